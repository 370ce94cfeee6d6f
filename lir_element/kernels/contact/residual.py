"""Kernels of the sliders' equilibrium: its residual, the size to reach, Newton's matrix.

Twelve unknowns: displacement and spin of the bottom and of the top slider. Their inertia enters by
the implicit Euler rule over the step, so that the system stays regular if contacts open.
docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.contact.pairs import press
from lir_element.kernels.contact.places import OWN, place_bodies
from lir_element.kernels.contact.slider_motion import add_gyration, own_forces
from lir_element.kernels.linear import pivot_of

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Props, Records, Scratch, Sliders

_TOLERANCE = 1e-10  # of the normal forces
HOLD = 1e-10  # of the contact stiffness, in static states
ROUND_OFF = 4e-16  # of lengths and turns


@kernel
def unbalanced(s: BodyStep, dt: float, speeds: Floats, derive: bool) -> float:
    """Set all forces at the sliders' places and ``w.residual``; return its size.

    With `derive` also the derivative of the forces.

    Forces, and moments over the slider's radius, against the largest normal force and weight.
    """
    c, w = s.sliders, s.scratch
    place_bodies(c, w, s.new, 1, 3)
    press(s, dt, speeds[0], speeds[1], derive)
    own_forces(s, dt, 1)
    own_forces(s, dt, 2)
    part = s.new.parts[OWN]
    for row in range(12):
        w.residual[row] = w.g[6 + row] + part[6 + row]
    return size_of_residual(c, w)


@inlined_by_llvm
def size_of_residual(c: Sliders, w: Scratch) -> float:
    """Return the size of ``w.residual``."""
    total = 0.0
    for row in range(12):
        size = w.residual[row] if row % 6 < 3 else w.residual[row] / c.radius
        total += size * size
    return math.sqrt(total)


@kernel
def longest(step: Floats, bodies: int, length: float) -> float:
    """Return the largest rotation in a step, or motion over `length`: isotropic in plan."""
    largest = 0.0
    for k in range(2 * bodies):  # ways and turns of one body after another
        x, y, z = step[3 * k], step[3 * k + 1], step[3 * k + 2]
        size = math.sqrt(x * x + y * y + z * z)
        largest = max(largest, size if k % 2 == 1 else size / length)
    return largest


@kernel
def small_forces(p: Props, c: Sliders, touch: Records, dt: float) -> float:
    """Return the residual to reach: a share of the forces, and round-off under stiff laws."""
    total = p.axial_floor
    for j in range(touch.shape[0]):
        total += touch[j].push
    stiff = c.stiffness + total * (
        p.friction_max[0] / p.yield_displacement[0] + p.friction_max[1] / p.yield_displacement[1]
    )
    if not p.fused:
        stiff += (total + p.interface_preload) * p.interface_friction / p.interface_yield
    if dt > 0.0:
        stiff += c.damping / dt + (c.mass[0] + c.mass[1]) / (dt * dt)
    return _TOLERANCE * total + ROUND_OFF * stiff * (p.radius[0] + p.radius[1])


@kernel
def set_system(s: BodyStep, dt: float) -> None:
    """Set Newton's matrix (12 x 12) in ``w.joint``: minus the derivative of the residual."""
    c, w = s.sliders, s.scratch
    a = w.joint
    for row in range(12):
        for col in range(12):
            a[row, col] = -w.k[6 + row, 6 + col]
    if dt == 0.0:  # free sliders stay at their place
        for row in range(12):
            a[row, row] += HOLD * c.stiffness * (1.0 if row % 6 < 3 else c.radius**2)
        return
    for k in range(2):
        first = 6 * k
        for e in range(3):
            a[first + e, first + e] += c.mass[k] / (dt * dt)
        add_gyration(s, dt, k, first + 3)


@inlined_by_llvm
def eliminate(a: Floats, width: int) -> bool:
    """Reduce the first twelve columns to upper triangular form, over `width` columns."""
    for col in range(12):
        pivot = pivot_of(a, col, 12)
        if pivot < 0:
            return False
        if pivot != col:
            for k in range(24):
                a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
        inv = 1.0 / a[col, col]
        for row in range(col + 1, 12):
            factor = a[row, col] * inv
            for k in range(width):
                a[row, k] -= factor * a[col, k]
    return True


@kernel
def solve_one(w: Scratch, x: Floats) -> bool:
    """Set ``x`` (12,) to the solution for column 12; False if the matrix is singular."""
    a = w.joint
    if not eliminate(a, 16):
        return False
    for row in range(11, -1, -1):
        total = a[row, 12]
        for col in range(row + 1, 12):
            total -= a[row, col] * x[col]
        x[row] = total / a[row, row]
    return True


@kernel
def invert(w: Scratch) -> bool:
    """Set the second twelve columns of ``w.joint`` to its inverse, column by column in rows.

    By Gauss and Jordan in place, with pivoted rows; False if the matrix is singular.
    """
    a, order = w.joint, w.order
    for col in range(12):
        pivot = pivot_of(a, col, 12)
        if pivot < 0:
            return False
        order[col] = pivot
        if pivot != col:
            for k in range(12):
                a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
        inv = 1.0 / a[col, col]
        a[col, col] = 1.0
        for k in range(12):
            a[col, k] *= inv
        for row in range(12):
            if row != col:
                factor = a[row, col]
                a[row, col] = 0.0
                for k in range(12):
                    a[row, k] -= factor * a[col, k]
    for row in range(12):
        for col in range(12):
            a[col, 12 + row] = a[row, col]
    for col in range(11, -1, -1):
        if order[col] != col:
            for k in range(12, 24):
                a[col, k], a[order[col], k] = a[order[col], k], a[col, k]
    return True
