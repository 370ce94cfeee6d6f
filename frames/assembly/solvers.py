"""Solves with symmetric matrices: dense ones, with a check for round-off, and sparse ones.

Sparse ones are factorised once, in a few hundredths of the time of a general solver.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import linalg as sparse_linalg

from frames._errors import ModelWarning
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray, SparseMatrix


def solve_positive(
    matrix: FloatArray, right: FloatArray, what: str, labels: Sequence[str]
) -> FloatArray:
    """Solve for right-hand sides, in scaled unknowns if round-off would show otherwise.

    Shapes: matrix (n, n), right (n, m), labels (n,), result (n, m).
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", linalg.LinAlgWarning)
        try:
            return np.asarray(linalg.solve(matrix, right, assume_a="pos"))
        except linalg.LinAlgWarning:
            scale = 1.0 / np.sqrt(np.diag(matrix))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scaled = matrix * np.outer(scale, scale)
        found = linalg.solve(scaled, scale[:, None] * right, assume_a="pos")
    if told:
        weak = np.abs(linalg.eigh(scaled, subset_by_index=[0, 0])[1][:, 0])
        warnings.warn(
            worded(
                'the {what} near "{label}" is lost to round-off: its neighbours are 1e16 times '
                "larger. Make rigid parts 1,000 times as stiff as their neighbours, or use a "
                "diaphragm or offsets",
                what=what,
                label=labels[int(weak.argmax())],
            ),
            ModelWarning,
            stacklevel=2,
        )
    return np.asarray(scale[:, None] * found)


class Factors:
    """A symmetric matrix, factorised in an order that keeps it sparse, its diagonal as pivots.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """

    def __init__(self, matrix: SparseMatrix) -> None:
        self._factors = sparse_linalg.splu(
            sparse.csc_array(matrix),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    @property
    def is_positive(self) -> bool:
        """True if the matrix is positive definite: by the signs of its pivots (Sylvester)."""
        pivots = self._pivots
        return pivots is not None and bool((pivots > 0.0).all())

    @property
    def negative(self) -> int:
        """Number of negative eigenvalues, that of negative pivots (Sylvester); -1 if unknown."""
        pivots = self._pivots
        return -1 if pivots is None else int(np.count_nonzero(pivots < 0.0))

    @property
    def _pivots(self) -> FloatArray | None:
        # None if rows were exchanged: then they are not those of the symmetric matrix.
        same = bool((self._factors.perm_r == self._factors.perm_c).all())
        return np.asarray(self._factors.U.diagonal()) if same else None

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for right-hand sides (n,) or (n, m)."""
        return np.asarray(self._factors.solve(np.asarray(right, dtype=np.float64)))


def positive_factors(matrix: SparseMatrix) -> Factors | None:
    """Return the factors of a symmetric matrix (n, n); None if it is not positive definite."""
    try:
        factors = Factors(matrix)
    except RuntimeError:
        return None
    return factors if factors.is_positive else None
