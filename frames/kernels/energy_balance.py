"""Kernels of the energy balance: input of a step, and its terms.

All works use the trapezoidal rule, with which Newmark's average acceleration conserves energy; the
gain or loss of another member of the family is the term 'numerical'.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm
from frames.kernels.coupling import coupled_work
from frames.kernels.nonlinear_works import part_energy_on
from lir_element.kernels.linear import dot, set_product
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import Ground, IntegrationState
    from lir_element.layout import Floats


@inlined_by_llvm
def kinetic_energy(
    model: ReducedModel, v_b: Floats, v_e: Floats, flow: Floats, momentum: Floats
) -> float:
    """Return the kinetic energy relative to the ground.

    `flow` (n_e,) is mass_eb v_b, `momentum` (n_b,) mass_b v_b.
    """
    total = dot(v_b, momentum)
    for k in range(v_e.shape[0]):
        total += v_e[k] * (model.mass_e[k] * v_e[k] + 2.0 * flow[k])
    return 0.5 * total


@inlined_by_llvm
def elastic_energy(model: ReducedModel, b: Floats, e: Floats, force: Floats) -> float:
    """Return the strain energy of the structure, geometric part included.

    `force` (n_b,) is stiffness_b b.
    """
    total = dot(b, force)
    for k in range(e.shape[0]):
        total += model.omega2[k] * e[k] * e[k]
    return 0.5 * total


@inlined_by_llvm
def damping_work(model: ReducedModel, run: IntegrationState) -> float:
    """Return the work of all damping of the structure over the step."""
    total = 0.0
    for k in range(run.e.shape[0]):
        mean = 0.5 * (run.v_e[k] + run.v_e_new[k])
        run.h_e[k] = mean
        total += run.g_e[k] * model.damping_e[k] * mean
    for a in range(run.b.shape[0]):
        run.h_b[a] = 0.5 * (run.v_b[a] + run.v_b_new[a])
    if model.damping_b.shape[0] > 0:
        if model.shared.shape[0] > 0:
            total += dot(run.step, run.flows[4])
        else:
            set_product(model.damping_b, run.h_b, run.g_b)
            total += dot(run.step, run.g_b)
    if model.damping_ee.shape[0] > 0:
        total += coupled_work(
            model.damping_be,
            model.damping_eb,
            model.damping_ee,
            run.step,
            run.g_e,
            run.h_b,
            run.h_e,
            run.g_b,
            run.rhs_e,
        )
    return total


@inlined_by_llvm
def add_energy(
    model: ReducedModel, run: IntegrationState, parts: NonlinearElements | None, ground: Ground
) -> None:
    """Add the step's input, gravity, damping and numerical work; set kinetic and elastic.

    Works use the trapezoidal rule. 'numerical' is the work of the forces that the scheme leaves
    unbalanced at the ends of the step: zero for Newmark's method but Newton's tolerance.
    """
    energy, clock = run.energy[0], run.clock[0]
    supplied, lifted, bearings = 0.0, 0.0, 0.0
    for axis in range(3):
        mean = 0.5 * (
            ground_acceleration(ground.acceleration, ground.dt, clock.time + clock.dt, axis)
            + ground_acceleration(ground.acceleration, ground.dt, clock.time, axis)
        )
        for a in range(run.b.shape[0]):
            supplied -= mean * model.inertia_b[a, axis] * run.step[a]
        for k in range(run.e.shape[0]):
            supplied -= mean * model.inertia_e[k, axis] * run.g_e[k]
    for a in range(run.b.shape[0]):
        lifted -= model.load_b[a] * run.step[a]
        bearings += 0.5 * (run.force_old[a] + run.force[a]) * run.step[a]
    for k in range(run.e.shape[0]):
        lifted -= model.load_e[k] * run.g_e[k]
    damped = damping_work(model, run)
    before = energy.elastic
    if parts is not None:  # add_part_energy adds the nonlinear part of the elastic energy
        before -= part_store(parts)
        given = part_energy_on(parts.load_b, parts, parts.to_b, run.step)
        given += part_energy_on(parts.load_e, parts, parts.to_e, run.g_e)
        parts.work[3] += given
        bearings += given
    momentum = run.flows[0] if model.shared.shape[0] > 0 else run.h_b
    if model.shared.shape[0] == 0:
        set_product(model.mass_b, run.v_b_new, momentum)
        set_product(model.stiffness_b, run.b_new, run.held)
    kinetic = kinetic_energy(model, run.v_b_new, run.v_e_new, run.flow_v_new, momentum)
    elastic = elastic_energy(model, run.b_new, run.e_new, run.held) - clock.elastic_start
    energy.input += supplied
    energy.gravity += lifted
    energy.damping += damped
    stored = kinetic - energy.kinetic + elastic - before
    energy.numerical += supplied - lifted - damped - bearings - stored
    energy.kinetic, energy.elastic = kinetic, elastic


@inlined_by_llvm
def add_bearing_energy(run: IntegrationState) -> None:
    """Set the bearings' terms of the energy from their accumulated works.

    The energy stored by friction counts from the state at rest, which gravity may have loaded.
    """
    energy = run.energy[0]
    energy.low_friction_bottom, energy.low_friction_top, energy.high_friction = 0.0, 0.0, 0.0
    energy.friction_elastic = -run.store_at_rest[0]
    energy.rims, energy.contact, energy.sliders = 0.0, 0.0, 0.0
    for k in range(run.old.shape[0]):
        old = run.old[k]
        energy.low_friction_bottom += old.work_friction[0]
        energy.low_friction_top += old.work_friction[1]
        energy.high_friction += old.work_interface
        energy.friction_elastic += old.work_elastic
        energy.numerical += old.work_step
        energy.rims += old.work_rim[0] + old.work_rim[1]
        energy.contact += old.work_contact
        energy.sliders += old.work_sliders


@inlined_by_llvm
def part_store(parts: NonlinearElements) -> float:
    """Return the parts' stored energy beyond the linear structure's: given less dissipated.

    Without the loan of `add_missed_impulse`: springs hold less in the middle of a step than at its
    ends.
    """
    work = parts.work
    return float(work[3] - work[0] - work[1] - work[2] - work[4])


@inlined_by_llvm
def add_part_energy(run: IntegrationState, parts: NonlinearElements) -> None:
    """Set the nonlinear parts' terms of the energy, and make the elastic one that of the truth."""
    energy = run.energy[0]
    energy.yielding, energy.dampers, energy.stops = parts.work[0], parts.work[1], parts.work[2]
    energy.elastic += part_store(parts)
