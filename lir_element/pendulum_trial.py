"""Kernels of the level 'pendulum': the state determination (trial) and what a commit does.

`trial` reads the committed record `old`, never writes it, and fills the record `new`; calling it
twice gives the same bits. To commit: `accumulate`, then `copy_words` of the new record.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._jit import kernel
from lir_element.errors import RunStatus
from lir_element.pendulum import (
    aim_axis,
    elastic_jacobian,
    evaluate,
    place_plates,
    set_axis,
    static_speeds,
)
from lir_element.pendulum_tangent import fill_tangent, slider_jacobian
from lir_element.slip import return_map

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, Records, State, Words, Work

_OK = int(RunStatus.OK)
_NOT_FINITE = int(RunStatus.NOT_FINITE)
_NO_EQUILIBRIUM = int(RunStatus.NO_EQUILIBRIUM)
_SLIP_EXCEEDED = int(RunStatus.SLIP_EXCEEDED)
_RIM_OVERRUN = int(RunStatus.RIM_OVERRUN)
_SPHERE_EXCEEDED = int(RunStatus.SPHERE_EXCEEDED)
_SLIP_UNSTABLE = int(RunStatus.SLIP_UNSTABLE)
_MAX_ITERATIONS = 60
_MAX_STEEPEST = 12
_TOLERANCE = 1e-12  # of axial force times string length
_LARGEST_TURN = 0.1  # rad, of the axis in one iteration
_SMALLEST_COSINE = 0.3  # of the tilt: beyond 72 degrees there is no bearing left


@kernel
def residual_size(w: Work) -> float:
    """Return the residual of the slider's equilibrium over axial force and length."""
    return math.sqrt(w.residual[0] ** 2 + w.residual[1] ** 2) / (w.n_hat * w.l)


@kernel
def mark_start(w: Work) -> None:
    """Keep the current axis as the start of a search; on a rim, keep its parallel circle too."""
    for a in range(3):
        w.start[0, a], w.start[1, a], w.start[2, a] = w.n[a], w.t[0, a], w.t[1, a]
    on_rim = w.stiff_rim[0] > 0.0 or w.stiff_rim[1] > 0.0
    radius = math.sqrt(w.n[0] ** 2 + w.n[1] ** 2)
    w.start_circle[2] = radius if on_rim and radius > 1e-6 else 0.0
    if w.start_circle[2] > 0.0:
        w.start_circle[0], w.start_circle[1] = w.n[0] / radius, w.n[1] / radius


@kernel
def move(p: Props, old: State, w: Work, e_1: float, e_2: float) -> None:
    """Turn the axis from the start of the search by eta and evaluate there.

    On a rim the turn follows the rim's circle: a straight one would run into the rim's stiffness
    by its curvature alone.
    """
    s = w.start
    if w.start_circle[2] == 0.0:
        set_axis(
            w,
            s[0, 0] + s[1, 0] * e_1 + s[2, 0] * e_2,
            s[0, 1] + s[1, 1] * e_1 + s[2, 1] * e_2,
            s[0, 2] + s[1, 2] * e_1 + s[2, 2] * e_2,
        )
    else:
        u_1, u_2, radius = w.start_circle[0], w.start_circle[1], w.start_circle[2]
        along = (-u_2 * e_1 + u_1 * e_2) / radius
        tilt = math.atan2(radius, s[0, 2]) + u_1 * e_1 + u_2 * e_2
        cos, sin, out = math.cos(along), math.sin(along), math.sin(tilt)
        set_axis(w, out * (cos * u_1 - sin * u_2), out * (sin * u_1 + cos * u_2), math.cos(tilt))
    evaluate(p, old, w)


@kernel
def newton_turn(p: Props, old: State, w: Work, zero: Floats) -> float:
    """Turn the axis along Newton's direction; return the new relative residual, -1 if no gain."""
    size = math.sqrt(w.residual[0] ** 2 + w.residual[1] ** 2)
    slider_jacobian(p, w, zero)
    j = w.jacobian
    det = j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]
    floor = w.n_hat * w.l * w.l  # of the restoring term, which must not rule
    if not (j[0, 0] + j[1, 1] > floor and det > 1e-3 * floor * floor):
        return -1.0
    e_1 = -(j[1, 1] * w.residual[0] - j[0, 1] * w.residual[1]) / det
    e_2 = -(j[0, 0] * w.residual[1] - j[1, 0] * w.residual[0]) / det
    turn = math.sqrt(e_1 * e_1 + e_2 * e_2)
    if turn > _LARGEST_TURN:
        e_1, e_2 = e_1 * _LARGEST_TURN / turn, e_2 * _LARGEST_TURN / turn
    mark_start(w)
    for _ in range(8):
        move(p, old, w, e_1, e_2)
        relative = residual_size(w)
        new = math.sqrt(w.residual[0] ** 2 + w.residual[1] ** 2)
        if new <= 0.999 * size or relative < _TOLERANCE:
            return relative
        e_1, e_2 = 0.3 * e_1, 0.3 * e_2
    move(p, old, w, 0.0, 0.0)
    return -1.0


@kernel
def steepest_turn(p: Props, old: State, w: Work) -> float:
    """Turn the axis against the residual until its part along that direction vanishes.

    The safeguard where everything slides and Newton sees no stiffness: expand, then bisect
    (Illinois). Returns the new relative residual, -1 if there is no zero within the largest turn.
    """
    size = math.sqrt(w.residual[0] ** 2 + w.residual[1] ** 2)
    d_1, d_2 = -w.residual[0] / size, -w.residual[1] / size
    elastic_jacobian(p, w)
    high = size / (w.jacobian[0, 0] + w.jacobian[1, 1])
    low, f_low = 0.0, -size
    mark_start(w)
    move(p, old, w, high * d_1, high * d_2)
    f_high = w.residual[0] * d_1 + w.residual[1] * d_2
    while f_high < 0.0:
        low, f_low = high, f_high
        if high >= 3.0 * _LARGEST_TURN:
            move(p, old, w, 0.0, 0.0)
            return -1.0
        high = min(4.0 * high, 3.0 * _LARGEST_TURN)
        move(p, old, w, high * d_1, high * d_2)
        f_high = w.residual[0] * d_1 + w.residual[1] * d_2
    for _ in range(80):
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        move(p, old, w, middle * d_1, middle * d_2)
        f = w.residual[0] * d_1 + w.residual[1] * d_2
        if abs(f) <= 1e-3 * w.n_hat * w.l or high - low < 1e-16:
            break
        if f < 0.0:
            low, f_low, f_high = middle, f, 0.5 * f_high
        else:
            high, f_high, f_low = middle, f, 0.5 * f_low
    return residual_size(w)


@kernel
def solve_axis(p: Props, old: State, w: Work, zero: Floats) -> int:
    """Find the axis in equilibrium; return the iterations taken, or -1."""
    evaluate(p, old, w)
    if p.fused:
        return 0
    size = residual_size(w)
    steepest = 0
    for count in range(_MAX_ITERATIONS):
        if size < _TOLERANCE:
            return count
        new = newton_turn(p, old, w, zero)
        if new < 0.0:
            if size < 1e3 * _TOLERANCE:  # at the round-off of stiff contacts
                return count
            steepest += 1
            new = steepest_turn(p, old, w)
            if new < 0.0 or steepest > _MAX_STEEPEST:
                return -1
        size = new
    return -1


@kernel
def set_forces(w: Work, p: Props, new: State, old: State) -> None:
    """Set the nodes' forces from the evaluated string, surfaces and rims."""
    s_1, s_2 = w.n_hat * w.phi_s[0], w.n_hat * w.phi_s[1]
    k_1, k_2 = w.n_hat * w.phi[1, 0], w.n_hat * w.phi[1, 1]
    t, n, q = w.t, w.n, w.q_i
    for a in range(3):
        w.g[a] = w.scale * (-w.n_hat * n[a] + t[0, a] * s_1 + t[1, a] * s_2)
        w.sums[a] = w.scale * p.radius[1] * (
            t[0, a] * k_1 + t[1, a] * k_2 - w.rim[1] * w.r_top[a]
        )  # fmt: skip
    m = w.sums
    m_0, m_1, m_2 = n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]
    f = new.force
    for a in range(3):
        w.tau[a] = q[a, 0] * m_0 + q[a, 1] * m_1 + q[a, 2] * m_2
        f[6 + a] = q[a, 0] * w.g[0] + q[a, 1] * w.g[1] + q[a, 2] * w.g[2]
        f[a] = -f[6 + a]
    torsion(p, old, w, new)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        arm_b, arm_c = p.lever[1] * w.q_j[b, 2], p.lever[1] * w.q_j[c, 2]
        f[9 + a] = w.tau[a] - (arm_b * f[6 + c] - arm_c * f[6 + b])
        arm_b = p.lever[0] * w.q_i[b, 2] + w.c_global[b]
        arm_c = p.lever[0] * w.q_i[c, 2] + w.c_global[c]
        f[3 + a] = -w.tau[a] - (arm_b * f[6 + c] - arm_c * f[6 + b])
    f[11] += w.torque
    f[5] -= w.torque


@kernel
def torsion(p: Props, old: State, w: Work, new: State) -> None:
    """Set the friction moment about the vertical: the weakest of the three contacts slips.

    Full circular contacts under uniform pressure; the friction coefficients are those of the
    committed state.
    """
    mu = min(old.friction_coefficient[0], old.friction_coefficient[1], p.interface_friction)
    z, _, slope, _, _, _, slip, _, _ = return_map(
        p.bouc_wen, p.exponent, old.twist_hysteresis, 0.0, new.twist - old.twist, 0.0,
        p.torsion_yield,
    )  # fmt: skip
    w.torque_axial = p.torsion_lever * mu * z
    w.torque = w.torque_axial * w.n_true
    w.torque_stiffness = p.torsion_lever * mu * w.n_true * slope
    new.twist_hysteresis, new.slid_twist = z, slip
    new.torque = w.torque


@kernel
def set_state(p: Props, old: State, w: Work, new: State) -> None:
    """Fill what the record keeps of the sliders."""
    n, t, q = w.n, w.t, w.q_i
    for a in range(3):
        new.axis[a] = n[a]
        new.centres[a] = w.c[a]
        new.axis_top[a] = w.a[0, a] * n[0] + w.a[1, a] * n[1] + w.a[2, a] * n[2]
        global_axis = q[a, 0] * n[0] + q[a, 1] * n[1] + q[a, 2] * n[2]
        new.slider_displacement[0, a] = -p.radius[0] * (global_axis - q[a, 2])
        new.slider_displacement[1, a] = -p.radius[1] * (global_axis - w.q_j[a, 2])
        new.slip_total[a] = 0.0
        for b in range(3):
            new.slip_total[a] += q[a, b] * (t[0, b] * w.sigma[0] + t[1, b] * w.sigma[1])
    new.string = w.l
    new.closure = w.closure
    new.slid_interface = 0.0 if p.fused else w.slid_s
    new.axial_force = w.n_true
    for k in range(2):
        new.slip[k] = w.sigma[k]
        new.slip_increment[k] = w.sigma[k] - old.slip[k]
        new.interface_hysteresis[k] = w.z_s[k]
        new.interface_force[k] = w.scale * w.n_hat * w.phi_s[k]
        new.friction_coefficient[k] = w.mu[k]
        new.sliding_speed[k] = w.speed[k]
        new.slid[k] = w.slid[k]
        new.eccentricity[k] = p.radius[k] * w.n_hor[k]
        new.rim_closure[k] = w.rim_closure[k]
        new.rim_force[k] = w.scale * w.rim[k]
        for a in range(2):
            new.hysteresis[k, a] = w.z[k, a]
            new.friction_force[k, a] = w.scale * w.n_hat * w.phi[k, a]
            new.sliding_increment[k, a] = w.dw[k, a]


@kernel
def limit_status(p: Props, new: State) -> int:
    """Return whether the bearing's limits hold in the state `new`.

    The slip counts once the sliders are pressed together: lifted off, they carry nothing.
    """
    if new.axial_force > 0.0 and math.sqrt(new.slip[0] ** 2 + new.slip[1] ** 2) > p.slip_capacity:
        return _SLIP_EXCEEDED
    if max(new.rim_closure[0], new.rim_closure[1]) > p.rim_overrun:
        return _RIM_OVERRUN
    return _OK


@kernel
def has_snapped(p: Props, old: State, w: Work, count: int) -> bool:
    """Return whether the slip passed ``L mu_h + mu_1 R_1 + mu_2 R_2``, where equilibrium ends.

    The axial force drives the slip on with ``N s``, both frictions resist: beyond that slip the
    slider leaves the rim, and the only equilibrium left is far away (docs/theory.md).
    """
    if p.fused:
        return False
    held = w.l * p.interface_friction + p.radius[0] * w.mu[0] + p.radius[1] * w.mu[1]
    if count < 0:
        return math.sqrt(old.slip[0] ** 2 + old.slip[1] ** 2) > 0.9 * held
    return math.sqrt(w.sigma[0] ** 2 + w.sigma[1] ** 2) > 1.001 * held


@kernel
def trial(
    p: Props, old: State, new: State, w: Work, u: Floats, v: Floats, time: float, zero: Floats
) -> int:
    """Determine the state at displacements `u`, velocities `v` (12,) and `time`.

    Returns a RunStatus code. A limit of the bearing that is exceeded leaves a valid state:
    whoever commits it must look at `new.status`.
    """
    for k in range(12):
        if not (math.isfinite(u[k]) and math.isfinite(v[k])):
            new.status = _NOT_FINITE
            return _NOT_FINITE
    w.dt = max(time - old.time, 0.0)
    place_plates(p, w, u)
    size = math.sqrt(w.c[0] ** 2 + w.c[1] ** 2 + w.c[2] ** 2)
    if not -w.c[2] > _SMALLEST_COSINE * size:
        new.status = _SPHERE_EXCEEDED
        return _SPHERE_EXCEEDED
    for a in range(3):
        w.old_top[a] = (
            w.a[a, 0] * old.axis_top[0] + w.a[a, 1] * old.axis_top[1] + w.a[a, 2] * old.axis_top[2]
        )
    aim_axis(p, old, w)
    if w.dt == 0.0:
        static_speeds(p, w, v)
    count = solve_axis(p, old, w, zero)
    for k in range(12):
        new.displacement[k] = u[k]
    new.time = time
    new.twist = u[11] - u[5]
    new.iterations = count
    set_forces(w, p, new, old)
    set_state(p, old, w, new)
    status = limit_status(p, new)
    if has_snapped(p, old, w, count):
        status = _SLIP_UNSTABLE
    elif count < 0:
        status = _NO_EQUILIBRIUM
    for k in range(12):
        if not math.isfinite(new.force[k]):
            status = _NOT_FINITE
    new.status = status
    return status


@kernel
def shortening_work(at: State, old: State, new: State) -> float:
    """Return axial force times change of the string's length, both as they are in the state `at`.

    ``dl = -n . dc - s . dn``: with the direction of its own end each force does exactly the work
    of the nodes' forces, however far the step goes.
    """
    n = at.axis
    lean = (at.slip[0] * n[0] + at.slip[1] * n[1]) / (1.0 + n[2])
    s_1, s_2, s_3 = at.slip[0] - lean * n[0], at.slip[1] - lean * n[1], -lean * (1.0 + n[2])
    length = 0.0
    for a in range(3):
        s = s_1 if a == 0 else (s_2 if a == 1 else s_3)
        length -= n[a] * (new.centres[a] - old.centres[a]) + s * (new.axis[a] - old.axis[a])
    return at.axial_force * length


@kernel
def rim_work(p: Props, at: State, old: State, new: State, k: int) -> float:
    """Return rim force `k` times the radial sliding, both as they are in the state `at`."""
    if at.rim_force[k] == 0.0:
        return 0.0
    if k == 0:
        x, y = at.axis[0], at.axis[1]
        d_x, d_y = new.axis[0] - old.axis[0], new.axis[1] - old.axis[1]
    else:
        x, y = at.axis_top[0], at.axis_top[1]
        d_x, d_y = new.axis_top[0] - old.axis_top[0], new.axis_top[1] - old.axis_top[1]
    return at.rim_force[k] * p.radius[k] * (x * d_x + y * d_y) / math.sqrt(x * x + y * y)


@kernel
def contact_defect(old: State, new: State) -> float:
    """Return the energy that the step makes or loses where a contact opens or closes in it.

    The trapezoidal rule lets a contact's force act over the open part of the step as well: force
    times the part of the travel that no closure took part in.
    """
    travel = abs((new.string - old.string) - (new.closure - old.closure))
    defect = 0.5 * (old.axial_force + new.axial_force) * travel
    for k in range(2):
        radial = new.eccentricity[k] - old.eccentricity[k]
        travel = abs(radial - (new.rim_closure[k] - old.rim_closure[k]))
        defect += 0.5 * (old.rim_force[k] + new.rim_force[k]) * travel
    return defect


@kernel
def dissipated(
    f_old_1: float, f_old_2: float, f_1: float, f_2: float, z_1: float, z_2: float, slip: float
) -> float:
    """Return the work of friction over the slipped part of a step, which lies along z.

    By the trapezoidal rule, without the old force where it pointed the other way: never negative.
    """
    size = math.sqrt(z_1 * z_1 + z_2 * z_2)
    if slip <= 0.0 or size == 0.0:
        return 0.0
    e_1, e_2 = z_1 / size, z_2 / size
    return 0.5 * slip * (max(f_old_1 * e_1 + f_old_2 * e_2, 0.0) + f_1 * e_1 + f_2 * e_2)


@kernel
def accumulate(p: Props, old: State, new: State) -> None:
    """Add the works and paths of the step from `old` to `new` to those of `new`.

    Works by the trapezoidal rule: over the step they sum to that of the nodes' forces (exactly
    so for the stiff contacts, whose forces jump).
    """
    total = 0.5 * (old.torque + new.torque) * (new.twist - old.twist)
    turned = dissipated(old.torque, 0.0, new.torque, 0.0, new.twist_hysteresis, 0.0, new.slid_twist)
    lost = turned
    for k in range(2):
        f, g = old.friction_force[k], new.friction_force[k]
        d, z = new.sliding_increment[k], new.hysteresis[k]
        total += 0.5 * ((f[0] + g[0]) * d[0] + (f[1] + g[1]) * d[1])
        work = dissipated(f[0], f[1], g[0], g[1], z[0], z[1], new.slid[k])
        lost += work
        new.work_friction[k] = old.work_friction[k] + work + 0.5 * turned
        new.travel[k] = old.travel[k] + math.sqrt(d[0] * d[0] + d[1] * d[1])
        work = 0.5 * (rim_work(p, old, old, new, k) + rim_work(p, new, old, new, k))
        new.work_rim[k] = old.work_rim[k] + work
    f, g, d, z = old.interface_force, new.interface_force, new.slip_increment, new.slip
    total += 0.5 * ((f[0] + g[0]) * d[0] + (f[1] + g[1]) * d[1])
    y = new.interface_hysteresis
    work = dissipated(f[0], f[1], g[0], g[1], y[0], y[1], new.slid_interface)
    new.work_interface = old.work_interface + work
    new.work_elastic = old.work_elastic + total - lost - work
    new.interface_travel = old.interface_travel + math.sqrt(d[0] * d[0] + d[1] * d[1])
    new.largest_slip = max(old.largest_slip, math.sqrt(z[0] * z[0] + z[1] * z[1]))
    work = 0.5 * (shortening_work(old, old, new) + shortening_work(new, old, new))
    new.work_contact = old.work_contact + work


@kernel
def copy_words(source: Words, target: Words) -> None:
    """Copy one record, seen as a row of 64-bit words."""
    for k in range(source.shape[0]):
        target[k] = source[k]


@kernel
def trial_one(
    props: Records,
    committed: Records,
    trial_state: Records,
    work: Records,
    u: Floats,
    v: Floats,
    time: float,
    zero: Floats,
) -> int:
    """Run `trial` on arrays of one record (records cross into kernels as arrays)."""
    return trial(props[0], committed[0], trial_state[0], work[0], u, v, time, zero)


@kernel
def tangent_one(
    props: Records, trial_state: Records, work: Records, k: Floats, zero: Floats, axes: Floats
) -> None:
    """Fill the tangent `k` (12, 12) of the trial in `work`, for arrays of one record."""
    fill_tangent(props[0], work[0], trial_state[0].force, k, zero, axes)


@kernel
def accumulate_one(props: Records, committed: Records, trial_state: Records) -> None:
    """Run `accumulate` on arrays of one record."""
    accumulate(props[0], committed[0], trial_state[0])
