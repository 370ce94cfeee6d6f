"""Files of results: laid out as h5netcdf lays them out, read as it reads them."""

import io
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray as xr

from frames import load, save
from frames.results.netcdf import read, written

PACKED = {"zlib": True, "complevel": 2, "shuffle": True}


def result() -> xr.Dataset:
    """Of all kinds that results have: gaps, texts, truths, scalars, coordinates over two."""
    time = np.linspace(0.0, 1.0, 40)
    wave = np.sin(np.outer(time, [1.0, 2.0, 3.0]))
    wave[3, 1] = np.nan
    return xr.Dataset(
        {
            "u": (("time", "bearing"), wave, {"units": "m", "long_name": "displacement"}),
            "steps": ("run", np.array([3, 5]), {"units": "1"}),
            "left": (("run", "axis"), np.arange(6.0).reshape(2, 3)),
            "status": ("run", np.array(["ok", "slip_exceeded"])),
            "message": ("run", np.array(["", "ü stays"], dtype=object)),
            "held": ("bearing", np.array([True, False, True])),
            "single": ("time", np.sin(time).astype(np.float32)),
            "energy": ((), 2.5, {"units": "J"}),
            "name": ((), "house"),
        },
        coords={
            "time": ("time", time, {"units": "s"}),
            "bearing": ["a", "b", "c"],
            "motion": ("run", ["x", "y"]),
            "when": (("run", "axis"), np.ones((2, 3))),
        },
        attrs={"status": "ok", "dt": 0.005, "count": 3, "words": ["a", "b"], "pair": [1.0, 2.0]},
    )


def by_library(path: Path) -> xr.Dataset:
    with xr.open_dataset(path, engine="h5netcdf") as data:
        return data.load()


def attributes(file: h5py.File, owner: Any) -> dict[str, str]:
    found = {}
    for name, value in owner.attrs.items():
        if name == "REFERENCE_LIST":
            value = sorted((file[place].name, int(axis)) for place, axis in value)
        elif name == "DIMENSION_LIST":
            value = [file[places[-1]].name for places in value]
        kind = getattr(value, "dtype", type(value).__name__)
        found[name] = f"{kind} {np.asarray(value).tolist()}"
    return found


def layout(content: bytes) -> dict[str, Any]:
    """All that is in a file but the versions of those who wrote it, in its order."""
    found = {}
    with h5py.File(io.BytesIO(content), "r", track_order=True) as file:
        found["order"] = list(file)
        found["/"] = attributes(file, file)
        assert found["/"].pop("_NCProperties").startswith("|S")
        for name, stored in file.items():
            how = (stored.dtype.str, stored.shape, stored.maxshape, str(stored.fillvalue))
            packed = (stored.compression, stored.compression_opts, stored.shuffle, stored.chunks)
            found[name] = how, packed, attributes(file, stored), repr(stored[...].tolist())
    return found


@pytest.mark.parametrize("encoding", [{}, {"u": PACKED | {"dtype": "float32"}, "single": PACKED}])
def test_a_file_is_that_of_the_library(encoding: dict[str, Any]) -> None:
    content = written(result(), encoding)
    assert content is not None
    library = result().to_netcdf(None, engine="h5netcdf", encoding=encoding)
    assert layout(content) == layout(bytes(library))


@pytest.mark.parametrize("writer", ["own", "library"])
def test_a_file_is_read_as_by_the_library(writer: str, tmp_path: Path) -> None:
    path, data = tmp_path / "run.nc", result()
    if writer == "own":
        save(data, path)
    else:
        data.to_netcdf(path, engine="h5netcdf")
    found, expected = read(path), by_library(path)
    assert found is not None
    xr.testing.assert_identical(found, expected)
    assert list(found.variables) == list(expected.variables)
    assert list(found.coords) == list(expected.coords)
    for name, variable in expected.variables.items():
        assert found[name].dtype == variable.dtype, name
        kinds = {key: type(value) for key, value in variable.attrs.items()}
        assert {key: type(value) for key, value in found[name].attrs.items()} == kinds
    assert found["u"].dtype == np.float64


def test_what_was_packed_is_packed_when_it_is_saved_again(tmp_path: Path) -> None:
    save(result(), tmp_path / "one.nc", compress=True)
    save(load(tmp_path / "one.nc"), tmp_path / "two.nc")
    one, two = ((tmp_path / name).read_bytes() for name in ("one.nc", "two.nc"))
    assert layout(one) == layout(two)
    with h5py.File(tmp_path / "two.nc") as file:
        assert file["u"].compression == "gzip"
        assert file["u"].dtype == np.float32


@pytest.mark.parametrize(
    "strange",
    [
        xr.Dataset({"none": ("run", np.zeros(0))}),
        xr.Dataset({"letters": ("run", np.array([b"a", b"b"]))}),
        xr.Dataset({"u": ("run", np.ones(2))}, attrs={"empty": np.zeros(0)}),
        xr.Dataset({"day": ("run", np.array(["2026-01-01", "2026-01-02"], "datetime64[ns]"))}),
    ],
    ids=["empty", "bytes", "attribute", "dates"],
)
def test_what_results_do_not_have_is_written_by_the_library(
    strange: xr.Dataset, tmp_path: Path
) -> None:
    save(strange, tmp_path / "strange.nc")
    xr.testing.assert_identical(load(tmp_path / "strange.nc"), by_library(tmp_path / "strange.nc"))


def test_what_cannot_be_written_is_said_by_the_library(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="Invalid value for attr 'odd'"):
        save(xr.Dataset({"u": ("run", np.ones(2))}, attrs={"odd": {"a": 1}}), tmp_path / "odd.nc")
    assert not (tmp_path / "odd.nc").exists()


@pytest.mark.parametrize("how", ["no numbers", "a group", "other types"])
def test_files_of_others_are_read_by_the_library(how: str, tmp_path: Path) -> None:
    path = tmp_path / "other.nc"
    result().to_netcdf(path, engine="h5netcdf")
    with h5py.File(path, "a") as file:
        if how == "no numbers":
            for stored in file.values():
                stored.attrs.pop("_Netcdf4Coordinates", None)
        elif how == "a group":
            file.create_group("beside")
        else:
            file["odd"] = np.array([1.0 + 2.0j])
            file["odd"].dims[0].attach_scale(file["run"])
            del file["odd"]
            file["u"].attrs["code"] = np.array([[1.0, 2.0]])
    assert read(path) is None
    if how != "other types":
        xr.testing.assert_identical(load(path), by_library(path))
