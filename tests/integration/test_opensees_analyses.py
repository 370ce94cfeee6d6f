"""Bearings in OpenSees under its analyses: integrators, algorithms, constraints, time, removal."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lir_element import Element, FrictionHeating
from lir_element.opensees import (
    RouteWarning,
    bearing_response,
    bearing_tags,
    plugin,
    record_bearings,
)

REFERENCE: dict[str, np.ndarray] = {}


def shaken(stand: Any, steps: int = 100, dt: float = 0.01, **options: Any) -> np.ndarray:
    stand.build()
    stand.gravity()
    stand.shaking(2.8, **options)
    return stand.run(steps, dt)


@pytest.fixture
def reference(stand: Any) -> np.ndarray:
    """Newmark and Newton, of the same route."""
    if stand.route not in REFERENCE:
        REFERENCE[stand.route] = shaken(stand)
        assert np.abs(REFERENCE[stand.route][:, 0]).max() > 0.05
    return REFERENCE[stand.route]


def off(moved: np.ndarray, reference: np.ndarray) -> float:
    """Largest difference, of the peak."""
    return float(np.abs(moved - reference).max() / np.abs(reference).max())


# Transient integrators of OpenSees: at which time displacement and velocity are tried, and when the
# time is set, differs by family (source: newStep, update, commit of its SRC/analysis/integrator)
IMPLICIT: dict[str, tuple[float, ...]] = {
    # tried at the end of the step, with its time
    "Newmark": (0.5, 0.25),
    "Newmark1": (0.5, 0.25),
    "NewmarkHSFixedNumIter": (0.5, 0.25),
    "NewmarkHSIncrLimit": (0.5, 0.25, 0.1),
    "NewmarkHSIncrReduct": (0.5, 0.25, 1.0),
    "TRBDF2": (),
    "TRBDF3": (),
    "Houbolt": (),
    "BackwardEuler": (),
    # tried within the step, and at its end with the time of that
    "HHT": (0.7,),
    "HHT_TP": (0.7,),
    "HHTGeneralized": (0.5,),
    "HHTGeneralized_TP": (0.5,),
    "GeneralizedAlpha": (0.8, 0.7),
    # the same, but the nodes move to the end without a trial
    "HHTHSFixedNumIter": (0.5,),
    "HHTHSFixedNumIter_TP": (0.5,),
    "HHTHSIncrLimit": (0.5, 0.1),
    "HHTHSIncrLimit_TP": (0.5, 0.1),
    "HHTHSIncrReduct": (0.5, 1.0),
    "HHTHSIncrReduct_TP": (0.5, 1.0),
    # tried beyond the step
    "WilsonTheta": (1.4,),
    "Collocation": (1.4,),
    "CollocationHSFixedNumIter": (1.4,),
    "CollocationHSIncrLimit": (1.4, 0.1),
    "CollocationHSIncrReduct": (1.4, 1.0),
    "GimmeMCK": (1.0, 1.0, 1.0),  # no step at all
}
EXPLICIT: dict[str, tuple[float, ...]] = {
    # the time is set after the trial
    "CentralDifference": (),
    "CentralDifferenceAlternative": (),
    "CentralDifferenceNoDamping": (),
    # before it
    "ExplicitDifference": (),
    "NewmarkExplicit": (0.5,),
    # tried within the step, and the nodes move to its end without a trial
    "HHTExplicit": (0.7,),
    "HHTExplicit_TP": (0.7,),
    "HHTGeneralizedExplicit": (0.5, 0.5),
    "HHTGeneralizedExplicit_TP": (0.5, 0.5),
    "KRAlphaExplicit": (0.5,),
    "KRAlphaExplicit_TP": (0.5,),
    "AlphaOS": (0.8,),
    "AlphaOS_TP": (0.8,),
    "AlphaOSGeneralized": (0.5,),
    "AlphaOSGeneralized_TP": (0.5,),
}
SHOWN = {"HHT", "HHTHSFixedNumIter", "WilsonTheta", "CentralDifferenceAlternative", "AlphaOS"}
"""One of each family that needs care: out of process by the day, the others at night."""
STILL = {"GimmeMCK", "CentralDifference", *(n for n in IMPLICIT if n.endswith("_TP"))}
"""Of a mass on an elastic spring they do not continue the velocity that it begins with, either."""


def thrown(stand: Any, name: str, level: Any, dt: float, end: float = 0.04) -> tuple[Any, float]:
    """Throw the mass across a rim near by; returns its recording and where it ends [m].

    A replay, the element alone, goes through the displacements, velocities and times of the node.
    """
    device = replace(stand.DEVICE, capacity=0.02, friction_heating=FrictionHeating())
    ops, alone = stand.ops, Element(device, level)
    stand.build(device, level=level)
    stand.gravity(steps=1)

    def follow() -> list[Any]:
        motion = [np.concatenate([np.zeros(6), each(2)]) for each in (ops.nodeDisp, ops.nodeVel)]
        alone.set_trial(*motion, ops.getTime())
        alone.commit()
        return [np.array(alone.response(each)) for each in ("temperature", "force", "slip_total")]

    follow()
    ops.setNodeVel(2, 1, 0.9, "-commit")
    stand.solver(algorithm="Linear" if name in EXPLICIT else "Newton")
    if "FixedNum" in name:
        ops.test("FixedNumIter", 10)
    ops.integrator(name, *{**IMPLICIT, **EXPLICIT}[name])
    ops.analysis("Transient")
    recording, replayed = record_bearings(), []
    for _ in range(round(end / dt)):
        assert ops.analyze(1, dt) == 0
        replayed.append(follow())
    data = recording.dataset().isel(bearing=0)
    if name != "GimmeMCK":
        assert_allclose(data["time"], dt * np.arange(1, len(replayed) + 1))
    for place, variable in enumerate(("temperature", "bearing_force", "interface_slip")):
        expected = np.array([each[place] for each in replayed])
        if variable == "bearing_force":
            expected = expected[:, 6:9]
        assert_allclose(data[variable], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    assert bearing_response(1, "time") == pytest.approx(ops.getTime())
    return data, ops.nodeDisp(2, 1)


@pytest.mark.parametrize(
    ("stand", "name"),
    [
        pytest.param(
            route,
            name,
            marks=[pytest.mark.nightly] if route == "portable" and name not in SHOWN else [],
        )
        for route in ("fast", "portable")
        for name in (*IMPLICIT, *EXPLICIT)
    ],
    indirect=["stand"],
)
def test_each_integrator_gets_the_rates_of_its_committed_motion(stand: Any, name: str) -> None:
    """By both levels and two steps: friction by velocity, its heat, rims and slip."""
    for level in ("pendulum", "contact"):
        for dt in (4e-4, 2e-4) if name in EXPLICIT else (2e-3, 1e-3):
            data, end = thrown(stand, name, level, dt)
            if name not in STILL:
                assert end == pytest.approx(0.0353, rel=0.01)
                assert np.hypot(*bearing_response(1, "slip")) == pytest.approx(0.015, rel=0.03)
                assert data["temperature"].max() == pytest.approx(111.0, rel=0.04)


def test_without_access_to_opensees_a_doubtful_clock_is_told(stand, monkeypatch, recwarn):
    """Its remedy, another integrator, is silent and right."""
    if stand.route == "fast":
        pytest.skip("it has the access")
    monkeypatch.setattr(plugin, "why_not_fast", lambda: "tried")
    monkeypatch.setattr(plugin, "restart_reads", lambda **_: None)
    moved = {}
    for name in ("HHT", "Newmark", "TRBDF2"):
        moved[name] = shaken(stand, 60, integrator=(name, *IMPLICIT[name]))
        if name == "HHT":
            with pytest.warns(
                RouteWarning, match="element 1: .* Use the integrator Newmark or TRBDF"
            ):
                bearing_response(1, "slip")
        recwarn.clear()
        bearing_response(1, "slip")
        assert not recwarn.list
    assert off(moved["TRBDF2"], moved["Newmark"]) < 0.03


@pytest.mark.parametrize(
    "algorithm", ["ModifiedNewton", "NewtonLineSearch", "KrylovNewton", "BFGS", "Broyden"]
)
def test_algorithms(stand: Any, reference: np.ndarray, algorithm: str) -> None:
    moved = shaken(stand, algorithm=algorithm, tolerance=1e-8, iterations=500)
    assert off(moved, reference) < 1e-3


@pytest.mark.parametrize(
    "handler", [("Transformation",), ("Penalty", 1e14, 1e14), ("Lagrange",)], ids=lambda h: h[0]
)
def test_constraint_handlers(stand: Any, reference: np.ndarray, handler: tuple[Any, ...]) -> None:
    # the multipliers of Lagrange are forces: a norm of displacements would count them
    moved = shaken(stand, handler=handler, test="EnergyIncr", tolerance=1e-11)
    assert off(moved, reference) < 1e-3


def pushed(stand: Any, integrator: tuple[Any, ...], steps: int) -> np.ndarray:
    """Push sideways from rest under gravity; displacement and force of each step."""
    ops = stand.ops
    stand.build(fixed=(0, 1, 0, 1, 1, 1))
    stand.gravity()
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(2, stand.LOAD, 0.0, 0.0, 0.0, 0.0, 0.0)
    stand.solver()
    ops.integrator(*integrator)
    ops.analysis("Static")
    track = []
    for _ in range(steps):
        assert ops.analyze(1) == 0
        track.append((ops.nodeDisp(2, 1), ops.eleForce(1, 7), ops.getTime()))
    return np.array(track)


def test_static_integrators_find_the_same_path(stand: Any) -> None:
    by_displacement = pushed(stand, ("DisplacementControl", 2, 1, 1e-3), 100)
    assert by_displacement[-1, 0] == pytest.approx(0.1)
    # friction at rest plus the pendulum of length 1.33 m, up to its tilt
    assert by_displacement[-1, 1] == pytest.approx(stand.LOAD * (0.033 + 0.1 / 1.415), rel=0.06)
    assert by_displacement[:, 1] == pytest.approx(by_displacement[:, 2] * stand.LOAD, rel=1e-5)
    by_load = pushed(stand, ("LoadControl", 1e-3), 100)
    expected = np.interp(by_load[-1, 1], by_displacement[:, 1], by_displacement[:, 0])
    assert by_load[-1, 0] == pytest.approx(expected, rel=1e-3)
    by_arc = pushed(stand, ("ArcLength", 1e-3, 1e-3), 50)
    assert by_arc[-1, 0] > 0.02
    expected = np.interp(by_arc[-1, 1], by_displacement[:, 1], by_displacement[:, 0])
    assert by_arc[-1, 0] == pytest.approx(expected, rel=1e-3)


def push_through(stand, step, reach, stiffness, system="UmfPack", **options):
    """Push a mass on a soft storey on a bearing; displacement of the bearing and force."""
    ops = stand.ops
    stand.build(fixed=(0, 1, 0, 1, 1, 1), **options)
    ops.node(3, 0.0, 0.0, 0.0)
    ops.fix(3, 0, 1, 0, 1, 1, 1)
    ops.uniaxialMaterial("Elastic", 1, stiffness)
    ops.uniaxialMaterial("Elastic", 2, 1e10)
    ops.element("zeroLength", 9, 2, 3, "-mat", 1, 2, "-dir", 1, 3)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(3, 0.0, 0.0, -stand.LOAD, 0.0, 0.0, 0.0)
    stand.solver()
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    assert ops.analyze(10) == 0
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Linear", 3)
    ops.pattern("Plain", 3, 3)
    ops.load(3, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    stand.solver(test="NormUnbalance", tolerance=1.0, iterations=50)
    ops.system(system)
    ops.integrator("DisplacementControl", 3, 1, step)
    ops.analysis("Static")
    track = []
    for k in range(round(reach / step)):
        assert ops.analyze(1) == 0, (k, ops.nodeDisp(2, 1))
        track.append((ops.nodeDisp(2, 1), ops.getTime()))
    return np.array(track)


@pytest.mark.parametrize("stiffness", [1e6, 5e6, 5e7])
def test_newton_pushes_into_the_rim_and_on(stand: Any, stiffness: float) -> None:
    """The rim's steep part is 0.4 mm wide, and flat parts are before and behind it."""
    if stand.route == "portable" and stiffness != 5e6:
        pytest.skip("the iteration is the same")
    reach = 0.2 + 2.5e5 / stiffness
    fine = push_through(stand, 1e-3, reach, stiffness)
    assert np.hypot(*bearing_response(1, "slip")) > 0.015
    # before the rim, on it, and held by the interface's friction
    assert fine[-1, 1] == pytest.approx(stand.LOAD * np.tan(np.arctan(0.126) + 0.124), rel=0.02)
    for step in (2e-3, 5e-3, 10e-3):
        coarse = push_through(stand, step, reach, stiffness)
        nearest = np.abs(fine[:, 0] - coarse[-1, 0]).argmin()
        assert coarse[-1, 1] == pytest.approx(fine[nearest, 1], rel=1e-4), step


def test_a_symmetric_tangent_finds_the_same_path(stand: Any) -> None:
    path = push_through(stand, 2e-3, 0.25, 5e6)
    for system in ("UmfPack", "ProfileSPD"):
        other = push_through(stand, 2e-3, 0.25, 5e6, system, tangent="symmetric")
        assert other == pytest.approx(path, rel=1e-4)
    plain = stand.DEVICE.as_dcfp()
    path = push_through(stand, 5e-3, 0.25, 5e6, bearing=plain)
    for system in ("ProfileSPD", "BandSPD"):
        other = push_through(stand, 5e-3, 0.25, 5e6, system, bearing=plain, tangent="symmetric")
        assert other == pytest.approx(path, rel=1e-4)


def test_a_symmetric_tangent_in_a_time_history(stand: Any, reference: np.ndarray) -> None:
    stand.build(tangent="symmetric")
    stand.gravity()
    stand.shaking(2.8)
    stand.ops.system("ProfileSPD")
    assert off(stand.run(), reference) < 1e-6


def test_eigen_has_the_sticking_stiffness(stand: Any) -> None:
    stand.build(fixed=(0, 1, 0, 1, 1, 1))
    options = stand.DEVICE.resolved()
    stand.gravity()
    values = sorted(stand.ops.eigen("-fullGenLapack", 2))
    vertical = options["axial_stiffness"] / stand.MASS
    # two elastic surfaces and the interface in series, in parallel with the pendulum; see theory
    element = np.array(stand.ops.eleResponse(1, "force"))
    assert element[8] == pytest.approx(-stand.LOAD, rel=1e-8)
    assert values[1] == pytest.approx(vertical, rel=0.02)
    sideways = stand.MASS * values[0]
    before = bearing_response(1, "force")[6]
    stand.ops.timeSeries("Linear", 2)
    stand.ops.pattern("Plain", 2, 2)
    stand.ops.load(2, 100.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    stand.solver(tolerance=1e-13)
    stand.ops.integrator("LoadControl", 1.0)
    stand.ops.analysis("Static")
    assert stand.ops.analyze(1) == 0
    stiffness = (bearing_response(1, "force")[6] - before) / stand.ops.nodeDisp(2, 1)
    assert sideways == pytest.approx(stiffness, rel=1e-3)
    period = 2.0 * math.pi / math.sqrt(values[0])
    assert period < 0.3  # it sticks; sliding it is the pendulum's, 2.3 s


def test_gravity_starts_without_singular_equations(stand: Any, capfd: Any) -> None:
    stand.build()
    stand.gravity(steps=1)
    assert "singular" not in capfd.readouterr().err.lower()
    assert bearing_response(1, "axial_force") == pytest.approx(stand.LOAD, rel=1e-9)


def test_setting_the_time_leaves_the_rates_sane(stand: Any) -> None:
    plain = shaken(stand, 60, 0.005)
    ops = stand.ops
    for time in (100.0, -100.0):  # the shaking has period 1 s
        stand.build()
        stand.gravity()
        ops.setTime(200.0)
        stand.shaking(2.8)
        begun = stand.run(30, 0.005)
        speed = np.array(bearing_response(1, "sliding_speed"))
        ops.setTime(ops.getTime() + time)
        assert ops.analyze(1, 0.005) == 0
        later = np.array(bearing_response(1, "sliding_speed"))
        assert (later <= speed + 0.03).all(), time
        moved = np.vstack([begun, ops.nodeDisp(2)[:3], stand.run(29, 0.005)])
        assert off(moved, plain) < (1e-6 if stand.route == "fast" else 0.01), time


def test_a_new_analysis_goes_on_from_the_state(stand: Any) -> None:
    plain = shaken(stand, 60)
    stand.build()
    stand.gravity()
    stand.shaking(2.8)
    first = stand.run(30)
    stand.solver()
    stand.ops.integrator("Newmark", 0.5, 0.25)
    stand.ops.analysis("Transient")
    assert np.array_equal(np.vstack([first, stand.run(30)]), plain)


def test_reset_goes_back_to_the_start(stand: Any, capfd: Any) -> None:
    ops = stand.ops
    stand.build()
    at_rest = {name: bearing_response(1, name) for name in ("slip", "axial_force", "axis")}
    stand.gravity()
    stand.shaking(2.8)
    plain = stand.run()
    ops.reset()
    assert "revert" not in capfd.readouterr().err
    assert ops.eleType(1) == "LIRBearing"
    for name, value in at_rest.items():
        assert np.array_equal(bearing_response(1, name), value), name
    ops.remove("loadPattern", 1)
    ops.remove("loadPattern", 2)
    ops.remove("timeSeries", 1)
    ops.remove("timeSeries", 2)
    stand.gravity()
    stand.shaking(2.8)
    assert off(stand.run(), plain) < 1e-9


def test_failed_steps_leave_no_trace(stand: Any) -> None:
    plain = shaken(stand, 120, 0.005)
    ops = stand.ops
    stand.build()
    stand.gravity()
    stand.shaking(2.8)
    moved = np.zeros((120, 3))
    for k in range(120):
        if k % 15 == 7:
            ops.test("NormDispIncr", 1e-14, 1)
            assert ops.analyze(1, 0.25) != 0
            ops.test("NormDispIncr", 1e-9, 100)
        assert ops.analyze(1, 0.005) == 0
        moved[k] = ops.nodeDisp(2)[:3]
    assert off(moved, plain) < 1e-9


def test_rayleigh_damping_does_not_act_on_a_bearing(stand: Any, reference: np.ndarray) -> None:
    stand.build()
    stand.gravity()
    stand.ops.rayleigh(0.0, 0.05, 0.05, 0.05)  # of the mass: none
    stand.shaking(2.8)
    assert off(stand.run(), reference) < 1e-9


def test_element_loads_are_refused(stand: Any, capfd: Any) -> None:
    stand.build()
    stand.ops.timeSeries("Linear", 5)
    stand.ops.pattern("Plain", 5, 5)
    stand.ops.eleLoad("-ele", 1, "-type", "-beamUniform", 1.0, 1.0, 1.0)
    stand.gravity()
    message = capfd.readouterr().err
    assert "load type unknown for element: 1" in message
    assert bearing_response(1, "axial_force") == pytest.approx(stand.LOAD, rel=1e-9)


def test_elements_are_removed_and_tags_used_again(stand: Any, reference: np.ndarray) -> None:
    stand.build(count=3)
    stand.ops.remove("element", 2)
    assert bearing_tags() == (1, 3)
    with pytest.raises(ValueError, match="element 2 is not a bearing"):
        bearing_response(2, "slip")
    stand.put(2, 1, 3, level="contact")
    assert sorted(bearing_tags()) == [1, 2, 3]
    stand.gravity()
    assert bearing_response(2, "axial_force") == pytest.approx(stand.LOAD, rel=1e-9)
    for _ in range(3):
        assert np.array_equal(shaken(stand), reference)
        assert bearing_tags() == (1,)


def test_many_bearings(stand: Any, reference: np.ndarray) -> None:
    stand.build(count=40)
    recording = record_bearings()
    stand.gravity()
    stand.shaking(2.8)
    assert off(stand.run(), reference) < 1e-6
    data = recording.dataset()
    assert data.sizes["bearing"] == 40
    last = data["bearing_displacement"][-1].to_numpy()
    assert np.ptp(last, axis=0) == pytest.approx(0.0, abs=1e-9)
    stand.ops.wipe()
    assert bearing_tags() == ()
    assert len(recording.dataset().time) == 105


def test_both_routes_in_one_model(stand: Any, reference: np.ndarray) -> None:
    stand.build()
    ops, own = stand.ops, stand.route
    ops.node(3, 0.0, 0.0, 0.0)
    ops.fix(3, 0, 0, 0, 1, 1, 1)
    ops.mass(3, *[stand.MASS] * 3, *[0.0] * 3)
    stand.route = "portable" if own == "fast" else "fast"
    stand.put(2, 1, 3)
    assert {bearing_response(tag, "route") for tag in (1, 2)} == {"fast", "portable"}
    stand.gravity()
    stand.shaking(2.8)
    assert off(stand.run(), reference) < 1e-6
    # both know the length of all steps, of the first one after `loadConst` as well
    assert np.allclose(ops.nodeDisp(2), ops.nodeDisp(3), rtol=1e-9, atol=1e-12)
