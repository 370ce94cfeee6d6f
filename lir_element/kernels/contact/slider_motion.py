"""Kernels of the sliders' own motion: weight and inertia by the implicit Euler rule over a step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.places import OWN, matrix_of, turn_between
from lir_element.kernels.rotation import add_cross
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Records


@kernel
def momentum(
    inertia: Floats, q: Floats, spin: Floats, out: Floats, first: int, factor: float
) -> None:
    """Add `factor` times the angular momentum (global axes) to ``out[first:first + 3]``."""
    for b in range(3):
        own = q[0, b] * spin[0] + q[1, b] * spin[1] + q[2, b] * spin[2]
        for a in range(3):
            out[first + a] += factor * inertia[b] * own * q[a, b]


@kernel
def shake_sliders(scratch: Records, motion: Floats, motion_dt: float, time: float) -> None:
    """Set the ground's acceleration at `time`, the end of a step, for sliders of all bearings."""
    for axis in range(3):
        pull = ground_acceleration(motion, motion_dt, time, axis)
        for k in range(scratch.shape[0]):
            scratch[k].ground[axis] = pull


@kernel
def set_momentum(s: BodyStep) -> None:
    """Set the sliders' angular momentum at the committed state, ``w.momentum`` (2, 3)."""
    w = s.scratch
    for k in range(2):
        for a in range(3):
            w.momentum[k, a] = 0.0
        matrix_of(s.old.turn[k], w.spare_matrix)
        momentum(s.sliders.inertia[k], w.spare_matrix, s.old.spin[k], w.momentum[k], 0, 1.0)


@kernel
def own_forces(s: BodyStep, dt: float, b: int) -> None:
    """Set weight and inertia forces of slider `b` (1, 2) in ``s.new.parts``, and its velocity."""
    c, old, new = s.sliders, s.old, s.new
    w = s.scratch
    part = new.parts[OWN]
    first, k = 6 * b, b - 1
    for a in range(6):
        part[first + a] = 0.0
    if dt == 0.0:
        part[first + 2] = -c.mass[k] * c.gravity
        for a in range(3):
            new.velocity[k, a], new.spin[k, a] = 0.0, 0.0
        return
    rate = 1.0 / dt
    x, y, z = turn_between(old.turn[k], new.turn[k])
    new.spin[k, 0], new.spin[k, 1], new.spin[k, 2] = rate * x, rate * y, rate * z
    for a in range(3):
        new.velocity[k, a] = rate * (new.displacement[k, a] - old.displacement[k, a])
        new.acceleration[k, a] = rate * (new.velocity[k, a] - old.velocity[k, a])
        part[first + a] = -c.mass[k] * (new.acceleration[k, a] + w.ground[a])  # (7.5)
        part[first + 3 + a] = rate * w.momentum[k, a]
    part[first + 2] -= c.mass[k] * c.gravity
    momentum(c.inertia[k], w.q[b], new.spin[k], part, first + 3, -rate)


@kernel
def add_gyration(s: BodyStep, dt: float, k: int, first: int) -> None:
    """Add the derivative of slider `k`'s rate of angular momentum by its spin."""
    w = s.scratch
    q, spin, inertia = w.q[k + 1], s.new.spin[k], s.sliders.inertia[k]
    for a in range(3):
        for b in range(3):
            w.half[a, b] = 0.0
            for e in range(3):
                w.half[a, b] += inertia[e] * q[a, e] * q[b, e]
    x, y, z = dt * spin[0], dt * spin[1], dt * spin[2]
    square = x * x + y * y + z * z
    curve = 1.0 / 12.0 + square / 720.0
    if square > 1e-4:
        half = 0.5 * math.sqrt(square)
        curve = (1.0 - half / math.tan(half)) / square
    psi, g = (x, y, z), w.spare_matrix
    for a in range(3):  # d(rotation vector) = (1 - psi x / 2 + curve (psi x)^2) spin, over dt
        for b in range(3):
            value = curve * psi[a] * psi[b]
            if a == b:
                value += 1.0 - curve * square
            g[a, b] = value / dt
    add_cross(g, 0, 0, x, y, z, -0.5 / dt)
    add_cross(g, 0, 0, spin[0], spin[1], spin[2], 1.0)  # turning inertia: J (spin x) - momentum x
    h = w.spare_vector
    h[0], h[1], h[2] = 0.0, 0.0, 0.0
    momentum(inertia, q, spin, h, 0, 1.0)
    m = w.joint
    for a in range(3):
        for b in range(3):
            total = 0.0
            for e in range(3):
                total += w.half[a, e] * g[e, b]
            m[first + a, first + b] += total / dt
    add_cross(m, first, first, h[0], h[1], h[2], -1.0 / dt)
