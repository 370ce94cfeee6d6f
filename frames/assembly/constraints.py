r"""Supports and diaphragms: the matrix that carries the free DOFs to all nodal displacements.

A diaphragm moves as X, Y, RZ of its master point; each of its nodes follows with

.. math:: u_x = X - (y - y_c) R_Z, \quad u_y = Y + (x - x_c) R_Z, \quad r_z = R_Z

and keeps its own uz, rx and ry. A support in the plane of a diaphragm's node is a linear equation
on X, Y and RZ; Gaussian elimination decides which of the three it removes.

Equations and directions without mass are eliminated from the free displacements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph

from frames._errors import ModelError
from frames.assembly.solvers import solve_positive
from frames.model.components import DOFS, Diaphragm

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.model.frame_data import FrameData

IN_PLANE = (0, 1, 5)
"""Places of ux, uy and rz, the displacements a diaphragm ties, among a node's six."""

OUT_OF_PLANE = ("uy", "rx", "rz")
"""Displacements held if the second horizontal direction is left out."""


def free_dofs(
    frame: FrameData, coordinates: FloatArray, node_mass: FloatArray, *, planar: bool = False
) -> tuple[SparseMatrix, tuple[str, ...]]:
    """Eliminate supports and diaphragms.

    Shapes: coordinates (n_nodes, 3), node_mass (n_nodes, 6), transform (6 n_nodes, n_free), labels
    (n_free,).
    """
    index = {name: place for place, name in enumerate(frame.nodes)}
    held = held_dofs(frame, planar=planar)
    tied = {node for diaphragm in frame.diaphragms.values() for node in diaphragm.nodes}
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    labels: list[str] = []
    for name, place in index.items():
        fixed = held[name]
        for dof, word in enumerate(DOFS):
            if word in fixed or (name in tied and dof in IN_PLANE):
                continue
            rows.append(6 * place + dof)
            columns.append(len(labels))
            values.append(1.0)
            labels.append(f"{name} {word}")
    for diaphragm in frame.diaphragms.values():
        places = np.array([index[node] for node in diaphragm.nodes])
        block, kept = _diaphragm_block(held, diaphragm, coordinates[places], node_mass[places])
        places_in_plane = (6 * places[:, None] + np.array(IN_PLANE)).ravel()
        at_row, at_column = np.nonzero(block)
        rows.extend(places_in_plane[at_row].tolist())
        columns.extend((at_column + len(labels)).tolist())
        values.extend(block[at_row, at_column].tolist())
        labels.extend(f"{diaphragm.name} (diaphragm) {DOFS[IN_PLANE[k]]}" for k in kept)
    transform = sparse.csr_array(
        sparse.coo_array(
            (np.array(values), (np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))),
            shape=(6 * len(index), len(labels)),
        )
    )
    return transform, tuple(labels)


def held_dofs(frame: FrameData, *, planar: bool = False) -> dict[str, frozenset[str]]:
    """Return the names of the displacements held at each node, all out of the plane if `planar`."""
    more = frozenset(OUT_OF_PLANE if planar else ())
    return {name: frame.fixed_dofs.get(name, frozenset()) | more for name in frame.nodes}


def in_plane_rows(position: FloatArray, centre: FloatArray) -> FloatArray:
    """Return the matrix from (X, Y, RZ) of a diaphragm to (ux, uy, rz) of its nodes.

    Shapes: position (n, 3), centre (2,), result (n, 3, 3).
    """
    block = np.zeros((position.shape[0], 3, 3))
    block[:] = np.eye(3)
    block[:, 0, 2] = -(position[:, 1] - centre[1])
    block[:, 1, 2] = position[:, 0] - centre[0]
    return block


def _diaphragm_block(
    held: dict[str, frozenset[str]], diaphragm: Diaphragm, position: FloatArray, mass: FloatArray
) -> tuple[FloatArray, IntArray]:
    # Matrix (3 n, n_kept) from the kept ones of (X, Y, RZ) to (ux, uy, rz) of every node.
    weight = mass[:, 0] if mass[:, 0].any() else np.ones(len(diaphragm.nodes))
    centre = weight @ position[:, :2] / weight.sum()
    rows = in_plane_rows(position, centre)
    fixed = np.array([[DOFS[dof] in held[node] for dof in IN_PLANE] for node in diaphragm.nodes])
    span = float(np.linalg.norm(position[:, :2] - centre, axis=1).max()) or 1.0
    scale = np.array([1.0, 1.0, 1.0 / span])
    kept, solution = _solve_homogeneous(rows[fixed] * scale)
    block = (rows.reshape(-1, 3) * scale) @ solution / scale[kept]
    block[fixed.ravel()] = 0.0
    block[np.abs(block) < 1e-12 * span] = 0.0
    return block, kept


def _solve_homogeneous(equations: FloatArray) -> tuple[IntArray, FloatArray]:
    # Solves equations @ x = 0 for three unknowns of like size: the places of the unknowns kept
    # free, and the matrix (3, n_kept) that gives all three from them.
    reduced = equations.copy()
    pivots: list[int] = []
    row = 0
    for column in range(3):
        if row == reduced.shape[0]:
            break
        best = row + int(np.argmax(np.abs(reduced[row:, column])))
        if abs(reduced[best, column]) < 1e-9:
            continue
        reduced[[row, best]] = reduced[[best, row]]
        reduced[row] /= reduced[row, column]
        others = np.arange(reduced.shape[0]) != row
        reduced[others] -= np.outer(reduced[others, column], reduced[row])
        pivots.append(column)
        row += 1
    kept = np.array([column for column in range(3) if column not in pivots], dtype=np.int64)
    solution = np.zeros((3, kept.size))
    solution[kept, np.arange(kept.size)] = 1.0
    if pivots:
        solution[pivots] = -reduced[: len(pivots)][:, kept]
    return kept, solution


_ZERO = 1e-9  # of the largest coefficient of an equation, below which one counts as nothing
_PIVOT = 0.1  # of the same, from which on a coefficient may be divided by
_MASSLESS = 1e-10  # of the diagonal, below which a direction has no mass
_NEGATIVE = 1e-8  # of the diagonal, that round-off may take a mass below zero


def eliminate(equations: SparseMatrix, scale: FloatArray) -> tuple[IntArray, SparseMatrix]:
    """Solve homogeneous linear equations for some of their unknowns.

    Shapes: equations (m, n), scale (n,), kept (k,), follow (n, k).
    """
    size = equations.shape[1]
    columns = np.unique(equations.indices).astype(np.int64)
    work = equations[:, columns].toarray() * scale[columns]
    largest = np.abs(work).max(axis=1, initial=0.0)
    work = work[largest > 0.0] / largest[largest > 0.0, None]
    pivots: list[int] = []
    rows: list[int] = []
    open_rows = list(range(len(work)))
    while open_rows:
        filled = work[open_rows].astype(bool)
        row = open_rows[int(np.argmin(filled.sum(axis=1)))]
        open_rows.remove(row)
        peak = np.abs(work[row]).max()
        if peak <= _ZERO:
            continue
        # a displacement that few equations name: the tied one rather than the one it is tied to
        able = np.flatnonzero(np.abs(work[row]) >= _PIVOT * peak)
        column = int(able[np.argmin(work[:, able].astype(bool).sum(axis=0))])
        work[row] /= work[row, column]
        others = np.flatnonzero(work[:, column])
        others = others[others != row]
        work[others] -= np.outer(work[others, column], work[row])
        work[np.abs(work) < _ZERO] = 0.0
        rows.append(row)
        pivots.append(column)
    gone = columns[pivots]
    kept = np.setdiff1d(np.arange(size), gone)
    free = np.setdiff1d(np.arange(len(columns)), pivots)
    solved = work[rows][:, free]
    at_row, at_column = np.nonzero(solved)
    values = -solved[at_row, at_column]
    values *= scale[gone[at_row]] / scale[columns[free[at_column]]]
    place = np.full(size, -1, dtype=np.int64)
    place[kept] = np.arange(len(kept))
    follow = sparse.coo_array(
        (
            np.concatenate([np.ones(len(kept)), values]),
            (
                np.concatenate([kept, gone[at_row]]),
                np.concatenate([place[kept], place[columns[free[at_column]]]]),
            ),
        ),
        shape=(size, len(kept)),
    )
    return kept, sparse.csr_array(follow)


def separate_massless(mass: SparseMatrix, labels: tuple[str, ...]) -> tuple[SparseMatrix, IntArray]:
    """Change displacements so that the massless ones are separate.

    Masses at the end of rigid links leave a mass matrix that is singular without having zero
    rows. Directions in which nothing moves that has mass get displacements of their own.

    Shapes: mass (n, n), labels (n,), turn (n, n).
    """
    size = mass.shape[0]
    turn = sparse.lil_array(sparse.eye_array(size))
    _, part = csgraph.connected_components(mass, directed=False)
    massless: list[int] = []
    for cluster in _groups(part.astype(np.int64)):
        block = mass[cluster][:, cluster].toarray()
        diagonal = np.diag(block)
        empty = not block.any()
        root = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        scaled = block / np.outer(root, root)
        if not empty and linalg.eigvalsh(scaled)[0] < -_NEGATIVE:
            message = (
                f'the mass is negative near "{labels[cluster[int(np.argmin(diagonal))]]}" '
                f"(smallest entry of the diagonal {diagonal.min():.4g} kg): use masses of at "
                "least 0"
            )
            raise ModelError(message)
        if empty:
            massless.extend(cluster.tolist())
            continue
        _, order, rank, _ = linalg.lapack.dpstrf(scaled, tol=_MASSLESS, lower=1)
        if rank == len(cluster):
            continue
        first, last = order[:rank] - 1, order[rank:] - 1
        names = [labels[place] for place in cluster[first].tolist()]
        inner = block[np.ix_(first, first)]
        lead = -solve_positive(inner, block[np.ix_(first, last)], "mass", names)
        turn[np.ix_(cluster[first], cluster[last])] = lead
        massless.extend(cluster[last].tolist())
    return sparse.csr_array(turn), np.array(sorted(massless), dtype=np.int64)


def _groups(part: IntArray) -> list[IntArray]:
    # Places of equal numbers.
    order = np.argsort(part, kind="stable")
    breaks = np.flatnonzero(np.diff(part[order])) + 1
    return [group.astype(np.int64) for group in np.split(order, breaks)]
