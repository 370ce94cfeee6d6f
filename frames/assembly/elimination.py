"""Elimination of linear equations, and of directions without mass, from the free displacements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph

from frames._errors import ModelError
from frames.assembly.dense_solver import solve_positive

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix

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
    """Change displacements so that those without mass stand alone.

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
                f'there is negative mass near "{labels[cluster[int(np.argmin(diagonal))]]}" '
                f"(smallest entry of the diagonal {diagonal.min():.4g} kg): give masses of 0 or "
                "greater"
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
