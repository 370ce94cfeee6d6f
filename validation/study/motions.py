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

PEAKS = {"axial force": 1e-3, "maximum uplift": 1e3, "bearing displacement": 1e3}
"""Peaks that a vertical component may change, and factors to kN and mm."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return by angle, second shock and vertical component how many runs collapse."""
    return {
        "turned": turned({name: table_of(every["turned"], name) for name in DEVICES}),
        "seconds": {
            f"{factor:g} of the {following} record": second_shocks(
                {
                    name: [table_of(every[part], name) for part in ("same", following)]
                    for name in DEVICES
                },
                following,
                factor,
            )
            for following, factor in SECONDS
        },
        "vertical": {name: _vertical(table_of(every["vertical"], name)) for name in DEVICES},
    }


def table_of(tables: Any, device: str) -> pd.DataFrame:
    """Return the runs of a device, with "over", whether they collapse (NaN: unknown)."""
    runs = tables.runs[device]
    over = runs.exceeded(tables.comparison.collapse)
    return runs.table.assign(motion=runs.table["motion"].astype(str), over=over)


def apart(own: pd.Series, other: pd.Series) -> list[float]:
    """Return in how many runs one alone collapses, own and other, and the exact two-sided p."""
    both = (own - other).dropna()
    more, less = int((both > 0.0).sum()), int((both < 0.0).sum())
    return [more, less, binomtest(more, more + less).pvalue if more + less else 1.0]


def turned(tables: Mapping[str, pd.DataFrame]) -> dict[str, Any]:
    """Return collapses by angle and device, and the records in which the angle decides."""
    found: dict[str, Any] = {"angles": {}}
    wide = {}
    for name, table in tables.items():
        parts = table["motion"].str.extract(r"^(.*?)(?:, (\d+) degrees)?$").fillna({1: "0"})
        keyed = table.assign(record=parts[0], angle=parts[1].astype(int))
        wide[name] = keyed.pivot_table(index=["record", "scale"], columns="angle", values="over")
    for angle in ANGLES:
        own = {name: each[angle] for name, each in wide.items()}
        counts = {name: [int(each.sum()), int(each.count())] for name, each in own.items()}
        found["angles"][f"{angle}"] = counts | {"apart": apart(own[LIR], own[PLAIN])}
    known = {name: each.dropna() for name, each in wide.items()}
    found["decides"] = {
        name: [int((each.max(axis=1) > each.min(axis=1)).sum()), len(each)]
        for name, each in known.items()
    }
    return found


def second_shocks(
    tables: Mapping[str, list[pd.DataFrame]], following: str, factor: float
) -> dict[str, Any]:
    """Return collapses in a second shock of buildings that survived the first, by device."""
    found: dict[str, Any] = {}
    second = {}
    for name, (alone, both) in tables.items():
        one = alone[~alone["motion"].str.contains(", then ")].set_index("motion")
        names = list(one.index)
        others = names if following == "same" else names[1:] + names[:1]
        after = [f"{a}, then {factor:g} {b}" for a, b in zip(names, others, strict=True)]
        two = both.set_index("motion").loc[after].set_axis(names)
        survived = (one["outcome"] == COMPLETE) & (one["over"] < 1.0) & (two["outcome"] != UNKNOWN)
        second[name] = two["over"].where(survived)
        held = survived & (two["outcome"] == COMPLETE)
        found[name] = {
            "survived": int(survived.sum()),
            "collapsed": int(second[name].sum()),
            "slip": [
                1e3 * float(each.loc[held, "residual interface slip"].median())
                for each in (one, two)
                if held.any()
            ],
        }
    return found | {"apart": apart(second[LIR], second[PLAIN])}


def _vertical(table: pd.DataFrame) -> dict[str, Any]:
    # Collapse without and with the component, runs that differ, medians of peaks.
    flat = table["motion"].str.endswith(", horizontal")
    index = [table["motion"].str.removesuffix(", horizontal"), table["scale"].round(9)]
    keyed = table.set_index(index)
    plain, whole = (keyed[mask.to_numpy()] for mask in (flat, ~flat))
    plain = plain.loc[whole.index]
    both = (whole["outcome"] == COMPLETE) & (plain["outcome"] == COMPLETE)
    peaks = {
        q: [factor * float(each.loc[both, q].median()) for each in (plain, whole)]
        for q, factor in PEAKS.items()
        if both.any()
    }
    collapsed = [int(np.nansum(each["over"])) for each in (plain, whole)]
    return {"collapsed": collapsed, "runs": len(whole), "peaks": peaks} | {
        "apart": apart(whole["over"], plain["over"])
    }
