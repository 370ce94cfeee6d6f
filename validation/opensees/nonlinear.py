"""Links and plastic hinges of a `frames.Frame` by OpenSees' own materials and elements.

A member with hinges is a forceBeamColumn with the integration ConcentratedPlasticity: the hinges
are sections at its ends, rigid until they yield as they are here. A section is Bidirectional where
both moments yield, of Steel01 where one does, of four fibres where the axial force takes part.
"""

from __future__ import annotations

import math
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.model.laws import (
    Bilinear,
    BoucWen,
    Gap,
    HertzGap,
    Law,
    PlasticHinge,
    Tie,
    ViscousDamper,
)

if TYPE_CHECKING:
    from frames import Frame
    from frames.model.components import Link, Member

FIRST = 500_000
"""First tag of materials, sections and elements made here."""

SECTIONS = 30
"""Tags that a member with hinges takes."""

ITERATIONS, BALANCE = 100, 1e-14
"""Of a hinged member within itself, and the energy left open there [J]."""


def material(ops: Any, tag: int, law: Law) -> None:
    """Make the uniaxial material of a law; refused with a ValueError where OpenSees has none."""
    if isinstance(law, Bilinear):
        ops.uniaxialMaterial("Steel01", tag, law.yield_force, law.stiffness, law.hardening)
    elif isinstance(law, BoucWen):
        _bouc_wen(ops, tag, law)
    elif isinstance(law, Tie):
        limit = 1e12 if math.isinf(law.yield_force) else law.yield_force
        values = (law.stiffness, limit, max(law.slack, 1e-12), law.hardening)
        ops.uniaxialMaterial("ElasticPPGap", tag, *values, "damage")
    elif isinstance(law, ViscousDamper):
        if math.isinf(law.stiffness):
            ops.uniaxialMaterial("Viscous", tag, law.coefficient, law.exponent)
        else:
            ops.uniaxialMaterial("ViscousDamper", tag, law.stiffness, law.coefficient, law.exponent)
    else:  # OpenSees' gaps close in compression: what is pushed there has negative strains
        kind = "ViscoelasticGap" if isinstance(law, Gap) else "Hertzdamp"
        last = () if isinstance(law, Gap) else (law.exponent,)
        ops.uniaxialMaterial(kind, tag, law.stiffness, law.damping, -law.gap, *last)


def _bouc_wen(ops: Any, tag: int, law: BoucWen) -> None:
    scale = law.yield_deformation**law.exponent
    bent, straight = law.shape / scale, (1.0 - law.shape) / scale
    energy = (1.0 - law.hardening) * law.yield_force * law.yield_deformation
    first = (law.hardening, law.stiffness, law.exponent, straight, bent, 1.0)
    if law.pinching is None:
        losses = (0.0, law.strength_loss / energy, law.stiffness_loss / energy)
        ops.uniaxialMaterial("BoucWen", tag, *first, *losses)
        return
    p, d = law.pinching, law.yield_deformation
    pinched = (p.place, p.slip, p.rate / energy, p.width * d, p.spreading / energy * d, p.severity)
    ops.uniaxialMaterial("BWBN", tag, *first, *pinched, 1e-14, 100)


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
    if isinstance(link.law, Gap | HertzGap):
        direction = -direction
    across = np.eye(3)[int(np.abs(direction).argmin())]
    across = across - (across @ direction) * direction
    way = ("-dir", 4 if link.turns else 1, "-orient", *direction.tolist(), *across.tolist())
    ops.element("twoNodeLink", tag, *ends, "-mat", tag, *way)


def hinged_member(
    ops: Any,
    tag: int,
    member: Member,
    ends: tuple[int, int],
    length: float,
    hinges: tuple[PlasticHinge | None, PlasticHinge | None],
) -> None:
    """Add a member with plastic hinges at its ends; its transformation has the same tag."""
    s = member.section
    first = FIRST + SECTIONS * tag
    elastic = first + SECTIONS - 1
    bending = (s.elastic_modulus, s.area, s.inertia_z, s.inertia_y)
    ops.section("Elastic", elastic, *bending, s.shear_modulus, s.torsion_constant)
    sections = [
        elastic if hinge is None else _hinge(ops, first + 10 * side, member, hinge, length)
        for side, hinge in enumerate(hinges)
    ]
    ops.beamIntegration("ConcentratedPlasticity", tag, *sections, elastic)
    ops.element("forceBeamColumn", tag, *ends, tag, tag, "-iter", ITERATIONS, BALANCE)


def _hinge(ops: Any, first: int, member: Member, hinge: PlasticHinge, length: float) -> int:
    # The section that stands for a hinge, over a length of 1 m: its elastic part is the member's
    # own, so that its plastic curvature is the hinge's rotation. Returns its tag.
    if math.isfinite(hinge.axial):
        return sandwich(ops, first, member, hinge, length)
    s = member.section
    ratio = hinge.hardening / (1.0 - hinge.hardening)
    bend = [s.elastic_modulus * i for i in (s.inertia_y, s.inertia_z)]
    moments = (hinge.moment_y, hinge.moment_z)
    ops.uniaxialMaterial("Elastic", first, s.elastic_modulus * s.area)
    ops.uniaxialMaterial("Elastic", first + 1, s.shear_modulus * s.torsion_constant)
    both = all(math.isfinite(moment) for moment in moments)
    if both:
        if moments[0] != moments[1] or not math.isclose(*bend):
            msg = f'member "{member.name}": Bidirectional is a section with equal axes'
            raise ValueError(msg)
        hardening = 6.0 * ratio * bend[0] / length
        ops.section("Bidirectional", first, bend[0], moments[0], 0.0, hardening, "Mz", "My")
        ops.section("Aggregator", first + 1, first, "P", first + 1, "T", "-section", first)
        return first + 1
    for k, (moment, stiffness) in enumerate(zip(moments, bend, strict=True)):
        modulus = 6.0 * ratio * stiffness / length
        if math.isfinite(moment):
            share = modulus / (stiffness + modulus)
            ops.uniaxialMaterial("Steel01", first + 2 + k, moment, stiffness, share)
        else:
            ops.uniaxialMaterial("Elastic", first + 2 + k, stiffness)
    ops.section("Aggregator", first, first, "P", first + 1, "T", first + 2, "My", first + 3, "Mz")
    return first


def sandwich(ops: Any, first: int, member: Member, hinge: PlasticHinge, length: float) -> int:
    """Make a section of four fibres, which yields at ``|N / axial| + |My / moment_y| = 1``."""
    s = member.section
    across, arm = (math.sqrt(inertia / s.area) for inertia in (s.inertia_z, s.inertia_y))
    fits = math.isclose(hinge.moment_y, hinge.axial * arm) and math.isinf(hinge.moment_z)
    if not fits or hinge.axial_exponent > 1.0 or hinge.axial_centre:
        msg = (
            f'member "{member.name}": fibres make a hinge with moment_y = axial * {arm:.6g} m, '
            "axial_exponent = 1 and axial_centre = 0 only"
        )
        raise ValueError(msg)
    modulus = 6.0 * hinge.hardening / (1.0 - hinge.hardening) * s.elastic_modulus / length
    share = modulus / (s.elastic_modulus + modulus)
    ops.uniaxialMaterial("Steel01", first, hinge.axial / s.area, s.elastic_modulus, share)
    ops.section("Fiber", first, "-GJ", s.shear_modulus * s.torsion_constant)
    for y, z in product((-across, across), (-arm, arm)):
        ops.fiber(y, z, 0.25 * s.area, first)
    return first


def plastic_rotations(ops: Any, tag: int) -> list[tuple[float, float]]:
    """Return the plastic rotations about y and z of a hinged member, at either end [rad]."""
    _, z_i, z_j, y_i, y_j, _ = ops.eleResponse(tag, "plasticDeformation")
    return [(y_i, z_i), (y_j, z_j)]
