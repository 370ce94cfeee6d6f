"""Where permanent loads go: what the bearings carry, and what supports of the structure take."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.argument_checks import listed
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System

UNSAID = 0.01
"""Part of the weight that supports above the bearings may take without a word [-]."""

NAMED = 4
"""How many supports a sentence names."""


class LoadPath(NamedTuple):
    """How the weight of what stands on bearings reaches the ground."""

    weight: float  # permanent vertical load above the bearings [N]
    bearings: float  # what the bearings carry of it [N]
    supports: tuple[tuple[str, float], ...]
    """Nodes above the bearings whose uz is held, and what each takes [N], largest first."""

    @property
    def lost(self) -> float:
        """Load carried by other supports than bearings [N]."""
        return sum(force for _, force in self.supports)

    def sentence(self) -> str:
        """Return what the supports take, and what to do; empty where it is next to nothing."""
        taken = [pair for pair in self.supports if abs(pair[1]) > UNSAID * self.weight]
        if not taken:
            return ""
        names = listed((f'"{node}" ({1e-3 * force:.4g} kN)' for node, force in taken), NAMED)
        return worded(
            "the bearings carry {bearings:.4g} kN of the {weight:.4g} kN above them: vertical "
            'supports take the rest past them, at {names}. Free their "uz" and put the masses '
            "where columns or bearings carry them (a diaphragm ties nothing vertically), unless "
            "these supports are meant",
            bearings=1e-3 * self.bearings,
            weight=1e-3 * self.weight,
            names=names,
        )


def load_path(
    system: System, geometric: SparseMatrix, displacement: FloatArray, axial_forces: FloatArray
) -> LoadPath:
    """Compare what the bearings carry with the weight above them.

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
