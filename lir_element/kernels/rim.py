"""Kernels of a restraining rim that yields: its law and its plastic deformation in plan.

The rim is an elastic-plastic spring with hardening in radial direction, beside a damper that acts
on its elastic part alone: its force never exceeds its strength. Plastic deformation stays at the
point of contact, kept in waves around the plate (docs/theory.md, section 3). A rim of unlimited
strength is the contact of Eq. (2).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.slip import kelvin_voigt
from lir_element.layout import RIM_WAVES

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props

_SHARES = (70.0 / 256.0, 112.0 / 256.0, 56.0 / 256.0, 16.0 / 256.0, 2.0 / 256.0)  # of cos^8(a / 2)


@kernel
def gives_way(p: Props) -> bool:
    """Return whether rims yield, or break and let the slider go on."""
    return bool(p.rim_yield_force < math.inf or p.flange > 0.0)


@kernel
def bent(dent: Floats, x: float, y: float) -> tuple[float, float]:
    """Return the plastic deformation of a rim in the direction (x, y), its change by the angle.

    Infinite of a rim that is broken.
    """
    if dent[0] == math.inf:
        return math.inf, 0.0
    size = math.sqrt(x * x + y * y)
    if size == 0.0:  # in the middle: no rim is near
        return 0.0, 0.0
    u, v = x / size, y / size
    cos, sin, total, slant = 1.0, 0.0, dent[0], 0.0
    for k in range(1, RIM_WAVES + 1):
        cos, sin = cos * u - sin * v, sin * u + cos * v
        a, b = dent[k], dent[RIM_WAVES + k]
        total += a * cos + b * sin
        slant += k * (b * cos - a * sin)
    return max(total, 0.0), slant


@kernel
def bend(dent: Floats, x: float, y: float, flow: float) -> None:
    """Add the plastic deformation `flow` in the direction (x, y), less to its sides (3.12)."""
    size = math.sqrt(x * x + y * y)
    u, v = x / size, y / size
    cos, sin = 1.0, 0.0
    dent[0] += flow * _SHARES[0]
    for k in range(1, RIM_WAVES + 1):
        cos, sin = cos * u - sin * v, sin * u + cos * v
        dent[k] += flow * _SHARES[k] * cos
        dent[RIM_WAVES + k] += flow * _SHARES[k] * sin


@kernel
def keep_dents(
    p: Props, old: Floats, new: Floats, x: float, y: float, flow: float, closure: float, here: float
) -> None:
    """Set the dents of a rim from those before the step; a rim pressed too far is broken.

    `closure` is its elastic deformation, `here` the plastic one at the contact.
    """
    for a in range(old.shape[0]):
        new[a] = old[a]
    if flow > 0.0:
        bend(new, x, y, flow)
    if p.flange > 0.0 and closure > 0.0 and closure + here > p.rim_overrun:
        for a in range(old.shape[0]):
            new[a] = math.inf


@kernel
def largest_dent(before: float, dent: Floats, here: float) -> float:
    """Return the largest plastic deformation so far: that of before, that `here` or infinite."""
    return math.inf if dent[0] == math.inf else max(before, here)


@kernel
def press_rim(
    gap: float,
    closure_old: float,
    stiffness: float,
    damping: float,
    dt: float,
    strength: float,
    hardening: float,
) -> tuple[float, float, float, float]:
    """Return force of a rim, its derivative, its elastic deformation and its plastic flow.

    `gap` is the displacement beyond the deformed rim, `strength` its resistance there (3.11).
    """
    force, slope, closure = kelvin_voigt(gap, closure_old, stiffness, damping, dt)
    if not force > strength:
        return force, slope, closure, 0.0
    flow = (force - strength) / (slope + hardening)
    return strength + hardening * flow, slope * hardening / (slope + hardening), gap - flow, flow


@kernel
def meet_rim(
    p: Props, dent: Floats, gap: float, x: float, y: float, closure_old: float, dt: float
) -> tuple[float, float, float, float, float, float]:
    """Return the values of `press_rim` for a rim with dents in the direction (x, y), and these.

    `gap` is the way beyond the rim as it was built. The last two are its plastic deformation before
    the step, and how that changes by the angle, as far as the force follows it.
    """
    before, slant = 0.0, 0.0
    if gap > 0.0 and gives_way(p):
        before, slant = bent(dent, x, y)
    force, slope, closure, flow = press_rim(
        gap - before,
        closure_old,
        p.rim_stiffness,
        p.rim_damping,
        dt,
        p.rim_yield_force + p.rim_hardening * before,
        p.rim_hardening,
    )
    if flow > 0.0:  # its flow makes up for the smaller dent
        slant = 0.0
    return force, slope, closure, flow, before, slant
