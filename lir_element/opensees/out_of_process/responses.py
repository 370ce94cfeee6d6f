"""Responses of an out-of-process element, if the build of OpenSees allows them.

Its states are determined in another process. This module provides the responses under the names of
OpenSees' bearings, the line in a printed model, and the refusal of a database. It also keeps the
other process in step: the motion that is committed, and signals held back.
"""

from __future__ import annotations

import ctypes
import signal
from typing import TYPE_CHECKING

import numpy as np

from lir_element.opensees.block.layout import HOST, MOST_DOFS
from lir_element.opensees.in_process.symbols import addresses
from lir_element.opensees.in_process.vtable_patch import VTablePatch, common_functions

if TYPE_CHECKING:
    from lir_element.opensees.placement import PlacedBearing

_HOST = {"tangent": "tangent_stiff", "initial": "initial_stiff", "commit": "commit_state"}
_OWN = {
    "update": "update_remote",
    "commit_state": "commit_remote",
    "tangent_stiff": "tangent_remote",
    "initial_stiff": "initial_remote",
    "resisting_force": "force_remote",
    "resisting_force_with_inertia": "force_remote",
    "damping": "zero_matrix",
    "mass": "zero_matrix",
    "revert_to_last_commit": "revert_remote",
    "revert_to_start": "restart_remote",
}
"""Callbacks in the place of the host's functions."""


class HostOverrides:
    """Some functions of ours in an element of the out-of-process coupling.

    A NotPossibleError: the element differs from that of the self-test.
    """

    def __init__(self, placed: PlacedBearing) -> None:
        from lir_element.opensees.kernels import callbacks

        block = np.zeros(1, dtype=HOST)
        block["dofs"] = dofs = placed.placement.dofs
        block["remote"] = 1
        block["all_signals"] = -1
        block["mask_mode"] = signal.SIG_SETMASK
        block["set_signals"] = ctypes.cast(ctypes.CDLL(None).pthread_sigmask, ctypes.c_void_p).value
        where = addresses()
        for name in ("update", "tangent", "initial", "commit"):
            block[f"host_{name}"] = where[_HOST.get(name, name)]
        self._graft = VTablePatch(placed, block, "portable")
        zeros = self._graft.keep(np.zeros(MOST_DOFS * MOST_DOFS))
        block["zero_matrix"] = self._graft.matrix(zeros.ctypes.data, dofs)
        own = {name: getattr(callbacks, each).address for name, each in _OWN.items()}
        self._graft.replace(common_functions() | own)

    def undo(self) -> None:
        """Restore a living element's own functions."""
        self._graft.undo()
