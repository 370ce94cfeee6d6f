"""Kernels of the friction law: the coefficient over the sliding speed, and what follows from it.

A law falls short of its coefficient at high speed by a drop, times the share of it that the speed
leaves: ``exp(-alpha v)`` (3.1), or what the table of another law holds, a cubic between knots that
lie evenly over ``x = v / (v + v_ref)`` (3.10). All that depends on the law is asked for here.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Work

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
    """Return what a speed leaves of the friction's drop, and how that falls by the speed."""
    if table[0] > 0.0:
        share, fall = tabulated(table, speed)
        return drop * share, drop * fall
    decay = drop * math.exp(-rate * speed)  # (3.1)
    return decay, rate * decay


@kernel
def lowered(p: Props, k: int, speed: float) -> tuple[float, float]:
    """Return the same of surface `k` (0 bottom, 1 top): by how much a speed leaves it too low."""
    return left_of_drop(p.friction_drop[k], p.friction_rate[k], p.friction_table[k], speed)


@inlined
def lowered_near(p: Props, w: Work, k: int) -> tuple[float, float]:
    """Return the same at the speed of a trial, ``w.speed[k]``.

    The exponential is taken where a trial looks first; nearby a few terms of its series do. A table
    costs less than it.
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


@kernel
def fill_left(drop: Floats, rate: Floats, tables: Floats, speeds: Floats, out: Floats) -> None:
    """Fill `out` (n, m) with what `speeds` (n, m) leave of the drop of m surfaces."""
    for i in range(speeds.shape[0]):
        for j in range(speeds.shape[1]):
            out[i, j], _ = left_of_drop(drop[j], rate[j], tables[j], speeds[i, j])
