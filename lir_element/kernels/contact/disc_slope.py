"""Kernels of the derivative of a disc's force and couple by the shift and turn of its body.

Of the body's material at the centre of pressure, in global axes; they follow the kernels of
`disc_pair`, whose places and forces they read. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.contact.disc import disc_load_slope

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch, Touch


@inlined_by_llvm
def turned(q: Floats, v: Floats) -> tuple[float, float, float]:
    """Return a vector of a body with axes `q` in global axes."""
    return (
        q[0, 0] * v[0] + q[0, 1] * v[1] + q[0, 2] * v[2],
        q[1, 0] * v[0] + q[1, 1] * v[1] + q[1, 2] * v[2],
        q[2, 0] * v[0] + q[2, 1] * v[1] + q[2, 2] * v[2],
    )


@inlined_by_llvm
def slope_of_tilt(
    w: Scratch, face: Floats, m_0: float, m_1: float, m_2: float, bend: float
) -> None:
    """Set the derivative of penetration and tilt (2), ``w.bed_by`` (3, 6).

    By the shift of the face's centre and by a turn; the face's axes are the first columns of
    `face`. `m` is the direction of penetration, `bend` one over the way to the sphere's centre.
    """
    by = w.bed_by
    by[0, 0], by[0, 1], by[0, 2] = m_0, m_1, m_2
    by[0, 3], by[0, 4], by[0, 5] = 0.0, 0.0, 0.0
    for k in range(2):
        c_0, c_1, c_2, g = face[0, k], face[1, k], face[2, k], w.tilt[k]
        by[1 + k, 0] = (c_0 - g * m_0) * bend
        by[1 + k, 1] = (c_1 - g * m_1) * bend
        by[1 + k, 2] = (c_2 - g * m_2) * bend
        by[1 + k, 3], by[1 + k, 4] = c_1 * m_2 - c_2 * m_1, c_2 * m_0 - c_0 * m_2
        by[1 + k, 5] = c_0 * m_1 - c_1 * m_0


@kernel
def slope_of_damping(
    w: Scratch, old: Touch, new: Touch, share: float, fall: float, a: float
) -> None:
    """Add the bed's damping to the derivative of the centre of pressure, ``w.bed``.

    `share` is that of `damped_centre`, `fall` its decrease with the penetration V over itself.
    """
    bed = w.bed
    x, y = new.core[0] - old.core[0], new.core[1] - old.core[1]
    for k in range(3):
        less = share * fall * bed[0, k]
        bed[1, k] += share * bed[1, k] - less * x
        bed[2, k] += share * bed[2, k] - less * y
    e_1, e_2 = new.core[0] + share * x, new.core[1] + share * y
    size = math.sqrt(e_1 * e_1 + e_2 * e_2)
    if size <= a:
        return
    e_1, e_2, short = e_1 / size, e_2 / size, a / size
    for k in range(3):
        along = e_1 * bed[1, k] + e_2 * bed[2, k]
        bed[1, k] = short * (bed[1, k] - along * e_1)
        bed[2, k] = short * (bed[2, k] - along * e_2)


@kernel
def slope_of_push(
    w: Scratch,
    face: Floats,
    old: Touch,
    new: Touch,
    p: float,
    a: float,
    stiff: float,
    damped: float,
) -> None:
    """Set the derivative of load and centre of pressure (2), ``w.push_by`` (3, 6).

    `stiff` is that of the load by the mean penetration, `damped` as in `slope_of_damping`.
    """
    disc_load_slope(w, p, w.tilt[0], w.tilt[1], a)
    if damped > 0.0:
        slope_of_damping(w, old, new, damped, stiff / new.push, a)
    bed, by = w.bed, w.bed_by
    e_1, e_2 = new.centre[0], new.centre[1]
    r_0 = e_1 * face[0, 0] + e_2 * face[0, 1]
    r_1 = e_1 * face[1, 0] + e_2 * face[1, 1]
    r_2 = e_1 * face[2, 0] + e_2 * face[2, 1]
    for row in range(3):  # the vertex moves by the material's shift less turn x r
        x, y, z = by[row, 0], by[row, 1], by[row, 2]
        by[row, 3] -= r_1 * z - r_2 * y
        by[row, 4] -= r_2 * x - r_0 * z
        by[row, 5] -= r_0 * y - r_1 * x
    for row in range(3):
        factor = stiff if row == 0 else 1.0
        for col in range(6):
            w.push_by[row, col] = factor * (
                bed[row, 0] * by[0, col] + bed[row, 1] * by[1, col] + bed[row, 2] * by[2, col]
            )


@inlined_by_llvm
def slope_of_spin(
    w: Scratch, q: Floats, face: Floats, old: Touch, n_0: float, n_1: float, n_2: float
) -> None:
    """Set the derivative of the spin about `n`, ``w.spin_by`` (6,): by n and by a rotation.

    Also ``w.axes`` (2, 3): the former axes of the face, as the carrier has rotated them.
    """
    by, axes = w.spin_by, w.axes
    x_0, x_1, x_2, dots = 0.0, 0.0, 0.0, 0.0
    by[3], by[4], by[5] = 0.0, 0.0, 0.0
    for k in range(2):
        o_0, o_1, o_2 = turned(q, old.axes[k])
        axes[k, 0], axes[k, 1], axes[k, 2] = o_0, o_1, o_2
        c_0, c_1, c_2 = face[0, k], face[1, k], face[2, k]
        x_0 += o_1 * c_2 - o_2 * c_1
        x_1 += o_2 * c_0 - o_0 * c_2
        x_2 += o_0 * c_1 - o_1 * c_0
        dots += o_0 * c_0 + o_1 * c_1 + o_2 * c_2
        along = 0.5 * (n_0 * c_0 + n_1 * c_1 + n_2 * c_2)
        by[3] -= along * o_0
        by[4] -= along * o_1
        by[5] -= along * o_2
    by[0], by[1], by[2] = 0.5 * x_0, 0.5 * x_1, 0.5 * x_2
    by[3] += 0.5 * dots * n_0
    by[4] += 0.5 * dots * n_1
    by[5] += 0.5 * dots * n_2


@kernel
def scale_slope(
    w: Scratch, push: float, mu: float, by_slid: float, f_1: float, f_2: float, f_3: float
) -> None:
    """Multiply ``w.rub`` by the friction coefficient, whose derivative by the sliding it takes up.

    `f` is the friction over mu N. The last column becomes the derivative of mu N f by N.
    """
    rub_, slid_by = w.rub, w.slid_by
    for row in range(3):
        f = f_1 if row == 0 else (f_2 if row == 1 else f_3)
        for col in range(3):
            rub_[row, col] = mu * rub_[row, col] + f * by_slid * slid_by[col]
        rub_[row, 3] = mu * (f + push * rub_[row, 3])


@kernel
def slope_of_cap(
    w: Scratch,
    q: Floats,
    face: Floats,
    old: Touch,
    radius: float,
    sign: float,
    size: float,
    old_size: float,
    push: float,
    spread: float,
    f_1: float,
    f_2: float,
    f_3: float,
) -> None:
    """Set ``w.six`` (6, 6) of a cap on a sphere; `f` is its friction (2) and torque.

    `q` are the axes of the carrier, `face` those of the body.
    """
    lean = 1.0 / (1.0 + w.axis[2])
    lean_1, lean_2 = lean * w.axis[1], lean * w.axis[0]
    n_0, n_1, n_2 = turned(q, w.axis)
    t_0, t_1, t_2 = turned(q, w.tangent_1)
    s_0, s_1, s_2 = turned(q, w.tangent_2)
    p_0, p_1, p_2 = turned(q, w.old_place)
    slope_of_spin(w, q, face, old, n_0, n_1, n_2)
    o_1, o_2 = -w.way[0] / radius, -w.way[1] / radius
    o_n = n_0 * p_0 + n_1 * p_1 + n_2 * p_2
    x_0 = -push * sign * n_0 - f_1 * t_0 - f_2 * s_0
    x_1 = -push * sign * n_1 - f_1 * t_1 - f_2 * s_1
    x_2 = -push * sign * n_2 - f_1 * t_2 - f_2 * s_2
    axes, by, spin_by, r, six = w.axes, w.push_by, w.spin_by, w.rub, w.six
    turn, over = sign / size, 1.0 / old_size
    for col in range(6):
        d_n, c_1, c_2 = by[0, col], by[1, col], by[2, col]
        y_0 = c_1 * face[0, 0] + c_2 * face[0, 1]  # the centre of pressure in the face
        y_1 = c_1 * face[1, 0] + c_2 * face[1, 1]
        y_2 = c_1 * face[2, 0] + c_2 * face[2, 1]
        v_0, v_1, v_2 = y_0, y_1, y_2
        if col == 0:
            v_0 += 1.0
        elif col == 1:
            v_1 += 1.0
        elif col == 2:
            v_2 += 1.0
        e_1 = turn * (t_0 * v_0 + t_1 * v_1 + t_2 * v_2)
        e_2 = turn * (s_0 * v_0 + s_1 * v_1 + s_2 * v_2)
        w_n = lean_1 * e_1 - lean_2 * e_2
        q_0 = (c_1 * axes[0, 0] + c_2 * axes[1, 0]) * over
        q_1 = (c_1 * axes[0, 1] + c_2 * axes[1, 1]) * over
        q_2 = (c_1 * axes[0, 2] + c_2 * axes[1, 2]) * over
        q_o = q_0 * p_0 + q_1 * p_1 + q_2 * p_2
        q_0, q_1, q_2 = q_0 - q_o * p_0, q_1 - q_o * p_1, q_2 - q_o * p_2
        w_1 = -radius * (-e_1 * o_n + w_n * o_2 + t_0 * q_0 + t_1 * q_1 + t_2 * q_2)
        w_2 = -radius * (-e_2 * o_n - w_n * o_1 + s_0 * q_0 + s_1 * q_1 + s_2 * q_2)
        m_0 = t_0 * e_1 + s_0 * e_2  # change of n
        m_1 = t_1 * e_1 + s_1 * e_2
        m_2 = t_2 * e_1 + s_2 * e_2
        w_3 = spin_by[0] * m_0 + spin_by[1] * m_1 + spin_by[2] * m_2
        if col >= 3:
            w_3 += spin_by[col]
        w_3 *= spread
        g_1 = push * (r[0, 0] * w_1 + r[0, 1] * w_2 + r[0, 2] * w_3) + r[0, 3] * d_n - f_2 * w_n
        g_2 = push * (r[1, 0] * w_1 + r[1, 1] * w_2 + r[1, 2] * w_3) + r[1, 3] * d_n + f_1 * w_n
        g_3 = spread * (push * (r[2, 0] * w_1 + r[2, 1] * w_2 + r[2, 2] * w_3) + r[2, 3] * d_n)
        g_n = sign * d_n - (f_1 * e_1 + f_2 * e_2)
        six[0, col] = -g_n * n_0 - push * sign * m_0 - g_1 * t_0 - g_2 * s_0
        six[1, col] = -g_n * n_1 - push * sign * m_1 - g_1 * t_1 - g_2 * s_1
        six[2, col] = -g_n * n_2 - push * sign * m_2 - g_1 * t_2 - g_2 * s_2
        six[3, col] = -g_3 * n_0 - f_3 * m_0 + y_1 * x_2 - y_2 * x_1
        six[4, col] = -g_3 * n_1 - f_3 * m_1 + y_2 * x_0 - y_0 * x_2
        six[5, col] = -g_3 * n_2 - f_3 * m_2 + y_0 * x_1 - y_1 * x_0


@kernel
def slope_on_plane(
    w: Scratch, q: Floats, face: Floats, old: Touch, push: float, load: float, spread: float
) -> None:
    """Set ``w.six`` (6, 6) of a face on the plane, as `slope_of_cap`; it rubs by its `load`."""
    t_0, t_1, t_2 = q[0, 0], q[1, 0], q[2, 0]
    s_0, s_1, s_2 = q[0, 1], q[1, 1], q[2, 1]
    n_0, n_1, n_2 = q[0, 2], q[1, 2], q[2, 2]
    slope_of_spin(w, q, face, old, n_0, n_1, n_2)
    f_1, f_2 = w.tangential[0], w.tangential[1]
    x_0 = push * n_0 + f_1 * t_0 + f_2 * s_0
    x_1 = push * n_1 + f_1 * t_1 + f_2 * s_1
    x_2 = push * n_2 + f_1 * t_2 + f_2 * s_2
    axes, by, six, r = old.axes, w.push_by, w.six, w.rub
    for col in range(6):
        d_n, c_1, c_2 = by[0, col], by[1, col], by[2, col]
        y_0 = c_1 * face[0, 0] + c_2 * face[0, 1]
        y_1 = c_1 * face[1, 0] + c_2 * face[1, 1]
        y_2 = c_1 * face[2, 0] + c_2 * face[2, 1]
        w_1 = t_0 * y_0 + t_1 * y_1 + t_2 * y_2 - c_1 * axes[0, 0] - c_2 * axes[1, 0]
        w_2 = s_0 * y_0 + s_1 * y_1 + s_2 * y_2 - c_1 * axes[0, 1] - c_2 * axes[1, 1]
        w_3 = 0.0
        if col < 3:
            w_1 += q[col, 0]
            w_2 += q[col, 1]
        else:
            w_3 = spread * w.spin_by[col]
        g_1 = load * (r[0, 0] * w_1 + r[0, 1] * w_2 + r[0, 2] * w_3) + r[0, 3] * d_n
        g_2 = load * (r[1, 0] * w_1 + r[1, 1] * w_2 + r[1, 2] * w_3) + r[1, 3] * d_n
        g_3 = spread * (load * (r[2, 0] * w_1 + r[2, 1] * w_2 + r[2, 2] * w_3) + r[2, 3] * d_n)
        six[0, col] = d_n * n_0 - g_1 * t_0 - g_2 * s_0
        six[1, col] = d_n * n_1 - g_1 * t_1 - g_2 * s_1
        six[2, col] = d_n * n_2 - g_1 * t_2 - g_2 * s_2
        six[3, col] = y_1 * x_2 - y_2 * x_1 - g_3 * n_0
        six[4, col] = y_2 * x_0 - y_0 * x_2 - g_3 * n_1
        six[5, col] = y_0 * x_1 - y_1 * x_0 - g_3 * n_2


@kernel
def slope_of_bond(w: Scratch, q: Floats, face: Floats, along: float, square: float) -> None:
    """Set ``w.six`` (6, 6) of the bond of a face.

    `along` is the derivative of its force by a shift, `square` the mean square of a place in it.
    """
    six = w.six
    for row in range(6):
        for col in range(6):
            six[row, col] = along if row == col and row < 3 else 0.0
    for k in range(2):
        h_0, h_1, h_2 = turned(q, w.home[k])
        dot = face[0, k] * h_0 + face[1, k] * h_1 + face[2, k] * h_2
        for b in range(3):  # (turn x f) x h = f (turn . h) - turn (f . h)
            f = square * face[b, k]
            six[3 + b, 3] += f * h_0
            six[3 + b, 4] += f * h_1
            six[3 + b, 5] += f * h_2
            six[3 + b, 3 + b] -= square * dot
