"""Kernels of the tangent of many bearings under a diaphragm, in two blocks.

The tangent is [[V, B], [D, H]]: H of the few coordinates that many bearings share (a diaphragm's),
V of all others. As bearings slide and rotate, their vertical and rotational stiffness stays
constant while they are pressed: from step to step only B, D and H change. With V factorised, V^-1 B
and H - D V^-1 B are a few substitutions, whereas a tangent of all coordinates needs a
factorisation.

Matrices of this size do not fit into the processor's cache: the time of a step is that of reading
them. So their products with vectors are updated, if known terms give them: the structure's product
with Newton's correction follows from the residual that it had to remove, and the products of mass,
damping and stiffness with motions follow from those with the step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import kernel
from lir_element.kernels.linear import dot, factorise, set_product, substitute, substitute_rows

_LEAST = 0.2  # of a secant's slope over that of the tangent: corrections grow fivefold at most

if TYPE_CHECKING:
    from lir_element.layout import Floats, Words


@kernel
def add_element_to_blocks(
    start: Words,
    columns: Words,
    values: Floats,
    element: Floats,
    factor: float,
    place: Words,
    whole: bool,
    tangent: Floats,
    across: Floats,
    below: Floats,
    corner: Floats,
) -> None:
    """Add `factor` times the tangent (12, 12) of a bearing to the blocks.

    `start` (13,), `columns` and `values` are its map as in `gather`; `place` (n_b,) the places of
    the coordinates, those in V first. V is left alone unless `whole`.
    """
    n_v = tangent.shape[0]
    for row in range(12):
        for i in range(start[row], start[row + 1]):
            r = place[columns[i]]
            for col in range(12):
                value = factor * values[i] * element[row, col]
                for j in range(start[col], start[col + 1]):
                    c = place[columns[j]]
                    if r < n_v and c < n_v:
                        if whole:
                            tangent[c, r] += value * values[j]
                    elif r < n_v:
                        across[c - n_v, r] += value * values[j]
                    elif c < n_v:
                        below[r - n_v, c] += value * values[j]
                    else:
                        corner[c - n_v, r - n_v] += value * values[j]


@kernel
def set_linear_blocks(
    linear: Floats,
    at: Words,
    whole: bool,
    tangent: Floats,
    across: Floats,
    below: Floats,
    corner: Floats,
) -> None:
    """Set the blocks to a symmetric matrix (n_b, n_b); `at` (n_b,) are its rows by place."""
    n_v, n_h = tangent.shape[0], corner.shape[0]
    if whole:
        for i in range(n_v):
            row = linear[at[i]]
            for j in range(n_v):
                tangent[i, j] = row[at[j]]
    for h in range(n_h):
        row = linear[at[n_v + h]]
        for j in range(n_v):
            across[h, j] = row[at[j]]
            below[h, j] = row[at[j]]
        for j in range(n_h):
            corner[h, j] = row[at[n_v + j]]


@kernel
def factorise_blocks(
    whole: bool,
    tangent: Floats,
    order: Words,
    across: Floats,
    below: Floats,
    corner: Floats,
    corner_order: Words,
) -> bool:
    """Factorise V if `whole`, make `across` V^-1 B and factorise ``H - D V^-1 B`` in place of H."""
    if whole and not factorise(tangent, order):
        return False
    n_h = corner.shape[0]
    substitute_rows(tangent, order, across)
    for c in range(n_h):
        for r in range(n_h):
            corner[c, r] -= dot(below[r], across[c])
    return factorise(corner, corner_order)


@kernel
def substitute_blocks(
    tangent: Floats,
    order: Words,
    across: Floats,
    below: Floats,
    corner: Floats,
    corner_order: Words,
    at: Words,
    sorted_x: Floats,
    x: Floats,
) -> None:
    """Solve for the right-hand side `x` (n_b,) in place; `sorted_x` (n_b,) is overwritten."""
    n_v, n_h = tangent.shape[0], corner.shape[0]
    for i in range(n_v + n_h):
        sorted_x[i] = x[at[i]]
    inner, shared = sorted_x[:n_v], sorted_x[n_v:]
    substitute(tangent, order, inner)
    for r in range(n_h):
        shared[r] -= dot(below[r], inner)
    substitute(corner, corner_order, shared)
    for c in range(n_h):
        for i in range(n_v):
            inner[i] -= across[c, i] * shared[c]
    for i in range(n_v + n_h):
        x[at[i]] = sorted_x[i]


@kernel
def linear_part_of_correction(
    start: Words,
    columns: Words,
    values: Floats,
    latest: Floats,
    before: Floats,
    share: float,
    place: Words,
    n_v: int,
    x: Floats,
    scratch: Floats,
    flow: Floats,
) -> None:
    """Subtract the product of the bearings' share of the tangent in use and `x` from `flow` (n_b,).

    `latest` and `before` (n, 12, 12) are the bearings' tangents in the shared blocks, and in V.
    From ``flow = T x`` it leaves the product of the structure alone and `x`.
    """
    inner, outer, on_v, on_h = scratch[0], scratch[1], scratch[2], scratch[3]
    for k in range(start.shape[0]):
        for row in range(12):
            inner[row], outer[row], on_v[row], on_h[row] = 0.0, 0.0, 0.0, 0.0
            for i in range(start[k, row], start[k, row + 1]):
                if place[columns[i]] < n_v:
                    inner[row] += values[i] * x[columns[i]]
                else:
                    outer[row] += values[i] * x[columns[i]]
        for row in range(12):
            if start[k, row] == start[k, row + 1]:
                continue
            for col in range(12):
                on_v[row] += before[k, row, col] * inner[col]
                on_v[row] += latest[k, row, col] * outer[col]
                on_h[row] += latest[k, row, col] * (inner[col] + outer[col])
            for i in range(start[k, row], start[k, row + 1]):
                force = on_v[row] if place[columns[i]] < n_v else on_h[row]
                flow[columns[i]] -= share * values[i] * force


@kernel
def with_secants(
    weights: Floats,
    taken: Floats,
    following: Floats,
    linear: Floats,
    sizes: Floats,
    count: int,
    x: Floats,
    flow: Floats,
) -> None:
    """Improve Newton's correction `x` by the residuals of those before it: Broyden's method.

    Kelley 1995, Iterative Methods for Linear and Nonlinear Equations, algorithm brsol. Its secants
    are valid as long as the tangent is. Shapes: weights (n_b,), taken and following (m, n_b),
    linear (m, n_s), sizes (m,), x (n_b,), flow (n_s,): the structure's product with `x`, or of size
    zero.
    """
    for j in range(count):
        along = 0.0
        for a in range(x.shape[0]):
            along += weights[a] * taken[j, a] * x[a]
        along /= sizes[j]
        for a in range(x.shape[0]):
            x[a] += along * following[j, a]
        for a in range(flow.shape[0]):
            flow[a] += along * linear[j, a]


@kernel
def keep_secant(
    weights: Floats,
    taken: Floats,
    following: Floats,
    linear: Floats,
    sizes: Floats,
    count: int,
    follows: bool,
    x: Floats,
    flow: Floats,
) -> int:
    """Keep the correction `x`, improved by the one that it `follows`; return how many secants."""
    if follows and sizes[count] > 0.0:
        along = 0.0
        for a in range(x.shape[0]):
            along += weights[a] * taken[count, a] * x[a]
        growth = 1.0 / max(1.0 - along / sizes[count], _LEAST)
        for a in range(x.shape[0]):
            x[a] *= growth
            following[count, a] = x[a]
        for a in range(flow.shape[0]):
            flow[a] *= growth
            linear[count, a] = flow[a]
        count = (count + 1) % sizes.shape[0]
    size = 0.0
    for a in range(x.shape[0]):
        taken[count, a] = x[a]
        size += weights[a] * x[a] * x[a]
    sizes[count] = size
    return count


@kernel
def goes_on_missing(weights: Floats, missed: Floats) -> bool:
    """Return True if the errors of guesses repeat, rather than vanish.

    Rows of `missed` (3, n_b): errors of the guesses of the last two steps.
    """
    before, change = 0.0, 0.0
    for a in range(weights.shape[0]):
        before += weights[a] * missed[0, a] ** 2
        change += weights[a] * (missed[0, a] - missed[1, a]) ** 2
    return change < before


@kernel
def carry_products(
    mass: Floats,
    damping: Floats,
    stiffness: Floats,
    step: Floats,
    rate: float,
    rest: float,
    dt: float,
    gamma: float,
    flows: Floats,
    held: Floats,
) -> None:
    """Update the products of mass, damping and stiffness (n_b, n_b) with the motion over a step.

    The acceleration after it is ``rate (step / dt - v) - rest a`` (`rates_after`). Rows of `flows`
    (6, n_b): mass by velocity and acceleration, damping by them, damping by the mean velocity, and
    scratch; `held` is stiffness by displacement.
    """
    n_b = step.shape[0]
    set_product(stiffness, step, flows[5])
    for a in range(n_b):
        held[a] += flows[5, a]
    for kind in range(2):
        if kind == 0:
            set_product(mass, step, flows[5])
        elif damping.shape[0] > 0:
            set_product(damping, step, flows[5])
        else:
            return
        v, w = flows[2 * kind], flows[2 * kind + 1]
        for a in range(n_b):
            after = rate * (flows[5, a] / dt - v[a]) - rest * w[a]
            before = v[a]
            v[a] += dt * ((1.0 - gamma) * w[a] + gamma * after)
            w[a] = after
            flows[4, a] = 0.5 * (before + v[a])
