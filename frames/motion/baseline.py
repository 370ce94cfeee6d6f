r"""What is left of a motion of the ground at its end, and the smallest correction that removes it.

A correction p(t) of the acceleration on 0..T that makes velocity and displacement vanish at T has

.. math:: \int_0^T p\,dt = v_T, \qquad \int_0^T (T - t)\,p\,dt = d_T.

The one of the least square (Lagrange's conditions) is a straight line, p = c_0 + c_1 t / T, with

.. math:: c_0 = 6 d_T / T^2 - 2 v_T / T, \qquad c_1 = 6 v_T / T - 12 d_T / T^2.

It is the parabolic baseline of the velocity (Berg and Housner 1961; Brady 1966), its constants
taken from the end instead of a fit. Where only the velocity shall vanish, p = v_T / T.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray

LARGEST_DRIFT = 0.15
"""Velocity at the end over the peak velocity above which a record is called not at rest [-]."""

LEAST_RECORD = 8.0
"""Duration from which a motion is a record, not a pulse, and its end is looked at [s]."""

LAST_PART, QUIET, STEADY = 0.2, 0.3, 0.1
"""Samples at the end that tell whether a motion has faded [-], and what their mean and their
scatter are below then, over the peak acceleration [-]. One that ends at full strength was cut, or
made so: where its velocity stands just then says nothing of a baseline."""

LARGEST_CHANGE = 0.05
"""Change of a peak acceleration by a correction above which it is refused [-]."""


class Drift(NamedTuple):
    """What is left of one component at its end.

    Attributes
    ----------
    velocity, displacement : float
        Of the ground at the last sample [m/s], [m].
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
    """Return what is left of one component (n,) [m/s2] at its end."""
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
    """Say which components of a motion still move at its end, and how."""
    found = []
    for axis, values in given.items():
        if (len(values) - 1) * dt < LEAST_RECORD or not (recorded or has_faded(values)):
            continue
        left = drift_of(values, dt)
        if left.share > LARGEST_DRIFT:
            found.append(
                f"{axis}: velocity {left.velocity:.3g} m/s ({left.share:.0%} of its peak), "
                f"displacement {left.displacement:.3g} m"
            )
    return "; ".join(found)


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
