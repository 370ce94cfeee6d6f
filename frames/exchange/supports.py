"""Supports, springs, constraints and bearings of an imported building."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames._remedies import argument
from frames.model.components import DOFS, bearing_height
from frames.model.editing import stand
from lir_element.elevations import SAME_PLACE, by_elevation

if TYPE_CHECKING:
    from frames.exchange.building import Building, Constraint
    from frames.exchange.import_report import Options
    from frames.model.editing import FrameEditor
    from lir_element import LIRBearing


class Places:
    """Where bearings stand: under joints, and in place of links."""

    def __init__(self, building: Building, options: Options) -> None:
        self._building = building
        self.joints: dict[str, LIRBearing] = {}
        self.links: dict[str, LIRBearing] = {}
        given = options.bearing
        if given is None:
            return
        if isinstance(given, Mapping):
            for name, device in given.items():
                self._put(name, device)
        elif options.at is None:
            for joint in standing(building):
                self.joints[joint] = given
        else:
            for name in options.at:
                self._put(name, given)
        for name, device in {**self.joints, **self.links}.items():
            bearing_height(name, device)
        if not self.joints and not self.links:
            low = min((joint.z for joint in building.joints.values()), default=0.0)
            some = [*building.groups, *building.link_properties]
            some += [n for n, joint in building.joints.items() if joint.z - low < SAME_PLACE]
            message = (
                f"{building.account.file} has no joint that is restrained vertically to put a "
                "bearing under: name groups, joints, links or link properties, "
                f"{argument('at', some[:4])}"
            )
            raise ModelError(message)

    def _put(self, name: str, device: LIRBearing) -> None:
        building = self._building
        joints: list[str] = []
        links: list[str] = []
        if name in building.groups:
            held = set(standing(building))
            members = building.groups[name]
            joints = [label for kind, label in members if kind == "joint" and label in held]
            links = [label for kind, label in members if kind == "link"]
        elif name in building.link_properties:
            links = [k for k, link in building.links.items() if link.property == name]
        elif name in building.links:
            links = [name]
        elif name in building.joints:
            joints = [name]
        else:
            message = (
                f'"{name}" is no group, link property, link or joint of {building.account.file}: '
                f"it has groups {', '.join(building.groups) or 'none'}, link properties "
                f"{', '.join(building.link_properties) or 'none'}"
            )
            raise ModelError(message)
        if not joints and not links:
            message = f'"{name}" of {building.account.file} has no restrained joint and no link'
            raise ModelError(message)
        for place, found in ((self.joints, joints), (self.links, links)):
            for each in found:
                if each in place:
                    message = f'"{each}" would get two bearings: it belongs to "{name}" and others'
                    raise ModelError(message)
                place[each] = device


def standing(building: Building) -> list[str]:
    """Return the joints that are restrained vertically and in plan."""
    return [name for name, held in building.restraints.items() if "uz" in held and "ux" in held]


def add_supports(
    frame: FrameEditor, building: Building, places: Places, options: Options
) -> list[str]:
    """Fix supports, put bearings under joints, add springs to the ground."""
    stay, turned = [joint for joint in building.restraints if joint not in places.joints], []
    for joint, held in building.restraints.items():
        if joint not in places.joints:
            frame.fix(joint, *held)
    if places.joints or places.links:
        what = "supports that stay as they are, beside bearings"
        building.account.read_as("supports", what, stay)
    for joint, device in places.joints.items():
        stand(frame, joint, f"bearing-{joint}", device, joint)
        held = building.restraints.get(joint, ())
        turns = [dof for dof in ("rx", "ry") if dof in held]
        if options.base_rotations != "kept":
            turns = ["rx", "ry"] if options.base_rotations == "fixed" else []
        if turns:
            frame.fix(joint, *turns)
            turned.append(joint)
    if places.joints:
        what = "supports, each of them a bearing on the ground"
        building.account.read_as("supports", what, list(places.joints))
    for joint, stiffness in building.springs.items():
        frame.add_node(f"spring-{joint}", *frame.nodes[joint].position)
        frame.fix(f"spring-{joint}", "all")
        frame.add_spring(f"spring-{joint}", f"spring-{joint}", joint, stiffness)
    what = "joints on bearings whose rotations are held, as stiff beams at the base would"
    building.account.read_as("supports", what, turned)
    return turned


def add_constraints(
    frame: FrameEditor, building: Building, places: Places, options: Options
) -> None:
    """Add diaphragms, bodies and equal displacements, and a base diaphragm over bearings."""
    plain = []
    for constraint in building.constraints.values():
        joints = [joint for joint in constraint.joints if joint in frame.nodes]
        if constraint.kind == "diaphragm":
            free = [j for j in joints if not {"ux", "uy"} <= frame.fixed_dofs.get(j, frozenset())]
            for k, group in enumerate(levels_of(frame, free)):
                name = constraint.name if k == 0 else f"{constraint.name}-{k + 1}"
                if len(group) > 1:
                    frame.add_diaphragm(name, group)
        elif len(joints) > 1:
            _add_ties(frame, constraint, joints)
        if len(joints) < 2:
            plain.append(constraint.name)
    building.account.left_out("constraints", "of fewer than two joints", plain)
    if options.base_diaphragm and places.joints:
        _add_base(frame, building, list(places.joints))


def _add_base(frame: FrameEditor, building: Building, joints: list[str]) -> None:
    taken = {node for part in frame.diaphragms.values() for node in part.nodes}
    for k, group in enumerate(levels_of(frame, joints)):
        if len(group) > 1 and not taken.intersection(group):
            frame.add_diaphragm("base" if k == 0 else f"base-{k + 1}", group)
            what = "joints on bearings at one elevation, which move in plan as one body"
            building.account.read_as("supports", what, group)


def levels_of(frame: FrameEditor, joints: list[str]) -> list[list[str]]:
    """Return nodes by their elevation, from below."""
    return by_elevation({joint: frame.nodes[joint].z for joint in joints})


def _add_ties(frame: FrameEditor, constraint: Constraint, joints: list[str]) -> None:
    # A body: u_n = u_m + theta_m x r, theta_n = theta_m; equal: u_n = u_m; for the named ones.
    size = 6 * len(joints)
    first = np.array(frame.nodes[joints[0]].position)
    rows = []
    for k, joint in enumerate(joints[1:], start=1):
        follow = np.eye(6)
        if constraint.kind == "body":
            x, y, z = np.array(frame.nodes[joint].position) - first
            follow[0:3, 3:6] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
        for axis, dof in enumerate(DOFS):
            if dof in constraint.dofs:
                row = np.zeros(size)
                row[6 * k + axis] = 1.0
                row[0:6] -= follow[axis]
                rows.append(row)
    zero = np.zeros((size, size))
    frame.add_superelement(constraint.name, joints, zero, zero, equations=np.array(rows))
