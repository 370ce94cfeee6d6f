"""Own numbers and figures of the part on uncertain properties."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.plots import plot_style as ps
from frames.risk import RiskWarning, saltelli_sample, sobol_indices
from frames.risk.campaign.ductility import ductility
from frames.risk.campaign.file import distributions_in
from frames.risk.fragility.record_table import of_campaign
from frames.risk.fragility.runs import COMPLETE, FAILURE, outcome_of
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.risk import SobolIndices
    from frames.risk.campaign.tables import CampaignTables

    Own = Mapping[str, Any]

ULTIMATE = 9.0
"""Ductility of collapse, which a failed bearing counts as [-]."""

RATIO = "LIR-DCFP over DCFP"
RESULTS = {
    "ductility": "ductility of the worst hinge",
    "base shear over weight": "base shear",
    "axial force": "axial force of a bearing",
}
"""What is varied for: logarithms, as ratios of devices are of interest."""

DRAWS = 200
FRACTILES = 0.68
"""Share of a distribution between its fractiles of 16 and 84 %."""


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return indices and effects of each result, by device and of the ratio of both."""
    tables = every["uncertainty"]
    found: dict[str, Any] = {"indices": {}, "effects": {}}
    assert tables.file.sample is not None
    size, seed = tables.file.sample.size or 0, tables.file.sample.seed
    given = distributions_in(tables.file)
    sample = saltelli_sample(given, size, seed=seed)  # type: ignore[arg-type]  # distributions
    sets = [sample[k] for k in range(len(sample))]
    columns: Any = zip(given.values(), sample.values.T, strict=True)
    shares = np.array([each.cdf(values) for each, values in columns])
    for result in RESULTS:
        results = {
            name: of_campaign(tables.data, sets, _logarithm(tables, name, result), None, name, None)
            for name in tables.frames
        }
        own, other = results.values()
        for name, each in {**results, RATIO: own - other}.items():
            told = _unknown(given, np.size(each))
            if np.nanmax(each) > np.nanmin(each):
                with warnings.catch_warnings(action="ignore", category=RiskWarning):
                    told = _told(sobol_indices(each, given, samples=size, seed=seed))
            found["indices"].setdefault(result, {})[name] = told
            found["effects"].setdefault(result, {})[name] = effects(each, shares.T, list(given))
    return found


def _logarithm(tables: CampaignTables, model: str, result: str) -> Any:
    # A function of the runs of a device; runs that fail count as the largest of all devices.
    frame = tables.frames[model]

    def reached(data: xr.Dataset, of: Any = frame) -> FloatArray:
        if result == "ductility":
            return ductility(data, of)
        return np.asarray(data["peak"].sel(quantity=result).to_numpy())

    def outcomes(data: xr.Dataset) -> np.ndarray:
        return np.array([outcome_of(str(each)) for each in data["status"].to_numpy()])

    most = ULTIMATE
    if result != "ductility":
        done = outcomes(tables.data) == COMPLETE
        most = float(np.nanmax(reached(tables.data)[done]))

    def logarithm(data: xr.Dataset) -> FloatArray:
        outcome = outcomes(data)
        value = np.where(outcome == FAILURE, most, np.minimum(reached(data), most))
        return np.where(np.isin(outcome, (COMPLETE, FAILURE)), np.log(value), np.nan)

    return logarithm


def _told(found: SobolIndices) -> dict[str, Any]:
    # Values with their ends by property; values that are not known are None.
    def rows(table: pd.DataFrame) -> dict[str, Any]:
        return {
            str(name): {
                kind: [_or_none(row[kind]), row[f"{kind}, low"], row[f"{kind}, high"]]
                for kind in ("first", "total")
            }
            for name, row in table.iterrows()
        }

    assert found.groups is not None
    return {
        "properties": rows(found.table),
        "groups": rows(found.groups),
        "deviation": found.deviation,
        "left out": found.left_out,
        "runs": found.runs,
    }


def _unknown(names: Iterable[str], runs: int) -> dict[str, Any]:
    # Of results that are all the same, as at collapse: nothing is known.
    rows = {kind: [None, 0.0, 1.0] for kind in ("first", "total")}
    groups = dict.fromkeys(("record", "parameters"), rows)
    own = {"properties": dict.fromkeys(names, rows), "groups": groups, "deviation": 0.0}
    return own | {"left out": 0, "runs": runs}


def _or_none(value: float) -> float | None:
    return None if math.isnan(value) else float(value)


def effects(results: FloatArray, shares: FloatArray, names: list[str]) -> dict[str, list[float]]:
    """Return what a property changes from its fractile of 16 % to that of 84 %, with intervals.

    Slopes of a plane through the results (sets, records) over the shares (sets, properties) of the
    distributions, with a constant for each record; intervals are of resampled records.
    """
    known = ~np.isnan(results)
    slopes = []
    for values, there in zip(results.T, known.T, strict=True):
        of = np.column_stack([shares[there], np.ones(there.sum())])
        slopes.append(np.linalg.lstsq(of, values[there], rcond=None)[0][:-1])
    each = FRACTILES * np.array(slopes)
    rng = np.random.default_rng(1)
    again = each[rng.integers(0, len(each), (DRAWS, len(each)))].mean(axis=1)
    low, high = np.quantile(again, [0.05, 0.95], axis=0)
    return {
        name: [float(v) for v in (each[:, k].mean(), low[k], high[k])]
        for k, name in enumerate(names)
    }


def index(own: Own, result: str, device: str, name: str, kind: str = "total") -> str:
    """Return an index of a property, or of a group, with its interval."""
    told = own["indices"][result][device]
    rows = told["properties"] if name in told["properties"] else told["groups"]
    value, low, high = rows[name][kind]
    return (
        f"not known ({low:.2f} to {high:.2f})" if value is None else with_interval(rows[name][kind])
    )


def change(own: Own, result: str, device: str, name: str) -> str:
    """Return what a property changes, in per cent."""
    values = own["effects"][result][device][name]
    return with_interval([100.0 * math.expm1(v) for v in values], 0)


def leading(own: Own, result: str, device: str) -> str:
    """Return the properties by their total indices, those that are not known last."""
    rows = own["indices"][result][device]["properties"]
    known = {name: row["total"][0] for name, row in rows.items() if row["total"][0] is not None}
    first = sorted(known, key=lambda name: -known[name])[:3]
    words = ", ".join(f"{name} {with_interval(rows[name]['total'])}" for name in first)
    others = [name for name in rows if name not in known]
    return words + (f"; not known: {', '.join(others)}" if others else "")


def figures(campaigns: Mapping[str, Any], own: Own) -> dict[str, Figure]:
    """Return total indices of the properties, a panel a device."""
    del campaigns
    told = own["indices"]["ductility"]
    figure = ps.new_figure(3.4)
    (panels,) = ps.grid_of(figure, 1, len(told), share_x=True, share_y=True)
    names = list(next(iter(told.values()))["properties"])
    places = np.arange(len(names))[::-1]
    for panel, (device, each) in zip(panels, told.items(), strict=True):
        rows = [each["properties"][name]["total"] for name in names]
        low, high = np.array([row[1:] for row in rows]).T
        panel.hlines(places, low, high, color="black", linewidth=0.9)
        known = [k for k, row in enumerate(rows) if row[0] is not None]
        panel.plot([rows[k][0] for k in known], places[known], "o", color="black", markersize=4.0)
        panel.set_xlim(0.0, 1.0)
        ps.caption(panel, title=device, x="total index [-]")
    panels[0].set_yticks(places, names)
    return {"indices": figure}
