"""Motions that a reviewer asks for: turned, with a vertical component, one after another, pulses.

All are of an intensity of 1 (Sa of 3 s, 5 %, in m/s2), so that the factors on them are intensities.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import GroundMotion, MotionWarning
from frames.demo import bearing_for, pacoima
from frames.design.hazard.stochastic_motion import NearFaultPulse
from frames.risk import Intensity
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR, TAIL, records_in
from validation.study.paired import WEAK
from validation.study.records_runs import INTENSITY, normalised

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

ANGLES = (0, 30, 60)
"""By which records are turned [degrees]: the building is its own image after a quarter turn."""

ANGLE_SCALES = (2.6, 3.3)
"""Intensities of records that are turned [m/s2]: of `SCALES`, those around collapse."""

MAIN_SCALES = (2.0, 2.6)
"""Intensities of mainshocks [m/s2]."""

TRIED = (LIR, WEAK)
"""Devices of this part."""


class After(NamedTuple):
    """A second shock: the same record as the first, or the next of the set, and its share."""

    other: bool
    share: float

    @property
    def name(self) -> str:
        """How the page calls it."""
        return f"{self.share:g} of {'another record' if self.other else 'the same record'}"


SECONDS = (After(False, 0.5), After(False, 0.8), After(False, 1.0), After(True, 1.0))

LARGEST_FACTOR = 5.0
"""On records with a vertical component, at `FACTOR_AT`: more is another earthquake."""

FACTOR_AT = 2.0
VERTICAL_SCALES = (2.0, 2.6, 3.3)
"""Intensities of records with a vertical component [m/s2]."""

PERIOD_RATIOS = (0.5, 0.65, 0.8, 1.0, 1.25, 1.6, 2.0)
"""Periods of pulses over that of the bearings [-]."""

PHASES = {"symmetric": 0.0, "antisymmetric": 0.5 * math.pi}
"""Velocities of pulses about their middles, and their phases [rad]."""

GAMMA = 2.0
PULSE_STEP = 1.12
PULSE_SCALES = tuple(round(1.2 * PULSE_STEP**k, 4) for k in range(15))
"""Intensities of pulses [m/s2]: each is larger by 12 % than the one before."""

ALONG_X = Intensity(kind="Sa", period=INTENSITY.period, measure="x")
SAMPLING = 0.01
"""Of pulses [s]."""


def isolated_period() -> float:
    """Return the period of the bearings while they slide [s]."""
    return 2.0 * math.pi * math.sqrt(bearing_for(1000e3).effective_radius / STANDARD_GRAVITY)


def turned(motions: Mapping[str, GroundMotion], angle: float) -> dict[str, GroundMotion]:
    """Return motions turned about the vertical [degrees]; 0 are the motions themselves."""
    if angle == 0:
        return dict(motions)
    return {name: motion.rotated(math.radians(angle)) for name, motion in motions.items()}


def followed(motions: Mapping[str, GroundMotion], after: After) -> dict[str, GroundMotion]:
    """Return each motion with a second shock behind it; motions have their time of rest behind."""
    names = list(motions)
    seconds = names[1:] + names[:1] if after.other else names
    return {
        first: _joined(motions[first], motions[second].scaled(after.share))
        for first, second in zip(names, seconds, strict=True)
    }


def _joined(first: GroundMotion, second: GroundMotion) -> GroundMotion:
    # One after the other at the finer of both steps; linear between samples, as the runs take it.
    dt = min(first.dt, second.dt)
    both = [each if each.dt == dt else each.resampled(dt) for each in (first, second)]
    parts = {axis: np.concatenate([_component(each, axis) for each in both]) for axis in ("x", "y")}
    with warnings.catch_warnings(action="ignore", category=MotionWarning):
        return GroundMotion(**parts, dt=dt, name=f"{first.name}, and again")


def _component(motion: GroundMotion, axis: str) -> Any:
    values = getattr(motion, axis)
    return np.zeros(motion.n_steps) if values is None else values


def three_components(folder: Path) -> dict[str, GroundMotion]:
    """Return records with a vertical component whose factors stay small, normalised."""
    with warnings.catch_warnings(action="ignore", category=MotionWarning):
        found = {
            "Pacoima Dam 1971": pacoima(),
            "Chi-Chi TCU065 1999": records_in(folder)["Chi-Chi TCU065 1999"](),
        }
        for file in sorted((folder / "landers").glob("*.bbp")):
            name = f"Landers 1992, {file.stem}"
            found[name] = GroundMotion.from_columns(
                file, time=0, x=2, y=1, z=3, unit="cm/s2", name=name
            )
    kept = {
        name: motion
        for name, motion in found.items()
        if FACTOR_AT / INTENSITY.of(motion) <= LARGEST_FACTOR
    }
    return normalised(kept)


def without_vertical(motions: Mapping[str, GroundMotion]) -> dict[str, GroundMotion]:
    """Return motions without their vertical components."""
    return {name: motion.scaled([1.0, 1.0, 0.0]) for name, motion in motions.items()}


def vertical_over_horizontal(motion: GroundMotion) -> float:
    """Return the peak of the vertical acceleration over the mean of the horizontal ones [-]."""
    peak = motion.peak
    return float(peak["z"] / math.sqrt(peak["x"] * peak["y"]))


@dataclass(frozen=True)
class Pulse:
    """A pulse along x: its period over that of the bearings, and its phase."""

    ratio: float
    kind: str

    @property
    def name(self) -> str:
        """How its motion is called."""
        return f"{self.kind}, {self.ratio:g}"

    def motion(self, velocity: float = 1.0) -> GroundMotion:
        """Return its motion of an amplitude of velocity [m/s], without time of rest behind."""
        pulse = NearFaultPulse(
            velocity=velocity,
            period=self.ratio * isolated_period(),
            gamma=GAMMA,
            phase=PHASES[self.kind],
        )
        times = np.arange(0.0, pulse.duration + 0.5 * SAMPLING, SAMPLING)
        with warnings.catch_warnings(action="ignore", category=MotionWarning):
            return GroundMotion(x=pulse.accelerations(times), dt=SAMPLING, name=self.name)


PULSES = tuple(Pulse(ratio, kind) for kind in PHASES for ratio in PERIOD_RATIOS)


def pulses() -> dict[str, GroundMotion]:
    """Return the pulses, of an Sa of 1 m/s2 along x, with time to come to rest behind."""
    found = {}
    for each in PULSES:
        motion = each.motion()
        found[each.name] = motion.scaled(1.0 / ALONG_X.of(motion)).with_tail(TAIL)
    return found


def velocities() -> dict[str, float]:
    """Return the amplitude of velocity [m/s] of each pulse of an intensity of 1 m/s2."""
    return {each.name: 1.0 / ALONG_X.of(each.motion()) for each in PULSES}
