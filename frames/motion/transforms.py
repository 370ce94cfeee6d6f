"""Operations on a ground motion: from components by axis [m/s2] to new ones."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import MotionError
from frames.motion.records import AXES, checked_step
from lir_element.argument_checks import require_finite
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames._types import FloatArray

Given = Mapping[str, "FloatArray"]
Changed = dict[str, "FloatArray"]

LONGEST_TAIL = 1e5
"""Zeros that a motion can have after it [s]."""


def scaled(given: Given, factor: float | Sequence[float]) -> Changed:
    """Return components times one factor, or times one for each of x, y and z."""
    factors = [factor] * 3 if np.ndim(factor) == 0 else list(np.ravel(factor))
    if len(factors) != 3:
        msg = f"factor has {len(factors)} entries: pass one number, or three for x, y and z"
        raise MotionError(msg)
    sizes = [
        require_finite("factor", value, remedy="give a pure number", error=MotionError)
        for value in factors
    ]
    return {axis: sizes[AXES.index(axis)] * values for axis, values in given.items()}


def rotated(given: Given, angle: float) -> Changed:
    """Return components turned about z by an angle [rad], from x towards y."""
    turn = require_finite("angle", angle, "rad", error=MotionError)
    cos, sin = math.cos(turn), math.sin(turn)
    nothing = np.zeros(len(next(iter(given.values()))))
    east, north = (given.get(axis, nothing) for axis in ("x", "y"))
    return {**given, "x": cos * east - sin * north, "y": sin * east + cos * north}


def trimmed(given: Given, dt: float, start: float, end: float | None) -> Changed:
    """Return the samples from `start` to `end` [s]; None for the last one."""
    count = len(next(iter(given.values())))
    duration = (count - 1) * dt
    first = require_finite("start", start, "s", error=MotionError)
    last = duration if end is None else require_finite("end", end, "s", error=MotionError)
    near = 1e-6 * dt  # a time that is a multiple of dt up to round-off counts as one
    time = np.arange(count) * dt
    keep = (time >= first - near) & (time <= last + near)
    if np.count_nonzero(keep) < 2:
        msg = (
            f"start = {first:g} s, end = {last:g} s leave fewer than 2 samples: use times "
            f"between 0 and {duration:g} s, at least {dt:g} s apart"
        )
        raise MotionError(msg)
    return {axis: values[keep] for axis, values in given.items()}


def resampled(given: Given, dt: float, new: float) -> tuple[Changed, float]:
    """Return components at another time step [s] by linear interpolation, and that step."""
    count = len(next(iter(given.values())))
    duration = (count - 1) * dt
    step = require_finite("dt", new, "s", error=MotionError)
    if not 0.0 < step <= duration:
        msg = f"dt = {step:g} s must be greater than 0 and at most {duration:g} s, the duration"
        raise MotionError(msg)
    checked_step(step)
    time = np.arange(math.floor(duration / step + 1e-6) + 1) * step
    before = np.arange(count) * dt
    return {axis: np.interp(time, before, values) for axis, values in given.items()}, step


def with_tail(given: Given, dt: float, seconds: float) -> Changed:
    """Return components with zeros after them, `seconds` rounded up to whole steps."""
    length = require_finite("seconds", seconds, "s", error=MotionError)
    if length < 0.0:
        msg = f"seconds = {length:g} must be at least 0: use trimmed to shorten a motion"
        raise MotionError(msg)
    if length > LONGEST_TAIL:
        msg = f"seconds = {length:g} must be at most {LONGEST_TAIL:g}: give the tail in s"
        raise MotionError(msg)
    tail = (0, math.ceil(length / dt - 1e-6))
    return {axis: np.pad(values, tail) for axis, values in given.items()}


def baseline_corrected(given: Given, dt: float, *, displacement: bool) -> tuple[Changed, float]:
    """Return components whose baseline is corrected, and the largest change of a peak [-]."""
    arrays, largest = {}, 0.0
    for axis, values in given.items():
        arrays[axis] = corrected(values, dt, displacement=displacement)
        before, after = float(np.abs(values).max()), float(np.abs(arrays[axis]).max())
        change = after / before - 1.0 if before > 0.0 else 0.0
        if abs(change) > LARGEST_CHANGE:
            left = drift_of(values, dt)
            msg = (
                f"the correction would change the peak of {axis} by {change:.1%} (at most "
                f"{LARGEST_CHANGE:.0%}): the final velocity of {left.velocity:.3g} m/s and "
                f"displacement of {left.displacement:.3g} m are too large. Use the whole record, "
                "or corrected(displacement=False)"
            )
            raise MotionError(msg)
        largest = max(largest, abs(change))
    return arrays, largest


LARGEST_DRIFT = 0.15
"""Velocity at the end over the peak velocity above which a record is called not at rest [-]."""

LEAST_RECORD = 8.0
"""Duration from which a motion is a record, not a pulse, and its end is looked at [s]."""

LAST_PART, QUIET, STEADY = 0.2, 0.3, 0.1
"""Share of the samples at the end that decide if a motion has faded [-], and the limits of their
mean and their scatter, over the peak acceleration [-]. A motion that ends at full strength was cut,
or made so: its velocity at that point is no evidence of a baseline.
"""

LARGEST_CHANGE = 0.05
"""Change of a peak acceleration by a correction above which it is refused [-]."""


class Drift(NamedTuple):
    """Residual motion of one component at its end.

    Attributes
    ----------
    velocity, displacement : float
        Velocity [m/s] and displacement [m] of the ground at the last sample.
    peak_velocity, peak_displacement : float
        Largest ones [m/s], [m].
    """

    velocity: float
    displacement: float
    peak_velocity: float
    peak_displacement: float

    @property
    def share(self) -> float:
        """Velocity at the end over the peak velocity [-]."""
        return abs(self.velocity) / self.peak_velocity if self.peak_velocity > 0.0 else 0.0


def integrated(acceleration: FloatArray, dt: float) -> tuple[FloatArray, FloatArray]:
    """Return velocity and displacement (n,) of an acceleration that is linear between samples.

    Shapes: acceleration (n,).
    """
    first, last = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * dt * (first + last))])
    moved = dt * velocity[:-1] + dt**2 * (first / 3.0 + last / 6.0)
    return velocity, np.concatenate([[0.0], np.cumsum(moved)])


def drift_of(acceleration: FloatArray, dt: float) -> Drift:
    """Return the residual motion of one component (n,) [m/s2] at its end."""
    velocity, displacement = integrated(acceleration, dt)
    return Drift(
        velocity=float(velocity[-1]),
        displacement=float(displacement[-1]),
        peak_velocity=float(np.abs(velocity).max()),
        peak_displacement=float(np.abs(displacement).max()),
    )


def has_faded(acceleration: FloatArray) -> bool:
    """Return whether a component (n,) is quiet in its last part, be it about an offset."""
    last = acceleration[-max(2, int(LAST_PART * len(acceleration))) :]
    peak = np.abs(acceleration).max()
    return bool(abs(last.mean()) < QUIET * peak and last.std() < STEADY * peak)


def left_at_end(given: Mapping[str, FloatArray], dt: float, *, recorded: bool) -> str:
    """Return the components of a motion that still move at its end, and their motion, in words."""
    found = []
    for axis, values in given.items():
        if (len(values) - 1) * dt < LEAST_RECORD or not (recorded or has_faded(values)):
            continue
        left = drift_of(values, dt)
        if left.share > LARGEST_DRIFT:
            found.append(
                worded(
                    "{axis}: velocity {velocity:.3g} m/s ({share:.0%} of its peak), displacement "
                    "{displacement:.3g} m",
                    axis=axis,
                    velocity=left.velocity,
                    share=left.share,
                    displacement=left.displacement,
                )
            )
    return joined(*found)


def corrected(acceleration: FloatArray, dt: float, *, displacement: bool) -> FloatArray:
    """Return an acceleration whose velocity vanishes at its end, and on demand displacement.

    Shapes: acceleration (n,), result (n,).
    """
    velocity, displaced = (values[-1] for values in integrated(acceleration, dt))
    length = dt * (len(acceleration) - 1)
    line = np.linspace(0.0, 1.0, len(acceleration))
    if not displacement:
        return np.asarray(acceleration - velocity / length, dtype=np.float64)
    at_start = 6.0 * displaced / length**2 - 2.0 * velocity / length
    rise = 6.0 * velocity / length - 12.0 * displaced / length**2
    return np.asarray(acceleration - at_start - rise * line, dtype=np.float64)
