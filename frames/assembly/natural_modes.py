"""Natural modes of matrices whose masses span many orders of magnitude, none among them.

The usual way, to divide by the mass, loses all digits if rotations have masses of 1e-10: the
largest squared frequency sets the round-off of all. Here the problem is inverted, ``M y = mu K y``
with ``mu = 1 / omega^2``: DOFs of almost no mass have almost no mu, and the long periods, which
matter, are the accurate ones. Modes are computed from the longest on, a million in mu at a time,
each group made orthogonal to those before: so all keep ten digits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import linalg as sparse_linalg

from frames.assembly.solvers import Factors, positive_factors

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix

STATIC = 1e-12
"""Squared period over the longest squared period, up to which a mode follows statically [-]."""

_SPAN = 1e-6  # in squared period, of a group of modes that is resolved at once


class UnstableError(ValueError):
    """The stiffness is not positive definite."""

    def __init__(self, direction: FloatArray) -> None:
        super().__init__("the stiffness is not positive definite")
        self.direction = direction


class NaturalModes(NamedTuple):
    """Modes of ``K y = omega^2 M y``, longest period first."""

    omega2: FloatArray
    """Squared circular frequencies (n_modes,) [1/s2]."""
    shapes: FloatArray
    """Shapes (n, n_modes) of modal mass 1."""
    static: FloatArray
    """Shapes (n, n_static) of modal stiffness 1 whose mass is below the round-off."""


def natural_modes(k: FloatArray, m: FloatArray, count: int | None = None) -> NaturalModes:
    """Find the natural modes of a structure.

    Shapes: k (n, n), m (n, n).
    """
    size = len(k)
    scale = _scale(k)
    scaled = symmetric(k * np.outer(scale, scale))
    inert = symmetric(m * np.outer(scale, scale))
    few = count is not None and 2 * count < size
    try:
        mu, y = linalg.eigh(
            inert, scaled, subset_by_index=(size - count, size - 1) if few and count else None
        )
    except linalg.LinAlgError as error:
        raise UnstableError(weakest(k)) from error
    mu, y = mu[::-1], y[:, ::-1]
    longest = float(mu[0])
    found, shapes = [np.zeros(0)], [np.zeros((size, 0))]
    while len(mu) and mu[0] > STATIC * longest:
        clear = int(np.count_nonzero(mu > _SPAN * mu[0]))
        found.append(mu[:clear])
        shapes.append(y[:, :clear])
        mu, y = _rest(inert, found[-1], shapes[-1], y[:, clear:])
    periods2 = np.concatenate(found)[:count]
    static = np.zeros((size, 0)) if few else y
    return NaturalModes(
        omega2=1.0 / periods2,
        shapes=scale[:, None] * np.hstack(shapes)[:, :count] / np.sqrt(periods2),
        static=scale[:, None] * static,
    )


def _rest(
    inert: FloatArray, mu: FloatArray, done: FloatArray, rest: FloatArray
) -> tuple[FloatArray, FloatArray]:
    # The modes in the span of `rest`, without the round-off of earlier ones.
    if not rest.shape[1]:
        return np.zeros(0), rest
    rest = rest - done @ ((done.T @ (inert @ rest)) / mu[:, None])
    values, turned = linalg.eigh(symmetric(rest.T @ inert @ rest))
    return values[::-1], (rest @ turned)[:, ::-1]


def is_stable(k: FloatArray) -> bool:
    """Return whether a stiffness (n, n) is positive definite."""
    scale = _scale(k)
    try:
        linalg.cholesky(symmetric(k * np.outer(scale, scale)))
    except linalg.LinAlgError:
        return False
    return True


def weakest(k: FloatArray) -> FloatArray:
    """Return the displacements (n,) in which a stiffness is least, relative to its diagonal."""
    scale = _scale(k)
    _, vectors = linalg.eigh(symmetric(k * np.outer(scale, scale)), subset_by_index=(0, 0))
    return np.asarray(scale * vectors[:, 0])


def _scale(k: FloatArray) -> FloatArray:
    # Scale that gives the diagonal the size of 1.
    diagonal = np.abs(np.diag(k))
    return 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))


def symmetric(matrix: FloatArray) -> FloatArray:
    """Return a matrix (n, n) made symmetric against round-off."""
    return np.ascontiguousarray(0.5 * (matrix + matrix.T))


_MORE = 6  # modes beside those wanted: of equal ones all are found
_BEYOND = 1e-6  # of a squared frequency, above which modes are counted


def few_modes(k: SparseMatrix, m: SparseMatrix, count: int) -> NaturalModes:
    """Find the first natural modes of a structure by Lanczos' method (ARPACK).

    The number of squared frequencies below the last one found is counted (Sylvester's law of
    inertia); if one was missed, `natural_modes` finds all modes.

    Shapes: k (n, n), m (n, n).
    """
    factors = positive_factors(k)
    if factors is None:
        raise UnstableError(weakest(k.toarray()))
    massive = int(np.count_nonzero(abs(m).sum(axis=1)))
    if 2 * (count + _MORE) >= massive:
        return natural_modes(k.toarray(), m.toarray(), count)
    inverse = sparse_linalg.LinearOperator(k.shape, matvec=factors.solve, dtype=np.float64)
    start = factors.solve(np.asarray(m @ np.linspace(1.0, 2.0, k.shape[0])))
    omega2, shapes = sparse_linalg.eigsh(
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
    # Modes with squared frequencies below a value; -1 if the factors do not show them.
    try:
        factors = Factors(sparse.csr_array(k - value * m))
    except RuntimeError:
        return -1
    return factors.negative
