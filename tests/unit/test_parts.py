"""Kernels that kernels call: kept as parts, made machine code only where Python calls them."""

import math
import os
from pathlib import Path
from typing import Any

import numba
import pytest

import lir_element
from lir_element._compile import cache
from lir_element._compile.jit import WITH_PARTS, kernels_of
from tests.patience import fresh

COMPILES = pytest.mark.skipif(
    os.environ.get("NUMBA_DISABLE_JIT", "0") != "0", reason="nothing is compiled"
)
PARTS = pytest.mark.skipif(
    not WITH_PARTS or os.environ.get("NUMBA_DISABLE_JIT", "0") != "0", reason="there are no parts"
)
ROOT = Path(lir_element.__file__).parents[1]
SOURCE = """
import math

@kernel
def law(x, power):
    return math.exp(-x) * x ** power

@kernel
def twice(x):
    return law(x, 2) + law(x, 3)

@kernel
def other(x):
    return twice(x) - law(x, 2)

@kernel
def last(x):
    return other(x) + twice(x)
"""
X = 0.7
TWICE = math.exp(-X) * (X**2 + X**3)
LAST = math.exp(-X) * X**3 + TWICE
NAMES = ("law", "twice", "other", "last")


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """What a new process finds: a function that returns the kernels, and an empty cache."""
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path / "cache"))
    folder = tmp_path / "package" / "kernels"
    folder.mkdir(parents=True)
    path = folder / "law.py"
    path.write_text(SOURCE, encoding="utf-8")

    def start() -> dict[str, Any]:
        monkeypatch.setattr(cache, "_parts", {})
        sources = cache.Sources(folder.parent)
        names: dict[str, Any] = {"kernel": kernels_of(sources), "__name__": "package"}
        exec(compile(SOURCE, str(path), "exec"), names)  # noqa: S102
        return names

    return start


def compiled(kernel: Any) -> int:
    return sum(kernel.stats.cache_misses.values())


def files(tmp_path: Path, name: str) -> list[Path]:
    return sorted((tmp_path / "cache").rglob(f"package.{name}-*"))


@PARTS
def test_a_part_becomes_whole_when_python_calls_it(kernels: Any, tmp_path: Path) -> None:
    names = kernels()
    law = names["law"]
    assert names["twice"](X) == pytest.approx(TWICE, rel=1e-15)
    assert compiled(law) == 1  # constants are numbers: 2 and 3 are one signature
    [part] = law.overloads.values()
    assert not part.library._object_caching_enabled  # there is no object
    assert law(X, 2) == pytest.approx(math.exp(-X) * X**2, rel=1e-15)
    assert compiled(law) == 2
    assert len(files(tmp_path, "law")) == 2
    assert names["last"](X) == pytest.approx(LAST, rel=1e-15)


@PARTS
def test_a_later_process_takes_parts_from_the_cache(kernels: Any, tmp_path: Path) -> None:
    kernels()["other"](X)
    names = kernels()
    taken = set(cache.taken)
    assert names["last"](X) == pytest.approx(LAST, rel=1e-15)
    assert [compiled(names[name]) for name in NAMES] == [0, 0, 1, 1]
    assert cache.taken == taken  # what a wheel packs is what Python calls
    names = kernels()
    assert names["last"](X) == pytest.approx(LAST, rel=1e-15)
    assert [compiled(names[name]) for name in NAMES] == [0, 0, 0, 0]
    assert cache.taken - taken == {path for path in files(tmp_path, "last") if path in cache.taken}


@PARTS
def test_a_part_is_left_whose_callee_another_process_has_replaced(kernels, tmp_path):
    kernels()["other"](X)
    [law] = files(tmp_path, "law")
    before = law.read_bytes()
    law.unlink()
    kernels()["law"].get_call_template((numba.typeof(X), numba.typeof(2)), {})
    assert law.read_bytes() != before  # names in the code are those of a process
    names = kernels()
    assert names["last"](X) == pytest.approx(LAST, rel=1e-15)
    assert [compiled(names[name]) for name in NAMES] == [0, 1, 1, 1]


@PARTS
def test_a_long_function_is_called_and_a_short_or_forced_one_is_copied() -> None:
    from llvmlite import ir
    from numba.core.registry import cpu_target

    from lir_element._compile.linking import LONG, MANY_ARGUMENTS, PartLibrary

    def called(length: int, arguments: int, *, forced: bool = False) -> bool:
        library = PartLibrary(cpu_target.target_context.codegen(), "law")
        module = library.create_ir_module("law")
        double = ir.DoubleType()
        function = ir.Function(module, ir.FunctionType(double, [double] * arguments), "law")
        builder = ir.IRBuilder(function.append_basic_block())
        value = function.args[0]
        for _ in range(length - 1):
            value = builder.fadd(value, value)
        builder.ret(value)
        if forced:
            function.attributes.add("alwaysinline")
        library.add_ir_module(module)
        return "noinline" in function.attributes

    assert called(LONG + 1, 5)
    assert not called(LONG, 5)
    assert not called(LONG + 1, MANY_ARGUMENTS)
    assert not called(LONG + 1, 5, forced=True)


FALLBACK = """
import numba
numba.__version__ = "0.1.0"
from lir_element._compile import jit
assert not jit.WITH_PARTS
from lir_element.kernels.rotation import turn_matrix
import numpy as np
q = np.empty((3, 3))
turn_matrix(0.1, 0.2, 0.3, q)
print(q.tobytes().hex(), sum(turn_matrix.stats.cache_misses.values()))
"""


def run(code: str, cache: Path) -> list[str]:
    return fresh(code, PYTHONPATH=str(ROOT), LIR_CACHE_DIR=str(cache)).stdout.split()


@COMPILES
def test_with_a_numba_that_is_not_known_kernels_compile_the_ordinary_way(tmp_path: Path) -> None:
    usual = FALLBACK.replace('"0.1.0"', "numba.__version__").replace("not jit.WITH_PARTS", "True")
    [bits, misses] = run(FALLBACK, tmp_path)
    assert misses == "1"
    assert run(FALLBACK, tmp_path) == [bits, "0"]
    assert run(usual, tmp_path) == [bits, "1"]


RIG = """
import numba
numba.__version__ = {version}
from lir_element import CoulombFriction, LIRBearing, cyclic_test
from lir_element._compile import jit
assert jit.WITH_PARTS == {parts}
bearing = LIRBearing(radius=1.0, slider_height=0.1, slider_radius=0.1, capacity=0.2,
                     friction=CoulombFriction(0.05), interface_friction=0.12)
data = cyclic_test(bearing, [0.05, -0.22], 1e5)
print(*(data[name].to_numpy().tobytes().hex() for name in ("bearing_force", "interface_slip")))
print(float(data["interface_slip_size"].max()))
"""


@PARTS
@pytest.mark.nightly
def test_a_rig_gives_the_same_with_and_without_parts(tmp_path: Path) -> None:
    kept = cache.cache_folder()
    usual = run(RIG.format(version="numba.__version__", parts=True), kept or tmp_path)
    assert float(usual[-1]) > 1e-3  # rims and interface are met on the way
    assert run(RIG.format(version='"0.67.0"', parts=False), tmp_path / "ordinary") == usual


FIRST = """
from frames.precompile import USUAL
import warnings
warnings.simplefilter("ignore")
USUAL["time history"]()
"""


@COMPILES
@pytest.mark.nightly
def test_a_run_compiles_no_kernels_of_other_levels(tmp_path: Path) -> None:
    run(FIRST, tmp_path)
    names = {path.name.rsplit("-", 1)[0] for path in tmp_path.rglob("*.kernel")}
    assert "frames.kernels.integration.integrate_chunk" in names
    others = ("contact", "rigid_body")
    assert not [n for n in names if any(f"lir_element.kernels.{o}." in n for o in others)]
