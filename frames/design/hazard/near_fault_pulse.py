r"""The velocity pulse of Mavroeidis and Papageorgiou, in closed form.

With :math:`\tau = t - t_0`, :math:`\omega = 2 \pi f_p` and :math:`|\tau| \le \gamma / (2 f_p)`,

.. math:: v = \frac{A}{2} \left(1 + \cos \frac{\omega \tau}{\gamma}\right) \cos(\omega \tau + \nu)

(Mavroeidis and Papageorgiou 2003, Bull. Seism. Soc. Am. 93:1099-1131). Acceleration and
displacement are its derivative and its integral.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from lir_element.argument_checks import require_between, require_finite, require_positive

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray

PULSE_VELOCITY = 1.0
"""Amplitude A of near-fault pulses [m/s], about the same for all moderate to large magnitudes
(Mavroeidis and Papageorgiou 2003; to be confirmed against the paper)."""

PERIOD_OF_MAGNITUDE = (-2.9, 0.5)
"""log10 T_p = a + b M_w with T_p in s (the same; to be confirmed against the paper)."""


def pulse_period(magnitude: float) -> float:
    """Return the period of the pulse [s] that belongs to a moment magnitude.

    Examples
    --------
    >>> round(pulse_period(7.0), 2)
    3.98
    """
    size = require_between("magnitude", magnitude, 5.0, 8.5, "-", error=MotionError)
    a, b = PERIOD_OF_MAGNITUDE
    return float(10.0 ** (a + b * size))


@dataclass(frozen=True, kw_only=True)
class NearFaultPulse:
    """A pulse of velocity in closed form.

    Parameters
    ----------
    velocity : float
        Amplitude A of the velocity's envelope [m/s].
    period : float
        Period T_p = 1 / f_p of what oscillates [s].
    gamma : float
        Length of the envelope over the period [-], above 1.
    phase : float
        Phase nu [rad]: 0 a velocity that is symmetric about its middle, pi/2 antisymmetric.
    time : float, optional
        Time of the middle of the envelope [s]; half its length if None: it begins at 0.

    Raises
    ------
    MotionError
        If a value is out of its bounds.

    Examples
    --------
    >>> pulse = NearFaultPulse(velocity=1.0, period=2.0, gamma=2.0, phase=0.0)
    >>> pulse.duration, pulse.left
    (4.0, 0.0)
    >>> float(pulse.velocities(2.0))
    1.0
    """

    velocity: float
    period: float
    gamma: float
    phase: float
    time: float | None = None

    def __post_init__(self) -> None:
        """Check."""
        require_positive("velocity", self.velocity, "m/s", error=MotionError)
        require_positive("period", self.period, "s", error=MotionError)
        require_finite("phase", self.phase, "rad", error=MotionError)
        length = require_finite("gamma", self.gamma, "-", error=MotionError)
        if length <= 1.0:
            msg = f"gamma = {length:g} must be above 1: the envelope is longer than one period"
            raise MotionError(msg)
        middle = 0.5 * self.duration if self.time is None else self.time
        object.__setattr__(self, "time", require_finite("time", middle, "s", error=MotionError))

    @property
    def duration(self) -> float:
        """Length of the envelope [s]."""
        return self.gamma * self.period

    @property
    def left(self) -> float:
        """Displacement that is left after the pulse [m]."""
        whole = math.sin(math.pi * self.gamma) * math.cos(self.phase) / (1.0 - self.gamma**2)
        return round(0.5 * self.velocity * self.period / math.pi * whole, 15) + 0.0

    def accelerations(self, times: npt.ArrayLike) -> FloatArray:
        """Return accelerations [m/s2] at times [s], in their shape."""
        tau, w = self._within(times), 2.0 * math.pi / self.period
        slow, fast = w * tau / self.gamma, w * tau + self.phase
        found = np.sin(slow) * np.cos(fast) + self.gamma * np.sin(fast) * (1.0 + np.cos(slow))
        inside = np.abs(tau) < 0.5 * self.duration
        return np.asarray(-0.5 * self.velocity * w / self.gamma * found * inside)

    def velocities(self, times: npt.ArrayLike) -> FloatArray:
        """Return velocities [m/s] at times [s], in their shape."""
        tau, w = self._within(times), 2.0 * math.pi / self.period
        found = (1.0 + np.cos(w * tau / self.gamma)) * np.cos(w * tau + self.phase)
        return np.asarray(0.5 * self.velocity * found)

    def displacements(self, times: npt.ArrayLike) -> FloatArray:
        """Return displacements [m] at times [s], in their shape; zero before the pulse."""
        tau = self._within(times)
        return self._integral(tau) - self._integral(np.float64(-0.5 * self.duration))

    def _within(self, times: npt.ArrayLike) -> FloatArray:
        # Times from the middle of the envelope, held at its ends: nothing moves out of it.
        half = 0.5 * self.duration
        return np.clip(np.asarray(times, dtype=np.float64) - (self.time or 0.0), -half, half)

    def _integral(self, tau: npt.ArrayLike) -> FloatArray:
        w, found = 2.0 * math.pi / self.period, np.zeros(np.shape(tau))
        for share, weight in (
            (1.0, 1.0),
            (1.0 + 1.0 / self.gamma, 0.5),
            (1.0 - 1.0 / self.gamma, 0.5),
        ):
            found = found + weight * np.sin(share * w * np.asarray(tau) + self.phase) / (share * w)
        return 0.5 * self.velocity * found
