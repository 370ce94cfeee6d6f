"""Reads a SAP2000 model: its text tables (.s2k, .$2k) or the workbook with the same tables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from frames.exchange import sap2000_fields as dialect
from frames.exchange.account import Account, judge_rest
from frames.exchange.building import (
    LINK_DOFS,
    AreaLoad,
    AreaSection,
    Building,
    FrameSection,
    JointLoad,
    LineLoad,
    LinkDof,
    LinkProperty,
    MassSource,
    Modifiers,
    Pattern,
)
from frames.exchange.fields import Units, refused, units_of, values
from frames.exchange.loads import (
    add_area_load,
    add_combinations,
    add_line_load,
    area_weight,
    cases_of,
    frame_weight,
    vector_of,
)
from frames.exchange.options import Options
from frames.exchange.properties import (
    by_constants,
    in_use,
    material_of,
    section_by_shape,
    shell_factors,
)
from frames.exchange.reading import read_excel, read_s2k
from frames.exchange.sap2000_objects import read_objects, section_of
from frames.exchange.tables import ACTIVE, Row, Tables, by_name, known, require_space

_BOOKS = {".xlsx", ".xlsm"}


def read_sap2000(path: str | Path, options: Options | None = None) -> Building:
    """Read a SAP2000 model."""
    file, given = Path(path), options or Options()
    tables = read_excel(file) if file.suffix.lower() in _BOOKS else read_s2k(file, given.decimal)
    account = Account(file.name, given.allow)
    row = tables.needed("PROGRAM CONTROL", "it has the units; export it with the others")[0]
    units = units_of(row.text("CurrUnits"), "CurrUnits", row.error)
    building = Building(file.stem, "SAP2000", row.text("Version", ""), units, account)
    for row in tables.rows("ACTIVE DEGREES OF FREEDOM"):
        require_space(row, {name for name in ACTIVE if row.yes(name)})
    read_properties(tables, building)
    read_objects(tables, building)
    read_loads(tables, building)
    judge_rest(tables, account, dialect.REFUSED, dialect.KNOWN, dialect.OBJECTS, dialect.HARMLESS)
    return building


def read_properties(tables: Tables, building: Building) -> None:
    """Read materials, sections and link properties into a building."""
    account, units = building.account, building.units
    frames = tables.rows("FRAME SECTION ASSIGNMENTS")
    areas = tables.rows("AREA SECTION ASSIGNMENTS")
    kinds = [row.text("Section", "") for row in areas]
    sections = _used(tables, building, dialect.SECTIONS, "SectionName", map(section_of, frames))
    shells = _used(tables, building, dialect.AREA_SECTIONS, "Section", kinds)
    used = {row.text("Material", "") for row in (*sections.values(), *shells.values())}
    used |= {row.text("MatProp", "") for row in frames}
    heads = by_name(tables.rows("MATERIAL PROPERTIES 01 - GENERAL"), "Material")
    for name, row in _used(tables, building, dialect.MATERIALS, "Material", used).items():
        for field in ("UnitMass", "UnitWeight"):  # which stand in either table of materials
            if name in heads and heads[name].has(field) and not row.has(field):
                row.values[field] = heads[name].values[field]
        building.materials[name] = material_of(row, name, dialect.MATERIAL, units)
    account.read(dialect.MATERIALS, "materials in use", len(building.materials))
    for name, row in sections.items():
        building.sections[name] = _section(row, name, building)
    account.read(dialect.SECTIONS, "cross-sections in use", len(building.sections))
    for name, row in shells.items():
        building.area_sections[name] = _area_section(row, name, building)
    account.read(dialect.AREA_SECTIONS, "sections of areas in use", len(building.area_sections))
    _read_links(tables, building)


def _used(
    tables: Tables, building: Building, table: str, field: str, names: Iterable[str]
) -> dict[str, Row]:
    rows, idle = in_use(by_name(tables.rows(table), field), names)
    building.account.left_out(table, "which nothing has", idle)
    return rows


def _section(row: Row, name: str, building: Building) -> FrameSection:
    account, units = building.account, building.units
    material, shape = values(row, dialect.SECTION[:2], units).values()
    modifiers = Modifiers(**values(row, dialect.MODIFIERS, units))
    refused(row, name, account, dialect.SECTION_WORDS)
    if not row.has("Area", "I33", "I22"):
        known(row, "Material", material, building.materials)
        poisson = building.materials[material].poisson_ratio
        sizes = tuple(values(row, dialect.SIZES, units).values())
        found = section_by_shape(row, name, material, shape, sizes, poisson)
    else:
        if abs(row.number("I23", 0.0)) > 1e-6 * max(row.number("I33"), row.number("I22")):
            what = (
                "the product of inertia I23 of a section, whose axes 2 and 3 are not principal ones"
            )
            account.refuse("I23", dialect.SECTIONS, what, [name], row.place)
        found = by_constants(row, name, dialect.SECTION, units)
    return replace(found, modifiers=modifiers)


def _area_section(row: Row, name: str, building: Building) -> AreaSection:
    kind = f"{row.text('AreaType', 'Shell')} {row.text('Type', 'Shell-Thin')}".lower()
    refused(row, name, building.account, dialect.LAYERED)
    if refused(row, name, building.account, dialect.NO_SHELL):
        return AreaSection(name, "", "none", 0.0, 0.0)
    words = ("membrane", "plate")
    found = next((word for word in words if word in kind.removeprefix("shell ")), "shell")
    material = known(row, "Material", row.text("Material"), building.materials)
    of = f' of area section "{name}"'
    thickness, bending = values(row, dialect.THICKNESS, building.units, of).values()
    factors = shell_factors(row, dialect.SHELL, building)
    return AreaSection(name, material, found, thickness, bending or thickness, **factors)


def _read_links(tables: Tables, building: Building) -> None:
    placed = (row.text("LinkProp", "") for row in tables.rows("LINK PROPERTY ASSIGNMENTS"))
    rows = by_name(tables.rows(f"{dialect.LINKS} 01 - GENERAL"), "Link")
    general, idle = in_use(rows, placed)
    building.account.left_out(dialect.LINKS, "which nothing has", idle)
    dofs: dict[str, dict[str, LinkDof]] = {name: {} for name in general}
    for row in tables.starting(dialect.LINKS):
        if not row.has("DOF") or row.text("Link") in idle:
            row.looked_at.clear()
            continue
        name, dof = known(row, "Link", row.text("Link"), general), row.text("DOF").upper()
        if dof not in LINK_DOFS:
            msg = f'DOF = "{dof}" must be one of {", ".join(LINK_DOFS)}'
            raise row.error(msg)
        dofs[name].setdefault(dof, _link_dof(row, building.units, turns=dof.startswith("R")))
    for name, row in general.items():
        given = values(row, dialect.LINK, building.units)
        building.link_properties[name] = LinkProperty(name, dofs=dofs[name], **given)
    building.account.read(dialect.LINKS, "link properties in use", len(general))


def _link_dof(row: Row, units: Units, *, turns: bool) -> LinkDof:
    return LinkDof(
        nonlinear=row.yes("NonLinear", default=False),
        values=values(row, dialect.NONLINEAR[turns], units, only_given=True),
        **values(row, dialect.LINEAR[turns], units),
    )


def read_loads(tables: Tables, building: Building) -> None:
    """Read patterns, loads, masses and combinations into a building."""
    for name, row in by_name(tables.rows(dialect.PATTERNS), "LoadPat").items():
        building.patterns[name] = Pattern(name, **values(row, dialect.PATTERN, building.units))
    account = building.account
    account.read(dialect.PATTERNS, "load patterns", len(building.patterns))
    for row in tables.rows("JOINT LOADS - FORCE"):
        joint = known(row, "Joint", row.text("Joint"), building.joints)
        _require_global(row, f'load of joint "{joint}"')
        forces = tuple(values(row, dialect.FORCES, building.units).values())
        building.joint_loads.append(JointLoad(joint, _pattern(row, building), forces))
    account.read("JOINT LOADS - FORCE", "loads on joints", len(building.joint_loads))
    for table in ("FRAME LOADS - DISTRIBUTED", "FRAME LOADS - POINT"):
        before = len(building.line_loads)
        for row in tables.rows(table):
            _add_frame_load(row, building, point=table.endswith("POINT"))
        account.read(table, "loads on frames", len(building.line_loads) - before)
    for table, field in (("FRAME LOADS - GRAVITY", "Frame"), ("AREA LOADS - GRAVITY", "Area")):
        for row in tables.rows(table):
            _add_gravity(row, building, field)
        account.read(table, "multiples of own weight", len(tables.rows(table)))
    before = len(building.area_loads)
    for table in ("AREA LOADS - UNIFORM", "AREA LOADS - UNIFORM TO FRAME"):
        for row in tables.rows(table):
            area = known(row, "Area", row.text("Area"), building.areas)
            size, pattern = row.number("UnifLoad"), _pattern(row, building)
            add_area_load(row, building, area, pattern, row.text("Dir"), size)
    account.read("AREA LOADS", "uniform loads", len(building.area_loads) - before)
    _read_source(tables, building)
    cases = cases_of(
        building,
        (
            (row.text("Case"), row.text("LoadName", ""), row.number("LoadSF", 1.0))
            for row in tables.rows("CASE - STATIC 1 - LOAD ASSIGNMENTS")
        ),
    )
    combinations = tables.rows("COMBINATION DEFINITIONS")
    parts = [
        (row.text("ComboName"), _linear_case(row), row.number("ScaleFactor", 1.0))
        for row in combinations
    ]
    add_combinations(building, "COMBINATION DEFINITIONS", cases, parts)


def _linear_case(row: Row) -> str | None:
    is_sum = row.text("ComboType", "Linear Add").lower() == "linear add"
    return row.text("CaseName", "") if is_sum else None


def _pattern(row: Row, building: Building) -> str:
    field = "LoadPat" if row.has("LoadPat") else "LoadCase"
    return known(row, field, row.text(field), building.patterns)


def _require_global(row: Row, what: str) -> None:
    # Local axes of joints are the global ones: others are refused by their own table.
    if row.text("CoordSys", "GLOBAL").upper() not in {"GLOBAL", "LOCAL"}:
        msg = f"{what} must be given in GLOBAL axes"
        raise row.error(msg)


def _add_frame_load(row: Row, building: Building, *, point: bool) -> None:
    frame = known(row, "Frame", row.text("Frame"), building.frames)
    pattern, word = _pattern(row, building), row.text("Dir")
    if refused(row, frame, building.account, dialect.LOAD_WORDS):
        return
    sizes = [row.number("Force")] * 2 if point else [row.number(f"FOverL{m}") for m in "AB"]
    a, b = (_at(row, building, frame, mark) for mark in (("", "") if point else "AB"))
    add_line_load(row, building, frame, pattern, word, sizes, (a, b), point=point)


def _at(row: Row, building: Building, frame: str, mark: str) -> float:
    # Distance from joint i as a share of the length.
    if not row.text("DistType", "RelDist").lower().startswith("abs"):
        return row.number(f"RelDist{mark}")
    given = building.frames[frame]
    first, last = (np.array(building.joints[n].position) for n in (given.i, given.j))
    length = float(np.linalg.norm(last - first))
    return row.number(f"AbsDist{mark}") * building.units.length / length


def _add_gravity(row: Row, building: Building, field: str) -> None:
    # Multiples of own weight, along global axes: MultiplierZ = -1 is own weight, downwards.
    name = known(row, field, row.text(field), getattr(building, f"{field.lower()}s"))
    factors = np.array([row.number(f"Multiplier{axis}", 0.0) for axis in "XYZ"])
    pattern = _pattern(row, building)
    if field == "Frame":
        load = vector_of(factors * frame_weight(building, name))
        building.line_loads.append(LineLoad(name, pattern, 0.0, 1.0, load, load))
    else:
        load = vector_of(factors * area_weight(building, name))
        building.area_loads.append(AreaLoad(name, pattern, load))


def _read_source(tables: Tables, building: Building) -> None:
    rows = tables.rows("MASS SOURCE")
    if rows:
        first = next((r for r in rows if r.yes("IsDefault", default=False)), rows[0])
        name = first.text("MassSource", "")
        own = [r for r in rows if r.text("MassSource", "") == name]
        elements = any(r.yes("Elements", default=False) for r in own)
        added = any(r.yes("Masses", default=False) for r in own)
        loads = {_pattern(r, building): r.number("Multiplier") for r in own if r.has("LoadPat")}
        counted = loads if any(r.yes("Loads", default=True) for r in own) else {}
        building.mass_source = MassSource(elements, added, counted)
        others = sorted({r.text("MassSource", "") for r in rows} - {name})
        building.account.left_out("MASS SOURCE", "mass sources besides the default", others)
    old = tables.rows("MASSES 1 - MASS SOURCE")
    if old and building.mass_source is None:
        words = {r.text("MassFrom", "Elements").lower() for r in old}
        elements = any("element" in word for word in words)
        loads = {
            _pattern(r, building): r.number("Multiplier")
            for r in old
            if r.has("LoadPat") or r.has("LoadCase")
        }
        building.mass_source = MassSource(elements, elements, loads)
    building.account.read("MASS SOURCE", "mass source", int(building.mass_source is not None))
