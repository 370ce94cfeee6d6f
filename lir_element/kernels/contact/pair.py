"""Kernels of one contact pair: its force and derivative in axes of the body that carries it.

A pair is a point of one body and a surface of another, its carrier: a concave sphere, the plane
of the interface, or a circular rim. Each law reads the point's place `w.d` in axes of the carrier
and sets the force on the point (`w.normal`, `w.tangential`) and its derivative `w.slope`. Sources:
Eqs (2) and (3) of the paper; docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.friction_law import coefficient
from lir_element.kernels.rim import gives_way, keep_dents, meet_rim
from lir_element.kernels.slip import (
    friction_map,
    kelvin_voigt,
    kept_share,
    speed_at_end,
)

if TYPE_CHECKING:
    from lir_element.layout import Bodies, Props, Scratch, Touch


@kernel
def clear_pair(w: Scratch) -> None:
    """Set the pair's force and derivative to zero."""
    for a in range(3):
        w.normal[a] = 0.0
        w.tangential[a] = 0.0
        for b in range(3):
            w.slope[a, b] = 0.0


@kernel
def set_tangents(w: Scratch, x: float, y: float, z: float) -> None:
    """Set the basis of the plane normal to (x, y, z): the carrier's axes turned without spin."""
    k = 1.0 / (1.0 + z)
    w.tangent_1[0], w.tangent_1[1], w.tangent_1[2] = 1.0 - k * x * x, -k * x * y, -x
    w.tangent_2[0], w.tangent_2[1], w.tangent_2[2] = -k * x * y, 1.0 - k * y * y, -y


@kernel
def sphere(
    p: Props,
    side: int,
    w: Scratch,
    old: Touch,
    new: Touch,
    stiffness: float,
    damping: float,
    dt: float,
    static_speed: float,
    grip: float,
) -> None:
    """Set force and derivative of a point on the concave sphere `side` (0 bottom, 1 top).

    `grip` is its friction coefficient over that of the surface as a whole. `w.d` runs from the
    sphere's centre. Sliding is measured along the sphere, as the slider's motion on the plate; the
    friction speed is that of sliding past the old z.
    """
    d, radius = w.d, p.radius[side]
    size = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    m_0, m_1, m_2 = d[0] / size, d[1] / size, d[2] / size
    sign = -1.0 if side == 0 else 1.0
    n_0, n_1, n_2 = sign * m_0, sign * m_1, sign * m_2
    set_tangents(w, n_0, n_1, n_2)
    t, s, o = w.tangent_1, w.tangent_2, old.spot
    o_1 = t[0] * o[0] + t[1] * o[1] + t[2] * o[2]
    o_2 = s[0] * o[0] + s[1] * o[1] + s[2] * o[2]
    o_n = n_0 * o[0] + n_1 * o[1] + n_2 * o[2]
    dw_1, dw_2 = -radius * o_1, -radius * o_2
    push, stiff, closure = kelvin_voigt(size - radius, old.closure, stiffness, damping, dt)
    before = old.increment
    kept, by_push = kept_share(old.push, push, 0.0) if dt > 0.0 else (1.0, 0.0)
    z_1, z_2, h_11, h_12, h_21, h_22, slid, s_1, s_2, z_n1, z_n2 = friction_map(
        p.bouc_wen,
        p.exponent,
        old.hysteresis[0],
        old.hysteresis[1],
        dw_1,
        dw_2,
        max(p.yield_displacement[side], w.soft_low[side]),
        kept,
        by_push,
        before[0],
        before[1],
        w.share,
    )
    speed, by_slip = static_speed, 0.0
    if dt > 0.0:
        speed, by_slip = speed_at_end(slid, dt, old.slid, w.step_before, w.share)
    mu, slope = coefficient(p, side, speed)
    grip *= 1.0 - w.lost[side]
    mu, slope = grip * mu, grip * slope
    new.spot[0], new.spot[1], new.spot[2] = m_0, m_1, m_2
    new.hysteresis[0], new.hysteresis[1] = z_1, z_2
    new.increment[0], new.increment[1] = dw_1, dw_2
    new.gap, new.closure, new.push = size - radius, closure, push
    new.friction, new.slid, new.speed = mu, slid, speed
    f_1, f_2 = mu * z_1, mu * z_2
    m = new.spot
    for a in range(3):
        w.normal[a] = -push * m[a]  # (7.1)
        w.tangential[a] = -push * (f_1 * t[a] + f_2 * s[a])
    if push == 0.0:
        return
    by_1, by_2 = slope * by_slip * s_1, slope * by_slip * s_2
    f_n1, f_n2 = f_1 + push * mu * z_n1, f_2 + push * mu * z_n2
    g_11, g_12 = mu * h_11 + z_1 * by_1, mu * h_12 + z_1 * by_2
    g_21, g_22 = mu * h_21 + z_2 * by_1, mu * h_22 + z_2 * by_2
    k, inv = 1.0 / (1.0 + n_2), 1.0 / size
    for c in range(3):  # column: the point moves along axis c of the carrier
        along = m[c]
        e_1, e_2 = sign * t[c] * inv, sign * s[c] * inv
        w_n = k * (n_1 * e_1 - n_0 * e_2)
        dw_c1 = -radius * (-e_1 * o_n + w_n * o_2)
        dw_c2 = -radius * (-e_2 * o_n - w_n * o_1)
        d_push = stiff * along
        d_1 = push * (g_11 * dw_c1 + g_12 * dw_c2) + d_push * f_n1 - push * f_2 * w_n
        d_2 = push * (g_21 * dw_c1 + g_22 * dw_c2) + d_push * f_n2 + push * f_1 * w_n
        d_n = -push * (f_1 * e_1 + f_2 * e_2) * sign + d_push  # along m = sign n
        for a in range(3):
            unit = (1.0 if a == c else 0.0) - m[a] * along
            w.slope[a, c] = -d_n * m[a] - push * inv * unit - d_1 * t[a] - d_2 * s[a]


@kernel
def plane(
    p: Props,
    w: Scratch,
    old: Touch,
    new: Touch,
    stiffness: float,
    damping: float,
    dt: float,
    preload: float,
) -> None:
    """Set force and derivative of a point of the top slider on the bottom slider's plane.

    `w.d` runs from the plane's centre, its third entry is the gap. Push and `preload` rub.
    """
    d, o = w.d, old.spot
    dw_1, dw_2 = d[0] - o[0], d[1] - o[1]
    push, stiff, closure = kelvin_voigt(-d[2], old.closure, stiffness, damping, dt)
    load = push + preload
    kept, by_push = kept_share(old.push + preload, load, 0.0) if dt > 0.0 else (1.0, 0.0)
    z_1, z_2, h_11, h_12, h_21, h_22, slid, _, _, z_n1, z_n2 = friction_map(
        p.bouc_wen,
        p.exponent,
        old.hysteresis[0],
        old.hysteresis[1],
        dw_1,
        dw_2,
        max(p.interface_yield, w.soft_high),
        kept,
        by_push,
        old.increment[0],
        old.increment[1],
        w.share,
    )
    mu = p.interface_friction
    new.spot[0], new.spot[1], new.spot[2] = d[0], d[1], d[2]
    new.hysteresis[0], new.hysteresis[1] = z_1, z_2
    new.increment[0], new.increment[1] = dw_1, dw_2
    new.gap, new.closure, new.push = -d[2], closure, push
    new.friction, new.slid = mu, slid
    new.speed = slid / dt if dt > 0.0 else 0.0
    w.normal[2] = push  # (7.2)
    w.tangential[0], w.tangential[1] = -load * mu * z_1, -load * mu * z_2
    w.slope[2, 2] = -stiff
    w.slope[0, 2] = stiff * mu * (z_1 + load * z_n1)
    w.slope[1, 2] = stiff * mu * (z_2 + load * z_n2)
    w.slope[0, 0], w.slope[0, 1] = -load * mu * h_11, -load * mu * h_12
    w.slope[1, 0], w.slope[1, 1] = -load * mu * h_21, -load * mu * h_22


@kernel
def bond(
    w: Scratch,
    old: Touch,
    new: Touch,
    home_1: float,
    home_2: float,
    stiffness: float,
    damping: float,
    dt: float,
) -> None:
    """Set force and derivative of a point if the slider is rigid: an elastic bond."""
    rate = damping / dt if dt > 0.0 else 0.0
    home = (home_1, home_2, 0.0)
    for a in range(3):
        w.normal[a] = -stiffness * (w.d[a] - home[a]) - rate * (w.d[a] - old.spot[a])
        w.slope[a, a] = -stiffness - rate
        new.spot[a] = w.d[a]
    new.gap = -w.d[2]  # bonded: it neither opens nor closes
    new.closure = new.gap
    new.push = max(w.normal[2], 0.0)
    new.hysteresis[0], new.hysteresis[1] = 0.0, 0.0
    new.increment[0], new.increment[1] = 0.0, 0.0
    new.friction, new.slid, new.speed = 0.0, 0.0, 0.0


@kernel
def rim(p: Props, side: int, w: Scratch, old: Bodies, new: Bodies, dt: float) -> None:
    """Set force and derivative of the circular rim `side` on the slider's outermost point.

    `w.d` runs from the sphere's centre to that point; its distance from the plate's axis counts, in
    any direction.
    """
    x, y = w.d[0], w.d[1]
    size = math.sqrt(x * x + y * y)
    gap = size - p.rim_displacement[side]
    push, stiff, closure, flow, bent_by, slant = meet_rim(
        p, old.rim_dent[side], gap, x, y, old.rim_closure[side], dt
    )
    if gives_way(p):
        dents, before = new.rim_dent[side], old.rim_dent[side]
        keep_dents(p, before, dents, x, y, flow, closure, bent_by + flow)
    new.rim_gap[side] = gap - bent_by - flow
    new.rim_closure[side], new.rim_force[side] = closure, push
    new.rim_flow[side], new.rim_bent[side] = flow, bent_by + flow
    if push == 0.0:
        return
    e_1, e_2 = x / size, y / size
    hoop, along = push / size, stiff * slant / size
    w.normal[0], w.normal[1] = -push * e_1, -push * e_2  # (7.3)
    w.slope[0, 0] = -stiff * e_1 * e_1 - hoop * e_2 * e_2 - along * e_1 * e_2
    w.slope[1, 1] = -stiff * e_2 * e_2 - hoop * e_1 * e_1 + along * e_1 * e_2
    w.slope[0, 1] = (hoop - stiff) * e_1 * e_2 + along * e_1 * e_1
    w.slope[1, 0] = (hoop - stiff) * e_1 * e_2 - along * e_2 * e_2
