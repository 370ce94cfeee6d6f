"""Ground motions: recorded or made accelerations along x, y and z, in SI units.

A motion is a frozen value: every method that changes something returns a new motion. Between two
samples the acceleration is linear; before the first and after the last one it is zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from frames._errors import MotionError
from frames.motion import changes
from frames.motion.components import AXES
from frames.motion.contents import MotionContents
from frames.motion.records import (
    AccelerationTrace,
    ColumnLayout,
    PathLike,
    Source,
    at2_traces,
    column_traces,
    common_step,
)
from frames.motion.spectra import response_spectrum

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from frames._types import FloatArray


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class GroundMotion(MotionContents):
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
        its velocity is above 15 % of its peak. What ends at full strength, as a sine that was cut,
        is taken to be meant; of files every record is looked at.

    Examples
    --------
    >>> import numpy as np
    >>> pulse = GroundMotion(x=3.0 * np.sin(np.linspace(0.0, np.pi, 101)), dt=0.01, name="pulse")
    >>> pulse
    GroundMotion 'pulse': 101 samples, dt = 0.01 s, 1 s, peak x 3.000 m/s2
    >>> pulse.scaled(2.0).peak
    {'x': 6.0}
    """

    @classmethod
    def from_at2(
        cls,
        x: PathLike | None = None,
        y: PathLike | None = None,
        z: PathLike | None = None,
        scale: float | Sequence[float] = 1.0,
        name: str | None = None,
    ) -> GroundMotion:
        """Read PEER AT2 files, one for each component (`frames.motion.records.read_at2`).

        Parameters
        ----------
        x, y, z : str or path, optional
            The files; at least one of them. A vertical component recorded as positive downwards
            (its name ends in DWN or DN) wants a negative scale.
        scale : float or sequence of three
            Factor on all components, or one for each [-].
        name : str, optional
            Name of the motion; the first file's name if left out.

        Returns
        -------
        GroundMotion
            The motion in m/s2.

        Raises
        ------
        MotionError
            If a file cannot be used, or time steps or lengths differ.

        Warns
        -----
        MotionWarning
            If the ground still moves at the end of a component.
        """
        traces, label = at2_traces(x, y, z)
        return cls._from_traces(traces, label if name is None else name).scaled(scale)

    @classmethod
    def from_columns(
        cls,
        path: PathLike | None = None,
        *,
        x: Source | None = None,
        y: Source | None = None,
        z: Source | None = None,
        unit: str,
        time: int | None = None,
        dt: float | None = None,
        scale: float | Sequence[float] = 1.0,
        skip: int = 0,
        comments: str = "#",
        delimiter: str | None = None,
        name: str | None = None,
    ) -> GroundMotion:
        """Read columns of text files (`frames.motion.records.read_columns`).

        Parameters
        ----------
        path : str or path, optional
            The file that column numbers refer to.
        x, y, z : int, str, path or (path, int), optional
            Where each component is: a column of `path`, counted from 0; a file of its own, with
            one column besides the times; or a file and its column.
        unit : {"g", "m/s2", "cm/s2"}
            Unit of the accelerations in the files.
        time : int, optional
            Column of the times [s] in each file. Give it or `dt`.
        dt : float, optional
            Time step [s] of files without times.
        scale : float or sequence of three
            Factor on all components, or one for each [-].
        skip : int
            Number of header lines that no comment sign marks.
        comments : str
            What starts a comment.
        delimiter : str, optional
            What separates the columns; white space if left out.
        name : str, optional
            Name of the motion; the first file's name if left out.

        Returns
        -------
        GroundMotion
            The motion in m/s2.

        Raises
        ------
        MotionError
            If a file cannot be used, or time steps or lengths differ.

        Warns
        -----
        MotionWarning
            If the ground still moves at the end of a component.

        Examples
        --------
        One file with times, north, east and up, in cm/s2; three files of one column, in g:

        >>> GroundMotion.from_columns(
        ...     "station.bbp", x=2, y=1, z=3, time=0, unit="cm/s2"
        ... )  # doctest: +SKIP
        >>> GroundMotion.from_columns(
        ...     x="E.ATH", y="N.ATH", z="V.ATH", dt=0.005, unit="g"
        ... )  # doctest: +SKIP
        """
        layout = ColumnLayout(unit, time, dt, skip, comments, delimiter)
        traces, label = column_traces(path, x, y, z, layout)
        return cls._from_traces(traces, label if name is None else name).scaled(scale)

    @classmethod
    def _from_traces(cls, traces: dict[str, AccelerationTrace], name: str) -> Self:
        """Join components that share their time step."""
        arrays = {axis: trace.acceleration for axis, trace in traces.items()}
        x, y, z = (arrays.get(axis) for axis in AXES)
        motion = cls._made(x, y, z, common_step(traces), name)
        motion._warn_of_drift(recorded=True)
        return motion

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
        return self._with(changes.scaled(self._given(), factor))

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
        return self._with(changes.rotated(self._given(), angle))

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
            If fewer than two samples lie between.
        """
        return self._with(changes.trimmed(self._given(), self.dt, start, end))

    def resampled(self, dt: float) -> GroundMotion:
        """Return the motion at another time step, by linear interpolation.

        The time integration, too, takes the acceleration as linear between samples: a step that
        divides the old one changes nothing but the number of samples. A longer step loses peaks
        and folds high frequencies down, as no filter is applied. What is left of the last step,
        if the duration is not a multiple of `dt`, is cut off.

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
        return self._with(*changes.resampled(self._given(), self.dt, dt))

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
        return self._with(changes.with_tail(self._given(), self.dt, seconds))

    def corrected(self, *, displacement: bool = True) -> GroundMotion:
        """Return the motion with its baseline corrected: the ground is at rest at its end.

        The smallest acceleration that does so, a straight line in time, is taken off each
        component (`frames.motion.baseline`). The name tells by how much the peaks changed.

        Parameters
        ----------
        displacement : bool
            Whether the displacement at the end shall vanish, too. False keeps it free, for records
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
        arrays, change = changes.baseline_corrected(
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
            msg = f"component = {component!r} must be one of {', '.join(given)}, those given"
            raise MotionError(msg)
        data = response_spectrum(given[component], self.dt, periods, damping)
        return data.assign_attrs(motion=self.name, component=component)

    def _with(
        self, arrays: Mapping[str, FloatArray], dt: float | None = None, name: str | None = None
    ) -> GroundMotion:
        """Return a motion with other components, and the same step and name where none is given."""
        x, y, z = (arrays.get(axis) for axis in AXES)
        step = self.dt if dt is None else dt
        return self._made(x, y, z, step, self.name if name is None else name)
