"""Kernels of a disc on an elastic bed: its load in closed form, and its friction with spin.

The slider's face is a rigid disc of radius a on a bed whose pressure is proportional to the
penetration ``p + g . r``. Where all of it presses the load is that of the centre, else that of a
segment of the circle. Friction is that of a disc under even pressure about the centre of pressure:
its dissipation for a sliding v and a spin w, the mean of ``|v + w x r|``, is a norm of (v, a w).
docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined, kernel
from lir_element.kernels.slip import bouc_wen_radius, direction_of, turn_to_end

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch

_A, _B, _C = 5.0 / 6.0, 7.0 / 27.0, 7.0 / 12.0  # of the norm: exact for slow and fast spin (7.12)
_NOTHING = 1e-17  # square of z: friction of 1e-10 of the load, where Newton's method stops
_FULL = 1.0 + 1e-12  # round-off: what has slipped holds until it slides on


@kernel
def segment(u: float) -> tuple[float, float, float, float]:
    """Return load, moment and their derivatives of a unit disc under ``max(u + x, 0)``, -1 < u < 1.

    Over the area of the disc: load f, moment h about the centre, df/du (the share of the area that
    presses) and dh/du.
    """
    root = math.sqrt(1.0 - u * u)
    angle, cube = math.acos(-u), root * root * root * (2.0 / 3.0)
    inv = 1.0 / math.pi
    share = inv * (angle + u * root)
    by = inv * cube
    f = u * share + by  # (7.9)
    h = u * by + 0.25 * inv * (angle - u * root * (1.0 - 2.0 * u * u))  # (7.10)
    return f, h, share, by


@kernel
def disc_load(w: Scratch, p: float, g_1: float, g_2: float, a: float) -> float:
    """Set mean penetration and centre of pressure of a disc, with derivatives; return the former.

    ``w.bed`` (3, 4): rows V and the centre of pressure's place (2), each with its derivative by p
    and g (2).
    """
    out = w.bed
    tilt = math.sqrt(g_1 * g_1 + g_2 * g_2)
    edge = tilt * a
    if p >= edge:  # all of it presses
        if p <= 0.0:
            return 0.0
        arm = 0.25 * a * a / p
        out[0, 0], out[0, 1], out[0, 2], out[0, 3] = p, 1.0, 0.0, 0.0
        out[1, 0], out[1, 1], out[1, 2], out[1, 3] = arm * g_1, -arm * g_1 / p, arm, 0.0
        out[2, 0], out[2, 1], out[2, 2], out[2, 3] = arm * g_2, -arm * g_2 / p, 0.0, arm
        return p
    if p <= -edge:
        return 0.0
    u = p / edge
    f, h, share, by = segment(u)
    if f <= 0.0:  # to round-off
        return 0.0
    e_1, e_2 = g_1 / tilt, g_2 / tilt
    ratio = h / f
    bent = (by - ratio * share) / f  # d(h / f) / du
    by_tilt = -bent * u / tilt * a
    v_g = a * (f - u * share)
    hoop = a * ratio / tilt
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = edge * f, share, v_g * e_1, v_g * e_2
    out[1, 0], out[1, 1] = a * ratio * e_1, bent / tilt * e_1
    out[2, 0], out[2, 1] = a * ratio * e_2, bent / tilt * e_2
    out[1, 2] = by_tilt * e_1 * e_1 + hoop * e_2 * e_2
    out[1, 3] = (by_tilt - hoop) * e_1 * e_2
    out[2, 2] = out[1, 3]
    out[2, 3] = by_tilt * e_2 * e_2 + hoop * e_1 * e_1
    return edge * f


@kernel
def rubbing(x: float, y: float, s: float) -> tuple[float, float, float, float, float, float]:
    """Return the square of the norm of (x, y, s), and half its derivatives by the squares (7.12).

    Six numbers: Q; Q_v, Q_t by ``v = x^2 + y^2`` and ``t = s^2``; Q_vv, Q_vt, Q_tt.
    """
    v, t = x * x + y * y, s * s
    low = v + _C * t
    if low < _NOTHING:  # no direction: stiffnesses of sliding alone, of spinning alone
        return v + _B / _C * t, 1.0, _B / _C, 0.0, 0.0, 0.0
    inv = 1.0 / low
    q = (v * v + _A * v * t + _B * t * t) * inv
    q_v = (2.0 * v + _A * t - q) * inv
    q_t = (_A * v + 2.0 * _B * t - _C * q) * inv
    return (
        q,
        q_v,
        q_t,
        (2.0 - 2.0 * q_v) * inv,
        (_A - _C * q_v - q_t) * inv,
        (2.0 * _B - 2.0 * _C * q_t) * inv,
    )


@kernel
def size_of(z: Floats) -> float:
    """Return the norm of a hysteretic variable with spin."""
    q, _, _, _, _, _ = rubbing(z[0], z[1], z[2])
    return math.sqrt(q)


@kernel
def slid_on(w: Scratch, z: Floats, d_1: float, d_2: float, d_3: float, u_y: float) -> float:
    """Return the sliding past the old z (3.9), in the norm; set its derivative ``w.slid_by``."""
    inv = 1.0 / u_y
    b_1, b_2, b_3 = z[0] + d_1 * inv, z[1] + d_2 * inv, z[2] + d_3 * inv
    q, q_v, q_t, _, _, _ = rubbing(b_1, b_2, b_3)
    size, before = math.sqrt(q), size_of(z)
    by = w.slid_by
    by[0], by[1], by[2] = 0.0, 0.0, 0.0
    if size <= before:
        return 0.0
    by[0], by[1], by[2] = b_1 * q_v / size, b_2 * q_v / size, b_3 * q_t / size
    return u_y * (size - before)


@kernel
def bend_of_norm(w: Scratch, q_v: float, q_t: float, q_vv: float, q_vt: float, q_tt: float) -> None:
    """Set half the second derivative of the norm's square at ``w.rub_b``: ``w.rub_h``."""
    b, h = w.rub_b, w.rub_h
    h[0, 0] = q_v + 2.0 * b[0] * b[0] * q_vv
    h[1, 1] = q_v + 2.0 * b[1] * b[1] * q_vv
    h[2, 2] = q_t + 2.0 * b[2] * b[2] * q_tt
    h[0, 1] = 2.0 * b[0] * b[1] * q_vv
    h[0, 2], h[1, 2] = 2.0 * b[0] * b[2] * q_vt, 2.0 * b[1] * b[2] * q_vt
    h[1, 0], h[2, 0], h[2, 1] = h[0, 1], h[0, 2], h[1, 2]


@inlined
def returned_by(
    bouc_wen: int, exponent: float, size: float, kappa: float
) -> tuple[float, float, float, float]:
    """Return what is left of b, ``z = c b``, and three factors of its derivative.

    ``dc = c_b g . db + c_d g . dd - c_h (h d) . db`` with g half the gradient of the norm's square,
    h its derivative and d the sliding over the way to slip.
    """
    if bouc_wen and kappa > 0.0 and size < 1.0 + kappa:
        rho, by_size, power = bouc_wen_radius(size, kappa, exponent)
        over = 1.0 / size
        c, square = rho * over, over * over
        c_h = by_size * power * square
        return c, square * (by_size * (1.0 + power * kappa * over) - c), -c_h, c_h
    if size > _FULL:
        c = 1.0 / size
        return c, -c * c * c, 0.0, 0.0
    return 1.0, 0.0, 0.0, 0.0


@kernel
def rub(
    w: Scratch,
    bouc_wen: int,
    exponent: float,
    old: Floats,
    d: Floats,
    u_y: float,
    kept: float,
    by_push: float,
    before: Floats,
    share: float,
    z: Floats,
) -> float:
    """Set the friction of a disc that slides by ``d[:2]`` and spins by ``d[2]`` over its radius.

    `z` (3,) is the new hysteretic variable, ``w.rub`` (3, 5) the friction over mu N (spin: torque
    over mu N a) with its derivatives by `d` and by the axial force; ``w.slid_by`` belongs to what
    is returned, the sliding past the old z. Laws as in `slip.friction_map`; the norm of section 7
    takes the place of the length.
    """
    inv = 0.5 * (1.0 + kept) / u_y
    u, half = 1.0 / inv, 0.5 * by_push / u_y
    b, g, hd, n, e = w.rub_b, w.rub_g, w.rub_hd, w.rub_n, w.rub_e
    for k in range(3):
        hd[k] = d[k] * inv
        b[k] = kept * old[k] + hd[k]
        e[k] = half * d[k]
        n[k] = by_push * old[k] + e[k]
    q, q_v, q_t, q_vv, q_vt, q_tt = rubbing(b[0], b[1], b[2])
    size = math.sqrt(q)
    g[0], g[1], g[2] = b[0] * q_v, b[1] * q_v, b[2] * q_t  # half the gradient
    bend_of_norm(w, q_v, q_t, q_vv, q_vt, q_tt)
    h, out, by = w.rub_h, w.rub, w.rub_c
    kappa = (g[0] * hd[0] + g[1] * hd[1] + g[2] * hd[2]) / size if size > 0.0 else 0.0
    c, c_b, c_d, c_h = returned_by(bouc_wen, exponent, size, kappa)
    d_1, d_2, d_3 = hd[0], hd[1], hd[2]
    along, by[3] = 0.0, 0.0
    for k in range(3):  # derivative of c: by d over inv, and by the axial force
        hd[k] = h[k, 0] * d_1 + h[k, 1] * d_2 + h[k, 2] * d_3
        by[k] = (c_b + c_d) * g[k] - c_h * hd[k]
        along += g[k] * n[k]
        by[3] += c_b * g[k] * n[k] + c_d * g[k] * e[k] - c_h * hd[k] * n[k]
    for a in range(3):
        z[a], out[a, 0] = c * b[a], c * g[a]
        for k in range(3):
            out[a, 1 + k] = inv * (c * h[a, k] + g[a] * by[k])
        out[a, 4] = c * (h[a, 0] * n[0] + h[a, 1] * n[1] + h[a, 2] * n[2]) + g[a] * by[3]
    slip = u * size * (1.0 - c)
    slid = slid_on(w, old, d[0], d[1], d[2], u_y)
    if share == 0.0 or slip == 0.0 or slid == 0.0:
        return slid
    slope = w.slip_by  # derivative of the slip by d and by the axial force
    for k in range(3):
        slope[k] = g[k] / size * (1.0 - c) - size * by[k]
    slope[3] = u * (along / size * (1.0 - c) - size * by[3] - slip * half)
    turn_on(w, d, before, share, slip, slid, u_y, z)
    return slid


@kernel
def turn_on(
    w: Scratch,
    d: Floats,
    before: Floats,
    share: float,
    slip: float,
    slid: float,
    u_y: float,
    z: Floats,
) -> None:
    """Turn friction and hysteretic variable on to the end of the step (3.7), with derivatives."""
    slope, out = w.slip_by, w.rub
    if slid < slip:
        slip = slid
        for k in range(3):
            slope[k] = w.slid_by[k]
        slope[3] = 0.0
    turns, angle, by_angle, by_slip = turn_to_end(
        before[0], before[1], d[0], d[1], share, slip, u_y
    )
    if not turns:
        return
    c, s = direction_of(angle)
    for k in range(5):
        x, y = out[0, k], out[1, k]
        out[0, k], out[1, k] = c * x - s * y, s * x + c * y
    x, y = z[0], z[1]
    z[0], z[1] = c * x - s * y, s * x + c * y
    f_1, f_2 = out[0, 0], out[1, 0]
    for k in range(4):
        turn = by_slip * slope[k]
        if k == 0:
            turn -= by_angle * d[1]
        elif k == 1:
            turn += by_angle * d[0]
        out[0, 1 + k] -= f_2 * turn
        out[1, 1 + k] += f_1 * turn
