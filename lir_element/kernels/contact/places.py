"""Kernels of the places of bodies and contact points: rotations as quaternions, origins."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel

if TYPE_CHECKING:
    from lir_element.layout import Bodies, Floats, Scratch, Sliders

NORMAL, LOW_BOTTOM, HIGH, LOW_TOP, RIM_BOTTOM, RIM_TOP, OWN = 0, 1, 2, 3, 4, 5, 6
_SMALL = 1e-4  # square of half a turn, below which a few terms of a series are exact to round-off


@kernel
def matrix_of(turn: Floats, q: Floats) -> None:
    """Fill `q` (3, 3) with the rotation matrix of the unit quaternion `turn`."""
    w, x, y, z = turn[0], turn[1], turn[2], turn[3]
    q[0, 0] = 1.0 - 2.0 * (y * y + z * z)
    q[1, 1] = 1.0 - 2.0 * (z * z + x * x)
    q[2, 2] = 1.0 - 2.0 * (x * x + y * y)
    q[0, 1], q[1, 0] = 2.0 * (x * y - w * z), 2.0 * (x * y + w * z)
    q[1, 2], q[2, 1] = 2.0 * (y * z - w * x), 2.0 * (y * z + w * x)
    q[2, 0], q[0, 2] = 2.0 * (z * x - w * y), 2.0 * (z * x + w * y)


@kernel
def turn_by(start: Floats, x: float, y: float, z: float, out: Floats) -> None:
    """Set `out` (4,) to the rotation vector (x, y, z) in global axes after the turn `start`."""
    square = 0.25 * (x * x + y * y + z * z)
    if square < _SMALL:
        share = 0.5 - square * (1.0 / 12.0 - square * (1.0 / 240.0 - square * (1.0 / 10080.0)))
        a = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0)))
    else:
        half = math.sqrt(square)
        share, a = 0.5 * math.sin(half) / half, math.cos(half)
    b, c, d = share * x, share * y, share * z
    e, f, g, h = start[0], start[1], start[2], start[3]
    t_0, t_1 = a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g
    t_2, t_3 = a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e
    inv = 1.0 / math.sqrt(t_0 * t_0 + t_1 * t_1 + t_2 * t_2 + t_3 * t_3)
    out[0], out[1], out[2], out[3] = inv * t_0, inv * t_1, inv * t_2, inv * t_3


@kernel
def turn_between(old: Floats, new: Floats) -> tuple[float, float, float]:
    """Return the rotation vector (global axes) that leads from the turn `old` to `new`."""
    a, b, c, d = new[0], new[1], new[2], new[3]
    e, f, g, h = old[0], -old[1], -old[2], -old[3]
    s = a * e - b * f - c * g - d * h
    x, y, z = (
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        (a * h + b * g - c * f + d * e),
    )
    sign = 1.0 if s >= 0.0 else -1.0
    square = x * x + y * y + z * z
    if square < _SMALL:
        high = 3.0 / 40.0 + square * (5.0 / 112.0 + square * (35.0 / 1152.0))
        factor = 2.0 + 2.0 * square * (1.0 / 6.0 + square * high)
    else:
        size = math.sqrt(square)
        factor = 2.0 * math.atan2(size, abs(s)) / size
    return sign * factor * x, sign * factor * y, sign * factor * z


@kernel
def place_bodies(c: Sliders, w: Scratch, bodies: Bodies, first: int, last: int) -> None:
    """Set places and rotations of the bodies `first` to `last` (exclusive) from their record."""
    for b in range(first, last):
        for a in range(3):
            w.x[b, a] = c.place[b, a] + bodies.displacement[b - 1, a]
        matrix_of(bodies.turn[b - 1], w.q[b])


@kernel
def locate(w: Scratch, body: int, carrier: int, x: float, y: float, z: float, up: float) -> None:
    """Set the point (x, y, z) of `body` in axes of its `carrier`, from height `up` on its axis."""
    q, r = w.q[body], w.q[carrier]
    for a in range(3):
        w.arm[0, a] = q[a, 0] * x + q[a, 1] * y + q[a, 2] * z
        w.arm[1, a] = w.arm[0, a] + (w.x[body, a] - w.x[carrier, a])
    for a in range(3):
        w.d[a] = r[0, a] * w.arm[1, 0] + r[1, a] * w.arm[1, 1] + r[2, a] * w.arm[1, 2]
    w.d[2] -= up
