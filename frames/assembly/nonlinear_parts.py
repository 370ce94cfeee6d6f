"""Nonlinear parts of an assembled frame: links, members with hinges, and how their arrays lie."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from scipy import sparse

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.model.components import Link

BILINEAR, BOUC_WEN, TIE, VISCOUS, MAXWELL, STOP, HERTZ, HINGES = range(8)
"""Laws by number; the last is a member with hinges."""

CONSTANTS = 50
"""Constants of a part, at most: those of two hinges."""

HINGE = 30
"""Where the constants of hinge i begin; those of hinge j follow after `STRIDE`."""

STRIDE = 10

STATE_SIZE = 10
"""Numbers of state of a part, at most."""

N_PLASTIC = 6
"""Plastic elongation, rotation about y and z of hinge i, then of hinge j: first in the state."""

WORK_DONE = 8
"""Where the state of a part has the work it has done; of hinge j it is the next one."""

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
    # (m,) stiffness in the linear structure [N/m, N m/rad]; 0 of what is put in under permanent
    # loads, -1 of hinged members, whose stiffness is the member's
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
