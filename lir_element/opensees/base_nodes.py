"""Base nodes of an OpenSees model that get bearings: their checks, and their release."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from lir_element.argument_checks import listed
from lir_element.device.bearing import LIRBearing
from lir_element.elevations import SAME_PLACE, by_elevation

BASE_ROTATIONS = ("kept", "free", "fixed")
"""Treatment of the rotations of base nodes about horizontal axes."""

_NO_MASS = 1e-6  # of all nodal masses, below which the base counts as without mass


def bearings_by_node(
    base_nodes: Sequence[int],
    bearing: LIRBearing | Mapping[int, LIRBearing],
    *,
    error: type[ValueError] = ValueError,
) -> dict[int, LIRBearing]:
    """Return bearings by base node, in the order of those."""
    bases = [int(tag) for tag in base_nodes]
    repeated = [tag for tag in bases if bases.count(tag) > 1]
    if not bases or repeated:
        what = f"lists node {repeated[0]} more than once" if repeated else "is empty"
        msg = f"base_nodes {what}: list each node on a bearing once"
        raise error(msg)
    given = bearing if isinstance(bearing, Mapping) else dict.fromkeys(bases, bearing)
    apart = sorted(set(bases) ^ {int(tag) for tag in given})
    if apart:
        where = "base_nodes but not in bearing" if apart[0] in bases else "bearing only"
        msg = f"node {apart[0]} is in {where}: give one bearing for each base node"
        raise error(msg)
    for tag in bases:
        if not isinstance(given[tag], LIRBearing):
            msg = f"the bearing of node {tag} is {given[tag]!r}: pass a LIRBearing"
            raise TypeError(msg)
    return {tag: given[tag] for tag in bases}


def check_base(ops: Any, bases: list[int], metre: float) -> None:
    """Raise unless the base nodes exist, have six freedoms, and are where they were built."""
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
                f"node {tag} has {shape[0]} coordinates and {shape[1]} degrees of freedom: "
                "isolate needs 3 and 6; for a plane model use bearing_element"
            )
            raise ValueError(msg)
        moved = metre * max(abs(value) for value in ops.nodeDisp(tag)[:3])
        if moved > SAME_PLACE:
            msg = (
                f"base node {tag} has moved by {moved:.3g} m, at most {SAME_PLACE:g} m is allowed: "
                "call isolate on the undeformed model (after ops.reset()), or while its supports "
                "are fixed"
            )
            raise ValueError(msg)


def new_tags(
    present: Any, given: Sequence[int] | None, bases: list[int], word: str, kind: str
) -> dict[int, int]:
    """Return new tags by base node: those given, or free ones above the largest."""
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


def not_alone(ops: Any, bases: list[int], up: int, metre: float) -> list[list[int]]:
    """Return base nodes by elevation, those that are not alone."""
    groups = by_elevation({tag: metre * ops.nodeCoord(tag)[up] for tag in bases})
    return [sorted(group, key=bases.index) for group in groups if len(group) > 1]


def check_ties(ops: Any, bases: list[int], groups: list[list[int]]) -> None:
    """Refuse followers in a new diaphragm, and those on a bearing that follow a fixed node."""
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
                f"a multi-point constraint ties base node {tag} to node {leaders[0]}: pass "
                f"base_diaphragm=False, or remove the constraint by ops.remove('mp', {tag})"
            )
            raise ValueError(msg)


def doubts(ops: Any, bases: list[int], up: int) -> list[str]:
    """Return supports of base nodes beside their bearings, and whether the base lacks mass."""
    notes = []
    along = {1, 2, 3} - {up + 1}  # nodes of a plane frame hold one of these
    held = {
        int(tag)
        for tag in ops.getFixedNodes() or ()
        if up + 1 in ops.getFixedDOFs(tag) or along <= set(ops.getFixedDOFs(tag))
    } - set(bases)
    beside = []
    for element in ops.getEleTags() or ():
        nodes = {int(tag) for tag in ops.eleNodes(element)}
        if nodes.intersection(bases) and nodes.intersection(held):
            beside.append(int(element))
    if beside:
        notes.append(
            f"elements {listed(beside)} join base nodes to supports beside the bearings and "
            "carry part of their load: remove the elements of the former isolators or "
            f"foundations, ops.remove('element', {beside[0]}) and so on"
        )
    every = sum(max(ops.nodeMass(tag)[:3]) for tag in ops.getNodeTags())
    if sum(max(ops.nodeMass(tag)[:3]) for tag in bases) <= _NO_MASS * every:
        notes.append(
            "the base nodes have no mass, so the analysis needs small steps: add the mass "
            "of the slab above the bearings, ops.mass(tag, ...)"
        )
    return notes


def release(
    ops: Any, tag: int, up: int, base_rotations: str
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Release a base node; return the degrees of freedom released, and those that are held."""
    before = {int(dof) for dof in ops.getFixedDOFs(tag) or ()}
    tilts = {4, 5, 6} - {4 + up}
    after = {"kept": before & tilts, "free": set[int](), "fixed": tilts}[base_rotations]
    for dof in sorted(before - after):
        ops.remove("sp", tag, dof)
    new = after - before
    if new:
        ops.fix(tag, *(int(dof in new) for dof in range(1, 7)))
    return tuple(sorted(before - after)), tuple(sorted(after))


def leftovers(ops: Any) -> str:
    """Return constraints and elements whose nodes are gone.

    ``ops.remove('node', tag)`` leaves the node's supports, constraints and elements in the model.
    The next analysis then ends the process, mostly without a word.
    """
    nodes = set(ops.getNodeTags() or ())
    fixed = [tag for tag in ops.getFixedNodes() or () if tag not in nodes]
    tied = [
        tag
        for tag in ops.getConstrainedNodes() or ()
        if tag not in nodes or not nodes.issuperset(ops.getRetainedNodes(tag) or ())
    ]
    loose = [
        tag for tag in ops.getEleTags() or () if not nodes.issuperset(map(int, ops.eleNodes(tag)))
    ]
    found = []
    if fixed:
        held = ", ".join(str(dof) for dof in ops.getFixedDOFs(fixed[0]))
        found.append(
            f"nodes {listed(fixed)} were removed, but their fix was not: remove it too, for node "
            f"{fixed[0]} by ops.remove('sp', {fixed[0]}, dof) with dof = {held}"
        )
    if tied:
        found.append(
            f"multi-point constraints of nodes {listed(tied)} name a node that was removed: "
            f"remove them by ops.remove('mp', {tied[0]}) and so on"
        )
    if loose:
        found.append(
            f"elements {listed(loose)} end at a node that was removed: remove them by "
            f"ops.remove('element', {loose[0]}) and so on"
        )
    if not found:
        return ""
    return "; ".join(found) + ". OpenSees would end this process at its next analysis"
