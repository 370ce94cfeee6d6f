"""Readers of recorded accelerations: PEER AT2 files and plain columns of text, into SI units.

Both readers return an `AccelerationTrace` in m/s2 and refuse what does not add up (a truncated
file, an unknown unit, an uneven time column) with a message that names the file, the value and
the remedy.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from frames._errors import MotionError
from frames._types import FloatArray
from frames.motion.components import AXES
from lir_element.units import STANDARD_GRAVITY

PathLike: TypeAlias = str | os.PathLike[str]

Source: TypeAlias = int | PathLike | tuple[PathLike, int]
"""Where a component is: a column of the common file, a file, or a column of a file."""

TIME_TOLERANCE = 0.02
"""How far a printed time may lie off the even grid, as a part of the step [-]: times are rounded,
while a sample that is missing puts every later one off by a whole step."""

UNITS = {"g": STANDARD_GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "gal": 0.01}
"""Units that `read_columns` accepts, and what one of them is in m/s2."""

_AT2_UNITS = {
    "G": STANDARD_GRAVITY,
    "CM/S/S": 0.01,
    "CM/SEC/SEC": 0.01,
    "CM/S2": 0.01,
    "CM/S**2": 0.01,
    "CM/S^2": 0.01,
    "GAL": 0.01,
    "M/S/S": 1.0,
    "M/S2": 1.0,
}
_UNIT = re.compile(r"\bUNITS?\b(?:\s+OF)?[\s:=]*([A-Z][A-Z0-9/*^]*)", re.IGNORECASE)
_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?)"
_SIZES = (
    re.compile(rf"NPTS\s*=\s*(\d+)\D*?DT\s*=\s*{_NUMBER}", re.IGNORECASE),
    re.compile(rf"^\s*(\d+)[\s,]+{_NUMBER}[\s,]+NPTS\b.*\bDT\b", re.IGNORECASE),
)


class AccelerationTrace(NamedTuple):
    """One recorded component.

    Attributes
    ----------
    acceleration : ndarray, shape (n,)
        Accelerations [m/s2].
    dt : float
        Time step [s].
    """

    acceleration: FloatArray
    dt: float


def read_at2(path: PathLike) -> AccelerationTrace:
    """Read one component from a PEER AT2 file.

    Four header lines, then the values. Line 4 holds the number of points and the time step, as
    ``NPTS=  4000, DT=   .0050 SEC`` or as ``4000  0.005  NPTS, DT``. The unit is the one that
    line 3 names (g, cm/s2 or m/s2), and g, the unit of the format, where it names none.

    Parameters
    ----------
    path : str or path
        The file.

    Returns
    -------
    AccelerationTrace
        Accelerations [m/s2] and time step [s].

    Raises
    ------
    MotionError
        If the header has no sizes, the unit is not an acceleration's, a value is not a number, or
        the file holds fewer or more values than its header says.
    """
    name = Path(path).name
    lines = Path(path).read_text(encoding="latin-1").splitlines()
    sizes = next((m for p in _SIZES if len(lines) > 3 and (m := p.search(lines[3]))), None)
    if sizes is None:
        found = repr(lines[3].strip()) if len(lines) > 3 else f"only {len(lines)} lines"
        msg = (
            f"{name}: line 4 of an AT2 file reads 'NPTS= 4000, DT= .005 SEC' or '4000 0.005 NPTS, "
            f"DT', this one has {found}: give an AT2 file, or read it with from_columns"
        )
        raise MotionError(msg)
    points, step = int(sizes[1]), float(sizes[2].upper().replace("D", "E"))
    values = _numbers(name, lines, 4)
    if len(values) != points:
        state = "is cut short" if len(values) < points else "holds more than one record"
        msg = (
            f"{name} {state}: {len(values)} values, and its header says NPTS = {points}; "
            "fetch the file again"
        )
        raise MotionError(msg)
    return AccelerationTrace(values * _at2_unit(name, lines[2]), step)


def at2_traces(
    x: PathLike | None, y: PathLike | None, z: PathLike | None
) -> tuple[dict[str, AccelerationTrace], str]:
    """Read AT2 files, one a component, and name them after the first."""
    files = {axis: path for axis, path in zip(AXES, (x, y, z), strict=True) if path is not None}
    label = Path(next(iter(files.values()))).stem if files else ""
    return {axis: read_at2(path) for axis, path in files.items()}, label


def _at2_unit(name: str, line: str) -> float:
    """Return the factor to m/s2 of the unit that header line 3 names (g where it names none)."""
    found = _UNIT.search(line)
    if found is None:
        return STANDARD_GRAVITY
    unit = found[1].upper()
    if unit not in _AT2_UNITS:
        msg = (
            f"{name}: the unit {unit!r} in line 3 is not an acceleration's, one of "
            f"{', '.join(_AT2_UNITS)}: give the file with the accelerations"
        )
        raise MotionError(msg)
    return _AT2_UNITS[unit]


def _numbers(name: str, lines: list[str], first: int) -> FloatArray:
    """Return all numbers from line `first` on, in reading order."""
    try:
        return np.array(" ".join(lines[first:]).split(), dtype=np.float64)
    except ValueError:
        for number, line in enumerate(lines[first:], first + 1):
            for word in line.split():
                try:
                    float(word)
                except ValueError as cause:
                    msg = f"{name}, line {number}: {word!r} is not a number: repair the line"
                    raise MotionError(msg) from cause
        raise


class ColumnLayout(NamedTuple):
    """How the columns of a text file are written.

    Attributes
    ----------
    unit : {"g", "m/s2", "cm/s2", "gal"}
        Unit of the accelerations.
    time : int or None
        Column of the times [s], counted from 0; they must be evenly spaced.
    dt : float or None
        Time step [s] of a file without times.
    skip : int
        Number of header lines that no comment sign marks.
    comments : str
        What starts a comment.
    delimiter : str or None
        What separates the columns; None for white space.
    """

    unit: str
    time: int | None = None
    dt: float | None = None
    skip: int = 0
    comments: str = "#"
    delimiter: str | None = None


def read_columns(path: PathLike, column: int | None, layout: ColumnLayout) -> AccelerationTrace:
    """Read one component from a column of a text file.

    Parameters
    ----------
    path : str or path
        The file.
    column : int or None
        Column of the accelerations, counted from 0; None for the only one besides the times.
    layout : ColumnLayout
        How the file is written.

    Returns
    -------
    AccelerationTrace
        Accelerations [m/s2] and time step [s].

    Raises
    ------
    MotionError
        If the unit is unknown, a column is missing or unclear, an entry is not a number, or the
        times are uneven or missing.
    """
    name = Path(path).name
    if layout.unit not in UNITS:
        known = ", ".join(UNITS)
        msg = f"unit = {layout.unit!r} must be one of {known}: say in what the file is written"
        raise MotionError(msg)
    if (layout.time is None) == (layout.dt is None):
        msg = (
            f"{name}: time = {layout.time} and dt = {layout.dt}: give one of them, the column of "
            "the times or the time step in s"
        )
        raise MotionError(msg)
    table = _table(name, Path(path), layout)
    if column is None:
        column = _only_column(name, table.shape[1], layout.time)
    for what, index in (("column", column), ("time", layout.time)):
        if index is not None and not 0 <= index < table.shape[1]:
            msg = (
                f"{name}: {what} = {index} must be at least 0 and below {table.shape[1]}, the "
                "number of columns: they are counted from 0"
            )
            raise MotionError(msg)
    step = _even_step(name, table[:, layout.time]) if layout.dt is None else layout.dt
    return AccelerationTrace(table[:, column] * UNITS[layout.unit], step)


def source_file(axis: str, source: Source, common: PathLike | None) -> tuple[PathLike, int | None]:
    """Return file and column of one component; the column is None where only a file is named."""
    if isinstance(source, tuple):
        return source
    if not isinstance(source, int):
        return source, None
    if common is None:
        msg = f"{axis} = {source} is a column of no file: give the file as path"
        raise MotionError(msg)
    return common, source


def column_traces(
    common: PathLike | None,
    x: Source | None,
    y: Source | None,
    z: Source | None,
    layout: ColumnLayout,
) -> tuple[dict[str, AccelerationTrace], str]:
    """Read columns of text files, one a component, and name them after the first file."""
    sources = zip(AXES, (x, y, z), strict=True)
    files = {axis: source_file(axis, at, common) for axis, at in sources if at is not None}
    label = Path(next(iter(files.values()))[0]).stem if files else ""
    return {axis: read_columns(*file, layout) for axis, file in files.items()}, label


def common_step(traces: Mapping[str, AccelerationTrace]) -> float:
    """Return the time step that all traces share [s], or raise a MotionError; 1 of none."""
    steps = {axis: trace.dt for axis, trace in traces.items()}
    if steps and max(steps.values()) - min(steps.values()) > 1e-6 * max(steps.values()):
        found = ", ".join(f"{axis} {step:g} s" for axis, step in steps.items())
        msg = f"the components have unlike time steps ({found}): resample them to one dt first"
        raise MotionError(msg)
    return next(iter(steps.values()), 1.0)


def _table(name: str, path: Path, layout: ColumnLayout) -> FloatArray:
    """Return the numbers of a text file as a table (rows, columns)."""
    lines = path.read_text(encoding="latin-1").splitlines()[layout.skip :]
    rows = [line for line in (row.split(layout.comments)[0] for row in lines) if line.strip()]
    if not rows:
        msg = (
            f"{name} holds no values after {layout.skip} skipped lines and the comments "
            f"({layout.comments!r}): give a file of numbers, or a smaller skip"
        )
        raise MotionError(msg)
    try:
        return np.loadtxt(rows, dtype=np.float64, ndmin=2, delimiter=layout.delimiter)
    except ValueError as cause:
        msg = (
            f"{name} is not a table of numbers ({cause}; rows counted without header): "
            "skip its header with skip=, or name the delimiter"
        )
        raise MotionError(msg) from cause


def _only_column(name: str, columns: int, time: int | None) -> int:
    """Return the only column that does not hold the times."""
    others = [index for index in range(columns) if index != time]
    if len(others) != 1:
        msg = f"{name} has {columns} columns: say which one holds the accelerations, (path, column)"
        raise MotionError(msg)
    return others[0]


def _even_step(name: str, times: FloatArray) -> float:
    """Return the step of evenly spaced times."""
    step = float(times[-1] - times[0]) / max(len(times) - 1, 1)
    off = np.abs(times - times[0] - step * np.arange(len(times)))
    worst = int(np.argmax(off))
    if not step > 0.0 or not off[worst] <= TIME_TOLERANCE * step:
        msg = (
            f"{name}: the times are not evenly spaced: sample {worst} at t = {times[worst]:g} s "
            f"lies {off[worst]:.3g} s off a step of {step:.6g} s (at most "
            f"{TIME_TOLERANCE:.0%} of the step): resample the record, or name the column of times"
        )
        raise MotionError(msg)
    return float(f"{step:.9g}")  # the digits that printed times carry
