"""Kernels of friction and contact laws: one return map, one friction law, one contact law.

Friction is ``F = mu q``. The vector q [N] is what an elastic sliding before slip builds up, with a
stiffness k that does not depend on the axial force N, and never exceeds N, its cap: a falling N
makes it slip, a rising one leaves it as it is. No cycle of N then makes energy (docs/theory.md,
section 3). Both regularisations share one form. With the trial value ``b = q_old + k dw`` the new
one is ``q = rho(|b|, kappa) b / |b|``, ``kappa = k (b / |b|) . dw``:

- elastic-plastic: ``rho = min(|b|, N)``;
- biaxial Bouc-Wen (isotropic, A = 1, beta = gamma = 1/2; Park, Wen and Ang 1986), implicit:
  ``rho + kappa (rho / N)^eta = |b|`` while loading (kappa > 0), ``rho = |b|`` while unloading;
  never beyond N.

The second becomes the first as eta grows without bound.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._jit import kernel

if TYPE_CHECKING:
    from lir_element.layout import Mapped

_FADE = 0.1  # of the reference: axial force below which friction's stiffness falls with it
_BEND = 0.9  # rad a step, beyond which a path is too coarse to tell where it is bound for


@kernel
def bouc_wen_radius(size: float, kappa: float, exponent: float) -> tuple[float, float]:
    """Return rho of ``rho + kappa rho^eta = size`` and d(rho)/d(size) by Newton's method."""
    rho = min(size, 1.0)
    for _ in range(60):
        power = rho ** (exponent - 1.0)
        slope = 1.0 + kappa * exponent * power
        change = (rho + kappa * rho * power - size) / slope
        rho -= change
        if abs(change) < 1e-15:
            break
    return rho, 1.0 / (1.0 + kappa * exponent * rho ** (exponent - 1.0))


@kernel
def return_map(
    bouc_wen: int, exponent: float, old_1: float, old_2: float, dw_1: float, dw_2: float,
    k: float, cap: float,
) -> Mapped:  # fmt: skip
    """Return q, its derivatives, the sliding that loads it further, and its derivatives.

    Twelve numbers: q (2), dq/d(dw) (2 x 2, by rows), the part of the sliding that goes on past the
    old q (>= 0) and its derivative by dw (2), dq/d(cap) (2), and that part's by the cap. It gives
    the friction its speed: sliding that unloads has none; neither what a falling cap gives way to,
    nor what a rising one lets build up, changes it.
    """
    d_1, d_2 = k * dw_1, k * dw_2
    b_1, b_2 = old_1 + d_1, old_2 + d_2
    size = math.sqrt(b_1 * b_1 + b_2 * b_2)
    if size == 0.0:
        return b_1, b_2, k, 0.0, 0.0, k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    e_1, e_2 = b_1 / size, b_2 / size
    rho, by_cap, grad_1, grad_2 = cap, 1.0, 0.0, 0.0
    held = size <= cap
    if bouc_wen and cap > 0.0:
        kappa = e_1 * d_1 + e_2 * d_2
        if kappa > 0.0:
            x, by_size = bouc_wen_radius(size / cap, kappa / cap, exponent)
            if x < 1.0:
                across = (d_2 * e_1 - d_1 * e_2) / size  # turn of the direction, times dw
                power = x**exponent
                rho, by_cap, held = cap * x, x * (1.0 - by_size), False
                grad_1 = by_size * (e_1 - power * (e_1 - e_2 * across))
                grad_2 = by_size * (e_2 - power * (e_2 + e_1 * across))
    slip, s_1, s_2 = 0.0, 0.0, 0.0
    before = math.sqrt(old_1 * old_1 + old_2 * old_2)
    if size > before:
        slip, s_1, s_2 = (size - before) / k, e_1, e_2
    if held:
        return b_1, b_2, k, 0.0, 0.0, k, slip, s_1, s_2, 0.0, 0.0, 0.0
    hoop = rho / size
    return (
        rho * e_1,
        rho * e_2,
        k * (e_1 * grad_1 + hoop * e_2 * e_2),
        k * (e_1 * grad_2 - hoop * e_1 * e_2),
        k * (e_2 * grad_1 - hoop * e_1 * e_2),
        k * (e_2 * grad_2 + hoop * e_1 * e_1),
        slip,
        s_1,
        s_2,
        by_cap * e_1,
        by_cap * e_2,
        0.0,
    )


@kernel
def friction_map(
    bouc_wen: int, exponent: float, old_1: float, old_2: float, dw_1: float, dw_2: float,
    k: float, cap: float, before_1: float, before_2: float, share: float,
) -> Mapped:  # fmt: skip
    """Return what `return_map` does, q turned to where the sliding is bound for at the step's end.

    The return map leaves q along the mean direction of the step: half a step late where the path
    bends. The direction of the step before, (before_1, before_2), tells how it bends: q is turned
    on by the angle between both times `share`, ``dt / (dt + dt_before)``. No turn where nothing
    slips, where the path runs straight or back, or beyond `_BEND`. docs/theory.md, section 3.
    """
    flat = return_map(bouc_wen, exponent, old_1, old_2, dw_1, dw_2, k, cap)
    q_1, q_2, h_11, h_12, h_21, h_22, slip, s_1, s_2, n_1, n_2, s_n = flat
    cross = before_1 * dw_2 - before_2 * dw_1
    dot = before_1 * dw_1 + before_2 * dw_2
    if share == 0.0 or slip == 0.0 or not dot > 0.0:
        return flat
    angle = math.atan2(cross, dot)
    q = (angle / _BEND) ** 2
    if not q < 1.0:
        return flat
    b_1, b_2 = old_1 + k * dw_1, old_2 + k * dw_2
    size = math.sqrt(b_1 * b_1 + b_2 * b_2)
    e_1, e_2 = b_1 / size, b_2 / size
    slipped = size - (e_1 * q_1 + e_2 * q_2)
    if slipped <= 1e-14 * size:  # held
        return flat
    slipped /= k
    p_1, p_2 = e_1 - (e_1 * h_11 + e_2 * h_21) / k, e_2 - (e_1 * h_12 + e_2 * h_22) / k
    p_n = -(e_1 * n_1 + e_2 * n_2) / k
    square = dw_1 * dw_1 + dw_2 * dw_2
    u_y = cap / k  # elastic sliding before slip under the present cap
    part = slipped / (slipped + u_y)  # what a turn adds up to over the steps is then half a step's
    turn = share * angle * (1.0 - q) ** 2 * part
    by_angle = share * part * (1.0 - q) * (1.0 - 5.0 * q) / square
    by_part = share * angle * (1.0 - q) ** 2 / (slipped + u_y) ** 2
    turn_1 = -by_angle * dw_2 + by_part * u_y * p_1
    turn_2 = by_angle * dw_1 + by_part * u_y * p_2
    turn_n = by_part * (u_y * p_n - slipped / k)
    c, s = math.cos(turn), math.sin(turn)
    r_1, r_2 = c * q_1 - s * q_2, s * q_1 + c * q_2
    return (
        r_1,
        r_2,
        c * h_11 - s * h_21 - r_2 * turn_1,
        c * h_12 - s * h_22 - r_2 * turn_2,
        s * h_11 + c * h_21 + r_1 * turn_1,
        s * h_12 + c * h_22 + r_1 * turn_2,
        slip,
        s_1,
        s_2,
        c * n_1 - s * n_2 - r_2 * turn_n,
        s * n_1 + c * n_2 + r_1 * turn_n,
        s_n,
    )


@kernel
def hold(cap: float, reference: float, cap_old: float, reference_old: float
         ) -> tuple[float, float, int]:  # fmt: skip
    """Return the spring (stiffness times yield displacement), what it keeps of q, and its kind.

    The spring is the reference, and fades with the cap below a tenth of it. Where it stiffens q is
    kept, where it fades the elastic sliding: both lower the energy. Kinds: 0 the spring does not
    change with the cap, 1 it does, 2 and so does what it keeps of q.
    """
    spring, old = min(reference, cap / _FADE), min(reference_old, cap_old / _FADE)
    kind = 1 if cap < _FADE * reference else 0
    if old > spring:
        return spring, spring / old, 2 * kind
    return spring, 1.0, kind


@kernel
def by_spring(
    kind: int, cap: float, n_1: float, n_2: float, s_n: float, q_1: float, q_2: float,
    h_11: float, h_12: float, h_21: float, h_22: float, dw_1: float, dw_2: float,
    slip: float, s_1: float, s_2: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return the derivatives of q (2) and of the slip by the cap where the spring follows it."""
    if kind == 0:
        return n_1, n_2, s_n
    if kind == 2:  # all that enters is in proportion to the cap
        return q_1 / cap, q_2 / cap, 0.0
    return (
        n_1 + (h_11 * dw_1 + h_12 * dw_2) / cap,
        n_2 + (h_21 * dw_1 + h_22 * dw_2) / cap,
        s_n + (s_1 * dw_1 + s_2 * dw_2 - slip) / cap,
    )


@kernel
def stored(mu: float, q_1: float, q_2: float, u_y: float, cap: float, reference: float) -> float:
    """Return the energy of the elastic sliding before slip."""
    spring = min(reference, cap / _FADE)
    return 0.5 * mu * (q_1 * q_1 + q_2 * q_2) * u_y / spring if spring > 0.0 else 0.0


@kernel
def step_share(dt: float, before: float) -> float:
    """Return ``dt / (dt + dt_before)``, zero without a step before."""
    return dt / (dt + before) if dt > 0.0 and before > 0.0 else 0.0


@kernel
def speed_at_end(
    slip: float, dt: float, slip_before: float, dt_before: float, share: float
) -> tuple[float, float]:
    """Return the speed of slip at the end of the step and its derivative by the slip.

    The mean speed of a step is that of its middle; the step before tells how it changes. `share`
    is ``dt / (dt + dt_before)``.
    """
    if share == 0.0 or slip == 0.0 or slip_before == 0.0:
        return slip / dt, 1.0 / dt
    speed = slip / dt
    ahead = speed + share * (speed - slip_before / dt_before)
    if ahead > 0.0:
        return ahead, (1.0 + share) / dt
    return 0.0, 0.0


@kernel
def friction_coefficient(
    f_max: float, drop: float, rate: float, speed: float
) -> tuple[float, float]:
    """Return mu and d(mu)/d(speed) of Eq. (1) of the paper (Mokha et al. 1990)."""
    if drop == 0.0:
        return f_max, 0.0
    decay = drop * math.exp(-rate * speed)
    return f_max - decay, rate * decay


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
        force += damping * (gap - closure_old) / dt
        slope += damping / dt
    if force < 0.0:
        return 0.0, 0.0, gap
    return force, slope, gap
