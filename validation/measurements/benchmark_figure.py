"""The figure of the benchmark: cost over size, and error over cost."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.plots.plot_style import PALETTE, SMALL, add_legend, caption, grid_of, new_figure
from validation.measurements.benchmark_page import second_cost, there_are
from validation.measurements.benchmark_search import ALLOWED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KINDS = {"singleFPBearing": "o", "LIR-DCFP, in-process coupling": "s"}
"""By marker; beside a kind stands our own device of it."""
WHO = {"direct": PALETTE[0], "reduced": PALETTE[2], "usual": PALETTE[3], "best": PALETTE[1]}
NAMES = {
    "direct": "here, direct",
    "reduced": "here, reduced",
    "usual": "OpenSees, usual settings",
    "best": "OpenSees at its best",
}
FLOOR = 1e-3  # %: errors below are drawn here


def size_panel(ax: Axes, kept: dict[str, Any]) -> None:
    """Draw the cost of a second of the motion over the number of bearings."""
    large = [one for one in there_are(kept) if one.case in "bcd"]
    for kind, marker in KINDS.items():
        for who, colour in WHO.items():
            points = sorted((one.bearings, second_cost(kept[one.key], kind, who)) for one in large)
            points = [(n, cost) for n, cost in points if math.isfinite(cost)]
            if points:
                ax.plot(
                    *zip(*points, strict=True),
                    color=colour,
                    marker=marker,
                    ms=3.5,
                    lw=0.0,
                    mfc=colour if marker == "s" else "white",
                )
    ax.set(xscale="log", yscale="log", xlim=(7.0, 330.0))
    ax.set_xticks([9, 16, 25, 36, 100, 256], labels=["9", "16", "25", "36", "100", "256"])
    ax.minorticks_off()
    caption(ax, x="bearings", y="computation / motion [s/s]", title="cost over size")


def error_panel(ax: Axes, found: dict[str, Any]) -> None:
    """Draw error over cost of the building on nine bearings."""
    ours = found["here"]
    for device, marker in (("plain DCFP", "o"), ("LIR-DCFP", "s")):
        for method, one in ours[device].items():
            pairs = [
                (run["loop"], max(100.0 * error, FLOOR))
                for run, error in zip(one.get("runs", [])[:4], one.get("errors", []), strict=False)
            ]
            if pairs:
                ax.plot(
                    *zip(*pairs, strict=True),
                    color=WHO[method],
                    marker=marker,
                    ms=3.5,
                    lw=1.0,
                    mfc=WHO[method] if marker == "s" else "white",
                )
    for kind, marker in KINDS.items():
        for name in ("usual", "best"):
            one = found["there"][kind][name]
            if math.isfinite(one["dt"]) and "loop" in one:
                ax.plot(
                    [one["loop"]],
                    [max(100.0 * one["error"], FLOOR)],
                    color=WHO[name],
                    marker=marker,
                    ms=4.5,
                    mfc=WHO[name] if marker == "s" else "white",
                    lw=0.0,
                )
    ax.axhline(100.0 * ALLOWED, color="black", ls="--", lw=0.9)
    ax.set(xscale="log", yscale="log")
    caption(
        ax,
        x="CPU time of the steps [s]",
        y="error of the peak displacement [%]",
        title="3 storeys, 9 bearings, 12 s",
    )


def draw(kept: dict[str, Any]) -> Figure:
    """Draw both panels, of what there is."""
    figure = new_figure(3.6)
    ((left, right),) = grid_of(figure, 1, 2)
    size_panel(left, kept)
    if kept.get("b", {}).get("state") == "ok":
        error_panel(right, kept["b"])
    handles = [
        Line2D([], [], color=colour, marker="s", ms=4.0, lw=0.0, label=NAMES[who])
        for who, colour in WHO.items()
        if who != "reduced" or _has_reduced(kept)
    ]
    handles += [
        Line2D([], [], color="black", marker="s", ms=4.0, lw=0.0, label="LIR-DCFP"),
        Line2D([], [], color="black", marker="o", mfc="white", ms=4.0, lw=0.0, label="plain DCFP"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="error allowed"),
    ]
    add_legend(figure, handles, columns=3, size=SMALL)
    return figure


def _has_reduced(kept: dict[str, Any]) -> bool:
    return any("runs" in kept[one.key]["here"]["LIR-DCFP"]["reduced"] for one in there_are(kept))
