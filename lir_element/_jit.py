"""The one decorator for compiled kernels: typed, no fastmath, cached under the sources' hash.

numba's own cache does not notice an edit in a *callee* of another file and would go on
running the old code. The cache folder is therefore named by a hash over all sources that can end
up in compiled code: the kernels of every package involved, and what they import.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numba
from numba.core import config

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., object]")


class KernelDecorator(Protocol):
    """A decorator that keeps the signature of what it compiles."""

    def __call__(self, function: F) -> F:
        """Return the compiled `function`."""
        ...


COMPILED = ("**/kernels/**/*.py", "_jit.py", "errors.py", "layout.py", "kernel_data.py",
            "bundles/*.py", "opensees/block/*.py", "opensees/portable/*.py")  # fmt: skip
"""Patterns of the sources, in a package, that kernels consist of or import."""


def compiled_sources(folder: Path) -> list[Path]:
    """Return the sources of the package in `folder` that compiled code depends on, sorted."""
    return sorted({path for pattern in COMPILED for path in folder.glob(pattern)})


def source_hash(*folders: Path) -> str:
    """Return a short hash over the sources of the packages in `folders` that kernels depend on."""
    digest = hashlib.sha256()
    for folder in folders:
        for path in compiled_sources(folder):
            digest.update(path.relative_to(folder).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder(*folders: Path) -> Path:
    """Return the folder that holds the compiled kernels of the packages in `folders`."""
    base = os.environ.get("LIR_CACHE_DIR") or Path.home() / ".cache" / "lir-dcfp"
    return Path(base) / source_hash(*folders)


def kernels_of(*folders: Path, inline: bool = False) -> KernelDecorator:
    """Make a decorator that compiles kernels of the packages in `folders`.

    Parameters
    ----------
    *folders : Path
        Packages whose sources the cache depends on.
    inline : bool
        Whether a kernel becomes part of those that call it: for kernels that pass bundles of many
        arrays on, whose every call would otherwise cost as much as a small kernel's work.

    Returns
    -------
    KernelDecorator
        The decorator.
    """
    target = str(cache_folder(*folders))

    def decorate(function: F) -> F:
        kept = config.CACHE_DIR
        config.CACHE_DIR = target
        try:
            compiled: F = numba.njit(
                cache=True, error_model="numpy", nogil=True, forceinline=inline
            )(function)
        finally:
            config.CACHE_DIR = kept
        return compiled

    return decorate


def entry_point(signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Make a decorator that compiles a function with the calling convention of C.

    Parameters
    ----------
    signature : str
        Types of the result and of the arguments, such as "int32(int64)".

    Returns
    -------
    callable
        The decorator; what it returns has the function's `address`. It compiles at once (or takes
        the code from the cache).
    """
    target = str(cache_folder(Path(__file__).parent))

    def decorate(function: Callable[..., Any]) -> Any:
        kept = config.CACHE_DIR
        config.CACHE_DIR = target
        try:
            return numba.cfunc(signature, cache=True, error_model="numpy")(function)
        finally:
            config.CACHE_DIR = kept

    return decorate


kernel = kernels_of(Path(__file__).parent)
