"""Ground motions: recorded or made accelerations along x, y and z, in SI units.

A motion is a frozen value: every method that changes something returns a new motion. Between two
samples the acceleration is linear; before the first and after the last one it is zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from frames.motion import transforms
from frames.motion.record_motions import RecordedMotion
from frames.motion.spectra import response_spectrum

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from frames._types import FloatArray


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class GroundMotion(RecordedMotion):
    """Accelerations of the ground along up to three axes.

    Parameters
    ----------
    x, y, z : ndarray, shape (n,), optional
        Accelerations [m/s2] along the global axes, z up; at least one of them. They are copied
        and read-only. A component that is shorter than the longest by at most 20 samples or 1 %
        is filled up with zeros at its end (vertical components often are).
    dt : float
        Time step [s].
    name : str
        Name for plots and messages.

    Raises
    ------
    MotionError
        If there is no component, a component is no finite 1-D array of two samples or more, the
        lengths differ by more than the above, or `dt` is not positive.
    TypeError
        If `dt` is no number.

    Warns
    -----
    MotionWarning
        If the ground still moves at the end of a component of 8 s or more that has faded by then:
        its velocity is above 15 % of its peak. A motion that ends at full strength, as a sine that
        was cut, counts as intended; of files every record is checked.

    Examples
    --------
    >>> import numpy as np
    >>> pulse = GroundMotion(x=3.0 * np.sin(np.linspace(0.0, np.pi, 101)), dt=0.01, name="pulse")
    >>> pulse
    GroundMotion 'pulse': 101 samples, dt = 0.01 s, 1 s, peak x 3.000 m/s2
    >>> pulse.scaled(2.0).peak
    {'x': 6.0}
    """

    def scaled(self, factor: float | Sequence[float]) -> GroundMotion:
        """Return the motion times a factor, or times one factor for each of x, y and z.

        Parameters
        ----------
        factor : float or sequence of three
            The factors [-]; negative ones turn the direction, 0 silences a component.

        Returns
        -------
        GroundMotion
            The scaled motion.

        Raises
        ------
        MotionError
            If there are not one or three finite factors.
        """
        if isinstance(factor, float) and factor == 1.0:  # exactly  # noqa: RUF069
            return self
        return self._with(transforms.scaled(self._given(), factor))

    def rotated(self, angle: float) -> GroundMotion:
        """Return the motion turned about z.

        Parameters
        ----------
        angle : float
            Angle [rad], from x towards y: a motion along x becomes one along y at pi/2.

        Returns
        -------
        GroundMotion
            The motion with both horizontal components.
        """
        return self._with(transforms.rotated(self._given(), angle))

    def trimmed(self, start: float = 0.0, end: float | None = None) -> GroundMotion:
        """Return the samples from `start` to `end`; the time starts at 0 again.

        Parameters
        ----------
        start, end : float
            Times of the first and the last sample that are kept [s]; `end` left out: the last.

        Returns
        -------
        GroundMotion
            The part of the motion.

        Raises
        ------
        MotionError
            If fewer than two samples are between.
        """
        return self._with(transforms.trimmed(self._given(), self.dt, start, end))

    def resampled(self, dt: float) -> GroundMotion:
        """Return the motion at another time step, by linear interpolation.

        The time integration, too, assumes a linear acceleration between samples: a step that
        divides the old one changes nothing but the number of samples. A longer step loses peaks and
        aliases high frequencies, because no filter is applied. The rest of the last step, if the
        duration is not a multiple of `dt`, is cut off.

        Parameters
        ----------
        dt : float
            New time step [s], at most the duration.

        Returns
        -------
        GroundMotion
            The resampled motion.

        Raises
        ------
        MotionError
            If `dt` is not greater than 0 and at most the duration.
        """
        return self._with(*transforms.resampled(self._given(), self.dt, dt))

    def with_tail(self, seconds: float) -> GroundMotion:
        """Return the motion with zeros after it, for the free vibration.

        Parameters
        ----------
        seconds : float
            Length of the tail [s], >= 0; rounded up to whole time steps.

        Returns
        -------
        GroundMotion
            The longer motion.

        Raises
        ------
        MotionError
            If the tail is negative.
        """
        return self._with(transforms.with_tail(self._given(), self.dt, seconds))

    def followed_by(self, second: GroundMotion, gap: float = 0.0) -> GroundMotion:
        """Return the motion with a second one behind it, as after a main shock.

        Parameters
        ----------
        second : GroundMotion
            The second shock; a component that one of both lacks is at rest there.
        gap : float
            Time at rest between them [s], >= 0; rounded up to whole time steps.

        Returns
        -------
        GroundMotion
            Both, at the finer of their time steps.

        Raises
        ------
        MotionError
            If the gap is negative.
        """
        dt = min(self.dt, second.dt)
        own = (self if self.dt == dt else self.resampled(dt)).with_tail(gap)
        other = second if second.dt == dt else second.resampled(dt)
        first, then, rest = own._given(), other._given(), (own.n_steps, other.n_steps)
        parts = {
            axis: np.concatenate(
                [each.get(axis, np.zeros(n)) for each, n in zip((first, then), rest, strict=True)]
            )
            for axis in {**first, **then}
        }
        return GroundMotion(**parts, dt=dt, name=f"{self.name}, then {second.name}")

    def corrected(self, *, displacement: bool = True) -> GroundMotion:
        """Return the motion with its baseline corrected: the ground is at rest at its end.

        The smallest sufficient acceleration, a straight line in time, is subtracted from each
        component (`frames.motion.transforms`). The name has the change of the peaks.

        Parameters
        ----------
        displacement : bool
            True if the displacement at the end must vanish, too. False keeps it free, for records
            with a permanent displacement of the ground.

        Returns
        -------
        GroundMotion
            The corrected motion.

        Raises
        ------
        MotionError
            If a peak acceleration would change by more than 5 %: that is no baseline.

        Examples
        --------
        >>> import numpy as np
        >>> motion = GroundMotion(x=0.01 + np.cos(np.linspace(0.0, 62.8, 2001)), dt=0.01)
        >>> still = motion.corrected()
        >>> round(motion.drift["x"].velocity, 2), abs(still.drift["x"].velocity) < 1e-12
        (0.19, True)
        """
        arrays, change = transforms.baseline_corrected(
            self._given(), self.dt, displacement=displacement
        )
        label = f"{self.name or 'motion'} (baseline corrected, peaks within {100 * change:.2g} %)"
        return self._with(arrays, name=label)

    def response_spectrum(
        self, periods: npt.ArrayLike, damping: float = 0.05, component: str = "x"
    ) -> xr.Dataset:
        """Return the elastic response spectrum of one component (method: `frames.motion.spectra`).

        Parameters
        ----------
        periods : array_like, shape (m,)
            Natural periods [s], >= 0. At 0 the pseudo-acceleration is the peak of the ground's.
        damping : float
            Part of the critical damping [-], in [0, 1).
        component : {"x", "y", "z"}
            The component.

        Returns
        -------
        xarray.Dataset
            `pseudo_acceleration` [m/s2], `pseudo_velocity` [m/s] and `displacement` [m] on the
            dimension `period` [s].

        Raises
        ------
        MotionError
            If a period or the damping is out of its bounds, or the component is not given.

        Examples
        --------
        >>> pulse = GroundMotion(x=[0.0, 2.0, 0.0, -2.0, 0.0], dt=0.1)
        >>> spectrum = pulse.response_spectrum([0.0, 0.4, 4.0])
        >>> spectrum["pseudo_acceleration"].values.round(3).tolist()
        [2.0, 4.375, 0.09]
        """
        given = self._given()
        if component not in given:
            msg = f"component = {component!r}: choose one of {', '.join(given)}"
            raise MotionError(msg)
        data = response_spectrum(given[component], self.dt, periods, damping)
        return data.assign_attrs(motion=self.name, component=component)


def seen_by_steps(motion: GroundMotion, dt: float) -> tuple[FloatArray, float]:
    """Return ground accelerations and their step for an analysis in steps of `dt`."""
    given = np.ascontiguousarray(motion.components, dtype=np.float64)
    step = float(motion.dt)
    if dt <= step * (1.0 + 1e-9) or len(given) < 2:
        return given, step
    rise = np.diff(given, axis=0) / step
    velocity = np.vstack([np.zeros(3), np.cumsum(0.5 * step * (given[1:] + given[:-1]), axis=0)])
    parts = step * velocity[:-1] + step**2 * (0.5 * given[:-1] + step * rise / 6.0)
    place = np.vstack([np.zeros(3), np.cumsum(parts, axis=0)])
    count = int(np.ceil((len(given) - 1) * step / dt - 1e-9)) + 2
    times = dt * np.arange(-1, count + 1)
    index = np.clip((times / step + 1e-9).astype(np.int64), 0, len(given) - 1)
    since = np.maximum(times - step * index, 0.0)[:, None]
    inside = index < len(given) - 1
    slope = np.vstack([rise, np.zeros(3)])[index]
    start = np.where(inside[:, None], given[index], 0.0)
    moved = place[index] + since * velocity[index] + since**2 * (0.5 * start + since * slope / 6.0)
    moved[times < 0.0] = 0.0
    means = (moved[2:] - 2.0 * moved[1:-1] + moved[:-2]) / dt**2
    means[0] *= 2.0  # half of the first triangle is before the motion
    return np.ascontiguousarray(means), dt
