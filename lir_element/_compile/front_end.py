"""numba's front end while it compiles kernels: what it does over and over is done once.

The type of ``x + y`` for two floats is looked for in all that numba knows of sums, thousands of
times; a kernel that is put into another one takes a copy of all its variables along with each of
its blocks. What is found is the same. This goes by numba's inside: it is imported only with a
version that is known to have it (`jit.py`), and what it changes there is as it was once a kernel is
compiled.
"""

from __future__ import annotations

import copy
import gc
from contextlib import contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from numba.core import inline_closurecall, ir, types

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

_signatures: dict[tuple[Any, ...], Any] = {}


@contextmanager
def shortened(typing: Any) -> Generator[None]:
    """Shorten the front end's ways; whoever compiles holds numba's lock."""
    if "resolve_function_type" in vars(typing):  # by the kernel that is compiled around this one
        yield
        return
    usual_lists = ir.Inst._rec_list_vars
    typing.resolve_function_type = _remembering(typing.resolve_function_type)
    inline_closurecall.copy = SimpleNamespace(deepcopy=_copied, copy=copy.copy)
    ir.Inst._rec_list_vars = _variables
    try:
        yield
    finally:
        del typing.resolve_function_type
        inline_closurecall.copy = copy
        ir.Inst._rec_list_vars = usual_lists


def _remembering(resolve: Callable[..., Any]) -> Callable[..., Any]:
    # The signature of a function of numba's own for some types, which does not change.
    def resolved(func: Any, args: Any, kws: Any) -> Any:
        if not isinstance(func, types.Function) or kws:
            return resolve(func, args, kws)
        key = (func, tuple(args))
        found = _signatures.get(key)
        if found is None:
            found = resolve(func, args, kws)
            if found is not None:
                _signatures[key] = found
        return found

    return resolved


def _copied(value: Any) -> Any:
    # A block's copy has a scope of its own, of the same variables.
    if not isinstance(value, ir.Block):
        return copy.deepcopy(value)
    old = value.scope
    scope = ir.Scope(old.parent, old.loc)
    scope.localvars._con = dict(old.localvars._con)
    scope.redefined = copy.copy(old.redefined)
    scope.var_redefinitions = copy.deepcopy(old.var_redefinitions)
    return copy.deepcopy(value, {id(old): scope})


def _variables(self: Any, value: Any) -> list[Any]:
    # All variables in a statement, in their order.
    kind = type(value)
    if kind is ir.Var:
        return [value]
    if kind is dict:
        values = value.values()
    elif kind is tuple or kind is list:
        values = value
    elif isinstance(value, ir.Inst):
        return list(value.list_vars())
    else:
        return []
    found = []
    for each in values:
        kind = type(each)
        if kind is ir.Var:
            found.append(each)
        elif kind is ir.Loc or kind is str:
            continue
        else:
            found += _variables(self, each)
    return found


@contextmanager
def without_collection() -> Generator[None]:
    """Keep Python from looking for garbage in what is still needed."""
    looks = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if looks:
            gc.enable()
