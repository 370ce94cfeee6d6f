"""Reads a SAP2000 model: its text tables (.s2k, .$2k) or the workbook with the same tables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from frames._csv import BOOKS
from frames.exchange import sap2000_fields as dialect
from frames.exchange.building import (
    LINK_DOFS,
    NO_SECTION,
    NO_SHELL,
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
from frames.exchange.fields import refused, values
from frames.exchange.import_report import ImportReport, Options, judge_rest
from frames.exchange.loads import (
    add_area_load,
    add_combinations,
    add_line_load,
    add_mass_source,
    area_weight,
    cases_of,
    default_source,
    frame_weight,
    mass_shares,
    vector_of,
)
from frames.exchange.properties import (
    by_constants,
    in_use,
    material_of,
    section_by_shape,
    shell_factors,
)
from frames.exchange.reading import read_excel, read_s2k
from frames.exchange.sap2000_objects import read_objects, section_of
from frames.exchange.tables import ACTIVE, Row, Tables, by_name, known, require_space, units_of


def read_sap2000(path: str | Path, options: Options | None = None) -> Building:
    """Read a SAP2000 model."""
    file, given = Path(path), options or Options()
    tables = read_excel(file) if file.suffix.lower() in BOOKS else read_s2k(file, given.decimal)
    account = ImportReport(file.name, given.allow)
    row = tables.needed("PROGRAM CONTROL", "it has the units; export it with the others")[0]
    units = units_of(row.text("CurrUnits"), "CurrUnits", row.error)
    building = Building(file.stem, "SAP2000", row.text("Version", ""), units, account)
    with account.together():
        for row in tables.rows("ACTIVE DEGREES OF FREEDOM"):
            with account.noting():
                require_space(row, {name for name in ACTIVE if row.yes(name)})
        read_properties(tables, building)
        read_objects(tables, building)
        read_loads(tables, building)
        words = dialect.REFUSED, dialect.KNOWN, dialect.OBJECTS, dialect.HARMLESS
        judge_rest(tables, account, *words)
    return building


def read_properties(tables: Tables, building: Building) -> None:
    """Read materials, sections and link properties into a building."""
    account = building.account
    frames = tables.rows("FRAME SECTION ASSIGNMENTS")
    areas = tables.rows("AREA SECTION ASSIGNMENTS")
    kinds = [row.text("Section", "") for row in areas]
    sections = _used(tables, building, dialect.SECTIONS, "SectionName", map(section_of, frames))
    shells = _used(tables, building, dialect.AREA_SECTIONS, "Section", kinds)
    used = {row.text("Material", "") for row in (*sections.values(), *shells.values())}
    used |= {row.text("MatProp", "") for row in frames}
    heads = by_name(tables.rows("MATERIAL PROPERTIES 01 - GENERAL"), "Material")
    for name, row in _used(tables, building, dialect.MATERIALS, "Material", used).items():
        for field in ("UnitMass", "UnitWeight"):  # which are in either table of materials
            if name in heads and heads[name].has(field) and not row.has(field):
                row.values[field] = heads[name].values[field]
        building.materials[name] = material_of(row, name, dialect.MATERIAL, building)
    account.read(dialect.MATERIALS, "materials in use", len(building.materials))
    for name, row in sections.items():
        building.sections[name] = NO_SECTION
        with account.noting():
            building.sections[name] = _section(row, name, building)
    account.read(dialect.SECTIONS, "cross-sections in use", len(building.sections))
    for name, row in shells.items():
        building.area_sections[name] = NO_SHELL
        with account.noting():
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
    account = building.account
    material, shape = values(row, dialect.SECTION[:2], building).values()
    modifiers = Modifiers(**values(row, dialect.MODIFIERS, building))
    own = row.has("Area", "I33", "I22")
    if not own and any(each.odd(row) for each in dialect.SECTION_WORDS):
        message = (
            f'section "{name}" is nonprismatic: divide its frame objects, and assign a '
            "prismatic section to each part"
        )
        raise row.error(message)
    refused(row, name, account, dialect.SECTION_WORDS)
    if not own:
        known(row, "Material", material, building.materials)
        poisson = building.materials[material].poisson_ratio
        sizes = tuple(values(row, dialect.SIZES, building).values())
        found = section_by_shape(row, name, material, shape, sizes, poisson)
    else:
        row.looked_at.update(dialect.OUTLINE)
        if abs(row.number("I23", 0.0)) > 1e-6 * max(row.number("I33"), row.number("I22")):
            what = (
                "the product of inertia I23 of a section, whose axes 2 and 3 are not principal ones"
            )
            account.refuse("I23", dialect.SECTIONS, what, [name], row.place)
        found = by_constants(row, name, dialect.SECTION, building)
    return replace(found, modifiers=modifiers)


def _area_section(row: Row, name: str, building: Building) -> AreaSection:
    kind = f"{row.text('AreaType', 'Shell')} {row.text('Type', 'Shell-Thin')}".lower()
    refused(row, name, building.account, dialect.LAYERED)
    if refused(row, name, building.account, dialect.NO_SHELL):
        return NO_SHELL
    words = ("membrane", "plate")
    found = next((word for word in words if word in kind.removeprefix("shell ")), "shell")
    material = known(row, "Material", row.text("Material"), building.materials)
    of = f' of area section "{name}"'
    thickness, bending = values(row, dialect.THICKNESS, building, of).values()
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
        dofs[name].setdefault(dof, _link_dof(row, building, turns=dof.startswith("R")))
    for name, row in general.items():
        given = values(row, dialect.LINK, building)
        building.link_properties[name] = LinkProperty(name, dofs=dofs[name], **given)
    building.account.read(dialect.LINKS, "link properties in use", len(general))


def _link_dof(row: Row, building: Building, *, turns: bool) -> LinkDof:
    return LinkDof(
        nonlinear=row.yes("NonLinear", default=False),
        values=values(row, dialect.NONLINEAR[turns], building, only_given=True),
        **values(row, dialect.LINEAR[turns], building),
    )


def read_loads(tables: Tables, building: Building) -> None:
    """Read patterns, loads, masses and combinations into a building."""
    for name, row in by_name(tables.rows(dialect.PATTERNS), "LoadPat").items():
        building.patterns[name] = Pattern(name, **values(row, dialect.PATTERN, building))
    account = building.account
    account.read(dialect.PATTERNS, "load patterns", len(building.patterns))
    for row in tables.rows("JOINT LOADS - FORCE"):
        with account.noting():
            joint, *forces, pattern = values(row, dialect.JOINT_LOAD, building).values()
            _require_global(row, f'load of joint "{joint}"')
            building.joint_loads.append(JointLoad(joint, pattern, tuple(forces)))
    account.read("JOINT LOADS - FORCE", "loads on joints", len(building.joint_loads))
    for table in ("FRAME LOADS - DISTRIBUTED", "FRAME LOADS - POINT"):
        before = len(building.line_loads)
        for row in tables.rows(table):
            with account.noting():
                _add_frame_load(row, building, point=table.endswith("POINT"))
        account.read(table, "loads on frames", len(building.line_loads) - before)
    for table in ("FRAME LOADS - GRAVITY", "AREA LOADS - GRAVITY"):
        for row in tables.rows(table):
            _add_gravity(row, building, on_area=table.startswith("AREA"))
        account.read(table, "multiples of own weight", len(tables.rows(table)))
    before = len(building.area_loads)
    for table in ("AREA LOADS - UNIFORM", "AREA LOADS - UNIFORM TO FRAME"):
        for row in tables.rows(table):
            with account.noting():
                add_area_load(row, building, **values(row, dialect.AREA_LOAD, building))
    account.read("AREA LOADS", "uniform loads", len(building.area_loads) - before)
    _read_source(tables, building)
    rows = tables.rows("CASE - STATIC 1 - LOAD ASSIGNMENTS")
    cases = cases_of(building, (tuple(values(r, dialect.CASE, building).values()) for r in rows))
    parts = []
    for row in tables.rows("COMBINATION DEFINITIONS"):
        name, case, factor = values(row, dialect.COMBINATION, building).values()
        is_sum = row.text("ComboType", "Linear Add").lower() == "linear add"
        parts.append((name, case if is_sum else None, factor))
    add_combinations(building, "COMBINATION DEFINITIONS", cases, parts)


def _require_global(row: Row, what: str) -> None:
    # Local axes of joints are the global ones: others are refused by their own table.
    if row.text("CoordSys", "GLOBAL").upper() not in {"GLOBAL", "LOCAL"}:
        msg = f"{what} must be given in GLOBAL axes"
        raise row.error(msg)


def _add_frame_load(row: Row, building: Building, *, point: bool) -> None:
    given = values(row, dialect.LINE_LOAD, building)
    if refused(row, given["frame"], building.account, dialect.LOAD_WORDS):
        return
    absolute = row.text("DistType", "RelDist").lower().startswith("abs")
    places = dialect.ABSOLUTE[point] if absolute else dialect.RELATIVE[point]
    given |= values(row, (dialect.POINT if point else dialect.SPREAD) + places, building)
    add_line_load(row, building, **given, point=point, absolute=absolute)


def _add_gravity(row: Row, building: Building, *, on_area: bool) -> None:
    # Multiples of own weight, along global axes: MultiplierZ = -1 is own weight, downwards.
    map_ = dialect.AREA_GRAVITY if on_area else dialect.FRAME_GRAVITY
    name, pattern, *factors = values(row, map_, building).values()
    weight = (area_weight if on_area else frame_weight)(building, name)
    load = vector_of(np.array(factors) * weight)
    if on_area:
        building.area_loads.append(AreaLoad(name, pattern, load))
    else:
        building.line_loads.append(LineLoad(name, pattern, 0.0, 1.0, load, load))


def _read_source(tables: Tables, building: Building) -> None:
    rows = [(row, values(row, dialect.MASS_SOURCE, building)) for row in tables.rows("MASS SOURCE")]
    sources: dict[str, dict[str, Any]] = {}
    for _, given in rows:  # any row may set it
        before = sources.setdefault(given["name"], given)
        sources[given["name"]] = {word: before[word] or given[word] for word in given}
    name = default_source(sources)
    shares = [row for row, given in rows if given["name"] == name and row.has("LoadPat")]
    add_mass_source(building, name, sources, shares, dialect.MASS_SHARE)
    old = tables.rows("MASSES 1 - MASS SOURCE")
    if old and building.mass_source is None:
        elements = any("element" in r.text("MassFrom", "Elements").lower() for r in old)
        shares = [r for r in old if r.has("LoadPat") or r.has("LoadCase")]
        loads = mass_shares(shares, dialect.MASS_SHARE, building)
        building.mass_source = MassSource(elements, elements, loads)
        building.account.read("MASS SOURCE", "mass source", 1)
