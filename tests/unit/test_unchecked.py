"""What is checked of a code, provision by provision, and that no value of a failed run counts."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("typer")

import xarray as xr
from matplotlib.text import Text
from typer.testing import CliRunner

from frames import time_history
from frames.batch.runs import Runs, tagged
from frames.command.app import app
from frames.command.console import FAILED_CHECKS
from frames.design import Check, Checks, Standing, code_named
from frames.design.codes.analysis import BUILT_IN
from frames.design.codes.code_values import (
    NEEDS,
    NO_CHECK,
    OF_BEARINGS,
    CodeValue,
    checks_of_provision,
    left_to_the_engineer,
    not_checked,
    states_of,
)
from frames.design.project.check_register import Preliminary
from frames.design.project.design_run import (
    ProjectRun,
    evaluate_run,
    from_memory,
    provisions_of,
)
from frames.design.project.inputs import ProjectInputs
from frames.design.project.level_runs import project_runs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.report.figures import VOID_TITLE, motions_figure
from frames.design.report.page import Words
from frames.design.report.result_tables import run_tables
from frames.results.recorded import is_of_all_steps
from tests.spanish import untold

CODES = {
    "ASCE 7-22": "s_ms = 1.2\ns_m1 = 0.6\n",
    "EN 1998": 'a_g = "3.4 m/s2"\nground_type = "B"\n',
    "NCh2745": 'soil = "II"\nzone = 3\n',
}
ABOVE = "[superstructure]\nR = 4\n"
WHOLE = '[superstructure]\nR = 4\nwind_shear = "30 kN"\nservice_displacement = "10 mm"\n'
STICK = """[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["6 m", "6 m"]
storey_mass = ["90 t"]
storey_stiffness = ["400 kN/mm"]
storey_height = "3 m"
"""
FRAME = """[structure]
kind = "moment frame"
bays = [1, 1]
bay_width = ["6 m", "6 m"]
storeys = 1
storey_height = "3 m"
floor_load = "2500 kg/m2"
columns = { box = ["300 mm", "12 mm"], material = "A992" }
beams = { i_shape = ["400 mm", "200 mm", "20 mm", "12 mm"], material = "A992" }
"""
WALLS = 'walls = [{ between = ["0-0", "1-0"], thickness = "200 mm", material = "C30/37" }]\n'
SCRIPT = """[structure]
kind = "opensees"
script = "model.py"
base_nodes = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
length_unit = "1 mm"
force_unit = "1 kN"
"""
DAMPERS = '[dampers.base]\nforce = "20 kN"\nspeed = "0.5 m/s"\ncolumns = ["0-0"]\n'
MOAT = '[moat]\ngap = "450 mm"\nstiffness = "80 kN/mm"\n'
LIMITS = """[limits]
rim_strength = "3 MN"
interface_pressure = "90 MPa"
liner_pressure = "90 MPa"
moat_gap = "400 mm"
drift = "1 %"
base_shear = "5 MN"
floor_acceleration = "9 m/s2"
axial_force = "9 MN"
uplift_gap = "20 mm"
displacement_left = "100 mm"
lateral_force = "5 MN"
"""
KINDS = {
    "stick, all given": STICK + WHOLE + LIMITS,
    "frame, nothing given": FRAME,
    "frame with walls": FRAME + WALLS + ABOVE + LIMITS,
    "imported": SCRIPT + ABOVE,
    "dampers and moat": FRAME + ABOVE + DAMPERS + MOAT,
}
COUNTS = {
    "stick, all given": {"ASCE 7-22": (30, 2, 15), "EN 1998": (29, 3, 14), "NCh2745": (24, 5, 11)},
    "frame, nothing given": {
        "ASCE 7-22": (16, 16, 15),
        "EN 1998": (17, 15, 14),
        "NCh2745": (12, 17, 11),
    },
    "frame with walls": {"ASCE 7-22": (27, 5, 16), "EN 1998": (26, 6, 15), "NCh2745": (21, 8, 12)},
    "imported": {"ASCE 7-22": (17, 15, 15), "EN 1998": (16, 16, 14), "NCh2745": (11, 18, 11)},
    "dampers and moat": {
        "ASCE 7-22": (22, 10, 16),
        "EN 1998": (21, 11, 15),
        "NCh2745": (16, 13, 12),
    },
}
"""Provisions by structure and code: checked, not checked, the engineer's."""
DAILY = {
    *itertools.product(["stick, all given"], CODES),
    *zip(list(KINDS)[1:], [*CODES, "ASCE 7-22"], strict=True),
}
"""All codes for one structure, one for each other; the rest is for the night."""
REST = """
[bearing]
radius = "1.5 m"
slider_height = "200 mm"
slider_radius = "0.2 m"
capacity = "180 mm"
friction = 0.05
interface_friction = 0.15
[motions]
folder = "motions"
scale = 1.0
[bounds]
friction = [0.8, 1.3]
[analysis]
level = "pendulum"
bounds = ["lower"]
"""


@pytest.fixture(scope="module")
def kinds(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Any]:
    """Structures' folders by name, each with one short run that stands for all of its runs."""
    return cache(lambda name: made(name, tmp_path_factory.mktemp("kind")))


def made(name: str, folder: Path) -> Any:
    """Write a project for each code; run the histories of one motion once."""
    motions = folder / "motions"
    motions.mkdir()
    time = np.arange(0.0, 1.5, 0.01)
    np.savetxt(motions / "x.txt", 1.2 * np.sin(2.0 * math.pi * time / 1.5))
    (motions / "motions.csv").write_text(
        "name,x,y,dt,unit,near_fault\npulse,x.txt,x.txt,0.01,m/s2,yes\n"
    )
    model = Path(__file__).parents[1] / "golden" / "projects" / "model.py"
    (folder / "model.py").write_text(model.read_text())
    for code, spectrum in CODES.items():
        about = f'[project]\nname = "{name}"\ncode = "{code}"\n'
        text = f"{about}{KINDS[name]}[spectrum]\n{spectrum}{REST}"
        (folder / f"{code}.toml").write_text(text)
    parts, known = opened(folder, "EN 1998")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = project_runs(parts, replace(known, moved={}), None).data
        governing = time_history(known.frame, known.motions["pulse"], level="pendulum")
    noise = {f"noise_{key}": 0.0 for key in ("displacement", "base_shear", "rim_force", "slip")}
    assert data["status"].to_numpy().tolist() == ["ok"]
    history = governing.assign_attrs(noise)
    return SimpleNamespace(folder=folder, data=data, history=history)


def opened(folder: Path, code: str) -> tuple[ProjectInputs, Preliminary]:
    """Read a project, with what needs no time history."""
    parts = ProjectInputs(read_project(folder / f"{code}.toml"), folder)
    return parts, known_of(folder, code)


@cache
def known_of(folder: Path, code: str) -> Preliminary:
    """What a project needs no time history for: computed once."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return preliminary(ProjectInputs(read_project(folder / f"{code}.toml"), folder))


def seven(data: xr.Dataset) -> xr.Dataset:
    """Return seven runs of a suite, of which each reached a little more than the one before."""
    found = data.isel(run=[0] * 7).assign_coords(motion=("run", [f"pulse {k}" for k in range(7)]))
    return scaled(found, 1.0 + 0.01 * np.arange(7))


def scaled(data: xr.Dataset, factors: np.ndarray) -> xr.Dataset:
    """Return runs that reached so many times as much."""
    by = xr.DataArray(factors, dims="run")
    reached = {n: v for n, v in data.data_vars.items() if is_of_all_steps(n)}
    numbers = {n: v for n, v in reached.items() if v.dtype == float and "run" in v.dims}
    return data.assign({n: (v * by).transpose(*v.dims) for n, v in numbers.items()})


def judged(kind, parts, known, data, moved=None):
    """Evaluate runs at all levels of a code; with moved masses four of the first motion."""
    ways = {"mass_shift": ("run", ["+x", "-x", "+y", "-y"])}
    moved = (data.isel(run=[0] * 4) if moved is None else moved).assign_coords(ways)
    every = (data, moved) if known.moved else (data,)
    runs = [
        tagged(one, hazard_level=level.name, bound="lower")
        for level in parts.rules().levels
        for one in every
    ]
    return evaluate_run(parts, known, Runs(*runs), kind.history)


@pytest.mark.parametrize(
    ("name", "code"),
    [
        pytest.param(*pair, marks=[] if pair in DAILY else pytest.mark.nightly)
        for pair in itertools.product(KINDS, CODES)
    ],
)
def test_every_provision_is_checked_or_says_why_not(kinds, name, code):
    """Whichever structure: each is made, or named with its reason; no check is without one."""
    if name == "imported":
        pytest.importorskip("openseespy")
    kind = kinds(name)
    parts, known = opened(kind.folder, code)
    run = judged(kind, parts, known, seven(kind.data))
    assert [one.what for one in run.provisions if NO_CHECK in one.how] == []
    asked = (*parts.code().provisions, *OF_BEARINGS)
    cited = [c for c in (*run.checks, *known.checks) if not c.clause.startswith("no code")]
    of_code = [c for c in cited if "docs/theory" not in c.clause]
    unnamed = {c.title for c in of_code if not any(checks_of_provision(p, [c]) for p in asked)}
    assert unnamed == set()
    before = provisions_of(parts, known, (), is_run=False)  # as `lir check` has it
    by_name = {one.what: one for one in asked}
    for one, later in zip(before, run.provisions, strict=True):
        made_of = checks_of_provision(by_name[one.what], run.checks)
        blind = any("not evaluated" in check.title for check in made_of)
        assert one.state == later.state or blind, one.what
    held = [check for check in (*run.checks, *known.checks) if check.verdict == "ok"]
    assert all(math.isfinite(check.demand) and math.isfinite(check.limit) for check in held)
    words = Words("es", ",")
    for one in run.provisions:
        assert words.say(one.what) != one.what
        words.say(one.how)
    assert untold(words) == set()
    counts = tuple(
        sum(one.state == word for one in run.provisions)
        for word in ("checked", "not checked", "yours")
    )
    assert len(not_checked(run.provisions)) == counts[1]
    assert len(left_to_the_engineer(run.provisions)) == counts[2]
    assert counts == COUNTS[name][code]


def test_the_clear_distance_is_checked_before_any_run(kinds: Callable[[str], Any]) -> None:
    """100 mm for what bearings must allow: `lir check` fails; what is not checked is printed."""
    folder = kinds("stick, all given").folder
    parts, known = opened(folder, "ASCE 7-22")
    title = "clearance to the moat wall, equivalent-linear"
    room = [check for check in known.checks if check.title == title]
    allowed = [each.allowed_displacement for each in known.equivalent.bounds.values()]
    assert [(c.demand, c.limit) for c in room] == [(value, 0.4) for value in allowed]
    assert all(c.clause == "ASCE 7-22 17.2.5.2" for c in room)
    text = (folder / "ASCE 7-22.toml").read_text().replace('"400 mm"', '"100 mm"')
    (folder / "narrow.toml").write_text(text)
    done = CliRunner().invoke(app, ["check", str(folder / "narrow.toml")])
    said = " ".join(done.output.split())
    assert done.exit_code == FAILED_CHECKS
    assert f"FAILS {title} (lower, MCE_R): {1e3 * allowed[0]:.4g} mm <= 100 mm" in said
    assert "of 47 provisions are checked here or by lir run" in said
    for sentence in not_checked(provisions_of(parts, known, (), is_run=False)):
        assert sentence in said


def failing(kind: Any, code: str, case: str, share: float) -> tuple[ProjectRun, str]:
    """Return a project's run of which a run failed, after it reached a share of its values."""
    parts, known = opened(kind.folder, code)
    data, word = seven(kind.data), "bearing_lost" if case == "lost" else "slip_exceeded"
    if case == "allowed":
        rules = replace(parts.rules(), unacceptable_allowed=1)
        parts.rules = lambda: rules  # type: ignore[method-assign]
    moved = data.isel(run=[0] * 4)
    which = data if case != "moved" else moved
    places = np.arange(which.sizes["run"])
    gone = places == (0 if case == "moved" else 6)
    gone |= case == "all"
    made = scaled(which, np.where(gone, share, 1.0))
    status = np.where(gone, word, which["status"].to_numpy())
    made = made.assign(
        status=("run", status.astype(object)),
        failed_at=("run", np.where(gone, 0.7, math.nan)),
        failed_where=("run", np.where(gone, "bearing-0-0", "").astype(object)),
    )
    data, moved = (data, made) if case == "moved" else (made, moved)
    return judged(kind, parts, known, data, moved=moved), word


@pytest.mark.parametrize(
    ("name", "code", "case"),
    [
        ("stick, all given", "ASCE 7-22", "one"),
        ("stick, all given", "ASCE 7-22", "allowed"),
        ("stick, all given", "EN 1998", "moved"),
        pytest.param("stick, all given", "NCh2745", "lost", marks=pytest.mark.nightly),
        pytest.param("dampers and moat", "ASCE 7-22", "one", marks=pytest.mark.nightly),
        ("dampers and moat", "NCh2745", "all"),
    ],
)
def test_no_check_and_no_table_takes_a_value_of_a_failed_run(kinds, name, code, case):
    """Whatever changes with the values of the failed run is void, or bears its mark."""
    (run, word), (other, _) = (failing(kinds(name), code, case, share) for share in (1.0, 0.4))
    changed = []
    for check, twin in zip(run.checks, other.checks, strict=True):
        assert (check.title, check.bound) == (twin.title, twin.bound)
        if (check.demand, check.limit) != (twin.demand, twin.limit):
            changed.append(check.title)
            assert check.void, check
            assert check.verdict == "no value"
    assert len(changed) >= (0 if case in {"allowed", "moved"} else 3)
    tables, twins = ({**run_tables(each), "demands": each.demands} for each in (run, other))
    marked = 0
    for title in tables:
        one, two = (each[title].reset_index().map(str) for each in (tables, twins))
        differs = np.zeros(0, dtype=bool) if one.empty else (one != two).any(axis=1).to_numpy()
        for row, twin_row in zip(one[differs].to_numpy(), two[differs].to_numpy(), strict=True):
            marked += 1  # in whichever of both the value is that of the failed run
            cells = {*row, *twin_row}
            assert any("failed" in cell or word in cell for cell in cells), (title, row)
    assert marked > 10
    if case == "one":
        texts = {text.get_text() for text in motions_figure(run).findobj(Text)}
        assert VOID_TITLE in texts


def test_values_from_memory_are_named_with_their_clause() -> None:
    known = CodeValue("A 1", "one", Standing("agrees", "C 3"))
    code = replace(
        code_named("ASCE 7-22"), values={"one": known, "two": CodeValue("B 2", "two, of three")}
    )
    (sentence,) = from_memory(code)
    assert sentence == "from memory, not read in the standard: B 2 (two, of three)"
    assert from_memory(replace(code, values={"one": known})) == ()
    for name in ("ASCE 7-22", "EN 1998", "NCh2745"):
        assert "(of the whole structure, safety 1.0)" in from_memory(code_named(name))[0]


@pytest.mark.parametrize("relation", ["<=", ">="])
def test_an_infinite_bound_is_never_ok_with_a_number(relation: Any) -> None:
    """Nothing is compared: it says that there is no limit, in tables and sentences."""
    demand, limit = (0.208, math.inf) if relation == "<=" else (math.inf, 0.208)
    check = Check(
        clause="A 1", title="displacement", demand=demand, limit=limit, unit="m", relation=relation
    )
    assert (check.verdict, check.passed, check.said[2]) == ("no limit", True, "-")
    assert "inf" not in f"{check} {check.said} {Checks([check])}"
    assert Checks([check]).tally == "1 checks, 0 failed, 1 without a limit"
    assert "ok" not in str(Checks([check]))
    beyond = replace(check, demand=limit, limit=demand)
    assert beyond.verdict == "FAILS"


def test_provisions_of_a_structure_that_yields_are_for_it_alone() -> None:
    """Facts choose; what a project lacks is the first of its needs; an unmade check is named."""
    every = [one for code in BUILT_IN for one in (*code.provisions, *OF_BEARINGS)]
    assert {need for one in every for need in one.needs} == {*NEEDS}
    assert {one.only for one in every if one.only} == {"walls", "dampers", "yields"}
    hinges = [one for one in OF_BEARINGS if one.only == "yields"]
    (state,) = states_of(hinges, {"yields"}, ())
    assert state.said == (
        "rotation of plastic hinges and ductility of links: not checked, because no limit can be "
        "set for them"
    )
    assert states_of(hinges, {"walls"}, ()) == ()
    (free,) = states_of(OF_BEARINGS[:1], (), ())
    assert free.how == NO_CHECK
