"""Kernels that keep Newton's method from cycling across a rim.

If an interface slips soon after rim contact, the force over the displacement is flat, steep over
some tenths of a millimetre, and flat again. From either flat part Newton's method jumps across the
steep one, for ever. The residual of a correction at this bearing is its force less the linear
prediction. If the last corrections alternate without getting smaller, the solution is between, and
a stiffness along the line, ``left over / distance between``, halves the next correction. Before
that, a correction back is kept within `_REACH` times the displacement of the step. Both vanish with
the residual: solutions are the same, and so is the rate near them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import with_refcounts as kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats
    from lir_element.opensees.block.layout import Host

_ENOUGH = 2  # turns in a row
_SMALLER = 0.5  # of the step before: one that is smaller gets closer
_REACH = 8.0  # corrections back, over the displacement of the step
_CLOSE = 1e-12  # m, between two positions that are one


@kernel
def begin_iteration(h: Host, place: Floats, force: Floats) -> None:
    """Begin a step at the committed displacements, with the committed forces."""
    for k in range(12):
        h.last_u[k], h.last_force[k], h.start_u[k] = place[k], force[k], place[k]
    h.last_move[0], h.last_move[1] = 0.0, 0.0
    h.swings, h.left_known = 0, 0


@kernel
def follow_iteration(h: Host, force: Floats) -> None:
    """Follow an iteration of Newton's method: `force` belongs to `h.u`, in bearing axes.

    Constraint handlers ask twice for the same place: that is no iteration.
    """
    same = True
    for k in range(12):
        same = same and h.u[k] == h.last_u[k]
    if same:
        return
    turn = 0.0
    before = math.hypot(h.last_move[0], h.last_move[1])
    for a in range(2):
        h.move[a] = (h.u[6 + a] - h.u[a]) - (h.last_u[6 + a] - h.last_u[a])
        turn += h.move[a] * h.last_move[a]
    size = math.hypot(h.move[0], h.move[1])
    h.left_known = h.element_made
    if h.left_known == 0 or size == 0.0:
        h.swings = 0
    else:
        set_left_over(h, force)
        if h.swings <= _ENOUGH:
            h.swings = h.swings + 1 if turn < 0.0 and size > _SMALLER * before else 0
    for k in range(12):
        h.last_u[k], h.last_force[k] = h.u[k], force[k]
    for a in range(2):
        h.last_move[a] = h.move[a]


@kernel
def set_left_over(h: Host, force: Floats) -> None:
    """Set the residual of the last correction: the force on node j less the prediction."""
    for a in range(3):
        foretold = h.last_force[6 + a]
        for k in range(12):
            foretold += h.element[6 + a, k] * (h.u[k] - h.last_u[k])
        h.left_over[a] = force[6 + a] - foretold


@kernel
def pushed_back(h: Host) -> float:
    """Return the residual along the line once the axial force has found its balance [N]."""
    total = 0.0
    axial = h.element[8, 8]
    share = h.left_over[2] / axial if axial > 0.0 else 0.0
    for a in range(2):
        total += h.way[a] * (h.left_over[a] - share * h.element[6 + a, 8])
    return total


@kernel
def narrow(h: Host) -> float:
    """Bracket the solution; returns the stiffness that keeps the iteration in the bracket.

    It gives up (and returns 0) if no bracket exists.
    """
    if h.swings == _ENOUGH:  # the last two positions
        size = math.hypot(h.move[0], h.move[1])
        for a in range(2):
            h.way[a] = h.move[a] / size
        place = h.way[0] * (h.u[6] - h.u[0]) + h.way[1] * (h.u[7] - h.u[1])
        h.between[0], h.between[1] = place - size, place
    place = h.way[0] * (h.u[6] - h.u[0]) + h.way[1] * (h.u[7] - h.u[1])
    push = pushed_back(h)
    if h.swings == _ENOUGH and push <= 0.0:  # not too far yet
        h.swings = 1
        return 0.0
    h.swings = _ENOUGH + 1
    if push > 0.0:
        h.between[1] = min(place, h.between[1])
    else:
        h.between[0] = max(place, h.between[0])
    size = h.between[1] - h.between[0]
    if size < _CLOSE:
        h.swings = 0
        return 0.0
    return abs(push) / size


@kernel
def restrain(h: Host) -> float:
    """Return the stiffness that keeps a correction from going far behind the step's start.

    Beyond the rim the bearing's own stiffness may be zero. The residual of the steep part would
    then move the model back by many times the step, to a place without a state of the bearing.
    """
    size = 0.0
    for a in range(2):
        h.way[a] = (h.u[6 + a] - h.u[a]) - (h.start_u[6 + a] - h.start_u[a])
        size += h.way[a] * h.way[a]
    size = math.sqrt(size)
    if h.left_known == 0 or size < _CLOSE:
        return 0.0
    own = 0.0
    axial = h.element[8, 8]
    for a in range(2):
        h.way[a] /= size
    for a in range(2):
        for b in range(2):
            part = h.element[6 + a, 6 + b]
            if axial > 0.0:
                part -= h.element[6 + a, 8] * h.element[8, 6 + b] / axial
            own += h.way[a] * part * h.way[b]
    extra = pushed_back(h) / (_REACH * size)
    return extra if extra > max(own, 0.0) else 0.0


@kernel
def stiffen(h: Host) -> None:
    """Add the stiffness along the way to the tangent of an iteration that swings or soon would."""
    extra = narrow(h) if h.swings >= _ENOUGH else restrain(h)
    if extra == 0.0:
        return
    for a in range(2):
        for b in range(2):
            part = extra * h.way[a] * h.way[b]
            h.element[6 + a, 6 + b] += part
            h.element[a, b] += part
            h.element[6 + a, b] -= part
            h.element[a, 6 + b] -= part


@kernel
def make_symmetric(h: Host) -> None:
    """Replace the tangent by a symmetric one that is as definite as the bearing under its load.

    The axial force depends on displacements as in `h.element`, and acts on them as it would
    without friction; the rest, the stiffness under a constant axial force, is symmetrised. (The
    symmetric part of the whole tangent would be indefinite while the bearing slides.)
    """
    axial = h.element[8, 8]
    row = h.axial_row
    for k in range(12):
        row[k] = h.element[8, k] if axial > 0.0 else 0.0
    if axial > 0.0:
        for k in range(12):
            if k == 8:
                continue
            share = h.element[k, 8] / axial
            for m in range(12):
                h.element[k, m] -= share * row[m]
        for m in range(12):
            h.element[8, m] = 0.0
    for k in range(12):
        for m in range(k + 1):
            mean = 0.5 * (h.element[k, m] + h.element[m, k])
            if axial > 0.0:
                mean += row[k] * row[m] / axial
            h.element[k, m] = mean
            h.element[m, k] = mean
