"""Kernels of the ledger of energy: what a step puts in, and what takes it up.

All works are taken by the trapezoidal rule, with which Newmark's average acceleration conserves
energy; what another member of the family adds or takes is the term 'numerical'.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined
from frames.kernels.coupling import coupled_work
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from frames.kernel_data import Model, Run
    from lir_element.layout import Floats


@inlined
def quadratic(mass: Floats, coupling: Floats, own: Floats, x: Floats, y: Floats) -> float:
    """Return ``x' mass x + 2 x' coupling y + y' diag(own) y`` halved."""
    total = 0.0
    for a in range(x.shape[0]):
        part = 0.0
        for c in range(x.shape[0]):
            part += mass[a, c] * x[c]
        for k in range(y.shape[0]):
            part += 2.0 * coupling[a, k] * y[k]
        total += x[a] * part
    for k in range(y.shape[0]):
        total += own[k] * y[k] * y[k]
    return 0.5 * total


@inlined
def elastic_energy(model: Model, b: Floats, e: Floats) -> float:
    """Return the strain energy of the structure, geometric part included."""
    total = 0.0
    for a in range(b.shape[0]):
        part = 0.0
        for c in range(b.shape[0]):
            part += model.stiffness_b[a, c] * b[c]
        total += b[a] * part
    for k in range(e.shape[0]):
        total += model.omega2[k] * e[k] * e[k]
    return 0.5 * total


@inlined
def add_energy(
    model: Model, run: Run, motion: Floats, motion_dt: float, time: float, dt: float
) -> None:
    """Add the step's input, gravity, damping and numerical work; set kinetic and elastic.

    Works are taken by the trapezoidal rule. 'numerical' is the work of what the scheme leaves
    unbalanced at the ends of the step: nothing for Newmark's method but Newton's tolerance.
    Order of terms: frames.kernel_data.ENERGY_TERMS.
    """
    energy = run.energy
    supplied, lifted, damped, bearings = 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        ground = 0.5 * (
            ground_acceleration(motion, motion_dt, time + dt, axis)
            + ground_acceleration(motion, motion_dt, time, axis)
        )
        for a in range(run.b.shape[0]):
            supplied -= ground * model.inertia_b[a, axis] * run.step[a]
        for k in range(run.e.shape[0]):
            supplied -= ground * model.inertia_e[k, axis] * run.g_e[k]
    for a in range(run.b.shape[0]):
        lifted -= model.load_b[a] * run.step[a]
        bearings += 0.5 * (run.force_old[a] + run.force[a]) * run.step[a]
        for c in range(run.b.shape[0]):
            damped += 0.5 * run.step[a] * model.damping_b[a, c] * (run.v_b[c] + run.v_b_new[c])
    for k in range(run.e.shape[0]):
        lifted -= model.load_e[k] * run.g_e[k]
        damped += 0.5 * run.g_e[k] * model.damping_e[k] * (run.v_e[k] + run.v_e_new[k])
    if model.damping_ee.shape[0] > 0:
        damped += coupled_work(
            model.damping_be, model.damping_ee, run.step, run.g_e, run.v_b, run.v_b_new, run.v_e,
            run.v_e_new,
        )  # fmt: skip
    kinetic = quadratic(model.mass_b, model.mass_be, model.mass_e, run.v_b_new, run.v_e_new)
    elastic = elastic_energy(model, run.b_new, run.e_new) - run.clock[3]
    energy[0] += supplied
    energy[1] += lifted
    energy[12] += (
        supplied - lifted - damped - bearings - (kinetic - energy[2]) - (elastic - energy[3])
    )
    energy[2], energy[3] = kinetic, elastic
    energy[4] += damped


@inlined
def add_bearing_energy(run: Run) -> None:
    """Set the bearings' terms of the energy from their accumulated works."""
    for term in range(5, 12):
        run.energy[term] = 0.0
    for k in range(run.old.shape[0]):
        run.energy[5] += run.old[k].work_friction[0]
        run.energy[6] += run.old[k].work_friction[1]
        run.energy[7] += run.old[k].work_interface
        run.energy[8] += run.old[k].work_elastic
        run.energy[12] += run.old[k].work_step
        run.energy[9] += run.old[k].work_rim[0] + run.old[k].work_rim[1]
        run.energy[10] += run.old[k].work_contact
        run.energy[11] += run.old[k].work_sliders
