"""Parts of a building: lines of columns, beams, braces, walls, fields of floors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from frames.model.components import Vector
    from frames.model.sections import Section

DEFAULT_BASE_DEPTH = 0.8
"""Depth of the base beams with their slab [m]."""


class ColumnPart(NamedTuple):
    """A column over one storey."""

    line: str  # its line in plan
    storey: int  # 1 is the one on the base
    section: Section
    # as in `Frame.add_member`; None has the depth of the section along global x
    up: Vector | None = None


class BeamPart(NamedTuple):
    """A beam between two lines at a level."""

    name: str  # beginning of its name, "beam-x" or "beam"
    level: int  # 0 is the base, k the floor on storey k
    start: str  # its lines in plan
    end: str
    section: Section
    # from the axes of its columns to its ends, "i" and "j", in global axes [m]
    offsets: Mapping[str, Vector] | None = None


class BracePart(NamedTuple):
    """A rod across one storey, hinged at both ends."""

    start: str  # the line in plan at its foot
    end: str  # the line in plan at its head
    storey: int
    section: Section


class WallPart(NamedTuple):
    """A wall between two lines from the base up, as a column on its axis with rigid arms."""

    start: str  # its ends in plan, with bearings under them
    end: str
    last: int  # the storey that it ends with
    section: Section  # its section: local z along the wall, local y across


@dataclass(frozen=True, kw_only=True)
class BuildingPlan:
    """Parts of a building."""

    # lines in plan with columns, by name: x and y [m]
    lines: Mapping[str, tuple[float, float]]
    heights: tuple[float, ...]  # height of each storey, the lowest first [m]
    # a bearing is under each column of the first storey, and at both ends of a wall
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
