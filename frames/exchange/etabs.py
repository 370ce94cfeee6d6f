"""Reads an ETABS model: its text file (.e2k, .$et)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from frames.exchange import etabs_fields as dialect
from frames.exchange.account import Account, judge_rest
from frames.exchange.building import Building, JointLoad, MassSource, Pattern
from frames.exchange.etabs_links import EtabsLinks, read_groups
from frames.exchange.etabs_objects import Objects
from frames.exchange.etabs_properties import read_properties, read_stories
from frames.exchange.fields import FORCES, LENGTHS, Units, refused, units_of, values
from frames.exchange.loads import add_area_load, add_combinations, add_line_load, cases_of
from frames.exchange.options import Options
from frames.exchange.reading import TEXT, read_e2k
from frames.exchange.section_shapes import read_libraries
from frames.exchange.tables import Row, Tables, known, merged, require_space


def read_etabs(path: str | Path, options: Options | None = None) -> Building:
    """Read an ETABS model."""
    file, given = Path(path), options or Options()
    tables = read_e2k(file, given.decimal)
    account = Account(file.name, given.allow)
    program = tables.rows("PROGRAM")
    version = program[0].text("VERSION", "") if program else ""
    building = Building(file.stem, "ETABS", version, _units(tables), account)
    for row in tables.rows("ACTIVEDOF"):
        require_space(row, row.text("Name", "").upper().split())
    read_stories(tables, building)
    read_properties(tables, building, given.sections, read_libraries(given.library))
    objects = Objects(tables, building)
    objects.read()
    EtabsLinks(tables, building, objects).read()
    read_groups(tables, building)
    read_loads(tables, building)
    _refuse_stages(tables, account)
    judge_rest(tables, account, dialect.REFUSED, dialect.KNOWN, row_word="lines")
    return building


def _refuse_stages(tables: Tables, account: Account) -> None:
    rows = tables.rows("LOADCASE")
    staged = [r for r in rows if r.has("STAGE") or "STAGED" in r.text("TYPE", "").upper()]
    if staged:
        key, what = next(refused[1:] for refused in dialect.REFUSED if refused[0] == "STAGE")
        names = list(dict.fromkeys(row.text("Case") for row in staged))
        account.refuse(key, staged[0].table, what, names, staged[0].place)


def _units(tables: Tables) -> Units:
    row = tables.needed("UNITS", "$ CONTROLS has the units; export it with the others")[0]
    found = units_of(row.text("Force"), row.text("Length"))
    if found is None:
        message = (
            f'UNITS "{row.text("Force")}" "{row.text("Length")}" must be a force of '
            f"{', '.join(FORCES)} and a length of {', '.join(LENGTHS)}"
        )
        raise row.error(message)
    return found


def read_loads(tables: Tables, building: Building) -> None:
    """Read patterns, loads, mass source and combinations into a building."""
    account = building.account
    rows = merged(tables.rows("LOADPATTERN"), "Pattern")
    old = merged([r for r in tables.rows("LOADCASE") if r.has("SELFWEIGHT")], "Case")
    for (name,), row in (rows or old).items():
        building.patterns[name] = Pattern(name, **values(row, dialect.PATTERN, building.units))
    account.read("LOAD PATTERNS", "load patterns", len(building.patterns))
    for row in tables.rows("POINTLOAD"):
        _add_point_load(row, building)
    account.read("POINT OBJECT LOADS", "loads on points", len(building.joint_loads))
    for row in tables.rows("LINELOAD"):
        _add_line(row, building)
    account.read("LINE OBJECT LOADS", "loads on lines", len(building.line_loads))
    sets = _load_sets(tables, building)
    for row in tables.rows("AREALOAD"):
        _add_area(row, building, sets)
    account.read("AREA OBJECT LOADS", "loads on areas", len(building.area_loads))
    _read_source(tables, building)
    cases = cases_of(
        building,
        (
            (row.text("Case"), row.text("LOADPAT"), row.number("SF", 1.0))
            for row in tables.rows("LOADCASE")
            if row.has("LOADPAT")
        ),
    )
    add_combinations(building, "LOAD COMBINATIONS", cases, _combined(tables))


def _combined(tables: Tables) -> Iterator[tuple[str, str | None, float]]:
    for row in tables.rows("COMBO"):
        name = row.text("Combo")
        if row.has("TYPE") and row.text("TYPE").lower() not in {"linear add", "add"}:
            yield name, None, 0.0
        if row.has("LOADCASE"):
            yield name, row.text("LOADCASE"), row.number("SF", 1.0)
        elif row.has("LOADCOMBO"):
            yield name, None, 0.0


def _pattern(row: Row, building: Building, field: str = "LC") -> str:
    return known(row, "load pattern", row.text(field), building.patterns)


def _add_point_load(row: Row, building: Building) -> None:
    joint = f"{row.text('Point')}-{row.text('Story')}"
    if joint not in building.joints:
        message = f'a load on point "{row.text("Point")}" of story "{row.text("Story")}", at which '
        raise row.error(message + "no object ends")
    if refused(row, joint, building.account, dialect.POINT_LOAD):
        return
    forces = tuple(values(row, dialect.FORCES, building.units).values())
    building.joint_loads.append(JointLoad(joint, _pattern(row, building), forces))


def _add_line(row: Row, building: Building) -> None:
    name = f"{row.text('Line')}-{row.text('Story')}"
    kind = row.text("TYPE", "").upper()
    if name not in building.frames:
        what = "loads on lines without a section"
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
        return
    if refused(row, name, building.account, dialect.LINE_LOAD):
        return
    point = kind == "POINTF"
    a, b = 0.0, 1.0
    if kind == "TRAPF":
        sizes = [row.number("FSTART"), row.number("FEND")]
        a, b = row.number("RDSTART", 0.0), row.number("RDEND", 1.0)
    else:
        sizes = [row.number("FVAL")] * 2
        a, b = (row.number("RDIST"),) * 2 if point else (a, b)
    pattern, word = _pattern(row, building), row.text("DIR", "GRAV")
    add_line_load(row, building, name, pattern, word, sizes, (a, b), point=point)


def _load_sets(tables: Tables, building: Building) -> dict[str, list[tuple[str, float]]]:
    # Patterns of uniform load sets, and their pressures down.
    found: dict[str, list[tuple[str, float]]] = {}
    used = {row.text(TEXT, "") for row in tables.rows("AREALOAD")}
    for row in tables.rows("SHELLUNIFORMLOADSET"):
        if row.text("Set") not in used:
            row.looked_at.clear()
        elif row.has("LOADPAT"):
            part = (_pattern(row, building, "LOADPAT"), row.number("VALUE"))
            found.setdefault(row.text("Set"), []).append(part)
    return found


def _add_area(row: Row, building: Building, sets: dict[str, list[tuple[str, float]]]) -> None:
    name = f"{row.text('Area')}-{row.text('Story')}"
    kind = row.text("TYPE", "").upper()
    if name not in building.areas or kind not in {"UNIFF", "UNIFLOADSET"}:
        what = f'loads of type "{kind}" on areas, or on areas that are not there'
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
    elif kind == "UNIFLOADSET":
        for pattern, size in sets[known(row, "uniform load set", row.text(TEXT), sets)]:
            add_area_load(row, building, name, pattern, "GRAV", size)
    else:
        pattern, word = _pattern(row, building), row.text("DIR", "GRAV")
        add_area_load(row, building, name, pattern, word, row.number("FVAL"))


def _read_source(tables: Tables, building: Building) -> None:
    sources = {
        key[0]: values(row, dialect.MASS_SOURCE, building.units)
        for key, row in merged(tables.rows("MASSSOURCE"), "Source").items()
    }
    name = next((k for k, given in sources.items() if given["default"]), next(iter(sources), ""))
    loads = {
        _pattern(row, building, "Pattern"): row.number("Factor")
        for row in tables.rows("MASSSOURCELOAD")
        if row.text("Source") == name
    }
    if not sources:
        return
    given = sources[name]
    loads = loads if given["loads"] else {}
    building.mass_source = MassSource(given["elements"], given["added"], loads)
    account = building.account
    account.read("MASS SOURCE", "mass source", 1)
    others = [other for other in sources if other != name]
    account.left_out("MASS SOURCE", "mass sources besides the default", others)
    if given["lumped"]:
        what = "masses lumped at stories by ETABS, here where they are"
        account.read_as("MASS SOURCE", what, [name])
