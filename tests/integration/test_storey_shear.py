"""Shear above the isolation: by the accelerations of the floors, and its least value by hand."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import (
    Frame,
    GroundMotion,
    Section,
    shear_building,
    storey_forces,
    time_histories,
    time_history,
)
from frames.design import (
    CheckError,
    EquivalentLinear,
    IsolationSystem,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    Superstructure,
    equivalent_linear,
    history_checks,
    history_demands,
)
from frames.design.histories.force_demands import ShearFactor, raises_by_case
from frames.results.peak_response import largest
from tests.scenes import full_sine, paper_bearing

MASSES = (60e3, 50e3)


@pytest.fixture(scope="module")
def frame() -> Frame:
    bearing = paper_bearing(capacity=0.4, friction=0.06, interface_friction=0.25)
    return shear_building(
        bearing, list(MASSES), 60e6, base_mass=60e3, plan=((1, 1), (6.0, 6.0)), damping=None
    )


def pulse(size: float) -> GroundMotion:
    return full_sine(1.5 * size, 0.4, rest=3.0)


@pytest.fixture(scope="module")
def runs(frame: Frame) -> xr.Dataset:
    return time_histories(frame, [pulse(1.0 - 0.05 * k) for k in range(7)])


def linear(frame: Frame, **above: Any) -> EquivalentLinear:
    system = IsolationSystem.from_frame(frame)
    return equivalent_linear(
        system,
        Spectrum.asce7(s_ms=0.9, s_m1=0.5),
        bounds=PropertyBounds(PropertyModificationFactors(0.8, 1.2)),
        superstructure=Superstructure.from_frame(frame, R=4.0, **above),
    )


def test_bearings_between_storeys_carry_the_shear_there() -> None:
    """A mass on a bearing on a column: through the upper storey passes the bearing's force."""
    bearing = paper_bearing(capacity=0.4, friction=0.06, interface_friction=0.25)
    frame = Frame("isolated head")
    frame.add_node("foot", 0.0, 0.0, 0.0)
    frame.add_node("head", 0.0, 0.0, 3.0)
    frame.add_node("top", 0.0, 0.0, 3.0 + bearing.height)
    frame.fix("foot", "all")
    frame.fix("top", "rx", "ry", "rz")
    frame.add_member("column", "foot", "head", Section.rectangle(0.8, 0.8))
    frame.add_bearing("one", "head", "top", bearing)
    frame.add_mass("head", 5e3, (1e2, 1e2, 1e2))
    frame.add_mass("top", 2e5, (1e4, 1e4, 1e4))
    frame.add_level("ground", ["foot"])
    frame.add_level("head", ["head"])
    frame.add_level("top", ["top"])
    data = time_history(frame, pulse(1.0))
    force = data["bearing_force"].sel(bearing="one").to_numpy()
    assert data["storey_shear"].sel(storey="top").to_numpy() == pytest.approx(force, rel=1e-9)
    below = storey_forces(frame, data).sel(storey="head", component=["Vx", "Vy", "Fz"])
    assert data["storey_shear"].sel(storey="head").to_numpy() == pytest.approx(
        below.to_numpy(), abs=1e-6 * np.abs(below).max().item()
    )
    kept = time_histories(frame, [pulse(1.0)])["peak_storey_shear"].to_numpy()[0]
    assert kept == pytest.approx(largest(data, "storey_shear").values, rel=1e-9)


def least_shear(frame, runs, equivalent, bound="lower"):
    found = history_checks({bound: runs}, frame, "ASCE 7-22", equivalent=equivalent)
    return next(check for check in found if check.title == "storey shear of time histories")


def test_least_storey_shear_of_a_suite(frame: Frame, runs: xr.Dataset) -> None:
    """Seven motions of sizes 0.7 to 1: the mean of their largest shears over R_I."""
    known = linear(frame)
    t = known["lower"].trace
    check = least_shear(frame, runs, known)
    each = runs["peak_storey_shear"].to_numpy()[:, 0]
    reduction = min(max(3.0 / 8.0 * 4.0, 1.0), 2.0)
    assert len(each) == 7
    assert np.ptp(each) > 0.0
    assert check.demand == pytest.approx(each.mean() / reduction, rel=1e-12)
    assert check.limit == pytest.approx(t.value("V_s"), rel=1e-12)
    assert check.subject == frame.levels[1].name
    assert check.passed == (check.demand >= check.limit)
    windy = least_shear(frame, runs, linear(frame, wind_shear=10.0 * each.mean()))
    assert windy.ratio == pytest.approx(10.0 * reduction)
    assert (windy.passed, windy.verdict) == (False, "raised")


def test_less_than_the_least_shear_raises_forces_and_drifts(frame: Frame, runs: xr.Dataset) -> None:
    """The earthquake's part of forces above the isolation counts times the ratio, and drifts do."""
    most = runs["peak_storey_shear"].to_numpy()[:, 0].mean()
    windy = linear(frame, wind_shear=1.5 * most / 1.5)  # V_s is 1.5 times the shear of the runs
    plain = history_checks({"lower": runs}, frame, "ASCE 7-22")
    found = history_checks({"lower": runs}, frame, "ASCE 7-22", equivalent=windy)
    base = runs["peak_base_shear"].to_numpy().mean()
    at_base = max(windy["lower"].trace.value("V_b_dyn") / base, 1.0)
    (check,) = (each for each in found if each.title == "base shear of time histories")
    assert check.demand == pytest.approx(base, rel=1e-12)
    assert check.ratio == pytest.approx(windy["lower"].trace.value("V_b_dyn") / base, rel=1e-12)
    drifts = [
        next(each.demand for each in made if each.title == "storey drift ratio")
        for made in (plain, found)
    ]
    assert drifts[1] == pytest.approx(max(1.5, at_base) * drifts[0], rel=1e-9)
    assert not [each for each in found.failed if "shear" in each.title]
    assert "forces are raised to it" in found.tally
    more = raises_by_case(found)["MCE_R", "lower"]
    assert more.above == pytest.approx(max(1.5, at_base), rel=1e-9)
    assert more.isolation == pytest.approx(at_base, rel=1e-12)


def test_shears_above_the_least_leave_forces_as_they_are(frame: Frame, runs: xr.Dataset) -> None:
    weak = linear(frame)
    for name in ("V_b_dyn", "V_s"):
        assert weak["lower"].trace.value(name) > 0.0
    strong = runs.copy()
    for name in ("peak_storey_shear", "peak_base_shear"):
        strong[name] = 100.0 * runs[name]
    found = history_checks({"lower": strong}, frame, "ASCE 7-22", equivalent=weak)
    assert raises_by_case(found) == {("MCE_R", "lower"): ShearFactor(1.0, 1.0)}
    nominal = history_checks({"nominal": runs}, frame, "ASCE 7-22", equivalent=weak)
    assert raises_by_case(nominal) == {}


def test_a_suite_that_failed_has_no_storey_shear(frame: Frame, runs: xr.Dataset) -> None:
    status = runs["status"].copy()
    status[2] = "slip_exceeded"
    check = least_shear(frame, runs.assign(status=status), linear(frame), "upper")
    each = runs["peak_storey_shear"].to_numpy()[:, 0]  # what was reached; a mean of no value
    assert check.demand == pytest.approx(each.mean() / 1.5, rel=1e-12)
    assert check.demand > check.limit
    assert not check.passed
    assert check.verdict == "no value"
    failed, windy = runs.assign(status=status), linear(frame, wind_shear=100.0 * each.mean())
    found = history_checks({"upper": failed}, frame, "ASCE 7-22", equivalent=windy)
    assert raises_by_case(found) == {
        ("MCE_R", "upper"): ShearFactor()
    }  # of no value nothing is raised
    assert "1 of 7 runs failed" in check.void


def test_without_its_analysis_there_is_no_least_shear(frame: Frame, runs: xr.Dataset) -> None:
    found = history_checks({"lower": runs}, frame, "ASCE 7-22")
    assert not [check for check in found if "storey shear" in check.title]
    demands = history_demands({"lower": runs}, "ASCE 7-22")
    assert demands.loc["storey shear", "lower"] == pytest.approx(
        runs["peak_storey_shear"].to_numpy().mean(axis=0).max()
    )


def test_results_without_storey_shears_are_refused(frame: Frame, runs: xr.Dataset) -> None:
    with pytest.raises(CheckError, match="run them again"):
        least_shear(frame, runs.drop_vars("peak_storey_shear"), linear(frame))
