"""Kernels of the level 'pendulum': the condensed tangent spread over the nodes' displacements.

Levers of the sphere centres move and plates turn by finite rotations: both have their terms here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
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
def set_rows(p: Props, w: Work, force: Floats) -> None:
    """Set the derivatives of g, tau and N (global axes) by the nodes' displacements: `d_rows`.

    shift = u_j - u_i + (a_i e_i + c) x phi_i + a_j e_j x phi_j, spin = phi_j - phi_i. Both g and
    tau turn with the bottom plate. Spins phi are those of rotation vectors.
    """
    k, half, x, y = w.k6, w.half, w.axes_shift, w.axes
    for a in range(3):
        f, m = w.axes_force[a], w.axes[a]
        for c in range(6):
            half[a, c] = f[0] * k[0, c] + f[1] * k[1, c] + f[2] * k[2, c]
            half[3 + a, c] = m[0] * k[3, c] + m[1] * k[4, c] + m[2] * k[5, c]
    for c in range(6):
        half[6, c] = k[6, c]
    a_x, a_y, a_z = p.lever[1] * w.q_j[0, 2], p.lever[1] * w.q_j[1, 2], p.lever[1] * w.q_j[2, 2]
    b_x = p.lever[0] * w.q_i[0, 2] + w.c_global[0]
    b_y = p.lever[0] * w.q_i[1, 2] + w.c_global[1]
    b_z = p.lever[0] * w.q_i[2, 2] + w.c_global[2]
    for a in range(7):
        r, row = half[a], w.d_rows[a]
        d_x = x[0, 0] * r[0] + x[0, 1] * r[1] + x[0, 2] * r[2]
        d_y = x[1, 0] * r[0] + x[1, 1] * r[1] + x[1, 2] * r[2]
        d_z = x[2, 0] * r[0] + x[2, 1] * r[1] + x[2, 2] * r[2]
        if w.stiff_vertical != 0.0 and a < 3:  # the vertical spring beside a fixed load
            lift = w.stiff_vertical * w.q_i[a, 2]
            d_x, d_y = d_x + lift * w.q_i[0, 2], d_y + lift * w.q_i[1, 2]
            d_z += lift * w.q_i[2, 2]
        s_x = y[0, 0] * r[3] + y[0, 1] * r[4] + y[0, 2] * r[5]
        s_y = y[1, 0] * r[3] + y[1, 1] * r[4] + y[1, 2] * r[5]
        s_z = y[2, 0] * r[3] + y[2, 1] * r[4] + y[2, 2] * r[5]
        row[0], row[1], row[2] = -d_x, -d_y, -d_z
        row[6], row[7], row[8] = d_x, d_y, d_z
        # d . (e x phi) = phi . (d x e)
        i_x, j_x = d_y * b_z - d_z * b_y - s_x, d_y * a_z - d_z * a_y + s_x
        i_y, j_y = d_z * b_x - d_x * b_z - s_y, d_z * a_x - d_x * a_z + s_y
        i_z, j_z = d_x * b_y - d_y * b_x - s_z, d_x * a_y - d_y * a_x + s_z
        if a < 6:  # phi x g, phi x tau
            g_x, g_y, g_z = force[6], force[7], force[8]
            if a >= 3:
                g_x, g_y, g_z = w.tau[0], w.tau[1], w.tau[2]
            if a in (0, 3):
                i_y, i_z = i_y + g_z, i_z - g_y
            elif a in (1, 4):
                i_x, i_z = i_x - g_z, i_z + g_x
            else:
                i_x, i_y = i_x + g_y, i_y - g_x
        for b in range(3):
            s, t = w.spin_i, w.spin_j
            row[3 + b] = i_x * s[0, b] + i_y * s[1, b] + i_z * s[2, b]
            row[9 + b] = j_x * t[0, b] + j_y * t[1, b] + j_z * t[2, b]


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
    set_rows(p, w, force)
    g_x, g_y, g_z = force[6], force[7], force[8]
    rows, q_j, turn = w.d_rows, w.spin_j, w.torque_axial
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
