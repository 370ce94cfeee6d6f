"""Viscous parts of springs that OpenSees leaves out of its damping matrix."""

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

_CLASS = "ZeroLength"
_ALIKE = 1e-5  # relative difference of matrices that count as one; axes are printed to six digits
_DIRECTIONS = {"P": 0, "Vy": 1, "Vz": 2, "T": 3, "My": 4, "Mz": 5}


def with_viscous_springs(ops: Any, model: OpenSeesModel) -> tuple[SparseMatrix, list[str]]:
    """Return the damping of a model with the viscous part of all springs of zero length.

    A ``zeroLength`` with ``-doRayleigh 1`` puts Rayleigh damping in place of its materials' in
    the damping matrix, while its force has both. What a pair of nodes has in the matrix is either
    the materials' own, or in proportion to the stiffness of the springs.
    """
    springs = [element for element in model.elements if element.kind == _CLASS]
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
        own = sum((_viscous(ops, printed, element, ndf) for element in group), np.zeros((ndf, ndf)))
        if not own.any():
            continue
        first, second = (slice(ndf * at[n], ndf * (at[n] + 1)) for n in group[0].nodes)
        present = -model.damping[first, second].toarray()
        if np.linalg.norm(present - own) <= _ALIKE * np.linalg.norm(own):
            continue
        if not _is_rayleigh(present, model, (first, second), float(np.linalg.norm(own))):
            unclear += [element.tag for element in group]
            continue
        for rows, columns, sign in (
            (first, first, 1),
            (second, second, 1),
            (first, second, -1),
            (second, first, -1),
        ):
            damping[rows, columns] = damping[rows, columns].toarray() + sign * own
        added = True
    notes = []
    if unclear:
        notes.append(
            f"it cannot be told whether OpenSees' damping matrix has the viscous forces of the "
            f"springs {listed(unclear)}: with -doRayleigh 1 a zeroLength leaves them out there, "
            "and other damping acts between the same nodes; leave -doRayleigh out, or give "
            "viscous springs nodes of their own"
        )
    return sparse.csr_array(damping) if added else model.damping, notes


def _viscous(ops: Any, printed: Printed, element: ElementEntry, ndf: int) -> FloatArray:
    # Force over speed between its nodes, in the model's axes.
    entry = printed.elements.get(str(element.tag), {})
    axes = np.array(entry.get("transMatrix", np.eye(3)), dtype=np.float64)
    full = np.zeros((6, 6))
    for tag, word in zip(entry.get("materials", ()), entry.get("dof", ()), strict=True):
        ops.testUniaxialMaterial(int(tag))
        block, row = divmod(_DIRECTIONS[word], 3)
        along = np.zeros(6)
        along[3 * block : 3 * block + 3] = axes[row]
        full += float(ops.getDampTangent()) * np.outer(along, along)
    kept = [0, 1, 5] if ndf == 3 else list(range(6))
    return full[np.ix_(kept, kept)]


def _is_rayleigh(
    damping: FloatArray, model: OpenSeesModel, places: tuple[slice, slice], size: float
) -> bool:
    # Whether what two nodes have is none, or a multiple of the stiffness between them.
    if np.linalg.norm(damping) <= _ALIKE * size:
        return True
    for stiffness in (-model.stiffness[places].toarray(), -model.initial[places].toarray()):
        norm = float(np.sum(stiffness * stiffness))
        factor = float(np.sum(damping * stiffness)) / norm if norm > 0.0 else 0.0
        if factor >= 0.0 and np.linalg.norm(damping - factor * stiffness) <= _ALIKE * size:
            return True
    return False
