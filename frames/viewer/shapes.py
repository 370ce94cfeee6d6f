"""Displacements of all nodes as a few shapes, each with its history."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray

_SNAPSHOTS = 800  # instants that shapes are found from, at most


class Shapes(NamedTuple):
    """Displacements over time as ``histories @ shapes``.

    Attributes
    ----------
    histories : ndarray, (n_steps, r)
        How much of each shape there is.
    shapes : ndarray, (r, n)
        The shapes [m, rad].
    error : float
        Largest difference from the displacements, rotations times the arm [m].
    """

    histories: FloatArray
    shapes: FloatArray
    error: float


def as_shapes(moves: FloatArray, arm: float, tolerance: float) -> Shapes:
    """Return displacements of nodes as the fewest shapes that hold them (their proper modes).

    Shapes: moves (n_steps, n_nodes, 6).
    """
    weights = np.array([1.0, 1.0, 1.0, arm, arm, arm])
    table = (moves * weights).reshape(len(moves), -1)
    every = -(-len(table) // _SNAPSHOTS)
    sizes = np.abs(table).max(axis=1)
    snapshots = np.vstack([table[::every], table[[int(sizes.argmax())]]])
    basis = np.linalg.svd(snapshots, full_matrices=False)[2]
    allowed = tolerance * float(sizes.max())
    low, high = 0, len(basis)
    while low < high:  # the fewest that are enough
        middle = (low + high) // 2
        if _error(table, basis[:middle]) <= allowed:
            high = middle
        else:
            low = middle + 1
    chosen = basis[:low]
    shapes = (chosen.reshape(low, moves.shape[1], 6) / weights).reshape(chosen.shape)
    return Shapes(table @ chosen.T, shapes, _error(table, chosen))


def _error(table: FloatArray, basis: FloatArray) -> float:
    return float(np.abs(table - (table @ basis.T) @ basis).max())
