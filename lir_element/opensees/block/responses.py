"""Responses of a bearing by the names that OpenSees' own bearings know, as maps of its DOFs.

Local axes are those of OpenSees' bearings: x along the bearing's axis from node i to node j (the
bearing's z), y along the bearing's x, z along its y. Entries are in the model's units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.opensees.block.layout import CONSTANT, FROM_DISPLACEMENT, FROM_FORCE

if TYPE_CHECKING:
    from lir_element.layout import Floats
    from lir_element.opensees.placement import Placement

_LOCAL = [2, 0, 1]  # the bearing's axes as local x, y, z
_NAMES = {
    "local_force": ("localForce", "localForces"),
    "basic_force": ("basicForce", "basicForces"),
    "local_displacement": ("localDisplacement", "localDisplacements"),
    "deformation": (
        "deformation",
        "deformations",
        "defo",
        "basicDeformation",
        "basicDeformations",
        "basicDefo",
        "basicDisplacement",
        "basicDisplacements",
    ),
}
GLOBAL_NAMES = ("globalForce", "globalForces", "forces")
"""The force in global axes; OpenSees knows it as "force", too."""


class HostResponse(NamedTuple):
    """A response that follows from displacements or forces of the model's degrees of freedom."""

    source: int
    """`FROM_DISPLACEMENT`, `FROM_FORCE` or `CONSTANT`."""
    matrix: Floats
    """(n, dofs) by which these are multiplied; of a constant the values, (n,)."""


def host_responses(placement: Placement) -> dict[str, HostResponse]:
    """Return the responses that OpenSees' own bearings have."""
    turn = local_axes(placement)
    half = len(turn) // 2
    relative = turn[half:] - turn[:half]
    upper = np.where(np.arange(placement.dofs) < half, 0.0, turn[half:])
    force, moved = FROM_FORCE, FROM_DISPLACEMENT
    kinds = {
        "local_force": HostResponse(force, turn),
        "basic_force": HostResponse(force, upper),
        "local_displacement": HostResponse(moved, turn),
        "deformation": HostResponse(moved, relative),
    }
    found = {name: kinds[kind] for kind, names in _NAMES.items() for name in names}
    found |= {name: HostResponse(force, np.eye(placement.dofs)) for name in GLOBAL_NAMES}
    for name, axis in zip(("xaxis", "yaxis", "zaxis"), placement.axes[_LOCAL], strict=True):
        found[name] = HostResponse(CONSTANT, axis)
    return found


def local_axes(placement: Placement) -> Floats:
    """Return the matrix that turns the model's degrees of freedom to local axes, (dofs, dofs)."""
    rows = placement.axes[_LOCAL]
    turn = np.zeros((12, 12))
    for block in range(4):
        turn[3 * block : 3 * block + 3, 3 * block : 3 * block + 3] = rows
    if placement.dofs == 12:
        return turn
    kept = [0, 1, 5, 6, 7, 11]  # ux, uy, rz of the plane; axial, shear and local z rotation
    return turn[np.ix_(kept, kept)]
