"""Kernels of a disc on an elastic bed: its load in closed form, and its friction with spin.

The slider's face is a rigid disc of radius a on a bed whose pressure is proportional to the
penetration ``p + g . r``. If all of it presses, the load is that of the centre, else that of a
segment of the circle. Friction is that of a disc under even pressure about the centre of pressure:
its dissipation for a sliding v and a spin w, the mean of ``|v + w x r|``, is a norm of (v, a w).
docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.slip import bouc_wen_radius, direction_of, turn_to_end

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch

_D, _E = 0.573, 0.368  # of the norm (7.12): force and torque within 3 %
_A = _D + 1.0 / 4.0  # exact for slow spin
_C = 4.0 / 9.0 * _E  # exact for fast spin
_B = 2.0 / 3.0 * _E + 4.0 / 9.0 * _D  # exact to second order there
_NOTHING = 1e-17  # square of z: friction of 1e-10 of the load, the end of Newton's method
_FULL = 1.0 + 1e-12  # round-off: a contact that has slipped holds until it slides on


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


@inlined_by_llvm
def disc_load(p: float, g_1: float, g_2: float, a: float) -> tuple[float, float, float]:
    """Return mean penetration and place of the centre of pressure (2) of a disc; zeros if open."""
    tilt = math.sqrt(g_1 * g_1 + g_2 * g_2)
    edge = tilt * a
    if p >= edge:  # full contact
        if p <= 0.0:
            return 0.0, 0.0, 0.0
        arm = 0.25 * a * a / p
        return p, arm * g_1, arm * g_2
    if p <= -edge:
        return 0.0, 0.0, 0.0
    f, h, _, _ = segment(p / edge)
    if f <= 0.0:  # to round-off
        return 0.0, 0.0, 0.0
    arm = a * h / (f * tilt)
    return edge * f, arm * g_1, arm * g_2


@kernel
def disc_load_slope(w: Scratch, p: float, g_1: float, g_2: float, a: float) -> None:
    """Set the derivative of `disc_load`, ``w.bed`` (3, 3): by p and g (2)."""
    out = w.bed
    tilt = math.sqrt(g_1 * g_1 + g_2 * g_2)
    if p >= tilt * a:
        arm = 0.25 * a * a / p
        out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, 0.0
        out[1, 0], out[1, 1], out[1, 2] = -arm * g_1 / p, arm, 0.0
        out[2, 0], out[2, 1], out[2, 2] = -arm * g_2 / p, 0.0, arm
        return
    u = p / (tilt * a)
    f, h, share, by = segment(u)
    e_1, e_2 = g_1 / tilt, g_2 / tilt
    ratio = h / f
    bent = (by - ratio * share) / f  # d(h / f) / du
    by_tilt = -bent * u / tilt * a
    v_g = a * (f - u * share)
    hoop = a * ratio / tilt
    out[0, 0], out[0, 1], out[0, 2] = share, v_g * e_1, v_g * e_2
    out[1, 0], out[2, 0] = bent / tilt * e_1, bent / tilt * e_2
    out[1, 1] = by_tilt * e_1 * e_1 + hoop * e_2 * e_2
    out[1, 2] = (by_tilt - hoop) * e_1 * e_2
    out[2, 1] = out[1, 2]
    out[2, 2] = by_tilt * e_2 * e_2 + hoop * e_1 * e_1


@inlined_by_llvm
def rubbing(x: float, y: float, s: float) -> tuple[float, float, float, float, float, float]:
    """Return the square of the norm of (x, y, s), and half its derivatives by the squares (7.12).

    Six numbers: Q; Q_v, Q_t by ``v = x^2 + y^2`` and ``t = s^2``; Q_vv, Q_vt, Q_tt.
    """
    v, t = x * x + y * y, s * s
    if v + t < _NOTHING:  # no direction: stiffnesses of sliding alone, of spinning alone
        return v + _C / _E * t, 1.0, _C / _E, 0.0, 0.0, 0.0
    inv = 1.0 / (v * v + _D * v * t + _E * t * t)
    by_v, by_t = 2.0 * v + _D * t, _D * v + 2.0 * _E * t
    q = (v * v * v + _A * v * v * t + _B * v * t * t + _C * t * t * t) * inv
    q_v = (3.0 * v * v + 2.0 * _A * v * t + _B * t * t - q * by_v) * inv
    q_t = (_A * v * v + 2.0 * _B * v * t + 3.0 * _C * t * t - q * by_t) * inv
    return (
        q,
        q_v,
        q_t,
        (6.0 * v + 2.0 * _A * t - 2.0 * q_v * by_v - 2.0 * q) * inv,
        (2.0 * _A * v + 2.0 * _B * t - q_v * by_t - q_t * by_v - _D * q) * inv,
        (2.0 * _B * v + 6.0 * _C * t - 2.0 * q_t * by_t - 2.0 * _E * q) * inv,
    )


@inlined_by_llvm
def slid_on(
    z: Floats, before: float, d_1: float, d_2: float, d_3: float, u_y: float
) -> tuple[float, float, float, float]:
    """Return the sliding past the old z (3.9), in the norm, and its derivative.

    `before` is the norm of the old z.
    """
    inv = 1.0 / u_y
    b_1, b_2, b_3 = z[0] + d_1 * inv, z[1] + d_2 * inv, z[2] + d_3 * inv
    q, q_v, q_t, _, _, _ = rubbing(b_1, b_2, b_3)
    size = math.sqrt(q)
    if size <= before:
        return 0.0, 0.0, 0.0, 0.0
    over = 1.0 / size
    return u_y * (size - before), b_1 * q_v * over, b_2 * q_v * over, b_3 * q_t * over


@inlined_by_llvm
def returned_by(
    bouc_wen: int, exponent: float, size: float, kappa: float
) -> tuple[float, float, float, float]:
    """Return the remaining share of b, ``z = c b``, and three factors of its derivative.

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


@inlined_by_llvm
def rub(
    w: Scratch,
    bouc_wen: int,
    exponent: float,
    old: Floats,
    old_size: float,
    d_1: float,
    d_2: float,
    d_3: float,
    u_y: float,
    kept: float,
    by_push: float,
    before: Floats,
    share: float,
    z: Floats,
    derive: bool,
) -> tuple[float, float, float, float, float]:
    """Return the friction of a disc that slides by `d` (2) and spins by `d_3` over its radius.

    Friction over mu N (2), torque over mu N a, the sliding past the old z, and the norm of the new
    hysteretic variable `z` (3,); `old_size` is that of the old one. With `derive` also ``w.rub``
    (3, 4), the derivative of the first three by `d` and by the axial force, and ``w.slid_by`` (3,),
    that of the sliding by `d`. Laws as in `slip.friction_map`; the norm of section 7 replaces the
    length.
    """
    inv = 0.5 * (1.0 + kept) / u_y
    h_1, h_2, h_3 = d_1 * inv, d_2 * inv, d_3 * inv
    b_1, b_2, b_3 = kept * old[0] + h_1, kept * old[1] + h_2, kept * old[2] + h_3
    q, q_v, q_t, q_vv, q_vt, q_tt = rubbing(b_1, b_2, b_3)
    size = math.sqrt(q)
    g_1, g_2, g_3 = b_1 * q_v, b_2 * q_v, b_3 * q_t  # half the gradient
    kappa = (g_1 * h_1 + g_2 * h_2 + g_3 * h_3) / size if bouc_wen and size > 0.0 else 0.0
    c, c_b, c_d, c_h = returned_by(bouc_wen, exponent, size, kappa)
    f_1, f_2, f_3 = c * g_1, c * g_2, c * g_3
    z_1, z_2 = c * b_1, c * b_2
    slip = size * (1.0 - c) / inv
    slid, by_1, by_2, by_3 = slid_on(old, old_size, d_1, d_2, d_3, u_y)
    turns = share > 0.0 and slip > 0.0 and slid > 0.0
    if derive:
        b, g, d = w.rub_b, w.rub_g, w.rub_d
        b[0], b[1], b[2] = b_1, b_2, b_3
        g[0], g[1], g[2] = g_1, g_2, g_3
        d[0], d[1], d[2] = d_1, d_2, d_3
        w.slid_by[0], w.slid_by[1], w.slid_by[2] = by_1, by_2, by_3
        bend_of_norm(w, q_v, q_t, q_vv, q_vt, q_tt)
        rub_slope(w, old, inv, 0.5 * by_push / u_y, by_push, size, c, c_b, c_d, c_h)
    if turns:
        held = slid < slip  # the loss of z under a falling axial force is no sliding
        if held:
            slip = slid
        turns, angle, by_angle, by_slip = turn_to_end(
            before[0], before[1], d_1, d_2, share, slip, u_y
        )
        if turns:
            cos, sin = direction_of(angle)
            f_1, f_2 = cos * f_1 - sin * f_2, sin * f_1 + cos * f_2
            z_1, z_2 = cos * z_1 - sin * z_2, sin * z_1 + cos * z_2
            if derive:
                turn_slope(w, cos, sin, f_1, f_2, held, by_angle, by_slip)
    z[0], z[1], z[2] = z_1, z_2, c * b_3
    return f_1, f_2, f_3, slid, c * size


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


@kernel
def rub_slope(
    w: Scratch,
    old: Floats,
    inv: float,
    half: float,
    by_push: float,
    size: float,
    c: float,
    c_b: float,
    c_d: float,
    c_h: float,
) -> None:
    """Set the derivatives of friction and slip in `rub`, before it turns: ``w.rub``, ``w.slip_by``.

    `half` is the derivative of `inv` by the axial force, the other numbers are those of `rub`.
    """
    g, d, h, out = w.rub_g, w.rub_d, w.rub_h, w.rub
    hd, n, by, slope = w.rub_hd, w.rub_n, w.rub_c, w.slip_by
    along, by[3] = 0.0, 0.0
    for k in range(3):
        e = half * d[k]
        n[k] = by_push * old[k] + e
        hd[k] = inv * (h[k, 0] * d[0] + h[k, 1] * d[1] + h[k, 2] * d[2])
        by[k] = (c_b + c_d) * g[k] - c_h * hd[k]
        along += g[k] * n[k]
        by[3] += c_b * g[k] * n[k] + c_d * g[k] * e - c_h * hd[k] * n[k]
    for a in range(3):
        for k in range(3):
            out[a, k] = inv * (c * h[a, k] + g[a] * by[k])
        out[a, 3] = c * (h[a, 0] * n[0] + h[a, 1] * n[1] + h[a, 2] * n[2]) + g[a] * by[3]
    if size == 0.0:
        return
    for k in range(3):
        slope[k] = g[k] / size * (1.0 - c) - size * by[k]
    slope[3] = (along / size * (1.0 - c) - size * by[3] - size * (1.0 - c) * half / inv) / inv


@kernel
def turn_slope(
    w: Scratch,
    c: float,
    s: float,
    f_1: float,
    f_2: float,
    held: bool,
    by_angle: float,
    by_slip: float,
) -> None:
    """Turn the derivative of the friction on to the end of the step (3.7).

    `c` and `s` are cosine and sine of the turn, `f` is the friction after it; `held` says that the
    slip is the sliding past the old z.
    """
    out, d = w.rub, w.rub_d
    for k in range(4):
        x, y = out[0, k], out[1, k]
        slope = w.slip_by[k]
        if held:
            slope = w.slid_by[k] if k < 3 else 0.0
        turn = by_slip * slope
        if k == 0:
            turn -= by_angle * d[1]
        elif k == 1:
            turn += by_angle * d[0]
        out[0, k] = c * x - s * y - f_2 * turn
        out[1, k] = s * x + c * y + f_1 * turn
