"""Reads an ETABS model: its text file (.e2k, .$et)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from frames.exchange import etabs_fields as dialect
from frames.exchange.account import Account
from frames.exchange.building import Building, JointLoad, MassSource, Pattern
from frames.exchange.etabs_links import EtabsLinks, read_groups
from frames.exchange.etabs_objects import Objects
from frames.exchange.etabs_properties import read_properties, read_stories
from frames.exchange.fields import FORCES, LENGTHS, Units, numbers, units_of
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
    for name, count in tables.unread().items():
        key, what = next(
            (v for start, v in dialect.REFUSED.items() if name.startswith(start)), ("", "")
        )
        if key:
            rows = tables.rows(name)
            first = next(iter(rows[0].values.values()), "")
            account.refuse(
                key, rows[0].table, f"{what}, {count} lines", [str(first)], rows[0].place
            )
    account.unknown(tables.unknown(dialect.KNOWN))
    rest = [f"{name} ({count})" for name, count in tables.unread().items()]
    account.left_out("other lines", "what the linear model does not need, by first word", rest)
    return building


def _refuse_stages(tables: Tables, account: Account) -> None:
    rows = tables.rows("LOADCASE")
    staged = [r for r in rows if r.has("STAGE") or "STAGED" in r.text("TYPE", "").upper()]
    if staged:
        key, what = dialect.REFUSED["STAGE"]
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
        kind, factor = row.text("TYPE", "Other"), row.number("SELFWEIGHT", 0.0)
        building.patterns[name] = Pattern(name, kind, factor)
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
    if row.text("TYPE", "FORCE").upper() != "FORCE":
        what = f'loads of type "{row.text("TYPE")}" on points'
        building.account.refuse("imposed strains", row.table, what, [joint], row.place)
        return
    forces = tuple(numbers(row, dialect.FORCES, building.units).values())
    building.joint_loads.append(JointLoad(joint, _pattern(row, building), forces))


def _add_line(row: Row, building: Building) -> None:
    name = f"{row.text('Line')}-{row.text('Story')}"
    kind = row.text("TYPE", "").upper()
    if name not in building.frames:
        what = "loads on lines without a section"
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
        return
    if kind not in {"UNIFF", "TRAPF", "POINTF"}:
        what = f'loads of type "{kind}" on lines'
        building.account.refuse("imposed strains", row.table, what, [name], row.place)
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
    sources = merged(tables.rows("MASSSOURCE"), "Source")
    chosen = [k[0] for k, r in sources.items() if r.text("ISDEFAULT", "No").lower() == "yes"]
    name = chosen[0] if chosen else next((k[0] for k in sources), "")
    loads = {
        _pattern(row, building, "Pattern"): row.number("Factor")
        for row in tables.rows("MASSSOURCELOAD")
        if row.text("Source") == name
    }
    if not sources:
        return
    row = sources[name,]

    def says(word: str) -> bool:
        return row.text(word, "No").lower() == "yes"

    loads = loads if says("INCLUDELOADS") else {}
    building.mass_source = MassSource(says("INCLUDEELEMENTS"), says("INCLUDEADDEDMASS"), loads)
    account = building.account
    account.read("MASS SOURCE", "mass source", 1)
    others = [k[0] for k in sources if k[0] != name]
    account.left_out("MASS SOURCE", "mass sources besides the default", others)
    if says("LUMPATSTORIES"):
        what = "masses lumped at stories by ETABS, here where they are"
        account.read_as("MASS SOURCE", what, [name])
