"""Kernel that reads sampled signals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats


@kernel
def ground_acceleration(motion: Floats, motion_dt: float, time: float, axis: int) -> float:
    """Return the ground acceleration along `axis`, linear between samples, zero outside."""
    position = time / motion_dt
    first = math.floor(position)
    if first < 0 or first >= motion.shape[0] - 1:
        if first == motion.shape[0] - 1 and position - first < 1e-9:
            return motion[first, axis]
        return 0.0
    share = position - first
    return (1.0 - share) * motion[first, axis] + share * motion[first + 1, axis]
