"""Kernels of a bearing that has failed: its load has no support, or a flat stop.

The stop is a contact in vertical direction that never pulls, with friction of the same law as the
surfaces' (docs/theory.md, section 3). Its force acts under node j; its moment is node i's.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.pendulum.trial import is_finite, keep_works
from lir_element.kernels.pendulum.work import taken
from lir_element.kernels.rotation import add_cross
from lir_element.kernels.slip import friction_map, kelvin_voigt, kept_share, open_work, stored

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, State, Work

_OK = int(RunStatus.OK)
_NOT_FINITE = int(RunStatus.NOT_FINITE)


@kernel
def carry_nothing(at: State) -> None:
    """Set the forces of a bearing at its surfaces, its interface and its rims to zero."""
    for k in range(2):
        at.rim_force[k], at.rim_closure[k], at.rim_flow[k] = 0.0, 0.0, 0.0
        at.sliding_speed[k], at.axis_speed[k], at.slid[k] = 0.0, 0.0, 0.0
        at.interface_force[k], at.interface_hysteresis[k] = 0.0, 0.0
        at.slip_increment[k] = 0.0
        for a in range(2):
            at.friction_force[k, a], at.hysteresis[k, a] = 0.0, 0.0
            at.sliding_increment[k, a], at.plain_hysteresis[k, a] = 0.0, 0.0
            at.spin_arm[k, a] = 0.0
    at.axial_force, at.vertical_force, at.torque, at.twist_hysteresis = 0.0, 0.0, 0.0, 0.0
    at.spin_couple, at.spin_rate = 0.0, 0.0


@kernel
def give_up(at: State, code: int) -> None:
    """Make a committed state the last one of a bearing that fails by `code`.

    It keeps the forces of its equilibrium: the rest is its backup's.
    """
    at.failed, at.failed_at = -code, at.time
    at.status = _OK


@kernel
def stop_before(p: Props, old: State) -> tuple[float, float]:
    """Return the axial force and the closure of the stop before the step."""
    if old.failed > 0:
        return old.axial_force, old.closure
    return 0.0, max(old.displacement[2] - old.displacement[8] - p.backup_drop, 0.0)


@kernel
def backup_trial(
    p: Props, old: State, new: State, w: Work, u: Floats, v: Floats, time: float
) -> int:
    """Determine the state of a failed bearing at displacements `u`, velocities `v` and `time`.

    Returns a RunStatus code. The sliders' part of the record stays unchanged.
    """
    if not (math.isfinite(time) and is_finite(u) and is_finite(v)):
        return _NOT_FINITE
    w.dt = max(time - old.time, 0.0)
    gap = u[2] - u[8] - p.backup_drop
    load, closed = stop_before(p, old)
    push, slope, closure = kelvin_voigt(gap, closed, p.backup_stiffness, p.backup_damping, w.dt)
    kept, kept_n = 1.0, 0.0
    if w.dt > 0.0:
        kept, kept_n = kept_share(load, push, p.axial_floor)
    before = old.displacement
    rubs = 1.0 * (old.failed > 0)  # the bearing's own friction is gone
    y_1, y_2 = rubs * old.hysteresis[0, 0], rubs * old.hysteresis[0, 1]
    d_x, d_y = u[6] - u[0] - (before[6] - before[0]), u[7] - u[1] - (before[7] - before[1])
    z_1, z_2, h_11, h_12, h_21, h_22, slid, _, _, n_1, n_2 = friction_map(
        0, p.exponent, y_1, y_2, d_x, d_y, p.yield_displacement[0], kept, kept_n, 0.0, 0.0, 0.0
    )
    carry_nothing(new)
    keep_works(old, new)
    new.failed, new.failed_at, new.status = abs(old.failed), old.failed_at, _OK
    new.time, new.step, new.twist, new.iterations = time, w.dt, u[11] - u[5], 0
    new.axial_force, new.closure, new.slid[0] = push, closure, slid
    new.hysteresis[0, 0], new.hysteresis[0, 1] = z_1, z_2
    mu = p.backup_friction
    new.friction_force[0, 0], new.friction_force[0, 1] = mu * push * z_1, mu * push * z_2
    for k in range(12):
        new.displacement[k] = u[k]
        new.force[k] = 0.0
    f = new.force
    f[6], f[7], f[8] = mu * push * z_1, mu * push * z_2, -push
    for a in range(3):
        f[a] = -f[6 + a]
    x, y, z = arm_of(p, u, 0), arm_of(p, u, 1), arm_of(p, u, 2)
    f[3], f[4], f[5] = -(y * f[8] - z * f[7]), -(z * f[6] - x * f[8]), -(x * f[7] - y * f[6])
    rows = w.half  # derivative of the force on node j by the way of j from i
    rows[0, 0], rows[0, 1], rows[1, 0] = mu * push * h_11, mu * push * h_12, mu * push * h_21
    rows[1, 1], rows[2, 0], rows[2, 1] = mu * push * h_22, 0.0, 0.0
    rows[0, 2] = -slope * mu * (z_1 + push * n_1)
    rows[1, 2] = -slope * mu * (z_2 + push * n_2)
    rows[2, 2] = slope
    return _OK


@kernel
def arm_of(p: Props, u: Floats, axis: int) -> float:
    """Return the place of node j relative to node i along an axis [m]."""
    height = p.lever[0] + p.lever[1] - p.length if axis == 2 else 0.0
    return float(u[6 + axis] - u[axis] + height)


@kernel
def backup_tangent(p: Props, w: Work, new: State, k: Floats) -> None:
    """Fill the (12, 12) tangent of the last `backup_trial`."""
    rows, u, force = w.half, new.displacement, new.force
    x, y, z = arm_of(p, u, 0), arm_of(p, u, 1), arm_of(p, u, 2)
    for row in range(12):
        for col in range(12):
            k[row, col] = 0.0
    for col in range(3):
        d_x, d_y, d_z = rows[0, col], rows[1, col], rows[2, col]
        turn = (-(y * d_z - z * d_y), -(z * d_x - x * d_z), -(x * d_y - y * d_x))
        for a in range(3):
            k[6 + a, 6 + col], k[6 + a, col] = rows[a, col], -rows[a, col]
            k[a, 6 + col], k[a, col] = -rows[a, col], rows[a, col]
            k[3 + a, 6 + col], k[3 + a, col] = turn[a], -turn[a]
    add_cross(k, 3, 6, force[6], force[7], force[8], 1.0)  # the arm follows the nodes
    add_cross(k, 3, 0, force[6], force[7], force[8], -1.0)


@kernel
def backup_store(p: Props, at: State) -> float:
    """Return the energy in the elastic sliding on the stop."""
    z = at.hysteresis[0]
    return stored(p.backup_friction, at.axial_force, p.yield_displacement[0], z[0], z[1])


@kernel
def backup_accumulate(p: Props, old: State, new: State) -> None:
    """Add the works of the step: friction's with those of the bottom surface, the rest the contact.

    By the trapezoidal rule over all forces of the nodes, that of the bearing at its failure
    included.
    """
    total, rubbed = 0.0, 0.0
    for k in range(12):
        step = new.displacement[k] - old.displacement[k]
        total += 0.5 * (old.force[k] + new.force[k]) * step
    for a in range(2):
        way = new.displacement[6 + a] - new.displacement[a]
        way -= old.displacement[6 + a] - old.displacement[a]
        before = old.friction_force[0, a] if old.failed > 0 else 0.0
        rubbed += 0.5 * (before + new.friction_force[0, a]) * way
    gain = backup_store(p, new)
    if old.failed > 0:
        gain -= backup_store(p, old)
    new.work_elastic = old.work_elastic + gain
    new.work_friction[0] = old.work_friction[0] + taken(old, new, 0, rubbed - gain)
    new.travel[0] = old.travel[0] + new.slid[0]
    new.work_contact = old.work_contact + total - rubbed


@kernel
def backup_defect(p: Props, old: State, new: State) -> float:
    """Return the energy that the stop makes or loses in the step by its size alone."""
    load, closed = stop_before(p, old)
    rise = new.displacement[8] - new.displacement[2] - old.displacement[8] + old.displacement[2]
    return open_work(load, new.axial_force, -rise, new.closure - closed)
