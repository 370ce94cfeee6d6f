"""Bundles and arrays by their parts: compiled kernels give what the same Python gives."""

from __future__ import annotations

import copy
import os
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from numba.core import inline_closurecall
from numba.core.ir import Inst
from numba.core.registry import cpu_target

from lir_element._compile.cache import Sources
from lir_element._compile.jit import WITH_PARTS, inlined_before_typing, kernels_of
from lir_element.kernels import linear

pytestmark = pytest.mark.skipif(
    not WITH_PARTS or os.environ.get("NUMBA_DISABLE_JIT", "0") != "0", reason="nothing is compiled"
)
RECORD = np.dtype(
    [("size", float), ("place", float, 3), ("turn", float, (2, 3)), ("count", np.int64)], align=True
)


class Inner(NamedTuple):
    """A bundle in a bundle."""

    scale: float
    table: Any


class Outer(NamedTuple):
    """A bundle of what bundles hold."""

    x: Any
    a: Any
    state: Any
    inner: Inner
    number: int


def reads(b: Outer, i: int) -> float:
    """Numbers, rows and shapes, from the front and from behind."""
    row = b.a[i]
    total = row[-1] + b.a[-1, 0] + b.a[i, i] + b.x[-2] + b.x[np.uint8(1)]
    rows, columns = b.a.shape
    for k in range(b.inner.table.shape[1]):
        total = total * 0.5 + b.inner.scale * b.inner.table[1, k][-1] * b.inner.table[0][k, 0]
    return total + rows * 10.0 + columns + b.number + len(row) + row.size + b.inner.table[1].size


def writes(b: Outer, i: int) -> float:
    """Numbers in arrays and records; an array in a record is a view."""
    row = b.a[1]
    row[-1] = 7.25
    b.a[i, 0] += 1.5
    b.x[i] = b.number
    b.inner.table[-1, 0, i] = -3.0
    record = b.state[i]
    record.size = 2.5 * row[0]
    record.count += 3
    place = record.place
    place[-1] = record.turn[1, -1] + record.turn[0][1]
    record.turn[1][0] = place[2] * record.count
    b.state[0].turn[0, 1] = b.state[-1].place[i]
    return b.a[i, 0] + b.x[i]


def renamed(b: Outer, i: int) -> float:
    """Bundles and arrays under other names, the same and changed ones."""
    other = b
    again = other
    if i > 0:
        again = Outer(other.a[i], other.a, other.state, Inner(3.0, other.inner.table), 5)
    values = again.x
    for k in range(again.number):
        if k == 2:
            values = again.a[0]
        values[k % 2] += again.inner.scale * k
    return values[0] + 10.0 * again.x[1] + again.inner.scale


def changed(b: Outer, i: int) -> float:
    """An argument that is another later on."""
    total = 0.0
    for k in range(3):
        total += b.x[k] * i
        b = Outer(b.a[k % 2], b.a, b.state, Inner(b.inner.scale + 1.0, b.inner.table), k)
        i = i + k
    return total + b.inner.scale + b.number + i


def views(b: Outer, i: int) -> float:
    """Arrays that are not contiguous, slices and columns."""
    column = b.a[:, i]
    part = b.x[1:]
    turned = b.a.T
    column[0] = part[-1] + turned[1, 0]
    part[:] = column[-1]
    return column[1] + part[0] + turned[-1, -1] + b.x[2]


def bundle() -> Outer:
    state = np.zeros(3, dtype=RECORD)
    state["place"] = np.arange(9.0).reshape(3, 3)
    state["turn"] = 0.1 * np.arange(18.0).reshape(3, 2, 3)
    state["count"] = [4, 5, 6]
    table = np.linspace(-1.0, 1.0, 12).reshape(2, 2, 3)
    powers, squares = np.array([1.0, 2.0, 4.0, 8.0]), np.arange(6.0).reshape(2, 3) ** 1.5
    return Outer(powers, squares, state, Inner(0.3, table), 4)


@pytest.mark.parametrize("i", [0, 1])
@pytest.mark.parametrize("inlined", [False, True])
@pytest.mark.parametrize("function", [reads, writes, renamed, changed, views])
def test_a_kernel_gives_what_its_python_gives(function, inlined, i, tmp_path, monkeypatch):
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path))
    sources = Sources(tmp_path)
    part = kernels_of(sources, inline=inlined)(function)

    def call(b: Outer, i: int, strided: Any) -> float:
        strided[-1] = part(b, i)
        return strided[1] + strided[-1]

    data, given = bundle(), np.zeros(6)[::2]
    python, taken = bundle(), np.zeros(6)[::2]
    by_name = python._replace(state=python.state.view(np.recarray))  # as compiled code reads fields
    found = kernels_of(sources)(call)(data, i, given)
    taken[-1] = function(by_name, i)
    assert found == taken[-1]
    assert given.tolist() == taken.tolist()
    assert data.inner.table.tobytes() == python.inner.table.tobytes()
    for ours, theirs in zip(data[:3], python[:3], strict=True):
        assert ours.tobytes() == theirs.tobytes()


def sums(x: Any) -> float:
    """A loop of unknown length."""
    total = 0.0
    for k in range(x.shape[0]):
        total += x[k]
    return total


@pytest.mark.parametrize("module", [linear.__name__, __name__])
def test_loops_are_unrolled_where_they_are_long(module: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(sums, "__module__", module)
    compiled: Any = kernels_of(Sources(tmp_path))(sums)
    assert compiled(np.arange(99.0)) == 99 * 49.0
    (code,) = compiled.inspect_llvm().values()
    assert (code.count("fadd") > 1) == (module != __name__)


@inlined_before_typing
def stretched(b: Outer, by: float) -> Inner:
    """A bundle from a kernel that is put into others."""
    total = 0.0
    for k in range(b.x.shape[0]):
        total += by * b.x[k]
    return Inner(total, b.inner.table)


def twice_stretched(b: Outer, i: int) -> float:
    """One kernel put twice into another, under names of its own each time."""
    total = stretched(b, 2.0).scale
    if i > 0:
        total -= stretched(b, 0.5 * total).scale
    return total


@pytest.mark.parametrize("i", [0, 1])
def test_numba_is_left_as_it_was(i: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path))
    x = bundle().x.sum()
    before = (cpu_target.typing_context.resolve_function_type, Inst._rec_list_vars)
    found = kernels_of(Sources(tmp_path))(twice_stretched)(bundle(), i)
    assert found == pytest.approx(2.0 * x if i == 0 else 2.0 * x - x * x, rel=1e-14)

    def unknown(b: Outer) -> float:
        return b.x.no_such_thing

    with pytest.raises(numba.TypingError, match="no_such_thing"):
        kernels_of(Sources(tmp_path))(unknown)(bundle())
    assert (cpu_target.typing_context.resolve_function_type, Inst._rec_list_vars) == before
    assert inline_closurecall.copy is copy
    assert "mangler" not in vars(cpu_target.target_context)
