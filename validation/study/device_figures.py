"""The figures of the study of the best devices, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from frames.plots import plot_style as ps
from validation.measurements.yielding_runs import LIR
from validation.study.device_numbers import SURE
from validation.study.device_runs import OTHERS, STRIPES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

SEARCH, MARGINS, REGIONS, COST = (
    f"study_device-{name}.png" for name in ("search", "margins", "regions", "cost")
)
KINDS = (LIR, *OTHERS)
MARKERS = "os^dv"
COLOURS = {"LIR": ps.PALETTE[0], "DCFP": ps.PALETTE[1], "": "#E8E8E8"}


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {
        SEARCH: search_figure(found),
        MARGINS: margins_figure(found),
        REGIONS: regions_figure(found),
        COST: cost_figure(found),
    }


def labelled(kind: str) -> str:
    """Return how a device is called in a figure."""
    return kind if kind == LIR else f"DCFP, {kind}"


def search_figure(found: Found) -> Figure:
    """Return collapse over the sliders, the interface and the work, of all points tried."""
    figure = ps.new_figure(2.9)
    (panels,) = ps.grid_of(figure, 1, 3, share_y=True)
    rows = found["search"]
    plans = np.array([1e3 * row["plan"] for row in rows])
    texts = {
        "sliders": "sliders: 0 by load, 1 equal,\n2 least pressure",
        "kappa": "interface: 1 slip holds,\n2 slider at the point of tipping",
        "work": "work from rest to failure\nover weight [mm]",
    }
    for panel, (key, text) in zip(panels, texts.items(), strict=True):
        x = [1e3 * row["work"] if key == "work" else row[key] for row in rows]
        for stage, marker in (("first", "o"), ("second", "D")):
            own = [k for k, row in enumerate(rows) if row["stage"] == stage]
            shown = panel.scatter(
                [x[k] for k in own],
                [rows[k]["median"] for k in own],
                c=plans[own],
                marker=marker,
                s=22,
                vmin=plans.min(),
                vmax=plans.max(),
                cmap="viridis",
                edgecolors="black",
                linewidths=0.5,
            )
        ps.caption(panel, x=text)
    ps.caption(panels[0], y="collapse, median [m/s2]")
    bar = figure.colorbar(shown, ax=panels, fraction=0.04, pad=0.02)
    bar.set_label("plan [mm]", fontsize=ps.LABEL)
    bar.ax.tick_params(labelsize=ps.SMALL)
    return figure


def margins_figure(found: Found) -> Figure:
    """Return margins over the plan, and shares of collapse over the intensity."""
    figure = ps.new_figure(5.4)
    grid = ps.grid_of(figure, 2, 2)
    _margins(grid[0][0], found)
    for panel, plan in zip((grid[0][1], *grid[1]), shown_plans(found), strict=True):
        for k, kind in enumerate(KINDS):
            kept = plan["devices"][kind]
            collapse, failed = (100.0 * np.array(kept[key]) for key in ("collapse", "failed"))
            look = ps.line_of(k)
            panel.plot(STRIPES, collapse, marker=MARKERS[k], markersize=3.5, **look)
            frame = np.flatnonzero(collapse > failed + 1e-9)
            panel.plot(
                np.array(STRIPES)[frame],
                failed[frame],
                MARKERS[k],
                markersize=3.5,
                markerfacecolor="white",
                color=look["color"],
            )
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(-2.0, 103.0)
        ps.caption(
            panel,
            title=f"plan {1e3 * plan['plan']:.0f} mm",
            x="Sa(3 s) [m/s2]",
            y="share of collapse [%]",
        )
    handles = [
        Line2D([], [], label=labelled(kind), marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
        for k, kind in enumerate(KINDS)
    ]
    open_ = Line2D(
        [], [], linestyle="", marker="o", markerfacecolor="white", color=ps.GREY, markersize=3.5
    )
    open_.set_label("open: of these, failed bearings")
    ps.add_legend(figure, [*handles, open_], columns=3)
    return figure


def shown_plans(found: Found) -> list[Mapping[str, Any]]:
    """Return the plans of the panels: the two smallest, and the largest."""
    plans = found["plans"]
    return [*plans[:2], plans[-1]]


def _margins(panel: Axes, found: Found) -> None:
    for k, kind in enumerate(KINDS):
        at, rows = [], []
        for plan in found["plans"]:
            margin = plan["devices"][kind].get("margin")
            if margin is not None:
                at.append(1e3 * plan["plan"] + 3.0 * (k - 2))
                rows.append(margin)
        if not rows:
            continue
        value, low, high = np.array(rows).T
        panel.errorbar(
            at,
            value,
            yerr=[value - low, high - value],
            marker=MARKERS[k],
            markersize=3.5,
            elinewidth=0.6,
            **ps.line_of(k),
        )
    ps.caption(
        panel, title="collapse margin, intervals of 90 %", x="plan [mm]", y="collapse margin [-]"
    )


def winner(row: list[Any]) -> str:
    """Return who is ahead: "LIR", "DCFP", or "" where resamples do not agree."""
    own, other = row[2:]
    return "LIR" if own >= SURE else "DCFP" if other >= SURE else ""


def regions_figure(found: Found) -> Figure:
    """Return who is ahead of whom over intensity and plan."""
    figure = ps.new_figure(4.6)
    grid = ps.grid_of(figure, 2, len(OTHERS), share_x=True, share_y=True)
    plans = [f"{1e3 * plan['plan']:.0f}" for plan in found["plans"]]
    for row, (key, text) in zip(
        grid, (("collapse", "collapse, against"), ("floors", "acceleration, against")), strict=True
    ):
        for panel, other in zip(row, OTHERS, strict=True):
            panel.grid(visible=False)
            for y, plan in enumerate(found["plans"]):
                for x, cell in enumerate(plan["pairs"][other][key]):
                    _cell(panel, x, y, winner(cell))
            panel.set_xlim(-0.5, len(STRIPES) - 0.5)
            panel.set_ylim(-0.5, len(plans) - 0.5)
            panel.set_xticks(range(len(STRIPES)), [f"{at:g}" for at in STRIPES])
            panel.set_yticks(range(len(plans)), plans)
            ps.caption(panel, title=f"{text}\n{other}")
            panel.title.set_fontsize(ps.SMALL)
        ps.caption(row[0], y="plan [mm]")
    for panel in grid[1]:
        ps.caption(panel, x="Sa(3 s) [m/s2]")
    handles = [
        Patch(facecolor=COLOURS["LIR"], label="L: LIR-DCFP ahead"),
        Patch(facecolor=COLOURS["DCFP"], label="D: DCFP ahead"),
        Patch(facecolor=COLOURS[""], hatch="///", edgecolor=ps.GREY, label="equal or not decided"),
    ]
    ps.add_legend(figure, handles, columns=3)
    return figure


def _cell(panel: Axes, x: int, y: int, who: str) -> None:
    panel.add_patch(
        Rectangle(
            (x - 0.5, y - 0.5),
            1.0,
            1.0,
            facecolor=COLOURS[who],
            hatch="" if who else "///",
            edgecolor="white" if who else ps.GREY,
            linewidth=0.5,
        )
    )
    if who:
        panel.text(
            x, y, who[0], ha="center", va="center", fontsize=ps.SMALL, color="white", weight="bold"
        )


def cost_figure(found: Found) -> Figure:
    """Return margins over the cost, a line a device."""
    figure = ps.new_figure(3.4)
    (panels,) = ps.grid_of(figure, 1, 2, share_y=True)
    for panel, key in zip(panels, ("cost", "volume"), strict=True):
        for k, kind in enumerate(KINDS[:-1]):
            at, values, names = [], [], []
            for plan in found["plans"]:
                kept = plan["devices"][kind]
                if "margin" in kept:
                    at.append(1e-3 * sum(kept["cost"].values()) if key == "cost" else kept[key])
                    values.append(kept["margin"][0])
                    names.append(f"{1e3 * plan['plan']:.0f}")
            panel.plot(at, values, marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
            if kind in (LIR, OTHERS[2]):
                for x, y, name in zip(at, values, names, strict=True):
                    panel.annotate(
                        name, (x, y), (3, -8), textcoords="offset points", fontsize=ps.SMALL - 1
                    )
    panels[0].margins(y=0.12)
    ps.caption(panels[0], x="cost of nine bearings [t of steel]", y="collapse margin [-]")
    ps.caption(panels[1], x="volume, plates times height [m3]")
    handles = [
        Line2D([], [], label=labelled(kind), marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
        for k, kind in enumerate(KINDS[:-1])
    ]
    ps.add_legend(figure, handles, columns=2, title="At the points: plan [mm]")
    return figure
