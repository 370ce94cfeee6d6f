"""The process that determines the states of bearings in the out-of-process coupling.

    python -m lir_element.opensees.out_of_process.server HANDLE PARENT

is started by `remote.Server`. It communicates with the model's process through a private pipe (the
handle), which passes it the connections of the host elements; it opens no port. It ends with the
pipe, or with its parent.
"""

from __future__ import annotations

import collections
import os
import selectors
import socket
import sys
import threading
import time
from multiprocessing import reduction
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.child_process import pipe_of
from lir_element.errors import RunStatus
from lir_element.opensees.block import layout
from lir_element.opensees.element_memory import ElementMemory

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from lir_element.opensees.placement import PlacedBearing

_QUICK = getattr(socket, "TCP_QUICKACK", None)  # Linux: without it small messages wait some 40 ms
_NO_FORCE = np.full(layout.MOST_DOFS * layout.MOST_DOFS, -1).view(np.float64)
"""Answer for a failure, which the protocol lacks; no test accepts it, from any byte on."""
_GRACE = 1e-3
"""Longest delay of a message in another stream after a request [s]."""
_AWAKE = 2e-3
"""Time to look for the next message without sleeping [s]: waking up costs more than answering, and
an analysis sends its next request at once.
"""
_PATIENCE = 2.0
"""Time between two looks at whether the parent is still there [s]."""


class Channel:
    """A host element's connection, and the bearing that answers it."""

    def __init__(self, sock: socket.socket, hosted: ElementMemory) -> None:
        self.sock = sock
        self.hosted = hosted
        count = hosted.placed.placement.dofs
        size = layout.vector_length(count)
        self._inbox = np.zeros(size)
        self._view = memoryview(self._inbox.view(np.uint8).data)
        self._motion = self._inbox[1 : 1 + count], self._inbox[1 + count : 1 + 2 * count]
        self._time = 1 + 3 * count
        self._zeros = bytes(8 * size)
        self._out = np.zeros(size)
        self._status = RunStatus.OK
        self.is_open = True
        if not self._read(layout.HEADER_BYTES):
            return
        header = self._inbox.view(np.int32)[: layout.HEADER_WORDS]
        if (header[0], header[-1]) != (count, size):
            msg = (
                f"host element of {header[0]} DOFs and {header[-1]} words: {count}, {size} expected"
            )
            raise ValueError(msg)

    def close(self) -> None:
        """Close the connection."""
        self.is_open = False
        self.sock.close()

    def serve(self) -> bool:
        """Read one message and answer it; False when the element is gone."""
        if not self._read(self._inbox.nbytes):
            return False
        action = int(self._inbox[0])
        if action == layout.SET_TRIAL:
            self._trial()
        elif action == layout.COMMIT:
            self.hosted.commit()
        elif action == layout.GET_FORCE:
            good = self._status is RunStatus.OK
            self._send(self.hosted.force if good else _NO_FORCE[: len(self._out)])
        elif action == layout.GET_TANGENT:
            self._send(self.hosted.tangent_by_columns())
        elif action == layout.GET_INITIAL:
            self._send(self.hosted.initial)
        elif action in layout.ANSWERED:  # damping and mass: none
            self.sock.sendall(self._zeros)
        elif action != layout.END:
            msg = f"{self._inbox[0]:g} is no action of a host element: its messages are out of step"
            raise ValueError(msg)
        return action != layout.END

    def _trial(self) -> None:
        hosted = self.hosted
        clock = float(self._inbox[self._time])
        if not clock and not self._inbox[1 : self._time].any():
            hosted.restart()  # `reset` has no message: no motion at all, at time 0
        # no message reports that the model's clock was set back: to zero, as by `loadConst`
        before = hosted.committed_time if clock >= hosted.committed_time else 0.0
        self._status = hosted.trial(*self._motion, clock - before, clock)
        text = hosted.told()
        if text:
            print(text, end="", file=sys.stderr, flush=True)

    def _send(self, values: np.ndarray) -> None:
        self._out[: len(values)] = values
        self.sock.sendall(self._out.data)

    def _read(self, count: int) -> bool:
        got = 0
        while got < count:
            try:
                received = self.sock.recv_into(self._view[got:count])
            except ConnectionError:
                return False
            if received == 0:
                return False
            got += received
            if _QUICK is not None:
                self.sock.setsockopt(socket.IPPROTO_TCP, _QUICK, 1)
        return True


class Service:
    """All bearings of one model's process, at the other end of the pipe."""

    def __init__(self, pipe: Connection, parent: int) -> None:
        self._pipe = pipe
        self._parent = parent
        self._hosted: dict[int, ElementMemory] = {}
        self._channels: dict[int, Channel] = {}
        self._requests: collections.deque[tuple[Any, ...]] = collections.deque()
        self._selector = selectors.DefaultSelector()
        self._wake, self._bell = socket.socketpair()
        self._selector.register(self._wake, selectors.EVENT_READ, None)

    def run(self) -> None:
        """Serve until the pipe is closed."""
        threading.Thread(target=self._listen_to_pipe, daemon=True).start()
        asked, busy_until = False, 0.0
        while os.getppid() == self._parent:
            busy = time.perf_counter() < busy_until
            ready = self._selector.select(_GRACE if asked else 0.0 if busy else _PATIENCE)
            if ready:
                busy_until = time.perf_counter() + _AWAKE
            for key, _ in ready:
                channel = key.data
                if channel is None:
                    self._wake.recv(4096)
                    asked = True
                elif not channel.serve():
                    self._selector.unregister(channel.sock)
                    channel.close()
            # messages of the model sent before a request come first, though they may arrive later
            if ready or not asked:
                continue
            asked = False
            while self._requests:
                request = self._requests.popleft()
                if request[0] == "end":
                    return
                self._answer(*request)

    def _listen_to_pipe(self) -> None:
        # Requests, and the connections that come with some of them.
        try:
            while True:
                request = self._pipe.recv()
                if request[0] == "connect":
                    request = (*request, _receive_socket(self._pipe))
                self._requests.append(request)
                self._bell.send(b"!")
        except (EOFError, ConnectionError, OSError):
            self._requests.append(("end",))
            self._bell.send(b"!")

    def _answer(self, what: str, key: int, *arguments: Any) -> None:
        own = getattr(self, f"_do_{what}", None)
        try:
            if own is None:
                result = getattr(self._hosted[key], what)(*arguments)
            else:
                result = own(key, *arguments)
        except (KeyError, ValueError, ArithmeticError, MemoryError) as error:
            self._pipe.send((False, error))
        else:
            self._pipe.send((True, result))

    def _do_prepare(self, key: int, placed: PlacedBearing) -> None:
        self._hosted[key] = ElementMemory(placed)

    def _do_connect(self, key: int, sock: socket.socket) -> None:
        channel = Channel(sock, self._hosted[key])
        self._channels[key] = channel
        self._selector.register(sock, selectors.EVENT_READ, channel)

    def _do_is_open(self, key: int) -> bool:
        return key in self._channels and self._channels[key].is_open

    def _do_clock(self, key: int) -> tuple[float, float]:
        block = self._hosted[key].block
        return float(block["committed_time"][0]), float(block["step"][0])

    def _do_forget(self, key: int) -> None:
        self._channels.pop(key, None)
        del self._hosted[key]


def _receive_socket(pipe: Connection) -> socket.socket:
    if sys.platform == "win32":
        return socket.fromshare(pipe.recv_bytes())
    return socket.socket(fileno=reduction.recv_handle(pipe))


def main(arguments: list[str]) -> None:
    """Serve the process that started this one."""
    handle, parent = (int(each) for each in arguments)
    Service(pipe_of(handle), parent).run()


if __name__ == "__main__":
    main(sys.argv[1:])
