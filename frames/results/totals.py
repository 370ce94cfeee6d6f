"""Sums over the steps of a time history: the table that declares them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.bundles.peak_data import LOOSE
from frames.kernels.quantities import sliding_power
from frames.results.quantities import formed, known, of_bearings
from frames.results.recorded import standing
from lir_element.kernels.friction_law import fill_left
from lir_element.layout import FRICTION_TABLE

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames._types import BoolArray, FloatArray

_B = ("bearing",)


class Total(NamedTuple):
    """A sum over steps first <= k < last of a Dataset that holds the step before the first, too."""

    dims: tuple[str, ...]
    unit: str
    meaning: str
    of: Callable[[xr.Dataset, int, int], FloatArray]


def _slid(data: xr.Dataset, first: int, last: int) -> tuple[FloatArray, FloatArray]:
    # Speed of sliding and load on it at some steps.
    part = slice(first, last)
    load = np.maximum(of_bearings(data, "axial_force")[part], 0.0)[..., None]
    return of_bearings(data, "sliding_speed", "surface")[part], load


def _work(data: xr.Dataset, first: int, last: int) -> FloatArray:
    speed, load = _slid(data, first, last)
    return np.asarray(formed(sliding_power, load, known(data, "friction_max"), speed).sum())


def _work_lower(data: xr.Dataset, first: int, last: int) -> FloatArray:
    speed, load = _slid(data, first, last)
    drop, rate = (data.variables[f"friction_{name}"].to_numpy() for name in ("drop", "rate"))
    tables = np.zeros((*drop.shape, FRICTION_TABLE))
    if "friction_table" in data:
        tables = data.variables["friction_table"].transpose("bearing", "surface", ...).to_numpy()
    lower = np.zeros((len(speed), drop.size))
    fill_left(
        drop.ravel(),
        rate.ravel(),
        np.ascontiguousarray(tables).reshape(drop.size, -1),
        np.ascontiguousarray(speed).reshape(lower.shape),
        lower,
    )
    return np.asarray(formed(sliding_power, load, lower.reshape(speed.shape), speed).sum())


def _work_pressed(data: xr.Dataset, first: int, last: int) -> FloatArray:
    if "pressure_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    rate, at = (data.variables[name].to_numpy() for name in ("pressure_rate", "pressure_load"))
    changed = np.abs(1.0 - np.exp(-rate[:, None] * (load - at[:, None])))
    return np.asarray((load * data.variables["friction_max"].to_numpy() * changed * speed).sum())


def _work_heated(data: xr.Dataset, first: int, last: int) -> FloatArray:
    if "softening_rate" not in data:
        return np.zeros(())
    speed, load = _slid(data, first, last)
    scale, rate, rest = (
        data.variables[f"softening_{name}"].to_numpy()[:, None]
        for name in ("scale", "rate", "rest")
    )
    surfaces = of_bearings(data, "temperature", "contact")[first:last, :, :2]
    heated = np.isfinite(surfaces)  # of some bearings only
    changed = np.abs(1.0 - scale * (rest + np.exp(-rate * np.where(heated, surfaces, 0.0))))
    work = load * data.variables["friction_max"].to_numpy() * np.where(heated, changed, 0.0)
    return np.asarray((work * speed).sum())


def _lifted(data: xr.Dataset) -> BoolArray:
    return (of_bearings(data, "axial_force") <= 0.0) & (standing(data) > 0.0)


def _uplifts(data: xr.Dataset, first: int, last: int) -> FloatArray:
    lifted = _lifted(data)
    begins = np.concatenate([lifted[:1], lifted[1:] & ~lifted[:-1]])
    return np.asarray(begins[first:last].sum(), dtype=np.float64)


def _time_lifted(data: xr.Dataset, first: int, last: int) -> FloatArray:
    first = max(first, 1)
    steps = np.diff(data.variables["time"].to_numpy())[first - 1 : last - 1]
    lifted = _lifted(data)[first:last]
    return np.asarray((steps[:, None] * lifted).sum(axis=0))


def _slip_loose(data: xr.Dataset, first: int, last: int) -> FloatArray:
    first = max(first, 1)
    changes = np.diff(of_bearings(data, "interface_slip_size")[first - 1 : last], axis=0)
    static = data.variables["static_axial_force"].to_numpy()
    loose = of_bearings(data, "axial_force")[first:last] <= LOOSE * static
    return np.asarray((changes * loose).sum(axis=0))


def _rim_plastic(data: xr.Dataset, first: int, last: int) -> FloatArray:
    # What it grew by; a rim that breaks has no end of it, once.
    if "rim_plastic" not in data:
        return np.zeros(data.sizes["bearing"])
    largest = of_bearings(data, "rim_plastic", "surface").max(axis=-1)
    before = largest[first - 1] if first > 0 else np.zeros(largest.shape[1])
    gone = np.isinf(before)
    return np.where(gone, 0.0, largest[last - 1] - np.where(gone, 0.0, before))


TOTALS: dict[str, Total] = {
    "sliding_work": Total(
        (), "N m/s", "sum over steps and surfaces: load, friction at high speed, speed", _work
    ),
    "sliding_work_lower": Total(
        (), "N m/s", "the same with what friction is below that at high speed", _work_lower
    ),
    "sliding_work_pressed": Total(
        (), "N m/s", "the same with what the pressure changes of that", _work_pressed
    ),
    "sliding_work_heated": Total(
        (), "N m/s", "the same with what the temperature changes of that", _work_heated
    ),
    "uplifts": Total((), "1", "how often bearings lifted off", _uplifts),
    "time_lifted": Total(_B, "s", "uplift duration", _time_lifted),
    "slip_loose": Total(
        _B,
        "m",
        "growth of the interface slip while the axial force was at most 1 % of that at rest",
        _slip_loose,
    ),
    "rim_plastic": Total(
        _B,
        "m",
        "largest plastic deformation of a rim; infinite once it is broken",
        _rim_plastic,
    ),
}
"""Sums over the steps by name."""
