"""Joints within shells, and where a mesh has to be cut to meet them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from frames.exchange.stations import ON_LINE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.exchange.building import AreaObject
    from frames.exchange.stations import Points

Inside = dict[str, dict[str, tuple[float, float]]]
"""Joints within each area, by its name: shares along its first and along its last edge [-]."""

_STEPS = 30


def joints_within(areas: Sequence[AreaObject], points: Points) -> Inside:
    """Return the joints that lie within areas, not on their edges."""
    names = list(points)
    where = np.array([points[name] for name in names]).reshape(-1, 3)
    tree = cKDTree(where)
    found: Inside = {}
    for area in areas:
        corners = np.array([points[name] for name in area.joints])
        centre = corners.mean(axis=0)
        low, high = corners.min(axis=0) - ON_LINE, corners.max(axis=0) + ON_LINE
        reach = float(np.linalg.norm(corners - centre, axis=1).max())
        for k in tree.query_ball_point(centre, reach):
            outside = (where[k] < low) | (where[k] > high)
            if names[k] in area.joints or outside.any():
                continue
            shares = _shares_of(corners, where[k])
            if shares is not None:
                found.setdefault(area.name, {})[names[k]] = shares
    return found


def _shares_of(corners: FloatArray, place: FloatArray) -> tuple[float, float] | None:
    # By Newton on the bilinear surface of four corners; None off the area or on its edges.
    a, b, d = corners[0], corners[1], corners[-1]
    twist = corners[2] - b - d + a if len(corners) == 4 else np.zeros(3)
    u = v = 0.5
    for _ in range(_STEPS):
        off = a + u * (b - a) + v * (d - a) + u * v * twist - place
        along, across = b - a + v * twist, d - a + u * twist
        matrix = np.stack([along, across], axis=1)
        step = np.linalg.lstsq(matrix, -off, rcond=None)[0]
        u, v = u + float(step[0]), v + float(step[1])
        if abs(u) > 1e3 or abs(v) > 1e3:
            return None
        if float(np.abs(step).max()) < 1e-12:
            break
    off = a + u * (b - a) + v * (d - a) + u * v * twist - place
    if float(np.linalg.norm(off)) > ON_LINE:
        return None
    wide = min(float(np.linalg.norm(side)) for side in (b - a + v * twist, d - a + u * twist))
    least = ON_LINE / wide
    if len(corners) == 3:
        return (u, v) if min(u, v) > least and u + v < 1.0 - least else None
    return (u, v) if least < u < 1.0 - least and least < v < 1.0 - least else None
