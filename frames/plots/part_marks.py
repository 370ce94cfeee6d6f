"""How links, walls and plastic hinges are marked in pictures of a model in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D

from frames.model.components import hinged_ends
from frames.model.laws import Bilinear, BoucWen, Gap, HertzGap, Tie, ViscousDamper
from frames.plots import plot_style as ps

if TYPE_CHECKING:
    from collections.abc import Iterator

    from frames._types import FloatArray
    from frames.assembly.system import System
    from frames.model.components import Hinges, Link
    from frames.model.frame_data import FrameData
    from frames.model.laws import Law

SHARE = 0.07
"""Of a member's length, from its end, at which a hinge is drawn."""

HINGES = {
    "linestyle": "",
    "marker": "o",
    "markersize": 3.6,
    "markerfacecolor": "#F0E442",
    "markeredgecolor": "black",
    "markeredgewidth": 0.6,
}
"""Style of plastic hinges."""

_TICK = 0.03  # of the extent: half a wall, half the tick along a link's direction


class Kind(NamedTuple):
    """A kind of link: what the legend calls it, its laws, colour, line and mark."""

    label: str
    laws: tuple[type[Law], ...]
    colour: str
    line: str
    mark: str


KINDS = (
    Kind("yielding links", (Bilinear, BoucWen), ps.PALETTE[4], "-", "D"),
    Kind("ties", (Tie,), ps.PALETTE[5], "--", "x"),
    Kind("dampers", (ViscousDamper,), ps.PALETTE[3], "-.", "s"),
    Kind("walls, stops", (Gap, HertzGap), "#333333", ":", ""),
)
"""Kinds of links, in the order of the legend."""


def kind_of(law: Law) -> Kind:
    """Return the kind of a law."""
    return next(kind for kind in KINDS if isinstance(law, kind.laws))


def draw_links(
    panel: Any, model: FrameData, system: System, place: FloatArray, enlarged: float
) -> list[Any]:
    """Draw the links of a model.

    Shapes: place (n_nodes, 3).
    """
    index = {name: k for k, name in enumerate(system.node_names)}
    extent = float(np.linalg.norm(np.ptp(system.coordinates, axis=0)))
    drawn: list[Any] = []
    for link in model.links.values():
        kind = kind_of(link.law)
        at_rest = system.coordinates[[index[link.i], index[link.j]]]
        ends = place[[index[link.i], index[link.j]]]
        for points, style in _strokes(link, at_rest, ends, enlarged, _TICK * extent):
            drawn += panel.plot(*points.T, color=kind.colour, **style)
    return drawn


def _strokes(
    link: Link, at_rest: FloatArray, ends: FloatArray, enlarged: float, tick: float
) -> Iterator[tuple[FloatArray, dict[str, Any]]]:
    # Points (n, 3) of the lines and marks of a link, and their styles.
    kind, direction = kind_of(link.law), np.array(link.direction)
    apart = at_rest[1] - at_rest[0]
    length = float(np.linalg.norm(apart))
    if length > 0.0:
        yield ends, {"linestyle": kind.line, "linewidth": 1.0}
    if isinstance(link.law, Gap | HertzGap):
        wall = ends[0] + (apart if length > 0.0 else 0.0) + enlarged * link.law.gap * direction
        across = np.cross(direction, (0.0, 0.0, 1.0))
        across = np.array([1.0, 0.0, 0.0]) if not across.any() else across
        across *= tick / np.linalg.norm(across)
        style = {"linewidth": 3.0, "linestyle": "-", "solid_capstyle": "butt"}
        yield np.array([wall - across, wall + across]), style
        return
    middle = ends.mean(axis=0)
    aside = length > 0.0 and abs(apart @ direction) < 0.99 * length
    if (aside or not length > 0.0) and not link.turns:
        reach = tick * direction
        yield np.array([middle - reach, middle + reach]), {"linewidth": 1.6, "linestyle": "-"}
    yield middle[None], {"linestyle": "", "marker": kind.mark, "markersize": 4.0}


def hinge_places(lines: FloatArray, system: System, hinges: Hinges) -> tuple[list[str], FloatArray]:
    """Return the names of plastic hinges, "member:i", and where they are drawn, (n, 3)."""
    place = {name: k for k, name in enumerate(system.members.names)}
    found, points = hinged_ends(hinges), []
    for _, member, end, _ in found:
        line = lines[place[member]]
        near, far = line[(0, -1)[end]], line[(-1, 0)[end]]
        points.append(near + SHARE * (far - near))
    return [hinge.name for hinge in found], np.array(points).reshape(-1, 3)


def part_handles(model: FrameData) -> list[Line2D]:
    """Return the entries of a legend for the links and plastic hinges that a model has."""
    laws = [link.law for link in model.links.values()]
    handles = []
    for kind in KINDS:
        if any(isinstance(law, kind.laws) for law in laws):
            style: dict[str, Any] = {"linestyle": kind.line, "marker": kind.mark, "markersize": 4.0}
            if not kind.mark:
                style = {"linestyle": "-", "linewidth": 3.0}
            handles.append(Line2D([], [], color=kind.colour, label=kind.label, **style))
    if model.hinges:
        handles.append(Line2D([], [], label="plastic hinges", **HINGES))  # type: ignore[arg-type]
    return handles
