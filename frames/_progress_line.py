"""Progress line of an analysis on the standard error: terminal, notebook, log file."""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter

from lir_element._compile.progress import on_terminal

_EVERY = 0.5, 30.0
"""Time between two lines if one replaces the other, and elsewhere [s]."""

_WIDTH = 78
_MARKS = 20
"""Places of the bar."""


def replaces_lines() -> bool:
    """Return whether a line on the standard error can be written over: a terminal, a notebook."""
    return on_terminal() or type(sys.stderr).__module__.startswith("ipykernel.")


class ProgressLine:
    """Writes how far something is, now and then; the last line stays."""

    def __init__(self) -> None:
        self._told = 0.0
        self.is_open = False
        """True if an unfinished line was written."""

    def write(self, text: str, elapsed: float, *, ends: bool) -> None:
        """Write a text, if it ends or enough time has passed since the last one."""
        over = replaces_lines()
        if sys.stderr is None or not (ends or elapsed - self._told >= _EVERY[0 if over else 1]):
            return
        self._told, self.is_open = elapsed, not ends
        line = f"\r{text:{_WIDTH}}" if over else text
        sys.stderr.write(line + ("\n" if ends or not over else ""))
        sys.stderr.flush()


class _Share(ProgressLine):
    # A bar of the share that is done; each run from zero to one is one line.

    def __init__(self) -> None:
        super().__init__()
        self._before, self._began = 0.0, perf_counter()

    def __call__(self, share: float) -> None:
        if share <= self._before:  # another run begins, of level="auto"
            self._began, self._told = perf_counter(), 0.0
        self._before = share
        elapsed = perf_counter() - self._began
        bar = "#" * round(_MARKS * share)
        left = elapsed * (1.0 / share - 1.0) if share > 0.0 else 0.0
        text = f"[{bar:{_MARKS}}] {100.0 * share:.0f} % of the steps, {left:.0f} s left"
        if share >= 1.0:
            text = f"[{bar}] {elapsed:.1f} s"
        self.write(text, elapsed, ends=share >= 1.0)


def share_told(progress: object) -> Callable[[float], None] | None:
    """Return the listener to the share of a time history that is done."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _Share()
    if not callable(progress):
        msg = f"progress = {progress!r} must be True, or a function of the share done (0 to 1)"
        raise TypeError(msg)
    return progress
