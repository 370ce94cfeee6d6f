"""One quantity is one number: in peaks, the summary, demands, the report and figures."""

import math
import warnings

import numpy as np
import pytest
import xarray as xr

from frames import (
    AuditWarning,
    Frame,
    GroundMotion,
    Recording,
    peaks,
    shear_building,
    storey_drift,
    time_histories,
    time_history,
)
from frames.demo import table_of
from frames.design import HISTORY_RULES, history_demands
from frames.design.histories.suite import names_of, peaks_of_runs
from frames.plots import storey_profiles
from frames.results.quantities import DEMANDS
from lir_element import AnalysisWarning
from tests.scenes import paper_bearing

TIME = np.arange(0.0, 4.0, 0.01)


def motion() -> GroundMotion:
    """Along x and y together: the size in plan is well above both components."""
    wave = 1.8 * np.exp(-0.5 * TIME) * np.sin(2.0 * math.pi * TIME / 1.5)
    return GroundMotion(x=wave, y=0.8 * wave, dt=0.01, name="both")


@pytest.fixture(scope="module")
def frame() -> Frame:
    bearing = paper_bearing(radius=1.2, capacity=0.15, friction=0.05, interface_friction=0.11)
    return shear_building(bearing, [80e3, 60e3], 60e6, base_mass=60e3, plan=(1, 6.0))


@pytest.fixture(scope="module")
def data(frame: Frame) -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AuditWarning)
        found = time_history(frame, motion())
    assert found.attrs["status"] == "ok"
    return found


@pytest.fixture(scope="module")
def batch(frame: Frame) -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", (AuditWarning, AnalysisWarning))
        return time_histories(frame, [motion()], workers=1)


def test_drift_is_the_vector_of_both_components(data: xr.Dataset) -> None:
    along = float(np.abs(storey_drift(data)).max())
    whole = float(np.linalg.norm(storey_drift(data).to_numpy(), axis=-1).max())
    assert whole > 1.05 * along  # else this test tells nothing
    assert peaks(data).loc["storey drift, mean", "value"] == pytest.approx(whole, rel=1e-12)


def test_the_summary_is_the_table_of_peaks(data: xr.Dataset) -> None:
    table = peaks(data)["value"]
    text = table_of({"A": data}).splitlines()
    drift = next(line for line in text if line.startswith("storey drift, mean"))
    assert float(drift.split()[-1]) == pytest.approx(100.0 * table["storey drift, mean"], abs=6e-4)


def test_what_a_run_that_was_interrupted_left_is_not_known(data: xr.Dataset) -> None:
    cut = data.assign_attrs(status="interrupted")
    assert math.isnan(peaks(cut).loc["residual bearing displacement", "value"])


@pytest.mark.parametrize("code", HISTORY_RULES)
def test_demands_of_one_run_are_its_peaks(data: xr.Dataset, batch: xr.Dataset, code: str) -> None:
    demands, table = history_demands(batch, code), peaks(data)["value"]
    assert demands.attrs["statistics"] == {"value": "1 run"}
    titles = {quantity.demand: quantity.title for quantity in DEMANDS.values()}
    assert list(demands.index) == list(titles)
    for row, quantity in titles.items():
        for column in ("value", "envelope", "worst"):
            value = demands.loc[row, column]
            assert value == pytest.approx(table[quantity], rel=1e-9, abs=1e-12), (row, column)


def test_the_figure_of_storeys_has_the_peaks(data: xr.Dataset) -> None:
    left, right = storey_profiles(data).axes
    known = peaks(data)["value"]
    assert "resultant in plan" in left.get_xlabel()
    assert "resultant in plan" in right.get_xlabel()
    [stairs] = [patch for patch in left.patches if hasattr(patch, "get_data")]
    drift = np.asarray(stairs.get_data().values)
    assert drift.max() == pytest.approx(100.0 * known["storey drift, mean"], rel=1e-12)
    mean, rings = right.lines
    floors = known["floor acceleration in plan, mean"]
    assert max(mean.get_xdata()) == pytest.approx(floors, rel=1e-12)
    nodes = known["acceleration in plan, worst node"]
    assert max(rings.get_xdata()) == pytest.approx(nodes, rel=1e-12)
    [corners] = left.lines
    lines = 100.0 * known["storey drift, maximum at any column line"]
    assert max(corners.get_xdata()) == pytest.approx(lines, rel=1e-12)


def test_the_figure_of_storeys_has_them_where_steps_were_left_out(frame, data):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AuditWarning)
        few = time_history(frame, motion(), recording=Recording(every=40))
    full, thin = (storey_profiles(each).axes for each in (data, few))
    for k, panel in enumerate(full):
        for line, other in zip(panel.lines, thin[k].lines, strict=True):
            assert other.get_xdata() == pytest.approx(line.get_xdata(), rel=1e-9)


def test_what_a_batch_reached_has_the_names_of_the_single_run(data, batch):
    for name in ("displacement", "slip", "drift", "line_drift", "floor_plan", "storey_shear"):
        one, many = peaks_of_runs(data, name), peaks_of_runs(batch, name)
        assert many == pytest.approx(one, rel=1e-9, abs=1e-12), name
        assert names_of(data, name) == names_of(batch, name)
