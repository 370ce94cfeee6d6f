"""Adding the host element, an OpenSees `genericClient`, and taking hold of its connection.

The element connects to a port on loopback as soon as it is added. The port is open for that moment
only, and only the connection that this very process made is accepted.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from lir_element.opensees.block.layout import vector_length

if TYPE_CHECKING:
    from collections.abc import Generator

    from lir_element.opensees.placement import BearingTransform

_LOOPBACK = "127.0.0.1"
_BACKLOG = 16
_WAIT = 5.0
"""Longest wait for a connection [s]; it exists as soon as the element is added."""


def add_host_element(ops: Any, tag: int, placement: BearingTransform) -> socket.socket:
    """Add a `genericClient` to the current model and return our end of its connection."""
    dofs = [*range(1, placement.dofs // 2 + 1)]
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as listener:
        listener.bind((_LOOPBACK, 0))
        listener.listen(_BACKLOG)
        listener.settimeout(_WAIT)
        port = listener.getsockname()[1]
        with calls_uninterrupted():  # OpenSees gives up a connection that a signal interrupts
            ops.element(
                "genericClient",
                tag,
                "-node",
                *placement.nodes,
                "-dof",
                *dofs,
                "-dof",
                *dofs,
                "-server",
                port,
                _LOOPBACK,
                "-dataSize",
                vector_length(placement.dofs),
                "-noRayleigh",
            )
        try:
            return _accept_own(listener, port, tag)
        except BaseException:
            ops.remove("element", tag)  # before the port closes: its farewell must find an end
            raise


def own_connections() -> list[Any]:
    """Return this process's TCP connections, as psutil does, that have another end."""
    try:
        import psutil
    except ImportError as cause:
        msg = (
            "psutil is not installed, but the connection to OpenSees needs it: pip install "
            '"lir-dcfp[opensees]"'
        )
        raise ImportError(msg) from cause
    return [each for each in psutil.Process(os.getpid()).net_connections("tcp4") if each.raddr]


def _accept_own(listener: socket.socket, port: int, tag: int) -> socket.socket:
    # Accept the connection of this process; all others are closed.
    own = {each.laddr.port for each in own_connections() if each.raddr.port == port}
    while own:
        try:
            connection, (address, peer) = listener.accept()
        except TimeoutError:
            break
        if address == _LOOPBACK and peer in own:
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            connection.setblocking(True)
            return connection
        connection.close()
    msg = (
        f"bearing element {tag}: the connection of its host element did not arrive at "
        f"{_LOOPBACK}:{port}; allow connections on the loopback interface"
    )
    raise ConnectionError(msg)


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
    """Restart reads after signals that Python handles, if OpenSees cannot be kept from them.

    `restart` switches that for all signals from now on; `numbers` got new handlers.
    """
    if restart is not None:
        _READS["restart"] = restart
        numbers = tuple(n for n in signal.valid_signals() if callable(signal.getsignal(n)))
    if sys.platform != "win32" and (_READS["restart"] or restart is not None):
        for number in numbers:
            signal.siginterrupt(number, not _READS["restart"])
