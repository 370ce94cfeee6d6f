"""Accelerations from text files of numbers: in columns, row by row, or in pairs."""

from __future__ import annotations

import contextlib
import warnings
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames._types import FloatArray
from frames.motion.number_text import (
    Lines,
    Writing,
    acceleration_unit,
    likely_order,
    rows_of,
    table_of,
    text_lines,
)
from frames.motion.records import AXES, AccelerationTrace, PathLike
from lir_element.argument_checks import require_choice
from lir_element.texts import worded

Source: TypeAlias = int | PathLike | tuple[PathLike, int]
"""Source of a component: a column of the common file, a file, or a column of a file."""

TIME_TOLERANCE = 0.02
"""Tolerance of a printed time from the even grid, over the step [-]: times are rounded, while a
missing sample shifts every later one by a whole step.
"""

UNITS = ("g", "m/s2", "cm/s2", "gal", "mm/s2", "g/10")
"""Units of the accelerations in a file."""

ORDERS = ("columns", "rows", "pairs")
"""Order of the numbers in a file."""


class ColumnLayout(NamedTuple):
    """Layout of a text file of numbers."""

    unit: str  # unit of the accelerations, one of `UNITS`
    time: int | None = None  # column of the times [s], counted from 0; they must be evenly spaced
    dt: float | None = None  # time step [s] of a file without times
    skip: int = 0  # number of header lines that no comment sign marks
    comments: str = "#"
    delimiter: str | None = None  # separator of the numbers; None for white space, or semicolons
    # a history down each column, one history row by row, or times and values in turn
    order: str = "columns"
    decimal: str = "."  # the decimal sign
    width: int | None = None  # characters of each number, of files without separators


def read_columns(path: PathLike, column: int | None, layout: ColumnLayout) -> AccelerationTrace:
    """Read one component from a text file of numbers."""
    name = Path(path).name
    factor = acceleration_unit(layout.unit)
    if factor is None:
        known = ", ".join(UNITS)
        msg = f"unit = {layout.unit!r} must be one of {known}, the unit of the file"
        raise MotionError(msg)
    require_choice("order", layout.order, ORDERS, error=MotionError)
    require_choice("decimal", layout.decimal, (".", ","), error=MotionError)
    if layout.order != "columns":
        return _one_history(name, Path(path), column, layout, factor)
    if (layout.time is None) == (layout.dt is None):
        msg = (
            f"{name}: time = {layout.time} and dt = {layout.dt}: set one of them, the column "
            "of times or the time step in s"
        )
        raise MotionError(msg)
    table = _table(name, Path(path), layout)
    for what, index in (("column", column), ("time", layout.time)):
        if index is not None and not 0 <= index < table.shape[1]:
            msg = (
                f"{name}: {what} = {index} must be at least 0 and below {table.shape[1]}, the "
                "number of columns: count them from 0"
            )
            raise MotionError(msg)
    if column is None:
        column = _only_column(name, table, layout.time)
    _doubt_columns(name, table, layout)
    step = even_step(name, table[:, layout.time]) if layout.dt is None else layout.dt
    return AccelerationTrace(table[:, column] * factor, step)


def _one_history(
    name: str, path: Path, column: int | None, layout: ColumnLayout, factor: float
) -> AccelerationTrace:
    """Return the history of a file row by row, or in pairs of time and value."""
    pairs = layout.order == "pairs"
    wanted = "neither time nor dt" if pairs else "dt and no time"
    if column is not None or layout.time is not None or (layout.dt is None) != pairs:
        msg = (
            f"{name}: order = {layout.order!r} with column = {column}, time = {layout.time}, "
            f"dt = {layout.dt}: the file is one component, pass it alone (x=path) with "
            f"{wanted}"
        )
        raise MotionError(msg)
    lines = _lines(name, path, layout)
    rows = rows_of(name, lines, _writing(layout, lines))
    values = np.array([value for row in rows for value in row], dtype=np.float64)
    if pairs:
        if len(values) % 2:
            msg = (
                f"{name} has {len(values)} numbers, which do not form pairs of time and value: "
                f"check line {lines[-1][0]}, the last, or skip a header (skip=)"
            )
            raise MotionError(msg)
        return AccelerationTrace(values[1::2] * factor, even_step(name, values[::2]))
    _doubt_rows(name, rows)
    return AccelerationTrace(values * factor, float(layout.dt or 0.0))


def source_file(axis: str, source: Source, common: PathLike | None) -> tuple[PathLike, int | None]:
    """Return file and column of one component; the column is None if only a file is named."""
    if isinstance(source, tuple):
        return source
    if not isinstance(source, int):
        return source, None
    if common is None:
        msg = f"{axis} = {source} is a column, but no file is given: set path"
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


def _writing(layout: ColumnLayout, lines: Lines) -> Writing:
    """Return the notation of numbers: commas may be decimal if semicolons separate them."""
    comma = layout.delimiter == ";" or (layout.delimiter is None and ";" in lines[0][1])
    return Writing(layout.delimiter, "," if comma else layout.decimal, layout.width)


def _lines(name: str, path: Path, layout: ColumnLayout) -> Lines:
    """Return the numbered lines of a file that hold numbers."""
    every = list(enumerate(text_lines(path), start=1))[layout.skip :]
    cut = [(k, line.split(layout.comments)[0] if layout.comments else line) for k, line in every]
    lines = [(k, line) for k, line in cut if line.strip()]
    if not lines:
        msg = (
            f"{name} holds no values after {layout.skip} skipped lines and the comments "
            f"({layout.comments!r}): give a file of numbers, or a smaller skip"
        )
        raise MotionError(msg)
    return lines


def _table(name: str, path: Path, layout: ColumnLayout) -> FloatArray:
    """Return the numbers of a text file as a table (rows, columns)."""
    lines = _lines(name, path, layout)
    writing = _writing(layout, lines)
    if writing.width is None and writing.decimal == ".":
        with contextlib.suppress(ValueError):  # table_of names the cause, or reads an exponent D
            rows = [line for _, line in lines]
            return np.loadtxt(rows, dtype=np.float64, ndmin=2, delimiter=layout.delimiter)
    return table_of(name, lines, writing)


def _only_column(name: str, table: FloatArray, time: int | None) -> int:
    """Return the only column that does not hold the times."""
    others = [index for index in range(table.shape[1]) if index != time]
    if len(others) == 1:
        return others[0]
    if not others:
        msg = f"{name} has 1 column for times and accelerations: set dt in s, in place of time"
        raise MotionError(msg)
    told = ""
    if time is None:
        seem = "the numbers seem to be" if likely_order(table) == "rows" else "if they are"
        told = f'; {seem} one history, row by row, use order="rows"'
    msg = (
        f"{name} has {table.shape[1]} columns: name the one with the accelerations, (path, "
        f"column), or in a table of motions file, x and no dt if column 0 holds times{told}"
    )
    raise MotionError(msg)


def _doubt_columns(name: str, table: FloatArray, layout: ColumnLayout) -> None:
    """Refuse pairs of time and value that were read as columns, and warn of one history."""
    if layout.time is not None:
        times = table[:, layout.time]
        step = float(times[-1] - times[0]) / max(len(times) - 1, 1)
        later = table - times[:, None]
        spread, start = np.ptp(later, axis=0), later[0]
        again = (spread < TIME_TOLERANCE * step) & (start > 0.1 * step) & (start < 0.95 * step)
        if again.any():
            msg = (
                f"{name}: column {int(np.argmax(again))} has times between those of column "
                f"{layout.time}, so each line has several pairs of time and value: use "
                'order="pairs", without time'
            )
            raise MotionError(msg)
    others = np.delete(table, [] if layout.time is None else [layout.time], axis=1)
    if likely_order(others) != "rows":
        return
    remedy = 'order="rows"' if layout.time is None else 'order="rows" and a file without its times'
    msg = worded(
        "{name}: rows seem to continue one history, so that a column is only every "
        "{count}th sample: read it with {remedy}",
        name=name,
        count=others.shape[1],
        remedy=remedy,
    )
    warnings.warn(msg, MotionWarning, stacklevel=5)


def _doubt_rows(name: str, rows: list[list[float]]) -> None:
    """Refuse a table with times that was read as rows, and warn of columns."""
    size = len(rows[0])
    if size < 2 or len(rows) < 3 or any(len(row) != size for row in rows[:-1]):
        return
    table = np.array(rows[:-1])
    steps = np.diff(table[:, 0])
    if (steps > 0.0).all() and np.ptp(steps) < TIME_TOLERANCE * steps.mean():
        msg = (
            f"{name}: column 0 holds even times, {table[0, 0]:g}, {table[1, 0]:g}, ..., so "
            'it is a table: use order="columns", time=0 and the columns of the components'
        )
        raise MotionError(msg)
    if likely_order(table) == "columns":
        msg = worded(
            "{name}: the {size} numbers in a row seem to be {size} components: read one "
            'column with order="columns"',
            name=name,
            size=size,
        )
        warnings.warn(msg, MotionWarning, stacklevel=6)


def even_step(name: str, times: FloatArray) -> float:
    """Return the step of evenly spaced times."""
    step = float(times[-1] - times[0]) / max(len(times) - 1, 1)
    off = np.abs(times - times[0] - step * np.arange(len(times)))
    worst = int(np.argmax(off))
    if not step > 0.0 or not off[worst] <= TIME_TOLERANCE * step:
        msg = (
            f"{name}: the time step is not constant: sample {worst} at t = {times[worst]:g} "
            f"s is {off[worst]:.3g} s off a step of {step:.6g} s (at most "
            f"{TIME_TOLERANCE:.0%} of it). Resample the record, or check the column of times"
        )
        raise MotionError(msg)
    return float(f"{step:.9g}")  # the digits that printed times carry
