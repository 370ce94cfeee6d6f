"""Overturning of a stick by statics, and models whose bearings do not follow it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, gravity, lumped_mass, moment_frame, shear_building
from frames.design import IsolationSystem
from frames.statics.overturning import overturning_share, unknown_axial_forces
from lir_element import CoulombFriction
from tests.scenes import large_bearing

Array = npt.NDArray[np.float64]

BEARING = large_bearing(design_load=5e5)
PLAN = ((2, 1), (6.0, 5.0))
MASS, STIFFNESS, HEIGHT = 5e4, 8e7, 3.5
G = 9.80665


def stick(**options: object) -> Frame:
    given: dict[str, object] = {"plan": PLAN, "storeys": 3, "storey_height": HEIGHT}
    return shear_building(BEARING, MASS, STIFFNESS, **(given | options))  # type: ignore[arg-type]


def at_rest(frame: Frame) -> tuple[Array, Array, Array]:
    """Return axial forces [N], places (n, 2) [m], moments of all upper ends about y and -x [N m].

    Upper plates tilt with the base, and slide on their spheres as they do: friction resists that,
    and carries some 1e-3 of an overturning moment.
    """
    nodes = [frame.nodes[link.j] for link in frame.bearings.values()]
    state = gravity(frame)
    ends = np.array(state.run.old["force"])[:, 9:11].sum(axis=0)
    places = np.array([(node.x, node.y) for node in nodes])
    return np.array(state.axial_forces), places, np.array([ends[1], -ends[0]])


@pytest.mark.parametrize("share", [(0.0, 0.0), (0.03, 0.0), (0.1, -0.05), (0.0, 0.12)])
def test_loads_of_bearings_stand_under_the_eccentric_masses(share: tuple[float, float]) -> None:
    loads, places, ends = at_rest(stick(eccentricity=share))
    weight = 4.0 * MASS * G
    off = np.array(share) * [12.0, 5.0]
    assert_allclose(loads.sum(), weight, rtol=1e-6)
    assert_allclose((loads @ places + ends) / weight, off, rtol=1e-6, atol=1e-6)
    rigid = 1.0 + places @ (off / (places**2).mean(axis=0))
    assert_allclose(loads, weight / 6.0 * rigid, rtol=1e-3)


def test_an_overturning_moment_goes_by_the_distance_from_the_middle() -> None:
    plain, places, _ = at_rest(stick())
    for along, axis in (("x", 0), ("y", 1)):
        frame = stick()
        force = np.zeros(6)
        force[axis] = 20e3  # 1 % of the weight: friction holds
        frame.add_load("floor-2", force.tolist())
        loads, _, ends = at_rest(frame)
        moment = force[axis] * 2.0 * HEIGHT
        levers = places[:, axis]
        moment -= ends[axis]
        expected = moment * levers / (levers**2).sum()
        assert_allclose(loads - plain, expected, rtol=2e-3, atol=1.0, err_msg=along)


def test_beams_and_columns_resist_that_a_bearing_leaves_the_plane_of_the_others() -> None:
    """One bay, pushed down at two corners across and up at the others, in closed form."""
    bending, side, stiff, axial = 3e10, 6.0, 100.0 * STIFFNESS, 5e9
    # without friction plates hold the base's nodes by N R alone, 1e-4 of what columns do
    smooth = replace(BEARING, axial_stiffness=axial, friction=CoulombFriction(1e-9))
    frame = shear_building(
        smooth,
        MASS,
        stiff,
        storeys=3,
        storey_height=HEIGHT,
        plan=((1, 1), side),
        base_stiffness=bending,
    )
    push = 2e4
    for ix in (0, 1):
        for iy in (0, 1):
            frame.add_load(f"base-{ix}-{iy}", [0.0, 0.0, push * (-1.0) ** (ix + iy), 0, 0, 0])
    loads, places, _ = at_rest(frame)
    held = stiff * HEIGHT**2 / (3.0 * 4.0)  # 4 E I / h of a column
    turned = 6.0 * bending / side
    beams = 2.0 * 24.0 * bending / side**3 * held / (held + turned)
    share = axial / (axial + beams)
    expected = loads.mean() - push * share * np.sign(places[:, 0] * places[:, 1])
    assert_allclose(loads, expected, rtol=1e-4)
    assert 0.2 < share < 0.98  # beams and columns count here, and so do the bearings


def test_base_stiffness_is_for_a_base_that_tilts() -> None:
    for options in ({"plan": None}, {"overturning": False}):
        with pytest.raises(ModelError, match=r"base_stiffness = 100000000.0 has no effect"):
            stick(base_stiffness=1e8, **options)
    with pytest.raises(ModelError, match=r"base_stiffness \[N m2\] = -1"):
        stick(base_stiffness=-1.0)


def test_storeys_deform_by_their_shear_alone() -> None:
    """Periods over held bearings are those of the stick that does not tilt."""
    tilting, level = (gravity(stick(overturning=own)).held_periods for own in (True, False))
    assert_allclose(
        tilting[:12], level[:12], rtol=1e-5
    )  # then those of the ties, which yield a little


def without_roof() -> Frame:
    frame = moment_frame((2, 2), 3, bearing=BEARING)
    for node in frame.levels[-1].nodes:
        frame.fix(node, "uz")
    return frame


def plane() -> Frame:
    frame = moment_frame((2, 1), 2, bearing=BEARING)
    for node in frame.nodes:
        frame.fix(node, "uy", "rx", "rz")
    return frame


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (stick, ""),
        (lambda: moment_frame((2, 1), 2, bearing=BEARING, eccentricity=(0.05, 0.05)), ""),
        (plane, ""),
        (lambda: lumped_mass(BEARING, MASS), ""),
        (lambda: lumped_mass(BEARING, MASS, inertia=(1e5, 1e5, 1e5)), ""),
        (lambda: stick(overturning=False), "resist only 0 % of the overturning moment"),
        (lambda: stick(plan=None), "the model has one bearing"),
    ],
)
def test_whether_bearings_follow_overturning_is_told_by_the_model(make, words):
    found = unknown_axial_forces(make())
    assert words in found
    assert bool(found) == bool(words)


@pytest.mark.filterwarnings("ignore::frames.ModelWarning")  # the roof's supports carry weight
def test_supports_of_the_roof_take_their_share_of_the_moment() -> None:
    share = overturning_share(gravity(without_roof()).system)
    assert 0.0 < share.x < 0.9
    assert share.x == pytest.approx(share.y, rel=1e-9)
    assert f"resist only {100.0 * min(share.x, share.y):.3g} % of" in share.sentence()


@pytest.mark.filterwarnings("ignore::frames.ModelWarning")  # the roof's supports carry weight
def test_the_share_of_the_moment_does_not_depend_on_the_origin() -> None:
    """Supports on one side take weight, so that the bearings' forces have a sum."""
    frame = moment_frame((2, 1), 3, bearing=BEARING)
    for node in frame.levels[-1].nodes:
        if frame.nodes[node].x > 7.0:
            frame.fix(node, "uz")
    system = gravity(frame).system
    away = replace(system, coordinates=system.coordinates + np.array([100.0, -50.0, 0.0]))
    assert_allclose(overturning_share(away)[:2], overturning_share(system)[:2], rtol=1e-9)


def test_the_centre_of_mass_is_that_of_the_masses_whatever_the_loads_say() -> None:
    for level in (True, False):
        system = IsolationSystem.from_frame(stick(eccentricity=(0.03, 0.3), overturning=level))
        assert system.centre_of_mass == pytest.approx((0.36, 1.5), rel=1e-12)
        centre = np.array(system.loads) @ np.array(system.positions) / sum(system.loads)
        assert_allclose(centre, [0.36, 1.5] if level else 0.0, rtol=2e-3, atol=1e-6)
        assert bool(system.unknown_loads) != level
    steel = moment_frame((2, 1), 2, bearing=BEARING, eccentricity=(0.05, 0.02))
    framed = IsolationSystem.from_frame(steel)
    centre = np.array(framed.loads) @ np.array(framed.positions) / sum(framed.loads)
    assert framed.centre_of_mass is not None
    assert_allclose(centre, framed.centre_of_mass, rtol=1e-3)
    assert math.hypot(framed.centre_of_mass[0] - 6.0, framed.centre_of_mass[1] - 3.0) > 0.3
