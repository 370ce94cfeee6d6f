"""Bearings as linear springs between their nodes, and checks of a model before any run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from frames.assembly.assemble import assemble
from frames.assembly.constraints import OUT_OF_PLANE
from frames.assembly.solvers import Factors
from frames.model.components import DOFS, bearing_axial_stiffness, bearing_rocking_stiffness
from lir_element import Features

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion


def guessed_springs(system: System, with_points: Collection[str] = ()) -> SparseMatrix:
    """Return the bearings as linear springs: axial stiffness, a hundredth of it sideways.

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


def have_same_springs(one: System, other: System) -> bool:
    """Return whether the bearings of two systems are the same as linear springs."""
    pairs = zip(one.bearings, other.bearings, strict=True)
    kinds = bearing_axial_stiffness, bearing_rocking_stiffness
    return all(of(a.bearing) == of(b.bearing) for a, b in pairs for of in kinds)


def spring_forces(system: System, displacement: FloatArray) -> FloatArray:
    """Return the axial forces of the bearings as linear springs, compression positive.

    Shapes: displacement (n_free,), result (n_bearings,).
    """
    moves = np.asarray(system.bearing_rows @ displacement).reshape(-1, 12)
    axial = np.array([bearing_axial_stiffness(placed.bearing) for placed in system.bearings])
    return np.asarray(axial * (moves[:, 2] - moves[:, 8]))


def spring_matrix(system: System, values: FloatArray) -> SparseMatrix:
    """Return springs (n_bearings, 6) between the nodes of each bearing, over the free DOFs."""
    rows = system.bearing_rows
    bearing, dof = np.nonzero(values)
    i, size = 12 * bearing + dof, values[bearing, dof]
    j, count = i + 6, 12 * len(values)
    at = np.concatenate([i, i, j, j]), np.concatenate([i, j, i, j])
    blocks = sparse.csr_array((np.concatenate([size, -size, -size, size]), at), (count, count))
    return sparse.csr_array(rows.T @ blocks @ rows)


def held_springs(system: System) -> SparseMatrix:
    """Return springs that hold the bearings: 1,000 times their axial stiffness in x, y, z."""
    values = np.zeros((len(system.bearings), 6))
    axial = [bearing_axial_stiffness(placed.bearing) for placed in system.bearings]
    values[:, :3] = 1e3 * np.array(axial)[:, None]
    return spring_matrix(system, values)


def exact_features(frame: FrameData, motion: GroundMotion) -> Features:
    """Return the features that a run certainly needs, before it starts."""
    system = assemble(frame)
    bearings = [placed.bearing for placed in system.bearings]
    lacking = []
    if bearings and all(b.is_dcfp for b in bearings):
        lacking.append("interface")
    if all(np.isinf(b.rim_displacement).all() for b in bearings):
        lacking.append("rims")
    if all(law.f_max == law.f_min for b in bearings for law in b.frictions):
        lacking.append("velocity_dependence")
    if not motion.components[:, 1].any() and is_plane(system):
        lacking.append("second_direction")
    return Features.all().without(*lacking)


def is_plane(system: System) -> bool:
    """Return True if nothing couples the x-z plane of a frame with motion out of it."""
    outside = np.array([label.rsplit(" ", 1)[1] in OUT_OF_PLANE for label in system.dof_labels])
    across = np.array([dof in OUT_OF_PLANE for dof in DOFS] * len(system.node_names))
    parts = (
        system.stiffness[~outside][:, outside],
        system.mass[~outside][:, outside],
        system.damping[~outside][:, outside],
        system.transform[~across][:, outside],
        system.transform[across][:, ~outside],
    )
    rows = abs(system.part_rows)
    crossing = [np.asarray(rows[:, chosen].sum(axis=1)) > 0.0 for chosen in (outside, ~outside)]
    if (crossing[0] & crossing[1]).any():
        return False
    if any(abs(part).max() > 0.0 for part in parts if part.shape[0] and part.shape[1]):
        return False
    return not (system.load[outside].any() or system.inertia_load[outside][:, [0, 2]].any())


def plane_coupling(frame: FrameData) -> float:
    """Return how far a frame moves along y when it is pushed along x."""
    system = assemble(frame)
    stiffness = sparse.csc_array(system.stiffness + guessed_springs(system))
    moves: FloatArray = spsolve(stiffness, system.inertia_load[:, 0])
    u = np.asarray(system.bearing_rows @ moves).reshape(-1, 12)
    relative = np.abs(u[:, 6:8] - u[:, :2]).max(axis=0)
    return float(relative[1] / relative[0]) if relative[0] > 0.0 else np.inf
