"""Kernels of a restraining rim that yields: its law and where around the plate it is bent.

The rim is an elastic-plastic spring with hardening in radial direction, beside a damper that acts
on its elastic part alone: what presses on it never exceeds what it bears. Plastic deformation
stays where the slider pressed: it is kept in eight directions of the plate, between which it runs
smoothly (docs/theory.md, section 3). A rim without end of strength is the contact of Eq. (2).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.slip import kelvin_voigt
from lir_element.layout import RIM_DIRECTIONS

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props

_BETWEEN = 2.0 * math.pi / RIM_DIRECTIONS  # rad, from one direction to the next


@kernel
def between(x: float, y: float) -> tuple[int, int, float, float]:
    """Return the neighbours of a direction, and share and quarter turn of the way to the second.

    The share is ``sin^2`` of that turn: with the first one's ``cos^2`` it sums to 1.
    """
    place = math.atan2(y, x) / _BETWEEN
    first = math.floor(place)
    turn = 0.5 * math.pi * (place - first)
    share = math.sin(turn) ** 2
    i = int(first) % RIM_DIRECTIONS
    return i, (i + 1) % RIM_DIRECTIONS, share, turn


@kernel
def bent(dent: Floats, x: float, y: float) -> tuple[float, float]:
    """Return the plastic deformation of a rim in the direction (x, y), its change by the angle.

    Infinite of a rim that is broken.
    """
    if dent[0] == math.inf:
        return math.inf, 0.0
    i, j, share, turn = between(x, y)
    steep = 0.5 * math.pi * math.sin(2.0 * turn) / _BETWEEN
    return (1.0 - share) * dent[i] + share * dent[j], steep * (dent[j] - dent[i])


@kernel
def bend(dent: Floats, x: float, y: float, flow: float) -> None:
    """Add the plastic deformation `flow` in the direction (x, y); it spreads to its neighbours."""
    i, j, share, _ = between(x, y)
    size = (1.0 - share) ** 2 + share**2
    dent[i] += flow * (1.0 - share) / size
    dent[j] += flow * share / size


@kernel
def keep_dents(
    p: Props, old: Floats, new: Floats, x: float, y: float, flow: float, deformed: float
) -> None:
    """Set the dents (8,) of a rim from those before the step; a rim pressed too far is broken."""
    for a in range(RIM_DIRECTIONS):
        new[a] = old[a]
    if flow > 0.0:
        bend(new, x, y, flow)
    if p.flange > 0.0 and deformed > p.rim_overrun:
        for a in range(RIM_DIRECTIONS):
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
    """Return force of a rim, its derivative, its elastic deformation and how far it flows.

    `gap` is the way beyond the rim as it is bent, `strength` what it bears there (3.11).
    """
    force, slope, closure = kelvin_voigt(gap, closure_old, stiffness, damping, dt)
    if not force > strength:
        return force, slope, closure, 0.0
    flow = (force - strength) / (slope + hardening)
    return strength + hardening * flow, slope * hardening / (slope + hardening), gap - flow, flow
