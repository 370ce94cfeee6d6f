"""Features of an OpenSees model that cannot be imported, or need attention."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from frames._errors import ModelError, argument
from frames.assembly.constraints import eliminate
from frames.assembly.natural_modes import is_stable, weakest
from frames.model.superelement import asymmetry
from frames.opensees.natures import refuse_one_sided, told
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System
    from frames.opensees.model import ElementEntry, OpenSeesModel
    from frames.opensees.natures import Nature


YIELDED = 0.2
"""Change of stiffness of an element, of its initial one, from which on it is refused [-]."""

_SYMMETRY = 1e-6
_LEANING = 0.01  # energy in elements over that of the loads, below which nothing holds a motion
_RANK = 1e-4  # of the largest singular value of a block, below which it has no stiffness


def refuse_unsymmetric(model: OpenSeesModel) -> None:
    """Refuse matrices that are not symmetric."""
    for word in ("mass", "damping", "stiffness"):
        apart, largest, row = asymmetry(getattr(model, word))
        if apart > _SYMMETRY * largest:
            node = model.tags[row // model.ndf]
            there = [each for each in model.elements if node in each.nodes]
            ends = listed([f"{each.tag} ({each.kind})" for each in there])
            message = (
                f"the {word} of the OpenSees model is not symmetric near node {node} (by "
                f"{apart:.3g} of {largest:.3g}), due to one of the elements {ends}: remove "
                "isolators and elements with follower forces by ops.remove('element', tag)"
            )
            raise ModelError(message)


def changed_elements(
    model: OpenSeesModel, elements: list[ElementEntry]
) -> list[tuple[ElementEntry, float]]:
    """Find elements whose stiffness is not their initial one.

    Off the diagonal a stiffness matrix shows the connection of two nodes. The change is measured in
    the deformation that it affects most, relative to the initial stiffness in it. Elements that
    share their nodes are reported together.
    """
    change = model.stiffness - model.initial
    at = {tag: place for place, tag in enumerate(model.tags)}
    ndf, found = model.ndf, []
    for element in elements:
        largest = 0.0
        for k, first in enumerate(element.nodes):
            for second in element.nodes[k + 1 :]:
                rows = slice(ndf * at[first], ndf * (at[first] + 1))
                columns = slice(ndf * at[second], ndf * (at[second] + 1))
                apart = model.coordinates[at[first]] - model.coordinates[at[second]]
                largest = max(
                    largest,
                    _relative_change(
                        model.initial[rows, columns].toarray(),
                        change[rows, columns].toarray(),
                        float(np.linalg.norm(apart)) or 1.0,
                        model.coordinates.shape[1],
                    ),
                )
        found.append((element, largest))
    return found


def _relative_change(initial: FloatArray, change: FloatArray, length: float, ndm: int) -> float:
    if not initial.any():
        return 1.0 if change.any() else 0.0
    size = np.where(np.arange(len(initial)) < ndm, 1.0, 1.0 / length)
    scale = np.outer(size, size)
    return float(np.linalg.norm(np.linalg.pinv(initial * scale, rcond=_RANK) @ (change * scale), 2))


def judge_elements(
    model: OpenSeesModel, found: list[Nature], vertical: int, *, accept: bool
) -> list[str]:
    """Refuse elements without a linear stiffness, or with a stiffness that has changed."""
    notes = refuse_one_sided(found, accept=accept)
    doubtful = [nature for nature in found if not nature.is_linear]
    changed = changed_elements(model, [nature.element for nature in doubtful])
    left = [(element, share) for element, share in changed if share > YIELDED]
    if left:
        worst = max(left, key=lambda item: item[1])
        tags = listed([element.tag for element, _ in left])
        text = (
            f"elements {tags} no longer have their initial stiffness (element "
            f"{worst[0].tag}, {worst[0].kind}, differs by {100.0 * worst[1]:.0f} %, at most "
            f"{100.0 * YIELDED:.0f} %)"
        )
        if not accept:
            message = (
                f"{text}: import the model before they yield, open or crack, or keep their "
                f"present stiffness, {argument('accept_nonlinear', True)}"
            )
            raise ModelError(message)
        notes.append(f"{text}: their present stiffness is kept")
    if not doubtful:
        return notes
    shares = energy_shares(model, [nature.element.tag for nature in doubtful], vertical)
    return notes + told(found, shares)


def refuse_other_supports(
    model: OpenSeesModel, bases: Collection[int], meant: Collection[int]
) -> None:
    """Refuse supports that carry elements and are neither base nodes nor accepted."""
    ndm = model.coordinates.shape[1]
    held = np.all(model.fixed.reshape(-1, model.ndf)[:, :ndm], axis=1).tolist()
    allowed = {*bases, *meant}
    supports = {
        tag for tag, fixed in zip(model.tags, held, strict=True) if fixed and tag not in allowed
    }
    carried = [element for element in model.elements if supports.intersection(element.nodes)]
    if not carried:
        return
    between = [element for element in carried if set(bases).intersection(element.nodes)]
    tags = sorted(supports & {node for element in carried for node in element.nodes})
    if between:
        remedy = (
            f"element {between[0].tag} ({between[0].kind}) joins one to base node "
            f"{next(n for n in between[0].nodes if n in set(bases))}: bearings replace these "
            f"elements, so remove them first, ops.remove('element', {between[0].tag}) and so "
            f"on ({len(between)} in all)"
        )
    else:
        remedy = f"add them to base_nodes, or keep them, {argument('other_supports', tags)}"
    message = f"nodes {listed(tags)} are supports of elements, but not base nodes: {remedy}"
    raise ModelError(message)


def refuse_leaning(system: System, initial: SparseMatrix) -> None:
    """Refuse a structure that falls over under its loads on a fixed base.

    Shapes: initial (6 n, 6 n).
    """
    touched = np.unique(system.bearing_rows.tocoo().coords[1])
    rest = np.setdiff1d(np.arange(len(system.dof_labels)), touched)
    if not len(rest):
        return
    stiffness = system.stiffness[rest][:, rest].toarray()
    if is_stable(stiffness):
        return
    way = weakest(stiffness)
    moves = np.asarray(system.transform[:, rest] @ way)
    own = moves[: initial.shape[0]]  # the nodes below the bearings come last
    elastic = float(own @ (initial @ own))
    loads = elastic - float(way @ (stiffness @ way))
    label = system.dof_labels[int(rest[int(np.argmax(np.abs(way)))])]
    node, dof = label.rsplit(" ", 1)
    if elastic < _LEANING * loads:
        message = (
            f"node {node} can move along {dof} (frame axes, z up) without deforming an "
            "element, and the loads push it over: brace the column or strut there, or tie "
            "its top to the frame (equalDOF, rigidDiaphragm, a beam)"
        )
        raise ModelError(message)
    message = (
        f'the structure buckles under its permanent loads on a fixed base, at "{label}" '
        f"(frame axes, z up): the loads are at least {loads / elastic:.3g} times the "
        "buckling load. Reduce the loads or stiffen columns"
    )
    raise ModelError(message)


_SPARE = 1e-10  # of the mean stiffness, so that free displacements do not stop the solution


def energy_shares(model: OpenSeesModel, tags: Collection[int], vertical: int) -> dict[int, float]:
    """Return the elements' shares of strain energy under loads proportional to the masses [-].

    The compliance to a load changes by that share of the change of an element's stiffness:
    ``d(u' F) / (u' F) = -share dk / k``.

    If an element is free of force in rigid motions, its energy is a sum over pairs of its nodes.
    A pair has ``-u_a' K_ab (u_b - R_ab u_a) / 2`` in both orders; R_ab is the rigid motion of node
    b with node a. So the blocks of the assembled stiffness are enough.
    """
    at = {tag: place for place, tag in enumerate(model.tags)}
    pairs: dict[tuple[int, int], list[int]] = {}
    for element in model.elements:
        places = sorted({at[node] for node in element.nodes})
        for k, first in enumerate(places):
            for second in places[k + 1 :]:
                pairs.setdefault((first, second), []).append(element.tag)
    wanted = set(tags)
    ndm = model.coordinates.shape[1]
    shares = dict.fromkeys(wanted, 0.0)
    for axis in range(ndm):
        if axis == vertical:
            continue
        moved, total = _moved(model, axis)
        own = dict.fromkeys(wanted, 0.0)
        for (a, b), elements in pairs.items():
            concerned = wanted.intersection(elements)
            if concerned and total > 0.0:
                energy = _pair_energy(model, moved, a, b) / total / len(elements)
                for tag in concerned:
                    own[tag] += energy
        if sum(own.values()) > sum(shares.values()):
            shares = own
    return shares


def _moved(model: OpenSeesModel, axis: int) -> tuple[FloatArray, float]:
    free = np.flatnonzero(~model.fixed)
    _, follow = eliminate(
        sparse.csr_array(model.equations[:, free]), np.ones(len(free), dtype=np.float64)
    )
    unit = np.zeros(len(model.fixed), dtype=np.float64)
    unit[axis :: model.ndf] = 1.0
    pull = np.asarray(model.mass @ unit)
    load = follow.T @ pull[free]
    initial = model.initial[free][:, free]
    stiffness: SparseMatrix = sparse.csr_array(follow.T @ initial @ follow)
    size = max(float(np.abs(stiffness.diagonal()).mean()), 1e-300)
    spare = _SPARE * size * sparse.eye_array(stiffness.shape[0])
    answer = splu(sparse.csc_matrix(stiffness + spare)).solve(load)
    moved = np.zeros(len(unit))
    moved[free] = follow @ answer
    return moved, float(answer @ (stiffness @ answer))


def _pair_energy(model: OpenSeesModel, moved: FloatArray, a: int, b: int) -> float:
    # Twice the energy between two nodes.
    u = moved.reshape(len(model.tags), model.ndf)
    rows = [slice(model.ndf * place, model.ndf * (place + 1)) for place in (a, b)]
    block = model.initial[rows[0], rows[1]].toarray()
    arm = model.coordinates[b] - model.coordinates[a]
    ahead = u[b] - _carried(u[a], arm)
    back = u[a] - _carried(u[b], -arm)
    return float(u[a] @ block @ ahead + u[b] @ block.T @ back)


def _carried(motion: FloatArray, arm: FloatArray) -> FloatArray:
    # The motion of a node at the end of a rigid arm.
    ndm = len(arm)
    turn = motion[ndm:]
    lever = np.cross(turn, arm) if ndm == 3 else turn[0] * np.array([-arm[1], arm[0]])
    return np.concatenate([motion[:ndm] + lever, turn])
