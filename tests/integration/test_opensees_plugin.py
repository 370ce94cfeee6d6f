"""Bearings in OpenSees give the answers of `Element` and of `frames`, wherever they stand."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from frames import GroundMotion, gravity, lumped_mass, time_history
from lir_element import BackupSupport, CoulombFriction, Element
from lir_element.opensees import bearing_response
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.opensees_cost import ours, pulse, slender_frame, stepped
from validation.opensees.frames import add_loads, build
from validation.opensees.model import (
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)
from validation.opensees.runs import lumped
from validation.scenes import example_bearing

LEVELS = ("pendulum", "contact")


def follow(stand, element, steps, dt, slips=1e-12):
    """Advance, take `element` along the same motion; the largest difference of forces [N]."""
    ops, away, time = stand.ops, 0.0, 0.0
    for _ in range(steps):
        assert ops.analyze(1, *(() if dt is None else (dt,))) == 0
        time += dt or 0.0
        motion = [np.concatenate([read(1), read(2)]) for read in (ops.nodeDisp, ops.nodeVel)]
        element.set_trial(*motion, time)
        force = ops.eleResponse(1, "force")
        away = max(away, float(np.abs(force - element.resisting_force()).max()))
        element.commit()
        assert np.allclose(bearing_response(1, "slip"), element.response("slip"), atol=slips)
    return away


def push(stand: Any, path: np.ndarray, axis: int = 1) -> None:
    """Prescribe the displacement of node 2 along an axis, a static step a point of the path."""
    ops = stand.ops
    ops.timeSeries("Path", 3, "-dt", 1.0, "-values", 0.0, *path.tolist(), path[-1])
    ops.pattern("Plain", 3, 3)
    ops.sp(2, axis, 1.0)
    stand.solver(handler=("Transformation",))
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")


def round_trip(reach: float, count: int) -> np.ndarray:
    return reach * np.sin(np.linspace(0.0, 2.0 * np.pi, count + 1)[1:])


@pytest.mark.parametrize("level", LEVELS)
def test_static_path_is_that_of_the_element(stand: Any, level: str) -> None:
    stand.build(level=level, fixed=(0, 1, 0, 1, 1, 1))
    element = Element(stand.DEVICE, level)
    stand.gravity()
    # the path of gravity counts: friction, too, has a history
    u = np.zeros(12)
    u[6:9] = stand.ops.nodeDisp(2)[:3]
    element.set_trial(u, np.zeros(12), 0.0)
    element.commit()
    # steps that leave the bearing loaded where its path is steep: without load it is singular
    push(stand, round_trip(0.179, 900))
    # at level contact the steps of gravity leave a trace of some newtons in the points' friction
    limit, slips = (1e-7, 1e-12) if level == "pendulum" else (1e-5, 1e-9)
    assert follow(stand, element, 900, None, slips) < limit * stand.LOAD
    assert np.hypot(*bearing_response(1, "slip")) > 1e-3


@pytest.mark.quick
@pytest.mark.parametrize("level", LEVELS)
def test_transient_is_that_of_the_element(stand: Any, level: str) -> None:
    stand.build(level=level)
    stand.gravity()
    element = Element(stand.DEVICE, level)
    u = np.zeros(12)
    u[6:9] = stand.ops.nodeDisp(2)[:3]
    element.set_trial(u, np.zeros(12), 0.0)
    element.commit()
    stand.shaking(3.6, tolerance=1e-8)
    # in the out-of-process coupling the length of the first step after `loadConst -time` is not
    # known
    limit, slips = (1e-7, 1e-12) if stand.route == "fast" else (1e-4, 1e-9)
    if level == "contact":  # a trace of gravity's steps in the points' friction
        limit, slips = max(limit, 1e-5), max(slips, 1e-9)
    steps = 60 if level == "contact" else 150
    assert follow(stand, element, steps, 0.005, slips) < limit * stand.LOAD


@pytest.mark.parametrize(
    ("level", "plain", "strength"),
    [
        ("pendulum", False, math.inf),
        ("pendulum", True, math.inf),
        ("contact", False, math.inf),
        ("pendulum", True, 6e4),
    ],
)
def test_mass_under_a_pulse_moves_as_in_frames(stand, level, plain, strength):
    """Three components; the rim is met and, without `as_dcfp`, the interface slips."""
    bearing = stand.DEVICE.as_dcfp() if plain else stand.DEVICE
    bearing = replace(bearing, rim_yield_force=strength, rim_overrun=0.05)
    motion = three_pulses(2.8, dt=0.001)
    ours = time_history(lumped_mass(bearing, stand.MASS), motion, dt=motion.dt, level=level)

    def place(tag: int, i: int, j: int) -> None:
        stand.put(tag, i, j, bearing, level=level)

    track = lumped(place, bearing.height, stand.MASS, motion, motion.dt)
    moved = ours["bearing_displacement"].isel(bearing=0).to_numpy()
    force = ours["bearing_force"].isel(bearing=0).to_numpy()
    assert ours["rim_force"].max() > 5e4
    assert (ours["interface_slip_size"].max() > 0.02) is not plain
    bent = float(ours["rim_plastic"].max()) if "rim_plastic" in ours else 0.0
    assert (bent > 2e-3) is (strength == 6e4)
    count = len(moved)
    for mine, theirs in ((track.displacement, moved), (track.force, force)):
        for axis in range(3):
            peak = np.abs(theirs[:, axis]).max()
            assert np.abs(mine[:count, axis]).max() == pytest.approx(peak, rel=1e-3)
    assert np.abs(moved - track.displacement[:count]).max() < 1e-4 * np.abs(moved).max()


@pytest.mark.filterwarnings("ignore:at t = :lir_element.AnalysisWarning")
def test_a_failed_bearing_goes_on_with_its_backup(stand: Any) -> None:
    """It comes down on the stop in OpenSees as in frames, where the last step before is refined."""
    drop = 0.01
    backup = BackupSupport(drop=drop, friction=0.3)
    bearing = replace(stand.DEVICE, slip_capacity=0.01, backup=backup)
    motion = three_pulses(2.8, dt=0.001).with_tail(1.0)
    ours = time_history(lumped_mass(bearing, stand.MASS), motion, dt=motion.dt)
    assert ours.attrs["status"] == "bearing_lost"

    def place(tag: int, i: int, j: int) -> None:
        stand.put(tag, i, j, bearing)

    track = lumped(place, bearing.height, stand.MASS, motion, motion.dt)
    moved = ours["bearing_displacement"].isel(bearing=0).to_numpy()
    last = len(moved) - 1
    load = stand.MASS * STANDARD_GRAVITY
    closed = load / bearing.resolved()["axial_stiffness"]
    assert moved[last, 2] == pytest.approx(-drop - closed, rel=0.01)
    assert track.displacement[last, 2] == pytest.approx(moved[last, 2], rel=0.01)
    plane = np.hypot(*(track.displacement[: last + 1] - moved)[:, :2].T)
    assert plane.max() < 0.02 * np.hypot(*moved[:, :2].T).max()
    assert np.hypot(*track.force[last, :2]) <= 0.3 * np.abs(track.force[last, 2]) * (1.0 + 1e-9)


def three_pulses(peak: float, dt: float) -> GroundMotion:
    t = np.arange(0.0, 1.8, dt)

    def wave(size: float, period: float, length: float) -> np.ndarray:
        window = np.sin(np.pi * np.minimum(t / length, 1.0))
        return size * np.sin(2.0 * np.pi * t / period) * window

    return GroundMotion(x=wave(peak, 1.4, 1.4), y=wave(0.8, 1.1, 2.2), z=wave(0.8, 0.7, 1.4), dt=dt)


def two_dimensional(stand: Any) -> tuple[np.ndarray, np.ndarray]:
    ops = stand.ops
    stand.begin(ndm=2)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, stand.DEVICE.height)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 0, 0, 1)
    ops.mass(2, stand.MASS, stand.MASS, 0.0)
    stand.put(1, 1, 2)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -stand.LOAD, 0.0)
    stand.solver()
    ops.integrator("LoadControl", 0.2)
    ops.analysis("Static")
    assert ops.analyze(5) == 0
    ops.loadConst("-time", 0.0)
    stand.shaking(3.6)
    moved = np.zeros((150, 2))
    for k in range(len(moved)):
        assert ops.analyze(1, 0.005) == 0
        moved[k] = ops.nodeDisp(2)[:2]
    return moved, np.array(ops.eleResponse(1, "force"))


def test_two_dimensions_are_three_in_plane(stand: Any) -> None:
    plane, force = two_dimensional(stand)
    stand.build(height=stand.DEVICE.height)
    stand.gravity()
    stand.shaking(3.6)
    space = stand.run(150, 0.005)
    assert np.allclose(plane, space[:, [0, 2]], rtol=1e-9, atol=1e-11)
    other = np.array(stand.ops.eleResponse(1, "force"))
    # rotations of the plane are about Z, which points against the bearing's y
    assert np.allclose(force[[0, 1, 3, 4]], other[[0, 2, 6, 8]], rtol=1e-8)
    assert np.allclose(force[[2, 5]], -other[[4, 10]], rtol=1e-8, atol=1e-3)


def test_coincident_nodes_and_nodes_apart_agree(stand: Any) -> None:
    runs = []
    for height in (0.0, stand.DEVICE.height):
        stand.build(height=height)
        stand.gravity()
        stand.shaking()
        runs.append(stand.run())
    assert np.array_equal(*runs)


def turned(stand: Any, axes: np.ndarray, orient: tuple[float, ...] | None) -> np.ndarray:
    """Run the mass in a model whose global axes are turned: rows of `axes` are its x, y, z."""
    ops = stand.ops
    stand.begin()
    ops.node(1, 1.0, 2.0, 3.0)
    ops.node(2, *(np.array([1.0, 2.0, 3.0]) + stand.DEVICE.height * axes[2]).tolist())
    ops.fix(1, *[1] * 6)
    ops.fix(2, 0, 0, 0, 1, 1, 1)
    ops.mass(2, *[stand.MASS] * 3, *[0.0] * 3)
    stand.put(1, 1, 2, orient=orient)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, *(-stand.LOAD * axes[2]).tolist(), 0.0, 0.0, 0.0)
    stand.solver()
    ops.integrator("LoadControl", 0.2)
    ops.analysis("Static")
    assert ops.analyze(5) == 0
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Trig", 2, 0.0, 100.0, 1.0)
    ops.pattern("Plain", 2, 2)
    push_along = axes.T @ np.array([0.5 * stand.LOAD, 0.2 * stand.LOAD, 0.0])
    ops.load(2, *push_along.tolist(), 0.0, 0.0, 0.0)
    stand.solver()
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    return stand.run(80, 0.005) @ axes.T


def test_a_turned_model_gives_turned_answers(stand: Any) -> None:
    upright = turned(stand, np.eye(3), None)
    slip = np.array(bearing_response(1, "slip_total"))
    assert np.abs(upright[:, 0]).max() > 0.05
    onto_y = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    third = np.array([2.0, -1.0, 2.0]) / 3.0
    first = np.array([2.0, 2.0, -1.0]) / 3.0
    askew = np.array([first, np.cross(third, first), third])
    for axes, orient in (
        (onto_y, (0.0, 1.0, 0.0)),
        (onto_y, (0.0, 3.0, 0.0, 2.0, 0.0, 0.0)),
        (askew, (*third, *first)),
        (askew, (*(5.0 * third), *(first + 0.3 * third))),
    ):
        moved = turned(stand, axes, tuple(map(float, orient)))
        assert np.allclose(moved, upright, rtol=1e-7, atol=1e-9)
        assert np.allclose(bearing_response(1, "slip_total"), slip, rtol=1e-6, atol=1e-9)


def in_units(stand: Any, metre: float, newton: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Run in other units: lengths of `metre` [m], forces of `newton` [N], time in seconds."""
    ops = stand.ops
    stand.begin()
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, stand.DEVICE.height / metre)
    ops.fix(1, *[1] * 6)
    ops.fix(2, 0, 0, 0, 1, 1, 1)
    ops.mass(2, *[stand.MASS * metre / newton] * 3, *[0.0] * 3)
    stand.put(1, 1, 2, length_unit=metre, force_unit=newton)
    stand.gravity(stand.LOAD / newton, tolerance=1e-9 / metre)
    stand.shaking(3.6 / metre, tolerance=1e-9 / metre)
    moved = stand.run(120, 0.005) * metre
    moments = np.array([newton] * 3 + [newton * metre] * 3)
    force = np.array(ops.eleResponse(1, "force")) * np.concatenate([moments, moments])
    return moved, force, np.array(bearing_response(1, "force"))


def test_other_units_are_the_same_model(stand: Any) -> None:
    moved, force, inside = in_units(stand, 1.0, 1.0)
    others = in_units(stand, 0.001, 1000.0)
    assert np.allclose(others[0], moved, rtol=1e-8, atol=1e-10)
    assert np.allclose(others[1], force, rtol=1e-7, atol=1e-2)
    assert np.allclose(others[2], inside, rtol=1e-7, atol=1e-2)  # SI whatever the model's units


def test_a_load_far_from_the_design_load_is_told(stand: Any, capfd: Any) -> None:
    stand.watch_server()
    words = {1e4: "less than an eighth", 2e7: "more than eight times", 1e6: None}
    for load, word in words.items():
        stand.build()
        stand.gravity(load)
        stand.shaking(0.1)
        stand.run(5)
        text = stand.errors(capfd)
        assert text.count("bearing element 1 carries") == (word is not None)
        if word is not None:
            assert word in text
            assert "its design load, 1e+06 N (1e+06 of the model's units)" in text
            assert "length_unit, force_unit" in text


def test_a_model_whose_vertical_is_another_is_told(stand: Any, capfd: Any) -> None:
    stand.watch_server()
    stand.build(fixed=(0, 0, 0, 1, 1, 1))
    ops = stand.ops
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -stand.LOAD, 0.0, 0.0, 0.0, 0.0)
    stand.solver()
    ops.integrator("LoadControl", 0.2)
    ops.analysis("Static")
    assert ops.analyze(5) != 0
    text = stand.errors(capfd)
    assert "was never in compression along its axis (0, 0, 1)" in text
    assert "orient=(0, 1, 0) if y is vertical" in text
    assert "72 degrees" not in text


@pytest.mark.slow
def test_steps_that_begin_without_a_state_at_the_level_contact() -> None:
    # Newmark's method begins a step at the committed place with velocities turned round: sliders
    # that leave a rim at 0.8 s and stand on an edge have no state there.
    bearing = example_bearing(friction=CoulombFriction(0.065))
    frame = slender_frame((1, 1), 1, bearing)
    load = float(gravity(frame).axial_forces.mean())
    frame = slender_frame((1, 1), 1, replace(bearing, design_load=load))
    with empty_model() as ops:
        add_loads(ops, frame, build(ops, frame, ours("fast", "contact")))
        gravity_analysis(ops)
        ground_motion(ops, pulse())
        solver(ops)
        transient_steps(ops)
        assert ops.analyze(175, 0.005) == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("integrator", "dt", "passes"),
    [
        (("TRBDF2",), 2e-3, True),
        pytest.param(("Newmark", 0.5, 0.25), 1e-3, True, marks=pytest.mark.nightly),
        pytest.param(("Newmark", 0.5, 0.25), 2e-3, False, marks=pytest.mark.nightly),
        pytest.param(("HHT", 0.7), 1e-3, False, marks=pytest.mark.nightly),
    ],
)
def test_integrators_under_strong_impacts(integrator, dt, passes):
    """The advice for the level contact: a frame on four bearings, failed steps halved."""
    bearing = example_bearing(friction=CoulombFriction(0.065))
    frame = slender_frame((1, 1), 1, bearing)
    load = float(gravity(frame).axial_forces.mean())
    frame = slender_frame((1, 1), 1, replace(bearing, design_load=load))
    farthest = 0.0
    with empty_model() as ops:
        built = build(ops, frame, ours("fast", "contact"))
        add_loads(ops, frame, built)
        gravity_analysis(ops)
        ground_motion(ops, pulse().scaled(1.15))
        solver(ops)
        ops.algorithm("KrylovNewton")
        ops.integrator(*integrator)
        ops.analysis("Transient")
        done = True
        for _ in range(round(2.0 / dt)):
            done = stepped(ops, dt)
            if not done:
                break
            farthest = max(farthest, math.hypot(*ops.nodeDisp(built.bases[0])[:2]))
    assert done is passes
    assert not passes or farthest == pytest.approx(0.388, rel=0.005)
