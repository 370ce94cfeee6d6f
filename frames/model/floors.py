"""From a load on a floor panel to the members along its edges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from frames._errors import ModelError
from frames.model.components import FloorLoad, Member, Node, TaperedLoad
from frames.model.geometry_checks import member_ends, node_list, one_elevation
from frames.model.panels import nearest_edges, one_way, turning
from lir_element.argument_checks import require_vector
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.panels import Piece, Span

Around: TypeAlias = Mapping[str, Sequence[Member]]
"""Members at each node."""

_AXES = {"x": (1.0, 0.0), "y": (0.0, 1.0)}


class PanelLoads(NamedTuple):
    """What a panel's load comes to."""

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
    # The members from corner to corner, each going on where the one before ends.
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
                f'floor load "{name}": along its edge from "{edge[0]}" to "{edge[1]}" {what} from '
                f'node "{here}": each edge that carries needs one chain of members from corner to '
                'corner; add it, or give the direction of a one-way panel: span="x"'
            )
            raise ModelError(message)
        ((member, here, along),) = onward
        found.append(_Bay(member, *((at, along) if member.j == here else (along, at))))
        at = along
    return found


def _put(
    nodes: Mapping[str, Node], bay: _Bay, pieces: Sequence[Piece], load: FloorLoad, to: PanelLoads
) -> None:
    # Cuts what an edge carries to one member: on the length between its ends, and beyond.
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
    # Of a linear load from a to b: its sum, and where it acts.
    force = 0.5 * (near + far) * (b - a)
    return force, a + (b - a) * (near + 2.0 * far) / (3.0 * (near + far)) if force else a
