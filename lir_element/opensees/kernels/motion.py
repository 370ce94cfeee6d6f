"""Kernels that read OpenSees: the block of an element, the trial motion of its nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba import carray

from lir_element._jit import kernel
from lir_element.opensees.block.layout import NUMBERS, RESPONSE, STATE_WORDS, WORDS
from lir_element.opensees.block.pointers import (
    byte_at,
    call_number,
    call_word,
    call_write,
    number_at,
    pointer,
    word_at,
)

if TYPE_CHECKING:
    from lir_element.layout import Floats
    from lir_element.opensees.block.layout import Host, Response

_STDERR = 2
HASH_START = -3750763034362895579
HASH_FACTOR = 1099511628211
"""Of the hash of a response's name: Fowler, Noll, Vo (1a), 64 bits."""


@kernel
def block_of(element: int) -> int:
    """Return the address of the block, which lies in front of the element's virtual table."""
    return word_at(word_at(element) - 24)


@kernel
def copy_vector(vector: int, count: int, first: int, target: Floats) -> None:
    """Copy the entries of an OpenSees Vector (its data's address is its second word)."""
    data = word_at(vector + 8)
    for k in range(count):
        target[first + k] = number_at(data + 8 * k)


@kernel
def read_motion(h: Host) -> float:
    """Set the block's motion to the nodes' trial motion; returns the step since the commit.

    Explicit integrators set the domain's time after their trials: the step then is that from the
    last committed trial.
    """
    half = h.dofs // 2
    copy_vector(call_word(h.get_displacement, h.node_i), half, 0, h.host_u)
    copy_vector(call_word(h.get_displacement, h.node_j), half, half, h.host_u)
    copy_vector(call_word(h.get_velocity, h.node_i), half, 0, h.host_v)
    copy_vector(call_word(h.get_velocity, h.node_j), half, half, h.host_v)
    h.time = call_number(h.get_time, h.domain)
    step = number_at(h.step_size)
    return step if step > 0.0 else h.time - h.committed_time


@kernel
def tell_refusal(h: Host) -> None:
    """Write to standard error why the last trial has no state, once until the next commit."""
    if h.last_status != h.refused:
        h.refused = h.last_status
        call_write(h.write, _STDERR, h.messages[h.last_status], h.message_sizes[h.last_status])


@kernel
def find_response(h: Host, name: int) -> int:
    """Return the place of the response whose name (a C string) is at an address, or -1."""
    mixed = HASH_START
    for k in range(64):
        byte = byte_at(name + k)
        if byte == 0:
            break
        mixed = (mixed ^ byte) * HASH_FACTOR
    table = carray(pointer(h.responses), h.response_count, RESPONSE)
    for k in range(h.response_count):
        if table[k].name == mixed:
            return k
    return -1


@kernel
def fill_response(h: Host, response: Response) -> None:
    """Set the values of a response from the committed state, or the deformation."""
    if response.source < 0:
        for k in range(response.size):
            response.values[k] = h.host_u[response.size + k] - h.host_u[k]
    elif response.integer == 1:
        words = carray(pointer(h.old), STATE_WORDS, WORDS)
        for k in range(response.size):
            response.values[k] = float(words[response.source + k])
    else:
        numbers = carray(pointer(h.old), STATE_WORDS, NUMBERS)
        for k in range(response.size):
            response.values[k] = numbers[response.source + k]
