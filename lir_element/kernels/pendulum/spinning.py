"""Kernels of the level 'pendulum': the spin of the sliders in equilibrium, with the axis.

The axis is found for a spin, then the spin is improved by Newton's method along axes in
equilibrium, between bounds. docs/theory.md, section 2.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.pendulum.axial import rubs_by
from lir_element.kernels.pendulum.solve import (
    NEARLY,
    ROUND_OFF,
    mark_start,
    move,
    residual_square,
    solve_axis,
    square_to_reach,
)
from lir_element.kernels.pendulum.spin import (
    own_time,
    rates_by_spin,
    spin_against,
    spin_balance,
    spin_by,
)
from lir_element.kernels.pendulum.string import aim_on, evaluate, set_axis, turn_axis
from lir_element.kernels.pendulum.tangent import slider_jacobian
from lir_element.layout import SPIN_BALANCE

if TYPE_CHECKING:
    from lir_element.layout import Props, State, Work

_LEAST_STEP = 1e-6  # s: a shorter one, used if no other succeeds, does not spin (a choice)
_MAX_ITERATIONS = 40
_TOLERANCE = 1e-12  # of the largest torque
_LARGEST_STEP = 0.1  # rad in one iteration (a choice)
_LARGEST_SHIFT = 20.0  # yield displacements of the interface, of the slip in one (a choice)
_LARGEST_SPIN = 1.0  # rad in one step: beyond it the couple has turned round (a choice)
_FARTHEST = 10.0  # times the slip's motion by rotation: beyond it is another equilibrium (a choice)
_MOST_JOINT = 12  # iterations for axis and spin together
_FROM_FIRST = 0.05  # rad from the spin that goes on: further, the search is bounded (a choice)
_SMALLEST_STEP = 1e-15  # rad, round-off
_TRIES = 5  # of a spin for which no axis is found, each a quarter of the last one (a choice)


@kernel
def first_spin(p: Props, old: State, dt: float) -> float:
    """Return the spin from which the search begins: that of the step before, at the same rate."""
    if max(old.rim_force[0], old.rim_force[1]) == 0.0 or dt < own_time(p) * _LEAST_STEP:
        return 0.0
    return old.spin_rate * dt


@kernel
def spin_slope(p: Props, w: Work) -> float:
    """Return the derivative of the spin's balance over N in the state that was found."""
    w.spins = 1.0
    slider_jacobian(p, w)
    rates_by_spin(p, w)
    return w.spun[SPIN_BALANCE] / w.n_hat


@kernel
def largest_step(p: Props, w: Work) -> float:
    """Return the largest change of the spin in one iteration."""
    slip = math.sqrt(w.sigma[0] ** 2 + w.sigma[1] ** 2)
    if slip * _LARGEST_STEP > _LARGEST_SHIFT * p.interface_yield:
        return _LARGEST_SHIFT * p.interface_yield / slip
    return _LARGEST_STEP


@kernel
def axis_for_spin(p: Props, old: State, w: Work, step: float) -> int:
    """Change the spin by `step`, less if no axis is found; return the iterations, or -1."""
    x, y, z, spin = w.n[0], w.n[1], w.n[2], w.spin
    s_1, s_2 = w.sigma[0], w.sigma[1]
    slip = math.sqrt(s_1 * s_1 + s_2 * s_2)
    e_1, e_2 = w.spun_turn[0], w.spun_turn[1]
    for _ in range(_TRIES):
        set_axis(w, x, y, z)
        spin_by(p, old, w, spin + step)
        turn_axis(w, x, y, z, e_1 * step, e_2 * step)
        count = solve_axis(p, old, w)
        moved = math.sqrt((w.sigma[0] - s_1) ** 2 + (w.sigma[1] - s_2) ** 2)
        if count >= 0 and moved < _FARTHEST * (abs(step) * slip + p.interface_yield):
            return count
        step *= 0.25
    spin_by(p, old, w, spin)
    set_axis(w, x, y, z)
    return min(solve_axis(p, old, w), -1)


@kernel
def lacking(p: Props, w: Work, balance: float) -> float:
    """Return the residual of the equilibrium of axis and spin, over axial force and length."""
    return max(math.sqrt(residual_square(w)) / (w.n_hat * w.l), abs(balance) / p.slider_radius)


@kernel
def round_off(p: Props, old: State, w: Work) -> float:
    """Return the round-off of the spin's balance over N: that of lengths under stiff laws.

    As in `square_to_reach` for the axis: friction over N is exact to ``l mu / u_y`` times the
    round-off of lengths, centres of pressure with it and with the forces of the rims.
    """
    more, _ = rubs_by(p, w.n_hat)
    held = ROUND_OFF * w.l * w.law_stiffness[1] * more
    total = math.sqrt(w.sigma[0] ** 2 + w.sigma[1] ** 2) * held
    rims = 0.0
    for k in range(2):
        rims += ROUND_OFF * p.radius[k] ** 2 * w.stiff_rim[k] / w.n_hat
    for k in range(2):
        mu, radius = old.friction_coefficient[k], p.radius[k]
        rubs = ROUND_OFF * w.l * mu * w.per_yield[k]
        arm = math.sqrt(w.arm[k, 0] ** 2 + w.arm[k, 1] ** 2)
        total += mu * (radius * (held + rubs) + rims) + arm * rubs
    return total


@kernel
def joint_step(p: Props, w: Work, balance: float) -> tuple[float, float, float]:
    """Return Newton's step of axis and spin together: two rotations and a spin; zeros if none."""
    w.spins = 1.0
    slider_jacobian(p, w)
    j = w.jacobian
    det = j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]
    if not (det > 0.0 and j[0, 0] + j[1, 1] > 0.0):
        return 0.0, 0.0, 0.0
    e_1 = -(j[1, 1] * w.residual[0] - j[0, 1] * w.residual[1]) / det
    e_2 = -(j[0, 0] * w.residual[1] - j[1, 0] * w.residual[0]) / det
    rates_by_spin(p, w)
    slope = w.spun[SPIN_BALANCE]
    if not slope < 0.0:
        return 0.0, 0.0, 0.0
    rest = w.n_hat * balance + w.turns[0, SPIN_BALANCE] * e_1 + w.turns[1, SPIN_BALANCE] * e_2
    most = largest_step(p, w)
    step = min(max(-rest / slope, -most), most)
    return e_1 + w.spun_turn[0] * step, e_2 + w.spun_turn[1] * step, step


@kernel
def spin_with_axis(p: Props, old: State, w: Work) -> int:
    """Find the axis and the spin of a step together; return the iterations, or -1.

    Newton's method in three unknowns, starting from slip and spin extrapolated from the last step.
    If no step gains any more, round-off is reached. It gives up if it does not converge quickly:
    then the spin is found around the axis (`spin_sliders`).
    """
    first = 0.0 if p.fused else first_spin(p, old, w.dt)
    if first == 0.0 or max(old.axis_speed[0], old.axis_speed[1]) == 0.0:
        return -1
    spin_by(p, old, w, first)
    aim_on(p, old, w)
    evaluate(p, old, w)
    mu = old.friction_coefficient
    enough = _TOLERANCE * p.slider_radius * (mu[0] + mu[1])
    balance = spin_balance(p, old, w)
    lacks = lacking(p, w, balance)
    for count in range(_MOST_JOINT):
        if not w.n_true > p.axial_floor or max(w.rim[0], w.rim[1]) == 0.0:
            return -1
        if abs(balance) <= enough and residual_square(w) < square_to_reach(p, w):
            w.spins = 1.0 if w.spin != 0.0 else 0.0
            return count
        e_1, e_2, step = joint_step(p, w, balance)
        spin = w.spin + step
        if step == 0.0 or abs(spin - first) > _FROM_FIRST:
            return -1
        mark_start(w)
        spin_by(p, old, w, spin)
        move(p, old, w, e_1, e_2)
        balance = spin_balance(p, old, w)
        before, lacks = lacks, lacking(p, w, balance)
        if not lacks < before:
            in_balance = abs(balance) <= max(enough, round_off(p, old, w))
            if in_balance and residual_square(w) < NEARLY**2 * square_to_reach(p, w):
                w.spins = 1.0 if w.spin != 0.0 else 0.0
                return count + 1
            return -1
    return -1


@kernel
def spin_sliders(p: Props, old: State, w: Work) -> None:
    """Find the spin of the sliders in the step and the axis that belongs to it.

    The axis is in equilibrium at the spin of `w`. If more spin raises the couple by more than the
    torque, the step is too long for that: the spin is the one under the couple at its start. If
    none of the neighbouring spins has an axis, the last one with an axis remains.
    """
    if p.fused or (max(w.rim[0], w.rim[1]) == 0.0 and w.spin == 0.0):
        return
    if w.dt < own_time(p) * _LEAST_STEP:
        return
    if max(old.axis_speed[0], old.axis_speed[1]) == 0.0 or not w.n_true > p.axial_floor:
        if w.spin != 0.0:  # nothing that would hold it
            w.spun_turn[0], w.spun_turn[1] = 0.0, 0.0
            axis_for_spin(p, old, w, -w.spin)
        return
    mu = old.friction_coefficient
    enough = _TOLERANCE * p.slider_radius * (mu[0] + mu[1])
    low, high = -math.inf, math.inf
    balance = spin_balance(p, old, w)
    for count in range(_MAX_ITERATIONS):
        if abs(balance) <= enough:
            w.spins = 1.0 if w.spin != 0.0 else 0.0
            return
        slope = spin_slope(p, w)
        if count == 0 and slope > 0.0:
            axis_for_spin(p, old, w, spin_against(p, old, w, old.spin_couple) - w.spin)
            spin_balance(p, old, w)
            break
        if balance > 0.0:
            low = w.spin
        else:
            high = w.spin
        most = largest_step(p, w)
        step = -balance / slope if slope < 0.0 else math.copysign(most, balance)
        step = min(max(step, -most), most)
        if not low < w.spin + step < high:
            step = 0.5 * (low + high) - w.spin
        if abs(step) < _SMALLEST_STEP and abs(balance) <= round_off(p, old, w):
            w.spins = 1.0 if w.spin != 0.0 else 0.0
            return
        if abs(step) < _SMALLEST_STEP or abs(w.spin + step) > _LARGEST_SPIN:
            break
        if axis_for_spin(p, old, w, step) < 0:
            break
        balance = spin_balance(p, old, w)
    w.spins = 0.0
