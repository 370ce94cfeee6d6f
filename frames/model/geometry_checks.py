"""Checks of places in a frame: nodes that exist and differ, planes, bearings, members."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from operator import add, mul, sub
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, known_name
from frames.model.axes import local_axes
from frames.model.components import (
    RELEASABLE,
    Diaphragm,
    Level,
    Member,
    Node,
    Vector,
    bearing_height,
)
from lir_element.argument_checks import require_finite, require_type, require_vector
from lir_element.elevations import SAME_PLACE
from lir_element.units import OTHER_UNITS, meant

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element import LIRBearing

LARGEST_OFFSET = 20.0
"""Length of a rigid end zone that no member has [m]."""

Nodes = Mapping[str, Node]


def require_two_nodes(nodes: Nodes, i: str, j: str, owner: str) -> None:
    """Raise unless both nodes exist and differ."""
    for node in (i, j):
        known_name(node, nodes, "node")
    if i == j:
        message = f'{owner} starts and ends at node "{i}": name two different nodes'
        raise ModelError(message)


def node_list(nodes: Nodes, given: Sequence[str], owner: str, least: int) -> tuple[str, ...]:
    """Return names of nodes that exist, each once and `least` at least, or raise."""
    if isinstance(given, str):
        message = f'nodes of {owner} = "{given}" must be a list of names: write ["{given}"]'
        raise TypeError(message)
    chosen = tuple(known_name(node, nodes, "node") for node in given)
    repeated = sorted({node for node in chosen if chosen.count(node) > 1})
    if repeated:
        message = f'{owner} lists node "{repeated[0]}" more than once: list each node once'
        raise ModelError(message)
    if len(chosen) < least:
        message = f"{owner} has {len(chosen)} nodes: name at least {least}"
        raise ModelError(message)
    return chosen


def one_elevation(nodes: Nodes, chosen: tuple[str, ...], owner: str) -> float:
    """Return the elevation that nodes share [m], or raise."""
    low = min((nodes[node] for node in chosen), key=lambda node: node.z)
    high = max((nodes[node] for node in chosen), key=lambda node: node.z)
    if high.z - low.z > SAME_PLACE:
        message = (
            f'{owner} is not horizontal: node "{low.name}" is at z = {low.z:g} m, node '
            f'"{high.name}" at z = {high.z:g} m (at most {SAME_PLACE:g} m apart): split it, '
            "or put its nodes at one elevation"
        )
        raise ModelError(message)
    return low.z


def member_up(
    nodes: Nodes,
    name: str,
    i: str,
    j: str,
    up: Sequence[float] | None,
    offsets: tuple[Vector, Vector],
) -> Vector | None:
    """Return `up` for a member, or raise if it has no length or no local axes."""
    first, second = nodes[i].position, nodes[j].position
    start, end = tuple(map(add, first, offsets[0])), tuple(map(add, second, offsets[1]))
    length = math.dist(start, end)
    between = f'"{i}" to "{j}"' + (" less its offsets" if any(map(any, offsets)) else "")
    if length < SAME_PLACE:
        message = (
            f'member "{name}" from {between} is {length:g} m long, it must be longer '
            f"than {SAME_PLACE:g} m: join coincident nodes by add_spring"
        )
        raise ModelError(message)
    if sum(map(mul, map(sub, end, start), map(sub, second, first))) < 0.0:
        message = (
            f'member "{name}" from {between} has offsets that overlap by {length:g} m: '
            "shorten them (vectors from node to end in global axes [m])"
        )
        raise ModelError(message)
    if up is None:  # the default is never along the member
        return None
    given = require_vector(f'up of member "{name}"', up, 3, error=ModelError)
    try:
        local_axes(np.array([start]), np.array([end]), given[None, :])
    except ModelError as cause:
        message = f'member "{name}" has no local axes: {cause}'
        raise ModelError(message) from cause
    return float(given[0]), float(given[1]), float(given[2])


def member_offsets(
    name: str, offsets: Mapping[str, Sequence[float]] | None
) -> tuple[Vector, Vector]:
    """Return the vectors [m] from nodes i and j of a member to its ends, checked."""
    what = 'vectors by end: write {"i": (0.25, 0, 0)}'
    require_type(f'offsets of member "{name}"', offsets, (Mapping, type(None)), what)
    given = dict(offsets or {})
    unknown = [end for end in given if end not in {"i", "j"}]
    if unknown:
        message = (
            f'offsets of member "{name}": {unknown[0]!r} is not an end: use "i" and "j" with '
            'vectors from node to end [m], such as {"j": (-0.25, 0, 0)}'
        )
        raise ModelError(message)
    found = []
    for end in "ij":
        if end not in given:
            found.append((0.0, 0.0, 0.0))
            continue
        what = f'offset [m] of member "{name}" at end {end}'
        x, y, z = require_vector(what, given[end], 3, error=ModelError)
        size = math.hypot(x, y, z)
        if size > LARGEST_OFFSET:
            message = (
                f"{what} is {size:g} m long, at most {LARGEST_OFFSET:g} m: "
                f"{meant(size, 'm', 0.01, 3.0)}"
            )
            raise ModelError(message)
        found.append((float(x), float(y), float(z)))
    return found[0], found[1]


def member_points(nodes: Nodes, member: Member) -> tuple[Vector, Vector]:
    """Return the ends of a member [m]: its nodes and its offsets from them."""
    i, j = nodes[member.i], nodes[member.j]
    (x, y, z), (dx, dy, dz) = member.offsets
    return (i.x + x, i.y + y, i.z + z), (j.x + dx, j.y + dy, j.z + dz)


def member_ends(nodes: Nodes, member: Member) -> tuple[FloatArray, FloatArray]:
    """Return the same as arrays (3,)."""
    first, second = member_points(nodes, member)
    return np.array(first), np.array(second)


def member_span(nodes: Nodes, member: Member, a: float, b: float | None) -> tuple[float, float]:
    """Return a part of a member from `a` to `b` [m], None its end, or raise if it is not on it."""
    length = math.dist(*member_points(nodes, member))
    owner = f'a load on member "{member.name}"'
    start = require_finite(f"a [m] of {owner}", a, error=ModelError)
    end = length if b is None else require_finite(f"b [m] of {owner}", b, error=ModelError)
    slack = 1e-9 * length
    if not -slack <= start < end <= length + slack:
        message = (
            f"{owner} from a = {start:g} m to b = {end:g} m must begin before it ends, "
            f"within the member's {length:g} m: give distances from its end i"
        )
        raise ModelError(message)
    return max(start, 0.0), min(end, length)


def refuse_shared(name: str, nodes: tuple[str, ...], others: Mapping[str, Diaphragm]) -> None:
    """Raise if a node of a new diaphragm belongs to another one."""
    for other in others.values():
        shared = sorted(set(nodes) & set(other.nodes))
        if shared:
            message = (
                f'node "{shared[0]}" of diaphragm "{name}" is already in diaphragm '
                f'"{other.name}": merge the two'
            )
            raise ModelError(message)


def fits(rise: float, height: float) -> bool:
    """Return True if a bearing of a height fits between nodes that are `rise` apart [m]."""
    return min(abs(rise), abs(rise - height)) <= SAME_PLACE


def require_bearing_place(nodes: Nodes, name: str, i: str, j: str, bearing: LIRBearing) -> None:
    """Raise unless node j is on the vertical through node i, at distance 0 or the height."""
    height = bearing_height(name, bearing)
    below, above = nodes[i], nodes[j]
    offset = math.hypot(above.x - below.x, above.y - below.y)
    rise = above.z - below.z
    if offset > SAME_PLACE:
        message = (
            f'bearing "{name}": node "{j}" is {offset:g} m off the vertical through node '
            f'"{i}" (at most {SAME_PLACE:g} m): use the same x and y for both'
        )
        raise ModelError(message)
    if not fits(rise, height):
        message = (
            f'bearing "{name}": node "{j}" is {rise:g} m above node "{i}", it must be 0 m or '
            f"the bearing's height {height:g} m within {SAME_PLACE:g} m: "
            f"place node j at z of node i plus bearing.height{_in_mm(rise, height)}"
        )
        raise ModelError(message)


def require_above(name: str, z: float, below: Level | None) -> None:
    """Raise unless a new level is above the one added before."""
    if below is not None and z <= below.z + SAME_PLACE:
        message = (
            f'level "{name}" at z = {z:g} m must lie above level "{below.name}" at '
            f"{below.z:g} m: add levels from below to above, one for each elevation"
        )
        raise ModelError(message)


def member_releases(
    name: str, releases: Mapping[str, Sequence[str]] | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the moments that ends i and j of a member do not pass on, checked."""
    given = dict(releases or {})
    unknown = [end for end in given if end not in {"i", "j"}]
    wrong = [part for parts in given.values() for part in parts if part not in RELEASABLE]
    if unknown or wrong:
        message = (
            f'releases of member "{name}": {unknown[0] if unknown else wrong[0]!r} is not '
            f'supported: use ends "i" and "j" with moments of {", ".join(RELEASABLE)}, such '
            'as {"j": ("My", "Mz")}'
        )
        raise ModelError(message)
    first, second = (tuple(part for part in RELEASABLE if part in given.get(e, ())) for e in "ij")
    if "T" in first and "T" in second:
        message = (
            f'releases of member "{name}": "T" at both ends leaves the rotation about its '
            "axis free: release it at one end at most"
        )
        raise ModelError(message)
    return first, second


def _in_mm(rise: float, height: float) -> str:
    for name, factor in OTHER_UNITS["m"]:
        if abs(rise * factor - height) <= max(SAME_PLACE * factor, 1e-3 * height):
            return f"; coordinates are in m ({rise:g} {name} are {rise * factor:.4g} m)"
    return ""
