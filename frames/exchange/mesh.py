"""Mesh of the areas that are shells: edges divided equally on both sides, and at their joints."""

from __future__ import annotations

import itertools
import math
import operator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from frames._errors import ModelError, argument
from frames.exchange.geometry import Points
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from collections.abc import Sequence
    from collections.abc import Set as AbstractSet

    from frames._types import FloatArray
    from frames.exchange.building import AreaObject


Edge = tuple[str, str]

MOST = 20_000
"""Elements of shells that an import makes."""


@dataclass
class Mesh:
    """Elements of shells: the area each belongs to, and its nodes in order (3 or 4).

    `between` has the nodes made along edges, and the two corners of each.
    """

    elements: list[tuple[str, tuple[str, ...]]] = field(default_factory=list)
    between: dict[str, tuple[str, str]] = field(default_factory=dict)

    def by_area(self) -> dict[str, list[tuple[str, ...]]]:
        """Return the elements of each area."""
        found: dict[str, list[tuple[str, ...]]] = {}
        for area, nodes in self.elements:
            found.setdefault(area, []).append(nodes)
        return found


def mesh_areas(
    areas: Sequence[AreaObject], points: Points, size: float, inside: Inside | None = None
) -> Mesh:
    """Divide areas into elements, and add their nodes to the points."""
    for area in areas:
        if len(area.joints) > 4:
            message = (
                f'{area.place}: area "{area.name}" is a shell of {len(area.joints)} '
                "corners, only 3 and 4 are supported: divide it, or give it a rigid "
                "diaphragm"
            )
            raise ModelError(message)
    inside = inside or {}
    cuts = _cuts(areas, points, size, inside)
    count = sum(math.prod(len(cuts[_key(edge)]) - 1 for edge in edges_of(a)[:2]) for a in areas)
    if count > MOST:
        message = (
            f"walls and slabs have {count} elements with {argument('mesh', size)} (at most "
            f"{MOST}): use longer elements, or rigid diaphragms for floors"
        )
        raise ModelError(message)
    joints = set(points)
    places = _Places(points)
    names = {edge: _names(edge, shares, places) for edge, shares in cuts.items()}
    mesh = Mesh()
    for edge, along in names.items():
        mesh.between |= {node: edge for node in along if node not in joints}
    for area in areas:
        if len(area.joints) == 4:
            _quad(area, names, cuts, places, mesh, joints - inside.get(area.name, {}).keys())
            continue
        if area.name in inside:
            message = (
                f'{area.place}: joint "{next(iter(inside[area.name]))}" lies inside the '
                f'triangle "{area.name}", whose mesh cannot connect to it: divide it into '
                "quadrilaterals"
            )
            raise ModelError(message)
        divided = [edge for edge in edges_of(area) if len(names[_key(edge)]) > 2]
        if divided:
            message = (
                f'{area.place}: triangle "{area.name}" has joints along its edge between '
                f'"{divided[0][0]}" and "{divided[0][1]}", or its neighbours need some: '
                "divide it into quadrilaterals"
            )
            raise ModelError(message)
        mesh.elements.append((area.name, area.joints))
    return mesh


def edges_of(area: AreaObject) -> list[Edge]:
    """Return the edges of an area, each by its joints."""
    joints = area.joints
    return [(joints[k], joints[(k + 1) % len(joints)]) for k in range(len(joints))]


def _key(edge: Edge) -> Edge:
    return edge if edge[0] < edge[1] else (edge[1], edge[0])


def _cuts(
    areas: Sequence[AreaObject], points: Points, size: float, inside: Inside
) -> dict[Edge, list[float]]:
    # Shares of each edge's length, from its first joint by name, at which it is divided.
    edges = list(dict.fromkeys(_key(edge) for area in areas for edge in edges_of(area)))
    found = _joints_on(edges, points)
    quads = [area for area in areas if len(area.joints) == 4]
    for area in quads:
        a, b, _, d = area.joints
        for place in inside.get(area.name, {}).values():
            for edge, share in zip(((a, b), (a, d)), place, strict=True):
                key = _key(edge)
                new = share if edge == key else 1.0 - share
                least = SAME_PLACE / math.dist(points[a], points[edge[1]])
                if min(abs(new - old) for old in found[key]) > least:
                    found[key] = sorted([*found[key], new])
    _spread(quads, found)
    cells: dict[Edge, list[int]] = {}
    for edge, shares in found.items():
        length = math.dist(points[edge[0]], points[edge[1]])
        steps = np.diff(shares) * length
        cells[edge] = [max(1, math.ceil(step / size - 1e-6)) for step in steps]
    for area in areas:
        if len(area.joints) == 3:
            for edge in edges_of(area):
                cells[_key(edge)] = [1] * len(cells[_key(edge)])
    _even_out(quads, cells)
    return {
        edge: [
            float(a + (b - a) * k / count)
            for a, b, count in zip(shares[:-1], shares[1:], cells[edge], strict=True)
            for k in range(count)
        ]
        + [1.0]
        for edge, shares in found.items()
    }


def _joints_on(edges: list[Edge], points: Points) -> dict[Edge, list[float]]:
    names = list(points)
    where = np.array([points[name] for name in names])
    tree = cKDTree(where)
    found = {}
    for edge in edges:
        first, last = (np.array(points[name]) for name in edge)
        length = float(np.linalg.norm(last - first))
        near = tree.query_ball_point(0.5 * (first + last), max(0.5 * length - SAME_PLACE, 0.0))
        shares = {0.0, 1.0}
        for k in near:
            along = float((where[k] - first) @ (last - first)) / length**2
            if np.linalg.norm(where[k] - first - along * (last - first)) <= SAME_PLACE:
                shares.add(along)
        found[edge] = sorted(shares)
    return found


def _pairs(area: AreaObject) -> list[tuple[Edge, Edge, bool]]:
    # Opposite edges, and whether their shares run against each other.
    a, b, c, d = area.joints
    found = []
    for one, two in (((a, b), (d, c)), ((b, c), (a, d))):
        turned = (one == _key(one)) != (two == _key(two))
        found.append((_key(one), _key(two), turned))
    return found


def _spread(quads: Sequence[AreaObject], found: dict[Edge, list[float]]) -> None:
    # Until opposite edges are divided at the same shares.
    pairs = [pair for area in quads for pair in _pairs(area)]
    changed = True
    while changed:
        changed = False
        for one, two, turned in pairs:
            for source, target in ((one, two), (two, one)):
                given = [1.0 - s for s in found[source]] if turned else found[source]
                new = [s for s in given if min(abs(s - t) for t in found[target]) > 1e-6]
                if new:
                    found[target] = sorted([*found[target], *new])
                    changed = True


def _even_out(quads: Sequence[AreaObject], cells: dict[Edge, list[int]]) -> None:
    # Until opposite edges have as many elements in each part.
    pairs = [pair for area in quads for pair in _pairs(area)]
    changed = True
    while changed:
        changed = False
        for one, two, turned in pairs:
            other = cells[two][::-1] if turned else cells[two]
            most = [max(a, b) for a, b in zip(cells[one], other, strict=True)]
            if most != cells[one] or most != other:
                cells[one], cells[two] = most, most[::-1] if turned else list(most)
                changed = True


class _Places:
    # Nodes by place: a new one at the place of another is that one.
    def __init__(self, points: Points) -> None:
        self.points = points
        self._cells: dict[tuple[int, ...], list[str]] = {}
        for name, place in points.items():
            self._cells.setdefault(_cell(place), []).append(name)

    def node(self, name: str, place: FloatArray, apart: AbstractSet[str] = frozenset()) -> str:
        x, y, z = place.tolist()
        cell = _cell((x, y, z))
        for step in _BESIDE:
            for other in self._cells.get(tuple(map(operator.add, cell, step)), ()):
                is_near = math.dist(self.points[other], (x, y, z)) <= SAME_PLACE
                if is_near and other not in apart:
                    return other
        self.points[name] = (x, y, z)
        self._cells.setdefault(cell, []).append(name)
        return name


def _cell(place: tuple[float, float, float]) -> tuple[int, ...]:
    return tuple(math.floor(value / SAME_PLACE) for value in place)


_BESIDE = list(itertools.product((0, -1, 1), repeat=3))


def _names(edge: Edge, shares: list[float], places: _Places) -> list[str]:
    # Nodes along an edge.
    first, last = (np.array(places.points[name]) for name in edge)
    between = [
        places.node(f"{edge[0]}~{edge[1]}~{k}", first + share * (last - first))
        for k, share in enumerate(shares[1:-1], start=1)
    ]
    return [edge[0], *between, edge[1]]


def _quad(
    area: AreaObject,
    names: dict[Edge, list[str]],
    cuts: dict[Edge, list[float]],
    places: _Places,
    mesh: Mesh,
    apart: AbstractSet[str],
) -> None:
    a, b, c, d = area.joints
    bottom, top = _along((a, b), names), _along((d, c), names)
    left, right = _along((a, d), names), _along((b, c), names)
    corners = np.array([places.points[name] for name in (a, b, c, d)])
    u, v = (_shares(edge, cuts) for edge in ((a, b), (a, d)))
    grid = [[""] * len(u) for _ in v]
    for row in range(len(v)):
        for column in range(len(u)):
            if row in {0, len(v) - 1}:
                grid[row][column] = (bottom if row == 0 else top)[column]
            elif column in {0, len(u) - 1}:
                grid[row][column] = (left if column == 0 else right)[row]
            else:
                place = _bilinear(corners, u[column], v[row])
                grid[row][column] = places.node(f"{area.name}~{row}~{column}", place, apart)
    for row in range(len(v) - 1):
        for column in range(len(u) - 1):
            low, high = grid[row], grid[row + 1]
            nodes = (low[column], low[column + 1], high[column + 1], high[column])
            mesh.elements.append((area.name, nodes))


def _along(edge: Edge, names: dict[Edge, list[str]]) -> list[str]:
    found = names[_key(edge)]
    return found if edge == _key(edge) else found[::-1]


def _shares(edge: Edge, cuts: dict[Edge, list[float]]) -> list[float]:
    found = cuts[_key(edge)]
    return found if edge == _key(edge) else [1.0 - share for share in found[::-1]]


def _bilinear(corners: FloatArray, u: float, v: float) -> FloatArray:
    weights = np.array([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
    return weights @ corners


Inside = dict[str, dict[str, tuple[float, float]]]
"""Joints within each area, by its name: shares along its first and along its last edge [-]."""

_STEPS = 30


def joints_within(areas: Sequence[AreaObject], points: Points, edges: bool = False) -> Inside:
    """Return the joints inside areas, with `edges` also those on their edges."""
    names = list(points)
    where = np.array([points[name] for name in names]).reshape(-1, 3)
    tree = cKDTree(where)
    found: Inside = {}
    for area in areas:
        corners = np.array([points[name] for name in area.joints])
        centre = corners.mean(axis=0)
        low, high = corners.min(axis=0) - SAME_PLACE, corners.max(axis=0) + SAME_PLACE
        reach = float(np.linalg.norm(corners - centre, axis=1).max())
        for k in tree.query_ball_point(centre, reach):
            outside = (where[k] < low) | (where[k] > high)
            if names[k] in area.joints or outside.any():
                continue
            shares = _shares_of(corners, where[k], edges=edges)
            if shares is not None:
                found.setdefault(area.name, {})[names[k]] = shares
    return found


def _shares_of(
    corners: FloatArray, place: FloatArray, *, edges: bool = False
) -> tuple[float, float] | None:
    # By Newton on the bilinear surface of four corners; None off the area or on its edges.
    a, b, d = corners[0], corners[1], corners[-1]
    twist = corners[2] - b - d + a if len(corners) == 4 else np.zeros(3)
    u = v = 0.5
    for _ in range(_STEPS):
        off = a + u * (b - a) + v * (d - a) + u * v * twist - place
        along, across = b - a + v * twist, d - a + u * twist
        matrix = np.stack([along, across], axis=1)
        step = np.linalg.lstsq(matrix, -off, rcond=None)[0]
        u, v = u + float(step[0]), v + float(step[1])
        if abs(u) > 1e3 or abs(v) > 1e3:
            return None
        if float(np.abs(step).max()) < 1e-12:
            break
    off = a + u * (b - a) + v * (d - a) + u * v * twist - place
    if float(np.linalg.norm(off)) > SAME_PLACE:
        return None
    wide = min(float(np.linalg.norm(side)) for side in (b - a + v * twist, d - a + u * twist))
    least = (-SAME_PLACE if edges else SAME_PLACE) / wide
    if len(corners) == 3:
        return (u, v) if min(u, v) > least and u + v < 1.0 - least else None
    return (u, v) if least < u < 1.0 - least and least < v < 1.0 - least else None
