"""The study of the records of FEMA P695: its functions on two motions."""

import json
import re
import types

import numpy as np
import pandas as pd
import pytest

from frames import GroundMotion, ductility, time_histories, time_history
from tests.unit.test_campaign_compare import FILE, put_pulses
from validation.measurements.yielding_runs import RIMS, WIDE
from validation.study import runner
from validation.study.__main__ import main
from validation.study.records import study
from validation.study.records_figures import figures
from validation.study.records_page import page
from validation.study.records_runs import (
    ALL,
    DEVICES,
    INTENSITY,
    LIMITS,
    STEP,
    considered,
    devices,
    ductilities,
    normalised,
    yield_rotations,
)


def pulse(period):
    t = np.arange(0.0, 2.0 * period, 0.02)
    x = np.sin(2.0 * np.pi * t / period) * np.sin(0.5 * np.pi * t / period)
    return GroundMotion(x=x, y=0.3 * x[::-1], dt=0.02, name=f"{period:g} s")


SCALES = (0.5, 2.6)


@pytest.fixture(scope="module")
def sets():
    return {"pulses": normalised({"1.5 s": pulse(1.5), "2.5 s": pulse(2.5)})}


@pytest.fixture(scope="module")
def found(sets, tmp_path_factory):
    pytest.importorskip("filelock")
    store = tmp_path_factory.mktemp("study") / "runs"
    first = study(sets, store, 2, SCALES)
    again = study(sets, store, 2, SCALES)
    return first, again


def test_a_store_that_is_there_is_not_run_again(found):
    first, again = found
    assert first["cost"]["computed"] == first["cost"]["runs"] == 4 * len(DEVICES)
    assert again["cost"]["computed"] == 0
    assert first["cost"]["digest"] == again["cost"]["digest"]
    assert first["parts"] == again["parts"]


def test_intensities_are_factors(sets):
    for motion in sets["pulses"].values():
        assert INTENSITY.of(motion) == pytest.approx(1.0, rel=1e-3)  # but for the tail


def test_the_earthquake_that_fills_the_capacity():
    # mu = 0.065 * 2.37/2.25 = 0.06847, k = 1/2.25 + mu/0.25 = 0.7183 1/m, T = 2.367 s,
    # damping 0.2427, B_M = 1.5855
    assert considered() == pytest.approx(0.25 * 39.478 * 1.5855 / (2.367 * 3.0), rel=1e-3)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_ductility_is_that_of_a_history(sets):
    motion = sets["pulses"]["2.5 s"]
    model = {RIMS: devices()[RIMS]}
    batch = time_histories(model, {"2.5 s": motion}, scales=[2.6], dt=STEP)
    table = ductility(time_history(model[RIMS], motion.scaled(2.6), dt=STEP))
    limits = np.array([yield_rotations()[name.split("-")[0]] for name in table.index])
    expected = 1.0 + (table["largest"].to_numpy() / limits).max()
    assert expected > 1.1
    assert ductilities(batch)[0] == pytest.approx(expected, rel=1e-9)


def test_stripes_count_what_the_runs_did(found):
    part = found[0]["parts"][ALL]
    rims = part["limits"][LIMITS[0].name]["stripes"]
    assert [row[1:] for row in rims[RIMS]] == [[0.0, 2.0], [2.0, 2.0]]
    assert [row[1:] for row in rims[WIDE]] == [[0.0, 2.0], [0.0, 2.0]]


def test_the_page_says_what_it_was_given(found):
    given = found[0]
    text = page(given)
    assert given["cost"]["digest"] in text
    assert set(figures(given)) == {"study-curves.png", "study-medians.png"}
    assert "none: no run exceeds the limit state" in text  # the larger DCFP has no rims


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
    drawn = {f"study_rims-{kind}-{k}.png" for kind in ("fragility", "response") for k in (1, 2)}
    assert {path.name for path in (to / "figures").iterdir()} == drawn
    csv = pd.read_csv(to / "tables/study_rims-rims-ratios.csv")
    assert csv["ratio [-]"].to_numpy() == pytest.approx(ratios["ratio [-]"], rel=1e-4, nan_ok=True)
    main(given)
    again = (to / "study_rims.md").read_text()
    assert f"{runs} histories, 0 of them in the last call" in again
    (to / "study_rims.md").unlink()
    main(["rims", "--again", "--to", str(to)])
    assert (to / "study_rims.md").read_text() == again
