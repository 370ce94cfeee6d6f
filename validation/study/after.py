"""Numbers and the figure of what follows the failure of a bearing: collapse, or a stop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from frames.risk import LimitState
from frames.risk.fragility.runs import UNKNOWN
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    Own = Mapping[str, Any]

PAIRS = {
    "failure is collapse": ("LIR-DCFP", "DCFP"),
    "a stop after 20 mm": ("LIR-DCFP with a stop", "DCFP with a stop"),
}
"""Devices by what follows the failure of a bearing."""

WENT_ON = {
    "drift": ("storey drift, mean", 100.0),
    "ductility": ("ductility", 1.0),
    "floor": ("floor acceleration in plan, mean", 1.0 / STANDARD_GRAVITY),
}
"""Quantities of runs that went on after a failure, and factors to per cent and g."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return of each device and intensity how many runs fail and collapse, and medians after it."""
    tables = every["after"]
    return {
        "stripes": {
            name: _stripes(runs, tables.comparison.collapse) for name, runs in tables.runs.items()
        }
    }


def _stripes(runs: Any, collapse: LimitState) -> list[dict[str, Any]]:
    failed, collapsed = runs.exceeded(LimitState.bearing_failure()), runs.exceeded(collapse)
    table, rows = runs.table, []
    for level in sorted(set(table["im"].round(9))):
        own = np.isclose(table["im"], level) & (table["outcome"] != UNKNOWN).to_numpy()
        after = own & (table["status"] == "bearing_lost").to_numpy()
        rows.append(
            {
                "im": float(level),
                "known": int(own.sum()),
                "failed": int(np.nansum(failed[own])),
                "collapsed": int(np.nansum(collapsed[own])),
                "went on": int(after.sum()),
                **{
                    key: factor * float(table[name][after].median()) if after.any() else None
                    for key, (name, factor) in WENT_ON.items()
                },
            }
        )
    return rows


def carried(own: Own, device: str) -> tuple[int, int]:
    """Return how many runs that went on after a failure collapse, of how many."""
    rows = [row for row in own["stripes"][device] if row["went on"]]
    return sum(row["collapsed"] for row in rows), sum(row["went on"] for row in rows)


def reached(own: Own, key: str) -> tuple[float, float]:
    """Return the least and largest median of a quantity after a failure; 0 if none went on."""
    values = [row[key] for rows in own["stripes"].values() for row in rows if row[key] is not None]
    return (min(values), max(values)) if values else (0.0, 0.0)


def figures(campaigns: object, own: Own) -> dict[str, Figure]:
    """Return shares of collapse over intensity, a panel each follow-up of a failure."""
    del campaigns
    figure = ps.new_figure(2.9)
    (panels,) = ps.grid_of(figure, 1, len(PAIRS), share_x=True, share_y=True)
    for panel, (title, devices) in zip(panels, PAIRS.items(), strict=True):
        for k, device in enumerate(devices):
            rows = [row for row in own["stripes"][device] if row["known"]]
            share = [row["collapsed"] / row["known"] for row in rows]
            look = {**ps.line_of(k), "marker": "os"[k], "markersize": 3.5}
            panel.plot([row["im"] for row in rows], share, label=devices[k][:8].strip(), **look)
        panel.set_ylim(-0.02, 1.02)
        ps.caption(panel, title=title, x="Sa(3 s) [m/s2]")
    ps.caption(panels[0], y="share that collapses [-]")
    ps.add_legend(figure, panels[0].get_lines(), columns=2)
    return {"collapse": figure}
