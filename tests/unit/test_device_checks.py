"""Checks of the bearing alone: by hand, by integration, and on the testing rig."""

import math

import numpy as np
import pytest

from frames.design import (
    CheckError,
    DesignLimits,
    PropertyBounds,
    PropertyModificationFactors,
    capacity_checks,
    device_checks,
    engagement_checks,
    overlap_area,
)
from lir_element import LIRBearing, PressureDependence, cyclic_test
from tests.refusals import refused
from tests.scenes import small_bearing


def bearing(mu: float = 0.066, mu_h: float = 0.126, **other: object) -> LIRBearing:
    """The paper's static test: L = 1.415 m, tested under 150 kN."""
    rims = {"capacity": None} if "rims" in other else {}
    return small_bearing(friction=mu, interface_friction=mu_h, **rims | other)


@pytest.mark.parametrize("share", [0.0, 0.2, 1.0, 1.7, 2.0, 3.0])
def test_overlap_is_what_integration_over_the_strips_gives(share: float) -> None:
    a = 0.15
    width = np.linspace(min(share, 2.0) * a / 2.0, a, 200_001)
    strips = 2.0 * np.sqrt(np.maximum(a * a - width * width, 0.0))
    area = 2.0 * np.trapezoid(strips, width)
    assert overlap_area(a, share * a) == pytest.approx(area, rel=1e-6, abs=1e-12)


def test_static_bearing_by_hand() -> None:
    """mu_e = 0.066 * 1.5 / 1.415; s* = 1.415 * 0.126 - 0.066 * 1.5; overlap of circles."""
    pressure = dict.fromkeys(("interface_pressure", "liner_pressure"), 15e6)
    limits = DesignLimits(margin=1.2, rim_strength=20e3, lateral_force=40e3, **pressure)
    checks = device_checks(bearing(), (100e3, 150e3), slip=0.01, limits=limits)
    by = {(c.title, c.subject): c for c in checks}
    held = by["interface holds until a rim is met", "N_min"]
    assert held.demand == pytest.approx(100e3 * 0.099 / 1.415)
    assert held.limit == pytest.approx(0.126 * 100e3 / 1.2)
    assert by["stable limit of interface slip", ""].limit == pytest.approx(0.07929)
    rim = by["interface slips before the rim breaks", "bottom rim"]
    cos = math.cos(math.asin(0.175 / 1.415))
    assert rim.demand == pytest.approx(150e3 * 0.07929 / 0.75 / cos)
    pressed = by["pressure on the sliders' overlap", ""].demand
    assert pressed == pytest.approx(150e3 / overlap_area(0.08, 0.01))
    # bottom rim alone: (R - h/2) mu_h - mu R off the upper slider's axis, that is s* / 2
    eccentric = by["normalised eccentricity e/a at the rims", ""].demand
    assert eccentric == pytest.approx(0.07929 / 2 / 0.08)
    # the centre of pressure on a liner: s R / L off where frictions are alike, and mu R h / L
    offset = 0.75 * (0.01 + 0.066 * 0.085) / 1.415
    liner = by["pressure on the liner around its resultant", "top surface"]
    assert liner.demand == pytest.approx(150e3 / overlap_area(0.08, 2.0 * offset))
    assert checks.passed


def test_lateral_force_is_the_limit_that_the_bearing_tells() -> None:
    """W tan(theta_max + atan mu_h), W vertical; for small tilts W (U_cap / L + mu_h)."""
    sine = 0.175 / 1.415
    axial = 150e3 / (math.sqrt(1.0 - sine**2) - 0.126 * sine)
    limits = DesignLimits(lateral_force=40e3)
    check = device_checks(bearing(), (axial, axial), slip=0.01, limits=limits)[-1]
    assert check.demand == pytest.approx(bearing().force_limit(150e3), rel=1e-12)
    assert check.demand == pytest.approx((sine + 0.126) * 150e3, rel=0.025)


@pytest.mark.parametrize(
    ("other", "pressed"),
    [
        ({}, (0, 1)),
        ({"rims": (0.0928, 0.12)}, (0,)),
        ({"rims": (0.12, 0.0928)}, (1,)),
        ({"radius": (0.75, 1.0)}, (0, 1)),
    ],
)
def test_rim_force_at_the_first_slip_is_that_of_the_rig(other, pressed):
    device = bearing(**other)
    path = np.linspace(0.0, device.lateral_capacity + 0.005, 400)
    data = cyclic_test(device, path, axial_load=150e3)
    slip = data.interface_slip_size.to_numpy()[:, 0]
    k = int(np.argmax(slip > 0.02e-3))
    load = float(data.axial_force[k, 0])
    limits = DesignLimits(rim_strength=1e6, rims_together=True)
    checks = device_checks(device, (load, load), slip=0.01, limits=limits).of("(2.1)")[2:]
    assert [c.subject for c in checks] == [f"{('bottom', 'top')[n]} rim" for n in pressed]
    eased = 1.0 - slip[k] / device.slip_stability  # by the slip of that step
    on_rig = data.rim_force.to_numpy()[k, 0, list(pressed)]
    np.testing.assert_allclose([eased * c.demand for c in checks], on_rig, rtol=2e-3)


@pytest.mark.meant("slipped further than the sliders' overlap", "slips before the slider meets")
def test_interface_that_the_check_refuses_slips_before_the_rim_on_the_rig() -> None:
    """Upper low friction and lower interface friction; 0.1 m are well inside the rims."""
    for upper, lower, holds in ((1.2, 0.9, True), (1.3, 0.7, False)):
        factors = PropertyModificationFactors(1.0, upper), PropertyModificationFactors(lower, 1.0)
        bounds = PropertyBounds(*factors)
        limits = DesignLimits(margin=1.0)
        check = device_checks(bearing(), (1e5, 2e5), slip=0.0, bounds=bounds, limits=limits)[0]
        assert check.passed is holds
        worst = bearing(0.066 * upper, 0.126 * lower, allow_weak_interface=True)
        slip = cyclic_test(worst, [0.0, 0.05, 0.1], axial_load=150e3).interface_slip_size
        assert (float(slip.max()) < 0.1e-3) is holds


def test_a_slip_left_behind_loads_interface_and_rims() -> None:
    limits = DesignLimits(rim_strength=1e6)
    without, after = (
        device_checks(bearing(), (1e5, 1e5), slip=0.02, slip_left=left, limits=limits)
        for left in (0.0, 0.02)
    )
    assert after[0].demand - without[0].demand == pytest.approx(1e5 * 0.02 / 1.415)
    cos = math.cos(math.asin(0.175 / 1.415))
    assert after[3].demand - without[3].demand == pytest.approx(1e5 * 0.02 / 0.75 / cos)


def test_overlap_that_is_gone_fails() -> None:
    limits = DesignLimits(interface_pressure=60e6)
    check = device_checks(bearing(), (1e5, 1e5), slip=0.17, limits=limits)[-1]
    assert not check.passed
    assert check.demand == math.inf


def test_capacity_is_the_sum_of_three_parts() -> None:
    device = bearing()
    checks = capacity_checks(device, 0.2)
    bottom, top, slip, whole = checks
    assert [bottom.demand, bottom.limit] == 2 * [pytest.approx(0.75 * 0.175 / 1.415)]
    assert top.ratio == pytest.approx(1.0)
    assert (slip.demand, slip.limit) == pytest.approx((0.025, 0.07929))
    assert whole.limit == pytest.approx(0.175 + 0.07929)
    # the surfaces' sliding and the slip make the displacement, the slider's tilt over h apart
    assert bottom.demand + top.demand + slip.demand == pytest.approx(0.2 + 0.085 * 0.175 / 1.415)
    left = capacity_checks(device, 0.2, slip_left=0.06)
    assert [c.passed for c in left] == [True, True, False, False]
    assert left[3].limit == pytest.approx(0.175 + 0.07929 - 0.06)
    overlap = bearing(slip_capacity=0.03)
    assert capacity_checks(overlap, 0.1)[3].limit == pytest.approx(0.205)


def test_rims_that_engage_early() -> None:
    device = bearing(rims=(0.0928, 0.12))
    checks = engagement_checks(device, {"lower": 0.35, "upper": 0.2}, least=0.6)
    assert [c.bound for c in checks] == ["lower", "lower", "upper", "upper"]
    assert checks[0].demand == pytest.approx(1.415 * 0.0928 / 0.75 / 0.35)
    assert [c.passed for c in checks] == [False, True, True, True]
    assert "not met" in checks[3].note


@pytest.mark.parametrize(
    ("change", "words"),
    [({"mu_h": math.inf}, "a rigid slider"), ({"capacity": math.inf}, "no rims")],
)
def test_bearings_without_an_interface_or_rims_are_refused(change, words):
    refused(CheckError, words, device_checks, bearing(**change), (1e5, 1e5), slip=0.0)


def test_numbers_out_of_bounds_are_refused() -> None:
    refused(CheckError, "least first", device_checks, bearing(), (2e5, 1e5), slip=0.0)
    refused(CheckError, r"s = -0\.01", device_checks, bearing(), (1e5, 1e5), slip=-0.01)
    refused(CheckError, "margin", DesignLimits, margin=0.9)
    refused(CheckError, "rim_strength", DesignLimits, rim_strength=0.0)


def test_friction_is_that_of_the_pressure() -> None:
    """By hand: friction at 5 MPa and at 40 MPa, measured at 20 MPa, and its bounds on top."""
    area = math.pi * 0.08**2
    law = PressureDependence(reference_pressure=20e6)
    loads = 5e6 * area, 40e6 * area
    bounds = PropertyBounds(
        PropertyModificationFactors(0.8, 1.3), interface=PropertyModificationFactors(1.0, 1.0)
    )
    limits = DesignLimits(rim_strength=1e6, margin=1.0)
    checks = device_checks(
        bearing(0.05, 0.15, pressure_dependence=law), loads, slip=0.01, bounds=bounds, limits=limits
    )
    by = {(c.title, c.subject): c for c in checks}
    upper = 1.3 * 0.05 * 0.7 ** (0.02 * (5.0 - 20.0))
    lower = 0.8 * 0.05 * 0.7 ** (0.02 * (40.0 - 20.0))
    held = by["interface holds until a rim is met", "N_min"]
    assert held.demand == pytest.approx(loads[0] * upper * 1.5 / 1.415)
    stable = by["stable limit of interface slip", ""]
    assert stable.limit == pytest.approx(1.415 * 0.15 - 1.5 * upper)
    rim = by["interface slips before the rim breaks", "top rim"]
    cos = math.cos(math.asin(0.175 / 1.415))
    assert rim.demand == pytest.approx(loads[1] * (1.415 * 0.15 - 1.5 * lower) / 0.75 / cos)
    assert "k_p_U" in held.trace


def test_the_interface_slips_where_the_pressure_says_on_the_rig() -> None:
    """The element's own friction under both loads lies between the two of the checks."""
    law = PressureDependence(reference_pressure=20e6)
    one = bearing(0.05, 0.15, pressure_dependence=law)
    area = math.pi * 0.08**2
    for pressure in (5e6, 40e6):
        run = cyclic_test(one, [0.05], pressure * area)
        factor = law.factor(pressure)
        force = float(run["bearing_force"].sel(axis="x").to_numpy()[-1, 0])
        pendulum = pressure * area * 0.05 / 1.415
        mu_e = 0.05 * 1.5 / 1.415
        assert force == pytest.approx(pendulum + factor * mu_e * pressure * area, rel=0.01)


def test_each_code_has_its_own_rule_for_rims() -> None:
    """ASCE 7-22 a share of D_TM; of the others all of what bearings must allow."""
    device, allowed = bearing(), {"lower": 0.35, "upper": 0.2}
    for code, clause, least in (
        ("ASCE 7-22", "ASCE 7-22 17.2.4.5", 0.60),
        ("EN 1998-1", "EN 1998-1 10.3(2), EN 15129", 1.0),
        ("NCh2745", "NCh2745 7.3", 1.0),
    ):
        checks = engagement_checks(device, allowed, code=code)  # type: ignore[arg-type]
        assert {c.clause for c in checks} == {clause}
        assert {c.limit for c in checks} == {least}
        worst = checks.governing
        assert (worst.bound, worst.demand) == ("lower", pytest.approx(0.175 / 0.35))
        assert len(checks) == (4 if code == "ASCE 7-22" else 1)
        if code != "ASCE 7-22":
            assert "rims met by intent" in worst.note
            assert (worst.verdict, checks.passed) == ("needs agreement", True)
            assert list(checks.to_agree) == [worst]
            assert "1 checks, 0 failed, 1 to be agreed" in checks.tally
            project = engagement_checks(device, allowed, code=code, agreed=0.8)[1]  # type: ignore[arg-type]
            assert project.verdict == "FAILS"  # what was agreed to is a limit
        else:
            assert worst.verdict == "FAILS"
    free = engagement_checks(device, 0.1, code="EN 1998-1")[0]
    assert (free.passed, free.note) == (True, "not met below gamma_x d_bd")
    refused(CheckError, "code = 'UBC'", engagement_checks, device, 0.1, code="UBC")  # type: ignore[arg-type]
