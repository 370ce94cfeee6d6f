"""Load patterns, loads, masses and combinations of SAP2000's tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.building import (
    AreaLoad,
    Building,
    JointLoad,
    LineLoad,
    MassSource,
    Pattern,
    Vector,
)
from frames.exchange.geometry import area_normal, direction_of, frame_axes
from frames.exchange.sap2000_properties import known
from frames.exchange.tables import by_name

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.tables import Row, Tables

PATTERNS = "LOAD PATTERN DEFINITIONS"
_FORCES, _MOMENTS = ("F1", "F2", "F3"), ("M1", "M2", "M3")


def read_loads(tables: Tables, building: Building) -> None:
    """Read patterns, loads, masses and combinations into a building."""
    for name, row in by_name(tables.rows(PATTERNS), "LoadPat").items():
        kind, factor = row.text("DesignType", "Other"), row.number("SelfWtMult", 0.0)
        building.patterns[name] = Pattern(name, kind, factor)
    building.account.read(PATTERNS, "load patterns", len(building.patterns))
    _read_joint_loads(tables, building)
    _read_frame_loads(tables, building)
    _read_area_loads(tables, building)
    _read_masses(tables, building)
    _read_source(tables, building)
    _read_combinations(tables, building)


def _pattern(row: Row, building: Building) -> str:
    field = "LoadPat" if row.has("LoadPat") else "LoadCase"
    return known(row, field, row.text(field), building.patterns)


def _read_joint_loads(tables: Tables, building: Building) -> None:
    units, table = building.units, "JOINT LOADS - FORCE"
    for row in tables.rows(table):
        joint = known(row, "Joint", row.text("Joint"), building.joints)
        if row.text("CoordSys", "GLOBAL").upper() not in {"GLOBAL", "LOCAL"}:
            msg = f'load of joint "{joint}" must be given in GLOBAL axes'
            raise row.error(msg)
        forces = [units.force * row.number(field, 0.0) for field in _FORCES]
        moments = [units.moment * row.number(field, 0.0) for field in _MOMENTS]
        building.joint_loads.append(JointLoad(joint, _pattern(row, building), (*forces, *moments)))
    building.account.read(table, "loads on joints", len(building.joint_loads))


def line_direction(
    row: Row, building: Building, frame: str, word: str, kind: str
) -> tuple[FloatArray, float] | None:
    """Return the direction of a load along a frame object and the factor of its projection.

    Shapes: result (3,).
    """
    given = building.frames[frame]
    first, last = (building.joints[name].position for name in (given.i, given.j))
    axes = frame_axes(first, last, given.angle)
    if kind.lower().startswith("moment"):
        what = "moments along frames"
        building.account.refuse("moments along frames", row.table, what, [frame], row.place)
        return None
    found = direction_of(word, axes)
    if found is None:
        msg = f'"{word}" of frame "{frame}" is no direction: Gravity, X, Y, Z, 1, 2, 3'
        raise row.error(msg)
    vector, projected = found
    return vector, float(np.linalg.norm(np.cross(axes[0], vector))) if projected else 1.0


def _at(row: Row, building: Building, frame: str, mark: str) -> float:
    # Distance from joint i as a share of the length.
    if row.text("DistType", "RelDist").lower().startswith("abs"):
        given = building.frames[frame]
        first, last = (np.array(building.joints[n].position) for n in (given.i, given.j))
        length = float(np.linalg.norm(last - first))
        share = row.number(f"AbsDist{mark}") * building.units.length / length
    else:
        share = row.number(f"RelDist{mark}")
    if not -1e-9 <= share <= 1.0 + 1e-6:
        msg = f'a load at {share:g} of the length of frame "{frame}" is not on it'
        raise row.error(msg)
    return min(max(share, 0.0), 1.0)


def _read_frame_loads(tables: Tables, building: Building) -> None:
    units = building.units
    for table, point in (("FRAME LOADS - DISTRIBUTED", False), ("FRAME LOADS - POINT", True)):
        before = len(building.line_loads)
        for row in tables.rows(table):
            frame = known(row, "Frame", row.text("Frame"), building.frames)
            pattern = _pattern(row, building)
            found = line_direction(row, building, frame, row.text("Dir"), row.text("Type", "Force"))
            if found is None:
                continue
            vector, factor = found
            if point:
                sizes = [row.number("Force") * units.force] * 2
                a = b = _at(row, building, frame, "")
            else:
                sizes = [factor * units.line * row.number(f"FOverL{mark}") for mark in "AB"]
                a, b = (_at(row, building, frame, mark) for mark in "AB")
                if b <= a:
                    msg = f'the load on frame "{frame}" ends at {b:g}, before {a:g}'
                    raise row.error(msg)
            start, end = (_vector(size * vector) for size in sizes)
            building.line_loads.append(LineLoad(frame, pattern, a, b, start, end, point))
        building.account.read(table, "loads on frames", len(building.line_loads) - before)
    _read_gravity(tables, building)


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def frame_weight(building: Building, frame: str) -> float:
    """Return the own weight of a frame object per length [N/m]."""
    given = building.frames[frame]
    section = building.sections[given.section]
    name = given.material or section.material
    factors = section.modifiers.times(given.modifiers)
    weight = building.materials[name].weight if name in building.materials else 0.0
    return weight * section.area * factors.weight


def area_weight(building: Building, area: str) -> float:
    """Return the own weight of an area per its own area [N/m2]."""
    given = building.areas[area]
    section = building.area_sections.get(given.section)
    if section is None:
        return 0.0
    material = building.materials.get(section.material)
    own = 0.0 if material is None else material.weight * section.thickness
    return (own + section.extra_weight) * section.weight * given.weight


def _read_gravity(tables: Tables, building: Building) -> None:
    # Multiples of own weight, along global axes: MultiplierZ = -1 is own weight, downwards.
    for table, field in (("FRAME LOADS - GRAVITY", "Frame"), ("AREA LOADS - GRAVITY", "Area")):
        rows = tables.rows(table)
        for row in rows:
            objects = building.frames if field == "Frame" else building.areas
            name = known(row, field, row.text(field), objects)
            factors = np.array([row.number(f"Multiplier{axis}", 0.0) for axis in "XYZ"])
            pattern = _pattern(row, building)
            if field == "Frame":
                load = _vector(factors * frame_weight(building, name))
                building.line_loads.append(LineLoad(name, pattern, 0.0, 1.0, load, load))
            else:
                load = _vector(factors * area_weight(building, name))
                building.area_loads.append(AreaLoad(name, pattern, load))
        building.account.read(table, "multiples of own weight", len(rows))


def area_direction(row: Row, building: Building, area: str, word: str) -> FloatArray:
    """Return the direction of a load on an area, times the factor of its projection (3,).

    Shapes: result (3,).
    """
    points = np.array([building.joints[name].position for name in building.areas[area].joints])
    normal, _ = area_normal(points)
    found = direction_of(word, None)
    if word.strip().lower() in {"3", "local-3"}:
        return normal
    if found is None:
        message = f'"{word}" of area "{area}" is no direction that is read: Gravity, X, Y, Z or 3'
        raise row.error(message)
    vector, projected = found
    return vector * (abs(float(normal @ vector)) if projected else 1.0)


def _read_area_loads(tables: Tables, building: Building) -> None:
    before = len(building.area_loads)
    for table in ("AREA LOADS - UNIFORM", "AREA LOADS - UNIFORM TO FRAME"):
        for row in tables.rows(table):
            area = known(row, "Area", row.text("Area"), building.areas)
            vector = area_direction(row, building, area, row.text("Dir"))
            size = row.number("UnifLoad") * building.units.stress
            pattern = _pattern(row, building)
            building.area_loads.append(AreaLoad(area, pattern, _vector(size * vector)))
    building.account.read("AREA LOADS", "uniform loads", len(building.area_loads) - before)


def _read_masses(tables: Tables, building: Building) -> None:
    units, table = building.units, "JOINT ADDED MASS ASSIGNMENTS"
    for name, row in by_name(tables.rows(table), "Joint").items():
        known(row, "Joint", name, building.joints)
        values = [row.number(f"Mass{k}", 0.0) * units.mass for k in (1, 2, 3)]
        turns = [row.number(f"MMI{k}", 0.0) * units.mass * units.length**2 for k in (1, 2, 3)]
        if min(*values, *turns) < 0.0:
            msg = f'masses of joint "{name}" must be 0 or greater'
            raise row.error(msg)
        building.masses[name] = (*values, *turns)
    building.account.read(table, "masses added to joints", len(building.masses))


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
        others = {r.text("MassSource", "") for r in rows} - {name}
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


def _read_combinations(tables: Tables, building: Building) -> None:
    cases: dict[str, dict[str, float]] = {}
    for row in tables.rows("CASE - STATIC 1 - LOAD ASSIGNMENTS"):
        if row.text("LoadName", "") in building.patterns:
            case = cases.setdefault(row.text("Case"), {})
            case[row.text("LoadName")] = row.number("LoadSF", 1.0)
    for name in building.patterns:
        cases.setdefault(name, {name: 1.0})
    other: set[str] = set()
    for row in tables.rows("COMBINATION DEFINITIONS"):
        name, part = row.text("ComboName"), row.text("CaseName", "")
        kind = row.text("ComboType", "Linear Add").lower()
        if kind != "linear add" or part not in cases:
            other.add(name)
            continue
        found = building.combinations.setdefault(name, {})
        for pattern, factor in cases[part].items():
            found[pattern] = found.get(pattern, 0.0) + factor * row.number("ScaleFactor", 1.0)
    for name in other:
        building.combinations.pop(name, None)
    table = "COMBINATION DEFINITIONS"
    building.account.read(table, "combinations of static loads", len(building.combinations))
    building.account.left_out(table, "combinations of other cases, or envelopes", sorted(other))
