"""Load patterns, loads, mass source and combinations of an ETABS text file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.exchange.building import (
    AreaLoad,
    Building,
    JointLoad,
    LineLoad,
    MassSource,
    Pattern,
    Vector,
)
from frames.exchange.e2k_text import TEXT
from frames.exchange.etabs_properties import merged
from frames.exchange.sap2000_loads import area_direction, line_direction

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.tables import Row, Tables


def read_loads(tables: Tables, building: Building) -> None:
    """Read patterns, loads, mass source and combinations into a building."""
    rows = merged(tables.rows("LOADPATTERN"), "Pattern")
    old = merged([r for r in tables.rows("LOADCASE") if r.has("SELFWEIGHT")], "Case")
    for (name,), row in (rows or old).items():
        kind, factor = row.text("TYPE", "Other"), row.number("SELFWEIGHT", 0.0)
        building.patterns[name] = Pattern(name, kind, factor)
    building.account.read("LOAD PATTERNS", "load patterns", len(building.patterns))
    for row in tables.rows("POINTLOAD"):
        _point(row, building)
    building.account.read("POINT OBJECT LOADS", "loads on points", len(building.joint_loads))
    for row in tables.rows("LINELOAD"):
        _line(row, building)
    building.account.read("LINE OBJECT LOADS", "loads on lines", len(building.line_loads))
    sets = _load_sets(tables, building)
    for row in tables.rows("AREALOAD"):
        _area(row, building, sets)
    building.account.read("AREA OBJECT LOADS", "loads on areas", len(building.area_loads))
    _read_source(tables, building)
    _read_combinations(tables, building)


def _pattern(row: Row, building: Building, field: str = "LC") -> str:
    name = row.text(field)
    if name not in building.patterns:
        some = ", ".join(building.patterns) or "none"
        msg = f'load pattern "{name}" is not defined: there are {some}'
        raise row.error(msg)
    return name


def _point(row: Row, building: Building) -> None:
    joint = f"{row.text('Point')}-{row.text('Story')}"
    if joint not in building.joints:
        message = f'a load on point "{row.text("Point")}" of story "{row.text("Story")}", at which '
        raise row.error(message + "no object ends")
    if row.text("TYPE", "FORCE").upper() != "FORCE":
        what = f'loads of type "{row.text("TYPE")}" on points'
        building.account.refuse("imposed strains", row.table, what, [joint], row.place)
        return
    units = building.units
    forces = [row.number(word, 0.0) * units.force for word in ("FX", "FY", "FZ")]
    moments = [row.number(word, 0.0) * units.moment for word in ("MX", "MY", "MZ")]
    building.joint_loads.append(JointLoad(joint, _pattern(row, building), (*forces, *moments)))


def _line(row: Row, building: Building) -> None:
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
    found = line_direction(row, building, name, row.text("DIR", "GRAV"), "Force")
    if found is None:
        return
    vector, factor = found
    units, point = building.units, kind == "POINTF"
    a, b = 0.0, 1.0
    if kind == "TRAPF":
        sizes = [row.number("FSTART"), row.number("FEND")]
        a, b = row.number("RDSTART", 0.0), row.number("RDEND", 1.0)
    else:
        sizes = [row.number("FVAL")] * 2
        a = b = row.number("RDIST") if point else 0.0
        b = b if point else 1.0
    if not -1e-9 <= a <= b <= 1.0 + 1e-6 or (a >= b and not point):
        msg = f"a load from {a:g} to {b:g} of the length is not on the line"
        raise row.error(msg)
    scale = units.force if point else units.line * factor
    start, end = (_vector(scale * size * vector) for size in sizes)
    load = LineLoad(name, _pattern(row, building), max(a, 0.0), min(b, 1.0), start, end, point)
    building.line_loads.append(load)


def _load_sets(tables: Tables, building: Building) -> dict[str, list[tuple[str, float]]]:
    # Patterns of uniform load sets, and their pressures down [N/m2].
    found: dict[str, list[tuple[str, float]]] = {}
    used = {row.text(TEXT, "") for row in tables.rows("AREALOAD")}
    for row in tables.rows("SHELLUNIFORMLOADSET"):
        if row.text("Set") not in used:
            row.looked_at.clear()
        elif row.has("LOADPAT"):
            part = (_pattern(row, building, "LOADPAT"), row.number("VALUE"))
            found.setdefault(row.text("Set"), []).append((part[0], part[1] * building.units.stress))
    return found


def _area(row: Row, building: Building, sets: dict[str, list[tuple[str, float]]]) -> None:
    name = f"{row.text('Area')}-{row.text('Story')}"
    kind = row.text("TYPE", "").upper()
    if kind == "UNIFLOADSET" and name in building.areas:
        given = row.text(TEXT)
        if given not in sets:
            msg = (
                f'uniform load set "{given}" is not defined: there are {", ".join(sets) or "none"}'
            )
            raise row.error(msg)
        down = area_direction(row, building, name, "GRAV")
        for pattern, size in sets[given]:
            building.area_loads.append(AreaLoad(name, pattern, _vector(size * down)))
        return
    if name not in building.areas or kind != "UNIFF":
        what = f'loads of type "{kind}" on areas, or on areas that are not there'
        building.account.refuse("loads on nothing", row.table, what, [name], row.place)
        return
    vector = area_direction(row, building, name, row.text("DIR", "GRAV"))
    size = row.number("FVAL") * building.units.stress
    load = AreaLoad(name, _pattern(row, building), _vector(size * vector))
    building.area_loads.append(load)


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def _read_source(tables: Tables, building: Building) -> None:
    sources = merged(tables.rows("MASSSOURCE"), "Source")
    chosen = [k[0] for k, r in sources.items() if r.text("ISDEFAULT", "No").lower() == "yes"]
    name = chosen[0] if chosen else next((k[0] for k in sources), "")
    loads = {}
    for row in tables.rows("MASSSOURCELOAD"):
        if row.text("Source") != name:
            continue
        pattern = row.text("Pattern")
        if pattern not in building.patterns:
            msg = f'load pattern "{pattern}" of the mass source is not defined'
            raise row.error(msg)
        loads[pattern] = row.number("Factor")
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


def _read_combinations(tables: Tables, building: Building) -> None:
    cases: dict[str, dict[str, float]] = {name: {name: 1.0} for name in building.patterns}
    for row in tables.rows("LOADCASE"):
        if row.has("LOADPAT") and row.text("LOADPAT") in building.patterns:
            name = row.text("Case")
            if cases.get(name) == {name: 1.0}:
                cases[name] = {}
            cases.setdefault(name, {})[row.text("LOADPAT")] = row.number("SF", 1.0)
    other: set[str] = set()
    for row in tables.rows("COMBO"):
        name = row.text("Combo")
        if row.has("TYPE") and row.text("TYPE").lower() not in {"linear add", "add"}:
            other.add(name)
        if row.has("LOADCASE"):
            part = row.text("LOADCASE")
            if part not in cases:
                other.add(name)
                continue
            found = building.combinations.setdefault(name, {})
            for pattern, factor in cases[part].items():
                found[pattern] = found.get(pattern, 0.0) + factor * row.number("SF", 1.0)
        elif row.has("LOADCOMBO"):
            other.add(name)
    for name in other:
        building.combinations.pop(name, None)
    table = "LOAD COMBINATIONS"
    building.account.read(table, "combinations of static loads", len(building.combinations))
    building.account.left_out(table, "combinations of other cases, or envelopes", sorted(other))
