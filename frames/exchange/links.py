"""Links of an imported building: bearings, springs, dampers, gaps and yielding springs."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, argument, bearing_for
from frames.assembly.assemble import assemble
from frames.exchange.building import LINK_DOFS
from frames.exchange.geometry import frame_axes
from frames.frame import stand
from frames.model.laws import Bilinear, Gap, ViscousDamper
from frames.statics.springs import first_displacement, spring_forces
from lir_element import CoulombFriction, FrictionLaw, LIRBearing, VelocityFriction
from lir_element.elevations import SAME_PLACE
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from frames._types import FloatArray
    from frames.exchange.building import Building, LinkDof, LinkObject, LinkProperty
    from frames.exchange.members import Places
    from frames.frame import Frame
    from frames.model.frame_data import FrameData

SLIDER_HEIGHT, SLIDER_RADIUS = 0.1, 0.15
"""Slider of a bearing made of a friction isolator link, whose file has none [m]."""

UPRIGHT = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Axes of a link between two joints at one place."""

COINCIDENT = 1e-6
"""Distance of two joints below which they have no direction [m]."""

PENDULUM_LINKS = ("friction isolator", "sliding isolator", "friction pendulum")
"""Kinds of links that are friction pendulums."""


def equivalent_bearing(link: LinkProperty, place: str, height: float = 0.0) -> LIRBearing:
    """Return the DCFP equivalent to a friction isolator link.

    Two equal surfaces of radius R_1 with L = 2 R_1 - h, the link's radius. At a displacement u each
    slides by u R_1 / L, and Q/W = 2 mu R_1 / L: so friction coefficients are the link's times L /
    (2 R_1), and the rate parameter is the link's times L / R_1. The slider is rigid, without rims;
    its axial stiffness is that of U1.
    """
    shear = [link.dofs.get(name) for name in ("U2", "U3")]
    found = [dof.values for dof in shear if dof is not None and dof.nonlinear]
    words = ("radius", "slow", "fast", "rate")
    if len(found) < 2 or any(word not in values for values in found for word in words[:3]):
        message = (
            f'{place}: link property "{link.name}" needs nonlinear U2 and U3 with radius and '
            "friction to become a bearing: set the bearing, " + bearing_for(link.name)
        )
        raise ModelError(message)
    pairs = [tuple(values.get(word, 0.0) for word in words) for values in found]
    if not np.allclose(pairs[0], pairs[1], rtol=1e-6) or not pairs[0][0] > 0.0:
        message = (
            f'{place}: link property "{link.name}" must have one positive radius and one friction '
            "in U2 and U3 to become a bearing: set the bearing, " + bearing_for(link.name)
        )
        raise ModelError(message)
    radius, slow, fast, rate = pairs[0]
    slider = min(SLIDER_HEIGHT, height or SLIDER_HEIGHT)
    surface = 0.5 * (radius + slider)
    share = radius / (2.0 * surface)
    law: FrictionLaw = CoulombFriction(share * fast)
    if fast > slow and rate > 0.0:
        law = VelocityFriction(share * fast, share * slow, rate * radius / surface)
    axial = link.dofs.get("U1")
    values = {} if axial is None else axial.values
    stiffness = values.get("stiffness", 0.0) or (0.0 if axial is None else axial.stiffness)
    try:
        return LIRBearing(
            radius=surface,
            slider_height=slider,
            plate_thickness=0.5 * (height - slider) if height else 0.0,
            slider_radius=SLIDER_RADIUS,
            friction=law,
            interface_friction=math.inf,
            capacity=math.inf,
            axial_stiffness=stiffness or None,
        )
    except ValueError as cause:
        message = f'{place}: link property "{link.name}": {cause}'
        raise ModelError(message) from cause


def yield_displacements(frame: FrameData, stiffness: Mapping[str, float]) -> dict[str, LIRBearing]:
    """Return bearings that are as stiff before sliding as the replaced links.

    The strength Q is reached at a displacement of Q / K, at which a surface has slid by its share
    R_i / L; Q is that of fast sliding under the permanent loads.
    """
    system = assemble(frame)
    found = spring_forces(system, first_displacement(system))
    loads = dict(zip((b.name for b in system.bearings), found.tolist(), strict=True))
    mean = float(np.mean([loads[name] for name in stiffness]))
    devices = {}
    for name, before in stiffness.items():
        bearing = frame.bearings[name].bearing
        load = loads[name] if loads[name] > 0.0 else mean
        strength = bearing.effective_friction * load
        slid = strength * bearing.effective_radius / (before * sum(bearing.radii))
        if slid > 0.0:
            devices[name] = replace(bearing, yield_displacement=float(f"{slid:.4g}"))
    return devices


class Links:
    """Adds the links of a building to a frame that has the nodes."""

    def __init__(self, frame: Frame, building: Building, places: Places) -> None:
        self.frame, self.building, self.places = frame, building, places
        self._as: dict[str, list[str]] = {}
        self.stiffness: dict[str, float] = {}  # of isolators before they slide [N/m]

    def add(self) -> None:
        """Add all links."""
        for name, link in self.building.links.items():
            prop = self.building.link_properties[link.property]
            if name in self.places.links:
                self._bearing(link, self.places.links[name])
                self._note("links, in whose place the given bearing stands", name)
            elif prop.kind.lower().startswith(PENDULUM_LINKS):
                self._refuse_unknown(link, prop)
                self._bearing(link, equivalent_bearing(prop, link.place, self._rise(link)))
                self._note_pendulum(link, prop)
            else:
                self._refuse_unknown(link, prop)
                self._plain(link, prop)
        for what, names in self._as.items():
            self.building.account.read_as("links", what, list(dict.fromkeys(names)))

    def _refuse_unknown(self, link: LinkObject, prop: LinkProperty) -> None:
        if prop.unknown:
            what = worded('words of link property "{name}" that are not known here', name=prop.name)
            account = self.building.account
            account.refuse("link properties", "links", what, prop.unknown, link.place)

    def _rise(self, link: LinkObject) -> float:
        # Height of a link between two joints, one above the other.
        if link.j is None:
            return 0.0
        (x, y, z), (u, v, w) = (self.frame.nodes[name].position for name in (link.i, link.j))
        return abs(w - z) if math.hypot(u - x, v - y) < SAME_PLACE else 0.0

    def _note_pendulum(self, link: LinkObject, prop: LinkProperty) -> None:
        as_dcfp = worded(
            "friction isolators, as DCFP of the same radius, friction and stiffness before "
            "sliding, two equal surfaces and a rigid slider of radius {radius:g} m without rims",
            radius=SLIDER_RADIUS,
        )
        self._note(as_dcfp, link.name)
        values = [dof.values for name, dof in prop.dofs.items() if name in {"U2", "U3"}]
        first, last = (value.get("stiffness", 0.0) for value in values)
        if first > 0.0 and math.isclose(first, last, rel_tol=1e-6):
            self.stiffness[link.name] = first
        else:
            what = "friction isolators without one stiffness before sliding, with that of bearings"
            self._note(what, link.name)
        rise = self._rise(link)
        if any(abs(value.get("place", 0.0) - 0.5 * rise) > SAME_PLACE for value in values):
            what = "friction isolators, their shear force at half their height, in place of DJ"
            self._note(what, link.name)

    def _note(self, what: str, name: str) -> None:
        self._as.setdefault(what, []).append(name)

    def _bearing(self, link: LinkObject, device: LIRBearing) -> None:
        frame, joint = self.frame, link.i
        if link.j is None:
            stand(frame, joint, link.name, device, link.name)
            return
        low, high = sorted((link.i, link.j), key=lambda name: frame.nodes[name].z)
        try:
            frame.add_bearing(link.name, low, high, device)
        except ModelError as cause:
            if not self._only_carries(low):
                message = f'{link.place}, link "{link.name}": {cause}{self._plates(link, device)}'
                raise ModelError(message) from cause
            stand(frame, high, link.name, device, link.name)

    def _plates(self, link: LinkObject, device: LIRBearing) -> str:
        rise = self._rise(link) - device.slider_height
        if rise <= 0.0:
            return ""
        plates = argument("plate_thickness", float(f"{0.5 * rise:.6g}"))
        return f"; or let plates fill the height of the link, {plates} of the bearing"

    def _only_carries(self, joint: str) -> bool:
        # A joint of the ground that nothing but this link needs.
        building, frame = self.building, self.frame
        users = [link for link in building.links.values() if joint in {link.i, link.j}]
        ends = {node for member in frame.members.values() for node in (member.i, member.j)}
        return joint in building.restraints and len(users) == 1 and joint not in ends

    def _plain(self, link: LinkObject, prop: LinkProperty) -> None:
        frame, other = self.frame, link.j
        if other is None:
            other = f"ground-{link.name}"
            frame.add_node(other, *frame.nodes[link.i].position)
            frame.fix(other, "all")
            first, last = other, link.i
            axes = UPRIGHT
        else:
            first, last = link.i, other
            ends = [np.array(frame.nodes[name].position) for name in (first, last)]
            apart = float(np.linalg.norm(ends[1] - ends[0]))
            axes = frame_axes(ends[0], ends[1], link.angle) if apart > COINCIDENT else UPRIGHT
        fixed = []
        for k, name in enumerate(LINK_DOFS):
            dof = prop.dofs.get(name)
            if dof is None:
                continue
            if dof.fixed:
                fixed.append((axes[k % 3], k >= 3))
                continue
            at = self._spring_at(link, name, dof, last, axes[0])
            self._dof(link, prop, name, dof, (first, at), axes[k % 3])
        if fixed:
            self._tie(link.name, first, last, fixed)

    def _spring_at(
        self, link: LinkObject, name: str, dof: LinkDof, last: str, along: FloatArray
    ) -> str:
        # Place of a shear spring: at joint j, or on a rigid lever DJ from it towards joint i.
        away = dof.values.get("place", 0.0)
        if name not in {"U2", "U3"} or abs(away) < 1e-6:
            return last
        node = f"{link.name}-{name}-place"
        x, y, z = (np.array(self.frame.nodes[last].position) - away * along).tolist()
        self.frame.add_node(node, x, y, z)
        every = [(axis, turns) for turns in (False, True) for axis in np.eye(3)]
        self._tie(node, last, node, every)
        return node

    def _dof(
        self,
        link: LinkObject,
        prop: LinkProperty,
        name: str,
        dof: LinkDof,
        ends: tuple[str, str],
        axis: FloatArray,
    ) -> None:
        kind, values = prop.kind.lower(), dof.values
        part = f"{link.name}-{name}"
        direction: str | list[float] = axis.tolist()
        turns = name.startswith("R")
        if turns:
            place = int(np.abs(axis).argmax())
            if abs(axis[place]) < 1.0 - 1e-9 and (dof.stiffness or dof.nonlinear):
                message = (
                    f'{link.place}: {name} of link "{link.name}" turns about an axis that is not '
                    "a global one: make the link vertical or horizontal along X or Y"
                )
                raise ModelError(message)
            direction = ("rx", "ry", "rz")[place]
        nonlinear = dof.nonlinear and kind != "linear"

        def needed(word: str) -> float:
            if values.get(word, 0.0) <= 0.0:
                message = (
                    f'{link.place}: {name} of link property "{prop.name}" needs a positive '
                    f"{word} to be nonlinear: give it in that program, or make {name} linear"
                )
                raise ModelError(message)
            return values[word]

        if nonlinear and kind.startswith("gap") and not turns:
            self._note_unused(link, values, {"stiffness", "open"})
            law = Gap(gap=values.get("open", 0.0), stiffness=needed("stiffness"))
            self.frame.add_link(part, *ends, law, (-axis).tolist())
            self._note("gaps, which push only", link.name)
        elif nonlinear and kind.startswith(("rubber", "plastic")):
            self._note_unused(link, values, {"stiffness", "yield", "ratio"})
            law_b = Bilinear(
                stiffness=needed("stiffness"),
                yield_force=needed("yield"),
                hardening=min(values.get("ratio", 0.0), 0.999),
            )
            self.frame.add_link(part, *ends, law_b, direction)
            self._note("yielding links, by each of their directions for itself", link.name)
        elif nonlinear:
            what = worded('links of kind "{kind}", by their linear stiffness', kind=prop.kind)
            account = self.building.account
            account.refuse("nonlinear links", "links", what, [link.name], link.place)
            self._spring(part, ends, axis, dof.stiffness, turns=turns)
        else:
            self._spring(part, ends, axis, dof.stiffness, turns=turns)
        if dof.damping > 0.0 and not nonlinear:
            damper = ViscousDamper(coefficient=dof.damping)
            self.frame.add_link(f"{part}-damper", *ends, damper, direction)

    def _note_unused(
        self, link: LinkObject, values: dict[str, float], used: Collection[str]
    ) -> None:
        for word in sorted(w for w in values if values[w] and w not in {*used, "place"}):
            self._note(f"nonlinear links, without their {word.replace('_', ' ')}", link.name)

    def _spring(
        self, part: str, ends: tuple[str, str], axis: FloatArray, stiffness: float, *, turns: bool
    ) -> None:
        if stiffness <= 0.0:
            return
        along = np.outer(axis, axis) * stiffness
        off = along - np.diag(np.diag(along))
        if np.abs(off).max() > 1e-9 * stiffness:
            message = (
                f'spring "{part}" is not along a global axis: make the link vertical or '
                "horizontal along X or Y, without an angle"
            )
            raise ModelError(message)
        zero = [0.0, 0.0, 0.0]
        values = [*zero, *np.diag(along)] if turns else [*np.diag(along), *zero]
        self.frame.add_spring(part, *ends, [max(float(v), 0.0) for v in values])

    def _tie(self, name: str, i: str, j: str, fixed: list[tuple[FloatArray, bool]]) -> None:
        # No deformation: u_j - u_i - theta_i x r along an axis, theta_j - theta_i about it.
        r = np.subtract(self.frame.nodes[j].position, self.frame.nodes[i].position)
        rows = np.zeros((len(fixed), 12))
        for row, (axis, turns) in zip(rows, fixed, strict=True):
            if turns:
                row[3:6], row[9:12] = -axis, axis
            else:
                row[0:3], row[6:9] = -axis, axis
                row[3:6] = -np.cross(r, axis)
        zero = np.zeros((12, 12))
        self.frame.add_superelement(f"{name}-fixed", [i, j], zero, zero, equations=rows)
