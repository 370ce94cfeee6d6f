"""Reader of OpenSeesPy's present linear model into arrays.

The constraint handler 'Penalty' with the factor 0 leaves every displacement in the system of
equations, the supported ones too, and adds nothing to it. The integrator 'GimmeMCK' then returns
mass, damping and stiffness of the whole unsupported model. With the factor 1 for constraints alone
and nothing else, the same matrix is the sum of g g' over all constraint equations g' u = 0. The
equations are numbered by an analysis that ends before its first step (Newmark's method refuses a
step of 0 s), so that nothing in the model moves and no recorder writes.
"""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from lir_element.opensees.base_nodes import leftovers
from lir_element.opensees.library import opensees

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import BoolArray, FloatArray, IntArray, SparseMatrix

LARGEST = 6000
"""Number of displacements up to which dense matrices are imported."""

SHAPES = ((3, 6), (2, 3))
"""Models that can be read: dimensions, and displacements of a node."""

_SPEED = 1e-6  # length / time, up to which a node counts as at rest
_ACCELERATION = 1e-4  # length / time^2, the same


class ElementEntry(NamedTuple):
    """An element of the model: its tag, its class in OpenSees, and the tags of its nodes."""

    tag: int
    kind: str
    nodes: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class OpenSeesModel:
    """A model of OpenSees in its own axes and units, supports not applied.

    Displacements are all those of the first node, then of the second, and so on.
    """

    tags: tuple[int, ...]  # (n,), nodes
    coordinates: FloatArray  # (n, ndm), positions before the loads
    ndf: int  # displacements of a node
    mass: SparseMatrix  # (n ndf, n ndf), all matrices in the present state
    damping: SparseMatrix
    stiffness: SparseMatrix
    initial: SparseMatrix  # (n ndf, n ndf), stiffness of the elements before any load
    fixed: BoolArray  # (n ndf,), displacements held by single-point constraints
    # (m, n ndf), multi-point constraints, ``equations @ u = 0``; some may repeat others
    equations: SparseMatrix
    # (n ndf,), applied loads less resisting forces in the present state; minus the reactions at
    # supports
    unbalance: FloatArray
    elements: tuple[ElementEntry, ...]  # all elements


def read_model() -> OpenSeesModel:
    """Read the current model of OpenSeesPy."""
    ops = opensees()
    tags = tuple(int(tag) for tag in ops.getNodeTags() or ())
    ndf = _shape(ops, tags)
    left = leftovers(ops)
    if left:
        message = f"the OpenSees model cannot be analysed: {left}"
        raise ModelError(message)
    _refuse_motion(ops, tags)
    with contextlib.redirect_stderr(io.StringIO()):
        places = _number(ops, tags, ndf, 0.0, 0.0)
        mass, damping, stiffness, initial = (
            _matrix(ops, places, *factors)
            for factors in ((1.0,), (0.0, 1.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 1.0))
        )
        ops.reactions()
        unbalance = -np.array([ops.nodeReaction(tag) for tag in tags], dtype=np.float64)
        places = _number(ops, tags, ndf, 1.0, 0.0)
        fixed = _matrix(ops, places).diagonal() > 0.0
        places = _number(ops, tags, ndf, 0.0, 1.0)
        ties = _matrix(ops, places)
        ops.wipeAnalysis()
    if ops.getConstrainedNodes() and not ties.nnz:
        message = (
            "this build of OpenSees does not show its multi-point constraints (equalDOF, "
            "rigidDiaphragm, rigidLink) to the constraint handler 'Penalty': use openseespy 3.7 "
            "or 3.8"
        )
        raise ModelError(message)
    return OpenSeesModel(
        tags=tags,
        coordinates=np.array([ops.nodeCoord(tag) for tag in tags], dtype=np.float64),
        ndf=ndf,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        initial=initial,
        fixed=fixed,
        equations=sparse.csr_array(ties[np.diff(ties.indptr) > 0]),
        unbalance=unbalance.ravel(),
        elements=tuple(
            ElementEntry(int(tag), str(ops.eleType(tag)), tuple(map(int, ops.eleNodes(tag))))
            for tag in ops.getEleTags() or ()
        ),
    )


def read_initial(tags: Sequence[int]) -> SparseMatrix:
    """Read the stiffness of elements before any load, by the displacements of these nodes."""
    ops = opensees()
    with contextlib.redirect_stderr(io.StringIO()):
        found = _matrix(ops, _number(ops, tuple(tags), 6, 0.0, 0.0), 0.0, 0.0, 0.0, 1.0)
        ops.wipeAnalysis()
    return found


def _shape(ops: Any, tags: tuple[int, ...]) -> int:
    # Displacements of a node; refuses unknown shapes.
    if not tags:
        message = (
            "OpenSeesPy holds no model in this process: build it first (ops.model, ops.node, ...)"
        )
        raise ModelError(message)
    ndm = len(ops.nodeCoord(tags[0]))
    counts = [int(ops.getNDF(tag)[0]) for tag in tags]
    wanted = dict(SHAPES).get(ndm, 0)
    other = [tag for tag, count in zip(tags, counts, strict=True) if count != wanted]
    if other:
        message = (
            f"node {other[0]} of the OpenSees model has {counts[tags.index(other[0])]} "
            f"displacements in {ndm} dimensions ({len(other)} of {len(tags)} nodes): use ndm "
            "3 with ndf 6, or ndm 2 with ndf 3"
        )
        raise ModelError(message)
    if len(tags) * wanted > LARGEST:
        message = (
            f"the OpenSees model has {len(tags) * wanted} displacements (at most {LARGEST}): "
            "simplify or condense it"
        )
        raise ModelError(message)
    return wanted


def _refuse_motion(ops: Any, tags: tuple[int, ...]) -> None:
    # A model that moves, or that a pattern will move.
    for word, read, limit in (
        ("velocity", ops.nodeVel, _SPEED),
        ("acceleration", ops.nodeAccel, _ACCELERATION),
    ):
        sizes = [float(np.abs(read(tag)).max()) for tag in tags]
        worst = int(np.argmax(sizes))
        if not sizes[worst] <= limit:
            message = (
                f"the OpenSees model is not at rest: {word} {sizes[worst]:.3g} at node "
                f"{tags[worst]} (at most {limit:g}). Import it before its time history, or "
                "let it come to rest"
            )
            raise ModelError(message)
    for pattern in ops.getPatterns() or ():
        if not ops.getNodeLoadTags(pattern) and not ops.getEleLoadTags(pattern):
            message = (
                f"load pattern {pattern} of the OpenSees model has no loads (a ground motion "
                "or imposed displacements?): remove it by ops.remove('loadPattern', "
                f"{pattern}), and pass the motion to time_history"
            )
            raise ModelError(message)


def _number(ops: Any, tags: tuple[int, ...], ndf: int, supports: float, ties: float) -> IntArray:
    # Number the equations; the places of all displacements, node by node.
    ops.wipeAnalysis()
    ops.constraints("Penalty", supports, ties)
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    ops.analyze(1, 0.0)  # ends before the step; see the head of this file
    places = np.array([ops.nodeDOFs(tag) for tag in tags], dtype=np.int64).ravel()
    if not np.array_equal(np.sort(places), np.arange(len(tags) * ndf)):
        message = (
            f"OpenSees has {ops.systemSize()} equations, but the model has {len(tags) * ndf} "
            "displacements: use openseespy 3.7 or 3.8"
        )
        raise ModelError(message)
    return places


def _matrix(ops: Any, places: IntArray, *factors: float) -> SparseMatrix:
    # The system matrix with these factors of mass, damping, stiffness and initial stiffness.
    ops.integrator("GimmeMCK", *(*factors, 0.0, 0.0, 0.0)[: max(3, len(factors))])
    size = len(places)
    full = np.array(ops.printA("-ret"), dtype=np.float64).reshape(size, size)
    return sparse.csr_array(full[np.ix_(places, places)])
