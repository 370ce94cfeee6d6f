"""Checks of ground motions at the door: every error names the value, the bound and the remedy."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, SupportsFloat

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray

PAD_SAMPLES, PAD_PART = 20, 0.01
"""Largest difference in length of the components that zeros at the end make up for."""


class MotionError(ValueError):
    """A ground motion, or a file of one, that cannot be used; the message names the culprit."""


def number(name: str, value: object, meaning: str) -> float:
    """Return a finite number, or raise."""
    if isinstance(value, bool) or not isinstance(value, SupportsFloat):
        msg = f"{name} = {value!r} must be a number: give {meaning}"
        raise MotionError(msg)
    result = float(value)
    if not math.isfinite(result):
        msg = f"{name} = {result:g} must be finite: give {meaning}"
        raise MotionError(msg)
    return result


def checked_component(axis: str, values: object) -> FloatArray:
    """Return a copy of one component, checked."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        msg = f"{axis} must be a 1-D array of accelerations in m/s2 (files: use from_at2): {cause}"
        raise MotionError(msg) from cause
    if array.ndim != 1 or array.size < 2:
        msg = f"{axis} has shape {array.shape}: give a 1-D array of at least 2 samples in m/s2"
        raise MotionError(msg)
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        msg = f"{axis}[{bad[0]}] = {array[bad[0]]} must be finite: repair the record, in m/s2"
        raise MotionError(msg)
    return array


def equal_lengths(given: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Fill components that are a little shorter than the longest up with zeros, or raise."""
    longest = max(given, key=lambda axis: len(given[axis]))
    n = len(given[longest])
    limit = max(PAD_SAMPLES, int(PAD_PART * n))
    for axis, values in given.items():
        if n - len(values) > limit:
            msg = (
                f"{axis} has {len(values)} samples and {longest} has {n}: they may differ by at "
                f"most {limit}; cut or fill them to one length, or check that they belong together"
            )
            raise MotionError(msg)
    return {axis: np.pad(values, (0, n - len(values))) for axis, values in given.items()}
