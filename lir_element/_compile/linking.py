"""Kernels as linkable code: machine code only of kernels that Python or C calls.

numba optimises each function and makes it machine code, and does so again inside of each caller.
Here a kernel with a kernel as caller stays a part: as it was lowered, with no wrapper and no
address, until one that Python or C calls includes it and is optimised as one piece. No optimisation
changes the order of sums, so that bits are the same. This depends on numba's inside: it is imported
only with a supported version (`jit.py`).
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

import llvmlite.binding as llvm
from numba.core import compiler, sigutils
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import _FunctionCompiler  # type: ignore[attr-defined]
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys
from numba.core.types.misc import unliteral

from lir_element._compile.front_end import faster_typing, gc_paused
from lir_element._compile.lowering import KernelPipeline

if TYPE_CHECKING:
    from collections.abc import Callable


LONG = 300
"""Instructions from which on LLVM may not copy a function: it takes half as long for the rest."""

MANY_ARGUMENTS = 100
"""Arguments from which on a call costs too much: arrays are handed over number by number."""


class PartLibrary(JITCodeLibrary):  # type: ignore[misc]  # numba has no types
    """The code of one kernel as it was lowered, and the libraries of its callees."""

    kept: tuple[str, bytes] | None = None
    """Name and digest of the file that it is kept in."""

    def add_ir_module(self, ir_module: Any) -> None:
        """Add code; a long function with few arguments is called rather than copied."""
        for function in ir_module.functions:
            length = sum(len(block.instructions) for block in function.blocks)
            few = len(function.args) < MANY_ARGUMENTS
            if few and length > LONG and "alwaysinline" not in function.attributes:
                function.attributes.add("noinline")
        super().add_ir_module(ir_module)

    def add_llvm_module(self, ll_module: Any) -> None:
        """Add code unchanged."""
        ll_module.data_layout = self._codegen._data_layout
        self._final_module.link_in(ll_module)

    def finalize(self) -> None:
        """Close the library: nothing is optimised, nothing made machine code."""
        self._finalize_dynamic_globals()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == llvm.Linkage.external:
                function.linkage = "linkonce_odr"  # taken in by whoever calls it, once
        self._finalized = True

    def _finalize_dynamic_globals(self) -> None:
        # Addresses of this process alone; those of kernels are named and never read.
        super()._finalize_dynamic_globals()
        names: list[str] = self._dynamic_globals  # type: ignore[has-type]
        self._dynamic_globals = [n for n in names if int(n.split(".")[3], 16) not in _kernels]

    def below(self) -> list[Any]:
        """Return the libraries that it calls."""
        return list(dict.fromkeys(self._linking_libraries))

    def reduced(self, result: Any) -> tuple[Any, ...] | None:
        """Return the part in a form that can be kept; None if something below is not kept."""
        below: list[tuple[Any, ...]] = []
        for callee in self.below():
            if isinstance(callee, PartLibrary):
                if callee.kept is None:
                    return None
                below.append(callee.kept)
            elif callee is not rtsys.library:
                below.append((callee.name, None, callee._get_module_for_linking().as_bitcode()))
        fndesc = result.fndesc
        fndesc.typemap = fndesc.calltypes = None  # as numba does: they may not be pickled
        code = self._final_module.as_bitcode()
        return self.name, code, below, fndesc, result.environment, result.signature

    def _get_module_for_linking(self) -> Any:
        module = self._final_module.clone()
        _take_in(self, module)
        return module


_kernels: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()


def _take_in(top: Any, module: Any) -> None:
    # All below a library, callers first: a function that nobody has called yet is not taken in.
    for library in _callers_first(top)[1:]:
        part = isinstance(library, PartLibrary)
        module.link_in(
            library._final_module if part else library._get_module_for_linking(), preserve=True
        )
        top._reload_init.update(library._reload_init)


def _callers_first(top: Any) -> list[Any]:
    seen: set[Any] = set()
    order: list[Any] = []

    def visit(library: Any) -> None:
        seen.add(library)
        if library is top or isinstance(library, PartLibrary):
            for callee in library._linking_libraries:
                if callee not in seen:
                    visit(callee)
        order.append(library)

    visit(top)
    return order[::-1]


class _WholeLibrary(JITCodeLibrary):  # type: ignore[misc]  # numba has no types
    """The code of a kernel that Python calls: optimised once, with all parts in place."""

    def add_llvm_module(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout
        self._final_module.link_in(ll_module)

    def finalize(self) -> None:
        """Add all parts below, each once, and make machine code of them."""
        _take_in(self, self._final_module)
        self._linking_libraries.clear()
        super().finalize()

    def _optimize_final_module(self) -> None:
        # Once: numba's first round finds pairs of counted references, of which kernels have none.
        passes, builder = self._codegen._module_pass_manager()
        passes.run(self._final_module, builder)

    def _finalize_specific(self) -> None:
        # LLVM's loop strength reduction takes a third of the time, and gives no speed.
        llvm.set_option("", "-disable-lsr=1")
        try:
            super()._finalize_specific()
        finally:
            llvm.set_option("", "-disable-lsr=0")


class _Flags(compiler.Flags):  # type: ignore[misc]  # numba has no types
    """Flags that are compared as fast as the dictionaries they are: typing does so all the time."""

    __slots__ = ()

    def __hash__(self) -> int:
        return _FLAGS

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Flags) and self._values == other._values


_FLAGS = hash("flags of kernels")


class _Address:
    """Substitute for the address of a part, which has none."""


class _KernelCompiler(_FunctionCompiler):  # type: ignore[misc]  # numba has no types
    """Compiles one kernel: whole, or as a part."""

    as_part = False

    def _compile_core(self, args: Any, return_type: Any) -> Any:
        flags = _Flags()
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags = self._customize_flags(flags)
        context = self.targetdescr.target_context
        kind = PartLibrary if self.as_part else _WholeLibrary
        library = kind(context.codegen(), self.py_func.__qualname__)
        if self.as_part:
            flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        else:
            library.enable_object_caching()
        result = compiler.compile_extra(
            self.targetdescr.typing_context,
            context,
            self._get_implementation(args, {}),
            args=args,
            return_type=return_type,
            flags=flags,
            locals=self.locals,
            library=library,
            pipeline_class=self.pipeline_class,
        )
        if self.as_part:
            library.finalize()
            result = result._replace(entry_point=_Address())
            context.insert_user_function(result.entry_point, result.fndesc, [library])
        else:
            for environment in result._find_referenced_environments():
                library.codegen.set_env(environment.env_name, environment)
        return result


class KernelDispatcher(CPUDispatcher):  # type: ignore[misc]  # numba has no types
    """A kernel: whole if Python calls it, a part if kernels do."""

    _asked_by_kernel = False

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        _kernels[id(self)] = self
        usual: Any = self._compiler  # type: ignore[has-type]
        self._compiler = _KernelCompiler(
            usual.py_func,
            usual.targetdescr,
            usual.targetoptions,
            usual.locals,
            KernelPipeline,
        )

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return the signature for a kernel that calls this one; its constants are numbers."""
        _, args = self._compiler.fold_argument_types(args, kws)
        self._asked_by_kernel = True  # compiling holds a lock
        try:
            return super().get_call_template(tuple(unliteral(a) for a in args), {})
        finally:
            self._asked_by_kernel = False

    def compile(self, sig: Any) -> Any:
        """Compile for a signature, unless that was done."""
        with global_compiler_lock:
            as_part, self._asked_by_kernel = self._asked_by_kernel, False
            arguments = tuple(sigutils.normalize_signature(sig)[0])
            existing = self.overloads.get(arguments)
            if not as_part and existing and isinstance(existing.library, PartLibrary):
                del self.overloads[arguments]  # Python calls it as well
            before = self._compiler.as_part
            self._compiler.as_part = self._cache.as_part = as_part
            try:
                with gc_paused(), faster_typing():
                    return super().compile(sig)
            finally:
                self._compiler.as_part = self._cache.as_part = before

    def add_overload(self, cres: Any) -> None:
        """Register a compilation; Python sees it only if it is whole."""
        if isinstance(cres.library, PartLibrary):
            self.overloads[tuple(cres.signature.args)] = cres
        else:
            super().add_overload(cres)


def rebuilt_part(
    context: Any, reduced: tuple[Any, ...], part_of: Callable[[str, bytes], Any]
) -> Any:
    """Return a part from its kept content."""
    name, code, below, fndesc, environment, signature = reduced
    library = _library(context, name, code)
    for known_by, digest, *rest in below:
        if digest is None:
            callee = _library(context, known_by, *rest)
        else:
            part = part_of(known_by, digest)
            if part is None:
                return None
            callee = part.library
        library.add_linking_library(callee)
    library.add_linking_library(rtsys.library)
    return compiler.compile_result(
        typing_context=context.typing_context,
        target_context=context,
        library=library,
        environment=environment,
        entry_point=_Address(),
        fndesc=fndesc,
        type_annotation="",
        signature=signature,
        objectmode=False,
        lifted=(),
        reload_init=[],
        referenced_envs=[],
    )


def _library(context: Any, name: str, code: bytes) -> PartLibrary:
    library = PartLibrary(context.codegen(), name)
    library._final_module = llvm.parse_bitcode(code)
    library.finalize()
    return library
