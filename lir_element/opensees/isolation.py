"""Bearings under a model that OpenSeesPy holds on fixed supports, in one call."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from lir_element.device.bearing import LIRBearing
from lir_element.door import require_choice, require_positive
from lir_element.element import LEVELS, Level
from lir_element.opensees.leftovers import leftovers, listed
from lir_element.opensees.library import opensees
from lir_element.opensees.plugin import ROUTES, Route, bearing_element, element_tags

BaseRotations = Literal["kept", "free", "fixed"]
_ROTATIONS = ("kept", "free", "fixed")
_AXES = {"y": 1, "z": 2}
_AT_REST = 1e-3  # m, which a base node may have moved before
_ONE_LEVEL = 1e-3  # m, within which base nodes are at one elevation
_NO_MASS = 1e-6  # of all nodal masses, below which the base counts as without mass


class IsolationWarning(UserWarning):
    """What should be known of bearings that were put under a model."""


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
        Routes taken, "fast" or "portable", by base node.
    released : dict of int to tuple of int
        Degrees of freedom (1 to 6) of the base nodes that were fixed and are free now.
    held : dict of int to tuple of int
        Degrees of freedom of the base nodes that are fixed now.
    tied : tuple of tuple of int
        Base nodes that move in plan as one rigid body.
    notes : tuple of str
        What should be known; each was a warning, too.
    """

    elements: dict[int, int]
    grounds: dict[int, int]
    routes: dict[int, str]
    released: dict[int, tuple[int, ...]]
    held: dict[int, tuple[int, ...]]
    tied: tuple[tuple[int, ...], ...]
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
        lines.append(
            "find equilibrium next; constraints('Transformation') and an unsymmetric system, "
            "as system('UmfPack'), are needed"
        )
        return "\n".join([*lines, *self.notes])


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
) -> Isolation:
    """Put bearings under the current OpenSeesPy model, which stands on supports.

    Each base node gets a fixed node `bearing.height` below it and a bearing between both. Its own
    supports are released: the translations and the rotation about the vertical.

    Parameters
    ----------
    base_nodes : sequence of int
        Tags of the nodes that shall stand on bearings.
    bearing : LIRBearing or mapping
        One bearing for all base nodes, or one by tag.
    level : {"pendulum", "contact"}
        Level of fidelity.
    route : {"auto", "fast", "portable"}
        As for `bearing_element`.
    vertical : {"z", "y"}
        Axis of the model that points up.
    base_rotations : {"kept", "free", "fixed"}
        Rotations of the base nodes about horizontal axes: held where the model holds them (as
        stiff base beams would), free (of a model that has base beams), or held.
    base_diaphragm : bool
        Whether base nodes at one elevation move in plan as one rigid body, as on a base slab.
    tags, ground_tags : sequence of int, optional
        Tags of the new elements and of the fixed nodes, one for each base node; free ones above
        the largest are taken if None.
    length_unit, force_unit : float
        The model's units [m], [N]: 0.001 and 1000 for mm and kN. Time is in seconds.

    Returns
    -------
    Isolation
        Tags, nodes, what was released; `print` it for a short description.

    Raises
    ------
    ValueError
        If something is not what it must be; the model is as it was.
    TypeError
        If a bearing is not a LIRBearing, or a tag or unit no number.
    RuntimeError
        If the route asked for is not possible; the model is as it was.

    Warns
    -----
    IsolationWarning
        If an element holds a base node beside its bearing, or the base has no mass.

    Notes
    -----
    For models of three dimensions with six degrees of freedom at each base node, linear or not.
    In the plane (ndm 2, ndf 3) put the bearings by `bearing_element`, one by one.

    The superstructure must leave the base free to rise: a pendulum goes up as it moves, by
    ``U**2 / (2 L)``. What resists that, an old vertical spring under a column, a tie to the
    ground or a stiff wall on fixed supports beside the bearings, draws the load to itself or from
    its neighbours. And something has to hold the rotations of the upper plates about horizontal
    axes: supports (`base_rotations`), base beams or continuous columns. A bearing does not.

    Call it where the base nodes are where they were built, before the gravity analysis or after
    it; find equilibrium then (one static step at least), for now the bearings carry the loads.
    ``rayleigh`` leaves the bearings alone, but its part by mass, and modal damping, also damp the
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
    _check_words(level, route, vertical, base_rotations)
    devices = _devices(base_nodes, bearing)
    bases = list(devices)
    up = _AXES[vertical]
    _check_model(ops, bases, metre)
    grounds = _new_tags(ops.getNodeTags(), ground_tags, bases, "ground_tags", "node")
    elements = _new_tags(element_tags(), tags, bases, "tags", "element")
    groups = _groups(ops, bases, up, metre) if base_diaphragm else []
    _check_ties(ops, bases, groups)
    notes = _notes(ops, bases)
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
                elements[tag], grounds[tag], tag, device, level, axis, route,
                length_unit=length_unit, force_unit=force_unit,
            )  # fmt: skip
    except (ValueError, TypeError, RuntimeError):
        for tag in routes:
            ops.remove("element", elements[tag])
        for node in made:
            ops.remove("node", node)
        raise
    released, held = {}, {}
    ops.model("basic", "-ndm", 3, "-ndf", 6)  # what fix counts by
    for tag in bases:
        ops.fix(grounds[tag], 1, 1, 1, 1, 1, 1)
        released[tag], held[tag] = _release(ops, tag, up, base_rotations)
    for group in groups:
        ops.rigidDiaphragm(up + 1, *group)
    for note in notes:
        warnings.warn(note, IsolationWarning, stacklevel=2)
    return Isolation(
        elements=elements,
        grounds=grounds,
        routes=routes,
        released=released,
        held=held,
        tied=tuple(tuple(group) for group in groups),
        notes=tuple(notes),
    )


def _check_words(level: str, route: str, vertical: str, base_rotations: str) -> None:
    require_choice("level", level, LEVELS)
    require_choice("route", route, ROUTES)
    require_choice("vertical", vertical, tuple(_AXES))
    require_choice("base_rotations", base_rotations, _ROTATIONS)


def _devices(
    base_nodes: Sequence[int], bearing: LIRBearing | Mapping[int, LIRBearing]
) -> dict[int, LIRBearing]:
    # Bearings by base node, in the order of those.
    bases = [int(tag) for tag in base_nodes]
    repeated = [tag for tag in bases if bases.count(tag) > 1]
    if not bases or repeated:
        what = f"lists node {repeated[0]} more than once" if repeated else "is empty"
        msg = f"base_nodes {what}: give the tag of each node that shall stand on a bearing once"
        raise ValueError(msg)
    given = bearing if isinstance(bearing, Mapping) else dict.fromkeys(bases, bearing)
    apart = sorted(set(bases) ^ {int(tag) for tag in given})
    if apart:
        where = "base_nodes but not in bearing" if apart[0] in bases else "bearing but no base node"
        msg = f"node {apart[0]} is in {where}: give one bearing for each base node"
        raise ValueError(msg)
    for tag in bases:
        if not isinstance(given[tag], LIRBearing):
            msg = f"the bearing of node {tag} is {given[tag]!r}: describe it by a LIRBearing"
            raise TypeError(msg)
    return {tag: given[tag] for tag in bases}


def _check_model(ops: Any, bases: list[int], metre: float) -> None:
    present = set(ops.getNodeTags() or ())
    left = leftovers(ops)
    if left:
        msg = f"the OpenSees model cannot be analysed: {left}"
        raise ValueError(msg)
    for tag in bases:
        if tag not in present:
            msg = f"the OpenSees model has no node {tag}: base_nodes are tags of its nodes"
            raise ValueError(msg)
        shape = len(ops.nodeCoord(tag)), len(ops.nodeDisp(tag))
        if shape != (3, 6):
            msg = (
                f"node {tag} has {shape[0]} coordinates and {shape[1]} degrees of freedom: isolate "
                "needs 3 and 6; in the plane put the bearings by bearing_element, one by one"
            )
            raise ValueError(msg)
        moved = metre * max(abs(value) for value in ops.nodeDisp(tag)[:3])
        if moved > _AT_REST:
            msg = (
                f"base node {tag} has moved by {moved:.3g} m, at most {_AT_REST:g} m is allowed, "
                "for its bearing would start displaced: call isolate on the model as it was built "
                "(ops.reset() takes it back), or while its supports hold it"
            )
            raise ValueError(msg)


def _new_tags(
    present: Any, given: Sequence[int] | None, bases: list[int], word: str, kind: str
) -> dict[int, int]:
    known = {int(tag) for tag in present or ()}
    if given is None:
        first = max([*known, 0]) + 1
        return {tag: first + place for place, tag in enumerate(bases)}
    new = [int(tag) for tag in given]
    if len(new) != len(bases) or len(set(new)) != len(new):
        msg = f"{word} has {len(set(new))} different tags: give one for each of {len(bases)} nodes"
        raise ValueError(msg)
    taken = sorted(known.intersection(new))
    if taken:
        msg = f"{word}: {kind} {taken[0]} is in the model already, choose another tag"
        raise ValueError(msg)
    return dict(zip(bases, new, strict=True))


def _groups(ops: Any, bases: list[int], up: int, metre: float) -> list[list[int]]:
    # Base nodes by elevation, those that are not alone.
    at = {tag: metre * ops.nodeCoord(tag)[up] for tag in bases}
    groups: list[list[int]] = []
    for tag in sorted(bases, key=lambda tag: at[tag]):
        if not groups or at[tag] - at[groups[-1][0]] > _ONE_LEVEL:
            groups.append([])
        groups[-1].append(tag)
    return [sorted(group, key=bases.index) for group in groups if len(group) > 1]


def _check_ties(ops: Any, bases: list[int], groups: list[list[int]]) -> None:
    # A base node that follows another one has no place in a new diaphragm, nor on a bearing if
    # that other one is fixed.
    fixed = set(ops.getFixedNodes() or ()) - set(bases)
    for tag in set(ops.getConstrainedNodes() or ()).intersection(bases):
        leaders = [int(other) for other in ops.getRetainedNodes(tag)]
        grounded = [
            other
            for other in leaders
            if other in fixed and {1, 2, 3}.intersection(ops.getFixedDOFs(other))
        ]
        if grounded:
            msg = (
                f"a multi-point constraint ties base node {tag} to the fixed node {grounded[0]}: "
                f"its bearing could not move; remove it by ops.remove('mp', {tag})"
            )
            raise ValueError(msg)
        if any(tag in group for group in groups):
            msg = (
                f"base node {tag} follows node {leaders[0]} by a multi-point constraint: pass "
                "base_diaphragm=False and keep the model's own, or remove that one by "
                f"ops.remove('mp', {tag})"
            )
            raise ValueError(msg)


def _notes(ops: Any, bases: list[int]) -> list[str]:
    notes = []
    held = {
        int(tag)
        for tag in ops.getFixedNodes() or ()
        if {1, 2, 3}.intersection(ops.getFixedDOFs(tag))
    } - set(bases)
    beside = []
    for element in ops.getEleTags() or ():
        nodes = {int(tag) for tag in ops.eleNodes(element)}
        if nodes.intersection(bases) and nodes.intersection(held):
            beside.append(int(element))
    if beside:
        notes.append(
            f"elements {listed(beside)} join base nodes to supports beside their bearings: what "
            "resists the rise of a pendulum draws load to itself; remove what stood for the old "
            f"isolators or foundations, ops.remove('element', {beside[0]}) and so on"
        )
    every = sum(max(ops.nodeMass(tag)[:3]) for tag in ops.getNodeTags())
    if sum(max(ops.nodeMass(tag)[:3]) for tag in bases) <= _NO_MASS * every:
        notes.append(
            "the base nodes have no mass: friction acts on nothing that has inertia, and steps "
            "have to be small; give them that of the slab above the bearings, ops.mass(tag, ...)"
        )
    return notes


def _release(
    ops: Any, tag: int, up: int, base_rotations: str
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    # Release a base node; returns the degrees of freedom released, and those that are held.
    before = {int(dof) for dof in ops.getFixedDOFs(tag) or ()}
    tilts = {4, 5, 6} - {4 + up}
    after = {"kept": before & tilts, "free": set[int](), "fixed": tilts}[base_rotations]
    for dof in sorted(before - after):
        ops.remove("sp", tag, dof)
    new = after - before
    if new:
        ops.fix(tag, *(int(dof in new) for dof in range(1, 7)))
    return tuple(sorted(before - after)), tuple(sorted(after))
