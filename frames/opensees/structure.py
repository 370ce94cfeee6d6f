"""Import of an OpenSees model: options, matrices, loads, masses and doubts."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from frames._errors import ModelError, argument, in_python
from frames.model.superelement import lumped
from lir_element.argument_checks import listed, require_non_negative
from lir_element.elevations import SAME_PLACE
from lir_element.opensees.base_nodes import bearings_by_node
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, SparseMatrix
    from lir_element import LIRBearing


@dataclass(frozen=True)
class Options:
    """Options of `Frame.from_opensees`."""

    base_nodes: Sequence[int]
    bearing: LIRBearing | Mapping[int, LIRBearing]
    vertical: str | None
    base_rotations: str
    base_diaphragm: bool
    gravity: float | None
    damping: bool
    levels: Mapping[str, Sequence[int]] | None
    other_supports: Collection[int]
    accept_nonlinear: bool
    vertical_mass: str | Mapping[int, float] | None
    length_unit: float
    force_unit: float

    @cached_property
    def bearings(self) -> dict[int, LIRBearing]:
        """Bearings by base node, in the order of those."""
        return bearings_by_node(self.base_nodes, self.bearing, error=ModelError)

    @property
    def bases(self) -> tuple[int, ...]:
        """Tags of the nodes above bearings."""
        return tuple(self.bearings)


def turning(ndm: int, vertical: str | None) -> tuple[FloatArray, FloatArray]:
    """Return how vectors and displacements of a node turn from the model's axes to the frame's.

    Shapes: result (3, 3).
    """
    y_up = ndm == 2 or vertical == "y"
    axes = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]) if y_up else np.eye(3)
    return axes, np.kron(np.eye(2), axes)[:, [0, 1, 5] if ndm == 2 else list(range(6))]


@dataclass(frozen=True, eq=False)
class Structure:
    """The model in axes of the frame (z up) and SI units, six displacements a node."""

    tags: tuple[int, ...]
    coordinates: FloatArray
    matrices: dict[str, SparseMatrix]  # mass, damping, stiffness
    initial: SparseMatrix  # stiffness of the elements before any load
    fixed: BoolArray  # (n, 6), true if held
    present: BoolArray  # (n, 6), false for displacements that the model does not have
    equations: SparseMatrix
    load: FloatArray  # (6 n,)


_LOADED = 1e-3  # of the weight of the masses, from which on a model counts as loaded
_RIGID_DAMPING = 0.005  # damping ratio of the rigid motion on the bearings that is worth a warning
_LIGHT = 0.01  # of the whole mass, below which the base counts as without mass
_RATIO = (0.2, 5.0)  # weight over mass times gravity that raises no doubt about the units


def permanent_load(structure: Structure, options: Options) -> tuple[FloatArray, list[str]]:
    """Return the load of the bearings."""
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
            f"the OpenSees model carries a vertical load of {weight:.4g} N, but its masses "
            f"weigh {usual:.4g} N: analyse its gravity loads first, or apply the weight of "
            f"the masses, {argument('gravity', 9.81)}"
        )
        raise ModelError(message)
    if options.gravity is not None and is_loaded:
        message = (
            f"gravity = {options.gravity:g} m/s2, but the OpenSees model already carries "
            f"{weight:.4g} N of vertical load: leave gravity out, or import the model "
            "without loads"
        )
        raise ModelError(message)
    notes = []
    if options.gravity is not None:
        load = load - options.gravity * pull
        weight = 0.0 - float(load[2::6].sum())
        if lifted < 0.999 * moving:
            notes.append(
                f"the masses along the vertical are {lifted:.4g} kg, those along x "
                f"{moving:.4g} kg: masses without a vertical part have no weight"
            )
    if usual > 0.0 and not _RATIO[0] < weight / usual < _RATIO[1]:
        notes.append(
            f"weight {weight:.4g} N over mass times {STANDARD_GRAVITY:g} m/s2 is "
            f"{weight / usual:.3g}: check the units, and pass length_unit [m] and force_unit "
            "[N] if the model is not in N, m and kg"
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
        "the damping of the OpenSees model (mass-proportional or modal) also damps the "
        f"isolation mode, by {100.0 * ratio:.1f} % of critical at "
        f"{2.0 * math.pi / omega:.2f} s, as in OpenSees: leave it out by "
        f"{argument('damping', False)}"
        + in_python(", and damp the structure alone by frame.set_damping(ModalDamping(0.02))")
    ]


def light_base(structure: Structure, options: Options) -> list[str]:
    """Return bases without mass: friction there acts on no inertia."""
    moved = lumped(structure.matrices["mass"])[:, 0]
    bases = [structure.tags.index(tag) for tag in options.bases]
    if moved[bases].sum() > _LIGHT * moved.sum():
        return []
    return [
        f"the base nodes have {moved[bases].sum():.4g} kg of {moved.sum():.4g} kg, so "
        "the base vibrates at high frequency and steps become small: add the mass of "
        f"the slab above the bearings, ops.mass({options.bases[0]}, ...) before"
        + in_python(f', or frame.add_mass("{options.bases[0]}", kg) afterwards')
    ]


HORIZONTAL = "horizontal"
"""The option that lets masses act along the vertical as they do along x."""

_NONE = 1e-6  # of the mass along x, below which a model counts as without vertical mass
_FEW = 0.5  # of the same, below which that is worth a note


def with_vertical_mass(
    structure: Structure, given: str | Mapping[int, float] | None
) -> tuple[SparseMatrix, list[str]]:
    """Return the mass of a structure with the vertical mass of the option."""
    mass = structure.matrices["mass"]
    own = lumped(mass)
    rises = ~structure.fixed[:, 2]
    if isinstance(given, Mapping):
        more = _given(structure, given, rises)
    elif given == HORIZONTAL:
        more = _as_horizontal(structure, own, rises)
    elif given is None:
        more = np.zeros(len(own))
    else:
        message = (
            f'vertical_mass = {given!r}: use "horizontal", masses in kg by tag of node, or None'
        )
        raise ModelError(message)
    moving, lifted = float(own[:, 0].sum()), float((own[:, 2] + more)[rises].sum())
    if lifted <= _NONE * moving:
        message = (
            f"the OpenSees model has {moving:.4g} kg along x, but no vertical mass on free "
            'nodes: pass vertical_mass="horizontal" to use the same masses vertically, or '
            "vertical_mass={tag: kg, ...} (the weight stays)"
        )
        raise ModelError(message)
    notes = []
    if lifted < _FEW * moving:
        notes.append(
            f"the vertical mass is {lifted:.4g} kg, the mass along x {moving:.4g} kg: pass "
            'vertical_mass="horizontal" if the rest also moves vertically'
        )
    diagonal = np.zeros((len(own), 6))
    diagonal[:, 2] = more
    return sparse.csr_array(mass + sparse.diags_array(diagonal.ravel())), notes


def _given(structure: Structure, given: Mapping[int, float], rises: BoolArray) -> FloatArray:
    more = np.zeros(len(structure.tags))
    for tag, value in given.items():
        number = require_non_negative(
            f"vertical_mass [kg] of node {tag}", value, remedy="give kg", error=ModelError
        )
        if tag not in structure.tags or not rises[structure.tags.index(tag)]:
            able = [node for node, free in zip(structure.tags, rises, strict=True) if free]
            message = (
                f"vertical_mass names node {tag}, which does not exist or is fixed "
                f"vertically: use nodes that are free vertically, {listed(able)}"
            )
            raise ModelError(message)
        more[structure.tags.index(tag)] += number
    return more


def _as_horizontal(structure: Structure, own: FloatArray, rises: BoolArray) -> FloatArray:
    lacking = np.maximum(own[:, 0] - own[:, 2], 0.0)
    more = np.where(rises, lacking, 0.0)
    heights = structure.coordinates[:, 2]
    carrying = rises & (structure.matrices["stiffness"].diagonal().reshape(-1, 6)[:, 2] > 0.0)
    for place in np.flatnonzero(~rises & (lacking > 0.0)):
        floor = np.flatnonzero(carrying & (np.abs(heights - heights[place]) < SAME_PLACE))
        if not len(floor):
            message = (
                f"node {structure.tags[place]} has {lacking[place]:.4g} kg, but is fixed "
                "vertically, as are all nodes at its elevation: give vertical_mass by tag"
            )
            raise ModelError(message)
        more[floor] += lacking[place] / len(floor)
    return more
