"""Nonlinear parts of a frame as arrays: their deformations, constants and elastic stiffness."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from frames.assembly.members import at_ends, local_geometric_stiffness, local_stiffness
from frames.assembly.system import (
    BILINEAR,
    BOUC_WEN,
    CONSTANTS,
    HERTZ,
    HINGE,
    HINGED,
    HINGES,
    MAXWELL,
    STOP,
    STRIDE,
    TIE,
    VISCOUS,
    NonlinearParts,
)
from frames.model.laws import (
    Bilinear,
    BoucWen,
    Gap,
    Law,
    PlasticHinge,
    Tie,
    ViscousDamper,
    elastic_stiffness,
)

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.system import MemberTable
    from frames.model.components import Link
    from frames.model.frame_data import FrameData

BASIC = np.array([6, 5, 11, 4, 10])
"""Places among a member's 12 local displacements of its five deformations, the rest being held."""


def nonlinear_parts(
    frame: FrameData, index: dict[str, int], coordinates: FloatArray, members: MemberTable
) -> NonlinearParts:
    """Gather the nonlinear parts of a frame.

    Shapes: coordinates (n_nodes, 3).
    """
    links, hinged = tuple(frame.links.values()), tuple(frame.hinges)
    kind, par, elastic, scale = [], [], [], []
    rows: list[FloatArray] = []
    for link in links:
        number, constants = _law(link.law)
        kind.append(number)
        par.append(constants)
        elastic.append(elastic_stiffness(link.law))
        scale.append(1.0)
        rows.append(_link_row(link, index, coordinates)[None])
    stiffness = local_stiffness(members.arrays) if hinged else np.zeros((0, 12, 12))
    fixed_end = at_ends(members.fixed_end, members.arms)
    for name in hinged:
        place = members.names.index(name)
        length = float(members.arrays.length[place])
        kind.append(HINGES)
        par.append(_hinges(stiffness[place], fixed_end[place], frame.hinges[name]))
        elastic.extend([HINGED] * 5)
        scale.extend([1.0, *[1.0 / length] * 4])
        rows.append(_basic_rows(members, place, length, len(index)))
    widths = np.array([len(row) for row in rows], dtype=np.int64)
    return NonlinearParts(
        links=links,
        hinged=hinged,
        kind=np.array(kind, dtype=np.int64),
        first=np.concatenate([[0], np.cumsum(widths)]).astype(np.int64),
        par=np.array(par, dtype=np.float64).reshape(-1, CONSTANTS),
        elastic=np.array(elastic, dtype=np.float64),
        scale=np.array(scale, dtype=np.float64),
        node_rows=sparse.csr_array(np.concatenate(rows) if rows else np.zeros((0, 6 * len(index)))),
    )


def with_axial_forces(
    parts: NonlinearParts, members: MemberTable, axial_forces: FloatArray
) -> NonlinearParts:
    """Return the parts with the geometric stiffness of the hinged members.

    A hinge rotates the member's end against its node, so that the geometric stiffness acts on the
    rest: a member with rotating hinges at both ends stays straight.

    Shapes: axial_forces (n_members,).
    """
    if not parts.hinged:
        return parts
    own = local_geometric_stiffness(members.arrays, axial_forces)
    whole = local_stiffness(members.arrays) + own
    rows, par = parts.node_rows.tolil(copy=True), parts.par.copy()
    for k, name in enumerate(parts.hinged, start=len(parts.links)):
        place = members.names.index(name)
        basic = whole[place][np.ix_(BASIC, BASIC)]
        par[k, :25] = basic.ravel()
        to_five = np.linalg.solve(basic, whole[place][BASIC])
        five = slice(parts.first[k], parts.first[k + 1])
        rows[five, members.dofs[place]] = _globally(to_five, members, place)
    return replace(parts, par=par, node_rows=sparse.csr_array(rows))


def _law(law: Law) -> tuple[int, FloatArray]:
    # Its number and constants, in the order frames/kernels/laws.py reads them.
    values: tuple[float, ...]
    if isinstance(law, Bilinear):
        kind, values = BILINEAR, (law.stiffness, law.yield_force, _modulus(law))
    elif isinstance(law, BoucWen):
        kind = BOUC_WEN
        values = (
            law.stiffness,
            law.hardening,
            law.exponent,
            law.shape,
            law.strength_loss,
            law.stiffness_loss,
            law.yield_deformation,
        )
        pinch = law.pinching
        if pinch is not None:
            values += (
                pinch.slip,
                pinch.rate,
                pinch.place,
                pinch.width,
                pinch.spreading,
                pinch.severity,
            )
    elif isinstance(law, Tie):
        kind, values = TIE, (law.stiffness, law.yield_force, _modulus(law), law.slack)
    elif isinstance(law, ViscousDamper):
        kind = VISCOUS if law.stiffness == math.inf else MAXWELL
        values = (law.coefficient, law.exponent, law.linear_below, law.stiffness)
    elif isinstance(law, Gap):
        kind, values = STOP, (law.gap, law.stiffness, law.damping, law.soft)
    else:
        kind, values = HERTZ, (law.gap, law.stiffness, law.exponent, law.damping)
    return kind, _padded(values)


def _modulus(law: Bilinear | Tie) -> float:
    # Plastic modulus, with which the stiffness after yielding is the hardening's share.
    return law.hardening / (1.0 - law.hardening) * law.stiffness


def _padded(values: tuple[float, ...]) -> FloatArray:
    constants = np.zeros(CONSTANTS)
    constants[: len(values)] = values
    return constants


def _link_row(link: Link, index: dict[str, int], coordinates: FloatArray) -> FloatArray:
    # Its deformation from all nodal displacements: it sits at node j, with a rigid lever to i.
    i, j = index[link.i], index[link.j]
    row = np.zeros(6 * len(index))
    direction = np.array(link.direction)
    at = 3 if link.turns else 0
    row[6 * j + at : 6 * j + at + 3] += direction
    row[6 * i + at : 6 * i + at + 3] -= direction
    if not link.turns:
        row[6 * i + 3 : 6 * i + 6] -= np.cross(coordinates[j] - coordinates[i], direction)
    return row


def _basic_rows(members: MemberTable, place: int, length: float, n_nodes: int) -> FloatArray:
    # The five deformations of a member from all nodal displacements.
    local = np.zeros((5, 12))
    local[0, [0, 6]] = -1.0, 1.0
    for row, turn in ((1, 5), (2, 11)):
        local[row, turn] = 1.0
        local[row, [1, 7]] = 1.0 / length, -1.0 / length
    for row, turn in ((3, 4), (4, 10)):
        local[row, turn] = 1.0
        local[row, [2, 8]] = -1.0 / length, 1.0 / length
    rows = np.zeros((5, 6 * n_nodes))
    rows[:, members.dofs[place]] = _globally(local, members, place)
    return rows


def _globally(local: FloatArray, members: MemberTable, place: int) -> FloatArray:
    # Rows over a member's 12 local displacements as rows over its nodes' displacements.
    turned = np.kron(np.eye(4), members.arrays.axes[place])
    return np.asarray(local @ members.follow[place] @ turned)


def _hinges(
    stiffness: FloatArray,
    fixed_end: FloatArray,
    ends: tuple[PlasticHinge | None, PlasticHinge | None],
) -> FloatArray:
    # Constants of a hinged member: stiffness and permanent parts of its five forces, its hinges.
    basic = stiffness[np.ix_(BASIC, BASIC)]
    constants = np.zeros(CONSTANTS)
    constants[:25] = basic.ravel()
    constants[25:30] = fixed_end[BASIC]
    constants[25] = 0.5 * (fixed_end[6] - fixed_end[0])
    for end, hinge in enumerate(ends):
        if hinge is None:
            continue
        ratio = hinge.hardening / (1.0 - hinge.hardening)
        bent = basic[[1, 3], [1, 3]] + basic[[1, 3], [2, 4]]  # 6 E I / L about z and y
        axial = ratio * basic[0, 0] if math.isfinite(hinge.axial) else 0.0
        at = HINGE + STRIDE * end
        constants[at : at + 9] = (
            1.0 / hinge.axial,
            1.0 / hinge.moment_y,
            1.0 / hinge.moment_z,
            hinge.axial_centre,
            hinge.axial_exponent,
            axial,
            ratio * bent[1],
            ratio * bent[0],
            1.0,
        )
    return constants
