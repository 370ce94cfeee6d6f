"""From typed kernels to LLVM: bundles and arrays by their parts, so that little is to be undone.

numba passes structures as wholes: to read one array of a bundle it loads all of the bundle, to read
a number of an array it writes the array down first. LLVM spends most of its time on undoing that.
Here a bundle or array is the list of its parts until it is needed in one piece, and a number of an
array is read and written in place. The results are the same, in the same order. This depends on
numba's inside: it is imported only with a supported version (`jit.py`).
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from llvmlite import ir as llvm
from numba.core import ir, types
from numba.core.analysis import compute_cfg_from_blocks
from numba.core.cgutils import alloca_once, get_record_member
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.funcdesc import default_mangler
from numba.core.lowering import Lower
from numba.core.typed_passes import (
    InlineOverloads,
    IRLegalization,
    NativeLowering,
    NopythonRewrites,
)
from numba.core.types.containers import BaseNamedTuple, BaseTuple
from numba.core.types.misc import unliteral
from numba.core.untyped_passes import FindLiterallyCalls, InlineClosureLikes, WithLifting
from numba.np.arrayobj import fix_integer_index, load_item, store_item

from lir_element._compile.front_end import ShortPasses

if TYPE_CHECKING:
    from collections.abc import Sequence

_MEMINFO, _PARENT, _COUNT, _ITEM_SIZE, _DATA, _SHAPE, _STRIDES = range(7)  # parts of an array


_LONG_LOOPS = {
    "contact",
    "coupling",
    "hinges",
    "laws",
    "linear",
    "nonlinear_works",
    "part_states",
    "shared_tangent",
    "yielding",
}
"""Modules and packages of products and factors of matrices, and of parts that yield: most of their
time is in loops."""

_BIT = partial(llvm.Constant, llvm.IntType(1))


class Parts:
    """A structure in parts: no code of its own until it is needed in one piece.

    Parameters
    ----------
    kind : llvmlite.ir.Type
        Type of the structure.
    parts : sequence
        Values, in order; None if there is none yet.
    """

    def __init__(self, kind: Any, parts: Sequence[Any]) -> None:
        self.type = kind
        self.parts = tuple(parts)

    def whole(self, builder: Any) -> Any:
        """Return it in one piece, built at the place of `builder`."""
        value = llvm.Constant(self.type, llvm.Undefined)
        for place, part in enumerate(self.parts):
            if part is not None:
                value = llvm.IRBuilder.insert_value(builder, value, _whole(builder, part), place)
        return value


def _whole(builder: Any, value: Any) -> Any:
    return value.whole(builder) if isinstance(value, Parts) else value


class PartsBuilder(llvm.IRBuilder):  # type: ignore[misc]  # llvmlite has no types
    """A builder that takes structures apart and puts them together without code."""

    def extract_value(self, agg: Any, idx: Any, name: str = "") -> Any:
        """Return a part of a structure."""
        first, *rest = idx if isinstance(idx, tuple | list) else (idx,)
        if not isinstance(agg, Parts):
            return super().extract_value(agg, idx, name)
        part = agg.parts[first]
        if part is None:
            part = llvm.Constant(agg.type.elements[first], llvm.Undefined)
        return self.extract_value(part, rest) if rest else part

    def insert_value(self, agg: Any, value: Any, idx: Any, name: str = "") -> Any:
        """Return a structure with one part changed."""
        first, *rest = idx if isinstance(idx, tuple | list) else (idx,)
        empty = isinstance(agg, llvm.Constant) and agg.constant is llvm.Undefined
        if rest or not (empty or isinstance(agg, Parts)):
            return super().insert_value(_whole(self, agg), _whole(self, value), idx, name)
        if value.type != agg.type.elements[first]:
            msg = f"part {first} of {agg.type} cannot be {value.type}"
            raise TypeError(msg)
        parts = [None] * len(agg.type.elements) if empty else list(agg.parts)
        parts[first] = value
        return Parts(agg.type, parts)

    def store(self, value: Any, ptr: Any, align: Any = None) -> Any:
        """Write a value down, structures in one piece."""
        return super().store(_whole(self, value), ptr, align)

    def ret(self, value: Any) -> Any:
        """Return a value, structures in one piece."""
        return super().ret(_whole(self, value))

    def call(self, fn: Any, args: Any, *others: Any, **named: Any) -> Any:
        """Call a function, structures in one piece."""
        return super().call(fn, [_whole(self, arg) for arg in args], *others, **named)

    def select(self, cond: Any, lhs: Any, rhs: Any, *others: Any, **named: Any) -> Any:
        """Choose a value, structures in one piece."""
        return super().select(cond, _whole(self, lhs), _whole(self, rhs), *others, **named)


class KernelLower(Lower):  # type: ignore[misc]  # numba has no types
    """Makes code of a typed kernel."""

    def init(self) -> None:
        """Find the variables that only ever stand for an argument."""
        super().init()
        values: dict[str, list[Any]] = defaultdict(list)
        for block in self.blocks.values():
            for assign in block.find_insts(ir.Assign):
                values[assign.target.name].append(assign.value)
        self._once = {name: found[0] for name, found in values.items() if len(found) == 1}
        self._arguments: dict[str, int | None] = {}
        self._plain = not self.flags.nrt and not self._disable_sroa_like_opt
        short = _LONG_LOOPS.isdisjoint(self.func_ir.func_id.modname.split("."))
        self._ends = _ends_of_loops(self.blocks) if short else set()

    def _argument(self, name: str) -> int | None:
        # The argument that is a bundle, under any of its names; None if it is another.
        if name not in self._arguments:
            self._arguments[name] = None  # should names go round in a circle
            value = self._once.get(name)
            if isinstance(value, ir.Arg) and self.typeof(f"arg.{value.name}") == self.typeof(name):
                self._arguments[name] = value.index
            elif isinstance(value, ir.Var) and self.typeof(value.name) == self.typeof(name):
                self._arguments[name] = self._argument(value.name)
        return self._arguments[name]

    def _stands(self, name: str) -> Any:
        # The argument that a variable is; None if it is a variable of its own.
        if not self._plain:
            return None
        place = self._argument(name)
        return None if place is None else self.fnargs[place]

    def setup_function(self, fndesc: Any) -> None:
        """Begin the function."""
        self.function = self.context.declare_function(self.module, fndesc)
        self.entry_block = self.function.append_basic_block("entry")
        self.builder = PartsBuilder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)

    def lower_inst(self, inst: Any) -> None:
        """Make code of a statement."""
        if isinstance(inst, ir.Assign) and self._stands(inst.target.name) is not None:
            return
        if isinstance(inst, ir.SetItem | ir.StaticSetItem):
            index = inst.index if isinstance(inst, ir.SetItem) else inst.index_var
            if index is not None and self._indexed(inst.target.name, index.name, full=True):
                self._write(inst.target.name, index.name, inst.value.name)
                return
        super().lower_inst(inst)
        if id(inst) in self._ends:
            self.builder.block.terminator.set_metadata("llvm.loop", self._kept_small())

    def _kept_small(self) -> Any:
        # Metadata against unrolling a loop of unknown length, and against vectors.
        no = [("llvm.loop.unroll.runtime.disable",), ("llvm.loop.vectorize.enable", False)]
        wishes = [
            self.module.add_metadata([llvm.MetaDataString(self.module, name), *map(_BIT, value)])
            for name, *value in no
        ]
        loop = llvm.MDValue(self.module, wishes, name=str(len(self.module.metadata)))
        loop.operands = (loop, *loop.operands)  # by which it is another than all others
        return loop

    def loadvar(self, name: str) -> Any:
        """Return the value of a variable."""
        argument = self._stands(name)
        return super().loadvar(name) if argument is None else argument

    def storevar(self, value: Any, name: str, argidx: Any = None) -> None:
        """Give a variable its value."""
        if not self._plain or name in self._singly_assigned_vars:
            super().storevar(value, name, argidx)
            return
        self._alloca_var(name, self.typeof(name))
        self.builder.store(value, self.getvar(name))  # its old value needs no reference count

    def delvar(self, name: str) -> None:
        """Drop a variable: it has no reference count and no further reader."""
        if not self._plain:
            super().delvar(name)

    def alloca_lltype(self, name: str, lltype: Any, datamodel: Any = None) -> Any:
        """Make room for a variable."""
        return alloca_once(self.builder, lltype, name=name, zfill=False)

    def _alloca_var(self, name: str, fetype: Any) -> None:
        if self._stands(name) is None:
            super()._alloca_var(name, fetype)

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """Make code of an expression."""
        if expr.op in {"getitem", "static_getitem"} and self._plain:
            index = expr.index if expr.op == "getitem" else expr.index_var
            if index is not None and self._indexed(expr.value.name, index.name, full=False):
                return self._read(resty, expr.value.name, index.name)
        if expr.op == "getattr" and self._plain:
            kind = self.typeof(expr.value.name)
            if isinstance(kind, BaseNamedTuple) and expr.attr in kind.fields:
                found = self._field(expr.value.name, kind.fields.index(expr.attr))
                return self.context.cast(
                    self.builder, found, kind[kind.fields.index(expr.attr)], resty
                )
            if isinstance(kind, types.Record) and isinstance(
                kind.typeof(expr.attr), types.NestedArray
            ):
                return self._nested(kind, expr)
            if isinstance(kind, types.Array) and expr.attr == "shape":
                return self.builder.extract_value(self.loadvar(expr.value.name), 5)
        return super().lower_expr(resty, expr)

    def _nested(self, kind: Any, expr: Any) -> Any:
        # An array in a record: its place; its shape is known.
        nested, context = kind.typeof(expr.attr), self.context
        data = get_record_member(
            self.builder,
            self.loadvar(expr.value.name),
            kind.offset(expr.attr),
            context.get_data_type(nested.dtype),
        )
        whole = context.get_value_type(nested)
        nothing = [llvm.Constant(whole.elements[k], None) for k in (0, 1)]

        def numbers(values: Any) -> list[Any]:
            return [context.get_constant(types.intp, value) for value in values]

        return Parts(
            whole,
            [
                *nothing,
                *numbers((nested.nitems, nested.size)),
                data,
                Parts(whole.elements[5], numbers(nested.shape)),
                Parts(whole.elements[6], numbers(nested.strides)),
            ],
        )

    def _field(self, name: str, place: int) -> Any:
        # A part of a bundle: of one in memory, it alone is loaded.
        if self._stands(name) is not None or name in self._blk_local_varmap:
            return self.builder.extract_value(self.loadvar(name), place)
        zero, at = (llvm.Constant(llvm.IntType(32), n) for n in (0, place))
        return self.builder.load(self.builder.gep(self.getvar(name), [zero, at], inbounds=True))

    def _indexed(self, name: str, index: str, *, full: bool) -> bool:
        # True if an array is read or written at whole numbers: all of them, if it is one number.
        kind = self.typeof(name)
        if not self._plain or not isinstance(kind, types.Array) or kind.layout != "C":
            return False
        by = self.typeof(index)
        kinds = tuple(by) if isinstance(by, BaseTuple) else (by,)
        known = all(isinstance(each, types.Integer) for each in kinds)
        count = len(kinds)
        within = count == kind.ndim if full else 0 < count <= kind.ndim
        return known and within and not self.context.enable_boundscheck

    def _place(self, name: str, index: str) -> tuple[Any, Any, list[Any]]:
        # Place of an element, or of the first one of a view; remaining shapes.
        builder, kind, by = self.builder, self.typeof(name), self.typeof(index)
        array, given = self.loadvar(name), self.loadvar(index)
        several = isinstance(by, BaseTuple)
        kinds = tuple(by) if several else (by,)
        shape = [
            builder.extract_value(builder.extract_value(array, 5), k) for k in range(kind.ndim)
        ]
        at = None
        for k, each in enumerate(kinds):
            value = builder.extract_value(given, k) if several else given
            plain = unliteral(each)
            value = self.context.cast(builder, value, each, plain)
            if isinstance(value, llvm.Constant) and value.constant >= 0:
                value = self.context.get_constant(types.intp, value.constant)
            else:
                value = fix_integer_index(self.context, builder, plain, value, shape[k])
            at = value if at is None else builder.add(builder.mul(at, shape[k]), value)
        rest = shape[len(kinds) :]
        for size in rest:
            at = builder.mul(at, size)
        data = builder.extract_value(array, 4)
        return array, builder.gep(data, [at]), rest

    def _read(self, resty: Any, name: str, index: str) -> Any:
        builder, kind = self.builder, self.typeof(name)
        array, place, shape = self._place(name, index)
        if not shape:
            return self.context.cast(
                builder, load_item(self.context, builder, kind, place), kind.dtype, resty
            )
        count = shape[0]
        for size in shape[1:]:
            count = builder.mul(count, size, flags=["nsw"])
        steps = builder.extract_value(array, 6)
        kept = range(kind.ndim - len(shape), kind.ndim)
        steps = [builder.extract_value(steps, k) for k in kept]
        whole = self.context.get_value_type(resty)
        sizes = Parts(whole.elements[5], shape)
        meminfo, parent, itemsize = (builder.extract_value(array, k) for k in (0, 1, 3))
        return Parts(
            whole,
            [meminfo, parent, count, itemsize, place, sizes, Parts(whole.elements[6], steps)],
        )

    def _write(self, name: str, index: str, value: str) -> None:
        kind = self.typeof(name)
        _, place, _ = self._place(name, index)
        given = self.context.cast(self.builder, self.loadvar(value), self.typeof(value), kind.dtype)
        store_item(self.context, self.builder, kind, given, place)


def _ends_of_loops(blocks: dict[int, Any]) -> set[int]:
    # The jumps, by their identity, that go back to the beginning of a loop.
    return {
        id(blocks[label].terminator)
        for header, loop in compute_cfg_from_blocks(blocks).loops().items()
        for label in loop.body
        if isinstance(blocks[label].terminator, ir.Jump)
        and blocks[label].terminator.target == header
    }


def _short(name: str, argtypes: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
    # The name of a kernel in LLVM: numba's has all fields of its bundles in it, 20 000 letters.
    kinds = hashlib.sha256("".join(map(_shown, argtypes)).encode()).hexdigest()[:24]
    return str(default_mangler(f"{name}.{kinds}", (), abi_tags=abi_tags, uid=uid))


@cache
def _shown(kind: Any) -> str:
    return f"{kind!r};"


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):  # type: ignore[misc]  # numba has no types
    """The step of the compiler that makes code of a typed kernel."""

    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> Any:
        """Class that makes the code."""
        return KernelLower

    def run_pass(self, state: Any) -> bool:
        """Make the code, under short names."""
        context = state.targetctx
        context.mangler = _short
        try:
            return bool(super().run_pass(state))
        finally:
            del context.mangler


_NEEDLESS = (
    FindLiterallyCalls,
    InlineClosureLikes,
    InlineOverloads,
    NopythonRewrites,
    WithLifting,
)
"""Steps for closures, expressions of arrays, overloads and contexts, which kernels do not have."""


class KernelPipeline(CompilerBase):  # type: ignore[misc]  # numba has no types
    """The steps of the compiler for kernels."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's steps without the needless ones, with the last one of this module."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        needless = _NEEDLESS if self.state.flags.nrt else (*_NEEDLESS, IRLegalization)
        short = ShortPasses(manager.pipeline_name)
        short.passes = [
            (KernelLowering if step is NativeLowering else step, why)
            for step, why in manager.passes
            if step not in needless
        ]
        short.finalize()
        return [short]
