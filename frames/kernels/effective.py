"""Kernel of what a step of the time integration makes of mass, damping and stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined

if TYPE_CHECKING:
    from frames.kernel_data import Setup


@inlined
def effective(settings: Setup, dt: float) -> tuple[float, float, float]:
    """Return the factors of mass, damping and stiffness in the effective stiffness of a step."""
    c_m = (1.0 - settings.alpha_m) / (settings.beta * dt * dt)
    c_c = (1.0 - settings.alpha_f) * settings.gamma / (settings.beta * dt)
    return c_m, c_c, 1.0 - settings.alpha_f
