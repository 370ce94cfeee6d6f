"""Kernels that keep the largest values of a run and their times, step by step.

The formulas are those of frames/formulas.py, by which Datasets are read as well.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm, kernel
from frames.bundles.peak_data import ENERGY_TERMS, LOOSE
from frames.kernels.quantities import (
    balance_gap,
    bearing_quantities,
    closing_speed,
    size,
    sliding_power,
)
from lir_element.kernels.derived import in_plan
from lir_element.kernels.friction_law import lowered
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from typing import Any

    from frames.bundles.peak_data import Devices, Reached, Shape
    from frames.bundles.run_data import Ground, Output
    from lir_element.layout import Floats, Props, Records, State

AT_ONCE = 4
"""Steps whose displacements are formed together: each column of the maps is read once for them."""

WHOLE_PLACES = (
    "base_shear",
    "energy_input",
    "energy_numerical",
    "energy_gap",
    "energy_yielding",
)
"""Quantities in `Reached.whole`."""

_INPUT = ENERGY_TERMS.index("input")
_YIELDING = ENERGY_TERMS.index("yielding")
_NUMERICAL = ENERGY_TERMS.index("numerical")


@inlined_by_llvm
def raise_to(values: Floats, times: Floats, place: int, value: float, time: float) -> None:
    """Keep a value that is larger than those before, or the first that is not a number."""
    old = values[place]
    if value > old or (math.isnan(value) and not math.isnan(old)):
        values[place], times[place] = value, time


@inlined_by_llvm
def add_totals(p: Props, state: State, reached: Reached, k: int, t: float) -> None:
    """Add a step of a bearing to the sums over steps."""
    load = max(state.axial_force, 0.0)
    for surface in range(2):
        speed = state.sliding_speed[surface]
        reached.total[0] += sliding_power(load, p.friction_max[surface], speed)
        if p.friction_drop[surface] != 0.0:
            lower, _ = lowered(p, surface, speed)
            reached.total[1] += sliding_power(load, lower, speed)
    lifted = state.axial_force <= 0.0 and state.failed <= 0
    if lifted and reached.lifted[k, 1] == 0.0:
        reached.total[2] += 1.0
    if lifted and reached.last[1] > 0.0:
        reached.lifted[k, 0] += t - reached.last[0]
    reached.lifted[k, 1] = 1.0 if lifted else 0.0


@inlined_by_llvm
def add_loose_slip(static: float, load: float, slip: float, reached: Reached, k: int) -> None:
    """Add the change of a bearing's slip in a step that ends with loose sliders."""
    if load <= LOOSE * static and reached.last[1] > 0.0:
        reached.loose[k, 0] += slip - reached.loose[k, 1]
    reached.loose[k, 1] = slip


@inlined_by_llvm
def met_with_slip(length: float, state: State, reached: Reached, k: int, t: float) -> float:
    """Return the closing speed at which a bearing met a rim in the last step, 0 if it did not."""
    old, slip, u, speed = reached.met[k], state.slip_total, state.displacement, 0.0
    x, y = u[6] - u[0], u[7] - u[1]
    meets = state.rim_force[0] > 0.0 or state.rim_force[1] > 0.0
    if meets and old[4] == 0.0 and reached.last[1] > 0.0:
        time = t - reached.last[0]
        speed = closing_speed(old[0], old[1], x - old[2], y - old[3], time, length)
    old[0], old[1], old[2], old[3] = slip[0], slip[1], x, y
    old[4] = 1.0 if meets else 0.0
    return speed


@kernel
def peak_bearings(devices: Devices, reached: Reached, states: Records, row: int, t: float) -> None:
    """Update the peaks by one step of all bearings."""
    for k in range(devices.records.shape[0]):
        p, state = devices.records[k], states[row, k]
        values, times = reached.bearing[k], reached.bearing_at[k]
        u = state.displacement
        for axis in range(3):
            raise_to(reached.axis, reached.axis_at, axis, size(u[6 + axis] - u[axis]), t)
        bearing_quantities(
            p,
            state,
            devices.static[k],
            devices.radius[k],
            devices.height[k],
            devices.floor[k],
            reached.shown[0],
        )
        reached.shown[0].closing = met_with_slip(p.length, state, reached, k, t)
        for column in range(values.shape[0]):
            raise_to(values, times, column, reached.columns[0, column], t)
        add_totals(p, state, reached, k, t)
        slip = reached.shown[0].slip
        add_loose_slip(devices.static[k], state.axial_force, slip, reached, k)


@kernel
def peak_energy(reached: Reached, energy: Floats, t: float) -> None:
    """Update the peaks by the terms of the energy at one step."""
    total = 0.0
    for term in range(1, energy.shape[0]):
        total += energy[term]
    given = energy[_INPUT]
    raise_to(reached.whole, reached.whole_at, 1, size(given), t)
    raise_to(reached.whole, reached.whole_at, 2, size(energy[_NUMERICAL]), t)
    raise_to(reached.whole, reached.whole_at, 3, balance_gap(given, total), t)
    raise_to(reached.whole, reached.whole_at, 4, size(energy[_YIELDING]), t)


@kernel
def columns_times(matrix: Floats, x: Floats, out: Floats) -> None:
    """Add ``matrix.T @ x`` of `AT_ONCE` vectors: matrix (n, m), x (4, n), out (4, m)."""
    a, b, c, d = out[0], out[1], out[2], out[3]
    for k in range(matrix.shape[0]):
        row = matrix[k]
        x_a, x_b, x_c, x_d = x[0, k], x[1, k], x[2, k], x[3, k]
        for r in range(row.shape[0]):
            value = row[r]
            a[r] += value * x_a
            b[r] += value * x_b
            c[r] += value * x_c
            d[r] += value * x_d


@kernel
def expand_steps(shape: Shape, out: Output, first: int, count: int) -> None:
    """Form the displacements and accelerations needed of `count` <= AT_ONCE steps."""
    n_b, n_e, m = out.b.shape[1], out.e.shape[1], out.beyond.shape[1]
    for s in range(count):
        for k in range(n_b):
            shape.x[s, k], shape.x_rate[s, k] = out.b[first + s, k], out.a_b[first + s, k]
        for k in range(n_e):
            shape.x[s, n_b + k] = out.e[first + s, k]
            shape.x_rate[s, n_b + k] = shape.mass_e[k] * out.a_e[first + s, k]
        for k in range(m):
            shape.x[s, n_b + n_e + k] = out.beyond[first + s, k]
        for k in range(shape.rest.shape[0]):
            shape.u[s, k] = shape.rest[k]
        for k in range(shape.a.shape[1]):
            shape.a[s, k] = 0.0
    columns_times(shape.moves, shape.x, shape.u)
    columns_times(shape.rates, shape.x_rate, shape.a)


@inlined_by_llvm
def sparse_row(start: Any, place: Any, value: Floats, row: int, of: Floats) -> float:
    """Return one row of a sparse map times a vector."""
    total = 0.0
    for k in range(start[row], start[row + 1]):
        total += value[k] * of[place[k]]
    return total


@inlined_by_llvm
def peak_motion(shape: Shape, reached: Reached, ground: Ground, s: int, t: float) -> None:
    """Update the peaks by accelerations of nodes and levels, drifts of storeys and lines."""
    n_nodes, n_levels, n_storeys = shape.sizes[0], shape.sizes[1], shape.sizes[2]
    a, u = shape.a[s], shape.u[s]
    g_x = ground_acceleration(ground.acceleration, ground.dt, t, 0)
    g_y = ground_acceleration(ground.acceleration, ground.dt, t, 1)
    g_z = ground_acceleration(ground.acceleration, ground.dt, t, 2)
    for k in range(n_nodes + n_levels):
        x = sparse_row(shape.a_start, shape.a_place, shape.a_value, 3 * k, a) + g_x
        y = sparse_row(shape.a_start, shape.a_place, shape.a_value, 3 * k + 1, a) + g_y
        z = sparse_row(shape.a_start, shape.a_place, shape.a_value, 3 * k + 2, a) + g_z
        plan, vertical = in_plan(x, y), size(z)
        if k < n_nodes:
            raise_to(reached.node[k], reached.node_at[k], 0, plan, t)
            raise_to(reached.node[k], reached.node_at[k], 1, vertical, t)
        else:
            raise_to(reached.level[k - n_nodes], reached.level_at[k - n_nodes], 0, plan, t)
            raise_to(reached.level[k - n_nodes], reached.level_at[k - n_nodes], 1, vertical, t)
    for k in range(n_storeys + shape.sizes[3]):
        x = sparse_row(shape.u_start, shape.u_place, shape.u_value, 2 * k, u)
        y = sparse_row(shape.u_start, shape.u_place, shape.u_value, 2 * k + 1, u)
        if k < n_storeys:
            raise_to(reached.storey, reached.storey_at, k, in_plan(x, y), t)
        else:
            raise_to(reached.line, reached.line_at, k - n_storeys, in_plan(x, y), t)


@inlined_by_llvm
def peak_shear(
    devices: Devices,
    shape: Shape,
    reached: Reached,
    states: Records,
    beyond: Floats,
    row: int,
    s: int,
    t: float,
) -> None:
    """Update the peak base shear by one step: of bearings on the ground, and of other supports."""
    first, m = 2 * (shape.sizes[2] + shape.sizes[3]), beyond.shape[1]
    x, y = 0.0, 0.0
    for axis in range(2):
        force = shape.shear[axis, m]
        for k in range(m):
            force += shape.shear[axis, k] * beyond[row, k]
        force += sparse_row(shape.u_start, shape.u_place, shape.u_value, first + axis, shape.u[s])
        for k in range(devices.on_ground.shape[0]):
            if devices.on_ground[k] == 1:
                force += states[row, k].force[6 + axis]
        x, y = (force, y) if axis == 0 else (x, force)
    raise_to(reached.whole, reached.whole_at, 0, in_plan(x, y), t)


@inlined_by_llvm
def peak_storey_shear(
    shape: Shape, reached: Reached, states: Records, row: int, s: int, t: float
) -> None:
    """Update the peak shear of each storey by one step: of members, and of bearings through it."""
    storeys, n_bearings = shape.crossed.shape
    u, first = shape.u[s], shape.u.shape[1] - 2 * storeys
    for k in range(storeys):
        x, y = u[first + 2 * k], u[first + 2 * k + 1]
        for b in range(n_bearings):
            if shape.crossed[k, b] == 1:
                x += states[row, b].force[6]
                y += states[row, b].force[7]
        raise_to(reached.shear, reached.shear_at, k, in_plan(x, y), t)


@kernel
def peak_of_bearings(
    devices: Devices, reached: Reached, states: Records, out: Output, first: int, last: int
) -> None:
    """Update the peaks by rows first <= k < last of the output: bearings and energy."""
    for row in range(first, last):
        t = out.time[row]
        peak_bearings(devices, reached, states, row, t)
        peak_energy(reached, out.energy[row], t)
        reached.last[0] = t
        reached.last[1] += 1.0


@kernel
def peak_of_structure(
    devices: Devices,
    shape: Shape,
    reached: Reached,
    states: Records,
    out: Output,
    ground: Ground,
    first: int,
    last: int,
) -> None:
    """Update the peaks by rows first <= k < last of the output: the structure above."""
    row = first
    while row < last:
        count = min(AT_ONCE, last - row)
        expand_steps(shape, out, row, count)
        for s in range(count):
            t = out.time[row + s]
            peak_motion(shape, reached, ground, s, t)
            peak_shear(devices, shape, reached, states, out.beyond, row + s, s, t)
            peak_storey_shear(shape, reached, states, row + s, s, t)
        row += count
