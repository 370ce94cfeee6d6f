"""Kernels of the level 'pendulum': the spin of the sliders that rims cause.

The forces of the rims on the two sliders are offset by the slip. Their couple about the axis turns
both sliders, against the torque of the surfaces' friction, and the slip turns with them
(docs/theory.md, section 2).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._jit import kernel

if TYPE_CHECKING:
    from lir_element.layout import Props, State, Work

_TORQUE = 2.0 / 3.0  # of friction on a disc that spins, over friction force and radius
_SLOW = 3.0 / 8.0  # radius over 4 times that lever: where the disc slides and spins slowly (2.4)
_FAST = 27.0 / 256.0  # what sliding takes from the torque of a disc that spins fast (2.4)
_BLEND = 4.7  # exponent between both, within 3 % of the integral over the disc
_NARROW = 16.0 / 3.0  # how eccentric pressure lowers it: a quarter at a quarter of the radius
_MOST = 0.95  # of the torque of spinning alone: what a couple beyond it is taken for (a choice)


@kernel
def turn_with_sliders(spin: float, x: float, y: float) -> tuple[float, float]:
    """Return (x, y) of the interface's plane turned by `spin` about the axis."""
    c, s = math.cos(spin), math.sin(spin)
    return c * x - s * y, s * x + c * y


@kernel
def relative_spin(part: float) -> float:
    """Return the spin of a disc of radius a that slides with v, omega a / v, under a couple.

    `part` is the couple over the torque of spinning alone, 0 to below 1.
    """
    slow, fast = part / (1.0 - part**4), math.sqrt(_FAST / (1.0 - part))
    both = (slow**_BLEND + fast**_BLEND) ** (1.0 / _BLEND)
    return slow * fast / (both * _SLOW)  # (2.4)


@kernel
def spin_rate(p: Props, w: Work) -> float:
    """Return the rate at which the sliders spin in the state that was found [rad/s].

    Zero without a rim force, without slip speed on the surfaces, and at a vanishing axial force.
    """
    if not (w.n_true > p.axial_floor and max(w.rim[0], w.rim[1]) > 0.0):
        return 0.0
    couple, held, creep = 0.0, 0.0, 0.0
    for k in range(2):
        if w.mu[k] == 0.0:
            continue
        if w.speed[k] == 0.0:
            return 0.0
        x, y = w.n[2] * w.unit[0, 0], w.n[2] * w.unit[0, 1]
        if k == 1:
            r = w.r_top
            x = w.t[0, 0] * r[0] + w.t[0, 1] * r[1] + w.t[0, 2] * r[2]
            y = w.t[1, 0] * r[0] + w.t[1, 1] * r[1] + w.t[1, 2] * r[2]
        arm = p.radius[k] * w.rim[k] / w.n_true
        f_1, f_2 = w.phi_s[0] - w.phi[k, 0], w.phi_s[1] - w.phi[k, 1]
        couple += arm * (x * f_2 - y * f_1)  # (2.3)
        e_1, e_2 = p.radius[k] * f_1 + arm * x, p.radius[k] * f_2 + arm * y
        along = (e_1 * w.phi[k, 0] + e_2 * w.phi[k, 1]) / (w.mu[k] * p.slider_radius)
        share = w.mu[k] / (1.0 + _NARROW * along * along)  # (2.5)
        held += share
        creep += share / w.speed[k]
    if held == 0.0:
        return 0.0
    part = min(abs(couple) / (_TORQUE * p.slider_radius * held), _MOST)
    rate = relative_spin(part) * held / (creep * p.slider_radius)  # (2.6)
    return math.copysign(rate, couple)


@kernel
def spin_work(old: State, new: State) -> float:
    """Return the work that the interface passes on to the spin of the sliders in a step."""
    s, f, t, g = old.slip, old.interface_force, new.slip, new.interface_force
    couple = s[0] * f[1] - s[1] * f[0] + t[0] * g[1] - t[1] * g[0]
    return 0.5 * couple * (new.spin - old.spin)
