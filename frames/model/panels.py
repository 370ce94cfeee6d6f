"""How floor panels carry: load on their edges, from the outline in plan.

A load on an edge is a list of pieces (s0, h0, s1, h1): from s0 to s1 [m] along the edge it goes
linearly from h0 to h1 [m], metres of the panel's depth that the edge carries at this place.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from frames._errors import ModelError

if TYPE_CHECKING:
    from frames._types import FloatArray

Span: TypeAlias = str | Sequence[float]
"""Direction of a one-way panel in plan: "x", "y" or a vector."""

Piece: TypeAlias = tuple[float, float, float, float]
"""From s0 with h0 to s1 with h1 [m]."""

_FLAT = 1e-9  # of a sine or of a length: below, it is nothing


def turning(corners: FloatArray, owner: str) -> float:
    """Return +1 for a convex outline that runs anticlockwise and -1 for a clockwise one.

    Shapes: corners (n, 2).
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=1)
    if (length < 1e-3).any():
        place = int(np.argmin(length)) + 1
        message = f"{owner}: its corners {place} and {place % len(corners) + 1} coincide in plan"
        raise ModelError(message)
    unit = edges / length[:, None]
    after = np.roll(unit, -1, axis=0)
    sines = unit[:, 0] * after[:, 1] - unit[:, 1] * after[:, 0]
    angles = np.arctan2(sines, (unit * after).sum(axis=1))
    side = 1.0 if angles.sum() > 0.0 else -1.0
    turns_back = np.abs(angles) > math.pi - 1e-6
    if (side * sines < -1e-6).any() or turns_back.any() or abs(angles.sum()) > 2.0 * math.pi + 1e-3:
        message = (
            f"{owner}: its corners are not those of a convex outline in order: name them one after "
            "the other around the panel (not all on one line), and split it where a corner points "
            "inwards"
        )
        raise ModelError(message)
    return side


def nearest_edges(corners: FloatArray) -> list[list[Piece]]:
    r"""Return what each edge carries where every point of a panel goes to the nearest edge.

    Over the point s of an edge with the inward normal n reaches the depth

    .. math:: h(s) = \min_k \, (c_k + m_k s) / (1 - n_k \cdot n)

    up to the bisector with another edge k, from which the point is :math:`c_k + m_k s` away; 45
    degrees at the corners of a rectangle. As the distance D to the outline is 0 on it,
    :math:`\int D \nabla D \, dA = 0`: the load moves to the edges without a moment in sum.

    Shapes: corners (n, 2), result (n,).
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=1)
    along = edges / length[:, None]
    inward = np.stack([-along[:, 1], along[:, 0]], axis=1)
    found = []
    for e in range(len(corners)):
        against = 1.0 - inward @ inward[e]
        others = against > _FLAT  # edges on the same line take their own part of it
        away = (inward * (corners[e] - corners)).sum(axis=1)[others] / against[others]
        slope = (inward @ along[e])[others] / against[others]
        places = {0.0, float(length[e])}
        for (a, p), (b, q) in itertools.combinations(zip(away, slope, strict=True), 2):
            if abs(p - q) > _FLAT and 0.0 < (place := float((b - a) / (p - q))) < length[e]:
                places.add(place)
        s = np.array(sorted(places))
        depth = np.maximum((away[:, None] + slope[:, None] * s).min(axis=0), 0.0)
        found.append(_pieces(s, depth))
    return found


def one_way(corners: FloatArray, span: FloatArray) -> list[list[Piece]]:
    """Return what each edge carries where strips along `span` rest on the edges at their ends.

    Shapes: corners (n, 2), span (2,), result (n,).
    """
    across = np.array([-span[1], span[0]])
    offset, reach = corners @ across, corners @ span
    stations = np.unique(offset)
    after = np.roll(np.arange(len(corners)), -1)

    def strip(at: float) -> float:
        # Length of the strip at an offset that is no corner's.
        ends = []
        for k, m in enumerate(after):
            if (offset[k] - at) * (offset[m] - at) < 0.0:
                share = (at - offset[k]) / (offset[m] - offset[k])
                ends.append(reach[k] + share * (reach[m] - reach[k]))
        return float(max(ends) - min(ends))

    found: list[list[Piece]] = []
    for k, m in enumerate(after):
        length = float(np.linalg.norm(corners[m] - corners[k]))
        lean = float(offset[m] - offset[k]) / length
        pieces: list[Piece] = []
        if abs(lean) > 1e-6:
            low, high = sorted((offset[k], offset[m]))
            inside = stations[(stations >= low) & (stations <= high)]
            for c0, c1 in itertools.pairwise(inside):
                if c1 - c0 < _FLAT * length:
                    continue
                near, far = (strip(c0 + share * (c1 - c0)) for share in (1.0 / 3.0, 2.0 / 3.0))
                ends = [(c0, 2.0 * near - far), (c1, 2.0 * far - near)]
                (s0, h0), (s1, h1) = sorted(((c - offset[k]) / lean, h) for c, h in ends)
                pieces.append((float(s0), 0.5 * abs(lean) * h0, float(s1), 0.5 * abs(lean) * h1))
        found.append(sorted(pieces))
    return found


def _pieces(s: FloatArray, depth: FloatArray) -> list[Piece]:
    return [
        (float(s[k]), float(depth[k]), float(s[k + 1]), float(depth[k + 1]))
        for k in range(len(s) - 1)
        if s[k + 1] - s[k] > _FLAT * s[-1]
    ]
