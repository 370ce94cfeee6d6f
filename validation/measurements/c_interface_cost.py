"""What a step of the bearing costs from C, beside `Element` and the in-process OpenSees coupling.

    python -m validation.measurements.c_interface_cost

Prints the table of docs/frameworks.md: processor time of a trial, a tangent and a commit while the
bearing slides along an ellipse, without the program around them. The least of several turns counts.
"""

from __future__ import annotations

import ctypes
import subprocess  # the C compiler  # noqa: S404
import tempfile
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element import Element, write_bearing, write_library
from lir_element.opensees.element_memory import ElementMemory, entries_of
from lir_element.opensees.placement import BearingTransform, PlacedBearing
from validation.page import table
from validation.scenes import example_bearing

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element.device.features import Level
    from lir_element.layout import Floats

STEPS, TURNS, DT = 2000, 5, 0.002
LOOPS = r"""
#include <string.h>
#include "lir_element.h"

int run_library(double *bearing, const double *u, const double *v, int steps, double dt)
{
    double force[12], tangent[144];
    int code = 0;
    for (int k = 0; k < steps && !code; k++) {
        code = lir_trial(bearing, u + 12 * k, v, k * dt);
        lir_force(bearing, force);
        lir_tangent(bearing, tangent);
        code = code ? code : lir_commit(bearing);
    }
    return code;
}

int run_coupling(long long block, double *host_u, double *host_v, const double *u, const double *v,
                 int steps, double dt, int (*trial)(long long, double), void (*tangent)(long long),
                 void (*commit)(long long))
{
    int code = 0;
    for (int k = 0; k < steps && !code; k++) {
        memcpy(host_u, u + 12 * k, 96);
        memcpy(host_v, v, 96);
        code = trial(block, k ? dt : 0.0);
        tangent(block);
        commit(block);
    }
    return code;
}
"""


def motion() -> Floats:
    """Return displacements (STEPS, 12) that slide under a constant closure."""
    bearing = example_bearing()
    angle = 2.0 * np.pi * np.arange(STEPS) / STEPS
    u = np.zeros((STEPS, 12))
    u[:, 6], u[:, 7] = 0.1 * np.sin(angle), 0.05 * np.sin(2.0 * angle)
    length, options = bearing.effective_radius, bearing.resolved()
    u[:, 8] = length - np.sqrt(length**2 - np.sum(u[:, 6:8] ** 2, axis=1))
    u[:, 8] -= options["design_load"] / options["axial_stiffness"]
    return u


def least(make: Callable[[], Callable[[], int]]) -> float:
    """Return the least time of a step [us]; each turn is made anew, outside of the time."""
    times = []
    for _ in range(TURNS):
        run = make()
        began = process_time()
        if code := run():
            msg = f"a step has the status {code}"
            raise RuntimeError(msg)
        times.append(process_time() - began)
    return 1e6 * min(times) / STEPS


def costs(folder: Path, loops: Any, level: Level) -> list[float]:
    """Return the costs of the three ways [us]."""
    u, v = motion(), np.zeros(12)
    v[6] = 0.1
    bearing = example_bearing()
    file = folder / "bearing.lir"
    write_bearing(bearing, file, level)
    entries = entries_of(level)
    entry = [ctypes.c_void_p(e.address) for e in (entries.trial, entries.tangent, entries.commit)]

    def address(array: Any) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    def library() -> Callable[[], int]:
        memory = np.frombuffer(bytearray(file.read_bytes()))
        dt = ctypes.c_double(DT)
        return lambda: int(loops.run_library(address(memory), address(u), address(v), STEPS, dt))

    def coupling() -> Callable[[], int]:
        transform = BearingTransform((1, 2), 12, np.eye(12), 1.0, np.eye(3), 1.0)
        memory = ElementMemory(PlacedBearing(1, bearing, level, transform))
        given = [address(memory.block[name]) for name in ("host_u", "host_v")]
        rest = (address(u), address(v), STEPS, ctypes.c_double(DT), *entry)

        def run() -> int:
            block = ctypes.c_longlong(memory.address)
            return int(loops.run_coupling(block, *given, *rest))

        return run

    def element() -> Callable[[], int]:
        one = Element(bearing, level)

        def run() -> int:
            for k in range(STEPS):
                one.set_trial(u[k], v, k * DT)
                one.resisting_force()
                one.tangent_stiffness()
                one.commit()
            return 0

        return run

    return [least(way) for way in (library, coupling, element)]


def main() -> None:
    """Measure, and print the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_library(folder)
        (folder / "loops.c").write_text(LOOPS, encoding="utf-8")
        words = "cc -O2 -shared -fPIC loops.c -L. -llir_element -Wl,-rpath,$ORIGIN -o loops.so"
        subprocess.run(words.split(), cwd=folder, check=True)  # noqa: S603
        loops = ctypes.CDLL(str(folder / "loops.so"))
        levels: tuple[Level, ...] = ("pendulum", "contact")
        rows = [[f'`"{at}"`', *(f"{t:.1f}" for t in costs(folder, loops, at))] for at in levels]
    head = ["level", "C interface [us]", "in-process OpenSees [us]", "`Element` in Python [us]"]
    print(table(head, rows))


if __name__ == "__main__":
    main()
