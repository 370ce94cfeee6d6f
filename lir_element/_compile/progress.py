"""Message while kernels compile: the first run compiles for ten seconds to a minute.

Written once to the standard error: a line that names the work and, on a terminal, a bar. Nothing is
written if the kernels come from the cache, or with LIR_QUIET=1.
"""

from __future__ import annotations

import os
import sys
import time
from typing import TYPE_CHECKING, Any

from numba.core import event

if TYPE_CHECKING:
    from collections.abc import Callable

PATIENCE = 1.0
"""Seconds of compiling before the message: a kernel or two need none."""

_WIDTH = 78
_BAR = 24


def quiet() -> bool:
    """Return True if LIR_QUIET is set."""
    return os.environ.get("LIR_QUIET", "") not in {"", "0"}


def say(text: str) -> None:
    """Write a line to the standard error, unless LIR_QUIET is set."""
    _write(f"lir-dcfp: {text}\n")


def _write(text: str) -> bool:
    # True if it was written: a program may have closed its standard error, or have none.
    if quiet() or sys.stderr is None:
        return False
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except (OSError, ValueError):
        return False
    return True


def on_terminal() -> bool:
    """Return whether the standard error is a terminal."""
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except ValueError:  # closed
        return False


class Progress(event.Listener):  # type: ignore[misc]  # numba has no types
    """Listener to the compiler, which compiles a kernel inside its caller.

    Parameters
    ----------
    ours : callable
        Returns True if a numba dispatcher belongs to this program.
    where : callable
        Returns the destination of the kernels, in words.
    clock : callable
        Seconds, from any origin.
    """

    def __init__(
        self,
        ours: Callable[[Any], bool],
        where: Callable[[], str],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._ours = ours
        self._where = where
        self._clock = clock
        self._open: list[str] = []
        self._began = 0.0
        self._spent = 0.0
        self._done = 0
        self._most = 0
        self._told = False
        self._drawn = False

    def on_start(self, event: Any) -> None:
        """Register a kernel whose compilation begins."""
        if not self._ours(event.data["dispatcher"]):
            return
        if not self._open:
            self._began = self._clock()
            self._most = self._done + self._below(event.data["dispatcher"])
        self._open.append(event.data["dispatcher"].__name__)
        self._show()

    def on_end(self, event: Any) -> None:
        """Register a kernel that is compiled, or failed to compile."""
        if not self._ours(event.data["dispatcher"]):
            return
        self._open.pop()
        self._done += 1
        if self._open:
            self._show()
            return
        self._spent += self._clock() - self._began
        if self._drawn:  # the next output starts on an empty line
            self._drawn = not _write(f"\r{'':{_WIDTH}}\r")

    def _below(self, top: Any) -> int:
        # Number of kernels in one, by the names in its code: it may need fewer.
        found, left = {id(top): top}, [top]
        while left:
            function = left.pop().py_func
            called = (function.__globals__.get(name) for name in function.__code__.co_names)
            new = {id(each): each for each in called if hasattr(each, "py_func")}
            left += [each for key, each in new.items() if key not in found]
            found |= new
        return sum(map(self._ours, found.values()))

    def _show(self) -> None:
        seconds = self._spent + self._clock() - self._began
        if seconds < PATIENCE:
            return
        if not self._told:
            long = "ten seconds to a minute"
            say(f"compiling kernels for the first use, {long}; {self._where()}")
            self._told = True
        if on_terminal():
            bar = "#" * (_BAR * self._done // max(self._most, 1))
            of = f"{self._done} of at most {self._most} kernels, {seconds:.0f} s"
            line = f"  [{bar:{_BAR}}] {of}: {self._open[-1]}"
            self._drawn = _write(f"\r{line[:_WIDTH]:{_WIDTH}}")
