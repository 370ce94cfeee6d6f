"""Kernels of the level 'pendulum': works of a step, taken up when it is committed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.friction_law import least
from lir_element.kernels.pendulum.axial import rubs_by
from lir_element.kernels.pendulum.spin import spin_work
from lir_element.kernels.slip import open_work, stored, surplus

if TYPE_CHECKING:
    from lir_element.layout import Props, State


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
def contact_defect(p: Props, old: State, new: State) -> float:
    """Return the energy that the contacts gain or lose in the step by its size alone.

    Works of open contacts, and a rim's release beyond its stored energy, for example if a slider
    runs along it in large steps.
    """
    defect = 0.0
    if p.fixed_load == 0.0:
        defect = open_work(
            old.axial_force, new.axial_force, new.string - old.string, new.closure - old.closure
        )
    for k in range(2):
        if old.rim_force[k] == 0.0 and new.rim_force[k] == 0.0:
            continue
        if old.rim_dent[k, 0] == math.inf:  # broken in the step before: its force is lost
            continue
        radial = new.eccentricity[k] - old.eccentricity[k] - new.rim_flow[k]
        before, after = old.rim_closure[k], new.rim_closure[k]
        defect += open_work(old.rim_force[k], new.rim_force[k], radial, after - before)
        work = 0.5 * (rim_work(p, old, old, new, k) + rim_work(p, new, old, new, k))
        defect += surplus(p.rim_stiffness, before, after, work)
    return defect


@kernel
def taken(old: State, new: State, side: int, work: float) -> float:
    """Return the dissipated part of friction's work over the slipped part of a step.

    If slip reverses within a step, the trapezoidal rule may make that work negative, by about the
    friction force's work in a fraction of the step. The deficit is carried until the next slip
    covers it, so that the dissipation never falls.
    """
    due = old.work_owed[side] + work
    paid = max(due, 0.0)
    new.work_owed[side] = due - paid
    new.work_step += new.work_owed[side] - old.work_owed[side]
    return paid


@kernel
def store_law(p: Props, side: int) -> tuple[float, float]:
    """Return the friction coefficient that counts for a contact's store, and its u_y.

    Side 0 bottom, 1 top, 2 interface. Of a coefficient that sliding raises the least counts.
    """
    if side == 2:
        return p.interface_friction, p.interface_yield
    return least(p, side), p.yield_displacement[side]


@kernel
def pressing(p: Props, at: State) -> float:
    """Return the axial force that counts for the stores of friction: a fixed load as it is."""
    return p.fixed_load if p.fixed_load > 0.0 else at.axial_force


@kernel
def spring_energy(p: Props, at: State, k: int) -> float:
    """Return the energy in the elastic sliding of surface `k` in the state `at`."""
    low, u_y = store_law(p, k)
    z = at.hysteresis[k]
    return stored(low, pressing(p, at), u_y, z[0], z[1])


@kernel
def rubbing_load(p: Props, force: float) -> float:
    """Return the load that the interface rubs by under an axial force, 0 in tension."""
    more, _ = rubs_by(p, force)
    return max(force, 0.0) * more


@kernel
def interface_energy(p: Props, at: State) -> float:
    """Return the same of the interface."""
    if p.fused:
        return 0.0
    mu, u_y = store_law(p, 2)
    z = at.interface_hysteresis
    return stored(mu, rubbing_load(p, pressing(p, at)), u_y, z[0], z[1])


@kernel
def interface_work(p: Props, old: State, new: State) -> float:
    """Return the work of the interface's friction over the step.

    The interface's force beyond it, while the bearing is pulled, is the contact's.
    """
    before = p.interface_friction * rubbing_load(p, old.axial_force)
    after = p.interface_friction * rubbing_load(p, new.axial_force)
    y, z = old.interface_hysteresis, new.interface_hysteresis
    d_1, d_2 = new.slip[0] - old.slip[0], new.slip[1] - old.slip[1]
    along = (before * y[0] + after * z[0]) * d_1 + (before * y[1] + after * z[1]) * d_2
    return 0.5 * along


@kernel
def twist_energy(p: Props, at: State) -> float:
    """Return the same of the torsional friction, which counts with its least coefficient."""
    low = p.interface_friction
    for k in range(2):
        low = min(low, store_law(p, k)[0])
    low *= p.torsion_lever
    return stored(low, pressing(p, at), p.torsion_yield, at.twist_hysteresis, 0.0)


@kernel
def together(a: float, b: float, c: float) -> tuple[float, float, float]:
    """Return the works of three contacts with the same sum, none negative unless the sum is.

    Spinning sliders exchange work between contacts: it counts together.
    """
    least, total = min(a, b, c), a + b + c
    if least >= 0.0 or total <= 0.0:
        return a, b, c
    a, b, c = max(a, 0.0), max(b, 0.0), max(c, 0.0)
    share = total / (a + b + c)
    return share * a, share * b, share * c


@kernel
def accumulate(p: Props, old: State, new: State) -> None:
    """Add the works and paths of the step from `old` to `new` to those of `new`.

    Works by the trapezoidal rule: over the step they sum to that of the nodes' forces (exactly so
    for the stiff contacts, whose forces jump). The work of friction beyond its elastic energy is
    dissipated.
    """
    gain = twist_energy(p, new) - twist_energy(p, old)
    turned = 0.5 * (old.torque + new.torque) * (new.twist - old.twist) - gain
    spun, spin = spin_work(old, new), new.spin - old.spin
    works = (0.0, 0.0, 0.0)
    for k in range(2):
        f, g, d = old.friction_force[k], new.friction_force[k], new.sliding_increment[k]
        spring = spring_energy(p, new, k) - spring_energy(p, old, k)
        d_1, d_2 = d[0] + spin * old.spin_arm[k, 1], d[1] - spin * old.spin_arm[k, 0]  # of the axis
        work = 0.5 * ((f[0] + g[0]) * d_1 + (f[1] + g[1]) * d_2) - spring
        gain += spring
        work += 0.5 * (turned + spun)
        works = (work, 0.0, 0.0) if k == 0 else (works[0], work, 0.0)
        new.travel[k] = old.travel[k] + math.sqrt(d_1 * d_1 + d_2 * d_2)
        work = 0.5 * (rim_work(p, old, old, new, k) + rim_work(p, new, old, new, k))
        new.work_rim[k] = old.work_rim[k] + work
    f, g, d, s = old.interface_force, new.interface_force, new.slip_increment, new.slip
    d_1, d_2 = s[0] - old.slip[0], s[1] - old.slip[1]
    held = 0.0
    if not p.fused:
        spring = interface_energy(p, new) - interface_energy(p, old)
        total = 0.5 * ((f[0] + g[0]) * d_1 + (f[1] + g[1]) * d_2)
        held = total - interface_work(p, old, new)
        works = (works[0], works[1], total - held - spring - spun)
        gain += spring
    if spin != 0.0:
        works = together(works[0], works[1], works[2])
    for k in range(2):
        new.work_friction[k] = old.work_friction[k] + taken(old, new, k, works[k])
    if not p.fused:
        new.work_interface = old.work_interface + taken(old, new, 2, works[2])
    new.work_elastic = old.work_elastic + gain
    new.interface_travel = old.interface_travel + math.sqrt(d[0] * d[0] + d[1] * d[1])
    square = s[0] * s[0] + s[1] * s[1]
    if square > old.largest_slip * old.largest_slip:
        new.largest_slip = math.sqrt(square)
    work = 0.5 * (shortening_work(old, old, new) + shortening_work(new, old, new))
    if p.fixed_load > 0.0:  # the load of the string rises; the spring beside it
        work += p.fixed_load * (new.centres[2] - old.centres[2])
        work += 0.5 * (old.vertical_force + new.vertical_force) * (new.closure - old.closure)
    new.work_contact = old.work_contact + work + held
