"""Kernels of the equilibrium: bearing forces in frame coordinates, Newton's method, gravity.

The frame's unknowns are b (bearing coordinates) and eta (fixed-interface modes). The modes enter
linearly, so Newton's method runs over b alone: `reduced` is the linear effective stiffness of b
after the modes were eliminated, which depends on the step size only.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_before_typing, inlined_by_llvm, kernel
from frames.kernels.shared_tangent import (
    add_element_to_blocks,
    factorise_blocks,
    goes_on_missing,
    keep_secant,
    linear_part_of_correction,
    set_linear_blocks,
    substitute_blocks,
    with_secants,
)
from frames.kernels.yielding import (
    add_part_forces,
    add_part_tangent,
    foresee_part_forces,
    has_yielded,
    settle_parts,
)
from lir_element.errors import RunStatus
from lir_element.kernels.levels import bearing_commit, bearing_tangent, bearing_trial
from lir_element.kernels.linear import (
    add_product,
    copy,
    factorise,
    gather,
    scatter,
    set_product,
    substitute,
)
from lir_element.kernels.pendulum.trial import has_no_state

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats

_OK = int(RunStatus.OK)
_NEWTON_FAILED = int(RunStatus.NEWTON_FAILED)
_SINGULAR = int(RunStatus.SINGULAR)
_SHORTER = 0.4  # of a step that does not do: between 1/10 and 1/2 (Dennis and Schnabel 1983, 6.3.2)
_TRIES = 6  # of a step: the last one, 0.4^5 or 1 % of it, is accepted (a choice)
_PATIENCE = 3  # tries: then a residual that rises a little does, past a corner of a law (a choice)
_RISE = 2.0  # of the residual that is little (a choice)
_RETRIED = 0.8  # of a kept tangent's fall of the residual, a step without: so it is tried again
_GUESS, _REST, _BACK, _CORRECTED = range(4)  # vectors of Newton's method
_KEPT, _SHARED, _WHOLE = range(3)  # renewed part of the tangent
_TAKE, _SHORTEN, _LEAVE = range(3)  # treatment of a corrected step
_GRAVITY_WORTH = 3.0  # iterations that save a tangent of all coordinates under permanent loads


@inlined_by_llvm
def bearing_forces(
    model: ReducedModel, run: IntegrationState, contacts: Contacts | None, b: Floats
) -> int:
    """Run all bearings at `b`; set `run.force`. Returns a status code (limits included).

    Velocities affect a bearing in static steps alone, in which they are zero: `run.v`.
    """
    n_b = b.shape[0]
    time = run.clock[0].time + run.clock[0].dt
    run.counts[0].trials += 1
    for a in range(n_b):
        run.force[a] = 0.0
    worst = _OK
    for k in range(model.props.shape[0]):
        gather(model.start[k], model.columns, model.values, b, run.u)
        code = bearing_trial(
            model.props, run.old, run.new, run.work, contacts, k, run.u, run.v, time
        )
        if code != _OK:
            worst = code
            run.counts[0].bearing = k
            if has_no_state(code):
                return code
        force = run.new[k].force
        scatter(model.start[k], model.columns, model.values, 1.0, force, run.force)
    return worst


@inlined_before_typing
def bearing_tangents(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    factor: float,
    whole: bool,
) -> None:
    """Add `factor` times the bearings' tangents at the last trial, transposed, to the tangent."""
    for k in range(model.props.shape[0]):
        element = run.element_k[k]
        bearing_tangent(model.props, run.new, run.work, contacts, k, element)
        if model.shared.shape[0] > 0:
            add_element_to_blocks(
                model.start[k],
                model.columns,
                model.values,
                element,
                factor,
                model.place,
                whole,
                run.tangent,
                run.across,
                run.below,
                run.corner,
            )
            continue
        for row in range(12):
            for i in range(model.start[k, row], model.start[k, row + 1]):
                for col in range(12):
                    value = factor * model.values[i] * element[row, col]
                    for j in range(model.start[k, col], model.start[k, col + 1]):
                        run.tangent[model.columns[j], model.columns[i]] += value * model.values[j]


@kernel
def norm(x: Floats) -> float:
    """Return the Euclidean norm; infinite if an entry is not finite.

    It is the same from all sides: Newton's method takes the same steps however a model is turned
    about the vertical. The largest entry would not be, and a step that converges from one side
    would be halved from another.
    """
    total = 0.0
    for a in range(x.shape[0]):
        if not math.isfinite(x[a]):
            return math.inf
        total += x[a] * x[a]
    return math.sqrt(total)


@inlined_by_llvm
def set_residual(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    linear: Floats,
    step: Floats,
    share: float,
) -> float:
    """Set displacement, bearing forces and residual of the trial ``b + step``; return its size.

    residual = rhs - linear step - share force; infinite if bearings or nonlinear parts of the
    structure have no state. With many bearings `run.linear_trial` is linear step.
    """
    n_b = step.shape[0]
    for a in range(n_b):
        run.trial_b[a] = run.b[a] + step[a]
    code = bearing_forces(model, run, contacts, run.trial_b)
    run.counts[0].code = code
    if has_no_state(code):
        return math.inf
    for a in range(n_b):
        run.residual[a] = run.rhs_b[a] - share * run.force[a]
    if model.shared.shape[0] > 0:
        for a in range(n_b):
            run.residual[a] -= run.linear_trial[a]
    else:
        add_product(linear, step, -1.0, run.residual)
    if parts is not None:
        if not settle_parts(model, run, parts, step):
            return math.inf
        add_part_forces(run, parts, run.residual)
    return norm(run.residual)


@inlined_by_llvm
def solve_tangent(model: ReducedModel, run: IntegrationState, share: float, x: Floats) -> None:
    """Solve for the right-hand side `x` (n_b,) in place, with the tangent of many bearings.

    `run.linear_change`, which contains the right-hand side too, becomes the linear structure's
    part.
    """
    substitute_blocks(
        run.tangent,
        run.order,
        run.across,
        run.below,
        run.corner,
        run.corner_order,
        model.at,
        run.sorted_b,
        x,
    )
    linear_part_of_correction(
        model.start,
        model.columns,
        model.values,
        run.element_k,
        run.element_whole,
        share,
        model.place,
        run.tangent.shape[0],
        x,
        run.of_nodes,
        run.linear_change,
    )


@inlined_by_llvm
def correct(model: ReducedModel, run: IntegrationState, share: float, x: Floats) -> None:
    """Make of a residual `x` (n_b,) Newton's correction, with the present tangent and secants."""
    if model.shared.shape[0] == 0:
        substitute(run.tangent, run.order, x)
    else:
        copy(x, run.linear_change)
        solve_tangent(model, run, share, x)
    with_secants(
        run.weights,
        run.corrections,
        run.corrections_next,
        run.corrections_linear,
        run.corrections_size,
        run.clock[0].secants,
        x,
        run.linear_change,
    )


@inlined_by_llvm
def predict(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements | None,
    linear: Floats,
    share: float,
) -> None:
    """Set a guess of ``run.step`` without a state determination.

    One iteration with the kept tangent, as if displacements and forces of the bearings continued as
    in the last steps, quadratically after three equal ones. It is exact for linear bearings, with
    any ringing, and the horizontal motion is that of a mass under a known force. If the errors of
    the last two guesses agree, this one is corrected by them.
    """
    clock = run.clock[0]
    n_b = run.step.shape[0]
    ratio = clock.dt / clock.dt_before
    bent = 1.0 if clock.equal >= 2 and ratio == 1.0 else 0.0
    for a in range(n_b):
        turn = bent * (run.mean_v_b[a] - run.mean_v_before[a])
        run.step[a] = clock.dt * (run.mean_v_b[a] + turn)
        gain = run.force_old[a] - run.force_before[0, a]
        turn = bent * (gain - (run.force_before[0, a] - run.force_before[1, a]))
        run.residual[a] = run.rhs_b[a] - share * (run.force_old[a] + ratio * gain + turn)
    if model.shared.shape[0] == 0:
        add_product(linear, run.step, -1.0, run.residual)
    else:
        if ratio == 1.0:
            for a in range(n_b):
                turn = bent * (run.linear_before[0, a] - run.linear_before[1, a])
                run.linear_step[a] = run.linear_before[0, a] + turn
        else:
            set_product(linear, run.step, run.linear_step)
        for a in range(n_b):
            run.residual[a] -= run.linear_step[a]
    if parts is not None:
        foresee_part_forces(run, parts, ratio, run.residual)
    correct(model, run, share, run.residual)
    lasts = min(clock.guessed, clock.equal) >= 2 and ratio == 1.0
    again = 1.0 if lasts and goes_on_missing(run.weights, run.missed) else 0.0
    for a in range(n_b):
        run.missed[2, a] = run.step[a] + run.residual[a]
        run.step[a] = run.missed[2, a] + again * run.missed[0, a]
    for a in range(run.linear_step.shape[0]):
        run.missed_linear[2, a] = run.linear_step[a] + run.linear_change[a]
        run.linear_step[a] = run.missed_linear[2, a] + again * run.missed_linear[0, a]


@inlined_before_typing
def renew_tangent(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    linear: Floats,
    share: float,
    whole: bool,
) -> bool:
    """Set and factorise the tangent at the last trial; returns False if it is singular.

    Unless `whole`, only the part of the coordinates that many bearings share is renewed.
    """
    n_b = run.step.shape[0]
    if model.shared.shape[0] > 0:
        set_linear_blocks(linear, model.at, whole, run.tangent, run.across, run.below, run.corner)
    else:
        for a in range(n_b):
            for c in range(n_b):
                run.tangent[a, c] = linear[a, c]
    if whole:
        for a in range(n_b):
            run.weights[a] = abs(linear[a, a])
    bearing_tangents(model, run, contacts, share, whole)
    if model.shared.shape[0] > 0:
        if whole:
            for k in range(run.element_k.shape[0]):
                for a in range(12):
                    copy(run.element_k[k, a], run.element_whole[k, a])
        run.counts[0].shared_tangents += 1 - int(whole)
        run.counts[0].tangents += int(whole)
        return factorise_blocks(
            whole, run.tangent, run.order, run.across, run.below, run.corner, run.corner_order
        )
    run.counts[0].tangents += 1
    if parts is not None and not add_part_tangent(model, run, parts):
        return False
    return factorise(run.tangent, run.order)


@inlined_by_llvm
def set_trial(run: IntegrationState, corrected: bool, factor: float) -> None:
    """Set the step that is tried: `run.step`, or `run.g_b` with a share of the correction."""
    if corrected:
        for a in range(run.step.shape[0]):
            run.g_b[a] = run.step[a] + factor * run.h_b[a]
    for a in range(run.linear_step.shape[0]):
        change = factor * run.linear_change[a] if corrected else 0.0
        run.linear_trial[a] = run.linear_step[a] + change


@kernel
def judge_correction(new: float, size: float, need: int, tries: int) -> int:
    """Return whether to take a corrected step of residual `new`, before it `size`.

    A step of a new tangent that does not reduce the residual is shortened; one of a kept tangent is
    left for one of a newer tangent.
    """
    good = new < size or (tries > _PATIENCE and new < _RISE * size)
    if not good and need == _WHOLE and tries < _TRIES:
        return _SHORTEN
    return _LEAVE if need != _WHOLE and not new < size else _TAKE


@kernel
def needed_tangent(
    new: float,
    size: float,
    need: int,
    less: int,
    tolerance: float,
    worth: float,
    shared_worth: float,
) -> int:
    """Return the part of the tangent to renew after a residual fell from `size` to `new`.

    It is kept while it needs fewer than `worth` further iterations; first, if bearings share
    coordinates, their part alone is renewed, from `shared_worth` iterations on.
    """
    fall = new / size
    if new * fall**shared_worth <= tolerance:
        return _KEPT
    return _WHOLE if need == _SHARED and not new * fall**worth <= tolerance else less


@inlined_by_llvm
def newton(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    parts: NonlinearElements | None,
    linear: Floats,
    share: float,
    tolerance: float,
    max_iterations: int,
    worth: float,
    shared_worth: float,
) -> int:
    """Find ``run.step`` with a residual below `tolerance`; returns a status code.

    `run.step` has the first guess. The tangent is kept from step to step and from iteration to
    iteration while it is good enough (`needed_tangent`), improved by secants. Once parts have
    yielded it is renewed at the guess if the last step suggests that it must be renewed anyway.
    """
    clock = run.clock[0]
    eager = False
    if parts is not None:
        eager = has_yielded(parts)
    need = _KEPT if clock.kept == clock.halvings + 1 else _WHOLE
    less = _SHARED if model.shared.shape[0] > 0 else _WHOLE
    size, factor = math.inf, 1.0
    at, tries, passes = _GUESS, 0, 0
    while True:  # one call of the bearings: it contains all their code
        set_trial(run, at == _CORRECTED, factor)
        trial = run.g_b if at == _CORRECTED else run.step
        new = set_residual(model, run, contacts, parts, linear, trial, share)
        if at == _GUESS and new == math.inf:  # start from rest instead
            at = _REST
            run.step[:] = 0.0
            run.linear_step[:] = 0.0
            continue
        if at == _CORRECTED:
            tries += 1
            found = judge_correction(new, size, need, tries)
            if found == _SHORTEN:
                factor *= _SHORTER
                continue
            if found == _LEAVE:  # back to its start
                need = less if need == _KEPT else _WHOLE
                at = _BACK
                continue
        if new == math.inf and at != _BACK:
            return run.counts[0].code if has_no_state(run.counts[0].code) else _NEWTON_FAILED
        if at == _CORRECTED:
            copy(run.g_b, run.step)
            copy(run.linear_trial, run.linear_step)
            if passes == 1 and need == _KEPT:
                clock.fall = new / size
            need = needed_tangent(new, size, need, less, tolerance, worth, shared_worth)
        if at != _BACK:
            size = new
        if passes == max_iterations:
            return _NEWTON_FAILED
        passes += 1
        if size <= tolerance:
            return _OK
        run.counts[0].iterations += 1
        renews = eager and at == _GUESS and need == _KEPT
        if renews and size * clock.fall ** (1.0 + worth) > tolerance:
            need = less
            clock.fall *= _RETRIED
            shared_worth = max(shared_worth, 1.0)
        follows = at == _CORRECTED and factor == 1.0 and need == _KEPT
        if need != _KEPT:
            clock.kept, clock.secants = 0, 0
            if not renew_tangent(model, run, contacts, parts, linear, share, need == _WHOLE):
                return _SINGULAR
            clock.kept = clock.halvings + 1
        copy(run.residual, run.h_b)
        correct(model, run, share, run.h_b)
        clock.secants = keep_secant(
            run.weights,
            run.corrections,
            run.corrections_next,
            run.corrections_linear,
            run.corrections_size,
            clock.secants,
            follows,
            run.h_b,
            run.linear_change,
        )
        at, tries, factor = _CORRECTED, 0, 1.0


@kernel
def solve_gravity(
    model: ReducedModel,
    run: IntegrationState,
    contacts: Contacts | None,
    tolerance: float,
    max_iterations: int,
) -> int:
    """Find the equilibrium of the frame under its permanent loads; returns a status code.

    `run.b` holds the first guess; `run.step` is used. On success the state is committed.
    """
    n_b = run.b.shape[0]
    for a in range(n_b):
        run.step[a] = run.b[a]
        run.b[a] = 0.0
        run.rhs_b[a] = model.load_b[a]
    if model.shared.shape[0] > 0:
        set_product(model.stiffness_b, run.step, run.linear_step)
    run.clock[0].kept = 0
    code = newton(
        model,
        run,
        contacts,
        None,
        model.stiffness_b,
        1.0,
        tolerance,
        max_iterations,
        _GRAVITY_WORTH,
        0.0,
    )
    run.clock[0].kept = 0
    if code != _OK:
        return code
    for a in range(n_b):
        run.b[a] = run.step[a]
    for a in range(run.e.shape[0]):
        run.e[a] = model.load_e[a] / model.omega2[a]
    commit_bearings(model, run, contacts)
    run.store_at_rest[0] = 0.0
    for k in range(run.old.shape[0]):  # works count from here; energy stored by friction is a state
        run.store_at_rest[0] += run.old[k].work_elastic
        for side in range(2):
            run.old[k].work_friction[side] = 0.0
            run.old[k].work_rim[side] = 0.0
            run.old[k].travel[side] = 0.0
        for side in range(3):
            run.old[k].work_owed[side] = 0.0
        run.old[k].work_interface = 0.0
        run.old[k].work_contact = 0.0
        run.old[k].work_sliders = 0.0
    return _OK


@inlined_by_llvm
def commit_bearings(model: ReducedModel, run: IntegrationState, contacts: Contacts | None) -> None:
    """Accept the trial states and forces of all bearings."""
    for k in range(run.old.shape[0]):
        bearing_commit(
            model.props, run.old, run.new, run.old_words, run.new_words, run.heat, contacts, k
        )
    for a in range(run.force.shape[0]):
        run.force_before[1, a] = run.force_before[0, a]
        run.force_before[0, a] = run.force_old[a]
        run.force_old[a] = run.force[a]
