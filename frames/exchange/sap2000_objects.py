"""Joints, frame objects, areas, links, supports and constraints of SAP2000's tables."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from frames._errors import ModelError
from frames.exchange import sap2000_fields as dialect
from frames.exchange.building import (
    AreaObject,
    Building,
    Constraint,
    FrameObject,
    Joint,
    LinkObject,
    Modifiers,
)
from frames.exchange.fields import refused, values
from frames.exchange.geometry import frame_axes
from frames.exchange.loads import vector_of
from frames.exchange.properties import offsets_of, released, shell_factors
from frames.exchange.tables import Row, Tables, by_name, known, of_objects
from frames.model.components import DOFS
from lir_element.texts import worded

_GROUND = {"", "ground", "gnd", "none"}


def section_of(row: Row) -> str:
    """Return the section of a row of assignments to frames."""
    return row.text("AnalSect", row.text("Section", "None"))


def read_objects(tables: Tables, building: Building) -> None:
    """Read joints, frames, areas, links, supports, constraints and groups into a building."""
    for name, row in by_name(tables.needed(dialect.JOINTS, "export all tables"), "Joint").items():
        building.joints[name] = _joint(row, name, building)
    building.account.read(dialect.JOINTS, "joints", len(building.joints))
    _refuse_turned_joints(tables, building)
    _read_frames(tables, building)
    _read_areas(tables, building)
    _read_links(tables, building)
    _read_supports(tables, building)
    _read_constraints(tables, building)
    for row in tables.rows("GROUPS 2 - ASSIGNMENTS"):
        group = building.groups.setdefault(row.text("GroupName"), [])
        group.append((row.text("ObjectType").lower(), row.text("ObjectLabel")))


def _joint(row: Row, name: str, building: Building) -> Joint:
    map_ = dialect.GLOBAL
    if not row.has("GlobalX", "GlobalY", "GlobalZ"):
        map_ = dialect.OWN
        system = row.text("CoordSys", "GLOBAL"), row.text("CoordType", "Cartesian")
        if system[0].upper() != "GLOBAL" or system[1].upper() != "CARTESIAN":
            message = (
                f'joint "{name}" is given in {system[0]} {system[1]} coordinates without GlobalX, '
                "GlobalY and GlobalZ: export it in global Cartesian ones"
            )
            raise row.error(message)
    return Joint(name, **values(row, map_, building), place=row.place)


def _refuse_turned_joints(tables: Tables, building: Building) -> None:
    table = "JOINT LOCAL AXES ASSIGNMENTS 1 - TYPICAL"
    rows = tables.rows(table)
    turned = [row for row in rows if any(row.number(f"Angle{c}", 0.0) for c in "ABC")]
    if turned:
        names = [row.text("Joint") for row in turned]
        what = "local axes of joints, whose supports and springs are taken in global axes"
        building.account.refuse("joint axes", table, what, names, turned[0].place)


def _read_frames(tables: Tables, building: Building) -> None:
    sections = by_name(tables.rows("FRAME SECTION ASSIGNMENTS"), "Frame")
    for name, row in by_name(tables.rows(dialect.FRAMES), "Frame").items():
        i, j = values(row, dialect.ENDS, building).values()
        if i == j:
            msg = f'frame "{name}" begins and ends at joint "{i}"'
            raise row.error(msg)
        assigned = sections.get(name)
        if assigned is None:
            message = f'frame "{name}" has no row in FRAME SECTION ASSIGNMENTS: export that table'
            raise row.error(message)
        section = section_of(assigned)
        refused(row, name, building.account, dialect.FRAME_WORDS)
        material = assigned.text("MatProp", "Default")
        frame = FrameObject(name, i, j, section, row.place)
        if section.lower() != "none":
            known(assigned, "section", section, building.sections)
            if material.lower() != "default":
                known(assigned, "MatProp", material, building.materials)
                frame = replace(frame, material=material)
        building.frames[name] = frame
    for row in sections.values():
        known(row, "Frame", row.text("Frame"), building.frames)
    _assign_frames(tables, building)
    empty = [name for name, frame in building.frames.items() if frame.section.lower() == "none"]
    building.account.left_out(dialect.FRAMES, "frames without a section", empty)
    for name in empty:
        del building.frames[name]
    building.account.read(dialect.FRAMES, "frame objects", len(building.frames))


def _assign_frames(tables: Tables, building: Building) -> None:
    for table, change in (
        ("FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", _turned),
        ("FRAME PROPERTY MODIFIERS", _modified),
        ("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", _released),
        ("FRAME OFFSET ALONG LENGTH ASSIGNMENTS", _with_end_zones),
        ("FRAME OFFSETS (LENGTH) ASSIGNMENTS", _with_end_zones),
        ("FRAME INSERTION POINT ASSIGNMENTS", _inserted),
        ("FRAME AUTO MESH ASSIGNMENTS", _meshed),
    ):
        for name, row in of_objects(tables.rows(table), "Frame", building.frames):
            refused(row, name, building.account, dialect.FRAME_WORDS)
            frame = building.frames[name]
            building.frames[name] = replace(frame, **change(frame, row, building))


def _turned(_: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    return values(row, dialect.ANGLE, building)


def _modified(_: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    return {"modifiers": Modifiers(**values(row, dialect.MODIFIERS, building))}


def _released(frame: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    free = [word for word, is_free in values(row, dialect.RELEASES, building).items() if is_free]
    return {"releases": released(row, frame.name, free, building)}


def _with_end_zones(frame: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    return values(row, dialect.END_ZONES, building, f' of frame "{frame.name}"')


def _inserted(frame: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    number = re.match(r"\s*(\d+)", row.text("CardinalPt", "10"))
    cardinal = int(number[1]) if number else 0
    if not 1 <= cardinal <= 11:
        msg = f'CardinalPt = "{row.text("CardinalPt")}" must begin with 1 to 11'
        raise row.error(msg)
    offset_i, offset_j = offsets_of(row, dialect.OFFSETS, building)
    if row.text("CoordSys", "GLOBAL").lower() == "local":
        first, last = (building.joints[name].position for name in (frame.i, frame.j))
        axes = frame_axes(first, last, frame.angle)
        offset_i, offset_j = (vector_of(axes.T @ offset) for offset in (offset_i, offset_j))
    transforms = all(values(row, dialect.TRANSFORMS, building).values())
    offsets = {"offset_i": offset_i, "offset_j": offset_j}
    return {"cardinal": cardinal, "transforms": transforms, **offsets}


def _meshed(_: FrameObject, row: Row, building: Building) -> dict[str, Any]:
    return {"meshed": all(values(row, dialect.MESHED, building).values())}


def _read_areas(tables: Tables, building: Building) -> None:
    sections = by_name(tables.rows("AREA SECTION ASSIGNMENTS"), "Area")
    for row in tables.rows(dialect.AREAS):
        name = row.text("Area")
        fields = [f for f in row.values if re.fullmatch(r"Joint\d+", f) and row.has(f)]
        joints = tuple(known(row, f, row.text(f), building.joints) for f in fields)
        if name in building.areas:  # corners go on in the next row
            joints = (*building.areas[name].joints, *joints)
        assigned = sections.get(name)
        section = "None" if assigned is None else assigned.text("Section", "None")
        if section.lower() == "none":
            section = ""
        elif assigned is not None:
            known(assigned, "Section", section, building.area_sections)
        building.areas[name] = AreaObject(name, joints, section, row.place)
    for area in building.areas.values():
        if len(set(area.joints)) < max(3, len(area.joints)):
            message = f'{area.place}: area "{area.name}" needs three or more different corners'
            raise ModelError(message)
    for row in sections.values():
        known(row, "Area", row.text("Area"), building.areas)
    for name, row in of_objects(tables.rows("AREA STIFFNESS MODIFIERS"), "Area", building.areas):
        factors = shell_factors(row, dialect.SHELL, building)
        building.areas[name] = replace(building.areas[name], **factors)
    building.account.read(dialect.AREAS, "areas", len(building.areas))


def _read_links(tables: Tables, building: Building) -> None:
    table = dialect.LINK_PLACES
    assigned = by_name(tables.rows("LINK PROPERTY ASSIGNMENTS"), "Link")
    angles = by_name(tables.rows("LINK LOCAL AXES ASSIGNMENTS 1 - TYPICAL"), "Link")
    for name, row in by_name(tables.rows(table), "Link").items():
        if name not in assigned:
            message = f'link "{name}" has no row in LINK PROPERTY ASSIGNMENTS: export that table'
            raise row.error(message)
        first, last = row.text("JointI"), row.text("JointJ", "")
        known(row, "JointI", first, building.joints)
        single = assigned[name].text("LinkJoints", "").lower().startswith("single")
        ground = single or last.lower() in _GROUND or last == first
        if not ground:
            known(row, "JointJ", last, building.joints)
        prop = assigned[name].text("LinkProp")
        known(assigned[name], "LinkProp", prop, building.link_properties)
        turn = values(angles[name], dialect.ANGLE, building) if name in angles else {}
        other = None if ground else last
        building.links[name] = LinkObject(name, first, other, prop, row.place, **turn)
    building.account.read(table, "links", len(building.links))


def _read_supports(tables: Tables, building: Building) -> None:
    table = "JOINT RESTRAINT ASSIGNMENTS"
    for name, row in of_objects(tables.rows(table), "Joint", building.joints):
        given = values(row, dialect.RESTRAINT, building)
        held = tuple(dof for dof, is_held in given.items() if is_held)
        if held:
            building.restraints[name] = held
    building.account.read(table, "supports", len(building.restraints))
    table = "JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED"
    for name, row in of_objects(tables.rows(table), "Joint", building.joints):
        if row.text("CoordSys", "GLOBAL").upper() not in {"GLOBAL", "LOCAL"}:
            msg = f'spring of joint "{name}" must be given in GLOBAL axes'
            raise row.error(msg)
        of = f' of the spring of joint "{name}"'
        stiffness = tuple(values(row, dialect.SUPPORT, building, of).values())
        if any(stiffness):
            building.springs[name] = stiffness
    building.account.read(table, "joint springs", len(building.springs))
    table = "JOINT ADDED MASS ASSIGNMENTS"
    for name, row in of_objects(tables.rows(table), "Joint", building.joints):
        of = f' of joint "{name}"'
        building.masses[name] = tuple(values(row, dialect.MASS, building, of).values())
    building.account.read(table, "masses added to joints", len(building.masses))


def _read_constraints(tables: Tables, building: Building) -> None:
    kinds: dict[str, tuple[str, tuple[str, ...]]] = {}
    head = "CONSTRAINT DEFINITIONS - "
    for kind in ("DIAPHRAGM", "BODY", "EQUAL"):
        for row in tables.rows(head + kind):
            if kind == "DIAPHRAGM":
                refused(row, row.text("Name"), building.account, dialect.CONSTRAINT_WORDS)
            tied = values(row, dialect.TIED, building)
            kinds[row.text("Name")] = (kind.lower(), tuple(dof for dof in tied if tied[dof]))
    joints: dict[str, list[str]] = {}
    table = "JOINT CONSTRAINT ASSIGNMENTS"
    for row in tables.rows(table):
        name = row.text("Constraint")
        kind = row.text("Type", kinds.get(name, ("",))[0]).lower()
        if name not in kinds and kind not in {"diaphragm", "body", "equal"}:
            what = worded('a constraint of type "{kind}"', kind=kind or "not defined")
            building.account.refuse("other constraints", table, what, [name], row.place)
            continue
        kinds.setdefault(name, (kind, DOFS))
        joints.setdefault(name, []).append(known(row, "Joint", row.text("Joint"), building.joints))
    for name, members in joints.items():
        kind, dofs = kinds[name]
        building.constraints[name] = Constraint(name, kind, tuple(dict.fromkeys(members)), dofs)
    building.account.read(table, "constraints", len(building.constraints))
