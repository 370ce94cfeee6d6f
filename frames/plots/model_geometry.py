"""The lines of a frame in space, bent as its members bend, and marks of its parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D

from frames.library.building import ARM
from frames.model.axes import faces_of, to_local
from frames.model.components import hinged_ends
from frames.model.laws import Bilinear, BoucWen, Gap, HertzGap, Tie, ViscousDamper
from frames.plots import plot_style as ps

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from frames._types import FloatArray
    from frames.assembly.system import MemberTable, System
    from frames.model.components import Hinges, Link
    from frames.model.frame_data import FrameData
    from frames.model.laws import Law


STATIONS = 9
"""Points of a member's line."""


def member_lines(table: MemberTable, coordinates: FloatArray, u: FloatArray) -> FloatArray:
    """Return the lines of members under nodal displacements.

    Between its ends a member bends by the cubic of their displacements and rotations, which is
    exact for end forces without shear deformation.

    Shapes: coordinates (n_nodes, 3), u (n_nodes, 6), result (n_members, STATIONS, 3).
    """
    axes, length = table.arrays.axes, table.arrays.length[:, None]
    local = np.einsum("mab,mb->ma", table.follow, to_local(u.reshape(-1)[table.dofs], axes))
    t = np.linspace(0.0, 1.0, STATIONS)[None, :]
    one, two = 1.0 - 3.0 * t**2 + 2.0 * t**3, 3.0 * t**2 - 2.0 * t**3
    near, far = length * (t - 2.0 * t**2 + t**3), length * (t**3 - t**2)

    def bent(at: int, slope: int, sign: float) -> FloatArray:
        i, j = local[:, at, None], local[:, 6 + at, None]
        turn_i, turn_j = local[:, slope, None], local[:, 6 + slope, None]
        return np.asarray(one * i + two * j + sign * (near * turn_i + far * turn_j))

    moved = np.stack(
        [(1.0 - t) * local[:, 0, None] + t * local[:, 6, None], bent(1, 5, 1.0), bent(2, 4, -1.0)],
        axis=-1,
    )
    ends = coordinates[table.nodes] + table.offsets
    start, end = (ends[:, k, None] for k in range(2))
    straight = start + t[..., None] * (end - start)
    return np.asarray(straight + np.einsum("msl,mlg->msg", moved, axes))


def shell_corners(model: FrameData, names: Sequence[str]) -> list[list[int]]:
    """Return the places of the nodes around each shell element, of a list of nodes' names."""
    index = {name: k for k, name in enumerate(names)}
    found = []
    for part in model.superelements.values():
        faces = [each.nodes for each in part.elements.shells]
        faces += [face for other in part.elements.without for face in other.faces]
        found += [[index[name] for name in face] for face in faces]
    return found


def beam_ends(model: FrameData) -> list[tuple[str, str]]:
    """Return the nodes of each member but arms, and of each line element of superelements."""
    ends = [(m.i, m.j) for name, m in model.members.items() if not name.startswith(ARM)]
    return ends + [each for part in model.superelements.values() for each in part.elements.nodes]


def wall_faces(model: FrameData) -> list[list[str]]:
    """Return the corners of walls that are wide columns: the outer ends of their arms."""
    outer: dict[str, list[str]] = {}
    for name, member in model.members.items():
        if name.startswith(ARM):
            outer.setdefault(member.j, []).append(member.i)
    pairs = ((outer.get(m.i, ()), outer.get(m.j, ())) for m in model.members.values())
    return [[*low, *high[::-1]] for low, high in pairs if len(low) == len(high) == 2]


def diaphragm_faces(model: FrameData) -> list[list[str]]:
    """Return the fields that beams enclose within each diaphragm."""
    beams, found = beam_ends(model), []
    for diaphragm in model.diaphragms.values():
        around: dict[str, set[str]] = {node: set() for node in diaphragm.nodes}
        for one, other in beams:
            if one in around and other in around:
                around[one].add(other)
                around[other].add(one)
        points = {node: (model.nodes[node].x, model.nodes[node].y) for node in around}
        found += faces_of(points, around)
    return found


SHARE = 0.07
"""Distance of a hinge from the member's end as drawn, over its length [-]."""

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
    """A kind of link: its legend, laws, colour, line and mark."""

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
    """Return the names of plastic hinges, "member:i", and their drawn places, (n, 3)."""
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
