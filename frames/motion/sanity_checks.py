"""Whether a component of a record can be one: its peak, its time step, its end, its partner.

The bounds stand well outside what records measure. Of the 100 components of FEMA P695, PGV / PGA is
0.03 to 0.47 s, PGD at most 2.4 m, and the last twentieth of the duration holds at most 0.3 % of the
Arias intensity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.motion.baseline import LEAST_RECORD, corrected, drift_of
from lir_element.units import STANDARD_GRAVITY, meant

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray

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
    """Return what is strange about a record, a sentence for each thing; nothing for usual ones."""
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
                f"{axis} peaks at {peak:.4g} m/s2 = {peak / STANDARD_GRAVITY:.3g} g, the strongest "
                "record known has some 4.4 g: its unit is probably another; "
                f"{meant(peak, 'm/s2', 0.05, 30.0)}"
            ]
    return []


def _of_components(flat: Mapping[str, FloatArray]) -> list[str]:
    if len(flat) == 2:
        x, y = (values / np.linalg.norm(values) for values in flat.values())
        if len(x) == len(y) and abs(float(x @ y)) > SAME:
            return [
                "x and y are one history, or proportional: the ground moves along one line, in "
                "directions between them more than in either; give the other component of the "
                "record, or x alone"
            ]
    return []


def _of_step(flat: Mapping[str, FloatArray], dt: float) -> list[str]:
    for axis, values in flat.items():
        peak = float(np.abs(values).max())
        left = drift_of(corrected(values, dt, displacement=True), dt)  # its baseline is told of
        ratio = left.peak_velocity / peak
        displaced = left.peak_displacement > LARGEST_DISPLACEMENT
        if USUAL_RATIO[0] <= ratio <= USUAL_RATIO[1] and not displaced:
            continue
        longer = ratio > USUAL_RATIO[0]
        return [
            f"{axis}: PGA {peak:.3g} m/s2, PGV {left.peak_velocity:.3g} m/s, PGD "
            f"{left.peak_displacement:.3g} m; PGV / PGA = {ratio:.2g} s, of records 0.03 to 0.5 s: "
            f"dt = {dt:g} s is probably too {'long' if longer else 'short'} (periods go with dt, "
            "displacements with its square): look it up in the record's file"
        ]
    return []


def _of_end(flat: Mapping[str, FloatArray]) -> list[str]:
    for axis, values in flat.items():
        intensity = values**2
        last = max(2, int(LAST_PART * len(values)))
        share = float(intensity[-last:].sum() / intensity.sum())
        if share > LARGEST_END:
            return [
                f"{axis}: the last {LAST_PART:.0%} of its duration hold {share:.1%} of its Arias "
                f"intensity, of whole records below 0.3 %, and it ends at "
                f"{abs(values[-1]) / np.abs(values).max():.0%} of its peak: it was probably cut in "
                "its strong phase; give the whole record, or displacements may come out too small"
            ]
    return []
