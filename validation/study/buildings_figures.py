"""The figures of the study of buildings, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from scipy.stats import norm

from frames.plots import plot_style as ps
from validation.study.buildings_numbers import LIR
from validation.study.buildings_runs import SCALES
from validation.study.paired import DEVICES, LIMITS, OTHERS
from validation.study.records_runs import COLLAPSE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

CURVES_FIGURE, RATIOS_FIGURE = "study_buildings-collapse.png", "study_buildings-ratios.png"
MARKERS = "osd"
DODGE = 0.14
COLUMNS = 3


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {CURVES_FIGURE: _curves(found), RATIOS_FIGURE: _ratios(found)}


def _curves(found: Found) -> Figure:
    figure, panels = ps.panels_of(len(found["buildings"]), COLUMNS, 2.2)
    at = np.linspace(0.05, 1.1 * SCALES[-1], 80)
    for panel, (name, own) in zip(panels, found["buildings"].items(), strict=True):
        collapse = own["limits"][COLLAPSE.name]
        for k, device in enumerate(DEVICES):
            look, drawn = ps.line_of(k), collapse["drawn"][device]
            if drawn is not None:
                panel.plot(at, norm.cdf(np.log(at / drawn[0]) / drawn[1]), **look)
            im, over, _, known, _ = np.array(collapse["shares"][device]).T
            panel.plot(
                im, over / np.maximum(known, 1.0), MARKERS[k], markersize=3.5, color=look["color"]
            )
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(-0.02, 1.03)
        ps.caption(panel, title=name)
    for panel in panels[::COLUMNS]:
        ps.caption(panel, y="probability of collapse [-]")
    for panel in panels[-COLUMNS:]:
        ps.close_column(panel, "Sa(3 s) [m/s2]", is_last=True)
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
        for k, name in enumerate(DEVICES)
    ]
    ps.add_legend(figure, handles, columns=3, title="Dotted: maximum considered earthquake")
    return figure


def _ratios(found: Found) -> Figure:
    figure = ps.new_figure(4.6)
    grid = ps.grid_of(figure, 2, 2, share_x=True, share_y=True)
    panels = [panel for row in grid for panel in row]
    names = list(found["buildings"])
    for panel, limit in zip(panels, LIMITS, strict=True):
        for k, other in enumerate(OTHERS):
            color = ps.PALETTE[k]
            for place, name in enumerate(names):
                ratio = found["buildings"][name]["limits"][limit.name]["ratios"][other]
                if ratio is None:
                    continue
                x = place + DODGE * (2 * k - 1)
                panel.plot([x, x], ratio[1:], color=color, linewidth=1.0)
                panel.plot(
                    [x],
                    [ratio[0]],
                    MARKERS[k],
                    markersize=4.5,
                    color=color,
                    markerfacecolor="white" if k else color,
                )
        panel.axhline(1.0, color=ps.GREY, linewidth=0.8)
        panel.set_xticks(range(len(names)), [name.replace(" storeys, ", "\n") for name in names])
        panel.set_xlim(-0.5, len(names) - 0.5)
        ps.caption(panel, title=limit.name)
    for row in grid:
        ps.caption(row[0], y="ratio of medians [-]")
    handles = [
        Line2D(
            [],
            [],
            label=f"over {other}",
            marker=MARKERS[k],
            markersize=4.5,
            color=ps.PALETTE[k],
            markerfacecolor="white" if k else ps.PALETTE[k],
        )
        for k, other in enumerate(OTHERS)
    ]
    ps.add_legend(figure, handles, columns=2, title=f"{LIR} over DCFP by storeys and system")
    return figure
