"""Change of basis: bearing degrees of freedom kept, the linear rest as fixed-interface modes.

With the bearings' degrees of freedom b held, the rest of the structure is linear. Its motion is the
quasi-static one that follows b plus all modes with b fixed (Hurty 1965; Craig and Bampton 1968),
``q_r = Psi q_b + Phi eta``. This makes stiffness and damping of the rest diagonal: a time step of
any size costs a small dense solve in b and a division a mode. All modes are kept, so this is the
full model in other coordinates, not an approximation. Degrees of freedom without mass follow
statically and are eliminated first, which is exact too. So are modes with almost no mass
(frames/assembly/natural_modes.py), whose periods are below 1e-6 of the longest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from frames._errors import ModelError
from frames.assembly.coordinates import Basis as Basis
from frames.assembly.coordinates import with_matrix_damping
from frames.assembly.natural_modes import UnstableError, natural_modes, symmetric, weakest
from frames.assembly.solvers import solve_positive
from frames.model.damping import ModalDamping, RayleighDamping

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.assembly.system import System
    from frames.model.damping import Damping


def touched_dofs(rows: SparseMatrix) -> IntArray:
    """Return the places among the free DOFs, in order, of those that some rows depend on."""
    return np.unique(rows.tocoo().coords[1]).astype(np.int64)


def build_basis(system: System, geometric: SparseMatrix, damping: Damping | None) -> Basis:
    """Change a frame to bearing coordinates and all fixed-interface modes.

    Shapes: geometric (n_free, n_free).
    """
    elastic = system.stiffness.toarray()
    stiffness = elastic + geometric.toarray()
    mass = system.mass.toarray()
    n_free = len(stiffness)
    touched = touched_dofs(system.bearing_rows)
    rest = np.setdiff1d(np.arange(n_free), touched)
    massless = rest[~mass[rest].any(axis=1)]
    massive = np.setdiff1d(rest, massless)
    kept = np.concatenate([touched, massive])
    n_b = len(touched)
    follow, offset_m = _static_following(system, stiffness, massless, kept)
    k = stiffness[np.ix_(kept, kept)] + stiffness[np.ix_(kept, massless)] @ follow
    m = mass[np.ix_(kept, kept)]
    load = system.load[kept] + follow.T @ system.load[massless]
    inertia = system.inertia_load[kept]
    psi, phi, omega2, static = _interface_modes(system, k, m, kept, n_b)
    to_kept_b = np.vstack([np.eye(n_b), psi])
    to_kept_e = np.vstack([np.zeros((n_b, phi.shape[1])), phi])
    expand_b, expand_e = np.zeros((n_free, n_b)), np.zeros((n_free, phi.shape[1]))
    still = np.zeros((n_free, static.shape[1]))
    for expand, part in (
        (expand_b, to_kept_b),
        (expand_e, to_kept_e),
        (still, np.vstack([np.zeros((n_b, static.shape[1])), static])),
    ):
        expand[kept] = part
        expand[massless] = follow @ part
    offset = still @ (static.T @ load[n_b:])
    offset[massless] += offset_m
    damping_e, beta = mode_damping(damping, omega2)
    basis = Basis(
        bearing_dofs=touched,
        expand_b=expand_b,
        expand_e=expand_e,
        offset=offset,
        still=_still_shapes(stiffness, massless, still) if len(system.parts.kind) else still[:, :0],
        mass_b=symmetric(to_kept_b.T @ m @ to_kept_b),
        mass_be=to_kept_b.T @ m @ to_kept_e,
        mass_e=np.ones(len(omega2)),
        stiffness_b=symmetric(to_kept_b.T @ k @ to_kept_b),
        damping_b=symmetric(beta * (expand_b.T @ elastic @ expand_b)),
        omega2=omega2,
        damping_e=damping_e,
        damping_be=np.zeros((0, 0)),
        damping_ee=np.zeros((0, 0)),
        load_b=to_kept_b.T @ load,
        load_e=to_kept_e.T @ load,
        inertia_b=to_kept_b.T @ inertia,
        inertia_e=to_kept_e.T @ inertia,
    )
    if not system.damping.nnz:
        return basis
    still = np.hstack([np.eye(n_free)[:, massless], still])
    return with_matrix_damping(basis, system.damping.toarray(), stiffness, still)


def _static_following(
    system: System, stiffness: FloatArray, massless: IntArray, kept: IntArray
) -> tuple[FloatArray, FloatArray]:
    # Displacement of massless DOFs by the kept ones, and by their own loads.
    if not len(massless):
        return np.zeros((0, len(kept))), np.zeros(0)
    block = stiffness[np.ix_(massless, massless)]
    right = np.column_stack([-stiffness[np.ix_(massless, kept)], system.load[massless]])
    try:
        solution = solve_positive(block, right, "stiffness", _labels(system, massless))
    except linalg.LinAlgError as error:
        label = _largest(system, weakest(block), massless)
        message = (
            f'the structure is unstable under its permanent loads near "{label}" (a degree of '
            "freedom without mass): reduce the loads or stiffen the members there"
        )
        raise ModelError(message) from error
    return solution[:, :-1], solution[:, -1]


def _still_shapes(stiffness: FloatArray, massless: IntArray, static: FloatArray) -> FloatArray:
    # Shapes of stiffness 1 of all that has no mass; `static` are those of modes without.
    if not len(massless):
        return static
    lower = linalg.cholesky(stiffness[np.ix_(massless, massless)], lower=True)
    own = np.zeros((len(stiffness), len(massless)))
    own[massless] = linalg.solve_triangular(lower, np.eye(len(massless)), lower=True).T
    return np.hstack([own, static])


def _interface_modes(
    system: System, k: FloatArray, m: FloatArray, kept: IntArray, n_b: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    # Quasi-static following of b; with b held the mass-normalised modes, their squared
    # frequencies, and shapes without mass.
    if len(kept) == n_b:
        return np.zeros((0, n_b)), np.zeros((0, 0)), np.zeros(0), np.zeros((0, 0))
    inner = k[n_b:, n_b:]
    try:
        omega2, phi, static = natural_modes(inner, m[n_b:, n_b:])
    except UnstableError as error:
        label = _largest(system, error.direction, kept[n_b:])
        message = (
            "the structure buckles under its permanent loads on a fixed base, at "
            f'"{label}": reduce the loads or stiffen columns'
        )
        raise ModelError(message) from error
    names = _labels(system, kept[n_b:])
    psi = -solve_positive(symmetric(inner), k[n_b:, :n_b], "stiffness", names)
    return psi, phi, omega2, static


def _labels(system: System, places: IntArray) -> list[str]:
    return [system.dof_labels[place] for place in places.tolist()]


def _largest(system: System, direction: FloatArray, places: IntArray) -> str:
    # Name of the largest displacement of a direction over some of the free ones.
    place = int(places[int(np.argmax(np.abs(direction)))])
    return system.dof_labels[place]


def mode_damping(damping: Damping | None, omega2: FloatArray) -> tuple[FloatArray, float]:
    """Return damping constants of modes, and the factor of stiffness for the base's deformation.

    Shapes: omega2 (n_e,).
    """
    omega = np.sqrt(omega2)
    if isinstance(damping, ModalDamping):
        ratios = np.full(len(omega), damping.ratios[-1])
        first = min(len(omega), len(damping.ratios))
        ratios[:first] = damping.ratios[:first]
        return 2.0 * ratios * omega, 0.0
    if isinstance(damping, RayleighDamping):
        w1, w2 = (2.0 * np.pi / period for period in damping.periods)
        beta = 2.0 * damping.ratio / (w1 + w2)
        alpha = beta * w1 * w2
        return alpha + beta * omega2, float(beta)
    return np.zeros(len(omega)), 0.0
