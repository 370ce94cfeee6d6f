"""A process that runs what may crash or hang, and is replaced when it does.

OpenSeesPy has one model a process, and a wrong call can end the process: runs that are there to
find out go through `Worker`.
"""

from __future__ import annotations

import multiprocessing as mp
import os
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from multiprocessing.connection import Connection
    from types import TracebackType

LIMIT = 60.0
"""Seconds after which a run counts as hanging."""


def serve(connection: Connection) -> None:
    """Run what is sent, and send back what it returns, until None is sent."""
    silence = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):  # OpenSees reports every failed iteration
        os.dup2(silence, stream)
    while (task := connection.recv()) is not None:
        function, arguments = task
        connection.send(function(**arguments))


class Worker:
    """Runs functions in a process of its own, under a limit of time.

    Parameters
    ----------
    limit : float
        Seconds after which a run is ended.
    """

    def __init__(self, limit: float = LIMIT) -> None:
        self.limit = limit
        self._start()

    def __enter__(self) -> Worker:
        """Return the worker."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the process."""
        self._end()

    def run(self, function: Callable[..., Any], **arguments: Any) -> tuple[str, Any]:
        """Run a function of a module."""
        self.connection.send((function, arguments))
        if not self.connection.poll(self.limit):
            self._end()
            self._start()
            return "hang", None
        try:
            return "ok", self.connection.recv()
        except EOFError:
            self.process.join()
            code = self.process.exitcode
            self._start()
            return f"crash ({code})", None

    def _start(self) -> None:
        context = mp.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=serve, args=(theirs,), daemon=True)
        sys.stdout.flush()
        self.process.start()
        theirs.close()

    def _end(self) -> None:
        self.process.terminate()
        self.process.join()
        self.connection.close()
