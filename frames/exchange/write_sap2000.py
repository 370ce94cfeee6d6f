"""Writes a building as SAP2000's text tables, the format that its import reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from frames._errors import ModelError
from frames.exchange import sap2000_fields as dialect
from frames.exchange.building import RELEASES, Modifiers
from frames.exchange.fields import written
from frames.model.components import DOFS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.exchange.building import Building, FrameObject, LineLoad, LinkDof
    from frames.exchange.fields import Fields
    from frames.exchange.tables import Units

Value: TypeAlias = str | float | int | bool
"""Value of a cell."""

Rows: TypeAlias = list[dict[str, Value]]

_MASS_SOURCE: dict[str, Value] = {
    "MassSource": "MSSSRC1",
    "Elements": True,
    "Masses": True,
    "IsDefault": True,
}


def text_of(tables: dict[str, Rows]) -> str:
    """Return tables as the text that SAP2000 imports."""
    lines = ["File written by lir-dcfp", " "]
    for name, rows in tables.items():
        lines.append(f'TABLE:  "{name}"')
        lines += ["   " + "   ".join(f"{k}={_text(v)}" for k, v in row.items()) for row in rows]
        lines.append(" ")
    return "\r\n".join([*lines, "END TABLE DATA", ""])


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "Yes" if value else "No"
    if isinstance(value, float):
        return repr(float(value))
    words = str(value)
    if '"' in words:
        message = (
            f"the name {words!r} has a quotation mark, which SAP2000 does not support: remove it"
        )
        raise ModelError(message)
    return f'"{words}"' if not words or " " in words or "=" in words else words


def tables_of(building: Building) -> dict[str, Rows]:
    """Return a building as tables; its `version` has the words of the units."""
    head: dict[str, Value] = {"ProgramName": "SAP2000", "Version": "20.0.0"}
    found = {
        "PROGRAM CONTROL": [head | {"CurrUnits": building.version}],
        **_joints(building),
        **_properties(building),
        **_members(building),
        **_areas(building),
        **_loads(building),
        **_links(building),
    }
    return {name: rows for name, rows in found.items() if rows}


def _rows(key: str, given: Mapping[str, object], map_: Fields, units: Units, **more: Value) -> Rows:
    # A row for each thing by its name, its fields by a map.
    return [{key: name, **written(map_, thing, units), **more} for name, thing in given.items()]


def _joints(building: Building) -> dict[str, Rows]:
    units = building.units
    own: dict[str, Value] = {"CoordSys": "GLOBAL", "CoordType": "Cartesian"}
    ties = [(part, joint) for part in building.constraints.values() for joint in part.joints]
    return {
        dialect.JOINTS: [
            {"Joint": name, **own, **written(dialect.OWN, joint, units), "SpecialJt": True}
            for name, joint in building.joints.items()
        ],
        "JOINT RESTRAINT ASSIGNMENTS": [
            {"Joint": name, **written(dialect.RESTRAINT, {d: d in held for d in DOFS}, units)}
            for name, held in building.restraints.items()
        ],
        "JOINT ADDED MASS ASSIGNMENTS": [
            {"Joint": name, "CoordSys": "Local", **written(dialect.MASS, values, units)}
            for name, values in building.masses.items()
        ],
        "CONSTRAINT DEFINITIONS - DIAPHRAGM": [
            {"Name": name, "CoordSys": "GLOBAL", "Axis": "Z"} for name in building.constraints
        ],
        "JOINT CONSTRAINT ASSIGNMENTS": [
            {"Joint": joint, "Constraint": part.name, "Type": "Diaphragm"} for part, joint in ties
        ],
    }


def _properties(building: Building) -> dict[str, Rows]:
    units = building.units
    return {
        dialect.MATERIALS: _rows("Material", building.materials, dialect.MATERIAL, units),
        dialect.SECTIONS: _rows("SectionName", building.sections, dialect.SECTION, units, I23=0),
        dialect.AREA_SECTIONS: [
            {
                "Section": name,
                "Material": section.material,
                "MatAngle": 0.0,
                "AreaType": "Shell",
                "Type": "Shell-Thin",
                **written(dialect.THICKNESS, section, units),
                **written(dialect.SHELL[:6], section.factors, units),
            }
            for name, section in building.area_sections.items()
        ],
    }


def _members(building: Building) -> dict[str, Rows]:
    frames, units = building.frames.values(), building.units
    turned = {one.name: one for one in frames if one.angle}
    factors = {one.name: one.modifiers for one in frames if one.modifiers != Modifiers()}
    section: dict[str, Value] = {"AutoSelect": "N.A.", "AnalSect": "", "MatProp": "Default"}
    return {
        dialect.FRAMES: _rows("Frame", building.frames, dialect.ENDS, units, IsCurved=False),
        "FRAME SECTION ASSIGNMENTS": [
            {"Frame": one.name} | section | {"AnalSect": one.section} for one in frames
        ],
        "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL": _rows(
            "Frame", turned, dialect.ANGLE, units, AdvanceAxes=False
        ),
        "FRAME RELEASE ASSIGNMENTS 1 - GENERAL": [
            {"Frame": one.name, **_released(one, units), "PartialFix": False}
            for one in frames
            if any(one.releases)
        ],
        "FRAME INSERTION POINT ASSIGNMENTS": [
            {
                "Frame": one.name,
                "CardinalPt": "10 (centroid)",
                "CoordSys": "GLOBAL",
                **written(dialect.OFFSETS, (*one.offset_i, *one.offset_j), units),
                "Transform": True,
            }
            for one in frames
            if any(one.offset_i) or any(one.offset_j)
        ],
        "FRAME PROPERTY MODIFIERS": _rows("Frame", factors, dialect.MODIFIERS, units),
        "FRAME AUTO MESH ASSIGNMENTS": [{"Frame": one.name, "AutoMesh": False} for one in frames],
    }


def _released(one: FrameObject, units: Units) -> dict[str, Value]:
    ends = zip("IJ", one.releases, strict=True)
    free = {f"{word}{end}": word in words for end, words in ends for word in RELEASES}
    return written(dialect.RELEASES, free, units)


def _areas(building: Building) -> dict[str, Rows]:
    areas = building.areas.values()
    return {
        dialect.AREAS: [
            {
                "Area": area.name,
                "NumJoints": len(area.joints),
                **{f"Joint{k}": joint for k, joint in enumerate(area.joints, start=1)},
            }
            for area in areas
        ],
        "AREA SECTION ASSIGNMENTS": [
            {"Area": area.name, "Section": area.section} for area in areas
        ],
    }


def _loads(building: Building) -> dict[str, Rows]:
    source, units = building.mass_source, building.units
    shares = {} if source is None else source.patterns
    return {
        dialect.PATTERNS: _rows("LoadPat", building.patterns, dialect.PATTERN, units),
        "MASS SOURCE": [
            _MASS_SOURCE | {"Loads": True} | written(dialect.MASS_SHARE, share, units)
            for share in shares.items()
        ]
        or [_MASS_SOURCE | {"Loads": False}],
        "JOINT LOADS - FORCE": [
            {
                **written(dialect.LOADED, load, units),
                "CoordSys": "GLOBAL",
                **written(dialect.FORCES, load.forces, units),
            }
            for load in building.joint_loads
        ],
        "FRAME LOADS - DISTRIBUTED": [
            {
                **written(dialect.LINE_LOAD[:2], load, units),
                "CoordSys": "GLOBAL",
                "Type": "Force",
                **written(dialect.LINE_LOAD[2:], given, units),
                "DistType": "RelDist",
                **written(dialect.RELATIVE[False], load, units),
                **written(dialect.SPREAD, given, units),
            }
            for load in building.line_loads
            for given in along_axes(load)
        ],
    }


def along_axes(load: LineLoad) -> list[dict[str, Any]]:
    """Return a load along a frame object by the global axes along which it acts."""
    parts = zip("XYZ", load.start, load.end, strict=True)
    return [{"way": w, "start": start, "end": end} for w, start, end in parts if start or end]


def _links(building: Building) -> dict[str, Rows]:
    head = f"{dialect.LINKS} "
    found: dict[str, Rows] = {
        f"{head}01 - GENERAL": [],
        f"{head}02 - LINEAR": [],
        f"{head}08 - SLIDING ISOLATOR": [],
        dialect.LINK_PLACES: [],
        "LINK PROPERTY ASSIGNMENTS": [],
    }
    general = _rows("Link", building.link_properties, dialect.LINK, building.units)
    found[f"{head}01 - GENERAL"] = general
    for name, prop in building.link_properties.items():
        for dof, given in prop.dofs.items():
            table = "08 - SLIDING ISOLATOR" if given.nonlinear else "02 - LINEAR"
            found[head + table].append({"Link": name, "DOF": dof, **_dof(building, dof, given)})
    for name, link in building.links.items():
        row: dict[str, Value] = {"Link": name, "JointI": link.i, "JointJ": link.j or ""}
        found[dialect.LINK_PLACES].append(row)
        row = {"Link": name, "LinkType": building.link_properties[link.property].kind}
        row |= {"LinkJoints": "TwoJoint", "LinkProp": link.property}
        found["LINK PROPERTY ASSIGNMENTS"].append(row)
    return found


def _dof(building: Building, dof: str, given: LinkDof) -> dict[str, Value]:
    turns, units = dof.startswith("R"), building.units
    row = written(dialect.LINEAR[turns], given, units)
    if given.nonlinear:
        row["NonLinear"] = True
    return row | written(dialect.NONLINEAR[turns], given.values, units)
