"""The one decorator for compiled kernels: typed, no fastmath, cached under the sources' hash.

Kernels allocate nothing, so they count no references to their arrays either (`_nrt=False`): whoever
calls them holds these. The counting, atomic, took half of a step of the time loop.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

import numba
from numba.core import config, event, sigutils
from numba.core.ccallback import CFunc

from lir_element._compile.cache import KernelCache, Sources, cache_folder
from lir_element._compile.progress import Progress

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., object]")

OWN = Sources(Path(__file__).parents[1])
"""Sources of the kernels of this package."""


WITH_PARTS = numba.__version__.startswith("0.68.")
"""True if this version of numba is supported: else kernels take twice as long to compile."""

if WITH_PARTS:
    from lir_element._compile.linking import KernelDispatcher, rebuilt_part


class KernelDecorator(Protocol):
    """A decorator that keeps the signature of the compiled function."""

    def __call__(self, function: F) -> F:
        """Return the compiled `function`."""
        ...


def kernels_of(sources: Sources, inline: bool = False, counts: bool = False) -> KernelDecorator:
    """Make a decorator that compiles the kernels of some packages."""

    def decorate(function: F) -> F:
        if config.DISABLE_JIT:
            return function
        options = {
            "error_model": "numpy",
            "nogil": True,
            "forceinline": inline,
            "_nrt": counts,
            "no_cfunc_wrapper": True,
        }  # Python calls by the other wrapper
        if WITH_PARTS:
            options |= {"nopython": True, "boundscheck": None}  # as `njit` has it
            compiled: Any = KernelDispatcher(function, targetoptions=options)
            compiled._cache = KernelCache(function, sources, rebuilt_part)
        else:
            compiled = numba.njit(**options)(function)
            compiled._cache = KernelCache(function, sources)
        return cast("F", compiled)

    return decorate


def entry_point(signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Make a decorator that compiles a function with the calling convention of C."""
    types = sigutils.normalize_signature(signature)

    def decorate(function: Callable[..., Any]) -> Any:
        compiled: Any = CFunc(function, types, locals={}, options={"error_model": "numpy"})
        compiled._cache = KernelCache(function, OWN)
        compiled.compile()
        return compiled

    return decorate


kernel = kernels_of(OWN)
"""The kernel decorator of this package."""

with_refcounts = kernels_of(OWN, counts=True)
"""The same for kernels that make arrays of addresses (see `kernels_of`)."""

inlined_by_llvm = kernels_of(OWN, inline=True)
"""The same for kernels that become part of their callers (see `kernels_of`)."""

inlined_before_typing: KernelDecorator = numba.njit(inline="always")
"""For kernels inlined in one other, or used as an expression: inserted before typing.

They are not compiled by themselves: a chain of `inlined_by_llvm` ones is optimised and made machine
code at each of its links, with all its callees. They may return values that compiled functions
cannot: a bundle of records.
"""


def _ours(dispatcher: Any) -> bool:
    return isinstance(getattr(dispatcher, "_cache", None), KernelCache)


def _where() -> str:
    folder = cache_folder()
    return f"they are kept in {folder}" if folder else "they are not kept: no home folder"


event.register("numba:compile", Progress(_ours, _where))
