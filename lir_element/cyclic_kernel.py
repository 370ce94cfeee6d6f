"""Kernel of the testing rig: imposed lateral path, axial load held by the vertical actuator."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._jit import kernel
from lir_element.errors import RunStatus
from lir_element.pendulum_nodes import fill_tangent
from lir_element.pendulum_trial import copy_words, has_no_state, trial
from lir_element.pendulum_work import accumulate

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Records, State, Words, Work

_OK = int(RunStatus.OK)
_NEWTON_FAILED = int(RunStatus.NEWTON_FAILED)


@kernel
def hold_load(
    p: Props,
    old: State,
    new: State,
    w: Work,
    u: Floats,
    v: Floats,
    time: float,
    load: float,
    k: Floats,
    zero: Floats,
    axes: Floats,
) -> int:
    """Find the vertical displacement ``u[8]`` that carries `load`; return a status code."""
    code = _NEWTON_FAILED
    for _ in range(40):
        code = trial(p, old, new, w, u, v, time, zero)
        if has_no_state(code):
            return code
        excess = new.force[8] + load
        if abs(excess) <= 1e-10 * load:
            return new.status
        fill_tangent(p, w, new.force, k, zero, axes)
        if k[8, 8] > 0.0:
            u[8] -= excess / k[8, 8]
        else:  # lifted off: close the gap
            u[8] -= (p.length - w.l) + load / p.axial_stiffness
    return _NEWTON_FAILED


@kernel
def run_path(
    props: Records,
    states: Records,
    words: Words,
    work: Records,
    path: Floats,
    loads: Floats,
    velocity: float,
    increment: float,
    k: Floats,
    zero: Floats,
    axes: Floats,
    out: Words,
    v_out: Floats,
) -> tuple[int, int, float]:
    """Go through `path` (n, 2) at `velocity`; fill `out` (n, words) and `v_out` (n, 2).

    Returns the number of points reached, a status code and the time. `states` and `words` hold
    two records: committed and trial.
    """
    p, old, new, w = props[0], states[0], states[1], work[0]
    u, v = w.spare_u, w.spare_v
    for a in range(12):
        u[a], v[a] = 0.0, 0.0
    u[8] = -loads[0] / p.axial_stiffness
    code = hold_load(p, old, new, w, u, v, 0.0, loads[0], k, zero, axes)
    if code != _OK:
        return 0, code, 0.0
    accumulate(p, old, new)
    copy_words(words[1], words[0])
    time, x, y, load = 0.0, 0.0, 0.0, loads[0]
    for point in range(path.shape[0]):
        d_x, d_y = path[point, 0] - x, path[point, 1] - y
        distance = math.sqrt(d_x * d_x + d_y * d_y)
        parts = max(1, math.ceil(distance / increment))
        duration = distance / velocity
        speed = velocity if distance > 0.0 else 0.0
        v[6] = d_x / distance * speed if distance > 0.0 else 0.0
        v[7] = d_y / distance * speed if distance > 0.0 else 0.0
        for part in range(1, parts + 1):
            share = part / parts
            u[6], u[7] = x + share * d_x, y + share * d_y
            now = time + share * duration
            level = load + share * (loads[point] - load)
            code = hold_load(p, old, new, w, u, v, now, level, k, zero, axes)
            if code != _OK:
                return point, code, now
            accumulate(p, old, new)
            copy_words(words[1], words[0])
        time, x, y, load = time + duration, path[point, 0], path[point, 1], loads[point]
        copy_words(words[0], out[point])
        v_out[point, 0], v_out[point, 1] = v[6], v[7]
    return path.shape[0], _OK, time
