"""What a step costs in each program, and a call of the bearing from each language.

    python -m validation.measurements.framework_cost

Writes docs/validation/framework_cost.json, from which docs/build.py makes the tables of
docs/frameworks.md. Steps: a mass slides on one bearing into its rims. All programs run in turn,
several times, with the bearing and with a friction pendulum of their own. It is processor time,
that of the process behind an out-of-process coupling included. Programs that are not installed are
left out. Calls: a trial, a tangent and a commit while the bearing slides along an ellipse, without
the program around them. The least of several turns counts.
"""

from __future__ import annotations

import ctypes
import json
import statistics
import subprocess  # the C compiler  # noqa: S404
import tempfile
from functools import partial
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, Element, write_bearing, write_library
from lir_element.opensees import bearing_element, builtin_commands, opensees
from lir_element.opensees.element_memory import ElementMemory, entries_of
from lir_element.opensees.placement import BearingTransform, PlacedBearing
from lir_element.opensees.plugin import _SESSION
from validation.measurements.opensees_cost import BASE, STEP, in_turns, pulse, ratio, set_up
from validation.measurements.opensees_cost import STEPS as HISTORY
from validation.multibody import Options, building_history, multibody_history
from validation.opensees.model import empty_model
from validation.page import FOLDER
from validation.scenes import EXAMPLE_MASS, example_bearing

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element import LIRBearing
    from lir_element.device.features import Level
    from lir_element.layout import Floats

KEPT = FOLDER / "framework_cost.json"
LEVELS: tuple[Level, ...] = ("pendulum", "contact")
BODIES = 1000  # steps of the bearing of bodies and contacts
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


BEARING = partial(example_bearing, friction=CoulombFriction(0.065))


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


def spent() -> float:
    """Return the processor time of this process, and of the one behind the bearings [s]."""
    server = _SESSION.server
    if server is None or not server.alive:
        return process_time()
    times = import_module("psutil").Process(server.pid).cpu_times()
    return process_time() + float(times.user + times.system)


def timed(run: Callable[[], object], steps: int = HISTORY) -> float:
    """Return the processor time of a step [us]."""
    began = spent()
    run()
    return 1e6 * (spent() - began) / steps


def in_opensees(ops: Any, route: Any, level: Level | None) -> float:
    """Run OpenSees, or xara, with the bearing at a level, or with its own friction pendulum."""
    bearing, load = BEARING(), EXAMPLE_MASS * 9.80665

    def place(tag: int, i: int, j: int, device: LIRBearing) -> None:
        if level is not None:
            bearing_element(tag, i, j, device, level, route=route, ops=ops)
            return
        for name, *arguments in builtin_commands(BASE, tag, i, j, device, load):
            getattr(ops, name)(*arguments)

    frame = lumped_mass(bearing if level else bearing.as_dcfp(rims=False), EXAMPLE_MASS)
    codes: list[int] = []
    with empty_model(ops):
        set_up(ops, frame, place, along_x())
        cost = timed(lambda: codes.append(ops.analyze(HISTORY, STEP)))
    if codes != [0]:
        msg = f"the analysis with level {level} stopped"
        raise RuntimeError(msg)
    return cost


def in_frames(level: Level | None) -> float:
    """Run `time_history`; its loop counts."""
    bearing = BEARING() if level else BEARING().as_dcfp(rims=False)
    model = lumped_mass(bearing, EXAMPLE_MASS)
    duration = HISTORY * STEP
    data = time_history(model, along_x(), level=level or "pendulum", duration=duration, dt=STEP)
    return 1e6 * float(data.attrs["seconds_loop"]) / HISTORY


def in_exudyn(level: Level | None) -> float:
    """Run a quarter of a building on four bearings, or a bearing of bodies and contacts."""
    shaking = along_x()
    if level is None:
        end = BODIES * Options().step
        return timed(
            lambda: multibody_history(BEARING(), EXAMPLE_MASS, shaking, end, Options()), BODIES
        )
    mass, end = 4.0 * EXAMPLE_MASS, HISTORY * STEP
    return 0.25 * timed(lambda: building_history(BEARING(), mass, shaking, end, STEP, level))


def along_x() -> GroundMotion:
    """Return the motion of all programs."""
    return GroundMotion(x=pulse().x, dt=STEP)


def histories() -> list[dict[str, Any]]:
    """Run all programs that are installed; return their costs of a step [us] and ratios."""
    ways: dict[str, tuple[str, Callable[[Level | None], float]]] = {
        "`time_history`": ("plain DCFP", in_frames)
    }
    if find_spec("openseespy"):
        name = f"OpenSeesPy {opensees().version()}"
        ways[f"{name}, in process"] = f"`{BASE}`", partial(in_opensees, opensees(), "fast")
        ways[f"{name}, out of process"] = f"`{BASE}`", partial(in_opensees, opensees(), "portable")
    if find_spec("opensees"):
        xara = import_module("opensees.openseespy")
        name = f"xara (opensees {version('opensees')}), out of process"
        ways[name] = f"`{BASE}`", partial(in_opensees, xara, "portable")
    if find_spec("exudyn"):
        own = f"bodies and contacts, steps of {1e3 * Options().step:g} ms"
        ways[f"Exudyn {version('exudyn')}"] = own, in_exudyn
    runs = {
        f"{name} {level}": partial(run, level)
        for name, (_, run) in ways.items()
        for level in (None, *LEVELS)
    }
    found = in_turns(runs)
    return [
        {"program": name, "own": own, "cost": statistics.median(found[f"{name} None"])}
        | {
            at: [
                statistics.median(found[f"{name} {at}"]),
                ratio(found, f"{name} {at}", f"{name} None"),
            ]
            for at in LEVELS
        }
        for name, (own, _) in ways.items()
    ]


def calls() -> dict[str, list[float]]:
    """Return the costs of a call by level."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_library(folder)
        (folder / "loops.c").write_text(LOOPS, encoding="utf-8")
        words = "cc -O2 -shared -fPIC loops.c -L. -llir_element -Wl,-rpath,$ORIGIN -o loops.so"
        subprocess.run(words.split(), cwd=folder, check=True)  # noqa: S603
        loops = ctypes.CDLL(str(folder / "loops.so"))
        return {at: costs(folder, loops, at) for at in LEVELS}


def main() -> None:
    """Measure, and keep the numbers."""
    kept = {"steps": histories(), "calls": calls()}
    KEPT.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    print(KEPT.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
