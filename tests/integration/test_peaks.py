"""What an engineer reads off a time history: peaks with their time and place."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    GroundMotion,
    drift_by_line,
    floor_acceleration,
    floor_spectrum,
    load,
    lumped_mass,
    moment_frame,
    peaks,
    save,
    storey_drift,
    summary,
    time_history,
    uplift_gap,
)
from frames.motion.spectra import response_spectrum
from frames.results.findings import doubts_of
from lir_element import AnalysisWarning
from tests.scenes import simple_bearing as bearing
from tests.scenes import swell

TIME = np.arange(0.0, 4.0, 0.005)
MOTION = swell(x=(1.7, 1.4), y=(1.0, 0.8))


@pytest.fixture(scope="module")
def data():
    """Return the history of a building with a heavy corner, whose rims are met."""
    frame = moment_frame((2, 1), 2, bearing=bearing())
    frame.add_mass("floor-2-2-1", 4e4)
    return time_history(frame, MOTION, dt=0.005)


def test_values_times_and_places(data):
    table = peaks(data)
    u = np.linalg.norm(data["bearing_displacement"].to_numpy()[..., :2], axis=-1)
    step, place = np.unravel_index(u.argmax(), u.shape)
    row = table.loc["bearing displacement"]
    assert row["value"] == u.max()
    assert (row["time"], row["where"], row["unit"]) == (
        data["time"].to_numpy()[step],
        data["bearing"].to_numpy()[place],
        "m",
    )
    capacity = bearing().lateral_capacity
    over = table.loc["bearing displacement over capacity", "value"]
    assert over == pytest.approx(u.max() / capacity, rel=1e-12)
    assert over > 1.0  # rims are met
    slip = float(data["interface_slip_size"].max())
    assert table.loc["interface slip over overlap", "value"] == pytest.approx(slip / 0.1)
    assert table.loc["minimum axial force", "value"] == float(data["axial_force"].min())
    assert table.loc["rim force", "value"] == float(data["rim_force"].max())
    shear = np.linalg.norm(data["base_shear"].to_numpy()[:, :2], axis=-1).max()
    assert table.loc["base shear", "value"] == shear
    assert table.loc["uplifts, all bearings", "value"] == 0.0
    assert table.loc["maximum uplift", "where"] == ""


def test_corners_drift_more_than_the_mean(data):
    mean, lines = storey_drift(data), drift_by_line(data)
    assert lines.sizes["line"] == 2 * 6
    for storey in mean["storey"].to_numpy():
        own = lines.where(lines["storey"] == storey, drop=True)
        assert own.sizes["line"] == 6
        assert_allclose(own.mean("line"), mean.sel(storey=storey), rtol=0.0, atol=1e-12)
    table = peaks(data)
    assert (
        table.loc["storey drift, maximum at any column line", "value"]
        > table.loc["storey drift, mean", "value"]
    )
    assert table.loc["torsion: maximum at any column line over mean drift", "value"] > 1.01


def test_spectrum_of_a_floor_is_that_of_its_motion(data):
    periods = [0.0, 0.1, 0.5, 2.0]
    found = floor_spectrum(data, periods).sel(level="floor-2", axis="x")
    motion = floor_acceleration(data).sel(level="floor-2", axis="x").to_numpy()
    expected = response_spectrum(motion, 0.005, periods)["pseudo_acceleration"]
    assert_allclose(found, expected, rtol=1e-12)
    assert float(found[0]) == np.abs(motion).max()


def test_side_by_side_and_after_loading(data, tmp_path):
    save(data, tmp_path / "run.nc")
    table = summary({"run": data, "loaded": load(tmp_path / "run.nc")})
    assert list(table.columns) == ["run", "loaded"]
    assert table.loc["status"].tolist() == ["ok", "ok"]
    numbers = table.drop(index=["status", "audit"]).astype(float)
    assert_allclose(numbers["run"], numbers["loaded"], rtol=1e-12)
    assert table.loc["bearing displacement [m]", "run"] == peaks(data)["value"].iloc[0]
    assert table.loc["audit", "run"] == "; ".join(doubts_of(data))


def test_uplift_is_counted_and_its_gap_is_that_of_free_flight():
    """Thrown up by a vertical pulse, a mass flies: the gap grows and falls as a parabola does."""
    pulse = np.where(TIME < 0.1, 30.0 * np.sin(np.pi * TIME / 0.1), 0.0)
    pulse -= np.where((TIME >= 0.1) & (TIME < 0.2), 30.0 * np.sin(np.pi * (TIME - 0.1) / 0.1), 0.0)
    data = time_history(lumped_mass(bearing(), 3e4), GroundMotion(z=pulse, dt=0.005), 1.0, dt=1e-3)
    table = peaks(data)
    assert table.loc["uplifts, all bearings", "value"] >= 1.0
    gap = uplift_gap(data).to_numpy()[:, 0]
    height = data["bearing_displacement"].to_numpy()[:, 0, 2]
    assert gap.max() > 5e-3
    assert_allclose(gap[gap > 0.0], height[gap > 0.0], rtol=0.0, atol=1e-9)
    assert table.loc["maximum uplift", "value"] == gap.max()
    lifted = (data["axial_force"].to_numpy()[:, 0] <= 0.0)[1:].sum() * 1e-3
    assert table.loc["uplift duration", "value"] == pytest.approx(lifted, rel=1e-9)


def test_a_run_that_stopped_leaves_nothing():
    model = lumped_mass(bearing(slip_capacity=0.005), 3e4)
    with pytest.warns(AnalysisWarning):
        data = time_history(model, MOTION, dt=0.005)
    table = peaks(data)
    assert math.isnan(table.loc["residual interface slip", "value"])
    assert math.isnan(table.loc["residual bearing displacement", "value"])
    assert summary({"one": data}).loc["status", "one"].startswith("slip_exceeded at ")
    assert peaks(data).loc["duration computed", "where"].startswith("slip_exceeded at ")
