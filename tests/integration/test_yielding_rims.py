"""Rims that yield and break: the law by itself, one push and one impact in closed form, levels."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    Finding,
    GroundMotion,
    Recording,
    audit,
    load,
    lumped_mass,
    save,
    shear_building,
    time_history,
)
from frames.design import impact_checks
from lir_element import AnalysisWarning, DesignWarning, Element, LIRBearing, ring_strength
from lir_element.kernels.rim import bend, bent, press_rim
from lir_element.opensees import builtin_commands
from tests.scenes import heavy_bearing

MASS = 1e5
WEIGHT = MASS * 9.80665
FORCE = 0.6 * WEIGHT
CAPACITY = 0.2


def bearing(interface_friction: float = math.inf, **changes: Any) -> LIRBearing:
    """A bearing of which a rim yields under 60 % of the weight; a plain DCFP if nothing is said."""
    options = {"rim_yield_force": FORCE, "rim_overrun": 0.05, "slip_capacity": 1.0, **changes}
    return heavy_bearing(capacity=CAPACITY, interface_friction=interface_friction, **options)


def pushed(device: LIRBearing, scale: float = 1.0, level: str = "pendulum", **options: Any) -> Any:
    """A mass that a pulse throws at the rims, at an angle of 31 degrees."""
    pulse = np.where(np.arange(0.0, 2.0, 0.005) < 0.6, -1.5 * scale, 0.0)
    motion = GroundMotion(x=pulse, y=0.6 * pulse, dt=0.005)
    frame = lumped_mass(device, MASS)
    return time_history(frame, motion, dt=1e-3, level=level, **options)


def test_a_rim_follows_a_bilinear_law() -> None:
    """Loading, unloading and loading again against the sum of an elastic and a plastic part."""
    k, h, p_y = 4e8, 4e6, 5e5
    plastic, closure = 0.0, 0.0
    for gap in (1e-3, 2e-3, 8e-3, 5e-3, 8.1e-3, 2e-2):
        force, slope, closure, flow = press_rim(
            gap - plastic, closure, k, 0.0, 0.0, p_y + h * plastic, h
        )
        before = p_y + h * plastic
        assert flow == pytest.approx(max(k * (gap - plastic) - before, 0.0) / (k + h), abs=1e-15)
        plastic += flow
        assert force == pytest.approx(max(k * (gap - plastic), 0.0), rel=1e-9)
        assert slope in (0.0 if force == 0.0 else k, pytest.approx(k * h / (k + h)))
    # on the bilinear envelope: P = P_y + H g_p, g = P / k + g_p
    assert force == pytest.approx(p_y + (gap - p_y / k) * k * h / (k + h))


def test_the_damper_never_takes_the_force_above_what_the_rim_bears() -> None:
    force, _, closure, flow = press_rim(0.01, 0.0, 4e8, 1e6, 1e-3, 5e5, 4e6)
    assert force == pytest.approx(5e5 + 4e6 * flow)
    assert 4e8 * closure + 1e6 * closure / 1e-3 == pytest.approx(force)  # both on the elastic part
    assert closure + flow == pytest.approx(0.01)


@pytest.mark.parametrize("angle", [0.0, 0.1, 0.3927, 0.7, 2.0, -2.9, math.pi])
def test_a_dent_stays_where_it_was_pressed(angle: float) -> None:
    dent = np.zeros(9)
    x, y = math.cos(angle), math.sin(angle)
    bend(dent, 2.0 * x, 2.0 * y, 3e-3)  # a direction, whatever its length
    bend(dent, x, y, 2e-3)
    for off in np.linspace(0.0, 2.0 * math.pi, 100):
        found, slant = bent(dent, math.cos(angle + off), math.sin(angle + off))
        assert found == pytest.approx(5e-3 * math.cos(0.5 * off) ** 8, abs=1e-17)
        steep = -2e-2 * math.cos(0.5 * off) ** 7 * math.sin(0.5 * off)
        assert slant == pytest.approx(steep, abs=1e-16)
    assert bent(dent, -x, -y)[0] < 1e-17
    assert bent(dent, 0.0, 0.0) == (0.0, 0.0)  # a slider in the middle is near no rim


def test_the_force_of_a_slow_push_is_that_of_a_bilinear_rim() -> None:
    """Back and forth past both sides: the second push in one direction meets the rims later."""
    device = bearing(rim_damping=0.0)
    element = Element(device)
    options, load = device.resolved(), WEIGHT
    k, h = options["rim_stiffness"], options["rim_stiffness"] * 0.005 / 0.995
    spent = {1.0: 0.0, -1.0: 0.0}
    path = np.concatenate(
        [
            np.linspace(0.0, 0.215, 400),
            np.linspace(0.215, -0.212, 800),
            np.linspace(-0.212, 0.22, 800),
        ]
    )
    for step, x in enumerate(path):
        u = np.zeros(12)
        u[6] = x
        length = device.effective_radius
        u[8] = length - math.sqrt(length**2 - x**2) - load / options["axial_stiffness"]
        element.set_trial(u, np.zeros(12), 0.1 * step)
        element.commit()
        side = math.copysign(1.0, x)
        sine = abs(x) / math.hypot(x, length - u[8])  # of the axis: it lies along the centres
        gap = 1.5 * sine - device.rim_displacement[0]
        _, _, _, flow = press_rim(gap - spent[side], 0.0, k, 0.0, 0.0, FORCE + h * spent[side], h)
        spent[side] += flow
        assert_allclose(
            element.response("rim_force"), max(k * (gap - spent[side]), 0.0), rtol=1e-6, atol=1.0
        )
    assert min(spent.values()) > 2e-3
    assert_allclose(element.response("rim_plastic"), max(spent.values()), rtol=1e-9)
    bottom, top = element.response("rim_dent")  # on the top plate the slider lies the other way
    for dent, way in ((bottom, 1.0), (top, -1.0)):
        for side in (1.0, -1.0):
            assert bent(dent, way * side, 0.0)[0] == pytest.approx(spent[side], rel=1e-9)


def test_an_impact_leaves_in_the_rims_what_it_takes_to_bend_them() -> None:
    """Without dampers: P_y g_p + H g_p^2 / 2 of each rim, and nothing else."""
    data = pushed(bearing(rim_damping=0.0, axial_damping=0.0), 1.3)
    assert data.attrs["status"] == "ok"
    assert abs(data.attrs["energy_error"]) < 1e-4
    plastic = data["rim_plastic"].isel(time=-1, bearing=0).to_numpy()
    assert (plastic > 4e-3).all()
    h = bearing().resolved()["rim_stiffness"] * 0.005 / 0.995
    spent = (FORCE * plastic + 0.5 * h * plastic**2).sum()
    assert float(data["rim_force"].isel(time=-1).max()) == 0.0
    assert float(data["work_rims"].isel(time=-1, bearing=0)) == pytest.approx(spent, rel=2e-3)
    assert float(data["rim_force"].max()) == pytest.approx(FORCE + h * plastic.max(), rel=1e-6)


def test_a_rim_that_stays_elastic_is_one_that_never_yields() -> None:
    strong, endless = (pushed(bearing(rim_yield_force=f)) for f in (1e8, math.inf))
    assert float(endless["rim_force"].max()) > WEIGHT
    for name in ("bearing_displacement", "rim_force", "rim_closure", "work_rims"):
        assert_array_equal(strong[name], endless[name])
    assert "rim_plastic" not in endless
    assert float(strong["rim_plastic"].max()) == 0.0


@pytest.mark.parametrize("interface", [math.inf, 0.2])
def test_levels_agree(interface: float) -> None:
    device = bearing(interface, rim_yield_force=0.35 * WEIGHT)
    found = {level: pushed(device, 1.6, level) for level in ("pendulum", "contact")}
    for data in found.values():
        assert data.attrs["status"] == "ok"
        assert abs(data.attrs["energy_error"]) < 1e-4
    most = [float(data["rim_plastic"].max()) for data in found.values()]
    assert min(most) > 1.5e-3
    assert most[0] == pytest.approx(most[1], rel=0.08)  # sliders have mass at one level
    force = [float(data["rim_force"].max()) for data in found.values()]
    assert force[0] == pytest.approx(force[1], rel=0.01)
    ends = [data["bearing_displacement"].to_numpy()[:, 0, :2] for data in found.values()]
    assert_allclose(ends[0], ends[1], rtol=0.0, atol=0.03 * np.abs(ends[1]).max())


@pytest.mark.parametrize("level", ["pendulum", "contact"])
@pytest.mark.parametrize("interface", [math.inf, 0.9])
@pytest.mark.parametrize("back", [0.0, 1.2e-3])
def test_tangent_is_the_derivative(level: str, interface: float, back: float) -> None:
    """Where a rim flows and, a little back from there, along a dent that varies around it."""
    device = bearing(interface)
    element = Element(device, level)
    u = np.zeros(12)
    u[8] = -WEIGHT / device.resolved()["axial_stiffness"]
    element.set_trial(u, np.zeros(12), 0.0)
    element.commit()
    length, dt = device.effective_radius, 0.01
    for k in range(1, 201):
        size = 0.215 * k / 200 - (back if k == 200 else 0.0)
        u[6], u[7] = size * math.cos(0.5), size * math.sin(0.5)
        u[8] = (
            length - math.sqrt(length**2 - size**2) - WEIGHT / device.resolved()["axial_stiffness"]
        )
        element.set_trial(u, np.zeros(12), dt * k)
        if k < 200:
            element.commit()
    assert element.response("rim_force").min() > 0.1 * WEIGHT
    assert (element.response("rim_flow").max() > 0.0) == (back == 0.0)
    tangent, size = element.tangent_stiffness(), 1e-8
    found = np.zeros((12, 3))
    for column in range(3):
        for sign in (1.0, -1.0):
            moved = u.copy()
            moved[6 + column] += sign * size
            element.set_trial(moved, np.zeros(12), dt * 200)
            found[:, column] += sign * element.resisting_force() / (2.0 * size)
    scale = np.abs(tangent[:, 6:9]).max()
    assert_allclose(found / scale, tangent[:, 6:9] / scale, rtol=0.0, atol=2e-5)


def test_dents_are_where_the_slider_pressed_at_both_levels() -> None:
    dents = []
    for level in ("pendulum", "contact"):
        element = Element(bearing(), level)
        u = np.zeros(12)
        for step, size in enumerate(np.linspace(0.0, 0.21, 100)):
            u[6], u[7], u[8] = -0.8 * size, 0.6 * size, 0.5 * size**2 / 2.75 - 1e-4
            element.set_trial(u, np.zeros(12), 0.1 * step)
            element.commit()
        dents.append(element.response("rim_dent"))
    around = np.linspace(-math.pi, math.pi, 1000)
    for dent, angle in zip(dents[0], (math.atan2(0.6, -0.8), math.atan2(-0.6, 0.8)), strict=True):
        deep = [bent(dent, math.cos(a), math.sin(a))[0] for a in around]
        assert around[np.argmax(deep)] == pytest.approx(angle, abs=0.01)
    assert_allclose(dents[0], dents[1], rtol=0.0, atol=0.03 * np.abs(dents[0]).max())


@pytest.mark.parametrize(("load", "gives"), [(0.002 * WEIGHT, True), (0.1 * WEIGHT, False)])
def test_a_closed_path_along_a_dent(load: float, gives: bool) -> None:
    """The rim gives back more than it took, less than friction takes but under a small load.

    Pressed where it is bent, let go 60 degrees on, below the rims back: round after round.
    """
    device = bearing(rim_stiffness=6e7, rim_damping=0.0, axial_damping=0.0)
    element, reach = Element(device), device.lateral_capacity
    bent_by, pressed, back, turn = reach + 0.02, reach + 0.017, 0.9 * reach, math.pi / 3.0
    corners = [(0.0, 0.0), (bent_by, 0.0), (back, 0.0)]
    corners += 2 * [(pressed, 0.0), (pressed, turn), (back, turn), (back, 0.0)]
    stiffness, length = device.resolved()["axial_stiffness"], device.effective_radius
    ends: list[tuple[float, float]] = []
    u, force, put_in = np.zeros(12), np.zeros(12), 0.0
    for (r, a), (r_end, a_end) in pairwise(corners):
        for share in np.linspace(0.0, 1.0, 100):
            size, angle = r + share * (r_end - r), a + share * (a_end - a)
            before, u = u, np.zeros(12)
            u[6], u[7] = size * math.cos(angle), size * math.sin(angle)
            u[8] = length - math.sqrt((length + load / stiffness) ** 2 - size**2)
            element.set_trial(u, np.zeros(12), len(ends) + 0.1 * share)
            element.commit()
            put_in += float(0.5 * (force + element.resisting_force()) @ (u - before))
            force = element.resisting_force()
        ends.append((put_in, float(np.sum(element.response("work_rim")))))
    work, rim = np.subtract(ends[-1], ends[-5])
    assert -2.0 * FORCE * 0.02 < rim < 0.0
    assert (work < 0.0) == gives


@pytest.mark.parametrize("turn", [0.3, 1.1, math.pi])
def test_a_turned_pulse_finds_the_same(turn: float) -> None:
    pulse = np.where(np.arange(0.0, 1.2, 0.005) < 0.6, -2.0, 0.0)
    ends = []
    for angle in (0.2, 0.2 + turn):
        motion = GroundMotion(x=pulse * math.cos(angle), y=pulse * math.sin(angle), dt=0.005)
        data = time_history(lumped_mass(bearing(), MASS), motion, dt=1e-3)
        path = data["bearing_displacement"].to_numpy()[:, 0]
        ends.append(path[:, 0] * math.cos(angle) + path[:, 1] * math.sin(angle))
        assert float(data["rim_plastic"].max()) > 1e-3
    assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_a_broken_rim_ends_the_run_or_lets_the_slider_on_the_flange(level: str) -> None:
    warnings.simplefilter("ignore", AnalysisWarning)  # that they end is what is looked at
    weak = {"rim_yield_force": 0.4 * WEIGHT, "rim_overrun": 0.01}
    ended = pushed(bearing(**weak), 1.6, level)
    assert ended.attrs["status"] == "rim_overrun"
    assert "rim_overrun 0.01 m" in ended.attrs["message"]
    free = pushed(bearing(**weak, flange=0.25), 1.6, level)
    assert free.attrs["status"] == "ok"
    assert abs(free.attrs["energy_error"]) < 1e-3
    assert np.isinf(free["rim_plastic"].isel(time=-1)).all()
    broken = np.isinf(free["rim_plastic"].isel(bearing=0).max("surface").to_numpy())
    assert 0 < broken.argmax() < len(broken) - 100
    assert float(free["rim_force"].isel(time=slice(broken.argmax() + 1, None)).max()) == 0.0
    assert float(abs(free["bearing_displacement"]).max()) > 1.3 * CAPACITY
    short = pushed(bearing(**weak, flange=0.03), 1.6, level)
    assert short.attrs["status"] == "rim_overrun"
    assert "beyond a failed rim, flange 0.03 m" in short.attrs["message"]


@pytest.mark.parametrize("level", ["pendulum", "contact"])
@pytest.mark.parametrize("force", [0.4 * WEIGHT, math.inf])
def test_a_flange_counts_from_a_broken_rim_on(level: str, force: float) -> None:
    """A flange shorter than `rim_overrun` changes nothing, if a rim holds or breaks."""
    warnings.simplefilter("ignore", AnalysisWarning)
    for scale, end in ((1.0, "ok"), (1.6, "rim_overrun")):
        overrun = 0.01 if end == "rim_overrun" else 0.1
        plain = bearing(
            rim_yield_force=force, rim_overrun=overrun * (0.1 if force > WEIGHT else 1.0)
        )
        short = replace(plain, flange=1e-12)
        runs = [pushed(each, scale, level) for each in (plain, short)]
        assert [run.attrs["status"] for run in runs] == [end, end]
        assert_array_equal(*(run["bearing_displacement"].to_numpy() for run in runs))
        assert float(runs[1]["rim_closure"].max()) > 1e-4


def test_what_rims_did_is_told_by_any_recording(tmp_path: Path) -> None:
    """By the whole record, by peaks alone, by a file; a rim that never yields is not spoken of."""
    device = bearing()
    whole = pushed(device)
    assert "1 of them yielded, by up to" in rims_finding(whole).sentence
    assert not rims_finding(whole).doubtful
    most = float(whole["rim_plastic"].max())
    assert f"{1e3 * most:.3g} mm (bearing, " in rims_finding(whole).sentence
    for recording in (Recording(every=None), Recording(every=50, channels=("axial_force",))):
        thin = pushed(device, recording=recording)
        assert float(thin["peak_rim_plastic"].max()) == pytest.approx(most, rel=1e-12)
        assert rims_finding(thin).sentence == rims_finding(whole).sentence
    save(whole, tmp_path / "run.nc")
    kept = load(tmp_path / "run.nc")
    assert_array_equal(kept["rim_plastic"], whole["rim_plastic"])
    assert float(kept["rim_yield_force"][0]) == FORCE
    assert "yielded" not in rims_finding(pushed(bearing(rim_yield_force=math.inf))).sentence


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_a_broken_rim_asks_to_be_looked_at(level: str) -> None:
    broken = bearing(rim_yield_force=0.4 * WEIGHT, rim_overrun=0.01, flange=0.25)
    for recording in (None, Recording(every=None)):
        found = rims_finding(pushed(broken, 1.6, level, recording=recording))
        assert "a rim of bearing broke" in found.sentence
        assert found.doubtful


def rims_finding(data: Any) -> Finding:
    return next(found for found in audit(data) if found.feature == "rims")


def test_bearings_of_one_building_have_rims_of_their_own() -> None:
    """One of four bearings has weak rims: it alone is bent, the others' runs are theirs."""
    frame = shear_building(
        bearing(rim_yield_force=math.inf), 1e5, 1e8, storeys=2, base_mass=1e5, plan=(1, 6.0)
    )
    names = list(frame.bearings)
    mixed = frame.with_bearings({names[0]: bearing(rim_yield_force=2e5)})
    pulse = np.where(np.arange(0.0, 1.2, 0.005) < 0.6, -2.0, 0.0)
    data = time_history(mixed, GroundMotion(x=pulse, dt=0.005))
    assert data.attrs["status"] == "ok"
    plastic = data["rim_plastic"].isel(time=-1).max("surface").to_numpy()
    assert plastic[0] > 1e-4
    assert_array_equal(plastic[1:], 0.0)
    assert "1 of them yielded" in rims_finding(data).sentence


def test_elements_of_opensees_that_know_no_such_rims_refuse_them() -> None:
    with pytest.raises(ValueError, match=r"does not support rim_yield_force.*bearing_element"):
        builtin_commands("TripleFrictionPendulum", 1, 1, 2, bearing(), WEIGHT)
    with pytest.raises(ValueError, match="does not support flange"):
        builtin_commands(
            "TripleFrictionPendulum", 1, 1, 2, bearing(rim_yield_force=math.inf, flange=0.1), WEIGHT
        )


def test_what_stays_bent_is_checked_against_what_a_rim_lasts() -> None:
    device = bearing()
    data = pushed(device)
    title = "plastic deformation of rims"
    [check] = [one for one in impact_checks(data, lumped_mass(device, MASS)) if one.title == title]
    assert check.demand == pytest.approx(float(data["rim_plastic"].max()), rel=1e-12)
    left = 0.05 - FORCE / device.resolved()["rim_stiffness"]
    assert check.limit == pytest.approx(left, rel=1e-12)
    assert check.passed
    strong = bearing(rim_yield_force=math.inf)
    every = impact_checks(pushed(strong), lumped_mass(strong, MASS))
    assert title not in {one.title for one in every}


def test_the_strength_of_a_ring() -> None:
    """A slender wall bends: M_p / a; a squat one shears off: V_p; both at once by hand."""
    steel = {"arc": 0.3, "yield_stress": 345e6}
    slender = ring_strength(thickness=0.002, height=0.2, **steel)
    assert slender == pytest.approx(345e6 * 0.3 * 0.002**2 / 4 / 0.1, rel=1e-6)
    squat = ring_strength(thickness=0.03, height=0.04, lever=1e-5, **steel)
    assert squat == pytest.approx(345e6 * 0.3 * 0.03 / math.sqrt(3.0), rel=1e-3)
    # P a / M_p = 8/9 and (P / V_p)^4 = 1/9 sum to 1 at t = 3 a / 2
    assert ring_strength(thickness=0.03, height=0.04, **steel) == pytest.approx(1.035e6, rel=1e-9)
    with pytest.raises(ValueError, match=r"lever = 0.05 m must not exceed the ring"):
        ring_strength(thickness=0.03, height=0.04, lever=0.05, **steel)
    with pytest.raises(ValueError, match=r"arc = 0"):
        ring_strength(thickness=0.03, height=0.04, arc=0.0, yield_stress=345e6)
    for thickness in (1e-300, 1e200):
        with pytest.raises(ValueError, match=r"thickness = .* give no finite force"):
            ring_strength(thickness=thickness, height=0.04, **steel)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"rim_yield_force": -1.0}, ValueError, r"rim_yield_force = -1 \[N\]"),
        (
            {"rim_hardening": 1.0},
            ValueError,
            r"rim_hardening = 1 \[-\] must be at least 0.0001 and below 1",
        ),
        ({"rim_hardening": 1e-5}, ValueError, "some 0.005 of steel"),
        ({"flange": 0.0}, ValueError, r"flange = 0"),
        ({"rim_yield_force": 600.0}, DesignWarning, "600 kN are"),
        ({"rim_overrun": 2e-4}, DesignWarning, "the rim fails before it yields"),
    ],
)
def test_numbers_out_of_bounds(given: dict[str, float], error: type[Warning], message: str) -> None:
    caught = pytest.warns if issubclass(error, Warning) else pytest.raises
    with caught(error, match=message):
        bearing(**given)
