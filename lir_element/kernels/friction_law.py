"""Kernels of the friction law: the coefficient over the sliding speed, and its derivatives.

A law reduces its coefficient at high speed by a drop, times its remaining share at the speed:
``exp(-alpha v)`` (3.1), or the table of another law, a cubic between knots that are even over ``x =
v / (v + v_ref)`` (3.10). All that depends on the law is here.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, State, Work

_NEAR = 1e-3  # of an exponent: the next term of the series lies below round-off


@kernel
def tabulated(table: Floats, speed: float) -> tuple[float, float]:
    """Return the share of the drop that a speed leaves by a table, and its fall by the speed."""
    reference, intervals = table[0], (table.shape[0] - 3) // 2
    whole = 1.0 / (speed + reference)
    place = speed * whole * intervals
    k = int(place) if place < intervals else intervals - 1  # of a speed that is no number, too
    s = place - k
    a, b = table[1 + 2 * k], table[3 + 2 * k]
    inv = 1.0 / intervals
    first, last = table[2 + 2 * k] * inv, table[4 + 2 * k] * inv
    bend, more = 3.0 * (b - a) - 2.0 * first - last, 2.0 * (a - b) + first + last
    share = a + s * (first + s * (bend + s * more))
    by_place = first + s * (2.0 * bend + 3.0 * s * more)
    return share, -by_place * intervals * reference * whole * whole


@kernel
def left_of_drop(drop: float, rate: float, table: Floats, speed: float) -> tuple[float, float]:
    """Return the remaining share of the friction's drop at a speed, and its fall with the speed."""
    if table[0] > 0.0:
        share, fall = tabulated(table, speed)
        return drop * share, drop * fall
    decay = drop * math.exp(-rate * speed)  # (3.1)
    return decay, rate * decay


@kernel
def lowered(p: Props, k: int, speed: float) -> tuple[float, float]:
    """Return the same of surface `k` (0 bottom, 1 top): by how much a speed leaves it too low."""
    return left_of_drop(p.friction_drop[k], p.friction_rate[k], p.friction_table[k], speed)


@inlined_by_llvm
def lowered_near(p: Props, w: Work, k: int) -> tuple[float, float]:
    """Return the same at the speed of a trial, ``w.speed[k]``.

    The exponential is computed at the first speed of a trial; near it a few terms of its series are
    used. A table costs less.
    """
    if p.friction_table[k, 0] > 0.0:
        return lowered(p, k, w.speed[k])
    rate = p.friction_rate[k]
    x = rate * (w.first_speed[k] - w.speed[k])
    if w.first_decay[k] != 0.0 and abs(x) < _NEAR:
        decay = w.first_decay[k]
        decay *= 1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0))))
        return decay, rate * decay
    w.first_speed[k] = w.speed[k]
    w.first_decay[k], slope = lowered(p, k, w.speed[k])
    return w.first_decay[k], slope


@kernel
def coefficient(p: Props, k: int, speed: float) -> tuple[float, float]:
    """Return the friction coefficient of surface `k` at a speed, and its derivative."""
    if p.friction_drop[k] == 0.0:
        return p.friction_max[k], 0.0
    lower, fall = lowered(p, k, speed)
    return p.friction_max[k] - lower, fall


@kernel
def least(p: Props, k: int) -> float:
    """Return the friction coefficient of surface `k` at rest."""
    return p.friction_max[k] - p.friction_drop[k]


@kernel
def steepest(p: Props, k: int) -> float:
    """Return the largest derivative of the friction coefficient of surface `k` by speed [s/m]."""
    return p.friction_drop[k] * p.friction_rate[k]


_FADED = 1e-15  # K


@kernel
def left_by_heat(p: Props, temperature: float) -> float:
    """Return the share of friction that is left at a temperature [C]."""
    if p.softens == 0:
        return 1.0
    left = p.softening_rest + math.exp(-p.softening_rate * temperature)
    return p.softening_scale * left  # (11.1)


@kernel
def left_by_pressure(p: Props, load: float) -> float:
    """Return the share of friction that is left under an axial force [N]."""
    if p.pressure_rate == 0.0:
        return 1.0
    return math.exp(-p.pressure_rate * (load - p.pressure_load))  # (11.1)


@kernel
def covered(before: float, after: float, radius: float) -> float:
    """Return the share of a step in which a slider covers the middle of its surface.

    `before` and `after` are its distances from there; between them they change evenly.
    """
    low, high = min(before, after), max(before, after)
    if high <= radius:
        return 1.0
    if low >= radius:
        return 0.0
    return (radius - low) / (high - low)


@kernel
def grown(part: float, lost: float, gain: float) -> float:
    """Return a part of a temperature after a step, zero if it has faded (11.5).

    Numbers that fade on towards the smallest there are cost a processor a hundred times as much.
    """
    part += gain - lost * part
    return part if part > _FADED else 0.0


@kernel
def heat_up(p: Props, heat: Floats, old: State, new: State) -> None:
    """Advance the temperatures over the step from `old` to `new`, whose works are summed.

    `heat` (3, parts) has the contacts' rise above their temperature at the start, part by part:
    bottom surface, top surface, interface. The dissipation of friction heats them evenly over the
    step.
    """
    dt = new.time - old.time
    if not dt > 0.0:
        return
    a = p.slider_radius
    per = 1.0 / (math.pi * a * a * dt)
    slip_old = math.sqrt(old.slip[0] ** 2 + old.slip[1] ** 2)
    slip = math.sqrt(new.slip[0] ** 2 + new.slip[1] ** 2)
    bottom = covered(old.eccentricity[0], new.eccentricity[0], a)
    bottom *= per * (new.work_friction[0] - old.work_friction[0])
    top = covered(old.eccentricity[1], new.eccentricity[1], a)
    top *= per * (new.work_friction[1] - old.work_friction[1])
    plane = covered(slip_old, slip, a) * per * (new.work_interface - old.work_interface)
    t_0, t_1, t_2 = p.heat_skin * bottom, p.heat_skin * top, p.heat_skin * plane
    for i in range(heat.shape[1]):
        rate = p.heat_rate[i]
        lost = -math.expm1(-rate * dt)
        gain = p.heat_gain[i] * (lost / rate if rate > 0.0 else dt)
        heat[0, i] = grown(heat[0, i], lost, gain * bottom)
        heat[1, i] = grown(heat[1, i], lost, gain * top)
        heat[2, i] = grown(heat[2, i], lost, gain * plane)
        t_0, t_1, t_2 = t_0 + heat[0, i], t_1 + heat[1, i], t_2 + heat[2, i]
    new.temperature[0] = p.initial_temperature + t_0
    new.temperature[1] = p.initial_temperature + t_1
    new.temperature[2] = p.initial_temperature + t_2
