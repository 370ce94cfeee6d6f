"""Structures and motion of the benchmark: the same in both programs.

Members have no shear deformation, and the structure is damped by the stiffness of its members
alone: 2 per cent in its first mode on held bearings. So the structures are the same in both
programs, and nothing damps the isolation but friction.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from frames import GroundMotion, RayleighDamping, gravity, lumped_mass
from lir_element import CoulombFriction
from validation.claims.opensees_building import FAR, RATIO, first_period
from validation.claims.opensees_yielding_runs import bearing as yielding_bearing
from validation.claims.opensees_yielding_runs import hinged
from validation.measurements.opensees_cost import slender_frame
from validation.opensees.isolators import waves
from validation.scenes import EXAMPLE_MASS, EXAMPLE_RECORD, example_bearing

if TYPE_CHECKING:
    from frames import Frame
    from lir_element import LIRBearing

ANGLE = math.radians(30.0)  # of the record in plan
SCALE = 1.0  # of the record: the rims of the LIR-DCFP are met, none is overrun
STRONG = 4.0  # s, begin of the strong part
YIELDING_CAPACITY, YIELDING_FRICTION = 0.3, 0.1  # m and -, of bearings under a frame that yields
MADE_SCALE = 0.9  # of the synthetic motions, where there is no record


@dataclass(frozen=True)
class Structure:
    """One structure of the benchmark."""

    key: str
    """By which results are kept."""
    case: str
    """Letter of the case it belongs to."""
    bays: tuple[int, int]
    """Numbers of bays, 0 for a mass on one bearing."""
    storeys: int
    """Number of storeys."""
    yields: bool = False
    """Whether its members have plastic hinges."""

    @property
    def bearings(self) -> int:
        """Number of bearings."""
        return (self.bays[0] + 1) * (self.bays[1] + 1)

    @property
    def name(self) -> str:
        """What it is, in words."""
        if not self.storeys:
            return "a mass on one bearing"
        kind = "yielding, " if self.yields else ""
        return f"{kind}{self.storeys} storeys, {self.bearings} bearings"

    def bearing(self) -> LIRBearing:
        """Return the LIR-DCFP under every column, its load that of the structure at rest [N]."""
        device = example_bearing(friction=CoulombFriction(0.065))
        if self.yields:
            device = yielding_bearing(YIELDING_CAPACITY, YIELDING_FRICTION)
        return replace(device, design_load=float(gravity(self._on(device)).axial_forces.mean()))

    def frame(self, bearing: LIRBearing) -> Frame:
        """Return the structure on bearings, damped."""
        frame = self._on(bearing)
        if self.storeys and not self.yields:
            frame.set_damping(RayleighDamping(RATIO, (FAR, first_period(frame))))
        return frame

    def stiffness_damping(self, frame: Frame) -> float:
        """Return the factor of the members' stiffness in the damping [s]."""
        damped = self.storeys and not self.yields
        return RATIO * first_period(frame) / math.pi if damped else 0.0

    def _on(self, bearing: LIRBearing) -> Frame:
        if not self.storeys:
            return lumped_mass(bearing, EXAMPLE_MASS)
        if self.yields:
            return hinged(bearing)
        return slender_frame(self.bays, self.storeys, bearing)


STRUCTURES = {
    one.key: one
    for one in (
        Structure("a", "a", (0, 0), 0),
        Structure("b", "b", (2, 2), 3),
        *(Structure(f"c{(n + 1) ** 2}x{s}", "c", (n, n), s) for n in (3, 4, 5) for s in (6, 10)),
        *(Structure(f"d{(n + 1) ** 2}", "d", (n, n), 10) for n in (9, 15)),
        Structure("f", "f", (1, 1), 2, yields=True),
    )
}
"""All structures by key."""


def motion_of(duration: float) -> GroundMotion:
    """Return the motion: Newhall 1994 at 30 degrees in plan, else synthetic motions of such a size."""
    folder = os.environ.get("LIR_RECORDS")
    if folder and (Path(folder) / EXAMPLE_RECORD).is_file():
        record = GroundMotion.from_at2(x=Path(folder) / EXAMPLE_RECORD)
        return record.scaled(SCALE).rotated(ANGLE).trimmed(0.0, duration)
    return waves(MADE_SCALE, duration).scaled((1.0, 1.0, 0.0))


def strong(length: float) -> GroundMotion:
    """Return the strong part of the motion."""
    return motion_of(STRONG + length + 0.1).trimmed(STRONG, STRONG + length + 0.1)
