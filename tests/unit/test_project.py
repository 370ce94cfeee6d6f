"""A project's file: units, messages, what it becomes; the command from an empty folder."""

import json
import math
import shutil
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("typer")

import pandas as pd
import xarray as xr
from typer.testing import CliRunner

from frames import AnalysisInterrupted, load, time_history
from frames.batch.runs import Runs
from frames.command.app import app
from frames.design import CheckError, ProjectError, Superstructure, with_property_bounds
from frames.design.project import example, level_runs
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.quantities import si
from frames.design.project.reading import read_project, schema
from frames.design.project.schema_structure import SuperstructureTable
from frames.design.project.speed import Way
from frames.design.report import figures, files
from frames.design.sizing.target import INTERFACE_PRESSURE
from tests.refusals import refused
from tests.viewed import payload

SMALL = """
[project]
name = "Two storeys"
code = "NCh2745"
[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["6 m", "600 cm"]
storey_mass = ["100 t", "100 t"]
storey_stiffness = ["400 kN/mm", "300 kN/mm"]
storey_height = "3 m"
base_mass = "100000 kg"
[bearing]
radius = "1.5 m"
slider_height = "200 mm"
slider_radius = "0.2 m"
capacity = "180 mm"
friction = {f_max = 0.06, f_min = "3 %", rate = "100 s/m"}
interface_friction = 0.18
[spectrum]
soil = "II"
zone = 2
[motions]
folder = "motions"
only = ["artificial-1", "artificial-3", "artificial-5"]
scale = 0.8
[bounds]
friction = [0.8, 1.3]
interface = [0.9, 1.1]
[limits]
rim_strength = "5 MN"
[analysis]
accidental_eccentricity = "none"
"""
ASCE = SMALL.replace('"NCh2745"', '"ASCE 7-22"').replace(
    'soil = "II"\nzone = 2', "s_ms = 1.0\ns_m1 = 0.5"
)  # uplift does not void its runs
SOON = f'{ASCE}level = "pendulum"\n'
"""The level that is soonest done, for what is not about time histories."""
LAST = SMALL.replace('"artificial-1", "artificial-3", ', "")  # motion alone
AT_LOADS_OF_RUNS = [
    "interface holds until a rim is met",
    "stable limit of interface slip",
    "normalised eccentricity e/a at the rims",
]
run = CliRunner().invoke


def ran(file: object, results: object) -> Any:
    """Run a project by the command, without figures."""
    return run(app, ["run", "--no-figures", str(file), "--results", str(results)])


@pytest.fixture
def done(tmp_path: Path, run_once: tuple[Path, Any]) -> Path:
    """The same with the results of a run in it, in the folder `out`."""
    shutil.copytree(run_once[0], tmp_path, dirs_exist_ok=True)
    return tmp_path


@pytest.fixture(scope="module")
def run_once(tmp_path_factory, put_example):
    """Folder of the small project that was run, and what the command returned."""
    folder = put_example(tmp_path_factory.mktemp("run"))
    (folder / "small.toml").write_text(SOON)
    found = ran(folder / "small.toml", folder / "out")
    assert found.exit_code in {0, 1}, found.output
    return folder, found


@pytest.fixture
def folder(tmp_path: Path, put_example: Callable[..., Path]) -> Path:
    """Motions of the example, and a small project."""
    put_example(tmp_path)
    (tmp_path / "small.toml").write_text(ASCE)
    return tmp_path


@pytest.fixture
def whole(folder: Path, put_example: Callable[..., Path]) -> Path:
    """The same with the example as it is written for users."""
    return put_example(folder, whole=True)


@pytest.mark.plain
@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("175 mm", "m", 0.175),
        ("175mm", "m", 0.175),
        ("-3.5e-1 m", "m", -0.35),
        ("12 in", "m", 0.3048),
        ("150 kN", "N", 150e3),
        ("1 kip", "N", 4448.2216152605),
        ("1450 kg/m2", "kg/m^2", 1450.0),
        ("30 MPa", "Pa", 30e6),
        ("1 t", "kg", 1000.0),
        ("100 s/m", "s/m", 100.0),
        ("0.3 s/in", "s/m", 0.3 / 0.0254),
        ("5 %", "", 0.05),
        (0.05, "", 0.05),
        ("0.05", "", 0.05),
        ("0.35 m/s^2", "m/s^2", 0.35),
        ("50 psf", "N/m^2", 50.0 * 4.4482216152605 / 0.3048**2),
        ("50 psf", "kg/m^2", 50.0 * 0.45359237 / 0.3048**2),
        ("1 plf", "N/m", 4.4482216152605 / 0.3048),
        ("2 klf", "N/m", 2000.0 * 4.4482216152605 / 0.3048),
        ("150 pcf", "kg/m^3", 150.0 * 0.45359237 / 0.3048**3),
        ("4 ksf", "N/m^2", 4000.0 * 4.4482216152605 / 0.3048**2),
    ],
)
def test_units_are_si(text: object, unit: str, value: float) -> None:
    assert si(text, unit, "1 m") == pytest.approx(value, rel=1e-12)


@pytest.mark.plain
@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        (175, "m", 'write "175 mm"'),
        ("175", "m", "no unit"),
        ("175 kN", "m", "not a unit of m: write a number in mm"),
        ("175 furz", "m", "unknown unit"),
        ("mm", "m", "not a number"),
        (True, "", "not a number"),
        (math.inf, "", "not finite"),
        ("3 m", "", "not a unit of a pure number: write a pure number"),
        ("1,5 m", "m", 'has a comma: write "1.5 m"'),
        ("1 2 m", "m", 'has "2 m" in place of a unit'),
        ("3 )", "m", "in place of a unit"),
        ("3 m**", "m", "in place of a unit"),
        ("3 m/0", "m", "in place of a unit"),
        ("3 psf", "m", "not a unit of m"),
    ],
)
def test_what_is_no_quantity_is_refused(text: object, unit: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        si(text, unit, "175 mm")


def test_bounds_of_a_file_are_those_of_python() -> None:
    above = {"fixed_base_period": 1.0, "storey_weights": (1.0,), "storey_heights": (3.0,), "R": 2.0}
    for name, value in {"R": 0.5, "importance": 4.0, "wind_shear": -1.0}.items():
        refused(CheckError, f"{name} = ", Superstructure, **above | {name: value})
        text = f"{value} N" if name == "wind_shear" else value
        refused(ValueError, name, SuperstructureTable, **{name: text})


def changed(folder: Path, old: str, new: str) -> Path:
    assert old in SMALL
    path = folder / "changed.toml"
    path.write_text(SMALL.replace(old, new))
    return path


@pytest.mark.plain
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"180 mm"', "180", 'changed.toml: bearing.capacity = 180 has no unit: write "180 mm"'),
        ("capacity", "capacty", 'bearing.capacty is not known; is "capacity" meant'),
        ("interface_friction = 0.18", "", "bearing.interface_friction is missing"),
        ('radius = "1.5 m"', 'radius = "1500"', 'bearing.radius = "1500" has no unit'),
        ("zone = 2", "zone = 7", "spectrum.zone = 7 must be 1, 2 or 3"),
        ('soil = "II"', "s_ms = 1.0", "spectrum.s_ms is not known"),
        ('"NCh2745"', '"NCh433"', "code = .NCh433. must be"),
        ('folder = "motions"', "", "motions: needs one source"),
        (
            "scale = 0.8",
            'scale = "spectrum"\npulses = {periods = ["3 s"], velocities = ["1 m/s"]}',
            'motions: scale = "spectrum" does not apply to pulses',
        ),
        ("[limits]", "[limit]", 'limit is not known; is "limits" meant'),
        (
            'friction = {f_max = 0.06, f_min = "3 %", rate = "100 s/m"}',
            'friction = "a lot"',
            r"^[^\n]*bearing.friction = .a lot. is not a number",
        ),
        (
            'friction = {f_max = 0.06, f_min = "3 %", rate = "100 s/m"}',
            "friction = {f_mox = 0.06}",
            'friction.f_mox is not known; is "f_max" m',
        ),
        (
            'friction = {f_max = 0.06, f_min = "3 %", rate = "100 s/m"}',
            "friction = {f_mox = 0.06}",
            "friction.f_min is missing",
        ),
        (
            "[0.8, 1.3]",
            '"a lot"',
            r"bounds.friction = .a lot. must be a list: write it in brackets, \[0.8",
        ),
        ("[0.8, 1.3]", "[0.8, 1.0, 1.3]", "bounds.friction has 3 entries: write at most 2"),
        ("zone = 2", "zone = true", r"spectrum.*: zone = true must be a number or a text"),
        (
            "[limits]",
            "[superstructure]\nR = 6.0\nimportance = 5.0\n[limits]",
            "importance = 5.0 must be at most 3",
        ),
        (
            "[limits]",
            "[superstructure]\nR = 13.0\n[limits]",
            "superstructure.R = 13.0 must be at most 12",
        ),
        (
            "[limits]",
            '[superstructure]\nR = "eight"\n[limits]',
            'R = "eight" is not a number: write a pure number',
        ),
        ("scale = 0.8", "scale = 0", 'scale = 0 must be "spectrum" or a positive factor'),
        ("scale = 0.8", "scale = inf", 'must be "spectrum" or a positive factor'),
        ("[bearing]", "[bearing", r"TOML syntax error: .*: write `key = value`"),
        ("[bearing]", "[bearing]\ncapacity = 1\ncapacity = 2", r"overwrite .*keep one of them"),
        ("[bearing]", "[bearing]\n[bearing]", r"the section occurs twice: keep one of them"),
    ],
)
def test_messages_name_file_key_value_and_remedy(tmp_path, old, new, words):
    with pytest.raises(ProjectError, match=words):
        read_project(changed(tmp_path, old, new))


@pytest.mark.plain
@pytest.mark.parametrize(
    ("old", "new", "part", "words"),
    [
        ("[0.8, 1.3]", "[1.2, 1.3]", "bounds", r"\[bounds\] lower factor of properties = 1.2"),
        ('"180 mm"', '"180 m"', "bearing", r"\[bearing\] capacity = 180 m lies beyond"),
        ('capacity = "180 mm"', "", "bearing", r"\[bearing\].*capacity"),
        ('"motions"', '"nowhere"', "motions", r"\[motions\].*nowhere"),
        ('"5 MN"', '"-5 MN"', "limits", r"\[limits\].*rim_strength"),
    ],
)
def test_a_section_that_cannot_be_is_named(tmp_path, old, new, part, words):
    parts = ProjectInputs(read_project(changed(tmp_path, old, new)), tmp_path)
    with pytest.raises(ProjectError, match=words):
        getattr(parts, part)()


@pytest.mark.plain
def test_the_schema_knows_all_sections() -> None:
    found = json.loads(schema(), parse_constant=pytest.fail)  # JSON has no infinity
    assert {"project", "structure", "bearing", "spectrum", "bounds"} <= set(found["properties"])


def test_the_example_is_a_project(folder: Path) -> None:
    file = read_project(folder / "project.toml")
    ground = preliminary(ProjectInputs(file, folder))
    assert len(ground.frame.bearings) == 12
    assert ground.motions.scaling is not None
    assert ground.motions.scaling.least_ratio == pytest.approx(1.0)
    assert len(ground.motions) == 7
    for motion in ground.motions.values():
        assert abs(motion.drift["x"].share) < 0.05


def test_new_writes_the_example_of_a_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(example, "PULSES", {"artificial-1": 1.9})  # one motion
    own, made = tmp_path / "own", tmp_path / "made"
    example.write_example(made, "EN 1998")
    assert run(app, ["new", str(own), "--code", "EN 1998"]).exit_code == 0
    names = sorted(path.relative_to(made) for path in made.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(own) for path in own.rglob("*") if path.is_file())
    assert all((own / name).read_bytes() == (made / name).read_bytes() for name in names)


@pytest.mark.parametrize("code", ["ASCE 7-22", "EN 1998", "NCh2745"])
def test_each_code_has_an_example(tmp_path, code, put_example):
    """Its motions follow its spectrum, so that the rule of the code hardly scales them."""
    folder = put_example(tmp_path / "own", code, whole=True)
    file = read_project(folder / "project.toml")
    assert file.project.code == file.spectrum.code == code
    parts = ProjectInputs(file, folder)
    periods = np.geomspace(0.1, 4.0, 30)
    wanted = np.asarray(parts.spectrum().acceleration(periods))
    for motion in parts.motions().values():
        reached = motion.response_spectrum(periods)["pseudo_acceleration"].to_numpy()
        assert reached == pytest.approx(wanted, rel=0.2)
        assert np.mean(reached / wanted) == pytest.approx(1.0, abs=0.04)
    scaling = preliminary(parts).motions.scaling
    assert scaling is not None
    assert all(0.7 < factor < 1.3 for factor in scaling.factors.values())


def test_an_unknown_code_is_refused(tmp_path: Path) -> None:
    done = run(app, ["new", str(tmp_path / "own"), "--code", "UBC"])
    assert done.exit_code == 2
    assert "ASCE 7-22" in done.stderr


def test_new_writes_over_nothing(folder: Path) -> None:
    again = run(app, ["new", str(folder)])
    assert again.exit_code == 2
    assert "exists" in again.stderr


def test_a_report_without_figures_says_so_and_lir_report_draws_them(done, monkeypatch):
    monkeypatch.setattr(figures, "pictures", lambda *_: {"model": []})
    assert "Written without figures" in (done / "out" / "report.html").read_text(encoding="utf-8")
    run(app, ["report", str(done / "small.toml"), "--results", str(done / "out")])
    text = (done / "out" / "report.html").read_text(encoding="utf-8")
    assert "Written without figures" not in text


@pytest.mark.quick
def test_a_run_writes_what_its_parts_give(run_once: tuple[Path, Any]) -> None:
    folder, done = run_once
    results = folder / "out"
    checks = pd.read_csv(results / "checks.csv")
    facts = json.loads((results / "run.json").read_text())
    assert facts["passed"] == checks["passed"].all() == (done.exit_code == 0)
    assert len(checks) == facts["checks"] > 20
    assert (results / "checks.txt").read_text().count("standing: ") == len(checks)
    assert (results / "project.toml").read_text() == SOON
    runs = load(results / "runs-upper.nc")
    parts = ProjectInputs(read_project(folder / "small.toml"), folder)
    motion = parts.motions()["artificial-3"].scaled(0.8)
    model = with_property_bounds(parts.frame(), "upper", parts.bounds())
    single = time_history(model, motion, level="pendulum")
    ours = float(runs["peak_displacement"].isel(run=1).max())
    size = np.linalg.norm(single["bearing_displacement"].to_numpy()[..., :2], axis=-1)
    assert ours == pytest.approx(size.max(), rel=1e-12)
    demands = pd.read_csv(results / "demands.csv", index_col=0)
    each = runs["peak_displacement"].max("run")
    upper = next(name for name in demands.columns if name.startswith("upper, "))
    assert demands.loc["isolator displacement", upper] == pytest.approx(float(each.max()))


def test_a_run_is_viewed_in_motion(done: Path) -> None:
    """The page has the governing run, and the checks as the run's table has them."""
    small, out = done / "small.toml", done / "out"
    found = run(app, ["view", str(small), "--results", str(out)])
    assert found.exit_code == 0, found.output
    written = out / "view.html"
    assert f"{written}: {written.stat().st_size / 1e6:.1f} MB" in found.output
    facts = json.loads((out / "run.json").read_text(encoding="utf-8"))
    assert facts["governing_case"] in found.output
    held, table = payload(written), pd.read_csv(out / "checks.csv", keep_default_na=False)
    assert [check["title"] for check in held["checks"]] == list(table["title"])
    assert [check["verdict"] for check in held["checks"]] == list(table["verdict"])
    governing = load(out / "governing.nc")
    u = governing["bearing_displacement"].to_numpy()
    largest = np.linalg.norm(u[..., :2].astype(float), axis=-1).max(axis=0)
    assert [value for value, _ in held["peaks"]["displacement"]] == pytest.approx(largest)
    thin = run(app, ["view", str(small), "--results", str(out), "--size", "0.2"])
    assert thin.exit_code == 0, thin.output
    assert payload(written)["kept"]["steps"] < held["kept"]["steps"]
    run(app, ["report", "--no-figures", str(small), "--results", str(out)])
    assert not written.exists()  # its checks may be others by now


def test_what_cannot_be_viewed_says_what_to_run(done: Path) -> None:
    small, out = done / "small.toml", done / "out"

    def refused(results: Path, *more: str) -> str:
        found = run(app, ["view", str(small), "--results", str(results), *more])
        assert found.exit_code == 2, found.output
        return " ".join(found.output.split())

    assert "has no run: run `lir run`" in refused(done / "nothing")
    assert "size = 0 MB must be positive" in refused(out, "--size", "0")
    checks = (out / "checks.csv").read_text(encoding="utf-8")
    (out / "checks.csv").write_text(checks.replace(",verdict", ",word"), encoding="utf-8")
    assert "checks.csv has no column verdict: run `lir report`" in refused(out)
    (out / "checks.csv").unlink()
    assert "checks.csv is missing: run `lir report`" in refused(out)
    small.write_text(small.read_text().replace('storey_height = "3 m"', 'storey_height = "4 m"'))
    assert "belong to other input (structure differ): run `lir run` again" in refused(out)
    assert not (out / "view.html").exists()


def test_nch2745_is_run_at_both_levels(folder: Path) -> None:
    """Bearings judged under 1.2 times the motions that judge what stands on them."""
    file, out = folder / "chile.toml", folder / "chile"
    two = SMALL.replace(', "artificial-5"', "")
    soon = "bounds = ['upper']\nuplift_allowed = true\nlevel = 'pendulum'\n"
    file.write_text(f"{two}\n{soon}")
    checked = run(app, ["check", str(file)])
    assert "4 time histories: 2 motions, bounds upper, levels design, maximum (" in checked.stdout
    done = ran(file, out)
    assert done.exit_code in {0, 1}, done.output
    assert "\n4 time histories: 2 motions, bounds upper, levels design, max" in done.stdout
    runs = {level: load(out / f"runs-{level}-upper.nc") for level in ("design", "maximum")}
    assert [float(data["scale"][0]) for data in runs.values()] == [1.0, 1.2]
    parts = ProjectInputs(read_project(file), folder)
    motion = parts.motions()["artificial-1"].scaled(0.8 * 1.2)
    model = with_property_bounds(parts.frame(), "upper", parts.bounds())
    single = time_history(model, motion, level="pendulum")
    size = np.linalg.norm(single["bearing_displacement"].to_numpy()[..., :2], axis=-1)
    at_most = float(runs["maximum"]["peak_displacement"].isel(run=0).max())
    assert at_most == pytest.approx(size.max(), rel=1e-6)
    checks = pd.read_csv(out / "checks.csv").set_index("title")
    assert checks.loc["isolator displacement", "level"] == "maximum"
    assert checks.loc["storey drift ratio", "level"] == "design"
    assert set(checks.loc["number of motions", "level"]) == {"design", "maximum"}
    reached = float(runs["maximum"]["peak_displacement"].max())
    assert checks.loc["isolator displacement", "demand"] == pytest.approx(reached)
    demands = pd.read_csv(out / "demands.csv")
    upper = next(name for name in demands.columns if name.startswith("upper, "))
    moved = demands[demands["quantity"] == "isolator displacement"].set_index("level")[upper]
    assert moved["maximum"] == pytest.approx(reached)
    assert moved["design"] < moved["maximum"]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "the bearings at the level &#39;maximum&#39;, motions times 1.2" in page
    again = run(app, ["report", "--no-figures", str(file), "--results", str(out)])
    assert again.exit_code == done.exit_code
    facts = json.loads((out / "run.json").read_text())
    del facts["inputs"]["levels"]  # as a run at one level left it
    (out / "run.json").write_text(json.dumps(facts))
    other = run(app, ["report", str(file), "--results", str(out)])
    assert other.exit_code == 2
    assert "levels differ" in " ".join(other.output.split())


def test_uplift_counts_as_the_file_says(whole: Path) -> None:
    folder = whole
    said = {"": False, 'least_gap = "0.01 mm"': True, "uplift_allowed = true": False}
    voids = set()
    for line, is_void in said.items():
        tall = LAST.replace('storey_height = "3 m"', 'storey_height = "8 m"')
        (folder / "uplift.toml").write_text(
            f'{tall}\nlevel = "pendulum"\nbounds = ["lower"]\n{line}\n'
        )
        command = "report" if voids else "run"  # judged anew
        words = ["--no-figures", str(folder / "uplift.toml"), "--results", str(folder / "up")]
        done = run(app, [command, *words])
        assert done.exit_code == 1, done.output
        demands = pd.read_csv(folder / "up" / "demands.csv", index_col=0)
        assert ("lower: " in str(demands["void"].iloc[0])) == is_void
        head = next(name for name in demands.columns if name.startswith("lower, "))
        assert ("no valid value" in head) == is_void
        level = demands[demands["level"] == "maximum"]  # at which bearings are judged
        why = str(level["void"].astype("object").fillna("").iloc[0]).removeprefix("level maximum, ")
        checks = pd.read_csv(folder / "up" / "checks.csv", keep_default_na=False)
        of_loads = checks[checks["title"].isin(AT_LOADS_OF_RUNS)]
        assert len(of_loads) == 4
        assert set(of_loads["void"]) == {why}
        assert of_loads["verdict"].eq("no value").all() or not why
        tests = pd.read_csv(folder / "up" / "programme.csv")
        at_loads = tests["what"].str.contains("largest load|least load|interface|impact")
        marked = tests["note"].astype(str).str.contains("no values for design")
        assert (marked == (at_loads & bool(why))).all()
        page = (folder / "up" / "report.html").read_text(encoding="utf-8")
        programme = page.partition('id="test-programme"')[2].partition('id="calculations"')[0]
        assert ("no values for design" in programme) == bool(why)
        voids.add(bool(why))
        is_told = "count as contact" in (folder / "up" / "checks.csv").read_text()
        if line != 'least_gap = "0.01 mm"':  # up to which there may be gaps as well
            assert is_told == (not line)
    assert voids == {False, True}


def test_the_devices_are_compared(folder: Path) -> None:
    (folder / "small.toml").write_text(SOON.replace(', "artificial-3", "artificial-5"', ""))
    done = run(
        app, ["compare", str(folder / "small.toml"), "--no-figures", "--results", str(folder / "c")]
    )
    assert done.exit_code == 0, done.output
    line = next(
        one for one in done.stdout.splitlines() if one.startswith("residual interface slip")
    )
    assert line.split()[-2:] == ["0", "MCE_R"]  # the rigid slider


def test_steps_are_compared_with_a_finer_one(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error of a step falls with it, and the cheapest that keeps an error is named."""
    monkeypatch.chdir(folder)
    done = run(app, ["bench", "small.toml", "--error", "0.02"])
    assert done.exit_code == 0, done.output
    table = pd.read_csv("bench.csv")
    assert list(table["dt"].fillna(0.0)) == [0.00125, 0.0, 0.02, 0.01, 0.005, 0.0025]
    errors = table.set_index("dt")["displacement"]
    assert errors[0.00125] == 0.0 < errors[0.0025] < errors[0.02] < 0.1
    assert (table["seconds"] > 0.0).all()
    good = table[1:][
        (table[1:][["displacement", "base_shear", "acceleration"]] <= 0.02).all(axis=1)
    ]
    dt = good.loc[good["seconds"].idxmin(), "dt"]
    said = "leave dt out" if math.isnan(dt) else f'dt = "{1e3 * dt:g} ms"'
    assert f"error below 0.02 in the peaks: [analysis] {said}" in done.stdout


def test_steps_that_were_run_are_kept(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)

    def few(*_: object, **__: object) -> Iterator[Way]:
        yield Way(0.01, "pendulum", 100, 0.1, 0.01, 0.0, 0.0, 0.0, "ok")
        raise KeyboardInterrupt

    monkeypatch.setattr("frames.design.project.speed.ways_to_run", few)
    assert run(app, ["bench", "small.toml"]).exit_code == 130
    assert len(pd.read_csv("bench.csv")) == 1


def test_bearings_are_proposed_as_a_section(whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = whole
    monkeypatch.chdir(folder)
    text = (folder / "project.toml").read_text()
    alone = text.replace('folder = "motions"', 'folder = "motions"\nonly = ["artificial-1"]')
    (folder / "one.toml").write_text(alone.replace('scale = "spectrum"', "scale = 1.0"))
    words = ["--top", "1", "--objective", "displacement"]
    done = run(app, ["design", str(folder / "one.toml"), *words])
    assert done.exit_code == 1, done.output  # one motion is not seven
    assert "16 candidates tried" in done.stdout
    table = pd.read_csv("design/candidates.csv", keep_default_na=False)
    chosen = table[table["outcome"] == "proposed"].iloc[0]
    assert f'radius = "{chosen["radius [m]"]:g} m"' in done.stdout
    good = table[(table["lacks"] == "") & (table["warnings"] == "")]
    assert chosen["displacement [m]"] == good["displacement [m]"].min()
    assert Path("design/candidates.png").stat().st_size > 10_000
    section = done.stdout[done.stdout.index("[bearing]") :]
    start, end = text.index("[bearing]"), text.index("[bounds]")
    (folder / "project.toml").write_text(text[:start] + section + "\n" + text[end:])
    assert read_project(folder / "project.toml").bearing is not None


def test_candidates_of_which_none_keeps_what_is_asked_are_written(folder: Path) -> None:
    text = (folder / "project.toml").read_text()
    file = folder / "tight.toml"
    file.write_text(text.replace('max_displacement = "600 mm"', 'max_displacement = "100 mm"'))
    found = run(app, ["design", str(file), "--results", str(folder / "tried")])
    assert found.exit_code == 2
    assert "none of 16 pairs" in found.output
    table = pd.read_csv(folder / "tried" / "candidates.csv")
    assert list(table["outcome"]) == ["rejected"] * 16
    assert set(table["limited by"]) == {"displacement"}
    assert "- displacement: raise its limit by " in found.output
    assert "- effect of the motions: the mean spectrum of the motions is" in found.output
    wrong = run(app, ["design", str(file), "--objective", "weight"])
    assert wrong.exit_code == 2
    assert "must be one of base-shear, displacement, plan, cost-like" in wrong.output


def test_a_run_goes_on_where_it_was_interrupted(done, monkeypatch):
    """Interrupted after all of its runs but the governing one: they are kept, none is run twice."""
    folder = done
    file, cut = folder / "small.toml", folder / "cut"
    shutil.copytree(folder / "out", cut)

    def stopped(*_: object, **__: object) -> None:
        raise AnalysisInterrupted(2.0, xr.Dataset())

    monkeypatch.setattr(level_runs, "Analysis", stopped)
    found = ran(file, cut)
    assert found.exit_code == 130
    assert "9 complete runs are kept in " in found.output
    assert "unfinished: repeat the command to continue" in found.output
    assert "belong to the earlier run" in found.output
    assert "attribute" not in found.output
    report = run(app, ["report", "--no-figures", str(file), "--results", str(cut)])
    assert "a later run was interrupted" in report.output
    for path in cut.glob("*.*"):
        path.unlink()
    report = run(app, ["report", str(file), "--results", str(cut)])
    assert "has an interrupted run: run `lir run`" in report.output
    kept = list((folder / "cut" / "unfinished").iterdir())
    assert len(kept) == 9
    kept[4].unlink()  # as if it had been interrupted before
    monkeypatch.undo()
    found = ran(file, cut)
    assert found.exit_code in {0, 1}
    assert "1 of 1 runs (8 more were complete before)" in found.output
    assert not (folder / "cut" / "unfinished").exists()
    for name in ("demands.csv", "checks.csv", "bearings.csv", "equivalent-linear.csv"):
        assert (folder / "cut" / name).read_text() == (folder / "out" / name).read_text()
    for bound in ("lower", "nominal", "upper"):
        both = (load(folder / where / f"runs-{bound}.nc") for where in ("cut", "out"))
        one, two = (
            d.drop_vars("seconds_loop").drop_sel(quantity="seconds of the time loop") for d in both
        )
        xr.testing.assert_identical(one.drop_attrs(deep=False), two.drop_attrs(deep=False))


def test_a_run_that_was_not_written_whole_is_none(done, monkeypatch):
    def full(data: xr.Dataset, path: Path, *, compress: bool = False) -> None:
        if path.name == "governing.nc":
            raise OSError(28, "No space left on device")
        path.write_bytes(b"")

    folder = done
    words = [str(folder / "small.toml"), "--results", str(folder / "out")]
    monkeypatch.setattr(files, "save", full)
    failed = run(app, ["run", "--no-figures", *words])
    assert failed.exit_code == 4
    assert "error: No space left on device" in failed.output
    assert "complete runs are kept in" in failed.output
    found = run(app, ["report", *words])
    assert found.exit_code == 2
    assert "has an interrupted run" in found.output


def test_a_governing_run_whose_peaks_are_chance_says_so(done, monkeypatch):
    kept = load(done / "out" / "governing.nc")
    assert 0.0 <= float(kept.attrs["noise_displacement"]) < 1e-4  # of an ordinary run
    assert level_runs.sensitivity_warnings(kept) == ()
    monkeypatch.setattr(level_runs, "NOISE", 0.2)
    parts = ProjectInputs(read_project(done / "small.toml"), done)
    known = preliminary(parts)
    runs = Runs(load(done / "out" / "runs-lower.nc"))
    data = level_runs.governing_run(parts, known, runs)
    [said] = level_runs.sensitivity_warnings(data)
    share = 100.0 * float(data.attrs["noise_displacement"])
    assert share > 5.0
    assert f"bearing displacement by {share:.2g} %" in said


def test_ctrl_c_in_the_governing_run_ends_the_disturbed_one_beside_it(done, monkeypatch):
    begun, ended = threading.Event(), threading.Event()

    class Endless:
        def __init__(self, *_: object) -> None:
            pass

        def run(self, _motion, *, dt, recording=None, progress=None) -> None:
            while recording is not None:
                begun.set()
                try:
                    progress(0.0)
                except KeyboardInterrupt:
                    return ended.set()
            begun.wait(10.0)
            raise KeyboardInterrupt

    monkeypatch.setattr(level_runs, "Analysis", Endless)
    parts = ProjectInputs(read_project(done / "small.toml"), done)
    runs = Runs(load(done / "out" / "runs-lower.nc"))
    with pytest.raises(KeyboardInterrupt):
        level_runs.governing_run(parts, preliminary(parts), runs)
    assert ended.is_set()


def test_what_the_disturbed_run_alone_reaches_is_all_of_the_difference(done: Path) -> None:
    kept = load(done / "out" / "governing.nc")
    free = kept.assign(rim_force=0.0 * kept["rim_force"])
    assert float(kept["rim_force"].max()) > 0.0
    assert level_runs._apart(free, kept, "rim_force") == 1.0
    assert level_runs._apart(kept, free, "rim_force") == 1.0
    assert level_runs._apart(free, free, "rim_force") == 0.0


@pytest.mark.parametrize(
    ("script", "words"),
    [
        ("x = 1\nraise ZeroDivisionError('none')", "line 2: ZeroDivisionError: none"),
        ("import sys\nsys.exit(3)", "line 2: SystemExit: 3"),
        ("import sys\nsys.exit(0)", "structure"),  # no model
    ],
)
def test_a_script_that_fails_is_input_that_cannot_be_used(folder, script, words):
    pytest.importorskip("openseespy")
    (folder / "model.py").write_text(script)
    start, end = ASCE.index("[structure]"), ASCE.index("[bearing]")
    kind = '[structure]\nkind = "opensees"\nscript = "model.py"\nbase_nodes = [1]\n'
    (folder / "ops.toml").write_text(ASCE[:start] + kind + ASCE[end:])
    done = run(app, ["check", str(folder / "ops.toml")])
    assert done.exit_code == 2, done.output
    assert words in done.stderr


def test_what_cannot_be_used_ends_with_two(folder: Path) -> None:
    done = run(app, ["check", str(changed(folder, '"180 mm"', "180"))])
    assert done.exit_code == 2
    assert "bearing.capacity = 180" in done.stderr
    assert run(app, ["check", str(folder / "nowhere.toml")]).exit_code == 2


def test_limits_are_refused_before_anything_is_run(folder: Path) -> None:
    for command_ in ("check", "run"):
        done = run(app, [command_, str(changed(folder, '"5 MN"', '"-3 MN"'))])
        assert done.exit_code == 2
        assert "rim_strength = -3e+06 [N] must be at least 1" in " ".join(done.stderr.split())
    given = 'uplift_gap = "20 mm"\nrim_height = "30 mm"\nrims_together = true\nbase_shear = "9 MN"'
    path = changed(folder, 'rim_strength = "5 MN"', given)
    limits = ProjectInputs(read_project(path), folder).limits()
    assert (limits.uplift_gap, limits.rim_height, limits.base_shear) == (0.02, 0.03, 9e6)
    own = '\n[design]\nrim_width = "30 mm"\nmax_base_shear = "12 %"\n'
    path.write_text(path.read_text() + own)
    target = ProjectInputs(read_project(path), folder).target()
    assert (target.rim_width, target.max_base_shear, target.limits.rim_height) == (0.03, 0.12, 0.03)
    assert target.limits.interface_pressure == INTERFACE_PRESSURE


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("interface_friction = 0.18", "interface_friction = inf", "is a plain DCFP"),
        ('capacity = "180 mm"', "capacity = inf", "set the displacement at rim contact"),
    ],
)
def test_devices_that_no_check_judges_are_refused_before_anything_is_run(folder, old, new, words):
    for command_ in ("check", "run"):
        done = run(app, [command_, str(changed(folder, old, new))])
        assert done.exit_code == 2
        assert words in " ".join(done.stderr.split())


def test_check_ends_with_the_documented_codes(folder: Path) -> None:
    """Too little restoring force ends with 1; limits of the procedure that are exceeded do not."""
    done = run(app, ["check", str(folder / "small.toml")])
    assert done.exit_code == 1, done.output
    [line] = [line for line in done.stdout.splitlines() if line.startswith("FAILS")]
    assert "restoring force (upper, MCE_R)" in line
    (folder / "fine.toml").write_text(ASCE.replace("s_m1 = 0.5", "s_m1 = 0.7"))
    fine = run(app, ["check", str(folder / "fine.toml")])
    assert fine.exit_code == 0, fine.output
    assert "does not apply no restrainer contact at the total displacement" in fine.stdout
    assert "FAILS" not in fine.stdout
    assert "will report: pairs of motions: 3 >= 7, ratio 2.33 fails" in " ".join(
        fine.stdout.split()
    )


def test_what_counts_as_uplift_is_of_the_file(folder: Path) -> None:
    said = 'uplift_allowed = true\nleast_gap = "0.2 mm"'
    for text, allowed, gap in (("", False, 1e-3), (f"{said}\n", True, 2e-4)):
        (folder / "gap.toml").write_text(f"{SMALL}\n{text}")
        rules = ProjectInputs(read_project(folder / "gap.toml"), folder).rules()
        assert (rules.uplift_allowed, rules.least_gap) == (allowed, pytest.approx(gap))
