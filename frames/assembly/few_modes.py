"""The first natural modes of large structures, from sparse matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from frames.assembly.natural_modes import NaturalModes, UnstableError, natural_modes, weakest
from frames.assembly.sparse_solver import Factors, positive_factors

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix

_MORE = 6  # modes beside those wanted: of equal ones all are found
_BEYOND = 1e-6  # of a squared frequency, above which modes are counted


def few_modes(k: SparseMatrix, m: SparseMatrix, count: int) -> NaturalModes:
    """Find the first natural modes of a structure by Lanczos' method (ARPACK).

    How many squared frequencies there are below the last one found is counted (Sylvester's law of
    inertia); where one was missed, all modes are found by `natural_modes`.

    Shapes: k (n, n), m (n, n).
    """
    factors = positive_factors(k)
    if factors is None:
        raise UnstableError(weakest(k.toarray()))
    massive = int(np.count_nonzero(abs(m).sum(axis=1)))
    if 2 * (count + _MORE) >= massive:
        return natural_modes(k.toarray(), m.toarray(), count)
    inverse = linalg.LinearOperator(k.shape, matvec=factors.solve, dtype=np.float64)
    start = factors.solve(np.asarray(m @ np.linspace(1.0, 2.0, k.shape[0])))
    omega2, shapes = linalg.eigsh(
        sparse.csc_array(k), count + _MORE, sparse.csc_array(m), sigma=0.0, OPinv=inverse, v0=start
    )
    order = np.argsort(omega2)
    omega2, shapes = omega2[order], shapes[:, order]
    if _count_below(k, m, _gap_after(omega2, count)) != _found_below(omega2, count):
        return natural_modes(k.toarray(), m.toarray(), count)
    return NaturalModes(omega2[:count], shapes[:, :count], np.zeros((k.shape[0], 0)))


def _gap_after(omega2: FloatArray, count: int) -> float:
    # A value of no mode: above the last one wanted and those equal to it.
    return float(omega2[_found_below(omega2, count) - 1]) * (1.0 + _BEYOND)


def _found_below(omega2: FloatArray, count: int) -> int:
    return int(np.count_nonzero(omega2 <= omega2[count - 1] * (1.0 + _BEYOND)))


def _count_below(k: SparseMatrix, m: SparseMatrix, value: float) -> int:
    # Modes with squared frequencies below a value; -1 where the factors do not tell.
    try:
        factors = Factors(sparse.csr_array(k - value * m))
    except RuntimeError:
        return -1
    return factors.negative
