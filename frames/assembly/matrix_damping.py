"""Damping given as a matrix, in bearing coordinates and fixed-interface modes.

Such damping couples the modes with each other and with the bearings' displacements. Where it does
not follow the stiffness, directions without mass do not follow the rest statically any more:
they lag. Their deviation from the static shape then joins the modes, as coordinates without mass.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.basis import Basis

_CONSISTENT = 1e-6  # cosine of damping forces, up to which massless ones follow statically


def with_matrix_damping(
    basis: Basis, damping: FloatArray, stiffness: FloatArray, still: FloatArray
) -> Basis:
    """Add damping that is given as a matrix.

    Parameters
    ----------
    basis : Basis
        The frame without it.
    damping, stiffness : ndarray, (n_free, n_free)
        Damping of the motion relative to the ground; stiffness, geometric part included.
    still : ndarray, (n_free, n_still)
        Directions without mass, which follow the rest statically.

    Returns
    -------
    Basis
        With full damping matrices, and coordinates without mass where massless ones lag.
    """
    basis = _with_lag(basis, damping, stiffness, still)
    to_b, to_e = basis.expand_b, basis.expand_e
    own_b, own_e = to_b.T @ damping @ to_b, to_e.T @ damping @ to_e
    return replace(
        basis,
        damping_b=basis.damping_b + 0.5 * (own_b + own_b.T),
        damping_be=to_b.T @ damping @ to_e,
        damping_ee=0.5 * (own_e + own_e.T),
    )


def _with_lag(basis: Basis, damping: FloatArray, stiffness: FloatArray, still: FloatArray) -> Basis:
    count = still.shape[1]
    if not count:
        return basis
    still = still / np.sqrt(np.sum(still * (stiffness @ still), axis=0))
    shapes = np.hstack([basis.expand_b, basis.expand_e])
    forces = np.abs(still.T @ damping @ shapes)
    # the work of each shape with itself, all terms counted positive: no round-off where it is zero
    work, own = (
        np.sum(np.abs(part) * (np.abs(damping) @ np.abs(part)), axis=0) for part in (shapes, still)
    )
    if not (forces > _CONSISTENT * np.sqrt(np.outer(own, work))).any():
        return basis
    block = still.T @ stiffness @ still
    omega2, vectors = linalg.eigh(0.5 * (block + block.T))
    more = still @ vectors
    none = np.zeros(count)
    return replace(
        basis,
        expand_e=np.hstack([basis.expand_e, more]),
        mass_e=np.concatenate([basis.mass_e, none]),
        mass_be=np.hstack([basis.mass_be, np.zeros((len(basis.mass_be), count))]),
        omega2=np.concatenate([basis.omega2, omega2]),
        damping_e=np.concatenate([basis.damping_e, none]),
        load_e=np.concatenate([basis.load_e, none]),
        inertia_e=np.vstack([basis.inertia_e, np.zeros((count, 3))]),
    )
