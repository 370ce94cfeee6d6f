"""Bearings under a model that OpenSeesPy holds on fixed supports, in one call."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from lir_element.argument_checks import listed, require_choice, require_positive
from lir_element.device.bearing import LIRBearing
from lir_element.device.features import LEVELS, Level
from lir_element.opensees.base_nodes import (
    BASE_ROTATIONS,
    bearings_by_node,
    check_base,
    check_ties,
    doubts,
    new_tags,
    not_alone,
    release,
)
from lir_element.opensees.connection import signals_held
from lir_element.opensees.library import opensees
from lir_element.opensees.plugin import (
    ROUTES,
    TANGENTS,
    Route,
    Tangent,
    bearing_element,
    element_tags,
)

BaseRotations = Literal["kept", "free", "fixed"]
_AXES = {"y": 1, "z": 2}


class IsolationWarning(UserWarning):
    """Warning: bearings under a model need attention.

    Examples
    --------
    >>> import warnings
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import isolate, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     isolation = isolate([1], bearing)
    >>> str(told[0].message).split(":")[0]
    'the base nodes have no mass, so the analysis needs small steps'
    >>> ops.wipe()
    """


@dataclass(frozen=True)
class Isolation:
    """Bearings under a model.

    Attributes
    ----------
    elements : dict of int to int
        Tags of the bearings' elements by base node.
    grounds : dict of int to int
        Tags of the fixed nodes below, by base node.
    routes : dict of int to str
        Coupling routes, "fast" or "portable", by base node.
    released : dict of int to tuple of int
        Degrees of freedom (1 to 6) of the base nodes that were fixed and are free now.
    held : dict of int to tuple of int
        Degrees of freedom of the base nodes that are fixed now.
    tied : tuple of tuple of int
        Base nodes that move in plan as one rigid body.
    tangent : str
        Tangent of the bearings, "consistent" or "symmetric".
    notes : tuple of str
        Warnings about the model.

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import isolate, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> ops.mass(1, 2e4, 2e4, 2e4, 0.0, 0.0, 0.0)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> isolation = isolate([1], bearing)
    >>> isolation.elements, isolation.grounds
    ({1: 1}, {1: 2})
    >>> ops.wipe()
    """

    elements: dict[int, int]
    grounds: dict[int, int]
    routes: dict[int, str]
    released: dict[int, tuple[int, ...]]
    held: dict[int, tuple[int, ...]]
    tied: tuple[tuple[int, ...], ...]
    tangent: str
    notes: tuple[str, ...]

    def __str__(self) -> str:
        """Return a short description."""
        bases = list(self.elements)
        released = sorted({dof for dofs in self.released.values() for dof in dofs})
        held = sorted({dof for dofs in self.held.values() for dof in dofs})
        lines = [
            f"{len(bases)} bearings under nodes {listed(bases)}: elements "
            f"{listed(list(self.elements.values()))}, fixed nodes "
            f"{listed(list(self.grounds.values()))} below",
            f"degrees of freedom released {released}, held {held}",
        ]
        if self.tied:
            lines.append(f"{len(self.tied)} rigid diaphragm(s) over the base nodes")
        system = "an unsymmetric system, for example system('UmfPack')"
        if self.tangent == "symmetric":
            system = "any system, as system('BandSPD')"
        lines.append(f"find equilibrium next; constraints('Transformation') and {system}")
        return "\n".join([*lines, *self.notes])


@signals_held()  # an interruption would leave half of it
def isolate(
    base_nodes: Sequence[int],
    bearing: LIRBearing | Mapping[int, LIRBearing],
    *,
    level: Level = "pendulum",
    route: Route = "auto",
    vertical: Literal["y", "z"] = "z",
    base_rotations: BaseRotations = "kept",
    base_diaphragm: bool = True,
    tags: Sequence[int] | None = None,
    ground_tags: Sequence[int] | None = None,
    length_unit: float = 1.0,
    force_unit: float = 1.0,
    tangent: Tangent = "consistent",
) -> Isolation:
    """Put bearings under the current OpenSeesPy model, at its supports.

    Each base node gets a fixed node `bearing.height` below it and a bearing between both. Its own
    supports are released: the translations and the rotation about the vertical.

    Parameters
    ----------
    base_nodes : sequence of int
        Tags of the nodes that get bearings.
    bearing : LIRBearing or mapping
        One bearing for all base nodes, or one by tag.
    level : {"pendulum", "contact"}
        Level of fidelity.
    route : {"auto", "fast", "portable"}
        Fidelity level, as for `bearing_element`.
    vertical : {"z", "y"}
        Axis of the model that points up.
    base_rotations : {"kept", "free", "fixed"}
        Rotations of the base nodes about horizontal axes: held if the model holds them (as stiff
        base beams would), free (of a model that has base beams), or held.
    base_diaphragm : bool
        True if base nodes at one elevation move in plan as one rigid body, as on a base slab.
    tags, ground_tags : sequence of int, optional
        Tags of the new elements and of the fixed nodes, one for each base node; if None, free ones
        above the largest.
    length_unit, force_unit : float
        The model's units [m], [N]: 0.001 and 1000 for mm and kN. Time is in seconds.
    tangent : {"consistent", "symmetric"}
        As for `bearing_element`: True allows a `system` for symmetric matrices.

    Returns
    -------
    Isolation
        Tags, nodes and released supports; `print` it for a short description.

    Raises
    ------
    ValueError
        If an input or the model does not suit; the model is unchanged.
    TypeError
        If a bearing is not a LIRBearing, or a tag or unit no number.
    RuntimeError
        If the requested route is not possible; the model is unchanged.

    Warns
    -----
    IsolationWarning
        If an element holds a base node beside its bearing, or the base has no mass.

    Notes
    -----
    For models of three dimensions with six degrees of freedom at each base node, linear or not.
    In the plane (ndm 2, ndf 3) put the bearings by `bearing_element`, one by one.

    The superstructure must leave the base free to rise: a pendulum rises as it moves, by ``U**2 /
    (2 L)``. An old vertical spring under a column, a tie to the ground or a stiff wall on fixed
    supports resists the rise. So the loads of the bearings change. Supports
    (`base_rotations`), base beams or continuous columns must hold the rotations of the upper plates
    about horizontal axes. A bearing does not.

    Call it while the base nodes are at their initial places, before the gravity analysis or after
    it. Then find equilibrium (one static step at least), because the bearings now carry the loads.
    ``rayleigh`` does not act on the bearings. Its part by mass, and modal damping, also damp the
    motion of the whole building on them.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> from lir_element.opensees import isolate, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> ops.mass(1, 2e4, 2e4, 2e4, 0.0, 0.0, 0.0)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> isolation = isolate([1], bearing)
    >>> isolation.elements, isolation.grounds, isolation.released, isolation.held
    ({1: 1}, {1: 2}, {1: (1, 2, 3, 6)}, {1: (4, 5)})
    >>> ops.wipe()
    """
    ops = opensees()
    metre = require_positive("length_unit", length_unit, "m")
    require_positive("force_unit", force_unit, "N")
    require_choice("level", level, LEVELS)
    require_choice("route", route, ROUTES)
    require_choice("tangent", tangent, TANGENTS)
    require_choice("vertical", vertical, tuple(_AXES))
    require_choice("base_rotations", base_rotations, BASE_ROTATIONS)
    devices = bearings_by_node(base_nodes, bearing)
    bases = list(devices)
    up = _AXES[vertical]
    check_base(ops, bases, metre)
    grounds = new_tags(ops.getNodeTags(), ground_tags, bases, "ground_tags", "node")
    elements = new_tags(element_tags(ops), tags, bases, "tags", "element")
    groups = not_alone(ops, bases, up, metre) if base_diaphragm else []
    check_ties(ops, bases, groups)
    notes = doubts(ops, bases, up)
    routes: dict[int, str] = {}
    made: list[int] = []
    axis = [float(k == up) for k in range(3)]
    try:
        for tag, device in devices.items():
            point = list(ops.nodeCoord(tag))
            point[up] -= device.height / metre
            ops.node(grounds[tag], *point, "-ndf", 6)
            made.append(grounds[tag])
            routes[tag] = bearing_element(
                elements[tag],
                grounds[tag],
                tag,
                device,
                level,
                axis,
                route,
                length_unit=length_unit,
                force_unit=force_unit,
                tangent=tangent,
            )
    except (ValueError, TypeError, RuntimeError):
        for tag in routes:
            ops.remove("element", elements[tag])
        for node in made:
            ops.remove("node", node)
        raise
    released, held = {}, {}
    ops.model("basic", "-ndm", 3, "-ndf", 6)  # `fix` counts freedoms by these
    for tag in bases:
        ops.fix(grounds[tag], 1, 1, 1, 1, 1, 1)
        released[tag], held[tag] = release(ops, tag, up, base_rotations)
    for group in groups:
        ops.rigidDiaphragm(up + 1, *group)
    for note in notes:
        warnings.warn(note, IsolationWarning, stacklevel=3)
    return Isolation(
        elements=elements,
        grounds=grounds,
        routes=routes,
        released=released,
        held=held,
        tied=tuple(tuple(group) for group in groups),
        tangent=tangent,
        notes=tuple(notes),
    )
