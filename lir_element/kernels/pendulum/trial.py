"""Kernels of the level 'pendulum': the state determination (trial), and the commit.

`trial` reads the committed record `old`, never writes it, and fills the record `new`; calling it
twice gives the same bits. To commit: `accumulate`, then `copy_words` of the new record.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.pendulum.axial import rubs_by
from lir_element.kernels.pendulum.solve import solve_axis, start_search
from lir_element.kernels.pendulum.spin import keep_spin, spin_by, start_spin
from lir_element.kernels.pendulum.spinning import first_spin, spin_sliders, spin_with_axis
from lir_element.kernels.pendulum.string import (
    aim_axis,
    aim_on,
    evaluate,
    place_plates,
    set_axis,
    static_speeds,
)
from lir_element.kernels.rim import gives_way, keep_dents, largest_dent
from lir_element.kernels.slip import friction_map

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, State, Work

_OK = int(RunStatus.OK)
_NOT_FINITE = int(RunStatus.NOT_FINITE)
_NO_EQUILIBRIUM = int(RunStatus.NO_EQUILIBRIUM)
_SLIP_EXCEEDED = int(RunStatus.SLIP_EXCEEDED)
_RIM_OVERRUN = int(RunStatus.RIM_OVERRUN)
_SPHERE_EXCEEDED = int(RunStatus.SPHERE_EXCEEDED)
_SLIP_UNSTABLE = int(RunStatus.SLIP_UNSTABLE)
_UPLIFT_EXCEEDED = int(RunStatus.UPLIFT_EXCEEDED)
_NEAR_END = 0.9  # of the last slip: a search that fails from beyond it has met it (a choice)
_BEYOND_END = 1.001  # of it: results further on are on the far side; 0.1 % for the estimate
_SNAPS = 0.97
"""Share of the slip limit of equilibrium above which a failed search has met the limit."""
_STARTS = (0.9, 0.5, 1.0, 0.75)  # by trial: none of 19,200 random trials near rims stayed unsolved
SMALLEST_COSINE = 0.3  # of the tilt: beyond 72 degrees there is no bearing left


@kernel
def set_forces(w: Work, p: Props, new: State, old: State) -> None:
    """Set the nodes' forces from the evaluated string, surfaces and rims."""
    k_1, k_2 = w.n_pos * w.phi[1, 0], w.n_pos * w.phi[1, 1]
    rim = p.radius[1] * w.rim_scale * w.rim[1]
    t, n, q = w.t, w.n, w.q_i
    for a in range(3):
        w.g[a] = -w.n_true * n[a] + t[0, a] * w.f_s[0] + t[1, a] * w.f_s[1]  # (2.2)
        w.moment[a] = p.radius[1] * (t[0, a] * k_1 + t[1, a] * k_2)
        if rim > 0.0:
            w.moment[a] -= rim * w.r_top[a]
    if p.fixed_load > 0.0:
        w.g[2] = -w.vertical
    m = w.moment
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
    new.twist_hysteresis = 0.0
    new.torque, w.torque, w.torque_axial = 0.0, 0.0, 0.0
    mu = min(old.friction_coefficient[0], old.friction_coefficient[1], p.interface_friction)
    if new.twist == old.twist and old.twist_hysteresis == 0.0:
        slope = 0.5 * (1.0 + w.kept) * (1.0 / p.torsion_yield)
        w.torque_stiffness = p.torsion_lever * mu * w.n_pos * slope
        return
    z, _, slope, _, _, _, _, _, _, by_n, _ = friction_map(
        p.bouc_wen,
        p.exponent,
        old.twist_hysteresis,
        0.0,
        new.twist - old.twist,
        0.0,
        p.torsion_yield,
        w.kept,
        w.kept_n,
        0.0,
        0.0,
        0.0,
    )
    w.torque_axial = p.torsion_lever * mu * (z + w.n_pos * by_n)
    w.torque = p.torsion_lever * mu * z * w.n_pos
    w.torque_stiffness = p.torsion_lever * mu * w.n_pos * slope
    new.twist_hysteresis = z
    new.torque = w.torque


@kernel
def keep_works(old: State, new: State) -> None:
    """Carry works, paths and temperatures over to the trial: they change when it is committed."""
    for k in range(2):
        new.work_friction[k] = old.work_friction[k]
        new.work_rim[k] = old.work_rim[k]
        new.travel[k] = old.travel[k]
    new.work_interface = old.work_interface
    new.work_elastic = old.work_elastic
    for k in range(3):
        new.work_owed[k] = old.work_owed[k]
    new.work_step = 0.0
    new.work_contact = old.work_contact
    new.work_sliders = old.work_sliders
    new.interface_travel = old.interface_travel
    new.largest_slip = old.largest_slip
    for k in range(3):
        new.temperature[k] = old.temperature[k]


@kernel
def set_state(p: Props, old: State, w: Work, new: State) -> None:
    """Fill the sliders' part of the record."""
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
    n, m = new.axis, new.axis_top
    new.eccentricity[0] = p.radius[0] * math.sqrt(n[0] * n[0] + n[1] * n[1])
    new.eccentricity[1] = p.radius[1] * math.sqrt(m[0] * m[0] + m[1] * m[1])
    keep_works(old, new)
    keep_spin(p, old, w, new)
    new.string = w.l
    new.closure = w.closure
    new.axial_force = w.n_true
    new.vertical_force = w.vertical
    for k in range(2):
        new.slip[k] = w.sigma[k]
        new.slip_increment[k] = w.slip_step[k]
        new.interface_hysteresis[k] = w.z_s[k]
        new.interface_force[k] = w.f_s[k]
        new.friction_coefficient[k] = w.mu[k]
        new.sliding_speed[k] = w.speed[k]
        new.slid[k] = w.slid[k]
        new.rim_closure[k] = w.rim_closure[k]
        new.rim_force[k] = w.rim_scale * w.rim[k]
        new.rim_flow[k], new.rim_bent[k] = w.rim_flow[k], w.rim_bent[k] + w.rim_flow[k]
        if gives_way(p):
            way = -1.0 if k == 0 else 1.0  # from the plate's middle to the slider
            x, y = way * w.unit[k, 0], way * w.unit[k, 1]
            before, dents, here = old.rim_dent[k], new.rim_dent[k], new.rim_bent[k]
            keep_dents(p, before, dents, x, y, w.rim_flow[k], w.rim_closure[k], here)
            new.rim_plastic[k] = largest_dent(old.rim_plastic[k], dents, here)
        for a in range(2):
            new.hysteresis[k, a] = w.z[k, a]
            new.friction_force[k, a] = w.n_pos * w.phi[k, a]
            new.sliding_increment[k, a] = w.rubbed[k, a]


@kernel
def limit_status(p: Props, new: State) -> int:
    """Return whether the bearing's limits hold in the state `new`.

    The slip counts once the sliders are pressed together: lifted off, they carry nothing.
    """
    if new.axial_force > 0.0 and new.slip[0] ** 2 + new.slip[1] ** 2 > p.slip_capacity**2:
        return _SLIP_EXCEEDED
    if p.length - new.string > p.uplift_capacity:
        return _UPLIFT_EXCEEDED
    for k in range(2):
        if p.flange > 0.0:  # it counts once the rim is broken, whose plastic deformation has no end
            way = new.eccentricity[k] - p.rim_displacement[k]
            if new.rim_plastic[k] == math.inf and way > p.flange:
                return _RIM_OVERRUN
        elif new.rim_closure[k] + new.rim_bent[k] > p.rim_overrun:
            return _RIM_OVERRUN
    return _OK


@kernel
def is_finite(x: Floats) -> bool:
    """Return whether all 12 entries are finite."""
    total = 0.0
    for k in range(0, 12, 4):  # sums that do not wait for one another
        total += (abs(x[k]) + abs(x[k + 1])) + (abs(x[k + 2]) + abs(x[k + 3]))
    return math.isfinite(total)


@kernel
def last_slip(p: Props, at: State) -> float:
    """Return the slip limit of equilibrium in a state [m]: ``L mu_h + mu_1 R_1 + mu_2 R_2``.

    The load that the interface rubs by counts with mu_h, over the axial force.

    The axial force drives the slip on with ``N s``, both frictions resist: beyond that slip the
    slider leaves the rim, and the only remaining equilibrium is far away (docs/theory.md, section
    2).
    """
    mu = at.friction_coefficient
    more, _ = rubs_by(p, at.axial_force)
    return at.string * p.interface_friction * more + p.radius[0] * mu[0] + p.radius[1] * mu[1]


@kernel
def is_about_to_snap(p: Props, at: State) -> bool:
    """Return whether the slip of a committed state is next to the one at which equilibrium ends."""
    limit = _SNAPS * last_slip(p, at)
    return bool(at.failed == 0 and at.slip[0] ** 2 + at.slip[1] ** 2 > limit**2)


@kernel
def has_snapped(p: Props, old: State, new: State, count: int) -> bool:
    """Return whether the slip passed the one at which equilibrium ends, or a search met its end."""
    if p.fused:
        return False
    held = last_slip(p, new)
    if count < 0:
        return old.slip[0] ** 2 + old.slip[1] ** 2 > (_NEAR_END * held) ** 2
    return new.slip[0] ** 2 + new.slip[1] ** 2 > (_BEYOND_END * held) ** 2


@kernel
def solve_with_share(p: Props, old: State, w: Work) -> int:
    """Search the axis from an unchanged z of the interface, though the axial force changes much."""
    aim_axis(p, old, w, 1.0)
    evaluate(p, old, w)
    aim_axis(p, old, w, w.kept)
    return solve_axis(p, old, w)


@kernel
def solve_from_elsewhere(p: Props, old: State, w: Work) -> int:
    """Search the axis again from between the committed one and the one that keeps the slip.

    When the slider leaves a rim and slip reverses, the laws of friction make the equilibrium
    unsymmetric, and a search may run in circles; from another start it does not.
    """
    count = -1
    for share in _STARTS:
        aim_axis(p, old, w, 1.0)
        a, n = old.axis, w.n
        set_axis(
            w,
            n[0] + share * (a[0] - n[0]),
            n[1] + share * (a[1] - n[1]),
            n[2] + share * (a[2] - n[2]),
        )
        count = solve_axis(p, old, w)
        if count >= 0:
            return count
    if w.dt == 0.0 or p.fixed_load > 0.0:  # z stays in any case
        return -1
    return solve_with_share(p, old, w)


@kernel
def solve_in_turns(p: Props, old: State, w: Work) -> int:
    """Find the axis for a spin, and the spin around it; return the iterations, or -1."""
    spin_by(p, old, w, first_spin(p, old, w.dt))
    aim_on(p, old, w)
    count = solve_axis(p, old, w)
    if count < 0:
        spin_by(p, old, w, 0.0)
        count = solve_from_elsewhere(p, old, w)
    if count >= 0:
        spin_sliders(p, old, w)
    return count


@kernel
def trial(p: Props, old: State, new: State, w: Work, u: Floats, v: Floats, time: float) -> int:
    """Determine the state at displacements `u`, velocities `v` (12,) and `time`.

    Returns a RunStatus code. A limit of the bearing that is exceeded leaves a valid state:
    whoever commits it must look at `new.status`.
    """
    if not math.isfinite(time):
        return _NOT_FINITE
    if not (is_finite(u) and is_finite(v)):
        return _NOT_FINITE
    w.dt = max(time - old.time, 0.0)
    start_search(p, old, w)
    start_spin(p, old, w)
    if w.dt == 0.0:  # at the committed place: the tangent needs no derivative by it
        place_plates(p, w, old.displacement)
        set_axis(w, old.axis[0], old.axis[1], old.axis[2])
        static_speeds(p, w, v)
    place_plates(p, w, u)
    square = w.c[0] ** 2 + w.c[1] ** 2 + w.c[2] ** 2
    if not (w.c[2] < 0.0 and w.c[2] ** 2 > SMALLEST_COSINE**2 * square):
        return _SPHERE_EXCEEDED
    for a in range(3):
        w.old_top[a] = (
            w.a[a, 0] * old.axis_top[0] + w.a[a, 1] * old.axis_top[1] + w.a[a, 2] * old.axis_top[2]
        )
    count = spin_with_axis(p, old, w)
    if count < 0:
        count = solve_in_turns(p, old, w)
    for k in range(12):
        new.displacement[k] = u[k]
    new.time = time
    new.step = w.dt
    new.twist = u[11] - u[5]
    new.iterations = count
    set_forces(w, p, new, old)
    set_state(p, old, w, new)
    status = limit_status(p, new)
    if has_snapped(p, old, new, count):
        status = _SLIP_UNSTABLE
    elif count < 0:
        status = _NO_EQUILIBRIUM
    if not is_finite(new.force):
        status = _NOT_FINITE
    new.status = status
    return status


@kernel
def has_no_state(code: int) -> bool:
    """Return whether a bearing has no state at all (a limit exceeded is a state)."""
    return code in (_NOT_FINITE, _NO_EQUILIBRIUM, _SPHERE_EXCEEDED, _SLIP_UNSTABLE)
