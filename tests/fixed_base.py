"""Periods and reactions of a frame without bearings, by its matrices."""

from __future__ import annotations

import numpy as np
from scipy import linalg
from scipy.sparse.linalg import spsolve

from frames import Frame
from frames.assembly.assemble import assemble
from frames.model.axes import to_global, to_local


def periods(frame: Frame, count: int) -> np.ndarray:
    """Return the periods without the geometric stiffness [s]."""
    system = assemble(frame)
    k, m = system.stiffness.toarray(), system.mass.toarray()
    heavy = np.abs(m).sum(axis=1) > 0.0
    inner = np.linalg.solve(k[~heavy][:, ~heavy], k[~heavy][:, heavy])
    condensed = k[heavy][:, heavy] - k[heavy][:, ~heavy] @ inner
    values = linalg.eigh(condensed, m[heavy][:, heavy], eigvals_only=True)
    return 2 * np.pi / np.sqrt(values[:count])


def reactions(frame: Frame) -> dict[str, np.ndarray]:
    """Return what the supports give under the permanent loads, by the forces of all elements."""
    system = assemble(frame)
    u = system.transform @ spsolve(system.stiffness.tocsc(), system.load)
    table = system.members
    local = to_local(u[table.dofs], table.arrays.axes)
    ends = np.einsum("nij,nj->ni", table.stiffness, local) + table.fixed_end
    forces = np.zeros_like(u)
    np.add.at(forces, table.dofs, to_global(ends, table.arrays.axes))
    for part in frame.superelements.values():
        places = [system.node_names.index(n) for n in part.nodes]
        dofs = (6 * np.array(places)[:, None] + np.arange(6)).ravel()
        forces[dofs] += part.stiffness @ u[dofs]
    for node, load in frame.loads.items():
        place = 6 * system.node_names.index(node)
        forces[place : place + 6] -= load
    return {n: forces[6 * k : 6 * k + 6] for k, n in enumerate(system.node_names)}
