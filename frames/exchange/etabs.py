"""Reads an ETABS model: its text file (.e2k, .$et)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames._errors import ModelError
from frames.exchange import etabs_fields as dialect
from frames.exchange.building import (
    NO_SECTION,
    NO_SHELL,
    AreaSection,
    Building,
    FrameSection,
    JointLoad,
    Modifiers,
    Pattern,
)
from frames.exchange.etabs_links import EtabsLinks, read_groups
from frames.exchange.etabs_objects import Objects
from frames.exchange.fields import refused, values
from frames.exchange.import_report import ImportReport, Options, judge_rest
from frames.exchange.loads import (
    LevelAreas,
    add_area_load,
    add_combinations,
    add_line_load,
    add_mass_source,
    cases_of,
    default_source,
)
from frames.exchange.properties import (
    FILLED,
    Shape,
    by_constants,
    filled_section,
    material_of,
    read_libraries,
    section_by_shape,
    shell_factors,
    with_constants,
)
from frames.exchange.reading import TEXT, read_e2k
from frames.exchange.tables import Row, Tables, Units, known, merged, require_space, units_of
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.model.sections import Section


def read_etabs(path: str | Path, options: Options | None = None) -> Building:
    """Read an ETABS model."""
    file, given = Path(path), options or Options()
    tables = read_e2k(file, given.decimal)
    account = ImportReport(file.name, given.allow)
    program = tables.rows("PROGRAM")
    version = program[0].text("VERSION", "") if program else ""
    row = tables.needed("UNITS", "$ CONTROLS has the units; export it with the others")[0]
    units = units_of(f"{row.text('Force')}, {row.text('Length')}", "UNITS", row.error)
    building = Building(file.stem, "ETABS", version, units, account)
    with account.together():
        for row in tables.rows("ACTIVEDOF"):
            with account.noting():
                require_space(row, row.text("Name", "").upper().split())
        read_stories(tables, building)
        read_properties(tables, building, given.sections, read_libraries(given.library))
        objects = Objects(tables, building)
        objects.read()
        EtabsLinks(tables, building, objects).read()
        read_groups(tables, building)
        read_loads(tables, building, objects.bare)
        _refuse_stages(tables, account)
        judge_rest(tables, account, dialect.REFUSED, dialect.KNOWN, row_word="lines")
    return building


def _refuse_stages(tables: Tables, account: ImportReport) -> None:
    rows = tables.rows("LOADCASE")
    staged = [r for r in rows if r.has("STAGE") or "STAGED" in r.text("TYPE", "").upper()]
    if staged:
        key, what = next(each[1:] for each in dialect.REFUSED if each[0] == "STAGE")
        names = list(dict.fromkeys(row.text("Case") for row in staged))
        account.refuse(key, staged[0].table, what, names, staged[0].place)


def read_loads(tables: Tables, building: Building, bare: Mapping[str, tuple[str, str]]) -> None:
    """Read patterns, loads, mass source and combinations into a building.

    `bare` has the joints of lines without a section.
    """
    account = building.account
    rows = merged(tables.rows("LOADPATTERN"), "Pattern")
    old = merged([r for r in tables.rows("LOADCASE") if r.has("SELFWEIGHT")], "Case")
    for (name,), row in (rows or old).items():
        building.patterns[name] = Pattern(name, **values(row, dialect.PATTERN, building))
    account.read("LOAD PATTERNS", "load patterns", len(building.patterns))
    for row in tables.rows("POINTLOAD"):
        with account.noting():
            _add_point_load(row, building)
    account.read("POINT OBJECT LOADS", "loads on points", len(building.joint_loads))
    areas, onto = LevelAreas(building), dict[str, None]()
    for row in tables.rows("LINELOAD"):
        name = f"{row.text('Line')}-{row.text('Story')}"
        with account.noting():
            if not _add_line(row, building, name, bare.get(name), areas):
                onto[name] = None
    what = "loads on lines without a section, spread over the areas that they cross"
    account.read_as("LINE OBJECT LOADS", what, list(onto))
    account.read("LINE OBJECT LOADS", "loads on lines", len(building.line_loads))
    sets = _load_sets(tables, building)
    for row in tables.rows("AREALOAD"):
        with account.noting():
            _add_area(row, building, sets)
    account.read("AREA OBJECT LOADS", "loads on areas", len(building.area_loads))
    _read_source(tables, building)
    cases = cases_of(
        building,
        (
            tuple(values(row, dialect.CASE, building).values())
            for row in tables.rows("LOADCASE")
            if row.has("LOADPAT")
        ),
    )
    add_combinations(building, "LOAD COMBINATIONS", cases, _combined(tables, building))


def _combined(tables: Tables, building: Building) -> Iterator[tuple[str, str | None, float]]:
    for row in tables.rows("COMBO"):
        name = row.text("Combo")
        if row.has("TYPE") and row.text("TYPE").lower() not in {"linear add", "add"}:
            yield name, None, 0.0
        if row.has("LOADCASE"):
            yield tuple(values(row, dialect.COMBINATION, building).values())
        elif row.has("LOADCOMBO"):
            yield name, None, 0.0


def _add_point_load(row: Row, building: Building) -> None:
    joint = f"{row.text('Point')}-{row.text('Story')}"
    if joint not in building.joints:
        message = f'a load on point "{row.text("Point")}" of story "{row.text("Story")}", at which '
        raise row.error(message + "no object ends")
    if not refused(row, joint, building.account, dialect.POINT_LOAD_WORDS):
        *forces, pattern = values(row, dialect.POINT_LOAD, building).values()
        building.joint_loads.append(JointLoad(joint, pattern, tuple(forces)))


def _add_line(
    row: Row, building: Building, name: str, ends: tuple[str, str] | None, areas: LevelAreas
) -> bool:
    # Returns whether the line carries it, not the areas under it.
    if refused(row, name, building.account, dialect.LINE_LOAD_WORDS):
        return True
    kind = row.text("TYPE").upper()
    given = values(row, dialect.LINE_LOAD[kind], building) | {"point": kind == "POINTF"}
    if name in building.frames:
        add_line_load(row, building, name, **given)
    elif ends is not None and areas.spread(ends, **given):
        return False
    else:
        what = "loads on lines without a section, and with no area under them"
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
    return True


def _load_sets(tables: Tables, building: Building) -> dict[str, list[dict[str, Any]]]:
    # Patterns of uniform load sets, and their pressures down.
    found: dict[str, list[dict[str, Any]]] = {}
    used = {row.text(TEXT, "") for row in tables.rows("AREALOAD")}
    for row in tables.rows("SHELLUNIFORMLOADSET"):
        if row.text("Set") not in used:
            row.looked_at.clear()
        elif row.has("LOADPAT"):
            part = values(row, dialect.LOAD_SET, building)
            found.setdefault(row.text("Set"), []).append(part)
    return found


def _add_area(row: Row, building: Building, sets: dict[str, list[dict[str, Any]]]) -> None:
    name = f"{row.text('Area')}-{row.text('Story')}"
    kind = row.text("TYPE", "").upper()
    if name not in building.areas or kind not in {"UNIFF", "UNIFLOADSET"}:
        what = worded('loads of type "{kind}" on areas, or on areas that are not there', kind=kind)
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
    elif kind == "UNIFLOADSET":
        for part in sets[known(row, "uniform load set", row.text(TEXT), sets)]:
            add_area_load(row, building, name, **part)
    else:
        add_area_load(row, building, name, **values(row, dialect.AREA_LOAD, building))


def _read_source(tables: Tables, building: Building) -> None:
    sources = {
        key[0]: values(row, dialect.MASS_SOURCE, building)
        for key, row in merged(tables.rows("MASSSOURCE"), "Source").items()
    }
    rows = tables.rows("MASSSOURCELOAD")
    old = tables.rows("MASSOPTIONS")  # of ETABS 8 and 9, without a name
    for row in old if not sources else ():
        if row.has("SOURCE"):
            sources[""] = values(row, dialect.MASS_OPTIONS, building)
            said = row.text("SOURCE").upper()
            sources[""] |= {"elements": "MASS" in said, "added": "MASS" in said}
            sources[""] |= {"loads": "LOAD" in said, "default": True}
            rows = [each for each in old if each.has("LOAD")]
    name = default_source(sources)
    own = [row for row in rows if row.text("Source", "") == name]
    add_mass_source(building, name, sources, own, dialect.MASS_SHARE)
    if sources and sources[name]["lumped"]:
        what = "masses lumped at stories by ETABS, here where they are"
        building.account.read_as("MASS SOURCE", what, [name])


def read_stories(tables: Tables, building: Building) -> None:
    """Read the stories, which are listed from the top; elevations count from the lowest."""
    towers = tables.rows("TOWER")
    if len({row.text("Name", "") for row in towers}) > 1:
        message = "models of several towers are not read: export them one by one"
        building.account.fault(str(towers[1].error(message)))
    rows = tables.needed("STORY", "an ETABS model has stories")
    one = building.units.length
    base = rows[-1]
    elevation = one * base.number("ELEV", 0.0)
    building.stories.append((base.text("Story"), elevation))
    for row in reversed(rows[:-1]):
        height = one * row.number("HEIGHT")
        if height <= 0.0:
            msg = f'HEIGHT of story "{row.text("Story")}" must be above 0: correct it'
            raise row.error(msg)
        elevation += height
        building.stories.append((row.text("Story"), elevation))
    names = [name for name, _ in building.stories]
    if len(set(names)) < len(names):
        msg = "two stories have the same name: rename one of them"
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
            found = material_of(row, name, dialect.MATERIAL, building)
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
            building.sections[name] = NO_SECTION
            with account.noting():
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
            building.area_sections[name] = NO_SHELL
            with account.noting():
                building.area_sections[name] = _shell(row, name, building)
    account.read("SHELLPROP", "sections of areas in use", len(building.area_sections))


def _named(
    row: Row, constants: Section | None, library: Mapping[str, Shape] | None
) -> Section | Shape | None:
    # Constants from elsewhere: those given, and for named sections those of the library.
    if constants is not None or row.has("AREA", "I33", "I22"):
        return constants
    return (library or {}).get(row.text("SHAPE", "").strip().upper())


def _section(row: Row, name: str, building: Building, kept: Section | Shape | None) -> FrameSection:
    of = f' of section "{name}"'
    material, shape = values(row, dialect.SECTION[:2], building).values()
    known(row, "MATERIAL", material, building.materials, of)
    sizes = tuple(values(row, dialect.SIZES, building).values())
    modifiers = Modifiers(**values(row, dialect.MODIFIERS, building))
    if isinstance(kept, Shape):
        found = by_constants(kept.row, name, dialect.SECTION, building, Units(1.0, kept.length))
        found = replace(found, material=material, shape=shape)
    elif kept is not None:
        found = with_constants(name, material, shape, kept)
    elif row.has("AREA", "I33", "I22"):
        found = by_constants(row, name, dialect.SECTION, building)
    elif shape.strip().lower() in FILLED:
        fill = known(row, "FILLMATERIAL", row.text("FILLMATERIAL", ""), building.materials, of)
        steel, inside = building.materials[material], building.materials[fill]
        found = filled_section(row, name, sizes, steel, inside)
    else:
        poisson = building.materials[material].poisson_ratio
        found = section_by_shape(row, name, material, shape, sizes, poisson)
    return replace(found, modifiers=found.modifiers.times(modifiers))


def _shell(row: Row, name: str, building: Building) -> AreaSection:
    of = f' of section "{name}"'
    refused(row, name, building.account, dialect.SHELL_WORDS)
    kind = row.text("MODELINGTYPE", row.text("TYPE", "ShellThin")).lower()
    deck = row.text("PROPTYPE", "").lower() == "deck"
    word = "CONCMATERIAL" if deck else "MATERIAL"
    material = known(row, word, row.text(word, ""), building.materials, of)
    bending = extra_weight = 0.0
    if deck:
        slab, depth, top, spacing, bottom, extra_weight = values(
            row, dialect.DECK, building
        ).values()
        thickness = slab + (depth * 0.5 * (top + bottom) / spacing if spacing else 0.0)
    else:
        given = values(row, dialect.THICKNESS, building, only_given=True)
        if not given:
            words = ", ".join(dialect.THICKNESS[0].names.split("|"))
            msg = f'section "{name}" has no thickness: {words}'
            raise row.error(msg)
        thickness, bending = given["thickness"], row.number("TB", 0.0) * building.units.length
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
