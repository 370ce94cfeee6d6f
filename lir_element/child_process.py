"""Processes of this interpreter that serve this one, each through a private pipe."""

from __future__ import annotations

import os
import subprocess  # noqa: S404  # our own modules, by our own interpreter
import sys
from multiprocessing import Pipe, connection
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from multiprocessing.connection import Connection


def start(module: str, *, silent: bool = False) -> tuple[subprocess.Popen[bytes], Connection]:
    """Start a module as a process, and return it with this end of its pipe; Ctrl-C spares it."""
    ours, theirs = Pipe()
    command = [sys.executable, "-P", "-m", module, str(theirs.fileno()), str(os.getpid())]
    # in a session of its own: Ctrl-C in a terminal goes to all processes of this one's
    options: dict[str, Any] = {"pass_fds": [theirs.fileno()], "start_new_session": True}
    if sys.platform == "win32":
        os.set_handle_inheritable(theirs.fileno(), True)
        handles = subprocess.STARTUPINFO(lpAttributeList={"handle_list": [theirs.fileno()]})
        group = subprocess.CREATE_NEW_PROCESS_GROUP
        options = {"startupinfo": handles, "creationflags": group}
    if silent:
        options |= {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(  # noqa: S603
        command, stdin=subprocess.DEVNULL, env=child_environment(), **options
    )
    theirs.close()
    return process, ours


def pipe_of(handle: int) -> Any:
    """Return the child's end of the pipe, by the first argument that it was started with."""
    if sys.platform == "win32":
        return connection.PipeConnection(handle)
    return connection.Connection(handle)


def child_environment() -> dict[str, str]:
    """Return the environment in which a child process finds the modules that this one finds."""
    # Last, so that no file in it hides a module of others; in place if it has these packages.
    here, own = os.getcwd(), str(Path(__file__).parents[1])
    paths = [path for path in sys.path if path and (path != here or here == own)]
    paths += [here] if len(paths) < len(sys.path) else []
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
