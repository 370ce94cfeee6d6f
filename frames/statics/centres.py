"""Centres of mass and of stiffness of a frame's floors, and its stiffness against lifting."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames.assembly.assemble import assemble
from frames.assembly.solvers import Factors
from frames.model.components import bearing_axial_stiffness
from frames.statics.springs import guessed_springs, held_springs

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.frame_data import FrameData

_TURNS = 1e-9  # of the plan's diagonal squared: less rotation gives no centre of stiffness


class FloorCentres(NamedTuple):
    """A level of a frame in plan."""

    level: str
    z: float  # m
    mass: float  # kg
    mass_centre: tuple[float, float]  # m
    # place at which a lateral force does not rotate the level, the bearings held [m]; NaN if it
    # cannot rotate
    stiffness_centre: tuple[float, float]
    sides: tuple[float, float]  # extent of the level's nodes along x and y [m]


def floor_centres(frame: FrameData) -> list[FloorCentres]:
    """Return the centres of mass and stiffness of each level above the bearings, from below [m].

    The centre of stiffness is the place at which a force on this level alone, spread as its masses,
    rotates them by zero in the mean; the other levels are free, the bearings held. On a rigid
    diaphragm it is the centre of rigidity of usual programs.
    """
    system = assemble(frame)
    index = {name: k for k, name in enumerate(system.node_names)}
    factors = Factors(sparse.csr_array(system.stiffness + held_springs(system)))
    found = []
    for level in sorted(frame.levels, key=lambda one: one.z):
        places = _places(frame, level.nodes, index)
        mass = system.node_mass[places, 0]
        if not mass.sum() > 0.0:
            continue
        plan = system.coordinates[places, :2]
        centre, sides = np.average(plan, axis=0, weights=mass), np.ptp(plan, axis=0)
        moved = _generalised(len(system.node_names), places, mass, plan - centre)
        loads = np.asarray(system.transform.T @ moved)
        offset = _offset(loads.T @ factors.solve(loads), sides)
        (x, y), (u, v), (a, b) = map(np.ndarray.tolist, (centre, centre + offset, sides))
        total = float(mass.sum())
        found.append(FloorCentres(level.name, level.z, total, (x, y), (u, v), (a, b)))
    return found


def _places(frame: FrameData, nodes: tuple[str, ...], index: dict[str, int]) -> list[int]:
    # A level's nodes, and those of the diaphragms that tie them.
    tied = [one.nodes for one in frame.diaphragms.values() if {*one.nodes} & {*nodes}]
    names = dict.fromkeys([*nodes, *(node for group in tied for node in group)])
    return [index[name] for name in names]


def _generalised(count: int, places: list[int], mass: FloatArray, arm: FloatArray) -> FloatArray:
    # Nodal forces (6 n_nodes, 3): along x and y, and a moment, as the masses times their movement.
    share, turning = mass / mass.sum(), mass / (mass @ np.sum(arm**2, axis=1) or np.inf)
    forces = np.zeros((count, 6, 3))
    forces[places, 0, 0] = forces[places, 1, 1] = share
    forces[places, 0, 2] = -arm[:, 1] * turning
    forces[places, 1, 2] = arm[:, 0] * turning
    return forces.reshape(-1, 3)


def _offset(flexible: FloatArray, sides: FloatArray) -> FloatArray:
    # From the centre of mass to that of stiffness, by the flexibility of x, y and the rotation.
    turn = flexible[2, 2]
    if not turn * float(sides @ sides) > _TURNS * flexible[:2, :2].trace():
        return np.full(2, np.nan)
    return np.asarray(np.array([-flexible[1, 2], flexible[0, 2]]) / turn)


def lifting_stiffness(frame: FrameData) -> dict[str, float]:
    """Return the force per metre that lifts the structure off each bearing alone [N/m].

    The other bearings are linear springs; the lift is that of the node above the bearing.
    """
    system = assemble(frame)
    factors = Factors(sparse.csr_array(system.stiffness + guessed_springs(system)))
    rows = system.bearing_rows.toarray().reshape(-1, 12, len(system.dof_labels))
    apart = rows[:, 8] - rows[:, 2]
    moved = np.einsum("bq,qb->b", apart, factors.solve(apart.T))
    own = [bearing_axial_stiffness(placed.bearing) for placed in system.bearings]
    names = [placed.name for placed in system.bearings]
    each = zip(names, moved, own, strict=True)
    return {name: max(0.0, 1.0 / float(f) - float(k)) for name, f, k in each}
