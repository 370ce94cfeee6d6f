"""Kernels of the level 'pendulum': the slider's axis in equilibrium, found by a safeguarded Newton.

Newton's step is shortened until the residual falls. If everything slides and Newton's matrix has no
stiffness, a search against the residual brackets the zero. docs/theory.md, section 4.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.friction_law import left_by_heat, steepest
from lir_element.kernels.pendulum.axial import rubs_by
from lir_element.kernels.pendulum.string import elastic_jacobian, evaluate, set_axis
from lir_element.kernels.pendulum.tangent import slider_jacobian
from lir_element.kernels.slip import step_share

if TYPE_CHECKING:
    from lir_element.layout import Props, State, Work

_MAX_ITERATIONS = 60
_MAX_STEEPEST = 12
_TOLERANCE = 1e-12  # of axial force times string length
ROUND_OFF = 4e-16  # of lengths
_LARGEST_TURN = 0.1  # rad, of the axis in one iteration
_GAIN = 0.999  # of the residual, with which a step does: any gain beyond round-off
_SHORTER = 0.3  # of a step that does not do: between 1/10 and 1/2 (Dennis and Schnabel 1983, 6.3.2)
_TRIES = 8  # of a step: the last one is 0.3^7, 2e-4 of it (a choice)
NEARLY = 10.0  # residuals to reach: as good, if no step gains any more (a choice)
_SINGULAR = 1e-3  # of the restoring term's determinant, below which Newton sees none (a choice)
_LARGEST_SEARCH = 3.0 * _LARGEST_TURN  # 17 degrees, beyond any neighbouring equilibrium (a choice)
_FURTHER = 4.0  # times as far, until the zero is bracketed (a choice)
_MAX_BISECTIONS = 80
_BRACKETED = 1e-3  # of axial force and length: from there Newton's method goes on (a choice)
_SMALLEST_TURN = 1e-16  # rad, round-off of the axis
_SMALLEST_CIRCLE = 1e-6  # rad: a rim so close to the plate's axis has no circle (a choice)


@kernel
def start_search(p: Props, old: State, w: Work) -> None:
    """Set the values of a step alone: its share, the old z, the stiffness of the friction laws."""
    w.share = step_share(w.dt, old.step)
    w.first_decay[0], w.first_decay[1] = 0.0, 0.0
    w.varies = 0.0
    if p.softens or p.pressure_rate != 0.0:
        w.varies = 1.0
        w.warm[0] = left_by_heat(p, old.temperature[0])
        w.warm[1] = left_by_heat(p, old.temperature[1])
    stiff = 0.0
    for k in range(2):
        z = old.hysteresis[k]
        w.z_size[k], w.per_yield[k] = (
            math.sqrt(z[0] ** 2 + z[1] ** 2),
            1.0 / p.yield_displacement[k],
        )
        by_speed = steepest(p, k) / w.dt if w.dt > 0.0 else 0.0
        stiff += p.radius[k] * (p.friction_max[k] * w.per_yield[k] + by_speed)
    z = old.interface_hysteresis
    w.z_size[2], w.per_yield[2] = math.sqrt(z[0] ** 2 + z[1] ** 2), 1.0 / p.interface_yield
    w.law_stiffness[0], w.law_stiffness[1] = stiff, p.interface_friction * w.per_yield[2]


@kernel
def residual_square(w: Work) -> float:
    """Return the square of the residual of the slider's equilibrium."""
    return w.residual[0] ** 2 + w.residual[1] ** 2


@kernel
def square_to_reach(p: Props, w: Work) -> float:
    """Return the square of the residual to reach: that of round-off in lengths under stiff laws."""
    more, _ = rubs_by(p, w.n_hat)
    stiff = w.l * w.law_stiffness[1] * more + w.law_stiffness[0]
    enough = (_TOLERANCE + ROUND_OFF * stiff) * w.n_hat * w.l
    for k in range(2):
        enough += ROUND_OFF * p.radius[k] ** 2 * w.stiff_rim[k]
    return enough * enough


@kernel
def mark_start(w: Work) -> None:
    """Keep the current axis as the start of a search; on a rim, keep its parallel circle too."""
    for a in range(3):
        w.start[0, a], w.start[1, a], w.start[2, a] = w.n[a], w.t[0, a], w.t[1, a]
    w.start_circle[2] = 0.0
    if w.stiff_rim[0] > 0.0 or w.stiff_rim[1] > 0.0:
        radius = w.n_hor[0]
        if radius > _SMALLEST_CIRCLE:
            w.start_circle[0], w.start_circle[1] = w.n[0] / radius, w.n[1] / radius
            w.start_circle[2] = radius


@kernel
def move(p: Props, old: State, w: Work, e_1: float, e_2: float) -> None:
    """Turn the axis from the start of the search by eta and evaluate there.

    On a rim the turn follows the rim's circle: a straight one would run into the rim's stiffness
    by its curvature alone.
    """
    s = w.start
    if w.start_circle[2] == 0.0:
        set_axis(
            w,
            s[0, 0] + s[1, 0] * e_1 + s[2, 0] * e_2,
            s[0, 1] + s[1, 1] * e_1 + s[2, 1] * e_2,
            s[0, 2] + s[1, 2] * e_1 + s[2, 2] * e_2,
        )
    else:
        u_1, u_2, radius = w.start_circle[0], w.start_circle[1], w.start_circle[2]
        along = (-u_2 * e_1 + u_1 * e_2) / radius
        tilt = math.atan2(radius, s[0, 2]) + u_1 * e_1 + u_2 * e_2
        cos, sin, out = math.cos(along), math.sin(along), math.sin(tilt)
        set_axis(w, out * (cos * u_1 - sin * u_2), out * (sin * u_1 + cos * u_2), math.cos(tilt))
    evaluate(p, old, w)


@kernel
def newton_turn(p: Props, old: State, w: Work) -> bool:
    """Turn the axis along Newton's direction; return whether the residual falls."""
    size = residual_square(w)
    slider_jacobian(p, w)
    j = w.jacobian
    det = j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]
    floor = w.n_hat * w.l * w.l  # of the restoring term, which must not rule
    if not (j[0, 0] + j[1, 1] > floor and det > _SINGULAR * floor * floor):
        return False
    inv = -1.0 / det
    e_1 = inv * (j[1, 1] * w.residual[0] - j[0, 1] * w.residual[1])
    e_2 = inv * (j[0, 0] * w.residual[1] - j[1, 0] * w.residual[0])
    square = e_1 * e_1 + e_2 * e_2
    if square > _LARGEST_TURN**2:
        turn = math.sqrt(square)
        e_1, e_2 = e_1 * _LARGEST_TURN / turn, e_2 * _LARGEST_TURN / turn
    mark_start(w)
    for _ in range(_TRIES):
        move(p, old, w, e_1, e_2)
        new = residual_square(w)
        if new <= _GAIN**2 * size or new < square_to_reach(p, w):
            return True
        e_1, e_2 = _SHORTER * e_1, _SHORTER * e_2
    move(p, old, w, 0.0, 0.0)
    return False


@kernel
def steepest_turn(p: Props, old: State, w: Work) -> bool:
    """Rotate the axis against the residual until its part along that direction vanishes.

    The safeguard if everything slides and Newton's matrix has no stiffness: expand, then bisect
    (Illinois). Returns True if there is a zero within the largest rotation.
    """
    size = math.sqrt(w.residual[0] ** 2 + w.residual[1] ** 2)
    d_1, d_2 = -w.residual[0] / size, -w.residual[1] / size
    elastic_jacobian(p, w)
    high = size / (w.jacobian[0, 0] + w.jacobian[1, 1])
    low, f_low = 0.0, -size
    mark_start(w)
    move(p, old, w, high * d_1, high * d_2)
    f_high = w.residual[0] * d_1 + w.residual[1] * d_2
    while f_high < 0.0:
        low, f_low = high, f_high
        if high >= _LARGEST_SEARCH:
            move(p, old, w, 0.0, 0.0)
            return False
        high = min(_FURTHER * high, _LARGEST_SEARCH)
        move(p, old, w, high * d_1, high * d_2)
        f_high = w.residual[0] * d_1 + w.residual[1] * d_2
    for _ in range(_MAX_BISECTIONS):
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        move(p, old, w, middle * d_1, middle * d_2)
        f = w.residual[0] * d_1 + w.residual[1] * d_2
        if abs(f) <= _BRACKETED * w.n_hat * w.l or high - low < _SMALLEST_TURN:
            break
        if f < 0.0:
            low, f_low, f_high = middle, f, 0.5 * f_high
        else:
            high, f_high, f_low = middle, f, 0.5 * f_low
    return True


@kernel
def solve_axis(p: Props, old: State, w: Work) -> int:
    """Find the axis in equilibrium; return the iterations taken, or -1."""
    evaluate(p, old, w)
    if p.fused:
        return 0
    steepest = 0
    for count in range(_MAX_ITERATIONS):
        size, enough = residual_square(w), square_to_reach(p, w)
        if size < enough:
            return count
        if not newton_turn(p, old, w):
            if size < NEARLY**2 * enough:
                return count
            steepest += 1
            if not steepest_turn(p, old, w) or steepest > _MAX_STEEPEST:
                return -1
    return -1
