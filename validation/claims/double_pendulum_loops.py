"""Quasi-static loops of the plain bearing and of theories of the articulated slider."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from lir_element import CoulombFriction, LIRBearing, cyclic_test
from validation.articulated import articulated

if TYPE_CHECKING:
    from frames._types import FloatArray

LOAD = 500e3  # N
HEIGHT = 0.1  # m
STEP = 5e-4  # m, between the points of the path


@dataclass(frozen=True)
class Case:
    """A bearing and the amplitude of its cycle [m]."""

    name: str
    radii: tuple[float, float]
    frictions: tuple[float, float]
    amplitude: float
    rims: tuple[float, float] | None = None

    @property
    def bearing(self) -> LIRBearing:
        """The bearing, its rigid slider."""
        return LIRBearing(
            radius=self.radii,
            slider_height=HEIGHT,
            slider_radius=0.1,
            capacity=math.inf if self.rims is None else None,
            rims=self.rims,
            friction=(CoulombFriction(self.frictions[0]), CoulombFriction(self.frictions[1])),
            interface_friction=0.3,
            yield_displacement=0.02e-3,
            design_load=LOAD,
        ).as_dcfp()


CASES = (
    Case("equal surfaces", (1.0, 1.0), (0.06, 0.06), 0.15),
    Case("unequal frictions", (1.0, 1.0), (0.03, 0.09), 0.15),
    Case("unequal radii and frictions", (1.2, 0.8), (0.03, 0.09), 0.15),
    Case("the same, with rims at 120 mm", (1.2, 0.8), (0.03, 0.09), 0.20, (0.12, 0.12)),
)


@dataclass(frozen=True)
class Loops:
    """Forces over the load along one path: of the element, and of both articulated theories."""

    case: Case
    path: FloatArray
    element: FloatArray
    hinged: FloatArray
    moments: FloatArray
    turn: float

    @property
    def first(self) -> slice:
        """The first way out, without the elastic begin and the turn."""
        return slice(round(0.005 / STEP), round(self.case.amplitude / STEP))

    def at(self, force: FloatArray, displacement: float) -> float:
        """Return a force on the first way out, at a displacement [m]."""
        count = round(self.case.amplitude / STEP) + 1
        return float(np.interp(displacement, self.path[:count], force[:count]))

    def energy(self, force: FloatArray) -> float:
        """Return the energy of the full cycle over the load [m]."""
        begin = round(self.case.amplitude / STEP)
        return float(np.trapezoid(force[begin:], self.path[begin:]))


def loops(case: Case) -> Loops:
    """Run a case: out to the amplitude and one full cycle."""
    turns = [0.0, case.amplitude, -case.amplitude, case.amplitude]
    pieces = [np.linspace(a, b, round(abs(b - a) / STEP) + 1)[1:] for a, b in pairwise(turns)]
    path = np.concatenate([[0.0], *pieces])
    data = cyclic_test(case.bearing, path, LOAD, on_failure="raise")
    force = data["bearing_force"].sel(axis="x")[:, 0].to_numpy() / LOAD
    sliding = data["slider_displacement"].sel(axis="x")[:, 0].to_numpy()
    shares = sliding[1:] / np.array(case.radii)
    turn = float(np.abs(shares[:, 0] - shares[:, 1]).max() / np.abs(shares).max())
    hinged, moments = (articulated(case.bearing, moments=m).force(path) for m in (False, True))
    return Loops(case, path, force, hinged, moments, turn)
