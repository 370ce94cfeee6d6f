"""Threads of the dense algebra: only the caller's if matrices are small.

Threads of OpenBLAS wait for more work by spinning, some 20 ms after each product, on processors
that other runs could use.
"""

from __future__ import annotations

import threading
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING

import scipy.linalg  # noqa: F401  # brings a BLAS of its own, besides numpy's
from threadpoolctl import ThreadpoolController

if TYPE_CHECKING:
    from collections.abc import Generator

    from frames.model.frame_data import FrameData

_SMALL = 3000  # displacements and rotations of nodes, below which threads do not pay
_TAKEN = threading.Lock()


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController().select(user_api="blas")


@contextmanager
def blas_threads_for(*models: FrameData) -> Generator[None, None, None]:
    """Keep the dense algebra of small models on one thread.

    The setting is that of the whole process: the first of several simultaneous users makes and
    undoes it.
    """
    is_large = any(6 * len(model.nodes) >= _SMALL for model in models)
    if is_large or not _TAKEN.acquire(blocking=False):
        yield
        return
    try:
        with _controller().limit(limits=1):
            yield
    finally:
        _TAKEN.release()
