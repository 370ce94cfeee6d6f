"""Kernels of the error estimate: error of a step in the bearings' histories."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_before_typing, inlined_by_llvm, kernel
from frames.kernels.nonlinear_works import part_defect, part_error
from lir_element.kernels.levels import bearing_defect
from lir_element.kernels.sampling import ground_acceleration

_BEND = 0.9  # rad a step, beyond which the laws do not see to how a path bends
_MEMORY = 0.2  # s, averaging time of ringing
_MOST_LATE = 2.0  # of the friction force: it has turned round
_APART = 8  # steps, of which a run with a fixed step looks at the last two: they cost it 1 to 2 %

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import Ground, IntegrationState, IntegratorSettings
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats


@inlined_by_llvm
def opening(model: ReducedModel, k: int, axis: int, b: Floats) -> float:
    """Return how far `b` takes node j of bearing `k`: to the side, or up from node i."""
    total = 0.0
    for entry in range(model.start[k, 6 + axis], model.start[k, 7 + axis]):
        total += model.values[entry] * b[model.columns[entry]]
    if axis == 2:
        for entry in range(model.start[k, 2], model.start[k, 3]):
            total -= model.values[entry] * b[model.columns[entry]]
    return total


@inlined_before_typing
def rate(model: ReducedModel, run: IntegrationState, k: int, axis: int) -> float:
    """Return the acceleration of bearing `k`'s `opening` along an axis about the step's start.

    From displacements, which are free of ringing from step to step.
    """
    clock = run.clock[0]
    change = opening(model, k, axis, run.step) / clock.dt - run.moved[k, axis]
    return change / (0.5 * (clock.dt + clock.dt_before))


@inlined_before_typing
def lifting(model: ReducedModel, run: IntegrationState, ground: Ground, k: int) -> float:
    """Return the vertical acceleration of bearing `k`'s node j to i about the start of the step.

    Total acceleration if node i is fixed, so that it is smooth in free flight.
    """
    found = rate(model, run, k, 2)
    if model.start[k, 2] == model.start[k, 3]:
        found += ground_acceleration(ground.acceleration, ground.dt, run.clock[0].time, 2)
    return found


@inlined_before_typing
def driven(run: IntegrationState, ground: Ground, axis: int) -> tuple[float, float]:
    """Return the bearings' force over the mass they carry, and the ground's acceleration.

    Means of the step and the one before, with the weights that `rate` has.
    """
    clock = run.clock[0]
    force, mass = 0.0, 0.0
    past, coming = clock.dt_before, clock.dt
    for k in range(run.old.shape[0]):
        force += past * run.push[k, axis] + coming * run.new[k].force[6 + axis]
        force += (past + coming) * run.old[k].force[6 + axis]
        mass += run.carried[k]
    shaking = past * ground_acceleration(ground.acceleration, ground.dt, clock.time - past, axis)
    shaking += coming * ground_acceleration(
        ground.acceleration, ground.dt, clock.time + coming, axis
    )
    shaking += (past + coming) * ground_acceleration(
        ground.acceleration, ground.dt, clock.time, axis
    )
    return 0.5 * force / (mass * (past + coming)), 0.5 * shaking / (past + coming)


@kernel
def ringing(
    model: ReducedModel, run: IntegrationState, settings: IntegratorSettings, ground: Ground
) -> float:
    """Return 12 times the phase error of ringing at the bearings in a step's length [m].

    From accelerations without the bearings' forces, the only ones on a mass without a structure; at
    most 12 times twice the displacement of the ringing.
    """
    clock = run.clock[0]
    run.swing[0], run.swing[1] = 0.0, 0.0
    if clock.dt_before <= 0.0:
        return 0.0
    mass = 0.0
    for axis in range(2):
        push, shaking = driven(run, ground, axis)
        for k in range(run.old.shape[0]):
            own = rate(model, run, k, axis) + push + shaking
            gain = own - run.moved[k, 3 + axis]
            run.own[k, axis] = own
            run.swing[0] += run.carried[k] * own * own
            run.swing[1] += run.carried[k] * gain * gain
            mass += 0.5 * run.carried[k]
    run.swing[0], run.swing[1] = run.swing[0] / mass, run.swing[1] / mass
    lost = settings.error_time * clock.dt * math.sqrt(run.swing[1])
    if run.swing[3] > 0.0:
        lost = min(lost, 24.0 * run.swing[2] * math.sqrt(run.swing[2]) / run.swing[3])
    return lost


@inlined_before_typing
def bend(run: IntegrationState, k: int, axis: int) -> float:
    """Return how far the force on node j of bearing `k` is from linear over two steps."""
    clock = run.clock[0]
    ratio = clock.dt / clock.dt_before if clock.dt_before > 0.0 else 0.0
    old, new = run.old[k].force[6 + axis], run.new[k].force[6 + axis]
    return float(new - old - ratio * (old - run.push[k, axis]))


@inlined_before_typing
def turned(a_1: float, a_2: float, b_1: float, b_2: float) -> float:
    """Return the angle from (a_1, a_2) to (b_1, b_2), zero if one of them is zero."""
    return math.atan2(a_1 * b_2 - a_2 * b_1, a_1 * b_1 + a_2 * b_2)


@kernel
def lagging(model: ReducedModel, run: IntegrationState, k: int) -> float:
    """Return the lag of bearing `k`'s friction force behind its law.

    Implicit steps are half a step late, an error of first order: half of the change of the rims'
    damper forces, and half of the change of friction, as far as its sliding slips, as it rotates
    more or less than the path (the bend of the path itself is included elsewhere), and as its size
    grows by the Bouc-Wen law.
    """
    p, old, new = model.props[k], run.old[k], run.new[k]
    total = 0.0
    for side in range(2):
        damped = new.rim_force[side] - p.rim_stiffness * new.rim_closure[side]
        damped -= old.rim_force[side] - p.rim_stiffness * old.rim_closure[side]
        total += 0.5 * abs(damped)
        z_1, z_2 = new.hysteresis[side, 0], new.hysteresis[side, 1]
        y_1, y_2 = old.hysteresis[side, 0], old.hysteresis[side, 1]
        size = math.hypot(z_1, z_2)
        gain = size - math.hypot(y_1, y_2)
        slipped = new.slid[side] - p.yield_displacement[side] * max(gain, 0.0)
        if slipped <= 0.0 or size == 0.0:
            continue
        d_1, d_2 = new.sliding_increment[side, 0], new.sliding_increment[side, 1]
        bend = turned(old.sliding_increment[side, 0], old.sliding_increment[side, 1], d_1, d_2)
        if abs(bend) > _BEND:
            bend = 0.0
        late = size * min(abs(turned(y_1, y_2, z_1, z_2) - bend), _MOST_LATE)
        if p.bouc_wen != 0:
            late += abs(size - (y_1 * z_1 + y_2 * z_2) / size)
        force = new.friction_coefficient[side] * new.axial_force * late
        force *= slipped / max(slipped, math.hypot(d_1, d_2))
        total += 0.5 * p.radius[side] / p.length * force
    return total


@kernel
def estimated_error(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> float:
    """Return the error of the bearings' displacements with steps of this size [m].

    The trapezoidal rule integrates each bearing's force with an error of a twelfth of its second
    difference, and the lag counts besides. A lasting error of a force is a displacement of the
    pendulum, that of a step below ``error_event`` an impulse. Ringing of the structure gets out of
    phase; it counts over ``error_time``. Schemes that damp have more error (docs/theory.md, 5).
    Forces that are linear in the step, as the ground's, have none. Off the ground a bearing has no
    force, and the change of its vertical acceleration gives the error at landing.
    """
    clock = run.clock[0]
    damps = settings.gamma - 0.5
    factor = 1.0 / 12.0 + 0.5 * damps * damps
    ratio = clock.dt / clock.dt_before if clock.dt_before > 0.0 else 0.0
    wrong, mass = 0.0, 0.0
    for k in range(run.old.shape[0]):
        x, y, z = bend(run, k, 0), bend(run, k, 1), bend(run, k, 2)
        if run.old[k].axial_force <= 0.0 or run.new[k].axial_force <= 0.0:
            z = run.carried[k] * (lifting(model, run, ground, k) - run.moved[k, 5])
            z *= settings.error_open
        else:
            z *= settings.error_vertical
        late = lagging(model, run, k) / factor
        wrong += x * x + y * y + z * z + late * late
        mass += run.carried[k] * run.carried[k]
    if parts is not None:
        wrong += part_error(parts, ratio)
    error = math.sqrt(wrong / mass) * settings.error_flexibility  # (5.3)
    error *= min(clock.dt / settings.error_event, 1.0)
    error += ringing(model, run, settings, ground)  # (5.10)
    return factor * error


@inlined_before_typing
def is_rough(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> bool:
    """Return True if the step must be halved, though it converged.

    Either its estimated error is too large, or contacts that open or close in it gain or lose more
    than a share of the run's energy so far.
    """
    defect = 0.0
    for k in range(run.old.shape[0]):
        defect += bearing_defect(model.props, run.old, run.new, contacts, k)
    if parts is not None:
        defect += part_defect(parts)
    scale = max(run.energy[0].kinetic, abs(run.energy[0].input), settings.energy_floor)
    if defect > settings.energy_tolerance * scale:
        return True
    clock = run.clock[0]
    adapts = settings.error_tolerance < math.inf
    if adapts or run.counts[0].steps % _APART >= _APART - 2:
        clock.error = estimated_error(model, run, parts, settings, ground)
    if adapts:
        reach = max(clock.reach, settings.smallest_reach)
        clock.share = clock.error / (settings.error_tolerance * reach)
    return clock.share > 1.0


@inlined_before_typing
def keep_motion(
    model: ReducedModel, run: IntegrationState, settings: IntegratorSettings, ground: Ground
) -> None:
    """Keep how the bearings were forced and moved, for the next estimate of the error.

    With a fixed step the last of some steps stands for all of them, and needs those before it.
    """
    clock = run.clock[0]
    adapts = settings.error_tolerance < math.inf
    place = run.counts[0].steps % _APART
    if not adapts and place < _APART - 3:
        return
    if adapts or place == _APART - 1:
        lasts = clock.dt if adapts else _APART * clock.dt
        share = lasts / (lasts + _MEMORY)
        clock.recent += share * (clock.error - clock.recent)
        clock.worst = max(clock.worst, clock.recent)
        run.swing[2] += share * (run.swing[0] - run.swing[2])
        run.swing[3] += share * (run.swing[1] / (clock.dt * clock.dt) - run.swing[3])
    for k in range(run.old.shape[0]):
        run.moved[k, 5] = lifting(model, run, ground, k)
        for axis in range(3):
            if axis < 2:
                run.moved[k, 3 + axis] = run.own[k, axis]
            run.moved[k, axis] = opening(model, k, axis, run.step) / clock.dt
            run.push[k, axis] = run.old[k].force[6 + axis]
        u = run.new[k].displacement
        clock.reach = max(clock.reach, math.sqrt((u[6] - u[0]) ** 2 + (u[7] - u[1]) ** 2))
