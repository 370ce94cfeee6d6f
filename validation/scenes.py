"""The test cases in which the levels are compared: bearing, mass and motion, each with what it is for.

Synthetic motions are pulses of a few cycles; recorded ones are read from the folder named by
LIR_RECORDS. Sources: the paper (COMPDYN 2023), sections 2.2 and 3.1, for the bearings.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, lumped_mass, moment_frame
from frames.demo import design, pacoima
from lir_element import CoulombFriction, LIRBearing, VelocityFriction

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames import Frame
    from lir_element.device.features import AnyLevel
    from lir_element.layout import Floats

LEVELS_STATIC: tuple[AnyLevel, ...] = ("pendulum", "contact", "rigid_body")
"""Levels of the static cyclic test."""

LEVELS_HISTORY: tuple[AnyLevel, ...] = ("rigid_body", "contact", "pendulum")
"""Levels of the numerical example."""

LEVELS_DRIFT: tuple[AnyLevel, ...] = ("pendulum", "rigid_body")
"""Levels at which the drift under Bouc-Wen friction is followed through the numerical example."""

EXAMPLE_MASS = 204e3
"""Mass on the bearing of the numerical example [kg] (section 3.1)."""

EXAMPLE_RECORD = "RSN1044_NORTHR_NWH360.AT2"
"""PEER file of the numerical example: Newhall, Northridge 1994, 360."""

MASS = EXAMPLE_MASS
REACH = 0.185
PULSE_STEP = 0.005
TCU065 = ("TCU065-E.ATH", "TCU065-N.ATH", "TCU065-V.ATH")


@dataclass(frozen=True)
class Scene:
    """A model under a motion.

    `uplift` says that the bearing lifts off, `explicit` how many seconds are also run with the
    explicit mode of the level 'rigid_body' (0: none).
    """

    name: str
    what: str
    bearing: LIRBearing
    motion: GroundMotion
    duration: float
    uplift: bool = False
    explicit: float = 0.0

    def model(self, bearing: LIRBearing | None = None) -> Frame:
        """Return the mass on this test case's bearing, or on another one."""
        return lumped_mass(bearing or self.bearing, MASS)


def pulse(t: Floats, peak: float, period: float, centre: float, cycles: float = 1.5) -> Floats:
    """Return a sine of `peak` [m/s2] and `period` [s] under a bell of `cycles` about `centre`."""
    s = np.clip((t - centre) / (0.5 * cycles * period), -1.0, 1.0)
    wave: Floats = peak * np.cos(0.5 * np.pi * s) ** 2 * np.sin(2.0 * np.pi * (t - centre) / period)
    return wave


def made(name: str, duration: float, **components: tuple[float, ...]) -> GroundMotion:
    """Return a motion of pulses: by axis peak, period, centre (and cycles)."""
    t = np.arange(0.0, duration + 1e-9, PULSE_STEP)
    waves = {axis: pulse(t, *values) for axis, values in components.items()}
    return GroundMotion(**waves, dt=PULSE_STEP, name=name)


def path_along(turns: Sequence[float], spacing: float) -> Floats:
    """Return a path (n,) from turn to turn, its points `spacing` apart [m]."""
    pieces = [np.linspace(a, b, round(abs(b - a) / spacing) + 1)[1:] for a, b in pairwise(turns)]
    return np.concatenate([turns[:1], *pieces])


def static_path(reach: float = REACH, spacing: float = 1e-4) -> Floats:
    """Return two cycles of `reach`, points `spacing` apart [m]."""
    return path_along([0.0, reach, -reach, reach, -reach, 0.0], spacing)


def records() -> Path | None:
    """Return the folder of recorded motions, None if there is none."""
    folder = os.environ.get("LIR_RECORDS")
    return Path(folder) if folder else None


def made_scenes() -> list[Scene]:
    """Return the test cases that need no record."""
    strong = (2.0, 1.7, 1.5)
    across = (1.7, 1.7, 1.75)
    slow = (7.0, 0.6, 1.7, 5.0)
    lift = (13.0, 0.35, 1.7, 6.0)
    return [
        Scene(
            "oblique rim contact",
            "two horizontal pulses out of phase: the slider meets its rims obliquely",
            example_bearing(),
            made("two pulses", 6.0, x=strong, y=across),
            6.0,
            explicit=3.0,
        ),
        Scene(
            "varying axial force",
            "two horizontal pulses, and a slow vertical one that changes the axial force",
            example_bearing(),
            made("three pulses", 6.0, x=(2.5, 1.7, 1.5), y=(2.0, 1.3, 1.9), z=slow),
            6.0,
        ),
        Scene(
            "unequal radii",
            "radii of 0.90 and 1.45 m, both rims met together",
            example_bearing(radius=(0.9, 1.45)),
            made("pulse", 6.0, x=(2.7, 1.7, 1.5)),
            6.0,
        ),
        Scene(
            "unequal rims",
            "the same radii, the bottom rim met at 0.111 and the top one at 0.117 of its radius",
            example_bearing(radius=(0.9, 1.45), capacity=None, rims=(0.10, 0.17)),
            made("two pulses", 6.0, x=(2.4, 1.7, 1.5), y=(1.5, 1.3, 1.9)),
            6.0,
        ),
        Scene(
            "uplift and landing",
            "a vertical pulse of 1.3 g lifts the mass several times",
            example_bearing(),
            made("lifting pulses", 6.0, x=(2.3, 1.7, 1.5), y=(1.8, 1.3, 1.9), z=lift),
            6.0,
            uplift=True,
            explicit=3.0,
        ),
    ]


def tcu065(folder: Path) -> GroundMotion | None:
    """Return the three components of TCU065; None if the folder does not have them."""
    x, y, z = paths = [folder / name for name in TCU065]
    if not all(path.is_file() for path in paths):
        return None
    return GroundMotion.from_columns(x=x, y=y, z=z, dt=0.005, unit="g", name="TCU065")


def recorded_scenes(folder: Path | None) -> list[Scene]:
    """Return the test cases of recorded motions that the folder holds."""
    scenes: list[Scene] = []
    if folder is None:
        return scenes
    if (folder / EXAMPLE_RECORD).is_file():
        scenes.append(
            Scene(
                "Newhall",
                "the paper's example, one component of the record of 1994",
                example_bearing(),
                GroundMotion.from_at2(x=folder / EXAMPLE_RECORD),
                20.0,
                explicit=6.0,
            )
        )
    motion = tcu065(folder)
    if motion is not None:
        motion = motion.trimmed(5.0, 25.0)
        scenes.append(
            Scene(
                "three components",
                "Chi-Chi 1999, TCU065 times 0.62, its vertical component times 2.4",
                example_bearing(),
                motion.scaled((0.62, 0.62, 2.4)),
                20.0,
            )
        )
    return scenes


def building(duration: float = 7.0) -> tuple[Frame, GroundMotion, float] | None:
    """Return the demonstration's frame, motion and duration; None where its record is missing."""
    try:
        motion = pacoima(0.8)
    except FileNotFoundError:
        return None
    return moment_frame(bearing=design()), motion, duration


def static_bearing() -> LIRBearing:
    """Return the bearing of the static cyclic test (section 2.2); slider radius assumed."""
    return LIRBearing(
        radius=0.75,
        slider_height=0.085,
        slider_radius=0.08,
        capacity=0.175,
        friction=CoulombFriction(0.066),
        interface_friction=0.126,
    )


def example_bearing(**changes: Any) -> LIRBearing:
    """Return the bearing of the numerical example (section 3.1); slider radius assumed."""
    options: dict[str, Any] = {
        "radius": 1.185,
        "slider_height": 0.12,
        "slider_radius": 0.15,
        "capacity": 0.25,
        "friction": VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
        "interface_friction": 0.13,
    }
    return LIRBearing(**{**options, **changes})
