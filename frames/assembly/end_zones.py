r"""Rigid end zones of members, as plain functions of arrays.

A member's end lies at the vector d from its node, the rigid arm that turns with the node: its
displacement is :math:`u + \theta \times d`, its rotation that of the node.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray


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

    To second order an arm d that turns by :math:`\theta` moves its end by
    :math:`\theta \times (\theta \times d) / 2`; what the axial force along e does on it makes the
    stiffness :math:`\pm P (e d^T / 2 + d e^T / 2 - e \cdot d \, I)` on the node's rotation, plus at
    end j. A rigid column that leans with its node is the simplest case: P d.

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
