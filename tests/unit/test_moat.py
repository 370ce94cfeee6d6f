"""The clear distance to the moat wall: which displacements it is held against."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tests.scenes import wide_bearing

pytest.importorskip("typer")

from frames import GroundMotion, shear_building, time_histories
from frames.batch.runs import Runs, tagged
from frames.design import CheckError, DesignLimits, ProjectError, code_named
from frames.design.devices.limits import PROJECT_LIMIT
from frames.design.histories.eccentricity import cases_of
from frames.design.histories.slab_corners import farthest_corner
from frames.design.project.check_register import of_the_moat
from frames.design.project.moat_and_dampers import walls_of, with_devices
from frames.design.project.reading import read_project
from frames.design.project.sanity_checks import file_doubts
from frames.design.project.schema_bearing import MoatTable
from frames.design.report.page import Words
from tests.spanish import untold
from tests.unit.test_accidental_eccentricity import PROJECT

BEARING = wide_bearing()


def checked(gap: float | None, code: str, wall: MoatTable | None = None) -> list:
    frame = shear_building(BEARING, 9e4, 4e8, storeys=1, plan=((1, 1), (6.0, 6.0)))
    frame = with_devices(frame, wall, {})
    pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 41))
    motions = {
        name: GroundMotion(x=size * pulse, dt=0.02) for name, size in (("weak", 1.0), ("hard", 1.6))
    }
    data = time_histories(frame, motions, workers=1)
    rules = code_named(code).histories
    bound = SimpleNamespace(bound="lower", allowed_displacement=0.25, displacements=(0.2,) * 4)
    run = SimpleNamespace(
        code=code_named(code),
        frame=frame,
        limits=DesignLimits(moat_gap=gap),
        equivalent=SimpleNamespace(bounds={"lower": bound}),
        rules=rules,
        cases=cases_of(Runs(tagged(data, hazard_level=rules.bearing_level, bound="lower")), rules),
    )
    reached = data["peak_displacement"].to_numpy().max(axis=1)
    force = data["peak_link_force"].to_numpy() if wall else np.zeros((2, 1))
    return [reached, *of_the_moat(run), force.max(axis=1)][: None if wall else -1]


def test_displacements_are_held_against_the_gap() -> None:
    reached, linear, histories, single = checked(0.2, "EN 1998")
    assert (linear.demand, linear.passed) == (0.25, False)
    assert linear.clause == "EN 1998-1 10.5.4"  # the code's displacement; gaps are the project's
    assert histories.clause == single.clause == PROJECT_LIMIT
    assert histories.demand == pytest.approx(1.2 * reached.max(), rel=1e-12)  # two motions: largest
    assert single.demand == pytest.approx(reached.max(), rel=1e-12)
    assert single.trace["D_b"].note == "hard"
    assert single.passed == (reached.max() <= 0.2)
    wide = checked(reached.max() * 1.01, "ASCE 7-22")[1:]
    assert [check.passed for check in wide[1:]] == [True, True]
    tight = checked(reached.max() * 0.99, "ASCE 7-22")[1:]
    assert [check.passed for check in tight[1:]] == [False, False]
    assert all(check.level == "MCE_R" for check in tight)

    note = "the wall is not modelled: results have no force of contact with it"
    assert {check.note for check in (single, wide[2], tight[2])} == {note}


def test_the_slab_past_the_bearings_moves_more() -> None:
    """No rigid motion beats the bound, some come to it; between the bearings there is none."""
    frame = shear_building(BEARING, 9e4, 4e8, storeys=1, plan=((1, 1), (6.0, 6.0)))
    places = np.array([frame.nodes[link.j].position[:2] for link in frame.bearings.values()])
    inside = farthest_corner(frame, np.array([0.2, 0.1, 0.3, 0.2]))
    assert inside.factor == 1.0
    assert "enclose" in inside.note
    level, (x, y) = frame.levels[0], places.max(axis=0)
    z = frame.nodes[level.nodes[0]].z
    frame.add_node("tip", x + 1.5, y + 0.6, z)
    frame._levels[level.name] = replace(level, nodes=(*level.nodes, "tip"))
    ways, turns = np.random.default_rng(5).normal(size=(2, 400, 2))
    turns[:, 1] *= 0.3
    worst, told = 0.0, set()
    for way, (turn, _) in zip(ways, turns, strict=True):
        at = np.vstack([places, (x + 1.5, y + 0.6)])
        moved = np.hypot(*(way + turn * np.column_stack([-at[:, 1], at[:, 0]])).T)
        found = farthest_corner(frame, moved[:-1])
        worst = max(worst, moved[-1] / (found.factor * moved[:-1].max()))
        told |= {found.note}
        assert moved[-1] <= found.factor * moved[:-1].max() * (1.0 + 1e-9)
    assert worst > 0.95
    assert any("node tip of the base" in note for note in told)


def wall_at(gap: float) -> MoatTable:
    return MoatTable(gap=f"{gap} m", stiffness="80 kN/mm", sides=["x+", "x-"])


def test_walls_in_the_model_are_told_of_with_what_they_do() -> None:
    """Forces of the note are those that the histories recorded, node by node."""
    free = checked(0.2, "ASCE 7-22")[0]
    between = free.mean()  # the harder motion reaches it, the weaker one does not
    reached, linear, histories, single, force = checked(between, "ASCE 7-22", wall_at(between))
    assert (force > 0.0).tolist() == [False, True]
    assert between < reached[1] < free[1]  # it is held back
    assert not single.passed
    model = f"walls at {1e3 * between:.5g} mm along x+, x- are modelled"
    assert single.note == (
        f"{model}: contact in 1 of 2 runs, with up to {1e-3 * force.max():.4g} kN at a node; "
        "their force is in the results (links.csv)"
    )
    assert "limit the displacement of 1 of 2 runs" in histories.note
    assert "limit the displacement" not in linear.note  # which has no walls
    far = 1.1 * free.max()
    wide = checked(far, "ASCE 7-22", wall_at(far))
    assert wide[3].passed
    assert wide[3].note.endswith("are modelled: no contact in the runs")
    assert "limit the displacement" not in wide[2].note
    pytest.importorskip("babel")
    words = Words("es", ",")
    for check in (histories, single, *wide[1:4]):
        assert words.say(check.note) != check.note
    assert untold(words) == set()


def test_walls_are_found_in_a_structure() -> None:
    frame = shear_building(BEARING, 9e4, 4e8, storeys=1, plan=((1, 1), (6.0, 6.0)))
    assert walls_of(frame) is None
    found = walls_of(with_devices(frame, wall_at(0.3), {}))
    assert (found.gap, found.sides) == (0.3, ("x+", "x-"))
    assert len(found.links) == 4  # two nodes along each side


@pytest.mark.parametrize(
    ("wall", "clear", "sides", "refused", "doubted"),
    [
        ("450 mm", "450 mm", "", False, False),
        ("450 mm", "600 mm", "", True, False),
        ("450 mm", "400 mm", "", False, True),
        ("450 mm", "400 mm", 'sides = ["x+", "x-", "y+"]\n', False, False),  # a neighbour at y-
    ],
)
def test_two_distances_to_one_wall(tmp_path, wall, clear, sides, refused, doubted):
    file = tmp_path / "project.toml"
    walls = f'[moat]\ngap = "{wall}"\nstiffness = "1 MN/m"\n{sides}'
    file.write_text(PROJECT.replace("[limits]\n", f'{walls}[limits]\nmoat_gap = "{clear}"\n'))
    if refused:
        with pytest.raises(
            ProjectError, match=r"moat_gap = 600 mm must not exceed \[moat\] gap = 450"
        ):
            read_project(file)
        return
    found = [doubt for doubt in file_doubts(read_project(file)) if "moat_gap" in doubt]
    assert bool(found) == doubted
    assert all("400 mm" in doubt and "[moat] gap = 450 mm" in doubt for doubt in found)


def test_without_a_gap_nothing_is_checked_and_odd_gaps_are_refused(tmp_path: Path) -> None:
    assert checked(None, "ASCE 7-22")[1:] == []
    with pytest.raises(CheckError, match="moat_gap = 600"):
        DesignLimits(moat_gap=600.0)
