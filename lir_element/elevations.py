"""Groups of points at one place, and of points at one elevation."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TypeVar

K = TypeVar("K", bound=Hashable)

SAME_PLACE = 1e-3
"""Distance up to which points count as at one place, and heights as one elevation [m]."""


def by_elevation(heights: Mapping[K, float]) -> list[list[K]]:
    """Return names by their heights [m], from below; no group is higher than `SAME_PLACE`."""
    groups: list[list[K]] = []
    low = float("-inf")
    for name in sorted(heights, key=lambda name: heights[name]):
        if heights[name] - low > SAME_PLACE:
            groups.append([])
            low = heights[name]
        groups[-1].append(name)
    return groups
