"""Links and plastic hinges of a `frames.Frame` by OpenSees' own materials and elements.

Hinges are elements of zero length between a node and a twin of it at the member's end: a section of
the kind Bidirectional where both moments yield, a Steel01 spring where one does, all else stiff.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.model.axes import default_up, local_axes
from frames.model.laws import (
    Bilinear,
    BoucWen,
    HertzStop,
    Law,
    PlasticHinge,
    Stop,
    Tie,
    ViscousDamper,
)

if TYPE_CHECKING:
    from frames import Frame
    from frames._types import FloatArray
    from frames.model.parts import Link, Member

STIFF = 100
"""Stiffness of a hinge before it yields over that of its member [-]: above 100 OpenSees finds no
equilibrium where hinges begin to yield."""

FIRST = 500_000
"""First tag of nodes, materials, sections and elements made here."""


def material(ops: Any, tag: int, law: Law) -> None:
    """Make the uniaxial material of a law; refused with a ValueError where OpenSees has none."""
    if isinstance(law, Bilinear):
        ops.uniaxialMaterial("Steel01", tag, law.yield_force, law.stiffness, law.hardening)
    elif isinstance(law, BoucWen):
        _bouc_wen(ops, tag, law)
    elif isinstance(law, Tie):
        limit = 1e12 if math.isinf(law.yield_force) else law.yield_force
        ops.uniaxialMaterial(
            "ElasticPPGap", tag, law.stiffness, limit, max(law.slack, 1e-12), law.hardening,
            "damage",
        )  # fmt: skip
    elif isinstance(law, ViscousDamper):
        if math.isinf(law.stiffness):
            ops.uniaxialMaterial("Viscous", tag, law.coefficient, law.exponent)
        else:
            ops.uniaxialMaterial("ViscousDamper", tag, law.stiffness, law.coefficient, law.exponent)
    elif isinstance(law, Stop):
        _stop(ops, tag, law)
    else:
        _hertz(ops, tag, law)


def _bouc_wen(ops: Any, tag: int, law: BoucWen) -> None:
    scale = law.yield_deformation**law.exponent
    bent, straight = law.shape / scale, (1.0 - law.shape) / scale
    energy = (1.0 - law.hardening) * law.yield_force * law.yield_deformation
    if law.pinching is None:
        ops.uniaxialMaterial(
            "BoucWen", tag, law.hardening, law.stiffness, law.exponent, straight, bent, 1.0, 0.0,
            law.strength_loss / energy, law.stiffness_loss / energy,
        )  # fmt: skip
        return
    p = law.pinching
    ops.uniaxialMaterial(
        "BWBN", tag, law.hardening, law.stiffness, law.exponent, straight, bent, 1.0, p.place,
        p.slip, p.rate / energy, p.width * law.yield_deformation,
        p.spreading / energy * law.yield_deformation, p.severity, 1e-14, 100,
    )  # fmt: skip


def _stop(ops: Any, tag: int, law: Stop) -> None:
    # OpenSees' gaps close in compression: what is pushed there has negative strains.
    ops.uniaxialMaterial("ViscoelasticGap", tag, law.stiffness, law.damping, -law.gap)


def _hertz(ops: Any, tag: int, law: HertzStop) -> None:
    ops.uniaxialMaterial(
        "Hertzdamp",
        tag,
        law.stiffness,
        0.75 * (1.0 - law.restitution**2),
        -law.gap,
        law.exponent,
    )


def add_links(ops: Any, frame: Frame, nodes: dict[str, int]) -> dict[str, int]:
    """Add the links of a frame that belong to the structure, and all others; return their tags."""
    tags = {}
    for k, link in enumerate(frame.links.values()):
        tag = FIRST + k
        material(ops, tag, link.law)
        add_link(ops, tag, link, nodes)
        tags[link.name] = tag
    return tags


def add_link(ops: Any, tag: int, link: Link, nodes: dict[str, int]) -> None:
    """Add a link whose material has the same tag; gaps face the other way."""
    direction = np.array(link.direction)
    ends = [nodes[link.i], nodes[link.j]]
    if isinstance(link.law, Stop | HertzStop):
        direction = -direction
    across = np.eye(3)[int(np.abs(direction).argmin())]
    across = across - (across @ direction) * direction
    ops.element(
        "twoNodeLink", tag, *ends, "-mat", tag, "-dir", 4 if link.turns else 1,
        "-orient", *direction.tolist(), *across.tolist(),
    )  # fmt: skip


def add_twins(
    ops: Any, frame: Frame, member: Member, number: int, nodes: dict[str, int]
) -> tuple[int, int]:
    """Put hinges at the ends of a member, the `number`-th with hinges; return its end nodes."""
    start, end = (np.array([frame.nodes[name].position]) for name in (member.i, member.j))
    up = default_up(start, end) if member.up is None else np.array([member.up])
    axes, length = local_axes(start, end, up)
    ends = [nodes[member.i], nodes[member.j]]
    for side, hinge in enumerate(frame.hinges[member.name]):
        if hinge is not None:
            tag = hinge_tag(number, side)
            ops.node(tag, *(start, end)[side][0].tolist())
            _hinge(ops, tag, (ends[side], tag), member, hinge, float(length[0]), axes[0])
            ends[side] = tag
    return ends[0], ends[1]


def hinge_tag(number: int, side: int) -> int:
    """Return the tag of the hinge at a side (0, 1) of the `number`-th member with hinges."""
    return FIRST + 100_000 + 2 * number + side


def _hinge(
    ops: Any, tag: int, pair: tuple[int, int], member: Member, hinge: PlasticHinge, length: float,
    axes: FloatArray,
) -> None:  # fmt: skip
    # One hinge between two nodes, stiff but for the moments that yield; its turn against the first
    # node works like the rotation of the end against the node. Materials from 10 * tag on.
    if math.isfinite(hinge.axial):
        msg = f'member "{member.name}": no hinge with axial force is made of OpenSees elements here'
        raise ValueError(msg)
    s = member.section
    bend = [6.0 * s.elastic_modulus * i / length for i in (s.inertia_y, s.inertia_z)]
    turn = STIFF * max(*bend, s.shear_modulus * s.torsion_constant / length)
    ratio = hinge.hardening / (1.0 - hinge.hardening)
    first = 10 * tag
    for k in range(6):
        value = STIFF * s.elastic_modulus * s.area / length if k < 3 else turn
        ops.uniaxialMaterial("Elastic", first + k, value)
    orient = ("-orient", *axes[0].tolist(), *axes[1].tolist())
    moments = (hinge.moment_y, hinge.moment_z)
    if all(math.isfinite(moment) for moment in moments):
        ops.section("Bidirectional", tag, turn, moments[0], 0.0, ratio * bend[0], "Mz", "My")
        ops.section(
            "Aggregator", first, first, "P", first + 1, "Vy", first + 2, "Vz", first + 3, "T",
            "-section", tag,
        )  # fmt: skip
        ops.element("zeroLengthSection", tag, *pair, first, *orient)
        return
    mats = [first + k for k in range(4)]
    for k, moment in enumerate(moments):
        if math.isfinite(moment):
            share = ratio * bend[k] / (turn + ratio * bend[k])
            ops.uniaxialMaterial("Steel01", first + 6 + k, moment, turn, share)
        mats.append(first + 6 + k if math.isfinite(moment) else first + 4 + k)
    ops.element("zeroLength", tag, *pair, "-mat", *mats, "-dir", 1, 2, 3, 4, 5, 6, *orient)
