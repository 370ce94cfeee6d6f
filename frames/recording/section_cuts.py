"""Forces through horizontal cuts of a frame: rows over its displacements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames.assembly.assemble import scatter
from frames.model.axes import matrix_to_global, to_global

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from frames._types import BoolArray, FloatArray, IntArray, SparseMatrix
    from frames.assembly.system import System
    from frames.model.components import Level

_LEVEL = 1e-6  # m: nodes that are no higher than this over a level belong to it


class SectionCut(NamedTuple):
    """A horizontal cut: forces on all ends of elements, and those of members that cross it.

    Forces of the nodes on them, of members as far as they cross; those of other elements cancel in
    the resultant if both their ends are on one side.
    """

    above: BoolArray  # (n_nodes,)
    rows: SparseMatrix  # (6 n_nodes, 6 n_nodes) over displacements
    constant: FloatArray  # (6 n_nodes,) [N, N m]
    crossed: BoolArray  # (n_bearings,) bearings that cross it


@dataclass(frozen=True)
class StoreyRows:
    """Forces that storeys above the lowest level pass on, along x, y and z, storey by storey.

    `over_q @ q + over_beyond @ beyond + constant`, and the forces of the bearings that cross.
    """

    over_q: SparseMatrix  # (3 n_storeys, n_free) [N/m, N]
    over_beyond: FloatArray  # (3 n_storeys, m)
    constant: FloatArray  # (3 n_storeys,) [N]
    crossed: BoolArray  # (n_storeys, n_bearings)


def feet(heights: Sequence[float]) -> list[float]:
    """Return the elevations of storey cuts [m]: below the lowest level, above all but the last."""
    return [heights[0] - _LEVEL, *(height + _LEVEL for height in heights[:-1])]


def cuts(system: System, axial: FloatArray, elevations: Sequence[float]) -> list[SectionCut]:
    """Return the cuts of a frame at some elevations.

    Shapes: axial (n_members,).
    """
    table = system.members
    own, whole = (
        matrix_to_global(local, table.arrays.axes)
        for local in (table.stiffness, table.stiffness + table.geometric(axial))
    )
    count = len(system.node_names)
    others = system.node_stiffness - scatter(own, table.nodes, count)
    fixed_end = to_global(table.fixed_end, table.arrays.axes)
    found = []
    for z in elevations:
        above = system.coordinates[:, 2] > z
        crosses = above[table.nodes].any(axis=1) & ~above[table.nodes].all(axis=1)
        constant = np.zeros(6 * count)
        np.add.at(constant, table.dofs[crosses], fixed_end[crosses])
        rows = others + scatter(whole[crosses], table.nodes[crosses], count)
        crossed = np.array([bool(above[b.j] and not above[b.i]) for b in system.bearings])
        found.append(SectionCut(above, rows, constant, crossed))
    return found


def storey_feet(
    system: System, axial: FloatArray, levels: Sequence[Level]
) -> Iterator[tuple[SectionCut, SparseMatrix, SparseMatrix]]:
    """Yield the cut at each storey's foot, and rows that sum up forces below and above it."""
    # moments are about the middle of the nodes of the level below
    elevations = feet([level.z for level in levels]) if levels else []
    for k, cut in enumerate(cuts(system, axial, elevations)):
        nodes = [system.node_names.index(name) for name in levels[max(k - 1, 0)].nodes]
        middle = system.coordinates[nodes].mean(axis=0)
        lower, upper = (
            resultant(system.coordinates, middle, part) for part in (~cut.above, cut.above)
        )
        yield cut, lower, upper


def storey_rows(system: System, axial: FloatArray, heights: Sequence[float]) -> StoreyRows:
    """Return the forces of the storeys above the lowest level."""
    over_q, over_beyond, constant, crossed = [], [], [], []
    for cut in cuts(system, axial, feet(heights)[1:]):
        below = np.repeat(~cut.above, 6).astype(np.float64)
        lower = sparse.csr_array(np.tile(np.eye(3, 6), len(cut.above)) * -below)
        over_q.append(lower @ cut.rows @ system.transform)
        over_beyond.append((lower @ system.parts.node_rows.T).toarray())
        constant.append(np.asarray(lower @ cut.constant))
        crossed.append(cut.crossed)
    return StoreyRows(
        sparse.csr_array(sparse.vstack(over_q)),
        np.vstack(over_beyond),
        np.concatenate(constant),
        np.array(crossed),
    )


def resultant(coordinates: FloatArray, about: FloatArray, chosen: BoolArray) -> SparseMatrix:
    """Return the rows that sum up forces on nodes: force, and moment about a point.

    Shapes: coordinates (n_nodes, 3), about (3,), chosen (n_nodes,), result (6, 6 n_nodes).
    """
    nodes: IntArray = np.flatnonzero(chosen)
    x, y, z = (coordinates[nodes] - about).T
    entries: list[tuple[int, int, FloatArray]] = [(a, a, np.ones(len(nodes))) for a in range(6)]
    entries += [(3, 1, -z), (3, 2, y), (4, 0, z), (4, 2, -x), (5, 0, -y), (5, 1, x)]
    row = np.concatenate([np.full(len(nodes), a) for a, _, _ in entries])
    column = np.concatenate([6 * nodes + b for _, b, _ in entries])
    value = np.concatenate([v for _, _, v in entries])
    return sparse.csr_array((value, (row, column)), shape=(6, 6 * len(coordinates)))
