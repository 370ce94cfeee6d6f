"""Kernels of the testing rig: imposed lateral path, axial load held by the vertical actuator."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.levels import bearing_commit, bearing_tangent, bearing_trial
from lir_element.kernels.linear import copy_words
from lir_element.kernels.pendulum.trial import has_no_state

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import Contacts
    from lir_element.bundles.rigid_data import RigRun

_OK = int(RunStatus.OK)
_NEWTON_FAILED = int(RunStatus.NEWTON_FAILED)
_LOWER = 5  # times that a height without a state is lowered ...
_PRESS = 0.2  # ... by this share of the load's settlement (choices)
_MAX_ITERATIONS = 60  # of Newton's method with bisection, which alone halves to round-off in 52
_TOLERANCE = 1e-9  # of the axial load ...
_SEARCHED = 10  # ... and after so many iterations
_COARSE = 1e-7  # more than the sliders' own equilibrium is found to (a choice)


@kernel
def hold_actuator(run: RigRun, contacts: Contacts | None, time: float, load: float) -> int:
    """Find the vertical displacement ``u[8]`` that carries `load`; return a status code."""
    p, u, k = run.props[0], run.u, run.tangent
    new = run.new[0]
    low, high = -math.inf, math.inf  # heights that carry too much, too little
    lower = 0
    for count in range(_MAX_ITERATIONS):
        code = bearing_trial(run.props, run.old, run.new, run.work, contacts, 0, u, run.v, time)
        if has_no_state(code):  # a bearing pressed harder may have one
            lower += 1
            if lower > _LOWER:
                return code
            u[8] -= _PRESS * load / p.axial_stiffness
            continue
        excess = new.force[8] + load
        if abs(excess) <= (_TOLERANCE if count < _SEARCHED else _COARSE) * load:
            return new.status
        if excess > 0.0:
            high = min(high, u[8])
        else:
            low = max(low, u[8])
        bearing_tangent(run.props, run.new, run.work, contacts, 0, k)
        if k[8, 8] > 0.0:
            u[8] -= excess / k[8, 8]
        else:  # lifted off: close the gap
            u[8] -= (p.length - new.string) + load / p.axial_stiffness
        if not low < u[8] < high and low < high and math.isfinite(high - low):
            u[8] = 0.5 * (low + high)
    return _NEWTON_FAILED


@kernel
def hold_by_load(run: RigRun, time: float, load: float) -> int:
    """Find the state under `load` itself at level 'pendulum'; return a status code.

    If the interface slips away, the slip lowers the plate faster than it slides: held at a height,
    the axial force falls to zero; held by its load, the bearing continues to slip (docs/theory.md,
    section 9).
    """
    p, w, new = run.props[0], run.work[0], run.new[0]
    p.fixed_load = load
    code = bearing_trial(run.props, run.old, run.new, run.work, None, 0, run.u, run.v, time)
    run.u[8] += w.c[2] - w.height
    p.fixed_load = 0.0
    new.displacement[8], new.closure = run.u[8], new.string - p.length
    return code


@kernel
def accept(run: RigRun, contacts: Contacts | None) -> None:
    """Commit the trial state."""
    bearing_commit(run.props, run.old, run.new, run.old_words, run.new_words, run.heat, contacts, 0)


@kernel
def begin_path(run: RigRun, contacts: Contacts | None) -> int:
    """Apply the axial load to a bearing at the centre of its path; return a status code."""
    load = run.loads[0]
    run.u[8] = -load / run.props[0].axial_stiffness
    code = hold_actuator(run, contacts, 0.0, load)
    if code == _OK:
        accept(run, contacts)
    return code


@kernel
def follow_path(run: RigRun, contacts: Contacts | None, last: int, increments: int) -> int:
    """Follow the path until `last` points are reached, or `increments` are used.

    ``run.reached`` and ``run.clock`` have the progress, and the next call continues from there;
    returns a status code.
    """
    reached, clock = run.reached, run.clock
    taken = 0
    while reached[0] < last and taken < increments:
        point = reached[0]
        x, y, load = 0.0, 0.0, run.loads[0]
        if point > 0:
            x, y, load = run.path[point - 1, 0], run.path[point - 1, 1], run.loads[point - 1]
        d_x, d_y = run.path[point, 0] - x, run.path[point, 1] - y
        distance = math.sqrt(d_x * d_x + d_y * d_y)
        parts = max(1, math.ceil(distance / run.increment))
        speed = run.velocity / distance if distance > 0.0 else 0.0
        run.v[6], run.v[7] = d_x * speed, d_y * speed
        while reached[1] < parts and taken < increments:
            share = (reached[1] + 1) / parts
            run.u[6], run.u[7] = x + share * d_x, y + share * d_y
            clock[1] = clock[0] + share * distance / run.velocity
            held = load + share * (run.loads[point] - load)
            code = hold_actuator(run, contacts, clock[1], held)
            if code == _NEWTON_FAILED and contacts is None:
                code = hold_by_load(run, clock[1], held)
            if code != _OK:
                return code
            accept(run, contacts)
            reached[1] += 1
            taken += 1
        if reached[1] == parts:
            clock[0] += distance / run.velocity
            copy_words(run.old_words[0], run.states_words[point])
            if contacts is not None:
                copy_words(contacts.bodies_old_words[0], run.bodies_words[point])
            run.velocities[point, 0], run.velocities[point, 1] = run.v[6], run.v[7]
            reached[0], reached[1] = point + 1, 0
    return _OK
