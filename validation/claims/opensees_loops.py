"""Quasi-static loops of the plain bearing and of elements of OpenSees, against closed forms."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lir_element import CoulombFriction, LIRBearing, cyclic_test
from lir_element.opensees import builtin_element, builtin_values
from validation.opensees.runs import cycle
from validation.scenes import path_along, static_bearing

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames._types import FloatArray
    from lir_element.opensees.compare.builtin_writing import BuiltinKind

LOAD = 150e3  # N
AMPLITUDE = 0.17  # m, below the rims of the bearing of the static test
STEPS = 340  # on the way to the amplitude
NAMES = ("force at the amplitude", "strength", "stiffness", "energy a cycle")
UNITS = ("kN", "kN", "kN/m", "kJ")
SPAN = (0.12, 0.70)  # of the amplitude, between which the stiffness is taken

OURS = "bearing of this package"

LAWS: dict[str, Callable[[FloatArray, float], FloatArray]] = {
    OURS: lambda s, m: np.tan(np.arcsin(s) + math.atan(m)),
    "singleFPBearing": lambda s, m: (s + m) / (1.0 - s * (s + m)),
    "FPBearingPTV": lambda s, m: s / np.sqrt(1.0 - s**2) + m,
    "TripleFrictionPendulum": lambda s, m: s + m,
}
"""Lateral force over load while sliding outwards (m > 0) or back (m < 0), over s = U / L."""


@dataclass(frozen=True)
class Loop:
    """Displacements [m] and forces [N]: out to the amplitude and one full cycle."""

    path: FloatArray
    force: FloatArray

    def values(self) -> FloatArray:
        """Return force at the amplitude, strength, stiffness and energy (kN, m)."""
        begin = len(self.path) // 5
        u, f = self.path[begin:], 1e-3 * self.force[begin:]
        half = len(u) // 2
        back, out = (u[: half + 1][::-1], f[: half + 1][::-1]), (u[half:], f[half:])
        strength = 0.5 * (np.interp(0.0, *out) - np.interp(0.0, *back))
        low, high = (share * u[0] for share in SPAN)
        stiffness = (np.interp(high, *out) - np.interp(low, *out)) / (high - low)
        return np.array([f[0], strength, stiffness, np.trapezoid(f, u)])


def plain(scale: float = 1.0) -> LIRBearing:
    """Return the bearing of the static test, plain and without rims; friction times a factor."""
    bearing = static_bearing().as_dcfp(rims=False)
    mu = bearing.frictions[0].f_max
    return replace(
        bearing,
        friction=CoulombFriction(scale * mu),
        yield_displacement=scale * bearing.yield_displacement,
    )


def path_of(scale: float, finer: int = 1) -> FloatArray:
    """Return out to the amplitude times a factor, and one full cycle; `finer` divides its steps."""
    way = path_along([0.0, AMPLITUDE, -AMPLITUDE, AMPLITUDE], AMPLITUDE / (finer * STEPS))
    return scale * way


def here(scale: float = 1.0) -> Loop:
    """Run the loop with the bearing of this package."""
    path = path_of(scale)
    data = cyclic_test(plain(scale), path, LOAD, on_failure="raise")
    return Loop(path, data["bearing_force"].sel(axis="x")[:, 0].to_numpy())


def there(kind: BuiltinKind, scale: float = 1.0, *, factor: float = 1.0, finer: int = 1) -> Loop:
    """Run the loop in OpenSees, friction times `factor`, its steps divided by `finer`."""
    bearing, path = plain(scale), path_of(scale, finer)
    given = replace(bearing, friction=CoulombFriction(factor * bearing.frictions[0].f_max))

    def place(tag: int, i: int, j: int) -> None:
        builtin_element(kind, tag, i, j, given, LOAD)

    return Loop(path, cycle(place, bearing.height, LOAD, path).force[:, 0])


def closed_form(name: str, scale: float = 1.0) -> FloatArray:
    """Return the values of a loop by the law of an element; its energy less the elastic corners."""
    values, law = builtin_values(plain(scale), LOAD), LAWS[name]
    m, load, reach = values.friction_max, 1e-3 * LOAD, scale * AMPLITUDE
    u = np.linspace(-reach, reach, 4001)
    s = u / values.length
    out, back = load * law(s, m), load * law(s, -m)
    strength = 0.5 * (np.interp(0.0, u, out) - np.interp(0.0, u, back))
    low, high = (share * reach for share in SPAN)
    stiffness = (np.interp(high, u, out) - np.interp(low, u, out)) / (high - low)
    corners = 4.0 * strength * values.yield_displacement
    return np.array([out[-1], strength, stiffness, np.trapezoid(out - back, u) - corners])
