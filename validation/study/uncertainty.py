"""Numbers of the part on uncertain properties: how each changes the share of collapse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import rankdata

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

    from frames.risk.campaign.tables import CampaignTables

DRAWS = 1000


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return shares of collapse, and how each property changes them, by device."""
    tables = every["uncertainty"]
    comparison, data = tables.comparison, tables.data
    assert comparison is not None
    names = list(vars(tables.file.parameters))
    names = [name for name in names if getattr(tables.file.parameters, name) is not None]
    found: dict[str, Any] = {}
    for device, runs in tables.runs.items():
        own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
        over, records = runs.exceeded(comparison.collapse), own["motion"].to_numpy().astype(str)
        ranks = np.array([rankdata(own[name].to_numpy()) / len(over) for name in names])
        found[device] = {"share": float(np.nanmean(over))}
        found[device]["changes"] = dict(zip(names, changes(over, ranks.T, records), strict=True))
    return found


def changes(
    over: npt.NDArray[Any], ranks: npt.NDArray[Any], records: npt.NDArray[Any]
) -> list[list[float]]:
    """Return the change of the share of collapse from a property's lower to its upper half.

    Slopes of a plane through the runs of each record over the ranks (runs, properties) [-], times
    the half that is between the middles of both; mean and interval of 90 % by resampling records.
    """
    each = []
    for name in np.unique(records):
        own = (records == name) & ~np.isnan(over)
        of = np.column_stack([ranks[own], np.ones(own.sum())])
        each.append(0.5 * np.linalg.lstsq(of, over[own], rcond=None)[0][:-1])
    found = np.array(each)
    drawn = np.random.default_rng(1).integers(0, len(found), (DRAWS, len(found)))
    ends = np.quantile(found[drawn].mean(axis=1), [0.05, 0.95], axis=0)
    rows: list[list[float]] = np.column_stack([found.mean(axis=0), *ends]).tolist()
    return rows


def change(row: list[float]) -> str:
    """Return a change with its interval, in per cent."""
    return "{:+.0f} ({:+.0f} to {:+.0f})".format(*(100.0 * value for value in row))


def deciding(own: Mapping[str, Any], device: str) -> str:
    """Return the properties whose change is beyond the error of the plane, the largest first."""
    error = max(map(abs, own["DCFP"]["changes"]["interface_friction_factor"])) + 1e-9
    rows = own[device]["changes"]
    rows = {name: row for name, row in rows.items() if row[1] > error or row[2] < -error}
    found = sorted(rows, key=lambda name: -abs(rows[name][0]))
    return ", ".join(f"`{name}` {100.0 * rows[name][0]:+.0f} %" for name in found) or "none"
