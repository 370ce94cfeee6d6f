"""Kernels of the error estimate of a step: whether it is too rough, and what the next one needs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import expanded, inlined, kernel
from frames.kernels.part_works import part_defect, part_error
from lir_element.kernels.levels import bearing_defect
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from frames.kernel_data import Ground, Model, Run, Setup
    from frames.parts_data import Parts
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats


@inlined
def opening(model: Model, k: int, b: Floats) -> float:
    """Return how far `b` takes node j of bearing `k` up from node i."""
    total = 0.0
    for entry in range(model.start[k, 8], model.start[k, 9]):
        total += model.values[entry] * b[model.columns[entry]]
    for entry in range(model.start[k, 2], model.start[k, 3]):
        total -= model.values[entry] * b[model.columns[entry]]
    return total


@expanded
def lifting(model: Model, run: Run, ground: Ground, k: int) -> float:
    """Return the vertical acceleration of bearing `k`'s node j to i about the start of the step.

    From displacements, which are free of what rings from step to step; total, where node i is
    fixed, so that it is smooth in free flight.
    """
    clock = run.clock[0]
    rate = opening(model, k, run.step) / clock.dt - run.rise[k, 0]
    rate /= 0.5 * (clock.dt + clock.dt_before)
    if model.start[k, 2] == model.start[k, 3]:
        rate += ground_acceleration(ground.acceleration, ground.dt, clock.time, 2)
    return rate


@expanded
def bend(run: Run, k: int, axis: int) -> float:
    """Return how far the force on node j of bearing `k` is from linear over two steps."""
    clock = run.clock[0]
    ratio = clock.dt / clock.dt_before if clock.dt_before > 0.0 else 0.0
    old, new = run.old[k].force[6 + axis], run.new[k].force[6 + axis]
    return float(new - old - ratio * (old - run.push[k, axis]))


@kernel
def lagging(model: Model, run: Run, k: int) -> float:
    """Return the force by which the Bouc-Wen friction of bearing `k` lags behind its law.

    An implicit step follows the curve of that law with an error of first order: half of what
    the friction changes by, in so far as its sliding slips. The elastic-plastic law has none.
    """
    p, old, new = model.props[k], run.old[k], run.new[k]
    total = 0.0
    if p.bouc_wen == 0:
        return total
    for side in range(2):
        size = math.hypot(new.hysteresis[side, 0], new.hysteresis[side, 1])
        gain = size - math.hypot(old.hysteresis[side, 0], old.hysteresis[side, 1])
        slipped = new.slid[side] - p.yield_displacement[side] * max(gain, 0.0)
        if slipped > 0.0 and size > 0.0:
            along = 0.0
            for axis in range(2):
                along += old.hysteresis[side, axis] * new.hysteresis[side, axis] / size
            d_1, d_2 = new.sliding_increment[side, 0], new.sliding_increment[side, 1]
            force = new.friction_coefficient[side] * new.axial_force * abs(size - along)
            force *= slipped / max(slipped, math.hypot(d_1, d_2))
            total += 0.5 * p.radius[side] / p.length * force
    return total


@kernel
def estimated_error(
    model: Model, run: Run, parts: Parts | None, settings: Setup, ground: Ground
) -> float:
    """Return the estimated error of the step in the bearings' displacement over what is allowed.

    The trapezoidal rule integrates each bearing's force F to the velocity of the mass it carries
    with an error of ``dt / 12`` times the second difference of F / m, which counts over
    ``error_time``; schemes that damp have more of it (docs/theory.md, 5). Forces that are linear
    in the step, as the ground's, have none, and what rings in the structure has none unless it
    passes through a bearing. Off the ground a bearing has no force, and the change of its vertical
    acceleration says how it will land.
    """
    clock = run.clock[0]
    damps = settings.gamma - 0.5
    factor = 1.0 / 12.0 + 0.5 * damps * damps
    wrong, mass = 0.0, 0.0
    for k in range(run.old.shape[0]):
        x, y, z = bend(run, k, 0), bend(run, k, 1), bend(run, k, 2)
        if run.old[k].axial_force <= 0.0 or run.new[k].axial_force <= 0.0:
            z = run.carried[k] * (lifting(model, run, ground, k) - run.rise[k, 1])
            z *= settings.error_open
        else:
            z *= settings.error_vertical
        late = lagging(model, run, k) / factor
        wrong += x * x + y * y + z * z + late * late
        mass += run.carried[k] * run.carried[k]
    if parts is not None:
        wrong += part_error(parts, clock.dt / clock.dt_before if clock.dt_before > 0.0 else 0.0)
    error = factor * clock.dt * math.sqrt(wrong / mass) * settings.error_time  # (5.3)
    return error / (settings.error_tolerance * max(clock.reach, settings.smallest_reach))


@expanded
def is_rough(
    model: Model, run: Run, contacts: Contacts | None, parts: Parts | None, settings: Setup,
    ground: Ground,
) -> bool:  # fmt: skip
    """Return whether the step deserves to be halved, though it converged.

    Either its estimated error is too large, or contacts that open or close in it make or lose
    more energy than a share of what the run has moved so far.
    """
    defect = 0.0
    for k in range(run.old.shape[0]):
        defect += bearing_defect(model.props, run.old, run.new, contacts, k)
    if parts is not None:
        defect += part_defect(parts)
    scale = max(run.energy[0].kinetic, abs(run.energy[0].input), settings.energy_floor)
    if defect > settings.energy_tolerance * scale:
        return True
    if settings.error_tolerance < math.inf:
        run.clock[0].share = estimated_error(model, run, parts, settings, ground)
    return run.clock[0].share > 1.0


@expanded
def keep_motion(model: Model, run: Run, ground: Ground) -> None:
    """Keep how the bearings were forced and moved, for the next estimate of the error."""
    clock = run.clock[0]
    for k in range(run.old.shape[0]):
        run.rise[k, 1] = lifting(model, run, ground, k)
        run.rise[k, 0] = opening(model, k, run.step) / clock.dt
        for axis in range(3):
            run.push[k, axis] = run.old[k].force[6 + axis]
        u = run.new[k].displacement
        clock.reach = max(clock.reach, math.sqrt((u[6] - u[0]) ** 2 + (u[7] - u[1]) ** 2))
