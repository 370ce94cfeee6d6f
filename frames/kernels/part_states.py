"""Kernels of nonlinear parts one by one: their flows in a step, and how the frame gives way.

A flow is a part's change besides the elastic one (`NonlinearElements`). The deformations of the
frame by a flow of 1 at the present step size are a row of the pool, made on first use.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm, kernel
from frames.assembly.system import BOUC_WEN, HINGES, WIDEST
from frames.kernels.effective import effective
from frames.kernels.hinges import turn_hinges
from frames.kernels.laws import uniaxial
from lir_element.kernels.linear import add_product, set_product

if TYPE_CHECKING:
    from frames.bundles.model_data import ReducedModel
    from frames.bundles.nonlinear_data import NonlinearElements
    from frames.bundles.run_data import IntegrationState, IntegratorSettings
    from lir_element.layout import Floats, Words


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
    flow: Floats,
    give: Floats,
    small: Floats,
    k: int,
    rate: float,
    dt: float,
    warm: bool,
) -> int:
    """Set the flows of part `k` at `d`, and their derivatives; `warm` if `new` is near.

    Returns 0 if nothing flows, 1 if it does, -1 if there is no state.
    """
    at = first[k]
    if kind[k] == HINGES:
        end = at + WIDEST
        found = turn_hinges(
            par[k], old[k], new[k], d[at:end], flow[at:end], give[at:end], small, warm
        )
        if found == 0:
            for i in range(at, end):
                flow[i] = 0.0
                for q in range(WIDEST):
                    give[i, q] = 0.0
        return found
    k_0 = elastic[at]
    force, stiffness = uniaxial(
        kind[k], par[k], old[k], new[k], d_old[at], d[at], v_old[at], v[at], rate, dt
    )
    flow[at] = force - k_0 * d[at] - g_old[at]
    give[at, 0] = stiffness - k_0
    if not math.isfinite(force):
        return -1
    if k_0 > 0.0 and kind[k] != BOUC_WEN and stiffness == k_0:
        flow[at] = 0.0
        return 0
    return 1 if flow[at] != 0.0 or give[at, 0] != 0.0 else 0


@inlined_by_llvm
def try_part(parts: NonlinearElements, k: int, dt: float) -> int:
    """Run part `k` at its deformations, with the speeds that the time integration implies."""
    speed, known_v, known_a = (
        parts.scheme[0].speed,
        parts.scheme[0].known_v,
        parts.scheme[0].known_a,
    )
    if parts.kind[k] != HINGES:  # those have no use for it
        i = parts.first[k]
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
        parts.flow,
        parts.give,
        parts.small,
        k,
        speed,
        dt,
        parts.loose[k] == 1,
    )


@inlined_by_llvm
def set_changes(parts: NonlinearElements) -> None:
    """Set the changes of the forces g of loose parts from their flows."""
    for k in range(parts.kind.shape[0]):
        if parts.loose[k] == 0:
            continue
        at = parts.first[k]
        if parts.kind[k] != HINGES:
            parts.change[at] = parts.flow[at]
            continue
        for a in range(WIDEST):
            total = 0.0
            for c in range(WIDEST):
                total -= parts.par[k, WIDEST * a + c] * parts.flow[at + c]
            parts.change[at + a] = total


@inlined_by_llvm
def pushed(parts: NonlinearElements, i: int, x: Floats) -> float:
    """Return the work that forces of a flow `i` of 1 do on deformations `x` (m,)."""
    k = parts.owner[i]
    if parts.kind[k] != HINGES:
        return float(x[i])
    at = parts.first[k]
    total = 0.0
    for q in range(WIDEST):
        total -= parts.par[k, WIDEST * q + i - at] * x[at + q]
    return total


@kernel
def flow_row(
    push_e: Floats,
    still: Floats,
    of_e: Floats,
    inverse: Floats,
    share: float,
    out: Floats,
    w: Floats,
) -> None:
    """Set the deformations by a flow of 1, the modes' own flexibility being `inverse`, or its row.

    `push_e` (n_e,) are its loads on the modes, `still` (m,) deformations of massless DOFs.
    """
    if inverse.shape[0] == 1:
        for k in range(push_e.shape[0]):
            w[k] = share * inverse[0, k] * push_e[k]
    else:
        set_product(inverse, push_e, w)
        for k in range(push_e.shape[0]):
            w[k] *= share
    for j in range(out.shape[0]):
        out[j] = still[j]
    add_product(of_e, w, 1.0, out)


@kernel
def add_rows(pool: Floats, place: Words, factor: Floats, count: int, out: Floats) -> None:
    """Add the first `count` rows at `place` times `factor` to `out`, four at a time."""
    whole = count - count % 4
    for c in range(0, whole, 4):
        x_0, x_1, x_2, x_3 = factor[c], factor[c + 1], factor[c + 2], factor[c + 3]
        r_0, r_1, r_2, r_3 = place[c], place[c + 1], place[c + 2], place[c + 3]
        for a in range(out.shape[0]):
            out[a] += (pool[r_0, a] * x_0 + pool[r_1, a] * x_1) + (
                pool[r_2, a] * x_2 + pool[r_3, a] * x_3
            )
    for c in range(whole, count):
        x_0, r_0 = factor[c], place[c]
        for a in range(out.shape[0]):
            out[a] += pool[r_0, a] * x_0


@kernel
def weigh_row(
    kind: Words, first: Words, owner: Words, live: Words, give: Floats, row: Floats, out: Floats
) -> None:
    """Set how the flows `live` change by deformations `row` (m,), each by those of its part."""
    n = 0
    while n < out.shape[0]:
        k = owner[live[n]]
        at = first[k]
        if kind[k] != HINGES:
            out[n] = give[live[n], 0] * row[at]
            n += 1
            continue
        d_0, d_1, d_2, d_3, d_4 = row[at], row[at + 1], row[at + 2], row[at + 3], row[at + 4]
        while n < out.shape[0] and owner[live[n]] == k:
            by = give[live[n]]
            out[n] = (by[0] * d_0 + by[1] * d_1) + (by[2] * d_2 + by[3] * d_3) + by[4] * d_4
            n += 1


@kernel
def follow_of(
    to_b: Floats,
    to_e: Floats,
    mass_eb: Floats,
    inverse: Floats,
    factor: float,
    full: Floats,
    out: Floats,
    lead: Floats,
) -> None:
    """Set the deformations by b with the modes, with `full` damping or the diagonal one.

    `lead` is its transpose.
    """
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
        for a in range(n_b):
            lead[a, i] = out[i, a]


@inlined_by_llvm
def set_mode_flexibility(
    model: ReducedModel, parts: NonlinearElements, c_m: float, c_c: float, c_k: float
) -> None:
    """Set ``parts.modes[0]``, the modes' flexibility at a step with diagonal damping."""
    for k in range(parts.to_e.shape[1]):
        parts.modes[0, k] = 1.0 / (c_m + c_c * model.damping_e[k] + c_k * model.omega2[k])


@inlined_by_llvm
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
        parts.lead[at],
    )


@inlined_by_llvm
def row_of(model: ReducedModel, run: IntegrationState, parts: NonlinearElements, i: int) -> int:
    """Return the place in the pool of the row of flow `i` at the present step size."""
    at = run.clock[0].halvings
    place = parts.slot[at, i]
    if place > 0:
        return int(place - 1)
    place, share = parts.counts[0].rows, parts.scheme[0].share
    flow_row(
        parts.push_e[i],
        parts.still[i],
        parts.of_e,
        run.inverse_e[at] if model.damping_ee.shape[0] > 0 else parts.modes[:1],
        share,
        parts.pool[place],
        parts.modes[1],
    )
    parts.slot[at, i] = place + 1
    parts.counts[0].rows = place + 1
    return int(place)
