"""Kernels of Newmark's rule: effective mass, damping and stiffness of a step, and rates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm

if TYPE_CHECKING:
    from frames.bundles.run_data import IntegratorSettings


@inlined_by_llvm
def effective(settings: IntegratorSettings, dt: float) -> tuple[float, float, float]:
    """Return the factors of mass, damping and stiffness in the effective stiffness of a step."""
    c_m = (1.0 - settings.alpha_m) / (settings.beta * dt * dt)
    c_c = (1.0 - settings.alpha_f) * settings.gamma / (settings.beta * dt)
    return c_m, c_c, 1.0 - settings.alpha_f


@inlined_by_llvm
def rates_after(
    change: float, v: float, a: float, dt: float, beta: float, gamma: float
) -> tuple[float, float]:
    """Return velocity and acceleration after a step, from the change and the rates before it."""
    after = (change / dt - v) / (beta * dt) - (0.5 / beta - 1.0) * a
    return v + dt * ((1.0 - gamma) * a + gamma * after), after
