"""Shear above the isolation: by the accelerations of the floors, and its least value by hand."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import (
    CheckError,
    EquivalentLinear,
    Frame,
    GroundMotion,
    IsolationSystem,
    PropertyBounds,
    PropertyFactors,
    Spectrum,
    Superstructure,
    equivalent_linear,
    floor_acceleration,
    shear_building,
    storey_shear_check,
    storey_shear_peaks,
    time_history,
)
from lir_element import CoulombFriction, LIRBearing

MASSES = (60e3, 50e3)


@pytest.fixture(scope="module")
def frame() -> Frame:
    bearing = LIRBearing(
        radius=1.185, slider_height=0.12, slider_radius=0.15, capacity=0.4,
        friction=CoulombFriction(0.06), interface_friction=0.25,
    )  # fmt: skip
    return shear_building(
        bearing, list(MASSES), 60e6, base_mass=60e3, plan=((1, 1), (6.0, 6.0)), damping=None
    )


@pytest.fixture(scope="module")
def run(frame: Frame) -> xr.Dataset:
    time = np.arange(0.0, 5.0, 0.01)
    wave = 1.5 * np.sin(math.pi * time) * (time < 2.0)
    return time_history(frame, GroundMotion(x=wave, y=0.4 * wave, dt=0.01, name="pulse"))


def linear(frame: Frame, **above: Any) -> EquivalentLinear:
    system = IsolationSystem.from_frame(frame)
    return equivalent_linear(
        system, Spectrum.asce7(s_ms=0.9, s_m1=0.5),
        bounds=PropertyBounds(PropertyFactors(0.8, 1.2)),
        superstructure=Superstructure.from_frame(frame, R=4.0, **above),
    )  # fmt: skip


def test_storey_shears_are_the_inertia_above(frame: Frame, run: xr.Dataset) -> None:
    """Without damping a storey carries the masses above times their absolute accelerations."""
    moved = floor_acceleration(run).sel(axis=["x", "y"]).transpose("time", "level", "axis")
    forces = moved.to_numpy()[:, 1:] * np.array(MASSES)[:, None]
    shears = np.cumsum(forces[:, ::-1], axis=1)[:, ::-1]
    expected = np.linalg.norm(shears, axis=-1).max(axis=0)
    found = storey_shear_peaks(run, frame)
    assert found.shape == (3,)
    assert found[1:] == pytest.approx(expected, rel=1e-6)


def test_least_storey_shear(frame: Frame, run: xr.Dataset) -> None:
    known = linear(frame)
    t = known["lower"].trace
    check = storey_shear_check(run, frame, known, "lower")
    shear = storey_shear_peaks(run, frame)[1]
    reduction = min(max(3.0 / 8.0 * 4.0, 1.0), 2.0)
    assert check.demand == pytest.approx(shear / reduction, rel=1e-12)
    assert check.limit == pytest.approx(0.6 * t.value("V_s"), rel=1e-12)
    assert check.subject == frame.levels[1].name
    assert "of pulse" in check.note
    windy = storey_shear_check(run, frame, linear(frame, wind_shear=10.0 * shear), "lower")
    assert windy.ratio == pytest.approx(6.0 * reduction)
    assert not windy.passed


def test_a_run_that_failed_has_no_storey_shear(frame: Frame, run: xr.Dataset) -> None:
    stopped = run.assign_attrs(status="slip_exceeded", message="the slider left the overlap")
    check = storey_shear_check(stopped, frame, linear(frame), "upper")
    assert check.demand == 0.0
    assert not check.passed


def test_what_has_no_least_shear_is_refused(frame: Frame, run: xr.Dataset) -> None:
    with pytest.raises(CheckError, match=r"V_s_dyn.*'nominal'"):
        storey_shear_check(run, frame, linear(frame), "nominal")
