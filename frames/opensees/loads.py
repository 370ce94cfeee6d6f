"""What bearings under an OpenSees model carry; what is doubtful in its masses and damping."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames._remedies import argument, in_python
from frames.model.superelement import lumped
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.opensees.structure import Options, Structure

_LOADED = 1e-3  # of the weight of the masses, from which on a model counts as loaded
_RIGID_DAMPING = 0.005  # damping ratio of the rigid motion on the bearings that is worth a warning
_LIGHT = 0.01  # of the whole mass, below which the base counts as without mass
_RATIO = (0.2, 5.0)  # weight over mass times gravity that raises no doubt about the units


def permanent_load(structure: Structure, options: Options) -> tuple[FloatArray, list[str]]:
    """Find what the bearings have to carry."""
    count = len(structure.tags)
    units = [np.tile(np.eye(6)[axis], count) for axis in range(3)]
    mass = structure.matrices["mass"]
    pull = mass @ units[2]
    moving, lifted = float(units[0] @ mass @ units[0]), float(units[2] @ pull)
    load = structure.load
    weight = 0.0 - float(load[2::6].sum())
    usual = STANDARD_GRAVITY * moving
    is_loaded = weight > _LOADED * usual if usual > 0.0 else weight > 0.0
    if options.gravity is None and not is_loaded:
        message = (
            f"the OpenSees model carries a vertical load of {weight:.4g} N, its masses would weigh "
            f"{usual:.4g} N: analyse its gravity loads first, or let its masses weigh, "
            f"{argument('gravity', 9.81)}"
        )
        raise ModelError(message)
    if options.gravity is not None and is_loaded:
        message = (
            f"gravity = {options.gravity:g} m/s2, but the OpenSees model carries a vertical load "
            f"of {weight:.4g} N already: leave gravity out, or take the model over without loads"
        )
        raise ModelError(message)
    notes = []
    if options.gravity is not None:
        load = load - options.gravity * pull
        weight = 0.0 - float(load[2::6].sum())
        if lifted < 0.999 * moving:
            notes.append(
                f"the masses along the vertical are {lifted:.4g} kg, those along x {moving:.4g} "
                "kg: what has no vertical mass does not weigh"
            )
    if usual > 0.0 and not _RATIO[0] < weight / usual < _RATIO[1]:
        notes.append(
            f"weight {weight:.4g} N over mass times {STANDARD_GRAVITY:g} m/s2 is "
            f"{weight / usual:.3g}: check the units, and pass length_unit [m] and force_unit [N] "
            "where the model is not in N, m and kg"
        )
    return load, notes


def rigid_damping(structure: Structure, options: Options) -> list[str]:
    """Measure how far the damping acts on the building as a whole, moving on its bearings."""
    length = float(np.mean([b.effective_radius for b in options.bearings.values()]))
    omega = math.sqrt(STANDARD_GRAVITY / length)
    unit = np.tile(np.eye(6)[0], len(structure.tags))
    mass = float(unit @ structure.matrices["mass"] @ unit)
    force = float(unit @ structure.matrices["damping"] @ unit)
    ratio = force / (2.0 * omega * mass) if mass > 0.0 else 0.0
    if ratio <= _RIGID_DAMPING:
        return []
    return [
        f"the damping of the OpenSees model (mass-proportional or modal) also damps the motion of "
        f"the whole building on its bearings, by {100.0 * ratio:.1f} % of critical at their "
        f"period of {2.0 * math.pi / omega:.2f} s, as it does in OpenSees; "
        f"{argument('damping', False)} leaves it out"
        + in_python(", frame.set_damping(ModalDamping(0.02)) damps the structure alone")
    ]


def light_base(structure: Structure, options: Options) -> list[str]:
    """Note bases without mass: friction then acts on nothing that has inertia."""
    moved = lumped(structure.matrices["mass"])[:, 0]
    bases = [structure.tags.index(tag) for tag in options.base_nodes]
    if moved[bases].sum() > _LIGHT * moved.sum():
        return []
    return [
        f"the base nodes have {moved[bases].sum():.4g} kg of {moved.sum():.4g} kg: a base without "
        "mass rings, and steps become small; give them the mass of the slab above the bearings, "
        f"ops.mass({options.base_nodes[0]}, ...) and so on before"
        + in_python(f', or frame.add_mass("{options.base_nodes[0]}", kg) afterwards')
    ]
