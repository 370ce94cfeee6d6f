"""Stories, materials and sections of an ETABS text file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.exchange import etabs_fields as dialect
from frames.exchange.building import AreaSection, Building, FrameSection, Modifiers
from frames.exchange.fields import Units, refused, values
from frames.exchange.properties import (
    by_constants,
    material_of,
    shell_factors,
)
from frames.exchange.section_shapes import (
    FILLED,
    Shape,
    filled_section,
    section_by_shape,
    with_constants,
)
from frames.exchange.tables import known, merged
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.exchange.tables import Row, Tables
    from frames.model.sections import Section


def read_stories(tables: Tables, building: Building) -> None:
    """Read the stories, which stand from the top; elevations are counted from the lowest."""
    towers = tables.rows("TOWER")
    if len({row.text("Name", "") for row in towers}) > 1:
        message = "models of several towers are not read: export them one by one"
        raise towers[1].error(message)
    rows = tables.needed("STORY", "an ETABS model has stories")
    one = building.units.length
    base = rows[-1]
    elevation = one * base.number("ELEV", 0.0)
    building.stories.append((base.text("Story"), elevation))
    for row in reversed(rows[:-1]):
        height = one * row.number("HEIGHT")
        if height <= 0.0:
            msg = f'HEIGHT of story "{row.text("Story")}" must be positive'
            raise row.error(msg)
        elevation += height
        building.stories.append((row.text("Story"), elevation))
    names = [name for name, _ in building.stories]
    if len(set(names)) < len(names):
        msg = "two stories have one name: rename one of them"
        raise base.error(msg)
    building.account.read("STORIES", "stories", len(names))


def read_properties(
    tables: Tables,
    building: Building,
    constants: Mapping[str, Section] | None = None,
    library: Mapping[str, Shape] | None = None,
) -> None:
    """Read materials, and the sections that objects have."""
    account = building.account
    frames = {row.text("SECTION", "") for row in tables.rows("LINEASSIGN")}
    areas = {row.text("SECTION", "") for row in tables.rows("AREAASSIGN")}
    given = merged(tables.rows("FRAMESECTION"), "Section")
    shells = merged(tables.rows("SHELLPROP"), "Section")
    used = {row.text("MATERIALOVERWRITE", "") for row in tables.rows("LINEASSIGN")}
    for sections, names in ((given, frames), (shells, areas)):
        rows = [row for (name,), row in sections.items() if name in names]
        used |= {row.text(f"{word}MATERIAL", "") for row in rows for word in ("", "FILL", "CONC")}
    for (name,), row in merged(tables.rows("MATERIAL"), "Material").items():
        if name in used and (row.has("E") or row.has("E1")):
            found = material_of(row, name, dialect.MATERIAL, building.units)
            density = found.density or found.weight / STANDARD_GRAVITY
            building.materials[name] = replace(found, density=density)
    account.read("MATERIAL PROPERTIES", "materials in use", len(building.materials))
    constants, named = constants or {}, []
    wrong = [name for name in constants if (name,) not in given or name not in frames]
    if wrong:
        message = f'sections: no frame of {account.file} has a section "{wrong[0]}"'
        raise ModelError(message)
    for (name,), row in given.items():
        if name in frames:
            kept = _named(row, constants.get(name), library)
            named += [name] if isinstance(kept, Shape) else []
            building.sections[name] = _section(row, name, building, kept)
    if library and not named:
        message = f"library: no frame of {account.file} has a section that it names"
        raise ModelError(message)
    account.read_as("FRAME SECTIONS", "with the constants of the library", named)
    filled = [s.name for s in building.sections.values() if s.shape.strip().lower() in FILLED]
    what = "filled tubes, as sections of steel by moduli, with the weight of both materials"
    account.read_as("FRAME SECTIONS", what, [n for n in filled if n not in constants])
    account.read_as("FRAME SECTIONS", "with the constants given", list(constants))
    account.read("FRAME SECTIONS", "cross-sections in use", len(building.sections))
    idle = [name for (name,) in given if name not in frames]
    account.left_out("FRAME SECTIONS", "which nothing has", idle)
    for (name,), row in shells.items():
        if name in areas:
            building.area_sections[name] = _shell(row, name, building)
    account.read("SHELLPROP", "sections of areas in use", len(building.area_sections))


def _named(
    row: Row, constants: Section | None, library: Mapping[str, Shape] | None
) -> Section | Shape | None:
    # Constants from elsewhere: those given, and of what the file only names, of the library.
    if constants is not None or row.has("AREA", "I33", "I22"):
        return constants
    return (library or {}).get(row.text("SHAPE", "").strip().upper())


def _section(row: Row, name: str, building: Building, kept: Section | Shape | None) -> FrameSection:
    units, of = building.units, f' of section "{name}"'
    material, shape = values(row, dialect.SECTION[:2], units).values()
    known(row, "MATERIAL", material, building.materials, of)
    sizes = tuple(values(row, dialect.SIZES, units).values())
    modifiers = Modifiers(**values(row, dialect.MODIFIERS, units))
    if isinstance(kept, Shape):
        found = by_constants(kept.row, name, dialect.SECTION, Units(1.0, kept.length))
        found = replace(found, material=material, shape=shape)
    elif kept is not None:
        found = with_constants(name, material, shape, kept)
    elif row.has("AREA", "I33", "I22"):
        found = by_constants(row, name, dialect.SECTION, units)
    elif shape.strip().lower() in FILLED:
        fill = known(row, "FILLMATERIAL", row.text("FILLMATERIAL", ""), building.materials, of)
        steel, inside = building.materials[material], building.materials[fill]
        found = filled_section(row, name, sizes, steel, inside)
    else:
        poisson = building.materials[material].poisson_ratio
        found = section_by_shape(row, name, material, shape, sizes, poisson)
    return replace(found, modifiers=found.modifiers.times(modifiers))


def _shell(row: Row, name: str, building: Building) -> AreaSection:
    units, of = building.units, f' of section "{name}"'
    refused(row, name, building.account, dialect.SHELL_WORDS)
    kind = row.text("MODELINGTYPE", row.text("TYPE", "ShellThin")).lower()
    deck = row.text("PROPTYPE", "").lower() == "deck"
    word = "CONCMATERIAL" if deck else "MATERIAL"
    material = known(row, word, row.text(word, ""), building.materials, of)
    bending = extra_weight = 0.0
    if deck:
        slab, depth, top, spacing, bottom, extra_weight = values(row, dialect.DECK, units).values()
        thickness = slab + (depth * 0.5 * (top + bottom) / spacing if spacing else 0.0)
    else:
        given = values(row, dialect.THICKNESS, units, only_given=True)
        if not given:
            words = ", ".join(dialect.THICKNESS[0].names.split("|"))
            msg = f'section "{name}" has no thickness: {words}'
            raise row.error(msg)
        thickness, bending = given["thickness"], row.number("TB", 0.0) * units.length
    if thickness <= 0.0:
        msg = f'the thickness of section "{name}" must be positive'
        raise row.error(msg)
    return AreaSection(
        name=name,
        material=material,
        kind="membrane" if deck else next((k for k in ("membrane", "plate") if k in kind), "shell"),
        thickness=thickness,
        bending_thickness=bending or thickness,
        one_way=deck or row.yes("ONEWAYLOADDIST", default=False),
        extra_weight=extra_weight,
        **shell_factors(row, dialect.SHELL, building),
    )
