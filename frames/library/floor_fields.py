"""The fields of a floor between its beams: faces of the plan that beams make."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from frames._errors import ModelError

Point = tuple[float, float]

_STRAIGHT = 1e-6
"""Sine of the turn below which a corner lies on a straight edge [-]."""


class Fields(NamedTuple):
    """Fields of a floor."""

    # corners of each field anticlockwise, those on straight edges left out
    corners: tuple[tuple[str, ...], ...]
    # pieces of beams along the outer edges of the floor: on one side of them is no field
    outer: tuple[tuple[str, str], ...]


def fields_of(points: Mapping[str, Point], beams: Iterable[tuple[str, str]], where: str) -> Fields:
    """Return the fields that beams enclose, each without a beam across it."""
    edges = [tuple(sorted(beam)) for beam in beams]
    _require_plane(points, edges, where)
    around: dict[str, set[str]] = {}
    for one, other in edges:
        around.setdefault(one, set()).add(other)
        around.setdefault(other, set()).add(one)
    while loose := [name for name, others in around.items() if len(others) == 1]:
        for name in loose:  # a beam that ends alone encloses nothing
            for other in around.pop(name, set()):
                around[other].discard(name)
        around = {name: others for name, others in around.items() if others}
    faces = _faces(points, around)
    inner = [face for face in faces if _area(points, face) > 0.0]
    sides: dict[tuple[str, str], int] = {}
    for face in inner:
        for one, other in zip(face, [*face[1:], face[0]], strict=True):
            key = (min(one, other), max(one, other))
            sides[key] = sides.get(key, 0) + 1
    outer = tuple(edge for edge, count in sides.items() if count == 1)
    return Fields(tuple(_corners(points, face) for face in inner), outer)


def _require_plane(
    points: Mapping[str, Point], edges: Sequence[tuple[str, ...]], where: str
) -> None:
    for k, first in enumerate(edges):
        for second in edges[k + 1 :]:
            if _meet(points, first, second):
                names = [f'from "{edge[0]}" to "{edge[1]}"' for edge in (first, second)]
                msg = (
                    f"{where}: the beams {names[0]} and {names[1]} overlap or cross between their "
                    "ends: let beams go from column line to column line, one after the other"
                )
                raise ModelError(msg)


def _meet(points: Mapping[str, Point], first: Sequence[str], second: Sequence[str]) -> bool:
    # Whether two beams share more than an end.
    (a, b), (c, d) = ([points[name] for name in edge] for edge in (first, second))
    shared = set(first) & set(second)
    if len(shared) == 2:
        return True
    size = max(math.dist(a, b), math.dist(c, d))
    if shared:  # on one line, and on the same side of the end that they share
        (pivot,) = shared
        u, v = (next(points[name] for name in edge if name != pivot) for edge in (first, second))
        o = points[pivot]
        across = (u[0] - o[0]) * (v[1] - o[1]) - (u[1] - o[1]) * (v[0] - o[0])
        along = (u[0] - o[0]) * (v[0] - o[0]) + (u[1] - o[1]) * (v[1] - o[1])
        return abs(across) <= _STRAIGHT * math.dist(u, o) * math.dist(v, o) and along > 0.0
    least = _STRAIGHT * size**2

    def side(p: Point, q: Point, r: Point) -> float:
        turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        return 0.0 if abs(turn) <= least else math.copysign(1.0, turn)

    one, two, three, four = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    if not any((one, two, three, four)):  # on one line
        way = (b[0] - a[0], b[1] - a[1])
        length = math.hypot(*way)
        places = sorted(((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / length for p in (c, d))
        return min(places[1], length) - max(places[0], 0.0) > _STRAIGHT * size
    return one * two <= 0.0 and three * four <= 0.0


def _faces(points: Mapping[str, Point], around: Mapping[str, set[str]]) -> list[list[str]]:
    # Walk each side of each edge once, turning as far to the left as there is.
    turned: dict[str, list[str]] = {}
    for name, others in around.items():
        turned[name] = [other for _, other in sorted(_turns(points, name, others))]
    left = {(one, other) for one, others in around.items() for other in others}
    faces = []
    for start in sorted(left):
        if start not in left:
            continue
        face, (here, there) = [], start
        while (here, there) in left:
            left.discard((here, there))
            face.append(here)
            ways = turned[there]
            here, there = there, ways[ways.index(here) - 1]
        faces.append(face)
    return faces


def _turns(points: Mapping[str, Point], name: str, others: set[str]) -> list[tuple[float, str]]:
    # The direction in which each neighbour lies [rad].
    x, y = points[name]
    return [(math.atan2(points[o][1] - y, points[o][0] - x), o) for o in others]


def _area(points: Mapping[str, Point], face: Sequence[str]) -> float:
    corners = [points[name] for name in face]
    return 0.5 * sum(
        a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)
    )


def _corners(points: Mapping[str, Point], face: Sequence[str]) -> tuple[str, ...]:
    # Without points on straight edges.
    found = []
    for k, name in enumerate(face):
        (a, b, c) = (points[face[k - 1]], points[name], points[face[(k + 1) % len(face)]])
        turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
        if abs(turn) > _STRAIGHT * math.dist(a, b) * math.dist(b, c):
            found.append(name)
    return tuple(found)
