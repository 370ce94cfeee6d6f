"""Damping given as a matrix, in bearing coordinates and fixed-interface modes.

Such damping couples the modes with each other and with the bearings' displacements, unless it is
proportional to the present stiffness: then it is a number a mode. Where it does
not follow the stiffness, directions without mass do not follow the rest statically any more:
they lag. Their deviation from the static shape then joins the modes, as coordinates without mass.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from frames.assembly.natural_modes import symmetric

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.assembly.coordinates import Basis

_UNCOUPLED = 1e-10  # of the gross damping of two coordinates, below which nothing couples them
_CONSISTENT = 1e-6  # cosine of damping forces, up to which massless ones follow statically


def with_matrix_damping(
    basis: Basis,
    damping: FloatArray | SparseMatrix,
    stiffness: FloatArray | SparseMatrix,
    still: FloatArray,
) -> Basis:
    """Add damping that is given as a matrix.

    Shapes: damping, stiffness (n_free, n_free), still (n_free, n_still).
    """
    basis = _with_lag(basis, damping, stiffness, still)
    to_b, to_e = basis.expand_b, basis.expand_e
    own_b, own_e = symmetric(_of(to_b, damping, to_b)), symmetric(_of(to_e, damping, to_e))
    between = _of(to_b, damping, to_e)
    basis = replace(basis, damping_b=basis.damping_b + own_b)
    alone = np.diag(own_e)
    if _is_nothing(own_e - np.diag(alone), to_e, to_e, damping) and _is_nothing(
        between, to_b, to_e, damping
    ):
        return replace(basis, damping_e=basis.damping_e + alone.clip(0.0))
    return replace(basis, damping_be=between, damping_ee=own_e)


def couples_massless(basis: Basis, damping: SparseMatrix, massless: IntArray) -> bool:
    """Return whether damping holds up degrees of freedom that have no mass.

    Shapes: damping (n_free, n_free), massless (n_massless,).
    """
    shapes = np.hstack([basis.expand_b, basis.expand_e])
    forces = np.abs(np.asarray(damping[massless] @ shapes))
    own = abs(damping).diagonal()[massless]
    return bool((forces > _CONSISTENT * np.sqrt(np.outer(own, _gross(shapes, damping)))).any())


def _is_nothing(
    coupling: FloatArray,
    rows: FloatArray,
    columns: FloatArray,
    damping: FloatArray | SparseMatrix,
) -> bool:
    # Whether what damping couples of these shapes is round-off.
    bound = np.sqrt(np.outer(_gross(rows, damping), _gross(columns, damping)))
    return bool((np.abs(coupling) <= _UNCOUPLED * bound).all())


def _of(left: FloatArray, matrix: FloatArray | SparseMatrix, right: FloatArray) -> FloatArray:
    return np.asarray(left.T @ np.asarray(matrix @ right))


def _gross(shapes: FloatArray, damping: FloatArray | SparseMatrix) -> FloatArray:
    # The work of each shape with itself, all terms counted positive: no round-off where it is zero.
    size = np.abs(shapes)
    return np.asarray(np.sum(size * np.asarray(abs(damping) @ size), axis=0))


def _with_lag(
    basis: Basis,
    damping: FloatArray | SparseMatrix,
    stiffness: FloatArray | SparseMatrix,
    still: FloatArray,
) -> Basis:
    count = still.shape[1]
    if not count:
        return basis
    still = still / np.sqrt(np.sum(still * np.asarray(stiffness @ still), axis=0))
    shapes = np.hstack([basis.expand_b, basis.expand_e])
    forces = np.abs(_of(still, damping, shapes))
    work, own = _gross(shapes, damping), _gross(still, damping)
    if not (forces > _CONSISTENT * np.sqrt(np.outer(own, work))).any():
        return basis
    omega2, vectors = linalg.eigh(symmetric(_of(still, stiffness, still)))
    more = still @ vectors
    none = np.zeros(count)
    return replace(
        basis,
        still=basis.still[:, :0],
        expand_e=np.hstack([basis.expand_e, more]),
        mass_e=np.concatenate([basis.mass_e, none]),
        mass_be=np.hstack([basis.mass_be, np.zeros((len(basis.mass_be), count))]),
        omega2=np.concatenate([basis.omega2, omega2]),
        damping_e=np.concatenate([basis.damping_e, none]),
        load_e=np.concatenate([basis.load_e, none]),
        inertia_e=np.vstack([basis.inertia_e, np.zeros((count, 3))]),
    )
