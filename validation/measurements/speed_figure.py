"""The figure of error over cost: a panel for each test case, a line for each level."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from matplotlib.lines import Line2D

from frames.plots.plot_style import GREY, PALETTE, SMALL, add_legend, caption, grid_of, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from validation.measurements.speed_runs import Result, Row

COLUMNS = 3
FLOOR = 2e-3
"""Errors below are drawn here [%]."""
LEVELS = {
    "pendulum": (PALETTE[0], "o"),
    "contact": (PALETTE[1], "s"),
    "contact at the corners": (PALETTE[3], "D"),
    "rigid_body": (PALETTE[2], "^"),
}
GOALS = (1.0, 3.0)


def level_of(row: Row) -> str:
    """Return the level by which a run is drawn."""
    return row.level.split(",")[0]


def panel(ax: Axes, result: Result) -> None:
    """Draw one test case."""
    for level, (colour, marker) in LEVELS.items():
        rows = [r for r in result.rows if level_of(r) == level and r.status == "ok"]
        if level == "rigid_body":
            line = [r for r in rows if "tolerance" in r.level]
            points = [r for r in rows if "explicit" in r.level]
        else:
            line = [r for r in rows if not math.isnan(r.dt)]
            points = [r for r in rows if math.isnan(r.dt)]
        for name, style, face in (("peak", "-", colour), ("quantile", ":", "white")):
            ax.plot(
                [r.share for r in line],
                [max(getattr(r.errors, name), FLOOR) for r in line],
                color=colour,
                ls=style,
                lw=1.1,
                marker=marker,
                ms=4.0,
                mfc=face,
                mew=0.8,
            )
            ax.plot(
                [r.share for r in points],
                [max(getattr(r.errors, name), FLOOR) for r in points],
                color=colour,
                ls="",
                marker="*" if level != "rigid_body" else "X",
                ms=6.0,
                mfc=face,
                mew=0.8,
            )
        if level == "pendulum" and len(line) > 1:
            for row in (line[0], line[-1]):
                first = row is line[0]
                ax.annotate(
                    f"{1e3 * row.dt:g} ms",
                    (row.share, max(row.errors.peak, FLOOR)),
                    xytext=(-5, -2) if first else (2, -10),
                    textcoords="offset points",
                    ha="right" if first else "center",
                    fontsize=SMALL - 1.0,
                    color=colour,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
                )
    ax.axhline(GOALS[1 if result.uplift else 0], color="black", lw=0.9, ls="--")
    ax.set(xscale="log", yscale="log", xlim=(2e-4, 25.0), ylim=(0.7 * FLOOR, 40.0))
    caption(ax, title=result.name)


def draw(results: list[Result]) -> Figure:
    """Draw all test cases that were run with several steps."""
    chosen = [r for r in results if len(r.rows) > 2]
    count = -(-len(chosen) // COLUMNS)
    figure = new_figure(1.0 + 2.1 * count)
    grid = grid_of(figure, count, COLUMNS, share_x=True, share_y=True)
    panels = [ax for row in grid for ax in row]
    for ax, result in zip(panels, chosen, strict=False):
        panel(ax, result)
    for ax in panels[len(chosen) :]:
        ax.set_visible(False)
    for ax in panels[: len(chosen)]:
        ax.tick_params(labelbottom=True)
    for row in grid:
        caption(row[0], y="error [%]")
    for ax in panels[max(len(chosen) - COLUMNS, 0) : len(chosen)]:
        caption(ax, x="computation / motion [s/s]")
    handles = [
        Line2D([], [], color=colour, marker=marker, ms=4.0, lw=1.1, label=name)
        for name, (colour, marker) in LEVELS.items()
    ]
    handles += [
        Line2D([], [], color=GREY, marker="o", ms=4.0, lw=1.1, label="peak displacement"),
        Line2D(
            [],
            [],
            color=GREY,
            marker="o",
            ms=4.0,
            mfc="white",
            ls=":",
            lw=1.1,
            label="force, 99.9 %",
        ),
        Line2D([], [], color=GREY, marker="*", ms=6.0, ls="", label="step chosen by the program"),
        Line2D([], [], color=PALETTE[2], marker="X", ms=6.0, ls="", label="rigid_body, explicit"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="goal, pendulum, displacement"),
    ]
    add_legend(figure, handles, columns=3, size=SMALL)
    return figure
