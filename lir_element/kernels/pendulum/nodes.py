"""Kernels of the level 'pendulum': the condensed tangent spread over the nodes' displacements.

Levers of the sphere centres move and plates turn by finite rotations: both have their terms here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._jit import kernel
from lir_element.kernels.pendulum.tangent import condense
from lir_element.kernels.rotation import add_cross

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Work


@kernel
def rotate_to_global(w: Work) -> None:
    """Turn the 6 x 6 stiffness (four 3 x 3 blocks) and dn6 into global axes, in place."""
    q = w.q_i
    for block_row in (0, 3):
        for block_col in (0, 3):
            for a in range(3):  # rows: Q k
                for b in range(3):
                    w.half[a, b] = 0.0
                    for k in range(3):
                        w.half[a, b] += q[a, k] * w.k6[block_row + k, block_col + b]
            for a in range(3):  # columns: k Q'
                for b in range(3):
                    total = 0.0
                    for k in range(3):
                        total += w.half[a, k] * q[b, k]
                    w.k6[block_row + a, block_col + b] = total
    for block in (0, 3):
        x, y, z = w.dn6[block], w.dn6[block + 1], w.dn6[block + 2]
        for a in range(3):
            w.dn6[block + a] = q[a, 0] * x + q[a, 1] * y + q[a, 2] * z


@kernel
def spread(
    row: Floats,
    x: float,
    y: float,
    z: float,
    w: Work,
    lever_i: float,
    lever_j: float,
    s_x: float,
    s_y: float,
    s_z: float,
) -> None:
    """Fill the 12 entries of `row`: derivative by (shift of centre x, y, z; spin s) in B form.

    shift = u_j - u_i + (a_i e_i + c) x phi_i + a_j e_j x phi_j, spin = phi_j - phi_i.
    """
    row[0], row[1], row[2] = -x, -y, -z
    row[6], row[7], row[8] = x, y, z
    a = lever_j * w.q_j[0, 2]
    b = lever_j * w.q_j[1, 2]
    c = lever_j * w.q_j[2, 2]
    # x . (e x phi) = phi . (x x e)
    row[9] = y * c - z * b + s_x
    row[10] = z * a - x * c + s_y
    row[11] = x * b - y * a + s_z
    a = lever_i * w.q_i[0, 2] + w.c_global[0]
    b = lever_i * w.q_i[1, 2] + w.c_global[1]
    c = lever_i * w.q_i[2, 2] + w.c_global[2]
    row[3] = y * c - z * b - s_x
    row[4] = z * a - x * c - s_y
    row[5] = x * b - y * a - s_z


@kernel
def fill_tangent(p: Props, w: Work, force: Floats, k: Floats) -> None:
    """Fill the 12 x 12 tangent `k` of the trial that `w` holds; `force` is its (12,) force.

    Unsymmetric. Rows: node i, node j; each forces, then moments.
    """
    condense(p, w)
    rotate_to_global(w)
    g_x, g_y, g_z = force[6], force[7], force[8]
    m_x, m_y, m_z = w.tau[0], w.tau[1], w.tau[2]
    rows = w.d_rows
    for a in range(6):
        r = w.k6[a]
        spread(rows[a], r[0], r[1], r[2], w, p.lever[0], p.lever[1], r[3], r[4], r[5])
    add_cross(rows, 0, 3, g_x, g_y, g_z, -1.0)  # g and tau turn with the bottom plate: phi x g
    add_cross(rows, 3, 3, m_x, m_y, m_z, -1.0)
    a_x, a_y, a_z = p.lever[1] * w.q_j[0, 2], p.lever[1] * w.q_j[1, 2], p.lever[1] * w.q_j[2, 2]
    b_x = p.lever[0] * w.q_i[0, 2] + w.c_global[0]
    b_y = p.lever[0] * w.q_i[1, 2] + w.c_global[1]
    b_z = p.lever[0] * w.q_i[2, 2] + w.c_global[2]
    for col in range(12):
        d_x, d_y, d_z = rows[0, col], rows[1, col], rows[2, col]
        t_x, t_y, t_z = rows[3, col], rows[4, col], rows[5, col]
        k[0, col], k[1, col], k[2, col] = -d_x, -d_y, -d_z
        k[6, col], k[7, col], k[8, col] = d_x, d_y, d_z
        k[3, col] = -(b_y * d_z - b_z * d_y) - t_x
        k[4, col] = -(b_z * d_x - b_x * d_z) - t_y
        k[5, col] = -(b_x * d_y - b_y * d_x) - t_z
        k[9, col] = -(a_y * d_z - a_z * d_y) + t_x
        k[10, col] = -(a_z * d_x - a_x * d_z) + t_y
        k[11, col] = -(a_x * d_y - a_y * d_x) + t_z
    # levers move: m_i = -(a_i e_i + c) x g - tau, whose arm shifts by u_j - u_i + a_j e_j x phi_j
    add_cross(k, 3, 6, g_x, g_y, g_z, 1.0)
    add_cross(k, 3, 0, g_x, g_y, g_z, -1.0)
    # ... and m_j = -a_j e_j x g + tau, whose arm turns: (phi x arm) x g = arm (phi.g) - phi (arm.g)
    dot = a_x * g_x + a_y * g_y + a_z * g_z
    arm = (a_x, a_y, a_z)
    g = (g_x, g_y, g_z)
    for a in range(3):
        for b in range(3):
            turn = arm[a] * g[b] - (dot if a == b else 0.0)
            k[9 + a, 9 + b] -= turn
            k[3 + a, 9 + b] += turn
    axial_torsion(p, w, k)
    apply_spin(w.spin_i, k, 3)
    apply_spin(w.spin_j, k, 9)
    add_twist(k, w.torque_stiffness)


@kernel
def add_twist(k: Floats, stiffness: float) -> None:
    """Add a stiffness against the twist of the nodes, a difference of rotation vectors."""
    k[5, 5] += stiffness
    k[5, 11] -= stiffness
    k[11, 5] -= stiffness
    k[11, 11] += stiffness


@kernel
def axial_torsion(p: Props, w: Work, k: Floats) -> None:
    """Add the change of the torsional friction (about z, + on node j) with the axial force."""
    if w.torque_axial == 0.0:
        return
    row, n = w.n_row, w.dn6
    spread(row, n[0], n[1], n[2], w, p.lever[0], p.lever[1], n[3], n[4], n[5])
    for col in range(12):
        value = w.torque_axial * row[col]
        k[11, col] += value
        k[5, col] -= value


@kernel
def apply_spin(spin: Floats, k: Floats, first: int) -> None:
    """Turn columns `first`.. from derivatives by spin into derivatives by the rotation vector."""
    for row in range(12):
        x, y, z = k[row, first], k[row, first + 1], k[row, first + 2]
        for b in range(3):
            k[row, first + b] = x * spin[0, b] + y * spin[1, b] + z * spin[2, b]
