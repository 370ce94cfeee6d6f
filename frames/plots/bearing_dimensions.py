"""A bearing at rest, to scale, with the dimensions that it is made by."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames.plots import plot_style as ps
from frames.plots.bearing_drawing import draw_section
from frames.results.bearing_geometry import AT_REST, Plates, outlines, rim_face
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from lir_element import LIRBearing

_MARGIN = 0.12  # of the width, for the dimensions on each side


def bearing_dimensions(
    bearing: LIRBearing, plates: Plates | None = None, *, reach: float | None = None
) -> Figure:
    """Draw a bearing's vertical section at rest with its dimensions.

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    plates : frames.results.bearing_geometry.Plates, optional
        Thicknesses and rims, whose dimensions are then drawn as well.
    reach : float, optional
        Half the width of surfaces without rims [m].

    Returns
    -------
    Figure
        Slider, rims and heights in mm, radii and capacity below; without `plates` these are drawn
        as thick as the rims need, for their thickness is no input.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> figure = bearing_dimensions(bearing)
    """
    bodies = outlines(bearing, AT_REST, reach, plates)
    corners = np.vstack(list(bodies.values()))
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    width = right - left
    aside = _MARGIN * width
    left_of, more = (1.6 * aside, 0.8 * aside) if plates else (0.5 * aside, 0.0)
    share = (high - low + 2.4 * aside + 2.0 * more) / (width + 1.1 * aside + left_of)
    figure = ps.new_figure(min(0.7 + share * ps.PAGE_WIDTH, 7.0))
    ax = figure.subplots()
    draw_section(ax, bearing, AT_REST, reach=reach, plates=plates)
    a, height = bearing.slider_radius, bearing.slider_height
    _across(ax, a, height, high + 0.4 * aside, worded("slider ø {size:.0f}", size=2e3 * a))
    faces = [rim_face(bearing, k) for k in (0, 1)]
    if all(map(math.isfinite, faces)):
        top = worded("top rim, inside ø {size:.0f}", size=2e3 * faces[1])
        bottom = worded("bottom rim, inside ø {size:.0f}", size=2e3 * faces[0])
        _across(ax, faces[1], height, high + 1.2 * aside, top)
        _across(ax, faces[0], 0.0, low - 0.6 * aside, bottom)
    for radius, at in zip(bearing.radii, (0.5 * low, 0.5 * (high + height)), strict=True):
        ax.text(0.0, at, f"R = {1e3 * radius:.0f}", ha="center", va="center", fontsize=ps.SMALL)
    _upright(ax, right + 0.35 * aside, 0.0, height, f"h = {1e3 * height:.0f}")
    if plates is not None:
        _plates(ax, bearing, plates, (left, right, low, high), aside)
    ax.set_xlim(left - left_of, right + 1.1 * aside)
    ax.set_ylim(low - 0.8 * aside - more, high + 1.6 * aside + more)
    ps.caption(ax, title="Dimensions in mm")
    figure.supxlabel(_words(bearing, plates), fontsize=ps.LABEL)
    return figure


def _plates(
    ax: Axes,
    bearing: LIRBearing,
    plates: Plates,
    box: tuple[float, float, float, float],
    aside: float,
) -> None:
    # Diameters, the whole height, thicknesses at the vertices, and the bottom rim.
    left, right, low, high = box
    faces = [rim_face(bearing, k) for k in (0, 1)]
    outer = [face + plates.wall if math.isfinite(face) else right for face in faces]
    above = worded("top plate, outside ø {size:.0f}", size=2e3 * outer[1])
    below = worded("bottom plate, outside ø {size:.0f}", size=2e3 * outer[0])
    _across(ax, outer[1], high, high + 2.0 * aside, above)
    _across(ax, outer[0], low, low - 1.4 * aside, below)
    _upright(ax, left - 0.9 * aside, low, high, f"H = {1e3 * (high - low):.0f}", edge=left)
    height, (bottom, top) = bearing.slider_height, plates.thickness
    for start, end, size in ((low, 0.0, bottom), (height, high, top)):
        _upright(ax, right + 0.35 * aside, start, end, f"{1e3 * size:.0f}")


def _words(bearing: LIRBearing, plates: Plates | None) -> str:
    parts = [worded("effective radius {radius:.0f}", radius=1e3 * bearing.effective_radius)]
    if math.isfinite(bearing.lateral_capacity):
        bottom, top = (f"{1e3 * reach:.0f}" for reach in bearing.rim_displacement)
        both = bottom
        if bottom != top:
            both = worded("{bottom} (bottom) and {top} (top)", bottom=bottom, top=top)
        parts.append(worded("rims met after {sliding} of sliding", sliding=both))
        reach = 1e3 * bearing.lateral_capacity
        parts.append(worded("displacement at the rims {u:.0f}", u=reach))
        if plates is not None:
            rims = 1e3 * plates.wall, 1e3 * plates.rim
            parts.append(worded("rims {b:.0f} wide, {h:.0f} high", b=rims[0], h=rims[1]))
    return joined(*parts)


def _across(ax: Axes, half: float, begin: float, at: float, text: str) -> None:
    # From -half to half at a height, with lines from the measured points.
    for side in (-half, half):
        ax.plot([side, side], [begin, at], color=ps.GREY, linewidth=0.4)
    _arrow(ax, np.array([-half, at]), np.array([half, at]))
    ax.text(0.0, at, text, ha="center", va="bottom", fontsize=ps.SMALL)


def _upright(
    ax: Axes, at: float, start: float, end: float, text: str, *, edge: float = 0.0
) -> None:
    # At a place to the right or to the left, with lines from an edge; the text on the outer side.
    for height in (start, end):
        ax.plot([edge, at], [height, height], color=ps.GREY, linewidth=0.4)
    _arrow(ax, np.array([at, start]), np.array([at, end]))
    side, away = ("left", 4) if at > edge else ("right", -4)  # pt
    middle = (at, 0.5 * (start + end))
    ax.annotate(
        text, middle, (away, 0), textcoords="offset points", ha=side, va="center", fontsize=ps.SMALL
    )


def _arrow(ax: Axes, start: FloatArray, end: FloatArray) -> None:
    line = {
        "arrowstyle": "<|-|>",
        "linewidth": 0.6,
        "color": "black",
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": 7,
    }
    ax.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=line)
