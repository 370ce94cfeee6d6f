"""A reduced basis: the bearings' degrees of freedom kept, the linear rest as few Ritz vectors.

Instead of all fixed-base modes of `build_basis` it uses load-dependent vectors (Wilson, Yuan and
Dickens 1982). The first are the static displacements under the inertia of rigid motions, and under
that of each bearing's axial motion (without these the axial forces are off by a fifth). The next
are those under the inertia of the vectors before, and so on. So they come in the order of their
importance; the rest follows permanent loads and nonlinear parts statically. The structure's own
matrices stay sparse, so that a large one is set up in seconds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg, sparse

from frames._errors import ModelError
from frames.assembly.basis import (
    build_basis,
    mode_damping,
    touched_dofs,
)
from frames.assembly.coordinates import Basis, couples_massless, with_matrix_damping
from frames.assembly.natural_modes import symmetric
from frames.assembly.solvers import Factors, positive_factors

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System
    from frames.model.damping import Damping

RIGID_A_TURN = 3
"""Generations of vectors of rigid motions for one of the bearings' own."""

LARGE = 4000
"""Displacements of a structure, above which matrices of all its modes are out of reach."""

VECTORS, TURNS = 150, 3
"""Vectors, and cycles of them, at least, instead of all modes of a large structure."""

_NEW = 1e-6  # of a vector's size: least remainder beside those before, to count as a new one


def basis_of(system: System, geometric: SparseMatrix, damping: Damping | None) -> Basis:
    """Change a frame to bearing coordinates and all modes; of a large one, to many vectors.

    Shapes: geometric (n_free, n_free).
    """
    if not is_large(system):
        return build_basis(system, geometric, damping)
    space = RitzSpace(system, geometric, damping)
    count = turns = 0
    while count < min(VECTORS, space.most) or turns < TURNS:
        count, turns = space.grow(), turns + 1
    return space.basis()


def is_large(system: System) -> bool:
    """Return whether a structure is too large for matrices of all its modes."""
    return len(system.dof_labels) > LARGE


class RitzSpace:
    """Load-dependent vectors of a structure over its held bearings, added on request.

    Raises
    ------
    ModelError
        If the structure over held bearings is unstable under its permanent loads.
    """

    def __init__(self, system: System, geometric: SparseMatrix, damping: Damping | None) -> None:
        self._system, self._damping = system, damping
        stiffness = sparse.csr_array(system.stiffness + geometric)
        self._touched = touched_dofs(system.bearing_rows)
        self._rest = np.setdiff1d(np.arange(stiffness.shape[0]), self._touched)
        inner = sparse.csr_array(stiffness[self._rest][:, self._rest])
        self._stiffness = stiffness
        self._mass = sparse.csr_array(system.mass[self._rest][:, self._rest])
        self._factors = _factors(inner, system, geometric, damping)
        self._follow = self._solve(-np.asarray(stiffness[self._rest][:, self._touched].toarray()))
        self._static = self._solve(system.load[self._rest])
        self._vectors = self._loads = np.zeros((len(self._rest), 0))  # loads = stiffness @ vectors
        self._rigid = self._mass_of_rigid_motions()
        self._heaving = self._mass_of_heaving()
        self.most = int(np.count_nonzero(abs(self._mass).sum(axis=1)))

    def _solve(self, right: FloatArray) -> FloatArray:
        return self._factors.solve(right) if self._factors is not None else right

    def _mass_of_rigid_motions(self) -> FloatArray:
        # Inertia of the rest, (n_rest, 6), under unit accelerations of rigid motions.
        system = self._system
        arms = system.coordinates - system.coordinates.mean(axis=0)
        turns = np.zeros((len(arms), 6, 3))
        for axis in range(3):
            unit = np.eye(3)[axis]
            turns[:, :3, axis], turns[:, 3 + axis, axis] = np.cross(unit, arms), 1.0
        transform = system.transform
        normal = Factors(sparse.csr_array(transform.T @ transform))
        moved = normal.solve(np.asarray(transform.T @ turns.reshape(-1, 3)))
        turned = np.asarray(system.mass @ moved)
        return np.hstack([system.inertia_load[self._rest], turned[self._rest]])

    def _mass_of_heaving(self) -> FloatArray:
        # Inertia of the rest that follows a unit acceleration of each bearing along its axis.
        rows = self._system.bearing_rows[:, self._touched]
        lifted = touched_dofs(rows[2::6])
        own = np.asarray(self._system.mass[self._rest][:, self._touched[lifted]].toarray())
        return np.asarray(own + self._mass @ self._follow[:, lifted])

    def grow(self) -> int:
        """Add a cycle of further vectors, if there are any.

        A cycle has three generations from rigid motions, and one from the bearings' axial motions.
        """
        for _ in range(RIGID_A_TURN):
            self._rigid = self._next(self._rigid)
        self._heaving = self._next(self._heaving)
        return self._vectors.shape[1]

    def _next(self, loads: FloatArray) -> FloatArray:
        # Add the vectors that answer some loads; return the inertia of the new ones. Vectors have
        # modal mass 1 and are orthogonal, made so twice for the digits. Each is the answer to a
        # load on masses, so that the rest follows without round-off.
        vectors = self._solve(loads)
        size = np.sqrt(np.maximum(np.sum(vectors * np.asarray(self._mass @ vectors), axis=0), 0.0))
        scale = 1.0 / np.where(size > 0.0, size, 1.0)
        loads, vectors = loads * scale, vectors * scale
        for _ in range(2):
            shares = self._vectors.T @ np.asarray(self._mass @ vectors)
            loads, vectors = loads - self._loads @ shares, vectors - self._vectors @ shares
            mix = _orthogonal(vectors.T @ np.asarray(self._mass @ vectors))
            loads, vectors = loads @ mix, vectors @ mix
        vectors = self._solve(loads)
        room = self.most - self._vectors.shape[1]
        self._vectors = np.hstack([self._vectors, vectors[:, :room]])
        self._loads = np.hstack([self._loads, loads[:, :room]])
        return np.asarray(self._mass @ vectors[:, :room])

    def basis(self) -> Basis:
        """Return the frame in the bearings' coordinates and the vectors made so far."""
        system, n_b = self._system, len(self._touched)
        omega2, turned = self._turned()
        phi = self._vectors @ turned
        n_free, n_e = self._stiffness.shape[0], len(omega2)
        expand_b, expand_e = np.zeros((n_free, n_b)), np.zeros((n_free, n_e))
        expand_b[self._touched], expand_b[self._rest] = np.eye(n_b), self._follow
        expand_e[self._rest] = phi
        offset = np.zeros(n_free)
        load_e = phi.T @ system.load[self._rest]
        offset[self._rest] = self._static - phi @ (load_e / omega2)
        damping_e, beta = mode_damping(self._damping, omega2)
        with_mass = np.asarray(system.mass @ expand_b)
        own = expand_b.T @ np.asarray(system.stiffness @ expand_b)
        basis = Basis(
            bearing_dofs=self._touched,
            expand_b=expand_b,
            expand_e=expand_e,
            offset=offset,
            still=self._still(phi, omega2),
            mass_b=symmetric(expand_b.T @ with_mass),
            mass_be=with_mass.T @ expand_e,
            mass_e=np.ones(n_e),
            stiffness_b=symmetric(expand_b.T @ np.asarray(self._stiffness @ expand_b)),
            damping_b=symmetric(beta * own),
            omega2=omega2,
            damping_e=damping_e,
            damping_be=np.zeros((0, 0)),
            damping_ee=np.zeros((0, 0)),
            load_b=expand_b.T @ system.load,
            load_e=load_e,
            inertia_b=expand_b.T @ system.inertia_load,
            inertia_e=expand_e.T @ system.inertia_load,
        )
        if not system.damping.nnz:
            return basis
        _refuse_lag(system, basis)
        none = np.zeros((n_free, 0))
        return with_matrix_damping(basis, system.damping, self._stiffness, none)

    def _turned(self) -> tuple[FloatArray, FloatArray]:
        # Squared frequencies of the modes among the vectors, and how these mix them.
        if not self._vectors.shape[1]:
            return np.zeros(0), np.zeros((0, 0))
        stiffness = self._vectors.T @ self._loads
        mass = self._vectors.T @ np.asarray(self._mass @ self._vectors)
        omega2, turned = linalg.eigh(symmetric(stiffness), symmetric(mass))
        return omega2, turned

    def _still(self, phi: FloatArray, omega2: FloatArray) -> FloatArray:
        # Shapes of stiffness 1 with which the omitted part follows the nonlinear parts.
        rows, n_free = self._system.part_rows, self._stiffness.shape[0]
        if not rows.shape[0] or not len(self._rest):
            return np.zeros((n_free, 0))
        loads = rows[:, self._rest].T.toarray()
        left = self._solve(loads) - phi @ ((phi.T @ loads) / omega2[:, None])
        flexibility = loads.T @ left
        size = np.sqrt(np.maximum(np.diag(flexibility), 0.0))
        scale = 1.0 / np.where(size > 0.0, size, 1.0)
        values, vectors = linalg.eigh(symmetric(flexibility * np.outer(scale, scale)))
        kept = values > _NEW * max(float(values[-1]), 0.0)
        still = np.zeros((n_free, int(kept.sum())))
        still[self._rest] = left @ (scale[:, None] * vectors[:, kept] / np.sqrt(values[kept]))
        return still


def _factors(
    inner: SparseMatrix, system: System, geometric: SparseMatrix, damping: Damping | None
) -> Factors | None:
    # The stiffness over held bearings, factorised; None if nothing is left.
    if not inner.shape[0]:
        return None
    factors = positive_factors(inner)
    if factors is not None:
        return factors
    if not is_large(system):
        build_basis(system, geometric, damping)  # names the culprit
    message = (
        "the structure above the bearings is unstable under its permanent loads: reduce "
        "the loads or stiffen columns"
    )
    raise ModelError(message)


def _orthogonal(inertia: FloatArray) -> FloatArray:
    # Combination of vectors of about mass 1 to orthogonal ones of mass 1, the longest first;
    # components in the span of earlier ones are left out.
    masses, turned = linalg.eigh(symmetric(inertia))
    kept = np.flatnonzero(masses > _NEW**2)[::-1]
    return np.asarray(turned[:, kept] / np.sqrt(masses[kept]))


def _refuse_lag(system: System, basis: Basis) -> None:
    massless = np.flatnonzero(~(abs(system.mass).sum(axis=1) > 0.0))
    if couples_massless(basis, system.damping, massless):
        message = (
            'method = "reduced" does not support damping on degrees of freedom without '
            'mass: use method="direct"'
        )
        raise ModelError(message)
