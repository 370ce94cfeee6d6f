"""Formulas of the recorded quantities, compiled; those of a bearing at a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames import formulas
from frames._jit import inlined_by_llvm
from frames.bundles.peak_data import LOADED, PRESSED
from lir_element.kernels.derived import eccentricity, in_plan, in_space, resultant_offset

if TYPE_CHECKING:
    from typing import Any

    from lir_element.layout import Props, State

opposite = inlined_by_llvm(formulas.opposite)
size = inlined_by_llvm(formulas.size)
presses = inlined_by_llvm(formulas.presses)
either = inlined_by_llvm(formulas.either)
over_static = inlined_by_llvm(formulas.over_static)
vertical_change = inlined_by_llvm(formulas.vertical_change)
is_lifted = inlined_by_llvm(formulas.is_lifted)
by_tilt = inlined_by_llvm(formulas.by_tilt)
open_gap = inlined_by_llvm(formulas.open_gap)
interface_share = inlined_by_llvm(formulas.interface_share)
slips = inlined_by_llvm(formulas.slips)
pressed_eccentricity = inlined_by_llvm(formulas.pressed_eccentricity)
closing_speed = inlined_by_llvm(formulas.closing_speed)
sliding_power = inlined_by_llvm(formulas.sliding_power)
balance_gap = inlined_by_llvm(formulas.balance_gap)


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
    rubs = load + p.interface_preload
    now.interface_share = interface_share(in_plan(h[0], h[1]), rubs, static, p.interface_friction)
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
