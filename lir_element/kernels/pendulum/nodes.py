"""Kernels of the level 'pendulum': the condensed tangent spread over the nodes' displacements.

Levers of the sphere centres move and plates turn by finite rotations: both have their terms here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._jit import kernel
from lir_element.kernels.pendulum.tangent import condense
from lir_element.kernels.rotation import add_cross, spin_matrix

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Work


@kernel
def set_frames(p: Props, w: Work) -> None:
    """Set the slider's own axes seen globally: for moments, for forces, for shifts of the centre.

    Under a fixed load the vertical force is that load, and the centre's height follows from the
    string's length: ``dl = -n . d = 0``.
    """
    q, t, n = w.q_i, w.t, w.n
    for a in range(3):
        for b in range(2):
            w.axes[a, b] = q[a, 0] * t[b, 0] + q[a, 1] * t[b, 1] + q[a, 2] * t[b, 2]
        w.axes[a, 2] = q[a, 0] * n[0] + q[a, 1] * n[1] + q[a, 2] * n[2]
    for a in range(3):
        for b in range(3):
            w.axes_force[a, b], w.axes_shift[a, b] = w.axes[a, b], w.axes[a, b]
    if p.fixed_load > 0.0:
        for a in range(3):
            rise = w.axes[a, 2] / n[2]
            for b in range(2):
                w.axes_force[a, b] -= q[a, 2] * t[b, 2]
                w.axes_shift[a, b] -= t[b, 2] * rise
            w.axes_force[a, 2] -= q[a, 2] * n[2]
            w.axes_shift[a, 2] = 0.0


@kernel
def set_rows(p: Props, w: Work) -> None:
    """Set the derivatives of g, tau and N (global axes) by the nodes' displacements: `d_rows`."""
    k, half, rows = w.k6, w.half, w.d_rows
    for a in range(3):
        f, m = w.axes_force[a], w.axes[a]
        for c in range(6):
            half[a, c] = f[0] * k[0, c] + f[1] * k[1, c] + f[2] * k[2, c]
            half[3 + a, c] = m[0] * k[3, c] + m[1] * k[4, c] + m[2] * k[5, c]
    for c in range(6):
        half[6, c] = k[6, c]
    x, y = w.axes_shift, w.axes
    for a in range(7):
        r = half[a]
        spread(
            rows[a],
            x[0, 0] * r[0] + x[0, 1] * r[1] + x[0, 2] * r[2],
            x[1, 0] * r[0] + x[1, 1] * r[1] + x[1, 2] * r[2],
            x[2, 0] * r[0] + x[2, 1] * r[1] + x[2, 2] * r[2],
            w, p.lever[0], p.lever[1],
            y[0, 0] * r[3] + y[0, 1] * r[4] + y[0, 2] * r[5],
            y[1, 0] * r[3] + y[1, 1] * r[4] + y[1, 2] * r[5],
            y[2, 0] * r[3] + y[2, 1] * r[4] + y[2, 2] * r[5],
        )  # fmt: skip


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
    x, y = w.turned[0], w.turned[1]
    spin_matrix(x[0], x[1], x[2], w.spin_i)
    spin_matrix(y[0], y[1], y[2], w.spin_j)
    condense(p, w)
    set_frames(p, w)
    set_rows(p, w)
    g_x, g_y, g_z = force[6], force[7], force[8]
    rows, q_j, turn = w.d_rows, w.spin_j, w.torque_axial
    if p.fixed_load > 0.0:
        add_vertical(p, w)
    add_cross(rows, 0, 3, g_x, g_y, g_z, -1.0)  # g and tau turn with the bottom plate: phi x g
    add_cross(rows, 3, 3, w.tau[0], w.tau[1], w.tau[2], -1.0)
    apply_spin(w.spin_i, rows, 3)
    apply_spin(q_j, rows, 9)
    a_x, a_y, a_z = p.lever[1] * w.q_j[0, 2], p.lever[1] * w.q_j[1, 2], p.lever[1] * w.q_j[2, 2]
    b_x = p.lever[0] * w.q_i[0, 2] + w.c_global[0]
    b_y = p.lever[0] * w.q_i[1, 2] + w.c_global[1]
    b_z = p.lever[0] * w.q_i[2, 2] + w.c_global[2]
    m = w.tangent  # of known shape, so that its columns go together
    for col in range(12):
        d_x, d_y, d_z = rows[0, col], rows[1, col], rows[2, col]
        t_x, t_y, t_z = rows[3, col], rows[4, col], rows[5, col]
        twist = turn * rows[6, col]  # torsional friction
        m[0, col], m[1, col], m[2, col] = -d_x, -d_y, -d_z
        m[6, col], m[7, col], m[8, col] = d_x, d_y, d_z
        m[3, col] = -(b_y * d_z - b_z * d_y) - t_x
        m[4, col] = -(b_z * d_x - b_x * d_z) - t_y
        m[5, col] = -(b_x * d_y - b_y * d_x) - t_z - twist
        m[9, col] = -(a_y * d_z - a_z * d_y) + t_x
        m[10, col] = -(a_z * d_x - a_x * d_z) + t_y
        m[11, col] = -(a_x * d_y - a_y * d_x) + t_z + twist
    for row in range(12):
        for col in range(12):
            k[row, col] = m[row, col]
    # levers move: m_i = -(a_i e_i + c) x g - tau, whose arm shifts by u_j - u_i + a_j e_j x phi_j
    add_cross(k, 3, 6, g_x, g_y, g_z, 1.0)
    add_cross(k, 3, 0, g_x, g_y, g_z, -1.0)
    # ... and m_j = -a_j e_j x g + tau, whose arm turns: (phi x arm) x g = arm (phi.g) - phi (arm.g)
    dot = a_x * g_x + a_y * g_y + a_z * g_z
    arm = (a_x, a_y, a_z)
    for b in range(3):
        along = g_x * q_j[0, b] + g_y * q_j[1, b] + g_z * q_j[2, b]
        for a in range(3):
            value = arm[a] * along - dot * q_j[a, b]
            k[9 + a, 9 + b] -= value
            k[3 + a, 9 + b] += value
    add_twist(k, w.torque_stiffness)


@kernel
def add_vertical(p: Props, w: Work) -> None:
    """Add the vertical spring beside a fixed load to the rows of the force on the centre."""
    q = w.q_i
    for a in range(3):
        value = w.stiff_vertical * q[a, 2]
        spread(
            w.spare_u, value * q[0, 2], value * q[1, 2], value * q[2, 2], w,
            p.lever[0], p.lever[1], 0.0, 0.0, 0.0,
        )  # fmt: skip
        for c in range(12):
            w.d_rows[a, c] += w.spare_u[c]


@kernel
def add_twist(k: Floats, stiffness: float) -> None:
    """Add a stiffness against the twist of the nodes, a difference of rotation vectors."""
    k[5, 5] += stiffness
    k[5, 11] -= stiffness
    k[11, 5] -= stiffness
    k[11, 11] += stiffness


@kernel
def apply_spin(spin: Floats, k: Floats, first: int) -> None:
    """Turn columns `first`.. from derivatives by spin into derivatives by the rotation vector."""
    for row in range(k.shape[0]):
        x, y, z = k[row, first], k[row, first + 1], k[row, first + 2]
        for b in range(3):
            k[row, first + b] = x * spin[0, b] + y * spin[1, b] + z * spin[2, b]
