"""Kernel of the testing rig: imposed lateral path, axial load held by the vertical actuator."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.levels import bearing_commit, bearing_tangent, bearing_trial
from lir_element.kernels.pendulum.trial import copy_words, has_no_state

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats, Records, Words

_OK = int(RunStatus.OK)
_NEWTON_FAILED = int(RunStatus.NEWTON_FAILED)


@kernel
def hold_load(
    props: Records, old: Records, new: Records, work: Records, contacts: Contacts | None,
    u: Floats, v: Floats, time: float, load: float, k: Floats,
) -> int:  # fmt: skip
    """Find the vertical displacement ``u[8]`` that carries `load`; return a status code."""
    p = props[0]
    code = _NEWTON_FAILED
    low, high = -math.inf, math.inf  # places that carry too much, too little
    for _ in range(60):
        code = bearing_trial(props, old, new, work, contacts, 0, u, v, time)
        if has_no_state(code):
            return code
        excess = new[0].force[8] + load
        if abs(excess) <= 1e-9 * load:
            return new[0].status
        if excess > 0.0:
            high = min(high, u[8])
        else:
            low = max(low, u[8])
        bearing_tangent(props, new, work, contacts, 0, k)
        if k[8, 8] > 0.0:
            u[8] -= excess / k[8, 8]
        else:  # lifted off: close the gap
            u[8] -= (p.length - new[0].string) + load / p.axial_stiffness
        if not low < u[8] < high and low < high and math.isfinite(high - low):
            u[8] = 0.5 * (low + high)
    return _NEWTON_FAILED


@kernel
def run_path(
    props: Records, old: Records, new: Records, old_words: Words, new_words: Words, work: Records,
    contacts: Contacts | None, path: Floats, loads: Floats, velocity: float, increment: float,
    u: Floats, v: Floats, k: Floats, out: Words, v_out: Floats,
    bodies_out: Words,
) -> tuple[int, int, float]:  # fmt: skip
    """Go through `path` (n, 2) at `velocity`; fill `out` (n, words) and `v_out` (n, 2).

    Returns the number of points reached, a status code and the time. The bearing's records are
    arrays of one; `bodies_out` (n, words) takes the sliders where they are bodies.
    """
    u[8] = -loads[0] / props[0].axial_stiffness
    code = hold_load(props, old, new, work, contacts, u, v, 0.0, loads[0], k)
    if code != _OK:
        return 0, code, 0.0
    bearing_commit(props, old, new, old_words, new_words, contacts, 0)
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
            load_now = load + share * (loads[point] - load)
            code = hold_load(props, old, new, work, contacts, u, v, now, load_now, k)
            if code != _OK:
                return point, code, now
            bearing_commit(props, old, new, old_words, new_words, contacts, 0)
        time, x, y, load = time + duration, path[point, 0], path[point, 1], loads[point]
        copy_words(old_words[0], out[point])
        if contacts is not None:
            copy_words(contacts.bodies_old_words[0], bodies_out[point])
        v_out[point, 0], v_out[point, 1] = v[6], v[7]
    return path.shape[0], _OK, time
