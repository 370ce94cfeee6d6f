"""The portable route: bearings in a process of their own, behind `genericClient` elements."""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
import threading
from multiprocessing import Pipe, reduction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import socket

    from lir_element.bearing import LIRBearing
    from lir_element.opensees.placement import Placement


class ServerError(RuntimeError):
    """The process that determines the states of bearings is gone."""


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
        self._process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, env=environment, **options
        )
        theirs.close()
        self._pipe = ours
        self._lock = threading.Lock()
        self._keys = 0

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
            code = self._process.wait()
            msg = (
                f"the server process {self.pid} of the bearings ended (exit code {code}): their "
                "states are lost, wipe the model and build it again"
            )
            raise ServerError(msg) from cause
        if not good:
            raise answer
        return answer

    def close(self) -> None:
        """End the process."""
        self._pipe.close()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _hand_over(self, sock: socket.socket) -> None:
        if sys.platform == "win32":
            self._pipe.send_bytes(sock.share(self.pid))
        else:
            reduction.send_handle(self._pipe, sock.fileno(), self.pid)
