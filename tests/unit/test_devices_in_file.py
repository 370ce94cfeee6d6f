"""Moat walls and dampers in a project's file: the same links as by hand, laws, refusals, tables."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from frames import Frame, GroundMotion, time_histories, time_history
from frames.batch.runs import Runs
from frames.design import HISTORY_RULES, ProjectError
from frames.design.histories.demand_table import largest_of_links, link_demands
from frames.design.histories.eccentricity import Case
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import inputs_of, preliminary
from frames.design.project.reading import read_project
from frames.design.project.structure_statement import structure_rows
from frames.laws import Gap, ViscousDamper
from tests.unit.test_accidental_eccentricity import PROJECT

STRUCTURE = """[structure]
kind = "moment frame"
bays = [2, 1]
bay_width = ["6 m", "6 m"]
storeys = 2
storey_height = "3 m"
floor_load = "1200 kg/m2"
columns = { box = ["300 mm", "16 mm"], material = "A992" }
beams = { i_shape = ["400 mm", "200 mm", "16 mm", "10 mm"], material = "A992" }
base_beams = { i_shape = ["600 mm", "300 mm", "30 mm", "16 mm"], material = "A992" }
"""
BEFORE, AFTER = PROJECT.split("[structure]")[0], PROJECT[PROJECT.index("[bearing]") :]
MOAT = """[moat]
gap = "60 mm"
stiffness = "80 kN/mm"
damping = "90 kN s/m"
sides = ["x+", "y-"]
"""
DAMPERS = """[dampers.base]
force = "40 kN"
speed = "0.5 m/s"
exponent = 0.5
columns = ["0-0", "2-1"]
directions = ["y"]
[dampers.brace]
force = "60 kN"
speed = "200 mm/s"
stiffness = "30 kN/mm"
between = ["0-0", "1-0"]
storeys = [2, 2]
pattern = "down"
"""
TIME = np.arange(0.0, 2.4, 0.01)
WAVE = 1.8 * np.sin(2.0 * np.pi * TIME / 1.5) * np.exp(-(((TIME - 1.0) / 0.7) ** 2))
PULSE = GroundMotion(x=WAVE, y=-0.6 * WAVE, dt=0.01, name="pulse")


@pytest.fixture(scope="module")
def parts_of(tmp_path_factory, put_example):
    """Return projects of the structure with sections more."""
    folder = put_example(tmp_path_factory.mktemp("devices"))

    def made(more: str) -> ProjectInputs:
        path = folder / "devices.toml"
        path.write_text(BEFORE + STRUCTURE + more + AFTER)
        return ProjectInputs(read_project(path), folder)

    return made


def by_hand(plain: Frame) -> Frame:
    """Put the same walls and dampers in with the verbs of a frame."""
    found = plain.copy()
    east, south = ["base-2-0", "base-2-1"], ["base-0-0", "base-1-0", "base-2-0"]
    for node in ["base-2-0", "base-2-1", "base-0-0", "base-1-0"]:
        laws = {}
        if node in east:
            laws["x+"] = Gap(gap=0.06, stiffness=80e6 / 2, damping=90e3 / 2)
        if node in south:
            laws["y-"] = Gap(gap=0.06, stiffness=80e6 / 3, damping=90e3 / 3)
        found.add_moat("moat", [node], laws)
    law = ViscousDamper(coefficient=40e3 / 0.5**0.5, exponent=0.5)
    for column in ("0-0", "2-1"):
        link = found.bearings[f"bearing-{column}"]
        found.add_link(f"base-{column}-y", link.i, link.j, law, "uy")
    brace = ViscousDamper(coefficient=60e3 / 0.2, stiffness=30e6)
    found.add_link("brace-2-1-0-0-0", "floor-1-1-0", "floor-2-0-0", brace)
    return found


@pytest.fixture(scope="module")
def histories(parts_of: Callable[[str], ProjectInputs]) -> tuple:
    """Return the frame of the file and its histories, and those of the frame by hand."""
    frame = parts_of(MOAT + DAMPERS).frame()
    own = time_history(frame, PULSE, level="pendulum", dt=0.005)
    other = time_history(by_hand(parts_of("").frame()), PULSE, level="pendulum", dt=0.005)
    return frame, own, other


def test_the_same_to_the_bit_as_by_hand(histories: tuple) -> None:
    _, own, other = histories
    assert set(own["link"].to_numpy()) == set(other["link"].to_numpy())
    assert own.sizes["link"] == 8
    for name in ("node_displacement", "bearing_force", "link_force", "link_deformation"):
        second = other[name].sel(link=own["link"]) if "link" in own[name].dims else other[name]
        assert np.array_equal(own[name].to_numpy(), second.to_numpy()), name


def test_forces_are_those_of_the_laws(histories: tuple) -> None:
    """A wall: penetration times stiffness and damping. A damper: its force at its speed."""
    frame, own, _ = histories
    place = {str(name): k for k, name in enumerate(own["node"].to_numpy())}
    u = own["node_displacement"].transpose("time", "node", "dof").to_numpy()
    u = u - u[0]  # walls and dampers come after gravity
    force = own["link_force"].transpose("time", "link")
    wall = force.sel(link="moat-base-2-0-x+").to_numpy()
    into = u[:, place["base-2-0"], 0] - 0.06
    assert wall.max() > 0.0
    assert not wall[into < -1e-6].any()
    deepest = int(into.argmax())  # where it stops, there is no speed
    assert into[deepest] > 1e-3
    assert wall[deepest] == pytest.approx(40e6 * into[deepest], rel=0.02)
    v = np.gradient(u[:, place["base-0-0"], 1], own["time"].to_numpy())
    damper = force.sel(link="base-0-0-y").to_numpy()
    fast = np.abs(v) > 0.3 * np.abs(v).max()
    law = np.sign(v) * 40e3 * (np.abs(v) / 0.5) ** 0.5
    calm = fast & (np.abs(np.gradient(v, own["time"].to_numpy())) < 5.0)  # no impact
    assert calm.sum() > 50
    assert damper[calm] == pytest.approx(law[calm], rel=0.03)
    assert frame.links["brace-2-1-0-0-0"].law.stiffness == 30e6


def test_tables_of_links_are_by_the_runs(histories: tuple) -> None:
    frame, own, _ = histories
    motions = {"pulse": PULSE, "weak": PULSE.scaled(0.5)}
    data = time_histories(frame, motions, level="pendulum", dt=0.005)
    rules = HISTORY_RULES["ASCE 7-22"]
    lower, upper = (
        Case(Runs(d), rules, bound=b) for d, b in ((data, "lower"), (data.isel(run=[1]), "upper"))
    )
    table = link_demands([lower])
    assert set(table["statistic"]) == {"largest of 2 runs"}
    rows = table.set_index("link")
    for link in own["link"].to_numpy():
        size = float(np.abs(own["link_force"].sel(link=link)).max())
        assert rows.loc[str(link), "force [N]"] == pytest.approx(size, rel=1e-9)
        moved = float(np.abs(own["link_deformation"].sel(link=link)).max())
        assert rows.loc[str(link), "deformation [m]"] == pytest.approx(moved, rel=1e-9)
        assert rows.loc[str(link), "motion"] == "pulse"
    assert set(largest_of_links(link_demands([lower, upper]))["bound"]) == {"lower"}
    plain = data.drop_vars([name for name in data.data_vars if "link" in str(name)])
    assert link_demands([Case(Runs(plain), rules)]).empty


@pytest.mark.meant("mm displacement without walls")
def test_what_is_put_in_is_said_and_known(parts_of: Callable[[str], ProjectInputs]) -> None:
    parts = parts_of(MOAT + DAMPERS)
    rows = dict(structure_rows(parts.file, parts.frame()))
    said = "gap 60 mm, 80 kN/mm, 90 kN s/m, at x+, y-"
    assert rows["moat wall along each side"] == said
    assert rows["dampers base"] == "40 kN at 0.5 m/s, exponent 0.5; 0-0, 2-1, along y"
    assert rows["dampers brace"] == (
        "60 kN at 0.2 m/s, exponent 1, 30 kN/mm in series; rising from 1-0 to 0-0, storeys 2 to 2"
    )
    known = preliminary(parts)
    own = inputs_of(parts, known)
    other = parts_of(MOAT.replace("60 mm", "61 mm") + DAMPERS)
    assert own["moat"] != inputs_of(other, known)["moat"]
    assert own["dampers"] == inputs_of(other, known)["dampers"]


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (MOAT.replace('"60 mm"', "60"), "moat.gap = 60 has no unit"),
        (MOAT.replace('"60 mm"', '"-60 mm"'), "moat.gap"),
        (MOAT.replace('"80 kN/mm"', '"80 kN"'), "moat.stiffness"),
        (MOAT.replace('"x+"', '"east"'), "moat.sides"),
        (DAMPERS.replace("exponent = 0.5", "exponent = 3"), "dampers.base.exponent"),
        (DAMPERS.replace('columns = ["0-0", "2-1"]\n', ""), "needs its place"),
        (DAMPERS.replace('pattern = "down"', 'directions = ["x"]'), "directions is for dampers"),
    ],
)
def test_wrong_values_are_refused(parts_of, more, words):
    with pytest.raises(ProjectError) as refused:
        parts_of(more)
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"2-1"', '"9-9"', r"\[dampers.base\] 9-9 is not a column with a bearing: there are 0-0,"),
        ('"2-1"', '"bearing-0-0"', r"\[dampers.base\] .*base-0-0-y"),  # 0-0 once more
        ("storeys = [2, 2]", "storeys = [2, 5]", r"\[dampers.brace\] storeys"),
    ],
)
def test_what_stands_nowhere_is_refused(parts_of, old, new, words):
    with pytest.raises(ProjectError, match=words):
        parts_of(DAMPERS.replace(old, new)).frame()
