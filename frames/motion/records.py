"""Records as components: samples with their step, PEER AT2 files, steps that components share.

Readers return an `AccelerationTrace` in m/s2 and refuse inconsistent files (a truncated file, an
unknown unit) with a message that names the file, the value and the remedy.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from frames._errors import MotionError
from frames._types import FloatArray
from frames.motion.number_text import (
    NUMBER,
    Writing,
    acceleration_unit,
    rows_of,
    text_lines,
)
from lir_element.argument_checks import require_positive, unreal
from lir_element.units import STANDARD_GRAVITY, meant

PathLike: TypeAlias = str | os.PathLike[str]

_DECIMAL = r"[-+]?\d+,\d+(?:[EeDd][-+]?\d+)?(?![\d.])"
_SIZES = (
    re.compile(rf"NPTS\s*=\s*(\d+)\D*?DT\s*=\s*({_DECIMAL}|{NUMBER})\s*(\w*)", re.IGNORECASE),
    re.compile(
        rf"^\s*(\d+)[\s,]+({NUMBER})[\s,]+()NPTS\b.*\bDT\b",
        re.IGNORECASE,
    ),
)
_SECONDS = {"", "S", "SEC", "SECS", "SECOND", "SECONDS"}

_PARTS = re.compile(r"[\s,;:=()\[\]{}]+")
_RATE = re.compile(r"(?:MM|CM|M|KM|IN|FT)/S.*|G(?:AL|ALS|/10)?", re.IGNORECASE)
_FILLING = {"OF", "ARE", "IS", "IN", "AND", "SEC"}
_UNITS = "G, G/10, CM/S/S, CM/S2, GAL, M/S/S, M/S2, MM/S2"


class AccelerationTrace(NamedTuple):
    """One recorded component."""

    acceleration: FloatArray  # (n,) accelerations [m/s2]
    dt: float  # time step [s]


def read_at2(path: PathLike) -> AccelerationTrace:
    """Read one component from a PEER AT2 file.

    Four header lines, then the values. Line 4 has the number of points and the time step, as
    ``NPTS=  4000, DT=   .0050 SEC`` or as ``4000  0.005  NPTS, DT``. The unit is the one in line 3
    (g, cm/s2, gal, m/s2 or mm/s2), or g, the unit of the format, if it names none. Zeros that fill
    the last line up are left out.
    """
    name = Path(path).name
    lines = text_lines(Path(path))
    sizes = _sizes(lines)
    if sizes is None:
        found = repr(lines[3].strip()) if len(lines) > 3 else f"only {len(lines)} lines"
        msg = (
            f"{name}: line 4 of an AT2 file must read 'NPTS= 4000, DT= .005 SEC' or '4000 "
            f"0.005 NPTS, DT', not {found}: use an AT2 file, or from_columns(x=..., "
            'order="rows", skip=<header lines>, dt=<s>, unit="g")'
        )
        raise MotionError(msg)
    points, step = int(sizes[1]), float(re.sub(r"[Dd]", "E", sizes[2]).replace(",", "."))
    if sizes[3].upper() not in _SECONDS:
        msg = f"{name}: line 4 has DT = {step:g} in {sizes[3]!r}: write it in seconds, DT= .005 SEC"
        raise MotionError(msg)
    values = _numbers(name, lines, 4, points)
    if len(values) > points and not values[points:].any():
        values = values[:points]  # zeros fill the last line up
    if len(values) != points:
        state = "is cut short" if len(values) < points else "holds more than one record"
        msg = (
            f"{name} {state}: {len(values)} values, but the header states NPTS = {points}: "
            "download the file again"
        )
        raise MotionError(msg)
    return AccelerationTrace(values * _at2_unit(name, lines[2]), step)


def is_at2(lines: Sequence[str]) -> bool:
    """Return whether lines begin as a PEER AT2 file does."""
    return _sizes(lines) is not None


def _sizes(lines: Sequence[str]) -> re.Match[str] | None:
    return next((m for p in _SIZES if len(lines) > 3 and (m := p.search(lines[3]))), None)


def at2_traces(
    x: PathLike | None, y: PathLike | None, z: PathLike | None
) -> tuple[dict[str, AccelerationTrace], str]:
    """Read AT2 files, one a component, and name them after the first."""
    files = {axis: path for axis, path in zip(AXES, (x, y, z), strict=True) if path is not None}
    label = Path(next(iter(files.values()))).stem if files else ""
    return {axis: read_at2(path) for axis, path in files.items()}, label


def _at2_unit(name: str, line: str) -> float:
    """Return the factor to m/s2 of the unit in header line 3 (g if it names none)."""
    words = [word.strip(".'\"") for word in _PARTS.split(re.sub(r"\s*/\s*", "/", line)) if word]
    titles = [k for k, word in enumerate(words) if re.fullmatch(r"UNITS?", word, re.IGNORECASE)]
    if titles:
        after = (word for word in words[titles[0] + 1 :] if word.upper() not in _FILLING)
        unit = next(after, "")
    else:
        unit = next((word for word in words if _RATE.fullmatch(word)), "")
    factor = acceleration_unit(unit) if unit else STANDARD_GRAVITY
    other = {"VELOCITY", "DISPLACEMENT"} & {word.upper() for word in words}
    if factor is None or (other and "ACCELERATION" not in (word.upper() for word in words)):
        found = unit or min(other)
        msg = (
            f"{name}: the unit {found!r} in line 3 is not an acceleration ({_UNITS}): use "
            "the file of accelerations"
        )
        raise MotionError(msg)
    return factor


def _numbers(name: str, lines: list[str], first: int, points: int) -> FloatArray:
    """Return all numbers from line `first` on, in reading order; `points` shows if they touch."""
    try:
        return np.array(" ".join(lines[first:]).split(), dtype=np.float64)
    except ValueError:
        numbered = [(k, line) for k, line in enumerate(lines[first:], first + 1) if line.strip()]
    for writing in (Writing(decimal=","), Writing(width=15)):
        with contextlib.suppress(MotionError):  # that of the usual format names the cause below
            found = [value for row in rows_of(name, numbered, writing) for value in row]
            if len(found) >= points:
                return np.array(found, dtype=np.float64)
    every = [value for row in rows_of(name, numbered, Writing()) for value in row]
    return np.array(every, dtype=np.float64)


def common_step(traces: Mapping[str, AccelerationTrace]) -> float:
    """Return the time step that all traces share [s], or raise a MotionError; 1 of none."""
    steps = {axis: trace.dt for axis, trace in traces.items()}
    if steps and max(steps.values()) - min(steps.values()) > 1e-6 * max(steps.values()):
        found = ", ".join(f"{axis} {step:g} s" for axis, step in steps.items())
        msg = f"the time steps of the components differ ({found}): resample them to one dt first"
        raise MotionError(msg)
    return next(iter(steps.values()), 1.0)


AXES = ("x", "y", "z")
"""Names of the components; z points up."""

PAD_SAMPLES, PAD_PART = 20, 0.01
"""Largest difference in length of the components that zeros at the end make up for."""

STRONGEST = 1000.0
"""Peak acceleration that no ground and no shake table has [m/s2]: 100 g."""

SHORTEST_STEP, LONGEST_STEP = 1e-9, 2.0
"""Time step that no motion has [s]."""


def checked_component(axis: str, values: object) -> FloatArray:
    """Return a copy of one component, checked."""
    odd = unreal(values)
    if odd:
        msg = f"{axis} {odd}"
        raise MotionError(msg)
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        msg = f"{axis} must be a 1-D array of accelerations in m/s2 (files: use from_at2): {cause}"
        raise MotionError(msg) from cause
    if array.ndim != 1 or array.size < 2:
        msg = f"{axis} has shape {array.shape}: pass a 1-D array of at least 2 samples in m/s2"
        raise MotionError(msg)
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        msg = f"{axis}[{bad[0]}] = {array[bad[0]]} must be finite: repair the record, in m/s2"
        raise MotionError(msg)
    peak = float(np.abs(array).max())
    if peak > STRONGEST:
        in_g = peak / STANDARD_GRAVITY
        msg = (
            f"{axis} peaks at {peak:.4g} m/s2 = {in_g:.4g} g, above any recorded ground "
            f"motion: {meant(peak, 'm/s2', 0.05, 30.0)}"
        )
        if 0.05 < 0.01 * in_g < 30.0:
            msg += f"; {in_g:.4g} cm/s2 are {0.01 * in_g:.4g} m/s2"
        raise MotionError(msg)
    return array


def checked_step(value: object) -> float:
    """Return a time step [s] that a motion can have, or raise."""
    step = require_positive("dt", value, "s", remedy="give the time step in s", error=MotionError)
    if step > LONGEST_STEP:
        hint = meant(step, "s", 1e-4, 0.1)
        msg = f"dt = {step:g} s is longer than any record's, at most {LONGEST_STEP:g} s: {hint}"
        raise MotionError(msg)
    if step < SHORTEST_STEP:
        hint = meant(step, "s", 1e-4, 0.1)
        msg = f"dt = {step:g} s is shorter than any record's, at least {SHORTEST_STEP:g} s: {hint}"
        raise MotionError(msg)
    return step


def equal_lengths(given: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Fill components that are a little shorter than the longest up with zeros, or raise."""
    longest = max(given, key=lambda axis: len(given[axis]))
    n = len(given[longest])
    limit = max(PAD_SAMPLES, int(PAD_PART * n))
    for axis, values in given.items():
        if n - len(values) > limit:
            msg = (
                f"{axis} has {len(values)} samples and {longest} has {n} (at most {limit} apart): "
                "cut or extend them to one length, or check that they belong together"
            )
            raise MotionError(msg)
    return {axis: np.pad(values, (0, n - len(values))) for axis, values in given.items()}
