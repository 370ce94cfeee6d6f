"""Lower and upper bound friction properties: factors by their sources, and what they are put on."""

from dataclasses import replace

import pytest

from frames import shear_building
from frames.design import (
    CheckError,
    FrictionPendulum,
    IsolationSystem,
    PropertyBounds,
    PropertyModificationFactors,
    with_property_bounds,
)
from lir_element import CoulombFriction, VelocityFriction
from tests.refusals import refused
from tests.scenes import wide_bearing

FRICTION = CoulombFriction(0.04), VelocityFriction(0.05, 0.025, 20.0)
BEARING = wide_bearing(radius=(1.0, 1.5), capacity=0.4, friction=FRICTION, interface_friction=0.3)
BOUNDS = PropertyBounds(PropertyModificationFactors(0.6, 1.8))


def test_floor_and_cap_of_asce7() -> None:
    """lambda_ae 1.2, test 1.15, spec 1.15: 1.520875, governed by 1.8; 1.56, 1.30, 1.15: 2.1229."""
    asce7 = PropertyModificationFactors.asce7
    mild = {"ageing": (0.9, 1.2), "test": (0.85, 1.15), "spec": (0.85, 1.15)}
    floored = asce7(**mild)
    assert (floored.lower, floored.upper) == (0.60, 1.8)
    free = asce7(**mild, full_scale_tests=True)
    assert free.upper == pytest.approx(1.520875, rel=1e-12)
    assert free.lower == pytest.approx((1.0 - 0.75 * 0.1) * 0.85 * 0.85, rel=1e-12)
    tests = {"test": (1.0, 1.30), "spec": (1.0, 1.15)}
    # Ageing and contamination multiply before their share is taken.
    for more in ({"ageing": (1.0, 1.56)}, {"ageing": (1.0, 1.3), "contamination": (1.0, 1.2)}):
        assert asce7(**more, **tests).upper == pytest.approx(2.1229, abs=1e-10)


def test_the_calculation_of_factors_is_shown() -> None:
    text = PropertyModificationFactors.asce7(ageing=(1.0, 1.2)).trace.text()
    assert "λ_max = max((1 + a · (λ_ae_max - 1)) λ_test_max λ_spec_max, floor)" in text
    assert "= 1.8" in text
    waived = PropertyModificationFactors.asce7(full_scale_tests=True).trace
    assert "waived" in waived.text()
    assert "floor" not in waived


def test_combination_of_en1998() -> None:
    """Each source counts by psi_f = 0.70 in class II; friction only grows with age and dirt."""
    en1998 = PropertyModificationFactors.en1998
    aged = {"ageing": 1.2, "temperature": 1.1, "contamination": 1.1, "wear": 1.0}
    factors = en1998(**aged, spec=(0.85, 1.15))
    by_hand = 1.15 * (1.0 + 0.7 * 0.2) * (1.0 + 0.7 * 0.1) * (1.0 + 0.7 * 0.1)
    assert (factors.lower, factors.upper) == (0.85, pytest.approx(by_hand, rel=1e-12))
    assert en1998(ageing=1.2, importance="III").upper == pytest.approx(1.18, rel=1e-12)
    assert en1998(ageing=1.2, psi=1.0).upper == pytest.approx(1.2, rel=1e-12)


def test_a_bearing_at_its_bounds() -> None:
    inner = PropertyModificationFactors(0.8, 1.25)
    bounds = replace(BOUNDS, interface=inner)
    upper, lower = (with_property_bounds(BEARING, name, bounds) for name in ("upper", "lower"))
    assert upper.frictions[0] == CoulombFriction(1.8 * 0.04)
    assert upper.frictions[1] == VelocityFriction(1.8 * 0.05, 1.8 * 0.025, 20.0)
    assert lower.effective_friction == pytest.approx(0.6 * BEARING.effective_friction)
    assert with_property_bounds(BEARING, "nominal", bounds) == BEARING
    apart = with_property_bounds(BEARING, "upper", bounds, interface="lower")
    assert apart.interface_friction == lower.interface_friction
    # What is not friction stays.
    assert (upper.radii, upper.rim_displacement) == (BEARING.radii, BEARING.rim_displacement)
    alone = with_property_bounds(BEARING, "upper", BOUNDS)
    interface = [each.interface_friction for each in (upper, lower, alone)]
    assert interface == pytest.approx([1.25 * 0.3, 0.8 * 0.3, 1.8 * 0.3])
    assert with_property_bounds(BEARING.as_dcfp(), "upper", BOUNDS).is_dcfp


def test_all_bearings_of_a_frame_and_of_a_system() -> None:
    plan = (2, 1), 6.0
    frame = shear_building(BEARING, [1e5], [1e7], base_mass=5e4, plan=plan)
    upper = with_property_bounds(frame, "upper", BOUNDS)
    assert len(upper.bearings) == len(frame.bearings) == 6
    for name, link in upper.bearings.items():
        assert link.bearing == with_property_bounds(frame.bearings[name].bearing, "upper", BOUNDS)
    assert frame.bearings["bearing-0-0"].bearing == BEARING
    assert upper.name == f"{frame.name}, upper bound"
    pendulum = FrictionPendulum((0.9, 1.1), (0.04, 0.06))
    system = IsolationSystem(
        bearings=(BEARING, pendulum),
        loads=(1e6, 2e6),
        plan=(8.0, 6.0),
        positions=((0.0, 0.0), (6.0, 0.0)),
    )
    strong = with_property_bounds(system, "upper", BOUNDS)
    assert strong.strength == pytest.approx(1.8 * system.strength)


def test_what_are_no_factors_is_refused() -> None:
    make, put = PropertyModificationFactors, with_property_bounds
    words = r"upper factor of properties = 0.9 must be at least 1"
    refused(CheckError, words, make, 0.6, 0.9)
    words = r"lower factor of test = 1.1 .* at most 1"
    refused(CheckError, words, make.asce7, test=(1.1, 1.2))
    refused(CheckError, "lower factor", make, 0.0, 1.2)
    refused(CheckError, "choose one of", put, BEARING, "higher", BOUNDS)
    refused(TypeError, "PropertyBounds", put, BEARING, "upper", make(0.6, 1.8))
    refused(TypeError, "an LIRBearing, a Frame", put, 0.06, "upper", BOUNDS)
