"""Checks of motions: the mean spectrum by its definition, fault axes, numbers, periods."""

import math
from typing import Any

import numpy as np
import pytest

from frames import GroundMotion
from frames.design import (
    CheckError,
    EquivalentLinear,
    IsolationSystem,
    MotionSet,
    NCh2745,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    equivalent_linear,
    motion_checks,
    pair_spectrum,
    period_range,
)
from tests.square_system import square_system

TARGET = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
BOUNDS = PropertyBounds(PropertyModificationFactors(0.8, 1.2))


@pytest.fixture(scope="module")
def linear(system: IsolationSystem) -> EquivalentLinear:
    return equivalent_linear(system, TARGET, bounds=BOUNDS)


@pytest.fixture(scope="module")
def system() -> IsolationSystem:
    return square_system()


def motions(count: int = 7, **facts: Any) -> MotionSet:
    """Pulses of periods from 1 to 4 s, weaker across."""
    t = np.arange(0.0, 12.0, 0.02)
    made = {}
    for k in range(count):
        wave = (2.0 + k) * np.sin(2.0 * math.pi * t / (1.0 + 0.5 * k)) * (t < 2.0 + k)
        made[f"m{k}"] = GroundMotion(x=wave, y=0.5 * wave, dt=0.02, name=f"m{k}")
    return MotionSet(made, {name: facts for name in made} if facts else {})


def test_the_range_of_periods_spans_the_bounds(linear: EquivalentLinear) -> None:
    periods = [each.period for each in linear.bounds.values()]
    expected = (0.75 * min(periods), 1.25 * max(periods))
    assert period_range(linear) == pytest.approx(expected)
    assert period_range(linear, "NCh2745")[0] == pytest.approx(0.5 * min(periods))
    with pytest.raises(CheckError, match="rule"):
        period_range(linear, "ASCE 7-05")


def test_of_two_levels_the_range_begins_at_the_design_period(system: IsolationSystem) -> None:
    spectrum = Spectrum.nch2745("II", 3)
    linear = equivalent_linear(system, spectrum, code=NCh2745(), bounds=BOUNDS)
    design = [each.trace.value("T_D") for each in linear.bounds.values()]
    most = [each.period for each in linear.bounds.values()]
    assert min(design) < 0.99 * min(most)
    assert period_range(linear) == pytest.approx((0.5 * min(design), 1.25 * max(most)))


def test_the_mean_spectrum_is_least_where_it_is_said(linear: EquivalentLinear) -> None:
    given = motions()
    check = motion_checks(given, TARGET, linear)[1]
    grid = np.geomspace(*period_range(linear), 2000)
    mean = np.mean([pair_spectrum(m, grid, 0.05, "RotD100") for m in given.values()], axis=0)
    least = float((mean / np.asarray(TARGET.acceleration(grid, 0.05))).min())
    assert check.demand / check.trace.value("S_target") == pytest.approx(least, rel=5e-3)
    assert check.passed == (check.demand >= check.limit)
    doubled = motion_checks(
        MotionSet({n: m.scaled(2.0) for n, m in given.items()}), TARGET, linear
    )[1]
    assert doubled.demand == pytest.approx(2.0 * check.demand)


def test_pairs_are_counted(linear: EquivalentLinear) -> None:
    assert motion_checks(motions(), TARGET, linear)[0].passed
    few = motions(6)
    assert not motion_checks(few, TARGET, linear)[0].passed
    single = MotionSet({n: GroundMotion(x=m.x, dt=m.dt, name=n) for n, m in motions().items()})
    assert motion_checks(single, TARGET, linear)[0].demand == 0.0


@pytest.mark.parametrize(
    ("facts", "odd"),
    [
        ({"strike": 30.0, "azimuth_x": 120.0, "azimuth_y": 30.0}, 0.0),
        ({"strike": 30.0, "azimuth_x": -240.0, "azimuth_y": 390.0}, 0.0),
        ({"strike": 30.0, "azimuth_x": 300.0, "azimuth_y": 210.0}, 0.0),  # normal, other way
        ({"strike": 30.0, "azimuth_x": 30.0, "azimuth_y": 300.0}, 0.0),  # x along the fault
        ({"strike": 30.0, "azimuth_x": 90.0, "azimuth_y": 0.0}, 7.0),
        ({"strike": 30.0, "azimuth_x": 118.0, "azimuth_y": 28.0}, 7.0),
        ({}, 7.0),  # nothing is known
    ],
)
def test_near_fault_pairs_are_turned(linear, facts, odd):
    check = motion_checks(motions(near_fault=True, **facts), TARGET, linear)[-1]
    assert check.title.startswith("near-fault pairs")
    assert check.demand == odd
    assert check.passed == (odd == 0.0)


def test_far_motions_have_no_axes(linear: EquivalentLinear) -> None:
    assert len(motion_checks(motions(), TARGET, linear)) == 2
