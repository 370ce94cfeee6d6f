"""Entries from C for a bearing at level 'pendulum'; compiled (or read from cache) on import.

`trial`, `tangent`, `commit` take the address of the bearing's block. `update`, `commit_state`,
`tangent_stiff` take the host element (in-process coupling).
"""

from __future__ import annotations

from numba import carray

from lir_element._compile.jit import entry_point
from lir_element.opensees.block.layout import HOST
from lir_element.opensees.block.pointers import pointer
from lir_element.opensees.kernels.element_states import (
    host_commit,
    host_retry,
    host_tangent,
    host_trial,
)
from lir_element.opensees.kernels.motion import (
    block_of,
    fail,
    read_committed_motion,
    read_motion,
    tell,
)


@entry_point("int32(int64, float64)")
def trial(block: int, dt: float) -> int:
    """Determine the state at the block's motion; returns a RunStatus code."""
    h = carray(pointer(block), 1, HOST)[0]
    return host_trial(h, None, dt)


@entry_point("void(int64)")
def tangent(block: int) -> None:
    """Set the block's tangent."""
    h = carray(pointer(block), 1, HOST)[0]
    host_tangent(h, None)


@entry_point("void(int64)")
def commit(block: int) -> None:
    """Accept the trial state."""
    h = carray(pointer(block), 1, HOST)[0]
    host_commit(h, None)


@entry_point("int32(int64)")
def update(element: int) -> int:
    """Determine the state at the nodes' trial motion; return 0, or the code of `fail`."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    dt = read_motion(h)
    code = host_trial(h, None, dt)
    tell(h)
    return 0 if code == 0 else fail(h)


@entry_point("int32(int64)")
def commit_state(element: int) -> int:
    """Accept the state at the motion that is committed."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if read_committed_motion(h):
        host_retry(h, None)
        tell(h)
    host_commit(h, None)
    return 0


@entry_point("int64(int64)")
def tangent_stiff(element: int) -> int:
    """Return the tangent stiffness, a Matrix."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    host_tangent(h, None)
    return h.tangent_matrix
