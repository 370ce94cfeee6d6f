"""Kernels that call the level of a bearing's model: trial, tangent, commit.

`contacts` is None if all bearings are at the level 'pendulum' (the other level is then not even
compiled); otherwise it lists the bearings with contact points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_before_typing, kernel
from lir_element.bundles.contact_data import BodyStep
from lir_element.errors import RunStatus
from lir_element.kernels.backup import (
    backup_accumulate,
    backup_defect,
    backup_tangent,
    backup_trial,
    give_up,
)
from lir_element.kernels.contact.chord import begin_search, keep_search
from lir_element.kernels.contact.condensed import contact_tangent, contact_trial, look_at_committed
from lir_element.kernels.contact.state import contact_accumulate, points_defect
from lir_element.kernels.friction_law import heat_up
from lir_element.kernels.linear import copy_words
from lir_element.kernels.pendulum.nodes import fill_tangent
from lir_element.kernels.pendulum.trial import trial
from lir_element.kernels.pendulum.work import accumulate, contact_defect

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats, Records, Words

_OK = int(RunStatus.OK)


@inlined_before_typing
def bodies_of(props: Records, contacts: Contacts, k: int, at: int) -> BodyStep:
    """Return the bodies of bearing `k`, which stand at `at` in `contacts`."""
    return BodyStep(
        props[k],
        contacts.sliders[at],
        contacts.points[at],
        contacts.bodies_old[at],
        contacts.bodies_new[at],
        contacts.touch_old[at],
        contacts.touch_new[at],
        contacts.search_old[at],
        contacts.search_new[at],
        contacts.scratch[at],
    )


@kernel
def begin_trials(contacts: Contacts | None) -> None:
    """Begin the trials of a step, each of which starts from the result of the last one."""
    if contacts is None:
        return
    for at in range(contacts.search_new.shape[0]):
        begin_search(contacts.search_new[at])
        contacts.search_new[at].follows = 1


@kernel
def bearing_trial(
    props: Records,
    old: Records,
    new: Records,
    work: Records,
    contacts: Contacts | None,
    k: int,
    u: Floats,
    v: Floats,
    time: float,
) -> int:
    """Determine the state of bearing `k`; returns a RunStatus code."""
    if old[k].failed != 0:
        return backup_trial(props[k], old[k], new[k], work[k], u, v, time)
    new[k].failed = 0
    if contacts is not None:
        at = contacts.row[k]
        if at >= 0:
            bodies = bodies_of(props, contacts, k, at)
            return contact_trial(bodies, old[k], new[k], work[k], u, v, time)
    return trial(props[k], old[k], new[k], work[k], u, v, time)


@kernel
def bearing_tangent(
    props: Records,
    new: Records,
    work: Records,
    contacts: Contacts | None,
    k: int,
    tangent: Floats,
) -> None:
    """Fill the tangent (12, 12) of bearing `k`'s last trial."""
    if new[k].failed != 0:
        backup_tangent(props[k], work[k], new[k], tangent)
        return
    if contacts is not None:
        at = contacts.row[k]
        if at >= 0:
            contact_tangent(bodies_of(props, contacts, k, at), work[k], tangent)
            return
    fill_tangent(props[k], work[k], new[k].force, tangent)


@kernel
def bearing_commit(
    props: Records,
    old: Records,
    new: Records,
    old_words: Words,
    new_words: Words,
    heat: Floats,
    contacts: Contacts | None,
    k: int,
) -> None:
    """Accept the trial state of bearing `k`; `heat` as in `heat_parts`.

    A bearing with a backup fails if a limit is exceeded.
    """
    if new[k].failed != 0:
        backup_accumulate(props[k], old[k], new[k])
        copy_words(new_words[k], old_words[k])
        return
    if contacts is not None:
        at = contacts.row[k]
        if at >= 0:
            contact_accumulate(bodies_of(props, contacts, k, at), old[k], new[k], 2)
            if props[k].heats:
                heat_up(props[k], heat[k], old[k], new[k])
            keep_search(contacts.search_old[at], contacts.search_new[at])
            copy_words(contacts.bodies_new_words[at], contacts.bodies_old_words[at])
            copy_words(contacts.touch_new_words[at], contacts.touch_old_words[at])
            copy_words(new_words[k], old_words[k])
            leave_failed(props, old, old_words, new_words, k)
            return
    accumulate(props[k], old[k], new[k])
    if props[k].heats:
        heat_up(props[k], heat[k], old[k], new[k])
    copy_words(new_words[k], old_words[k])
    leave_failed(props, old, old_words, new_words, k)


@kernel
def leave_failed(props: Records, old: Records, old_words: Words, new_words: Words, k: int) -> None:
    """Replace a bearing that was committed beyond a limit by its backup, if it has one."""
    if old[k].status != _OK and props[k].goes_on:
        give_up(old[k], old[k].status)
        copy_words(old_words[k], new_words[k])


@kernel
def bearing_defect(
    props: Records, old: Records, new: Records, contacts: Contacts | None, k: int
) -> float:
    """Return the energy that bearing `k`'s contacts make or lose in the step by its size."""
    if new[k].failed != 0:
        return backup_defect(props[k], old[k], new[k])
    if contacts is not None:
        at = contacts.row[k]
        if at >= 0:
            return points_defect(bodies_of(props, contacts, k, at))
    return contact_defect(props[k], old[k], new[k])


@kernel
def bearing_look(
    props: Records, old: Records, work: Records, contacts: Contacts | None, k: int
) -> None:
    """Prepare the static tangent of bearing `k`'s committed state, which has contact points."""
    if contacts is None:
        return
    work[k].dt = 0.0
    look_at_committed(bodies_of(props, contacts, k, contacts.row[k]), old[k])
