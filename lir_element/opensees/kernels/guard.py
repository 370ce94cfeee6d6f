"""The compiled part of a guard: wait for the server's end, then answer in its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba import carray

from lir_element._compile.jit import entry_point
from lir_element._compile.jit import with_refcounts as kernel
from lir_element.opensees.block.layout import END, GUARD, WORDS
from lir_element.opensees.block.pointers import call_poll, call_transfer, call_write, pointer

if TYPE_CHECKING:
    from lir_element.opensees.block.layout import GuardBlock

_STDERR = 2
_READABLE = 1  # POLLIN, the same on all systems
_EVENTS = 32  # a pollfd as one word: descriptor, events, events that happened
_HAPPENED = 48
_PAUSE = 20  # ms without a request, after which the model may be waiting for an answer


@kernel
def polled_word(descriptor: int, events: int) -> int:
    """Return a pollfd as one word (little-endian)."""
    return (descriptor & 0xFFFFFFFF) | (events << _EVENTS)


@kernel
def send_answer(g: GuardBlock, k: int) -> None:
    """Send an answer that is not a number to channel `k`."""
    fields = g.channels[k]
    call_transfer(g.send, fields[0], g.answer.ctypes.data, 8 * fields[1], g.send_flags)


@kernel
def wait_for_end(g: GuardBlock) -> bool:
    """Wait until the server is gone; False if the guard is to stop."""
    while True:
        g.polled[0] = polled_word(g.stop, _READABLE)
        g.polled[1] = polled_word(g.pipe, 0)
        if call_poll(g.poll, g.polled.ctypes.data, 2, -1) <= 0:
            continue
        if g.polled[0] >> _HAPPENED:
            return False
        if g.polled[1] >> _HAPPENED:
            return True


@kernel
def tell(g: GuardBlock) -> None:
    """Write to standard error why there are no answers; that explains failed steps as well."""
    carray(pointer(g.hinted), 1, WORDS)[0] = 1
    call_write(g.write, _STDERR, g.message, g.message_size)


@kernel
def answer_requests(g: GuardBlock, told: bool) -> None:
    """Answer requests of the model until the guard must stop; told: a request may wait."""
    count = g.channels.shape[0]
    waiting = told
    while True:
        g.polled[0] = polled_word(g.stop, _READABLE)
        for k in range(count):
            g.polled[k + 1] = polled_word(g.channels[k, 0], _READABLE)
        found = call_poll(g.poll, g.polled.ctypes.data, count + 1, _PAUSE if waiting else -1)
        if g.polled[0] >> _HAPPENED:
            return
        for k in range(count):
            if g.channels[k, 0] < 0:
                continue
            if found == 0:  # a request that the server had read when it was killed
                send_answer(g, k)
            elif g.polled[k + 1] >> _HAPPENED:
                size = 8 * g.inbox.shape[0]
                got = call_transfer(
                    g.recv, g.channels[k, 0], g.inbox.ctypes.data, size, g.receive_flags
                )
                if got > 0:
                    if not told and g.inbox[0] != END:
                        tell(g)
                        told = True
                    send_answer(g, k)
                else:
                    g.channels[k, 0] = -2  # the element is gone
        waiting = waiting and found != 0


@entry_point("void(int64)")
def watch(block: int) -> None:
    """Watch a server until it is gone or the guard is to stop; without a pipe there is none."""
    g = carray(pointer(block), 1, GUARD)[0]
    if g.pipe < 0:
        answer_requests(g, False)
    elif wait_for_end(g):
        tell(g)
        answer_requests(g, True)
