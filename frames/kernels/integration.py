"""Kernels of the time integration: one step of the generalised-alpha family, and the time loop.

Newmark's method is the member alpha_m = alpha_f = 0; Chung and Hulbert (1993) give the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined_before_typing, inlined_by_llvm, kernel
from frames.bundles.run_data import MOST_HALVINGS
from frames.kernels.coupling import coupled_load, eliminate_modes
from frames.kernels.effective import effective, rates_after
from frames.kernels.energy_balance import add_bearing_energy, add_energy, add_part_energy
from frames.kernels.failures import ends_run, lose_bearing
from frames.kernels.missed_impulse import add_missed_impulse, push_parts
from frames.kernels.nonlinear_works import commit_parts
from frames.kernels.part_states import set_part_follow
from frames.kernels.shared_tangent import carry_products
from frames.kernels.step_error import is_rough, keep_motion
from frames.kernels.stepping import commit_bearings, newton, predict, solve_gravity
from frames.kernels.yielding import begin_parts, has_yielded, part_load_on_modes
from lir_element.errors import RunStatus
from lir_element.kernels.contact.slider_motion import shake_sliders
from lir_element.kernels.levels import begin_trials
from lir_element.kernels.linear import add_product, copy_words, set_product, subtract_squares
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import Ground, IntegrationState, IntegratorSettings, Output
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats

_OK = int(RunStatus.OK)
_STEP_TOO_SMALL = int(RunStatus.STEP_TOO_SMALL)
_MOST_HALVINGS = MOST_HALVINGS
_TICKS = 1 << MOST_HALVINGS  # parts of a base step
_CALM = 0.25  # share of the allowed error below which twice the step is tried: it grows by dt^2
_CARRIED = 64  # steps, after which products that are carried on have gathered some 1e-11
_LIMIT_HALVINGS = 4  # of a step before a limit of the bearing counts as exceeded


@kernel
def set_reduced_stiffness(
    model: ReducedModel, run: IntegrationState, settings: IntegratorSettings
) -> None:
    """Set the effective stiffness of b with the modes eliminated, for the present step size."""
    at = run.clock[0].halvings
    out = run.reduced[at]
    c_m, c_c, c_k = effective(settings, run.clock[0].dt)
    n_b, n_e = model.mass_be.shape
    for a in range(n_b):
        for c in range(n_b):
            out[a, c] = c_m * model.mass_b[a, c] + (c_k * model.stiffness_b[a, c])
            if model.damping_b.shape[0] > 0:
                out[a, c] += c_c * model.damping_b[a, c]
    if model.damping_ee.shape[0] > 0:
        eliminate_modes(
            model.mass_e,
            model.mass_eb,
            model.omega2,
            model.damping_e,
            model.damping_eb,
            model.damping_ee,
            c_m,
            c_c,
            c_k,
            run.inverse_e[at],
            run.follow_e[at],
            run.lead_e[at],
            out,
        )
    else:
        for k in range(n_e):
            run.g_e[k] = c_m * c_m / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])
        subtract_squares(model.mass_eb, run.g_e, out)
    run.has_reduced[at] = 1


@kernel
def renew_products(model: ReducedModel, run: IntegrationState) -> None:
    """Set the products carried from step to step from the committed state."""
    set_product(model.stiffness_b, run.b, run.held)
    set_product(model.mass_be, run.v_b, run.flow_v)
    set_product(model.mass_be, run.a_b, run.flow_a)
    if model.shared.shape[0] > 0:
        set_product(model.mass_b, run.v_b, run.flows[0])
        set_product(model.mass_b, run.a_b, run.flows[1])
        if model.damping_b.shape[0] > 0:
            set_product(model.damping_b, run.v_b, run.flows[2])
            set_product(model.damping_b, run.a_b, run.flows[3])


@inlined_before_typing
def set_load(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> None:
    """Set the right-hand sides: loads at the scheme's instant less the known part of the step."""
    time, dt, at = run.clock[0].time, run.clock[0].dt, run.clock[0].halvings
    am, af, beta, gamma = settings.alpha_m, settings.alpha_f, settings.beta, settings.gamma
    known_v = (1.0 - am) / (beta * dt)
    known_a = (1.0 - am) * (0.5 / beta - 1.0) - am
    damp_v = (1.0 - af) * (1.0 - gamma / beta) + af
    damp_a = (1.0 - af) * dt * (1.0 - 0.5 * gamma / beta)
    if run.counts[0].steps % _CARRIED == 0:
        renew_products(model, run)
    for a in range(run.b.shape[0]):
        run.rhs_b[a] = model.load_b[a] - af * run.force_old[a] - run.held[a]
        run.h_b[a] = known_v * run.v_b[a] + known_a * run.a_b[a]
        run.g_b[a] = damp_v * run.v_b[a] + damp_a * run.a_b[a]
    for k in range(run.e.shape[0]):
        run.h_e[k] = known_v * run.v_e[k] + known_a * run.a_e[k]
        run.rhs_e[k] = (
            model.load_e[k]
            + model.mass_e[k] * run.h_e[k]
            - model.damping_e[k] * (damp_v * run.v_e[k] + damp_a * run.a_e[k])
            - model.omega2[k] * run.e[k]
            + (known_v * run.flow_v[k] + known_a * run.flow_a[k])
        )
    if parts is not None:
        for a in range(run.b.shape[0]):
            run.rhs_b[a] -= parts.load_b[a]
        for k in range(run.e.shape[0]):
            run.rhs_e[k] -= parts.load_e[k]
    for axis in range(3):
        pull = (1.0 - af) * ground_acceleration(
            ground.acceleration, ground.dt, time + dt, axis
        ) + af * ground_acceleration(ground.acceleration, ground.dt, time, axis)
        for a in range(run.b.shape[0]):
            run.rhs_b[a] -= model.inertia_b[a, axis] * pull
        for k in range(run.e.shape[0]):
            run.rhs_e[k] -= model.inertia_e[k, axis] * pull
    if model.shared.shape[0] > 0:
        for a in range(run.b.shape[0]):
            run.rhs_b[a] += known_v * run.flows[0, a] + known_a * run.flows[1, a]
            run.rhs_b[a] -= damp_v * run.flows[2, a] + damp_a * run.flows[3, a]
    else:
        add_product(model.mass_b, run.h_b, 1.0, run.rhs_b)
        if model.damping_b.shape[0] > 0:
            add_product(model.damping_b, run.g_b, -1.0, run.rhs_b)
    # the modes, eliminated
    if model.damping_ee.shape[0] > 0:
        add_product(model.mass_eb, run.h_e, 1.0, run.rhs_b)
        for k in range(run.e.shape[0]):
            run.g_e[k] = damp_v * run.v_e[k] + damp_a * run.a_e[k]
        coupled_load(
            model.damping_be,
            model.damping_eb,
            model.damping_ee,
            run.inverse_e[at],
            run.follow_e[at],
            run.g_b,
            run.g_e,
            run.rhs_b,
            run.rhs_e,
            run.h_e,
        )
        return
    c_m, c_c, c_k = effective(settings, dt)
    for k in range(run.e.shape[0]):
        free = run.rhs_e[k] / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])
        run.g_e[k] = run.h_e[k] - c_m * free
        run.h_e[k] = free
    add_product(model.mass_eb, run.g_e, 1.0, run.rhs_b)


@inlined_before_typing
def finish_step(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
) -> None:
    """Set the new displacements, velocities and accelerations from ``run.step``."""
    dt, at = run.clock[0].dt, run.clock[0].halvings
    beta, gamma = settings.beta, settings.gamma
    set_product(model.mass_be, run.step, run.flow_v_new)
    if model.damping_ee.shape[0] > 0:
        for k in range(run.e.shape[0]):
            run.g_e[k] = run.h_e[k]
        add_product(run.lead_e[at], run.step, -1.0, run.g_e)
        if parts is not None:
            for k in range(run.e.shape[0]):
                run.e_new[k] = 0.0
            part_load_on_modes(parts, run.e_new)
            add_product(run.inverse_e[at], run.e_new, 1.0, run.g_e)
    else:
        c_m, c_c, c_k = effective(settings, dt)
        for k in range(run.e.shape[0]):
            run.g_e[k] = run.rhs_e[k] - c_m * run.flow_v_new[k]
        if parts is not None:
            part_load_on_modes(parts, run.g_e)
        for k in range(run.e.shape[0]):
            run.g_e[k] /= c_m + c_c * model.damping_e[k] + c_k * model.omega2[k]
    for k in range(run.e.shape[0]):
        run.e_new[k] = run.e[k] + run.g_e[k]
        run.v_e_new[k], run.a_e_new[k] = rates_after(
            run.g_e[k], run.v_e[k], run.a_e[k], dt, beta, gamma
        )
        run.flow_v_new[k], run.flow_a_new[k] = rates_after(
            run.flow_v_new[k], run.flow_v[k], run.flow_a[k], dt, beta, gamma
        )
    for a in range(run.b.shape[0]):
        run.b_new[a] = run.b[a] + run.step[a]
        run.v_b_new[a], run.a_b_new[a] = rates_after(
            run.step[a], run.v_b[a], run.a_b[a], dt, beta, gamma
        )


@inlined_before_typing
def try_step(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> int:
    """Attempt a step of ``clock.dt``; leaves it in the trial arrays. Returns a status code."""
    clock = run.clock[0]
    if run.has_reduced[clock.halvings] == 0:
        set_reduced_stiffness(model, run, settings)
        if parts is not None:
            set_part_follow(model, run, parts, settings)
    set_load(model, run, parts, settings, ground)
    if contacts is not None:
        shake_sliders(contacts.scratch, ground.acceleration, ground.dt, clock.time + clock.dt)
    begin_trials(contacts)
    for a in range(run.b.shape[0]):
        run.step[a] = clock.dt * run.mean_v_b[a]
    foreseen = clock.kept == clock.halvings + 1 and clock.dt_before > 0.0
    if parts is not None:
        foreseen = foreseen and (parts.counts[0].active == 0 or has_yielded(parts))
        begin_parts(model, run, parts, settings)
    if foreseen:
        predict(model, run, parts, run.reduced[clock.halvings], 1.0 - settings.alpha_f)
    else:
        clock.guessed = -1
    if not foreseen and model.shared.shape[0] > 0:
        set_product(run.reduced[clock.halvings], run.step, run.linear_step)
    code = newton(
        model,
        run,
        contacts,
        parts,
        run.reduced[clock.halvings],
        1.0 - settings.alpha_f,
        settings.force_tolerance,
        settings.max_iterations,
        settings.tangent_worth,
        settings.shared_worth,
    )
    if code == _OK:
        finish_step(model, run, parts, settings)
    return code


@inlined_before_typing
def limits(run: IntegrationState) -> int:
    """Return the status of the bearings' limits in the trial state."""
    for k in range(run.new.shape[0]):
        if run.new[k].status != _OK:
            run.counts[0].bearing = k
            return run.new[k].status
    return _OK


@inlined_before_typing
def accept_step(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> None:
    """Commit the step."""
    clock = run.clock[0]
    if model.shared.shape[0] > 0:
        carry_products(
            model.mass_b,
            model.damping_b,
            model.stiffness_b,
            run.step,
            1.0 / (settings.beta * clock.dt),
            0.5 / settings.beta - 1.0,
            clock.dt,
            settings.gamma,
            run.flows,
            run.held,
        )
    pushed = False
    if parts is not None:
        pushed = settings.corrects == 1 and add_missed_impulse(model, run, parts, settings)
    add_energy(model, run, parts, ground)
    keep_motion(model, run, settings, ground)
    commit_bearings(model, run, contacts)
    add_bearing_energy(run)
    if parts is not None:
        commit_parts(parts, settings.beta, settings.gamma, clock.dt)
        if pushed:
            push_parts(run, parts)
        add_part_energy(run, parts)
    clock.guessed += 1
    clock.equal = clock.equal + 1 if clock.dt == clock.dt_before else 0
    for a in range(run.b.shape[0]):
        run.mean_v_before[a] = run.mean_v_b[a]
        run.mean_v_b[a] = run.step[a] / clock.dt
        run.missed[1, a], run.missed[0, a] = run.missed[0, a], run.step[a] - run.missed[2, a]
        run.b[a], run.v_b[a], run.a_b[a] = run.b_new[a], run.v_b_new[a], run.a_b_new[a]
    for a in range(run.linear_step.shape[0]):
        run.linear_before[1, a] = run.linear_before[0, a]
        run.linear_before[0, a] = run.linear_step[a]
        run.missed_linear[0, a] = run.linear_step[a] - run.missed_linear[2, a]
    for k in range(run.e.shape[0]):
        run.e[k], run.v_e[k], run.a_e[k] = run.e_new[k], run.v_e_new[k], run.a_e_new[k]
        run.flow_v[k], run.flow_a[k] = run.flow_v_new[k], run.flow_a_new[k]
    clock.time += clock.dt
    clock.dt_before = clock.dt
    run.counts[0].steps += 1


@kernel
def balanced_rates(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements | None,
    ground: Ground,
    a_b: Floats,
    a_e: Floats,
) -> None:
    """Set the accelerations that balance all forces of the committed state."""
    n_b, n_e = run.b.shape[0], run.e.shape[0]
    for a in range(n_b):
        run.h_b[a] = model.load_b[a] - run.force_old[a] - run.held[a]
        a_b[a] = 0.0
    for k in range(n_e):
        a_e[k] = model.load_e[k] - model.damping_e[k] * run.v_e[k] - model.omega2[k] * run.e[k]
    if parts is not None:
        for a in range(n_b):
            run.h_b[a] -= parts.load_b[a]
        for k in range(n_e):
            a_e[k] -= parts.load_e[k]
    if model.damping_ee.shape[0] > 0:
        add_product(model.damping_ee, run.v_e, -1.0, a_e)
        add_product(model.damping_be, run.v_b, -1.0, a_e)
        add_product(model.damping_eb, run.v_e, -1.0, run.h_b)
    for axis in range(3):
        pull = ground_acceleration(ground.acceleration, ground.dt, run.clock[0].time, axis)
        for a in range(n_b):
            run.h_b[a] -= model.inertia_b[a, axis] * pull
        for k in range(n_e):
            a_e[k] -= model.inertia_e[k, axis] * pull
    for k in range(n_e):
        a_e[k] *= model.mass_e[k]
    if model.damping_b.shape[0] > 0:
        add_product(model.damping_b, run.v_b, -1.0, run.h_b)
    add_product(model.mass_eb, a_e, -1.0, run.h_b)
    add_product(run.balance, run.h_b, 1.0, a_b)
    set_product(model.mass_be, a_b, run.h_e)
    for k in range(n_e):
        a_e[k] -= run.h_e[k]


@inlined_by_llvm
def record(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    ground: Ground,
    out: Output,
    place: int,
) -> None:
    """Copy the committed state into the output arrays.

    A scheme that balances forces between the ends of its steps has accelerations that are no
    state's: then those are recorded that balance the forces recorded with them.
    """
    out.time[place] = run.clock[0].time
    for a in range(run.b.shape[0]):
        out.b[place, a], out.v_b[place, a], out.a_b[place, a] = run.b[a], run.v_b[a], run.a_b[a]
    for k in range(run.e.shape[0]):
        out.e[place, k], out.a_e[place, k] = run.e[k], run.a_e[k]
    if run.balanced[0] == 1:
        balanced_rates(model, run, parts, ground, out.a_b[place], out.a_e[place])
    for k in range(run.old.shape[0]):
        copy_words(run.old_words[k], out.words[place, k])
    if contacts is not None:
        for k in range(contacts.bodies_old_words.shape[0]):
            copy_words(contacts.bodies_old_words[k], out.bodies[place, k])
    for term in range(run.energy_row.shape[0]):
        out.energy[place, term] = run.energy_row[term]
    if parts is not None:
        for i in range(parts.d_old.shape[0]):
            out.deformation[place, i] = parts.d_old[i]
            out.beyond[place, i] = parts.g_old[i]
        for k in range(parts.old.shape[0]):
            for n in range(parts.old.shape[1]):
                out.part_state[place, k, n] = parts.old[k, n]


@inlined_before_typing
def halve(run: IntegrationState) -> None:
    """Halve the step that is being tried."""
    run.clock[0].halvings += 1
    run.clock[0].good = 0
    run.counts[0].halvings += 1


@inlined_before_typing
def try_substep(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
) -> int:
    """Try one step: commit it, or halve it for the next attempt. Returns a status code.

    A step that fails, or whose estimated error is too large, is halved; after two good steps the
    step is doubled again if it fits.
    """
    clock = run.clock[0]
    if clock.halvings < settings.least_halvings:
        clock.halvings = settings.least_halvings
    ticks = 1 << (_MOST_HALVINGS - clock.halvings)
    clock.dt = settings.dt / (1 << clock.halvings)
    clock.time = settings.dt * (clock.done + clock.ticks / _TICKS)
    code = try_step(model, run, contacts, parts, settings, ground)
    rough = code == _OK and clock.halvings < _MOST_HALVINGS // 2
    clock.share = 0.0
    if rough:
        rough = is_rough(model, run, contacts, parts, settings, ground)
    if code != _OK or rough:
        if clock.halvings == _MOST_HALVINGS:
            run.counts[0].cause = code
            at = run.counts[0].bearing
            if lose_bearing(model.props, run.old, run.old_words, run.new_words, code, at):
                clock.kept = 0
                return _OK
            return _STEP_TOO_SMALL
        halve(run)
        return _OK
    code = limits(run)
    if code != _OK:  # not committed; a coarse step is refined before it counts
        if clock.halvings >= _LIMIT_HALVINGS:
            at = ends_run(model.props, run.new)
            if at >= 0:
                run.counts[0].bearing = at
                clock.time += clock.dt
                return run.new[at].status
        else:
            halve(run)
            return _OK
    accept_step(model, run, contacts, parts, settings, ground)
    if code != _OK:
        clock.kept = 0
    clock.ticks += ticks
    clock.good += 1
    calm = clock.good >= 2 and clock.share < _CALM
    if clock.halvings > settings.least_halvings and calm and clock.ticks % (2 * ticks) == 0:
        clock.halvings -= 1
        clock.good = 0
    return _OK


@kernel
def integrate_chunk(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    settings: IntegratorSettings,
    ground: Ground,
    out: Output,
    last: int,
    trials: int,
) -> int:
    """Integrate until `last` base steps are done, or `trials` state determinations are used.

    Records each base step, `settings.first` in the first row, and the present one if no trials are
    given. Returns a status code; ``run.clock`` and ``run.counts`` have the progress, and the next
    call continues from there. If `last` is negative, finds the state at rest: one kernel for both,
    because each alone contains the state determination of the bearings.
    """
    if last < 0:
        return solve_gravity(
            model, run, contacts, settings.force_tolerance, settings.max_iterations
        )
    clock, counts = run.clock[0], run.counts[0]
    most = counts.trials + trials
    is_new = trials == 0
    while True:
        if is_new:
            record(model, run, contacts, parts, ground, out, clock.done - settings.first)
        if clock.done >= last or counts.trials >= most:
            return _OK
        code = try_substep(model, run, contacts, parts, settings, ground)
        if code != _OK:
            return code
        is_new = clock.ticks == _TICKS
        if is_new:
            clock.done += 1
            clock.ticks = 0
            clock.time = settings.dt * clock.done
