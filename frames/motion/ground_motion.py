"""Ground motions: recorded or made accelerations along x, y and z, in SI units.

A motion is a frozen value: every method that changes something returns a new motion. Between two
samples the acceleration is linear; before the first and after the last one it is zero.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames._types import FloatArray
from frames.motion.baseline import LARGEST_CHANGE, LARGEST_DRIFT, Drift, corrected, drift_of
from frames.motion.components import checked_component, checked_step, equal_lengths
from frames.motion.records import (
    AccelerationTrace,
    ColumnLayout,
    PathLike,
    Source,
    read_at2,
    read_columns,
    source_file,
)
from frames.motion.spectra import response_spectrum
from lir_element.door import require_finite
from lir_element.tables import html_table
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

AXES = ("x", "y", "z")
"""Names of the components; z points up."""

LEAST_RECORD = 8.0
"""Duration from which a file holds a record, not a pulse, and its end is looked at [s]."""


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class GroundMotion:
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

    Examples
    --------
    >>> import numpy as np
    >>> pulse = GroundMotion(x=3.0 * np.sin(np.linspace(0.0, np.pi, 101)), dt=0.01, name="pulse")
    >>> pulse
    GroundMotion 'pulse': 101 samples, dt = 0.01 s, 1 s, peak x 3.000 m/s2
    >>> pulse.scaled(2.0).peak
    {'x': 6.0}
    """

    x: FloatArray | None = None
    y: FloatArray | None = None
    z: FloatArray | None = None
    dt: float = math.nan
    name: str = ""

    def __post_init__(self) -> None:
        """Copy, check and freeze the components.

        Raises
        ------
        MotionError
            If a field is out of its bounds.
        """
        object.__setattr__(self, "dt", checked_step(self.dt))
        given = {
            axis: checked_component(axis, values)
            for axis in AXES
            if (values := getattr(self, axis)) is not None
        }
        if not given:
            msg = "a ground motion needs at least one of x, y and z: give accelerations in m/s2"
            raise MotionError(msg)
        for axis, values in equal_lengths(given).items():
            values.flags.writeable = False
            object.__setattr__(self, axis, values)

    def __reduce__(self) -> tuple[type[GroundMotion], tuple[object, ...]]:
        # copies and pickles are made anew: arrays that are copied one by one can be written to
        return type(self), (self.x, self.y, self.z, self.dt, self.name)

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
        files = {axis: path for axis, path in zip(AXES, (x, y, z), strict=True) if path is not None}
        traces = {axis: read_at2(path) for axis, path in files.items()}
        label = Path(next(iter(files.values()))).stem if files and name is None else name
        return cls._from_traces(traces, label or "").scaled(scale)

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
        sources = {"x": x, "y": y, "z": z}
        files = {
            axis: source_file(axis, source, path)
            for axis, source in sources.items()
            if source is not None
        }
        layout = ColumnLayout(unit, time, dt, skip, comments, delimiter)
        traces = {axis: read_columns(*file, layout) for axis, file in files.items()}
        label = Path(next(iter(files.values()))[0]).stem if files and name is None else name
        return cls._from_traces(traces, label or "").scaled(scale)

    @classmethod
    def _from_traces(cls, traces: dict[str, AccelerationTrace], name: str) -> GroundMotion:
        """Join components that share their time step."""
        steps = {axis: trace.dt for axis, trace in traces.items()}
        if steps and max(steps.values()) - min(steps.values()) > 1e-6 * max(steps.values()):
            found = ", ".join(f"{axis} {step:g} s" for axis, step in steps.items())
            msg = f"the components have unlike time steps ({found}): resample them to one dt first"
            raise MotionError(msg)
        arrays = {axis: trace.acceleration for axis, trace in traces.items()}
        motion = cls(**arrays, dt=next(iter(steps.values()), 1.0), name=name)
        moving = [
            f"{axis}: velocity {left.velocity:.3g} m/s ({left.share:.0%} of its peak), "
            f"displacement {left.displacement:.3g} m"
            for axis, left in motion.drift.items()
            if left.share > LARGEST_DRIFT and motion.duration >= LEAST_RECORD
        ]
        if moving:
            msg = (
                f"{name}: the ground is not at rest at the end of the record, {'; '.join(moving)}. "
                "corrected() takes that out, unless the record was cut"
            )
            warnings.warn(msg, MotionWarning, stacklevel=3)
        return motion

    @property
    def n_steps(self) -> int:
        """Number of samples."""
        return len(next(iter(self._given().values())))

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.n_steps - 1) * self.dt

    @property
    def time(self) -> FloatArray:
        """Times of the samples from 0 on [s], shape (n_steps,)."""
        return np.arange(self.n_steps, dtype=np.float64) * self.dt

    @property
    def peak(self) -> dict[str, float]:
        """Peak ground acceleration of each component that is given [m/s2]."""
        return {axis: float(np.abs(values).max()) for axis, values in self._given().items()}

    @property
    def drift(self) -> dict[str, Drift]:
        """Velocity [m/s] and displacement [m] of the ground at its end, and peaks, by component."""
        return {axis: drift_of(values, self.dt) for axis, values in self._given().items()}

    @property
    def components(self) -> FloatArray:
        """Accelerations along x, y, z [m/s2], shape (n_steps, 3), contiguous; zeros where none."""
        columns = np.zeros((self.n_steps, 3))
        for axis, values in self._given().items():
            columns[:, AXES.index(axis)] = values
        return columns

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
        factors = [factor] * 3 if np.ndim(factor) == 0 else list(np.ravel(factor))
        if len(factors) != 3:
            msg = f"factor has {len(factors)} entries: give one number, or three for x, y and z"
            raise MotionError(msg)
        sizes = [
            require_finite("factor", value, remedy="give a pure number", error=MotionError)
            for value in factors
        ]
        return self._with(
            {axis: sizes[AXES.index(axis)] * values for axis, values in self._given().items()}
        )

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
        turn = require_finite("angle", angle, "rad", error=MotionError)
        cos, sin = math.cos(turn), math.sin(turn)
        east, north, _ = self.components.T
        arrays = {"x": cos * east - sin * north, "y": sin * east + cos * north}
        return self._with(arrays if self.z is None else {**arrays, "z": self.z})

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
        last = self.duration if end is None else require_finite("end", end, "s", error=MotionError)
        near = 1e-6 * self.dt  # a time that is a multiple of dt up to round-off counts as one
        time = self.time
        keep = (time >= require_finite("start", start, "s", error=MotionError) - near) & (
            time <= last + near
        )
        if np.count_nonzero(keep) < 2:
            msg = (
                f"start = {start:g} s, end = {last:g} s keep fewer than 2 samples: give times "
                f"between 0 and {self.duration:g} s, at least {self.dt:g} s apart"
            )
            raise MotionError(msg)
        return self._with({axis: values[keep] for axis, values in self._given().items()})

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
        step = require_finite("dt", dt, "s", error=MotionError)
        if not 0.0 < step <= self.duration:
            msg = (
                f"dt = {step:g} s must be greater than 0 and at most {self.duration:g} s, "
                "the duration: give a time step in s"
            )
            raise MotionError(msg)
        time = np.arange(math.floor(self.duration / step + 1e-6) + 1) * step
        arrays = {axis: np.interp(time, self.time, a) for axis, a in self._given().items()}
        return self._with(arrays, step)

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
        length = require_finite("seconds", seconds, "s", error=MotionError)
        if length < 0.0:
            msg = f"seconds = {length:g} must be at least 0: use trimmed to shorten a motion"
            raise MotionError(msg)
        tail = (0, math.ceil(length / self.dt - 1e-6))
        return self._with({axis: np.pad(a, tail) for axis, a in self._given().items()})

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
        >>> motion = GroundMotion(x=0.01 + np.cos(np.linspace(0.0, 62.8, 2001)), dt=0.01)
        >>> still = motion.corrected()
        >>> round(motion.drift["x"].velocity, 2), abs(still.drift["x"].velocity) < 1e-12
        (0.19, True)
        """
        arrays, largest = {}, 0.0
        for axis, values in self._given().items():
            arrays[axis] = corrected(values, self.dt, displacement=displacement)
            before, after = float(np.abs(values).max()), float(np.abs(arrays[axis]).max())
            change = after / before - 1.0 if before > 0.0 else 0.0
            if abs(change) > LARGEST_CHANGE:
                left = self.drift[axis]
                msg = (
                    f"the correction would change the peak of {axis} by {change:.1%}, at most "
                    f"{LARGEST_CHANGE:.0%}: velocity {left.velocity:.3g} m/s and displacement "
                    f"{left.displacement:.3g} m at the end are no matter of a baseline; use the "
                    "whole record, or corrected(displacement=False)"
                )
                raise MotionError(msg)
            largest = max(largest, change, -change)
        label = f"{self.name or 'motion'} (baseline corrected, peaks within {100 * largest:.2g} %)"
        return GroundMotion(**arrays, dt=self.dt, name=label)

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

    def summary(self) -> str:
        """Return a few lines about the motion, for people.

        Returns
        -------
        str
            Name, samples, peaks of each component, and what is left at its end.
        """
        lines = [self.name or "ground motion"]
        return "\n".join(lines + [f"  {what}: {value}" for what, value in self.facts().items()])

    def facts(self) -> dict[str, str]:
        """Return size, peaks and what is left at the end, in words by name."""
        size = f"{self.n_steps} samples, dt = {self.dt:g} s, duration {self.duration:g} s"
        found = {"motion": size}
        for axis, left in self.drift.items():
            peak = self.peak[axis]
            found[axis] = (
                f"peak {peak:.3f} m/s2 ({peak / STANDARD_GRAVITY:.3f} g), "
                f"{left.peak_velocity:.3f} m/s, {left.peak_displacement:.3f} m; at its end "
                f"{round(left.velocity, 3) + 0.0:.3f} m/s, "
                f"{round(left.displacement, 3) + 0.0:.3f} m"
            )
        return found

    def _repr_html_(self) -> str:
        return html_table(self.name or "ground motion", list(self.facts().items()))

    def __repr__(self) -> str:
        """Name, size and peaks on one line."""
        peaks = ", ".join(f"{axis} {peak:.3f}" for axis, peak in self.peak.items())
        label = f" {self.name!r}" if self.name else ""
        size = f"{self.n_steps} samples, dt = {self.dt:g} s, {self.duration:g} s"
        return f"GroundMotion{label}: {size}, peak {peaks} m/s2"

    def _given(self) -> dict[str, FloatArray]:
        """Return the components that are given, in the order x, y, z."""
        pairs = zip(AXES, (self.x, self.y, self.z), strict=True)
        return {axis: values for axis, values in pairs if values is not None}

    def _with(self, arrays: dict[str, FloatArray], dt: float | None = None) -> GroundMotion:
        """Return a motion of the same name with other components."""
        return GroundMotion(**arrays, dt=self.dt if dt is None else dt, name=self.name)
