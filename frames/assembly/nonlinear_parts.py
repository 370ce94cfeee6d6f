"""Nonlinear parts of an assembled frame: links and members with hinges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from scipy import sparse

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray, SparseMatrix
    from frames.model.components import Link


@dataclass(frozen=True, repr=False)
class NonlinearParts:
    """Links and hinged members of a frame; `n` parts with `m` deformations.

    Attributes
    ----------
    links : tuple of Link
        The links, first among the parts.
    hinged : tuple of str
        Members with hinges, after them.
    kind : ndarray, (n,)
        Law by number (frames/kernels/laws.py).
    first : ndarray, (n + 1,)
        First deformation of each part.
    par : ndarray, (n, 50)
        Constants of the laws.
    elastic : ndarray, (m,)
        Stiffness in the linear structure [N/m, N m/rad]; 0 of what is put in under permanent loads,
        -1 of hinged members, whose stiffness is the member's.
    scale : ndarray, (m,)
        Factor that makes a force of a moment: 1 / length of the member [1, 1/m].
    node_rows : csr_array, (m, 6 n_nodes)
        Deformations from the nodes' displacements.
    """

    links: tuple[Link, ...]
    hinged: tuple[str, ...]
    kind: IntArray
    first: IntArray
    par: FloatArray
    elastic: FloatArray
    scale: FloatArray
    node_rows: SparseMatrix

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
