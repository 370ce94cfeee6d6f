"""What a building is made of: lines of columns, beams, braces, walls, fields of floors."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from frames._errors import ModelError

if TYPE_CHECKING:
    from frames.model.components import Vector
    from frames.model.sections import Section


class ColumnPart(NamedTuple):
    """A column over one storey."""

    line: str  # the line in plan that it stands on
    storey: int  # 1 is the one on the base
    section: Section
    # as in `Frame.add_member`; None has the depth of the section along global x
    up: Vector | None = None


class BeamPart(NamedTuple):
    """A beam between two lines at a level."""

    name: str  # what its name begins with, "beam-x" or "beam"
    level: int  # 0 is the base, k the floor on storey k
    start: str  # its lines in plan
    end: str
    section: Section


class BracePart(NamedTuple):
    """A rod across one storey, hinged at both ends."""

    start: str  # the line in plan at its foot
    end: str  # the line in plan at its head
    storey: int
    section: Section


class WallPart(NamedTuple):
    """A wall between two lines from the base up, as a column on its axis with rigid arms."""

    start: str  # its ends in plan; bearings stand under them
    end: str
    last: int  # the storey that it ends with
    section: Section  # its section: local z along the wall, local y across


@dataclass(frozen=True, kw_only=True)
class BuildingPlan:
    """What a building is made of."""

    # lines in plan on which columns stand, by name: x and y [m]
    lines: Mapping[str, tuple[float, float]]
    heights: tuple[float, ...]  # height of each storey, the lowest first [m]
    # a bearing stands under each column of the first storey, and at both ends of a wall
    columns: tuple[ColumnPart, ...]
    # those of the base, level 0, among them; one within a wall goes into its arms
    beams: tuple[BeamPart, ...]
    braces: tuple[BracePart, ...] = ()
    walls: tuple[WallPart, ...] = ()
    flexible: frozenset[int] = frozenset()  # levels whose floor is no rigid diaphragm

    def standing(self, storey: int) -> list[ColumnPart]:
        """Return the columns of a storey."""
        return [part for part in self.columns if part.storey == storey]

    def walls_at(self, level: int) -> list[WallPart]:
        """Return the walls that a level has."""
        return [wall for wall in self.walls if level <= wall.last]

    def beams_at(self, level: int) -> list[BeamPart]:
        """Return the beams of a level that are in no wall."""
        walls = {frozenset((wall.start, wall.end)) for wall in self.walls_at(level)}
        return [
            beam
            for beam in self.beams
            if beam.level == level and frozenset((beam.start, beam.end)) not in walls
        ]

    def at_level(self, level: int) -> list[str]:
        """Return the lines that have a node at a level: column heads, feet, ends of walls."""
        below = [part.line for part in self.standing(level)]
        above = [part.line for part in self.standing(level + 1)]
        walls = [end for wall in self.walls_at(level) for end in (wall.start, wall.end)]
        return list(dict.fromkeys([*below, *above, *walls]))

    def edges(self, level: int) -> list[tuple[str, str]]:
        """Return the beams and the arms of walls of a level, from node to node."""
        floor = level_name(level)
        beams = [(f"{floor}-{beam.start}", f"{floor}-{beam.end}") for beam in self.beams_at(level)]
        arms = [
            (f"{floor}-{end}", wall_node(wall, level))
            for wall in self.walls_at(level)
            for end in (wall.start, wall.end)
        ]
        return [*beams, *arms]


def regular_plan(
    bays: tuple[int, int],
    width: tuple[float, float],
    heights: tuple[float, ...],
    columns: Sequence[tuple[Section, Vector | None]],
    beams: Mapping[str, Sequence[Section]],
) -> BuildingPlan:
    """Return the plan of a regular frame, whose lines are "<ix>-<iy>".

    `columns` has section and `up` by storey, `beams` sections by direction, "x" and "y", then by
    level from the base on.
    """
    places = list(product(range(bays[0] + 1), range(bays[1] + 1)))
    standing = [
        ColumnPart(f"{ix}-{iy}", storey, *column)
        for storey, column in enumerate(columns, start=1)
        for ix, iy in places
    ]
    lying = [
        BeamPart(f"beam-{way}", level, f"{ix}-{iy}", f"{x}-{y}", beams[way][level])
        for level in range(len(heights) + 1)
        for ix, iy in places
        for way, x, y in (("x", ix + 1, iy), ("y", ix, iy + 1))
        if x <= bays[0] and y <= bays[1]
    ]
    return BuildingPlan(
        lines={f"{ix}-{iy}": (ix * width[0], iy * width[1]) for ix, iy in places},
        heights=heights,
        columns=tuple(standing),
        beams=tuple(lying),
    )


def level_name(level: int) -> str:
    """Return the name of a level, "base" or "floor-<k>"."""
    return f"floor-{level}" if level else "base"


def wall_node(wall: WallPart, level: int) -> str:
    """Return the name of the node on the axis of a wall."""
    return f"{level_name(level)}-wall-{wall.start}-{wall.end}"


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
