"""Bearings as linear springs between their nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from frames.assembly.basis import bearing_rows
from frames.assembly.sparse_solver import Factors
from frames.model.components import bearing_axial_stiffness, bearing_rocking_stiffness

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System


def guessed_springs(system: System, with_points: Collection[str] = ()) -> SparseMatrix:
    """Model the bearings as linear springs: axial stiffness, a hundredth of it sideways.

    Shapes: result (n_free, n_free).
    """
    values = np.zeros((len(system.bearings), 6))
    values[:, 2] = [bearing_axial_stiffness(placed.bearing) for placed in system.bearings]
    values[:, :2] = 0.01 * values[:, 2:3]
    for k, (name, _, _, bearing) in enumerate(system.bearings):
        if name in with_points:
            values[k, 3:] = bearing_rocking_stiffness(bearing)
    return spring_matrix(system, values)


def first_displacement(system: System, with_points: Collection[str] = ()) -> FloatArray:
    """Return the displacements under permanent loads on those springs, linear.

    Shapes: result (n_free,).
    """
    springs = guessed_springs(system, with_points)
    stiffness = sparse.csr_array(system.stiffness + springs)
    factors = Factors(stiffness)
    first = factors.solve(system.load)
    return first + factors.solve(system.load - np.asarray(stiffness @ first))  # round-off


def spring_forces(system: System, displacement: FloatArray) -> FloatArray:
    """Return the axial forces of the bearings as linear springs, compression positive.

    Shapes: displacement (n_free,), result (n_bearings,).
    """
    moves = np.asarray(bearing_rows(system) @ displacement).reshape(-1, 12)
    axial = np.array([bearing_axial_stiffness(placed.bearing) for placed in system.bearings])
    return np.asarray(axial * (moves[:, 2] - moves[:, 8]))


def spring_matrix(system: System, values: FloatArray) -> SparseMatrix:
    """Return springs (n_bearings, 6) between the nodes of each bearing, over the free DOFs."""
    rows = bearing_rows(system)
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    blocks = [sparse.csr_array(np.kron(pair, np.diag(row))) for row in values]
    return sparse.csr_array(rows.T @ sparse.block_diag(blocks, format="csr") @ rows)
