"""Numbers and the figure of motions that are turned, repeated, with and without the vertical part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from frames.risk import FragilityError, compare_fragility, fragility_of
from frames.risk.fragility.runs import COMPLETE, FAILURE, UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd
    from matplotlib.figure import Figure

    Own = Mapping[str, Any]

LIR, PLAIN = DEVICES = ("LIR-DCFP", "DCFP")
ANGLES = 0, 30, 60
"""By which records are turned [degrees]: the building is its own image after a quarter turn."""

SECONDS = ("same", 0.5), ("same", 0.8), ("same", 1.0), ("next", 1.0)
"""Second shocks: the same record or the next of the set, and the factor on it."""

WHOLE = {1.0}
"""Factors of second shocks that intact buildings meet as their first one, too."""

PEAKS = {
    "axial force": 1e-3,
    "minimum axial force": 1e-3,
    "maximum uplift": 1e3,
    "bearing displacement": 1e3,
    "interface slip": 1e3,
}
"""Peaks that a vertical component may change, and factors to kN and mm."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return by angle, second shock and vertical component how many runs collapse."""
    return {
        "turned": _turned(every["turned"]),
        "seconds": {
            f"{factor:g} of the {following} record": {
                name: second_shock(every["same"], every[following], name, following, factor)
                for name in DEVICES
            }
            for following, factor in SECONDS
        },
        "vertical": _vertical(every["vertical"]),
    }


def counted(over: Any) -> list[int]:
    """Return how many runs exceed a limit, and of how many that is known."""
    return [int(np.nansum(over)), int(np.isfinite(over).sum())]


def _turned(tables: Any) -> dict[str, Any]:
    # By limit state and angle: counts and the ratio of medians; how often the angle decides.
    found: dict[str, Any] = {}
    for limit in tables.limits:
        rows = found[limit.name] = {}
        for angle in ANGLES:
            own = {name: at_angle(tables.runs[name], angle) for name in DEVICES}
            rows[f"{angle}"] = {
                "counts": [counted(own[name].exceeded(limit)) for name in DEVICES],
                "ratio": _ratio([own[name] for name in DEVICES], limit),
            }
    differ = {}
    for name in DEVICES:
        over = np.array(
            [
                at_angle(tables.runs[name], angle).exceeded(tables.comparison.collapse)
                for angle in ANGLES
            ]
        )
        known = np.isfinite(over).all(axis=0)
        some = over[:, known].max(axis=0) > over[:, known].min(axis=0)
        differ[name] = [int(some.sum()), int(known.sum())]
    return {"limits": found, "differ": differ}


def at_angle(runs: Any, angle: int) -> Any:
    """Return runs under records at an angle [degrees], in the order of the records."""
    motions = runs.table["motion"].astype(str)
    turned = motions.str.endswith(" degrees")
    return runs.those((motions.str.endswith(f", {angle} degrees") if angle else ~turned).to_numpy())


def _ratio(pair: Sequence[Any], limit: Any) -> list[float] | None:
    # Median of the LIR-DCFP over that of the DCFP with its interval of 90 %.
    try:
        own, other = (fragility_of(runs, limit) for runs in pair)
        row = compare_fragility(other, own).to_dataframe(confidence=0.9)
    except FragilityError:
        return None
    return [float(row.loc["median, ratio [-]", key]) for key in ("value", "low", "high")]


def second_shock(
    same: Any, both: Any, name: str, following: str, factor: float
) -> list[dict[str, Any]]:
    """Return what a second shock does to survivors of the first, by intensity of the first."""
    collapse = same.comparison.collapse
    alone, after = (_table(each.runs[name], collapse) for each in (same, both))
    alone = alone[~alone["motion"].str.contains(", then ")]
    names = list(dict.fromkeys(alone["motion"]))
    others = dict(zip(names, names if following == "same" else names[1:] + names[:1], strict=True))
    rows = []
    for scale, first in alone.groupby("scale"):
        one = first.set_index("motion")
        second = after[np.isclose(after["scale"], scale)].set_index("motion")
        two = second.loc[[f"{n}, then {factor:g} {others[n]}" for n in names]].set_axis(names)
        known = (one["outcome"] == COMPLETE) & ~one["over"] & (two["outcome"] != UNKNOWN)
        intact = one.loc[[others[n] for n in names]].set_axis(names)
        held = known & (two["outcome"] == COMPLETE)
        rows.append(
            {
                "scale": float(scale),
                "survived": int(known.sum()),
                "collapsed": int((known & two["over"]).sum()),
                "bearing": int((known & (two["outcome"] == FAILURE)).sum()),
                "intact": int((known & intact["over"]).sum()) if factor in WHOLE else None,
                "slip": [_median(each["residual interface slip"][held]) for each in (one, two)],
            }
        )
    return rows


def _table(runs: Any, collapse: Any) -> pd.DataFrame:
    table = runs.table
    return table.assign(motion=table["motion"].astype(str), over=runs.exceeded(collapse) > 0.0)


def _median(values: pd.Series) -> float | None:
    return 1e3 * float(values.median()) if len(values) else None


def _vertical(tables: Any) -> dict[str, Any]:
    # Collapse with and without the component, runs that differ, medians of peaks.
    found: dict[str, Any] = {}
    for name in DEVICES:
        table = _table(tables.runs[name], tables.comparison.collapse)
        flat = table["motion"].str.endswith(", horizontal")
        key = table["motion"].str.removesuffix(", horizontal")
        index = [key.to_numpy(), table["scale"].round(9).to_numpy()]
        whole, plain = (table.set_index(index)[mask.to_numpy()] for mask in (~flat, flat))
        plain = plain.loc[whole.index]
        both = (whole["outcome"] == COMPLETE) & (plain["outcome"] == COMPLETE)
        found[name] = {
            "collapsed": [int(each["over"].sum()) for each in (plain, whole)],
            "runs": len(whole),
            "turned": [
                int((whole["over"] & ~plain["over"]).sum()),
                int((plain["over"] & ~whole["over"]).sum()),
            ],
            "peaks": {
                quantity: [factor * float(each[quantity][both].median()) for each in (plain, whole)]
                for quantity, factor in PEAKS.items()
            },
        }
    return found


def totals(own: Own, second: str, device: str) -> tuple[int, int]:
    """Return survivors of a first shock that collapse in a second, and all survivors."""
    rows = own["seconds"][second][device]
    return sum(row["collapsed"] for row in rows), sum(row["survived"] for row in rows)


def figures(campaigns: object, own: Own) -> dict[str, Figure]:
    """Return the share of survivors of a first shock that collapse in the second."""
    del campaigns
    figure = ps.new_figure(2.9)
    ((panel,),) = ps.grid_of(figure, 1, 1)
    seconds = list(own["seconds"])
    for k, (name, shade) in enumerate(zip(DEVICES, ("#1a1a1a", "#bbbbbb"), strict=True)):
        pairs = [totals(own, second, name) for second in seconds]
        at = np.arange(len(seconds)) + 0.38 * (k - 0.5)
        share = [100.0 * part / whole if whole else 0.0 for part, whole in pairs]
        bars = panel.bar(at, share, 0.36, color=shade, edgecolor="black", label=name)
        panel.bar_label(bars, [f"{a} of {b}" for a, b in pairs], fontsize=ps.SMALL)
    panel.set_xticks(range(len(seconds)), seconds)
    panel.margins(y=0.15)
    ps.caption(panel, y="collapse in the second [%]")
    ps.add_legend(figure, panel.get_legend_handles_labels()[0], columns=2)
    return {"seconds": figure}
