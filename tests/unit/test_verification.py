"""Candidates put to time histories: the run is that of the project with the section written in."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

pytest.importorskip("typer")

from typer.testing import CliRunner

from frames import ModelError
from frames.command.app import app
from frames.design import CheckError, Design, design
from frames.design.project import verification
from frames.design.project.design_run import run_project
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.verification import on_bearing, section_of, verified
from tests.unit.test_project import ASCE

FEW = ASCE.replace(', "artificial-3", "artificial-5"', "").replace(
    "[analysis]\n",
    '[design]\nradii = ["1.5 m"]\nfrictions = [0.04, 0.05]\nleast_pressure = "1 MPa"\n'
    '[analysis]\nlevel = "pendulum"\nbounds = ["nominal"]\n',
)

TYPE = '[bearings.wide]\ncolumns = ["0-0"]\nslider_radius = "300 mm"\n\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """Motions of the example, and a small project without a bearing."""
    made = put_example(tmp_path_factory.mktemp("verified"))
    start, end = FEW.index("[bearing]"), FEW.index("[spectrum]")
    (made / "few.toml").write_text(FEW[:start] + FEW[end:])
    return made


def parts_of(file: Path) -> ProjectInputs:
    return ProjectInputs(read_project(file), file.parent)


@pytest.fixture(scope="module")
def found(folder: Path) -> Design:
    parts = parts_of(folder / "few.toml")
    frame = parts.provisional_frame()
    return design(
        frame,
        parts.spectrum(),
        bounds=parts.bounds(),
        target=parts.target(),
        code=parts.code().analysis(),
    )


@pytest.fixture(scope="module")
def told(folder: Path) -> tuple[Any, pd.DataFrame]:
    """What the command says, and the table that it writes."""
    out = folder / "out"
    words = [str(folder / "few.toml"), "--verify", "--top", "2", "--results", str(out)]
    done = CliRunner().invoke(app, ["design", *words])
    assert done.exit_code == 0, done.output
    return done, pd.read_csv(out / "verified.csv", keep_default_na=False)


def test_what_is_verified_is_the_project_with_that_section(folder: Path, found: Design) -> None:
    """Rows against runs of files into which the sections were written."""
    bare = (folder / "few.toml").read_text()
    for one in verified(parts_of(folder / "few.toml"), found.ranked[:1]):
        candidate, row = one.candidate, one.row()
        file = folder / f"with-{candidate.friction.f_max:g}.toml"
        file.write_text(bare + "\n" + section_of(candidate.bearings[0]))
        run = run_project(parts_of(file))
        for name, unit in (("isolator displacement", "m"), ("base shear", "N")):
            assert row[f"{name} [{unit}]"] == pytest.approx(
                run.demands.loc[name, "envelope"], rel=1e-12
            )
        assert row["checks"] == len(run.checks)
        assert row["failed checks"] == len(run.checks.failed) > 0  # one motion is not seven
        titles = {check.title for check in run.checks.failed if not check.void}
        assert {part.split(" (ratio")[0] for part in str(row["fails"]).split("; ")} == titles


def test_the_command_says_which_passes(folder: Path, told: tuple[Any, pd.DataFrame]) -> None:
    done, table = told
    assert len(table) == 2
    one_mass = pd.read_csv(folder / "out" / "one_mass.csv")
    for _, row in table.iterrows():  # as one mass made them
        own = one_mass[one_mass["friction [-]"] == row["friction [-]"]]
        assert set(own["capacity [m]"]) == {row["capacity [m]"]}
        assert f"friction {row['friction [-]']:g}: tried" in done.stdout
    assert "Time histories of the best 2: 1 time histories" in done.stdout
    assert "number of motions (ratio 7.00)" in done.stdout
    assert "none passes all checks of the time histories" in done.stdout
    assert done.stdout.count("[bearing]") == 1


def test_candidates_are_run_when_they_are_asked_for(folder, found, monkeypatch):
    asked = []

    def noted(parts: ProjectInputs, **_: object) -> None:
        asked.append(parts.bearing().frictions[0].f_max)
        msg = "no such storey"
        raise ModelError(msg)

    monkeypatch.setattr(verification, "run_project", noted)
    each = verified(parts_of(folder / "few.toml"), found.ranked)
    assert asked == []
    first = next(each)
    assert asked == [found.chosen.friction.f_max]
    assert not first.passed
    assert first.row()["fails"] == "cannot be run: no such storey"


def test_sections_of_one_size_alone_are_verified(folder: Path, found: Design) -> None:
    words = [str(folder / "few.toml"), "--verify", "--sizes", "2", "--results", str(folder / "o")]
    done = CliRunner().invoke(app, ["design", *words])
    assert done.exit_code == 2
    assert "has one size, leave one out" in done.output
    several = found.chosen.__class__(
        **{name: getattr(found.chosen, name) for name in found.chosen.__dataclass_fields__}
        | {"bearings": found.chosen.bearings * 2}
    )
    with pytest.raises(CheckError, match="2 sizes of slider"):
        next(verified(parts_of(folder / "few.toml"), [several]))


def test_a_candidate_is_verified_alone_where_the_file_has_several_types(folder, found):
    file = folder / "types.toml"
    file.write_text(FEW.replace("[spectrum]", TYPE + "[spectrum]", 1))
    parts = parts_of(file)
    assert len({link.bearing.slider_radius for link in parts.frame().bearings.values()}) == 2
    best = found.ranked[0].bearings[0]
    proposed = on_bearing(parts, best)
    radii = {link.bearing.slider_radius for link in proposed.frame().bearings.values()}
    assert radii == {round(best.slider_radius, 3)}
