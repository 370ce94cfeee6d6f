"""The out-of-process coupling: bearings in another process, behind `genericClient` elements."""

from __future__ import annotations

import os
import pickle  # noqa: S403
import socket
import subprocess  # noqa: S404  # our own server, by our own interpreter
import sys
import threading
import warnings
from dataclasses import replace
from multiprocessing import reduction
from typing import TYPE_CHECKING, Any

from lir_element.child_process import start
from lir_element.device.friction import without_class
from lir_element.opensees.block.layout import vector_length
from lir_element.opensees.connection import own_connections, signals_held
from lir_element.opensees.out_of_process.guard import Guard

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lir_element.device.bearing import LIRBearing
    from lir_element.opensees.out_of_process.responses import HostOverrides
    from lir_element.opensees.placement import PlacedBearing


class ServerError(RuntimeError):
    """The process that determines the states of bearings is gone.

    Examples
    --------
    >>> from lir_element.opensees import ServerError
    >>> issubclass(ServerError, RuntimeError)  # so that `except RuntimeError` catches it
    True
    """


class RouteWarning(UserWarning):
    """Warning: the in-process coupling is not possible; the portable one is used, or fails, too.

    Examples
    --------
    >>> import warnings
    >>> from lir_element.opensees import RouteWarning
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", RouteWarning)  # rather fail than run out of process
    ...     # ... bearing_element(10, 1, 2, bearing)
    """


_SAME_CLOCK = 1e-3  # of a step: an explicit integrator sets its time a whole step later


def _without_classes(bearing: LIRBearing) -> LIRBearing:
    # A bearing that the server can read: it does not know the classes of laws from elsewhere.
    bottom, top = bearing.frictions
    laws = without_class(bottom), without_class(top)
    if laws == bearing.frictions:
        return bearing
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a warning came when the bearing was made
        return replace(bearing, friction=laws)


class Remote:
    """A bearing whose state the server determines."""

    route = "portable"

    def __init__(self, server: Server, placed: PlacedBearing, ops: Any) -> None:
        self.server = server
        self._ops = ops
        self._key = server.new_key()
        self._words = vector_length(placed.placement.dofs)
        self._sock: socket.socket | None = None
        self.placed = placed
        self._records: tuple[Any, ...] | None = None
        self._outcome = (0, False, 0.0)
        self._recording = False
        self._overrides: HostOverrides | None = None
        self._warned = False
        sent = placed._replace(device=_without_classes(placed.device))
        server.ask("prepare", self._key, sent)

    def connect(self, sock: socket.socket) -> None:
        """Take over the host element's connection, and guard it."""
        self.server.guard.add(sock, self._words)
        self._sock = sock
        self.server.ask("connect", self._key, sock=sock)

    def override(self, overrides: HostOverrides) -> None:
        """Keep the element's functions that differ from its host's."""
        self._overrides = overrides

    @property
    def alive(self) -> bool:
        """True if OpenSees still has the element, as far as can be seen."""
        try:
            return bool(self.server.ask("is_open", self._key))
        except ServerError:
            return self._is_connected()

    def response(self, name: str) -> Any:
        """Return a response of the committed state by name."""
        answer = self.server.ask("response", self._key, name)
        self._compare_clocks()
        return answer

    def start_recording(self, every: int) -> None:
        """Record every so many commits from now on; 0: none."""
        self.server.ask("start_recording", self._key, every)
        self._recording = every > 0

    def recorded(self) -> tuple[Any, ...]:
        """Return the records, as `ElementMemory.recorded`."""
        if self._records is not None:  # the element is gone, its records were kept
            return self._records
        answer = tuple(self.server.ask("recorded", self._key))
        self._compare_clocks()
        return answer

    def outcome(self) -> tuple[int, bool, float]:
        """Return the state of the last trial, as `ElementMemory.outcome`."""
        if self._records is None:
            self._outcome = self.server.ask("outcome", self._key)
        return self._outcome

    def release(self) -> None:
        """Close the connection, once the element is gone."""
        if self._sock is not None:
            self.server.guard.drop(self._sock)
            self._sock.close()
            self._sock = None
        if self.server.alive:
            if self._recording:
                self.outcome()
                self._records = tuple(self.server.ask("recorded", self._key))
            self.server.ask("forget", self._key)

    def detach(self) -> None:
        """Guard the connection no more, and leave it open for the farewell of OpenSees' exit.

        The element's destructor would write to a closed end for ever.
        """
        self._undo()
        if self._sock is not None:
            self.server.guard.drop(self._sock)
            self._sock.detach()
            self._sock = None

    def disconnect(self, own: dict[tuple[Any, Any], int], guard: Guard) -> socket.socket | None:
        """Cut the element of a forked process off from the connection of its parent."""
        self._undo()
        if self._sock is None:
            return None
        place = own.get((self._sock.getpeername(), self._sock.getsockname()))
        self._sock.close()
        self._sock = None
        if place is None:
            return None
        near, far = socket.socketpair()
        os.dup2(near.fileno(), place, inheritable=False)
        near.close()
        guard.add(far, self._words)
        return far

    def _compare_clocks(self) -> None:
        # The element names the committed motion (`HostOverrides`), or the last trial replaces it.
        if self._overrides is not None or self._warned:
            return
        committed, step = self.server.ask("clock", self._key)
        away = abs(self._ops.getTime() - committed)
        if _SAME_CLOCK * step < away < (1.0 - _SAME_CLOCK) * step:
            self._warned = True
            msg = (
                f"bearing element {self.placed.tag}: sliding velocities would be wrong, because "
                f"the integrator tries states at {committed:g} s but commits them {away:g} s "
                "apart. Use the integrator Newmark or TRBDF2"
            )
            warnings.warn(msg, RouteWarning, stacklevel=4)

    def _undo(self) -> None:
        if self._overrides is not None:
            self._overrides.undo()

    def _is_connected(self) -> bool:
        # Without a server nobody else reads; the end of the stream is the element's end.
        if self._sock is None:
            return False
        self._sock.setblocking(False)
        try:
            while self._sock.recv(4096):
                pass
        except BlockingIOError:
            return True
        except OSError:
            return False
        return False


class ForkedElements:
    """Elements of the out-of-process coupling that a forked process finds in its copy of the model.

    Their server is the parent's. In this process they answer nothing, so that an analysis fails
    and a wipe leaves the parent's bearings alone.

    Parameters
    ----------
    remotes : iterable of Remote
        The bearings behind them.
    """

    def __init__(self, remotes: Iterable[Remote]) -> None:
        message = (
            f"WARNING the bearings of this model belong to process {os.getppid()}, from "
            "which this one was forked: wipe the model and build it again.\n"
        )
        self._guard = Guard(None, message)
        own = {(tuple(each.laddr), tuple(each.raddr)): each.fd for each in own_connections()}
        self._kept = [remote.disconnect(own, self._guard) for remote in remotes]
        self._guard.start()

    def close(self) -> None:
        """End the guard; its sockets stay open for the farewell of OpenSees' exit."""
        self._guard.stop()
        for sock in self._kept:
            if sock is not None:
                sock.detach()


class Server:
    """The process that serves all bearings of this one in the out-of-process coupling."""

    def __init__(self) -> None:
        module = "lir_element.opensees.out_of_process.server"
        self._process, self._pipe = start(module)
        self._lock = threading.Lock()
        self._keys = 0
        self.guard = Guard(
            self._pipe, f"WARNING {self.end_message()}; the analysis cannot go on.\n"
        )
        self.guard.start()

    @property
    def pid(self) -> int:
        """Process id of the server."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """True if the process exists."""
        with signals_held():  # `poll` keeps its lock for ever if Ctrl-C comes inside
            return self._process.poll() is None

    def new_key(self) -> int:
        """Return a number by which a bearing will be known."""
        self._keys += 1
        return self._keys

    def ask(self, what: str, key: int, *arguments: Any, sock: socket.socket | None = None) -> Any:
        """Send a request and return the answer."""
        message = reduction.ForkingPickler.dumps((what, key, *arguments))
        with signals_held(), self._lock:
            try:
                self._pipe.send_bytes(message)
                if sock is not None:
                    self._hand_over(sock)
                reply = self._pipe.recv_bytes()
            except (EOFError, OSError) as cause:
                self._process.wait()
                raise ServerError(self.end_message()) from cause
            except BaseException:  # the next answer would be that to this request
                self._process.kill()
                self._process.wait()
                raise
        good, answer = pickle.loads(reply)  # noqa: S301  # of our own server
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

    def leave(self) -> None:
        """Release the parent's server in a forked process: its pipe ends with the parent."""
        self._pipe.close()

    def end_message(self) -> str:
        """Return the message to the user about a server that is gone."""
        return (
            f"the server process {self.pid} of the bearings has ended: their states are lost, "
            "wipe the model and build it again"
        )

    def _hand_over(self, sock: socket.socket) -> None:
        if sys.platform == "win32":
            self._pipe.send_bytes(sock.share(self.pid))
        else:
            reduction.send_handle(self._pipe, sock.fileno(), self.pid)
