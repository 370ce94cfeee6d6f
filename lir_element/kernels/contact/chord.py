"""Kernels of the quick search for the sliders: a chord method from the extrapolated place.

The inverse of Newton's matrix is kept from step to step, so that most iterations need forces alone;
derivatives are renewed if the time step differs or the residual falls too slowly. The kept data are
part of the committed state: a trial is a function of that and of its displacements. Only trials of
one step of a time history start from the result of the last one (`begin_trials`). If the search
finds nothing, `condensed` searches by Newton's method. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.pairs import add_up, clear_parts, hold_pairs, push_sliders
from lir_element.kernels.contact.places import OWN, place_bodies, turn_between, turn_by
from lir_element.kernels.contact.residual import (
    invert,
    longest,
    set_system,
    size_of_residual,
    small_forces,
    unbalanced,
)
from lir_element.kernels.contact.slider_motion import own_forces

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Bodies, Floats, Scratch, Search, Sliders

_SAME = 1e-6  # of the time step: round-off of times
_LIKE = 0.2  # of the time step, by which it may differ from that of the inverse (a choice)
_FALL = 0.1  # of the residual in an iteration, else derivatives are taken anew (a choice)
_MOST = 8  # iterations
_LARGEST_TURN = 0.01  # rad, of a body in one iteration, or times the slider's radius (a choice)


@kernel
def begin_search(new: Search) -> None:
    """Begin a trial: the inverse is that of the committed state, and no lead is known."""
    new.leads, new.renewed = 0, 0


@kernel
def forget(kept: Search) -> None:
    """Clear the kept data."""
    kept.leads, kept.inverse_step = 0, 0.0


@kernel
def keep_search(old: Search, new: Search) -> None:
    """Commit the data of a trial for the next search."""
    old.leads = new.leads
    if new.leads > 0:
        for k in range(2):
            for a in range(6):
                old.lead[k, a], old.lead_before[k, a] = new.lead[k, a], new.lead_before[k, a]
    if new.renewed != 0:
        old.inverse_step = new.inverse_step
        for col in range(12):
            for row in range(12):
                old.inverse[col, row] = new.inverse[col, row]


@kernel
def step_on(new: Bodies, w: Scratch) -> None:
    """Move the sliders by ``w.step``."""
    step = w.step
    for k in range(2):
        at = 6 * k
        for a in range(3):
            new.displacement[k, a] += step[at + a]
        turn_by(new.turn[k], step[at + 3], step[at + 4], step[at + 5], new.turn[k])


@kernel
def lead_on(s: BodyStep, dt: float) -> None:
    """Move the sliders from the start of a search by the last search's correction.

    That of the last trial of the step; else of the last step, which changes further as it did if
    three steps are equal.
    """
    old, trial, new, w = s.search_old, s.search_new, s.new, s.scratch
    for k in range(2):
        for a in range(3):
            w.start_displacement[k, a] = new.displacement[k, a]
        for a in range(4):
            w.start_turn[k, a] = new.turn[k, a]
    if trial.leads == 0 and old.leads == 0:
        return
    bend = 1.0 if old.leads > 1 and abs(dt - s.old.step) <= _SAME * dt else 0.0
    way = w.step
    for k in range(2):
        for a in range(6):
            last = old.lead[k, a]
            ahead = last + bend * (last - old.lead_before[k, a])
            way[6 * k + a] = trial.lead[k, a] if trial.leads > 0 else ahead
    step_on(new, w)


@kernel
def keep_lead(s: BodyStep, dt: float) -> None:
    """Keep the sliders' final place relative to the start of the search."""
    old, new, w, bodies = s.search_old, s.search_new, s.scratch, s.new
    for k in range(2):
        for a in range(3):
            new.lead[k, a] = bodies.displacement[k, a] - w.start_displacement[k, a]
        x, y, z = turn_between(w.start_turn[k], bodies.turn[k])
        new.lead[k, 3], new.lead[k, 4], new.lead[k, 5] = x, y, z
        for a in range(6):
            new.lead_before[k, a] = old.lead[k, a]
    new.leads = 1
    if old.leads > 0 and abs(dt - s.old.step) <= _SAME * dt:
        new.leads = 2


@kernel
def keep_inverse(w: Scratch, new: Search, dt: float) -> None:
    """Keep the inverse that stands in ``w.joint``."""
    for col in range(12):
        for row in range(12):
            new.inverse[col, row] = w.joint[col, 12 + row]
    new.renewed, new.inverse_step = 1, dt


@kernel
def renew_inverse(s: BodyStep, dt: float) -> bool:
    """Renew the inverse from the present derivative; False if there is none."""
    set_system(s, dt)
    if not invert(s.scratch):
        return False
    keep_inverse(s.scratch, s.search_new, dt)
    return True


@kernel
def chord_direction(c: Sliders, w: Scratch, inverse: Floats) -> bool:
    """Set ``w.step`` from the residual; False if it is too long."""
    step, r = w.step, w.residual
    for row in range(12):
        step[row] = 0.0
    for col in range(12):
        for row in range(12):
            step[row] += inverse[col, row] * r[col]
    return longest(step, 2, c.radius) <= _LARGEST_TURN


@kernel
def weigh(s: BodyStep, dt: float) -> float:
    """Set the forces of discs and rims, and ``w.residual``; return its size.

    As `unbalanced`, whose forces by origin are left as they are.
    """
    c, w = s.sliders, s.scratch
    place_bodies(c, w, s.new, 1, 3)
    hold_pairs(s, dt, 0.0, 0.0, False)
    own_forces(s, dt, 1)
    own_forces(s, dt, 2)
    part = s.new.parts[OWN]
    for row in range(12):
        w.residual[row] = part[6 + row]
    push_sliders(s, w.residual)
    return size_of_residual(c, w)


@kernel
def seek(s: BodyStep, dt: float, speeds: Floats) -> int:
    """Find the sliders' equilibrium from their present place; return iterations, -1 if none."""
    p, c, w = s.props, s.sliders, s.scratch
    kept = s.search_new if s.search_new.renewed != 0 else s.search_old
    fresh = abs(kept.inverse_step - dt) > _LIKE * dt
    inverse = kept.inverse
    before = math.inf
    size = unbalanced(s, dt, speeds, True) if fresh else weigh(s, dt)
    for count in range(_MOST):
        if not size < before:
            return -1
        if size <= small_forces(p, c, s.touch_new, dt):
            if w.derived == 0:
                clear_parts(s.new.parts)
                add_up(s)
            return count
        fresh = fresh or size > _FALL * before or not chord_direction(c, w, inverse)
        if fresh:
            if w.derived == 0:
                unbalanced(s, dt, speeds, True)
            if not renew_inverse(s, dt):
                return -1
            inverse, fresh = s.search_new.inverse, False
            if not chord_direction(c, w, inverse):
                return -1
        step_on(s.new, w)
        before = size
        size = weigh(s, dt)
    return -1
