"""Measures of the strength, the duration and the periods of one component of a ground motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from frames._types import FloatArray
from frames.motion.spectra import checked_oscillators, displacement_history, response_spectrum
from frames.motion.transforms import integrated
from lir_element.argument_checks import require_choice
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames.motion.ground_motion import GroundMotion

ANGLES = 180
"""Directions over half a turn of which RotD50 is the median."""


def _directions(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the largest response in each direction (ANGLES,)."""
    from scipy.spatial import ConvexHull, QhullError  # a good part of the time of `import frames`

    path = np.column_stack([x, y])
    try:
        corners = path[ConvexHull(path).vertices]
    except QhullError:  # all on one line: no hull
        corners = path
    angle = np.pi / ANGLES * np.arange(ANGLES)
    peaks = [np.abs(corners @ (np.cos(a), np.sin(a))).max() for a in angle]
    return np.array(peaks, dtype=np.float64)


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())


MEASURES: dict[str, Callable[[FloatArray, FloatArray], float]] = {
    "RotD100": lambda x, y: _peak(np.hypot(x, y)),
    "RotD50": lambda x, y: float(np.median(_directions(x, y))),
    "SRSS": lambda x, y: float(np.hypot(_peak(x), _peak(y))),
    "geometric mean": lambda x, y: float(np.sqrt(_peak(x) * _peak(y))),
    "arithmetic mean": lambda x, y: 0.5 * (_peak(x) + _peak(y)),
    "x": lambda x, y: _peak(x),
    "y": lambda x, y: _peak(y),
}
"""Measures of the response of a pair: functions of the histories along x and y."""


def pair_spectrum(
    motion: GroundMotion,
    periods: npt.ArrayLike,
    damping: float = 0.05,
    measure: str = "RotD100",
) -> FloatArray:
    """Return the spectrum of a pair of horizontal components.

    Parameters
    ----------
    motion : GroundMotion
        The motion; x and y, unless the measure is one of them.
    periods : array_like, shape (m,)
        Natural periods [s], >= 0.
    damping : float
        Part of the critical damping [-], in [0, 1).
    measure : str
        "RotD100" (maximum direction), "RotD50", "SRSS", "geometric mean", "arithmetic mean", or
        "x" or "y" alone.

    Returns
    -------
    ndarray, shape (m,)
        Pseudo-accelerations [m/s2].

    Raises
    ------
    MotionError
        If a component is missing, or a period, the damping or the measure is out of its bounds.

    Examples
    --------
    >>> from frames import GroundMotion
    >>> wave = [0.0, 3.0, 0.0, -3.0, 0.0]
    >>> both = GroundMotion(x=wave, y=[4.0 / 3.0 * a for a in wave], dt=0.1)
    >>> pair_spectrum(both, [0.0]).tolist()
    [5.0]
    """
    require_choice("measure", measure, tuple(MEASURES), error=MotionError)
    period, ratio = checked_oscillators(periods, damping)
    needed = measure if measure in {"x", "y"} else "xy"
    missing = [axis for axis in needed if getattr(motion, axis) is None]
    if missing:
        msg = (
            f"{motion.name or 'motion'} has no component {missing[0]} for the measure {measure!r}: "
            f"add it (column {missing[0]} of motions.csv); an intensity ([fragility]) may have "
            'measure = "x" or "y"'
        )
        raise MotionError(msg)
    pair = [
        motion.x if motion.x is not None else np.zeros(motion.n_steps),
        motion.y if motion.y is not None else np.zeros(motion.n_steps),
    ]
    rule = MEASURES[measure]
    found = np.empty(len(period))
    for k, each in enumerate(period):
        if each > 0.0:
            x, y = (displacement_history(a, motion.dt, float(each), ratio) for a in pair)
            found[k] = (2.0 * np.pi / each) ** 2 * rule(x, y)
        else:
            found[k] = rule(*pair)
    return found


SPECTRUM_PERIODS = np.geomspace(0.05, 12.0, 120)
"""Periods at which the predominant and the pulse period are sought [s]."""

MEAN_PERIOD_BAND = (0.25, 20.0)
"""Frequencies that count for the mean period [Hz] (Rathje, Abrahamson and Bray 1998)."""


def build_up(acceleration: FloatArray, dt: float) -> FloatArray:
    """Return the Arias intensity up to each sample [m/s], shape (n,)."""
    square = acceleration**2
    steps = 0.5 * dt * (square[:-1] + square[1:])
    return np.concatenate([[0.0], np.pi / (2.0 * STANDARD_GRAVITY) * np.cumsum(steps)])


def cumulative_velocity(acceleration: FloatArray, dt: float) -> float:
    """Return the cumulative absolute velocity [m/s], the integral of abs(a)."""
    size = np.abs(acceleration)
    return float(0.5 * dt * (size[:-1] + size[1:]).sum())


def significant_duration(
    acceleration: FloatArray, dt: float, start: float = 0.05, end: float = 0.95
) -> float:
    """Return the time between two parts of the Arias intensity.

    Shapes: acceleration (n,).
    """
    intensity = build_up(acceleration, dt)
    if not intensity[-1] > 0.0:
        return 0.0
    time = dt * np.arange(len(intensity))
    first, last = np.interp([start, end], intensity / intensity[-1], time)
    return float(last - first)


def mean_period(acceleration: FloatArray, dt: float) -> float:
    """Return the mean period T_m [s]: periods weighted by the squared Fourier amplitudes."""
    amplitude = np.abs(np.fft.rfft(acceleration)) ** 2
    frequency = np.fft.rfftfreq(len(acceleration), dt)
    low, high = MEAN_PERIOD_BAND
    counts = (frequency >= low) & (frequency <= high)
    total = float(amplitude[counts].sum())
    if not total > 0.0:
        return 0.0
    return float((amplitude[counts] / frequency[counts]).sum()) / total


def motion_measures(acceleration: FloatArray, dt: float) -> dict[str, float]:
    """Return all measures of one component, by name with unit.

    The pulse period is that of the largest pseudo-velocity of the 5 % spectrum. If there is a
    pulse, it measures its length (1.2 times its period for one sine of acceleration); it does not
    show if there is one.

    Parameters
    ----------
    acceleration : ndarray, shape (n,)
        Samples [m/s2].
    dt : float
        Time step [s].

    Returns
    -------
    dict of str to float
        Peaks of acceleration, velocity and displacement, Arias intensity, cumulative absolute
        velocity (CAV), significant durations, predominant, mean and pulse period.

    Examples
    --------
    >>> import numpy as np
    >>> from frames.design import motion_measures
    >>> found = motion_measures(3.0 * np.sin(np.linspace(0.0, 6.2832, 201)), dt=0.01)
    >>> round(found["PGA [m/s2]"], 2), round(found["PGV [m/s]"], 2)
    (3.0, 1.91)
    """
    velocity, displacement = integrated(acceleration, dt)
    size = np.abs(acceleration)
    spectrum = response_spectrum(acceleration, dt, SPECTRUM_PERIODS)
    level, speed = (spectrum[key].to_numpy() for key in ("pseudo_acceleration", "pseudo_velocity"))
    return {
        "PGA [m/s2]": float(size.max()),
        "PGV [m/s]": float(np.abs(velocity).max()),
        "PGD [m]": float(np.abs(displacement).max()),
        "Arias [m/s]": float(build_up(acceleration, dt)[-1]),
        "CAV [m/s]": cumulative_velocity(acceleration, dt),
        "D5-75 [s]": significant_duration(acceleration, dt, 0.05, 0.75),
        "D5-95 [s]": significant_duration(acceleration, dt),
        "Tp [s]": float(SPECTRUM_PERIODS[level.argmax()]),
        "Tm [s]": mean_period(acceleration, dt),
        "T pulse [s]": float(SPECTRUM_PERIODS[speed.argmax()]),
    }
