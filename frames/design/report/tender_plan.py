"""The bearings in plan as a supplier gets them: axes with distances, types, numbers, walls."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.design.report.tender import grid_of, types_of
from frames.plots import plot_style as ps
from frames.plots.model_geometry import beam_ends, shell_corners, wall_faces
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
_LINE: dict[str, Any] = {
    "color": ps.GREY,
    "linewidth": 0.6,
    "linestyle": (0, (8, 2, 1, 2)),
    "zorder": 1,
}
_CIRCLE = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "linewidth": 0.7}


def tender_plan(run: ProjectRun) -> Figure:
    """Draw axes with their names and distances, and each bearing by type with its number."""
    across_x, across_y, _ = grid_of(run)
    nodes = [run.frame.nodes[link.j] for link in run.frame.bearings.values()]
    spots = np.array([(node.x, node.y) for node in nodes])
    extent = np.ptp(spots, axis=0)
    # metres an inch; margins hold the axes' circles and distances
    scale = max(extent[0] / (ps.PAGE_WIDTH - 1.4), extent[1] / (_TALLEST - 2.0), 0.5)
    figure = ps.new_figure(max(extent[1] / scale + 2.0, 2.8))
    panel = ps.grid_of(figure, 1, 1)[0][0]
    low, high = spots.min(axis=0) - 0.35 * scale, spots.max(axis=0) + 0.35 * scale
    _walls(panel, run.frame)
    top = _axes(panel, across_x, (low[1], high[1]), scale, upright=True)
    left = _axes(panel, across_y, (high[0], low[0]), scale, upright=False)
    handles = []
    for k, one in enumerate(types_of(run)):
        look: dict[str, Any] = {
            "marker": _MARKS[k % len(_MARKS)],
            "color": ps.PALETTE[k % len(ps.PALETTE)],
            "linestyle": "",
            "markersize": 7.0,
        }
        panel.plot(*spots[one.places].T, zorder=3, **look)
        label = worded("{name}: {count}", name=one.name, count=len(one.places))
        handles.append(Line2D([], [], label=label, **look))
    small: dict[str, Any] = {"textcoords": "offset points", "fontsize": ps.SMALL, "zorder": 4}
    for n, spot in enumerate(spots, start=1):
        panel.annotate(str(n), spot, (5, 5), **small)
    panel.set_aspect("equal")
    panel.set_xlim(left, high[0] + 0.15 * scale)
    panel.set_ylim(low[1] - 0.15 * scale, top)
    panel.set_axis_off()
    ps.add_legend(figure, handles, title="Types and numbers of bearings; distances of axes in m")
    return figure


def _axes(
    panel: Axes, axes: Sequence[Axis], reach: tuple[float, float], scale: float, *, upright: bool
) -> float:
    # Lines with circles at the upper or the left end, in as many rows as keep circles apart.
    # Returns how far these go.
    turn = slice(None, None, 1 if upright else -1)
    (start, end), out = reach, scale if upright else -scale
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": ps.SMALL}
    rows: list[float] = []  # place of the last circle of each
    for axis in axes:
        near = axis.at - 2.2 * _BUBBLE * scale
        row = next((k for k, last in enumerate(rows) if last < near), len(rows))
        rows[row : row + 1] = [axis.at]
        at = end + (0.25 + 0.3 * row) * out
        panel.plot(*((axis.at, axis.at), (start, at - _BUBBLE * out))[turn], **_LINE)
        x, y = (axis.at, at) if upright else (at, axis.at)
        panel.text(x, y, axis.name, bbox=_CIRCLE, zorder=4, **look)
    for one, other in pairwise(axes):
        if other.at - one.at > 0.35 * scale:
            middle = 0.5 * (one.at + other.at)
            x, y = (middle, end) if upright else (end, middle)
            text = f"{other.at - one.at:.2f}"
            panel.text(x, y, text, rotation=0 if upright else 90, color=ps.GREY, **look)
    return end + (0.15 + 0.3 * len(rows)) * out


def _walls(panel: Axes, frame: Frame) -> None:
    # Beams of the level above the bearings as thin lines, walls on it as thick ones.
    nodes, names = frame.nodes, tuple(frame.nodes)
    above = {link.j for link in frame.bearings.values()}
    level = above.union(*(one.nodes for one in frame.levels if above & {*one.nodes}))
    shells = [[names[k] for k in corners] for corners in shell_corners(frame, names)]
    feet = ([one for one in face if one in level] for face in (*wall_faces(frame), *shells))
    lines: list[tuple[Sequence[str], float]] = [
        *((ends, 0.8) for ends in beam_ends(frame) if {*ends} <= level),
        *((foot, 4.0) for foot in feet if len(foot) == 2),
    ]
    for ends, width in lines:
        x, y = ([getattr(nodes[end], axis) for end in ends] for axis in "xy")
        panel.plot(x, y, color="#BBBBBB", linewidth=width, zorder=0.5 * width)
