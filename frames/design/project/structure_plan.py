"""From ``[structure]`` of columns and beams to the frame on its bearings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.irregular_plan import irregular_plan
from frames.design.project.member_sections import (
    NamedSection,
    by_storey,
    hinge_of,
    named_section,
    storeys_of,
)
from frames.design.project.schema_sections import BeamsTable, ColumnsTable, SectionTable
from frames.design.project.schema_structure import MomentFrame
from frames.design.project.structure_loads import BuildingLoads, LoadsTable, apply_loads
from frames.library.building import build
from frames.library.building_plan import (
    DEFAULT_BASE_DEPTH,
    BracePart,
    BuildingPlan,
    WallPart,
    regular_plan,
)
from frames.library.models import (
    DEFAULT_BASE_BEAM,
    DEFAULT_BEAM,
    DEFAULT_COLUMN,
    add_floor_masses,
    tributary_masses,
)
from frames.model.damping import ModalDamping
from frames.model.sections import Section
from lir_element.texts import joined

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from frames.design.project.schema_sections import BraceTable, WallTable
    from frames.design.project.schema_structure import BuildingTable, IrregularFrame
    from frames.io import Frame
    from frames.model.components import Vector
    from lir_element import LIRBearing

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
            msg = f'there is no column "{line}": choose one of {known} and so on'
            raise ProjectError(msg)
    if between[0] == between[1]:
        msg = f'between has "{between[0]}" twice: write two different columns'
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


def _wall(plan: BuildingPlan, given: WallTable) -> WallPart:
    _require_lines(plan, given.between)
    storeys = storeys_of(given.storeys, len(plan.heights))
    if storeys[0] != 1:
        msg = (
            f"a wall must start in storey 1 (storeys = [1, {storeys[-1]}]), not "
            f"{storeys[0]}; for a wall on beams, import a model with shells"
        )
        raise ProjectError(msg)
    apart = math.dist(*(plan.lines[line] for line in given.between))
    length = apart if given.length is None else given.length
    if given.thickness > 0.5 * length:
        msg = (
            f"thickness = {given.thickness:g} m is more than half of the length {length:g} "
            "m: model it as a column, or check the unit"
        )
        raise ProjectError(msg)
    own = SectionTable.model_construct(
        rectangle=(given.thickness, length), material=given.material, cracked=given.cracked
    )
    return WallPart(*given.between, storeys[-1], named_section(own, column=False).section)


Kind = TypeVar("Kind", bound=ColumnsTable | BeamsTable)

DIRECTIONS = ("x", "y")


_DEFAULTS: dict[str, tuple[Section, str]] = {
    "columns": (DEFAULT_COLUMN, "box 400 x 400 x 25 mm"),
    "beams": (DEFAULT_BEAM, "I 550 x 220 x 20 x 12 mm"),
    "base_beams": (DEFAULT_BASE_BEAM, "I 800 x 300 x 30 x 16 mm"),
}


class MemberSections(NamedTuple):
    """Sections of a regular frame."""

    columns: list[NamedSection]  # by storey
    beams: dict[str, list[NamedSection]]  # by direction, "x" and "y", then by floor
    base_beams: dict[str, NamedSection]  # by direction
    assumed: tuple[str, ...]  # keys that are not in the file, whose sections are assumed
    special: Mapping[tuple[str, int], ColumnsTable]  # of columns by line and storey


def sections_of(given: MomentFrame) -> MemberSections:
    """Return the sections of a regular frame, those that the file leaves out assumed."""
    tables = {key: _tables(getattr(given, key)) for key in _DEFAULTS}
    usual = [one for one in tables["columns"] if not one.at]
    columns = _sections("columns", usual, given.storeys, None)
    beams = {d: _sections("beams", tables["beams"], given.storeys, d) for d in DIRECTIONS}
    base = {d: _sections("base_beams", tables["base_beams"], 1, d)[0] for d in DIRECTIONS}
    assumed = tuple(key for key, each in (tables | {"columns": usual}).items() if not each)
    special = _told("columns", lambda: _special(tables["columns"], given))
    return MemberSections(columns, beams, base, assumed, special)


def _special(
    tables: Sequence[ColumnsTable], given: MomentFrame
) -> dict[tuple[str, int], ColumnsTable]:
    # Tables of columns on lines that they name.
    lines = [f"{ix}-{iy}" for ix in range(given.bays[0] + 1) for iy in range(given.bays[1] + 1)]
    found: dict[tuple[str, int], ColumnsTable] = {}
    for one in tables:
        for line in one.at:
            if line not in lines:
                msg = f'at = "{line}" is no column: choose from "{lines[0]}" to "{lines[-1]}"'
                raise ProjectError(msg)
            for storey in storeys_of(one.storeys, given.storeys):
                if (line, storey) in found:
                    msg = f'storey {storey} of column "{line}" has two sections: keep one of them'
                    raise ProjectError(msg)
                found[line, storey] = one
    return found


def _tables(given: Kind | Sequence[Kind] | None) -> list[Kind]:
    if given is None:
        return []
    return [given] if isinstance(given, (ColumnsTable, BeamsTable)) else list(given)


def _sections(
    key: str, tables: list[ColumnsTable | BeamsTable], storeys: int, direction: str | None
) -> list[NamedSection]:
    if not tables:
        section, said = _DEFAULTS[key]
        return [
            NamedSection(section, None, joined(said, "steel (E 200 GPa)", "assumed", by=", "))
        ] * storeys
    try:
        chosen = by_storey(tables, storeys, direction)
        made = {id(one): named_section(one, column=key == "columns") for one in chosen}
    except (ModelError, ProjectError) as cause:
        msg = f"[structure] {key}: {cause}"
        raise ProjectError(msg) from cause
    return [made[id(one)] for one in chosen]


def building_frame(
    given: MomentFrame | IrregularFrame,
    bearing: LIRBearing,
    name: str,
    folder: Path,
    loads: BuildingLoads | None = None,
) -> Frame:
    """Return a frame of columns and beams on its bearings, loaded; tables are in the folder."""
    _require_one_load(given, loads)
    plan = _regular_plan(given) if isinstance(given, MomentFrame) else irregular_plan(given, folder)
    plan = with_walls_and_braces(plan, given)
    damping = ModalDamping(given.damping) if given.damping > 0.0 else None
    frame = build(plan, bearing, name=name, damping=damping)
    if isinstance(given, MomentFrame):
        add_hinges(frame, given)
    if given.floor_load is not None and isinstance(given, MomentFrame):
        masses = tributary_masses(given.bays, given.bay_width, given.floor_load, given.eccentricity)
        add_floor_masses(frame, given.storeys, masses, DEFAULT_BASE_DEPTH)
        return frame
    if given.floor_load is not None:
        dead = LoadsTable.model_construct(dead=given.floor_load * frame.gravity)
        loads = BuildingLoads(dead, {"D": 1.0})
    if loads is not None:
        apply_loads(frame, plan, loads, given.eccentricity)
    return frame


def _regular_plan(given: MomentFrame) -> BuildingPlan:
    own = sections_of(given)
    plan = regular_plan(
        given.bays,
        given.bay_width,
        given.heights,
        [(column.section, column.up) for column in own.columns],
        {d: [each.section for each in (own.base_beams[d], *own.beams[d])] for d in DIRECTIONS},
    )
    columns, beams = [], []
    for part in plan.columns:
        table = own.special.get((part.line, part.storey))
        if table is not None:
            section, up, _ = named_section(table, column=True)
            part = part._replace(section=section, up=up)
        columns.append(part)
    for beam in plan.beams:
        ends = {
            end: _to_face(beam.name[-1], own.special.get((line, max(beam.level, 1))), side)
            for end, line, side in (("i", beam.start, 1.0), ("j", beam.end, -1.0))
        }
        offsets = {end: away for end, away in ends.items() if away is not None}
        beams.append(beam._replace(offsets=offsets or None))
    return replace(plan, columns=tuple(columns), beams=tuple(beams))


def _to_face(axis: str, table: ColumnsTable | None, side: float) -> Vector | None:
    # From the axis of a column to its face, of a beam along its longer side.
    if table is None or not table.faces or table.rectangle is None:
        return None
    along = dict(zip(DIRECTIONS, table.rectangle, strict=True))
    if along[axis] < max(along.values()):
        return None
    half = 0.5 * side * along[axis]
    return (half, 0.0, 0.0) if axis == "x" else (0.0, half, 0.0)


def add_hinges(frame: Frame, given: MomentFrame) -> None:
    """Add the plastic hinges of their tables to members."""
    special = sections_of(given).special
    columns = [one for one in _tables(given.columns) if not one.at]
    by_level = {"column": dict(enumerate(by_storey(columns, given.storeys), 1)) if columns else {}}
    for way in DIRECTIONS:
        beams, base = _tables(given.beams), _tables(given.base_beams)
        own = dict(enumerate(by_storey(beams, given.storeys, way), 1)) if beams else {}
        if base:
            own[0] = by_storey(base, 1, way)[0]
        by_level[f"beam-{way}"] = own
    for name in list(frame.members):
        kind, level, line = _placed(name)
        table = by_level.get(kind, {}).get(level)
        if kind == "column":
            table = special.get((line, level), table)
        if table is None or table.hinges is None:
            continue
        hinge = _told(name, lambda t=table, k=kind: hinge_of(t, t.hinges, column=k == "column"))  # type: ignore[misc]
        frame.add_hinges(name, {"i": hinge} if table.hinges.ends == "foot" else hinge)


def _placed(name: str) -> tuple[str, int, str]:
    # Kind, level and line of "column-<storey>-<line>" and of "beam-x-<level>-<line>".
    parts = name.split("-")
    if parts[0] == "column":
        return parts[0], int(parts[1]), "-".join(parts[2:])
    if parts[0] != "beam":
        return parts[0], 0, ""
    level = 0 if parts[2] == "base" else int(parts[3])
    return "-".join(parts[:2]), level, ""


def _require_one_load(given: MomentFrame | IrregularFrame, loads: BuildingLoads | None) -> None:
    if given.floor_load is not None and loads is not None:
        msg = (
            "[structure] floor_load and [loads] both give the weight of the floors: remove "
            "one of them"
        )
        raise ProjectError(msg)
    if given.floor_load is None and loads is None:
        msg = (
            '[structure] floor_load is missing: write the mass of the floors, floor_load = "450 '
            'kg/m2", or the section [loads] with dead = "4.5 kN/m2"'
        )
        raise ProjectError(msg)
