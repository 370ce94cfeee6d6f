"""Kernels of bearings that fail: whether the run ends by it, or goes on with their backups."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.backup import give_up
from lir_element.kernels.linear import copy_words
from lir_element.kernels.pendulum.trial import is_about_to_snap

if TYPE_CHECKING:
    from lir_element.layout import Records, Words

_OK = int(RunStatus.OK)
_SLIP_UNSTABLE = int(RunStatus.SLIP_UNSTABLE)
_SPHERE_EXCEEDED = int(RunStatus.SPHERE_EXCEEDED)


@kernel
def ends_run(props: Records, new: Records) -> int:
    """Return the first bearing beyond a limit by which the run ends, -1 if it goes on.

    It ends by a bearing without a backup, and when no bearing is left and no stop below one.
    """
    first, carries = -1, False
    for k in range(props.shape[0]):
        fails = new[k].status != _OK
        if fails and not props[k].goes_on:
            return k
        if fails and first < 0:
            first = k
        stands = not fails and new[k].failed == 0
        carries = carries or stands or props[k].backup_drop < math.inf
    return -1 if carries else first


@kernel
def lose_bearing(
    props: Records, old: Records, old_words: Words, new_words: Words, cause: int, at: int
) -> bool:
    """Replace the bearing without a step by its backup; returns True if there is one.

    Its slip is about to snap, or it has left the spheres: `cause`, of bearing `at`.
    """
    found, code = -1, _SLIP_UNSTABLE
    if cause in (_SLIP_UNSTABLE, _SPHERE_EXCEEDED):
        found, code = at, cause
    else:
        for k in range(props.shape[0]):
            if is_about_to_snap(props[k], old[k]):
                found = k
                break
    if found < 0 or not props[found].goes_on or old[found].failed != 0:
        return False
    give_up(old[found], code)
    copy_words(old_words[found], new_words[found])
    return True
