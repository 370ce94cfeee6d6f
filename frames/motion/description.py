"""A ground motion in words: its size, its peaks, and what is left at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.motion.baseline import drift_of
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray


def facts_of(given: Mapping[str, FloatArray], dt: float) -> dict[str, str]:
    """Return facts about components by axis [m/s2], in words by name."""
    count = len(next(iter(given.values())))
    found = {"motion": f"{count} samples, dt = {dt:g} s, duration {(count - 1) * dt:g} s"}
    for axis, values in given.items():
        left, peak = drift_of(values, dt), float(np.abs(values).max())
        found[axis] = (
            f"peak {peak:.3f} m/s2 ({peak / STANDARD_GRAVITY:.3f} g), "
            f"{left.peak_velocity:.3f} m/s, {left.peak_displacement:.3f} m; at its end "
            f"{round(left.velocity, 3) + 0.0:.3f} m/s, "
            f"{round(left.displacement, 3) + 0.0:.3f} m"
        )
    return found
