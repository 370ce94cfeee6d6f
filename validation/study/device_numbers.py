"""What the page of the best devices says, from the runs: plain numbers, for JSON."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.risk import FragilityError, collapse_margin_ratio, compare_fragility, fragility_of
from frames.risk.campaign.comparison import dish_diameter
from frames.risk.fragility.runs import COMPLETE, FAILURE
from validation.study.device_cost import PRICES, cost_of, volume_of
from validation.study.device_runs import STRIPES, Device, frame_of, own_bearings, shape_of
from validation.study.device_search import energies
from validation.study.records_runs import COLLAPSE, considered, numbers_of
from validation.study.rims_runs import LIMITS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames._types import FloatArray
    from frames.risk import IntensityRuns, LimitState
    from frames.risk.fragility.curve import CollapseFragility, Fragility

    Curve = Fragility | CollapseFragility | str

FLOOR = "floor acceleration in plan, mean"
DISPLACEMENT = "bearing displacement"
SURE = 0.9
"""Share of resamples that must agree on who is better."""


def curve_of(runs: IntensityRuns, limit: LimitState, resamples: int) -> Curve:
    """Return the curve of a limit state, or why there is none."""
    try:
        return fragility_of(runs, limit, resamples=resamples)
    except FragilityError as cause:
        return str(cause)


def free_of(runs: IntensityRuns, plan: float) -> IntensityRuns:
    """Return runs of DCFPs without rims as those of a plan: a slider beyond its dish is a failure."""
    own = own_bearings()
    way = 0.5 * plan - max(each.slider_radius for each in own)
    reach = way * own[0].effective_radius / shape_of(plan, own[0])[0]
    table = runs.table.copy()
    beyond = (table["outcome"] == COMPLETE) & (table[DISPLACEMENT] > reach)
    table.loc[beyond, "outcome"] = FAILURE
    table.loc[beyond, "status"] = "slider beyond its dish"
    return replace(runs, table=table)


def by_stripe(runs: IntensityRuns, values: FloatArray) -> FloatArray:
    """Return values of runs by record and stripe, (records, stripes); NaN where there is none."""
    im = runs.table["im"].to_numpy()
    found = np.full((len(runs.motions), len(STRIPES)), np.nan)
    rows = {name: k for k, name in enumerate(runs.motions)}
    for motion, at, value in zip(runs.table["motion"], im, values, strict=True):
        found[rows[motion], int(np.argmin(np.abs(np.array(STRIPES) - at)))] = value
    return found


def drawn(records: int, resamples: int) -> np.ndarray:
    """Return resamples of records, (resamples, records): the same for all devices."""
    return np.random.default_rng(1).integers(0, records, (resamples, records))


def ahead(own: FloatArray, other: FloatArray, samples: np.ndarray, middle: str) -> list[list[Any]]:
    """Return who has the smaller demand at each stripe.

    Shapes: own, other (records, stripes), samples (resamples, records).
    """
    rows = []
    for first, second in zip(own.T, other.T, strict=True):
        unknown = np.isnan(first) | np.isnan(second)
        one, two = (np.where(unknown, np.nan, each) for each in (first, second))
        values = [_middle(each, middle) for each in (one, two)]
        many = [_middle(each[samples], middle) for each in (one, two)]
        cells = [float(v) if np.isfinite(v) else None for v in values]
        rows.append([*cells, float((many[0] < many[1]).mean()), float((many[0] > many[1]).mean())])
    return rows


def _middle(values: FloatArray, middle: str) -> Any:
    # Along the last axis, NaN left out; the median is a demand that occurred, for some are infinite.
    if middle == "mean":
        return np.nanmean(values, axis=-1)
    return np.nanquantile(values, 0.5, axis=-1, method="inverted_cdf")


def device_numbers(
    device: Device, runs: IntensityRuns, resamples: int, eccentric: float | None
) -> tuple[dict[str, Any], dict[str, Curve]]:
    """Return what is kept of a device, and its curves by limit state."""
    curves = {limit.name: curve_of(runs, limit, resamples) for limit in LIMITS}
    collapse = runs.exceeded(COLLAPSE)
    failed = (runs.table["outcome"] == FAILURE).to_numpy(dtype=float)
    failed[np.isnan(collapse)] = np.nan
    floors = by_stripe(runs, runs.demand(FLOOR))
    bearings = [link.bearing for link in frame_of(device).bearings.values()]
    kept = {
        "name": device.name,
        "device": device._asdict(),
        "capacity": bearings[0].lateral_capacity,
        "sliders": sorted({round(each.slider_radius, 5) for each in bearings}),
        "dishes": sorted({round(dish_diameter(each), 5) for each in bearings}),
        "energies": energies(device),
        "cost": cost_of(bearings, device.strength, PRICES),
        "volume": volume_of(bearings),
        "limits": {name: numbers_of(curve, band=False) for name, curve in curves.items()},
        "collapse": np.nanmean(by_stripe(runs, collapse), axis=0).tolist(),
        "failed": np.nanmean(by_stripe(runs, failed), axis=0).tolist(),
        "unknown": int(np.isnan(collapse).sum()),
        "floors": [float(v) if np.isfinite(v) else None for v in _middle(floors.T, "median")],
        "statuses": runs.table["status"].value_counts().to_dict(),
        "eccentricity": eccentric,
    }
    curve = curves[COLLAPSE.name]
    if not isinstance(curve, str):
        at = considered()
        kept["margin"] = [collapse_margin_ratio(v, at) for v in kept_median(kept)]
    return kept, curves


def kept_median(kept: Mapping[str, Any]) -> list[float]:
    """Return the median of collapse with its interval."""
    return list(kept["limits"][COLLAPSE.name]["median"])


def pair_of(
    own: IntensityRuns,
    other: IntensityRuns,
    curves: tuple[Mapping[str, Curve], Mapping[str, Curve]],
    resamples: int,
) -> dict[str, Any]:
    """Return a device beside another one under the same records."""
    samples = drawn(len(own.motions), resamples)
    collapses = [by_stripe(each, each.exceeded(COLLAPSE)) for each in (own, other)]
    floors = [by_stripe(each, each.demand(FLOOR)) for each in (own, other)]
    ratios: dict[str, Any] = {}
    for limit in LIMITS:
        first, second = (each[limit.name] for each in curves)
        if isinstance(first, str) or isinstance(second, str):
            ratios[limit.name] = None
            continue
        row = compare_fragility(second, first).to_dataframe(SURE).loc["median, ratio [-]"]
        ratios[limit.name] = [float(row[key]) for key in ("value", "low", "high", "second better")]
    return {
        "ratios": ratios,
        "collapse": ahead(collapses[0], collapses[1], samples, "mean"),
        "floors": ahead(floors[0], floors[1], samples, "median"),
    }


def eccentricity_of(data: xr.Dataset, device: str) -> float | None:
    """Return the share of complete runs whose sliders' resultant reaches their edge."""
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
    complete = np.array([str(s) in ("ok", "inaccurate") for s in own["status"].to_numpy()])
    if not complete.any():
        return None
    reached = own["peak_eccentricity_loaded"].to_numpy()[complete]
    return float((reached.max(axis=tuple(range(1, reached.ndim))) > 1.0).mean())
