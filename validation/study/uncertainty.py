"""Numbers of the part on uncertain properties: collapse in the halves of each property's range."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

    from frames.risk.campaign.tables import CampaignTables

DRAWS = 1000
SHOWN = ("storey drift, mean", "floor acceleration in plan, mean", "base shear over weight")
"""Results whose indices the page has."""


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return shares of collapse of all runs and of halves, by device and property."""
    tables = every["uncertainty"]
    comparison, data = tables.comparison, tables.data
    assert comparison is not None
    names = list(vars(tables.file.parameters))
    names = [name for name in names if getattr(tables.file.parameters, name) is not None]
    found: dict[str, Any] = {}
    for device, runs in tables.runs.items():
        own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
        over, records = runs.exceeded(comparison.collapse), own["motion"].to_numpy().astype(str)
        shares = {name: halves(over, own[name].to_numpy(), records) for name in names}
        found[device] = {"share": float(np.nanmean(over)), "halves": shares}
    return found


def halves(over: npt.ArrayLike, values: npt.NDArray[Any], records: npt.ArrayLike) -> list[float]:
    """Return shares of collapse below and above the median of a property, and their difference.

    Ends of its interval of 90 % follow, by resampling records.
    """
    frame = pd.DataFrame({"over": over, "upper": values > np.median(values), "record": records})
    lower, upper = frame.pivot_table("over", "record", "upper").dropna().to_numpy().T
    drawn = np.random.default_rng(1).integers(0, len(lower), (DRAWS, len(lower)))
    ends = np.quantile((upper - lower)[drawn].mean(axis=1), [0.05, 0.95])
    return [float(v) for v in (lower.mean(), upper.mean(), (upper - lower).mean(), *ends)]


def change(row: list[float]) -> str:
    """Return shares of both halves, and the difference with its interval, in per cent."""
    lower, upper, more, low, high = (f"{100.0 * value:.0f}" for value in row)
    return f"{lower}, {upper}; {more} ({low} to {high})"


def deciding(own: Mapping[str, Any]) -> str:
    """Return the properties whose halves differ, the largest difference first."""
    rows = {name: row for name, row in own["halves"].items() if row[3] > 0.0 or row[4] < 0.0}
    found = sorted(rows, key=lambda name: -abs(rows[name][2]))
    return ", ".join(f"`{name}` {100.0 * rows[name][2]:+.0f} %" for name in found) or "none"
