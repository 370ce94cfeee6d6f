"""Kernels of a bearing in a foreign model: trial, tangent, commit, revert, record.

They read and write the bearing's block (`layout.HOST`). The bearing's own axes are those of
`Element`; a map (direction cosines, unit of length) leads there from the model's degrees of
freedom.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba import carray

from lir_element._compile.jit import with_refcounts as kernel
from lir_element.bundles.contact_data import Contacts
from lir_element.errors import RunStatus
from lir_element.kernels.contact.chord import forget
from lir_element.kernels.levels import bearing_commit, bearing_look, bearing_tangent, bearing_trial
from lir_element.kernels.linear import copy_words, gather, scatter
from lir_element.kernels.pendulum.trial import has_no_state
from lir_element.layout import (
    BODIES,
    HEAT_PARTS,
    POINT,
    PROPS,
    SCRATCH,
    SEARCH,
    SLIDERS,
    STATE,
    TOUCH,
    WORK,
)
from lir_element.opensees.block.layout import (
    BODY_WORDS,
    LOAD_HIGH,
    LOAD_LOW,
    NEVER_LOADED,
    NUMBERS,
    RECORD_WORDS,
    STATE_WORDS,
    TOLD_ENOUGH,
    WORDS,
)
from lir_element.opensees.block.pointers import call_2, pointer
from lir_element.opensees.kernels.newton_cycling import (
    begin_iteration,
    follow_iteration,
    make_symmetric,
    stiffen,
)

if TYPE_CHECKING:
    from lir_element.layout import Floats
    from lir_element.opensees.block.layout import Host

_OK = int(RunStatus.OK)
_NOT_FINITE = int(RunStatus.NOT_FINITE)
_TELLINGS = 10  # refusals of a bearing with a message
_FAR = 8.0  # axial force over the design load, or the reverse: g, kN and kip are further
_TOUCH_WORDS = TOUCH.itemsize // 8


@kernel
def contacts_at(h: Host) -> Contacts:
    """Return the contact points of a bearing at the level 'contact'."""
    m = h.point_count
    return Contacts(
        carray(pointer(h.row), 1, WORDS),
        carray(pointer(h.sliders), 1, SLIDERS),
        carray(pointer(h.points), (1, m), POINT),
        carray(pointer(h.bodies_old), 1, BODIES),
        carray(pointer(h.bodies_new), 1, BODIES),
        carray(pointer(h.touch_old), (1, m), TOUCH),
        carray(pointer(h.touch_new), (1, m), TOUCH),
        carray(pointer(h.bodies_old), (1, BODY_WORDS), WORDS),
        carray(pointer(h.bodies_new), (1, BODY_WORDS), WORDS),
        carray(pointer(h.touch_old), (1, m * _TOUCH_WORDS), WORDS),
        carray(pointer(h.touch_new), (1, m * _TOUCH_WORDS), WORDS),
        carray(pointer(h.search_old), 1, SEARCH),
        carray(pointer(h.search_new), 1, SEARCH),
        carray(pointer(h.scratch), 1, SCRATCH),
    )


@kernel
def set_force(h: Host, force: Floats) -> None:
    """Set the block's force to that of the bearing, in the model's degrees of freedom."""
    for k in range(h.dofs):
        h.force[k] = 0.0
    scatter(h.start, h.columns, h.values, h.force_factor, force, h.force)


@kernel
def map_tangent(h: Host) -> None:
    """Set the block's tangent, by columns, from the bearing's."""
    n = h.dofs
    for k in range(n * n):
        h.tangent[k] = 0.0
    for row in range(12):
        for col in range(12):
            value = h.force_factor * h.element[row, col]
            if value == 0.0:
                continue
            for i in range(h.start[row], h.start[row + 1]):
                part = h.values[i] * value
                for j in range(h.start[col], h.start[col + 1]):
                    h.tangent[n * h.columns[j] + h.columns[i]] += part * h.values[j]


@kernel
def host_trial(h: Host, contacts: Contacts | None, dt: float) -> int:
    """Determine the trial state at `host_u`, `host_v`, a step `dt` after the last commit.

    A trial at rest (all velocities exactly zero) is static: its time is no time. A step of 0 in a
    motion is one of which the integrator sets the time later: until then it is as long as the last
    one. At the committed
    place a moving bearing has the committed force: an explicit integrator asks for it there with
    velocities that are none. Returns a RunStatus code; a committed state beyond a limit of the
    bearing is refused here.
    """
    old = carray(pointer(h.old), 1, STATE)
    new = carray(pointer(h.new), 1, STATE)
    gather(h.start, h.columns, h.values, h.host_u, h.u)
    gather(h.start, h.columns, h.values, h.host_v, h.v)
    moves = False
    for k in range(h.dofs):
        moves = moves or h.host_v[k] != 0.0
    away = False
    for k in range(12):
        away = away or h.u[k] != old[0].displacement[k]
    begins = moves and not away
    if away or h.time > h.committed_time:
        h.unfinished = 1
    h.telling = 0
    h.has_tangent = 0
    if old[0].status != _OK:
        return refuse(h, old[0].status)
    look_at_load(h, old[0].axial_force, moves)
    h.step = 0.0 if not moves else dt if dt > 0.0 else h.last_step
    time = old[0].time + h.step
    code = bearing_trial(
        carray(pointer(h.props), 1, PROPS),
        old,
        new,
        carray(pointer(h.work), 1, WORK),
        contacts,
        0,
        h.u,
        h.v,
        time,
    )
    if has_no_state(code):
        if begins and contacts is not None:
            return stand(h, code, old[0].force)
        return refuse(h, code)
    h.last_status = _OK
    follow_iteration(h, new[0].force)
    h.element_made = 0
    set_force(h, old[0].force if begins else new[0].force)
    return _OK


@kernel
def host_retry(h: Host, contacts: Contacts | None) -> None:
    """Determine the state anew at the motion that is committed, the step `step` after the last one.

    Without a state there the committed one stays, and says so: later trials are refused.
    """
    if h.step <= 0.0:
        h.last_step = 0.0  # the time was set back
    code = host_trial(h, contacts, h.step)
    if code != _OK and h.has_tangent != 2:
        carray(pointer(h.old), 1, STATE)[0].status = code


@kernel
def stand(h: Host, code: int, force: Floats) -> int:
    """Keep the committed force and tangent if a step begins without a state.

    Newmark's method begins a step at the committed place with reversed velocities, and no motion of
    the sliders may fit them. That trial cannot be committed.
    """
    h.last_status = code
    h.element_made, h.has_tangent = 0, 2
    set_force(h, force)
    return _OK


@kernel
def refuse(h: Host, code: int) -> int:
    """Keep the reason that a trial has no state, and request a message: once a step."""
    h.last_status = code
    h.element_made = 0
    if h.refused == _OK:
        h.refused = code
        h.told += 1
        if h.told < _TELLINGS:
            h.telling = NEVER_LOADED if h.loaded == 0 and code != _NOT_FINITE else code
        elif h.told == _TELLINGS:
            h.telling = TOLD_ENOUGH
    return code


@kernel
def look_at_load(h: Host, axial_force: float, moves: bool) -> None:
    """Compare the axial force at rest with the design load, once: units are easily mistaken."""
    if h.load_seen == 1:
        return
    if axial_force > _FAR * h.design_load:
        h.load_seen, h.telling = 1, LOAD_HIGH
    elif moves and h.loaded == 1:
        h.load_seen = 1
        if axial_force * _FAR < h.design_load:
            h.telling = LOAD_LOW


@kernel
def host_tangent(h: Host, contacts: Contacts | None) -> None:
    """Set the block's tangent to that of the last trial, or of the committed state after it.

    A bearing that never carried load has the stiffness at rest, so that an analysis can begin; so
    has a trial without a state, unless it stands (`stand`).
    """
    if h.has_tangent == 1:
        return
    new = carray(pointer(h.new), 1, STATE)
    stands = h.has_tangent == 2
    no_state = h.last_status != _OK and not stands
    if no_state or (h.loaded == 0 and new[0].axial_force <= 0.0):
        for k in range(h.dofs * h.dofs):
            h.tangent[k] = h.initial[k]
        h.has_tangent = 1
        return
    props = carray(pointer(h.props), 1, PROPS)
    work = carray(pointer(h.work), 1, WORK)
    if stands:
        bearing_look(props, carray(pointer(h.old), 1, STATE), work, contacts, 0)
    bearing_tangent(props, new, work, contacts, 0, h.element)
    stiffen(h)
    if h.symmetric == 1:
        make_symmetric(h)
    map_tangent(h)
    h.element_made = 1
    h.has_tangent = 1


@kernel
def host_commit(h: Host, contacts: Contacts | None) -> None:
    """Accept the trial state, and record it if it is its turn.

    A trial without a state is not accepted, for any action of OpenSees.
    """
    if h.last_status != _OK:
        return
    old = carray(pointer(h.old), 1, STATE)
    new = carray(pointer(h.new), 1, STATE)
    bearing_commit(
        carray(pointer(h.props), 1, PROPS),
        old,
        new,
        carray(pointer(h.old), (1, STATE_WORDS), WORDS),
        carray(pointer(h.new), (1, STATE_WORDS), WORDS),
        carray(pointer(h.heat), (1, 3, HEAT_PARTS), NUMBERS),
        contacts,
        0,
    )
    if contacts is not None and h.has_tangent == 0:
        h.has_tangent = 2
    if old[0].axial_force > 0.0:
        h.loaded = 1
    h.commits += 1
    h.committed_time = h.time
    if h.step > 0.0:
        h.last_step = h.step
    h.refused, h.unfinished, h.failures = _OK, 0, 0
    begin_iteration(h, old[0].displacement, old[0].force)
    if h.record_every > 0:
        h.record_left -= 1
        if h.record_left <= 0:
            h.record_left = h.record_every
            record_state(h)


@kernel
def record_state(h: Host) -> None:
    """Append the committed state to the recorded ones; memory that runs out ends the recording."""
    if h.record_count == h.record_room:
        room = 2 * h.record_room + 64
        memory = call_2(h.realloc, h.record, 8 * RECORD_WORDS * room)
        if memory == 0:
            h.record_every = -1
            return
        h.record, h.record_room = memory, room
    address = h.record + 8 * RECORD_WORDS * h.record_count
    head = carray(pointer(address), 4, NUMBERS)
    head[0] = h.time
    for a in range(3):
        head[1 + a] = h.v[6 + a] - h.v[a]
    copy_words(
        carray(pointer(h.old), STATE_WORDS, WORDS),
        carray(pointer(address + 32), STATE_WORDS, WORDS),
    )
    if h.bodies_old != 0:
        copy_words(
            carray(pointer(h.bodies_old), BODY_WORDS, WORDS),
            carray(pointer(address + 32 + 8 * STATE_WORDS), BODY_WORDS, WORDS),
        )
    h.record_count += 1


@kernel
def host_revert(h: Host) -> None:
    """Drop the trial: the next one starts from the committed state."""
    copy_words(
        carray(pointer(h.old), STATE_WORDS, WORDS), carray(pointer(h.new), STATE_WORDS, WORDS)
    )
    old = carray(pointer(h.old), 1, STATE)
    set_force(h, old[0].force)
    h.last_status = old[0].status
    begin_iteration(h, old[0].displacement, old[0].force)
    h.has_tangent = 0 if h.bodies_old == 0 else 2


@kernel
def host_restart(h: Host) -> None:
    """Reset the bearing to its start: undeformed and unloaded."""
    copy_words(
        carray(pointer(h.first), STATE_WORDS, WORDS), carray(pointer(h.old), STATE_WORDS, WORDS)
    )
    heat = carray(pointer(h.heat), 3 * HEAT_PARTS, NUMBERS)
    for k in range(3 * HEAT_PARTS):
        heat[k] = 0.0
    if h.bodies_old != 0:
        copy_words(
            carray(pointer(h.bodies_first), BODY_WORDS, WORDS),
            carray(pointer(h.bodies_old), BODY_WORDS, WORDS),
        )
        count = h.point_count * _TOUCH_WORDS
        copy_words(
            carray(pointer(h.touch_first), count, WORDS),
            carray(pointer(h.touch_old), count, WORDS),
        )
        forget(carray(pointer(h.search_old), 1, SEARCH)[0])
    h.time, h.committed_time, h.loaded = 0.0, 0.0, 0
    h.step, h.last_step = 0.0, 0.0
    h.record_count, h.commits = 0, 0
    h.refused, h.unfinished, h.failures, h.load_seen = _OK, 0, 0, 0
    host_revert(h)
