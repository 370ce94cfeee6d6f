"""Components of a ground motion: what each must be, their time step, and their common length."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from lir_element.argument_checks import require_positive, unreal
from lir_element.units import STANDARD_GRAVITY, meant

if TYPE_CHECKING:
    from frames._types import FloatArray

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
        msg = f"{axis} has shape {array.shape}: give a 1-D array of at least 2 samples in m/s2"
        raise MotionError(msg)
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        msg = f"{axis}[{bad[0]}] = {array[bad[0]]} must be finite: repair the record, in m/s2"
        raise MotionError(msg)
    peak = float(np.abs(array).max())
    if peak > STRONGEST:
        in_g = peak / STANDARD_GRAVITY
        msg = (
            f"{axis} peaks at {peak:.4g} m/s2 = {in_g:.4g} g, no ground shakes like that: "
            f"{meant(peak, 'm/s2', 0.05, 30.0)}"
        )
        if 0.05 < 0.01 * in_g < 30.0:
            msg += f"; {in_g:.4g} cm/s2 taken for g are {0.01 * in_g:.4g} m/s2"
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
                f"{axis} has {len(values)} samples and {longest} has {n}: they may differ by at "
                f"most {limit}; cut or fill them to one length, or check that they belong together"
            )
            raise MotionError(msg)
    return {axis: np.pad(values, (0, n - len(values))) for axis, values in given.items()}
