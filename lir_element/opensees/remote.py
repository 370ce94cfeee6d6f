"""The portable route: bearings in a process of their own, behind `genericClient` elements."""

from __future__ import annotations

import os
import subprocess  # noqa: S404  # our own server, by our own interpreter
import sys
import threading
from multiprocessing import Pipe, reduction
from typing import TYPE_CHECKING, Any

from lir_element.opensees.guard import Guard
from lir_element.opensees.protocol import vector_length

if TYPE_CHECKING:
    import socket

    from lir_element.bearing import LIRBearing
    from lir_element.opensees.placement import Placement


class ServerError(RuntimeError):
    """The process that determines the states of bearings is gone."""


class Remote:
    """A bearing whose state the server determines.

    Parameters
    ----------
    server : Server
        The process.
    tag : int
        Of the element.
    bearing : LIRBearing
        The device.
    level : str
        Level of fidelity.
    placement : Placement
        How the model's degrees of freedom lead to its axes.
    """

    route = "portable"

    def __init__(
        self, server: Server, tag: int, bearing: LIRBearing, level: str, placement: Placement
    ) -> None:
        self._server = server
        self._key = server.new_key()
        self._words = vector_length(placement.dofs)
        self._sock: socket.socket | None = None
        self.device = bearing
        self.level = level
        self.placement = placement
        self._records: tuple[Any, ...] | None = None
        self._recording = False
        server.ask("prepare", self._key, tag, bearing, level, placement)

    def connect(self, sock: socket.socket) -> None:
        """Hand the host element's connection over, and guard it."""
        self._server.guard.add(sock, self._words)
        self._sock = sock
        self._server.ask("connect", self._key, sock=sock)

    @property
    def alive(self) -> bool:
        """Whether OpenSees still has the element, as far as can be told."""
        return not self._server.alive or bool(self._server.ask("is_open", self._key))

    def response(self, name: str) -> Any:
        """Return a response of the committed state by name."""
        return self._server.ask("response", self._key, name)

    def start_recording(self, every: int) -> None:
        """Record every so many commits from now on; 0: none."""
        self._server.ask("record", self._key, every)
        self._recording = every > 0

    def recorded(self) -> tuple[Any, ...]:
        """Return what `Hosted.recorded` does."""
        if self._records is not None:  # the element is gone, its records were kept
            return self._records
        return tuple(self._server.ask("recorded", self._key))

    def release(self) -> None:
        """Give up the connection, once the element is gone."""
        self.detach()
        if self._server.alive:
            if self._recording:
                self._records = self.recorded()
            self._server.ask("forget", self._key)

    def detach(self) -> None:
        """Guard the connection no more, and close it."""
        if self._sock is not None:
            self._server.guard.drop(self._sock)
            self._sock.close()
            self._sock = None


class Server:
    """The process that serves all bearings of this one in the portable route."""

    def __init__(self) -> None:
        ours, theirs = Pipe()
        command = [sys.executable, "-m", "lir_element.opensees.server", str(theirs.fileno()),
                   str(os.getpid())]  # fmt: skip
        options: dict[str, Any] = {"pass_fds": [theirs.fileno()]}
        if sys.platform == "win32":
            os.set_handle_inheritable(theirs.fileno(), True)
            handles = subprocess.STARTUPINFO(lpAttributeList={"handle_list": [theirs.fileno()]})
            options = {"startupinfo": handles}
        paths = [path or os.getcwd() for path in sys.path]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
        self._process = subprocess.Popen(  # noqa: S603
            command, stdin=subprocess.DEVNULL, env=environment, **options
        )
        theirs.close()
        self._pipe = ours
        self._lock = threading.Lock()
        self._keys = 0
        self.guard = Guard(ours, f"WARNING {self._end()}; the analysis cannot go on.\n")

    @property
    def pid(self) -> int:
        """Process id of the server."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether the process is there."""
        return self._process.poll() is None

    def new_key(self) -> int:
        """Return a number by which a bearing will be known."""
        self._keys += 1
        return self._keys

    def ask(self, what: str, key: int, *arguments: Any, sock: socket.socket | None = None) -> Any:
        """Send a request and return the answer.

        Parameters
        ----------
        what : str
            The request.
        key : int
            The bearing's number.
        *arguments
            What belongs to it.
        sock : socket, optional
            A connection to hand over.

        Returns
        -------
        object
            The answer.

        Raises
        ------
        ServerError
            If the server is gone.
        """
        try:
            with self._lock:
                self._pipe.send((what, key, *arguments))
                if sock is not None:
                    self._hand_over(sock)
                good, answer = self._pipe.recv()
        except (EOFError, ConnectionError) as cause:
            self._process.wait()
            raise ServerError(self._end()) from cause
        if not good:
            raise answer
        return answer

    def close(self) -> None:
        """End the process."""
        self.guard.stop()
        self._pipe.close()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _end(self) -> str:
        return (
            f"the server process {self.pid} of the bearings has ended: their states are lost, "
            "wipe the model and build it again"
        )

    def _hand_over(self, sock: socket.socket) -> None:
        if sys.platform == "win32":
            self._pipe.send_bytes(sock.share(self.pid))
        else:
            reduction.send_handle(self._pipe, sock.fileno(), self.pid)
