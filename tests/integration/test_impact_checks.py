"""What impacts and landings ask of bearings and structure, against the runs' own histories."""

import math
import re
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import (
    Frame,
    GroundMotion,
    Recording,
    floor_acceleration,
    lumped_mass,
    peaks,
    shear_building,
    storey_drift,
    time_histories,
    time_history,
)
from frames.design import (
    Check,
    CheckError,
    Checks,
    DesignLimits,
    device_checks,
    event_checks,
    history_checks,
    impact_checks,
    impact_demand,
    overlap_area,
    repeated_motion,
    resultant_offsets,
    rim_engagement,
    slips_of_events,
    uplift_events,
)
from lir_element import Features, LIRBearing
from tests.scenes import full_sine, paper_bearing, quietly


def device(**other: Any) -> LIRBearing:
    capacity = None if "rims" in other else 0.2
    return paper_bearing(
        **{"capacity": capacity, "friction": 0.06, "interface_friction": 0.14} | other
    )


@pytest.fixture(scope="module")
def frame() -> Frame:
    return shear_building(device(), [60e3, 60e3], 60e6, base_mass=60e3)


@pytest.fixture(scope="module")
def run(frame: Frame) -> xr.Dataset:
    data: xr.Dataset = quietly(time_history, frame, full_sine(1.5))
    assert data.attrs["status"] == "ok"
    return data


def one(checks: Checks, title: str) -> Check:
    found = [check for check in checks if check.title == title]
    assert len(found) == 1, title
    return found[0]


def test_impacts_are_compared_with_what_was_before(run: xr.Dataset) -> None:
    met = run["rim_force"].max(("bearing", "surface")).to_numpy() > 0.0
    time = run["time"].to_numpy()
    first = int(np.argmax(met))
    assert 0.2 < time[first] < 3.0
    near = np.array([bool(met[(time >= t - 0.3 - 1e-9) & (time <= t)].any()) for t in time])
    shear = np.hypot(*run["base_shear"].to_numpy()[:, :2].T)
    drift = np.hypot(*np.moveaxis(storey_drift(run).to_numpy(), -1, 0))
    floors = np.hypot(*np.moveaxis(floor_acceleration(run).to_numpy(), -1, 0)[:2])
    table = impact_demand(run)
    histories = {
        "base shear": shear,
        "drift of floor-1": drift[:, 0],
        "acceleration of floor-2": floors[:, 2],
    }
    for name, history in histories.items():
        row = table.loc[name]
        assert row["before"] == history[:first].max()
        assert row["at_impact"] == history[near].max()
        assert row["ratio"] == row["at_impact"] / row["before"] > 1.0


def test_rims_engage_where_geometry_has_them(frame: Frame, run: xr.Dataset) -> None:
    table = rim_engagement(run)
    assert table["surface"].tolist() == ["bottom", "top"]
    assert table["displacement"].to_numpy() == pytest.approx([0.2, 0.2], rel=0.02)
    assert table["rim_force"].max() == peaks(run).loc["rim force", "value"]
    checks = impact_checks(run, frame, total_displacement=0.4).of("17.2.4.5")
    assert [c.passed for c in checks] == [False, False]
    assert checks[0].demand == pytest.approx(table["displacement"][0] / 0.4)


def test_demands_are_the_peaks_of_the_run(frame: Frame, run: xr.Dataset) -> None:
    table = peaks(run)["value"]
    limits = DesignLimits(
        rim_strength=1e6,
        interface_pressure=100e6,
        liner_pressure=100e6,
        base_shear=1e6,
        drift=0.01,
        floor_acceleration=10.0,
        displacement_left=0.2,
        lateral_force=1e6,
    )
    stick = impact_checks(run, frame, limits=limits)  # on one bearing, which knows no overturning
    assert {c.title for c in stick.failed} == {
        "maximum uplift over the rim height: not evaluated",
        "pressure on the sliders' overlap: not evaluated",
        "pressure on the liner around its resultant: not evaluated",
    }
    alone = lumped_mass(frame.bearings["bearing"].bearing, 180e3)  # nothing that overturns
    checks = impact_checks(run, alone, limits=limits)
    assert checks.passed
    expected = {
        "isolator displacement": table["bearing displacement"],
        "slip over the overlap": table["interface slip"],
        "residual slip": table["residual interface slip"],
        "rim force": table["rim force"],
        "lateral force of a bearing": table["bearing force in plan"],
        "residual displacement": table["residual bearing displacement"],
        "pressure on the sliders' overlap": table["axial force"]
        / overlap_area(0.15, table["interface slip"]),
        "pressure on the liner around its resultant": table["axial force"]
        / overlap_area(0.15, 2.0 * 1.185 * (table["interface slip"] + 0.06 * 0.12) / 2.25),
    }
    for title, value in expected.items():
        assert one(checks, title).demand == pytest.approx(value, rel=1e-12), title
    assert table["interface slip"] > 0.01
    part = quietly(time_history, frame, full_sine(1.5), recording=Recording.peaks())
    some = DesignLimits(
        rim_strength=1e6, interface_pressure=100e6, liner_pressure=100e6, lateral_force=1e6
    )
    again = {c.title: c.demand for c in impact_checks(part, alone, limits=some)}
    assert again.items() <= {c.title: c.demand for c in checks}.items()
    with pytest.raises(ValueError, match="only the first and last step"):
        impact_checks(part, frame, limits=limits)


def test_a_failed_run_has_no_values(frame: Frame) -> None:
    data = quietly(time_history, frame, full_sine(4.0))
    alone = lumped_mass(frame.bearings["bearing"].bearing, 180e3)  # nothing that overturns
    checks = impact_checks(data, alone)
    assert checks[0].title == "run is complete"
    assert "slipped further" in checks[0].note
    assert len(checks.failed) == len(checks) > 3
    assert all(math.isfinite(c.demand) and "slipped further" in c.void for c in checks[1:])
    check = one(checks, "slip over the overlap")
    assert "no valid value: " in check.statement
    # the step that failed is in no history, but in the message and in what was reached
    said = re.search(r"slip (\S+) m, slip_capacity (\S+) m", data.attrs["message"])
    assert said is not None
    slip, overlap = float(said[1]), float(said[2])
    assert slip > overlap > float(data["interface_slip_size"].max())
    assert check.demand == pytest.approx(slip, rel=1e-3)
    assert check.compared > 1.0
    row = peaks(data).loc["interface slip over overlap"]
    assert row["value"] == pytest.approx(slip / overlap, rel=1e-3)
    assert row["time"] == pytest.approx(data.attrs["failed_at"], rel=1e-12)
    assert peaks(data).loc["interface slip", "value"] == check.demand
    batch = quietly(time_histories, frame, {"a": full_sine(4.0), "b": full_sine(1.0)}, workers=1)
    found = batch["peak_slip"].max("bearing").to_numpy()
    assert found[0] == pytest.approx(check.demand, rel=1e-12)
    assert found[1] < overlap  # of another run
    least = quietly(time_history, frame, full_sine(4.0), recording=Recording.peaks())
    assert peaks(least).loc["interface slip", "value"] == pytest.approx(check.demand, rel=1e-12)
    early = data.sel(time=slice(0.0, 0.8 * data.attrs["failed_at"]))
    assert peaks(early).loc["interface slip over overlap", "value"] < 1.0


def test_the_force_at_which_a_rim_broke_is_in_the_peaks() -> None:
    bearing = device(capacity=0.1, rim_overrun=0.005).as_dcfp()
    plain = lumped_mass(bearing, 1e5)
    data = quietly(time_history, plain, full_sine(8.0))
    assert data.attrs["status"] == "rim_overrun"
    row, before = peaks(data).loc["rim force"], float(data["rim_force"].max())
    known = plain.bearings[row["where"]].bearing.resolved()
    assert row["value"] > max(before, known["rim_stiffness"] * known["rim_overrun"])
    assert row["time"] == data.attrs["failed_at"]
    check = one(impact_checks(data, plain, limits=DesignLimits(rim_strength=9e9)), "rim force")
    assert check.demand == row["value"]
    assert not check.passed


def test_rims_that_were_left_out_and_would_have_been_met_are_no_pass(frame: Frame) -> None:
    title = "runs whose modelling assumptions are violated"
    for size, passed in ((0.5, True), (1.5, False)):
        out = Features.all().without("rims")
        data = quietly(time_history, frame, full_sine(size), features=out)
        check = one(impact_checks(data, frame), title)
        assert check.passed is passed
        assert check.note == "rims"
        runs = quietly(time_histories, frame, full_sine(size), features=out)
        assert one(history_checks(runs, frame, "EN 1998-1"), title).demand == check.demand


def test_resultant_on_one_rim_is_where_the_formula_has_it() -> None:
    """Bottom rim alone: the upper slider's axis is (R - h / 2) mu_h - mu R off, that is s* / 2."""
    bearing = device(rims=(0.1053, 0.15))
    data = quietly(time_history, lumped_mass(bearing, 2e5), full_sine(1.5))
    slip = data["interface_slip_size"].to_numpy()[:, 0]
    k = int(np.argmax(slip > 0.2e-3))
    assert slip[k] < 2e-3
    checks = device_checks(bearing, (2e6, 2e6), slip=slip[k])
    share = float(data["interface_eccentricity"][k, 0]) / 0.15
    assert one(checks, "normalised eccentricity e/a at the rims").demand == pytest.approx(
        share, rel=1e-3
    )


def test_events_in_a_row_are_followed_one_by_one(frame: Frame, run: xr.Dataset) -> None:
    motion, ends = repeated_motion(full_sine(1.5), 2, pause=3.0)
    assert motion.duration == pytest.approx(2 * (full_sine(1.5).duration + 3.0) + 0.01)
    assert ends == pytest.approx((9.0, 17.99))
    data = quietly(time_history, frame, motion)
    assert data.attrs["status"] == "ok"
    table = slips_of_events(data, ends)
    slip, time = data["interface_slip_size"].to_numpy()[:, 0], data["time"].to_numpy()
    assert table["slip"][0] == pytest.approx(float(peaks(run).loc["interface slip", "value"]))
    assert table["slip"].tolist() == [slip[time <= 9.0].max(), slip[time >= 9.0].max()]
    assert table["slip_left"].tolist() == [slip[np.argmin(np.abs(time - 9.0))], slip[-1]]
    assert table["slip"][1] > 1.2 * table["slip"][0]
    checks = event_checks(data, frame, ends, limits=DesignLimits(slip_left=0.02))
    assert one(checks, "residual slip, event 1").limit == 0.02
    assert one(checks, "slip, event 2").demand == table["slip"][1]
    assert one(checks, "slip, event 2").limit == 0.15 < device().slip_stability
    longer = slips_of_events(data, (9.0, 17.99, 30.0))
    assert longer["event"].tolist() == [1, 2]
    with pytest.raises(CheckError, match="rising"):
        slips_of_events(data, (9.0, 5.0))


def test_a_mass_thrown_up_flies_and_lands() -> None:
    """The ground falls away with 1.5 g for 0.1 s and goes on: the mass falls freely."""
    time = np.arange(0.0, 1.5, 0.002)
    z = np.where(time < 0.1, -1.5, 0.0) + np.where((time >= 0.5) & (time < 0.6), 1.5, 0.0)
    frame = lumped_mass(device(), 2e5)
    data = quietly(time_history, frame, GroundMotion(z=9.80665 * z, dt=0.002, name="drop"))
    events = uplift_events(data)
    row = peaks(data)["value"]
    assert len(events) == row["uplifts, all bearings"] > 0
    assert events["duration"].sum() == pytest.approx(row["uplift duration"], abs=0.01)
    assert events["gap"].max() == row["maximum uplift"]
    # apart by 0.5 g for 0.1 s, then slower for 0.05 s, and down again; the contact's strain under
    # the weight throws it up by some per cent more
    first, gap = events.iloc[0], 9.80665 * (0.25 * 0.1**2 + 0.5 * 0.05**2)
    assert first["gap"] == pytest.approx(1.05 * gap, rel=0.05)
    flight = 0.15 + math.sqrt(2.0 * gap / 9.80665)
    assert first["duration"] == pytest.approx(flight, abs=0.01)
    assert events["landing_force"].max() == row["axial force"] > 2e6
    limits = DesignLimits(uplift_gap=0.02, axial_force=60e6)
    checks = impact_checks(data, frame, limits=limits)
    assert not one(checks, "maximum uplift").passed
    for title in ("force of landing", "maximum axial force"):
        assert one(checks, title).demand == row["axial force"]


def test_resultant_offsets_say_what_pressed() -> None:
    """By loops over the histories; a rim is set to press alone, its other 1.5 mm away."""
    frame = shear_building(device(), [60e3], 60e6, base_mass=60e3)
    data = quietly(time_history, frame, full_sine(2.6))
    offset = data["interface_eccentricity"][:, 0] / data["slider_radius"][0]
    k = int(np.argmax(offset.to_numpy()))
    row = resultant_offsets(data).iloc[0]
    assert (row["offset"], row["time"]) == (float(offset[k]), float(data["time"][k]))
    kept = quietly(time_histories, frame, [full_sine(2.6)])["peak_eccentricity"]
    assert row["offset"] == pytest.approx(float(kept[0, 0]))
    assert row["load"] == float(data["axial_force"][k, 0] / data["static_axial_force"][0])
    limit = 0.5 * row["offset"]
    above = [
        float(dt) for dt, e in zip(np.diff(data["time"]), offset[:-1], strict=True) if e > limit
    ]
    assert resultant_offsets(data, limit=limit)["time_above"][0] == pytest.approx(sum(above))
    data["rim_force"][k, 0] = [3e3, 0.0]
    data["slider_displacement"][k, 0] = 0.0
    data["slider_displacement"][k, 0, 1, 0] = float(data["rim_displacement"][0, 1]) - 0.0015
    row = resultant_offsets(data).iloc[0]
    assert row["rims"] == "bottom"
    assert row["clearance"] == pytest.approx(0.0015)
    data["axial_force"][k, 0] = 0.04 * data["static_axial_force"][0]
    assert resultant_offsets(data)["time"][0] != float(data["time"][k])
    assert resultant_offsets(data, least_load=0.03)["time"][0] == float(data["time"][k])
    with pytest.raises(CheckError, match="least_load"):
        resultant_offsets(data, least_load=2.0)


def test_eccentricity_check_says_what_its_level_can_say() -> None:
    frame = shear_building(device(), [60e3], 60e6, base_mass=60e3)
    data = quietly(time_history, frame, full_sine(1.0))
    (check,) = (c for c in impact_checks(data, frame) if c.title.startswith("normalised ecc"))
    assert check.note.startswith(
        "counts while N > 0.5 of that at rest; at the level 'pendulum' one rim"
    )
    assert "level 'contact'" in check.note


def test_eccentricity_counts_while_half_of_the_load_at_rest_presses() -> None:
    """At the peak the load is set to 30 %: another instant governs, the note has what it was."""
    frame = shear_building(device(), [60e3], 60e6, base_mass=60e3)
    data = quietly(time_history, frame, full_sine(1.5)).load()
    offset = (data["interface_eccentricity"][:, 0] / data["slider_radius"][0]).to_numpy()
    k, rest = int(np.argmax(offset)), float(data["static_axial_force"][0])
    title, limits = "normalised eccentricity e/a", DesignLimits(eccentricity=0.9 * float(offset[k]))
    pressed = data["axial_force"].to_numpy()[:, 0] > 0.5 * rest
    assert pressed[k]
    before = one(impact_checks(data, frame, limits=limits), title)
    assert before.demand == pytest.approx(float(offset[k]))
    assert "under less" not in before.note
    data["axial_force"][k, 0] = 0.3 * rest
    pressed[k] = False
    after = one(impact_checks(data, frame, limits=limits), title)
    assert after.demand == pytest.approx(float(offset[pressed].max()))
    assert f"under less, down to 0.05 of it, up to {offset[k]:.2f} (" in after.note
