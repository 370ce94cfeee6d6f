"""Checks of time histories: by the numbers of the runs, taken by other means."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from frames import (
    Frame,
    GroundMotion,
    Recording,
    lumped_mass,
    shear_building,
    time_histories,
    time_history,
)
from frames.design import (
    HISTORY_RULES,
    Check,
    CheckError,
    Checks,
    DesignLimits,
    EquivalentLinear,
    IsolationSystem,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    Superstructure,
    bounded_histories,
    equivalent_linear,
    history_checks,
    history_demands,
    with_property_bounds,
)
from frames.design.histories.demand_table import headed
from lir_element import LIRBearing, PressureDependence
from tests.refusals import refused
from tests.scenes import full_sine, paper_bearing, quietly

BOUNDS = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
SLIDING = (0.8, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5)
"""Amplitudes of motions that all runs survive [m/s2]; the larger ones meet the rims."""


@pytest.fixture(scope="module")
def bearing() -> LIRBearing:
    return paper_bearing(capacity=0.2, interface_friction=0.14)


@pytest.fixture(scope="module")
def frame(bearing: LIRBearing) -> Frame:
    return shear_building(bearing, [60e3, 60e3], 60e6, base_mass=60e3)


@pytest.fixture(scope="module")
def seven(frame: Frame) -> xr.Dataset:
    return quietly(time_histories, frame, [full_sine(size, 0.4) for size in SLIDING])


@pytest.fixture(scope="module")
def with_failure(frame: Frame) -> xr.Dataset:
    """Seven runs; in the last one the sliders' overlap ends."""
    data = quietly(time_histories, frame, [full_sine(size, 0.4) for size in (*SLIDING[:-1], 4.0)])
    assert data["status"].to_numpy().tolist() == ["ok"] * 6 + ["slip_exceeded"]
    return data


def one(checks: Checks, title: str) -> Check:
    found = [check for check in checks if check.title == title]
    assert len(found) == 1, title
    return found[0]


def test_from_seven_motions_on_the_mean_counts_below_the_largest(frame, seven):
    assert (seven["status"] == "ok").all()
    moved = seven["peak_displacement"].to_numpy()[:, 0]
    drift = seven["peak_drift"].to_numpy()
    alone = lumped_mass(frame.bearings["bearing"].bearing, 180e3)  # nothing that overturns
    asce = history_checks(seven, frame, "ASCE 7-22")
    assert {c.title for c in asce.failed} == {
        "maximum uplift over the rim height: not evaluated"  # a stick on one bearing
    }
    assert history_checks(seven, alone, "ASCE 7-22").passed
    assert one(asce, "isolator displacement").demand == pytest.approx(moved.mean(), rel=1e-12)
    theta = one(asce, "storey drift ratio")
    assert (theta.demand, theta.limit) == pytest.approx((drift.mean(axis=0).max(), 0.02))
    assert theta.subject == ("floor-1", "floor-2")[int(drift.mean(axis=0).argmax())]
    assert one(asce, "residual slip").demand == pytest.approx(
        seven["peak_slip_left"].to_numpy().mean(), rel=1e-12
    )
    few = seven.isel(run=[0, 3, 5])
    chile = history_checks(few, frame, "NCh2745", action_level="maximum")
    assert one(chile, "isolator displacement").demand == pytest.approx(moved[5], rel=1e-12)
    assert not [check for check in chile if "drift" in check.title]
    above = history_checks(few, frame, "NCh2745", action_level="design")
    assert one(above, "storey drift ratio").limit == 0.003
    assert not [check for check in above if "isolator" in check.title or "slip" in check.title]
    assert {c.level for c in chile} | {c.level for c in above} == {"design", "maximum"}
    assert {c.level for c in asce} == {"MCE_R"}
    europe = history_checks(few, frame, "EN 1998-1")
    assert one(europe, "isolator displacement").demand == pytest.approx(1.2 * moved[5])
    nu_d = one(europe, "storey drift ratio")  # of damage limitation, for brittle elements
    assert (nu_d.demand, nu_d.limit) == pytest.approx((0.5 * drift[5].max(), 0.005), rel=1e-12)
    assert nu_d.clause == "EN 1998-1 4.4.3.2"
    for kind, limit in (("ductile", 0.0075), ("separate", 0.010)):
        chosen = HISTORY_RULES["EN 1998"].for_elements(kind)
        assert one(history_checks(few, frame, chosen), "storey drift ratio").limit == limit
    with pytest.raises(CheckError, match=r"nonstructural = 'brick': choose one of .'brittle'"):
        HISTORY_RULES["EN 1998"].for_elements("brick")
    with pytest.raises(CheckError, match="NCh2745 has one drift limit"):
        HISTORY_RULES["NCh2745"].for_elements("brittle")
    refused = history_checks(few, alone, "ASCE 7-22")
    assert [check.title for check in refused.failed] == ["number of motions"]


def test_a_run_that_failed_is_never_averaged_away(frame: Frame, with_failure: xr.Dataset) -> None:
    frame = lumped_mass(frame.bearings["bearing"].bearing, 180e3)  # nothing that overturns
    limits = DesignLimits(
        base_shear=1e9, floor_acceleration=100.0, rim_strength=1e9, interface_pressure=1e9
    )
    for code, level in (("ASCE 7-22", ""), ("EN 1998-1", ""), ("NCh2745", "maximum")):
        checks = history_checks(with_failure, frame, code, limits=limits, action_level=level)
        assert [c.title for c in checks if c.passed] == ["number of motions"]
        failed = one(checks, "runs that failed")
        assert "overlap supports: pulse 4 (" in failed.note
        assert "assumption checks of " in failed.note
        reason = "1 of 7 runs failed; the interface slipped further"
        for check in checks.failed[1:]:
            assert math.isfinite(check.demand)
            assert check.ratio == math.inf
            assert reason in check.void
            assert f"no valid value: {reason}" in check.statement
            assert "before failure" in check.said[0]
        moved = with_failure["peak_displacement"].to_numpy()[:, 0]
        gamma = HISTORY_RULES[code].displacement_factor
        demand = one(checks, "isolator displacement").demand
        assert demand == pytest.approx(gamma * moved.mean(), rel=1e-12)
        table = history_demands(with_failure, code)
        row = table.loc["isolator displacement"]
        assert row["value"] == row["envelope"] == pytest.approx(moved.mean(), rel=1e-12)
        assert (row["worst"], row["run"]) == (pytest.approx(moved.max()), "pulse 4 (failed)")
        assert row["void"].startswith(reason)
        assert table.attrs["statistics"] == {"value": "no valid value; mean of 7 runs, 1 failed"}
        assert np.isnan(table.loc["residual interface slip", "value"])
        left = with_failure["peak_slip_left"].to_numpy()[:6, 0]
        assert table.loc["residual interface slip", "worst"] == pytest.approx(left.max())


def test_one_unacceptable_run_may_be_allowed_at_a_price(frame, with_failure):
    """Mean of the six others, but at least 1.2 times the median of all, the fourth of seven."""
    rules = replace(HISTORY_RULES["ASCE 7-22"], unacceptable_allowed=1)
    check = one(history_checks(with_failure, frame, rules), "isolator displacement")
    moved = np.sort(with_failure["peak_displacement"].to_numpy()[:6, 0])
    assert check.demand == pytest.approx(max(moved.mean(), 1.2 * moved[3]), rel=1e-12)
    table = history_demands(with_failure, rules)
    row = table.loc["isolator displacement"]
    assert table.attrs["statistics"]["value"] == "mean of 6 of 7 runs, at least 1.2 medians of all"
    assert not table["void"].any()
    assert row["value"] == row["envelope"] == pytest.approx(check.demand, rel=1e-12)
    few = with_failure.isel(run=[0, 1, 6])
    assert not one(history_checks(few, frame, rules), "isolator displacement").passed


def test_uplift_makes_a_run_unacceptable_where_the_code_has_none(frame, seven):
    lifted = seven["peak_uplifts"].copy()
    lifted[2] = 3.0
    gone = seven.assign(
        peak_uplifts=lifted,
        peak_time_lifted=seven["peak_time_lifted"] + 0.02,
        peak_gap=seven["peak_gap"] + np.where(np.arange(7) == 2, 2e-3, 4e-4)[:, None],
    )
    alone = lumped_mass(frame.bearings["bearing"].bearing, 180e3)  # nothing that overturns
    checks = history_checks(gone, alone, "EN 1998-1")
    assert "a bearing lifted off: pulse 1.1" in one(checks, "runs that failed").note
    assert one(checks, "uplift duration above 1 mm").demand == pytest.approx(0.02)
    moved = gone["peak_displacement"].to_numpy()[:, 0]
    check = one(checks, "isolator displacement")
    assert check.demand == pytest.approx(1.2 * moved.mean(), rel=1e-12)
    assert not check.passed
    note = one(checks, "runs that failed").note
    assert note.startswith("1 of 7 runs failed; a bearing lifted off: pulse 1.1")
    assert "gaps up to 1 mm count as contact (pulse 0.8: 0.4 mm, 0.02 s; pulse 1: 0.4" in note
    assert note.count("0.4 mm") == 6
    small = gone.isel(run=[0, 1, 3])
    assert one(history_checks(small, alone, "EN 1998-1"), "uplift duration above 1 mm").passed
    title = "uplift duration above 1 mm: not evaluated"
    stick = one(history_checks(small, frame, "EN 1998-1"), title)
    assert not stick.passed
    assert stick.note.startswith("the model has one bearing and its tilt is restrained")
    any_gap = replace(HISTORY_RULES["EN 1998-1"], least_gap=0.0)
    assert (
        "3 of 3 runs failed" in one(history_checks(small, frame, any_gap), "runs that failed").note
    )
    unknown = small.assign(peak_gap=small["peak_gap"] * math.nan)
    assert not one(history_checks(unknown, alone, "EN 1998-1"), "uplift duration above 1 mm").passed
    assert history_checks(gone, alone, "ASCE 7-22").passed
    row = history_demands(gone, "ASCE 7-22").loc["uplifts, all bearings"]
    assert (row["value"], row["worst"], row["run"]) == (pytest.approx(3.0 / 7.0), 3.0, "pulse 1.1")
    assert row["note"] == ""
    table = history_demands(small, "EN 1998-1")
    assert table.loc["uplift duration", "worst"] == pytest.approx(0.02)
    assert table.loc["uplift duration", "note"] == "of any gap; a run fails above 1 mm (EN 1998-1)"


def test_runs_at_bounds_are_those_of_bounded_frames(frame: Frame) -> None:
    motions = [full_sine(1.0, 0.4), full_sine(1.4, 0.4)]
    scales = {"pulse 1": 1.1, "pulse 1.4": 0.9}
    runs = quietly(bounded_histories, frame, motions, BOUNDS, scales=scales)
    assert list(runs) == ["lower", "nominal", "upper"]
    for bound, data in runs.items():
        model = with_property_bounds(frame, bound, BOUNDS)
        alone = quietly(time_history, model, motions[0].scaled(1.1), recording=Recording.peaks())
        assert data["motion"].to_numpy().tolist() == ["pulse 1", "pulse 1.4"]
        assert float(data["peak_displacement"][0, 0]) == float(alone["peak_displacement"][0])
    checks = history_checks(runs, frame, "NCh2745", bounds=BOUNDS, action_level="maximum")
    limits = {c.bound: c.limit for c in checks if c.title == "slip over its stable limit s*"}
    for bound, factor in {"lower": 0.8, "nominal": 1.0, "upper": 1.2}.items():
        held = factor * frame.bearings["bearing"].bearing.slip_stability
        assert limits[bound] == pytest.approx(held, rel=1e-12)
    table = history_demands(runs, "NCh2745")
    each = [float(data["peak_displacement"].max()) for data in runs.values()]
    row = table.loc["isolator displacement"]
    assert table.attrs["statistics"] == dict.fromkeys(runs, "largest of 2 runs")
    heads = [f"{bound}, largest of 2 runs" for bound in runs]
    assert list(headed(table).columns) == [
        "unit",
        *heads,
        "envelope of these",
        "where",
        "worst of all 6 runs",
        "in run",
        "note",
    ]
    assert row[["lower", "nominal", "upper"]].tolist() == pytest.approx(each)
    assert (row["envelope"], row["where"]) == (pytest.approx(max(each)), "bearing")
    with pytest.raises(CheckError, match=r"no factor for the motion 'pulse 1\.4'"):
        bounded_histories(frame, motions, BOUNDS, scales={"pulse 1": 1.0})


def equivalent(frame: Frame, s_m1: float) -> EquivalentLinear:
    system = IsolationSystem.from_frame(frame, plan=(10.0, 10.0))
    above, spectrum = Superstructure.from_frame(frame, R=4.0), Spectrum.asce7(s_ms=1.5, s_m1=s_m1)
    return equivalent_linear(system, spectrum, bounds=BOUNDS, superstructure=above)


def test_minima_raise_displacement_shear_and_drift(frame: Frame, seven: xr.Dataset) -> None:
    limits, runs = DesignLimits(base_shear=1e9), {"lower": seven}
    given = {"bounds": BOUNDS, "limits": limits}
    plain = history_checks(runs, frame, "ASCE 7-22", **given)
    strong = equivalent(frame, 1.0)
    raised = history_checks(runs, frame, "ASCE 7-22", equivalent=strong, **given)
    found = strong["lower"].trace
    reduced = found.value("D_prime_M") / found.value("D_M")
    least = 0.8 * strong["lower"].total_displacement * reduced
    assert one(raised, "isolator displacement").demand == pytest.approx(least, rel=1e-12)
    shear = float(seven["peak_base_shear"].mean())
    factor = 0.9 * strong["lower"].base_shear / shear
    assert factor > 1.1
    assert one(raised, "base shear").demand == pytest.approx(factor * shear)
    ratio = one(raised, "storey drift ratio").demand / one(plain, "storey drift ratio").demand
    storey = one(raised, "storey shear of time histories")
    assert one(raised, "base shear of time histories").ratio == pytest.approx(factor)
    assert ratio == pytest.approx(max(factor, storey.limit / storey.demand))
    weak = history_checks(runs, frame, "ASCE 7-22", equivalent=equivalent(frame, 0.3), **given)
    own = [c for c in weak if not c.title.endswith("shear of time histories")]
    assert len(own) == len(weak) - 2
    grown = {"storey drift ratio": max(c.ratio for c in weak if c not in own)}
    assert grown["storey drift ratio"] > 1.0
    expected = [grown.get(c.title, 1.0) * c.demand for c in plain]
    assert [c.demand for c in own] == pytest.approx(expected, rel=1e-12)
    with pytest.raises(CheckError, match="no minima"):
        history_checks(runs, frame, "NCh2745", equivalent=strong, action_level="maximum", **given)


def test_the_slip_that_holds_goes_by_the_pressure_of_the_runs(bearing: LIRBearing) -> None:
    """Friction rises as the pressure falls: the minimum axial force of all runs decides."""
    law = PressureDependence(rate=8e-9, reference_pressure=8e6)
    own = replace(bearing, pressure_dependence=law, interface_friction=0.2)
    model = shear_building(own, [60e3, 60e3], 60e6, base_mass=60e3)
    time = np.arange(0.0, 6.0, 0.01)
    lifting = 4.0 * np.sin(2.0 * math.pi * time) * (time < 2.0)
    wave = full_sine(0.8, 0.4).components[:, 0]
    data = quietly(
        time_histories,
        model,
        [
            GroundMotion(x=wave, z=k * lifting, dt=0.01, name=f"{k:g}")
            for k in np.linspace(0.4, 1.0, 7)
        ],
    )
    least = -float(data["peak_axial_tension"].max())
    assert 0.0 < least < 0.8 * 180e3 * 9.80665
    check = one(history_checks(data, model, "ASCE 7-22"), "slip over its stable limit s*")
    factor = math.exp(-8e-9 * (least / (math.pi * 0.15**2) - 8e6))
    whole = own.effective_radius * 0.2 - factor * 0.065 * 2.0 * 1.185
    assert check.limit == pytest.approx(whole, rel=1e-9)


def test_runs_that_do_not_fit_are_refused(frame: Frame, seven: xr.Dataset) -> None:
    with pytest.raises(CheckError, match=r"2 levels, .*'maximum' \(motions times 1.2: isolation"):
        history_checks(seven, frame, "NCh2745")
    with pytest.raises(CheckError, match="action_level = 'MCE'"):
        history_checks(seven, frame, "ASCE 7-22", action_level="MCE")
    twice = seven.isel(run=[0, 0, 1])
    refused(CheckError, "occurs twice", history_checks, twice, frame, "EN 1998-1")
    refused(CheckError, "no dimension 'run'", history_checks, xr.Dataset(), frame, "EN 1998-1")
    with pytest.raises(CheckError, match="interrupted"):
        history_checks(seven.assign_attrs(status="interrupted"), frame, "EN 1998-1")
    refused(CheckError, "code = 'UBC'", history_checks, seven, frame, "UBC")  # type: ignore[arg-type]
    named = shear_building(frame.bearings["bearing"].bearing, 1e5, 1e8, plan=(1, 6.0))
    refused(CheckError, "not in both the runs and the", history_checks, seven, named, "EN 1998-1")
    models = seven.assign_coords(model=("run", ["a"] * 3 + ["b"] * 4))
    refused(CheckError, "2 structures", history_checks, models, frame, "EN 1998-1")
