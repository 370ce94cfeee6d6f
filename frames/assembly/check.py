"""The model check: a frame that cannot work is refused, and the culprit is named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg
from scipy import sparse
from scipy.sparse import csgraph
from scipy.sparse import linalg as sparse_linalg

from frames._errors import ModelError
from frames.assembly.natural_modes import is_stable
from frames.assembly.solvers import Factors, positive_factors
from frames.model.components import DOFS
from frames.model.laws import elastic_stiffness

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData
    from frames.model.superelement import Superelement

__all__ = ["ModelError", "check_connections", "check_mass", "check_restraint", "free_motions"]

DENSE_LIMIT = 300
"""Up to this number of DOFs the free motions are sought with dense matrices."""

MOTIONS = 12
"""Largest number of free motions to find."""

NO_STIFFNESS = 1e-13
"""Eigenvalue of the scaled stiffness (unit diagonal) below which a motion is free [-]."""

_PLAIN = 1e-9  # eigenvalue of the same, beyond round-off: if all are larger, no motion is free
_SHIFT = 1e-8  # of the scaled stiffness, which makes that of a mechanism regular

NAMED = 4
"""Number of motions, and of DOFs of each, in a message."""


def check_connections(frame: FrameData) -> None:
    """Refuse a frame without nodes, with loose nodes or with a part that has no support."""
    if not frame.nodes:
        message = f'frame "{frame.name}" has no nodes: add nodes, supports and members first'
        raise ModelError(message)
    index = {name: place for place, name in enumerate(frame.nodes)}
    links = [
        (index[link.i], index[link.j])
        for group in (frame.members, frame.springs, frame.bearings)
        for link in group.values()
    ]
    links.extend(
        (index[link.i], index[link.j])
        for link in frame.links.values()
        if elastic_stiffness(link.law) > 0.0
    )
    for diaphragm in frame.diaphragms.values():
        first = index[diaphragm.nodes[0]]
        links.extend((first, index[node]) for node in diaphragm.nodes[1:])
    for superelement in frame.superelements.values():
        links.extend(_joined_by(superelement, index))
    rows, columns = np.array(links, dtype=np.int64).reshape(-1, 2).T
    size = len(index)
    graph = sparse.coo_array((np.ones(rows.size), (rows, columns)), shape=(size, size))
    count, part = csgraph.connected_components(graph, directed=False)
    names = np.array(list(frame.nodes))
    linked = np.zeros(size, dtype=bool)
    linked[rows], linked[columns] = True, True
    held = np.array([len(frame.fixed_dofs.get(name, ())) for name in frame.nodes])
    loose = names[~linked & (held < len(DOFS))]
    if loose.size:
        message = (
            f"{_quoted(loose)}: no member, spring, bearing or diaphragm holds this node: "
            'connect it, or fix it with fix(node, "all")'
        )
        raise ModelError(message)
    supported = np.zeros(count, dtype=bool)
    supported[part[held > 0]] = True
    if not supported.all():
        alone = int(np.flatnonzero(~supported)[0])
        message = (
            f"{_quoted(names[part == alone])}: this part of the structure has no support: "
            "fix one of its nodes, or connect it to the rest"
        )
        raise ModelError(message)


def check_mass(system: System) -> None:
    """Refuse a system without free DOFs, or without mass in a free motion."""
    if not system.dof_labels:
        message = "every degree of freedom is fixed: release those that shall move"
        raise ModelError(message)
    moving = (np.diff(system.transform.indptr) > 0).reshape(-1, 6)[:, :3]
    inert = moving & (system.node_mass[:, :3] > 0.0)
    if not inert.any():
        total = float(system.node_mass[:, 0].sum())
        message = (
            f"no free node has mass ({total:g} kg in all, on fixed nodes): add mass by "
            "add_mass, or set the density of the sections"
        )
        raise ModelError(message)
    for axis, word in enumerate("xyz"):
        if moving[:, axis].any() and not inert[:, axis].any():
            names = np.array(system.node_names)
            free = names[moving[:, axis]]
            holding = names[~moving[:, axis] & (system.node_mass[:, axis] > 0.0)]
            where = (
                f"the mass is at {_quoted(holding)}, fixed along {word}; " if len(holding) else ""
            )
            message = (
                f"no mass along {word}: {_quoted(free)} can move along {word}, but have none: "
                f'{where}add mass to one of them, or fix their "u{word}"'
            )
            raise ModelError(message)


def check_restraint(system: System, stiffness: SparseMatrix) -> None:
    """Refuse a mechanism and name the degrees of freedom that move without stiffness.

    Shapes: stiffness (n_free, n_free).
    """
    labels = system.dof_labels
    spans = np.ptp(system.coordinates, axis=0)
    extent = float(np.linalg.norm(spans)) or 1.0
    turns = np.array([label.endswith((" rx", " ry", " rz")) for label in labels])
    motions = free_motions(stiffness)
    if not motions.shape[1]:
        return
    # Rotations count by the displacement they cause across the structure.
    sizes = motions * np.where(turns, extent, 1.0)[:, None]
    count = motions.shape[1]
    more = "at least " if count == MOTIONS < len(labels) else ""
    lines = [f"the structure is a mechanism: {more}{count} independent motion(s) without stiffness"]
    named: list[str] = []
    for k, size in enumerate(_localised(sizes).T[:NAMED], start=1):
        order = np.argsort(-np.abs(size), kind="stable")
        moving = int(np.sum(np.abs(size) > 0.1 * np.abs(size).max()))
        chief = [labels[int(place)] for place in order[: min(NAMED, moving)]]
        named.append(chief[0])
        rest = f" and {moving - NAMED} more" if moving > NAMED else ""
        lines.append(f"motion {k}: " + ", ".join(f'"{label}"' for label in chief) + rest)
    node, dof = named[0].rsplit(" ", 1)
    what = "rotation" if dof.startswith("r") else "translation"
    lines.append(f'"{node}" {what} {dof} is not restrained: {_remedy(system, node, dof)}')
    raise ModelError("; ".join(lines))


def free_motions(stiffness: SparseMatrix) -> FloatArray:
    """Return the motions without stiffness.

    The stiffness is scaled to a unit diagonal first, which makes translations and rotations
    comparable. If some of its eigenvalues are small, the smallest ones come from a dense solver
    for small matrices, from Lanczos iterations on the shifted inverse for large ones.

    Shapes: stiffness (n, n), result (n, n_motions).
    """
    size = stiffness.shape[0]
    diagonal = stiffness.diagonal()
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaling = sparse.diags_array(scale)
    scaled = sparse.csc_array(scaling @ stiffness @ scaling)
    wanted = min(MOTIONS, size)
    is_small = size <= max(DENSE_LIMIT, 2 * MOTIONS)
    less = sparse.csr_array(scaled - _PLAIN * sparse.eye_array(size))
    if is_stable(less.toarray()) if is_small else positive_factors(less) is not None:
        return np.zeros((size, 0))
    if is_small:
        dense = scaled.toarray()
        _, vectors = scipy.linalg.eigh(dense, subset_by_index=[0, wanted - 1])
    else:
        start = np.random.default_rng(0).standard_normal(size)
        shifted = Factors(sparse.csr_array(scaled + _SHIFT * sparse.eye_array(size)))
        inverse = sparse_linalg.LinearOperator(scaled.shape, shifted.solve, dtype=np.float64)
        _, vectors = sparse_linalg.eigsh(scaled, k=wanted, sigma=-_SHIFT, v0=start, OPinv=inverse)
    energies = np.sum(vectors * np.asarray(scaled @ vectors), axis=0)
    # less than none is no mechanism: loads push it over, which `build_basis` refuses
    motions: FloatArray = scale[:, None] * vectors[:, np.abs(energies) < NO_STIFFNESS]
    return motions


def _localised(motions: FloatArray) -> FloatArray:
    # Any basis of the null space will do; this one has one leading DOF a motion, absent in the
    # others, so that independent mechanisms are reported apart.
    _, _, order = scipy.linalg.qr(motions.T, pivoting=True, mode="economic")
    leading = order[: motions.shape[1]]
    return np.asarray(np.linalg.solve(motions[leading].T, motions.T).T, dtype=np.float64)


def _remedy(system: System, node: str, dof: str) -> str:
    if node.endswith(" (diaphragm)"):
        return "connect the diaphragm's nodes by members, springs or bearings"
    advice = f'fix it with fix("{node}", "{dof}"), or connect the node by a member or a spring'
    if dof == "uz":
        advice = (
            "connect the node by a member or a spring, and move its mass to nodes on "
            "members or bearings: a diaphragm has no vertical stiffness"
        )
    ends = {system.node_names[end] for _, i, j, _ in system.bearings for end in (i, j)}
    if node in ends and dof.startswith("r"):
        advice += (
            "; at this level a bearing does not restrain the rotation of its plates: "
            "connect the nodes above the bearings by base beams"
        )
    return advice


def _joined_by(part: Superelement, index: dict[str, int]) -> list[tuple[int, int]]:
    # Pairs of nodes that a superelement's stiffness or ties join.
    ties = part.equations
    pattern = abs(part.stiffness) + abs(part.mass) + abs(ties.T) @ abs(ties)
    at_row, at_column = pattern.tocoo().coords
    pairs = np.unique(np.column_stack([at_row // 6, at_column // 6]), axis=0)
    places = np.array([index[node] for node in part.nodes], dtype=np.int64)
    return [(int(places[a]), int(places[b])) for a, b in pairs if a != b]


def _quoted(names: FloatArray) -> str:
    shown = [f'"{name}"' for name in names[:NAMED]]
    rest = len(names) - len(shown)
    lead = "node " if len(names) == 1 else "nodes "
    return lead + ", ".join(shown) + (f" and {rest} more" if rest else "")
