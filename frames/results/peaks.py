"""The peaks of a time history, each with its time and place, and several histories side by side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from frames.results.auditing import doubts_of
from frames.results.measures import (
    drift_by_line,
    energy_error,
    floor_acceleration,
    lateral_capacity,
    storey_drift,
    uplift_gap,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import xarray as xr

    from frames._types import FloatArray


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
        Of `time_history`, also one that was saved and loaded.

    Returns
    -------
    pandas.DataFrame
        A row a quantity with the columns value, unit (SI), time [s] and where. Displacements,
        drifts, forces and accelerations in plan are sizes of vectors. What a run that stopped
        before its end would have left is NaN.
    """
    rows = [*_of_bearings(data), *_of_uplift(data), *_of_structure(data), *_of_run(data)]
    return pd.DataFrame(rows, columns=Peak._fields).set_index("quantity")


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
        the audit marks; a column for each system.
    """
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


def _peak(quantity: str, unit: str, values: FloatArray, time: FloatArray, names: Any = ()) -> Peak:
    # The largest of values (time, name), or (time,).
    at = np.unravel_index(int(np.argmax(values)), values.shape)
    if not abs(values[at]) > 0.0:
        return Peak(quantity, float(values[at]), unit)  # never, nowhere
    where = str(names[int(at[1])]) if len(at) > 1 else ""
    return Peak(quantity, float(values[at]), unit, float(time[int(at[0])]), where)


def _of_bearings(data: xr.Dataset) -> Iterator[Peak]:
    time, names = data["time"].to_numpy(), data["bearing"].to_numpy()
    ended = 1.0 if "failed_at" not in data.attrs else math.nan

    def of(name: str) -> FloatArray:
        return np.asarray(data[name].transpose("time", "bearing", ...).to_numpy())

    u = _plan(of("bearing_displacement"))
    capacity = lateral_capacity(data)
    slip, overlap = of("interface_slip_size"), data["slip_capacity"].to_numpy()
    axial = of("axial_force")
    yield _peak("bearing displacement", "m", u, time, names)
    yield _peak("bearing displacement over capacity", "1", u / capacity, time, names)
    yield Peak("bearing displacement left", ended * float(u[-1].max()), "m", float(time[-1]))
    yield _peak("interface slip", "m", slip, time, names)
    yield _peak("interface slip over overlap", "1", slip / overlap, time, names)
    yield Peak("interface slip left", ended * float(slip[-1].max()), "m", float(time[-1]))
    yield _peak("rim force", "N", of("rim_force").max(axis=-1), time, names)
    yield _peak("bearing force in plan", "N", _plan(of("bearing_force")), time, names)
    yield _peak("axial force", "N", axial, time, names)
    least = _peak("least axial force", "N", -axial, time, names)
    yield least._replace(value=0.0 - least.value)


def _of_uplift(data: xr.Dataset) -> Iterator[Peak]:
    time, names = data["time"].to_numpy(), data["bearing"].to_numpy()
    lifted = data["axial_force"].transpose("time", "bearing").to_numpy() <= 0.0
    begins = lifted[1:] & ~lifted[:-1]
    yield Peak("uplifts, all bearings", float(begins.sum() + lifted[0].sum()), "1")
    lasts = (np.diff(time)[:, None] * lifted[1:]).sum(axis=0)
    worst = int(np.argmax(lasts))
    where = str(names[worst]) if lasts[worst] > 0.0 else ""
    yield Peak("time lifted", float(lasts[worst]), "s", where=where)
    yield _peak("gap of uplift", "m", uplift_gap(data).to_numpy(), time, names)


def _of_structure(data: xr.Dataset) -> Iterator[Peak]:
    time = data["time"].to_numpy()
    shear = _plan(data["base_shear"].transpose("time", "axis").to_numpy())
    yield _peak("base shear", "N", shear, time)
    yield _peak("base shear over weight", "1", shear / float(data["weight"]), time)
    if data.sizes["level"] > 0:
        floors = floor_acceleration(data).transpose("time", "level", "axis")
        levels = floors["level"].to_numpy()
        yield _peak("floor acceleration in plan, mean", "m/s2", _plan(floors), time, levels)
        yield _peak(
            "floor acceleration, vertical, mean", "m/s2", np.abs(floors.to_numpy()[..., 2]), time,
            levels,
        )  # fmt: skip
        on = data["level_node"].to_numpy() >= 0
        nodes = data["node"].to_numpy()[on]
        moves = data["node_acceleration"].transpose("time", "node", "dof").to_numpy()[:, on]
        yield _peak("acceleration in plan, worst node", "m/s2", _plan(moves), time, nodes)
        vertical = np.abs(moves[..., 2])
        yield _peak("acceleration, vertical, worst node", "m/s2", vertical, time, nodes)
    if data.sizes["level"] > 1:
        yield from _of_drifts(data)


def _of_drifts(data: xr.Dataset) -> Iterator[Peak]:
    time = data["time"].to_numpy()
    mean = storey_drift(data)
    sizes = _plan(mean)
    yield _peak("storey drift, mean", "1", sizes, time, mean["storey"].to_numpy())
    lines = drift_by_line(data)
    if lines.sizes["line"] == 0:
        return
    each = _plan(lines)
    yield _peak("storey drift, worst line", "1", each, time, lines["line"].to_numpy())
    own = {str(name): k for k, name in enumerate(mean["storey"].to_numpy())}
    of = np.array([own[str(name)] for name in lines["storey"].to_numpy()])
    ratios = each.max(axis=0) / np.maximum(sizes.max(axis=0)[of], 1e-12)
    worst = int(np.argmax(ratios))
    where = str(lines["line"].to_numpy()[worst])
    yield Peak("torsion: worst line over mean drift", float(ratios[worst]), "1", where=where)


def _of_run(data: xr.Dataset) -> Iterator[Peak]:
    yield Peak("energy ledger: error over input", energy_error(data), "1")
    yield Peak("duration computed", float(data["time"][-1]), "s")
    yield Peak("seconds of the time loop", float(data.attrs["seconds_loop"]), "s")


def _plan(values: FloatArray | xr.DataArray) -> FloatArray:
    # Size of the horizontal part, the last dimension beginning with x and y.
    return np.asarray(np.linalg.norm(np.asarray(values)[..., :2], axis=-1))
