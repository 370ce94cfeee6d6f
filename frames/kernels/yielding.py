"""Kernels of the equilibrium of nonlinear parts in a linear frame, and of its tangent.

The force of a part is ``k0 d + g(d)``; k0 is in the frame's stiffness. Within a step of the time
integration the deformations are linear in the step of b and in the parts' flows (docs/theory.md,
5). Only parts that flow, the loose ones, need a solution, of as many unknowns as have a flow; an
elastic part costs its deformation alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm
from frames.kernels.effective import effective
from frames.kernels.part_states import (
    add_rows,
    pushed,
    row_of,
    set_changes,
    set_mode_flexibility,
    try_part,
    weigh_row,
)
from lir_element.kernels.linear import add_product, factorise, substitute, substitute_many

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState, IntegratorSettings
    from lir_element.layout import Floats

_MOST = 40  # iterations over the loose parts
_HELD = 1e-25  # m/N: flexibility of a deformation held by supports, or its round-off
_ROUND_OFF = 8.0 * 2.0**-52  # of a deformation: it is not known better (a choice)
_CLOSER = 1e-3  # of the tolerance of the whole: tolerance of the parts
_TRIES = 12  # of a step of Newton's method
_WORTH = 2.0  # tries that new factors are worth
_LESS = 0.7  # of the error before: then a step does
_FLAT = 0.2  # of the slope of the potential at the start of a step: then it does, too


@inlined_by_llvm
def begin_parts(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    settings: IntegratorSettings,
) -> None:
    """Set the deformations at the end of the step if b and the flows are zero.

    Needs ``run.h_e``, the modes' motion then. Flows of the last step are assumed to continue, as b
    does in ``run.step``.
    """
    dt, before = run.clock[0].dt, run.clock[0].dt_before
    c_m, c_c, c_k = effective(settings, dt)
    parts.scheme[0].speed = settings.gamma / (settings.beta * dt)
    parts.scheme[0].known_v = 1.0 - settings.gamma / settings.beta
    parts.scheme[0].known_a = dt * (1.0 - 0.5 * settings.gamma / settings.beta)
    parts.scheme[0].share = c_k
    parts.scheme[0].tolerance = _CLOSER * settings.force_tolerance
    set_mode_flexibility(model, parts, c_m, c_c, c_k)
    for i in range(parts.d.shape[0]):
        parts.known[i] = parts.d_old[i]
        parts.change[i] = 0.0
    add_product(parts.of_e, run.h_e, 1.0, parts.known)
    parts.counts[0].active = 0
    if run.clock[0].kept != run.clock[0].halvings + 1:
        parts.counts[0].gains = 0  # gains are those of a tangent
    for a in range(parts.at.shape[0]):
        parts.at[a] = run.step[a]
    ratio = dt / before if before > 0.0 else 0.0
    for k in range(parts.kind.shape[0]):
        parts.loose[k] = 0
        flows = False
        for i in range(parts.first[k], parts.first[k + 1]):
            flows = flows or parts.flow_old[i] != 0.0
        if flows:
            activate(parts, k)
            for i in range(parts.first[k], parts.first[k + 1]):
                parts.predicted[i] = ratio * parts.flow_old[i]
    m = parts.d.shape[0]
    if parts.counts[0].rows + m > parts.pool.shape[0]:  # room for a row each
        parts.slot[:, :] = 0
        parts.counts[0].rows = 0


@inlined_by_llvm
def activate(parts: NonlinearElements, k: int) -> None:
    """Add a part to the loose ones."""
    parts.loose[k] = 1
    for i in range(parts.first[k], parts.first[k + 1]):
        parts.active[parts.counts[0].active] = i
        parts.predicted[i] = 0.0
        parts.counts[0].active += 1


@inlined_by_llvm
def add_flows(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    flow: Floats,
    out: Floats,
) -> bool:
    """Add the deformations by `flow` (m,) of the loose parts; returns whether there is any."""
    count = 0
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        if flow[i] != 0.0:
            parts.place[count] = row_of(model, run, parts, i)
            parts.vector[count] = -flow[i]
            count += 1
    add_rows(parts.pool, parts.place, parts.vector, count, out)
    return count > 0


@inlined_by_llvm
def try_loose(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> float:
    """Run the loose parts and return the size of their residual; infinite without a state.

    That is how far their deformations are from those that the frame has under their flows.
    """
    for k in range(parts.kind.shape[0]):
        if parts.loose[k] == 1 and try_part(parts, k, run.clock[0].dt) < 0:
            return math.inf
    for i in range(parts.d.shape[0]):
        parts.framed[i] = parts.linear[i]
    add_flows(model, run, parts, parts.flow, parts.framed)
    size = 0.0
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        gap = abs(parts.framed[i] - parts.d[i]) * parts.scale[i]
        if parts.stiff[i] > 0.0:
            size = max(size, gap * parts.stiff[i])
        else:
            own = parts.pool[row_of(model, run, parts, i), i]
            gap -= _ROUND_OFF * (abs(parts.linear[i]) + abs(parts.d[i])) * parts.scale[i]
            if own > _HELD and gap > 0.0:
                size = max(size, gap / own)
    return size


@inlined_by_llvm
def list_live(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """List the flows that deformations change or that are not as guessed.

    Returns whether they are those of the factors that are kept, at the present step size.
    """
    count, same = 0, parts.counts[0].at_halvings == run.clock[0].halvings + 1
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        k = parts.owner[i]
        changes = parts.flow[i] != parts.predicted[i]
        for q in range(parts.first[k + 1] - parts.first[k]):
            changes = changes or parts.give[i, q] != 0.0
        if changes:
            same = same and count < parts.counts[0].factors and parts.factored[count] == i
            parts.live[count] = i
            parts.place[count] = row_of(model, run, parts, i)
            count += 1
    parts.counts[0].live = count
    return bool(same and count == parts.counts[0].factors)


@inlined_by_llvm
def factorise_parts(run: IntegrationState, parts: NonlinearElements) -> bool:
    """Factorise the matrix of the live flows; returns False if it is singular.

    It is ``1 + give F``, F the deformations by flows: that of a step of Newton's method, its
    columns one after the other.
    """
    count = parts.counts[0].live
    for p in range(count):
        column = parts.matrix[p * count : (p + 1) * count]
        weigh_row(
            parts.kind,
            parts.first,
            parts.owner,
            parts.live,
            parts.give,
            parts.pool[parts.place[p]],
            column,
        )
        column[p] += 1.0
        parts.factored[p] = parts.live[p]
    parts.counts[0].factors, parts.counts[0].at_halvings = count, run.clock[0].halvings + 1
    if factorise(parts.matrix[: count * count].reshape((count, count)), parts.order):
        return True
    parts.counts[0].at_halvings = 0
    return False


@inlined_by_llvm
def set_newton_step(
    model: ReducedModel, run: IntegrationState, parts: NonlinearElements, keep: bool
) -> int:
    """Set Newton's step of the flows (`right`) and of the deformations (`way`).

    Uses kept factors, if allowed and if there are some of the same flows. Returns 1 then, 0 if they
    are new, and -1 if they are singular.
    """
    kept = list_live(model, run, parts) and keep
    if not kept and not factorise_parts(run, parts):
        return -1
    count = parts.counts[0].live
    for n in range(count):
        parts.vector[n] = parts.predicted[parts.live[n]] - parts.flow[parts.live[n]]
    factors = parts.matrix[: count * count].reshape((count, count))
    substitute(factors, parts.order, parts.vector[:count])
    for i in range(parts.way.shape[0]):
        parts.way[i] = 0.0
    for n in range(count):
        parts.right[n, 0] = -parts.vector[n]
    add_rows(parts.pool, parts.place, parts.vector, count, parts.way)
    return 1 if kept else 0


@inlined_by_llvm
def go_along(parts: NonlinearElements, share: float) -> None:
    """Move the loose deformations and the guessed flows by a share of Newton's step."""
    for n in range(parts.counts[0].active):
        parts.d[parts.active[n]] += share * parts.way[parts.active[n]]
    for n in range(parts.counts[0].live):
        parts.predicted[parts.live[n]] += share * parts.right[n, 0]


@inlined_by_llvm
def ascent(parts: NonlinearElements) -> float:
    """Return the derivative of the potential along Newton's step; zero at its minimum."""
    total = 0.0
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        over = parts.flow[i] - parts.predicted[i]
        if over != 0.0:
            total += over * pushed(parts, i, parts.way)
    return total


@inlined_by_llvm
def newton_loose(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Find the equilibrium of the loose parts and the frame; returns True on success.

    With guessed flows, ``d = linear - F guess``; wanted are the parts' flows at d. They minimise a
    potential, convex but for parts that soften (docs/theory.md, 5): a step of Newton's method that
    goes too far is cut back until the potential does not rise.
    """
    size, start, low, high, here, down, up = math.inf, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0
    steps, tries, kept, keep = 0, 0, False, True
    while True:  # one call of the parts: it contains all their code
        found = try_loose(model, run, parts)
        good = tries == 0
        if kept and tries > 0:
            good = found < math.inf
            if not good:  # back to its start, for a step of new factors
                go_along(parts, -1.0)
                tries, keep = 0, False
                continue
        elif tries > 0:
            rise = ascent(parts)
            if tries == 1:
                low, high, here, down, up = 0.0, 1.0, 1.0, start, rise
            elif abs(rise) <= _FLAT * abs(start) and found < math.inf:
                good = True
            elif rise > 0.0 or found == math.inf:
                high, up = here, rise
            else:
                low, down = here, rise
            good = good or found < _LESS * size or (up <= 0.0 and found < math.inf)
        if good or tries > _TRIES:
            if tries > 0:
                keep = found * (found / size) ** _WORTH <= parts.scheme[0].tolerance
            size = found
            if size <= parts.scheme[0].tolerance:
                return True
            if size == math.inf or steps == _MOST:
                return False
            made = set_newton_step(model, run, parts, keep)
            if made < 0:
                return False
            kept = made == 1
            start = ascent(parts)
            go_along(parts, 1.0)
            steps, tries = steps + 1, 1
            continue
        share = 0.5
        if found < math.inf and up > down:
            share = min(max(-down / (up - down), 0.1), 0.9)
        there = low + share * (high - low)
        go_along(parts, there - here)
        here, tries = there, tries + 1


@inlined_by_llvm
def follow_step(parts: NonlinearElements, step: Floats) -> None:
    """Guess how the loose parts flow at a step of b from how they did at the one tried before."""
    for n in range(parts.counts[0].gains):
        i = parts.gained[n]
        if parts.loose[parts.owner[i]] == 1 and parts.flow[i] != 0.0:
            total = 0.0
            for a in range(step.shape[0]):
                total += parts.gain[n, a] * (step[a] - parts.at[a])
            parts.predicted[i] += total
    for a in range(step.shape[0]):
        parts.at[a] = step[a]


@inlined_by_llvm
def start_loose(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Set the deformations by the guessed flows; returns whether any is guessed."""
    for i in range(parts.d.shape[0]):
        parts.d[i] = parts.linear[i]
    return add_flows(model, run, parts, parts.predicted, parts.d)


@inlined_by_llvm
def forget_guess(parts: NonlinearElements) -> None:
    """Set the guessed flows to zero, for any b."""
    parts.counts[0].gains = 0
    for n in range(parts.counts[0].active):
        parts.predicted[parts.active[n]] = 0.0


@inlined_by_llvm
def settle_parts(
    model: ReducedModel, run: IntegrationState, parts: NonlinearElements, step: Floats
) -> bool:
    """Find the deformations and flows of all parts for a step of b; returns success."""
    for i in range(parts.d.shape[0]):
        parts.linear[i] = parts.known[i]
    add_product(parts.lead[run.clock[0].halvings], step, 1.0, parts.linear)
    for i in range(parts.d.shape[0]):
        parts.framed[i] = parts.linear[i]
    follow_step(parts, step)
    begin, guessed, turns = True, False, 0
    while turns <= parts.kind.shape[0]:
        if begin:
            guessed = start_loose(model, run, parts)
            begin = False
        if parts.counts[0].active > 0 and not newton_loose(model, run, parts):
            forget_guess(parts)  # no guess for the next trial
            if not guessed:
                return False
            begin = True
            continue
        more = False
        for k in range(parts.kind.shape[0]):
            if parts.loose[k] == 0:
                for i in range(parts.first[k], parts.first[k + 1]):
                    parts.d[i] = parts.framed[i]
                found = try_part(parts, k, run.clock[0].dt)
                if found < 0:
                    return False
                if found > 0:
                    activate(parts, k)
                    more = True
        if not more:
            for n in range(parts.counts[0].active):  # the frame's own values: so no errors add up
                i = parts.active[n]
                parts.d[i], parts.predicted[i] = parts.framed[i], parts.flow[i]
            set_changes(parts)
            return True
        turns += 1
    return False


@inlined_by_llvm
def add_part_forces(run: IntegrationState, parts: NonlinearElements, out: Floats) -> None:
    """Subtract the change of the forces g from a residual of b."""
    follow = parts.follow[run.clock[0].halvings]
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        value = parts.scheme[0].share * parts.change[i]
        if value != 0.0:
            for a in range(out.shape[0]):
                out[a] -= value * follow[i, a]


@inlined_by_llvm
def has_yielded(parts: NonlinearElements) -> bool:
    """Return whether any part has yielded in the run."""
    return bool(parts.work[0] > 0.0)


@inlined_by_llvm
def foresee_part_forces(
    run: IntegrationState, parts: NonlinearElements, ratio: float, out: Floats
) -> None:
    """Subtract the extrapolated forces g of loose parts from a residual of b."""
    follow = parts.follow[run.clock[0].halvings]
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        value = parts.scheme[0].share * ratio * (parts.g_old[i] - parts.g_before[i])
        if value != 0.0:
            for a in range(out.shape[0]):
                out[a] -= value * follow[i, a]


@inlined_by_llvm
def add_part_tangent(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Add the share of the loose parts to ``run.tangent``; returns False if they are singular."""
    parts.counts[0].gains = 0
    if parts.counts[0].active == 0:
        return True
    n_b = run.step.shape[0]
    follow = parts.follow[run.clock[0].halvings]
    list_live(model, run, parts)
    if not factorise_parts(run, parts):
        return False
    count = parts.counts[0].live
    for n in range(count):
        i = parts.live[n]
        at, end = parts.first[parts.owner[i]], parts.first[parts.owner[i] + 1]
        for a in range(n_b):
            parts.right[n, a] = 0.0
        for q in range(end - at):
            value = parts.give[i, q]
            if value != 0.0:
                for a in range(n_b):
                    parts.right[n, a] += value * follow[at + q, a]
    factors = parts.matrix[: count * count].reshape((count, count))
    substitute_many(factors, parts.order, parts.right[:count])
    for n in range(count):
        parts.gained[n] = parts.live[n]
        for a in range(n_b):
            parts.gain[n, a] = parts.right[n, a]
    parts.counts[0].gains = count
    lead = parts.lead[run.clock[0].halvings]
    for n in range(count):
        for a in range(n_b):
            value = parts.scheme[0].share * pushed(parts, parts.live[n], lead[a])
            for c in range(n_b):
                run.tangent[a, c] += value * parts.right[n, c]
    return True


@inlined_by_llvm
def part_load_on_modes(parts: NonlinearElements, out: Floats) -> None:
    """Subtract the change of the forces g from loads on the modes."""
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        value = parts.scheme[0].share * parts.change[i]
        if value != 0.0:
            for k in range(out.shape[0]):
                out[k] -= value * parts.to_e[i, k]
