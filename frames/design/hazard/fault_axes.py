"""Motions turned to the axes of a fault: normal and parallel to its strike."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from frames._errors import MotionError

if TYPE_CHECKING:
    from frames.motion.ground_motion import GroundMotion


def angle_of(name: str, known: Mapping[str, object], key: str) -> float:
    """Return an azimuth among the facts [degrees], or raise a MotionError."""
    value = known.get(key)
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        msg = (
            f"{name}: {key} = {value!r}: give it in degrees clockwise from north, among the "
            f"facts of the set or in the column {key} of motions.csv"
        )
        raise MotionError(msg)
    return float(value)


def to_fault(name: str, motion: GroundMotion, known: Mapping[str, object]) -> GroundMotion:
    """Return a motion with x fault-normal (strike + 90 degrees) and y fault-parallel."""
    strike, x, y = (angle_of(name, known, key) for key in ("strike", "azimuth_x", "azimuth_y"))
    apart = (y - x) % 360.0
    if min(abs(apart - 90.0), abs(apart - 270.0)) > 1.0:
        msg = f"{name}: azimuth_x = {x:g} and azimuth_y = {y:g} must be 90 degrees apart"
        raise MotionError(msg)
    # seen from above, y must lie to the left of x; azimuths grow to the right
    left = motion if abs(apart - 270.0) <= 1.0 else motion.scaled((1.0, -1.0, 1.0))
    return left.rotated(math.radians(strike + 90.0 - x))
