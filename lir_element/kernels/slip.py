"""Kernels of friction and contact laws: one return map, one contact law.

Friction is ``F = mu N z``. Both regularisations share one form. With the trial value
``b = z_old + dw / u`` the new hysteretic variable is ``z = rho(|b|, kappa) b / |b|``,
``kappa = (b / |b|) . dw / u``:

- elastic-plastic: ``rho = min(|b|, 1)``;
- biaxial Bouc-Wen (isotropic, A = 1, beta = gamma = 1/2; Park, Wen and Ang 1986), implicit:
  ``rho + kappa rho^eta = |b|`` while loading (kappa > 0), ``rho = |b|`` while unloading.

The second becomes the first as eta grows without bound. ``|z| <= 1`` holds for both.

The elastic sliding before slip stores ``mu N u_y |z|^2 / 2``. A change of the axial force N does no
work on it: at rest z goes with ``N^(-1/2)``, and the friction force with ``N^(1/2)``. No cycle of
the axial force then makes energy. docs/theory.md, section 3.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel

if TYPE_CHECKING:
    from lir_element.layout import Mapped

_BEND = 0.9  # rad a step, above which a path is too coarse to extrapolate
_STEEPEST = math.tan(_BEND)
_SMALL = 0.02  # rad, below which a few terms of a series are exact to round-off
_FALL = 1e12  # of the axial force in a step, beyond which nothing but slip can follow


@kernel
def kept_share(push_old: float, push: float, floor: float) -> tuple[float, float]:
    """Return the share of z that a changing axial force leaves, and its derivative by `push`.

    ``(N_old / N)^(1/2)``: the stored energy stays constant. Contacts that were open have none as
    they land. Below `floor` the axial force changes nothing.
    """
    before, after = max(push_old, floor), max(push, floor)
    if after <= 0.0:
        return 1.0, 0.0
    if before > _FALL * after:
        return math.sqrt(_FALL), 0.0
    kept = math.sqrt(before / after)  # (3.5)
    return kept, -0.5 * kept / after if push > floor else 0.0


@kernel
def stored(mu: float, push: float, u_y: float, z_1: float, z_2: float) -> float:
    """Return the energy [J] in the elastic sliding of a contact."""
    return 0.5 * mu * max(push, 0.0) * u_y * (z_1 * z_1 + z_2 * z_2)  # (3.4)


@kernel
def bouc_wen_radius(size: float, kappa: float, exponent: float) -> tuple[float, float, float]:
    """Return rho of ``rho + kappa rho^eta = size``, d(rho)/d(size), and rho^eta.

    In closed form for eta = 2, else by Newton's method.
    """
    if exponent == 2.0:
        rho = 2.0 * size / (1.0 + math.sqrt(1.0 + 4.0 * kappa * size))
        return rho, 1.0 / (1.0 + 2.0 * kappa * rho), rho * rho
    rho = min(size, 1.0)
    for _ in range(60):
        power = rho ** (exponent - 1.0)
        slope = 1.0 + kappa * exponent * power
        change = (rho + kappa * rho * power - size) / slope
        rho -= change
        if abs(change) < 1e-15:
            break
    power = rho ** (exponent - 1.0)
    return rho, 1.0 / (1.0 + kappa * exponent * power), rho * power


@inlined_by_llvm
def small_angle(tangent: float) -> float:
    """Return the arc tangent; for a small one by its series."""
    if abs(tangent) > _SMALL:
        return math.atan(tangent)
    x = tangent * tangent
    high = 1.0 / 5.0 - x * (1.0 / 7.0 - x * (1.0 / 9.0))
    return tangent * (1.0 - x * (1.0 / 3.0) + x * x * high)


@inlined_by_llvm
def direction_of(angle: float) -> tuple[float, float]:
    """Return cosine and sine; of a small angle by their series."""
    if abs(angle) > _SMALL:
        return math.cos(angle), math.sin(angle)
    x = angle * angle
    c = 1.0 - 0.5 * x + x * x * (1.0 / 24.0 - x * (1.0 / 720.0))
    s = 1.0 - x * (1.0 / 6.0) + x * x * (1.0 / 120.0 - x * (1.0 / 5040.0))
    return c, angle * s


@kernel
def return_map(
    bouc_wen: int, exponent: float, old_1: float, old_2: float, dw_1: float, dw_2: float, u_y: float
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Return the hysteretic variable, its derivative, the slip, and that one's derivative.

    Nine numbers: z (2), dz/d(dw) (2 x 2, by rows), the slipped part of the sliding (>= 0, along
    z) and its derivative by dw (2).
    """
    return returned(bouc_wen, exponent, old_1, old_2, dw_1 / u_y, dw_2 / u_y, u_y, 1.0 / u_y)


@inlined_by_llvm
def returned(
    bouc_wen: int,
    exponent: float,
    old_1: float,
    old_2: float,
    d_1: float,
    d_2: float,
    u_y: float,
    inv: float,
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Return the values of `return_map`; `d` is the sliding over `u_y`, `inv` is one over it."""
    b_1, b_2 = old_1 + d_1, old_2 + d_2  # (3.3)
    square = b_1 * b_1 + b_2 * b_2
    if square == 0.0 or (square <= 1.0 and not bouc_wen):
        return b_1, b_2, inv, 0.0, 0.0, inv, 0.0, 0.0, 0.0
    size = math.sqrt(square)
    hoop = 1.0 / size
    e_1, e_2 = b_1 * hoop, b_2 * hoop
    kappa = e_1 * d_1 + e_2 * d_2
    if size <= 1.0 and kappa <= 0.0:
        return b_1, b_2, inv, 0.0, 0.0, inv, 0.0, 0.0, 0.0
    if bouc_wen and size < 1.0 + kappa and kappa > 0.0:
        rho, by_size, power = bouc_wen_radius(size, kappa, exponent)
        across = (d_2 * e_1 - d_1 * e_2) / size  # turn of the direction, times dw
        grad_1 = by_size * (e_1 - power * (e_1 - e_2 * across))
        grad_2 = by_size * (e_2 - power * (e_2 + e_1 * across))
        hoop *= rho
    else:
        rho, grad_1, grad_2 = 1.0, 0.0, 0.0
    return (
        rho * e_1,
        rho * e_2,
        inv * (e_1 * grad_1 + hoop * e_2 * e_2),
        inv * (e_1 * grad_2 - hoop * e_1 * e_2),
        inv * (e_2 * grad_1 - hoop * e_1 * e_2),
        inv * (e_2 * grad_2 + hoop * e_1 * e_1),
        u_y * (size - rho),
        e_1 - grad_1,
        e_2 - grad_2,
    )


@kernel
def bouc_wen_rate(
    exponent: float,
    old_1: float,
    old_2: float,
    d_1: float,
    d_2: float,
    by_old_1: float,
    by_old_2: float,
    by_d_1: float,
    by_d_2: float,
) -> tuple[float, float, float]:
    """Return the derivative of z (2) and of ``|b| - rho`` in a direction of z_old and dw / u."""
    b_1, b_2 = old_1 + d_1, old_2 + d_2
    c_1, c_2 = by_old_1 + by_d_1, by_old_2 + by_d_2
    size = math.sqrt(b_1 * b_1 + b_2 * b_2)
    if size == 0.0:
        return c_1, c_2, 0.0
    e_1, e_2 = b_1 / size, b_2 / size
    along = e_1 * c_1 + e_2 * c_2
    w_1, w_2 = (c_1 - along * e_1) / size, (c_2 - along * e_2) / size  # derivative of e
    kappa = e_1 * d_1 + e_2 * d_2
    if size <= 1.0 and kappa <= 0.0:
        return c_1, c_2, 0.0
    rho, radial = 1.0, 0.0
    if size < 1.0 + kappa and kappa > 0.0:
        rho, by_size, power = bouc_wen_radius(size, kappa, exponent)
        by_kappa = w_1 * d_1 + w_2 * d_2 + e_1 * by_d_1 + e_2 * by_d_2
        radial = by_size * (along - power * by_kappa)
    return radial * e_1 + rho * w_1, radial * e_2 + rho * w_2, along - radial


@kernel
def friction_map(
    bouc_wen: int,
    exponent: float,
    old_1: float,
    old_2: float,
    dw_1: float,
    dw_2: float,
    u_y: float,
    kept: float,
    by_push: float,
    before_1: float,
    before_2: float,
    share: float,
) -> Mapped:
    """Return the values of `return_map` for a kept share of z, and more.

    Eleven numbers: z (2), dz/d(dw) (2 x 2, by rows), the sliding that goes on past the old z (>= 0)
    and its derivative by dw (2), and the derivative of z by the axial force (2). `kept` and
    `by_push` are those of `kept_share`; the sliding counts with the mean of the roots of both axial
    forces over the last one, ``(1 + kept) / 2``.

    The return map leaves z along the mean direction of the step: half a step late if the path
    bends. The direction of the step before, (before_1, before_2), gives the bend: z is rotated by
    the angle between both times `share`, ``dt / (dt + dt_before)``. No rotation if nothing slips,
    if the path runs straight or back, or beyond `_BEND`. docs/theory.md, section 3.
    """
    size = math.sqrt(old_1 * old_1 + old_2 * old_2)
    return friction_step(
        bouc_wen,
        exponent,
        old_1,
        old_2,
        size,
        dw_1,
        dw_2,
        u_y,
        1.0 / u_y,
        kept,
        by_push,
        2.0 / (1.0 + kept),
        before_1,
        before_2,
        share,
    )


@inlined_by_llvm
def friction_step(
    bouc_wen: int,
    exponent: float,
    old_1: float,
    old_2: float,
    size: float,
    dw_1: float,
    dw_2: float,
    u_y: float,
    per_u: float,
    kept: float,
    by_push: float,
    softer: float,
    before_1: float,
    before_2: float,
    share: float,
) -> Mapped:
    """Return the values of `friction_map` from the common data of all trials, or all contacts.

    `size` is that of the old z, `per_u` is ``1 / u_y``, `softer` is ``2 / (1 + kept)``.
    """
    k_1, k_2, u = kept * old_1, kept * old_2, softer * u_y  # (3.6)
    inv = 0.5 * (1.0 + kept) * per_u
    z_1, z_2, h_11, h_12, h_21, h_22, slip, s_1, s_2 = returned(
        bouc_wen, exponent, k_1, k_2, dw_1 * inv, dw_2 * inv, u, inv
    )
    n_1, n_2, s_n = 0.0, 0.0, 0.0
    if by_push != 0.0:
        more = 0.5 * by_push * per_u  # derivative of 1 / u
        c_1, c_2, e_1, e_2 = by_push * old_1, by_push * old_2, more * dw_1, more * dw_2
        if bouc_wen:
            n_1, n_2, s_n = bouc_wen_rate(
                exponent, k_1, k_2, dw_1 * inv, dw_2 * inv, c_1, c_2, e_1, e_2
            )
        else:  # a function of b alone
            c_1, c_2 = c_1 + e_1, c_2 + e_2
            n_1, n_2 = u * (h_11 * c_1 + h_12 * c_2), u * (h_21 * c_1 + h_22 * c_2)
            s_n = s_1 * c_1 + s_2 * c_2
        s_n = u * (s_n - more * slip)
    slid, a_1, a_2 = sliding_on(old_1, old_2, size, dw_1 * per_u, dw_2 * per_u, u_y)
    flat = (z_1, z_2, h_11, h_12, h_21, h_22, slid, a_1, a_2, n_1, n_2)
    if share == 0.0 or slip == 0.0 or slid == 0.0:
        return flat
    if slid < slip:  # the loss of z under a falling axial force is no sliding
        slip, s_1, s_2, s_n = slid, a_1, a_2, 0.0
    turns, turn, by_angle, by_slip = turn_to_end(before_1, before_2, dw_1, dw_2, share, slip, u_y)
    if not turns:
        return flat
    turn_1 = -by_angle * dw_2 + by_slip * s_1
    turn_2 = by_angle * dw_1 + by_slip * s_2
    turn_n = by_slip * s_n
    c, s = direction_of(turn)
    r_1, r_2 = c * z_1 - s * z_2, s * z_1 + c * z_2
    return (
        r_1,
        r_2,
        c * h_11 - s * h_21 - r_2 * turn_1,
        c * h_12 - s * h_22 - r_2 * turn_2,
        s * h_11 + c * h_21 + r_1 * turn_1,
        s * h_12 + c * h_22 + r_1 * turn_2,
        slid,
        a_1,
        a_2,
        c * n_1 - s * n_2 - r_2 * turn_n,
        s * n_1 + c * n_2 + r_1 * turn_n,
    )


@inlined_by_llvm
def turn_to_end(
    before_1: float,
    before_2: float,
    dw_1: float,
    dw_2: float,
    share: float,
    slip: float,
    u_y: float,
) -> tuple[bool, float, float, float]:
    """Return True if z rotates to the end of the step, its angle and the derivative (3.7).

    By the direction of the sliding over its length, and by the slip.
    """
    cross = before_1 * dw_2 - before_2 * dw_1
    dot = before_1 * dw_1 + before_2 * dw_2
    if not dot > 0.0 or not abs(cross) < _STEEPEST * dot:
        return False, 0.0, 0.0, 0.0
    angle = small_angle(cross / dot)
    q = angle * angle * (1.0 / (_BEND * _BEND))
    square = dw_1 * dw_1 + dw_2 * dw_2
    over = 1.0 / (slip + u_y)
    part = slip * over  # the sum of rotations over the steps is then half a step's
    whole = share * angle * (1.0 - q) ** 2
    by_angle = share * part * (1.0 - q) * (1.0 - 5.0 * q) / square
    return True, whole * part, by_angle, whole * u_y * over * over


@inlined_by_llvm
def sliding_on(
    old_1: float, old_2: float, before: float, d_1: float, d_2: float, u_y: float
) -> tuple[float, float, float]:
    """Return the part of the sliding that goes on past the old z, and its derivative by it (2).

    `before` is the size of the old z, `d` the sliding over `u_y`. It gives the friction its speed.
    Unloading of z has no speed; neither has its change by a changing axial force, so that this does
    not switch the friction.
    """
    b_1, b_2 = old_1 + d_1, old_2 + d_2
    size = math.sqrt(b_1 * b_1 + b_2 * b_2)
    if size <= before:
        return 0.0, 0.0, 0.0
    inv = 1.0 / size
    return u_y * (size - before), b_1 * inv, b_2 * inv  # (3.9)


@kernel
def step_share(dt: float, before: float) -> float:
    """Return ``dt / (dt + dt_before)``, zero without a step before."""
    return dt / (dt + before) if dt > 0.0 and before > 0.0 else 0.0


@inlined_by_llvm
def speed_at_end(
    slip: float, dt: float, slip_before: float, dt_before: float, share: float
) -> tuple[float, float]:
    """Return the speed of sliding at the end of the step and its derivative by the sliding.

    The mean speed of a step is that of its middle; the step before gives its change. `share` is
    ``dt / (dt + dt_before)``.
    """
    rate = 1.0 / dt
    speed = slip * rate
    if share == 0.0 or slip == 0.0 or slip_before == 0.0:
        return speed, rate
    ahead = speed + share * (speed - slip_before / dt_before)
    if ahead > 0.0:
        return ahead, (1.0 + share) * rate
    return 0.0, 0.0


@kernel
def open_work(force_old: float, force: float, approach: float, closed: float) -> float:
    """Return the work of a contact's force over the part of its approach that no closure took.

    The trapezoidal rule lets a contact's force act over the open part of the step as well.
    """
    return 0.5 * (force_old + force) * abs(approach - closed)


@kernel
def surplus(stiffness: float, closure_old: float, closure: float, work: float) -> float:
    """Return a contact's release in a step beyond its stored energy; `work` is done on it."""
    return max(0.5 * stiffness * (closure**2 - closure_old**2) - work, 0.0)


@kernel
def kelvin_voigt(
    gap: float, closure_old: float, stiffness: float, damping: float, dt: float
) -> tuple[float, float, float]:
    """Return force, its derivative and the closure of a contact that never pulls (Eq. 2).

    The damper acts on the closure, which is zero while the contact is open: the force stays
    continuous at the impact, however large the step.
    """
    if not gap >= 0.0:
        return 0.0, 0.0, 0.0
    slope = stiffness
    force = stiffness * gap
    if dt > 0.0:
        force += damping * (gap - closure_old) / dt  # (3.8)
        slope += damping / dt
    if force < 0.0:
        return 0.0, 0.0, gap
    return force, slope, gap
