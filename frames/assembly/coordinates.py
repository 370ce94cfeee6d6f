"""A frame in bearing degrees of freedom and fixed-interface modes, as `build_basis` makes it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from frames.assembly.natural_modes import symmetric

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray

_OWN_MASS = 1e-9  # of a coordinate's mass with all that follows it, above which it has its own


@dataclass(frozen=True, repr=False)
class Basis:
    """A frame in bearing coordinates b (n_b) and fixed-interface modes eta (n_e).

    Attributes
    ----------
    bearing_dofs : ndarray, (n_b,)
        Places of b among the free DOFs q.
    expand_b, expand_e : ndarray, (n_free, n_b), (n_free, n_e)
        ``q = expand_b @ b + expand_e @ eta + offset``.
    offset : ndarray, (n_free,)
        Static displacement of what has no mass under its own loads.
    still : ndarray, (n_free, n_still)
        Shapes of what has no mass, of stiffness 1 each; of no size in a linear frame, which does
        not need them.
    mass_b, mass_be : ndarray, (n_b, n_b), (n_b, n_e)
        Mass of b, and what couples it with eta.
    mass_e : ndarray, (n_e,)
        Mass of eta: 1 of the modes, 0 of what lags behind (frames/assembly/matrix_damping.py).
    stiffness_b : ndarray, (n_b, n_b)
        Stiffness without bearings, geometric part included.
    damping_b : ndarray, (n_b, n_b)
        Damping of the base's own deformation.
    omega2, damping_e : ndarray, (n_e,)
        Squared circular frequencies and damping constants (2 zeta omega) of the modes.
    damping_be, damping_ee : ndarray, (n_b, n_e), (n_e, n_e)
        Damping besides that is given as a matrix; of no size where there is none.
    load_b, load_e : ndarray
        Permanent loads.
    inertia_b, inertia_e : ndarray, (n_b, 3), (n_e, 3)
        Loads per unit ground acceleration, with positive sign.
    """

    bearing_dofs: IntArray
    expand_b: FloatArray
    expand_e: FloatArray
    offset: FloatArray
    still: FloatArray
    mass_b: FloatArray
    mass_be: FloatArray
    mass_e: FloatArray
    stiffness_b: FloatArray
    damping_b: FloatArray
    omega2: FloatArray
    damping_e: FloatArray
    damping_be: FloatArray
    damping_ee: FloatArray
    load_b: FloatArray
    load_e: FloatArray
    inertia_b: FloatArray
    inertia_e: FloatArray

    @cached_property
    def mobility(self) -> FloatArray:
        """Accelerations of b under forces on b that eta gives way to, (n_b, n_b) [1/kg, ...].

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
        heavy = self.mass_e > 0.0  # of the modes 1; what lags without mass is not accelerated
        between = self.mass_be[:, heavy]
        left = self.mass_b - between @ between.T
        alone = self.inertia_b - between @ self.inertia_e[heavy]
        of_e = np.zeros_like(self.inertia_e)
        of_b = -linalg.pinvh(symmetric(left)) @ alone
        of_e[heavy] = -self.inertia_e[heavy] - between.T @ of_b
        return np.vstack([of_b, of_e])

    def shift(self, loads: FloatArray) -> FloatArray:
        """Return how loads (n_free, ...) displace what has no mass while b and eta rest."""
        return np.asarray(self.still @ (self.still.T @ loads))

    def __repr__(self) -> str:
        """Return sizes on one line."""
        return f"Basis: {len(self.load_b)} bearing coordinates, {len(self.omega2)} modes"
