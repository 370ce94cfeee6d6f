"""Coordinates that many bearings share, such as a diaphragm's, and the arrays of their tangent.

See frames/kernels/shared_tangent.py for what is made of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.assembly.assemble import System

MANY = 200  # unknowns of bearings, from which on what few of them share is kept apart
_SHARED_BY = 8  # bearings at least
_FEW = 0.1  # of the unknowns at most
_SECANTS = 8  # corrections of Newton's method that are remembered within a step


def shared_coordinates(system: System, rows: SparseMatrix) -> IntArray:
    """Return those coordinates of b that many bearings share, if it pays to keep them apart.

    Shapes: rows (12 n_bearings, n_b), result (n_h,).
    """
    n_b = rows.shape[1]
    if n_b < MANY or len(system.parts.kind):
        return np.zeros(0, dtype=np.int64)
    row, column = rows.tocoo().coords
    pairs = np.unique(np.column_stack([column, row // 12]), axis=0)
    shared = np.flatnonzero(np.bincount(pairs[:, 0], minlength=n_b) >= _SHARED_BY)
    return shared if len(shared) <= _FEW * n_b else shared[:0]


def order_of(shared: IntArray, count: int) -> IntArray:
    """Return the coordinates (count,) with the shared ones last.

    Shapes: shared (n_h,), result (count,).
    """
    is_shared = np.zeros(count, dtype=np.int64)
    is_shared[shared] = 1
    return np.argsort(is_shared, kind="stable").astype(np.int64)


def tangent_arrays(n_b: int, n_h: int, bearings: int) -> dict[str, Any]:
    """Return the arrays of an IntegrationState that hold the tangent."""
    n_v = n_b - n_h
    n_s = n_b if n_h else 0

    def zeros(*shape: int) -> FloatArray:
        return np.zeros(shape)

    return {
        "tangent": zeros(n_v, n_v),
        "order": np.zeros(n_v, np.int64),
        "across": zeros(n_h, n_v),
        "below": zeros(n_h, n_v),
        "corner": zeros(n_h, n_h),
        "corner_order": np.zeros(n_h, np.int64),
        "sorted_b": zeros(n_s),
        "linear_step": zeros(n_s),
        "linear_trial": zeros(n_s),
        "linear_change": zeros(n_s),
        "linear_before": zeros(2, n_s),
        "flows": zeros(6, n_s),
        "element_whole": zeros(bearings if n_h else 0, 12, 12),
        "of_nodes": zeros(4, 12),
        "weights": np.ones(n_s),
        "corrections": zeros(_SECANTS, n_s),
        "corrections_linear": zeros(_SECANTS, n_s),
        "corrections_size": zeros(_SECANTS),
    }
