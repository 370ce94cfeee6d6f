"""Accidental eccentricity of a project: masses moved each way, what they raise, how it is kept."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from typer.testing import CliRunner

from frames import AnalysisInterrupted, load
from frames.command.app import app
from frames.design import CheckError, ProjectError, history_checks, history_demands
from frames.design.project import level_runs
from frames.design.project.comparison import OURS, PLAIN, compare_project
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.project.schema_structure import RESULT_FILES
from tests.refusals import refused
from tests.scenes import DEVICE

PROJECT = """
[project]
name = "One storey"
code = "ASCE 7-22"
[structure]
kind = "shear building"
bays = [2, 1]
bay_width = ["6 m", "6 m"]
storey_mass = ["150 t"]
storey_stiffness = ["400 kN/mm"]
storey_height = "3 m"
"""
PROJECT += DEVICE.replace("0.06", "0.05").replace("0.18", "0.15")
PROJECT += """
[spectrum]
s_ms = 1.2
s_m1 = 0.6
[motions]
folder = "motions"
only = ["artificial-1", "artificial-3"]
scale = 0.8
[bounds]
friction = [0.8, 1.3]
[limits]
rim_strength = "5 MN"
base_shear = "5 MN"
floor_acceleration = "8 m/s2"
drift = "1 %"
[analysis]
level = "pendulum"
bounds = ["lower"]
"""
FACTORED = {
    "displacement": "isolator displacement",
    "base_shear": "base shear",
    "drift": "storey drift ratio",
    "floor_plan": "floor acceleration in plan",
}
ADDED = {
    "slip": "interface slip",
    "rim_force": "rim force",
    "displacement_left": "residual displacement",
    "slip_left": "residual interface slip",
}
run = CliRunner().invoke


@pytest.fixture(scope="module")
def ran(
    tmp_path_factory: pytest.TempPathFactory,
    put_example: Callable[..., Path],
    made_once: Callable[..., Path],
) -> Path:
    """The project's folder after a run."""

    def make(folder: Path) -> None:
        file = put_example(folder) / "project.toml"
        file.write_text(PROJECT)
        done = run(app, ["run", "--no-figures", str(file), "--results", str(folder / "out")])
        assert done.exit_code in {0, 1}, done.output
        said = (
            "2 time histories: 2 motions, bounds lower, level MCE_R; 4 more with the masses moved"
        )
        assert said in " ".join(done.output.split())

    return made_once("moved masses", make, tmp_path_factory.mktemp("eccentric"))


def test_factors_and_demands_are_those_of_the_runs(ran: Path) -> None:
    """Ratios of the governing motion, by hand of the files; they multiply what the suite gives."""
    out = ran / "out"
    runs, moved = load(out / "runs-lower.nc"), load(out / "moved-lower.nc")
    worst = int(np.argmax(runs["peak_displacement"].max("bearing").to_numpy()))
    assert set(moved["motion"].values) == {runs["motion"].values[worst]}
    assert list(moved["mass_shift"].values) == ["+x", "-x", "+y", "-y"]
    table = pd.read_csv(out / "eccentricity.csv")
    demands = pd.read_csv(out / "demands.csv", index_col=0)
    [column] = [name for name in demands.columns if name.startswith("lower, ")]
    assert column == "lower, largest of 2 runs, raised by moved masses"
    checks = pd.read_csv(out / "checks.csv").set_index("title")
    for name, title in (FACTORED | ADDED).items():
        own = runs[f"peak_{name}"].to_numpy().reshape(2, -1)
        each = moved[f"peak_{name}"].to_numpy().reshape(4, -1).max(axis=1)
        rows = table[table["quantity"] == name.replace("_", " ")]
        centred = own[worst].max()
        np.testing.assert_allclose(rows["centred"], centred, rtol=1e-12)
        np.testing.assert_allclose(rows["moved"], each, rtol=1e-12)
        if name in FACTORED:
            np.testing.assert_allclose(rows["factor"], np.maximum(each / centred, 1.0), rtol=1e-12)
            expected = own.max() * max(each.max() / centred, 1.0)
        else:
            np.testing.assert_allclose(rows["added"], np.maximum(each - centred, 0.0), atol=1e-12)
            expected = own.max() + max(each.max() - centred, 0.0)
        assert demands.loc[title, column] == pytest.approx(expected, rel=1e-12)
        if title in checks.index:
            found = checks.loc[[title]]
            assert found["demand"].to_numpy()[0] == pytest.approx(expected, rel=1e-9)
    assert table.loc[table["quantity"] == "displacement", "factor"].max() > 1.01
    text = (out / "checks.txt").read_text(encoding="utf-8")
    assert "accidental eccentricity: masses moved" in text
    assert "e_D D_c" in text
    assert "masses moved by 5 % of the plan in each direction raise the demands" in text
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "moved by 5 % of the plan&#39;s sides in each direction, 4 more time histories" in page


def test_forces_for_design_have_what_moved_masses_add(ran: Path) -> None:
    """Shears of storeys and reactions of a run's files, from the extremes that its runs kept."""
    out = ran / "out"
    runs, moved = load(out / "runs-lower.nc"), load(out / "moved-lower.nc")
    worst = int(np.argmax(runs["peak_displacement"].max("bearing").to_numpy()))
    for kind, places in (
        ("storey", ("section", "storey_component")),
        ("reaction", ("bearing", "side", "reaction")),
    ):
        table = pd.read_csv(out / f"{'storeys' if kind == 'storey' else 'reactions'}.csv")
        table = table[table["force"].isin(["Vx", "Vy", "N"])]
        assert kind == "storey" or (table["moved masses add"].abs() > 1.0).any()
        for row in table.to_dict("records"):
            labels = {places[0]: row["storey" if kind == "storey" else "bearing"]}
            labels |= {"side": row["side"]} if kind == "reaction" else {}
            labels |= {places[-1]: row["force"], f"{places[-1]}_at_once": row["force"]}
            labels |= {"extreme": {"max": "largest", "min": "smallest"}[row["extreme"]]}
            own = runs[f"peak_{kind}_force"].sel(labels).to_numpy()
            each = moved[f"peak_{kind}_force"].sel(labels).to_numpy()
            sign = 1.0 if row["extreme"] == "max" else -1.0
            added = max(float((sign * (each - own[worst])).max()), 0.0)
            assert row["moved masses add"] == pytest.approx(sign * added, abs=2e-3)
            value = max(sign * own) + added  # two motions: the larger
            rest = sign * row["permanent"]
            value = rest + row["raised by"] * (value - rest)
            assert sign * row["value"] == pytest.approx(value, rel=1e-9, abs=1e-2)


def test_names_of_results_are_known(ran: Path) -> None:
    """A table of members by such a name would be written over: the project is refused before."""
    written = {path.name for path in (ran / "out").iterdir() if path.is_file()}
    histories = {name for name in written if name.startswith(("runs-", "moved-"))}
    assert len(histories) == 2
    assert written - histories <= RESULT_FILES
    assert len(written - histories) > 12


def test_the_report_reads_moved_runs_again(ran: Path) -> None:
    out = ran / "out"
    before = {name: (out / name).read_bytes() for name in ("checks.csv", "eccentricity.csv")}
    again = ["report", "--no-figures", str(ran / "project.toml"), "--results", str(out)]
    assert run(app, again).exit_code in {0, 1}
    assert before == {name: (out / name).read_bytes() for name in before}
    off = ran / "off.toml"
    off.write_text(PROJECT + 'accidental_eccentricity = "4 %"\n')
    done = run(app, ["report", str(off), "--results", str(out)])
    assert done.exit_code == 2
    assert "belong to other input (analysis differ)" in " ".join(done.output.split())


def test_a_run_goes_on_between_its_moved_masses(ran: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cut, file = ran / "cut", ran / "project.toml"
    own, calls = level_runs.time_histories, []

    def stopped(*given: object, **options: object) -> xr.Dataset:
        calls.append(options)
        found = own(*given, **options)  # type: ignore[arg-type]
        if len(calls) == 2:
            raise AnalysisInterrupted(1.0, found.isel(run=[0]))
        return found

    monkeypatch.setattr(level_runs, "time_histories", stopped)
    words = ["run", "--no-figures", str(file), "--results", str(cut)]
    assert run(app, words).exit_code == 130
    assert len(list((cut / "unfinished").rglob("*.npz"))) == 6
    next((cut / "unfinished" / "moved").iterdir()).unlink()
    monkeypatch.undo()
    done = run(app, words)
    assert done.exit_code in {0, 1}, done.output
    assert "1 of 1 runs (3 more were complete before)" in done.output
    for name in ("checks.csv", "demands.csv", "eccentricity.csv"):
        assert (cut / name).read_bytes() == (ran / "out" / name).read_bytes()
    assert not (cut / "unfinished").exists()
    assert list(json.loads((cut / "run.json").read_text())["moved"]) == ["lower"]


def test_all_motions_are_compared_as_the_code_counts_them(ran: Path) -> None:
    """Seven runs of which each was moved: means over means."""
    data, moved = (load(ran / "out" / f"{kind}-lower.nc") for kind in ("runs", "moved"))
    many = data.isel(run=[0, 1] * 4).assign_coords(motion=("run", list("abcdefgh")))
    ways = [
        many.assign_coords(mass_shift=("run", [way] * 8)).assign(
            peak_displacement=many["peak_displacement"] * factor
        )
        for way, factor in (("+x", 0.9), ("-x", 1.2), ("+y", 1.1), ("-y", 1.0))
    ]
    beside = xr.concat(ways, "run", data_vars="minimal", coords="minimal", compat="override")
    table = history_demands(many, "ASCE 7-22", moved=beside)
    old = beside.rename(mass_shift="masses_moved")  # of version 0.2
    assert history_demands(many, "ASCE 7-22", moved=old).equals(table)
    steps = many.rename_dims(time="step").drop_vars("time")  # of runs whose steps are their own
    steps = steps.assign_coords(time=(("run", "step"), np.zeros((8, many.sizes["time"]))))
    assert history_demands(steps, "ASCE 7-22", moved=beside).equals(table)
    plain = history_demands(many, "ASCE 7-22")
    rows = ("isolator displacement", "value")
    assert table.loc[rows] == pytest.approx(1.2 * plain.loc[rows], rel=1e-12)
    assert table.loc["base shear", "value"] == plain.loc["base shear", "value"]
    assert table.attrs["statistics"]["value"] == "mean of 8 runs, raised by moved masses"
    odd = moved.assign_coords(mass_shift=("run", ["up"] * 4))
    for words, runs, beside in (
        ("is not among the runs: use the motions", many, moved),
        ("mass_shift = 'up' must be one of", data, odd),
        ("no coordinate 'mass_shift'", data, data),
        ("runs has none: add them", {"lower": data}, {"upper": moved}),
    ):
        refused(CheckError, words, history_demands, runs, "ASCE 7-22", moved=beside)


def test_a_moved_run_that_fails_leaves_no_value(ran: Path) -> None:
    data, moved = (load(ran / "out" / f"{kind}-lower.nc") for kind in ("runs", "moved"))
    status = moved["status"].copy(data=["ok", "slip_exceeded", "ok", "ok"])
    frame = ProjectInputs(read_project(ran / "project.toml"), ran).frame()
    checks = history_checks(data, frame, "ASCE 7-22", moved=moved.assign(status=status))
    [check] = [c for c in checks if c.title == "runs with moved masses that failed"]
    assert (check.demand, check.passed) == (1.0, False)
    assert "masses moved -x" in check.note
    [shift] = [c for c in checks if c.title == "isolator displacement"]
    assert "the interface slipped further" in shift.void
    assert not shift.passed


@pytest.mark.parametrize("value", ['"none"', "0", '"0 %"'])
def test_it_is_left_out_where_the_file_says_so(ran: Path, value: str) -> None:
    file = ran / "none.toml"
    file.write_text(f"{PROJECT}accidental_eccentricity = {value}\n")
    parts = ProjectInputs(read_project(file), ran)
    assert parts.rules().accidental_eccentricity == 0.0
    known = preliminary(parts)
    assert not known.moved
    assert level_runs.said_of_runs(parts, known.motions).count("eccentricity is left out")
    data = load(ran / "out" / "runs-lower.nc")
    note = history_checks(data, known.frame, parts.rules())[0].note
    assert "without accidental eccentricity; ASCE 7-22 17.6.2.1 requires 5 %" in note


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("0.5", "must be a share of the plan's sides between 0 and 0.25"),
        ("-0.05", "must be a share of the plan's sides between 0 and 0.25"),
        ('"5 mm"', "not a unit of a pure number"),
    ],
)
def test_shares_out_of_bounds_are_refused(ran: Path, value: str, words: str) -> None:
    file = ran / "odd.toml"
    file.write_text(f"{PROJECT}accidental_eccentricity = {value}\n")
    refused(ProjectError, words, read_project, file)


def test_both_devices_of_a_comparison_have_their_own_moved_masses(ran: Path) -> None:
    """Demands by hand from the runs: of each device its own governing motion and factor."""
    parts = ProjectInputs(read_project(ran / "project.toml"), ran)
    found = compare_project(parts)
    assert "8 with the masses of all floors moved" in found.eccentricity
    table = found.table()
    for column, device in enumerate((OURS, PLAIN), start=1):
        own = found.runs.where(device=device, hazard_level="MCE_R", bound="lower")
        runs, moved = own.centred.data, own.moved.data
        worst = int(np.argmax(runs["peak_displacement"].max("bearing").to_numpy()))
        assert set(moved["motion"].values) == {runs["motion"].values[worst]}
        for name, title in FACTORED.items():
            own = runs[f"peak_{name}"].to_numpy().reshape(2, -1)
            factor = moved[f"peak_{name}"].to_numpy().max() / own[worst].max()
            expected = own.max() * max(factor, 1.0)
            assert table.iloc[:, column][title] == pytest.approx(expected, rel=1e-12)
    reached = found.runs.where(device=PLAIN).of("peak_slip")
    assert float(reached.max()) == 0.0
    whole = pd.read_csv(ran / "out" / "demands.csv", index_col=0)
    assert table.iloc[:, 1]["isolator displacement"] == pytest.approx(
        whole.loc["isolator displacement", "envelope of these"], rel=1e-9
    )
