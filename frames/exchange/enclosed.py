"""Which joints of its level an area encloses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray
    from frames.exchange.building import Vector

FLAT = 1e-3
"""Within what heights are one level, and what lies on an edge [m]."""


def level_of(z: float) -> int:
    """Return the number of the level at a height [m]."""
    return round(z / FLAT)


class Levels:
    """Joints by level.

    Parameters
    ----------
    places : mapping of str to (float, float, float)
        Joints [m].
    """

    def __init__(self, places: Mapping[str, Vector]) -> None:
        by_level: dict[int, list[str]] = {}
        for name, place in places.items():
            by_level.setdefault(level_of(place[2]), []).append(name)
        self._levels = {
            level: (names, np.array([places[name][:2] for name in names]))
            for level, names in by_level.items()
        }

    def within(self, corners: FloatArray) -> dict[str, FloatArray]:
        """Return the joints inside of a level area and on its edges, and their places in plan.

        Shapes: corners (n, 3), result (2,).
        """
        names, places = self._levels.get(level_of(float(corners[0, 2])), ([], np.zeros((0, 2))))
        outline = corners[:, :2]
        low, high = outline.min(axis=0) - FLAT, outline.max(axis=0) + FLAT
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
            if beside <= FLAT and -FLAT <= along <= length + FLAT:
                return True
        if (a[1] > place[1]) != (b[1] > place[1]):
            cut = a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            inside ^= bool(place[0] < cut)
    return inside
