"""From a load on a floor panel to the members along its edges."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from frames._errors import ModelError
from frames.model.components import FloorLoad, Member, Node, TaperedLoad
from frames.model.geometry_checks import member_ends, node_list, one_elevation
from lir_element.argument_checks import require_vector
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from frames._types import FloatArray

Around: TypeAlias = Mapping[str, Sequence[Member]]
"""Members at each node."""

_AXES = {"x": (1.0, 0.0), "y": (0.0, 1.0)}


class PanelLoads(NamedTuple):
    """Loads of a panel on members and nodes."""

    members: list[tuple[str, TaperedLoad]]  # loads along members
    # (6,) on their rigid end zones, as forces and moments on the nodes [N, N m]
    nodes: list[tuple[str, FloatArray]]


class _Bay(NamedTuple):
    # A member along an edge, between two places of its nodes on the edge [m], i first.
    member: Member
    i: float
    j: float


def floor_panel(
    nodes: Mapping[str, Node], name: str, given: Sequence[str], span: Span | None
) -> tuple[tuple[str, ...], tuple[float, float] | None]:
    """Return the corners of a panel, anticlockwise, and the direction in which it carries."""
    owner = f'floor load "{name}"'
    chosen = node_list(nodes, given, owner, least=3)
    one_elevation(nodes, chosen, owner)
    if turning(_plan(nodes, chosen), owner) < 0.0:
        chosen = chosen[::-1]
    if span is None:
        return chosen, None
    if isinstance(span, str) and span not in _AXES:
        message = f'span = "{span}" of {owner}: give "x", "y", or a vector (x, y) in plan'
        raise ModelError(message)
    vector = _AXES[span] if isinstance(span, str) else span
    x, y = require_vector(f"span of {owner}", vector, 2, error=ModelError)
    size = float(np.hypot(x, y))
    if size <= 0.0:
        message = f'span of {owner} has no direction: give "x", "y", or a vector (x, y) in plan'
        raise ModelError(message)
    return chosen, (float(x) / size, float(y) / size)


def members_at(members: Mapping[str, Member]) -> Around:
    """Return the members that begin or end at each node, by its name."""
    found: dict[str, list[Member]] = {}
    for member in members.values():
        for node in (member.i, member.j):
            found.setdefault(node, []).append(member)
    return found


def panel_loads(nodes: Mapping[str, Node], around: Around, load: FloorLoad) -> PanelLoads:
    """Distribute a panel's load to the members along its edges."""
    corners = _plan(nodes, load.nodes)
    edges = nearest_edges(corners) if load.span is None else one_way(corners, np.array(load.span))
    found = PanelLoads([], [])
    for k, pieces in enumerate(edges):
        if pieces:
            first, last = load.nodes[k], load.nodes[(k + 1) % len(corners)]
            for bay in _chain(nodes, around, (first, last), load.name):
                _put(nodes, bay, pieces, load, found)
    return found


def _plan(nodes: Mapping[str, Node], chosen: Sequence[str]) -> FloatArray:
    return np.array([(nodes[node].x, nodes[node].y) for node in chosen])


def _chain(
    nodes: Mapping[str, Node], around: Around, edge: tuple[str, str], name: str
) -> list[_Bay]:
    # The members from corner to corner, each continuing the one before.
    origin = np.array(nodes[edge[0]].position)
    way = np.array(nodes[edge[1]].position) - origin
    length = float(np.linalg.norm(way))
    way /= length

    def place(node: str) -> tuple[float, float]:
        # Along the edge, and beside it.
        apart = np.array(nodes[node].position) - origin
        along = float(apart @ way)
        return along, float(np.linalg.norm(apart - along * way))

    found: list[_Bay] = []
    here, at = edge[0], 0.0
    while here != edge[1]:
        onward = []
        for member in around.get(here, ()):
            other = member.j if member.i == here else member.i
            along, beside = place(other)
            if beside <= SAME_PLACE and at < along <= length + SAME_PLACE:
                onward.append((member, other, along))
        if len(onward) != 1:
            what = (
                "no member goes on"
                if not onward
                else "several members go on ("
                + ", ".join(f'"{m.name}"' for m, _, _ in onward)
                + ")"
            )
            message = (
                f'floor load "{name}": along its edge from "{edge[0]}" to "{edge[1]}" {what} '
                f'from node "{here}": add one chain of members from corner to corner, or set the '
                'direction of a one-way panel, span="x"'
            )
            raise ModelError(message)
        ((member, here, along),) = onward
        found.append(_Bay(member, *((at, along) if member.j == here else (along, at))))
        at = along
    return found


def _put(
    nodes: Mapping[str, Node], bay: _Bay, pieces: Sequence[Piece], load: FloorLoad, to: PanelLoads
) -> None:
    # Load of an edge on one member: on the length between its ends, and beyond.
    member, sign = bay.member, 1.0 if bay.j > bay.i else -1.0
    first, second = (np.array(nodes[node].position) for node in (member.i, member.j))
    way = (second - first) / np.linalg.norm(second - first)
    start, end = member_ends(nodes, member)
    x_i, x_j = float((start - first) @ way), float((end - first) @ way)
    ratio = float(np.linalg.norm(end - start)) / (x_j - x_i)
    for s0, h0, s1, h1 in pieces:
        (x0, p0), (x1, p1) = sorted(((s - bay.i) * sign, h) for s, h in ((s0, h0), (s1, h1)))
        size = abs(bay.j - bay.i)
        for low, high, node in ((0.0, x_i, member.i), (x_i, x_j, ""), (x_j, size, member.j)):
            a, b = max(x0, low), min(x1, high)
            if b - a <= 1e-9 * size:
                continue
            near, far = (load.q * (p0 + (p1 - p0) * (x - x0) / (x1 - x0)) for x in (a, b))
            if node:
                force, middle = _resultant(a, near, b, far)
                arm = middle * way - (0.0 if node == member.i else size) * way
                down = np.array([0.0, 0.0, -force])
                to.nodes.append((node, np.concatenate([down, np.cross(arm, down)])))
                continue
            part = TaperedLoad(
                (a - x_i) * ratio,
                (b - x_i) * ratio,
                (0.0, 0.0, -near / ratio),
                (0.0, 0.0, -far / ratio),
                load.case,
            )
            to.members.append((member.name, part))


def _resultant(a: float, near: float, b: float, far: float) -> tuple[float, float]:
    # Sum of a linear load from a to b, and its place.
    force = 0.5 * (near + far) * (b - a)
    return force, a + (b - a) * (near + 2.0 * far) / (3.0 * (near + far)) if force else a


Span: TypeAlias = str | Sequence[float]
"""Direction of a one-way panel in plan: "x", "y" or a vector."""

Piece: TypeAlias = tuple[float, float, float, float]
"""From s0 with h0 to s1 with h1 [m]."""

_FLAT = 1e-9  # of a sine or of a length: below, it is nothing


def turning(corners: FloatArray, owner: str) -> float:
    """Return +1 for a convex outline that runs anticlockwise and -1 for a clockwise one.

    Shapes: corners (n, 2).
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=1)
    if (length < SAME_PLACE).any():
        place = int(np.argmin(length)) + 1
        message = f"{owner}: its corners {place} and {place % len(corners) + 1} coincide in plan"
        raise ModelError(message)
    unit = edges / length[:, None]
    after = np.roll(unit, -1, axis=0)
    sines = unit[:, 0] * after[:, 1] - unit[:, 1] * after[:, 0]
    angles = np.arctan2(sines, (unit * after).sum(axis=1))
    side = 1.0 if angles.sum() > 0.0 else -1.0
    turns_back = np.abs(angles) > math.pi - 1e-6
    if (side * sines < -1e-6).any() or turns_back.any() or abs(angles.sum()) > 2.0 * math.pi + 1e-3:
        message = (
            f"{owner}: the corners must form a convex outline: list them in order around the "
            "panel, and split a panel with a reentrant corner"
        )
        raise ModelError(message)
    return side


def nearest_edges(corners: FloatArray) -> list[list[Piece]]:
    r"""Return the load of each edge if every point of a panel goes to the nearest edge.

    Over the point s of an edge with the inward normal n reaches the depth

    .. math:: h(s) = \min_k \, (c_k + m_k s) / (1 - n_k \cdot n)

    up to the bisector with another edge k, from which the point is :math:`c_k + m_k s` away; 45
    degrees at the corners of a rectangle. As the distance D to the outline is 0 on it,
    :math:`\int D \nabla D \, dA = 0`: the load moves to the edges without a moment in sum.

    Shapes: corners (n, 2), result (n,).
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=1)
    along = edges / length[:, None]
    inward = np.stack([-along[:, 1], along[:, 0]], axis=1)
    found = []
    for e in range(len(corners)):
        against = 1.0 - inward @ inward[e]
        others = against > _FLAT  # edges on the same line carry their own part
        away = (inward * (corners[e] - corners)).sum(axis=1)[others] / against[others]
        slope = (inward @ along[e])[others] / against[others]
        places = {0.0, float(length[e])}
        for (a, p), (b, q) in itertools.combinations(zip(away, slope, strict=True), 2):
            if abs(p - q) > _FLAT and 0.0 < (place := float((b - a) / (p - q))) < length[e]:
                places.add(place)
        s = np.array(sorted(places))
        depth = np.maximum((away[:, None] + slope[:, None] * s).min(axis=0), 0.0)
        found.append(_pieces(s, depth))
    return found


def one_way(corners: FloatArray, span: FloatArray) -> list[list[Piece]]:
    """Return the load of each edge if strips along `span` rest on the edges at their ends.

    Shapes: corners (n, 2), span (2,), result (n,).
    """
    across = np.array([-span[1], span[0]])
    offset, reach = corners @ across, corners @ span
    stations = np.unique(offset)
    after = np.roll(np.arange(len(corners)), -1)

    def strip(at: float) -> float:
        # Length of the strip at an offset that is no corner's.
        ends = []
        for k, m in enumerate(after):
            if (offset[k] - at) * (offset[m] - at) < 0.0:
                share = (at - offset[k]) / (offset[m] - offset[k])
                ends.append(reach[k] + share * (reach[m] - reach[k]))
        return float(max(ends) - min(ends))

    found: list[list[Piece]] = []
    for k, m in enumerate(after):
        length = float(np.linalg.norm(corners[m] - corners[k]))
        lean = float(offset[m] - offset[k]) / length
        pieces: list[Piece] = []
        if abs(lean) > 1e-6:
            low, high = sorted((offset[k], offset[m]))
            inside = stations[(stations >= low) & (stations <= high)]
            for c0, c1 in itertools.pairwise(inside):
                if c1 - c0 < _FLAT * length:
                    continue
                near, far = (strip(c0 + share * (c1 - c0)) for share in (1.0 / 3.0, 2.0 / 3.0))
                ends = [(c0, 2.0 * near - far), (c1, 2.0 * far - near)]
                (s0, h0), (s1, h1) = sorted(((c - offset[k]) / lean, h) for c, h in ends)
                pieces.append((float(s0), 0.5 * abs(lean) * h0, float(s1), 0.5 * abs(lean) * h1))
        found.append(sorted(pieces))
    return found


def _pieces(s: FloatArray, depth: FloatArray) -> list[Piece]:
    return [
        (float(s[k]), float(depth[k]), float(s[k + 1]), float(depth[k + 1]))
        for k in range(len(s) - 1)
        if s[k + 1] - s[k] > _FLAT * s[-1]
    ]
