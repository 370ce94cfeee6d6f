"""Ground motions read from files of records; `GroundMotion` adds the other verbs."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from frames._errors import MotionWarning
from frames.motion import transforms
from frames.motion.components import AXES
from frames.motion.motion_data import MotionData
from frames.motion.records import (
    AccelerationTrace,
    ColumnLayout,
    PathLike,
    Source,
    at2_traces,
    column_traces,
    common_step,
)
from frames.motion.sanity_checks import record_doubts


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class RecordedMotion(MotionData):
    """Accelerations of the ground that files hold; parameters as in `GroundMotion`."""

    @classmethod
    def from_at2(
        cls,
        x: PathLike | None = None,
        y: PathLike | None = None,
        z: PathLike | None = None,
        scale: float | Sequence[float] = 1.0,
        name: str | None = None,
    ) -> Self:
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
            If the ground still moves at the end of a component, its time step gives it
            displacements that no ground has, or it was cut in its strong phase.
        """
        traces, label = at2_traces(x, y, z)
        return cls._from_traces(traces, label if name is None else name, scale)

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
    ) -> Self:
        """Read columns of text files (`frames.motion.records.read_columns`).

        Parameters
        ----------
        path : str or path, optional
            The file that column numbers refer to.
        x, y, z : int, str, path or (path, int), optional
            Where each component is: a column of `path`, counted from 0; a file of its own, with
            one column besides the times; or a file and its column.
        unit : {"g", "m/s2", "cm/s2", "gal"}
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
            If the ground still moves at the end of a component, its time step gives it
            displacements that no ground has, or it was cut in its strong phase.

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
        return cls._from_traces(traces, label if name is None else name, scale)

    @classmethod
    def _from_traces(
        cls, traces: dict[str, AccelerationTrace], name: str, scale: float | Sequence[float]
    ) -> Self:
        """Join components that share their time step, and scale them."""
        arrays = {axis: trace.acceleration for axis, trace in traces.items()}
        x, y, z = (arrays.get(axis) for axis in AXES)
        motion = cls._made(x, y, z, common_step(traces), name)
        motion._warn_of_drift(recorded=True)
        for doubt in record_doubts(arrays, motion.dt):
            warnings.warn(f"{name}: {doubt}", MotionWarning, stacklevel=3)
        return motion._with(transforms.scaled(motion._given(), scale))
