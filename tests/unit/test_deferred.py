"""Variables that are formed when they are first looked at behave as arrays do."""

import copy
import pickle  # of what this test has made  # noqa: S403
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from frames import GroundMotion, load, lumped_mass, save, time_history
from frames.demo import bearing_for
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
    move = data["move"]
    assert (data.sizes["bearing"], move.dtype, move.nbytes) == (3, VALUES.dtype, VALUES.nbytes)
    parts = move.isel(time=0), data.sel(axis="y")["move"], move.transpose("axis", ...)
    assert forming.times == 0
    wanted = VALUES[0], VALUES[..., 1], np.moveaxis(VALUES, 2, 0)
    for part, values in zip((*parts, move), (*wanted, VALUES), strict=True):
        np.testing.assert_array_equal(part, values)
    assert float(move.sum()) == VALUES.sum()
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


@pytest.mark.parametrize("compress", [False, True])
def test_saved(data: xr.Dataset, tmp_path: Path, *, compress: bool) -> None:
    save(data, tmp_path / "data.nc", compress=compress)
    xr.testing.assert_identical(load(tmp_path / "data.nc"), data)


WRITES: dict[str, Callable[[xr.Dataset], object]] = {
    "a part taken by place": lambda d: set_first(d["move"].isel(time=0)),
    "a part of a part": lambda d: set_first(d["move"][0][1]),
    "a part of the Dataset": lambda d: set_first(d.isel(bearing=1)["move"]),
    "a part by label": lambda d: set_first(d["move"].sel(axis="y")),
    "every second instant": lambda d: set_first(d["move"].isel(time=slice(None, None, -2))),
    "its values": lambda d: set_first(d["move"].isel(time=0).values),
    "turned": lambda d: set_first(d["move"].transpose("axis", ...)),
    "the whole by place": lambda d: d["move"].__setitem__((1, 2), 7.0),
    "one value": lambda d: d["move"][0, 1].loc.__setitem__({"axis": "x"}, -7.0),
    "a Dataset that shares it": lambda d: set_first(d.assign_attrs(of="copy")["move"]),
    "chosen places, a copy": lambda d: set_first(d["move"].isel(time=[0, 1])),
    "places point by point, a copy": lambda d: set_first(d["move"].isel(bearing=POINTS)),
    "places of the whole": lambda d: d["move"].__setitem__({"time": [0, 2]}, -7.0),
    "points of the whole": lambda d: d["move"].__setitem__({"bearing": POINTS}, -7.0),
    "a part of a deep copy": lambda d: set_first(d.copy(deep=True)["move"].isel(time=0)),
}
POINTS = xr.DataArray([2, 0, 1, 1], dims="time")


def set_first(part: xr.DataArray | np.ndarray) -> None:
    """Write to the first place along the first dimension."""
    part[0] = -7.0


@pytest.mark.parametrize("looked_at", [False, True])
@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_what_is_written_to_a_part_is_where_it_would_be_in_an_array(data, write, *, looked_at):
    plain = data.copy(deep=True).load()
    if looked_at:
        _ = data["move"].values
    write(plain)
    write(data)
    xr.testing.assert_identical(data, plain)


def test_what_is_written_enters_nothing_that_is_formed_later() -> None:
    pulse = GroundMotion(x=2.5 * np.sin(np.linspace(0.0, 6.28, 41)), dt=0.04)
    frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    changed, kept = (time_history(frame, pulse) for _ in range(2))
    for name in ("bearing_force", "interface_slip", "rim_force", "ground_acceleration"):
        changed[name][...] = 1e9
    formed = ("base_shear", "interface_slip_size", "interface_eccentricity", "imbalance")
    for name in (*formed, "node_acceleration"):
        xr.testing.assert_identical(changed[name], kept[name])
