r"""Stochastic ground motion: filtered and modulated noise with the spectrum of a point source.

White Gaussian noise in an envelope of Saragoni and Hart is given the Fourier amplitudes

.. math::

    Y(f) = \frac{0.55 \cdot 2 \cdot 0.707}{4 \pi \rho \beta^3 R} M_0
           \frac{(2 \pi f)^2}{1 + (f / f_c)^2}
           \exp\left(-\frac{\pi f R}{Q \beta} - \pi \kappa f\right), \qquad
    f_c = 0.49 \beta \left(\frac{\Delta \sigma}{M_0}\right)^{1/3}

(Boore 2003, Pure Appl. Geophys. 160:635-676; in SI units), with Q = Q_0 f^n. Near the fault R is
the effective distance, which magnitude keeps from vanishing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from lir_element.argument_checks import require_between, require_positive, require_type
from lir_element.fields import check_numbers, number

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
        Period T_p = 1 / f_p of the oscillation [s].
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

    velocity: float = field(metadata=number("m/s", "(0, inf)"))
    period: float = field(metadata=number("s", "(0, inf)"))
    gamma: float = field(
        metadata=number("-", "(1, inf)", remedy="the envelope is longer than one period")
    )
    phase: float = field(metadata=number("rad"))
    time: float | None = field(default=None, metadata=number("s"))

    def __post_init__(self) -> None:
        """Check."""
        check_numbers(self, error=MotionError)
        middle = 0.5 * self.duration if self.time is None else float(self.time)
        object.__setattr__(self, "time", middle)

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
        # Times from the middle of the envelope, limited to its ends: the pulse is at rest beyond
        # them.
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


KILOMETRE = 1000.0

GENERIC_ROCK = (
    (0.01, 1.00),
    (0.09, 1.10),
    (0.16, 1.18),
    (0.51, 1.42),
    (0.84, 1.58),
    (1.25, 1.74),
    (2.26, 2.06),
    (3.17, 2.25),
    (6.05, 2.58),
    (16.6, 3.13),
    (61.2, 4.00),
)
"""Amplification of generic rock: frequencies [Hz] and factors (Boore and Joyner 1997, Bull. Seism.
Soc. Am. 87:327-341; to be confirmed against the paper)."""


@dataclass(frozen=True, kw_only=True)
class PointSource:
    """An earthquake and a site, for the Fourier amplitudes of the ground's acceleration.

    Parameters
    ----------
    magnitude : float
        Moment magnitude, 4 to below 9.
    distance : float
        Closest distance to the rupture [km].
    stress_drop : float
        Stress parameter [Pa]; 10 MPa (100 bar) is usual at plate boundaries.
    density, shear_velocity : float
        Density [kg/m3] and shear wave velocity [m/s] of the crust at the source.
    kappa : float
        Decay of high frequencies at the site [s]; 0.04 rock of California, 0.005 hard rock.
    quality, quality_exponent : float
        Attenuation along the path, ``Q = quality * f**quality_exponent``, f in Hz.
    amplification : sequence of (float, float)
        Frequencies [Hz] and factors [-] of the site, logarithmic between them; one pair for all.
        By default generic rock (Boore and Joyner 1997; to be confirmed).
    saturation : (float, float)
        a, b of ``log10 h = a + b magnitude``, h in km: the effective distance is
        ``sqrt(distance**2 + h**2)`` (Yenier and Atkinson 2014; to be confirmed).

    Raises
    ------
    MotionError
        If a value is out of its bounds.

    Notes
    -----
    Defaults are usual values for active regions, from memory: to be confirmed for the site.

    Examples
    --------
    >>> from frames.design import synthetic_near_fault
    >>> source = PointSource(magnitude=6.5, distance=5.0, kappa=0.03)
    >>> motions = synthetic_near_fault(1, magnitude=6.5, distance=5.0, seed=1, source=source)
    >>> list(motions)
    ['near-fault 1']
    """

    magnitude: float = field(metadata=number("-", "[4, 9)"))
    distance: float = field(
        metadata=number("km", "[0, inf)", remedy="give the closest distance to the rupture in km")
    )
    stress_drop: float = field(default=10e6, metadata=number("Pa", "(0, inf)"))
    density: float = field(default=2800.0, metadata=number("kg/m3", "(0, inf)"))
    shear_velocity: float = field(default=3500.0, metadata=number("m/s", "(0, inf)"))
    kappa: float = field(default=0.04, metadata=number("s", "[0, inf)"))
    quality: float = field(default=180.0, metadata=number("-", "(0, inf)"))
    quality_exponent: float = field(default=0.45, metadata=number("-", "[0, inf)"))
    amplification: tuple[tuple[float, float], ...] = GENERIC_ROCK
    saturation: tuple[float, float] = (-0.405, 0.235)

    def __post_init__(self) -> None:
        """Check."""
        check_numbers(self, error=MotionError)
        if np.shape(self.saturation) != (2,):
            msg = f"saturation = {self.saturation!r}: give (a, b) of log10 h [km] = a + b magnitude"
            raise MotionError(msg)
        pairs = np.array(self.amplification, dtype=np.float64)
        if pairs.ndim != 2 or pairs.shape[1] != 2 or not (pairs > 0.0).all():
            msg = f"amplification = {self.amplification!r}: give pairs of frequency [Hz] and factor"
            raise MotionError(msg)
        if not (np.diff(pairs[:, 0]) > 0.0).all():
            msg = f"amplification: frequencies {pairs[:, 0].tolist()} Hz must rise: sort the pairs"
            raise MotionError(msg)

    @property
    def moment(self) -> float:
        """Seismic moment [N m] (Hanks and Kanamori 1979)."""
        return float(10.0 ** (1.5 * self.magnitude + 9.05))

    @property
    def corner_frequency(self) -> float:
        """Corner frequency of Brune's spectrum [Hz]."""
        return 0.49 * self.shear_velocity * math.cbrt(self.stress_drop / self.moment)

    @property
    def effective_distance(self) -> float:
        """Distance that the amplitudes fall with [km]."""
        a, b = self.saturation
        return math.hypot(self.distance, 10.0 ** (a + b * self.magnitude))

    @property
    def duration(self) -> float:
        """Duration of the strong motion [s]: that of the source, and 0.05 s a kilometre."""
        return 1.0 / self.corner_frequency + 0.05 * self.effective_distance

    def fourier_amplitudes(self, frequencies: npt.ArrayLike) -> FloatArray:
        """Return Fourier amplitudes of the acceleration [m/s] at frequencies [Hz]."""
        f = np.asarray(frequencies, dtype=np.float64)
        r, beta = KILOMETRE * self.effective_distance, self.shear_velocity
        source = 0.55 * 2.0 * math.sqrt(0.5) / (4.0 * math.pi * self.density * beta**3 * r)
        shape = (2.0 * math.pi * f) ** 2 / (1.0 + (f / self.corner_frequency) ** 2)
        exponent = 1.0 - self.quality_exponent  # f over Q, finite at zero
        path = np.exp(-math.pi * r * f**exponent / (self.quality * beta))
        at, factors = np.log(self.amplification).T
        site = np.exp(
            np.interp(np.log(np.maximum(f, 1e-12)), at, factors) - math.pi * self.kappa * f
        )
        return np.asarray(source * self.moment * shape * path * site)


PEAK, REST = 0.2, 0.05
"""Time of the envelope's peak, and its value at the end, both over twice the duration."""


def envelope(
    times: npt.ArrayLike, duration: float, peak: float = PEAK, rest: float = REST
) -> FloatArray:
    """Return the envelope of Saragoni and Hart, 1 at its peak.

    Source: Boore (2003), eq. 13 to 16, with f_Tgm = 2; to be confirmed against the paper.
    """
    length = 2.0 * require_positive("duration", duration, "s", error=MotionError)
    for name, value in (("peak", peak), ("rest", rest)):
        require_between(name, value, 1e-6, 1.0, "-", error=MotionError)
    b = -peak * math.log(rest) / (1.0 + peak * (math.log(peak) - 1.0))
    c = b / peak
    x = np.maximum(np.asarray(times, dtype=np.float64) / length, 0.0)
    return np.asarray((math.e / peak * x) ** b * np.exp(-c * x))


def stochastic_acceleration(
    source: PointSource, dt: float, steps: int, rng: np.random.Generator
) -> FloatArray:
    """Return one sample of the acceleration of a point source.

    Shapes: result (steps,).
    """
    require_type("rng", rng, np.random.Generator, "a numpy Generator: numpy.random.default_rng(1)")
    step = require_positive("dt", dt, "s", error=MotionError)
    if steps * step < 2.0 * source.duration:
        msg = (
            f"{steps} samples of {step:g} s last {steps * step:.3g} s, but the motion lasts "
            f"{2.0 * source.duration:.3g} s: use more samples"
        )
        raise MotionError(msg)
    shape = envelope(step * np.arange(steps), source.duration)
    noise = np.fft.rfft(shape * rng.standard_normal(steps)) / math.sqrt(float((shape**2).sum()))
    target = source.fourier_amplitudes(np.fft.rfftfreq(steps, step))
    return np.asarray(np.fft.irfft(noise * target / step, steps), dtype=np.float64)
