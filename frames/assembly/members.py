r"""Elastic 3-D beam-column and 6-component spring, as plain functions of arrays.

All functions work on `n` members at once. A member joins node i to node j; its 12 displacements
are those of node i, then of node j, each (ux, uy, uz, rx, ry, rz). Forces act on the member's
ends, positive along the positive displacement.

Local axes: see `frames.model.axes`; `inertia_y` governs bending in the local x-z plane.

Sources: Przemieniecki, Theory of Matrix Structural Analysis (1968), sec. 5.6 and ch. 15 [Prz68];
McGuire, Gallagher & Ziemian, Matrix Structural Analysis, 2nd ed. (2000), ch. 4 and 9 [MGZ00].

End zones are rigid: a member's end is at the vector d from its node, the rigid arm that rotates
with the node: its displacement is :math:`u + \theta \times d`, its rotation that of the node.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.model.axes import local_axes

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.sections import Section


def rigid_arms(arms: FloatArray) -> FloatArray:
    """Return how the displacements of members' ends follow those of their nodes.

    Shapes: arms (n, 2, 3), result (n, 12, 12).
    """
    follow = np.tile(np.eye(12), (len(arms), 1, 1))
    for end in (0, 1):
        x, y, z = arms[:, end].T
        u, turn = 6 * end, 6 * end + 3
        follow[:, u, turn + 1], follow[:, u, turn + 2] = z, -y
        follow[:, u + 1, turn], follow[:, u + 1, turn + 2] = -z, x
        follow[:, u + 2, turn], follow[:, u + 2, turn + 1] = y, -x
    return follow


def at_ends(forces: FloatArray, arms: FloatArray) -> FloatArray:
    """Return forces on the ends of members from the same forces taken on their nodes.

    Shapes: forces (..., n, 12), arms (n, 2, 3), result (..., n, 12).
    """
    if not arms.any():
        return forces
    found = forces.copy()
    for end in (0, 1):
        force = slice(6 * end, 6 * end + 3)
        moment = slice(6 * end + 3, 6 * end + 6)
        found[..., moment] -= np.cross(arms[:, end], forces[..., force])
    return found


def arms_geometric_stiffness(arms: FloatArray, axial_force: FloatArray) -> FloatArray:
    r"""Return the geometric stiffness of rigid arms under the axial forces of their members.

    To second order an arm d that rotates by :math:`\theta` moves its end by :math:`\theta \times
    (\theta \times d) / 2`. The work of the axial force along e on that is the stiffness :math:`\pm
    P (e d^T / 2 + d e^T / 2 - e \cdot d \, I)` on the node's rotation, plus at end j. A rigid
    column that leans with its node is the simplest case: P d.

    Shapes: arms (n, 2, 3), axial_force (n,), result (n, 12, 12).
    """
    found = np.zeros((len(arms), 12, 12))
    for end, sign in ((0, -1.0), (1, 1.0)):
        block = np.zeros((len(arms), 3, 3))
        block[:, 0] += 0.5 * arms[:, end]
        block[:, :, 0] += 0.5 * arms[:, end]
        block -= arms[:, end, 0, None, None] * np.eye(3)
        places = slice(6 * end + 3, 6 * end + 6)
        found[:, places, places] = sign * axial_force[:, None, None] * block
    return found


# Places of (v_i, slope_i, v_j, slope_j) of each bending plane in the 12 local displacements, and
# the sign that turns the rotation into the slope: dv/dx = +rz, dw/dx = -ry.
_PLANE_XY = np.array([1, 5, 7, 11])
_PLANE_XZ = np.array([2, 4, 8, 10])
_SIGN_XZ = np.array([1.0, -1.0, 1.0, -1.0])


class MemberArrays(NamedTuple):
    """Constants of `n` members, each field (n,) except `axes`; units as in `Section`."""

    area: FloatArray
    inertia_y: FloatArray
    inertia_z: FloatArray
    torsion_constant: FloatArray
    elastic_modulus: FloatArray
    shear_modulus: FloatArray
    shear_area_y: FloatArray  # infinity without shear deformation
    shear_area_z: FloatArray
    density: FloatArray
    length: FloatArray
    axes: FloatArray
    """(n, 3, 3) rows are the unit vectors of local x, y, z in global components [-]."""


def member_arrays(
    sections: Sequence[Section], start: FloatArray, end: FloatArray, up: FloatArray
) -> MemberArrays:
    """Gather the constants of members into arrays.

    Shapes: sections (n,), start, end (n, 3), up (n, 3).
    """
    axes, length = local_axes(start, end, up)
    names = [name for name in MemberArrays._fields if name not in {"length", "axes"}]
    values = {
        name: np.array([getattr(section, name) for section in sections], dtype=np.float64)
        for name in names
    }
    return MemberArrays(**values, length=length, axes=axes)


def shear_parameters(members: MemberArrays) -> tuple[FloatArray, FloatArray]:
    r"""Return the shear parameters of both bending planes.

    .. math:: \Phi_y = 12 E I_z / (G A_{sy} L^2), \quad \Phi_z = 12 E I_y / (G A_{sz} L^2)

    Source: [Prz68] sec. 5.6.

    Shapes: phi_y, phi_z (n,).
    """
    m = members
    flexural = 12.0 * m.elastic_modulus / (m.shear_modulus * m.length**2)
    return flexural * m.inertia_z / m.shear_area_y, flexural * m.inertia_y / m.shear_area_z


def local_stiffness(members: MemberArrays) -> FloatArray:
    """Return the elastic stiffness in local axes, shear deformation included.

    Source: [Prz68] sec. 5.6 (Timoshenko beam, exact for end loads).

    Shapes: result (n, 12, 12).
    """
    m = members
    stiffness = np.zeros((m.length.size, 12, 12))
    _add_pair(stiffness, 0, m.elastic_modulus * m.area / m.length)
    _add_pair(stiffness, 3, m.shear_modulus * m.torsion_constant / m.length)
    phi_y, phi_z = shear_parameters(m)
    planes = (
        (_PLANE_XY, np.ones(4), m.elastic_modulus * m.inertia_z, phi_y),
        (_PLANE_XZ, _SIGN_XZ, m.elastic_modulus * m.inertia_y, phi_z),
    )
    for places, sign, flexural, phi in planes:
        factor = flexural / (m.length**3 * (1.0 + phi))
        block = _plane_matrix(
            m.length, np.full_like(phi, 12.0), np.full_like(phi, 6.0), 4.0 + phi, 2.0 - phi
        )
        stiffness[:, places[:, None], places] += (
            factor[:, None, None] * np.outer(sign, sign) * block
        )
    return stiffness


def local_geometric_stiffness(members: MemberArrays, axial_force: FloatArray) -> FloatArray:
    r"""Return the consistent geometric stiffness in local axes for given axial forces.

    Bending: :math:`P \int w'^T w' dx` with the same shape functions as the elastic stiffness, so
    that a column with shear deformation buckles at Engesser's load. With no shear deformation it
    is [Prz68] eq. 15.18. Torsion: :math:`P I_p / (A L)`, [MGZ00] ch. 9, without warping.

    Shapes: axial_force (n,), result (n, 12, 12).
    """
    m = members
    stiffness = np.zeros((m.length.size, 12, 12))
    _add_pair(stiffness, 3, axial_force * (m.inertia_y + m.inertia_z) / (m.area * m.length))
    phi_y, phi_z = shear_parameters(m)
    planes = ((_PLANE_XY, np.ones(4), phi_y), (_PLANE_XZ, _SIGN_XZ, phi_z))
    for places, sign, phi in planes:
        factor = axial_force / (30.0 * m.length * (1.0 + phi) ** 2)
        block = _plane_matrix(
            m.length,
            36.0 + 60.0 * phi + 30.0 * phi**2,
            np.full_like(phi, 3.0),
            4.0 + 5.0 * phi + 2.5 * phi**2,
            -1.0 - 5.0 * phi - 2.5 * phi**2,
        )
        stiffness[:, places[:, None], places] += (
            factor[:, None, None] * np.outer(sign, sign) * block
        )
    return stiffness


def fixed_end_forces(members: MemberArrays, load: FloatArray) -> FloatArray:
    """Return the end forces of clamped members under a uniform load, in local axes.

    Ends: half the load each, moments q L^2 / 12; by symmetry shear deformation does not enter.
    The equivalent nodal loads are the opposite of these forces.

    Shapes: load (n, 3), result (n, 12).
    """
    q = np.einsum("nab,nb->na", members.axes, load)
    half = -0.5 * q * members.length[:, None]
    moment = q * (members.length**2)[:, None] / 12.0
    forces = np.zeros((q.shape[0], 12))
    forces[:, 0:3] = half
    forces[:, 6:9] = half
    forces[:, 4], forces[:, 10] = moment[:, 2], -moment[:, 2]
    forces[:, 5], forces[:, 11] = -moment[:, 1], moment[:, 1]
    return forces


def released(stiffness: FloatArray, releases: Sequence[Sequence[int]]) -> FloatArray:
    """Return the local displacements of members by those of their nodes.

    If an end is free of a moment, its own rotation is the one without it: the elastic stiffness is
    condensed (Guyan), and loads and geometric stiffness are transformed with it.

    Shapes: stiffness (n, 12, 12), releases (n,), result (n, 12, 12).
    """
    follow = np.tile(np.eye(12), (len(stiffness), 1, 1))
    for place, given in enumerate(releases):
        free = np.array(given, dtype=np.int64)
        if not free.size:
            continue
        kept = np.setdiff1d(np.arange(12), free)
        k = stiffness[place]
        rows = -np.linalg.solve(k[np.ix_(free, free)], k[np.ix_(free, kept)])
        follow[place][free] = 0.0
        follow[place][np.ix_(free, kept)] = rows
    return follow


def spring_stiffness(lever: FloatArray, stiffness: FloatArray) -> FloatArray:
    r"""Return the stiffness of 6-component springs in global axes.

    The spring sits at node j; a rigid lever carries it to node i, so that a rigid motion of both
    nodes is free of force. Its deformation is :math:`u_j - u_i - \theta_i \times r` and
    :math:`\theta_j - \theta_i`, with r from node i to node j.

    Shapes: lever (n, 3), stiffness (n, 6), result (n, 12, 12).
    """
    count = lever.shape[0]
    deformation = np.zeros((count, 6, 12))
    deformation[:, :, 0:6] = -np.eye(6)
    deformation[:, :, 6:12] = np.eye(6)
    x, y, z = lever.T
    # -theta_i x r = r x theta_i
    deformation[:, 0, 4], deformation[:, 0, 5] = -z, y
    deformation[:, 1, 3], deformation[:, 1, 5] = z, -x
    deformation[:, 2, 3], deformation[:, 2, 4] = -y, x
    return deformation.transpose(0, 2, 1) @ (stiffness[:, :, None] * deformation)


def _add_pair(stiffness: FloatArray, dof: int, value: FloatArray) -> None:
    # Adds a two-node spring between local displacement `dof` of both ends.
    for row, column, sign in ((0, 0, 1.0), (0, 6, -1.0), (6, 0, -1.0), (6, 6, 1.0)):
        stiffness[:, dof + row, dof + column] += sign * value


def _plane_matrix(
    length: FloatArray, shear: FloatArray, couple: FloatArray, near: FloatArray, far: FloatArray
) -> FloatArray:
    # Pattern shared by the bending part of both stiffnesses, over (v_i, slope_i, v_j, slope_j).
    rise, own, other = couple * length, near * length**2, far * length**2
    rows = [
        [shear, rise, -shear, rise],
        [rise, own, -rise, other],
        [-shear, -rise, shear, -rise],
        [rise, other, -rise, own],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
