"""Whether the parts of a building's plan meet: columns, beams, braces and walls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.library.building_plan import level_name
from frames.library.floor_fields import fields_of
from frames.model.names import likely

if TYPE_CHECKING:
    from frames.library.building_plan import BuildingPlan


def require_whole(plan: BuildingPlan) -> None:
    """Refuse a plan whose parts do not meet."""
    _require_walls(plan)
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
        ends = {end for wall in plan.walls_at(level) for end in (wall.start, wall.end)}
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
        if plan.walls:  # which must not lie over beams
            points = {line: plan.lines[line] for line in nodes}
            walls = [(wall.start, wall.end) for wall in plan.walls_at(level)]
            beams = [(beam.start, beam.end) for beam in plan.beams_at(level)]
            fields_of(points, [*beams, *walls], level_name(level))
    for rod in plan.braces:
        where = f'brace from "{rod.start}" to "{rod.end}" in storey {rod.storey}'
        for line, level in ((rod.start, rod.storey - 1), (rod.end, rod.storey)):
            _require_line(plan, line, where)
            if line not in plan.at_level(level):
                msg = f'{where}: no column on line "{line}" reaches {level_name(level)}'
                raise ModelError(msg + ": leave the brace out there")
        if rod.start == rod.end:
            msg = f"{where} would be a column: name two lines"
            raise ModelError(msg)


def _require_walls(plan: BuildingPlan) -> None:
    pairs: set[frozenset[str]] = set()
    for wall in plan.walls:
        where = f'wall between "{wall.start}" and "{wall.end}"'
        for line in (wall.start, wall.end):
            _require_line(plan, line, where)
        if wall.start == wall.end:
            msg = f"{where} has no length: name two lines"
            raise ModelError(msg)
        pair = frozenset((wall.start, wall.end))
        if pair in pairs:
            msg = f"{where} is there twice: keep one"
            raise ModelError(msg)
        pairs.add(pair)


def _require_line(plan: BuildingPlan, line: str, where: str) -> None:
    if line not in plan.lines:
        msg = f'{where}: there is no column line "{line}" ({likely(line, plan.lines)})'
        raise ModelError(msg)
