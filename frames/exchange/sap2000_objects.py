"""Joints, frame objects, areas, links, supports and constraints of SAP2000's tables."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.exchange.building import (
    RELEASES,
    AreaObject,
    Building,
    Constraint,
    FrameObject,
    Joint,
    LinkObject,
    Vector,
)
from frames.exchange.geometry import frame_axes
from frames.exchange.sap2000_properties import (
    known,
    section_modifiers,
    section_of,
    shell_factors,
)
from frames.exchange.tables import by_name

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.tables import Row, Tables

DOFS = (("U1", "ux"), ("U2", "uy"), ("U3", "uz"), ("R1", "rx"), ("R2", "ry"), ("R3", "rz"))
"""Displacements of a joint: the file's names and ours."""

JOINTS, FRAMES, AREAS = "JOINT COORDINATES", "CONNECTIVITY - FRAME", "CONNECTIVITY - AREA"
_GROUND = {"", "ground", "gnd", "none"}


def read_objects(tables: Tables, building: Building) -> None:
    """Read joints, frames, areas, links, supports, constraints and groups into a building."""
    for name, row in by_name(tables.needed(JOINTS, "export all tables"), "Joint").items():
        building.joints[name] = _joint(row, name, building)
    building.account.read(JOINTS, "joints", len(building.joints))
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
    one = building.units.length
    if row.has("GlobalX", "GlobalY", "GlobalZ"):
        fields = ("GlobalX", "GlobalY", "GlobalZ")
    else:
        system = row.text("CoordSys", "GLOBAL"), row.text("CoordType", "Cartesian")
        if system[0].upper() != "GLOBAL" or system[1].upper() != "CARTESIAN":
            message = (
                f'joint "{name}" is given in {system[0]} {system[1]} coordinates without GlobalX, '
                "GlobalY and GlobalZ: export it in global Cartesian ones"
            )
            raise row.error(message)
        fields = ("XorR", "Y", "Z")
    x, y, z = (one * row.number(field) for field in fields)
    return Joint(name, x, y, z, row.place)


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
    for name, row in by_name(tables.rows(FRAMES), "Frame").items():
        i, j = (known(row, f, row.text(f), building.joints) for f in ("JointI", "JointJ"))
        if i == j:
            msg = f'frame "{name}" begins and ends at joint "{i}"'
            raise row.error(msg)
        assigned = sections.get(name)
        if assigned is None:
            message = f'frame "{name}" has no row in FRAME SECTION ASSIGNMENTS: export that table'
            raise row.error(message)
        section = section_of(assigned)
        if row.yes("IsCurved", default=False):
            what = "curved frames, taken as straight ones"
            building.account.refuse("curved frames", FRAMES, what, [name], row.place)
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
    building.account.left_out(FRAMES, "frames without a section", empty)
    for name in empty:
        del building.frames[name]
    building.account.read(FRAMES, "frame objects", len(building.frames))


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
        for name, row in by_name(tables.rows(table), "Frame").items():
            known(row, "Frame", name, building.frames)
            building.frames[name] = change(building.frames[name], row, building)


def _turned(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    flags = ("AdvanceAxes", "MirrorAbt2", "MirrorAbt3")
    if any(row.yes(flag, default=False) for flag in flags):
        what = "advanced or mirrored local axes of frames, taken by their angle alone"
        building.account.refuse("advanced axes", row.table, what, [frame.name], row.place)
    return replace(frame, angle=row.number("Angle", 0.0))


def _modified(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    del building
    return replace(frame, modifiers=section_modifiers(row))


def _released(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    ends = tuple(
        frozenset(word for word in RELEASES if row.yes(f"{word}{end}", default=False))
        for end in "IJ"
    )
    if row.yes("PartialFix", default=False):
        what = "partial fixity of end releases, taken as full releases"
        building.account.refuse("partial fixity", row.table, what, [frame.name], row.place)
    forces = {"P", "V2", "V3"}
    if (ends[0] | ends[1]) & forces:
        what = "releases of axial and shear forces, which are passed on"
        building.account.refuse("force releases", row.table, what, [frame.name], row.place)
    return replace(frame, releases=(ends[0] - forces, ends[1] - forces))


def _with_end_zones(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    one = building.units.length
    lengths = []
    for end in "IJ":
        names = (f"Length{end}", f"LengthOff{end}", f"End{end}", f"Offset{end}")
        given = [row.number(name) for name in names if row.has(name)]
        lengths.append(one * given[0] if given else 0.0)
    factor = row.number("RigidFactor", row.number("RigidFact", 0.0))
    if min(lengths) < 0.0 or not 0.0 <= factor <= 1.0:
        message = (
            f'end zones of frame "{frame.name}" must be 0 or longer, and RigidFactor = {factor:g} '
            "between 0 and 1"
        )
        raise row.error(message)
    return replace(frame, end_i=lengths[0], end_j=lengths[1], rigid=factor)


def _inserted(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    one = building.units.length
    number = re.match(r"\s*(\d+)", row.text("CardinalPt", "10"))
    cardinal = int(number[1]) if number else 0
    if not 1 <= cardinal <= 11:
        msg = f'CardinalPt = "{row.text("CardinalPt")}" must begin with 1 to 11'
        raise row.error(msg)
    offsets: list[Vector] = []
    for end in "IJ":
        x, y, z = (one * row.number(f"JtOffset{axis}{end}", 0.0) for axis in "XYZ")
        offsets.append((x, y, z))
    if row.text("CoordSys", "GLOBAL").lower() == "local":
        first, last = (building.joints[name].position for name in (frame.i, frame.j))
        axes = frame_axes(first, last, frame.angle)
        offsets = [_turned_by(axes, offset) for offset in offsets]
    fields = ("StiffTransform", "StiffTrans", "Transform")
    transforms = all(row.yes(field, default=True) for field in fields)
    return replace(
        frame,
        cardinal=cardinal,
        offset_i=offsets[0],
        offset_j=offsets[1],
        transforms=transforms,
    )


def _turned_by(axes: FloatArray, offset: Vector) -> Vector:
    x, y, z = (axes.T @ offset).tolist()
    return (x, y, z)


def _meshed(frame: FrameObject, row: Row, building: Building) -> FrameObject:
    del building
    at_joints = row.yes("AutoMesh", default=True) and row.yes("AtJoints", default=True)
    return replace(frame, meshed=at_joints)


def _read_areas(tables: Tables, building: Building) -> None:
    sections = by_name(tables.rows("AREA SECTION ASSIGNMENTS"), "Area")
    for row in tables.rows(AREAS):
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
    for name, row in by_name(tables.rows("AREA STIFFNESS MODIFIERS"), "Area").items():
        known(row, "Area", name, building.areas)
        in_plane, bending = shell_factors(row, building)
        building.areas[name] = replace(
            building.areas[name],
            in_plane=in_plane,
            bending=bending,
            mass=row.number("MMod", row.number("MassMod", 1.0)),
            weight=row.number("WMod", row.number("WeightMod", 1.0)),
        )
    building.account.read(AREAS, "areas", len(building.areas))


def _read_links(tables: Tables, building: Building) -> None:
    table = "CONNECTIVITY - LINK"
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
        angle = angles[name].number("Angle", 0.0) if name in angles else 0.0
        building.links[name] = LinkObject(
            name, first, None if ground else last, prop, row.place, angle
        )
    building.account.read(table, "links", len(building.links))


def _read_supports(tables: Tables, building: Building) -> None:
    table = "JOINT RESTRAINT ASSIGNMENTS"
    for name, row in by_name(tables.rows(table), "Joint").items():
        known(row, "Joint", name, building.joints)
        held = tuple(ours for field, ours in DOFS if row.yes(field, default=False))
        if held:
            building.restraints[name] = held
    building.account.read(table, "supports", len(building.restraints))
    units = building.units
    table = "JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED"
    for name, row in by_name(tables.rows(table), "Joint").items():
        known(row, "Joint", name, building.joints)
        if row.text("CoordSys", "GLOBAL").upper() not in {"GLOBAL", "LOCAL"}:
            msg = f'spring of joint "{name}" must be given in GLOBAL axes'
            raise row.error(msg)
        values = [row.number(field, 0.0) for field, _ in DOFS]
        if min(values) < 0.0:
            msg = f'a spring of joint "{name}" = {min(values):g} must be 0 or greater'
            raise row.error(msg)
        if any(values):
            scale = [units.line] * 3 + [units.moment] * 3
            building.springs[name] = tuple(a * b for a, b in zip(values, scale, strict=True))
    building.account.read(table, "joint springs", len(building.springs))


def _read_constraints(tables: Tables, building: Building) -> None:
    kinds: dict[str, tuple[str, tuple[str, ...]]] = {}
    head = "CONSTRAINT DEFINITIONS - "
    for kind in ("DIAPHRAGM", "BODY", "EQUAL"):
        for row in tables.rows(head + kind):
            if kind == "DIAPHRAGM" and row.text("Axis", "Z").upper() not in {"Z", "AUTO"}:
                what = "diaphragms that are not horizontal"
                place = row.place
                building.account.refuse("other constraints", row.table, what, ["Axis"], place)
            flags = tuple(ours for _, ours in DOFS if row.yes(ours.upper(), default=True))
            kinds[row.text("Name")] = (kind.lower(), flags)
    joints: dict[str, list[str]] = {}
    table = "JOINT CONSTRAINT ASSIGNMENTS"
    for row in tables.rows(table):
        name = row.text("Constraint")
        kind = row.text("Type", kinds.get(name, ("",))[0]).lower()
        if name not in kinds and kind not in {"diaphragm", "body", "equal"}:
            what = f'a constraint of type "{kind or "not defined"}"'
            building.account.refuse("other constraints", table, what, [name], row.place)
            continue
        kinds.setdefault(name, (kind, tuple(ours for _, ours in DOFS)))
        joints.setdefault(name, []).append(known(row, "Joint", row.text("Joint"), building.joints))
    for name, members in joints.items():
        kind, dofs = kinds[name]
        building.constraints[name] = Constraint(name, kind, tuple(dict.fromkeys(members)), dofs)
    building.account.read(table, "constraints", len(building.constraints))
