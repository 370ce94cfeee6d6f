"""Faster front end of numba for kernels: repeated work is done once.

numba searches the type of ``x + y`` for two floats in all its sums, thousands of times; a kernel
inlined into another one copies all its variables along with each of its blocks. The results are the
same. This depends on numba's inside: it is imported only with a supported version (`jit.py`), and
its changes are undone once a kernel is compiled.
"""

from __future__ import annotations

import copy
import gc
from contextlib import contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from numba.core import errors, inline_closurecall, ir, postproc, transforms, types
from numba.core.compiler_machinery import PassManager
from numba.core.compiler_machinery import _pass_registry as pass_registry

if TYPE_CHECKING:
    from collections.abc import Generator

_signatures: dict[tuple[Any, ...], Any] = {}
_kind_of_function: Any = types.BaseFunction
_errors: Any = errors
_signature_of = _kind_of_function.get_call_type


@contextmanager
def faster_typing() -> Generator[None]:
    """Shorten the front end's ways; whoever compiles holds numba's lock."""
    if _kind_of_function.get_call_type is _remembered:  # by the kernel compiled around this one
        yield
        return
    usual_lists, usual_processing = ir.Inst._rec_list_vars, postproc.PostProcessor.run
    _kind_of_function.get_call_type = _remembered
    postproc.PostProcessor.run = _processed
    inline_closurecall.copy = SimpleNamespace(deepcopy=_copied, copy=copy.copy)
    ir.Inst._rec_list_vars = _variables
    try:
        yield
    finally:
        _kind_of_function.get_call_type = _signature_of
        postproc.PostProcessor.run = usual_processing
        inline_closurecall.copy = copy
        ir.Inst._rec_list_vars = usual_lists


def _remembered(func: Any, context: Any, args: Any, kws: Any) -> Any:
    # The signature of a function of numba's own for some types, which does not change.
    if kws:
        return _signature_of(func, context, args, kws)
    key = (func, tuple(args))
    found = _signatures.get(key)
    if found is None:
        found = _signature_of(func, context, args, kws)
        if found is not None:
            _signatures[key] = found
    return found


class ShortPasses(PassManager):  # type: ignore[misc]  # numba has no types
    """Steps of the compiler, without a record of each that spells out all arguments."""

    def _runPass(self, index: int, step: Any, state: Any) -> None:  # noqa: N802 (its name there)
        step.analysis = self._analysis
        with _errors.new_error_context("Pass {name}", name=step.name()):
            step.run_pass(state)
        if pass_registry.get(type(step)).mutates_CFG:
            postproc.PostProcessor(state.func_ir).run()


def _processed(self: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    # Blocks in order, and lifetimes on request: no kernel is a generator.
    self.func_ir.blocks = transforms.canonicalize_cfg(self.func_ir.blocks)
    self.func_ir.variable_lifetime = postproc.VariableLifetime(self.func_ir.blocks)
    self.func_ir.generator_info = None
    if emit_dels:
        self._insert_var_dels(extend_lifetimes=extend_lifetimes)


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
def gc_paused() -> Generator[None]:
    """Pause Python's garbage collection over data that are still needed."""
    looks = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if looks:
            gc.enable()
