"""Ground motions read from files of records; `GroundMotion` adds the other verbs."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np

from frames._errors import MotionWarning
from frames.motion import transforms
from frames.motion.columns import ColumnLayout, Source, column_traces
from frames.motion.motion_data import MotionData
from frames.motion.record_files import record_traces
from frames.motion.records import AXES, AccelerationTrace, PathLike, at2_traces, common_step
from frames.motion.transforms import LEAST_RECORD, corrected, drift_of
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY, meant

if TYPE_CHECKING:
    from frames._types import FloatArray


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
            If the ground still moves at the end of a component, or its time step gives it
            displacements that no ground has. If it was cut in its strong phase or is stronger than
            all recorded motions, or if x and y are one history.
        """
        traces, label = at2_traces(x, y, z)
        return cls.from_traces(traces, label if name is None else name, scale)

    @classmethod
    def from_record(
        cls,
        *paths: PathLike,
        x: str | None = None,
        y: str | None = None,
        z: str | None = None,
        scale: float | Sequence[float] = 1.0,
        name: str | None = None,
    ) -> Self:
        """Read files in the formats of networks (`frames.motion.formats.FORMATS`), and PEER AT2.

        Units, time steps and directions are those of the headers. The mean of K-NET and KiK-net
        records is subtracted, because their numbers are counts about an offset.

        Parameters
        ----------
        *paths : str or path
            The files of one record: one with all components, or one for each.
        x, y, z : str, optional
            Names of directions in the files, such as "90 Deg" or "N-S". By default x and y are the
            horizontal components in the order of the files; z is the vertical one, turned up.
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
            If no file is given, a format is not known, a file cannot be used, a direction is not
            there, or time steps or lengths differ.

        Warns
        -----
        MotionWarning
            As for `from_at2`; and if the samples miss the peak in the header.

        Examples
        --------
        >>> GroundMotion.from_record(
        ...     "AOM0011801241951.EW", "AOM0011801241951.NS", "AOM0011801241951.UD"
        ... )  # doctest: +SKIP
        >>> GroundMotion.from_record("CE89146.V2", x="90 Deg", y="360 Deg")  # doctest: +SKIP
        """
        traces, _ = record_traces(paths, {"x": x, "y": y, "z": z})
        label = Path(paths[0]).stem if name is None else name
        return cls.from_traces(traces, label, scale)

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
        order: str = "columns",
        decimal: str = ".",
        width: int | None = None,
        name: str | None = None,
    ) -> Self:
        """Read text files of numbers (`frames.motion.columns.read_columns`).

        Parameters
        ----------
        path : str or path, optional
            The file that column numbers refer to.
        x, y, z : int, str, path or (path, int), optional
            Source of each component: a column of `path`, counted from 0; a file of its own, with
            one column besides the times; or a file and its column.
        unit : {"g", "m/s2", "cm/s2", "gal", "mm/s2", "g/10"}
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
            Character at the start of a comment.
        delimiter : str, optional
            Separator of the numbers; white space, or semicolons if there are some, if left out.
            With semicolons a comma is the decimal sign.
        order : {"columns", "rows", "pairs"}
            Order of the numbers: a history down each column; one history row by row, several values
            a line; or times and values in turn, several pairs a line. A file of the last two is one
            component, and the latter needs neither `time` nor `dt`.
        decimal : {".", ","}
            The decimal sign.
        width : int, optional
            Characters of each number if they may touch, as in "-9.643590-13.350390" (10).
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
            As for `from_at2`; and if the numbers seem to be in another order.

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
        layout = ColumnLayout(unit, time, dt, skip, comments, delimiter, order, decimal, width)
        traces, label = column_traces(path, x, y, z, layout)
        return cls.from_traces(traces, label if name is None else name, scale)

    @classmethod
    def from_traces(
        cls,
        traces: Mapping[str, AccelerationTrace],
        name: str = "",
        scale: float | Sequence[float] = 1.0,
    ) -> Self:
        """Join components read from files, and check them as records.

        Parameters
        ----------
        traces : mapping of str to AccelerationTrace
            Components [m/s2] with their time step [s] by axis, "x", "y" and "z".
        name : str
            Name of the motion.
        scale : float or sequence of three
            Factor on all components, or one for each [-].

        Returns
        -------
        GroundMotion
            The motion in m/s2.

        Raises
        ------
        MotionError
            If a component cannot be used, or time steps or lengths differ.

        Warns
        -----
        MotionWarning
            As for `from_at2`.
        """
        arrays = {axis: trace.acceleration for axis, trace in traces.items()}
        x, y, z = (arrays.get(axis) for axis in AXES)
        motion = cls._made(x, y, z, common_step(traces), name)
        motion._warn_of_drift(recorded=True)
        for doubt in record_doubts(motion._given(), motion.dt):
            warnings.warn(
                worded("{motion}: {doubt}", motion=name, doubt=doubt), MotionWarning, stacklevel=3
            )
        return motion._with(transforms.scaled(motion._given(), scale))


USUAL_RATIO = (0.02, 0.6)
"""PGV over PGA [s] of records: it grows with the time step."""

LARGEST_DISPLACEMENT = 3.0
"""Displacement of the ground above which the time step is looked at [m]."""

STRONGEST_RECORDED = 4.4 * STANDARD_GRAVITY
"""Largest acceleration that was recorded in an earthquake [m/s2]."""

SAME = 0.9999
"""Correlation of two components from which they are one [-]."""

LEAST_PART = 2.0
"""Duration from which a motion of a file shall end quietly, and x and y differ [s]."""

LAST_PART, LARGEST_END = 0.05, 0.02
"""Part of the duration at the end [-], and the share of the Arias intensity that it may hold."""


def record_doubts(given: Mapping[str, FloatArray], dt: float) -> tuple[str, ...]:
    """Return the unusual properties of a record, a sentence for each; nothing for usual ones."""
    length = (max(len(values) for values in given.values()) - 1) * dt
    flat = {axis: values for axis, values in given.items() if axis != "z" and values.any()}
    found = _of_peak(given)
    if length >= LEAST_RECORD:
        found += _of_step(flat, dt)
    if length >= LEAST_PART:
        found += [*_of_end(flat), *_of_components(flat)]
    return tuple(found)


def _of_peak(given: Mapping[str, FloatArray]) -> list[str]:
    for axis, values in given.items():
        peak = float(np.abs(values).max())
        if peak > STRONGEST_RECORDED:
            return [
                f"{axis} peaks at {peak:.4g} m/s2 = {peak / STANDARD_GRAVITY:.3g} g, above "
                "the strongest known record (4.4 g): check its unit; "
                f"{meant(peak, 'm/s2', 0.05, 30.0)}"
            ]
    return []


def _of_components(flat: Mapping[str, FloatArray]) -> list[str]:
    if len(flat) == 2:
        x, y = (values / np.linalg.norm(values) for values in flat.values())
        if len(x) == len(y) and abs(float(x @ y)) > SAME:
            return [
                "x and y are identical or proportional, so the ground moves along one line: use "
                "the other component of the record, or x alone"
            ]
    return []


def _of_step(flat: Mapping[str, FloatArray], dt: float) -> list[str]:
    for axis, values in flat.items():
        peak = float(np.abs(values).max())
        left = drift_of(corrected(values, dt, displacement=True), dt)  # its baseline has a warning
        ratio = left.peak_velocity / peak
        displaced = left.peak_displacement > LARGEST_DISPLACEMENT
        if USUAL_RATIO[0] <= ratio <= USUAL_RATIO[1] and not displaced:
            continue
        longer = ratio > USUAL_RATIO[0]
        return [
            f"{axis}: PGA {peak:.3g} m/s2, PGV {left.peak_velocity:.3g} m/s, PGD "
            f"{left.peak_displacement:.3g} m; PGV / PGA = {ratio:.2g} s is outside 0.03 to "
            f"0.5 s of records. dt = {dt:g} s is probably too "
            f"{'long' if longer else 'short'}: check it in the record's file"
        ]
    return []


def _of_end(flat: Mapping[str, FloatArray]) -> list[str]:
    for axis, values in flat.items():
        intensity = values**2
        last = max(2, int(LAST_PART * len(values)))
        share = float(intensity[-last:].sum() / intensity.sum())
        if share > LARGEST_END:
            return [
                f"{axis} was probably cut in its strong phase: its last {LAST_PART:.0%} have "
                f"{share:.1%} of the Arias intensity (usual: below 0.3 %), and it ends at "
                f"{abs(values[-1]) / np.abs(values).max():.0%} of its peak. Use the whole record"
            ]
    return []
