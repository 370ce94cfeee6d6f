"""Overturning in the bearings' axial forces, and place of the mass above them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames.assembly.assemble import assemble
from frames.assembly.solvers import Factors
from frames.model.components import bearing_axial_stiffness, bearing_rocking_stiffness
from frames.statics.springs import spring_matrix
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData

FOLLOWS = 0.9
"""Share of an overturning moment from which on axial forces count as following it [-]."""

_NOTHING = 1e-6


class Overturning(NamedTuple):
    """Share of the bearings in an overturning moment, by the direction of the motion."""

    x: float  # share of their axial forces [-]; 1 if there is no moment
    y: float
    bearings: int  # how many bearings there are

    @property
    def follows(self) -> bool:
        """True if the axial forces follow overturning in both directions."""
        return min(self.x, self.y) >= FOLLOWS

    def sentence(self) -> str:
        """Return the reason that axial forces are unknown; empty if they are known."""
        if self.follows:
            return ""
        if self.bearings == 1:
            return joined(
                "the model has one bearing and its tilt is restrained, so the axial force "
                "has no part from overturning",
                "model the bearings at their places in plan, shear_building(..., plan=...)",
            )
        least, axis = min((self.x, "x"), (self.y, "y"))
        held = worded(
            "axial forces of the bearings resist only {share:.3g} % of the overturning "
            "moment of motion along {axis}: supports of the model restrain its tilt",
            share=100.0 * least,
            axis=axis,
        )
        remedy = (
            'free rx and ry of base and floors: base_rotations="free" of an imported model, '
            "overturning=True of a shear building; untie uz of the base where constraints tie it"
        )
        return joined(held, remedy)


def overturning_share(system: System) -> Overturning:
    """Return the share of the bearings' axial forces in an overturning moment [-].

    Two static loads along each direction, bearings as linear springs. In the first every mass above
    the bearings is pushed sideways; its moment about the tops of the bearings is the sum of m (z -
    z_t). The second has vertical forces on the tops of the bearings that rise linearly over the
    plan. The rest of either moment goes to supports that hold the structure's tilt.
    """
    tops = np.array([placed.j for placed in system.bearings])
    mass = np.where(system.above_bearings, system.node_mass[:, 0], 0.0)
    axial = np.array([bearing_axial_stiffness(placed.bearing) for placed in system.bearings])
    rocking = np.array([bearing_rocking_stiffness(placed.bearing) for placed in system.bearings])
    springs = np.column_stack([axial, axial, axial, rocking, rocking, rocking])
    stiffness = sparse.csr_array(system.stiffness + spring_matrix(system, springs))
    factors = Factors(stiffness)
    rows = system.bearing_rows

    def carried(force: FloatArray, axis: int) -> float:
        # Moment of the bearings under nodal forces (n_nodes, 6).
        load = np.asarray(system.transform.T @ force.ravel())
        moved = factors.solve(load)
        moved = moved + factors.solve(load - np.asarray(stiffness @ moved))  # round-off
        ends = np.asarray(rows @ moved).reshape(-1, 2, 6)
        apart = ends[:, 1] - ends[:, 0]
        turn = apart[:, 4] if axis == 0 else -apart[:, 3]
        levers = system.coordinates[tops, axis] - system.coordinates[tops, axis].mean()
        return float((-axial * apart[:, 2] * levers + rocking * turn).sum())

    shares = []
    for axis in (0, 1):
        sideways = np.zeros((len(mass), 6))
        sideways[:, axis] = mass
        if not np.asarray(system.transform.T @ sideways.ravel()).any():
            shares.append(1.0)  # no motion in that direction
            continue
        upright = np.zeros((len(mass), 6))
        lever = system.coordinates[tops, axis] - system.coordinates[tops, axis].mean()
        np.add.at(upright[:, 2], tops, -lever)
        height = system.coordinates[:, 2] - system.coordinates[tops, 2].mean()
        size = float(np.linalg.norm(np.ptp(system.coordinates, axis=0)))
        least = _NOTHING * size * float(mass.sum())
        moments = [(sideways, float(mass @ height), least)]
        moments.append((upright, float(lever @ lever), _NOTHING * size**2))
        found = [
            carried(force, axis) / moment for force, moment, bound in moments if moment > bound
        ]
        shares.append(min((share for share in found if math.isfinite(share)), default=1.0))
    return Overturning(shares[0], shares[1], len(tops))


def unknown_axial_forces(frame: FrameData) -> str:
    """Return the reason that bearings' axial forces are unknown; empty if they are known."""
    return overturning_share(assemble(frame, None, tuple(frame.bearings))).sentence()


def mass_centre(system: System) -> tuple[float, float]:
    """Return x and y of the centre of the masses above the bearings [m]."""
    mass = np.where(system.above_bearings, system.node_mass[:, 0], 0.0)
    total = float(mass.sum())
    if total <= 0.0:
        return math.nan, math.nan
    x, y = mass @ system.coordinates[:, :2] / total
    return float(x), float(y)
