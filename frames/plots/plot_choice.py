"""Content of a figure: the systems, their part in time, the bearing."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from frames._errors import likely
from frames.plots.plot_style import PALETTE, line_of
from frames.results.findings import doubts_of
from frames.results.recorded import largest_kept, require_steps
from lir_element.errors import RunStatus
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from matplotlib.artist import Artist

Systems: TypeAlias = xr.Dataset | Mapping[str, xr.Dataset]
"""One result, or several by name for comparison."""

_NAMED = 12  # names that a message lists in full


def as_systems(
    systems: Systems, start: float | None = None, end: float | None = None
) -> dict[str, xr.Dataset]:
    """Return systems by name, in a window of time; a single Dataset has its title as name."""
    given: object = systems  # callers may not check their types
    if isinstance(given, xr.Dataset):
        found: dict[str, object] = {str(given.attrs.get("title", "result")): given}
    elif isinstance(given, Mapping):
        found = {str(name): data for name, data in given.items()}
    else:
        msg = (
            f"systems is a {type(given).__name__}: give a Dataset of time_history, or several by "
            'name, as in {"LIR-DCFP": data, "DCFP": other}'
        )
        raise TypeError(msg)
    if not 1 <= len(found) <= len(PALETTE):
        msg = f"{len(found)} systems: give 1 to {len(PALETTE)} Datasets to compare"
        raise ValueError(msg)
    return {name: in_window(data, start, end, name) for name, data in found.items()}


def in_window(
    data: object, start: float | None, end: float | None, name: str = "the Dataset"
) -> xr.Dataset:
    """Return the part of a result between two times [s]; errors as in `as_systems`."""
    if not isinstance(data, xr.Dataset):
        msg = f"{name} is a {type(data).__name__}: give a Dataset of time_history"
        raise TypeError(msg)
    if "time" not in data.dims:
        msg = (
            f"{name} has no dimension 'time', but {', '.join(map(str, data.dims))}: figures show "
            "time histories; draw the variables of a cyclic test over one another"
        )
        raise ValueError(msg)
    require_steps(data, f"figures of {name}")
    for side, value in (("start", start), ("end", end)):
        if value is not None and not math.isfinite(value):
            msg = f"{side} = {value}: give a time [s], or leave it out"
            raise ValueError(msg)
    if start is not None and end is not None and not start < end:
        msg = f"start = {start:g} s is not before end = {end:g} s: exchange or widen them"
        raise ValueError(msg)
    if start is None and end is None:
        return data
    chosen = data.sel(time=slice(start, end))
    if chosen.sizes["time"] < 2:
        time = data["time"].to_numpy()
        low, high = (time[0], time[-1]) if len(time) else (0.0, 0.0)
        window = " ".join(
            f"{side} = {value:g} s"
            for side, value in (("start", start), ("end", end))
            if value is not None
        )
        msg = (
            f"{window}: {name} has fewer than two steps there, it goes from {low:g} to {high:g} s: "
            "move the window, or leave the system out"
        )
        raise ValueError(msg)
    return chosen


def choose(name: object, known: Collection[str], kind: str, where: str = "") -> str:
    """Return a name that exists."""
    if isinstance(name, str) and name in known:
        return name
    msg = f"there is no {kind} {name!r}{where}"
    hint = likely(name, known)
    if len(known) <= _NAMED:
        msg += f"; known: {', '.join(known)}"
        hint = hint if hint.startswith("did") else ""
    raise ValueError(f"{msg}; {hint}" if hint else msg)


def choose_bearing(
    systems: Mapping[str, xr.Dataset], bearing: str | None, variable: str | None = None
) -> str:
    """Return the bearing that a figure shows, which all systems must have."""
    first = next(iter(systems.values()))
    need(first, ("bearing",), "figures of bearings need a Dataset of an isolated frame")
    if bearing is None:
        kept = largest_kept(first, "slip")
        if kept is None:
            need(first, ("interface_slip_size",), "name a bearing, or record it")
        slip = first["interface_slip_size"].to_numpy() if kept is None else kept[0]
        slips = float(slip.max()) > 0.0
        usual = "interface_slip_size" if slips else "bearing_displacement"
        bearing = worst_bearing(first, variable or usual)
    for name, data in systems.items():
        where = "" if len(systems) == 1 else f" in {name!r}"
        choose(bearing, [str(known) for known in data["bearing"].to_numpy()], "bearing", where)
    return bearing


_KEPT = {"interface_slip_size": "slip", "bearing_displacement": "displacement"}
"""Variables whose peaks a recording keeps, and the names of the peaks."""


def worst_bearing(data: xr.Dataset, variable: str = "interface_slip_size") -> str:
    """Return the name of the bearing with the largest absolute value of a variable.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`.
    variable : str
        A variable over time and bearing; of "bearing_displacement" the size in plan counts.

    Returns
    -------
    str
        Name of the bearing, in the dimension "bearing".

    Raises
    ------
    ValueError
        If there is no variable of that name.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.plots import worst_bearing
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> worst_bearing(data, "bearing_displacement")
    'bearing'
    """
    kept = largest_kept(data, _KEPT.get(variable, ""))
    if kept is not None:  # of all steps, for any recording
        return str(data["bearing"].to_numpy()[int(np.argmax(kept[0]))])
    known = [str(name) for name in data.data_vars if "bearing" in data[name].dims]
    values = data[choose(variable, known, "variable of bearings")].transpose("bearing", ...)
    if variable == "bearing_displacement":
        sizes = np.linalg.norm(values.sel(axis=["x", "y"]).to_numpy(), axis=-1)
    else:
        sizes = np.abs(values.to_numpy())
    peaks = sizes.reshape(len(sizes), -1).max(axis=1)
    return str(data["bearing"].to_numpy()[int(np.argmax(peaks))])


def step_at(data: xr.Dataset, time: float) -> int:
    """Return the recorded step nearest to a time; a ValueError if it is outside of them."""
    times = data["time"].to_numpy()
    if not times[0] <= time <= times[-1]:
        msg = f"time = {time:g} s lies outside of the result, {times[0]:g} to {times[-1]:g} s"
        raise ValueError(msg)
    return int(np.abs(times - time).argmin())


def need(data: xr.Dataset, names: Collection[str], why: str) -> None:
    """Raise a ValueError with the reason, if the Dataset lacks one of `names`."""
    missing = [name for name in names if name not in data.variables]
    if missing:
        msg = f"the Dataset has no {', '.join(missing)}: {why}"
        raise ValueError(msg)


def label_of(name: str, data: xr.Dataset, space: str = " ") -> str:
    """Return the name of a system; after `space`, that it stopped, or its findings."""
    status = data.attrs.get("status", "ok")
    if not RunStatus[status.upper()].is_complete:
        end = data.attrs.get("failed_at", float(data["time"][-1]))
        said = worded("(stopped at {t:.2f} s)", t=end)
    elif status != "ok":
        said = f"({status})"
    else:
        said = "(see its assumption check)" if doubts_of(data) else ""
    return joined(name, said, by=space)


def system_handles(systems: Mapping[str, xr.Dataset]) -> list[Artist]:
    """Return the entries of a legend for the systems, in their colours and line styles."""
    return [
        Line2D([], [], label=label_of(*item), **line_of(k))
        for k, item in enumerate(systems.items())
    ]


def several(names: str | Collection[str]) -> list[str]:
    """Return names as a list; a single string is one name."""
    return [names] if isinstance(names, str) else list(names)


def of_each(values: Any, systems: Collection[str], what: str) -> dict[str, Any]:
    """Return a value by system from one for all, or from a mapping that may leave some out."""
    if not isinstance(values, Mapping):
        return dict.fromkeys(systems, values)
    return {
        choose(name, systems, "system", f", as {what} has it"): value
        for name, value in values.items()
    }
