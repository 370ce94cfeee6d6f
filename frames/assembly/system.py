"""The assembled frame: matrices over the free degrees of freedom, and its members."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from frames.assembly.members import (
    MemberArrays,
    arms_geometric_stiffness,
    local_geometric_stiffness,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames._types import BoolArray, FloatArray, IntArray, SparseMatrix
    from frames.model.components import Link
    from frames.model.superelement import ElementTable
    from lir_element import Features, LIRBearing

BILINEAR, BOUC_WEN, TIE, VISCOUS, MAXWELL, STOP, HERTZ, HINGES = range(8)
"""Laws by number; the last is a member with hinges."""

CONSTANTS = 50
"""Constants of a part, at most: those of two hinges."""

HINGE = 30
"""First place of the constants of hinge i; those of hinge j follow after `STRIDE`."""

STRIDE = 10

STATE_SIZE = 10
"""Numbers of state of a part, at most."""

N_PLASTIC = 6
"""Plastic elongation, rotation about y and z of hinge i, then of hinge j: first in the state."""

WORK_DONE = 8
"""Place of the work of a part in its state; that of hinge j is the next one."""

SCRATCH = (18, 16)
"""Room that the solution of a hinged member needs."""

WIDEST = 5
"""Most deformations of one part."""

HINGED = -1.0
"""Marks a deformation of a hinged member among the elastic stiffnesses of parts."""


@dataclass(frozen=True, repr=False)
class NonlinearParts:
    """Links and hinged members of a frame; `n` parts with `m` deformations."""

    links: tuple[Link, ...]  # the links, first among the parts
    hinged: tuple[str, ...]  # members with hinges, after them
    kind: IntArray  # (n,) law by number (frames/kernels/laws.py)
    first: IntArray  # (n + 1,) first deformation of each part
    par: FloatArray  # (n, 50) constants of the laws
    # (m,) stiffness in the linear structure [N/m, N m/rad]; 0 of parts added under permanent loads,
    # -1 of hinged members, whose stiffness is the member's
    elastic: FloatArray
    scale: FloatArray
    """(m,) factor that makes a force of a moment: 1 / length of the member [1, 1/m]"""
    node_rows: SparseMatrix  # (m, 6 n_nodes) deformations from the nodes' displacements

    def own_stiffness(self) -> FloatArray:
        """Return the elastic stiffness of each deformation by itself, (m,) [N/m, N m/rad]."""
        found = self.elastic.clip(0.0)
        for k in range(len(self.links), len(self.kind)):
            found[self.first[k] : self.first[k + 1]] = self.par[k, :25:6]
        return found

    def stiffness(self) -> SparseMatrix:
        """Return the elastic stiffness of the links over all nodal displacements."""
        values = sparse.diags_array(self.elastic.clip(0.0))
        return sparse.csr_array(self.node_rows.T @ values @ self.node_rows)


class PlacedBearing(NamedTuple):
    """A bearing of a system: its name, the indices of its nodes, the bearing itself."""

    name: str
    i: int
    j: int
    bearing: LIRBearing


@dataclass(frozen=True)
class MemberTable:
    """Data of the `n` members for force recovery and the geometric stiffness."""

    names: tuple[str, ...]  # (n,) names, in the order of all member arrays
    arrays: MemberArrays  # section constants, lengths and local axes
    nodes: IntArray  # (n, 2) node indices of the ends i and j
    offsets: FloatArray  # (n, 2, 3) from the nodes to the members' ends [m]
    arms: FloatArray  # (n, 2, 3) the same in local axes
    # (n, 12, 12) local displacements of the members from those of their nodes, with releases and
    # offsets
    follow: FloatArray
    stiffness: FloatArray
    """(n, 12, 12) elastic stiffness in local axes, over the displacements of the nodes"""
    fixed_end: FloatArray
    """(n, 12) fixed-end forces of the members' loads in local axes, on their nodes [N, N m]"""

    def geometric(self, axial_forces: FloatArray) -> FloatArray:
        """Return the geometric stiffness (n, 12, 12) in local axes, over the nodes' displacements.

        Shapes: axial_forces (n,), result (n, 12, 12).
        """
        own = local_geometric_stiffness(self.arrays, axial_forces)
        bent = np.asarray(self.follow.transpose(0, 2, 1) @ own @ self.follow)
        return bent + arms_geometric_stiffness(self.arms, axial_forces)

    @property
    def dofs(self) -> IntArray:
        """Places of each member's 12 displacements among all nodal ones, (n, 12)."""
        return element_dofs(self.nodes)


@dataclass(frozen=True, repr=False)
class System:
    """A frame as matrices over its free degrees of freedom q; SI units."""

    node_names: tuple[str, ...]  # (n_nodes,) names, in the order of all node arrays
    coordinates: FloatArray  # (n_nodes, 3) coordinates [m]
    dof_labels: tuple[str, ...]
    """(n_free,) name of each free DOF: "base-1 ux"; of a diaphragm "floor-2 (diaphragm) rz"."""
    # (6 n_nodes, n_free) displacements (ux, uy, uz, rx, ry, rz of each node) are `transform @ q`
    transform: SparseMatrix
    stiffness: SparseMatrix
    """(n_free, n_free) elastic stiffness of members, springs and superelements, without bearings"""
    mass: SparseMatrix  # (n_free, n_free) mass; rows of a DOF without mass are zero
    # (n_free, n_free) of the superelements; empty without. `Frame.damping` is not in it
    damping: SparseMatrix
    # (n_nodes, 6) masses by node: diagonal of the lumped ones, of superelements for a unit
    # translation [kg, kg m2]
    node_mass: FloatArray
    load: FloatArray  # (n_free,) weights and permanent loads
    # (n_free, 3) transform.T @ M @ unit translation along x, y, z [kg]: a ground acceleration a_g
    # acts as the load `-inertia_load @ a_g`
    inertia_load: FloatArray
    bearings: tuple[PlacedBearing, ...]  # bearings with the indices of the nodes below and above
    gravity: float  # acceleration of gravity [m/s2]
    # (6 n_nodes, 6 n_nodes) elastic stiffness before elimination, for reactions:
    # `node_stiffness @ u - node_load`
    node_stiffness: SparseMatrix
    node_load: FloatArray  # (6 n_nodes,) weights and permanent loads before elimination [N, N m]
    members: MemberTable  # the members
    elements: ElementTable  # the line elements of superelements
    features: Features  # modelled features
    parts: NonlinearParts  # links and hinged members

    @cached_property
    def part_rows(self) -> SparseMatrix:
        """Deformations of the nonlinear parts from the free degrees of freedom, (m, n_free)."""
        return sparse.csr_array(self.parts.node_rows @ self.transform)

    @cached_property
    def fixed_dofs(self) -> IntArray:
        """Places among the nodes' displacements, six a node, of those that supports hold."""
        return np.flatnonzero(np.diff(self.transform.indptr) == 0)

    @cached_property
    def bearing_rows(self) -> SparseMatrix:
        """Rows of the transform that give the bearings' displacements, (12 n_bearings, n_free)."""
        # those of rotations are empty without plate rotation: then neither the nodes' rotations
        # reach a bearing, nor its moments the nodes
        nodes = np.array([(b.i, b.j) for b in self.bearings], dtype=np.int64).reshape(-1, 2)
        rows = (6 * nodes[:, :, None] + np.arange(6)).reshape(-1)
        if self.features.plate_rotation:
            return self.transform[rows]
        kept = sparse.diags_array((rows % 6 < 3).astype(np.float64))
        picked = sparse.csr_array(kept @ self.transform[rows])
        picked.eliminate_zeros()
        return picked

    @cached_property
    def above_bearings(self) -> BoolArray:
        """True for nodes joined to bearings by a member, spring, superelement, tie or diaphragm."""
        count = len(self.node_names)
        held, tied = self.node_stiffness.tocoo(), self.transform.tocoo()
        rows = np.concatenate([held.coords[0], tied.coords[0]]) // 6
        columns = np.concatenate([held.coords[1] // 6, count + tied.coords[1]])
        joins = np.concatenate([held.data, tied.data]).astype(bool)
        size = count + tied.shape[1]  # of nodes and free displacements
        joined = sparse.coo_array(
            (np.ones(np.count_nonzero(joins)), (rows[joins], columns[joins])), shape=(size, size)
        )
        _, part = csgraph.connected_components(joined, directed=False)
        return np.isin(part[:count], [part[placed.j] for placed in self.bearings])

    def moves_as(self, other: System) -> bool:
        """Return whether the nodes follow the free displacements as those of another one do."""
        own, others = self.transform, other.transform
        return own.shape == others.shape and all(
            np.array_equal(getattr(own, name), getattr(others, name))
            for name in ("data", "indices", "indptr")
        )

    def on(self, devices: Iterable[LIRBearing]) -> System:
        """Return the same structure on other bearings; data of the structure alone are shared."""
        found = copy.copy(self)
        placed = zip(self.bearings, devices, strict=True)
        vars(found)["bearings"] = tuple(old._replace(bearing=device) for old, device in placed)
        return found

    def __repr__(self) -> str:
        """Return sizes on one line."""
        return (
            f"System: {len(self.node_names)} nodes, {len(self.dof_labels)} degrees of freedom, "
            f"{len(self.members.names)} members, {len(self.bearings)} bearings"
        )


def element_dofs(nodes: IntArray) -> IntArray:
    """Return the places of two-node elements' displacements among all nodal ones.

    Shapes: nodes (n, 2), result (n, 12).
    """
    return (6 * nodes[:, :, None] + np.arange(6)).reshape(-1, 12)
