"""The in-process coupling: a host element with its states determined in the model's process."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np

from lir_element.layout import STATE, STATE_FIELDS
from lir_element.opensees.block.layout import MOST_DOFS, offset_of
from lir_element.opensees.in_process.vtable_patch import VTablePatch, address_of, common_functions

if TYPE_CHECKING:
    import socket

    from lir_element.opensees.element_memory import ElementMemory

_HOST_RESPONSES = {"force"}
"""Names that the host element answers by itself, from our resisting force."""


class InProcessElement:
    """A bearing in the place of a host element of the current model.

    The host element's destructor writes to the connection `farewell`. A NotPossibleError: the
    element differs from that of the self-test.
    """

    route = "fast"

    def __init__(self, hosted: ElementMemory, farewell: socket.socket) -> None:
        self.hosted = hosted
        self.placed = hosted.placed
        self.response, self.recorded = hosted.response, hosted.recorded
        self.start_recording, self.outcome = hosted.start_recording, hosted.outcome
        self._farewell = farewell
        self._graft = VTablePatch(self.placed, hosted.block, self.route, _state_words())
        self._set_objects()
        self._graft.replace(_callbacks(self.placed.level))

    @property
    def alive(self) -> bool:
        """True if OpenSees still has the element."""
        return self._graft.alive

    def detach(self) -> None:
        """Restore the element's own functions: ours end with Python, before OpenSees does."""
        if self.alive:
            self._graft.undo()
            self._farewell.detach()  # stays open: to a closed end the destructor writes for ever

    def release(self) -> None:
        """Close the connection, once the element is gone."""
        self._farewell.close()

    def _set_objects(self) -> None:
        block, count, graft = self.hosted.block, self.placed.placement.dofs, self._graft
        zeros = graft.keep(np.zeros(MOST_DOFS * MOST_DOFS))
        block["force_vector"] = graft.vector(address_of(block, "force"), count)
        block["tangent_matrix"] = graft.matrix(address_of(block, "tangent"), count)
        block["initial_matrix"] = graft.matrix(address_of(block, "initial"), count)
        block["zero_matrix"] = graft.matrix(zeros.ctypes.data, count)


def _state_words() -> list[tuple[str, int, int, bool]]:
    rows = []
    for field in STATE_FIELDS:
        size = int(np.prod(field.shape, dtype=int))
        if field.name not in _HOST_RESPONSES and size <= MOST_DOFS:
            rows.append((field.name, offset_of(STATE, field.name) // 8, size, field.kind == "i8"))
    return rows


@functools.cache
def _callbacks(level: str) -> dict[str, int]:
    # Addresses of the replacement of each function; compiled on first use.
    from lir_element.opensees.element_memory import entries_of
    from lir_element.opensees.kernels import callbacks

    entries = entries_of(level)
    functions = {
        "update": entries.update,
        "commit_state": entries.commit_state,
        "tangent_stiff": entries.tangent_stiff,
        "initial_stiff": callbacks.initial_stiff,
        "resisting_force": callbacks.resisting_force,
        "resisting_force_with_inertia": callbacks.resisting_force,
        "damping": callbacks.zero_matrix,
        "mass": callbacks.zero_matrix,
        "revert_to_last_commit": callbacks.revert_to_last_commit,
        "revert_to_start": callbacks.revert_to_start,
    }
    return {name: each.address for name, each in functions.items()} | common_functions()
