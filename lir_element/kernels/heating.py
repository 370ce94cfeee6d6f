"""Kernels of friction that depends on pressure and temperature, and of what heats the contacts.

The temperature at the start of a step governs its friction; a commit takes it on. docs/theory.md,
section 11.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Props, State


_FADED = 1e-15  # K


@kernel
def left_by_heat(p: Props, temperature: float) -> float:
    """Return the share of friction that is left at a temperature [C]."""
    if p.softens == 0:
        return 1.0
    left = p.softening_rest + math.exp(-p.softening_rate * temperature)
    return p.softening_scale * left  # (11.1)


@kernel
def left_by_pressure(p: Props, load: float) -> float:
    """Return the share of friction that is left under an axial force [N]."""
    if p.pressure_rate == 0.0:
        return 1.0
    return math.exp(-p.pressure_rate * (load - p.pressure_load))  # (11.1)


@kernel
def covered(before: float, after: float, radius: float) -> float:
    """Return the share of a step in which a slider covers the middle of what it slides on.

    `before` and `after` are its distances from there; between them they change evenly.
    """
    low, high = min(before, after), max(before, after)
    if high <= radius:
        return 1.0
    if low >= radius:
        return 0.0
    return (radius - low) / (high - low)


@kernel
def grown(part: float, lost: float, gain: float) -> float:
    """Return a part of a temperature after a step, none where it has faded (11.5).

    Numbers that fade on towards the smallest there are cost a processor a hundred times as much.
    """
    part += gain - lost * part
    return part if part > _FADED else 0.0


@kernel
def heat_up(p: Props, heat: Floats, old: State, new: State) -> None:
    """Take the temperatures on over the step from `old` to `new`, whose works are summed.

    `heat` (3, parts) holds what the contacts have above their temperature at the start, part by
    part: bottom surface, top surface, interface. What friction dissipates heats them evenly over
    the step.
    """
    dt = new.time - old.time
    if not dt > 0.0:
        return
    a = p.slider_radius
    per = 1.0 / (math.pi * a * a * dt)
    slip_old = math.sqrt(old.slip[0] ** 2 + old.slip[1] ** 2)
    slip = math.sqrt(new.slip[0] ** 2 + new.slip[1] ** 2)
    bottom = covered(old.eccentricity[0], new.eccentricity[0], a)
    bottom *= per * (new.work_friction[0] - old.work_friction[0])
    top = covered(old.eccentricity[1], new.eccentricity[1], a)
    top *= per * (new.work_friction[1] - old.work_friction[1])
    plane = covered(slip_old, slip, a) * per * (new.work_interface - old.work_interface)
    t_0, t_1, t_2 = p.heat_skin * bottom, p.heat_skin * top, p.heat_skin * plane
    for i in range(heat.shape[1]):
        rate = p.heat_rate[i]
        lost = -math.expm1(-rate * dt)
        gain = p.heat_gain[i] * (lost / rate if rate > 0.0 else dt)
        heat[0, i] = grown(heat[0, i], lost, gain * bottom)
        heat[1, i] = grown(heat[1, i], lost, gain * top)
        heat[2, i] = grown(heat[2, i], lost, gain * plane)
        t_0, t_1, t_2 = t_0 + heat[0, i], t_1 + heat[1, i], t_2 + heat[2, i]
    new.temperature[0] = p.initial_temperature + t_0
    new.temperature[1] = p.initial_temperature + t_1
    new.temperature[2] = p.initial_temperature + t_2
