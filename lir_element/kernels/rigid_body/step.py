"""Kernels of the level 'rigid_body': the paper's model, 18 degrees of freedom in time.

Three moving bodies (bottom slider, top slider, top plate) of six degrees of freedom each, with the
forces of the contact pairs of `kernels.contact.pairs`. One step is Bossak's member of the
generalised-alpha family (Wood, Bossak and Zienkiewicz 1981), solved by Newton's method; an explicit
step is there to check it. docs/theory.md, section 8.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.condensed import SHORTER, first_share
from lir_element.kernels.contact.pairs import press
from lir_element.kernels.contact.places import OWN, matrix_of, place_bodies, turn_between, turn_by
from lir_element.kernels.contact.residual import ROUND_OFF, small_forces
from lir_element.kernels.contact.slider_motion import momentum
from lir_element.kernels.linear import solve_many

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.bundles.rigid_data import RigidRun, RigidSetup
    from lir_element.layout import Bodies, Floats, Scratch

_MAX_ITERATIONS = 25
_TRIES = 4  # of a step: the last one, 0.35^3 or 4 % of it, is accepted (a choice)


@kernel
def turning_force(
    inertia: Floats, q: Floats, spin: Floats, rate: Floats, out: Floats, factor: float
) -> None:
    """Add `factor` times ``J rate + spin x J spin`` (global axes) to `out` (3,)."""
    momentum(inertia, q, rate, out, 0, factor)
    h_0, h_1, h_2 = 0.0, 0.0, 0.0
    for b in range(3):
        own = inertia[b] * (q[0, b] * spin[0] + q[1, b] * spin[1] + q[2, b] * spin[2])
        h_0 += own * q[0, b]
        h_1 += own * q[1, b]
        h_2 += own * q[2, b]
    out[0] += factor * (spin[1] * h_2 - spin[2] * h_1)
    out[1] += factor * (spin[2] * h_0 - spin[0] * h_2)
    out[2] += factor * (spin[0] * h_1 - spin[1] * h_0)


@kernel
def set_rates(old: Bodies, new: Bodies, w: Scratch, setup: RigidSetup, dt: float) -> None:
    """Set velocities and accelerations that belong to the step's displacements and turns."""
    beta, gamma = setup.beta, setup.gamma
    for k in range(3):
        turn = turn_between(old.turn[k], new.turn[k])
        for a in range(3):
            v, acc = old.velocity[k, a], old.acceleration[k, a]
            rate = (w.shift[3 * k + a] / dt - v) / (beta * dt) - (0.5 / beta - 1.0) * acc
            new.acceleration[k, a] = rate
            new.velocity[k, a] = v + dt * ((1.0 - gamma) * acc + gamma * rate)
            v, acc = old.spin[k, a], old.spin_rate[k, a]
            rate = (turn[a] / dt - v) / (beta * dt) - (0.5 / beta - 1.0) * acc
            new.spin_rate[k, a] = rate
            new.spin[k, a] = v + dt * ((1.0 - gamma) * acc + gamma * rate)


@kernel
def set_own_forces(s: BodyStep, run: RigidRun, am: float) -> None:
    """Set weight, ground and inertia forces of the sliders, and the residual of all bodies.

    `am` is the share of the step's start; ``w.load`` holds the loads on the top plate.
    """
    c, old, new = s.sliders, s.old, s.new
    w = s.scratch
    mass, inertia, ground = run.mass, run.inertia, run.ground
    part = new.parts[OWN]
    for k in range(3):
        moment, q = w.spare_vector, w.spare_matrix
        for a in range(3):
            moment[a] = 0.0
        turning_force(inertia[k], w.q[k + 1], new.spin[k], new.spin_rate[k], moment, 1.0 - am)
        matrix_of(old.turn[k], q)
        turning_force(inertia[k], q, old.spin[k], old.spin_rate[k], moment, am)
        for a in range(3):
            kept = (1.0 - am) * new.acceleration[k, a] + am * old.acceleration[k, a]
            own = -mass[k, a] * (kept + ground[a])
            turn = -moment[a]
            if k < 2:
                own -= mass[k, a] * c.gravity if a == 2 else 0.0
                part[6 * k + 6 + a], part[6 * k + 9 + a] = own, turn
            else:
                own += w.load[a]
                turn += w.load[3 + a]
            w.residual[6 * k + a] = w.g[6 * k + 6 + a] + own
            w.residual[6 * k + 3 + a] = w.g[6 * k + 9 + a] + turn


@kernel
def residual_of(s: BodyStep, run: RigidRun, setup: RigidSetup, dt: float) -> float:
    """Set all forces at the new places and return the size of the residual of the free DOFs."""
    c, w, free = s.sliders, s.scratch, run.free
    place_bodies(c, w, s.new, 1, 4)
    press(s, dt, 0.0, 0.0, True)
    set_rates(s.old, s.new, w, setup, dt)
    set_own_forces(s, run, setup.alpha_m)
    total = 0.0
    for row in range(18):
        if free[row] == 0:
            w.residual[row] = 0.0
            continue
        size = w.residual[row] if row % 6 < 3 else w.residual[row] / c.radius
        total += size * size
    return math.sqrt(total)


@kernel
def set_matrix(run: RigidRun, w: Scratch, setup: RigidSetup, dt: float) -> None:
    """Set Newton's matrix (18 x 18): minus the derivative of the residual."""
    mass, inertia, free = run.mass, run.inertia, run.free
    factor = (1.0 - setup.alpha_m) / (setup.beta * dt * dt)
    for row in range(18):
        for col in range(18):
            w.system[row, col] = -w.k[6 + row, 6 + col]
    for k in range(3):
        q = w.q[k + 1]
        for a in range(3):
            w.system[6 * k + a, 6 * k + a] += factor * mass[k, a]
            for b in range(3):
                for e in range(3):
                    value = factor * inertia[k, e] * q[a, e] * q[b, e]
                    w.system[6 * k + 3 + a, 6 * k + 3 + b] += value
    for row in range(18):
        if free[row] == 0:
            for col in range(18):
                w.system[row, col], w.system[col, row] = 0.0, 0.0
            w.system[row, row] = 1.0


@kernel
def move_bodies(old: Bodies, new: Bodies, w: Scratch, factor: float) -> None:
    """Move all bodies by `factor` times ``w.step`` from the start of the iteration."""
    for k in range(3):
        for a in range(3):
            w.shift[3 * k + a] = w.try_shift[3 * k + a] + factor * w.step[6 * k + a]
            new.displacement[k, a] = old.displacement[k, a] + w.shift[3 * k + a]
        turn_by(
            w.try_turn[k],
            factor * w.step[6 * k + 3],
            factor * w.step[6 * k + 4],
            factor * w.step[6 * k + 5],
            new.turn[k],
        )


@kernel
def predict(s: BodyStep, run: RigidRun, dt: float) -> None:
    """Start the step by the velocities; driven degrees of freedom go to their place."""
    old, new, w, free = s.old, s.new, s.scratch, run.free
    for k in range(3):
        for a in range(3):
            move = dt * old.velocity[k, a] + 0.5 * dt * dt * old.acceleration[k, a]
            if free[6 * k + a] == 0:
                move = 0.0
                if run.driven and k == 2 and a < 2:
                    move = run.drive[a] - old.displacement[k, a]
            w.shift[3 * k + a] = move
            new.displacement[k, a] = old.displacement[k, a] + move
        x, y, z = dt * old.spin[k, 0], dt * old.spin[k, 1], dt * old.spin[k, 2]
        if free[6 * k + 3] == 0:
            x = 0.0
        if free[6 * k + 4] == 0:
            y = 0.0
        if free[6 * k + 5] == 0:
            z = 0.0
        turn_by(old.turn[k], x, y, z, new.turn[k])


@kernel
def small_enough(s: BodyStep, run: RigidRun, dt: float) -> float:
    """Return the residual to reach: that of the contacts, and round-off of the plate's inertia."""
    own = 0.0
    for a in range(3):
        if run.free[15 + a] != 0:
            own = max(own, run.inertia[2, a] / s.sliders.radius)
    stiff = (run.mass[2, 2] + 4.0 * own) / (dt * dt)
    return small_forces(s.props, s.sliders, s.touch_new, dt) + ROUND_OFF * stiff


@kernel
def newton_direction(new: Bodies, w: Scratch) -> float:
    """Set ``w.step`` of all bodies; return the first factor to try, 0 if it is singular."""
    for row in range(18):
        w.right[row, 0] = w.residual[row]
    if not solve_many(w.system, w.right, 18, 1):
        return 0.0
    for row in range(18):
        w.step[row] = w.right[row, 0]
    return first_share(new, w, 3, math.inf)


@kernel
def implicit_step(s: BodyStep, run: RigidRun, setup: RigidSetup, dt: float) -> bool:
    """Compute one implicit step from `s.old` to `s.new`; return True if Newton converged."""
    old, new, w = s.old, s.new, s.scratch
    predict(s, run, dt)
    size = residual_of(s, run, setup, dt)
    for _ in range(_MAX_ITERATIONS):
        if not math.isfinite(size):
            return False
        if size <= small_enough(s, run, dt):
            return True
        set_matrix(run, w, setup, dt)
        factor = newton_direction(new, w)
        if factor == 0.0:
            return False
        for entry in range(9):
            w.try_shift[entry] = w.shift[entry]
        before = size
        for _attempt in range(_TRIES):
            move_bodies(old, new, w, factor)
            size = residual_of(s, run, setup, dt)
            if size < before or size <= small_enough(s, run, dt):
                break
            factor *= SHORTER
    return size <= small_enough(s, run, dt)


@kernel
def explicit_step(s: BodyStep, run: RigidRun, dt: float) -> None:
    """Compute one explicit step (semi-implicit Euler) from the forces of `s.old`.

    ``old.acceleration`` and ``old.spin_rate`` are those of the forces there.
    """
    old, new = s.old, s.new
    for k in range(3):
        for a in range(3):
            new.velocity[k, a] = old.velocity[k, a] + dt * old.acceleration[k, a]
            new.spin[k, a] = old.spin[k, a] + dt * old.spin_rate[k, a]
            if run.driven and k == 2 and a < 2:
                new.velocity[k, a] = (run.drive[a] - old.displacement[k, a]) / dt
            new.displacement[k, a] = old.displacement[k, a] + dt * new.velocity[k, a]
        spin = new.spin[k]
        turn_by(old.turn[k], dt * spin[0], dt * spin[1], dt * spin[2], new.turn[k])
    place_bodies(s.sliders, s.scratch, new, 1, 4)
    press(s, dt, 0.0, 0.0, False)
    set_accelerations(run, new)


@kernel
def set_accelerations(run: RigidRun, new: Bodies) -> None:
    """Set the accelerations of all bodies under the forces ``w.g`` and their loads."""
    c, w, mass, inertia = run.sliders[0], run.scratch[0], run.mass, run.inertia
    free, ground = run.free, run.ground
    part = new.parts[OWN]
    for k in range(3):
        q, spin = w.q[k + 1], new.spin[k]
        moment = w.spare_vector
        for a in range(3):
            force = w.g[6 * k + 6 + a] - mass[k, a] * ground[a]
            if k < 2:
                force -= mass[k, a] * c.gravity if a == 2 else 0.0
                part[6 * k + 6 + a] = -w.g[6 * k + 6 + a]
                part[6 * k + 9 + a] = -w.g[6 * k + 9 + a]
            else:
                force += w.load[a]
            is_free = free[6 * k + a] != 0
            new.acceleration[k, a] = force / mass[k, a] if is_free else 0.0
            moment[a] = w.g[6 * k + 9 + a] + (w.load[3 + a] if k == 2 else 0.0)
        for a in range(3):
            new.spin_rate[k, a] = 0.0
        turning_force(inertia[k], q, spin, new.spin_rate[k], moment, -1.0)
        for b in range(3):
            if inertia[k, b] > 0.0:
                own = (q[0, b] * moment[0] + q[1, b] * moment[1] + q[2, b] * moment[2]) / (
                    inertia[k, b]
                )
                for a in range(3):
                    new.spin_rate[k, a] += own * q[a, b]
        for a in range(3):
            if free[6 * k + 3 + a] == 0:
                new.spin_rate[k, a] = 0.0
