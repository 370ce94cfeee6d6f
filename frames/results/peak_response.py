"""Peaks of a time history: largest values of derived histories, their times, a few totals.

The assumption check, the check of the energy and the table of peaks rest on these numbers alone. A
result with all steps has them in its histories. A recording that leaves steps out computes them
during the run, at every base step, and keeps them as variables ``peak_...``: so both give the same.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.results.measures import lines_of
from frames.results.quantities import QUANTITIES
from frames.results.recorded import PEAK, largest_kept, names_of

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from frames._types import FloatArray


class Extreme(NamedTuple):
    """The largest values of a quantity and when they were reached."""

    values: FloatArray
    at: FloatArray  # s


def largest(data: xr.Dataset, name: str) -> Extreme:
    """Return the peak of a quantity."""
    kept = largest_kept(data, name)
    if kept is None:
        kept = extreme_of(QUANTITIES[name].of(data), data["time"].to_numpy())
    return _with_exceeded(data, name, Extreme(*kept))


def _with_exceeded(data: xr.Dataset, name: str, found: Extreme) -> Extreme:
    # With the end of the run, unless `data` is a part of it that ends before.
    attrs = data.attrs
    if attrs.get("exceeded") != name:
        return found
    at = float(attrs["exceeded_at"])
    where = names_of(data, "bearing") == attrs["exceeded_bearing"]
    ends = computed_until(data) + 1.5 * float(attrs.get("dt", math.inf)) >= at
    beyond = np.where(where & ends, float(attrs["exceeded_value"]), -math.inf)
    return larger_of(found, Extreme(beyond, np.full(len(beyond), at)))


def of_exceeded(data: xr.Dataset) -> dict[str, FloatArray]:
    """Return variables ``peak_...`` that the step counts in, too, which a limit ended."""
    name = str(data.attrs.get("exceeded", ""))
    if not name or largest_kept(data, name) is None:
        return {}
    return dict(zip((PEAK + name, f"{PEAK}{name}_at"), largest(data, name), strict=True))


def with_exceeded(data: xr.Dataset) -> xr.Dataset:
    """Return a result whose variables ``peak_...`` count the step that a limit ended, too."""
    found = of_exceeded(data)
    return data.assign({key: data[key].copy(data=own) for key, own in found.items()})


def extreme_of(history: FloatArray, time: FloatArray) -> Extreme:
    """Return the largest of a history (time, ...) and its time; NaN if it contains one."""
    at = np.argmax(history, axis=0)
    return Extreme(np.take_along_axis(history, at[None], axis=0)[0], time[at])


def larger_of(old: Extreme, new: Extreme) -> Extreme:
    """Return the larger of both, the older if they are equal; NaN stays."""
    more = (new.values > old.values) | (np.isnan(new.values) & ~np.isnan(old.values))
    return Extreme(np.where(more, new.values, old.values), np.where(more, new.at, old.at))


def summed(data: xr.Dataset, name: str) -> FloatArray:
    """Return a sum over the steps of a time history: one of `TOTALS`."""
    if PEAK + name in data.variables:
        return data.variables[PEAK + name].values
    return QUANTITIES[name].of(data, 0, data.sizes["time"])


def final_value(data: xr.Dataset, name: str) -> FloatArray:
    """Return a quantity of `LEFT` at the last step of the run."""
    if f"{PEAK}{name}_left" in data.variables:
        return data.variables[f"{PEAK}{name}_left"].values
    return np.asarray(QUANTITIES[name].of(data)[-1])


def final_if_complete(data: xr.Dataset, name: str) -> FloatArray:
    """Return the same of a run that went to its end; NaN of one that stopped before."""
    # one that was interrupted has no time of failure
    ended = data.attrs["status"] in {"ok", "bearing_lost"}
    return final_value(data, name) * (1.0 if ended else math.nan)


def reached(data: xr.Dataset, name: str) -> FloatArray:
    """Return a quantity of a time history, of any kind."""
    kind = QUANTITIES[name].kind
    if kind == "peak":
        return largest(data, name).values
    return summed(data, name) if kind == "sum" else final_value(data, name.removesuffix("_left"))


def places_of(data: xr.Dataset, name: str) -> NDArray[np.str_]:
    """Return the names of a quantity's places: bearings, levels, storeys, lines.

    None if the structure has none; one without a name for a quantity of the whole structure.
    """
    dim = next(iter(QUANTITIES[name].dims), "")
    if not dim:
        return np.array([""])
    if dim == "line" and "run" not in data.dims:
        return np.array(storeys_of_lines(data)[0], dtype=str)
    if dim == "storey" and dim not in data.coords:
        return names_of(data, "level")[1:]
    return names_of(data, dim) if dim in data.variables else np.array([])


def computed_until(data: xr.Dataset) -> float:
    """Return the time of the last base step of a run [s]."""
    name = "until"
    kept = data.variables.get(PEAK + name)
    return float(data["time"][-1]) if kept is None else float(kept)


def storeys_of_lines(data: xr.Dataset) -> tuple[list[str], list[str]]:
    """Return the names of the lines of nodes over one another, and of the storey of each."""
    if f"{PEAK}line_storey" in data.variables:
        storeys = data.variables[f"{PEAK}line_storey"].values
        return names_of(data, "line").tolist(), [str(name) for name in storeys]
    if f"{PEAK}drift" in data.variables:  # of an earlier version, which kept none
        return [], []
    lines, nodes, levels = lines_of(data), names_of(data, "node"), names_of(data, "level")
    return [str(nodes[k]) for k in lines.upper], [str(levels[k]) for k in lines.storey]
