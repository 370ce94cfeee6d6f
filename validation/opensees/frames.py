"""A `frames.Frame` as an OpenSees model, its bearings put there by the caller or left out.

Nodes, members, springs, masses, supports and diaphragms are carried over, and permanent loads on
request; members with shear deformation as ElasticTimoshenkoBeam, which takes no notice of P-Delta
(openseespy 3.7.1), others as elasticBeamColumn.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from frames.assembly.assemble import assemble
from frames.model.axes import default_up
from frames.model.components import DOFS
from frames.model.geometry_checks import member_ends
from validation.opensees.model import empty_model, gravity_analysis, permanent_loads
from validation.opensees.nonlinear import add_links, hinged_member
from validation.opensees.runs import Track, respond

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from frames import Frame, GroundMotion
    from frames.model.components import Member
    from lir_element import LIRBearing

PlaceBearing: TypeAlias = Callable[[int, int, int, "LIRBearing"], object]
"""Puts an element with a tag between node i and node j of the model at hand, for a bearing."""


@dataclass(frozen=True)
class Built:
    """Tags of what was built."""

    nodes: dict[str, int]
    members: dict[str, int]
    """By name."""
    bases: tuple[int, ...]
    """Nodes above the bearings, in the frame's order."""
    bearings: tuple[int, ...]
    """Elements of the bearings in that order; none where they were left out."""
    links: dict[str, int]
    """Nonlinear links by name."""


def frame_history(
    frame: Frame,
    place: PlaceBearing,
    motion: GroundMotion,
    dt: float,
    nodes: Sequence[str],
    *,
    duration: float | None = None,
    stiffness_damping: float = 0.0,
) -> Track:
    """Run a frame in OpenSees: gravity, then the ground motion with Newmark's average acceleration."""
    with empty_model() as ops:
        built = build(ops, frame, place)
        add_loads(ops, frame, built)
        gravity_analysis(ops)
        if stiffness_damping > 0.0:
            members = built.members.values()
            ops.region(1, "-ele", *members, "-rayleigh", 0.0, 0.0, stiffness_damping, 0.0)
        chosen = [built.nodes[name] for name in nodes]
        return respond(ops, motion, dt, chosen, built.bearings, duration=duration)


def build(
    ops: Any,
    frame: Frame,
    place: PlaceBearing | None = None,
    *,
    transformation: str = "PDelta",
    diaphragms: Collection[str] | None = None,
) -> Built:
    """Write a frame into an empty model, without its loads."""
    devices = frame.bearings.values()
    left_out = {link.i for link in devices} if place is None else set()
    system = assemble(frame)
    nodes = {name: k for k, name in enumerate((n for n in frame.nodes if n not in left_out), 1)}
    for name, tag in nodes.items():
        ops.node(tag, *frame.nodes[name].position)
        if name in frame.fixed_dofs:
            ops.fix(tag, *(int(dof in frame.fixed_dofs[name]) for dof in DOFS))
        mass = system.node_mass[system.node_names.index(name)]
        if mass.any():
            ops.mass(tag, *mass.tolist())
    for diaphragm in frame.diaphragms.values():
        if diaphragms is None or diaphragm.name in diaphragms:
            ops.rigidDiaphragm(3, *(nodes[name] for name in diaphragm.nodes))
    members = {name: k for k, name in enumerate(frame.members, start=1)}
    for name, member in frame.members.items():
        ends = nodes[member.i], nodes[member.j]
        _member(ops, frame, members[name], member, ends, transformation)
    links = add_links(ops, frame, nodes)
    count = len(members)
    for tag, spring in enumerate(frame.springs.values(), start=count + 1):
        _spring(ops, tag, nodes[spring.i], nodes[spring.j], spring.stiffness)
    count += len(frame.springs)
    bearings = () if place is None else tuple(range(count + 1, count + len(devices) + 1))
    if place is not None:
        for tag, link in zip(bearings, devices, strict=True):
            place(tag, nodes[link.i], nodes[link.j], link.bearing)
    bases = tuple(nodes[link.j] for link in devices)
    return Built(nodes, members, bases, bearings, links)


def add_loads(ops: Any, frame: Frame, built: Built) -> None:
    """Add weights and permanent loads of a frame to the model."""
    system = assemble(frame)
    loads = system.node_load.reshape(-1, len(DOFS))
    permanent_loads(ops)
    for name, tag in built.nodes.items():
        load = loads[system.node_names.index(name)]
        if load.any():
            ops.load(tag, *load.tolist())


def _member(
    ops: Any, frame: Frame, tag: int, member: Member, ends: tuple[int, int], transformation: str
) -> None:
    if any(member.releases):
        msg = f'member "{member.name}" has releases, which are not carried over to OpenSees here'
        raise ValueError(msg)
    start, end = (ends[None, :] for ends in member_ends(frame.nodes, member))
    up = default_up(start, end)[0].tolist() if member.up is None else member.up
    first, second = member.offsets
    zones = ("-jntOffset", *first, *second) if member.has_offsets else ()
    ops.geomTransf(transformation, tag, *up, *zones)
    s = member.section
    if zones and not (math.isinf(s.shear_area_y) and math.isinf(s.shear_area_z)):
        msg = f'member "{member.name}": ElasticTimoshenkoBeam takes no notice of offsets'
        raise ValueError(msg)
    stiff = math.isinf(s.shear_area_y) and math.isinf(s.shear_area_z)
    if member.name in frame.hinges:
        if not stiff or zones:
            msg = f'member "{member.name}": no hinges with shear deformation or offsets here'
            raise ValueError(msg)
        length = float(np.linalg.norm(end - start))
        hinged_member(ops, tag, member, ends, length, frame.hinges[member.name])
    elif stiff:
        own = (s.area, s.elastic_modulus, s.shear_modulus, s.torsion_constant)
        ops.element("elasticBeamColumn", tag, *ends, *own, s.inertia_y, s.inertia_z, tag)
    else:
        own = (s.elastic_modulus, s.shear_modulus, s.area, s.torsion_constant)
        rest = (s.inertia_y, s.inertia_z, s.shear_area_y, s.shear_area_z)
        ops.element("ElasticTimoshenkoBeam", tag, *ends, *own, *rest, tag)


def _spring(ops: Any, tag: int, i: int, j: int, stiffness: Sequence[float]) -> None:
    first = 10 * tag
    for k, value in enumerate(stiffness):
        ops.uniaxialMaterial("Elastic", first + k, value)
    materials = [first + k for k in range(6)]
    way = ("-dir", *range(1, 7), "-orient", 1, 0, 0, 0, 1, 0)
    ops.element("twoNodeLink", tag, i, j, "-mat", *materials, *way)
