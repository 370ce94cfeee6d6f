"""From tables of walls, braces and diaphragms in a project's file to the parts of its plan."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.materials import material_of
from frames.design.project.member_sections import cracked_said, named_section, storeys_of
from frames.library.building_plan import BracePart, WallPart
from frames.model.sections import Section

if TYPE_CHECKING:
    from frames.design.project.schema_sections import BraceTable, WallTable
    from frames.design.project.schema_structure import BuildingTable
    from frames.library.building_plan import BuildingPlan

T = TypeVar("T")


def with_walls_and_braces(plan: BuildingPlan, given: BuildingTable) -> BuildingPlan:
    """Return a plan with the walls, braces and diaphragms of the file."""
    braces: list[BracePart] = []
    for k, rod in enumerate(given.braces):
        braces += _told(f"braces[{k}]", lambda rod=rod: _rods(plan, rod))  # type: ignore[misc]
    walls = [
        _told(f"walls[{k}]", lambda wall=wall: _wall(plan, wall))  # type: ignore[misc]
        for k, wall in enumerate(given.walls)
    ]
    floors = range(1, len(plan.heights) + 1) if given.floor_diaphragm == "flexible" else ()
    base = (0,) if given.base_diaphragm == "flexible" else ()
    return replace(
        plan, braces=tuple(braces), walls=tuple(walls), flexible=frozenset({*floors, *base})
    )


def _told(key: str, make: Callable[[], T]) -> T:
    try:
        return make()
    except (ModelError, ProjectError) as cause:
        msg = f"[structure] {key}: {cause}"
        raise ProjectError(msg) from cause


def _require_lines(plan: BuildingPlan, between: tuple[str, str]) -> None:
    for line in between:
        if line not in plan.lines:
            known = ", ".join(f'"{each}"' for each in list(plan.lines)[:6])
            msg = f'there is no column "{line}": the first are {known}'
            raise ProjectError(msg)
    if between[0] == between[1]:
        msg = f'between = "{between[0]}" twice: name two columns'
        raise ProjectError(msg)


def _rods(plan: BuildingPlan, given: BraceTable) -> list[BracePart]:
    _require_lines(plan, given.between)
    section = named_section(given, column=False).section
    one, other = given.between
    ways = {"x": ((one, other), (other, one)), "up": ((one, other),), "down": ((other, one),)}
    return [
        BracePart(start, end, storey, section)
        for storey in storeys_of(given.storeys, len(plan.heights))
        for start, end in ways[given.pattern]
    ]


def wall_length(plan: BuildingPlan, given: WallTable) -> float:
    """Return the length of a wall [m]: its own, else the distance between its columns."""
    apart = math.dist(*(plan.lines[line] for line in given.between))
    return apart if given.length is None else given.length


def _wall(plan: BuildingPlan, given: WallTable) -> WallPart:
    _require_lines(plan, given.between)
    storeys = storeys_of(given.storeys, len(plan.heights))
    if storeys[0] != 1:
        msg = (
            f"storeys = [{storeys[0]}, {storeys[-1]}]: a wall stands on the base, above its "
            f"bearings: [1, {storeys[-1]}]; one on beams needs shells or a frame of your own"
        )
        raise ProjectError(msg)
    length, material = wall_length(plan, given), material_of(given.material)
    if given.thickness > 0.5 * length:
        msg = (
            f"thickness = {given.thickness:g} m is more than half of the length {length:g} m: "
            "that is a column, or look at the unit"
        )
        raise ProjectError(msg)
    section = Section.rectangle(
        given.thickness,
        length,
        elastic_modulus=material.elastic_modulus,
        poisson_ratio=material.poisson_ratio,
        density=material.density,
    )
    section, _ = cracked_said(section, given.cracked)
    return WallPart(*given.between, storeys[-1], section)
