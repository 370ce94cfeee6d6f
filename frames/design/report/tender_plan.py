"""The bearings in plan as a supplier gets them: axes with distances, types, numbers, walls."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.design.report.tender import grid_of, types_of
from frames.library.building import ARM
from frames.plots import plot_style as ps
from frames.plots.model_geometry import shell_corners
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.design.project.design_run import ProjectRun
    from frames.design.report.tender import Axis
    from frames.frame import Frame

_MARKS = "osD^vPX*"
_BUBBLE = 0.11  # inch: radius of an axis's circle
_TALLEST = 8.0  # inch


def tender_plan(run: ProjectRun) -> Figure:
    """Draw axes with their names and distances, and each bearing by type with its number."""
    across_x, across_y, _ = grid_of(run)
    nodes = [run.frame.nodes[link.j] for link in run.frame.bearings.values()]
    spots = np.array([(node.x, node.y) for node in nodes])
    extent = np.ptp(spots, axis=0)
    # metres an inch; margins hold the axes' circles and distances
    room = ps.PAGE_WIDTH - 1.4
    scale = max(extent[0] / room, extent[1] / (_TALLEST - 2.0), 0.5)
    tall = max(extent[1] / scale + 2.0, 2.8)
    figure = ps.new_figure(tall)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    low, high = spots.min(axis=0) - 0.35 * scale, spots.max(axis=0) + 0.35 * scale
    _walls(panel, run.frame)
    _axes(panel, across_x, (low[1], high[1]), scale, upright=True)
    _axes(panel, across_y, (low[0], high[0]), scale, upright=False)
    handles = []
    for k, one in enumerate(types_of(run)):
        look: dict[str, Any] = {
            "marker": _MARKS[k % len(_MARKS)],
            "color": ps.PALETTE[k % len(ps.PALETTE)],
        }
        panel.plot(*spots[one.places].T, linestyle="", markersize=7.0, zorder=3, **look)
        label = worded("{name}: {count}", name=one.name, count=len(one.places))
        handles.append(Line2D([], [], linestyle="", markersize=7.0, label=label, **look))
    for n, spot in enumerate(spots, start=1):
        panel.annotate(
            str(n), spot, (5, 5), textcoords="offset points", fontsize=ps.SMALL, zorder=4
        )
    panel.set_aspect("equal")
    panel.set_xlim(low[0] - 0.75 * scale, high[0] + 0.15 * scale)
    panel.set_ylim(low[1] - 0.15 * scale, high[1] + 0.75 * scale)
    panel.set_axis_off()
    ps.add_legend(figure, handles, title="Types and numbers of bearings; distances of axes in m")
    return figure


def _axes(
    panel: Axes, axes: Sequence[Axis], reach: tuple[float, float], scale: float, *, upright: bool
) -> None:
    # Lines with circles at the upper or the left end; a circle that has no room stands farther out.
    style: dict[str, Any] = {
        "color": ps.GREY,
        "linewidth": 0.6,
        "linestyle": (0, (8, 2, 1, 2)),
        "zorder": 1,
    }
    before, out = -np.inf, False
    sign, start, end = (1.0, *reach) if upright else (-1.0, *reach[::-1])
    for axis in axes:
        out = axis.at - before < 2.2 * _BUBBLE * scale and not out
        before = axis.at
        at = end + sign * ((0.55 if out else 0.25) * scale)
        line = np.array([[axis.at, start], [axis.at, at - sign * _BUBBLE * scale]])
        panel.plot(*(line.T if upright else line.T[::-1]), **style)
        place = (axis.at, at) if upright else (at, axis.at)
        circle: dict[str, Any] = {
            "boxstyle": "circle,pad=0.25",
            "facecolor": "white",
            "linewidth": 0.7,
        }
        panel.text(
            *place, axis.name, ha="center", va="center", fontsize=ps.SMALL, bbox=circle, zorder=4
        )
    for one, other in pairwise(axes):
        middle, apart = 0.5 * (one.at + other.at), other.at - one.at
        if apart > 0.35 * scale:
            place = (middle, end) if upright else (end, middle)
            text = f"{apart:.2f}"
            turned = 0 if upright else 90
            panel.text(
                *place,
                text,
                ha="center",
                va="center",
                fontsize=ps.SMALL,
                rotation=turned,
                color=ps.GREY,
            )


def _walls(panel: Axes, frame: Frame) -> None:
    # Beams of the level above the bearings as thin lines, walls on it as thick ones.
    nodes, above = frame.nodes, {link.j for link in frame.bearings.values()}
    level = {name for one in frame.levels if above & {*one.nodes} for name in one.nodes} | above
    ends = [((m.i, m.j), name) for name, m in frame.members.items()]
    for part in frame.superelements.values():
        ends += [(own, "") for own in part.elements.nodes]
    for (i, j), name in ends:
        wall = name.startswith(ARM)
        if (wall and {i, j} & level) or {i, j} <= level:
            x, y = ([getattr(nodes[end], axis) for end in (i, j)] for axis in "xy")
            panel.plot(
                x, y, color="#BBBBBB", linewidth=4.0 if wall else 0.8, zorder=2 if wall else 0
            )
    names = tuple(nodes)
    for corners in shell_corners(frame, names):
        foot = [nodes[names[k]] for k in corners if names[k] in level]
        if len(foot) == 2 and foot[0].z == foot[1].z:
            x, y = [node.x for node in foot], [node.y for node in foot]
            panel.plot(x, y, color="#BBBBBB", linewidth=4.0, zorder=2)
