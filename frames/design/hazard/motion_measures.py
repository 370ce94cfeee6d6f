"""Measures of the strength, the duration and the periods of one component of a ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.motion.baseline import integrated
from frames.motion.spectra import response_spectrum
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray

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

    The pulse period is that of the largest pseudo-velocity of the 5 % spectrum. It says how long
    the pulse is where there is one (1.2 times its period for one sine of acceleration); it does not
    tell whether there is one.

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
