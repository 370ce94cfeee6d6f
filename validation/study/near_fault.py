"""Numbers and map of near-fault pulses: which device survives, and which is better."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from frames.design.project.inputs import bearing_of
from frames.plots import plot_style as ps
from frames.risk.fragility.runs import COMPLETE, FAILURE
from lir_element.units import STANDARD_GRAVITY as G
from validation.page import number, table
from validation.study.shown import sizes_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Own = Mapping[str, Any]

BEYOND = "LIR-DCFP beyond the checks, moat 517 mm"
DRIFT = 0.05
"""Storey drift from which a building counts as lost [-]: FEMA 356, collapse prevention of steel
frames (table C1-3; to be confirmed)."""

APART = 0.1
"""Share by which demands of two devices must differ [-]: less is alike."""

QUANTITIES = {
    "acceleration": ("floor acceleration in plan, mean", "floor acceleration [g]", 1 / G, ".2f"),
    "drift": ("storey drift, mean", "storey drift [%]", 100.0, ".2f"),
    "displacement": ("bearing displacement", "displacement [mm]", 1e3, ".0f"),
    "shear": ("base shear over weight", "base shear over weight [-]", 1.0, ".2f"),
    "rim": ("rim force", "rim force [kN]", 1e-3, ".0f"),
}
"""Demands by name: the quantity, its text, a factor from SI, a format."""

LIR_ONLY, LIR_BETTER, ALIKE, MIXED, PLAIN_BETTER, PLAIN_ONLY, NEITHER = range(7)
LOOKS = {
    LIR_ONLY: ("#1a1a1a", "", "L", "LIR-DCFP alone survives"),
    LIR_BETTER: ("#777777", "", "L", "both survive, LIR-DCFP better"),
    ALIKE: ("#ffffff", "", "=", "both survive, alike"),
    MIXED: ("#ffffff", "..", "", "both survive, one better in each"),
    PLAIN_BETTER: ("#d9d9d9", "", "D", "both survive, DCFP better"),
    PLAIN_ONLY: ("#d9d9d9", "///", "", "DCFP alone survives"),
    NEITHER: ("#ffffff", "xxx", "", "neither survives"),
}
"""Verdicts of cells: face, hatch, letter, legend; apart in grey, too."""


def lir(moat: int) -> str:
    """Return the name of the LIR-DCFP of a moat [mm]."""
    return f"LIR-DCFP, moat {moat} mm"


def plain(moat: int) -> str:
    """Return the name of the DCFP of a moat [mm]."""
    return f"DCFP, moat {moat} mm"


PLAN, MOAT = "plan 689 mm", "moat 517 mm"
PAIRS = {
    PLAN: (lir(517), plain(402)),
    "plan 817 mm": (lir(632), plain(517)),
    **{f"moat {moat} mm": (lir(moat), plain(moat)) for moat in (402, 517, 632)},
    "beyond": (BEYOND, plain(402)),
    "soft": (lir(517), "DCFP, soft rims"),
}
"""Devices that are compared: of equal plan, of equal moat, beyond the checks, soft rims."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return cells by device, velocity and period; sizes; differences at half the step."""
    tables = every["near_fault"]
    whole, half = (cells_of(every[name].campaign.to_dataframe()) for name in ("near_fault", "step"))
    pulses = tables.file.motions.pulses
    return {
        "velocities": sorted(pulses.velocities),
        "ratios": sorted(pulses.period_ratios),
        "devices": {
            str(device): {key: own[key].unstack().round(5).to_numpy().tolist() for key in own}
            for device, own in whole.groupby(level=0)
        },
        "period": bearing_of(tables.file.bearing).period,
        "sizes": {name: sizes_of(frame) for name, frame in tables.frames.items()},
        "steps": steps_of(whole, half),
    }


def cells_of(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the worse of both shapes by device, velocity and period of the pulse."""
    period = runs["motion"].str.extract(r" pulse of ([\d.]+) s", expand=False).astype(float)
    cells = pd.DataFrame({key: runs[name] for key, (name, *_) in QUANTITIES.items()})
    cells["failed"] = runs["outcome"] == FAILURE
    cells["lost"] = (runs["outcome"] != COMPLETE) | (cells["drift"] > DRIFT)
    return cells.astype(float).groupby([runs["model"], runs["scale"], period]).max()


def steps_of(whole: pd.DataFrame, half: pd.DataFrame) -> dict[str, dict[str, Any]]:
    """Return by device cells, those that end otherwise, median and largest change of demands."""
    whole, half = whole.align(half, join="inner", axis=0)
    apart = (half / whole - 1.0).abs()[half["lost"] + whole["lost"] < 1.0]
    found = {}
    for device, own in (half != whole).groupby(level=0):
        changes = apart[apart.index.isin(own.index)]
        found[str(device)] = {
            "cells": len(own),
            **{key: int(own[key].sum()) for key in ("failed", "lost")},
            "survived": len(changes),
            **{key: [changes[key].median(), changes[key].max()] for key in list(QUANTITIES)[:3]},
        }
    return found


def verdicts(own: Own, pair: str) -> Any:
    """Return verdicts on a pair, numbers of `LOOKS`, of shape (velocities, periods)."""
    devices = [own["devices"][name] for name in PAIRS[pair]]
    one, other = (np.array([each["acceleration"], each["drift"]]) for each in devices)
    lost, lost_too = (np.array(each["lost"], dtype=bool) for each in devices)
    less, more = ((a < (1.0 - APART) * b).any(axis=0) for a, b in ((one, other), (other, one)))
    kinds = NEITHER, LIR_ONLY, PLAIN_ONLY, MIXED, LIR_BETTER, PLAIN_BETTER  # the first that is so
    so = lost & lost_too, lost_too, lost, less & more, less, more
    return np.select(so, kinds, ALIKE)


def counts(own: Own, pair: str) -> dict[int, int]:
    """Return the number of cells of a pair by verdict."""
    found = verdicts(own, pair)
    return {kind: int((found == kind).sum()) for kind in LOOKS}


def both(counted: Mapping[int, int]) -> int:
    """Return in how many cells both devices survive."""
    return sum(counted[kind] for kind in (LIR_BETTER, ALIKE, MIXED, PLAIN_BETTER))


def failed(own: Own, device: str) -> int:
    """Return in how many cells a bearing of a device fails."""
    return int(np.sum(own["devices"][device]["failed"]))


def medians(own: Own, pair: str) -> dict[str, list[float]]:
    """Return medians of both devices, over the cells in which both survive and a rim is met."""
    devices = [own["devices"][name] for name in PAIRS[pair]]
    met = ~np.any([each["lost"] for each in devices], axis=0)
    met &= np.any([each["rim"] for each in devices], axis=0)
    return {
        key: [
            factor * float(np.median(np.array(each[key])[met])) if met.any() else np.nan
            for each in devices
        ]
        for key, (*_, factor, _) in QUANTITIES.items()
    } | {"cells": [float(met.sum())]}


def pairs_table(own: Own) -> str:
    """Return counts of cells of all pairs, and medians of the cells in which a rim is met."""
    lines = []
    for pair, names in PAIRS.items():
        found = medians(own, pair)
        values = (
            " / ".join(number(value, form) for value in found[key])
            for key, (*_, form) in QUANTITIES.items()
        )
        lines.append([" / ".join(names), *map(str, counts(own, pair).values()), *values])
    heads = *(text for *_, text in LOOKS.values()), *(text for _, text, *_ in QUANTITIES.values())
    return table(["LIR-DCFP / DCFP", *heads], lines)


def figures(campaigns: object, own: Own) -> dict[str, Figure]:
    """Return the map: a panel each limited plan (above) and moat (below)."""
    del campaigns
    figure, pairs = ps.new_figure(5.2), list(PAIRS)
    grid = ps.grid_of(figure, 2, 3, share_x=True, share_y=True)
    for row, shown in zip(grid, (pairs[:2], pairs[2:5]), strict=True):
        for panel, pair in zip(row, shown, strict=False):
            draw_cells(panel, own, pair)
            ps.caption(panel, title=f"equal {pair}")
        ps.caption(row[0], y="peak velocity [m/s]")
    for panel in grid[1]:
        ps.caption(panel, x="T_p / T_b [-]")
    grid[0][2].set_axis_off()
    grid[0][2].legend(handles=legend_handles(), loc="center", fontsize=ps.SMALL, frameon=False)
    return {"map": figure}


def draw_cells(panel: Axes, own: Own, pair: str) -> None:
    """Draw cells, and lines below the first cell of each period in which a bearing fails."""
    found = verdicts(own, pair)
    for (y, x), kind in np.ndenumerate(found):
        face, hatch, letter, _ = LOOKS[int(kind)]
        look: dict[str, Any] = {"facecolor": face, "hatch": hatch, "edgecolor": ps.GREY}
        panel.add_patch(Rectangle((x - 0.5, y - 0.5), 1.0, 1.0, linewidth=0.3, **look))
        ink = "white" if kind in (LIR_ONLY, LIR_BETTER) else "black"
        panel.text(x, y, letter, ha="center", va="center", fontsize=6.0, color=ink)
    for name, line in zip(PAIRS[pair], ps.LINES, strict=False):
        fails = np.array(own["devices"][name]["failed"], dtype=bool)
        first = np.where(fails.any(axis=0), fails.argmax(axis=0), len(fails)) - 0.5
        for color, width, style in (("white", 3.2, "-"), ("black", 1.5, line)):
            look = {"color": color, "linewidth": width, "linestyle": style}
            panel.stairs(first, np.arange(len(first) + 1) - 0.5, baseline=None, **look)
    panel.grid(visible=False)
    panel.set_xlim(-0.5, found.shape[1] - 0.5)
    panel.set_ylim(-0.5, found.shape[0] - 0.5)
    panel.set_xticks(range(found.shape[1]), [f"{ratio:g}" for ratio in own["ratios"]], rotation=90)
    panel.set_yticks(range(found.shape[0]), [f"{v:g}" for v in own["velocities"]])


def legend_handles() -> list[Any]:
    """Return the entries of a legend of cells and lines."""
    patches = [
        Patch(facecolor=face, hatch=hatch, edgecolor=ps.GREY, label=text)
        for face, hatch, _, text in LOOKS.values()
    ]
    lines = [
        Line2D([], [], color="black", linestyle=line, label=f"{name}: bearing fails above")
        for name, line in zip(("LIR-DCFP", "DCFP"), ps.LINES, strict=False)
    ]
    return [*patches, *lines]
