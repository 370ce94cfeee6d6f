"""Accelerations of what has no mass, or next to none: taken from what has, statically.

A displacement without mass has an acceleration, the second derivative of a static one. It jumps
wherever friction turns round or slips, and no step gives it: in Newmark's rule it rings from step
to step, undamped, and masses that are next to nothing ring so fast that no step follows. What has a
mass is accelerated by the forces on it; the rest is said to be accelerated as the elastic structure
would carry it along, forces of bearings and nonlinear parts on it taken to stay as they are.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np
from scipy import sparse

from frames.assembly.sparse_solver import Factors
from frames.model.components import bearing_axial_stiffness
from frames.statics.springs import spring_matrix

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, SparseMatrix
    from frames.assembly.basis import Basis
    from frames.assembly.system import System

FASTEST = 1e-3
"""Own period of a displacement, all others held, over sqrt(L / g) of the bearings, below which its
mass counts as none: half a millisecond, a tenth of the largest step (a choice)."""

LIGHTEST = 1e-3
"""Besides, of translations: their mass over that on a bearing, of stiff ties between floors' masses
being no masses that are next to nothing (a choice)."""


class AtRest(Protocol):
    """A structure in equilibrium under its permanent loads, as `frames.GravityState` is."""

    @property
    def system(self) -> System:
        """Its matrices over the free degrees of freedom."""
        ...

    @property
    def geometric(self) -> SparseMatrix:
        """Its geometric stiffness."""
        ...

    @property
    def basis(self) -> Basis:
        """The same in bearing coordinates."""
        ...

    @property
    def axial_forces(self) -> FloatArray:
        """Axial forces of its bearings [N]."""
        ...


def accelerating(state: AtRest) -> FloatArray:
    """Return how accelerations of b and eta accelerate the free degrees of freedom.

    Shapes: result (n_free, n_b + n_e).
    """
    basis = state.basis
    found = np.hstack([basis.expand_b, basis.mass_e * basis.expand_e])
    stiffness = present_stiffness(state)
    light = without_inertia(state, stiffness)
    own = state.system.mass.diagonal() > 0.0
    if not (light[basis.bearing_dofs].any() or (light & own).any()):
        return found  # the rest does so in these coordinates
    inner = sparse.csr_array(stiffness[light][:, light])
    alone = inner.diagonal() <= 0.0
    if alone.any():  # held by nothing that is linear: not accelerated
        inner = sparse.csr_array(inner + sparse.diags_array(alone.astype(np.float64)))
    right = np.asarray(stiffness[light][:, ~light] @ found[~light])
    found[light] = -Factors(inner).solve(right)
    return found


def has_light_nodes(state: AtRest) -> bool:
    """Return whether a displacement of the structure has so little mass that it counts as none."""
    light = without_inertia(state, present_stiffness(state))
    return bool((light & (state.system.mass.diagonal() > 0.0)).any())


def present_stiffness(state: AtRest) -> SparseMatrix:
    """Return the stiffness (n_free, n_free) of the structure on bearings pressed as at rest."""
    return sparse.csr_array(state.system.stiffness + state.geometric + _springs(state))


def without_inertia(state: AtRest, stiffness: SparseMatrix) -> BoolArray:
    """Return which free degrees of freedom have no mass, or so little that no step follows it.

    Shapes: stiffness (n_free, n_free), result (n_free,).
    """
    system = state.system
    mass, held = system.mass.diagonal(), stiffness.diagonal()
    length = min(placed.bearing.effective_radius for placed in system.bearings)
    rate = 2.0 * math.pi / (FASTEST * math.sqrt(length / system.gravity))
    carried = float(system.node_mass[:, :3].mean(axis=1).sum()) / len(system.bearings)
    turns = np.array([label.rsplit(" ", 1)[1].startswith("r") for label in system.dof_labels])
    fast = (held > rate**2 * mass) & (turns | (mass < LIGHTEST * carried))
    return np.asarray(~(mass > 0.0) | fast)


def _springs(state: AtRest) -> SparseMatrix:
    # The bearings pressed as at rest: what restores along the pendulum, and the axial contact.
    system = state.system
    values = np.zeros((len(system.bearings), 6))
    for k, (_, _, _, bearing) in enumerate(system.bearings):
        values[k, :2] = state.axial_forces[k] / bearing.effective_radius
        values[k, 2] = bearing_axial_stiffness(bearing)
    return spring_matrix(system, values)
