"""A check and a code from outside the package: those of docs/extending.md, and how they fail."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from frames import MotionError
from frames.command.app import app
from frames.design import (
    HISTORY_RULES,
    Check,
    CheckError,
    ProjectError,
    RunToCheck,
    Spectrum,
    code_named,
    register_check,
    register_code,
    unregister_check,
)
from frames.design.codes.registry import known_codes
from frames.design.hazard.code_rules import remove_rules, scaling_named
from frames.design.project import check_register, source_files
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project, schema
from lir_element import FrictionLaw
from tests.refusals import refused
from tests.scenes import DEVICE, STICK

PAGE = Path(__file__).parents[2] / "docs" / "extending.md"
SOURCE = "\n".join(re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE))
PROJECT = (
    """
[project]
name = "Harbour office"
code = "Island"
extensions = ["island.py"]
"""
    + STICK
    + DEVICE
    + """
[spectrum]
plateau = "6 m/s2"
corner = "0.5 s"
[motions]
folder = "motions"
only = ["artificial-1", "artificial-3"]
scale = 0.5
[bounds]
friction = [0.8, 1.3]
[analysis]
bounds = ["lower", "upper"]
level = "pendulum"
accidental_eccentricity = "none"
"""
)
ONE_BOUND = ('["lower", "upper"]', '["lower"]')
run = CliRunner().invoke


@pytest.fixture
def folder(tmp_path, monkeypatch, put_example):
    """A project by the code of the page; what it registers is taken back."""
    monkeypatch.setattr(source_files, "_LOADED", {})
    monkeypatch.setattr(check_register, "_REGISTERED", dict(check_register._REGISTERED))
    put_example(tmp_path)
    (tmp_path / "island.py").write_text(SOURCE)
    (tmp_path / "office.toml").write_text(PROJECT)
    yield tmp_path
    remove_rules("Island 2030")


def test_a_project_is_run_by_a_code_and_with_a_check_of_its_own(folder: Path) -> None:
    words = ["--no-figures", str(folder / "office.toml"), "--results", str(folder / "out")]
    done = run(app, ["run", *words])
    assert done.exit_code in {0, 1}, done.output
    checks = pd.read_csv(folder / "out" / "checks.csv")
    gap = checks[checks["title"] == "gap of the moat"].iloc[0]
    assert gap["clause"] == "Harbour authority, letter 12"
    demands = pd.read_csv(folder / "out" / "demands.csv")
    envelope = next(name for name in demands.columns if name.startswith("envelope"))
    moved = demands[demands["quantity"] == "isolator displacement"][envelope].max()
    assert gap["demand"] == pytest.approx(1.1 * moved)
    rims = checks[checks["clause"] == "Island 2030 5.3"]
    assert (rims["limit"] == 0.8).all()
    drift = checks[checks["title"] == "storey drift ratio"]
    assert set(drift["limit"]) == {0.01}
    number = checks[checks["title"] == "number of motions"].iloc[0]
    assert (number["demand"], number["limit"]) == (2, 2)
    linear = pd.read_csv(folder / "out" / "equivalent-linear.csv", index_col=0)
    found = linear.loc["lower"]
    d, period, b = (
        found.filter(like=name).iloc[0] for name in ("displacement", "period", "factor")
    )
    assert d == pytest.approx(6.0 * 0.5 / period / b * (period / 6.283185307) ** 2, rel=1e-2)
    assert "Island 2030" in (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert json.loads((folder / "out" / "run.json").read_text())["checks"] == len(checks)


def test_the_keys_of_its_spectrum_are_checked(folder: Path) -> None:
    file = folder / "office.toml"
    file.write_text(PROJECT.replace('corner = "0.5 s"', 'corner = "0.5 m"'))
    with pytest.raises(ProjectError, match=r'spectrum.corner = "0.5 m" is in "m", not a unit of s'):
        read_project(file)
    file.write_text(PROJECT.replace('corner = "0.5 s"', ""))
    refused(ProjectError, r"spectrum.corner is missing", read_project, file)
    assert "Island 2030" in schema()


def test_a_code_is_found_by_all_its_spellings(folder: Path) -> None:
    parts = ProjectInputs(read_project(folder / "office.toml"), folder)
    assert parts.file.project.code == "Island 2030" == parts.code().name
    assert HISTORY_RULES["Island"] is HISTORY_RULES["Island 2030"] is parts.code().histories
    assert Spectrum.given([0.1, 1.0], [5.0, 1.0], code="Island").damping_factor(0.05) == 1.0
    assert scaling_named("Island").measure == "RotD50"


def test_other_spellings_of_codes_are_understood() -> None:
    assert [code.name for code in known_codes()] == ["ASCE 7-22", "EN 1998", "NCh2745"]
    for word, name in (("ASCE 7", "ASCE 7-22"), ("EN 1998-1", "EN 1998"), ("NCh 2745", "NCh2745")):
        assert code_named(word) is code_named(name)
        assert HISTORY_RULES[word] is HISTORY_RULES[name]
    assert scaling_named("EN 1998-1") is scaling_named("EN 1998") is not scaling_named("EN 1998-2")
    refused(CheckError, r"'UBC'.*'ASCE 7-22', 'EN 1998', 'NCh2745'", code_named, "UBC")
    refused(MotionError, r"'UBC'.*'EN 1998-2'", scaling_named, "UBC")


def test_a_code_takes_no_name_of_another() -> None:
    asce = code_named("ASCE 7-22")
    with pytest.raises(MotionError, match="'ASCE 7' belongs to 'ASCE 7-22'"):
        register_code(replace(asce, name="ASCE 7"))
    with pytest.raises(CheckError, match="from 7 motions on by histories, from 5 by scaling"):
        replace(asce, scaling=(asce.scaling[0]._replace(least=5),))
    refused(TypeError, "DesignCode", register_code, "ASCE 7-22")  # type: ignore[arg-type]
    assert code_named("ASCE 7-22") is asce


def test_minima_are_a_matter_of_the_rules(folder: Path) -> None:
    """Of a code whose rules have minima, whichever its name."""
    asce = code_named("ASCE 7-22")
    file = folder / "asce.toml"
    text = PROJECT.replace('"Island"', '"ASCE 7"').replace('extensions = ["island.py"]', "")
    text = text.replace('plateau = "6 m/s2"', "s_ms = 0.8").replace(
        'corner = "0.5 s"', "s_m1 = 0.4"
    )
    file.write_text(text.replace(*ONE_BOUND) + "[superstructure]\nR = 4.0\n")
    titles = {}
    for minima, command in ((True, "run"), (False, "report")):  # judged anew by other rules
        rules = replace(asce.histories, has_minima=minima)
        register_code(replace(asce, histories=rules), replace=True)
        try:
            done = run(app, [command, "--no-figures", str(file), "--results", str(folder / "out")])
        finally:
            register_code(asce, replace=True)
        assert done.exit_code in {0, 1}, done.output
        titles[minima] = set(pd.read_csv(folder / "out" / "checks.csv")["title"])
    assert "storey shear of time histories" in titles[True] - titles[False]


def test_what_a_check_returns_is_looked_at(folder: Path) -> None:
    @register_check
    def wrong(run: RunToCheck) -> list[Check]:
        return [run.code.name]  # type: ignore[list-item]

    file = folder / "office.toml"
    file.write_text(PROJECT.replace(*ONE_BOUND))
    done = run(app, ["run", "--no-figures", str(file), "--results", str(folder / "out")])
    assert done.exit_code == 2, done.output
    assert "wrong returned 'Island 2030': return a list" in " ".join(done.stderr.split())
    unregister_check(wrong)
    assert wrong not in check_register._REGISTERED.values()


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("1 / 0", r"extensions = island.py, line 1: ZeroDivisionError"),
        (None, r"extensions: .*island.py is not a file"),
    ],
)
def test_an_extension_that_fails_is_named(folder: Path, source: str | None, words: str) -> None:
    script = folder / "island.py"
    if source is None:
        script.unlink()
    else:
        script.write_text(source)
    refused(ProjectError, words, read_project, folder / "office.toml")


def test_friction_laws_of_the_page_are_those_of_a_project(folder: Path) -> None:
    def law(text: str) -> FrictionLaw:
        file = folder / "office.toml"
        file.write_text(PROJECT.replace("friction = 0.06", text, 1))
        return ProjectInputs(read_project(file), folder).bearing().frictions[0]

    found = law(re.findall(r"^    (friction = \{ law.*\})$", PAGE.read_text(), re.MULTILINE)[0])
    assert [found.at_speed(v) for v in (0.0, 0.02, 0.06)] == pytest.approx([0.03, 0.045, 0.0525])
    assert found.kernel_values().error < 1e-9
    measured = law(
        'friction = { law = "MeasuredFriction", speeds = ["0 m/s", "20 mm/s", "0.1 m/s", "1 m/s"], '
        'coefficients = [0.03, 0.045, "5 %", 0.06] }'
    )
    assert [measured.at_speed(v) for v in (0.0, 0.02, 0.1, 5.0)] == pytest.approx(
        [0.03, 0.045, 0.05, 0.06], rel=1e-4
    )
    assert 1e-8 < measured.kernel_values().error < 1e-4 * 0.06
