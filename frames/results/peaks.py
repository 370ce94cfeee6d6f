"""The peaks of a time history, each with its time and place, and several histories side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from frames.results.findings import doubts_of
from frames.results.formulas import can_yield
from frames.results.measures import energy_error, lateral_capacity
from frames.results.peak_response import (
    Extreme,
    computed_until,
    final_if_complete,
    largest,
    places_of,
    storeys_of_lines,
    summed,
)
from frames.results.quantities import QUANTITIES
from frames.results.recorded import names_of
from lir_element.argument_checks import require_type

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray


_STILL = 1e-9
"""Drift ratio of round-off: a storey that does not drift does not twist either."""


class Peak(NamedTuple):
    """One line of the table: a number, with its time and place."""

    quantity: str
    value: float
    unit: str
    time: float = math.nan
    where: str = ""


def peaks(data: xr.Dataset) -> pd.DataFrame:
    """Return the peaks of a time history as a table.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `time_history`, also one that was saved and loaded, with any recording: one
        without some steps or variables keeps the peaks of all of them. If it chose bearings or
        nodes, the peaks are theirs.

    Returns
    -------
    pandas.DataFrame
        A row a quantity with the columns value, unit (SI), time [s] and where. Displacements,
        drifts, forces and accelerations in plan are sizes of vectors, of both horizontal components
        at one instant: at most sqrt(2) times the larger of both peaks. Residual values of a run
        that stopped early are NaN. If it failed, "where" of the row "duration computed" has the
        reason, and the other rows are its peaks until then.

    Raises
    ------
    TypeError
        If it is no Dataset.

    Examples
    --------
    >>> from frames import peaks, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> row = peaks(data).loc["bearing displacement"]
    >>> round(float(row["value"]), 2), row["unit"], row["where"]
    (0.24, 'm', 'bearing')
    """
    remedy = "a Dataset of time_history; for several, summary({name: data, ...})"
    require_type("data", data, xr.Dataset, remedy)
    return pd.DataFrame(peaks_of(data), columns=Peak._fields).set_index("quantity")


def peaks_of(data: xr.Dataset) -> list[Peak]:
    """Return the rows of `peaks`."""
    titled = (name for name, quantity in QUANTITIES.items() if quantity.title)
    return [*(row for name in titled for row in _rows(data, name)), *_of_run(data)]


def summary(results: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Return the peaks of several time histories side by side.

    Parameters
    ----------
    results : mapping of str to xarray.Dataset
        Results by name of system.

    Returns
    -------
    pandas.DataFrame
        A row for each quantity of `peaks` with its unit, and one each for the status and for the
        findings of the assumption check; a column for each system.

    Raises
    ------
    TypeError
        If results are not given by name.

    Examples
    --------
    >>> from frames import summary, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> table = summary({"as it is": data})
    >>> list(table), table.loc["status"].tolist()
    (['as it is'], ['ok'])
    """
    given: object = results
    if isinstance(given, xr.Dataset) or not isinstance(given, Mapping):
        kind = type(given).__name__
        msg = f"results is a {kind}: give Datasets by name, as summary({{'a': data}})"
        raise TypeError(msg)
    columns = {}
    for name, data in results.items():
        table = peaks(data)
        labels = [f"{quantity} [{unit}]" for quantity, unit in table["unit"].items()]
        column = pd.Series(table["value"].to_numpy(), index=labels, dtype=object)
        column["status"] = _status(data)
        column["audit"] = "; ".join(doubts_of(data))
        columns[name] = column
    return pd.DataFrame(columns)


def _status(data: xr.Dataset) -> str:
    at = f" at {data.attrs['failed_at']:.4g} s" if "failed_at" in data.attrs else ""
    return f"{data.attrs['status']}{at}"


def _peak(quantity: str, unit: str, found: Extreme, names: Any = ()) -> Peak:
    # The largest of values (name,), or (); the first in time of those that are as large.
    value = float(found.values.max())
    if not abs(value) > 0.0:
        return Peak(quantity, value, unit)  # never, nowhere
    if found.values.ndim == 0:
        return Peak(quantity, value, unit, float(found.at))
    at = np.where(found.values == value, found.at, math.inf)
    k = int(np.argmin(at))
    return Peak(quantity, value, unit, float(at[k]), str(names[k]))


def _rows(data: xr.Dataset, name: str) -> Iterator[Peak]:
    # Row of a quantity, and its derived ratio.
    _, unit, _, _, kind, _, title, *_ = quantity = QUANTITIES[name]
    if kind == "final":
        left_over = final_if_complete(data, name.removesuffix("_left"))
        yield Peak(title, float(left_over.max()), unit, computed_until(data))
    elif kind == "sum":
        values = summed(data, name)
        worst = int(np.argmax(values))
        there = values.ndim and values[worst] > 0.0
        where = str(names_of(data, "bearing")[worst]) if there else ""
        yield Peak(title, float(values.max()), unit, where=where)
    elif name in _OF_SEVERAL:
        yield from _OF_SEVERAL[name](data, title)
    elif quantity.dims == ():
        yield from _with_share(data, name, largest(data, name), ())
    else:
        names = places_of(data, name)
        which = _SHOWN[name](data) if name in _SHOWN and len(names) else np.full(len(names), True)
        if which.any():
            found = Extreme(*(part[which] for part in largest(data, name)))
            yield from _with_share(data, name, found, names[which])


def _with_share(data: xr.Dataset, name: str, found: Extreme, names: Any) -> Iterator[Peak]:
    title, unit = QUANTITIES[name].title, QUANTITIES[name].unit
    row = _peak(title, unit, found, names)
    yield row._replace(value=QUANTITIES[name].sign * row.value + 0.0)  # no -0
    if name in _SHARES:
        of, whole = _SHARES[name]
        yield _peak(f"{title} over {of}", "1", Extreme(found.values / whole(data), found.at), names)


_SHARES: dict[str, tuple[str, Callable[[xr.Dataset], FloatArray]]] = {
    "displacement": ("capacity", lateral_capacity),
    "slip": ("overlap", lambda d: d.variables["slip_capacity"].to_numpy()),
    "base_shear": ("weight", lambda d: d.variables["weight"].to_numpy()),
}
"""Peaks that are also given as a ratio, and their divisors."""


def _of_heat(data: xr.Dataset, title: str) -> Iterator[Peak]:
    # Bearings with heating.
    if "contact" not in data.dims:
        return
    found = largest(data, "temperature")
    heated = np.isfinite(found.values[:, 0])
    names = names_of(data, "bearing")[heated]
    for text, contacts in (("plates", (0, 1)), ("interfaces", (2,))):
        if heated.any():
            places = np.repeat(names, len(contacts))
            each = Extreme(*(part[heated][:, contacts].ravel() for part in found))
            yield _peak(f"{title} {text}", "degC", each, places)


def _of_lines(data: xr.Dataset, title: str) -> Iterator[Peak]:
    names, storey_of = storeys_of_lines(data) if data.sizes["level"] > 1 else ([], [])
    if not names:
        return
    each, mean = largest(data, "line_drift"), largest(data, "drift")
    yield _peak(title, "1", each, names)
    own = {str(name): k for k, name in enumerate(places_of(data, "drift"))}
    of = np.array([own[name] for name in storey_of])
    over = each.values / np.maximum(mean.values[of], _STILL)
    ratios = np.where(each.values > _STILL, over, 1.0)
    worst = int(np.argmax(ratios))
    twist = "torsion: maximum at any column line over mean drift"
    yield Peak(twist, float(ratios[worst]), "1", where=names[worst])


def _of_work(data: xr.Dataset, title: str) -> Iterator[Peak]:
    if "hinge" in data.dims or ("link" in data.dims and can_yield(data).any()):
        work, given = (float(largest(data, f"energy_{of}").values) for of in ("yielding", "input"))
        yield Peak(title, work / given if given > 0.0 else math.nan, "1")


_OF_SEVERAL: dict[str, Callable[[xr.Dataset, str], Iterator[Peak]]] = {
    "temperature": _of_heat,
    "line_drift": _of_lines,
    "energy_yielding": _of_work,
}
"""Rows that are formed of several quantities, or several rows of one."""


def _walls(data: xr.Dataset) -> BoolArray:
    # Stops have no deformation at yield, as dampers, but they never pull.
    unlimited = np.isnan(data.variables["link_yield_deformation"].values)
    return np.asarray(unlimited & (largest(data, "link_reversal").values <= 0.0))


def _on_levels(data: xr.Dataset) -> BoolArray:
    return np.asarray(data.variables["level_node"].values >= 0)


_SHOWN: dict[str, Callable[[xr.Dataset], BoolArray]] = {
    "node_plan": _on_levels,
    "node_vertical": _on_levels,
    "link_ductility": can_yield,
    "link_force": _walls,
}
"""Places of a quantity that count, if not all do."""


def _of_run(data: xr.Dataset) -> Iterator[Peak]:
    yield Peak("energy balance: error over input", energy_error(data), "1")
    ended = "" if str(data.attrs["status"]) == "ok" else _status(data)
    yield Peak("duration computed", computed_until(data), "s", where=ended)
    yield Peak("seconds of the time loop", float(data.attrs["seconds_loop"]), "s")
