"""Axes of objects as SAP2000 and ETABS define them, directions of loads, joints in areas."""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from frames.model.axes import VERTICAL_SINE
from lir_element.elevations import SAME_PLACE, by_elevation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray

    Point: TypeAlias = Sequence[float] | FloatArray
    from collections.abc import Mapping

    from frames.exchange.building import Vector


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


class Levels:
    """Joints by elevation."""

    def __init__(self, places: Mapping[str, Vector]) -> None:
        groups = by_elevation({name: place[2] for name, place in places.items()})
        self._low = [places[names[0]][2] for names in groups]
        self._levels = [(names, np.array([places[n][:2] for n in names])) for names in groups]

    def level(self, z: float) -> int:
        """Return the number of the level at a height [m], -1 if there is none."""
        k = bisect_right(self._low, z) - 1
        if k >= 0 and z - self._low[k] <= SAME_PLACE:
            return k
        near = k + 1 < len(self._low) and self._low[k + 1] - z <= SAME_PLACE
        return k + 1 if near else -1

    def within(self, corners: FloatArray) -> dict[str, FloatArray]:
        """Return the joints inside of a level area and on its edges, and their places in plan.

        Shapes: corners (n, 3), result (2,).
        """
        k = self.level(float(corners[0, 2]))
        if k < 0:
            return {}
        names, places = self._levels[k]
        outline = corners[:, :2]
        low, high = outline.min(axis=0) - SAME_PLACE, outline.max(axis=0) + SAME_PLACE
        near = np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))
        return {names[k]: places[k] for k in near if _within(places[k], outline)}


def _within(place: FloatArray, outline: FloatArray) -> bool:
    # Inside a polygon, or within a millimetre of its edges.
    inside = False
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        way, apart = b - a, place - a
        length = float(np.hypot(*way))
        if length > 0.0:
            along = float(apart @ way) / length
            beside = abs(float(way[0] * apart[1] - way[1] * apart[0])) / length
            if beside <= SAME_PLACE and -SAME_PLACE <= along <= length + SAME_PLACE:
                return True
        if (a[1] > place[1]) != (b[1] > place[1]):
            cut = a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            inside ^= bool(place[0] < cut)
    return inside
