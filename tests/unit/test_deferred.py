"""Variables that are formed when they are first looked at behave as arrays do."""

import copy
import pickle  # of what this test has made  # noqa: S403
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from frames import load, save
from lir_element.results.dataset import labelled
from lir_element.results.deferred import deferred

VALUES = np.arange(24.0).reshape(4, 3, 2)


class Forming:
    """Counts how often it is asked."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self) -> np.ndarray:
        self.times += 1
        return VALUES.copy()


@pytest.fixture
def forming() -> Forming:
    return Forming()


@pytest.fixture
def data(forming: Forming) -> xr.Dataset:
    variable = labelled(("time", "bearing", "axis"), deferred(VALUES.shape, forming), "m", "move")
    return xr.Dataset({"move": variable}, {"time": np.arange(4.0), "axis": ["x", "y"]})


def test_formed_once_and_only_when_asked_for(data: xr.Dataset, forming: Forming) -> None:
    repr(data)
    assert (data.sizes["bearing"], data["move"].dtype) == (3, VALUES.dtype)
    assert data["move"].nbytes == VALUES.nbytes
    parts = (
        data["move"].isel(time=0),
        data.sel(axis="y")["move"],
        data["move"].transpose("axis", ...),
    )
    assert forming.times == 0
    np.testing.assert_array_equal(parts[0], VALUES[0])
    np.testing.assert_array_equal(parts[1], VALUES[..., 1])
    np.testing.assert_array_equal(parts[2], np.moveaxis(VALUES, 2, 0))
    np.testing.assert_array_equal(data["move"], VALUES)
    assert forming.times == 1
    assert float(data["move"].sum()) == VALUES.sum()
    assert forming.times == 1


def test_any_kind_of_choice(data: xr.Dataset) -> None:
    move = data["move"]
    np.testing.assert_array_equal(move.isel(time=[3, 1], bearing=[0, 2]), VALUES[[3, 1]][:, [0, 2]])
    np.testing.assert_array_equal(move.isel(time=slice(None, None, -2)), VALUES[::-2])
    places = xr.DataArray([2, 0, 1, 1], dims="time")
    np.testing.assert_array_equal(move.isel(bearing=places), VALUES[np.arange(4), [2, 0, 1, 1]])
    along = xr.DataArray([3, 0], dims="both"), xr.DataArray([1, 2], dims="both")
    np.testing.assert_array_equal(
        move.isel(time=along[0], bearing=along[1], axis=1), VALUES[[3, 0], [1, 2], 1]
    )
    np.testing.assert_array_equal(move.where(move > 5.0), np.where(VALUES > 5.0, VALUES, np.nan))


def pickled(data: xr.Dataset) -> xr.Dataset:
    found: xr.Dataset = pickle.loads(pickle.dumps(data))  # noqa: S301
    return found


@pytest.mark.parametrize("again", [copy.deepcopy, pickled, lambda data: data.copy(deep=True)])
def test_copies_are_their_own(data: xr.Dataset, again: object) -> None:
    other = again(data)  # type: ignore[operator]
    xr.testing.assert_identical(other, data)
    other["move"][0] = -1.0
    np.testing.assert_array_equal(data["move"], VALUES)
    assert float(other["move"][0, 0, 0]) == -1.0


def test_written_to(data: xr.Dataset) -> None:
    data["move"][1, 2] = 7.0
    data["move"].values[0] = 8.0
    assert float(data["move"][1, 2, 1]) == 7.0
    assert float(data["move"].max()) == 23.0
    assert float(data["move"][0].min()) == 8.0


@pytest.mark.parametrize("compress", [False, True])
def test_saved(data: xr.Dataset, tmp_path: Path, *, compress: bool) -> None:
    save(data, tmp_path / "data.nc", compress=compress)
    xr.testing.assert_identical(load(tmp_path / "data.nc"), data)
