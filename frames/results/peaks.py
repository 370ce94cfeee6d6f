"""The peaks of a time history, each with its time and place, and several histories side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from frames.results.findings import doubts_of
from frames.results.hinge_extremes import can_yield
from frames.results.measures import energy_error, lateral_capacity
from frames.results.peak_response import (
    Extreme,
    computed_until,
    largest,
    remaining,
    storeys_of_lines,
    total,
)
from frames.results.quantities import QUANTITIES
from lir_element.argument_checks import require_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from frames._types import BoolArray


_STILL = 1e-9
"""Drift ratio of round-off: a storey that does not drift does not twist either."""


class Peak(NamedTuple):
    """One line of the table: a number, and when and where it was reached."""

    quantity: str
    value: float
    unit: str
    time: float = math.nan
    where: str = ""


def peaks(data: xr.Dataset) -> pd.DataFrame:
    """Return what a time history reached, for an engineer to read off.

    Parameters
    ----------
    data : xarray.Dataset
        Of `time_history`, also one that was saved and loaded, and whatever its recording: one that
        leaves out steps or variables has kept what was reached at all of them. Where it chose
        bearings or nodes, the peaks are theirs.

    Returns
    -------
    pandas.DataFrame
        A row a quantity with the columns value, unit (SI), time [s] and where. Displacements,
        drifts, forces and accelerations in plan are sizes of vectors, of both horizontal
        components at one instant: at most sqrt(2) times the larger of both peaks. What a run that
        stopped before its end would have left is NaN; where it failed, "where" of the row "duration
        computed" says how: the other rows are what it reached.

    Raises
    ------
    TypeError
        If it is no Dataset.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, lumped_mass, peaks, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> row = peaks(data).loc["bearing displacement"]
    >>> round(float(row["value"]), 2), row["unit"], row["where"]
    (0.24, 'm', 'bearing')
    """
    remedy = "a Dataset of time_history; for several, summary({name: data, ...})"
    require_type("data", data, xr.Dataset, remedy)
    return pd.DataFrame(peaks_of(data), columns=Peak._fields).set_index("quantity")


def peaks_of(data: xr.Dataset) -> list[Peak]:
    """Return the rows of `peaks`."""
    parts = _of_bearings, _of_heat, _of_uplift, _of_structure, _of_yielding, _of_run
    return [row for part in parts for row in part(data)]


def summary(results: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Return the peaks of several time histories side by side.

    Parameters
    ----------
    results : mapping of str to xarray.Dataset
        Results by name of system.

    Returns
    -------
    pandas.DataFrame
        A row for each quantity of `peaks` with its unit, and one each for the status and for what
        the assumption check marks; a column for each system.

    Raises
    ------
    TypeError
        If results are not given by name.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, lumped_mass, summary, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
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


def _of_bearings(data: xr.Dataset) -> Iterator[Peak]:
    names, end = data.variables["bearing"].to_numpy(), computed_until(data)
    u, slip = largest(data, "displacement"), largest(data, "slip")
    over = Extreme(u.values / lateral_capacity(data), u.at)
    overlap = Extreme(slip.values / data.variables["slip_capacity"].to_numpy(), slip.at)
    left_over = {name: float(remaining(data, name).max()) for name in ("displacement", "slip")}
    yield _peak("bearing displacement", "m", u, names)
    yield _peak("bearing displacement over capacity", "1", over, names)
    yield Peak("residual bearing displacement", left_over["displacement"], "m", end)
    yield _peak("interface slip", "m", slip, names)
    yield _peak("interface slip over overlap", "1", overlap, names)
    yield Peak("residual interface slip", left_over["slip"], "m", end)
    for name, quantity in QUANTITIES.items():
        if quantity.row:
            yield _peak(quantity.row, quantity.unit, largest(data, name), names)
    least = _peak("minimum axial force", "N", largest(data, "axial_tension"), names)
    yield least._replace(value=0.0 - least.value)


def _of_heat(data: xr.Dataset) -> Iterator[Peak]:
    # Of bearings that are heated.
    if "contact" not in data.dims:
        return
    found = largest(data, "temperature")
    heated = np.isfinite(found.values[:, 0])
    names = data.variables["bearing"].to_numpy()[heated]
    for text, contacts in (("plates", (0, 1)), ("interfaces", (2,))):
        if heated.any():
            places = np.repeat(names, len(contacts))
            each = Extreme(*(part[heated][:, contacts].ravel() for part in found))
            yield _peak(f"temperature of {text}", "degC", each, places)


def _of_uplift(data: xr.Dataset) -> Iterator[Peak]:
    names = data.variables["bearing"].to_numpy()
    yield Peak("uplifts, all bearings", float(total(data, "uplifts")), "1")
    lasts = total(data, "time_lifted")
    worst = int(np.argmax(lasts))
    where = str(names[worst]) if lasts[worst] > 0.0 else ""
    yield Peak("uplift duration", float(lasts[worst]), "s", where=where)
    yield _peak("maximum uplift", "m", largest(data, "gap"), names)


def _of_structure(data: xr.Dataset) -> Iterator[Peak]:
    shear = largest(data, "base_shear")
    yield _peak("base shear", "N", shear)
    over = Extreme(shear.values / float(data.variables["weight"].to_numpy()), shear.at)
    yield _peak("base shear over weight", "1", over)
    if data.sizes["level"] > 0:
        levels = data.variables["level"].to_numpy()
        plan, vertical = (largest(data, f"floor_{way}") for way in ("plan", "vertical"))
        yield _peak("floor acceleration in plan, mean", "m/s2", plan, levels)
        yield _peak("floor acceleration, vertical, mean", "m/s2", vertical, levels)
        on = data.variables["level_node"].to_numpy() >= 0
        nodes = data.variables["node"].to_numpy()[on]
        for text, name in ((" in plan", "node_plan"), (", vertical", "node_vertical")):
            if not on.any():  # none of them was recorded
                continue
            each = largest(data, name)
            those = Extreme(each.values[on], each.at[on])
            yield _peak(f"acceleration{text}, worst node", "m/s2", those, nodes)
    if data.sizes["level"] > 1:
        storeys = data.variables["storey"].to_numpy()
        yield _peak("storey shear", "N", largest(data, "storey_shear"), storeys)
        yield from _of_drifts(data)


def _of_drifts(data: xr.Dataset) -> Iterator[Peak]:
    storeys = [str(name) for name in data.variables["level"].to_numpy()[1:]]
    mean = largest(data, "drift")
    yield _peak("storey drift, mean", "1", mean, storeys)
    names, storey_of = storeys_of_lines(data)
    if not names:
        return
    each = largest(data, "line_drift")
    yield _peak("storey drift, maximum at any column line", "1", each, names)
    own = {name: k for k, name in enumerate(storeys)}
    of = np.array([own[name] for name in storey_of])
    over = each.values / np.maximum(mean.values[of], _STILL)
    ratios = np.where(each.values > _STILL, over, 1.0)
    worst = int(np.argmax(ratios))
    where = names[worst]
    yield Peak(
        "torsion: maximum at any column line over mean drift",
        float(ratios[worst]),
        "1",
        where=where,
    )


def _of_yielding(data: xr.Dataset) -> Iterator[Peak]:
    # Of links and hinges, where a structure has them.
    links = data.variables["link"].to_numpy() if "link" in data.dims else np.array([], dtype=str)
    yields = can_yield(data) if len(links) else np.array([], dtype=bool)
    if yields.any():
        yield _peak("link ductility", "1", _chosen(data, "link_ductility", yields), links[yields])
    if "hinge" in data.dims:
        hinges = data.variables["hinge"].to_numpy()
        yield _peak("plastic rotation of hinges", "rad", largest(data, "hinge_rotation"), hinges)
    if yields.any() or "hinge" in data.dims:
        work, given = (float(largest(data, f"energy_{of}").values) for of in ("yielding", "input"))
        share = work / given if given > 0.0 else math.nan
        yield Peak("work of yielding over input", share, "1")
    walls = _walls(data) if len(links) else yields
    if walls.any():
        yield _peak("force of a wall", "N", _chosen(data, "link_force", walls), links[walls])


def _chosen(data: xr.Dataset, name: str, which: BoolArray) -> Extreme:
    found = largest(data, name)
    return Extreme(found.values[which], found.at[which])


def _walls(data: xr.Dataset) -> BoolArray:
    # Stops have no deformation at yield, as dampers, but they never pull.
    unlimited = np.isnan(data.variables["link_yield_deformation"].to_numpy())
    return np.asarray(unlimited & (largest(data, "link_reversal").values <= 0.0))


def _of_run(data: xr.Dataset) -> Iterator[Peak]:
    yield Peak("energy balance: error over input", energy_error(data), "1")
    ended = "" if str(data.attrs["status"]) == "ok" else _status(data)
    yield Peak("duration computed", computed_until(data), "s", where=ended)
    yield Peak("seconds of the time loop", float(data.attrs["seconds_loop"]), "s")
