"""Kernels of the time integration: one step of the generalised-alpha family, and the time loop.

Newmark's method is the member alpha_m = alpha_f = 0; Chung and Hulbert (1993) give the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined, kernel
from frames.kernel_data import MAX_LEVEL
from frames.kernels.coupling import coupled_load, eliminate_modes, times
from frames.kernels.ledger import add_bearing_energy, add_energy
from frames.kernels.stepping import commit_bearings, gather, newton
from lir_element.errors import RunStatus
from lir_element.kernels.levels import bearing_defect
from lir_element.kernels.pendulum.trial import copy_words
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from frames.kernel_data import Model, Output, Run, Setup
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats

_OK = int(RunStatus.OK)
_STEP_TOO_SMALL = int(RunStatus.STEP_TOO_SMALL)
_MAX_LEVEL = MAX_LEVEL
_LIMIT_LEVEL = 4  # halvings of a step before a limit of the bearing counts as exceeded


@inlined
def effective(settings: Setup, dt: float) -> tuple[float, float, float]:
    """Return the factors of mass, damping and stiffness in the effective stiffness of a step."""
    c_m = (1.0 - settings.alpha_m) / (settings.beta * dt * dt)
    c_c = (1.0 - settings.alpha_f) * settings.gamma / (settings.beta * dt)
    return c_m, c_c, 1.0 - settings.alpha_f


@kernel
def set_reduced_stiffness(model: Model, run: Run, settings: Setup, level: int, dt: float) -> None:
    """Set the effective stiffness of b with the modes eliminated, for this step size."""
    out = run.reduced[level]
    c_m, c_c, c_k = effective(settings, dt)
    n_b, n_e = model.mass_be.shape
    for a in range(n_b):
        for c in range(n_b):
            out[a, c] = (
                c_m * model.mass_b[a, c]
                + c_c * model.damping_b[a, c]
                + (c_k * model.stiffness_b[a, c])
            )
    if model.damping_ee.shape[0] > 0:
        eliminate_modes(
            model.mass_e, model.mass_eb, model.omega2, model.damping_e, model.damping_eb,
            model.damping_ee, c_m, c_c, c_k, run.inverse_e[level], run.follow_e[level], out,
        )  # fmt: skip
    else:
        for k in range(n_e):
            inv = c_m * c_m / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])
            for a in range(n_b):
                value = inv * model.mass_eb[k, a]
                for c in range(n_b):
                    out[a, c] -= value * model.mass_eb[k, c]
    run.has_reduced[level] = 1


@inlined
def set_load(
    model: Model,
    run: Run,
    settings: Setup,
    motion: Floats,
    motion_dt: float,
    time: float,
    dt: float,
    level: int,
) -> None:
    """Set the right-hand sides: loads at the scheme's instant less what is known of the step."""
    am, af, beta, gamma = settings.alpha_m, settings.alpha_f, settings.beta, settings.gamma
    known_v = (1.0 - am) / (beta * dt)
    known_a = (1.0 - am) * (0.5 / beta - 1.0) - am
    damp_v = (1.0 - af) * (1.0 - gamma / beta) + af
    damp_a = (1.0 - af) * dt * (1.0 - 0.5 * gamma / beta)
    for a in range(run.b.shape[0]):
        run.rhs_b[a] = model.load_b[a] - af * run.force_old[a]
        run.h_b[a] = known_v * run.v_b[a] + known_a * run.a_b[a]
        run.g_b[a] = damp_v * run.v_b[a] + damp_a * run.a_b[a]
    for k in range(run.e.shape[0]):
        run.h_e[k] = known_v * run.v_e[k] + known_a * run.a_e[k]
        run.rhs_e[k] = (
            model.load_e[k]
            + model.mass_e[k] * run.h_e[k]
            - model.damping_e[k] * (damp_v * run.v_e[k] + damp_a * run.a_e[k])
            - model.omega2[k] * run.e[k]
        )
    for axis in range(3):
        ground = (1.0 - af) * ground_acceleration(motion, motion_dt, time + dt, axis) + (
            af * ground_acceleration(motion, motion_dt, time, axis)
        )
        for a in range(run.b.shape[0]):
            run.rhs_b[a] -= model.inertia_b[a, axis] * ground
        for k in range(run.e.shape[0]):
            run.rhs_e[k] -= model.inertia_e[k, axis] * ground
    times(model.mass_b, run.h_b, 1.0, run.rhs_b)
    times(model.mass_be, run.h_e, 1.0, run.rhs_b)
    times(model.mass_eb, run.h_b, 1.0, run.rhs_e)
    times(model.damping_b, run.g_b, -1.0, run.rhs_b)
    times(model.stiffness_b, run.b, -1.0, run.rhs_b)
    # the modes, eliminated
    if model.damping_ee.shape[0] > 0:
        for k in range(run.e.shape[0]):
            run.g_e[k] = damp_v * run.v_e[k] + damp_a * run.a_e[k]
        coupled_load(
            model.damping_be, model.damping_eb, model.damping_ee, run.inverse_e[level],
            run.follow_e[level], run.g_b, run.g_e, run.rhs_b, run.rhs_e, run.h_e,
        )  # fmt: skip
        return
    c_m, c_c, c_k = effective(settings, dt)
    for k in range(run.e.shape[0]):
        run.h_e[k] = run.rhs_e[k] / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])
    times(model.mass_be, run.h_e, -c_m, run.rhs_b)


@inlined
def finish_step(model: Model, run: Run, settings: Setup, dt: float, level: int) -> None:
    """Set the new displacements, velocities and accelerations from ``run.step``."""
    beta, gamma = settings.beta, settings.gamma
    if model.damping_ee.shape[0] > 0:
        for k in range(run.e.shape[0]):
            run.g_e[k] = run.h_e[k]
        times(run.follow_e[level], run.step, -1.0, run.g_e)
    else:
        c_m, c_c, c_k = effective(settings, dt)
        for k in range(run.e.shape[0]):
            run.g_e[k] = run.rhs_e[k]
        times(model.mass_eb, run.step, -c_m, run.g_e)
        for k in range(run.e.shape[0]):
            run.g_e[k] /= c_m + c_c * model.damping_e[k] + c_k * model.omega2[k]
    for k in range(run.e.shape[0]):
        run.e_new[k] = run.e[k] + run.g_e[k]
        run.a_e_new[k] = (run.g_e[k] / dt - run.v_e[k]) / (beta * dt) - (
            0.5 / beta - 1.0
        ) * run.a_e[k]
        run.v_e_new[k] = run.v_e[k] + dt * ((1.0 - gamma) * run.a_e[k] + gamma * run.a_e_new[k])
    for a in range(run.b.shape[0]):
        run.b_new[a] = run.b[a] + run.step[a]
        run.a_b_new[a] = (run.step[a] / dt - run.v_b[a]) / (beta * dt) - (
            0.5 / beta - 1.0
        ) * run.a_b[a]
        run.v_b_new[a] = run.v_b[a] + dt * ((1.0 - gamma) * run.a_b[a] + gamma * run.a_b_new[a])


@inlined
def try_step(
    model: Model,
    run: Run,
    contacts: Contacts | None,
    settings: Setup,
    motion: Floats,
    motion_dt: float,
    time: float,
    dt: float,
    level: int,
) -> int:
    """Attempt one step; leaves it in the trial arrays. Returns a status code."""
    if run.has_reduced[level] == 0:
        set_reduced_stiffness(model, run, settings, level, dt)
    linear = run.reduced[level]
    set_load(model, run, settings, motion, motion_dt, time, dt, level)
    for a in range(run.b.shape[0]):
        run.step[a] = dt * run.mean_v_b[a]
    code = newton(
        model, run, contacts, linear, time + dt, 1.0 - settings.alpha_f, settings.force_tolerance,
        settings.max_iterations,
    )  # fmt: skip
    if code != _OK:
        return code
    finish_step(model, run, settings, dt, level)
    return _OK


@inlined
def estimated_error(model: Model, run: Run, dt: float) -> float:
    """Return the estimated error of the step in the bearings' horizontal displacement."""
    for a in range(run.b.shape[0]):
        run.h_b[a] = run.a_b_new[a] - run.a_b[a]
    largest = 0.0
    for k in range(model.props.shape[0]):
        gather(model, k, run.h_b, run.u)
        largest = max(largest, abs(run.u[6] - run.u[0]), abs(run.u[7] - run.u[1]))
    return dt * dt / 12.0 * largest


@inlined
def is_rough(model: Model, run: Run, contacts: Contacts | None, settings: Setup, dt: float) -> bool:
    """Return whether the step deserves to be halved, though it converged.

    Either its estimated error is too large, or contacts that open or close in it make or lose
    more energy than a share of what the run has moved so far.
    """
    defect = 0.0
    for k in range(run.old.shape[0]):
        defect += bearing_defect(model.props, run.old, run.new, contacts, k)
    scale = max(run.energy[2], abs(run.energy[0]), settings.energy_floor)
    if defect > settings.energy_tolerance * scale:
        return True
    return estimated_error(model, run, dt) > settings.error_tolerance


@inlined
def limits(run: Run) -> int:
    """Return the status of the bearings' limits in the trial state."""
    for k in range(run.new.shape[0]):
        if run.new[k].status != _OK:
            run.counters[3] = k
            return run.new[k].status
    return _OK


@inlined
def accept_step(
    model: Model, run: Run, contacts: Contacts | None, motion: Floats, motion_dt: float,
    time: float, dt: float,
) -> None:  # fmt: skip
    """Commit the step."""
    add_energy(model, run, motion, motion_dt, time, dt)
    commit_bearings(model, run, contacts)
    add_bearing_energy(run)
    for a in range(run.b.shape[0]):
        run.mean_v_b[a] = run.step[a] / dt
        run.b[a], run.v_b[a], run.a_b[a] = run.b_new[a], run.v_b_new[a], run.a_b_new[a]
    for k in range(run.e.shape[0]):
        run.e[k], run.v_e[k], run.a_e[k] = run.e_new[k], run.v_e_new[k], run.a_e_new[k]
    run.clock[0] = time + dt
    run.counters[0] += 1


@inlined
def record(run: Run, contacts: Contacts | None, out: Output, place: int) -> None:
    """Copy the committed state into the output arrays."""
    out.time[place] = run.clock[0]
    for a in range(run.b.shape[0]):
        out.b[place, a], out.v_b[place, a], out.a_b[place, a] = run.b[a], run.v_b[a], run.a_b[a]
    for k in range(run.e.shape[0]):
        out.e[place, k], out.a_e[place, k] = run.e[k], run.a_e[k]
    for k in range(run.old.shape[0]):
        copy_words(run.old_words[k], out.words[place, k])
    if contacts is not None:
        for k in range(contacts.bodies_old_words.shape[0]):
            copy_words(contacts.bodies_old_words[k], out.bodies[place, k])
    for term in range(run.energy.shape[0]):
        out.energy[place, term] = run.energy[term]


@kernel
def advance(
    model: Model,
    run: Run,
    contacts: Contacts | None,
    settings: Setup,
    motion: Floats,
    motion_dt: float,
    out: Output,
    first: int,
    last: int,
    every: int,
) -> int:
    """Integrate the base steps `first` to `last` (exclusive), recording each `every`-th.

    A step that fails, or whose estimated error is too large, is halved; after two good steps the
    step is doubled again where it fits. Returns a status code; ``run.clock[0]`` is the time
    reached; ``run.counters`` holds steps, iterations, halvings, the failed bearing, causes and
    the base steps completed.
    """
    level = int(run.clock[1])
    good = int(run.clock[2])
    ticks_a_step = 1 << _MAX_LEVEL
    for base in range(first, last):
        ticks = 0
        while ticks < ticks_a_step:
            parts = 1 << (_MAX_LEVEL - level)
            dt = settings.dt / (1 << level)
            time = settings.dt * (base + ticks / ticks_a_step)
            run.clock[0] = time
            code = try_step(model, run, contacts, settings, motion, motion_dt, time, dt, level)
            rough = code == _OK and level < _MAX_LEVEL // 2
            if rough:
                rough = is_rough(model, run, contacts, settings, dt)
            if code != _OK or rough:
                if level == _MAX_LEVEL:
                    run.counters[5] = code
                    return _STEP_TOO_SMALL
                level += 1
                good = 0
                run.counters[2] += 1
                continue
            code = limits(run)
            if code != _OK:  # not committed; a coarse step is refined before it counts
                if level >= _LIMIT_LEVEL:
                    run.clock[0] = time + dt
                    return code
                level += 1
                good = 0
                continue
            accept_step(model, run, contacts, motion, motion_dt, time, dt)
            ticks += parts
            good += 1
            if level > 0 and good >= 2 and ticks % (2 * parts) == 0:
                level -= 1
                good = 0
        run.clock[0] = settings.dt * (base + 1)
        run.counters[6] = base + 1
        if (base + 1) % every == 0:
            record(run, contacts, out, (base + 1) // every)
        run.clock[1], run.clock[2] = level, good
    return _OK
