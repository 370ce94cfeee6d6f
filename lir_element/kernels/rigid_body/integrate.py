"""Kernels of the time loop of the level 'rigid_body': step control, works, output.

Each step is computed once whole and once in two halves; the difference is its error, the halves are
kept. This assumes no smoothness in between.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_before_typing, kernel
from lir_element.bundles.contact_data import BodyStep
from lir_element.errors import RunStatus
from lir_element.kernels.contact.pairs import press
from lir_element.kernels.contact.places import place_bodies, turn_between
from lir_element.kernels.contact.state import bodies_status, contact_accumulate, fill_state
from lir_element.kernels.linear import copy_words
from lir_element.kernels.rigid_body.step import explicit_step, implicit_step, set_accelerations
from lir_element.kernels.sampling import ground_acceleration

if TYPE_CHECKING:
    from lir_element.bundles.rigid_data import RigidInput, RigidRun, RigidSetup

_OK = int(RunStatus.OK)
_STEP_TOO_SMALL = int(RunStatus.STEP_TOO_SMALL)
# Choice of the step by an error of order dt^3: Hairer, Norsett and Wanner (1993), II.4
_SAFETY = 0.9  # of the step that would just do; there, too
_LEAST, _MOST = 0.2, 2.0  # of the step before; a cautious 2 of their 1.5 to 5
_SMALL = 0.06  # of the allowed error: below it the step grows by the most, also of no error
_FAILED = 8.0  # allowed errors that a step without a solution counts as: the next is 0.45 of it


@kernel
def set_instant(run: RigidRun, given: RigidInput, time: float, dt: float, output: int) -> None:
    """Set ground acceleration, imposed place and load at `time`, before the given `output`.

    The step of size `dt` ends at `time`.
    """
    w = run.scratch[0]
    span = given.times[output] - given.times[output - 1]
    share = (time - given.times[output - 1]) / span if span > 0.0 else 1.0
    for axis in range(3):
        run.ground[axis] = ground_acceleration(given.motion, given.motion_dt, time, axis)
        run.ground_mean[axis] = 0.5 * (
            run.ground[axis] + ground_acceleration(given.motion, given.motion_dt, time - dt, axis)
        )
    for a in range(2):
        run.drive[a] = (1.0 - share) * given.drive[output - 1, a] + share * given.drive[output, a]
    for a in range(6):
        w.load[a] = (1.0 - share) * given.load[output - 1, a] + share * given.load[output, a]


@kernel
def set_rotation_vector(run: RigidRun, at: int) -> None:
    """Set ``run.u`` to the nodes' displacements of the bodies `at`."""
    turn = run.bodies[at].turn[2]
    size = math.sqrt(turn[1] ** 2 + turn[2] ** 2 + turn[3] ** 2)
    factor = 2.0 * math.atan2(size, abs(turn[0])) / size if size > 1e-12 else 2.0
    if turn[0] < 0.0:
        factor = -factor
    for a in range(3):
        run.u[6 + a] = run.bodies[at].displacement[2, a]
        run.u[9 + a] = factor * turn[1 + a]


@kernel
def kinetic_energy(run: RigidRun, at: int) -> float:
    """Return the kinetic energy of the top plate."""
    body, q = run.bodies[at], run.scratch[0].q[3]
    total = 0.0
    for b in range(3):
        own = 0.0
        for a in range(3):
            own += q[a, b] * body.spin[2, a]
        total += 0.5 * run.mass[2, b] * body.velocity[2, b] ** 2
        total += 0.5 * run.inertia[2, b] * own * own
    return total


@inlined_before_typing
def body_step(run: RigidRun, before: int, after: int) -> BodyStep:
    """Return the bodies over the step between two of their states."""
    return BodyStep(
        run.props[0],
        run.sliders[0],
        run.points,
        run.bodies[before],
        run.bodies[after],
        run.touches[before],
        run.touches[after],
        None,
        None,
        run.scratch[0],
    )


@kernel
def take_up(run: RigidRun, before: int, after: int, s_old: int, s_new: int) -> int:
    """Set the record ``states[s_new]`` and its works for the step between two states of bodies.

    The bodies `after` are those of the last evaluation. Returns the status of the limits.
    """
    w = run.scratch[0]
    old, new = run.states[s_old], run.states[s_new]
    b_old, b_new = run.bodies[before], run.bodies[after]
    set_rotation_vector(run, after)
    bodies = body_step(run, before, after)
    fill_state(bodies, old, new, run.u)
    contact_accumulate(bodies, old, new, 3)
    supplied, lifted, bearing = 0.0, 0.0, 0.0
    for a in range(6):
        move = w.moves[18 + a]
        if run.driven and a < 2:
            move = 0.0
        if a < 3:
            supplied -= run.mass[2, a] * run.ground_mean[a] * move
        lifted -= w.load[a] * move
        for part in range(6):
            force = 0.5 * (b_old.parts[part, 18 + a] + b_new.parts[part, 18 + a])
            bearing -= force * move
    e_old, e_new = run.energy[s_old], run.energy[s_new]
    e_new.kinetic = kinetic_energy(run, after)
    e_new.input, e_new.gravity = e_old.input + supplied, e_old.gravity + lifted
    gained = e_new.kinetic - e_old.kinetic
    e_new.numerical = e_old.numerical + supplied - lifted - bearing - gained + new.work_step
    new.status = bodies_status(run.props[0], w, new)
    return new.status


@kernel
def difference(run: RigidRun) -> float:
    """Return how far a whole step and two halves lie apart [m]; turns at the slider's edge."""
    one, two = run.bodies[1], run.bodies[3]
    largest = 0.0
    for k in range(3):
        x, y, z = turn_between(one.turn[k], two.turn[k])
        largest = max(largest, run.sliders[0].radius * math.sqrt(x * x + y * y + z * z))
        for a in range(3):
            largest = max(largest, abs(one.displacement[k, a] - two.displacement[k, a]))
    return largest


@kernel
def implicit(
    run: RigidRun,
    given: RigidInput,
    setup: RigidSetup,
    start: int,
    end: int,
    time: float,
    dt: float,
    output: int,
) -> bool:
    """Compute one implicit step from the bodies `start` to `end`, at the time `time`."""
    set_instant(run, given, time, dt, output)
    return implicit_step(body_step(run, start, end), run, setup, dt)


@kernel
def commit(run: RigidRun, at: int, state: int) -> None:
    """Make the bodies `at` and the record `state` the committed ones."""
    copy_words(run.bodies_words[at], run.bodies_words[0])
    copy_words(run.touches_words[at], run.touches_words[0])
    copy_words(run.states_words[state], run.states_words[0])
    copy_words(run.energy_words[state], run.energy_words[0])


@kernel
def adaptive(run: RigidRun, given: RigidInput, setup: RigidSetup, output: int) -> int:
    """Try a step of controlled error towards the given `output`; return a status code."""
    clock, counts = run.clock[0], run.counts[0]
    time, left = clock.time, given.times[output] - clock.time
    dt = min(clock.step, setup.largest)
    if dt >= left:
        dt = left
    elif dt > 0.5 * left:
        dt = 0.5 * left
    half = 0.5 * dt
    counts.tries += 1
    good = implicit(run, given, setup, 0, 1, time + dt, dt, output)
    if good:
        good = implicit(run, given, setup, 0, 2, time + half, half, output)
    code = _OK
    if good:
        code = take_up(run, 0, 2, 0, 1)
        good = implicit(run, given, setup, 2, 3, time + dt, half, output)
    share = difference(run) / setup.error if good else _FAILED
    if not (good and share <= 1.0):
        counts.refused += 1
        if dt <= setup.smallest:
            return _STEP_TOO_SMALL
        clock.step = dt * max(_LEAST, min(_SAFETY, _SAFETY * share ** (-1.0 / 3.0)))
        return _OK
    code = max(code, take_up(run, 2, 3, 1, 2))
    clock.time = time + dt
    if code != _OK:
        return code
    commit(run, 3, 2)
    counts.steps += 1
    run.states[0].time = clock.time
    growth = _MOST if share < _SMALL else _SAFETY * share ** (-1.0 / 3.0)
    clock.step = max(clock.step if dt < clock.step else 0.0, dt * min(growth, _MOST))
    return _OK


@kernel
def explicit_pair(run: RigidRun, given: RigidInput, setup: RigidSetup, output: int) -> int:
    """Compute two of the equal explicit steps towards `output`; return a status code."""
    clock, counts = run.clock[0], run.counts[0]
    begin, end = given.times[output - 1], given.times[output]
    parts = 2 * max(1, math.ceil(0.5 * (end - begin) / setup.explicit))
    dt = (end - begin) / parts
    for now in range(2):
        clock.part += 1
        time = end if clock.part == parts else begin + clock.part * dt
        set_instant(run, given, time, dt, output)
        explicit_step(body_step(run, now, 1 - now), run, dt)
        code = take_up(run, now, 1 - now, now, 1 - now)
        clock.time = time
        counts.tries += 1
        if code != _OK:
            copy_words(run.states_words[1 - now], run.states_words[2])
            return code
        counts.steps += 1
    run.states[0].time = clock.time
    if clock.part == parts:
        clock.part = 0
    return _OK


@kernel
def start(run: RigidRun, given: RigidInput) -> None:
    """Set forces and accelerations of the state a run starts from, and record it."""
    w = run.scratch[0]
    set_instant(run, given, given.times[0], 0.0, 1)
    place_bodies(run.sliders[0], w, run.bodies[0], 1, 4)
    for a in range(3):
        w.x[0, a] = run.sliders[0].place[0, a]
        for b in range(3):
            w.q[0][a, b] = 1.0 if a == b else 0.0
    begin = BodyStep(
        run.props[0],
        run.sliders[0],
        run.points,
        run.bodies[0],
        run.bodies[0],
        run.touches[0],
        run.touches[1],
        None,
        None,
        w,
    )
    press(begin, 0.0, 0.0, 0.0, False)
    set_accelerations(run, run.bodies[0])
    write_output(run, given, 0)


@kernel
def integrate_bodies(
    run: RigidRun, given: RigidInput, setup: RigidSetup, last: int, tries: int
) -> int:
    """Integrate until `last` outputs are written, or `tries` steps tried; return a status code.

    ``run.clock`` and ``run.counts`` have the progress, and the next call continues from there.
    """
    clock, counts = run.clock[0], run.counts[0]
    most = counts.tries + tries
    while counts.outputs < last and counts.tries < most:
        output = counts.outputs
        end = given.times[output]
        if end - clock.time <= 1e-12 * max(abs(end), 1.0):
            write_output(run, given, output)
            continue
        if setup.explicit > 0.0:
            code = explicit_pair(run, given, setup, output)
        else:
            code = adaptive(run, given, setup, output)
        if code != _OK:
            return code
    return _OK


@kernel
def write_output(run: RigidRun, given: RigidInput, output: int) -> None:
    """Write the committed state to the output."""
    copy_words(run.states_words[0], given.words[output])
    copy_words(run.bodies_words[0], given.bodies[output])
    copy_words(run.energy_words[0], given.energy[output])
    run.counts[0].outputs = output + 1
