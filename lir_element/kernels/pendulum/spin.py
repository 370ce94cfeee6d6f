"""Kernels of the level 'pendulum': the spin of the sliders that rims cause.

The forces of the rims on the two sliders are offset by the slip. Their couple about the axis spins
both sliders, against the torque of the surfaces' friction, and the slip rotates with them
(docs/theory.md, section 2). The spin of a step is a third internal unknown beside the axis.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.rim import bent, gives_way
from lir_element.layout import SPIN_BALANCE

if TYPE_CHECKING:
    from lir_element.layout import Props, State, Work

_TORQUE = 2.0 / 3.0  # of friction on a disc that spins, over friction force and radius
_SLOW = 3.0 / 8.0  # radius over 4 times that lever: for a disc that slides and spins slowly (2.4)
_BENDS, _FAST, _BEFORE, _BLEND = 0.1545, 0.75, 0.78, 9.5  # within 3 % of the integral (2.4)
_MOST, _FASTEST = 0.95, 6.0  # of the torque, and the edge's speed over the sliding's (choices)
_MAX_SEARCH, _ENOUGH = 60, 1e-12  # iterations for a torque, and its relative error
_CHOSEN = 2.0  # m: effective radius for which these are chosen; with the pendulum's time they grow
_LAG = 0.005  # s, of speeds and centres of pressure: steps must not answer each other (a choice)
_CREEP = 1e-5  # m/s, with which a surface that sticks counts as sliding (a choice)


@inlined_by_llvm
def turn_with_sliders(c: float, s: float, x: float, y: float) -> tuple[float, float]:
    """Return (x, y) of the interface's plane turned about the axis; cosine, sine."""
    return c * x - s * y, s * x + c * y


@inlined_by_llvm
def to_blend(x: float) -> float:
    """Return ``x**_BLEND``, without a logarithm."""
    square = x * x
    fourth = square * square
    return fourth * fourth * x * math.sqrt(x)


@kernel
def torque_of_spin(ratio: float) -> tuple[float, float]:
    """Return the torque of a disc over that of spinning alone, and its derivative.

    `ratio` is the speed that the spin gives the disc's edge over the speed of sliding, >= 0.
    """
    if ratio == 0.0:
        return 0.0, _SLOW
    square = ratio * ratio
    slow, d_slow = _SLOW * ratio * (1.0 + _BENDS * square), _SLOW * (1.0 + 3.0 * _BENDS * square)
    fast = 1.0 - _FAST / (square + _BEFORE)
    d_fast = 2.0 * _FAST * ratio / (square + _BEFORE) ** 2
    part = slow * (1.0 + to_blend(slow / fast)) ** (-1.0 / _BLEND)  # (2.4)
    of_slow, of_fast = part / slow, part / fast
    by_slow, by_fast = of_slow * to_blend(of_slow), of_fast * to_blend(of_fast)
    return part, by_slow * d_slow + by_fast * d_fast


@kernel
def own_time(p: Props) -> float:
    """Return the time of the bearing's pendulum over that of an effective radius of 2 m.

    Times and speeds without a law of their own follow it, so that similar bearings move equally.
    """
    return math.sqrt(p.length / _CHOSEN)


@kernel
def slides_with(p: Props, old: State, k: int) -> float:
    """Return the speed of surface `k` at the step's start, against which the sliders spin [m/s]."""
    return math.sqrt(old.axis_speed[k] ** 2 + (own_time(p) * _CREEP) ** 2)


@kernel
def start_spin(p: Props, old: State, w: Work) -> None:
    """Set the values at the step's start: centres of pressure, one-sidedness of the rims."""
    w.one_sided = one_sided(p, old)
    for k in range(2):
        w.shift[k, 0], w.shift[k, 1] = old.spin_arm[k, 0], old.spin_arm[k, 1]


@kernel
def spin_by(p: Props, old: State, w: Work, spin: float) -> None:
    """Set the spin of the sliders in a step, and the remaining share of the surfaces' friction.

    Speeds and friction coefficients are those of the step's start.
    """
    w.spin = spin
    w.spins, w.couple = 0.0, 0.0
    for k in range(2):
        w.left[k], w.left_rate[k] = 1.0, 0.0
        if spin == 0.0:
            continue
        drift = w.dt * slides_with(p, old, k)
        ratio = p.slider_radius * abs(spin) / drift
        base = 1.0 + ratio**4
        w.left[k] = 1.0 / math.sqrt(math.sqrt(base))  # (2.5)
        w.left_rate[k] = -math.copysign(ratio**3 / base * p.slider_radius / drift, spin)


@kernel
def torque(p: Props, old: State, w: Work, spin: float) -> tuple[float, float]:
    """Return the torque of the surfaces against the spin over N, and its derivative (2.4)."""
    total, rate = 0.0, 0.0
    for k in range(2):
        drift = w.dt * slides_with(p, old, k)
        most = _TORQUE * p.slider_radius * old.friction_coefficient[k]
        part, slope = torque_of_spin(p.slider_radius * abs(spin) / drift)
        total, rate = total + most * part, rate + most * slope * p.slider_radius / drift
    return math.copysign(total, spin), rate


@kernel
def one_sided(p: Props, old: State) -> float:
    """Return the one-sidedness of the rims: 0 equal pressure, 1 as for the axis alone.

    A slider that rocks on its caps passes its load on to the other rim, because it rocks more
    easily than a rim deforms. The start of the step decides, so that nothing iterates.
    """
    first = 0 if old.rim_force[0] >= old.rim_force[1] else 1
    push = old.rim_force[first]
    if push == 0.0:
        return 0.0
    radius = 0.5 * (p.radius[0] + p.radius[1])
    rocks = 4.0 / 3.0 * (radius / p.slider_radius) ** 2 * p.rim_stiffness / p.axial_stiffness
    gap = p.rim_displacement[1 - first] - old.eccentricity[1 - first]
    if gives_way(p):
        if first == 0:
            gap += bent(old.rim_dent[1], old.axis_top[0], old.axis_top[1])[0]
        else:
            gap += bent(old.rim_dent[0], -old.axis[0], -old.axis[1])[0]
    return min((1.0 + p.rim_stiffness * max(gap, 0.0) / push) / (1.0 + rocks), 1.0)


@kernel
def shared(p: Props, w: Work, k: int, bottom: float, top: float) -> float:
    """Return the part of both rims' moments that presses on slider `k`, which rocks."""
    both = p.radius[0] + p.radius[1]
    alike = p.radius[k] / both * (bottom + top)
    apart = w.one_sided * (p.radius[1] * bottom - p.radius[0] * top) / both
    return alike + apart if k == 0 else alike - apart


@kernel
def rim_moment(p: Props, w: Work, k: int) -> tuple[float, float]:
    """Return sphere radius times rim force of rim `k`, in the interface's plane."""
    push = p.radius[k] * w.rim[k]
    if k == 0:
        return push * w.n[2] * w.unit[0, 0], push * w.n[2] * w.unit[0, 1]
    t, r = w.t, w.r_top
    return (
        push * (t[0, 0] * r[0] + t[0, 1] * r[1] + t[0, 2] * r[2]),
        push * (t[1, 0] * r[0] + t[1, 1] * r[1] + t[1, 2] * r[2]),
    )


@kernel
def spin_against(p: Props, old: State, w: Work, couple: float) -> float:
    """Return the spin in a step at which the surfaces' torque over N is `couple`."""
    most = 0.0
    for k in range(2):
        most += _TORQUE * p.slider_radius * old.friction_coefficient[k]
    wanted = min(abs(couple), _MOST * most)
    low, high = 0.0, _FASTEST * w.dt * max(slides_with(p, old, 0), slides_with(p, old, 1))
    high /= p.slider_radius
    spin = 0.0
    for _ in range(_MAX_SEARCH):
        held, rate = torque(p, old, w, spin)
        if abs(held - wanted) <= _ENOUGH * wanted:
            break
        if held < wanted:
            low = spin
        else:
            high = spin
        spin += (wanted - held) / rate if rate > 0.0 else high
        if not low < spin < high:
            spin = 0.5 * (low + high)
    return math.copysign(spin, couple)


@kernel
def centre_of_pressure(p: Props, w: Work, k: int) -> tuple[float, float]:
    """Return the centre of pressure of surface `k`, from the axis: bottom e_1, top -e_2 (2.3)."""
    a_1, a_2 = rim_moment(p, w, 0)
    b_1, b_2 = rim_moment(p, w, 1)
    return (
        p.radius[k] * (w.phi_s[0] - w.phi[k, 0]) + shared(p, w, k, a_1, b_1) / w.n_hat,
        p.radius[k] * (w.phi_s[1] - w.phi[k, 1]) + shared(p, w, k, a_2, b_2) / w.n_hat,
    )


@kernel
def set_plain(p: Props, old: State, w: Work, k: int) -> None:
    """Set the friction over N that the axis' sliding alone would give, as a radial return.

    With it its derivative, in `bends`: ``drag (I - b b)`` over the sliding that it needs.
    """
    u_y, z = p.yield_displacement[k], old.plain_hysteresis[k]
    b_1, b_2 = z[0] + w.dw[k, 0] / u_y, z[1] + w.dw[k, 1] / u_y
    size = math.sqrt(b_1 * b_1 + b_2 * b_2)
    over = max(size, 1.0)
    w.z_plain[k, 0], w.z_plain[k, 1] = b_1 / over, b_2 / over
    drag = w.left[k] * old.friction_coefficient[k] / over
    w.plain[k, 0], w.plain[k, 1] = drag * b_1, drag * b_2
    w.bends[k, 2] = drag / u_y
    w.bends[k, 0], w.bends[k, 1] = 0.0, 0.0
    if size > 1.0:
        w.bends[k, 0], w.bends[k, 1] = b_1 / size, b_2 / size


@kernel
def plain_rate(w: Work, k: int, dw_1: float, dw_2: float) -> tuple[float, float]:
    """Return the derivative of `plain` by the axis' sliding."""
    b = w.bends[k]
    inward = b[0] * dw_1 + b[1] * dw_2
    return b[2] * (dw_1 - inward * b[0]), b[2] * (dw_2 - inward * b[1])


@kernel
def spin_balance(p: Props, old: State, w: Work) -> float:
    """Set the moments' sum that spins the sliders (2.6) and return it over the axial force.

    Sets also the input of its derivative: centres of pressure and friction along the axis' sliding.
    """
    s, f = w.sigma, w.phi_s
    couple = s[0] * f[1] - s[1] * f[0]
    for k in range(2):
        w.arm[k, 0], w.arm[k, 1] = centre_of_pressure(p, w, k)
        set_plain(p, old, w, k)
        couple -= w.arm[k, 0] * w.plain[k, 1] - w.arm[k, 1] * w.plain[k, 0]
    held, w.torque_rate = torque(p, old, w, w.spin)
    w.torque_spin, w.couple = held, couple
    return couple - held


@kernel
def rates_by_spin(p: Props, w: Work) -> None:
    """Set the derivatives of everything by the spin, whom the axis follows: `w.spun`, as `w.turns`.

    The derivatives by a turn of the axis (`slider_jacobian`) are those of the same state.
    """
    h, f, s = w.h_s, w.phi_s, w.sigma
    for k in range(w.spun.shape[0]):
        w.spun[k] = 0.0
    g_1 = w.n_hat * (-f[1] + h[0, 0] * s[1] - h[0, 1] * s[0])
    g_2 = w.n_hat * (f[0] + h[1, 0] * s[1] - h[1, 1] * s[0])
    d_n = 0.0
    if p.fixed_load > 0.0:  # (9.3)
        d_n = -(w.n[0] * g_1 + w.n[1] * g_2)
        d_n /= w.n[2] + w.n[0] * f[0] + w.n[1] * f[1]
    g_1, g_2 = g_1 + f[0] * d_n, g_2 + f[1] * d_n
    r_1, r_2, balance = w.l * g_1, w.l * g_2, s[0] * g_2 - s[1] * g_1 - d_n * w.torque_spin
    r_1, r_2 = r_1 - d_n * s[0], r_2 - d_n * s[1]
    k_n = w.lean
    basis = k_n * (s[1] * g_1 - s[0] * g_2)
    r_1, r_2 = r_1 + basis * w.n[1], r_2 - basis * w.n[0]
    for k in range(2):
        o_1, o_2 = -w.shift[k, 1], w.shift[k, 0]
        f_1 = (
            w.n_hat * (w.h[k, 0, 0] * o_1 + w.h[k, 0, 1] * o_2 + w.left_rate[k] * w.phi[k, 0])
            + w.phi[k, 0] * d_n
        )
        f_2 = (
            w.n_hat * (w.h[k, 1, 0] * o_1 + w.h[k, 1, 1] * o_2 + w.left_rate[k] * w.phi[k, 1])
            + w.phi[k, 1] * d_n
        )
        r_1, r_2 = r_1 - p.radius[k] * f_1, r_2 - p.radius[k] * f_2
        if k == 1:
            w.spun[5], w.spun[6] = f_1, f_2
        q_1, q_2 = p.radius[k] * (g_1 - f_1), p.radius[k] * (g_2 - f_2)
        balance -= q_1 * w.plain[k, 1] - q_2 * w.plain[k, 0]
        share = w.n_hat * w.left_rate[k]
        balance -= share * (w.arm[k, 0] * w.plain[k, 1] - w.arm[k, 1] * w.plain[k, 0])
    w.spun[0], w.spun[1], w.spun[2], w.spun[3], w.spun[4] = r_1, r_2, d_n, g_1, g_2
    w.spun[SPIN_BALANCE] = balance - w.n_hat * w.torque_rate
    j = w.jacobian
    det = j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]
    e_1 = -(j[1, 1] * r_1 - j[0, 1] * r_2) / det  # the axis follows (4.1)
    e_2 = -(j[0, 0] * r_2 - j[1, 0] * r_1) / det
    w.spun_turn[0], w.spun_turn[1] = e_1, e_2
    for k in range(w.spun.shape[0]):
        w.spun[k] += e_1 * w.turns[0, k] + e_2 * w.turns[1, k]


@kernel
def keep_spin(p: Props, old: State, w: Work, new: State) -> None:
    """Keep the spin's data for the next step in the record `new`."""
    new.spin = old.spin + w.spin
    new.spin_rate = w.spin / w.dt if w.dt > 0.0 else 0.0
    new.spin_couple = w.couple
    pressed = not p.fused and w.n_true > p.axial_floor and max(w.rim[0], w.rim[1]) > 0.0
    share = w.dt / (w.dt + own_time(p) * _LAG)
    for k in range(2):
        e_1, e_2, speed = 0.0, 0.0, w.speed[k]
        if pressed:
            e_1, e_2 = centre_of_pressure(p, w, k)
        if w.spin != 0.0:
            rubbed = math.sqrt(w.rubbed[k, 0] ** 2 + w.rubbed[k, 1] ** 2)
            if rubbed > 0.0:
                speed *= math.sqrt(w.dw[k, 0] ** 2 + w.dw[k, 1] ** 2) / rubbed
        new.plain_hysteresis[k, 0], new.plain_hysteresis[k, 1] = w.z[k, 0], w.z[k, 1]
        if pressed and w.dt > 0.0:
            set_plain(p, old, w, k)
            new.plain_hysteresis[k, 0], new.plain_hysteresis[k, 1] = (
                w.z_plain[k, 0],
                w.z_plain[k, 1],
            )
        was = old.spin_arm[k]
        new.spin_arm[k, 0] = was[0] + share * (e_1 - was[0])
        new.spin_arm[k, 1] = was[1] + share * (e_2 - was[1])
        new.axis_speed[k] = old.axis_speed[k] + share * (speed - old.axis_speed[k])


@kernel
def spin_work(old: State, new: State) -> float:
    """Return the work that the interface passes on to the spin of the sliders in a step."""
    s, f, t, g = old.slip, old.interface_force, new.slip, new.interface_force
    couple = s[0] * f[1] - s[1] * f[0] + t[0] * g[1] - t[1] * g[0]
    return 0.5 * couple * (new.spin - old.spin)
