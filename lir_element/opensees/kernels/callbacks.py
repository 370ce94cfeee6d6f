"""Functions that OpenSees calls instead of the host element's own, the same at every level.

Every function takes the address of the element first, as C++ methods do; `restart`, which the
out-of-process coupling calls, takes that of the block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba import carray

from lir_element._compile.jit import entry_point
from lir_element._compile.jit import with_refcounts as kernel
from lir_element.opensees.block.layout import HOST, NOT_SAVED, RESPONSE
from lir_element.opensees.block.pointers import (
    call_2,
    call_constructor,
    call_int,
    call_print,
    call_response,
    call_void,
    call_with_int,
    call_word,
    call_write,
    pointer,
    set_word,
    word_at,
)
from lir_element.opensees.kernels.element_states import host_restart, host_revert
from lir_element.opensees.kernels.motion import (
    block_of,
    copy_vector,
    fill_response,
    find_response,
    give_hint,
    read_committed_motion,
    read_displacements,
    read_motion,
)

if TYPE_CHECKING:
    from lir_element.opensees.block.layout import Host

FIRST_RESPONSE = 1000
"""Number of the first of our responses, above those of the host element."""
_RESPONSE_BYTES = 1024
_STDERR = 2
_JSON = 25000
"""Flag by which OpenSees requests a model's JSON (`OPS_PRINT_PRINTMODEL_JSON`)."""


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
    """Drop the trial of a step that failed."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if h.refused != 0:
        h.failures += 1
    host_revert(h)
    if h.last_status == 0:  # the committed state is no cause
        give_hint(h)
    return 0


@kernel
def call_host(h: Host, function: int, element: int) -> int:
    """Call a function of the host element that talks to another process, all signals held back.

    OpenSees takes a read that a signal interrupts for one of -1 bytes. Another thread of the
    process handles the signal.
    """
    call_write(h.set_signals, h.mask_mode, h.all_signals.ctypes.data, h.own_signals.ctypes.data)
    result = call_word(function, element)
    call_write(h.set_signals, h.mask_mode, h.own_signals.ctypes.data, 0)
    return result


@entry_point("int32(int64)")
def update_remote(element: int) -> int:
    """Send the trial motion to the process that determines the states."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    h.step = read_motion(h)
    call_host(h, h.host_update, element)
    return 0


@entry_point("int32(int64)")
def commit_remote(element: int) -> int:
    """Commit the state at the committed motion in the other process."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if read_committed_motion(h):
        call_host(h, h.host_update, element)
    call_host(h, h.host_commit, element)
    return 0


@entry_point("int64(int64)")
def tangent_remote(element: int) -> int:
    """Return the other process's tangent stiffness, a Matrix."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    return call_host(h, h.host_tangent, element)


@entry_point("int64(int64)")
def initial_remote(element: int) -> int:
    """Return the other process's stiffness at rest, a Matrix."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    return call_host(h, h.host_initial, element)


@entry_point("int64(int64)")
def force_remote(element: int) -> int:
    """Return the other process's resisting force, a Vector."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    return call_host(h, h.host_force, element)


@entry_point("int32(int64)")
def revert_remote(element: int) -> int:
    """Revert in the model's process if another one determines the states."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    give_hint(h)
    return 0


@entry_point("int32(int64)")
def restart_remote(_element: int) -> int:
    """Do nothing: a motion that is all zero at time 0 restarts the bearing in the other process."""
    return 0


@entry_point("int64(int64)")
def class_type(element: int) -> int:
    """Return the element's type, a C string."""
    return carray(pointer(block_of(element)), 1, HOST)[0].type_name


@entry_point("int32(int64)")
def revert_to_start(element: int) -> int:
    """Reset the bearing to its start."""
    host_restart(carray(pointer(block_of(element)), 1, HOST)[0])
    return 0


@entry_point("void(int64)")
def restart(block: int) -> None:
    """Reset the bearing to its start."""
    host_restart(carray(pointer(block), 1, HOST)[0])


@entry_point("void(int64)")
def destroy(element: int) -> None:
    """Mark the element as gone in the block, and destroy it."""
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
    """Return a new Response for a recorder's `words`; 0 if there is none."""
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
    """Write a response to a recorder."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if number < FIRST_RESPONSE:
        return call_with_int(h.host_get_response, element, number, information)
    table = carray(pointer(h.responses), h.response_count, RESPONSE)
    response = table[number - FIRST_RESPONSE]
    if h.remote == 1:
        copy_vector(call_host(h, h.host_force, element), h.dofs, 0, h.force)
        read_displacements(h)
    fill_response(h, response)
    return call_int(h.set_vector, information, response.vector)


@entry_point("int32(int64, int32, int64)")
def send_self(element: int, _commit: int, _channel: int) -> int:
    """Refuse to be saved: a database holds none of the bearing's state."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    call_write(h.write, _STDERR, h.messages[NOT_SAVED], h.message_sizes[NOT_SAVED])
    return -1


@entry_point("int32(int64, int32, int64, int64)")
def receive_self(element: int, _commit: int, _channel: int, _broker: int) -> int:
    """Refuse to be restored."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    call_write(h.write, _STDERR, h.messages[NOT_SAVED], h.message_sizes[NOT_SAVED])
    return -1


@entry_point("void(int64, int64, int32)")
def print_element(element: int, stream: int, flag: int) -> None:
    """Print the element: into a model's JSON a line of our own."""
    h = carray(pointer(block_of(element)), 1, HOST)[0]
    if flag == _JSON:
        call_2(word_at(word_at(stream) + 8 * h.stream_slot), stream, h.json)
    else:
        call_print(h.host_print, element, stream, flag)
