"""Numbers of records that are turned, repeated, with and without the vertical component."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import binomtest

from frames.risk.fragility.runs import COMPLETE, UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

LIR, PLAIN = DEVICES = ("LIR-DCFP", "DCFP")
ANGLES = 0, 30, 60
"""Angles of the records [degrees]: the building is its own image after a quarter turn."""

SECONDS = ("same", 0.5), ("same", 1.0), ("next", 1.0)
"""Second shocks: the same record or the next of the set, and the factor on it."""

SLIP = "residual interface slip"
PEAKS = {"axial force": 1e-3, "maximum uplift": 1e3, "bearing displacement": 1e3}
"""Peaks that a vertical component may change, and factors to kN and mm."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return by angle, second shock and vertical component how many runs collapse."""
    runs = {name: {k: table_of(each, k) for k in DEVICES} for name, each in every.items()}
    return {
        "turned": turned(runs["turned"]),
        "seconds": {
            f"{factor:g} of the {following} record": second_shocks(
                {k: [runs["same"][k], runs[following][k]] for k in DEVICES}, following, factor
            )
            for following, factor in SECONDS
        },
        "vertical": {name: _vertical(table) for name, table in runs["vertical"].items()},
    }


def table_of(tables: Any, device: str) -> pd.DataFrame:
    """Return the runs of a device, with "over", whether they collapse (NaN: unknown)."""
    runs = tables.runs[device]
    return runs.table.assign(over=runs.exceeded(tables.comparison.collapse))


def apart(own: pd.Series, other: pd.Series) -> list[float]:
    """Return in how many runs one alone collapses, own and other, and the exact two-sided p."""
    both = (own - other).dropna()
    more, less = int((both > 0.0).sum()), int((both < 0.0).sum())
    return [more, less, binomtest(more, more + less).pvalue if more + less else 1.0]


def turned(tables: Mapping[str, pd.DataFrame]) -> dict[str, Any]:
    """Return collapses by angle and device, and the records in which the angle decides."""
    wide = {}
    for name, table in tables.items():
        angle = table["motion"].str.extract(r", (\d+) degrees$", expand=False).fillna("0")
        wide[name] = table.assign(angle=angle).pivot(index="record", columns="angle", values="over")
    found: dict[str, Any] = {"angles": {}, "decides": {}}
    for angle in map(str, ANGLES):
        counts = {name: [int(v[angle].sum()), int(v[angle].count())] for name, v in wide.items()}
        found["angles"][angle] = counts | {"apart": apart(wide[LIR][angle], wide[PLAIN][angle])}
    for name, each in wide.items():
        known = each.dropna()
        found["decides"][name] = [int((known.nunique(axis=1) > 1).sum()), len(known)]
    return found


def second_shocks(
    tables: Mapping[str, list[pd.DataFrame]], following: str, factor: float
) -> dict[str, Any]:
    """Return collapses in a second shock of buildings that survived the first, by device."""
    found, second = {}, {}
    for name, (alone, both) in tables.items():
        one = alone[~alone["motion"].str.contains(", then ")].set_index("motion")
        names = list(one.index)
        others = names if following == "same" else names[1:] + names[:1]
        after = [f"{a}, then {factor:g} {b}" for a, b in zip(names, others, strict=True)]
        two = both.set_index("motion").loc[after].set_axis(names)
        survived = (one["outcome"] == COMPLETE) & (one["over"] < 1.0) & (two["outcome"] != UNKNOWN)
        second[name] = two["over"].where(survived)
        slips = [each[survived & (two["outcome"] == COMPLETE)][SLIP] for each in (one, two)]
        found[name] = {
            "survived": int(survived.sum()),
            "collapsed": int(second[name].sum()),
            "slip": [1e3 * float(each.median()) for each in slips if len(each)],
        }
    return found | {"apart": apart(second[LIR], second[PLAIN])}


def _vertical(table: pd.DataFrame) -> dict[str, Any]:
    # Collapse without and with the component, runs that differ, medians of peaks.
    flat = table["motion"].str.endswith(", horizontal")
    plain, whole = (table[mask].set_index(["record", "scale"]) for mask in (flat, ~flat))
    both = (whole["outcome"] == COMPLETE) & (plain["outcome"] == COMPLETE)
    peaks = {
        q: [factor * float(each.loc[both, q].median()) for each in (plain, whole)]
        for q, factor in PEAKS.items()
    }
    return {
        "collapsed": [int(np.nansum(each["over"])) for each in (plain, whole)],
        "runs": len(whole),
        "peaks": peaks if both.any() else {},
        "apart": apart(whole["over"], plain["over"]),
    }
