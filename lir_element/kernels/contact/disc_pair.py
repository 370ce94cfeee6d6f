"""Kernels of one pair of a disc: resultant, its place, friction and spin, derivative.

A pair is the face of one body on the surface of another, its carrier; all is in axes of the
carrier. The load acts where the pressure is, and through the centre of the carrier's sphere.
Friction belongs to the material there. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.disc import disc_load, rub
from lir_element.kernels.contact.pair import set_tangents
from lir_element.kernels.friction_law import coefficient, least
from lir_element.kernels.slip import kept_share, speed_at_end

if TYPE_CHECKING:
    from lir_element.layout import Props, Scratch, Sliders, Touch

_LEAST_RADIUS = 0.05  # of the slider's, in which an edge still resists spin (a choice)


@kernel
def set_columns(w: Scratch, body: int, carrier: int) -> None:
    """Set the body's axes in its plane as seen from the carrier, ``w.face`` (2, 3)."""
    q, r = w.q[body], w.q[carrier]
    for k in range(2):
        for a in range(3):
            w.face[k, a] = r[0, a] * q[0, k] + r[1, a] * q[1, k] + r[2, a] * q[2, k]


@kernel
def bed_of_sphere(w: Scratch, radius: float, a: float) -> float:
    """Set the load of a cap whose vertex is at ``w.d`` from the sphere's centre; see `disc_load`.

    ``w.bed_by`` (3, 6): derivative of penetration and tilt (2) by the shift of the vertex and by
    the turn of the body.
    """
    d, face, by = w.d, w.face, w.bed_by
    size = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    inv = 1.0 / size
    m_0, m_1, m_2 = d[0] * inv, d[1] * inv, d[2] * inv
    by[0, 0], by[0, 1], by[0, 2] = m_0, m_1, m_2
    by[0, 3], by[0, 4], by[0, 5] = 0.0, 0.0, 0.0
    for k in range(2):
        c_0, c_1, c_2 = face[k, 0], face[k, 1], face[k, 2]
        g = m_0 * c_0 + m_1 * c_1 + m_2 * c_2
        w.tilt[k] = g
        by[1 + k, 0], by[1 + k, 1] = (c_0 - g * m_0) * inv, (c_1 - g * m_1) * inv
        by[1 + k, 2] = (c_2 - g * m_2) * inv
        by[1 + k, 3], by[1 + k, 4] = c_1 * m_2 - c_2 * m_1, c_2 * m_0 - c_0 * m_2
        by[1 + k, 5] = c_0 * m_1 - c_1 * m_0
    return size - radius


@kernel
def bed_of_plane(w: Scratch) -> float:
    """Set the tilt of a face on a plane, as `bed_of_sphere`; return its penetration."""
    by, face = w.bed_by, w.face
    for row in range(3):
        for col in range(6):
            by[row, col] = 0.0
    by[0, 2] = -1.0
    for k in range(2):
        w.tilt[k] = -face[k, 2]
        by[1 + k, 3], by[1 + k, 4] = -face[k, 1], face[k, 0]
    return -w.d[2]


@kernel
def damp_rocking(
    w: Scratch, c: Sliders, old: Touch, push: float, stiff: float, a: float, dt: float
) -> None:
    """Move the centre of pressure ``w.bed`` by the bed's damping, and its derivative.

    What was pressed is damped as it is: the centre goes ahead of its elastic place by
    ``c V_old / (N dt)`` times its way in the step (7.14), no farther than the edge.
    """
    if dt <= 0.0 or old.closure <= 0.0:
        return
    bed = w.bed
    share = c.damping * old.closure / (dt * push)
    x, y = bed[1, 0] - old.core[0], bed[2, 0] - old.core[1]
    bed[1, 0] += share * x
    bed[2, 0] += share * y
    for k in range(1, 4):
        fall = share * stiff / push * bed[0, k]  # N grows by stiff times V
        bed[1, k] += share * bed[1, k] - fall * x
        bed[2, k] += share * bed[2, k] - fall * y
    size = math.sqrt(bed[1, 0] ** 2 + bed[2, 0] ** 2)
    if size <= a:
        return
    e_1, e_2, short = bed[1, 0] / size, bed[2, 0] / size, a / size
    bed[1, 0], bed[2, 0] = a * e_1, a * e_2
    for k in range(1, 4):
        along = e_1 * bed[1, k] + e_2 * bed[2, k]
        bed[1, k] = short * (bed[1, k] - along * e_1)
        bed[2, k] = short * (bed[2, k] - along * e_2)


@kernel
def press_bed(
    w: Scratch, c: Sliders, old: Touch, new: Touch, p: float, a: float, dt: float
) -> float:
    """Set load and centre of pressure of a disc with their derivatives; return the load.

    ``w.push_by`` (3, 6): of load and centre (2) by the shift of the body's material at the centre
    of pressure and by its turn. ``w.rho`` (3,) leads from the face's centre to it.
    """
    mean = disc_load(w, p, w.tilt[0], w.tilt[1], a)
    new.closure = mean
    new.gap = mean if mean > 0.0 else p + a * math.sqrt(w.tilt[0] ** 2 + w.tilt[1] ** 2)
    new.push = 0.0
    for k in range(2):
        new.centre[k], new.core[k] = 0.0, 0.0
    if mean <= 0.0:
        return 0.0
    stiff = c.stiffness
    push = stiff * mean
    if dt > 0.0:
        push += c.damping * (mean - old.closure) / dt
        stiff += c.damping / dt
    if push <= 0.0:
        return 0.0
    new.push = push
    bed, face, rho = w.bed, w.face, w.rho
    new.core[0], new.core[1] = bed[1, 0], bed[2, 0]
    damp_rocking(w, c, old, push, stiff, a, dt)
    new.centre[0], new.centre[1] = bed[1, 0], bed[2, 0]
    for b in range(3):
        rho[b] = bed[1, 0] * face[0, b] + bed[2, 0] * face[1, b]
    by = w.bed_by
    for row in range(3):  # the vertex moves by the material's shift less turn x rho
        x, y, z = by[row, 0], by[row, 1], by[row, 2]
        by[row, 3] -= rho[1] * z - rho[2] * y
        by[row, 4] -= rho[2] * x - rho[0] * z
        by[row, 5] -= rho[0] * y - rho[1] * x
    for row in range(3):
        factor = stiff if row == 0 else 1.0
        for col in range(6):
            w.push_by[row, col] = factor * (
                bed[row, 1] * by[0, col] + bed[row, 2] * by[1, col] + bed[row, 3] * by[2, col]
            )
    for b in range(3):
        w.d[b] += rho[b]
    return push


@kernel
def spun(w: Scratch, old: Touch, n_0: float, n_1: float, n_2: float) -> float:
    """Return the body's spin about `n` against its carrier since the committed state.

    ``w.spin_by`` (6,): its derivative by a change of n and by a turn of the body.
    """
    x_0, x_1, x_2, dots = 0.0, 0.0, 0.0, 0.0
    by = w.spin_by
    by[3], by[4], by[5] = 0.0, 0.0, 0.0
    for k in range(2):
        o, c = old.axes[k], w.face[k]
        x_0 += o[1] * c[2] - o[2] * c[1]
        x_1 += o[2] * c[0] - o[0] * c[2]
        x_2 += o[0] * c[1] - o[1] * c[0]
        dots += o[0] * c[0] + o[1] * c[1] + o[2] * c[2]
        along = 0.5 * (n_0 * c[0] + n_1 * c[1] + n_2 * c[2])
        for a in range(3):
            by[3 + a] -= along * o[a]
    by[0], by[1], by[2] = 0.5 * x_0, 0.5 * x_1, 0.5 * x_2
    by[3] += 0.5 * dots * n_0
    by[4] += 0.5 * dots * n_1
    by[5] += 0.5 * dots * n_2
    return 0.5 * (n_0 * x_0 + n_1 * x_1 + n_2 * x_2)


@kernel
def rest_disc(w: Scratch, old: Touch, new: Touch, friction: float) -> None:
    """Set the state of a disc that touches nothing; its face's place is kept for the next step."""
    for a in range(3):
        new.spot[a] = w.d[a]
        new.axes[0, a], new.axes[1, a] = w.face[0, a], w.face[1, a]
        new.memory[a] = old.memory[a]
    for a in range(2):
        new.hysteresis[a], new.increment[a] = 0.0, 0.0
    new.friction, new.slid, new.speed = friction, 0.0, 0.0


@kernel
def torsion_radius(old: Touch, a: float) -> float:
    """Return the radius of the even disc about the centre of pressure that resists spin alike.

    An eccentric pressure leaves ``a (1 - (e / a)^2)`` of it.
    """
    square = (old.centre[0] ** 2 + old.centre[1] ** 2) / (a * a)
    return a * max(1.0 - square, _LEAST_RADIUS)  # (7.13)


@kernel
def sphere_disc(
    p: Props,
    c: Sliders,
    side: int,
    w: Scratch,
    old: Touch,
    new: Touch,
    a: float,
    dt: float,
    static_speed: float,
) -> float:
    """Set force and couple of a cap on the concave sphere `side` and their derivative.

    Returns the axial force; ``w.normal``, ``w.tangential`` act at ``w.d``, ``w.couple`` about it.
    """
    radius = p.radius[side]
    penetration = bed_of_sphere(w, radius, a)
    rest_disc(w, old, new, least(p, side))
    push = press_bed(w, c, old, new, penetration, a, dt)
    if push <= 0.0:
        return 0.0
    d, o = w.d, w.old_place
    size = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    m_0, m_1, m_2 = d[0] / size, d[1] / size, d[2] / size
    sign = -1.0 if side == 0 else 1.0
    n_0, n_1, n_2 = sign * m_0, sign * m_1, sign * m_2
    set_tangents(w, n_0, n_1, n_2)
    e_1, e_2 = new.centre[0], new.centre[1]
    square = 0.0
    for b in range(3):  # the same material at the committed state
        o[b] = old.spot[b] + e_1 * old.axes[0, b] + e_2 * old.axes[1, b]
        square += o[b] * o[b]
    old_size = math.sqrt(square)
    for b in range(3):
        o[b] /= old_size
    t, s = w.tangent_1, w.tangent_2
    spread = torsion_radius(old, a)
    w.way[0] = -radius * (t[0] * o[0] + t[1] * o[1] + t[2] * o[2])
    w.way[1] = -radius * (s[0] * o[0] + s[1] * o[1] + s[2] * o[2])
    w.way[2] = spread * spun(w, old, n_0, n_1, n_2)
    kept, by_push = kept_share(old.push, push, 0.0) if dt > 0.0 else (1.0, 0.0)
    slid = rub(
        w,
        p.bouc_wen,
        p.exponent,
        old.memory,
        w.way,
        max(p.yield_displacement[side], w.soft_low[side]),
        kept,
        by_push,
        old.increment,
        w.share,
        new.memory,
    )
    speed, by_slip = static_speed, 0.0
    if dt > 0.0:
        speed, by_slip = speed_at_end(slid, dt, old.slid, w.step_before, w.share)
    mu, slope = coefficient(p, side, speed)
    grip = 1.0 - w.lost[side]
    mu, slope = grip * mu, grip * slope
    new.increment[0], new.increment[1] = w.way[0], w.way[1]
    new.friction, new.slid, new.speed = mu, slid, speed
    new.hysteresis[0], new.hysteresis[1] = w.rub[0, 0], w.rub[1, 0]
    scale_friction(w, push, mu, slope * by_slip)
    f_1, f_2, f_3 = push * w.rub[0, 0], push * w.rub[1, 0], push * spread * w.rub[2, 0]
    for b in range(3):
        w.normal[b] = -push * sign * (n_0 if b == 0 else (n_1 if b == 1 else n_2))
        w.tangential[b] = -(f_1 * t[b] + f_2 * s[b])
        w.couple[b] = -f_3 * (n_0 if b == 0 else (n_1 if b == 1 else n_2))
    slope_on_sphere(w, old, radius, sign, size, old_size, push, spread)
    return push


@kernel
def scale_friction(w: Scratch, push: float, mu: float, by_slid: float) -> None:
    """Multiply ``w.rub`` by the friction coefficient, whose derivative by the sliding it takes up.

    The last column becomes the derivative of N times it by N.
    """
    rub_, slid_by = w.rub, w.slid_by
    for row in range(3):
        z = rub_[row, 0]
        rub_[row, 0] = mu * z
        for col in range(3):
            rub_[row, 1 + col] = mu * rub_[row, 1 + col] + z * by_slid * slid_by[col]
        rub_[row, 4] = mu * (z + push * rub_[row, 4])


@kernel
def slope_on_sphere(
    w: Scratch,
    old: Touch,
    radius: float,
    sign: float,
    size: float,
    old_size: float,
    push: float,
    spread: float,
) -> None:
    """Set ``w.six`` (6, 6): derivative of force and couple of a cap by shift and turn.

    Of the body's material at the centre of pressure; axes of the carrier.
    """
    d, o, t, s = w.d, w.old_place, w.tangent_1, w.tangent_2
    n_0, n_1, n_2 = sign * d[0] / size, sign * d[1] / size, sign * d[2] / size
    f_1, f_2, f_3 = push * w.rub[0, 0], push * w.rub[1, 0], spread * push * w.rub[2, 0]
    o_1, o_2 = -w.way[0] / radius, -w.way[1] / radius
    o_n = n_0 * o[0] + n_1 * o[1] + n_2 * o[2]
    x_0 = w.normal[0] + w.tangential[0]
    x_1 = w.normal[1] + w.tangential[1]
    x_2 = w.normal[2] + w.tangential[2]
    face, axes, by, spin_by, r = w.face, old.axes, w.push_by, w.spin_by, w.rub
    k_n = 1.0 / (1.0 + n_2)
    for col in range(6):
        d_n, c_1, c_2 = by[0, col], by[1, col], by[2, col]
        y_0 = c_1 * face[0, 0] + c_2 * face[1, 0]  # the centre of pressure in the face
        y_1 = c_1 * face[0, 1] + c_2 * face[1, 1]
        y_2 = c_1 * face[0, 2] + c_2 * face[1, 2]
        s_0, s_1, s_2 = y_0, y_1, y_2
        if col == 0:
            s_0 += 1.0
        elif col == 1:
            s_1 += 1.0
        elif col == 2:
            s_2 += 1.0
        turn = sign / size
        e_1 = turn * (t[0] * s_0 + t[1] * s_1 + t[2] * s_2)
        e_2 = turn * (s[0] * s_0 + s[1] * s_1 + s[2] * s_2)
        w_n = k_n * (n_1 * e_1 - n_0 * e_2)
        q_0 = (c_1 * axes[0, 0] + c_2 * axes[1, 0]) / old_size
        q_1 = (c_1 * axes[0, 1] + c_2 * axes[1, 1]) / old_size
        q_2 = (c_1 * axes[0, 2] + c_2 * axes[1, 2]) / old_size
        q_o = q_0 * o[0] + q_1 * o[1] + q_2 * o[2]
        q_0, q_1, q_2 = q_0 - q_o * o[0], q_1 - q_o * o[1], q_2 - q_o * o[2]
        w_1 = -radius * (-e_1 * o_n + w_n * o_2 + t[0] * q_0 + t[1] * q_1 + t[2] * q_2)
        w_2 = -radius * (-e_2 * o_n - w_n * o_1 + s[0] * q_0 + s[1] * q_1 + s[2] * q_2)
        m_0 = t[0] * e_1 + s[0] * e_2  # change of n
        m_1 = t[1] * e_1 + s[1] * e_2
        m_2 = t[2] * e_1 + s[2] * e_2
        w_3 = spin_by[0] * m_0 + spin_by[1] * m_1 + spin_by[2] * m_2
        if col >= 3:
            w_3 += spin_by[col]
        w_3 *= spread
        g_1 = push * (r[0, 1] * w_1 + r[0, 2] * w_2 + r[0, 3] * w_3) + r[0, 4] * d_n - f_2 * w_n
        g_2 = push * (r[1, 1] * w_1 + r[1, 2] * w_2 + r[1, 3] * w_3) + r[1, 4] * d_n + f_1 * w_n
        g_3 = spread * (push * (r[2, 1] * w_1 + r[2, 2] * w_2 + r[2, 3] * w_3) + r[2, 4] * d_n)
        g_n = sign * d_n - (f_1 * e_1 + f_2 * e_2)
        six = w.six
        six[0, col] = -g_n * n_0 - push * sign * m_0 - g_1 * t[0] - g_2 * s[0]
        six[1, col] = -g_n * n_1 - push * sign * m_1 - g_1 * t[1] - g_2 * s[1]
        six[2, col] = -g_n * n_2 - push * sign * m_2 - g_1 * t[2] - g_2 * s[2]
        six[3, col] = -g_3 * n_0 - f_3 * m_0 + y_1 * x_2 - y_2 * x_1
        six[4, col] = -g_3 * n_1 - f_3 * m_1 + y_2 * x_0 - y_0 * x_2
        six[5, col] = -g_3 * n_2 - f_3 * m_2 + y_0 * x_1 - y_1 * x_0


@kernel
def plane_disc(
    p: Props, c: Sliders, w: Scratch, old: Touch, new: Touch, a: float, dt: float
) -> float:
    """Set force and couple of the top slider's face on the bottom slider's plane; see above."""
    penetration = bed_of_plane(w)
    rest_disc(w, old, new, p.interface_friction)
    push = press_bed(w, c, old, new, penetration, a, dt)
    if push <= 0.0:
        return 0.0
    e_1, e_2 = new.centre[0], new.centre[1]
    spread = torsion_radius(old, a)
    for b in range(2):
        w.way[b] = w.d[b] - old.spot[b] - e_1 * old.axes[0, b] - e_2 * old.axes[1, b]
    w.way[2] = spread * spun(w, old, 0.0, 0.0, 1.0)
    kept, by_push = kept_share(old.push, push, 0.0) if dt > 0.0 else (1.0, 0.0)
    slid = rub(
        w,
        p.bouc_wen,
        p.exponent,
        old.memory,
        w.way,
        max(p.interface_yield, w.soft_high),
        kept,
        by_push,
        old.increment,
        w.share,
        new.memory,
    )
    new.increment[0], new.increment[1] = w.way[0], w.way[1]
    new.slid = slid
    new.speed = slid / dt if dt > 0.0 else 0.0
    new.hysteresis[0], new.hysteresis[1] = w.rub[0, 0], w.rub[1, 0]
    scale_friction(w, push, p.interface_friction, 0.0)
    r = w.rub
    w.normal[2] = push
    w.tangential[0], w.tangential[1] = -push * r[0, 0], -push * r[1, 0]
    w.couple[2] = -spread * push * r[2, 0]
    x_0, x_1, x_2 = w.tangential[0], w.tangential[1], push
    face, axes, by, six = w.face, old.axes, w.push_by, w.six
    for col in range(6):
        d_n, c_1, c_2 = by[0, col], by[1, col], by[2, col]
        y_0 = c_1 * face[0, 0] + c_2 * face[1, 0]
        y_1 = c_1 * face[0, 1] + c_2 * face[1, 1]
        y_2 = c_1 * face[0, 2] + c_2 * face[1, 2]
        w_1 = y_0 - c_1 * axes[0, 0] - c_2 * axes[1, 0]
        w_2 = y_1 - c_1 * axes[0, 1] - c_2 * axes[1, 1]
        if col == 0:
            w_1 += 1.0
        elif col == 1:
            w_2 += 1.0
        w_3 = spread * w.spin_by[col] if col >= 3 else 0.0
        g_3 = spread * (push * (r[2, 1] * w_1 + r[2, 2] * w_2 + r[2, 3] * w_3) + r[2, 4] * d_n)
        six[0, col] = -push * (r[0, 1] * w_1 + r[0, 2] * w_2 + r[0, 3] * w_3) - r[0, 4] * d_n
        six[1, col] = -push * (r[1, 1] * w_1 + r[1, 2] * w_2 + r[1, 3] * w_3) - r[1, 4] * d_n
        six[2, col] = d_n
        six[3, col] = y_1 * x_2 - y_2 * x_1
        six[4, col] = y_2 * x_0 - y_0 * x_2
        six[5, col] = y_0 * x_1 - y_1 * x_0 - g_3
    return push


@kernel
def bond_disc(w: Scratch, c: Sliders, old: Touch, new: Touch, a: float, dt: float) -> None:
    """Set the elastic bond of two sliders that are one piece: that of a disc all over its face."""
    rate = c.damping / dt if dt > 0.0 else 0.0
    square = 0.25 * a * a
    face, six = w.face, w.six
    for row in range(6):
        for col in range(6):
            six[row, col] = 0.0
    for b in range(3):
        w.normal[b] = -c.stiffness * w.d[b] - rate * (w.d[b] - old.spot[b])
        six[b, b] = -c.stiffness - rate
        w.couple[b] = 0.0
    for k in range(2):  # the sum of (B r) x (- k (B - 1) r - c (B - B_old) r / dt) over the face
        f = face[k]
        h_0 = c.stiffness * (1.0 if k == 0 else 0.0) + rate * old.axes[k, 0]
        h_1 = c.stiffness * (1.0 if k == 1 else 0.0) + rate * old.axes[k, 1]
        h_2 = rate * old.axes[k, 2]
        w.couple[0] += square * (f[1] * h_2 - f[2] * h_1)
        w.couple[1] += square * (f[2] * h_0 - f[0] * h_2)
        w.couple[2] += square * (f[0] * h_1 - f[1] * h_0)
        dot = f[0] * h_0 + f[1] * h_1 + f[2] * h_2
        for b in range(3):  # (turn x f) x h = f (turn . h) - turn (f . h)
            six[3 + b, 3] += square * f[b] * h_0
            six[3 + b, 4] += square * f[b] * h_1
            six[3 + b, 5] += square * f[b] * h_2
            six[3 + b, 3 + b] -= square * dot
    rest_disc(w, old, new, 0.0)
    new.gap = -w.d[2]
    new.closure = new.gap
    new.push = max(w.normal[2], 0.0)
