"""A building on bearings from its plan: lines of columns, storeys, beams between lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING, NamedTuple

from frames._errors import ModelError
from frames.frame import Frame
from frames.library.grid import require_device
from frames.library.moment_frames import DEFAULT_DAMPING
from frames.model.names import likely
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.model.components import Vector
    from frames.model.damping import Damping
    from frames.model.sections import Section
    from lir_element import LIRBearing


class ColumnPart(NamedTuple):
    """A column over one storey.

    Attributes
    ----------
    line : str
        The line in plan that it stands on.
    storey : int
        1 is the one on the base.
    section : Section
        Its section.
    up : tuple of 3 floats, optional
        As in `Frame.add_member`; None has the depth of the section along global x.
    """

    line: str
    storey: int
    section: Section
    up: Vector | None = None


class BeamPart(NamedTuple):
    """A beam between two lines at a level.

    Attributes
    ----------
    name : str
        What its name begins with, "beam-x" or "beam".
    level : int
        0 is the base, k the floor on storey k.
    start, end : str
        Its lines in plan.
    section : Section
        Its section.
    """

    name: str
    level: int
    start: str
    end: str
    section: Section


@dataclass(frozen=True, kw_only=True)
class BuildingPlan:
    """What a building is made of.

    Parameters
    ----------
    lines : mapping of str to (float, float)
        Lines in plan on which columns stand, by name: x and y [m].
    heights : tuple of float
        Height of each storey, the lowest first [m].
    columns : tuple of ColumnPart
        A bearing stands under each column of the first storey.
    beams : tuple of BeamPart
        Those of the base, level 0, among them.
    """

    lines: Mapping[str, tuple[float, float]]
    heights: tuple[float, ...]
    columns: tuple[ColumnPart, ...]
    beams: tuple[BeamPart, ...]

    def standing(self, storey: int) -> list[ColumnPart]:
        """Return the columns of a storey."""
        return [part for part in self.columns if part.storey == storey]

    def at_level(self, level: int) -> list[str]:
        """Return the lines that have a node at a level: column heads below it, feet above it."""
        below = [part.line for part in self.standing(level)]
        above = [part.line for part in self.standing(level + 1)]
        return list(dict.fromkeys([*below, *above]))


def level_name(level: int) -> str:
    """Return the name of a level, "base" or "floor-<k>"."""
    return f"floor-{level}" if level else "base"


def build(
    plan: BuildingPlan,
    bearing: LIRBearing,
    *,
    name: str = "building",
    damping: Damping | None = DEFAULT_DAMPING,
    gravity: float = STANDARD_GRAVITY,
) -> Frame:
    """Return the frame of a building, without loads and masses but those of its members.

    Parameters
    ----------
    plan : BuildingPlan
        The building.
    bearing : LIRBearing
        Under each column of the first storey.
    name : str
        Name of the model.
    damping : RayleighDamping, ModalDamping or None
        Damping of the structure; default 2 per cent in every mode.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    Frame
        Levels "base", "floor-1", ... with nodes "<level>-<line>", a diaphragm for what beams join
        on each; fixed nodes "ground-<line>", bearings "bearing-<line>", members
        "column-<storey>-<line>" and "<name of the beam>-<level>-<line>" with the line that
        it begins at; where several begin there, the line that it ends at follows.

    Raises
    ------
    ModelError
        If a column or beam does not go from node to node, or a node hangs in the air.
    """
    require_device("bearing", bearing)
    _require_whole(plan)
    frame = Frame(name, gravity)
    heights = [bearing.height + z for z in accumulate(plan.heights, initial=0.0)]
    for line in plan.at_level(0):
        x, y = plan.lines[line]
        frame.add_node(f"ground-{line}", x, y, 0.0)
        frame.fix(f"ground-{line}", "all")
        frame.add_node(f"base-{line}", x, y, heights[0])
        frame.add_bearing(f"bearing-{line}", f"ground-{line}", f"base-{line}", bearing)
    _add_level(frame, plan, 0)
    for storey in range(1, len(plan.heights) + 1):
        floor, below = level_name(storey), level_name(storey - 1)
        parts = {part.line: part for part in plan.standing(storey)}
        for line in plan.at_level(storey):
            x, y = plan.lines[line]
            frame.add_node(f"{floor}-{line}", x, y, heights[storey])
            if line in parts:
                part = parts[line]
                foot, head = f"{below}-{line}", f"{floor}-{line}"
                frame.add_member(f"column-{storey}-{line}", foot, head, part.section, part.up)
        _add_level(frame, plan, storey)
    frame.set_damping(damping)
    return frame


def _add_level(frame: Frame, plan: BuildingPlan, level: int) -> None:
    # Beams, diaphragm and level; beams in the order of the lines that they begin at.
    floor, lines = level_name(level), plan.at_level(level)
    beams = [part for part in plan.beams if part.level == level]
    order = {line: k for k, line in enumerate(lines)}
    for part in sorted(beams, key=lambda part: order[part.start]):
        start, end = f"{floor}-{part.start}", f"{floor}-{part.end}"
        name = f"{part.name}-{start}"
        alone = sum((b.name, b.start) == (part.name, part.start) for b in beams) == 1
        frame.add_member(name if alone else f"{name}-{part.end}", start, end, part.section)
    for k, slab in enumerate(_slabs(lines, beams)):
        if len(slab) > 1:
            nodes = [f"{floor}-{line}" for line in slab]
            frame.add_diaphragm(floor if k == 0 else f"{floor}-{slab[0]}", nodes)
    frame.add_level(floor, [f"{floor}-{line}" for line in lines])


def _slabs(lines: list[str], beams: list[BeamPart]) -> list[list[str]]:
    # Lines that beams join, one list for each part of a level that stands apart.
    group = {line: line for line in lines}

    def root(line: str) -> str:
        while group[line] != line:
            line = group[line]
        return line

    for beam in beams:
        group[root(beam.end)] = root(beam.start)
    found: dict[str, list[str]] = {}
    for line in lines:
        found.setdefault(root(line), []).append(line)
    return list(found.values())


def _require_whole(plan: BuildingPlan) -> None:
    # Columns and beams that begin and end where there is something.
    count = len(plan.heights)
    for part in plan.columns:
        _require_line(plan, part.line, f"a column of storey {part.storey}")
        if not 1 <= part.storey <= count:
            msg = f'column on line "{part.line}": storey {part.storey} is none of the {count}'
            raise ModelError(msg)
    for level in range(count + 1):
        nodes = set(plan.at_level(level))
        if not nodes:
            msg = f"no column reaches level {level}: each storey needs one"
            raise ModelError(msg)
        ends = set()
        for beam in (beam for beam in plan.beams if beam.level == level):
            for line in (beam.start, beam.end):
                where = f'beam from "{beam.start}" to "{beam.end}" at {level_name(level)}'
                _require_line(plan, line, where)
                if line not in nodes:
                    msg = (
                        f'{where}: no column on line "{line}" has its head or its foot there: '
                        "give the column that storey, or leave the beam out"
                    )
                    raise ModelError(msg)
                ends.add(line)
        heads = {part.line for part in plan.standing(level)} if level or len(nodes) == 1 else set()
        hanging = sorted(nodes - heads - ends)
        if hanging and level == 0:
            msg = (
                f'column "{hanging[0]}": no beam at the base, floor 0, reaches its foot, and a '
                "bearing holds none upright: give base beams between the feet of columns"
            )
            raise ModelError(msg)
        if hanging:
            msg = (
                f'column "{hanging[0]}" begins at {level_name(level)}, where no beam reaches it: '
                "let it begin on the base, or give the beams that carry it"
            )
            raise ModelError(msg)


def _require_line(plan: BuildingPlan, line: str, where: str) -> None:
    if line not in plan.lines:
        msg = f'{where}: there is no column line "{line}" ({likely(line, plan.lines)})'
        raise ModelError(msg)
