"""What the page of motions says, from the runs of each campaign: plain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.risk.fragility.runs import COMPLETE, FAILURE, UNKNOWN
from validation.measurements.yielding_runs import LIR
from validation.study.motions_runs import PULSES, After
from validation.study.paired import LIMITS, WEAK, curve_of, median_of, ratio_of, shares_of
from validation.study.records_runs import COLLAPSE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from frames.risk import IntensityRuns


def of_angles(runs: Mapping[int, Mapping[str, IntensityRuns]], resamples: int) -> dict[str, Any]:
    """Return medians by angle and device, ratios, and how often an angle decides."""
    found: dict[str, Any] = {"limits": {}, "differ": {}}
    for limit in LIMITS:
        own: dict[str, Any] = {}
        for angle, each in runs.items():
            curves = {name: curve_of(table, limit, resamples) for name, table in each.items()}
            own[str(angle)] = {
                "medians": {name: median_of(curve) for name, curve in curves.items()},
                "ratio": ratio_of(curves[LIR], curves[WEAK]),
                "shares": {name: shares_of(table, limit) for name, table in each.items()},
            }
        found["limits"][limit.name] = own
    for name in next(iter(runs.values())):
        over = np.array([each[name].exceeded(COLLAPSE) for each in runs.values()])
        known = np.isfinite(over).all(axis=0)
        some = over[:, known].max(axis=0) > over[:, known].min(axis=0)
        found["differ"][name] = [int(some.sum()), int(known.sum())]
    return found


def of_seconds(
    alone: Mapping[str, pd.DataFrame],
    after: Mapping[str, Mapping[str, pd.DataFrame]],
    kinds: Mapping[str, After],
) -> dict[str, Any]:
    """Return what second shocks do to buildings that survived the first."""
    return {
        second: {name: _second(alone[name], table, kinds[second]) for name, table in own.items()}
        for second, own in after.items()
    }


def _second(alone: pd.DataFrame, both: pd.DataFrame, after: After) -> list[dict[str, Any]]:
    keys = ["motion", "scale"]
    first = alone.set_index(keys)
    names = list(dict.fromkeys(alone["motion"]))
    following = dict(zip(names, names[1:] + names[:1] if after.other else names, strict=True))
    rows = []
    for scale, own in both.groupby("scale"):
        row: dict[str, Any] = {"scale": float(scale)}
        at = own.set_index("motion")
        before = first.loc[[(name, scale) for name in at.index]].droplevel("scale")
        survived = (before["outcome"] == COMPLETE) & ~collapsed(before)
        known = survived & (at["outcome"] != UNKNOWN)
        fallen = known & collapsed(at)
        next_ones = first.loc[[(following[name], scale) for name in at.index]]
        intact = next_ones["outcome"].to_numpy() != UNKNOWN
        row["motions"] = len(at)
        row["survived"] = int(survived.sum())
        row["known"] = int(known.sum())
        row["collapsed"] = int(fallen.sum())
        row["bearing"] = int((known & (at["outcome"] == FAILURE)).sum())
        alone_falls = known.to_numpy() & intact & collapsed(next_ones).to_numpy()
        row["intact"] = [int(alone_falls.sum()), int((known.to_numpy() & intact).sum())]
        held = known & (at["outcome"] == COMPLETE)
        for key in ("residual interface slip", "residual bearing displacement"):
            row[key] = [_median(before[key][held]), _median(at[key][held])]
        rows.append(row)
    return rows


def collapsed(table: pd.DataFrame) -> pd.Series:
    """Return whether runs collapse: a bearing failed, or the ductility of collapse is exceeded."""
    assert COLLAPSE.limit is not None
    return (table["outcome"] == FAILURE) | (table["ductility"] > COLLAPSE.limit)


def _median(values: pd.Series) -> float | None:
    return float(values.median()) if len(values) else None


VERTICAL_SHOWN = (
    "axial force",
    "minimum axial force",
    "maximum uplift",
    "floor acceleration, vertical, mean",
    "bearing displacement",
    "interface slip",
)


def of_vertical(
    flat: Mapping[str, IntensityRuns], whole: Mapping[str, IntensityRuns], resamples: int
) -> dict[str, Any]:
    """Return what the vertical component changes, by device."""
    found: dict[str, Any] = {}
    for name, before in flat.items():
        after = whole[name]
        curves = [curve_of(each, COLLAPSE, resamples) for each in (before, after)]
        over = np.array([each.exceeded(COLLAPSE) for each in (before, after)])
        both = (before.table["outcome"] == COMPLETE) & (after.table["outcome"] == COMPLETE)
        at = before.table["im"]
        found[name] = {
            "medians": [median_of(curve) for curve in curves],
            "ratio": ratio_of(curves[1], curves[0]),
            "shares": [shares_of(each, COLLAPSE) for each in (before, after)],
            "turned": [int((one < other).sum()) for one, other in (over, over[::-1])],
            "peaks": {
                quantity: [
                    [
                        float(level),
                        int((both & (at == level)).sum()),
                        *(
                            _median(each.table[quantity][both & (at == level)])
                            for each in (before, after)
                        ),
                    ]
                    for level in sorted(set(at))
                ]
                for quantity in VERTICAL_SHOWN
            },
        }
    curves_of = {
        kind: {name: curve_of(each, COLLAPSE, resamples) for name, each in runs.items()}
        for kind, runs in (("flat", flat), ("whole", whole))
    }
    return {
        "devices": found,
        "ratios": {kind: ratio_of(c[LIR], c[WEAK]) for kind, c in curves_of.items()},
    }


def of_pulses(runs: Mapping[str, IntensityRuns]) -> dict[str, Any]:
    """Return by device and pulse the intensity of collapse, and where the bearing failed first."""
    found: dict[str, Any] = {}
    for name, each in runs.items():
        table = each.table.assign(over=each.exceeded(COLLAPSE))
        rows = {}
        for pulse in PULSES:
            own = table[table["motion"] == pulse.name].sort_values("im")
            rows[pulse.name] = first_over(
                own["im"].to_numpy(), own["over"].to_numpy(), own["status"].to_numpy()
            )
        found[name] = rows
    return found


def first_over(im: Any, over: Any, status: Sequence[str]) -> dict[str, Any]:
    """Return between which intensities collapse begins, how, and whether it goes on above.

    Shapes: im, over, status (n,).
    """
    known = np.isfinite(over)
    places = np.flatnonzero(known & (np.asarray(over) > 0.5))
    if not len(places):
        return {"low": float(np.asarray(im)[known].max()), "high": None, "status": "", "again": 0}
    first = int(places[0])
    before = np.flatnonzero(known[:first])
    return {
        "low": float(im[before[-1]]) if len(before) else None,
        "high": float(im[first]),
        "status": str(status[first]),
        "again": int((np.asarray(over)[first:] < 0.5).sum()),
    }
