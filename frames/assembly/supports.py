"""Path of permanent loads: forces of the bearings, and of supports of the structure."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import linalg as sparse_linalg

from lir_element.argument_checks import listed
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.coordinates import Basis
    from frames.assembly.system import System

UNSAID = 0.01
"""Part of the weight that supports above the bearings may take without a word [-]."""

NAMED = 4
"""Number of supports in a sentence."""

HELD = 8.0
"""Stiffness in plan beside the bearings, over that of their pendulums, above which there is a
doubt: a third of the isolated period [-].
"""

_RIGID = 1e-6  # residual of a translation that the model cannot make


class LoadPath(NamedTuple):
    """Path of the weight above the bearings to the ground."""

    weight: float  # permanent vertical load above the bearings [N]
    bearings: float  # part of it in the bearings [N]
    supports: tuple[tuple[str, float], ...]
    """Nodes above the bearings whose uz is held, and the load of each [N], largest first."""

    @property
    def lost(self) -> float:
        """Load carried by other supports than bearings [N]."""
        return sum(force for _, force in self.supports)

    def sentence(self) -> str:
        """Return the loads of the supports and the remedy; empty if they are negligible."""
        taken = [pair for pair in self.supports if abs(pair[1]) > UNSAID * self.weight]
        if not taken:
            return ""
        names = listed((f'"{node}" ({1e-3 * force:.4g} kN)' for node, force in taken), NAMED)
        return worded(
            "the bearings carry {bearings:.4g} of {weight:.4g} kN, vertical supports at "
            '{names} the rest. Free their "uz" and put the masses on columns or bearings, '
            "unless this is intended",
            bearings=1e-3 * self.bearings,
            weight=1e-3 * self.weight,
            names=names,
        )


def load_path(
    system: System, geometric: SparseMatrix, displacement: FloatArray, axial_forces: FloatArray
) -> LoadPath:
    """Compare the load of the bearings with the weight above them.

    Shapes: geometric (6 n_nodes, 6 n_nodes), displacement (n_free,), axial_forces (n_bearings,).
    """
    above = system.above_bearings
    held = np.diff(system.transform.indptr)[2::6] == 0
    moves = np.asarray(system.transform @ displacement)
    forces = np.asarray((system.node_stiffness + geometric) @ moves) - system.node_load
    reactions = forces[2::6]
    taken = [(system.node_names[k], float(reactions[k])) for k in np.flatnonzero(above & held)]
    standing = [above[b.j] and not above[b.i] for b in system.bearings]
    return LoadPath(
        weight=float(-system.node_load[2::6][above].sum()),
        bearings=float(np.asarray(axial_forces)[standing].sum()),
        supports=tuple(sorted(taken, key=lambda pair: -abs(pair[1]))),
    )


def held_sideways(
    system: System, geometric: SparseMatrix, basis: Basis, axial_forces: FloatArray
) -> list[str]:
    """Return restraints of the structure in plan besides the bearings, a sentence a direction.

    The tops of all bearings move equally; the rest follows statically. The resistance to that comes
    from springs and supports: a structure on bearings alone resists nothing. Elements that yield or
    push are left out.

    Shapes: geometric (6 n_nodes, 6 n_nodes), axial_forces (n_bearings,).
    """
    radii = np.array([placed.bearing.effective_radius for placed in system.bearings])
    pendulums = float((axial_forces / radii).sum())
    rows = system.bearing_rows[:, basis.bearing_dofs]
    elements = system.parts.stiffness()
    found = []
    for axis, name in enumerate("xy"):
        target = np.zeros((len(radii), 2, 6))
        target[:, 1, axis] = 1.0
        tops, *_, residual = sparse_linalg.lsqr(rows, target.ravel(), atol=1e-10, btol=1e-10)[:4]
        if residual > _RIGID * len(radii) or pendulums <= 0.0:
            continue  # of a model in the plane
        moves = np.asarray(system.transform @ (basis.expand_b @ tops))
        forces = np.asarray((system.node_stiffness + geometric - elements) @ moves)
        beside = float(moves @ forces) / pendulums
        if beside <= HELD:
            continue
        held = np.flatnonzero(np.diff(system.transform.indptr)[axis::6] == 0)
        largest = held[np.argsort(-np.abs(forces[axis::6][held]), kind="stable")]
        nodes = (f'"{system.node_names[k]}"' for k in largest if forces[6 * k + axis])
        found.append(
            worded(
                "springs or supports at {nodes} restrain the structure along {axis}, "
                "{beside:.3g} times as stiff as the bearings: it hardly slides. Remove them or "
                "put them below the bearings, unless this is intended",
                axis=name,
                beside=beside,
                nodes=listed(nodes, NAMED),
            )
        )
    return found
