"""The figures of the study of loss, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from lir_element.units import STANDARD_GRAVITY
from validation.study.consequences import COMPONENTS
from validation.study.loss_runs import FLOOR_PERIODS
from validation.study.pairs import NAMES, OURS, UNBREAKABLE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

LOSSES, SHAPE, FLOORS = "study_loss-loss.png", "study_loss-shape.png", "study_loss-floors.png"
MARKERS = "osv^d"
PERIOD_TICKS = (0.05, 0.2, 1.0, 4.0)
FLOOR_TICKS = (0.2, 0.5, 1.0, 2.0, 5.0)


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {LOSSES: _losses(found), SHAPE: _shape(found), FLOORS: _floors(found)}


def _losses(found: Found) -> Figure:
    figure = ps.new_figure(3.6)
    (panels,) = ps.grid_of(figure, 1, 3, share_x=True, share_y=True)
    im = np.array(found["loss"]["im"])
    for k, name in enumerate(NAMES):
        curve, look = found["loss"]["curves"][name], ps.line_of(k)
        parts = curve["parts"]
        low, high = (100.0 * np.array(curve[key]) for key in ("low", "high"))
        panels[0].fill_between(im, low, high, alpha=0.12, color=look["color"], linewidth=0.0)
        repair = np.sum([parts[each.name] for each in COMPONENTS], axis=0)
        shown = (curve["mean"], parts["collapse"], repair)
        for panel, values in zip(panels, shown, strict=True):
            panel.plot(
                im, 100.0 * np.array(values), label=name, marker=MARKERS[k], markersize=3.0, **look
            )
    titles = ("expected loss", "of it collapse (share of records)", "of it repair")
    for panel, title in zip(panels, titles, strict=True):
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(0.0, 102.0)
        ps.caption(panel, title=title, x="Sa(3 s) [m/s2]")
    ps.caption(panels[0], y="of a new building [%]")
    ps.add_legend(figure, panels[0].get_lines()[: len(NAMES)], columns=2)
    return figure


def _shape(found: Found) -> Figure:
    figure = ps.new_figure(3.6)
    (panels,) = ps.grid_of(figure, 1, 2, share_x=True, share_y=True)
    shape = found["shape"]
    ratio = np.array([*shape["ratio"].values()])
    for panel, name in zip(panels, (OURS, UNBREAKABLE), strict=True):
        line = shape["lines"][name]
        for x, (low, high) in zip(ratio, line["bounds"], strict=True):
            if high is None:
                panel.plot([x], [low], "^", color="black", markersize=4.0)
            else:
                panel.plot([x, x], [max(low, 0.5), high], "-", color="black", linewidth=1.5)
        at = np.geomspace(ratio.min(), ratio.max(), 40)
        mean = float(np.log(ratio).mean())
        middle = found["considered"] * line["margin"][0]
        panel.plot(at, middle * np.exp(line["slope"][0] * (np.log(at) - mean)), **ps.line_of(0))
        panel.axvline(shape["target"], color=ps.GREY, linewidth=0.8, linestyle=":")
        panel.set_yscale("log")
        ps.caption(panel, title=name, x="SaRatio [-]")
        panel.set_yticks([1.0, 2.0, 3.0, 4.0], ["1", "2", "3", "4"])
        panel.minorticks_off()
    ps.caption(panels[0], y="collapse, Sa(3 s) [m/s2]")
    return figure


def _floors(found: Found) -> Figure:
    figure = ps.new_figure(5.0)
    grid = ps.grid_of(figure, 2, 2, share_x=True, share_y=True)
    for row, (level, each) in zip(grid, found["floors"].items(), strict=True):
        for place, panel in enumerate(row):
            for k, (name, own) in enumerate(each.items()):
                values = [np.nan if v is None else v for v in own["median"][place]]
                label = f"{name} ({_failed(found, name)})"
                panel.plot(
                    FLOOR_PERIODS, np.array(values) / STANDARD_GRAVITY, label=label, **ps.line_of(k)
                )
            panel.set_xscale("log")
            panel.set_yscale("log")
            for axis, ticks in ((panel.xaxis, PERIOD_TICKS), (panel.yaxis, FLOOR_TICKS)):
                axis.set_ticks(list(ticks), [f"{value:g}" for value in ticks])
            panel.minorticks_off()
            ps.caption(panel, title=f"{('base', 'roof')[place]}, {level}")
        ps.caption(row[0], y="Sa of the floor [g]")
    for panel in grid[1]:
        ps.caption(panel, x="period [s]")
    title = "Records that fail at the design and the maximum considered earthquake in brackets"
    ps.add_legend(figure, grid[0][0].get_lines(), columns=1, title=title)
    return figure


def _failed(found: Found, name: str) -> str:
    return ", ".join(str(each[name]["failed"]) for each in found["floors"].values())
