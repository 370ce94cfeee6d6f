"""From divided frame objects to members of a frame, with their loads and masses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.building import Modifiers
from frames.model.sections import Section

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.building import Building, FrameObject, LineLoad
    from frames.exchange.member_splitting import SplitMember
    from frames.model.editing import FrameEditor
    from frames.model.loading import FrameLoader

LEAST_FACTOR = 1e-6
"""Factor on a stiffness that stands for none [-]."""

MOMENTS = {"T": "T", "M2": "Mz", "M3": "My"}
"""Releases of the programs and those of members: local z is axis 2, local y is -3."""

_GAUSS = ((0.5 - 0.5 / math.sqrt(3.0), 0.5), (0.5 + 0.5 / math.sqrt(3.0), 0.5))


class Sections:
    """Sections of members by what they are made of, each made once."""

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


def add_members(frame: FrameEditor, divided: list[SplitMember], sections: Sections) -> None:
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

    What acts on a stiff zone goes to its node as a force and a moment.
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
