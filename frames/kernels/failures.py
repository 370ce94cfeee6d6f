"""Kernels of bearings that fail: whether the run ends by it, or goes on with their backups."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.backup import give_up
from lir_element.kernels.pendulum.trial import SNAPS, copy_words, last_slip

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
    carries = False
    for k in range(props.shape[0]):
        if new[k].status != _OK and not props[k].goes_on:
            return k
        fails = new[k].status != _OK or new[k].failed != 0
        carries = carries or not fails or props[k].backup_drop < math.inf
    if carries:
        return -1
    for k in range(props.shape[0]):
        if new[k].status != _OK:
            return k
    return -1


@kernel
def lose_bearing(
    props: Records, old: Records, old_words: Words, new_words: Words, cause: int, at: int
) -> bool:
    """Leave to its backup the bearing by which no step is found; returns whether there is one.

    Its slip is about to snap, or it has left the spheres: `cause`, of bearing `at`.
    """
    found, code = -1, _SLIP_UNSTABLE
    if cause in (_SLIP_UNSTABLE, _SPHERE_EXCEEDED):
        found, code = at, cause
    else:
        for k in range(props.shape[0]):
            if props[k].fused or old[k].failed != 0:
                continue
            slip = math.sqrt(old[k].slip[0] ** 2 + old[k].slip[1] ** 2)
            if slip > SNAPS * last_slip(props[k], old[k]):
                found = k
                break
    if found < 0 or not props[found].goes_on or old[found].failed != 0:
        return False
    give_up(props[found], old[found], code)
    copy_words(old_words[found], new_words[found])
    return True
