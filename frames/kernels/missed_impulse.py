"""Kernels of the impulse that the trapezoidal rule misses in a step: "corrected-newmark".

Springs follow the path of a step, which is curved; friction does so until it slips, within a step.
The forces at the ends of the step do not give its mean. The difference is added to the velocities,
by accelerations, which follow from displacements, so that no ringing grows. The effective stiffness
filters all of it: unresolved motion stays unchanged (docs/theory_structure.md, 5).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm, kernel
from frames.assembly.system import HINGES
from frames.kernels.effective import effective
from lir_element.kernels.linear import (
    add_product,
    copy,
    dot,
    gather,
    scatter,
    set_product,
    substitute,
)

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState, IntegratorSettings
    from lir_element.layout import Floats

_LEAST = 1e-30  # least divisor
_SLIPS = 1.0 - 1e-9  # of the friction that there may be


@kernel
def missed_mean(
    y_1: float,
    y_2: float,
    z_1: float,
    z_2: float,
    d_1: float,
    d_2: float,
    c_1: float,
    c_2: float,
) -> tuple[float, float]:
    """Return the difference of the mean of z over a step from that of its ends, y and z.

    `d` is the sliding over the yield displacement, `c` half of its gain in speed: for a spring the
    path misses c / 6 twice, in its mean and in its end.
    """
    b_1, b_2 = y_1 + d_1, y_2 + d_2
    square = d_1 * d_1 + d_2 * d_2
    if b_1 * b_1 + b_2 * b_2 <= 1.0:
        return -c_1 / 3.0, -c_2 / 3.0
    along = y_1 * d_1 + y_2 * d_2
    room = max(1.0 - (y_1 * y_1 + y_2 * y_2), 0.0)
    root = math.sqrt(along * along + square * room)
    s = (root - along) / square if along < 0.0 else room / max(root + along, _LEAST)
    bend = min(max((c_1 * d_1 + c_2 * d_2) / square, -1.0), 1.0)
    root = math.sqrt(max((1.0 - bend) * (1.0 - bend) + 4.0 * bend * s, 0.0))
    t = min(2.0 * s / max(1.0 - bend + root, _LEAST), 1.0)  # when it slips
    held = t * t * (0.5 * (1.0 - bend) + bend * t / 3.0)
    rest = 0.5 * (1.0 - t)
    return (
        y_1 * t + d_1 * held + rest * (y_1 + s * d_1 + z_1) - 0.5 * (y_1 + z_1),
        y_2 * t + d_2 * held + rest * (y_2 + s * d_2 + z_2) - 0.5 * (y_2 + z_2),
    )


@inlined_by_llvm
def friction_misses(model: ReducedModel, run: IntegrationState, k: int) -> None:
    """Set ``run.missed_friction``, forces on the upper node of bearing `k` by its two surfaces."""
    p, old, new = model.props[k], run.old[k], run.new[k]
    dt = run.clock[0].dt
    gather(model.start[k], model.columns, model.values, run.rhs_b, run.u)
    a_1, a_2 = run.u[6] - run.u[0], run.u[7] - run.u[1]
    d = new.sliding_increment
    way = math.hypot(d[0, 0], d[0, 1]) + math.hypot(d[1, 0], d[1, 1])
    for side in range(2):
        out = run.missed_friction[k, side]
        out[0], out[1] = 0.0, 0.0
        d_1, d_2 = d[side, 0], d[side, 1]
        y_1, y_2 = old.hysteresis[side, 0], old.hysteresis[side, 1]
        size = math.hypot(d_1, d_2)
        if p.bouc_wen != 0 or not size > 0.0 or y_1 * d_1 + y_2 * d_2 >= _SLIPS * size:
            continue
        per = 1.0 / p.yield_displacement[side]
        gain = 0.5 * dt * dt * per * size / way
        z_1, z_2 = new.hysteresis[side, 0], new.hysteresis[side, 1]
        f_1, f_2 = missed_mean(y_1, y_2, z_1, z_2, d_1 * per, d_2 * per, gain * a_1, gain * a_2)
        force = new.friction_coefficient[side] * max(new.axial_force, 0.0)
        force *= p.radius[side] / p.length
        out[0], out[1] = force * f_1, force * f_2


@inlined_by_llvm
def add_friction_impulse(model: ReducedModel, run: IntegrationState, k: int) -> None:
    """Add to ``run.h_b`` the impulse that the friction of bearing `k` misses."""
    out = run.missed_friction[k]
    for a in range(2):
        run.u[6 + a] = out[0, a] + out[1, a]
    if run.u[6] == 0.0 and run.u[7] == 0.0:
        return
    run.u[:6] = 0.0
    run.u[8:] = 0.0
    run.u[0], run.u[1] = -run.u[6], -run.u[7]
    scatter(model.start[k], model.columns, model.values, -run.clock[0].dt, run.u, run.h_b)


@inlined_by_llvm
def owe_friction_work(model: ReducedModel, run: IntegrationState, k: int, c_m: float) -> None:
    """Count the work of the added impulse on the friction of bearing `k` as friction work.

    It is the work of the friction's missing impulse, and of the change of friction by the springs'
    missing impulse: by the part of the bearing's tangent that is not symmetric. ``run.h_b`` is the
    resolved velocity, ``run.rhs_b`` the addition to it.
    """
    p, old, new, element = model.props[k], run.old[k], run.new[k], run.element_k[k]
    v, gain = run.of_nodes[0], run.of_nodes[1]
    gather(model.start[k], model.columns, model.values, run.h_b, v)
    gather(model.start[k], model.columns, model.values, run.rhs_b, gain)
    given = 0.0
    for row in range(12):
        for col in range(12):
            given += element[row, col] * (v[col] * gain[row] - v[row] * gain[col])
    grip_0 = new.friction_coefficient[0] * p.radius[0]
    grip_1 = new.friction_coefficient[1] * p.radius[1]
    given /= c_m * max(grip_0 + grip_1, _LEAST)
    v_1, v_2 = v[6] - v[0], v[7] - v[1]
    for side in range(2):
        out = run.missed_friction[k, side]
        work = run.clock[0].dt * (out[0] * v_1 + out[1] * v_2)
        old.work_owed[side] += work - given * (grip_0 if side == 0 else grip_1)


@kernel
def give_way(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    c_m: float,
    x_b: Floats,
    x_e: Floats,
) -> None:
    """Set `x_b` and `x_e` to c_m times the step under forces.

    They hold the forces on b with the modes eliminated, and the modes' motion while b rests;
    ``run.h_e`` becomes mass_eb times the result for b.
    """
    substitute(run.tangent, run.order, x_b)
    for a in range(x_b.shape[0]):
        x_b[a] *= c_m
    set_product(model.mass_be, x_b, run.h_e)
    for k in range(x_e.shape[0]):
        x_e[k] = c_m * (x_e[k] - parts.modes[0, k] * run.h_e[k])


@kernel
def set_resolved(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    c_m: float,
    b: Floats,
    x_b: Floats,
    x_e: Floats,
) -> None:
    """Set `x_b` and `x_e` to the part of accelerations or velocities that these steps resolve.

    These are `b`, and `x_e` with ``run.h_e``, mass_eb times `b`, which is overwritten.
    """
    for k in range(x_e.shape[0]):
        own = x_e[k]
        x_e[k] = parts.modes[0, k] * (own + run.h_e[k])
        run.h_e[k] = own - c_m * x_e[k]
    set_product(model.mass_b, b, x_b)
    add_product(model.mass_eb, run.h_e, 1.0, x_b)
    give_way(model, run, parts, c_m, x_b, x_e)


@kernel
def add_missed_impulse(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    settings: IntegratorSettings,
) -> bool:
    """Add the trapezoidal rule's error of the step to the new velocities; return True if added.

    ``run.rhs_b`` and ``run.rhs_e`` have the addition. Its work on friction goes to the bearings,
    and that on springs is a loan: their energy in the curved path of the step.
    """
    clock = run.clock[0]
    if clock.kept != clock.halvings + 1:
        return False
    c_m, _, _ = effective(settings, clock.dt)
    a_e, v_e = parts.modes[1], parts.modes[2]
    copy(run.a_e_new, a_e)
    copy(run.flow_a_new, run.h_e)
    set_resolved(model, run, parts, c_m, run.a_b_new, run.rhs_b, a_e)
    for a in range(run.h_b.shape[0]):
        run.h_b[a] = 0.0
    for k in range(run.old.shape[0]):
        friction_misses(model, run, k)
        add_friction_impulse(model, run, k)
    share = clock.dt * clock.dt * clock.dt / 6.0
    for k in range(run.rhs_e.shape[0]):
        run.rhs_e[k] = share * model.omega2[k] * parts.modes[0, k] * a_e[k]
        run.h_e[k] = -c_m * run.rhs_e[k]
    copy(run.h_b, run.rhs_b)
    add_product(model.mass_eb, run.h_e, 1.0, run.rhs_b)
    give_way(model, run, parts, c_m, run.rhs_b, run.rhs_e)
    for a in range(run.rhs_b.shape[0]):
        run.g_b[a] = run.v_b_new[a] + 0.5 * run.rhs_b[a]
        run.v_b_new[a] += run.rhs_b[a]
    for k in range(run.rhs_e.shape[0]):
        v_e[k] = run.v_e_new[k] + 0.5 * run.rhs_e[k]
        run.v_e_new[k] += run.rhs_e[k]
        run.flow_v_new[k] += run.h_e[k]
        run.h_e[k] = run.flow_v_new[k] - 0.5 * run.h_e[k]
    set_resolved(model, run, parts, c_m, run.g_b, run.h_b, v_e)
    for k in range(run.old.shape[0]):
        owe_friction_work(model, run, k, c_m)
    lent = 0.0
    for k in range(v_e.shape[0]):
        middle = v_e[k] + 0.5 * clock.dt * a_e[k]
        lent += model.omega2[k] * middle * middle
    parts.work[4] = clock.dt * clock.dt * lent / 12.0
    return True


@inlined_by_llvm
def push_parts(run: IntegrationState, parts: NonlinearElements) -> None:
    """Add the change of speed in `add_missed_impulse` to the parts that depend on speed."""
    for i in range(parts.v_old.shape[0]):
        if parts.kind[parts.owner[i]] != HINGES:
            parts.v_old[i] += dot(parts.to_b[i], run.rhs_b) + dot(parts.to_e[i], run.rhs_e)
