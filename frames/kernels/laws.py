"""Kernels of the laws of one deformation: force and its derivative from deformation and speed.

`par` has the constants as `frames.assembly.nonlinear` writes them, `old` and `new` the state. All
return the force and its derivative by the deformation at the end of the step; `rate` is the
derivative of the speed by the deformation in the time integration.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import kernel
from frames.assembly.system import BILINEAR, BOUC_WEN, MAXWELL, STOP, TIE, VISCOUS

if TYPE_CHECKING:
    from lir_element.layout import Floats

_FINEST = (
    0.1  # of the yield deformation: substep of the Bouc-Wen law (4th order: 1e-5 of its force)
)
_PINCHED = 0.3  # of the spread of pinching: substep there
_SDIRK = 1.0 - math.sqrt(0.5)  # Alexander (1977): two stages, second order, L-stable
_MOST = 60  # iterations of a scalar solution


@kernel
def bilinear(par: Floats, old: Floats, new: Floats, d: float) -> tuple[float, float]:
    """Return force and slope of linear kinematic hardening; par: k, yield force, modulus."""
    k, limit, modulus = par[0], par[1], par[2]
    force = k * (d - old[0])
    over = abs(force - modulus * old[0]) - limit
    new[0] = old[0]
    if over <= 0.0:
        return force, k
    change = over / (k + modulus)
    new[0] += math.copysign(change, force - modulus * old[0])
    return k * (d - new[0]), k * modulus / (k + modulus)


@kernel
def bouc_wen_rate(par: Floats, z: float, energy: float, sense: float) -> float:
    """Return dz over the deformation in yield deformations, for a `sense` of motion."""
    size = abs(z) ** par[2]
    weak = 1.0 + par[4] * energy
    bent = par[3] if z * sense >= 0.0 else -par[3]
    rate = (1.0 - weak * size * (bent + 1.0 - par[3])) / (1.0 + par[5] * energy)
    if par[7] > 0.0:  # pinching
        depth = par[7] * (1.0 - math.exp(-par[8] * energy))
        spread = (par[10] + par[11] * energy) * (par[12] + depth)
        top = weak ** (-1.0 / par[2])
        place = (z * sense - par[9] * top) / spread
        rate *= 1.0 - depth * math.exp(-place * place)
    return rate


@kernel
def bouc_wen(par: Floats, old: Floats, new: Floats, d_old: float, d: float) -> tuple[float, float]:
    """Return force and slope of Bouc-Wen hysteresis by Runge-Kutta steps; state: z, energy.

    par: k, r, n, beta, strength loss, stiffness loss, yield deformation, then the pinching. The
    solution is a curve over d, so that its slope at the end is the derivative by d.
    """
    k, r, scale = par[0], par[1], par[6]
    z, energy = old[0], old[1]
    way = (d - d_old) / scale
    sense = math.copysign(1.0, way) if way != 0.0 else math.copysign(1.0, -z)
    finest = min(_FINEST, 0.5 / par[2])
    if par[7] > 0.0:
        depth = par[7] * (1.0 - math.exp(-par[8] * energy))
        finest = min(finest, _PINCHED * (par[10] + par[11] * energy) * (par[12] + depth))
    pieces = int(min(math.ceil(abs(way) / finest), 1e5))
    for _ in range(pieces):
        h = way / pieces
        k_1 = bouc_wen_rate(par, z, energy, sense)
        z_2 = z + 0.5 * h * k_1
        k_2 = bouc_wen_rate(par, z_2, energy + 0.5 * h * z, sense)
        z_3 = z + 0.5 * h * k_2
        k_3 = bouc_wen_rate(par, z_3, energy + 0.5 * h * z_2, sense)
        z_4 = z + h * k_3
        k_4 = bouc_wen_rate(par, z_4, energy + h * z_3, sense)
        energy += h * (z + 2.0 * z_2 + 2.0 * z_3 + z_4) / 6.0
        z += h * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4) / 6.0
    new[0], new[1] = z, energy
    slope = bouc_wen_rate(par, z, energy, sense)
    return k * (r * d + (1.0 - r) * scale * z), k * (r + (1.0 - r) * slope)


@kernel
def tie(par: Floats, old: Floats, new: Floats, d: float) -> tuple[float, float]:
    """Return force and slope of a slack tension member; par: k, yield force, modulus, slack."""
    k, limit, modulus = par[0], par[1], par[2]
    new[0] = old[0]
    force = k * (d - par[3] - old[0])
    if force <= 0.0:
        return 0.0, 0.0
    over = force - limit - modulus * old[0]
    if over <= 0.0:
        return force, k
    new[0] += over / (k + modulus)
    return k * (d - par[3] - new[0]), k * modulus / (k + modulus)


@kernel
def viscous(par: Floats, v: float, rate: float) -> tuple[float, float]:
    """Return force and slope of a dashpot c |v|^a, smooth about zero; par: c, a, smoothing."""
    c, exponent = par[0], par[1]
    if exponent == 1.0:
        return c * v, c * rate
    square = v * v + par[2] * par[2]
    size = c * square ** (0.5 * (exponent - 1.0))
    return size * v, size * (1.0 + (exponent - 1.0) * v * v / square) * rate


@kernel
def flow(par: Floats, force: float) -> tuple[float, float]:
    """Return the speed of that dashpot under a force, and its derivative."""
    c, exponent = par[0], par[1]
    if exponent == 1.0:
        return force / c, 1.0 / c
    soft = par[2]
    size = abs(force)
    low, high = 0.0, max((size / c) ** (1.0 / exponent), size / (c * soft ** (exponent - 1.0)))
    v = high
    for _ in range(_MOST):
        found, slope = viscous(par, v, 1.0)
        if found > size:
            high = v
        else:
            low = v
        step = (size - found) / slope
        v += step
        if not low <= v <= high:
            v = 0.5 * (low + high)
        if abs(step) <= 1e-14 * (v + soft):
            break
    _, slope = viscous(par, v, 1.0)
    return math.copysign(v, force), 1.0 / slope


@kernel
def maxwell_stage(par: Floats, start: float, h: float) -> tuple[float, float, float]:
    """Solve ``f = start - h k flow(f)``; returns f, and flow(f) with its derivative."""
    stiff = h * par[3]
    low, high = min(start, 0.0), max(start, 0.0)
    f = start
    for _ in range(_MOST):
        speed, slope = flow(par, f)
        gap = f + stiff * speed - start
        if gap > 0.0:
            high = f
        else:
            low = f
        step = -gap / (1.0 + stiff * slope)
        f += step
        if not low <= f <= high:
            f = 0.5 * (low + high)
        if abs(step) <= 1e-13 * (abs(start) + abs(f)):
            break
    speed, slope = flow(par, f)
    return f, speed, slope


@kernel
def maxwell(
    par: Floats, old: Floats, new: Floats, stretch: float, dt: float
) -> tuple[float, float]:
    """Return force and slope of dashpot and spring in series, at even speed; state: force.

    par: c, exponent, speed of the smooth part, k. ``f' = k (v - flow(f))`` by a two-stage implicit
    Runge-Kutta method.
    """
    share, k = _SDIRK, par[3]
    stiff = share * dt * k
    _, speed_1, flow_1 = maxwell_stage(par, old[0] + share * k * stretch, share * dt)
    rate_1 = k * stretch / dt - k * speed_1
    d_rate_1 = k / dt - k * flow_1 * (1.0 / (1.0 + stiff * flow_1)) * share * k
    start = old[0] + (1.0 - share) * dt * rate_1 + share * k * stretch
    f_2, _, flow_2 = maxwell_stage(par, start, share * dt)
    new[0] = f_2
    return f_2, (1.0 / (1.0 + stiff * flow_2)) * ((1.0 - share) * dt * d_rate_1 + share * k)


@kernel
def stop(par: Floats, d: float, v: float, rate: float) -> tuple[float, float]:
    """Return force and slope of a Kelvin-Voigt wall; par: gap, k, c, depth of full damping."""
    x = d - par[0]
    if x <= 0.0:
        return 0.0, 0.0
    share, more = 1.0, 0.0
    if x < par[3]:
        share, more = x / par[3], 1.0 / par[3]
    force = par[1] * x + par[2] * share * v
    if force <= 0.0:
        return 0.0, 0.0
    return force, par[1] + par[2] * (share * rate + more * v)


@kernel
def hertz(
    par: Floats, old: Floats, new: Floats, d: float, v_old: float, v: float, rate: float
) -> tuple[float, float]:
    """Return force and slope of a Hertz contact; par: gap, k, n, damping; state: speed."""
    x = d - par[0]
    new[0] = old[0]
    if x <= 0.0:
        new[0] = 0.0
        return 0.0, 0.0
    if old[0] <= 0.0:
        new[0] = max(v_old, 1e-6)
    size = par[1] * x ** par[2]
    damp = 1.0 + par[3] * v / new[0]
    if damp <= 0.0:
        return 0.0, 0.0
    return size * damp, size * (par[2] / x * damp + par[3] * rate / new[0])


@kernel
def uniaxial(
    kind: int,
    par: Floats,
    old: Floats,
    new: Floats,
    d_old: float,
    d: float,
    v_old: float,
    v: float,
    rate: float,
    dt: float,
) -> tuple[float, float]:
    """Return force and derivative of a law of one deformation, by its kind."""
    for k in range(old.shape[0]):
        new[k] = old[k]
    if kind == BILINEAR:
        return bilinear(par, old, new, d)
    if kind == BOUC_WEN:
        return bouc_wen(par, old, new, d_old, d)
    if kind == TIE:
        return tie(par, old, new, d)
    if kind == VISCOUS:
        return viscous(par, v, rate)
    if kind == MAXWELL:
        return maxwell(par, old, new, d - d_old, dt)
    if kind == STOP:
        return stop(par, d, v, rate)
    return hertz(par, old, new, d, v_old, v, rate)
