"""Memory and functions by their address, for compiled code that OpenSees calls.

Addresses are passed as int64, never compiled in: a compiled callback can be kept in the cache and
used by another process, in which all addresses differ.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

_WORD = ir.IntType(64)
_INT = ir.IntType(32)
_DOUBLE = ir.DoubleType()


@intrinsic
def pointer(_context: Any, _address: Any) -> Any:
    """Return an address as a pointer for `numba.carray`."""

    def code(_target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), code


@intrinsic
def word_at(_context: Any, _address: Any) -> Any:
    """Return the int64 at an address."""

    def code(_target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.load(builder.inttoptr(args[0], _WORD.as_pointer()))

    return types.int64(types.int64), code


@intrinsic
def byte_at(_context: Any, _address: Any) -> Any:
    """Return the byte at an address, 0 to 255."""

    def code(_target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        byte = builder.load(builder.inttoptr(args[0], ir.IntType(8).as_pointer()))
        return builder.zext(byte, _WORD)

    return types.int64(types.int64), code


@intrinsic
def number_at(_context: Any, _address: Any) -> Any:
    """Return the float64 at an address."""

    def code(_target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.load(builder.inttoptr(args[0], _DOUBLE.as_pointer()))

    return types.float64(types.int64), code


@intrinsic
def set_word(_context: Any, _address: Any, _value: Any) -> Any:
    """Set the int64 at an address."""

    def code(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        builder.store(args[1], builder.inttoptr(args[0], _WORD.as_pointer()))
        return context.get_dummy_value()

    return types.void(types.int64, types.int64), code


def _caller(result: Any, result_type: Any, arguments: tuple[tuple[Any, Any], ...]) -> Any:
    # A code generator that calls a C function of this signature by its address.
    def code(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(result_type, [each for _, each in arguments])
        function = builder.inttoptr(args[0], kind.as_pointer())
        value = builder.call(function, list(args[1:]))
        return context.get_dummy_value() if result is types.void else value

    return result(types.int64, *(each for each, _ in arguments)), code


@intrinsic
def call_word(_context: Any, _function: Any, _a: Any) -> Any:
    """Call ``int64 f(int64)``."""
    return _caller(types.int64, _WORD, ((types.int64, _WORD),))


@intrinsic
def call_number(_context: Any, _function: Any, _a: Any) -> Any:
    """Call ``double f(int64)``."""
    return _caller(types.float64, _DOUBLE, ((types.int64, _WORD),))


@intrinsic
def call_void(_context: Any, _function: Any, _a: Any) -> Any:
    """Call ``void f(int64)``."""
    return _caller(types.void, ir.VoidType(), ((types.int64, _WORD),))


@intrinsic
def call_2(_context: Any, _function: Any, _a: Any, _b: Any) -> Any:
    """Call ``int64 f(int64, int64)``."""
    return _caller(types.int64, _WORD, ((types.int64, _WORD),) * 2)


@intrinsic
def call_write(_context: Any, _function: Any, _file: Any, _data: Any, _count: Any) -> Any:
    """Call ``int64 f(int32, int64, int64)``."""
    words = (types.int64, _WORD)
    return _caller(types.int64, _WORD, ((types.int32, _INT), words, words))


@intrinsic
def call_int(_context: Any, _function: Any, _a: Any, _b: Any) -> Any:
    """Call ``int32 f(int64, int64)``."""
    return _caller(types.int32, _INT, ((types.int64, _WORD),) * 2)


@intrinsic
def call_constructor(_context: Any, _function: Any, _a: Any, _b: Any, _c: Any, _d: Any) -> Any:
    """Call ``void f(int64, int64, int32, int64)``."""
    words = (types.int64, _WORD)
    return _caller(types.void, ir.VoidType(), (words, words, (types.int32, _INT), words))


@intrinsic
def call_response(_context: Any, _function: Any, _a: Any, _b: Any, _c: Any, _d: Any) -> Any:
    """Call ``int64 f(int64, int64, int32, int64)``."""
    words = (types.int64, _WORD)
    return _caller(types.int64, _WORD, (words, words, (types.int32, _INT), words))


@intrinsic
def call_with_int(_context: Any, _function: Any, _a: Any, _b: Any, _c: Any) -> Any:
    """Call ``int32 f(int64, int32, int64)``."""
    words = (types.int64, _WORD)
    return _caller(types.int32, _INT, (words, (types.int32, _INT), words))


@intrinsic
def call_poll(_context: Any, _function: Any, _data: Any, _count: Any, _wait: Any) -> Any:
    """Call ``int32 f(int64, int64, int32)``."""
    words = (types.int64, _WORD)
    return _caller(types.int32, _INT, (words, words, (types.int32, _INT)))


@intrinsic
def call_transfer(
    _context: Any, _function: Any, _file: Any, _data: Any, _size: Any, _flags: Any
) -> Any:
    """Call ``int64 f(int32, int64, int64, int32)``."""
    words, number = (types.int64, _WORD), (types.int32, _INT)
    return _caller(types.int64, _WORD, (number, words, words, number))


@intrinsic
def call_print(_context: Any, _function: Any, _a: Any, _b: Any, _c: Any) -> Any:
    """Call ``void f(int64, int64, int32)``."""
    words = (types.int64, _WORD)
    return _caller(types.void, ir.VoidType(), (words, words, (types.int32, _INT)))
