"""Displacement of the base slab's corners beyond the bearings."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import linprog

from lir_element.elevations import SAME_PLACE
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.frame import Frame


class SlabCorner(NamedTuple):
    """The node of the base that moves most."""

    factor: float  # its displacement over the largest of the bearings, 1 at least
    note: str  # its place, in words


_INSIDE = "the bearings enclose the nodes of the base: a rigid slab moves farthest at a bearing"


def farthest_corner(frame: Frame, each: FloatArray) -> SlabCorner:
    """Return the largest displacement of base nodes if bearings move by `each`, (n_bearings,).

    A rigid slab moves by an affine map: a node moves by the sum of shares of the bearings'
    displacements, with shares that combine their places to its own. Only the sizes of these are
    known, so that the smallest sum of the shares' sizes times them is the bound. Inside of the
    bearings' outline no share is negative, and no node moves more than the farthest bearing.
    """
    above = [link.j for link in frame.bearings.values()]
    places = np.array([frame.nodes[node].position[:2] for node in above])
    base = frame.levels[0].nodes if frame.levels else above
    nodes = {name: np.array(frame.nodes[name].position[:2]) for name in base}
    most, found = float(each.max()), SlabCorner(1.0, _INSIDE)
    if not np.isfinite(most) or not most > 0.0:
        return found
    for name, place in nodes.items():
        if (np.hypot(*(places - place).T) < SAME_PLACE).any():
            continue
        factor = _largest(places, each, place) / most
        if factor > found.factor * (1.0 + 1e-9):
            x, y = place
            note = worded(
                "node {name} of the base at x = {x:.4g} m, y = {y:.4g} m moves farthest: at most "
                "{factor:.3f} times the displacement of the farthest bearing, with a rigid slab",
                name=name,
                x=x + 0.0,
                y=y + 0.0,
                factor=factor,
            )
            found = SlabCorner(factor, note)
    return found


def _largest(places: FloatArray, each: FloatArray, at: FloatArray) -> float:
    # Shares as differences of two that are not negative: their sum counts.
    count = len(places)
    affine = np.vstack([np.ones(count), places.T])
    made = linprog(
        np.concatenate([each, each]),
        A_eq=np.hstack([affine, -affine]),
        b_eq=np.concatenate([[1.0], at]),
    )
    return float(each.max() if made.fun is None else made.fun)  # none of bearings in one line
