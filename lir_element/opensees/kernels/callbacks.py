"""What OpenSees calls in place of the host element's own functions, the same at every level.

Every function takes the address of the element first, as C++ methods do; `restart`, which the
portable route calls, takes that of the block.
"""

from __future__ import annotations

from numba import carray

from lir_element._jit import entry_point
from lir_element.opensees.block.layout import HOST, RESPONSE
from lir_element.opensees.block.pointers import (
    call_constructor,
    call_int,
    call_response,
    call_void,
    call_with_int,
    call_word,
    pointer,
    set_word,
    word_at,
)
from lir_element.opensees.kernels.hosted import host_restart, host_revert
from lir_element.opensees.kernels.motion import block_of, fill_response, find_response

FIRST_RESPONSE = 1000
"""Number of the first of our responses, above those of the host element."""
_RESPONSE_BYTES = 1024


@entry_point("int64(int64)")
def resisting_force(element: int) -> int:
    """Return the resisting force of the last trial, a Vector."""
    return carray(pointer(block_of(element)), 1, HOST)[0].force_vector


@entry_point("int64(int64)")
def initial_stiff(element: int) -> int:
    """Return the stiffness at rest, a Matrix."""
    return carray(pointer(block_of(element)), 1, HOST)[0].initial_matrix


@entry_point("int64(int64)")
def zero_matrix(element: int) -> int:
    """Return a Matrix of zeros: damping and mass."""
    return carray(pointer(block_of(element)), 1, HOST)[0].zero_matrix


@entry_point("int32(int64)")
def revert_to_last_commit(element: int) -> int:
    """Forget the trial."""
    host_revert(carray(pointer(block_of(element)), 1, HOST)[0])
    return 0


@entry_point("int32(int64)")
def revert_to_start(element: int) -> int:
    """Bring the bearing back to its start."""
    host_restart(carray(pointer(block_of(element)), 1, HOST)[0])
    return 0


@entry_point("void(int64)")
def restart(block: int) -> None:
    """Bring the bearing back to its start."""
    host_restart(carray(pointer(block), 1, HOST)[0])


@entry_point("void(int64)")
def destroy(element: int) -> None:
    """Let the block know that the element is gone, and destroy it."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    h.alive = 0
    set_word(element, h.host_table)
    call_void(h.destroy, element)


@entry_point("void(int64)")
def destroy_free(element: int) -> None:
    """Do the same, and free the element's memory."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    h.alive = 0
    set_word(element, h.host_table)
    call_void(h.destroy_free, element)


@entry_point("int64(int64, int64, int32, int64)")
def set_response(element: int, words: int, count: int, stream: int) -> int:
    """Return a new Response for a recorder that asks for `words`; 0 where there is none."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    place = find_response(h, word_at(words)) if count > 0 else -1
    if place < 0:
        return call_response(h.host_set_response, element, words, count, stream)
    table = carray(pointer(h.responses), h.response_count, RESPONSE)
    response = call_word(h.allocate, _RESPONSE_BYTES)
    call_constructor(h.new_response, response, element, FIRST_RESPONSE + place, table[place].vector)
    return response


@entry_point("int32(int64, int32, int64)")
def get_response(element: int, number: int, information: int) -> int:
    """Hand a response over to a recorder."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if number < FIRST_RESPONSE:
        return call_with_int(h.host_get_response, element, number, information)
    table = carray(pointer(h.responses), h.response_count, RESPONSE)
    response = table[number - FIRST_RESPONSE]
    fill_response(h, response)
    return call_int(h.set_vector, information, response.vector)
