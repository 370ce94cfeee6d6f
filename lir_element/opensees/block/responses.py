"""Responses of a bearing under the names of OpenSees' own bearings, as maps of its DOFs.

Local axes are those of OpenSees' bearings: x along the bearing's axis from node i to node j (the
bearing's z), y along the bearing's x, z along its y. Entries are in the model's units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.errors import RunStatus
from lir_element.opensees.block.layout import (
    CONSTANT,
    FROM_DISPLACEMENT,
    FROM_FORCE,
    HINT,
    LOAD_HIGH,
    LOAD_LOW,
    NEVER_LOADED,
    NOT_SAVED,
    TOLD_ENOUGH,
)

if TYPE_CHECKING:
    from lir_element.layout import Floats
    from lir_element.opensees.placement import BearingTransform, PlacedBearing

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
"""Names of the force in global axes; OpenSees also calls it "force"."""


class HostResponse(NamedTuple):
    """A response that follows from displacements or forces of the model's degrees of freedom."""

    source: int
    """`FROM_DISPLACEMENT`, `FROM_FORCE` or `CONSTANT`."""
    matrix: Floats
    """(n, dofs) by which these are multiplied; of a constant the values, (n,)."""


def host_responses(placement: BearingTransform) -> dict[str, HostResponse]:
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


def local_axes(placement: BearingTransform) -> Floats:
    """Return the matrix that turns the model's degrees of freedom to local axes, (dofs, dofs)."""
    rows = placement.axes[_LOCAL]
    turn = np.zeros((12, 12))
    for block in range(4):
        turn[3 * block : 3 * block + 3, 3 * block : 3 * block + 3] = rows
    if placement.dofs == 12:
        return turn
    kept = [0, 1, 5, 6, 7, 11]  # ux, uy, rz of the plane; axial, shear and local z rotation
    return turn[np.ix_(kept, kept)]


HINTED = np.zeros(1, dtype=np.int64)
"""1 once a failed step of this process was explained."""


def bearing_messages(placed: PlacedBearing) -> dict[int, str]:
    """Return the messages of a bearing."""
    who, placement = f"bearing element {placed.tag}", placed.placement
    design_load = placed.device.resolved()["design_load"]
    load = f"its design load, {design_load:g} N ({design_load / placement.force_unit:g} of the"
    units = (
        "What to try: check the model's loads and units (length_unit, force_unit of "
        "bearing_element), or set design_load of the bearing."
    )
    up = ", ".join(f"{each:g}" for each in placement.axes[2])
    texts = {
        int(status): f"{who}: {status.meaning}. What to try: {status.remedy}."
        for status in RunStatus
    }
    texts[NEVER_LOADED] = (
        f"{who} found no equilibrium, and was never in compression along its axis "
        f"({up}). What to try: set orient=(0, 1, 0) if y is vertical; apply the weight "
        "first."
    )
    texts[LOAD_LOW] = (
        f"{who} carries less than an eighth of {load} model's units) as it begins to move. {units}"
    )
    texts[LOAD_HIGH] = f"{who} carries more than eight times {load} model's units). {units}"
    texts[TOLD_ENOUGH] = f"{who}: further trials without equilibrium are not reported."
    texts[NOT_SAVED] = (
        f"{who} is neither saved to nor restored from a database. What to try: repeat "
        "the analysis up to this point, or run several analyses in one process."
    )
    texts[HINT] = (
        "a step failed in a model with LIR bearings. Try algorithm KrylovNewton or "
        "smaller steps. A symmetric system (ProfileSPD, BandSPD, SparseSYM) cannot "
        "solve the unsymmetric tangent: use UmfPack, BandGeneral or FullGeneral, or "
        'tangent="symmetric" in bearing_element.'
    )
    return {number: f"WARNING {text}\n" for number, text in texts.items()}
