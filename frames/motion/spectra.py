r"""Elastic response spectra, exact for an acceleration that is linear between its samples.

The oscillator :math:`\ddot u + 2 \zeta \omega \dot u + \omega^2 u = -a_g(t)` is one complex
equation of first order, :math:`\dot q = p\,q + a_g` with
:math:`p = -\zeta\omega + i\,\omega_d`, :math:`\omega_d = \omega\sqrt{1-\zeta^2}` and
:math:`u = -\mathrm{Im}(q)/\omega_d`. For an acceleration that is linear within a step the step is
closed-form, the recursion of Nigam and Jennings (1969), Bull. Seism. Soc. Am. 59:909-922:

.. math:: q_{n+1} = e^{z} q_n + h\,(\varphi_1 - \varphi_2)\,a_n + h\,\varphi_2\,a_{n+1},
          \quad z = p h,\ \varphi_1 = (e^z - 1)/z,\ \varphi_2 = (\varphi_1 - 1)/z,

as in `scipy.signal.lfilter`. The peak is searched at `POINTS_PER_PERIOD` points or more of each
period, and in the free vibration after the motion's end.

Why not a library: of those on the package index, eqsig 1.2 (exact recursion too) returns the peak
ground acceleration for every period below 6 dt (at T = 0.1 s of a record with dt = 0.02 s that is
28 % too low) and searches the peak at the samples only; pyrotd 0.6 works in the frequency domain,
in which the record's end runs into its beginning (17 % off at T = 8 s of a 40 s record), and does
not import with a current setuptools.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames._errors import MotionError
from lir_element.argument_checks import require_between, unreal

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray

POINTS_PER_PERIOD = 40
"""Points of a period at which the peak is searched: the sampled peak of a harmonic is at most
1 - cos(pi/40) = 0.3 % too low."""

MAX_DIVISIONS = 100
"""Most points within a step of the record; periods that would want more follow the ground."""


def response_spectrum(
    acceleration: FloatArray, dt: float, periods: npt.ArrayLike, damping: float = 0.05
) -> xr.Dataset:
    """Return the elastic response spectrum of an acceleration.

    Shapes: acceleration (n,), periods (m,).
    """
    period, ratio = checked_oscillators(periods, damping)
    shift = spectral_displacement(acceleration, dt, period, ratio)
    omega = 2.0 * np.pi / np.where(period > 0.0, period, np.inf)
    rigid = np.abs(acceleration).max()
    columns = {
        "pseudo_acceleration": (np.where(period > 0.0, omega**2 * shift, rigid), "m/s2"),
        "pseudo_velocity": (omega * shift, "m/s"),
        "displacement": (shift, "m"),
    }
    return xr.Dataset(
        {
            key: ("period", values, {"units": unit, "long_name": key.replace("_", "-")})
            for key, (values, unit) in columns.items()
        },
        coords={"period": ("period", period, {"units": "s", "long_name": "natural period"})},
        attrs={"damping": ratio},
    )


def checked_oscillators(periods: npt.ArrayLike, damping: float) -> tuple[FloatArray, float]:
    """Return periods (m,) [s] and damping [-] of oscillators, or raise a MotionError."""
    ratio = require_between("damping", damping, 0.0, 1.0, remedy="5 % is 0.05", error=MotionError)
    if odd := unreal(periods):
        msg = f"periods {odd}"
        raise MotionError(msg)
    period = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    bad = period[~(np.isfinite(period) & (period >= 0.0))]
    if period.ndim != 1 or bad.size:
        found = f"hold {bad[0]:g}" if bad.size else f"have shape {period.shape}"
        msg = f"periods {found}: give one sequence of finite periods in s, >= 0"
        raise MotionError(msg)
    return period, ratio


def spectral_displacement(
    acceleration: FloatArray, dt: float, periods: FloatArray, damping: float
) -> FloatArray:
    """Return the largest displacements of elastic oscillators at rest at the first sample.

    Shapes: acceleration (n,), periods (m,), result (m,).

    Examples
    --------
    A step of 1 m/s2 deflects an undamped oscillator twice as far as its static load:

    >>> step = np.ones(1000)
    >>> omega = 2.0 * np.pi / 0.5
    >>> peak = spectral_displacement(step, 0.005, np.array([0.5]), 0.0)
    >>> [round(float(value), 3) for value in omega**2 * peak]
    [2.0]
    """
    refined: dict[int, FloatArray] = {}
    peaks = np.zeros(len(periods))
    for index, period in enumerate(periods):
        if period > 0.0:
            divisions = _divisions(dt, period)
            if divisions not in refined:
                refined[divisions] = _refine(acceleration, divisions)
            step = dt / divisions
            history = _history(refined[divisions], step, float(period), damping)
            peaks[index] = np.abs(history).max()
    return peaks


def displacement_history(
    acceleration: FloatArray, dt: float, period: float, damping: float
) -> FloatArray:
    """Return the displacement of an elastic oscillator, and a period of its free vibration after.

    Shapes: acceleration (n,), result (k,).
    """
    divisions = _divisions(dt, period)
    return _history(_refine(acceleration, divisions), dt / divisions, period, damping)


def _divisions(dt: float, period: float) -> int:
    """Return into how many parts a step is divided."""
    return min(MAX_DIVISIONS, max(1, math.ceil(POINTS_PER_PERIOD * dt / period)))


def _refine(acceleration: FloatArray, divisions: int) -> FloatArray:
    """Divide each step by linear interpolation."""
    samples = np.arange(len(acceleration), dtype=np.float64)
    points = np.arange((len(acceleration) - 1) * divisions + 1) / divisions
    return np.interp(points, samples, acceleration)


def _history(acceleration: FloatArray, step: float, period: float, damping: float) -> FloatArray:
    """Return the displacement of one oscillator (equations of the module's docstring)."""
    omega = 2.0 * math.pi / period
    omega_d = omega * math.sqrt(1.0 - damping**2)
    pole = complex(-damping * omega, omega_d)
    z = pole * step
    phi_1 = np.expm1(z) / z
    phi_2 = (phi_1 - 1.0) / z
    new, old = step * phi_2, step * (phi_1 - phi_2)
    at_rest = np.array([-new * acceleration[0]])  # q = 0 at the first sample
    from scipy.signal import lfilter  # half of the time that `import frames` took

    q, _ = lfilter([new, old], [1.0, -np.exp(z)], acceleration, zi=at_rest)
    after = np.arange(1, POINTS_PER_PERIOD + 1) * (period / POINTS_PER_PERIOD)
    free = q[-1] * np.exp(pole * after)
    return np.concatenate([q.imag, free.imag]) / -omega_d
