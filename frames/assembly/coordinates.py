"""A frame in bearing degrees of freedom and fixed-interface modes, as `build_basis` makes it.

Damping may be given as a matrix. It then couples the modes with each other and with the bearings'
displacements, unless it is proportional to the present stiffness: then it is a number a mode. If it
is not proportional, directions without mass do not follow the rest statically: they lag. Their
deviation from the static shape then joins the modes, as coordinates without mass.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from frames.assembly.natural_modes import symmetric

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix

_OWN_MASS = 1e-9  # of a coordinate's mass with all that follows it, above which it has its own


@dataclass(frozen=True, repr=False)
class Basis:
    """A frame in bearing coordinates b (n_b) and fixed-interface modes eta (n_e)."""

    bearing_dofs: IntArray  # (n_b,) places of b among the free displacements q
    expand_b: FloatArray  # (n_free, n_b): q = expand_b @ b + expand_e @ eta + offset
    expand_e: FloatArray  # (n_free, n_e)
    offset: FloatArray  # (n_free,) static displacement of massless DOFs under their own loads
    still: FloatArray  # (n_free, n_still) its shapes, of stiffness 1 each; none in a linear frame
    mass_b: FloatArray  # (n_b, n_b)
    mass_be: FloatArray  # (n_b, n_e)
    mass_e: FloatArray  # (n_e,) 1 for modes, 0 for lagging coordinates (`with_matrix_damping`)
    stiffness_b: FloatArray  # (n_b, n_b) without bearings, geometric part included
    damping_b: FloatArray  # (n_b, n_b) of the base's own deformation
    omega2: FloatArray  # (n_e,) squared circular frequencies of the modes
    damping_e: FloatArray  # (n_e,) 2 zeta omega
    damping_be: FloatArray  # (n_b, n_e) damping given as a matrix; of size zero if there is none
    damping_ee: FloatArray  # (n_e, n_e)
    load_b: FloatArray  # (n_b,) permanent loads
    load_e: FloatArray  # (n_e,)
    inertia_b: FloatArray  # (n_b, 3) loads per unit ground acceleration, with positive sign
    inertia_e: FloatArray  # (n_e, 3)

    @cached_property
    def mobility(self) -> FloatArray:
        """Accelerations of b under forces on b, with eta following, (n_b, n_b) [1/kg, ...].

        Coordinates without mass of their own have none: nothing balances a force on them.
        """
        heavy = self.mass_e > 0.0
        between = self.mass_be[:, heavy]
        left = symmetric(self.mass_b - between @ between.T)
        own = np.diag(left) > _OWN_MASS * np.diag(self.mass_b)
        found = np.zeros_like(left)
        found[np.ix_(own, own)] = linalg.pinvh(left[np.ix_(own, own)])
        return found

    @cached_property
    def shaken(self) -> FloatArray:
        """Accelerations of b and eta at rest under a unit of ground acceleration, (n, 3) [-]."""
        heavy = self.mass_e > 0.0  # 1 for modes; lagging coordinates have no inertia
        between = self.mass_be[:, heavy]
        left = self.mass_b - between @ between.T
        alone = self.inertia_b - between @ self.inertia_e[heavy]
        of_e = np.zeros_like(self.inertia_e)
        of_b = -linalg.pinvh(symmetric(left)) @ alone
        of_e[heavy] = -self.inertia_e[heavy] - between.T @ of_b
        return np.vstack([of_b, of_e])

    def shift(self, loads: FloatArray) -> FloatArray:
        """Return the displacements of massless DOFs under loads (n_free, ...), with b and eta 0."""
        return np.asarray(self.still @ (self.still.T @ loads))

    def __repr__(self) -> str:
        """Return sizes on one line."""
        return f"Basis: {len(self.load_b)} bearing coordinates, {len(self.omega2)} modes"


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
    # True if the coupling of these shapes by damping is round-off.
    bound = np.sqrt(np.outer(_gross(rows, damping), _gross(columns, damping)))
    return bool((np.abs(coupling) <= _UNCOUPLED * bound).all())


def _of(left: FloatArray, matrix: FloatArray | SparseMatrix, right: FloatArray) -> FloatArray:
    return np.asarray(left.T @ np.asarray(matrix @ right))


def _gross(shapes: FloatArray, damping: FloatArray | SparseMatrix) -> FloatArray:
    # The work of each shape with itself, all terms counted positive: no round-off if it is zero.
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
