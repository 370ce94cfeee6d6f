"""What an out-of-process element says of itself, where the build of OpenSees allows it.

Its states are determined in another process. What recorders ask for by the names of OpenSees'
bearings, its line in a printed model, and that a database does not hold it, is done here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lir_element.opensees.block.layout import HOST
from lir_element.opensees.block.messages import bearing_messages
from lir_element.opensees.block.responses import host_responses
from lir_element.opensees.fast.vtable_patch import Graft, common_functions

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing
    from lir_element.opensees.placement import Placement


class Manners:
    """Some functions of ours in an element of the out-of-process coupling.

    Parameters
    ----------
    tag : int
        Of the element.
    bearing : LIRBearing
        The device.
    level : str
        Level of fidelity.
    placement : Placement
        Its nodes and axes.

    Raises
    ------
    NotPossibleError
        If the element is not what it was in the self-test.
    """

    def __init__(self, tag: int, bearing: LIRBearing, level: str, placement: Placement) -> None:
        from lir_element.opensees.kernels import callbacks

        block = np.zeros(1, dtype=HOST)
        block["dofs"] = placement.dofs
        block["remote"] = 1
        load = bearing.resolved()["design_load"]
        self._graft = Graft(tag, placement, block, bearing_messages(tag, load, placement))
        self._graft.set_responses(host_responses(placement))
        self._graft.set_printed(
            name=tag,
            type="LIRBearing",
            nodes=[int(node) for node in placement.nodes],
            level=level,
            route="portable",
        )
        own = {"revert_to_last_commit": callbacks.revert_remote.address}
        self._graft.replace(common_functions() | own)

    def undo(self) -> None:
        """Give a living element its own functions back."""
        self._graft.undo()
