"""Which points are at one place, and which at one elevation."""

from __future__ import annotations

from collections.abc import Mapping

SAME_PLACE = 1e-3
"""Distance up to which points count as at one place, and heights as one elevation [m]."""


def by_elevation(heights: Mapping[str, float]) -> list[list[str]]:
    """Return names by their heights [m], from below: a group begins above the last one's lowest."""
    groups: list[list[str]] = []
    low = float("-inf")
    for name in sorted(heights, key=lambda name: heights[name]):
        if heights[name] - low > SAME_PLACE:
            groups.append([])
            low = heights[name]
        groups[-1].append(name)
    return groups
