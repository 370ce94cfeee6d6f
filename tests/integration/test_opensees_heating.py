"""Heated bearings inside OpenSees, and OpenSees' own element that heats: `FPBearingPTV`."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, Element, FrictionHeating, LIRBearing, PressureDependence

pytest.importorskip("openseespy")

from lir_element.opensees import bearing_response, builtin_commands, builtin_values, record_bearings
from validation.opensees.model import ABOVE, BELOW, ELEMENT, gravity_analysis, solver, weigh_down
from validation.opensees.model import stand as empty_stand

LOAD = 13345e3  # of the published example of TripleFrictionPendulumX, as radius and amplitudes
RADIUS = 0.5 * 0.711
PERIOD = 5.0


def device(radius: float, **changes: Any) -> LIRBearing:
    """Return a plain bearing whose two surfaces slide alike, each as a single one does."""
    return LIRBearing(
        radius=0.5 * 3.7465 + 0.1,
        slider_height=0.2,
        slider_radius=radius,
        capacity=math.inf,
        friction=CoulombFriction(0.06),
        interface_friction=math.inf,
        design_load=LOAD,
        torsional_friction=False,
        **changes,
    )


def theirs(reach: float, dt: float, end: float) -> np.ndarray:
    """Return temperature and friction coefficient of FPBearingPTV along a sine (n, 2)."""
    bearing = device(RADIUS)
    steps = round(end / dt)
    path = reach * np.sin(2.0 * np.pi * dt * np.arange(steps + 3) / PERIOD)
    found = []
    with empty_stand(bearing.height, held=(0, 1)) as ops:
        for command in builtin_commands("FPBearingPTV", ELEMENT, BELOW, ABOVE, bearing, LOAD):
            words = list(command)
            if words[1] == "FPBearingPTV":  # follows the temperature, stainless steel
                words[5], words[8], words[9], words[10] = 0.06, 1, 4.44e-6, 18.0
            getattr(ops, words[0])(*words[1:])
        weigh_down(ops, LOAD)
        gravity_analysis(ops)
        ops.timeSeries("Path", 77, "-dt", dt, "-values", *path)
        ops.pattern("Plain", 77, 77)
        ops.sp(ABOVE, 1, 1.0)
        solver(ops)
        ops.integrator("LoadControl", dt)
        ops.analysis("Static")
        for _ in range(steps):
            assert ops.analyze(1) == 0
            found.append([ops.eleResponse(ELEMENT, name)[0] for name in ("temp", "MuAdj")])
    return np.array(found)


def ours(bearing: LIRBearing, reach: float, dt: float, end: float) -> np.ndarray:
    """Return the same of a bearing each of whose surfaces slides by `reach`."""
    element, u, found = Element(bearing), np.zeros(12), []
    length = bearing.effective_radius + LOAD / bearing.resolved()["axial_stiffness"]
    for k in range(round(end / dt) + 1):
        away = reach * bearing.effective_radius / bearing.radii[0]
        u[6] = away * math.sin(2.0 * math.pi * dt * k / PERIOD)
        u[8] = bearing.effective_radius - math.sqrt(length**2 - u[6] ** 2)
        element.set_trial(u, np.zeros(12), dt * k)
        element.commit()
        names = ("temperature", "friction_coefficient")
        found.append([float(element.response(name)[0]) for name in names])
    return np.array(found[1:])


@pytest.mark.parametrize(("reach", "close"), [(0.2, 0.007), (0.6, 0.017)])
def test_temperature_is_that_of_fpbearingptv(reach: float, close: float) -> None:
    """Its sum over the past leaves an error of sqrt(dt): taken out by two steps.

    It heats the middle while that lies within half the side of a square of the slider's area; a
    smaller slider of ours, with that share of the heat, does the same. Beyond, its speed and flux
    are those of the step before.
    """
    coarse, fine = theirs(reach, 0.005, 6.0)[3::4], theirs(reach, 0.00125, 6.0)[15::16]
    expected = 2.0 * fine[:, 0] - coarse[:, 0]  # every 20 ms
    law = FrictionHeating(share=math.pi / 4.0)
    smaller = device(RADIUS * math.sqrt(math.pi) / 2.0, friction_heating=law)
    found = ours(
        smaller if reach > 0.3 else device(RADIUS, friction_heating=FrictionHeating()),
        reach,
        0.005,
        6.0,
    )[3::4]
    rise = expected.max() - 20.0
    assert rise > 70.0
    assert_allclose(found[5:, 0], expected[5:], rtol=0.0, atol=close * rise)
    assert_allclose(found[5:, 1], fine[5:, 1], rtol=0.02)
    assert found[:, 1].min() < 0.05


def test_other_elements_of_opensees_refuse_it() -> None:
    for name, law in (
        ("friction_heating", FrictionHeating()),
        ("pressure_dependence", PressureDependence()),
    ):
        with pytest.raises(ValueError, match=f"OpenSees does not support {name}: use be"):
            builtin_values(device(RADIUS, **{name: law}), LOAD)


def test_a_heated_bearing_answers_in_opensees_as_in_frames(stand: Any) -> None:
    """By both couplings; after a restart it begins cold again."""
    dt = 0.002
    bearing = replace(
        stand.DEVICE, friction_heating=FrictionHeating(), pressure_dependence=PressureDependence()
    )
    t = np.arange(0.0, 1.0, dt)
    motion = GroundMotion(x=2.8 * np.sin(2.0 * np.pi * t), dt=dt)
    ours = time_history(lumped_mass(bearing, stand.MASS), motion, dt=dt)
    expected = ours["temperature"].isel(bearing=0).to_numpy()
    assert expected[-1].min() < 30.0 < 60.0 < expected[-1].max()
    stand.build(bearing)
    stand.gravity(stand.MASS * 9.80665)
    recording = record_bearings()
    stand.shaking(2.8)
    stand.run(len(t) - 1, dt)
    data = recording.dataset()
    found = data["temperature"].isel(bearing=0).to_numpy()
    assert data["temperature"].attrs == ours["temperature"].attrs
    assert_allclose(found, expected[1:], rtol=0.0, atol=0.005 * (expected.max() - 20.0))
    assert_array_equal(bearing_response(1, "temperature"), found[-1])
    stand.ops.reset()
    stand.run(100, dt)
    assert 20.0 < bearing_response(1, "temperature")[0] < 0.6 * found[-1, 0]
