"""Guard that ends the wait of a model for a server that was killed.

While OpenSees waits for an answer, no Python code can run in its process, and the wait has no
limit. A thread of compiled code therefore watches the server, from the same process. If the server
is gone, the thread answers in its place, with numbers that no convergence test accepts (NaN), so
that the analysis fails as any other.
"""

from __future__ import annotations

import ctypes
import os
import socket
import sys
import threading
from typing import TYPE_CHECKING

import numpy as np

from lir_element.opensees.block.layout import GUARD, MOST_CHANNELS
from lir_element.opensees.block.responses import HINTED

if TYPE_CHECKING:
    from multiprocessing.connection import Connection


class Guard:
    """A thread that watches a server.

    Parameters
    ----------
    pipe : Connection or None
        Socket to the server; its end is the server's end. None: there is no server from the
        beginning, and every connection is added before `start`.
    message : str
        Message to the user if the server ends, or requests an element that does not exist.
    """

    def __init__(self, pipe: Connection | None, message: str) -> None:
        from lir_element.opensees.kernels import guard as guard_kernel

        self._text = np.frombuffer(message.encode(), dtype=np.uint8).copy()
        self._reader, self._writer = os.pipe()
        self._block = np.zeros(1, dtype=GUARD)
        self._block["channels"][0, :, 0] = -1
        self._block["answer"].view(np.int64)[:] = -1  # not a number, from any byte on
        self._block["hinted"] = HINTED.ctypes.data
        self._block["pipe"] = -1 if pipe is None else pipe.fileno()
        self._block["stop"] = self._reader
        self._block["message"] = self._text.ctypes.data
        self._block["message_size"] = len(self._text)
        self._block["receive_flags"] = getattr(socket, "MSG_DONTWAIT", 0)
        self._block["send_flags"] = getattr(socket, "MSG_DONTWAIT", 0) | getattr(
            socket, "MSG_NOSIGNAL", 0
        )
        self._thread: threading.Thread | None = None
        if sys.platform == "win32":  # it has no such functions: a killed server is not replaced
            return
        system = ctypes.CDLL(None)
        for name in ("poll", "recv", "send", "write"):
            self._block[name] = ctypes.cast(getattr(system, name), ctypes.c_void_p).value
        address = int(self._block.ctypes.data)
        self._thread = threading.Thread(
            target=guard_kernel.watch.ctypes, args=(address,), name="bearing guard", daemon=True
        )

    def start(self) -> None:
        """Start watching."""
        if self._thread is not None:
            self._thread.start()

    def add(self, sock: socket.socket, words: int) -> None:
        """Guard a host element's connection, whose answers have so many words."""
        free = np.flatnonzero(self._block["channels"][0, :, 0] == -1)
        if not len(free):
            msg = (
                f"the out-of-process coupling serves at most {MOST_CHANNELS} bearings: "
                'use fewer, or route="fast"'
            )
            raise ValueError(msg)
        self._block["channels"][0, free[0]] = sock.fileno(), words

    def drop(self, sock: socket.socket) -> None:
        """Guard a connection no more."""
        channels = self._block["channels"][0]
        channels[channels[:, 0] == sock.fileno(), 0] = -1

    def stop(self) -> None:
        """End the thread."""
        if self._thread is not None:
            os.write(self._writer, b"!")
            self._thread.join()
        os.close(self._writer)
        os.close(self._reader)
