"""Kernels that put all contact pairs of a bearing together: forces on four bodies, derivative.

Bodies: 0 node i with the bottom plate, 1 bottom slider, 2 top slider, 3 node j with the top
plate. The origin is the undeformed place of the bottom sphere's centre. A pair's force depends on
the place of its point in axes of the carrier alone; force and counterforce act at that point, so
that forces and moments of each pair balance to round-off (Eq. (5) of the paper).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined, kernel
from lir_element.kernels.contact.discs import hold_disc
from lir_element.kernels.contact.held import (
    PUSH,
    add_held,
    hold_forces,
    hold_nothing,
    place_point,
    spread_pair,
)
from lir_element.kernels.contact.pair import clear_pair, rim
from lir_element.kernels.contact.places import (
    HIGH,
    LOW_BOTTOM,
    LOW_TOP,
    NORMAL,
    OWN,
    RIM_BOTTOM,
    RIM_TOP,
)
from lir_element.kernels.contact.points import add_slope, press_points
from lir_element.kernels.slip import step_share

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats


@inlined
def clear_parts(parts: Floats) -> None:
    """Set the forces of all origins but the sliders' own to zero."""
    for part in range(OWN):
        for row in range(24):
            parts[part, row] = 0.0


@inlined
def clear_square(k: Floats) -> None:
    """Set the derivative of all forces to zero."""
    for row in range(24):
        for col in range(24):
            k[row, col] = 0.0


@inlined
def hold_rim(s: BodyStep, side: int, body: int, carrier: int, dt: float, derive: bool) -> None:
    """Hold the force of a rim on the slider's outermost point; its derivative goes to ``w.k``."""
    p, w, held = s.props, s.scratch, s.scratch.held[3 + side]
    up = p.lever[0] if side == 0 else -p.lever[1]
    place_point(w, held, body, carrier, s.sliders.vertex[side], up)
    clear_pair(w)
    rim(p, side, w, s.old, s.new, dt)
    if s.new.rim_force[side] == 0.0:
        hold_nothing(held)
        return
    for a in range(3):
        w.arm[0, a], w.arm[1, a], w.couple[a] = held[0, a], held[1, a], 0.0
    hold_forces(w, held, carrier)
    if derive:
        for a in range(3):
            w.force[0, a] = held[PUSH, a]
        add_slope(w, body, carrier)


@inlined
def hold_pairs(s: BodyStep, dt: float, speed_bottom: float, speed_top: float, derive: bool) -> None:
    """Hold the forces of discs and rims, and set the new state of contacts; see `press`."""
    w = s.scratch
    s.new.step = dt
    w.share, w.step_before = step_share(dt, s.old.step), s.old.step
    w.derived = 1 if derive else 0
    if s.points[0].disc > 0.0:
        hold_disc(s, 0, 1, 0, dt, speed_bottom, derive)
        hold_disc(s, 1, 2, 1, dt, 0.0, derive)
        hold_disc(s, 2, 2, 3, dt, speed_top, derive)
    else:
        press_points(s, dt, speed_bottom, speed_top, derive)
    hold_rim(s, 0, 1, 0, dt, derive)
    hold_rim(s, 1, 2, 3, dt, derive)


@inlined
def push_sliders(s: BodyStep, out: Floats) -> None:
    """Add the forces of discs and rims on both sliders to `out` (12,)."""
    held = s.scratch.held
    add_held(out, 0, 1.0, 0, held[0])
    add_held(out, 6, 1.0, 0, held[1])
    add_held(out, 0, -1.0, 1, held[1])
    add_held(out, 6, 1.0, 0, held[2])
    add_held(out, 0, 1.0, 0, held[3])
    add_held(out, 6, 1.0, 0, held[4])


@kernel
def add_up(s: BodyStep) -> None:
    """Add what is held to the forces by origin, and set their sum ``w.g``."""
    w, parts = s.scratch, s.new.parts
    if s.points[0].disc > 0.0:
        spread_pair(parts, w.held[0], 1, 0, NORMAL, LOW_BOTTOM)
        spread_pair(parts, w.held[1], 2, 1, NORMAL, HIGH)
        spread_pair(parts, w.held[2], 2, 3, NORMAL, LOW_TOP)
    spread_pair(parts, w.held[3], 1, 0, RIM_BOTTOM, RIM_BOTTOM)
    spread_pair(parts, w.held[4], 2, 3, RIM_TOP, RIM_TOP)
    total = w.g
    for row in range(24):
        total[row] = parts[0, row]
    for part in range(1, OWN):
        for row in range(24):
            total[row] += parts[part, row]


@kernel
def press(s: BodyStep, dt: float, speed_bottom: float, speed_top: float, derive: bool) -> None:
    """Set the forces ``w.g`` on all bodies at ``w.x``, ``w.q``, and the new state of contacts.

    With `derive`, also ``w.k``. `speed_bottom` and `speed_top` are the sliding speeds of a static
    state (dt = 0).
    """
    clear_parts(s.new.parts)
    if derive:
        clear_square(s.scratch.k)
    hold_pairs(s, dt, speed_bottom, speed_top, derive)
    add_up(s)
