"""Viscous parts of springs and bars that OpenSees has wrong in its damping matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse

from frames.opensees.materials import printed_model
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.opensees.materials import Printed
    from frames.opensees.model import ElementEntry, OpenSeesModel

_CLASSES = ("ZeroLength", "CorotTruss")
_ALIKE = 1e-5  # relative difference of matrices that count as one; axes are printed to six digits
_MOVED = 1e-2  # the same of bars, of whose motion the matrix leaves one direction out
_DIRECTIONS = {"P": 0, "Vy": 1, "Vz": 2, "T": 3, "My": 4, "Mz": 5}


def with_viscous_springs(ops: Any, model: OpenSeesModel) -> tuple[SparseMatrix, list[str]]:
    """Return the damping of a model with the viscous part of springs and bars as in their forces.

    A ``zeroLength`` with ``-doRayleigh 1`` puts Rayleigh damping in place of its materials' in
    the damping matrix, while its force has both. A ``corotTruss`` has four times its force's part
    there, for its length is counted twice (openseespy 3.7 and 3.8). What a pair of nodes has in the
    matrix is either the materials' own, or this and a part in proportion to the stiffness.
    """
    springs = [element for element in model.elements if element.kind in _CLASSES]
    if not springs:
        return model.damping, []
    printed = printed_model(ops)
    groups: dict[frozenset[int], list[ElementEntry]] = {}
    for element in springs:
        groups.setdefault(frozenset(element.nodes), []).append(element)
    at = {tag: place for place, tag in enumerate(model.tags)}
    ndf, damping = model.ndf, model.damping.tolil()
    added = False
    unclear: list[int] = []
    for group in groups.values():
        own, faulty = (
            sum(parts)
            for parts in zip(*(_viscous(ops, printed, model, e) for e in group), strict=True)
        )
        if not own.any():
            continue
        first, second = (slice(ndf * at[n], ndf * (at[n] + 1)) for n in group[0].nodes)
        present = -model.damping[first, second].toarray()
        size = float(np.linalg.norm(own)) * (_MOVED if faulty.any() else _ALIKE)
        if np.linalg.norm(present - own) <= size:
            continue
        if not _is_rayleigh(present - faulty, model, (first, second), size):
            unclear += [element.tag for element in group]
            continue
        for rows, columns, sign in (
            (first, first, 1),
            (second, second, 1),
            (first, second, -1),
            (second, first, -1),
        ):
            damping[rows, columns] = damping[rows, columns].toarray() + sign * (own - faulty)
        added = True
    notes = []
    if unclear:
        notes.append(
            f"it cannot be told whether OpenSees' damping matrix has the viscous forces of the "
            f"elements {listed(unclear)}: a zeroLength with -doRayleigh 1 leaves them out there, a "
            "corotTruss counts them four times, and other damping acts between the same nodes; "
            "leave -doRayleigh out, take a truss, or give viscous elements nodes of their own"
        )
    return sparse.csr_array(damping) if added else model.damping, notes


def _viscous(
    ops: Any, printed: Printed, model: OpenSeesModel, element: ElementEntry
) -> tuple[FloatArray, FloatArray]:
    # Force over speed between its nodes, in the model's axes; and the same as the matrix has it
    # where that is wrong.
    entry = printed.elements.get(str(element.tag), {})
    ndf = model.ndf
    if element.kind != _CLASSES[0]:
        return _viscous_bar(ops, entry, model, element)
    axes = np.array(entry.get("transMatrix", np.eye(3)), dtype=np.float64)
    full = np.zeros((6, 6))
    for tag, word in zip(entry.get("materials", ()), entry.get("dof", ()), strict=True):
        block, row = divmod(_DIRECTIONS[word], 3)
        along = np.zeros(6)
        along[3 * block : 3 * block + 3] = axes[row]
        full += _coefficient(ops, tag) * np.outer(along, along)
    kept = [0, 1, 5] if ndf == 3 else list(range(6))
    return full[np.ix_(kept, kept)], np.zeros((ndf, ndf))


def _viscous_bar(
    ops: Any, entry: dict[str, Any], model: OpenSeesModel, element: ElementEntry
) -> tuple[FloatArray, FloatArray]:
    # The force is along the present chord; the matrix adds the chord before the loads to that.
    start, end = (np.array(ops.nodeCoord(tag), dtype=np.float64) for tag in element.nodes)
    first = end - start
    moved = [np.array(ops.nodeDisp(tag))[: len(first)] for tag in element.nodes]
    now = first + moved[1] - moved[0]
    length = float(np.linalg.norm(first))
    factor = float(entry.get("A", 0.0)) * _coefficient(ops, entry["material"]) if entry else 0.0
    parts = []
    for chord in (now, now + first):
        along = np.zeros(model.ndf)
        along[: len(first)] = chord / np.linalg.norm(now)
        parts.append(factor / length * np.outer(along, along))
    return parts[0], parts[1]


def _coefficient(ops: Any, tag: object) -> float:
    ops.testUniaxialMaterial(int(str(tag)))
    return float(ops.getDampTangent())


def _is_rayleigh(
    damping: FloatArray, model: OpenSeesModel, places: tuple[slice, slice], error: float
) -> bool:
    # Whether what two nodes have is none, or a multiple of the stiffness between them.
    if np.linalg.norm(damping) <= error:
        return True
    for stiffness in (-model.stiffness[places].toarray(), -model.initial[places].toarray()):
        norm = float(np.sum(stiffness * stiffness))
        factor = float(np.sum(damping * stiffness)) / norm if norm > 0.0 else 0.0
        if factor >= 0.0 and np.linalg.norm(damping - factor * stiffness) <= error:
            return True
    return False
