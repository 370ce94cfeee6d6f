"""Kernels of the level 'pendulum': the axial force, and its forms with features left out.

Three laws (docs/theory.md, sections 3 and 9):

- the contact opens: ``N = k_v (l - L) + c_v dl/dt``, never below zero;
- uplift left out (``bilateral``): the same, also in tension. In tension both surfaces carry
  nothing, the interface holds its slip, and the bearing pulls along the line of its centres;
- vertical coupling left out (``fixed_load`` W > 0): the string keeps its length, the height of the
  top plate follows from it, and N from ``g_3 = -W``: a pendulum under a constant vertical load.
  Vertical motion has a spring and a damper of its own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.friction_law import left_by_pressure
from lir_element.kernels.slip import kelvin_voigt, kept_share

if TYPE_CHECKING:
    from lir_element.layout import Props, State, Work


@kernel
def fix_length(p: Props, w: Work) -> None:
    """Keep the true height of the line of centres; set the one that the string's length gives."""
    w.height = w.c[2]
    w.fixed_length = 0.0
    if p.fixed_load > 0.0:
        w.fixed_length = p.length + p.fixed_load / p.axial_stiffness
        rest = w.fixed_length**2 - w.c[0] ** 2 - w.c[1] ** 2
        w.c[2] = -math.sqrt(rest) if rest > 0.0 else 0.0


@inlined_by_llvm
def axial(p: Props, old: State, w: Work) -> None:
    """Set the axial force of the string and its floor (below it all forces fade equally).

    Sets also the share of friction's z that its change leaves: all of it under a fixed load, and in
    a static step, so that the history of permanent loads has no effect.
    """
    gap = (w.l if w.fixed_length == 0.0 else -w.height) - p.length
    if p.bilateral:
        force, slope = p.axial_stiffness * gap, p.axial_stiffness
        if w.dt > 0.0:
            force += p.axial_damping * (gap - old.closure) / w.dt
            slope += p.axial_damping / w.dt
        w.closure = gap
    else:
        force, slope, w.closure = kelvin_voigt(
            gap, old.closure, p.axial_stiffness, p.axial_damping, w.dt
        )
    w.vertical, w.stiff_vertical = 0.0, 0.0
    w.kept, w.kept_n, w.softer = 1.0, 0.0, 1.0
    w.kept_low, w.kept_low_n, w.softer_low = 1.0, 0.0, 1.0
    if w.fixed_length > 0.0:  # the string's own force follows: hold_load
        w.vertical, w.stiff_vertical = force, slope
        w.pressed, w.pressed_n = left_by_pressure(p, p.fixed_load), 0.0
        return
    w.n_true, w.stiff_n, w.n_pos = force, slope, max(force, 0.0)
    if w.n_pos > p.axial_floor:
        w.n_hat, w.scale = w.n_pos, 1.0
    else:
        w.n_hat, w.scale = p.axial_floor, w.n_pos / p.axial_floor
    if w.dt > 0.0:
        w.kept, w.kept_n = kept_share(old.axial_force, w.n_pos, p.axial_floor)
        w.softer = 2.0 / (1.0 + w.kept)
        w.kept_low, w.kept_low_n, w.softer_low = w.kept, w.kept_n, w.softer
    if w.varies != 0.0:
        press_surfaces(p, old, w)


@inlined_by_llvm
def rubs_by(p: Props, force: float) -> tuple[float, float]:
    """Return the interface's friction load (3.14) over its axial force, and its own share.

    With a fixed load it is a share of that. If all forces fade, the preload does, too.
    """
    by = p.fixed_load if p.fixed_load > 0.0 else max(force, p.axial_floor)
    return 1.0 + p.interface_preload / by, by + p.interface_preload


@kernel
def press_surfaces(p: Props, old: State, w: Work) -> None:
    """Set the share of the surfaces' friction that the pressure leaves, and that of their z.

    A cycle of the axial force makes no energy if z is proportional to ``(mu N)^(-1/2)``.
    """
    w.pressed, w.pressed_n = left_by_pressure(p, w.n_pos), p.pressure_rate
    if w.dt > 0.0:
        more = math.exp(0.5 * p.pressure_rate * (w.n_pos - max(old.axial_force, 0.0)))  # (11.2)
        w.kept_low = more * w.kept
        w.kept_low_n = more * (w.kept_n + 0.5 * p.pressure_rate * w.kept)
        w.softer_low = 2.0 / (1.0 + w.kept_low)


@kernel
def hold_load(p: Props, w: Work) -> None:
    """Set the axial force under which the vertical part of the string's force is the fixed load."""
    n = w.n
    if p.fused:
        load = p.fixed_load + (n[0] * w.push[0] + n[1] * w.push[1]) / w.l
        share = n[2] + (n[0] * w.drag[0] + n[1] * w.drag[1]) / w.l
    else:
        load = p.fixed_load
        share = n[2] + n[0] * w.phi_s[0] + n[1] * w.phi_s[1]
    w.n_true = load / share  # (9.3)
    w.n_pos, w.n_hat, w.scale, w.stiff_n = w.n_true, w.n_true, 1.0, 0.0


@kernel
def held_rate(w: Work, e_1: float, e_2: float, d_s1: float, d_s2: float) -> float:
    """Return the derivative of `hold_load` for two sliders: by a turn eta and a change of slip."""
    x = w.t[0, 0] * e_1 + w.t[1, 0] * e_2  # turn of n, horizontal
    y = w.t[0, 1] * e_1 + w.t[1, 1] * e_2
    share = w.n[2] + w.n[0] * w.phi_s[0] + w.n[1] * w.phi_s[1]
    rate = x * w.phi_s[0] + y * w.phi_s[1] - (w.n[0] * e_1 + w.n[1] * e_2)
    rate += w.n[0] * (w.h_s[0, 0] * d_s1 + w.h_s[0, 1] * d_s2)
    rate += w.n[1] * (w.h_s[1, 0] * d_s1 + w.h_s[1, 1] * d_s2)
    return -w.n_true * rate / share


@kernel
def held_rate_fused(w: Work, e_1: float, e_2: float, r_1: float, r_2: float) -> float:
    """Return the same for a rigid slider; `r_1`, `r_2`: the residual's derivative at constant N."""
    x = w.t[0, 0] * e_1 + w.t[1, 0] * e_2
    y = w.t[0, 1] * e_1 + w.t[1, 1] * e_2
    share = w.n[2] + (w.n[0] * w.drag[0] + w.n[1] * w.drag[1]) / w.l
    rate = w.n_true * (w.n[0] * e_1 + w.n[1] * e_2) - (x * w.f_s[0] + y * w.f_s[1])
    return (rate + (w.n[0] * r_1 + w.n[1] * r_2) / w.l) / share


@kernel
def tension_rates(
    w: Work, e_1: float, e_2: float, spin: float, d_1: float, d_2: float, d_3: float
) -> tuple[float, float]:
    """Return the derivative of ``N s / l``, the interface's force while the bearing pulls.

    By a turn eta and a shift along the slider's own axes.
    """
    s_1, s_2 = w.sigma[0], w.sigma[1]
    d_s1, d_s2 = w.l * e_1 + spin * s_2 + d_1, w.l * e_2 - spin * s_1 + d_2
    by_l = (w.stiff_n - w.n_true / w.l) * (-s_1 * e_1 - s_2 * e_2 - d_3)
    return (by_l * s_1 + w.n_true * d_s1) / w.l, (by_l * s_2 + w.n_true * d_s2) / w.l
