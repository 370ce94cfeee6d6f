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

    Parameters
    ----------
    arms : ndarray, (n, 2, 3)
        From nodes i and j to the ends, in local axes [m].

    Returns
    -------
    ndarray, (n, 12, 12)
        ``u_ends = follow @ u_nodes`` in local axes; the identity without arms.
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

    Parameters
    ----------
    forces : ndarray, (..., n, 12)
        Forces and moments on the nodes, in local axes [N, N m].
    arms : ndarray, (n, 2, 3)
        From the nodes to the ends, in local axes [m].

    Returns
    -------
    ndarray, (..., n, 12)
        The same forces, and the moments about the ends: less by d x F.
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

    Parameters
    ----------
    arms : ndarray, (n, 2, 3)
        From nodes i and j to the ends, in local axes [m].
    axial_force : ndarray, (n,)
        Axial force, tension positive [N].

    Returns
    -------
    ndarray, (n, 12, 12)
        Symmetric, over the nodes' displacements in local axes [N m].
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
