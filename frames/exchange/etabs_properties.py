"""Stories, materials and sections of an ETABS text file."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.exchange.building import AreaSection, Building, FrameSection, Material, Modifiers
from frames.exchange.filled_sections import SHAPES, filled_section
from frames.exchange.section_library import Shape
from frames.exchange.section_shapes import section_by_shape, with_constants
from frames.exchange.tables import Row
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.exchange.tables import Tables, Value
    from frames.model.sections import Section

SECTION_FACTORS = ("AMOD", "A2MOD", "A3MOD", "JMOD", "I2MOD", "I3MOD", "MMOD", "WMOD")
OBJECT_FACTORS = (
    "PROPMODA",
    "PROPMODA2",
    "PROPMODA3",
    "PROPMODT",
    "PROPMODI22",
    "PROPMODI33",
    "PROPMODM",
    "PROPMODW",
)


def merged(rows: Sequence[Row], *fields: str) -> dict[tuple[str, ...], Row]:
    """Return one row for each object: its lines add up, a value that comes again replaces."""
    found: dict[tuple[str, ...], Row] = {}
    for row in rows:
        key = tuple(row.text(field) for field in fields)
        if key in found:
            found[key].values |= row.values
        else:
            values: dict[str, Value] = dict(row.values)
            found[key] = Row(row.file, row.table, row.line, values, row.decimal)
        row.looked_at = found[key].looked_at
    return found


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
            building.materials[name] = _material(row, name, building)
    building.account.read("MATERIAL PROPERTIES", "materials in use", len(building.materials))
    constants, named = constants or {}, []
    wrong = [name for name in constants if (name,) not in given or name not in frames]
    if wrong:
        message = f'sections: no frame of {building.account.file} has a section "{wrong[0]}"'
        raise ModelError(message)
    for (name,), row in given.items():
        if name in frames:
            kept = _named(row, constants.get(name), library)
            named += [name] if isinstance(kept, Shape) else []
            building.sections[name] = _section(row, name, building, kept)
    if library and not named:
        message = f"library: no frame of {building.account.file} has a section that it names"
        raise ModelError(message)
    building.account.read_as("FRAME SECTIONS", "with the constants of the library", named)
    filled = [s.name for s in building.sections.values() if s.shape.strip().lower() in SHAPES]
    what = "filled tubes, as sections of steel by moduli, with the weight of both materials"
    building.account.read_as("FRAME SECTIONS", what, [n for n in filled if n not in constants])
    building.account.read_as("FRAME SECTIONS", "with the constants given", list(constants))
    building.account.read("FRAME SECTIONS", "cross-sections in use", len(building.sections))
    idle = [name for (name,) in given if name not in frames]
    building.account.left_out("FRAME SECTIONS", "which nothing has", idle)
    for (name,), row in shells.items():
        if name in areas:
            building.area_sections[name] = _shell(row, name, building)
    building.account.read("SHELLPROP", "sections of areas in use", len(building.area_sections))


def factors(row: Row, names: Sequence[str]) -> Modifiers:
    """Return the factors of a line, 1 where it has none."""
    values = [row.number(name, 1.0) for name in names]
    if min(values) < 0.0:
        msg = f"a modifier {min(values):g} must be 0 or greater"
        raise row.error(msg)
    return Modifiers(*values)


def _material(row: Row, name: str, building: Building) -> Material:
    units = building.units
    modulus = row.number("E", row.number("E1", 0.0)) * units.stress
    poisson = row.number("U", row.number("U1", 0.0))
    if modulus <= 0.0 or not -1.0 < poisson <= 0.5:
        msg = f'material "{name}" needs E > 0 and U in (-1, 0.5]'
        raise row.error(msg)
    weight = row.number("WEIGHTPERVOLUME", 0.0) * units.weight
    density = row.number("MASSPERVOLUME", 0.0) * units.density or weight / STANDARD_GRAVITY
    return Material(name, modulus, 0.5 * modulus / (1.0 + poisson), poisson, density, weight)


def _named(
    row: Row, constants: Section | None, library: Mapping[str, Shape] | None
) -> Section | Shape | None:
    # Constants from elsewhere: those given, and of what the file only names, of the library.
    if constants is not None or row.has("AREA", "I33", "I22"):
        return constants
    return (library or {}).get(row.text("SHAPE", "").strip().upper())


def _section(row: Row, name: str, building: Building, kept: Section | Shape | None) -> FrameSection:
    one = building.units.length
    material, shape = row.text("MATERIAL", ""), row.text("SHAPE", "General")
    if material not in building.materials:
        msg = f'MATERIAL "{material}" of section "{name}" is not defined'
        raise row.error(msg)
    sizes = (
        row.number("D", 0.0) * one,
        row.number("B", 0.0) * one,
        row.number("TF", 0.0) * one,
        row.number("TW", row.number("TF", 0.0)) * one,
    )
    modifiers = factors(row, SECTION_FACTORS)
    if isinstance(kept, Shape):
        return _by_constants(kept.row, kept.length, name, material, shape, modifiers)
    if kept is not None:
        return replace(with_constants(name, material, shape, kept), modifiers=modifiers)
    if row.has("AREA", "I33", "I22"):
        return _by_constants(row, one, name, material, shape, modifiers)
    if shape.strip().lower() in SHAPES:
        fill = row.text("FILLMATERIAL", "")
        if fill not in building.materials:
            msg = f'FILLMATERIAL "{fill}" of section "{name}" is not defined'
            raise row.error(msg)
        steel, inside = building.materials[material], building.materials[fill]
        found = filled_section(row, name, sizes, steel, inside)
        return replace(found, modifiers=found.modifiers.times(modifiers))
    poisson = building.materials[material].poisson_ratio
    found = section_by_shape(row, name, material, shape, sizes, poisson)
    return replace(found, modifiers=modifiers)


def _by_constants(
    row: Row, one: float, name: str, material: str, shape: str, modifiers: Modifiers
) -> FrameSection:
    depth = row.number("D", 0.0) * one
    return FrameSection(
        name=name,
        material=material,
        shape=shape,
        area=row.number("AREA") * one**2,
        torsion=row.number("TORSION", 0.0) * one**4,
        inertia_33=row.number("I33") * one**4,
        inertia_22=row.number("I22") * one**4,
        shear_2=row.number("AS2", 0.0) * one**2 or math.inf,
        shear_3=row.number("AS3", 0.0) * one**2 or math.inf,
        depth=depth,
        width=row.number("B", 0.0) * one or depth,
        modifiers=modifiers,
    )


def _shell(row: Row, name: str, building: Building) -> AreaSection:
    units = building.units
    kind = row.text("MODELINGTYPE", row.text("TYPE", "ShellThin")).lower()
    if "layered" in kind:
        what = "a layered shell, taken as a linear one of its thickness"
        building.account.refuse("layered shells", row.table, what, [name], row.place)
    shape = row.text("SLABTYPE", "Slab").lower()
    if shape in {"ribbed", "waffle"}:
        what = "a ribbed or waffle slab, taken as a flat one of its slab's thickness"
        building.account.refuse("ribbed slabs", row.table, what, [name], row.place)
    deck = row.text("PROPTYPE", "").lower() == "deck"
    material = row.text("CONCMATERIAL" if deck else "MATERIAL", "")
    if material not in building.materials:
        msg = f'MATERIAL "{material}" of section "{name}" is not defined'
        raise row.error(msg)
    bending = 0.0
    if deck:
        top = row.number("DECKRIBWIDTHTOP", 0.0)
        ribs = 0.5 * (top + row.number("DECKRIBWIDTHBOTTOM", top))
        spacing = row.number("DECKRIBSPACING", 0.0)
        filled = row.number("DECKRIBDEPTH", 0.0) * ribs / spacing if spacing else 0.0
        thickness = row.number("DECKSLABDEPTH") + filled
    else:
        fields = ("SLABTHICKNESS", "WALLTHICKNESS", "OVERALLDEPTH", "TM")
        given = [row.number(field) for field in fields if row.has(field)]
        if not given:
            msg = f'section "{name}" has no thickness: {", ".join(fields)}'
            raise row.error(msg)
        thickness, bending = given[0], row.number("TB", 0.0)
    if thickness <= 0.0:
        msg = f'the thickness of section "{name}" must be positive'
        raise row.error(msg)
    in_plane, plate = shell_factors(row, "{}{}MOD", building)
    return AreaSection(
        name=name,
        material=material,
        kind="membrane" if deck else next((k for k in ("membrane", "plate") if k in kind), "shell"),
        thickness=thickness * units.length,
        bending_thickness=(bending or thickness) * units.length,
        in_plane=in_plane,
        bending=plate,
        mass=row.number("MMOD", 1.0),
        weight=row.number("WMOD", 1.0),
        one_way=deck or row.text("ONEWAYLOADDIST", "No").lower() == "yes",
        extra_weight=row.number("DECKUNITWEIGHT", 0.0) * units.stress if deck else 0.0,
    )


def shell_factors(row: Row, pattern: str, building: Building) -> tuple[float, float]:
    """Return the factors on in-plane and bending stiffness of a shell [-]."""
    found = []
    for letter in "FM":
        values = [row.number(pattern.format(letter, d), 1.0) for d in ("11", "22", "12")]
        if min(values) < 0.0:
            msg = f"a modifier {min(values):g} must be 0 or greater"
            raise row.error(msg)
        if max(values) - min(values) > 1e-9:
            what = "stiffness modifiers of an area that differ by direction, taken by their mean"
            key, name = "directional area modifiers", pattern.format(letter, "11")
            building.account.refuse(key, row.table, what, [name], row.place)
        found.append(sum(values) / 3.0)
    return found[0], found[1]


class StoryIndex:
    """Stories by name, and the joints that points make at them.

    Parameters
    ----------
    building : Building
        With its stories.
    """

    def __init__(self, building: Building) -> None:
        self.names = [name for name, _ in building.stories]
        self.elevations = [z for _, z in building.stories]

    def below(self, row: Row, story: str, count: int) -> str:
        """Return the story that is a number of stories below another, or raise."""
        if story not in self.names:
            some = ", ".join(self.names)
            msg = f'story "{story}" is not defined: there are {some}'
            raise row.error(msg)
        place = self.names.index(story) - count
        if count < 0 or place < 0:
            message = f'{count} stories below "{story}" there is none'
            raise row.error(message)
        return self.names[place]

    def elevation(self, story: str) -> float:
        """Return the elevation of a story [m]."""
        return self.elevations[self.names.index(story)]
