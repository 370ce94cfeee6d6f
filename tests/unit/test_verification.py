"""Candidates put to time histories: the run is that of the project with the section written in."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

pytest.importorskip("typer")

from typer.testing import CliRunner

from frames import ModelError
from frames.command.app import app
from frames.design import Design, DesignTarget, design
from frames.design.project import verification
from frames.design.project.asked_by_runs import is_sized
from frames.design.project.design_run import run_project
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.verification import on_bearings, sections_of, verified, with_sections
from frames.design.sizing.fitting import Asked
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
    return of(parts, parts.target())


def of(parts: ProjectInputs, target: DesignTarget, sizes: int = 1) -> Design:
    frame, spectrum = parts.provisional_frame(), parts.spectrum()
    return design(
        parts.system(frame, spectrum),
        spectrum,
        bounds=parts.bounds(),
        target=target,
        code=parts.code().analysis(),
        sizes=sizes,
    )


@pytest.fixture(scope="module")
def told(folder: Path) -> tuple[Any, Path]:
    """What the command says, and the folder of the tables that it writes."""
    out = folder / "out"
    words = [str(folder / "few.toml"), "--verify", "--front", "--results", str(out)]
    done = CliRunner().invoke(app, ["design", *words])
    assert done.exit_code == 1, done.output  # one motion is not seven: a check fails
    return done, out


def few(found: Design, folder: Path, **options: Any) -> verification.Verified:
    return verified(parts_of(folder / "few.toml"), found, found.chosen, **options)


def test_what_is_verified_is_the_project_with_that_section(folder: Path, found: Design) -> None:
    """A row against the run of a file into which the section was written."""
    one = few(found, folder, rounds=1)
    row, file = one.row(), folder / "with.toml"
    section = sections_of(one.candidate, found.system.names)
    file.write_text(with_sections((folder / "few.toml").read_text(), section))
    run = run_project(parts_of(file))
    for name, unit in (("isolator displacement", "m"), ("base shear", "N")):
        assert row[f"{name} [{unit}]"] == pytest.approx(run.demands.loc[name, "envelope"], 1e-12)
    assert row["base shear / weight [-]"] == pytest.approx(
        row["base shear [N]"] / found.system.seismic_weight
    )
    assert row["checks"] == len(run.checks)
    assert row["failed checks"] == len(run.checks.failed) > 0  # one motion is not seven
    titles = {check.title for check in run.checks.failed if not check.void}
    assert {part.split(" (ratio")[0] for part in str(row["fails"]).split("; ")} == titles
    assert not one.passed
    assert {each.check.title for each in one.obstacles} == titles


def test_the_command_says_what_stands_in_the_way(told: tuple[Any, Path]) -> None:
    done, out = told
    front = pd.read_csv(out / "front.csv", keep_default_na=False)
    one_mass = pd.read_csv(out / "one_mass.csv")
    assert set(front["friction [-]"]) == set(one_mass["friction [-]"]) == {0.04, 0.05}
    assert set(front["outcome"]) == {"fails"}
    assert (out / "front.png").stat().st_size > 10_000
    assert not (out / "verified.csv").exists()  # what fails on the quick model is not verified
    assert "no candidate passes every check" in done.stdout
    assert "\n- number of motions" in done.stdout
    assert "\n- effect of the motions: the mean spectrum of the motions is" in done.stdout
    assert done.stdout.count("[bearing]") == 1


def test_a_candidate_that_cannot_be_run_says_why(folder, found, monkeypatch):
    def refused(*_: object) -> None:
        msg = "no such storey"
        raise ModelError(msg)

    monkeypatch.setattr(verification, "project_runs", refused)
    one = few(found, folder)
    assert not one.passed
    assert one.row()["fails"] == "cannot be run: no such storey"


def test_types_by_load_stand_under_their_columns(folder: Path) -> None:
    """Two sizes of slider in a file that had others: each under the columns of its loads."""
    parts = parts_of(folder / "few.toml")
    several = of(parts, parts.target(), sizes=2)
    names, chosen = several.system.names, several.chosen
    sliders = (0.3, *(0.0,) * (len(names) - 1))  # as time histories may ask it of one
    one = several.fit(chosen.radius, chosen.friction, Asked(sliders=sliders))
    assert one.places == (1, *(0,) * (len(names) - 1))
    assert one.bearings[1].slider_radius == pytest.approx(0.3)
    assert one.bearings[0].slider_radius == chosen.bearings[0].slider_radius
    kept = "# kept\n" + FEW.replace("[spectrum]", TYPE + "[spectrum]", 1)
    file = folder / "types.toml"
    file.write_text(with_sections(kept, sections_of(one, names)))
    assert file.read_text().startswith("# kept\n")
    written, proposed = parts_of(file), on_bearings(parts, one, names)
    for each in (written, proposed):
        links = each.frame().bearings
        assert [links[name].bearing.slider_radius for name in names] == [
            one.bearings[place].slider_radius for place in one.places
        ]
    assert written.file.bounds == parts.file.bounds
    alike = replace(one, bearings=one.bearings[:1] * 2)
    assert "bearings." not in sections_of(alike, names)


def test_bearings_are_sized_until_the_checks_pass(folder: Path, found: Design) -> None:
    """From a slip that is too small for the motion: every check of sizes keeps its margin then."""
    start, rounds = Asked(slip=0.9 * found.chosen.trace.value("s")), list[verification.Verified]()
    parts = parts_of(folder / "few.toml")
    strong = ProjectInputs(
        parts.file.model_copy(
            update={"motions": parts.file.motions.model_copy(update={"scale": 1.25})}
        ),
        folder,
    )
    last = verified(strong, found, found.chosen, asked=start, margin=1.1, told=rounds.append)
    first = rounds[0]
    over = [c for c in first.run.checks if is_sized(c) and c.ratio > 1.0]
    assert over
    assert last.rounds == len(rounds) > 1
    t, before = last.candidate.trace, found.chosen.trace
    assert t.value("U_cap") > before.value("U_cap")
    own = [c for c in last.run.checks if is_sized(c)]
    assert max(c.ratio for c in own) <= 1.0
    assert not any(o.sized for o in last.obstacles)


def test_a_file_that_is_written_keeps_all_but_its_bearings(folder: Path, told: Any) -> None:
    file = folder / "written.toml"
    file.write_text((folder / "few.toml").read_text())
    before = file.read_text()
    words = [str(file), "--write", "--top", "1", "--results", str(folder / "w")]
    done = CliRunner().invoke(app, ["design", *words])
    assert done.exit_code == 1, done.output
    assert file.with_name("written.toml.before").read_text() == before
    assert parts_of(file).bearing().radii == (1.5, 1.5)
