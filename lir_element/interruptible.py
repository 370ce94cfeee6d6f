"""Compiled loops as Python calls them: compiled first, then in pieces that Ctrl-C can part."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any

import numba
import numpy as np

from lir_element.errors import RunStatus

if TYPE_CHECKING:
    from collections.abc import Callable

PIECE = 0.03
"""Target length of a piece [s]: a call costs some 0.1 ms."""

FIRST_WORK = 50
"""Work of the first piece; its unit is the loop's own, for example one trial step."""

MARKS = 50
"""Number of progress reports."""


def interruptible(
    advance: Callable[[int, int], int],
    done: Callable[[], int],
    total: int,
    progress: Callable[[float], None] | None = None,
    room: Callable[[], int] | None = None,
) -> RunStatus:
    """Run a compiled loop to its end in pieces of about `PIECE` seconds."""
    stride = total if progress is None else max(1, -(-total // MARKS))
    work = FIRST_WORK
    try:
        while done() < total:
            last = min(total, (done() // stride + 1) * stride)
            until = last if room is None else min(last, room())
            began = perf_counter()
            code = advance(until, work)
            if code != int(RunStatus.OK):
                return RunStatus(code)
            if done() < until:  # the work was spent
                share = PIECE / max(perf_counter() - began, 1e-6)
                work = max(1, int(work * min(max(share, 0.1), 8.0)))
            elif progress is not None and until == last:
                progress(done() / total)
    except KeyboardInterrupt:
        return RunStatus.INTERRUPTED
    return RunStatus.OK


def ready(kernel: Callable[..., Any], *arguments: Any) -> float:
    """Compile a kernel without calling it, so that a timing contains the computation alone."""
    began = perf_counter()
    compile_for = getattr(kernel, "compile", None)  # a plain function if nothing is compiled
    kinds = kernel, *(_kind(value) for value in arguments)
    if compile_for is not None and kinds not in _READY:
        compile_for(tuple(numba.typeof(value) for value in arguments))
        _READY.add(kinds)
    return perf_counter() - began


_OWNED = 4  # flag of an array that owns its memory, which is not part of its type

_READY: set[tuple[Any, ...]] = set()  # kernels and kinds of arguments they are compiled for


def _kind(value: Any) -> Any:
    # Key of an argument's type, found faster than the type: arrays alone and in bundles, numbers,
    # None.
    if isinstance(value, tuple):
        return type(value), *(_kind(part) for part in value)
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim, value.flags.num & ~_OWNED
    return type(value)
