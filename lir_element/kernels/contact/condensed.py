"""Kernels of the level 'contact': both sliders as bodies, their equilibrium found in the element.

The quick search of `chord` comes first. If it finds nothing, Newton's method starts from the
sliders' motion with the plates, then from the state of the level 'pendulum'; if none leads to a
static state, softer friction does. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.contact.chord import begin_search, keep_inverse, keep_lead, lead_on, seek
from lir_element.kernels.contact.pairs import press
from lir_element.kernels.contact.places import place_bodies, turn_by
from lir_element.kernels.contact.residual import (
    HOLD,
    invert,
    longest,
    set_system,
    small_forces,
    solve_one,
    unbalanced,
)
from lir_element.kernels.contact.slider_motion import set_momentum
from lir_element.kernels.contact.start import (
    carry_on,
    fly_on,
    follow_string,
    place_nodes,
    turn_back,
)
from lir_element.kernels.contact.state import bodies_status, fill_state
from lir_element.kernels.friction_law import least, left_by_heat, left_by_pressure
from lir_element.kernels.pendulum.nodes import add_twist, apply_spin
from lir_element.kernels.pendulum.trial import has_no_state, is_finite, trial

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import (
        Bodies,
        Floats,
        Props,
        Scratch,
        Sliders,
        State,
        Work,
    )

_OK = int(RunStatus.OK)
_NOT_FINITE = int(RunStatus.NOT_FINITE)
_NO_EQUILIBRIUM = int(RunStatus.NO_EQUILIBRIUM)
_SPHERE_EXCEEDED = int(RunStatus.SPHERE_EXCEEDED)
_MAX_ITERATIONS = 40
_PATIENCE = 10  # iterations in which the residual must halve
LARGEST_TURN = 0.1  # rad, of a body in one iteration
SHORTER = 0.35  # of a step that does not do: between 1/10 and 1/2 (Dennis and Schnabel 1983, 6.3.2)
_TRIES = 5  # of a step: the last one is 0.35^4, 1.5 % of it (a choice)
_LEAPS = 3  # whole steps taken although the residual grows (a choice)
_GAIN = 0.9  # of the residual, with which a step does; else the best of them is taken (a choice)
_SOFTEST = 1e-2  # stiffness of the pendulum over that of friction, at the first softening
_STIFFER = 0.3  # by which it is brought down: some three iterations a stage (a choice)


@kernel
def first_share(new: Bodies, w: Scratch, bodies: int, length: float) -> float:
    """Keep the bodies' turns, and return how much of ``w.step`` to try first.

    No body turns by more than `LARGEST_TURN`, or moves by more than that times `length`.
    """
    largest = longest(w.step, bodies, length)
    for k in range(bodies):
        for a in range(4):
            w.try_turn[k, a] = new.turn[k, a]
    return min(1.0, LARGEST_TURN / largest) if largest > 0.0 else 1.0


@kernel
def newton_direction(c: Sliders, new: Bodies, w: Scratch) -> float:
    """Set ``w.step`` of both sliders; return the first factor to try, 0 if it is singular."""
    for row in range(12):
        w.joint[row, 12] = w.residual[row]
    if not solve_one(w, w.step):
        return 0.0
    return first_share(new, w, 2, c.radius)


@kernel
def move_sliders(new: Bodies, w: Scratch, factor: float) -> None:
    """Move the sliders by `factor` times ``w.step`` from the start of the iteration."""
    for k in range(2):
        for a in range(3):
            new.displacement[k, a] = w.try_displacement[k, a] + factor * w.step[6 * k + a]
        turn_by(
            w.try_turn[k],
            factor * w.step[6 * k + 3],
            factor * w.step[6 * k + 4],
            factor * w.step[6 * k + 5],
            new.turn[k],
        )


@kernel
def balance_sliders(s: BodyStep, dt: float, speeds: Floats) -> int:
    """Find the sliders' equilibrium from their present place; return iterations, -1 if none."""
    p, c, w = s.props, s.sliders, s.scratch
    new, touch_new = s.new, s.touch_new
    size = unbalanced(s, dt, speeds, True)
    mark, leaps = size, 0
    most = _LEAPS if dt > 0.0 and s.points[0].disc > 0.0 else 0
    for count in range(_MAX_ITERATIONS):
        if not math.isfinite(size):
            return -1
        if dt > 0.0 and count > 0 and count % _PATIENCE == 0:  # a smaller step does better
            if size > 0.5 * mark:
                return -1
            mark = size
        if size <= small_forces(p, c, touch_new, dt):
            return count
        if w.derived == 0:
            unbalanced(s, dt, speeds, True)
        set_system(s, dt)
        factor = newton_direction(c, new, w)
        if factor == 0.0:
            return -1
        for k in range(2):
            for a in range(3):
                w.try_displacement[k, a] = new.displacement[k, a]
        best, kept, whole = math.inf, factor, factor
        for _ in range(_TRIES):
            move_sliders(new, w, factor)
            attempt = unbalanced(s, dt, speeds, factor == whole)
            if attempt < best:
                best, kept = attempt, factor
            if attempt < _GAIN * size or attempt <= small_forces(p, c, touch_new, dt):
                break
            factor *= SHORTER
        if leaps < most and best >= _GAIN * size:  # a corner: contacts open or close beyond it
            leaps += 1
            kept = whole
            mark = math.inf
        if factor != kept or best >= size:
            move_sliders(new, w, kept)
            best = unbalanced(s, dt, speeds, False)
        size = best
    return -1


@kernel
def soften(p: Props, w: Scratch, softness: float) -> bool:
    """Set the least way to slip of all contacts by (5.4); return whether any is above its own."""
    way = softness * p.length
    is_softer = False
    for side in range(2):
        w.soft_low[side] = way * least(p, side)
        is_softer = is_softer or w.soft_low[side] > p.yield_displacement[side]
    w.soft_high = 0.0 if p.fused else way * p.interface_friction
    return is_softer or w.soft_high > p.interface_yield


@kernel
def balance_by_softer_friction(s: BodyStep, pen: Work) -> int:
    """Find the sliders' static equilibrium with softer friction first; -1 if none.

    Full contact makes both surfaces slide if plates tilt, by their radius times the tilt. Bodies
    rock instead if that is more than the displacement before slip: from there the search starts too
    far off.
    """
    p, w = s.props, s.scratch
    softness = _SOFTEST
    is_softer = soften(p, w, softness)
    follow_string(p, s.sliders, s.new, w, pen)
    count = 0
    while is_softer and count >= 0:
        count = balance_sliders(s, 0.0, pen.static_speed)
        softness *= _STIFFER
        is_softer = soften(p, w, softness)
    soften(p, w, 0.0)
    return balance_sliders(s, 0.0, pen.static_speed) if count >= 0 else -1


@kernel
def set_losses(p: Props, old: State, w: Scratch) -> None:
    """Set the share of friction that pressure and temperature of the committed state take.

    An unloaded bearing is taken to be under the pressure that its friction belongs to.
    """
    load = old.axial_force if old.axial_force > 0.0 else p.pressure_load
    for k in range(2):
        w.lost[k] = 1.0 - left_by_pressure(p, load) * left_by_heat(p, old.temperature[k])


@kernel
def go_on(s: BodyStep, old: State, dt: float, speeds: Floats) -> int:
    """Find the sliders' equilibrium from their motion with the plates; see `carry_on`."""
    lead_on(s, dt)
    count = seek(s, dt, speeds)
    if count < 0:
        begin_search(s.search_new)
        carry_on(s, old, dt)
        count = balance_sliders(s, dt, speeds)
    if count >= 0:
        keep_lead(s, dt)
    return count


@kernel
def contact_trial(
    s: BodyStep, old: State, new: State, pen: Work, u: Floats, v: Floats, time: float
) -> int:
    """Determine the state at displacements `u`, velocities `v` (12,) and `time`.

    Returns a RunStatus code; the committed state is read, never written.
    """
    p, c, w = s.props, s.sliders, s.scratch
    b_old, b_new = s.old, s.new
    if not (math.isfinite(time) and is_finite(u) and is_finite(v)):
        return _NOT_FINITE
    dt = max(time - old.time, 0.0)
    pen.dt = dt
    set_losses(p, old, w)
    place_nodes(p, c, w, u)
    count = -1
    if s.search_new.follows == 0:
        begin_search(s.search_new)
    set_momentum(s)
    if dt > 0.0 and s.points[0].disc > 0.0:
        if carry_on(s, old, dt):
            count = go_on(s, old, dt, pen.static_speed)
        elif s.search_new.follows == 2:  # from the sliders' place after the last trial
            count = seek(s, dt, pen.static_speed)
    if count < 0:
        code = trial(p, old, new, pen, u, v, time)
        if code in (_NOT_FINITE, _SPHERE_EXCEEDED):
            return code
        aloft = old.axial_force == 0.0 and dt > 0.0
        for attempt in range(2):
            if count >= 0:
                break
            turn_back(b_old, b_new)
            if (attempt == 0) == aloft or (has_no_state(code) and dt > 0.0):
                fly_on(b_old, b_new, dt)
            else:
                follow_string(p, c, b_new, w, pen)
            count = balance_sliders(s, dt, pen.static_speed)
    if count < 0 and dt == 0.0:
        turn_back(b_old, b_new)
        count = balance_by_softer_friction(s, pen)
    if s.search_new.follows > 0:
        s.search_new.follows = 2 if count >= 0 else 1
    fill_state(s, old, new, u)
    new.time, new.step = time, dt
    new.iterations = count
    status = bodies_status(p, w, new)
    if count < 0 and status != _NOT_FINITE:
        status = _NO_EQUILIBRIUM
    new.status = status
    return status


@kernel
def look_at_committed(s: BodyStep, old: State) -> None:
    """Set forces and derivative at the committed state, as a static one, without moving it."""
    p, c, w = s.props, s.sliders, s.scratch
    b_old, b_new = s.old, s.new
    set_losses(p, old, w)
    place_nodes(p, c, w, old.displacement)
    for k in range(2):
        for a in range(3):
            b_new.displacement[k, a] = b_old.displacement[k, a]
        for a in range(4):
            b_new.turn[k, a] = b_old.turn[k, a]
    place_bodies(c, w, b_new, 1, 3)
    press(s, 0.0, old.sliding_speed[0], old.sliding_speed[1], True)


@kernel
def condense(w: Scratch, k: Floats) -> None:
    """Subtract the sliders' condensed share from the nodes' stiffness `k` (7.6).

    The inverse stands in ``w.joint``. A node touches one slider: ``w.follow`` (12, 12) is the
    motion of both sliders for one of its nodes' displacements.
    """
    inverse, follow = w.joint, w.follow
    for b in range(2):
        k_yu = w.k[6 + 6 * b : 12 + 6 * b, 18 * b : 18 * b + 6]
        for row in range(12):
            for col in range(6):
                total = 0.0
                for e in range(6):
                    total += inverse[6 * b + e, 12 + row] * k_yu[e, col]
                follow[row, 6 * b + col] = total
    for b in range(2):
        k_uy = w.k[18 * b : 18 * b + 6, 6 + 6 * b : 12 + 6 * b]
        for a in range(6):
            for col in range(12):
                total = 0.0
                for e in range(6):
                    total += k_uy[a, e] * follow[6 * b + e, col]
                k[6 * b + a, col] -= total


@kernel
def contact_tangent(s: BodyStep, pen: Work, k: Floats) -> None:
    """Fill the 12 x 12 tangent `k` of the trial in the scratch, sliders condensed.

    Plates on surfaces without friction have no resistance to rotation about the vertical: in a
    static state they are held as loose sliders are, because round-off would decide their rotation.
    """
    c, w, dt = s.sliders, s.scratch, pen.dt
    if w.derived == 0:
        unbalanced(s, dt, pen.static_speed, True)
    set_system(s, dt)
    for row in range(12):
        at = row if row < 6 else row + 12
        for col in range(6):
            k[row, col], k[row, 6 + col] = -w.k[at, col], -w.k[at, 18 + col]
    if invert(w):
        condense(w, k)
        if s.search_new.follows > 0 and dt > 0.0:
            keep_inverse(w, s.search_new, dt)
    apply_spin(w.spin_i, k, 3)
    apply_spin(w.spin_j, k, 9)
    if dt == 0.0:
        add_twist(k, HOLD * c.stiffness * c.radius**2)
