"""Formulas of the quantities whose largest values are kept, and what a bearing shows of them.

A formula takes numbers in compiled code, and arrays as the Python that it is (`on_arrays`): what is
taken up step by step and what is read off a Dataset is one formula. None calls another. Names,
units and meanings are in `frames.results.quantities`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy import absolute, maximum, sqrt

from frames._jit import inlined_by_llvm
from frames.bundles.peak_data import FULL_SLIP, LEAST_SHARE, LOADED, PRESSED
from lir_element.kernels.derived import eccentricity, in_plan, in_space, resultant_offset

if TYPE_CHECKING:
    from typing import Any

    from lir_element.layout import Props, State


@inlined_by_llvm
def opposite(value: float) -> float:
    """Return what is largest where a value is least."""
    return -value


@inlined_by_llvm
def size(value: float) -> float:
    """Return the size of a number."""
    return absolute(value)


@inlined_by_llvm
def presses(force: float) -> float:
    """Return 1 where a force presses, else 0."""
    return 1.0 * (force > 0.0)


@inlined_by_llvm
def either(first: float, second: float) -> float:
    """Return the larger of two."""
    return maximum(first, second)


@inlined_by_llvm
def over_static(vertical_force: float, static: float) -> float:
    """Return a vertical force over the one under permanent loads."""
    return vertical_force / static


@inlined_by_llvm
def vertical_change(ratio: float) -> float:
    """Return by how much a vertical force differs from the static one, over it."""
    return absolute(ratio - 1.0)


@inlined_by_llvm
def is_lifted(ratio: float) -> float:
    """Return 1 where nothing presses, else 0."""
    return 1.0 * (ratio <= 0.0)


@inlined_by_llvm
def by_tilt(lever_bottom: float, lever_top: float, bottom: float, top: float) -> float:
    """Return by how much turns of the plates shift the centres of their spheres, C2 - C1 [m]."""
    return lever_bottom * bottom + lever_top * top


@inlined_by_llvm
def open_gap(
    across_x: float, across_y: float, rise: float, length: float, slip: float, axial_force: float
) -> float:
    """Return how far the axial contact is open [m]; 0 where it is closed.

    `across` is the place of the upper sphere's centre over the lower one in plan, `rise` that of
    the upper node. Where the contact just closes it is ``c = L n + s`` (docs/theory.md, section 1).
    """
    down = length - rise
    square = across_x * across_x + across_y * across_y + down * down - slip * slip
    gap = maximum(length - sqrt(maximum(square, 0.0)), 0.0)
    return gap * (axial_force <= 0.0)


@inlined_by_llvm
def interface_share(force: float, axial_force: float, static: float, friction: float) -> float:
    """Return the force of the interface over what its friction holds."""
    return force / (friction * maximum(axial_force, LEAST_SHARE * static))


@inlined_by_llvm
def slips(share: float) -> float:
    """Return 1 where the interface slips, else 0."""
    return 1.0 * (share >= FULL_SLIP)


@inlined_by_llvm
def pressed_eccentricity(
    eccentricity: float, slider_radius: float, axial_force: float, static: float, share: float
) -> float:
    """Return an eccentricity over the slider's radius; 0 up to this share of the load at rest."""
    return eccentricity / slider_radius * (axial_force > share * static)


@inlined_by_llvm
def closing_speed(
    slip_x: float, slip_y: float, way_x: float, way_y: float, time: float, length: float
) -> float:
    """Return how fast both sliders close on each other if the slider's tilt is held [m/s].

    The mass turns about the centre of the bottom sphere at ``sqrt(L^2 + s^2)`` (docs/theory.md,
    section 2): it closes where it moves against the slip. `way` is what it moves in the `time`.
    """
    closes = maximum(0.0 - slip_x * way_x - slip_y * way_y, 0.0)
    return closes / (time * sqrt(length * length + slip_x * slip_x + slip_y * slip_y))


@inlined_by_llvm
def sliding_power(load: float, friction: float, speed: float) -> float:
    """Return what the friction of a surface takes up under a load [N m/s]."""
    return load * friction * speed


@inlined_by_llvm
def balance_gap(given: float, absorbed: float) -> float:
    """Return by how much the terms of the energy differ from the input [J]."""
    return absolute(given - absorbed)


@inlined_by_llvm
def bearing_quantities(
    p: Props, state: State, static: float, radius: float, height: float, floor: float, now: Any
) -> None:
    """Fill the quantities of a bearing at one step, `now`: all that `by_step` names."""
    u, f, load = state.displacement, state.force, state.axial_force
    x, y = u[6] - u[0], u[7] - u[1]
    now.displacement = in_plan(x, y)
    now.force = in_plan(f[6], f[7])
    now.axial_force = load
    now.axial_tension = opposite(load)
    ratio = over_static(load, static)
    now.vertical_tension = opposite(ratio)
    now.vertical_change = vertical_change(ratio)
    stands = 1.0 * (state.failed <= 0)  # a stop that carries nothing is no bearing that lifts off
    now.lifted = stands * is_lifted(ratio)
    shift_x = by_tilt(p.lever[0], p.lever[1], -u[4], -u[10])
    shift_y = by_tilt(p.lever[0], p.lever[1], u[3], u[9])
    now.centre_shift = in_plan(shift_x, shift_y)
    s = state.slip_total
    now.slip = in_space(s[0], s[1], s[2])
    now.gap = stands * open_gap(x + shift_x, y + shift_y, u[8] - u[2], p.length, now.slip, load)
    for surface in range(2):
        slid = state.slider_displacement[surface]
        now.sliding[surface] = in_plan(slid[0], slid[1])
    now.rim_force = either(state.rim_force[0], state.rim_force[1])
    now.rims_met = presses(now.rim_force)
    h = state.interface_force
    now.interface_share = interface_share(in_plan(h[0], h[1]), load, static, p.interface_friction)
    now.slipped = slips(now.interface_share)
    e = eccentricity(
        load,
        floor,
        radius,
        height,
        state.axis[0],
        state.axis[1],
        state.axis[2],
        state.rim_force[0],
        h[0],
        h[1],
        state.friction_force[0, 0],
        state.friction_force[0, 1],
        state.slip[0],
        state.slip[1],
    )
    e = resultant_offset(e, state.offset)
    now.eccentricity = pressed_eccentricity(e, p.slider_radius, load, static, PRESSED)
    now.eccentricity_loaded = pressed_eccentricity(e, p.slider_radius, load, static, LOADED)
    now.spin = size(state.spin)
