"""Axes of frame objects and areas as SAP2000 and ETABS define them, and directions of loads."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from frames.model.axes import VERTICAL_SINE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray

    Point: TypeAlias = Sequence[float] | FloatArray

_GLOBAL = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "gravity": (0.0, 0.0, -1.0),
    "grav": (0.0, 0.0, -1.0),
}


def frame_axes(start: Point, end: Point, angle: float = 0.0) -> FloatArray:
    """Return the local axes of a frame object or a link.

    Axis 1 runs from i to j; the 1-2 plane is vertical and 2 points up, of a vertical object
    (sine of the angle to Z below 1e-3) 2 is +X; the angle turns 2 and 3 about 1.
    Source: CSI Analysis Reference Manual, "The Frame Element", local coordinate system.

    Shapes: start, end (3,), result (3, 3).
    """
    along = np.subtract(end, start)
    first = along / math.sqrt(along @ along)
    upright = math.hypot(first[0], first[1]) < VERTICAL_SINE
    guide = np.array([1.0, 0.0, 0.0] if upright else [0.0, 0.0, 1.0])
    second = guide - (guide @ first) * first
    second /= math.sqrt(second @ second)
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    third = np.array((b * z - c * y, c * x - a * z, a * y - b * x))
    if angle:
        cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        second, third = cos * second + sin * third, cos * third - sin * second
    return np.stack([first, second, third])


def area_normal(points: FloatArray) -> tuple[FloatArray, float]:
    """Return the unit normal of a plane polygon and its area [m2].

    Shapes: points (n, 3), normal (3,).
    """
    centre = points.mean(axis=0)
    x, y, z = (points - centre).T
    u, v, w = (np.concatenate((each[1:], each[:1])) for each in (x, y, z))
    twice = np.array((y @ w - z @ v, z @ u - x @ w, x @ v - y @ u))
    size = math.sqrt(twice @ twice)
    return (twice / size if size > 0.0 else twice), 0.5 * size


def direction_of(word: str, axes: FloatArray | None) -> tuple[FloatArray, bool] | None:
    """Return the unit vector of a direction of loads, and whether it is per projected length.

    Shapes: axes (3, 3), result (3,).
    """
    text = word.strip().lower()
    projected = "proj" in text
    text = text.replace("projected", "").replace("proj", "").strip(" -")
    if text in _GLOBAL:
        return np.array(_GLOBAL[text]), projected
    if axes is not None and text in {"1", "2", "3", "local-1", "local-2", "local-3"}:
        return axes[int(text[-1]) - 1], projected
    return None


def cardinal_shift(cardinal: int, depth: float, width: float) -> tuple[float, float]:
    """Return where the centroid is from an insertion point of a doubly symmetric section."""
    if not 1 <= cardinal <= 9:
        return 0.0, 0.0
    row, column = divmod(cardinal - 1, 3)
    return 0.5 * depth * (1 - row), 0.5 * width * (column - 1)
