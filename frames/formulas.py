"""Formulas of the quantities with recorded peaks, for numbers or arrays.

The step-by-step values (`frames/kernels/quantities.py` compiles them) and those of a Dataset have
one formula. None calls another. Names, units and meanings are in `frames.results.quantities`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy import absolute, maximum, sqrt

from frames.bundles.peak_data import FULL_SLIP, LEAST_SHARE

if TYPE_CHECKING:
    from lir_element.formulas import Numbers


def opposite(value: Numbers) -> Numbers:
    """Return a value that is largest at the least of another."""
    return -value


def size(value: Numbers) -> Numbers:
    """Return the size of a number."""
    return absolute(value)


def presses(force: Numbers) -> Numbers:
    """Return 1 if a force presses, else 0."""
    return 1.0 * (force > 0.0)


def either(first: Numbers, second: Numbers) -> Numbers:
    """Return the larger of two."""
    return maximum(first, second)


def over_static(vertical_force: Numbers, static: Numbers) -> Numbers:
    """Return a vertical force over the one under permanent loads."""
    return vertical_force / static


def vertical_change(ratio: Numbers) -> Numbers:
    """Return by how much a vertical force differs from the static one, over it."""
    return absolute(ratio - 1.0)


def is_lifted(ratio: Numbers) -> Numbers:
    """Return 1 if nothing presses, else 0."""
    return 1.0 * (ratio <= 0.0)


def by_tilt(lever_bottom: Numbers, lever_top: Numbers, bottom: Numbers, top: Numbers) -> Numbers:
    """Return by how much turns of the plates shift the centres of their spheres, C2 - C1 [m]."""
    return lever_bottom * bottom + lever_top * top


def open_gap(
    across_x: Numbers,
    across_y: Numbers,
    rise: Numbers,
    length: Numbers,
    slip: Numbers,
    axial_force: Numbers,
) -> Numbers:
    """Return the opening of the axial contact [m]; 0 if it is closed.

    `across` is the place of the upper sphere's centre over the lower one in plan, `rise` that of
    the upper node. At closing it is ``c = L n + s`` (docs/theory.md, section 1).
    """
    down = length - rise
    square = across_x * across_x + across_y * across_y + down * down - slip * slip
    gap = maximum(length - sqrt(maximum(square, 0.0)), 0.0)
    return gap * (axial_force <= 0.0)


def interface_share(
    force: Numbers, axial_force: Numbers, static: Numbers, friction: Numbers
) -> Numbers:
    """Return the force of the interface over its friction resistance."""
    return force / (friction * maximum(axial_force, LEAST_SHARE * static))


def slips(share: Numbers) -> Numbers:
    """Return 1 if the interface slips, else 0."""
    return 1.0 * (share >= FULL_SLIP)


def pressed_eccentricity(
    eccentricity: Numbers,
    slider_radius: Numbers,
    axial_force: Numbers,
    static: Numbers,
    share: Numbers,
) -> Numbers:
    """Return an eccentricity over the slider's radius; 0 up to this share of the load at rest."""
    return eccentricity / slider_radius * (axial_force > share * static)


def closing_speed(
    slip_x: Numbers, slip_y: Numbers, way_x: Numbers, way_y: Numbers, time: Numbers, length: Numbers
) -> Numbers:
    """Return the closing speed of both sliders at constant tilt of the slider [m/s].

    The mass rotates about the centre of the bottom sphere at ``sqrt(L^2 + s^2)`` (docs/theory.md,
    section 2): it closes if it moves against the slip. `way` is its motion in the `time`.
    """
    closes = maximum(0.0 - slip_x * way_x - slip_y * way_y, 0.0)
    return closes / (time * sqrt(length * length + slip_x * slip_x + slip_y * slip_y))


def sliding_power(load: Numbers, friction: Numbers, speed: Numbers) -> Numbers:
    """Return the power of a surface's friction under a load [N m/s]."""
    return load * friction * speed


def balance_gap(given: Numbers, absorbed: Numbers) -> Numbers:
    """Return by how much the terms of the energy differ from the input [J]."""
    return absolute(given - absorbed)
