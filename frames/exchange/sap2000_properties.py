"""Materials, sections and link properties of SAP2000's tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.exchange.building import (
    LINK_DOFS,
    AreaSection,
    Building,
    FrameSection,
    LinkDof,
    LinkProperty,
    Material,
    Modifiers,
)
from frames.exchange.section_shapes import section_by_shape
from frames.exchange.tables import by_name
from frames.exchange.units import link_scales

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.exchange.tables import Row, Tables

MATERIALS = "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"
SECTIONS = "FRAME SECTION PROPERTIES 01 - GENERAL"
AREA_SECTIONS = "AREA SECTION PROPERTIES"
LINKS = "LINK PROPERTY DEFINITIONS"

LINK_VALUES = {
    "TransK": "stiffness",
    "RotK": "stiffness",
    "TransYield": "yield",
    "RotYield": "yield",
    "Ratio": "ratio",
    "YieldExp": "exponent",
    "Slow": "slow",
    "Fast": "fast",
    "Rate": "rate",
    "Radius": "radius",
    "DJ": "place",
    "TransOpen": "open",
    "RotOpen": "open",
    "TransC": "damping",
    "CExp": "damping_exponent",
}
"""Nonlinear numbers of a link's deformation by their field."""


def read_properties(tables: Tables, building: Building) -> None:
    """Read materials, sections and link properties into a building."""
    frames, areas = (
        tables.rows("FRAME SECTION ASSIGNMENTS"),
        tables.rows("AREA SECTION ASSIGNMENTS"),
    )
    sections, idle = in_use(by_name(tables.rows(SECTIONS), "SectionName"), map(section_of, frames))
    building.account.left_out(SECTIONS, "which nothing has", idle)
    kinds = (row.text("Section", "") for row in areas)
    shells, idle = in_use(by_name(tables.rows(AREA_SECTIONS), "Section"), kinds)
    building.account.left_out(AREA_SECTIONS, "which nothing has", idle)
    used = {row.text("Material", "") for row in (*sections.values(), *shells.values())}
    used |= {row.text("MatProp", "") for row in frames}
    rows, idle = in_use(by_name(tables.rows(MATERIALS), "Material"), used)
    building.account.left_out(MATERIALS, "which nothing has", idle)
    heads = by_name(tables.rows("MATERIAL PROPERTIES 01 - GENERAL"), "Material")
    for name, row in rows.items():
        building.materials[name] = _material(row, name, building, heads.get(name, row))
    building.account.read(MATERIALS, "materials in use", len(rows))
    for name, row in sections.items():
        building.sections[name] = _section(row, name, building)
    building.account.read(SECTIONS, "cross-sections in use", len(building.sections))
    for name, row in shells.items():
        building.area_sections[name] = _area_section(row, name, building)
    building.account.read(AREA_SECTIONS, "sections of areas in use", len(building.area_sections))
    _read_links(tables, building)


def in_use(rows: dict[str, Row], names: Iterable[str]) -> tuple[dict[str, Row], list[str]]:
    """Return the rows that some name refers to, and the names of the others."""
    wanted = set(names)
    return {k: r for k, r in rows.items() if k in wanted}, [k for k in rows if k not in wanted]


def section_of(row: Row) -> str:
    """Return the section of a row of assignments to frames."""
    return row.text("AnalSect", row.text("Section", "None"))


def known(row: Row, field: str, name: str, names: dict[str, object] | object) -> str:
    """Return a name that a row refers to, or raise where nothing has it."""
    if isinstance(names, dict) and name not in names:
        some = ", ".join(list(names)[:6]) or "none"
        msg = f'{field} "{name}" is not defined: there are {some}'
        raise row.error(msg)
    return name


def _material(row: Row, name: str, building: Building, head: Row) -> Material:
    # Mass and weight stand in either table of materials.
    units = building.units
    modulus = row.number("E1") * units.stress
    poisson = row.number("U12", 0.0)
    if modulus <= 0.0:
        msg = f'E1 = {row.number("E1"):g} of material "{name}" must be positive'
        raise row.error(msg)
    if not -1.0 < poisson <= 0.5:
        msg = f'U12 = {poisson:g} of material "{name}" must lie in (-1, 0.5]'
        raise row.error(msg)
    shear = row.number("G12", 0.0) * units.stress or 0.5 * modulus / (1.0 + poisson)
    return Material(
        name,
        modulus,
        shear,
        poisson,
        row.number("UnitMass", head.number("UnitMass", 0.0)) * units.density,
        row.number("UnitWeight", head.number("UnitWeight", 0.0)) * units.weight,
    )


def _section(row: Row, name: str, building: Building) -> FrameSection:
    shape = row.text("Shape", "General")
    material = row.text("Material", "")
    one = building.units.length
    sizes = (
        row.number("t3", 0.0) * one,
        row.number("t2", 0.0) * one,
        row.number("tf", 0.0) * one,
        row.number("tw", 0.0) * one,
    )
    if "nonprismatic" in shape.lower():
        place = row.place
        what = "a nonprismatic section"
        building.account.refuse("nonprismatic sections", SECTIONS, what, [name], place)
    if not row.has("Area", "I33", "I22"):
        known(row, "Material", material, building.materials)
        poisson = building.materials[material].poisson_ratio
        return section_by_shape(row, name, material, shape, sizes, poisson)
    if abs(row.number("I23", 0.0)) > 1e-6 * max(row.number("I33"), row.number("I22")):
        what = "the product of inertia I23 of a section, whose axes 2 and 3 are not principal ones"
        building.account.refuse("I23", SECTIONS, what, [name], row.place)
    inertia_33 = row.number("I33") * one**4
    inertia_22 = row.number("I22") * one**4
    return FrameSection(
        name=name,
        material=material,
        shape=shape,
        area=row.number("Area") * one**2,
        torsion=row.number("TorsConst", 0.0) * one**4,
        inertia_33=inertia_33,
        inertia_22=inertia_22,
        shear_2=row.number("AS2", 0.0) * one**2 or math.inf,
        shear_3=row.number("AS3", 0.0) * one**2 or math.inf,
        depth=sizes[0],
        width=sizes[1] or sizes[0],
        modifiers=section_modifiers(row),
    )


def section_modifiers(row: Row) -> Modifiers:
    """Return the factors of a row of sections or of assignments, 1 where it has none."""
    fields = (
        ("AMod",),
        ("A2Mod", "AS2Mod"),
        ("A3Mod", "AS3Mod"),
        ("JMod",),
        ("I2Mod", "I22Mod"),
        ("I3Mod", "I33Mod"),
        ("MMod", "MassMod"),
        ("WMod", "WeightMod"),
    )
    values = []
    for names in fields:
        given = [row.number(name) for name in names if row.has(name)]
        if given and given[0] < 0.0:
            msg = f"{names[0]} = {given[0]:g} must be 0 or greater"
            raise row.error(msg)
        values.append(given[0] if given else 1.0)
    return Modifiers(*values)


def _area_section(row: Row, name: str, building: Building) -> AreaSection:
    kind = f"{row.text('AreaType', 'Shell')} {row.text('Type', 'Shell-Thin')}".lower()
    thickness = row.number("Thickness", 0.0) * building.units.length
    if "layered" in kind or "nonlinear" in kind:
        what = "a layered shell, taken as a linear one of its thickness"
        building.account.refuse("layered shells", AREA_SECTIONS, what, [name], row.place)
    if not kind.startswith("shell"):
        what = f'an area of type "{row.text("AreaType")}", of which loads alone are read'
        building.account.refuse("plane and solid areas", AREA_SECTIONS, what, [name], row.place)
        return AreaSection(name, "", "none", 0.0, 0.0)
    words = ("membrane", "plate")
    found = next((word for word in words if word in kind.removeprefix("shell ")), "shell")
    material = row.text("Material")
    known(row, "Material", material, building.materials)
    if thickness <= 0.0:
        msg = f'Thickness of area section "{name}" must be positive'
        raise row.error(msg)
    in_plane, bending = shell_factors(row, building)
    return AreaSection(
        name=name,
        material=material,
        kind=found,
        thickness=thickness,
        bending_thickness=row.number("BendThick", 0.0) * building.units.length or thickness,
        in_plane=in_plane,
        bending=bending,
        mass=row.number("MMod", 1.0),
        weight=row.number("WMod", 1.0),
    )


def shell_factors(row: Row, building: Building) -> tuple[float, float]:
    """Return the factors on in-plane and bending stiffness of a shell [-]."""
    found = []
    for letter in "FM":
        names = [(f"{letter}{d}Mod", f"{letter.lower()}{d}") for d in ("11", "22", "12")]
        values = [row.number(a, row.number(b, 1.0)) for a, b in names]
        if min(values) < 0.0:
            msg = f"a stiffness modifier {min(values):g} must be 0 or greater"
            raise row.error(msg)
        if max(values) - min(values) > 1e-9:
            what = "stiffness modifiers of an area that differ by direction, taken by their mean"
            place = row.place
            building.account.refuse(
                "directional area modifiers", row.table, what, [names[0][0]], place
            )
        found.append(sum(values) / 3.0)
    return found[0], found[1]


def _read_links(tables: Tables, building: Building) -> None:
    placed = (row.text("LinkProp", "") for row in tables.rows("LINK PROPERTY ASSIGNMENTS"))
    general, idle = in_use(by_name(tables.rows(f"{LINKS} 01 - GENERAL"), "Link"), placed)
    building.account.left_out(LINKS, "which nothing has", idle)
    dofs: dict[str, dict[str, LinkDof]] = {name: {} for name in general}
    for row in tables.starting(LINKS):
        if not row.has("DOF") or row.text("Link") in idle:
            row.looked_at.clear()
            continue
        name, dof = known(row, "Link", row.text("Link"), general), row.text("DOF").upper()
        if dof not in LINK_DOFS:
            msg = f'DOF = "{dof}" must be one of {", ".join(LINK_DOFS)}'
            raise row.error(msg)
        dofs[name].setdefault(dof, _link_dof(row, building, turns=dof.startswith("R")))
    for name, row in general.items():
        building.link_properties[name] = LinkProperty(
            name,
            row.text("LinkType", ""),
            dofs[name],
            row.number("Mass", 0.0) * building.units.mass,
            row.number("Weight", 0.0) * building.units.force,
        )
    building.account.read(LINKS, "link properties in use", len(general))


def _link_dof(row: Row, building: Building, *, turns: bool) -> LinkDof:
    units = building.units
    prefix = "Rot" if turns else "Trans"
    scales = link_scales(units, turns=turns)
    factor = scales["stiffness"]
    values = {
        word: row.number(field) * scales.get(word, 1.0)
        for field, word in LINK_VALUES.items()
        if row.has(field)
    }
    return LinkDof(
        fixed=row.yes("Fixed", default=False),
        stiffness=row.number(f"{prefix}KE", 0.0) * factor,
        damping=row.number(f"{prefix}CE", 0.0) * factor,
        nonlinear=row.yes("NonLinear", default=False),
        values=values,
    )
