"""Write the element as a shared library with a header for C: no Python is needed to run it.

The kernels are those of `Element`. They are linked into one module, which LLVM makes an object file
of; a C compiler links that with the few calls of `c_interface/lir_element.c`.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess  # the C compiler of the user  # noqa: S404
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
from llvmlite import binding as llvm
from llvmlite import ir
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.np.arrayobj import make_array, populate_array

from lir_element._compile.jit import OWN, WITH_PARTS
from lir_element._version import package_version
from lir_element.device.bearing import LIRBearing
from lir_element.device.features import LEVELS
from lir_element.device.friction import CoulombFriction
from lir_element.element import Element
from lir_element.errors import RunStatus
from lir_element.kernels import levels
from lir_element.kernels.pendulum.trial import has_no_state
from lir_element.layout import HEAT_PARTS, STATE, STATE_FIELDS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lir_element.device.features import Features, Level

_SOURCES = Path(__file__).parent / "c_interface"
_LAYOUT = float(int(OWN.hash[:12], 16))
_HEAD = 8  # doubles in front: layout, size, level, whether a tangent is there or a trial is pending
_NUMBER, _WORD = ir.DoubleType(), ir.IntType(64)
_PLACES: Any = STATE.fields
_ANY = LIRBearing(
    radius=1.0,
    slider_height=0.1,
    slider_radius=0.1,
    capacity=0.2,
    friction=CoulombFriction(0.05),
    interface_friction=0.12,
)


class _Memory:
    """The arrays of an element as one array of doubles, and the place of each in it."""

    def __init__(self, element: Element) -> None:
        self.element = element
        self.heat = np.zeros((1, 3, HEAT_PARTS))
        self.place: dict[int, int] = {}
        self.arrays: list[Any] = []
        self.size = 0
        e, head, initial = element, np.zeros(_HEAD), element.initial_stiffness()
        own = (head, initial, e._tangent, e._props, e._committed, e._trial, self.heat, e._work)
        for array in (*own, *(e._contacts or ())):
            if array.ctypes.data not in self.place:  # words are the same memory as their records
                self.place[array.ctypes.data] = self.size
                self.arrays.append(array)
                self.size += array.nbytes // 8
        head[:3] = _LAYOUT, self.size, LEVELS.index(element.level)
        places = {"INITIAL": initial, "TANGENT": e._tangent}
        places |= {"COMMITTED": e._committed, "TRIAL": e._trial}
        self.names = {name: self.place[array.ctypes.data] for name, array in places.items()}


def write_bearing(
    bearing: LIRBearing,
    path: str | Path,
    level: Level = "pendulum",
    *,
    features: Features | None = None,
) -> None:
    """Write a bearing at its start to a file that the library reads (`lir_read`).

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    path : str or Path
        The file.
    level, features
        Modelled features, as for `Element`.

    Raises
    ------
    ValueError
        If the bearing has contact points in place of discs, or `Element` refuses the rest.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "bearing.lir"
    >>> write_bearing(_ANY, file)
    >>> file.stat().st_size
    15072
    """
    if level == "contact" and bearing.contact_points is not None:
        count = bearing.contact_points
        msg = (
            f"contact_points = {count}: the C interface supports discs only, use "
            "contact_points=None"
        )
        raise ValueError(msg)
    memory = _Memory(Element(bearing, level, features=features))
    Path(path).write_bytes(b"".join(array.tobytes() for array in memory.arrays))


class _Entries:
    """Functions of C around kernels, in one module with all that they call."""

    def __init__(self) -> None:
        from lir_element._compile.linking import _WholeLibrary

        self._context = cpu_target.target_context
        self._context.refresh()
        self._library = _WholeLibrary(self._context.codegen(), "lir_element")
        self._module = ir.Module("lir_element")
        self._module.triple = llvm.get_process_triple()

    def add(self, memory: _Memory, name: str, kernel: Any, given: tuple[Any, ...]) -> None:
        """Add the function `name` that calls `kernel` with arrays of a bearing's memory.

        Other arrays, and numbers, are handed over by the caller.
        """
        kinds = tuple(numba.typeof(value) for value in given)
        kernel.get_call_template(kinds, {})  # compiles it as a part
        compiled = kernel.overloads[kinds]
        handed = [
            _NUMBER if isinstance(value, float) else _NUMBER.as_pointer()
            for value in given
            if isinstance(value, float)
            or (isinstance(value, np.ndarray) and value.ctypes.data not in memory.place)
        ]
        kind = ir.FunctionType(_WORD, [_NUMBER.as_pointer(), *handed])
        function = ir.Function(self._module, kind, f"lir_{name}_{memory.element.level}")
        builder = ir.IRBuilder(function.append_basic_block())
        base, left = function.args[0], iter(function.args[1:])
        values = [
            self._value(builder, base, memory, value, kind, left)
            for value, kind in zip(given, kinds, strict=True)
        ]
        _, result = self._context.call_internal_no_propagate(
            builder, compiled.fndesc, compiled.signature, values
        )
        builder.ret(result if result.type == _WORD else _WORD(0))
        self._library.add_linking_library(compiled.library)

    def _value(
        self, builder: Any, base: Any, memory: _Memory, value: Any, kind: Any, left: Iterator[Any]
    ) -> Any:
        # An argument of a kernel in numba's convention.
        context = self._context
        if value is None:
            return context.get_dummy_value()
        if isinstance(value, float):
            return next(left)
        if isinstance(value, int):
            return context.get_constant(kind, value)
        if isinstance(value, tuple):
            pairs = zip(value, kind, strict=True)
            parts = [self._value(builder, base, memory, v, own, left) for v, own in pairs]
            return context.make_tuple(builder, kind, parts)
        place = memory.place.get(value.ctypes.data)
        data = next(left) if place is None else builder.gep(base, [_WORD(place)])
        array = make_array(kind)(context, builder)
        populate_array(
            array,
            data=builder.bitcast(data, array.data.type),
            shape=cgutils.pack_array(builder, [_WORD(n) for n in value.shape]),
            strides=cgutils.pack_array(builder, [_WORD(n) for n in value.strides]),
            itemsize=_WORD(value.itemsize),
            meminfo=None,
        )
        return array._getvalue()

    def object_code(self) -> bytes:
        """Return the object file: all but the entries is hidden, and left out if it is unused."""
        from lir_element._compile.linking import _take_in

        entries = {f.name for f in self._module.functions if not f.is_declaration}
        self._library.add_ir_module(self._module)
        module = self._library._final_module
        _take_in(self._library, module)
        for part in (*module.functions, *module.global_variables):
            if not part.is_declaration and part.name not in entries:
                part.linkage = llvm.Linkage.internal
        self._library._optimize_final_module()
        codegen = self._context.codegen()
        machine = llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(
            cpu=codegen._get_host_cpu_name(),
            features=codegen._tm_features,
            opt=numba.config.OPT,
            reloc="pic",
            codemodel="default",
        )
        return bytes(machine.emit_object(module))


def _object_code(memories: list[_Memory]) -> bytes:
    # The kernels at all levels, as `Element` calls them.
    entries, u, v = _Entries(), np.zeros(12), np.zeros(12)
    for memory in memories:
        e = memory.element
        props, old, new, work, bodies = e._props, e._committed, e._trial, e._work, e._contacts
        calls: dict[str, tuple[Any, ...]] = {
            "trial": (props, old, new, work, bodies, 0, u, v, 0.0),
            "tangent": (props, new, work, bodies, 0, e._tangent),
            "commit": (props, old, new, *e._words, memory.heat, bodies, 0),
        }
        if bodies is not None:
            calls["look"] = (props, old, work, bodies, 0)
        for name, given in calls.items():
            entries.add(memory, name, getattr(levels, f"bearing_{name}"), given)
    return entries.object_code()


def _names(memories: list[_Memory]) -> dict[str, str]:
    # Texts for the names between @ in the header and the examples: all from one definition.
    computed = {RunStatus.OK, RunStatus.NOT_FINITE, RunStatus.NO_EQUILIBRIUM}
    outcomes = [s for s in RunStatus if s.is_bearing_failure or s in computed]
    sizes = {f"{m.element.level.upper()}_SIZE": m.size for m in memories}
    own = {**sizes, "SIZE": max(sizes.values()), **memories[0].names}
    own |= {"STATE_SIZE": STATE.itemsize // 8, "LAYOUT": int(_LAYOUT)}
    own["HAS_NO_STATE"] = sum(1 << int(s) for s in outcomes if has_no_state(int(s)))
    places = {f.name: int(_PLACES[f.name][1]) // 8 for f in STATE_FIELDS}
    lines = {
        "own": [f"{name} {value}" for name, value in own.items()],
        "statuses": [f"{s.name} {int(s)} /* {s.meaning}. Try: {s.remedy} */" for s in outcomes],
        "fields": [
            f"{f.name.upper()} {places[f.name]} /* {f.meaning} [{f.unit}], "
            f"{'integer' if f.kind == 'i8' else 'double'}{[*f.shape] or ''} */"
            for f in STATE_FIELDS
        ],
    }
    names = {name: "\n".join(f"#define LIR_{x}" for x in part) for name, part in lines.items()}
    numbers = own | {name.upper(): place for name, place in places.items()}
    names |= {f"LIR_{name}": str(number) for name, number in numbers.items()}
    return names | {"version": f"lir-dcfp {package_version()}"}


def write_library(folder: str | Path) -> Path:
    """Write the element as a shared library, its header and examples of programs that use it.

    Parameters
    ----------
    folder : str or Path
        Folder for the files; made if it does not exist.

    Returns
    -------
    Path
        Path of the library. Beside it are ``lir_element.h``, ``example.c``, ``uel.f90`` (Abaqus)
        and ``opensees_element.cpp``.

    Raises
    ------
    RuntimeError
        If there is no C compiler, if it fails, or if this version of numba is not supported.

    Notes
    -----
    The C compiler is the environment's CC, or ``cc``. The code is for the processor at hand;
    NUMBA_CPU_NAME=x86-64-v3 and NUMBA_CPU_FEATURES= in the environment make it for all usual ones.

    Examples
    --------
    >>> write_library("clib")  # doctest: +SKIP
    PosixPath('clib/liblir_element.so')
    """
    command = shlex.split(os.environ.get("CC", "cc"))
    if shutil.which(command[0]) is None:
        msg = (
            f"the C compiler {command[0]!r} was not found: install gcc, or set CC to the "
            "path of another"
        )
        raise RuntimeError(msg)
    if not WITH_PARTS or numba.config.DISABLE_JIT:
        msg = f"numba {numba.__version__} cannot compile the library: pip install 'numba==0.68.*'"
        msg += ", and unset NUMBA_DISABLE_JIT"
        raise RuntimeError(msg)
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    chosen: tuple[Level, ...] = ("pendulum", "contact")
    memories = [_Memory(Element(_ANY, level)) for level in chosen]
    names = _names(memories)
    for source in _SOURCES.iterdir():
        text = source.read_text(encoding="utf-8")
        filled = re.sub(r"@(\w+)@", lambda name: names[name[1]], text)
        (place / source.name).write_text(filled, encoding="utf-8")
    library = place / "liblir_element.so"
    with tempfile.TemporaryDirectory() as scratch:
        kernels = Path(scratch) / "kernels.o"
        kernels.write_bytes(_object_code(memories))
        options = "-O2", "-fPIC", "-shared", "-Wl,-z,defs", "-o", str(library)
        words = [*command, *options, str(place / "lir_element.c"), str(kernels), "-lm"]
        done = subprocess.run(words, capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode:
        msg = f"the C compiler failed: {shlex.join(words)}\n{done.stderr.strip()}"
        raise RuntimeError(msg)
    return library


def main(arguments: list[str] | None = None) -> None:
    """Write the library by a command: ``python -m lir_element.library FOLDER``."""
    parser = argparse.ArgumentParser(prog="python -m lir_element.library")
    parser.add_argument("folder", help="where to write the library, its header and the examples")
    try:
        print(write_library(parser.parse_args(arguments).folder))
    except (OSError, RuntimeError) as error:
        sys.exit(f"lir_element.library: {error}")


if __name__ == "__main__":
    main()
