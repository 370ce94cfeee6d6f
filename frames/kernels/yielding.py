"""Kernels of nonlinear parts in a linear frame: equilibrium, tangent, commit, energy.

The force of a part is ``k0 d + g(d)``; k0 is in the frame's stiffness. Within a step of the time
integration the deformations are ``d = linear - F (g - g_old)``, linear in the step of b, with the
flexibility F of the frame at that step (docs/theory.md, 5): only parts whose g changes, the loose
ones, need a solution, and what stays elastic costs its deformation alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined, kernel
from frames.kernels.effective import effective
from frames.kernels.hinges import hinged_member
from frames.kernels.laws import uniaxial
from frames.nonlinear_layout import (
    BOUC_WEN,
    HINGES,
    WIDEST,
)
from lir_element.kernels.linear import solve_many

if TYPE_CHECKING:
    from frames.kernel_data import IntegrationState, IntegratorSettings, ReducedModel
    from frames.nonlinear_data import NonlinearElements
    from lir_element.layout import Floats, Words

_MOST = 40  # iterations over the loose parts
_HELD = 1e-25  # m/N: flexibility of a deformation that supports hold, or round-off of it
_CLOSER = 1e-3  # of the tolerance of the whole: what parts may lack
_TRIES = 12  # of a step of Newton's method
_LESS = 0.7  # of the error before: then a step does
_FLAT = 0.2  # of the slope of the potential at the start of a step: then it does, too


@kernel
def part_trial(
    kind: Words,
    first: Words,
    par: Floats,
    elastic: Floats,
    old: Floats,
    new: Floats,
    d_old: Floats,
    d: Floats,
    v_old: Floats,
    v: Floats,
    g_old: Floats,
    g: Floats,
    change: Floats,
    slope: Floats,
    small: Floats,
    k: int,
    rate: float,
    dt: float,
) -> int:
    """Set g, its change and its slope of part `k` at `d`.

    Returns 0 where g does not change, 1 where it does, -1 where there is no state.
    """
    at = first[k]
    if kind[k] == HINGES:
        end = at + WIDEST
        yields = hinged_member(par[k], old[k], new[k], d[at:end], g[at:end], slope[at:end], small)
        for i in range(at, end):
            change[i] = g[i] - g_old[i] if yields else 0.0
        return yields
    k_0 = elastic[at]
    force, stiffness = uniaxial(
        kind[k], par[k], old[k], new[k], d_old[at], d[at], v_old[at], v[at], rate, dt
    )
    g[at] = force - k_0 * d[at]
    slope[at, 0] = stiffness - k_0
    change[at] = g[at] - g_old[at]
    if not math.isfinite(force):
        return -1
    if k_0 > 0.0 and kind[k] != BOUC_WEN and stiffness == k_0:
        change[at] = 0.0
        return 0
    return 1 if change[at] != 0.0 or slope[at, 0] != 0.0 else 0


@inlined
def try_part(parts: NonlinearElements, k: int, dt: float) -> int:
    """Run part `k` at its deformations, with the speeds that the time integration implies."""
    speed, known_v, known_a = parts.scheme[0], parts.scheme[1], parts.scheme[2]
    for i in range(parts.first[k], parts.first[k + 1]):
        parts.v[i] = (
            speed * (parts.d[i] - parts.d_old[i])
            + known_v * parts.v_old[i]
            + known_a * parts.a_old[i]
        )
    return part_trial(
        parts.kind,
        parts.first,
        parts.par,
        parts.elastic,
        parts.old,
        parts.new,
        parts.d_old,
        parts.d,
        parts.v_old,
        parts.v,
        parts.g_old,
        parts.g,
        parts.change,
        parts.slope,
        parts.small,
        k,
        speed,
        dt,
    )


@kernel
def flexibility_row(
    to_e: Floats, still: Floats, inverse: Floats, i: int, share: float, out: Floats, scratch: Floats
) -> None:
    """Set row `i` of the flexibility, the modes' own being the rows of `inverse` (full) or one."""
    m, n_e = to_e.shape
    if inverse.shape[0] == 1:
        for k in range(n_e):
            scratch[k] = share * inverse[0, k] * to_e[i, k]
    else:
        for k in range(n_e):
            total = 0.0
            for j in range(n_e):
                total += inverse[k, j] * to_e[i, j]
            scratch[k] = share * total
    for j in range(m):
        total = still[i, j]
        for k in range(n_e):
            total += scratch[k] * to_e[j, k]
        out[j] = total


@kernel
def follow_of(
    to_b: Floats,
    to_e: Floats,
    mass_eb: Floats,
    inverse: Floats,
    factor: float,
    full: Floats,
    out: Floats,
) -> None:
    """Set how deformations follow b with the modes: by `full` damping's, or the diagonal one."""
    m, n_b = to_b.shape
    for i in range(m):
        for a in range(n_b):
            out[i, a] = to_b[i, a]
        for k in range(to_e.shape[1]):
            value = to_e[i, k]
            if full.shape[0] > 0:
                for a in range(n_b):
                    out[i, a] -= value * full[k, a]
            else:
                value *= factor * inverse[0, k]
                for a in range(n_b):
                    out[i, a] -= value * mass_eb[k, a]


@inlined
def set_mode_flexibility(
    model: ReducedModel, parts: NonlinearElements, c_m: float, c_c: float, c_k: float
) -> None:
    """Set ``parts.modes[0]``, the modes' flexibility at a step where damping is diagonal."""
    for k in range(parts.to_e.shape[1]):
        parts.modes[0, k] = 1.0 / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])


@inlined
def set_part_follow(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    settings: IntegratorSettings,
) -> None:
    """Set how the deformations follow b at the present step size."""
    at = run.clock[0].halvings
    c_m, c_c, c_k = effective(settings, run.clock[0].dt)
    set_mode_flexibility(model, parts, c_m, c_c, c_k)
    n_full = model.damping_ee.shape[0]
    follow_of(
        parts.to_b,
        parts.to_e,
        model.mass_eb,
        parts.modes[:1],
        c_m,
        run.follow_e[at][:n_full],
        parts.follow[at],
    )


@inlined
def row_of(model: ReducedModel, run: IntegrationState, parts: NonlinearElements, i: int) -> int:
    """Return the place in the pool of row `i` of the flexibility at the present step size."""
    at = run.clock[0].halvings
    place = parts.slot[at, i]
    if place > 0:
        return int(place - 1)
    place, share = parts.number[1], parts.scheme[3]
    if model.damping_ee.shape[0] > 0:
        flexibility_row(
            parts.to_e, parts.still, run.inverse_e[at], i, share, parts.pool[place], parts.modes[1]
        )
    else:
        flexibility_row(
            parts.to_e, parts.still, parts.modes[:1], i, share, parts.pool[place], parts.modes[1]
        )
    parts.slot[at, i] = place + 1
    parts.number[1] = place + 1
    return int(place)


@inlined
def begin_parts(
    model: ReducedModel,
    run: IntegrationState,
    parts: NonlinearElements,
    settings: IntegratorSettings,
) -> None:
    """Set the deformations at the end of the step if b rests and no force g changes.

    Needs ``run.h_e``, what the modes do then.
    """
    c_m, c_c, c_k = effective(settings, run.clock[0].dt)
    parts.scheme[0] = settings.gamma / (settings.beta * run.clock[0].dt)
    parts.scheme[1] = 1.0 - settings.gamma / settings.beta
    parts.scheme[2] = run.clock[0].dt * (1.0 - 0.5 * settings.gamma / settings.beta)
    parts.scheme[3] = c_k
    parts.scheme[4] = _CLOSER * settings.force_tolerance
    set_mode_flexibility(model, parts, c_m, c_c, c_k)
    for i in range(parts.d.shape[0]):
        total = parts.d_old[i]
        for k in range(run.h_e.shape[0]):
            total += parts.to_e[i, k] * run.h_e[k]
        parts.known[i] = total
        parts.change[i] = 0.0
    for k in range(parts.kind.shape[0]):
        parts.loose[k] = 0
    parts.number[0] = 0
    m = parts.d.shape[0]
    if parts.number[1] + m > parts.pool.shape[0]:  # room for a row each
        parts.slot[:, :] = 0
        parts.number[1] = 0


@inlined
def activate(parts: NonlinearElements, k: int) -> None:
    """Add a part to the loose ones."""
    parts.loose[k] = 1
    for i in range(parts.first[k], parts.first[k + 1]):
        parts.active[parts.number[0]] = i
        parts.guess[i] = 0.0
        parts.number[0] += 1


@inlined
def follow_change(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> None:
    """Set the deformations of what is not loose from those of the step and the changes of g."""
    for i in range(parts.d.shape[0]):
        parts.vector[0, i] = parts.linear[i]
    for n in range(parts.number[0]):
        change = parts.change[parts.active[n]]
        if change != 0.0:
            row = parts.pool[row_of(model, run, parts, parts.active[n])]
            for i in range(parts.d.shape[0]):
                parts.vector[0, i] -= row[i] * change
    for k in range(parts.kind.shape[0]):
        if parts.loose[k] == 0:
            for i in range(parts.first[k], parts.first[k + 1]):
                parts.d[i] = parts.vector[0, i]


@inlined
def set_part_gap(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> float:
    """Set what the frame gives way to by forces that are guessed but not there; its size."""
    size = 0.0
    for n in range(parts.number[0]):
        i = parts.active[n]
        row = parts.pool[row_of(model, run, parts, i)]
        total = 0.0
        for p in range(parts.number[0]):
            k = parts.active[p]
            total += row[k] * (parts.guess[k] - parts.change[k])
        parts.vector[1, n] = total
        if parts.stiff[i] > 0.0:
            size = max(size, abs(total) * parts.stiff[i] * parts.scale[i])
        elif row[i] > _HELD:
            size = max(size, abs(total) / row[i] * parts.scale[i])
    return size


@inlined
def try_loose(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> float:
    """Run the loose parts and return the size of what they lack; infinite without a state."""
    for k in range(parts.kind.shape[0]):
        if parts.loose[k] == 1 and try_part(parts, k, run.clock[0].dt) < 0:
            return math.inf
    return set_part_gap(model, run, parts)


@inlined
def set_part_matrix(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> None:
    """Set ``1 + F slope`` over the loose deformations."""
    count = parts.number[0]
    for n in range(count):
        row = parts.pool[row_of(model, run, parts, parts.active[n])]
        for p in range(count):
            parts.matrix[n, p] = 1.0 if n == p else 0.0
        p = 0
        while p < count:  # by parts: those of one lie together
            width = part_width(parts, parts.active[p])
            for r in range(width):
                flexible = row[parts.active[p + r]]
                for q in range(width):
                    parts.matrix[n, p + q] += flexible * parts.slope[parts.active[p + r], q]
            p += width


@inlined
def part_width(parts: NonlinearElements, i: int) -> int:
    """Return how many deformations the part has whose first one is `i`."""
    return WIDEST if parts.elastic[i] < 0.0 else 1


@inlined
def go_along(parts: NonlinearElements, share: float) -> None:
    """Move the loose deformations and their forces by a share of Newton's step."""
    for n in range(parts.number[0]):
        i = parts.active[n]
        parts.d[i] += share * parts.right[n, 0]
        parts.guess[i] += share * parts.vector[0, n]


@inlined
def ascent(parts: NonlinearElements) -> float:
    """Return the derivative of the potential along Newton's step; zero where it is smallest."""
    total = 0.0
    for n in range(parts.number[0]):
        i = parts.active[n]
        total += parts.right[n, 0] * (parts.change[i] - parts.guess[i])
    return total


@inlined
def set_newton_step(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Set Newton's step of the deformations (`right`) and forces (`vector[0]`) of loose parts."""
    count = parts.number[0]
    set_part_matrix(model, run, parts)
    for n in range(count):
        parts.right[n, 0] = parts.vector[1, n]
    if not solve_many(parts.matrix, parts.right, count, 1):
        return False
    p = 0
    while p < count:
        width = part_width(parts, parts.active[p])
        for r in range(width):
            i = parts.active[p + r]
            parts.vector[0, p + r] = parts.change[i] - parts.guess[i]
            for q in range(width):
                parts.vector[0, p + r] += parts.slope[i, q] * parts.right[p + q, 0]
        p += width
    return True


@inlined
def newton_loose(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Bring the loose parts into equilibrium with the frame; returns whether that succeeded.

    With forces q guessed, ``d = linear - F q``; wanted is ``q = g(d) - g_old``. That is where a
    potential is smallest, convex but for parts that soften (docs/theory.md, 5): a step of Newton's
    method that goes too far is cut back to where the potential does not rise any more.
    """
    size = try_loose(model, run, parts)
    for _ in range(_MOST):
        if size <= parts.scheme[4]:
            return True
        if size == math.inf or not set_newton_step(model, run, parts):
            return False
        start = ascent(parts)
        go_along(parts, 1.0)
        found = try_loose(model, run, parts)
        low, high, here = 0.0, 1.0, 1.0
        down, up = start, ascent(parts)
        for _ in range(_TRIES):
            if found < _LESS * size or (up <= 0.0 and found < math.inf):
                break
            share = 0.5
            if found < math.inf and up > down:
                share = min(max(-down / (up - down), 0.1), 0.9)
            there = low + share * (high - low)
            go_along(parts, there - here)
            here = there
            found = try_loose(model, run, parts)
            rise = ascent(parts)
            if abs(rise) <= _FLAT * abs(start) and found < math.inf:
                break
            if rise > 0.0 or found == math.inf:
                high, up = here, rise
            else:
                low, down = here, rise
        size = found
    return size <= parts.scheme[4]


@inlined
def settle_parts(
    model: ReducedModel, run: IntegrationState, parts: NonlinearElements, step: Floats
) -> bool:
    """Find the deformations and forces of all parts for a step of b; returns success."""
    follow = parts.follow[run.clock[0].halvings]
    for i in range(parts.d.shape[0]):
        total = parts.known[i]
        for a in range(step.shape[0]):
            total += follow[i, a] * step[a]
        parts.linear[i] = total
    for n in range(parts.number[0]):  # the first guess: forces as they were
        i = parts.active[n]
        row = parts.pool[row_of(model, run, parts, i)]
        parts.d[i] = parts.linear[i]
        for p in range(parts.number[0]):
            parts.d[i] -= row[parts.active[p]] * parts.guess[parts.active[p]]
    for _ in range(parts.kind.shape[0] + 1):
        if parts.number[0] > 0 and not newton_loose(model, run, parts):
            for n in range(parts.number[0]):  # no guess for what is tried next
                parts.guess[parts.active[n]] = 0.0
            return False
        follow_change(model, run, parts)
        more = False
        for k in range(parts.kind.shape[0]):
            if parts.loose[k] == 0:
                found = try_part(parts, k, run.clock[0].dt)
                if found < 0:
                    return False
                if found > 0:
                    activate(parts, k)
                    more = True
        if not more:
            for n in range(parts.number[0]):  # what the frame gives: so no errors add up
                parts.d[parts.active[n]] += parts.vector[1, n]
            return True
    return False


@inlined
def add_part_forces(run: IntegrationState, parts: NonlinearElements, out: Floats) -> None:
    """Take the change of the forces g from a residual of b."""
    follow = parts.follow[run.clock[0].halvings]
    for n in range(parts.number[0]):
        i = parts.active[n]
        value = parts.scheme[3] * parts.change[i]
        if value != 0.0:
            for a in range(out.shape[0]):
                out[a] -= value * follow[i, a]


@inlined
def add_part_tangent(model: ReducedModel, run: IntegrationState, parts: NonlinearElements) -> bool:
    """Add what the loose parts do to ``run.tangent``; returns False where they are singular."""
    count, n_b = parts.number[0], run.step.shape[0]
    if count == 0:
        return True
    follow = parts.follow[run.clock[0].halvings]
    set_part_matrix(model, run, parts)
    for n in range(count):
        for a in range(n_b):
            parts.right[n, a] = follow[parts.active[n], a]
    if not solve_many(parts.matrix, parts.right, count, n_b):
        return False
    p = 0
    while p < count:
        width = part_width(parts, parts.active[p])
        for r in range(width):
            i = parts.active[p + r]
            for q in range(width):
                value = parts.scheme[3] * parts.slope[i, q]
                if value != 0.0:
                    for a in range(n_b):
                        for c in range(n_b):
                            run.tangent[a, c] += value * follow[i, a] * parts.right[p + q, c]
        p += width
    return True


@inlined
def part_load_on_modes(parts: NonlinearElements, out: Floats) -> None:
    """Take the change of the forces g from loads on the modes."""
    for n in range(parts.number[0]):
        i = parts.active[n]
        value = parts.scheme[3] * parts.change[i]
        if value != 0.0:
            for k in range(out.shape[0]):
                out[k] -= value * parts.to_e[i, k]
