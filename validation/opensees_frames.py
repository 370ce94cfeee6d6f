"""A `frames.Frame` as an OpenSees model, its bearings put there by the caller; its time history.

Nodes, members, springs, masses, supports, diaphragms and permanent loads are carried over; members
with shear deformation as ElasticTimoshenkoBeam, others as elasticBeamColumn, both with the
transformation PDelta, which the former takes no notice of (openseespy 3.7.1). Damping: none, or
proportional to the members' stiffness.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from frames.axes import default_up
from frames.parts import DOFS
from validation.opensees_runs import AXES, advance, gravity_analysis, model, shake

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames import Frame, GroundMotion
    from frames._types import FloatArray
    from frames.parts import Member
    from lir_element import LIRBearing

PlaceBearing: TypeAlias = Callable[[int, int, int, "LIRBearing"], object]
"""Puts an element with a tag between node i and node j of the model at hand, for a bearing."""


@dataclass(frozen=True)
class FrameTrack:
    """What a frame did.

    Attributes
    ----------
    time : ndarray, (n,)
        Times [s].
    displacement : ndarray, (n, nodes, 3)
        Of the nodes asked for, relative to the ground [m].
    force : ndarray, (n, bearings, 3)
        Of the bearings on the node above, in the frame's order [N].
    seconds : float
        Time of computation [s].
    loose : int
        Steps with the larger tolerance.
    """

    time: FloatArray
    displacement: FloatArray
    force: FloatArray
    seconds: float
    loose: int


def frame_history(
    frame: Frame,
    place: PlaceBearing,
    motion: GroundMotion,
    dt: float,
    nodes: Sequence[str],
    *,
    duration: float | None = None,
    stiffness_damping: float = 0.0,
) -> FrameTrack:
    """Run a frame in OpenSees: gravity, then the ground motion with Newmark's average acceleration.

    Parameters
    ----------
    frame : Frame
        The structure.
    place : callable
        Puts the element of a bearing.
    motion : GroundMotion
        Acceleration of the ground.
    dt : float
        Step [s].
    nodes : sequence of str
        Nodes whose displacements are handed back.
    duration : float, optional
        Length of the analysis [s]; that of the motion if None.
    stiffness_damping : float
        Damping of members over their stiffness [s]; bearings have no part in it.

    Returns
    -------
    FrameTrack
        At each step.
    """
    with model() as ops:
        tags, bearings = build(ops, frame, place)
        gravity_analysis(ops)
        if stiffness_damping > 0.0:
            members = [tags[f"member {name}"] for name in frame.members]
            ops.region(1, "-ele", *members, "-rayleigh", 0.0, 0.0, stiffness_damping, 0.0)
        shake(ops, motion)
        steps = round((motion.duration if duration is None else duration) / dt)
        time = np.zeros(steps + 1)
        moved = np.zeros((steps + 1, len(nodes), 3))
        force = np.zeros((steps + 1, len(bearings), 3))
        chosen = [tags[f"node {name}"] for name in nodes]
        began, loose = perf_counter(), 0
        for k in range(steps + 1):
            if k:
                loose += advance(ops, 1, dt)
            time[k] = ops.getTime()
            moved[k] = [[ops.nodeDisp(node, axis) for axis in AXES] for node in chosen]
            force[k] = [ops.eleResponse(tag, "force")[6:9] for tag in bearings]
        return FrameTrack(time, moved, force, perf_counter() - began, loose)


def build(ops: Any, frame: Frame, place: PlaceBearing) -> tuple[dict[str, int], list[int]]:
    """Write a frame into an empty model, its permanent loads in a pattern.

    Parameters
    ----------
    ops : module
        OpenSees.
    frame : Frame
        The structure.
    place : callable
        Puts the element of a bearing.

    Returns
    -------
    tags : dict of str to int
        Tags of nodes and members, by "node <name>" and "member <name>".
    bearings : list of int
        Element tags of the bearings, in the frame's order.
    """
    tags = {f"node {name}": k for k, name in enumerate(frame.nodes, start=1)}
    for name, node in frame.nodes.items():
        ops.node(tags[f"node {name}"], *node.position)
    for name, dofs in frame.fixed_dofs.items():
        ops.fix(tags[f"node {name}"], *(int(dof in dofs) for dof in DOFS))
    for diaphragm in frame.diaphragms.values():
        ops.rigidDiaphragm(3, *(tags[f"node {name}"] for name in diaphragm.nodes))
    for k, member in enumerate(frame.members.values(), start=1):
        tags[f"member {member.name}"] = k
        _member(ops, frame, k, member, tags)
    mass = _masses(frame)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for name in frame.nodes:
        weight = np.zeros(6)
        if mass[name].any():
            ops.mass(tags[f"node {name}"], *mass[name].tolist())
            weight[2] = -frame.gravity * mass[name][2]
        load = weight + frame.loads.get(name, np.zeros(6))
        if load.any():
            ops.load(tags[f"node {name}"], *load.tolist())
    count = len(frame.members)
    for k, spring in enumerate(frame.springs.values(), start=count + 1):
        _spring(ops, k, tags[f"node {spring.i}"], tags[f"node {spring.j}"], spring.stiffness)
    count += len(frame.springs)
    bearings = list(range(count + 1, count + len(frame.bearings) + 1))
    for k, link in zip(bearings, frame.bearings.values(), strict=True):
        place(k, tags[f"node {link.i}"], tags[f"node {link.j}"], link.bearing)
    return tags, bearings


def _member(ops: Any, frame: Frame, tag: int, member: Member, tags: dict[str, int]) -> None:
    ends = [np.array([frame.nodes[name].position]) for name in (member.i, member.j)]
    up = default_up(*ends)[0].tolist() if member.up is None else member.up
    ops.geomTransf("PDelta", tag, *up)
    s, nodes = member.section, (tags[f"node {member.i}"], tags[f"node {member.j}"])
    if math.isinf(s.shear_area_y) and math.isinf(s.shear_area_z):
        ops.element(
            "elasticBeamColumn", tag, *nodes, s.area, s.elastic_modulus, s.shear_modulus,
            s.torsion_constant, s.inertia_y, s.inertia_z, tag,
        )  # fmt: skip
    else:
        ops.element(
            "ElasticTimoshenkoBeam", tag, *nodes, s.elastic_modulus, s.shear_modulus, s.area,
            s.torsion_constant, s.inertia_y, s.inertia_z, s.shear_area_y, s.shear_area_z, tag,
        )  # fmt: skip


def _spring(ops: Any, tag: int, i: int, j: int, stiffness: Sequence[float]) -> None:
    first = 10 * tag
    for k, value in enumerate(stiffness):
        ops.uniaxialMaterial("Elastic", first + k, value)
    materials = [first + k for k in range(6)]
    ops.element(
        "twoNodeLink", tag, i, j, "-mat", *materials, "-dir", 1, 2, 3, 4, 5, 6,
        "-orient", 1, 0, 0, 0, 1, 0,
    )  # fmt: skip


def _masses(frame: Frame) -> dict[str, FloatArray]:
    # Lumped masses and half of each member's at its ends.
    mass = {name: np.array(frame.masses.get(name, np.zeros(6))) for name in frame.nodes}
    for member in frame.members.values():
        ends = [np.array(frame.nodes[name].position) for name in (member.i, member.j)]
        half = 0.5 * member.section.density * member.section.area * math.dist(*ends)
        for name in (member.i, member.j):
            mass[name][:3] += half
    return mass
