"""Kernels of one pair of a disc: resultant, its place, friction and spin.

A pair is the face of one body on the surface of another, its carrier; all is in axes of the
carrier. The load acts at the centre of pressure, and through the centre of the carrier's sphere.
Friction belongs to the material there. Derivatives: `disc_slope`. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.contact.disc import disc_load, rub
from lir_element.kernels.contact.disc_slope import (
    scale_slope,
    slope_of_bond,
    slope_of_cap,
    slope_of_push,
    slope_of_tilt,
    slope_on_plane,
    turned,
)
from lir_element.kernels.contact.pair import set_tangents
from lir_element.kernels.friction_law import coefficient, least
from lir_element.kernels.slip import kept_share, speed_at_end

if TYPE_CHECKING:
    from lir_element.layout import Props, Scratch, Sliders, Touch

_LEAST_RADIUS = 0.05  # of the slider's, in which an edge still resists spin (a choice)


@inlined_by_llvm
def damped_centre(
    e_1: float, e_2: float, old: Touch, share: float, a: float
) -> tuple[float, float]:
    """Return the centre of pressure moved by the bed's damping.

    The pressed part is damped: the centre is ahead of its elastic place by ``c V_old / (N dt)``
    times its motion in the step (7.14), no farther than the edge.
    """
    e_1 += share * (e_1 - old.core[0])
    e_2 += share * (e_2 - old.core[1])
    size = math.sqrt(e_1 * e_1 + e_2 * e_2)
    if size <= a:
        return e_1, e_2
    return a / size * e_1, a / size * e_2


@inlined_by_llvm
def press_bed(
    w: Scratch,
    c: Sliders,
    body: int,
    old: Touch,
    new: Touch,
    p: float,
    a: float,
    dt: float,
    derive: bool,
) -> float:
    """Set load and centre of pressure of a disc that penetrates by `p`; return the load.

    ``w.d`` moves on to the centre of pressure. With `derive` also ``w.push_by`` (3, 6): derivative
    of load and centre (2) by the shift of the body's material there and by its turn.
    """
    g_1, g_2 = w.tilt[0], w.tilt[1]
    mean, e_1, e_2 = disc_load(p, g_1, g_2, a)
    new.closure = mean
    new.gap = mean
    new.push = 0.0
    for k in range(2):
        new.centre[k], new.core[k] = 0.0, 0.0
    if mean <= 0.0:
        new.gap = p + a * math.sqrt(g_1 * g_1 + g_2 * g_2)
        return 0.0
    stiff = c.stiffness
    push = stiff * mean
    if dt > 0.0:
        push += c.damping * (mean - old.closure) / dt
        stiff += c.damping / dt
    if push <= 0.0:
        return 0.0
    new.push = push
    new.core[0], new.core[1] = e_1, e_2
    damped = 0.0
    if dt > 0.0 and old.closure > 0.0:
        damped = c.damping * old.closure / (dt * push)
        e_1, e_2 = damped_centre(e_1, e_2, old, damped, a)
    new.centre[0], new.centre[1] = e_1, e_2
    for b in range(3):
        w.d[b] += e_1 * w.face[0, b] + e_2 * w.face[1, b]
    if derive:
        slope_of_push(w, w.q[body], old, new, p, a, stiff, damped)
    return push


@inlined_by_llvm
def spun(w: Scratch, old: Touch, n_0: float, n_1: float, n_2: float) -> float:
    """Return the body's spin about `n` against its carrier since the committed state."""
    x_0, x_1, x_2 = 0.0, 0.0, 0.0
    for k in range(2):
        o, c = old.axes[k], w.face[k]
        x_0 += o[1] * c[2] - o[2] * c[1]
        x_1 += o[2] * c[0] - o[0] * c[2]
        x_2 += o[0] * c[1] - o[1] * c[0]
    return 0.5 * (n_0 * x_0 + n_1 * x_1 + n_2 * x_2)


@kernel
def rest_disc(w: Scratch, old: Touch, new: Touch, friction: float) -> None:
    """Set the state of a disc that carries nothing."""
    for a in range(3):
        new.memory[a] = old.memory[a]
    new.norm = old.norm
    for a in range(2):
        new.hysteresis[a], new.increment[a] = 0.0, 0.0
    new.friction, new.slid, new.speed = friction, 0.0, 0.0


@inlined_by_llvm
def keep_place(w: Scratch, new: Touch) -> None:
    """Keep the place of the face, for the next step."""
    for a in range(3):
        new.spot[a] = w.d[a]
        new.axes[0, a], new.axes[1, a] = w.face[0, a], w.face[1, a]


@inlined_by_llvm
def torsion_radius(old: Touch, a: float) -> float:
    """Return the radius of the even disc about the centre of pressure of equal spin torque.

    An eccentric pressure reduces it to ``a sqrt((a^2 - e^2) / (a^2 + e^2))``.
    """
    square = (old.centre[0] ** 2 + old.centre[1] ** 2) / (a * a)
    share = math.sqrt(max(1.0 - square, 0.0) / (1.0 + square))
    return a * max(share, _LEAST_RADIUS)  # (7.13)


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
    derive: bool,
) -> float:
    """Set force and couple of a cap on the concave sphere `side`, with `derive` their derivative.

    Returns the axial force; ``w.normal``, ``w.tangential`` act at ``w.d``, ``w.couple`` about it.
    """
    radius, d, face, o = p.radius[side], w.d, w.face, w.old_place
    keep_place(w, new)
    size = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    for k in range(2):
        w.tilt[k] = (d[0] * face[k, 0] + d[1] * face[k, 1] + d[2] * face[k, 2]) / size
    body, carrier = (1, 0) if side == 0 else (2, 3)
    if derive:
        m_0, m_1, m_2 = turned(w.q[carrier], d)
        inv = 1.0 / size
        slope_of_tilt(w, w.q[body], inv * m_0, inv * m_1, inv * m_2, inv)
    push = press_bed(w, c, body, old, new, size - radius, a, dt, derive)
    if push <= 0.0:
        rest_disc(w, old, new, least(p, side))
        return 0.0
    size = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    sign = -1.0 if side == 0 else 1.0
    inv = sign / size
    n_0, n_1, n_2 = d[0] * inv, d[1] * inv, d[2] * inv
    set_tangents(w, n_0, n_1, n_2)
    e_1, e_2 = new.centre[0], new.centre[1]
    square = 0.0
    for b in range(3):  # the same material at the committed state
        o[b] = old.spot[b] + e_1 * old.axes[0, b] + e_2 * old.axes[1, b]
        square += o[b] * o[b]
    old_size = math.sqrt(square)
    over = 1.0 / old_size
    for b in range(3):
        o[b] *= over
    t, s = w.tangent_1, w.tangent_2
    spread = torsion_radius(old, a)
    way_1 = -radius * (t[0] * o[0] + t[1] * o[1] + t[2] * o[2])
    way_2 = -radius * (s[0] * o[0] + s[1] * o[1] + s[2] * o[2])
    way_3 = spread * spun(w, old, n_0, n_1, n_2)
    kept, by_push = kept_share(old.push, push, 0.0) if dt > 0.0 else (1.0, 0.0)
    f_1, f_2, f_3, slid, new.norm = rub(
        w,
        p.bouc_wen,
        p.exponent,
        old.memory,
        old.norm,
        way_1,
        way_2,
        way_3,
        max(p.yield_displacement[side], w.soft_low[side]),
        kept,
        by_push,
        old.increment,
        w.share,
        new.memory,
        derive,
    )
    speed, by_slip = static_speed, 0.0
    if dt > 0.0:
        speed, by_slip = speed_at_end(slid, dt, old.slid, w.step_before, w.share)
    mu, slope = coefficient(p, side, speed)
    grip = 1.0 - w.lost[side]
    mu, slope = grip * mu, grip * slope
    new.increment[0], new.increment[1] = way_1, way_2
    new.friction, new.slid, new.speed = mu, slid, speed
    new.hysteresis[0], new.hysteresis[1] = f_1, f_2
    if derive:
        w.way[0], w.way[1] = way_1, way_2
        scale_slope(w, push, mu, slope * by_slip, f_1, f_2, f_3)
    f_1, f_2, f_3 = push * mu * f_1, push * mu * f_2, push * spread * mu * f_3
    n = w.axis
    n[0], n[1], n[2] = n_0, n_1, n_2
    for b in range(3):
        w.normal[b] = -push * sign * n[b]
        w.tangential[b] = -(f_1 * t[b] + f_2 * s[b])
        w.couple[b] = -f_3 * n[b]
    if derive:
        q, r = w.q[carrier], w.q[body]
        slope_of_cap(w, q, r, old, radius, sign, size, old_size, push, spread, f_1, f_2, f_3)
    return push


@kernel
def plane_disc(
    p: Props, c: Sliders, w: Scratch, old: Touch, new: Touch, a: float, dt: float, derive: bool
) -> float:
    """Set force and couple of the top slider's face on the bottom slider's plane; see above.

    The preload of the halves rubs at the centre of pressure, or in the middle if there is none.
    """
    keep_place(w, new)
    w.tilt[0], w.tilt[1] = -w.face[0, 2], -w.face[1, 2]
    q, face = w.q[1], w.q[2]
    if derive:
        slope_of_tilt(w, face, -q[0, 2], -q[1, 2], -q[2, 2], 0.0)
    push = press_bed(w, c, 2, old, new, -w.d[2], a, dt, derive)
    load = push + p.interface_preload  # load of its friction (3.14)
    if load <= 0.0:
        rest_disc(w, old, new, p.interface_friction)
        return 0.0
    if derive and push <= 0.0:
        w.push_by[:] = 0.0
    e_1, e_2 = new.centre[0], new.centre[1]
    spread = torsion_radius(old, a)
    way_1 = w.d[0] - old.spot[0] - e_1 * old.axes[0, 0] - e_2 * old.axes[1, 0]
    way_2 = w.d[1] - old.spot[1] - e_1 * old.axes[0, 1] - e_2 * old.axes[1, 1]
    way_3 = spread * spun(w, old, 0.0, 0.0, 1.0)
    kept, by_push = 1.0, 0.0
    if dt > 0.0:
        kept, by_push = kept_share(old.push + p.interface_preload, load, 0.0)
    f_1, f_2, f_3, slid, new.norm = rub(
        w,
        p.bouc_wen,
        p.exponent,
        old.memory,
        old.norm,
        way_1,
        way_2,
        way_3,
        max(p.interface_yield, w.soft_high),
        kept,
        by_push,
        old.increment,
        w.share,
        new.memory,
        derive,
    )
    mu = p.interface_friction
    new.increment[0], new.increment[1] = way_1, way_2
    new.friction, new.slid = mu, slid
    new.speed = slid / dt if dt > 0.0 else 0.0
    new.hysteresis[0], new.hysteresis[1] = f_1, f_2
    if derive:
        scale_slope(w, load, mu, 0.0, f_1, f_2, f_3)
    w.normal[0], w.normal[1], w.normal[2] = 0.0, 0.0, push
    w.tangential[0], w.tangential[1] = -load * mu * f_1, -load * mu * f_2
    w.tangential[2] = 0.0
    w.couple[0], w.couple[1], w.couple[2] = 0.0, 0.0, -spread * load * mu * f_3
    if derive:
        slope_on_plane(w, q, face, old, push, load, spread)
    return load


@kernel
def bond_disc(
    w: Scratch, c: Sliders, old: Touch, new: Touch, a: float, dt: float, derive: bool
) -> None:
    """Set the elastic bond of two sliders that are one piece: that of a disc all over its face."""
    rate = c.damping / dt if dt > 0.0 else 0.0
    square, face = 0.25 * a * a, w.face
    for b in range(3):
        w.normal[b] = -c.stiffness * w.d[b] - rate * (w.d[b] - old.spot[b])
        w.tangential[b], w.couple[b] = 0.0, 0.0
    for k in range(2):  # the sum of (B r) x (- k (B - 1) r - c (B - B_old) r / dt) over the face
        f, h = face[k], w.home[k]
        for b in range(3):
            h[b] = rate * old.axes[k, b]
        h[k] += c.stiffness
        w.couple[0] += square * (f[1] * h[2] - f[2] * h[1])
        w.couple[1] += square * (f[2] * h[0] - f[0] * h[2])
        w.couple[2] += square * (f[0] * h[1] - f[1] * h[0])
    if derive:
        slope_of_bond(w, w.q[1], w.q[2], -c.stiffness - rate, square)
    keep_place(w, new)
    rest_disc(w, old, new, 0.0)
    new.gap = -w.d[2]
    new.closure = new.gap
    new.push = max(w.normal[2], 0.0)
