"""Signals that wait: Ctrl-C must not come between a question to another process and its answer."""

from __future__ import annotations

import signal
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Generator


_READS = {"restart": False}


@contextmanager
def signals_held() -> Generator[None]:
    """Hold back the signals that Python handles until the block has ended.

    Their handlers then run one after the other. Python runs them in the main thread alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    caught: list[tuple[int, Any]] = []
    handlers: dict[int, Any] = {}
    try:
        for number in sorted(signal.valid_signals()):
            handler = signal.getsignal(number)
            if callable(handler):
                handlers[number] = handler
                signal.signal(number, lambda *arguments: caught.append(arguments))
        yield
    finally:
        # Ctrl-C raises an exception as soon as it has its handler back: last
        for each in sorted(handlers, key=lambda number: number == signal.SIGINT):
            signal.signal(each, handlers[each])
            restart_reads(each)
        for came, frame in caught:
            handlers[came](came, frame)


@contextmanager
def calls_uninterrupted() -> Generator[None]:
    """Keep signals from interrupting system calls of this thread until the block has ended."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows interrupts none
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def restart_reads(*numbers: int, restart: bool | None = None) -> None:
    """Let reads go on after signals that Python handles, where OpenSees cannot be kept from them.

    `restart` switches that for all signals from now on; `numbers` were given a handler anew.
    """
    if restart is not None:
        _READS["restart"] = restart
        numbers = tuple(n for n in signal.valid_signals() if callable(signal.getsignal(n)))
    if sys.platform != "win32" and (_READS["restart"] or restart is not None):
        for number in numbers:
            signal.siginterrupt(number, not _READS["restart"])
