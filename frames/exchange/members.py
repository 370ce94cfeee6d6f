"""From a building's members, supports and constraints to the parts of a frame."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, argument
from frames.exchange.building import Modifiers
from frames.frame import stand
from frames.model.components import DOFS, bearing_height
from frames.model.sections import Section
from lir_element.elevations import SAME_PLACE, by_elevation

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.building import Building, Constraint, FrameObject, LineLoad
    from frames.exchange.geometry import SplitMember
    from frames.exchange.import_report import Options
    from frames.frame import Frame
    from frames.model.loading import FrameLoader
    from lir_element import LIRBearing


LEAST_FACTOR = 1e-6
"""Factor that replaces zero on a stiffness [-]."""

MOMENTS = {"T": "T", "M2": "Mz", "M3": "My"}
"""Releases of the programs and those of members: local z is axis 2, local y is -3."""

_GAUSS = ((0.5 - 0.5 / math.sqrt(3.0), 0.5), (0.5 + 0.5 / math.sqrt(3.0), 0.5))


class Sections:
    """Sections of members by their sources, each made once."""

    def __init__(self, building: Building) -> None:
        self._building = building
        self._made: dict[tuple[str, str, Modifiers], Section] = {}
        self.softened: set[str] = set()

    def of(self, frame: FrameObject) -> Section:
        """Return the section of a frame object, without density: masses and weights are apart."""
        given = self._building.sections[frame.section]
        material = frame.material or given.material
        key = (frame.section, material, frame.modifiers)
        if key not in self._made:
            self._made[key] = self._make(frame, material)
        return self._made[key]

    def _make(self, frame: FrameObject, material: str) -> Section:
        given = self._building.sections[frame.section]
        if material not in self._building.materials:
            message = (
                f'{frame.place}: section "{given.name}" of frame "{frame.name}" has material '
                f'"{material}", which is not defined: export the tables of materials'
            )
            raise ModelError(message)
        matter = self._building.materials[material]
        factors = given.modifiers.times(frame.modifiers)
        stiff = factors.all()[:6]
        if min(stiff) < LEAST_FACTOR:
            self.softened.add(frame.section)
        a, s2, s3, j, i2, i3 = (max(value, LEAST_FACTOR) for value in stiff)
        torsion = given.torsion or LEAST_FACTOR * (given.inertia_33 + given.inertia_22)
        try:
            return Section(
                area=a * given.area,
                inertia_y=i3 * given.inertia_33,
                inertia_z=i2 * given.inertia_22,
                torsion_constant=j * torsion,
                elastic_modulus=matter.elastic_modulus,
                shear_modulus=matter.shear_modulus,
                shear_area_y=s3 * given.shear_3,
                shear_area_z=s2 * given.shear_2,
            )
        except ModelError as cause:
            message = f'section "{given.name}" of frame "{frame.name}" ({frame.place}): {cause}'
            raise ModelError(message) from cause


def add_members(frame: Frame, divided: list[SplitMember], sections: Sections) -> None:
    """Add the members of all frame objects to a frame that has their nodes."""
    for one in divided:
        given, last = one.frame, len(one.nodes) - 2
        for place, name in enumerate(one.members):
            low, high = one.flexible(place)
            i, j = one.nodes[place], one.nodes[place + 1]
            offsets = {
                end: (one.at(share) - np.array(frame.nodes[node].position))
                for end, share, node in (("i", low, i), ("j", high, j))
            }
            small = {end: vector for end, vector in offsets.items() if np.abs(vector).max() > 1e-9}
            ends = (
                given.releases[0] if place == 0 else (),
                given.releases[1] if place == last else (),
            )
            releases = {
                end: [MOMENTS[word] for word in sorted(words)]
                for end, words in zip("ij", ends, strict=True)
                if words
            }
            try:
                frame.add_member(
                    name,
                    i,
                    j,
                    sections.of(given),
                    up=one.axes[1].tolist(),
                    releases=releases or None,
                    offsets={end: vector.tolist() for end, vector in small.items()} or None,
                )
            except ModelError as cause:
                message = f'{given.place}, frame "{given.name}": {cause}'
                raise ModelError(message) from cause


def add_line_load(
    frame: FrameLoader, one: SplitMember, load: LineLoad, factor: float, case: str
) -> None:
    """Add a load along a frame object, or a force on it, to its members and nodes.

    The load on a stiff zone goes to its node as a force and a moment.
    """
    if load.point:
        place = int(np.abs(one.shares - load.a).argmin())
        node = one.nodes[place]
        force = factor * np.array(load.start)
        arm = one.at(load.a) - np.array(frame.nodes[node].position)
        frame.add_load(node, np.concatenate([force, np.cross(arm, force)]).tolist(), case=case)
        return
    for place, member in enumerate(one.members):
        low, high = one.flexible(place)
        ends = float(one.shares[place]), float(one.shares[place + 1])
        a, b = max(load.a, low), min(load.b, high)
        if b - a > 1e-9:
            _on_member(frame, one, load, (low, high), (a, b), member, factor, case)
        for zone, node in (
            ((ends[0], low), one.nodes[place]),
            ((high, ends[1]), one.nodes[place + 1]),
        ):
            a, b = max(load.a, zone[0]), min(load.b, zone[1])
            if b - a > 1e-9:
                at = np.array(frame.nodes[node].position)
                forces = factor * _resultant(one, load, a, b, at)
                frame.add_load(node, forces.tolist(), case=case)


def _size(load: LineLoad, share: float) -> FloatArray:
    start, end = np.array(load.start), np.array(load.end)
    found: FloatArray = start + (share - load.a) / (load.b - load.a) * (end - start)
    return found


def _on_member(
    frame: FrameLoader,
    one: SplitMember,
    load: LineLoad,
    flexible: tuple[float, float],
    part: tuple[float, float],
    member: str,
    factor: float,
    case: str,
) -> None:
    low, high = flexible
    true = float(np.linalg.norm(one.way)) * (high - low)
    scale = factor * one.length * (high - low) / true
    first, last = (scale * _size(load, share) for share in part)
    whole = part[0] - low < 1e-9 and high - part[1] < 1e-9
    if whole and np.array_equal(first, last):
        frame.add_uniform_load(member, first.tolist(), case=case)
        return
    a, b = (true * (share - low) / (high - low) for share in part)
    frame.add_tapered_load(member, first.tolist(), last.tolist(), a, min(b, true), case=case)


def _resultant(one: SplitMember, load: LineLoad, a: float, b: float, at: FloatArray) -> FloatArray:
    # Force and moment about a node of the part from a to b: by two Gauss points, which is exact.
    found = np.zeros(6)
    for place, weight in _GAUSS:
        share = a + place * (b - a)
        force = weight * (b - a) * one.length * _size(load, share)
        found += np.concatenate([force, np.cross(one.at(share) - at, force)])
    return found


class Places:
    """Places of bearings: under joints, and instead of links."""

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
                f"{building.account.file} has no vertically restrained joint for a bearing: "
                f"name groups, joints, links or link properties, {argument('at', some[:4])}"
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
                f'"{name}" is not a group, link property, link or joint of '
                f"{building.account.file}: its groups are "
                f"{', '.join(building.groups) or 'none'}, its link properties "
                f"{', '.join(building.link_properties) or 'none'}"
            )
            raise ModelError(message)
        if not joints and not links:
            message = (
                f'"{name}" of {building.account.file} has no restrained joint and no '
                "link: name another place for the bearing"
            )
            raise ModelError(message)
        for place, found in ((self.joints, joints), (self.links, links)):
            for each in found:
                if each in place:
                    message = (
                        f'"{each}" would get two bearings: it belongs to "{name}" and '
                        "others. Name it once"
                    )
                    raise ModelError(message)
                place[each] = device


def standing(building: Building) -> list[str]:
    """Return the joints that are restrained vertically and in plan."""
    return [name for name, held in building.restraints.items() if "uz" in held and "ux" in held]


def add_supports(frame: Frame, building: Building, places: Places, options: Options) -> list[str]:
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
    idle = []
    for joint, stiffness in building.springs.items():
        held = building.restraints.get(joint, ())
        acting = [0.0 if dof in held else k for dof, k in zip(DOFS, stiffness, strict=True)]
        if acting != list(stiffness):
            idle.append(joint)
        if any(acting):
            frame.add_node(f"spring-{joint}", *frame.nodes[joint].position)
            frame.fix(f"spring-{joint}", "all")
            frame.add_spring(f"spring-{joint}", f"spring-{joint}", joint, acting)
    what = "springs of displacements that supports hold, which do nothing in the file either"
    building.account.left_out("supports", what, idle)
    what = "joints on bearings whose rotations are held, as stiff beams at the base would"
    building.account.read_as("supports", what, turned)
    return turned


def add_constraints(frame: Frame, building: Building, places: Places, options: Options) -> None:
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


def _add_base(frame: Frame, building: Building, joints: list[str]) -> None:
    taken = {node for part in frame.diaphragms.values() for node in part.nodes}
    for k, group in enumerate(levels_of(frame, joints)):
        if len(group) > 1 and not taken.intersection(group):
            frame.add_diaphragm("base" if k == 0 else f"base-{k + 1}", group)
            what = "joints on bearings at one elevation, which move in plan as one body"
            building.account.read_as("supports", what, group)


def levels_of(frame: Frame, joints: list[str]) -> list[list[str]]:
    """Return nodes by their elevation, from below."""
    return by_elevation({joint: frame.nodes[joint].z for joint in joints})


def _add_ties(frame: Frame, constraint: Constraint, joints: list[str]) -> None:
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
