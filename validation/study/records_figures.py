"""The figures of the study of FEMA P695's records, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from lir_element.units import STANDARD_GRAVITY
from validation.study.records_runs import ALL, DEVICES, LIMITS, SLIP

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

CURVES, MEDIANS = "study-curves.png", "study-medians.png"
MARKERS = "os^d"  # of the devices
DEMAND, FLOOR = "ductility", "floor acceleration in plan, mean"
SHOWN = {
    "ductility": ("ductility [-]", 1.0, ".2f"),
    "storey drift, mean": ("storey drift [%]", 1e2, ".2f"),
    FLOOR: ("floor acceleration [g]", 1.0 / STANDARD_GRAVITY, ".2f"),
    "bearing displacement": ("bearing displacement [mm]", 1e3, ".0f"),
    "residual bearing displacement": ("residual displacement [mm]", 1e3, ".1f"),
    "interface slip": ("interface slip [mm]", 1e3, ".1f"),
    "residual interface slip": ("residual slip [mm]", 1e3, ".1f"),
    "rim force": ("rim force [kN]", 1e-3, ".0f"),
    "base shear over weight": ("base shear / W", 1.0, ".2f"),
}
"""Demands: their text, a factor from SI, a format."""


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {CURVES: _curves(found), MEDIANS: _medians(found)}


def _curves(found: Found) -> Figure:
    limits = [limit for limit in LIMITS if limit is not SLIP]
    figure = ps.new_figure(5.0)
    panels = [
        panel for row in ps.grid_of(figure, 2, 3, share_x=True, share_y=True) for panel in row
    ]
    for panel, limit in zip(panels, limits, strict=True):
        own = found["parts"][ALL]["limits"][limit.name]
        for k, name in enumerate(DEVICES):
            look, curve = ps.line_of(k), own["curves"][name]
            if "why" not in curve:
                panel.fill_between(
                    curve["at"],
                    curve["low"],
                    curve["high"],
                    alpha=0.15,
                    color=look["color"],
                    linewidth=0.0,
                )
                panel.plot(curve["at"], curve["probability"], **look)
            im, exceeded, total = np.array(own["stripes"][name]).T
            panel.plot(
                im,
                exceeded / np.maximum(total, 1.0),
                MARKERS[k],
                markersize=3.0,
                color=look["color"],
            )
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        ps.caption(panel, title=limit.name)
        panel.set_ylim(0.0, 1.02)
    for panel in panels[::3]:
        ps.caption(panel, y="probability [-]")
    for panel in panels[3:]:
        ps.caption(panel, x="Sa(3 s) [m/s2]")
    _legend(figure, "Fragility; dotted: maximum considered earthquake")
    return figure


def _medians(found: Found) -> Figure:
    figure = ps.new_figure(5.0)
    shown = (DEMAND, FLOOR, "residual bearing displacement")
    grid = ps.grid_of(figure, 2, 2)
    panels = (*grid[0], grid[1][0])
    _collapsed(grid[1][1], found)
    for panel, quantity in zip(panels, shown, strict=True):
        text, factor, _ = SHOWN[quantity]
        for k, name in enumerate(DEVICES):
            rows = found["parts"][ALL]["demands"][quantity][name]
            low, middle, high = (
                factor * np.array([np.nan if v is None else v for v in column])
                for column in zip(*rows, strict=True)
            )
            look = ps.line_of(k)
            panel.fill_between(
                found["scales"], low, high, alpha=0.12, color=look["color"], linewidth=0.0
            )
            panel.plot(found["scales"], middle, marker=MARKERS[k], markersize=3.0, **look)
        if quantity == FLOOR:
            panel.set_yscale("log")
        ps.caption(panel, x="Sa(3 s) [m/s2]", y=text)
    _legend(figure, "Medians and the middle 68 % of all records")
    return figure


def _collapsed(panel: Axes, found: Found) -> None:
    # The share that the medians leave out: without it a device that fails looks ideal.
    stripes = found["parts"][ALL]["limits"]["collapse"]["stripes"]
    for k, name in enumerate(DEVICES):
        at, exceeded, total = np.array(stripes[name]).T
        share = 100.0 * exceeded / np.maximum(total, 1.0)
        panel.plot(at, share, marker=MARKERS[k], markersize=3.0, **ps.line_of(k))
    panel.set_ylim(0.0, 102.0)
    ps.caption(panel, x="Sa(3 s) [m/s2]", y="share of collapse [%]")


def _legend(figure: Figure, title: str) -> None:
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.0, **ps.line_of(k))
        for k, name in enumerate(DEVICES)
    ]
    ps.add_legend(figure, handles, columns=2, title=title)
