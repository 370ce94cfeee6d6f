"""Kernels of bearings whose sliders are bodies: their record from the bodies, works of a step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.errors import RunStatus
from lir_element.kernels.contact.pair import set_tangents
from lir_element.kernels.contact.places import (
    HIGH,
    LOW_BOTTOM,
    LOW_TOP,
    NORMAL,
    OWN,
    RIM_BOTTOM,
    RIM_TOP,
    locate,
    turn_between,
)
from lir_element.kernels.pendulum.trial import SMALLEST_COSINE, is_finite, keep_works, limit_status
from lir_element.kernels.pendulum.work import store_law, taken
from lir_element.kernels.rim import gives_way, largest_dent
from lir_element.kernels.slip import open_work, stored, surplus

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import (
        Bodies,
        Floats,
        Props,
        Records,
        Scratch,
        Sliders,
        State,
    )

_NOT_FINITE = int(RunStatus.NOT_FINITE)
_SPHERE_EXCEEDED = int(RunStatus.SPHERE_EXCEEDED)
_SIDES = (0, 2, 1)  # of a contact pair: 0 bottom, 1 top, 2 interface


@kernel
def fill_state(s: BodyStep, old: State, new: State, u: Floats) -> None:
    """Fill the bearing's record from its bodies in the scratch and its contact points."""
    p, c, w = s.props, s.sliders, s.scratch
    bodies = s.new
    for k in range(12):
        new.displacement[k] = u[k]
        new.force[k] = -w.g[k if k < 6 else k + 12]
    keep_works(old, new)
    set_axes(p, w, new)
    set_slip(p, c, w, old, new)
    set_averages(p, c, s.points, s.touch_new, new)
    new.offset = pressure_offset(p, s.points, s.touch_new)
    set_surfaces(p, c, w, bodies, old, new)
    new.twist = u[11] - u[5]
    new.twist_hysteresis = 0.0
    new.spin = old.spin
    lever, part = p.lever[1], bodies.parts[LOW_TOP]
    new.torque = -(part[23] + lever * (w.q[3][0, 2] * part[19] - w.q[3][1, 2] * part[18]))


@kernel
def bodies_status(p: Props, w: Scratch, new: State) -> int:
    """Return whether a state made of bodies is finite and within the bearing's limits."""
    if not is_finite(new.force):
        return _NOT_FINITE
    if min(w.q[1][2, 2], w.q[2][2, 2]) < SMALLEST_COSINE:
        return _SPHERE_EXCEEDED
    return limit_status(p, new)


@kernel
def set_axes(p: Props, w: Scratch, new: State) -> None:
    """Set the sliders' axes in axes of the plates, the line of centres and its length."""
    q, r = w.q[0], w.q[3]
    length = 0.0
    for a in range(3):
        w.spare_vector[a] = w.x[3, a] - w.x[0, a] - p.lever[1] * r[a, 2] - p.lever[0] * q[a, 2]
        length -= w.q[1][a, 2] * w.spare_vector[a]
    c = w.spare_vector
    for a in range(3):
        new.centres[a] = q[0, a] * c[0] + q[1, a] * c[1] + q[2, a] * c[2]
        new.axis[a] = q[0, a] * w.q[1][0, 2] + q[1, a] * w.q[1][1, 2] + q[2, a] * w.q[1][2, 2]
        new.axis_top[a] = r[0, a] * w.q[2][0, 2] + r[1, a] * w.q[2][1, 2] + r[2, a] * w.q[2][2, 2]
    new.string = length
    new.closure = max(length - p.length, 0.0)


@kernel
def set_slip(p: Props, c: Sliders, w: Scratch, old: State, new: State) -> None:
    """Set the slip of the interface: the top slider's axis point from that of the bottom one.

    A rigid slider has none: the displacement of its bond is elastic.
    """
    if p.fused:
        for a in range(2):
            new.slip[a], new.slip_increment[a], new.slip_total[a] = 0.0, 0.0, 0.0
        new.slip_total[2] = 0.0
        return
    n = w.q[1]
    s, along = w.spare_vector, 0.0
    for a in range(3):
        s[a] = w.x[2, a] + c.plane[1] * w.q[2][a, 2] - w.x[1, a] - c.plane[0] * n[a, 2]
        along += s[a] * n[a, 2]
    for a in range(3):
        s[a] -= along * n[a, 2]
        new.slip_total[a] = s[a]
    set_tangents(w, new.axis[0], new.axis[1], new.axis[2])
    q, t_1, t_2 = w.q[0], w.tangent_1, w.tangent_2
    new.slip[0], new.slip[1] = 0.0, 0.0
    for a in range(3):
        own = q[0, a] * s[0] + q[1, a] * s[1] + q[2, a] * s[2]
        new.slip[0] += t_1[a] * own
        new.slip[1] += t_2[a] * own
    for a in range(2):
        new.slip_increment[a] = new.slip[a] - old.slip[a]


@kernel
def set_averages(p: Props, c: Sliders, points: Records, touch: Records, new: State) -> None:
    """Set friction states and forces of the three interfaces from their points."""
    new.axial_force = 0.0
    for a in range(2):
        new.slid[a], new.friction_coefficient[a], new.sliding_speed[a] = 0.0, 0.0, 0.0
        new.interface_hysteresis[a], new.interface_force[a] = 0.0, 0.0
        for b in range(2):
            new.hysteresis[a, b], new.friction_force[a, b] = 0.0, 0.0
            new.sliding_increment[a, b] = 0.0
    for j in range(points.shape[0]):
        t, share, pair = touch[j], points[j].share, points[j].pair
        if pair == 1:
            load = t.push + share * p.interface_preload
            for a in range(2):
                new.interface_hysteresis[a] += share * t.hysteresis[a]
                new.interface_force[a] += load * t.friction * t.hysteresis[a]
            continue
        side = 0 if pair == 0 else 1
        sign = 1.0 if pair == 0 else -1.0  # on the top surface the plate's motion counts
        if pair == 2:
            new.axial_force += t.push
        new.slid[side] += share * t.slid
        new.friction_coefficient[side] += share * t.friction / c.grip[side]
        new.sliding_speed[side] += share * t.speed
        for a in range(2):
            new.hysteresis[side, a] += sign * share * t.hysteresis[a]
            new.friction_force[side, a] += sign * t.push * t.friction * t.hysteresis[a]
            new.sliding_increment[side, a] += sign * share * t.increment[a]


@kernel
def pressure_offset(p: Props, points: Records, touch: Records) -> float:
    """Return the larger distance of the discs' pressure from the sliders' axes [m].

    0 without pressure, for a rigid slider, and with contact points.
    """
    if points[0].disc == 0.0 or p.fused or touch[1].push == 0.0:
        return 0.0
    t = touch[1]
    x = t.spot[0] + t.centre[0] * t.axes[0, 0] + t.centre[1] * t.axes[1, 0]
    y = t.spot[1] + t.centre[0] * t.axes[0, 1] + t.centre[1] * t.axes[1, 1]
    return max(math.sqrt(x * x + y * y), math.sqrt(t.centre[0] ** 2 + t.centre[1] ** 2))


@kernel
def set_surfaces(p: Props, c: Sliders, w: Scratch, bodies: Bodies, old: State, new: State) -> None:
    """Set sliding on both surfaces, and the rims."""
    for side in range(2):
        body, carrier = (1, 0) if side == 0 else (2, 3)
        up = p.lever[0] if side == 0 else -p.lever[1]
        locate(w, body, carrier, 0.0, 0.0, c.vertex[side], up)
        sign = 1.0 if side == 0 else -1.0
        q, d = w.q[carrier], w.d
        for a in range(3):
            new.slider_displacement[side, a] = sign * (
                q[a, 0] * d[0] + q[a, 1] * d[1] + q[a, 2] * (d[2] + sign * p.radius[side])
            )
        new.eccentricity[side] = math.sqrt(d[0] * d[0] + d[1] * d[1])
        new.rim_closure[side] = bodies.rim_closure[side]
        new.rim_force[side] = bodies.rim_force[side]
        new.rim_flow[side], new.rim_bent[side] = bodies.rim_flow[side], bodies.rim_bent[side]
        if gives_way(p):
            dents = bodies.rim_dent[side]
            for a in range(dents.shape[0]):
                new.rim_dent[side, a] = dents[a]
            new.rim_plastic[side] = largest_dent(
                old.rim_plastic[side], dents, bodies.rim_bent[side]
            )


@kernel
def set_moves(
    old: State, new: State, b_old: Bodies, b_new: Bodies, bodies: int, moves: Floats
) -> None:
    """Set `moves` (24,): displacement and turn of each body over the step.

    The first `bodies` of the three come from their record, the nodes from their displacements.
    """
    for a in range(6):
        moves[a] = new.displacement[a] - old.displacement[a]
        moves[18 + a] = new.displacement[6 + a] - old.displacement[6 + a]
    for k in range(bodies):
        for a in range(3):
            moves[6 * k + 6 + a] = b_new.displacement[k, a] - b_old.displacement[k, a]
        x, y, z = turn_between(b_old.turn[k], b_new.turn[k])
        moves[6 * k + 9], moves[6 * k + 10], moves[6 * k + 11] = x, y, z


@kernel
def taken_up(b_old: Bodies, b_new: Bodies, moves: Floats, origin: int) -> float:
    """Return the work that the forces of one origin take up over the step (trapezoidal)."""
    total = 0.0
    for row in range(24):
        total -= 0.5 * (b_old.parts[origin, row] + b_new.parts[origin, row]) * moves[row]
    return total


@kernel
def spring_gains(s: BodyStep) -> tuple[float, float, float]:
    """Return the energy of the elastic sliding of all points: bottom, top, interface."""
    bottom, top, plane = 0.0, 0.0, 0.0
    for j in range(s.points.shape[0]):
        side = _SIDES[s.points[j].pair]
        if side == 2 and s.props.fused:
            continue
        mu, u_y = store_law(s.props, side)
        before, after = s.touch_old[j], s.touch_new[j]
        y, z = before.hysteresis, after.hysteresis
        first, last = before.push, after.push
        if side < 2:
            mu *= s.sliders.grip[side]
        else:
            held = s.points[j].share * s.props.interface_preload
            first, last = first + held, last + held
        if s.points[j].disc > 0.0:
            gain = stored(mu, last, u_y, after.norm, 0.0)
            gain -= stored(mu, first, u_y, before.norm, 0.0)
        else:
            gain = stored(mu, last, u_y, z[0], z[1])
            gain -= stored(mu, first, u_y, y[0], y[1])
        if side == 0:
            bottom += gain
        elif side == 1:
            top += gain
        else:
            plane += gain
    return bottom, top, plane


@kernel
def contact_accumulate(s: BodyStep, old: State, new: State, bodies: int) -> None:
    """Add the works and paths of the step from `old` to `new` to those of `new`.

    Trapezoidal, over the motion of all bodies: the terms sum to the work of the nodes' forces. The
    work of friction beyond its elastic energy is dissipated.
    """
    b_old, b_new, moves = s.old, s.new, s.scratch.moves
    set_moves(old, new, b_old, b_new, bodies, moves)
    gains = spring_gains(s)
    for side, origin in ((0, LOW_BOTTOM), (1, LOW_TOP), (2, HIGH)):
        lost = taken(old, new, side, taken_up(b_old, b_new, moves, origin) - gains[side])
        new.work_elastic += gains[side]
        if side < 2:
            new.work_friction[side] += lost
        else:
            new.work_interface += lost
    new.work_contact += taken_up(b_old, b_new, moves, NORMAL)
    new.work_rim[0] += taken_up(b_old, b_new, moves, RIM_BOTTOM)
    new.work_rim[1] += taken_up(b_old, b_new, moves, RIM_TOP)
    new.work_sliders += taken_up(b_old, b_new, moves, OWN)
    for k in range(2):
        d = new.sliding_increment[k]
        new.travel[k] += math.sqrt(d[0] * d[0] + d[1] * d[1])
    q = s.scratch.q
    for k in range(2):  # the mean of both sliders, about their axes and against the bottom plate
        for a in range(3):
            new.spin += 0.5 * (moves[6 * k + 9 + a] - moves[3 + a]) * q[k + 1][a, 2]
    d, slip = new.slip_increment, new.slip
    new.interface_travel += math.sqrt(d[0] * d[0] + d[1] * d[1])
    size = math.sqrt(slip[0] * slip[0] + slip[1] * slip[1])
    new.largest_slip = max(old.largest_slip, size)


@kernel
def points_defect(s: BodyStep) -> float:
    """Return the energy that contacts make or lose in the step by its size, as `contact_defect`."""
    p, b_old, b_new = s.props, s.old, s.new
    defect = 0.0
    for j in range(s.points.shape[0]):
        before, after = s.touch_old[j], s.touch_new[j]
        defect += open_work(
            before.push, after.push, after.gap - before.gap, after.closure - before.closure
        )
    for k in range(2):
        if b_old.rim_force[k] == 0.0 and b_new.rim_force[k] == 0.0:
            continue  # a rim at infinity among them
        if b_old.rim_dent[k, 0] == math.inf:  # broken in the step before: its force is lost
            continue
        approach = b_new.rim_gap[k] - b_old.rim_gap[k]
        push_old, push = b_old.rim_force[k], b_new.rim_force[k]
        closure_old, closure = b_old.rim_closure[k], b_new.rim_closure[k]
        defect += open_work(push_old, push, approach, closure - closure_old)
        work = 0.5 * (push_old + push) * approach
        defect += surplus(p.rim_stiffness, closure_old, closure, work)
    return defect
