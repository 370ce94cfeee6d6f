"""Kernels of the level 'pendulum': derivatives of its residual and forces, and the tangent.

Three kernels give the derivative: by a rotation `eta` of the slider's axis, by a shift `d` of the
top sphere's centre, by a spin of the top plate. Shifts and spins have the components along the
slider's own axes (t_1, t_2, n), in which most terms vanish. The slider's jacobian and the condensed
tangent consist of them. docs/theory.md derives each line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.pendulum.axial import held_rate, held_rate_fused, tension_rates
from lir_element.kernels.pendulum.spin import plain_rate, rates_by_spin, shared
from lir_element.layout import SPIN_BALANCE

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Work

Rates = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float
]


@inlined_by_llvm
def friction_rate(
    w: Work, k: int, d_hat: float, d_pos: float, dw_1: float, dw_2: float
) -> tuple[float, float]:
    """Return the derivative of the friction force of surface `k`."""
    f_1 = w.h[k, 0, 0] * dw_1 + w.h[k, 0, 1] * dw_2 + w.phi_n[k, 0] * d_pos
    f_2 = w.h[k, 1, 0] * dw_1 + w.h[k, 1, 1] * dw_2 + w.phi_n[k, 1] * d_pos
    return w.n_hat * f_1 + w.phi[k, 0] * d_hat, w.n_hat * f_2 + w.phi[k, 1] * d_hat


@kernel
def top_rates(
    p: Props, w: Work, e_1: float, e_2: float, v: Floats
) -> tuple[float, float, float, float]:
    """Return d(axis against the top plate) (3), rate of the top's radial sliding, d(r_top) (3)."""
    y_1 = w.t[0, 0] * e_1 + w.t[1, 0] * e_2 - (v[1] * w.n[2] - v[2] * w.n[1])
    y_2 = w.t[0, 1] * e_1 + w.t[1, 1] * e_2 - (v[2] * w.n[0] - v[0] * w.n[2])
    y_3 = w.t[0, 2] * e_1 + w.t[1, 2] * e_2 - (v[0] * w.n[1] - v[1] * w.n[0])
    radial = w.r_top[0] * y_1 + w.r_top[1] * y_2 + w.r_top[2] * y_3
    hoop = 0.0
    if w.n_hor[1] > 0.0:
        hoop = (w.b_top[0] * y_1 + w.b_top[1] * y_2 + w.b_top[2] * y_3) / w.n_hor[1]
    return (
        p.radius[1] * radial - w.rim_slant[1] * hoop,
        v[1] * w.r_top[2] - v[2] * w.r_top[1] + w.b_top[0] * hoop,
        v[2] * w.r_top[0] - v[0] * w.r_top[2] + w.b_top[1] * hoop,
        v[0] * w.r_top[1] - v[1] * w.r_top[0] + w.b_top[2] * hoop,
    )


@kernel
def basis_rate(
    w: Work, x: float, y: float, z: float, e_1: float, e_2: float, spin: float
) -> tuple[float, float]:
    """Return d(t_a) . (x, y, z) for a = 1, 2 when the axis turns by eta."""
    along = w.n[0] * x + w.n[1] * y + w.n[2] * z
    on_1 = w.t[0, 0] * x + w.t[0, 1] * y + w.t[0, 2] * z
    on_2 = w.t[1, 0] * x + w.t[1, 1] * y + w.t[1, 2] * z
    return -e_1 * along + spin * on_2, -e_2 * along - spin * on_1


@kernel
def rim_rates(
    p: Props, w: Work, e_1: float, e_2: float, v: Floats, spin: float, tilt: float
) -> tuple[float, float, float, float, float, float, float, float]:
    """Return the derivatives of R P u of both rims (2 x 2), of the top rim: force, direction."""
    d_rim, q_1, q_2, q_3 = 0.0, 0.0, 0.0, 0.0
    p_11, p_12, p_21, p_22 = 0.0, 0.0, 0.0, 0.0
    if w.stiff_rim[0] > 0.0:
        u_1, u_2 = w.unit[0, 0], w.unit[0, 1]
        hoop = (u_1 * e_2 - u_2 * e_1) / w.n_hor[0]
        rate = p.radius[0] * w.n[2] * (u_1 * e_1 + u_2 * e_2) - w.rim_slant[0] * hoop
        radial = w.stiff_rim[0] * rate * w.n[2] - w.rim[0] * tilt
        p_11 = p.radius[0] * (radial * u_1 - w.rim[0] * w.n[2] * hoop * u_2)
        p_12 = p.radius[0] * (radial * u_2 + w.rim[0] * w.n[2] * hoop * u_1)
    if w.stiff_rim[1] > 0.0:
        rate, q_1, q_2, q_3 = top_rates(p, w, e_1, e_2, v)
        d_rim = w.stiff_rim[1] * rate
        t, r = w.t, w.r_top
        b_1, b_2 = basis_rate(w, r[0], r[1], r[2], e_1, e_2, spin)
        along_1 = t[0, 0] * r[0] + t[0, 1] * r[1] + t[0, 2] * r[2]
        along_2 = t[1, 0] * r[0] + t[1, 1] * r[1] + t[1, 2] * r[2]
        turn_1 = b_1 + t[0, 0] * q_1 + t[0, 1] * q_2 + t[0, 2] * q_3
        turn_2 = b_2 + t[1, 0] * q_1 + t[1, 1] * q_2 + t[1, 2] * q_3
        p_21 = p.radius[1] * (w.rim[1] * turn_1 + d_rim * along_1)
        p_22 = p.radius[1] * (w.rim[1] * turn_2 + d_rim * along_2)
    return p_11, p_12, p_21, p_22, d_rim, q_1, q_2, q_3


@kernel
def drag_rate(w: Work, k: int, dw_1: float, dw_2: float, m_1: float, m_2: float) -> float:
    """Return the derivative of friction's moment about the axis; `m` is that of N times its arm."""
    q_1, q_2 = plain_rate(w, k, dw_1, dw_2)
    arm, f = w.arm[k], w.plain[k]
    return m_1 * f[1] - m_2 * f[0] + w.n_hat * (arm[0] * q_2 - arm[1] * q_1)


@inlined_by_llvm
def string_rates(
    p: Props, w: Work, d_s1: float, d_s2: float, d_l: float, d_n: float, tilt: float
) -> tuple[float, float, float, float]:
    """Return the part of interface and string in the residual's derivative, and d(F_h)."""
    d_pos = d_n if w.n_true >= 0.0 else 0.0
    d_hat = d_n if w.scale == 1.0 else 0.0
    s_1, s_2, n_1, n_2 = w.sigma[0], w.sigma[1], w.n[0], w.n[1]
    k = w.lean
    g_1, g_2 = w.f_s[0], w.f_s[1]
    g_d1, g_d2 = 0.0, 0.0
    if not p.fused:
        g_1, g_2 = w.n_hat * w.phi_s[0], w.n_hat * w.phi_s[1]
        g_d1 = w.h_s[0, 0] * d_s1 + w.h_s[0, 1] * d_s2 + w.phi_sn[0] * d_pos
        g_d2 = w.h_s[1, 0] * d_s1 + w.h_s[1, 1] * d_s2 + w.phi_sn[1] * d_pos
        g_d1 = w.n_hat * g_d1 + w.phi_s[0] * d_hat
        g_d2 = w.n_hat * g_d2 + w.phi_s[1] * d_hat
    cross = s_2 * g_1 - s_1 * g_2  # over 1 + n_z: moment about n that the basis passes on (2.1)
    d_chi = k * (d_s2 * g_1 + s_2 * g_d1 - d_s1 * g_2 - s_1 * g_d2) + k * k * tilt * cross
    r_1 = d_l * g_1 + w.l * g_d1 + d_chi * n_2 - d_hat * s_1 - w.n_hat * d_s1
    r_2 = d_l * g_2 + w.l * g_d2 - d_chi * n_1 - d_hat * s_2 - w.n_hat * d_s2
    return r_1, r_2, g_d1, g_d2


@kernel
def balance_rate(
    p: Props,
    w: Work,
    d_s1: float,
    d_s2: float,
    d_n: float,
    g_d1: float,
    g_d2: float,
    f_11: float,
    f_12: float,
    f_21: float,
    f_22: float,
    w_11: float,
    w_12: float,
    w_21: float,
    w_22: float,
    p_11: float,
    p_12: float,
    p_21: float,
    p_22: float,
) -> float:
    """Return the derivative of the moments that spin the sliders (2.6)."""
    s_1, s_2 = w.sigma[0], w.sigma[1]
    g_1, g_2 = w.n_hat * w.phi_s[0], w.n_hat * w.phi_s[1]
    d_hat = d_n if w.scale == 1.0 else 0.0
    balance = d_s1 * g_2 - d_s2 * g_1 + s_1 * g_d2 - s_2 * g_d1 - d_hat * w.torque_spin
    m_1 = p.radius[0] * (g_d1 - f_11) + shared(p, w, 0, p_11, p_21)
    m_2 = p.radius[0] * (g_d2 - f_12) + shared(p, w, 0, p_12, p_22)
    balance -= drag_rate(w, 0, w_11, w_12, m_1, m_2)
    m_1 = p.radius[1] * (g_d1 - f_21) + shared(p, w, 1, p_11, p_21)
    m_2 = p.radius[1] * (g_d2 - f_22) + shared(p, w, 1, p_12, p_22)
    return balance - drag_rate(w, 1, w_21, w_22, m_1, m_2)


@inlined_by_llvm
def by_turn(p: Props, w: Work, a: int) -> Rates:
    """Return the derivatives by a rotation of the slider's axis towards t_1 (0) or t_2 (1).

    Derivatives of residual (2), N, F_h (2), F_2 (2), top rim (1 + 3), spin of the basis, balance.
    If the interface is fused, its force is left out: it follows from the residual. The balance is
    that of the moments that spin the sliders, zero if the spin is no unknown.
    """
    k = w.lean
    s_1, s_2 = w.sigma[0], w.sigma[1]
    spin = k * w.n[1] if a == 0 else -k * w.n[0]
    tilt = w.n[a]  # -d(n_z)
    d_s1, d_s2 = spin * s_2, -spin * s_1  # (1.4)
    d_l = -w.sigma[a]  # (1.5)
    w_11, w_12 = spin * w.old[0, 1], -spin * w.old[0, 0]
    w_21, w_22 = spin * w.old[1, 1], -spin * w.old[1, 0]
    if a == 0:
        d_s1, w_11, w_21 = d_s1 + w.l, w_11 - w.old[0, 2], w_21 - w.old[1, 2]
    else:
        d_s2, w_12, w_22 = d_s2 + w.l, w_12 - w.old[0, 2], w_22 - w.old[1, 2]
    w_11, w_12, w_21, w_22 = (
        p.radius[0] * w_11,
        p.radius[0] * w_12,
        p.radius[1] * w_21,
        p.radius[1] * w_22,
    )
    if p.fixed_load > 0.0:  # the height follows, so that the length stays
        d_s1, d_s2 = d_s1 + w.t[0, 2] * d_l / w.n[2], d_s2 + w.t[1, 2] * d_l / w.n[2]
        d_l = 0.0
    d_n = w.stiff_n * d_l
    if p.fixed_load > 0.0 and not p.fused:
        d_n = held_rate(w, 1.0 - a, 0.0 + a, d_s1, d_s2)
    d_pos = d_n if w.n_true >= 0.0 else 0.0
    d_hat = d_n if w.scale == 1.0 else 0.0
    f_11, f_12 = friction_rate(w, 0, d_hat, d_pos, w_11, w_12)
    f_21, f_22 = friction_rate(w, 1, d_hat, d_pos, w_21, w_22)
    if p.fused and w.scale < 1.0:  # true forces at once: there is no other equilibrium to keep
        f_11, f_12 = w.scale * f_11 + w.phi[0, 0] * d_pos, w.scale * f_12 + w.phi[0, 1] * d_pos
        f_21, f_22 = w.scale * f_21 + w.phi[1, 0] * d_pos, w.scale * f_22 + w.phi[1, 1] * d_pos
    r_1 = -p.radius[0] * f_11 - p.radius[1] * f_21
    r_2 = -p.radius[0] * f_12 - p.radius[1] * f_22
    d_rim, q_1, q_2, q_3 = 0.0, 0.0, 0.0, 0.0
    p_11, p_12, p_21, p_22 = 0.0, 0.0, 0.0, 0.0
    if w.stiff_rim[0] > 0.0 or w.stiff_rim[1] > 0.0:
        p_11, p_12, p_21, p_22, d_rim, q_1, q_2, q_3 = rim_rates(
            p, w, 1.0 - a, 0.0 + a, w.still, spin, tilt
        )
        r_1, r_2 = r_1 + p_11 + p_21, r_2 + p_12 + p_22
    if p.fixed_load > 0.0 and p.fused:
        d_n = held_rate_fused(w, 1.0 - a, 0.0 + a, r_1, r_2)
        f_21, f_22 = f_21 + w.phi[1, 0] * d_n, f_22 + w.phi[1, 1] * d_n
        r_1, r_2 = r_1 - w.drag[0] * d_n, r_2 - w.drag[1] * d_n
    x_1, x_2, g_d1, g_d2 = string_rates(p, w, d_s1, d_s2, d_l, d_n, tilt)
    g_1, g_2 = w.f_s[0], w.f_s[1]
    if not p.fused:
        g_1, g_2 = w.n_hat * w.phi_s[0], w.n_hat * w.phi_s[1]
    chi = k * (s_2 * g_1 - s_1 * g_2)
    turned = chi * k * tilt
    r_1, r_2 = r_1 + x_1 - turned * w.n[1], r_2 + x_2 + turned * w.n[0]
    if a == 0:
        r_2 -= chi
    else:
        r_1 += chi
    balance = 0.0
    if w.spins > 0.0:
        balance = balance_rate(
            p,
            w,
            d_s1,
            d_s2,
            d_n,
            g_d1,
            g_d2,
            f_11,
            f_12,
            f_21,
            f_22,
            w_11,
            w_12,
            w_21,
            w_22,
            p_11,
            p_12,
            p_21,
            p_22,
        )
    return r_1, r_2, d_n, g_d1, g_d2, f_21, f_22, d_rim, q_1, q_2, q_3, spin, balance


@inlined_by_llvm
def by_shift(p: Props, w: Work, d_1: float, d_2: float, d_3: float) -> Rates:
    """Return the same by a shift of the top sphere's centre along the slider's own axes."""
    d_l = -d_3
    d_n = w.stiff_n * d_l
    if p.fixed_load > 0.0 and not p.fused:
        d_n = held_rate(w, 0.0, 0.0, d_1, d_2)
    f_11, f_12, f_21, f_22 = 0.0, 0.0, 0.0, 0.0
    if d_n != 0.0:
        d_pos = d_n if w.n_true >= 0.0 else 0.0
        d_hat = d_n if w.scale == 1.0 else 0.0
        f_11, f_12 = friction_rate(w, 0, d_hat, d_pos, 0.0, 0.0)
        f_21, f_22 = friction_rate(w, 1, d_hat, d_pos, 0.0, 0.0)
        if p.fused and w.scale < 1.0:
            f_11, f_12 = w.scale * f_11 + w.phi[0, 0] * d_pos, w.scale * f_12 + w.phi[0, 1] * d_pos
            f_21, f_22 = w.scale * f_21 + w.phi[1, 0] * d_pos, w.scale * f_22 + w.phi[1, 1] * d_pos
    r_1, r_2, g_d1, g_d2 = string_rates(p, w, d_1, d_2, d_l, d_n, 0.0)
    r_1 -= p.radius[0] * f_11 + p.radius[1] * f_21
    r_2 -= p.radius[0] * f_12 + p.radius[1] * f_22
    balance = 0.0
    if w.spins > 0.0:
        balance = balance_rate(
            p,
            w,
            d_1,
            d_2,
            d_n,
            g_d1,
            g_d2,
            f_11,
            f_12,
            f_21,
            f_22,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        )
    return r_1, r_2, d_n, g_d1, g_d2, f_21, f_22, 0.0, 0.0, 0.0, 0.0, 0.0, balance


@inlined_by_llvm
def by_plate(p: Props, w: Work, v_1: float, v_2: float, v_3: float) -> Rates:
    """Return the same by a spin of the top plate about the slider's own axes."""
    m = w.old[1]
    w_21, w_22 = p.radius[1] * (v_2 * m[2] - v_3 * m[1]), p.radius[1] * (v_3 * m[0] - v_1 * m[2])
    f_21, f_22 = friction_rate(w, 1, 0.0, 0.0, w_21, w_22)
    if p.fused and w.scale < 1.0:
        f_21, f_22 = w.scale * f_21, w.scale * f_22
    r_1, r_2 = -p.radius[1] * f_21, -p.radius[1] * f_22
    d_n, d_rim, q_1, q_2, q_3, p_21, p_22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if w.stiff_rim[1] > 0.0:
        for a in range(3):
            w.along[a] = w.t[0, a] * v_1 + w.t[1, a] * v_2 + w.n[a] * v_3
        _, _, p_21, p_22, d_rim, q_1, q_2, q_3 = rim_rates(p, w, 0.0, 0.0, w.along, 0.0, 0.0)
        r_1, r_2 = r_1 + p_21, r_2 + p_22
    balance = 0.0
    if w.spins > 0.0:
        balance = balance_rate(
            p,
            w,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            f_21,
            f_22,
            0.0,
            0.0,
            w_21,
            w_22,
            0.0,
            0.0,
            p_21,
            p_22,
        )
    if p.fixed_load > 0.0 and p.fused:
        d_n = held_rate_fused(w, 0.0, 0.0, r_1, r_2)
        f_21, f_22 = f_21 + w.phi[1, 0] * d_n, f_22 + w.phi[1, 1] * d_n
        r_1 -= w.drag[0] * d_n + (d_n if w.scale == 1.0 else 0.0) * w.sigma[0]
        r_2 -= w.drag[1] * d_n + (d_n if w.scale == 1.0 else 0.0) * w.sigma[1]
    return r_1, r_2, d_n, 0.0, 0.0, f_21, f_22, d_rim, q_1, q_2, q_3, 0.0, balance


@kernel
def slider_jacobian(p: Props, w: Work) -> None:
    """Set the derivatives of everything by a turn of the slider's axis: rows of `w.turns`."""
    x, y, turns = by_turn(p, w, 0), by_turn(p, w, 1), w.turns
    for k in range(w.rates.shape[0]):
        turns[0, k], turns[1, k] = x[k], y[k]
    w.jacobian[0, 0], w.jacobian[1, 0] = x[0], x[1]
    w.jacobian[0, 1], w.jacobian[1, 1] = y[0], y[1]


@inlined_by_llvm
def column(p: Props, w: Work, col: int, rates: Rates, d_1: float, d_2: float, d_3: float) -> None:
    """Set column `col` of the condensed stiffness from the derivatives by a shift `d`, or a spin.

    The axis follows: it stays in equilibrium; that of a rigid slider stays the line of the centres.
    """
    r, inv = w.rates, w.inverse
    e_1 = -(inv[0] * rates[0] + inv[1] * rates[1])  # (4.1)
    e_2 = -(inv[2] * rates[0] + inv[3] * rates[1])
    if p.fused:
        e_1, e_2 = -d_1 / w.l, -d_2 / w.l
    for k in range(r.shape[0]):
        r[k] = rates[k] + e_1 * w.turns[0, k] + e_2 * w.turns[1, k]
    if p.fused:
        r[3], r[4] = -r[0] / w.l, -r[1] / w.l
    elif w.spins > 0.0:
        share = -r[SPIN_BALANCE] / w.spun[SPIN_BALANCE]
        e_1, e_2 = e_1 + share * w.spun_turn[0], e_2 + share * w.spun_turn[1]
        for k in range(12):
            r[k] += share * w.spun[k]
    d_n, g_d1, g_d2, f_1, f_2, d_rim, spin = r[2], r[3], r[4], r[5], r[6], r[7], r[11]
    d_pos = d_n if w.n_true >= 0.0 else 0.0
    if not p.fused and w.scale < 1.0:  # the forces fade with the axial force
        g_d1 = w.scale * g_d1 + d_pos * w.phi_s[0]
        g_d2 = w.scale * g_d2 + d_pos * w.phi_s[1]
        f_1 = w.scale * f_1 + d_pos * w.phi[1, 0]
        f_2 = w.scale * f_2 + d_pos * w.phi[1, 1]
        d_rim = w.scale * d_rim + d_pos / w.n_hat * w.rim[1]
        if w.n_true < 0.0:
            pull_1, pull_2 = tension_rates(w, e_1, e_2, spin, d_1, d_2, d_3)
            g_d1, g_d2 = g_d1 + pull_1, g_d2 + pull_2
    s_1, s_2, k6 = w.f_s[0], w.f_s[1], w.k6
    k6[0, col] = g_d1 - spin * s_2 - w.n_true * e_1
    k6[1, col] = g_d2 + spin * s_1 - w.n_true * e_2
    k6[2, col] = -(s_1 * e_1 + s_2 * e_2) - d_n
    # the top plate's force on the slider, and its rate
    p_1, p_2, p_3 = w.n_pos * w.phi[1, 0], w.n_pos * w.phi[1, 1], 0.0
    x_1, x_2 = f_1 - spin * p_2, f_2 + spin * p_1
    if w.rim[1] > 0.0:
        t, n, top, rim = w.t, w.n, w.r_top, w.rim_scale * w.rim[1]
        y_1, y_2 = d_rim * top[0] + rim * r[8], d_rim * top[1] + rim * r[9]
        y_3 = d_rim * top[2] + rim * r[10]
        x_1 -= t[0, 0] * y_1 + t[0, 1] * y_2 + t[0, 2] * y_3
        x_2 -= t[1, 0] * y_1 + t[1, 1] * y_2 + t[1, 2] * y_3
        p_1 -= rim * (t[0, 0] * top[0] + t[0, 1] * top[1] + t[0, 2] * top[2])
        p_2 -= rim * (t[1, 0] * top[0] + t[1, 1] * top[1] + t[1, 2] * top[2])
        p_3 -= rim * (n[0] * top[0] + n[1] * top[1] + n[2] * top[2])
    lever = p.radius[1]
    k6[3, col] = lever * (e_2 * p_3 - x_2)
    k6[4, col] = lever * (x_1 - e_1 * p_3)
    k6[5, col] = lever * (e_1 * p_2 - e_2 * p_1)
    k6[6, col] = d_pos


@kernel
def condense(p: Props, w: Work) -> None:
    """Set the condensed stiffness in the slider's own axes, and the derivative of N as last row."""
    inv, j = w.inverse, w.jacobian
    slider_jacobian(p, w)
    if not p.fused:
        det = j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]
        inv[0], inv[1] = j[1, 1] / det, -j[0, 1] / det
        inv[2], inv[3] = -j[1, 0] / det, j[0, 0] / det
        if w.spins > 0.0:
            rates_by_spin(p, w)
    for a in range(3):
        d_1, d_2, d_3 = 1.0 if a == 0 else 0.0, 1.0 if a == 1 else 0.0, 1.0 if a == 2 else 0.0
        column(p, w, a, by_shift(p, w, d_1, d_2, d_3), d_1, d_2, d_3)
        column(p, w, 3 + a, by_plate(p, w, d_1, d_2, d_3), 0.0, 0.0, 0.0)
