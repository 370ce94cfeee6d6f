"""Kernels of the level 'pendulum': the bearing as a string between its sphere centres.

With c from the bottom sphere's centre to the top one, n the slider's axis (internal unknown, two
numbers), and t_1, t_2 the basis of the plane normal to n that rotates with the bottom plate and has
no spin about n (docs/theory.md):

    l     = -n . c                      string length; axial force N(l), never below zero   (1.1)
    s_a   = t_a . c                     slip of the interface                               (1.4)
    dw_k  = -R_k (turn of n against plate k)          sliding on the surfaces
    r_k   = R_k |horizontal part of n, axes of plate k|      radial sliding, rim at d_max

The axis rotates until virtual work vanishes for every rotation ``eta`` of it:

    -N s + (ds/d eta)' F_h - R_1 F_1 - R_2 F_2 + (rims) = 0.                             (2.1)

Numbers of equations, here and in all kernels, are those of docs/theory.md.

All vectors here are in axes that turn with the bottom plate.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.friction_law import lowered_near
from lir_element.kernels.pendulum.axial import axial, fix_length, hold_load, rubs_by
from lir_element.kernels.pendulum.spin import turn_with_sliders
from lir_element.kernels.rim import meet_rim
from lir_element.kernels.rotation import turn_matrix
from lir_element.kernels.slip import (
    friction_step,
    kept_share,
    speed_at_end,
)

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, State, Work

_FAR = 0.99  # of the square of the rim displacement: below it no contact, round-off or not
_UPRIGHT = 1e-40  # m2: an axis whose horizontal part over the string's length is round-off


@kernel
def place_plates(p: Props, w: Work, u: Floats) -> None:
    """Set rotations and the line of centres from the nodes' displacements `u` (12,)."""
    turn_matrix(u[3], u[4], u[5], w.q_i)
    turn_matrix(u[9], u[10], u[11], w.q_j)
    for k in range(3):
        w.turned[0, k], w.turned[1, k] = u[3 + k], u[9 + k]
    w.c_global[0] = u[6] - u[0] - p.lever[1] * w.q_j[0, 2] - p.lever[0] * w.q_i[0, 2]
    w.c_global[1] = u[7] - u[1] - p.lever[1] * w.q_j[1, 2] - p.lever[0] * w.q_i[1, 2]
    w.c_global[2] = (u[8] - u[2] - p.length) + (
        p.lever[1] * (1.0 - w.q_j[2, 2]) + p.lever[0] * (1.0 - w.q_i[2, 2])
    )
    for a in range(3):
        x, y, z = w.q_i[0, a], w.q_i[1, a], w.q_i[2, a]
        w.c[a] = x * w.c_global[0] + y * w.c_global[1] + z * w.c_global[2]
        for b in range(3):
            w.a[a, b] = x * w.q_j[0, b] + y * w.q_j[1, b] + z * w.q_j[2, b]
    fix_length(p, w)


@kernel
def set_axis(w: Work, x: float, y: float, z: float) -> None:
    """Set the axis n (normalised), the basis t, the string length and the slip."""
    size = math.sqrt(x * x + y * y + z * z)
    inv, k = 1.0 / size, size / (size + z)
    x, y, z = x * inv, y * inv, z * inv
    w.lean = k
    w.n[0], w.n[1], w.n[2] = x, y, z
    w.t[0, 0], w.t[0, 1], w.t[0, 2] = 1.0 - k * x * x, -k * x * y, -x  # (1.2)
    w.t[1, 0], w.t[1, 1], w.t[1, 2] = -k * x * y, 1.0 - k * y * y, -y
    if w.fixed_length > 0.0:
        w.c[2] = -(w.fixed_length + x * w.c[0] + y * w.c[1]) / z  # (9.2)
    w.l = -(x * w.c[0] + y * w.c[1] + z * w.c[2])  # (1.1)
    for a in range(2):
        w.sigma[a] = w.t[a, 0] * w.c[0] + w.t[a, 1] * w.c[1] + w.t[a, 2] * w.c[2]


@kernel
def turn_axis(w: Work, x: float, y: float, z: float, eta_1: float, eta_2: float) -> None:
    """Set the axis to (x, y, z), whose basis is current, turned by eta."""
    set_axis(
        w,
        x + w.t[0, 0] * eta_1 + w.t[1, 0] * eta_2,
        y + w.t[0, 1] * eta_1 + w.t[1, 1] * eta_2,
        z + w.t[0, 2] * eta_1 + w.t[1, 2] * eta_2,
    )


@kernel
def aim_axis(p: Props, old: State, w: Work, kept: float) -> None:
    """Set the axis that keeps the old slip: the exact axis if the interface is fused.

    With a share `kept` of its hysteretic variable other than one, the axis that keeps its z.
    """
    c = w.c
    if p.fused:
        set_axis(w, -c[0], -c[1], -c[2])
        w.sigma[0], w.sigma[1] = 0.0, 0.0
        return
    s_1, s_2 = old.slip[0], old.slip[1]
    if kept != 1.0:
        back = 2.0 * p.interface_yield * (1.0 - kept) / (1.0 + kept)
        s_1 += back * old.interface_hysteresis[0]
        s_2 += back * old.interface_hysteresis[1]
    aim_slip(w, s_1, s_2)


@kernel
def aim_slip(w: Work, s_1: float, s_2: float) -> None:
    """Set the axis at which the slip is (s_1, s_2)."""
    c = w.c
    d_1, d_2 = s_1 - c[0], s_2 - c[1]  # the axis leans this way
    square = d_1 * d_1 + d_2 * d_2
    if square < _UPRIGHT:
        set_axis(w, 0.0, 0.0, 1.0)
        return
    on_slip, on_centre = s_1 * d_1 + s_2 * d_2, c[0] * d_1 + c[1] * d_2
    slip = s_1 * s_1 + s_2 * s_2
    if w.fixed_length > 0.0:
        length = w.fixed_length
        rest = length * length + (on_slip * on_slip - on_centre * on_centre) / square
        height = math.sqrt(max(rest, 0.0))
    else:
        height = -c[2]
        rest = c[0] * c[0] + c[1] * c[1] + height * height - slip
        length = math.sqrt(max(rest, 0.0))
    lean = on_slip * height - on_centre * length
    set_axis(w, d_1 * lean, d_2 * lean, on_slip * on_centre + square * length * height)  # (4.2)


@kernel
def aim_on(p: Props, old: State, w: Work) -> None:
    """Set the axis that continues the slip of the last step, elastic or not.

    The exact axis if the interface is fused; the old slip if there is no last step.
    """
    if p.fused or w.dt == 0.0 or old.step == 0.0:
        aim_axis(p, old, w, 1.0)
        return
    ahead = w.dt / old.step
    aim_slip(
        w,
        old.slip[0] + ahead * old.slip_increment[0],
        old.slip[1] + ahead * old.slip_increment[1],
    )


@kernel
def static_speeds(p: Props, w: Work, v: Floats) -> None:
    """Set the sliding speeds of a trial at the committed time from the nodes' velocities."""
    rate = w.centre_speed
    for k in range(3):
        rate[k] = v[6 + k] - v[k]
    # levers: + a_i e_i x omega_i + a_j e_j x omega_j, then the turn of the bottom plate
    for q, first, lever in ((w.q_i, 3, p.lever[0]), (w.q_j, 9, p.lever[1])):
        rate[0] += lever * (q[1, 2] * v[first + 2] - q[2, 2] * v[first + 1])
        rate[1] += lever * (q[2, 2] * v[first] - q[0, 2] * v[first + 2])
        rate[2] += lever * (q[0, 2] * v[first + 1] - q[1, 2] * v[first])
    cg = w.c_global
    rate[0] += cg[1] * v[5] - cg[2] * v[4]
    rate[1] += cg[2] * v[3] - cg[0] * v[5]
    rate[2] += cg[0] * v[4] - cg[1] * v[3]
    if p.fixed_load > 0.0:  # the string's own height: its length does not change
        along = 0.0
        for k in range(3):
            along += rate[k] * (w.q_i[k, 0] * w.n[0] + w.q_i[k, 1] * w.n[1] + w.q_i[k, 2] * w.n[2])
        for k in range(3):
            rate[k] -= w.q_i[k, 2] * along / w.n[2]
    square_bottom, square_top = 0.0, 0.0
    for a in range(2):
        bottom, top = 0.0, 0.0
        for k in range(3):
            axis = w.q_i[k, 0] * w.t[a, 0] + w.q_i[k, 1] * w.t[a, 1] + w.q_i[k, 2] * w.t[a, 2]
            bottom -= axis * rate[k] / w.l
            m, o = (k + 1) % 3, (k + 2) % 3
            n_m = w.q_i[m, 0] * w.n[0] + w.q_i[m, 1] * w.n[1] + w.q_i[m, 2] * w.n[2]
            n_o = w.q_i[o, 0] * w.n[0] + w.q_i[o, 1] * w.n[1] + w.q_i[o, 2] * w.n[2]
            top -= axis * ((v[9 + m] - v[3 + m]) * n_o - (v[9 + o] - v[3 + o]) * n_m)
        square_bottom += bottom**2
        square_top += (bottom + top) ** 2
    w.static_speed[0] = p.radius[0] * math.sqrt(square_bottom)
    w.static_speed[1] = p.radius[1] * math.sqrt(square_top)


@inlined_by_llvm
def surface(p: Props, old: State, w: Work, k: int) -> None:
    """Set the friction of surface `k` (0 bottom, 1 top): force and derivative over N."""
    m = w.old_top if k == 1 else old.axis
    for a in range(2):
        w.old[k, a] = w.t[a, 0] * m[0] + w.t[a, 1] * m[1] + w.t[a, 2] * m[2]
        w.dw[k, a] = p.radius[k] * w.old[k, a]  # (1.6), (1.7)
    w.old[k, 2] = w.n[0] * m[0] + w.n[1] * m[1] + w.n[2] * m[2]
    d_1 = w.dw[k, 0] - w.spin * w.shift[k, 1]  # at the centre of pressure
    d_2 = w.dw[k, 1] + w.spin * w.shift[k, 0]
    w.rubbed[k, 0], w.rubbed[k, 1] = d_1, d_2
    before = old.sliding_increment[k]
    z_1, z_2, h_11, h_12, h_21, h_22, slid, s_1, s_2, n_1, n_2 = friction_step(
        p.bouc_wen,
        p.exponent,
        old.hysteresis[k, 0],
        old.hysteresis[k, 1],
        w.z_size[k],
        d_1,
        d_2,
        p.yield_displacement[k],
        w.per_yield[k],
        w.kept_low,
        w.kept_low_n,
        w.softer_low,
        before[0],
        before[1],
        w.share,
    )
    w.slid[k] = slid
    # sliding that unloads has no speed: friction must not grow meanwhile
    w.speed[k], by_slip = w.static_speed[k], 0.0
    if w.dt > 0.0:
        w.speed[k], by_slip = speed_at_end(slid, w.dt, old.slid[k], old.step, w.share)
    mu, slope = p.friction_max[k], 0.0
    if p.friction_drop[k] != 0.0:
        lower, slope = lowered_near(p, w, k)
        mu -= lower
    if w.varies != 0.0:
        share = w.warm[k] * w.pressed
        mu, slope = share * mu, share * slope
        n_1, n_2 = n_1 - w.pressed_n * z_1, n_2 - w.pressed_n * z_2
    w.mu[k] = mu
    mu, slope = w.left[k] * mu, w.left[k] * slope
    by_1, by_2 = slope * by_slip * s_1, slope * by_slip * s_2
    w.phi_n[k, 0], w.phi_n[k, 1] = mu * n_1, mu * n_2
    w.z[k, 0], w.z[k, 1] = z_1, z_2
    w.phi[k, 0], w.phi[k, 1] = mu * z_1, mu * z_2
    w.h[k, 0, 0], w.h[k, 0, 1] = mu * h_11 + z_1 * by_1, mu * h_12 + z_1 * by_2
    w.h[k, 1, 0], w.h[k, 1, 1] = mu * h_21 + z_2 * by_1, mu * h_22 + z_2 * by_2


@kernel
def preloaded(p: Props, old: State, w: Work) -> tuple[float, float, float, float, float]:
    """Return the effect of a preload of the interface on its friction.

    The share of z that the axial force leaves, its derivative, 2 over one more than it; the
    interface's friction load over the axial force, and the fall of friction over N by that.
    """
    more, load = rubs_by(p, w.n_pos)
    if p.fixed_load > 0.0:
        return 1.0, 0.0, 1.0, more, 0.0
    less = p.interface_friction * (more - 1.0) / w.n_hat if w.scale == 1.0 else 0.0
    if w.dt == 0.0:
        return 1.0, 0.0, 1.0, more, less
    _, before = rubs_by(p, old.axial_force)
    kept, by_load = kept_share(before, load, 0.0)
    return kept, by_load if w.scale == 1.0 else 0.0, 2.0 / (1.0 + kept), more, less


@inlined_by_llvm
def interface(p: Props, old: State, w: Work) -> None:
    """Set the friction of the plane interface: force and derivative over N.

    It slides as the sliders see it, whose spin in the step turns the slip and z with them.
    """
    before = old.slip_increment
    spins = w.spin != 0.0
    cos, sin = 1.0, 0.0
    x, y = w.sigma[0], w.sigma[1]
    if spins:
        cos, sin = math.cos(w.spin), math.sin(w.spin)
        x, y = turn_with_sliders(cos, -sin, x, y)
    d_1, d_2 = x - old.slip[0], y - old.slip[1]
    kept, kept_n, softer, more, less = w.kept, w.kept_n, w.softer, 1.0, 0.0
    if p.interface_preload > 0.0:
        kept, kept_n, softer, more, less = preloaded(p, old, w)
    z_1, z_2, h_11, h_12, h_21, h_22, _, _, _, n_1, n_2 = friction_step(
        p.bouc_wen,
        p.exponent,
        old.interface_hysteresis[0],
        old.interface_hysteresis[1],
        w.z_size[2],
        d_1,
        d_2,
        p.interface_yield,
        w.per_yield[2],
        kept,
        kept_n,
        softer,
        before[0],
        before[1],
        w.share,
    )
    if spins:
        d_1, d_2 = turn_with_sliders(cos, sin, d_1, d_2)
        z_1, z_2 = turn_with_sliders(cos, sin, z_1, z_2)
        n_1, n_2 = turn_with_sliders(cos, sin, n_1, n_2)
        h_11, h_21 = turn_with_sliders(cos, sin, h_11, h_21)
        h_12, h_22 = turn_with_sliders(cos, sin, h_12, h_22)
        h_11, h_12 = turn_with_sliders(cos, sin, h_11, h_12)
        h_21, h_22 = turn_with_sliders(cos, sin, h_21, h_22)
    mu = more * p.interface_friction
    w.slip_step[0], w.slip_step[1] = d_1, d_2
    w.z_s[0], w.z_s[1] = z_1, z_2
    w.phi_sn[0], w.phi_sn[1] = mu * n_1 - less * z_1, mu * n_2 - less * z_2
    w.phi_s[0], w.phi_s[1] = mu * z_1, mu * z_2
    w.h_s[0, 0], w.h_s[0, 1], w.h_s[1, 0], w.h_s[1, 1] = mu * h_11, mu * h_12, mu * h_21, mu * h_22


@inlined_by_llvm
def rims(p: Props, old: State, w: Work) -> None:
    """Set the rim forces of both plates; their directions if there is rim contact.

    A rigid slider that is lifted by more than its height is no longer between the rims.
    """
    height = p.radius[0] + p.radius[1] - p.length
    away = p.fused and p.length - w.l > height
    y_1 = w.a[0, 0] * w.n[0] + w.a[1, 0] * w.n[1] + w.a[2, 0] * w.n[2]
    y_2 = w.a[0, 1] * w.n[0] + w.a[1, 1] * w.n[1] + w.a[2, 1] * w.n[2]
    bottom, top = w.n[0] * w.n[0] + w.n[1] * w.n[1], y_1 * y_1 + y_2 * y_2
    w.push[0], w.push[1] = 0.0, 0.0
    if (
        p.radius[0] * p.radius[0] * bottom < _FAR * p.rim_displacement[0] * p.rim_displacement[0]
        and p.radius[1] * p.radius[1] * top < _FAR * p.rim_displacement[1] * p.rim_displacement[1]
    ):
        for k in range(2):
            w.rim[k], w.stiff_rim[k], w.rim_closure[k] = 0.0, 0.0, 0.0
            w.rim_bent[k], w.rim_slant[k], w.rim_flow[k] = 0.0, 0.0, 0.0
        return
    w.n_hor[0], w.n_hor[1] = math.sqrt(bottom), math.sqrt(top)  # (1.8)
    for k in range(2):
        gap = -math.inf if away else p.radius[k] * w.n_hor[k] - p.rim_displacement[k]
        x, y = (-w.n[0], -w.n[1]) if k == 0 else (y_1, y_2)  # position of the slider
        (
            w.rim[k],
            w.stiff_rim[k],
            w.rim_closure[k],
            w.rim_flow[k],
            w.rim_bent[k],
            w.rim_slant[k],
        ) = meet_rim(p, old.rim_dent[k], gap, x, y, old.rim_closure[k], w.dt)
    if not (w.rim_closure[0] > 0.0 or w.rim_closure[1] > 0.0):
        return
    for k in range(2):
        x, y, size = (w.n[0], w.n[1], w.n_hor[0]) if k == 0 else (y_1, y_2, w.n_hor[1])
        w.unit[k, 0], w.unit[k, 1] = (x / size, y / size) if size > 0.0 else (1.0, 0.0)
    e_1, e_2 = w.unit[1, 0], w.unit[1, 1]
    for a in range(3):
        w.r_top[a] = w.a[a, 0] * e_1 + w.a[a, 1] * e_2
        w.b_top[a] = w.a[a, 1] * e_1 - w.a[a, 0] * e_2
    for a in range(2):
        top = w.t[a, 0] * w.r_top[0] + w.t[a, 1] * w.r_top[1] + w.t[a, 2] * w.r_top[2]
        w.push[a] = p.radius[0] * w.rim[0] * w.n[2] * w.unit[0, a] + p.radius[1] * w.rim[1] * top


@kernel
def evaluate(p: Props, old: State, w: Work) -> None:
    """Set all forces at the current axis and the residual of the slider's equilibrium.

    Two pieces separate without axial force, and have no forces; a rigid slider between its rims
    still transfers the rims' force.
    """
    axial(p, old, w)
    surface(p, old, w, 0)
    surface(p, old, w, 1)
    rims(p, old, w)
    for a in range(2):
        w.drag[a] = p.radius[0] * w.phi[0, a] + p.radius[1] * w.phi[1, a]
    if not p.fused:
        interface(p, old, w)
    if p.fixed_load > 0.0:
        hold_load(p, w)
    n = w.n_pos if p.fused else w.n_hat
    for a in range(2):
        w.residual[a] = -n * w.drag[a] + w.push[a]  # (2.1)
    if p.fused:  # the interface has the force of equilibrium
        w.rim_scale = 1.0
        for a in range(2):
            w.f_s[a] = -w.residual[a] / w.l
            w.residual[a] = 0.0
        return
    w.rim_scale = w.scale
    chi = w.lean * (w.sigma[1] * w.phi_s[0] - w.sigma[0] * w.phi_s[1])
    w.residual[0] += w.n_hat * (w.l * w.phi_s[0] + chi * w.n[1] - w.sigma[0])
    w.residual[1] += w.n_hat * (w.l * w.phi_s[1] - chi * w.n[0] - w.sigma[1])
    w.f_s[0], w.f_s[1] = w.n_pos * w.phi_s[0], w.n_pos * w.phi_s[1]
    if w.n_true < 0.0:  # pulled along the line of centres: the interface holds
        w.f_s[0] += w.n_true * w.sigma[0] / w.l
        w.f_s[1] += w.n_true * w.sigma[1] / w.l


@kernel
def elastic_jacobian(p: Props, w: Work) -> None:
    """Set the slider's jacobian as if nothing slipped: a safe direction when Newton's is not."""
    friction = w.n_hat * (
        w.l * w.l * p.interface_friction / p.interface_yield
        + p.radius[0] ** 2 * w.mu[0] / p.yield_displacement[0]
        + p.radius[1] ** 2 * w.mu[1] / p.yield_displacement[1]
    )
    friction += w.l * w.l * p.interface_friction * p.interface_preload / p.interface_yield
    for a in range(2):
        for b in range(2):
            w.jacobian[a, b] = 0.0
            for k in range(2):
                if w.stiff_rim[k] > 0.0:
                    stiff = p.radius[k] ** 2 * w.stiff_rim[k]
                    w.jacobian[a, b] += stiff * w.unit[k, a] * w.unit[k, b]
        w.jacobian[a, a] += friction
