"""Kernels that read OpenSees: the block of an element, the trial motion of its nodes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from numba import carray

from lir_element._compile.jit import with_refcounts as kernel
from lir_element.opensees.block.layout import (
    CONSTANT,
    FROM_FORCE,
    HINT,
    NUMBERS,
    RESPONSE,
    STATE_WORDS,
    WORDS,
)
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
_PATIENCE = 2  # refused steps in a row
_SAME_STEP = 1e-6  # of its length: times far from zero have round-off
HASH_START = -3750763034362895579
HASH_FACTOR = 1099511628211
"""Factor of the hash of a response's name: Fowler, Noll, Vo (1a), 64 bits."""


@kernel
def block_of(element: int) -> int:
    """Return the address of the block, which lies in front of the element's virtual table."""
    return word_at(word_at(element) - 24)


@kernel
def copy_vector(vector: int, count: int, first: int, target: Floats) -> bool:
    """Copy the entries of an OpenSees Vector (its data's address is its second word).

    Returns whether that changed the target.
    """
    data = word_at(vector + 8)
    changed = False
    for k in range(count):
        value = number_at(data + 8 * k)
        changed = changed or value != target[first + k]
        target[first + k] = value
    return changed


@kernel
def read_displacements(h: Host) -> bool:
    """Set the block's displacements to the nodes' trial ones; returns whether that changed them."""
    half = h.dofs // 2
    below = copy_vector(call_word(h.get_displacement, h.node_i), half, 0, h.host_u)
    above = copy_vector(call_word(h.get_displacement, h.node_j), half, half, h.host_u)
    return below or above


@kernel
def read_velocities(h: Host) -> bool:
    """Set the block's velocities to the nodes' trial ones; returns whether that changed them."""
    half = h.dofs // 2
    below = copy_vector(call_word(h.get_velocity, h.node_i), half, 0, h.host_v)
    above = copy_vector(call_word(h.get_velocity, h.node_j), half, half, h.host_v)
    return below or above


@kernel
def read_motion(h: Host) -> float:
    """Set the block's motion to the nodes' trial motion; returns the step since the commit.

    The step is 0 if an integrator sets the domain's time after its trials.
    """
    read_displacements(h)
    read_velocities(h)
    h.time = call_number(h.get_time, h.domain)
    step = number_at(h.step_size)
    h.domain_time = h.time - step
    return step


@kernel
def read_committed_motion(h: Host) -> bool:
    """Set the block's motion and step to those of the domain's commit.

    Returns True if they differ from those of the last trial. Methods with an alpha or a theta try
    states within the step or beyond it, explicit ones set the time later, some move the nodes
    without a trial: only at the commit do displacement, velocity and time belong together.
    """
    moved = read_displacements(h)
    moved = read_velocities(h) or moved
    h.time = call_number(h.get_time, h.domain)
    step = h.time - h.domain_time
    moves = False
    for k in range(h.dofs):
        moves = moves or h.host_v[k] != 0.0
    other = moves and abs(step - h.step) > _SAME_STEP * max(abs(step), abs(h.step))
    if other:
        h.step = step
    return moved or other


@kernel
def tell(h: Host) -> None:
    """Write the message of the last trial to standard error."""
    if h.telling != 0:
        call_write(h.write, _STDERR, h.messages[h.telling], h.message_sizes[h.telling])


@kernel
def fail(h: Host) -> int:
    """Return the code of an update without a state: -1, and 0 if that did not end it.

    `VariableTransient` shortens its steps by the number of iterations alone. It repeats a step that
    fails before any iteration with the same length for ever. After two of them the forces are
    therefore no numbers, and the test of convergence counts.
    """
    if h.failures < _PATIENCE:
        return -1
    for k in range(h.dofs):
        h.force[k] = math.nan
    return 0


@kernel
def give_hint(h: Host) -> None:
    """Write the probable cause of a failed step, once in a process."""
    word = carray(pointer(h.hinted), 1, WORDS)
    if word[0] == 0 and h.symmetric == 0:
        word[0] = 1
        call_write(h.write, _STDERR, h.messages[HINT], h.message_sizes[HINT])


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
    """Set the values of a response from the committed state, the motion or the force."""
    if response.source == CONSTANT:
        return
    if response.source < 0:
        given = h.force if response.source == FROM_FORCE else h.host_u
        rows = carray(pointer(response.map), (response.size, h.dofs), NUMBERS)
        for k in range(response.size):
            response.values[k] = 0.0
            for m in range(h.dofs):
                response.values[k] += rows[k, m] * given[m]
    elif response.integer == 1:
        words = carray(pointer(h.old), STATE_WORDS, WORDS)
        for k in range(response.size):
            response.values[k] = float(words[response.source + k])
    else:
        numbers = carray(pointer(h.old), STATE_WORDS, NUMBERS)
        for k in range(response.size):
            response.values[k] = numbers[response.source + k]
