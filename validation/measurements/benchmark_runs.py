"""One run of a structure of the benchmark here, and one in OpenSees: cost and peak displacement.

Cost is CPU time of the process: on a machine that is busy it is what a run needs, where the time
by the clock is what it had to wait for.
"""

from __future__ import annotations

import os
import resource
import statistics
import sys
import tempfile
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any
from unittest import mock

import numpy as np

import frames
from frames import Recording, time_history
from lir_element.errors import AnalysisWarning
from validation.measurements.benchmark_models import STRUCTURES, motion_of
from validation.measurements.opensees_cost import devices
from validation.opensees.frames import add_loads, build
from validation.opensees.model import (
    advance,
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)
from validation.opensees.worker import Worker

if TYPE_CHECKING:
    from collections.abc import Generator

    from frames import Frame, GroundMotion
    from lir_element import LIRBearing
    from validation.measurements.benchmark_models import Structure

RESCUES = 0.05
"""Share of steps that may need another algorithm before a setting is given up."""
BEARINGS_ALONE = Recording(channels=("bearing_displacement",))
"""What is recorded of a run here: as much as in OpenSees."""
_RESCUE_TOLERANCE = 1e-8  # m and rad, of the steps of a setting that fails


@dataclass(frozen=True)
class Run:
    """What one run took and found."""

    dt: float
    """Step [s]; NaN where the program chose it."""
    steps: int
    """Steps of the motion that were done."""
    loop: float
    """CPU time of the steps alone [s]."""
    whole: float
    """CPU time with building the model, equilibrium at rest and reading the results [s]."""
    peak: float
    """Largest displacement of a bearing in plan [m]."""
    status: str = "ok"
    """"ok", or why there is no result."""
    rescued: int = 0
    """Steps of OpenSees that its algorithm did not solve, and another one did."""
    iterations: int = 0
    states: int = 0
    tangents: int = 0
    """Of Newton's method here; determinations of all bearings' states, and tangents made."""

    @property
    def step(self) -> float:
        """CPU time of a step [s]."""
        return self.loop / self.steps if self.steps else float("nan")


@dataclass(frozen=True)
class Setting:
    """How OpenSees solves: system, numberer, algorithm, and test with its tolerance."""

    system: str = "UmfPack"
    numberer: str = "RCM"
    algorithm: tuple[str, ...] = ("Newton",)
    criterion: tuple[str, float] = ("NormDispIncr", 1e-8)

    @property
    def name(self) -> str:
        """All of it in words."""
        return (
            f"{self.system}, {self.numberer}, {' '.join(self.algorithm)}, "
            f"{self.criterion[0]} {self.criterion[1]:.0e}"
        )


_TIMED = "frames."

USUAL = Setting()
"""What manuals and examples show."""


@contextmanager
def cpu_clock() -> Generator[None, None, None]:
    """Have analyses here tell CPU time of the process for the time by the clock."""
    with ExitStack() as stack:
        for name, module in list(sys.modules.items()):
            if name.startswith(_TIMED) and hasattr(module, "perf_counter"):
                stack.enter_context(mock.patch.object(module, "perf_counter", process_time))
        yield


def run_here(
    frame: Frame,
    motion: GroundMotion,
    duration: float,
    dt: float | None,
    method: str = "direct",
    recording: Recording | None = BEARINGS_ALONE,
) -> Run:
    """Run a structure here."""
    integrator = "corrected-newmark" if frame.hinges else "newmark"
    options: Any = {"method": method, "recording": recording, "integrator": integrator}
    cpu = process_time()
    try:
        with warnings.catch_warnings(action="ignore", category=AnalysisWarning), cpu_clock():
            data = time_history(frame, motion, duration, dt, **options)
    except (ValueError, MemoryError) as refusal:
        return refused(dt, f"refused: {refusal}")
    cpu = process_time() - cpu
    moved = data["bearing_displacement"].to_numpy()[..., :2]
    return Run(
        dt=np.nan if dt is None else dt,
        steps=int(data.attrs["steps"]),
        loop=float(data.attrs["seconds_loop"]),
        whole=cpu,
        peak=float(np.linalg.norm(moved, axis=-1).max()),
        status=str(data.attrs["status"]),
        iterations=int(data.attrs["newton_iterations"]),
        states=int(data.attrs["state_determinations"]),
        tangents=int(data.attrs["tangents"]),
    )


def refused(dt: float | None, status: str) -> Run:
    """Return a run that gave nothing, with its reason."""
    step = np.nan if dt is None else dt
    return Run(step, 0, np.nan, np.nan, np.nan, status.splitlines()[0])


def run_there(
    structure: Structure,
    bearing: LIRBearing,
    kind: str,
    motion: GroundMotion,
    dt: float,
    steps: int,
    setting: Setting = USUAL,
) -> Run:
    """Run a structure in OpenSees, on elements of its own or ours."""
    device, place = devices(bearing, bearing.resolved()["design_load"])[kind]
    frame = structure.frame(device)
    began = process_time()
    with tempfile.TemporaryDirectory() as folder, empty_model() as ops:
        ops.logFile(os.devnull, "-noEcho")  # every failed iteration is reported
        built = build(ops, frame, place)
        add_loads(ops, frame, built)
        damping = structure.stiffness_damping(frame)
        if damping > 0.0:
            members = built.members.values()
            ops.region(1, "-ele", *members, "-rayleigh", 0.0, 0.0, damping, 0.0)
        try:
            gravity_analysis(ops)
            ground_motion(ops, motion)
            file = Path(folder) / "displacement.txt"
            ops.recorder("Node", "-file", str(file), "-node", *built.bases, "-dof", 1, 2, "disp")
            use(ops, setting)
            transient_steps(ops)
            timed = process_time()
            rescued = march(ops, setting, steps, dt)
            timed = process_time() - timed
        except (RuntimeError, ops.OpenSeesError) as cause:
            return refused(dt, f"stops: {cause}")
        ops.remove("recorders")
        whole = process_time() - began
        moved = np.loadtxt(file, ndmin=2)
    peak = float(np.hypot(moved[:, 0::2], moved[:, 1::2]).max())
    status = "ok" if np.isfinite(peak) else "not finite"
    return Run(dt, steps, timed, whole, peak, status, rescued)


def use(ops: Any, setting: Setting) -> None:
    """Give the analysis a setting."""
    test, tolerance = setting.criterion
    solver(ops, tolerance, test=test, system=setting.system)
    ops.numberer(setting.numberer)
    ops.algorithm(*setting.algorithm)


def march(ops: Any, setting: Setting, steps: int, dt: float) -> int:
    """Take steps; where the setting's algorithm fails take the step with another one."""
    began, done, rescued = ops.getTime(), 0, 0
    while done < steps:
        if ops.analyze(steps - done, dt) == 0:
            return rescued
        done = round((ops.getTime() - began) / dt) + 1
        rescued += 1
        if rescued > 1 + RESCUES * steps:
            msg = f"more than {100.0 * RESCUES:g} % of the steps need another algorithm"
            raise RuntimeError(msg)
        ops.test("NormDispIncr", _RESCUE_TOLERANCE, 60)
        ops.algorithm("KrylovNewton")
        advance(ops, 1, dt, _RESCUE_TOLERANCE)
        ops.test(*setting.criterion, 60)
        ops.algorithm(*setting.algorithm)
    return rescued


HISTORIES = 200
DIRECTIONS = 20  # of the motion in plan
SCALES = tuple(float(value) for value in np.linspace(0.55, 1.0, HISTORIES // DIRECTIONS))
LENGTH = 20.0
"""Of a history [s]."""
GOAL_HISTORIES, GOAL_SECONDS, GOAL_BYTES = 10_000, 600.0, 2 * 2**30
THERE = 2
"""Histories that OpenSees runs in each process; all others cost the same."""


def motions() -> dict[str, GroundMotion]:
    """Return the motion in `DIRECTIONS` directions in plan, by name."""
    motion = motion_of(LENGTH)
    angles = np.linspace(0.0, 2.0 * np.pi, DIRECTIONS, endpoint=False)
    return {f"turned {np.degrees(a):.0f}": motion.rotated(float(a)) for a in angles}


def batch_here(dt: float) -> dict[str, Any]:
    """Run all histories here."""
    structure = STRUCTURES["b"]
    frame = structure.frame(structure.bearing())
    run_here(frame, motion_of(LENGTH), 2.0 * dt, dt)  # loads the kernels
    together = getattr(frames, "time_histories", None)
    before = _memory()
    clock, cpu = perf_counter(), process_time()
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        if together is None:
            _one_by_one(frame, dt)
        else:
            together(frame, motions(), scales=SCALES, dt=dt, workers=None)
    return {
        "histories": HISTORIES,
        "clock": perf_counter() - clock,
        "cpu": process_time() - cpu,
        "memory": _memory(),
        "before": before,
        "cores": os.cpu_count(),
        "dt": dt,
        "how": "`time_history` in threads" if together is None else "`time_histories`",
    }


def _memory() -> int:
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _one_by_one(frame: Frame, dt: float) -> None:
    cases = [motion.scaled(scale) for motion in motions().values() for scale in SCALES]

    def peak(motion: GroundMotion) -> float:
        data = frames.time_history(frame, motion, LENGTH, dt, recording=BEARINGS_ALONE)
        return float(data["bearing_displacement"].max())

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(peak, cases))


def histories_there(kind: str, dt: float, setting: Setting, first: int) -> list[float]:
    """Run `THERE` histories in OpenSees; return the CPU time of each [s]."""
    structure, times = STRUCTURES["b"], []
    bearing = structure.bearing()
    for motion in list(motions().values())[first : first + THERE]:
        run = run_there(structure, bearing, kind, motion, dt, round(LENGTH / dt), setting)
        times.append(run.whole)
    return times


def batch_there(kind: str, dt: float, setting: Setting, limit: float) -> dict[str, Any]:
    """Run some of the histories in OpenSees, one process a core at the same time."""
    count = os.cpu_count() or 1

    def serve(place: int) -> list[float]:
        with Worker(limit) as worker:
            state, times = worker.run(
                histories_there, kind=kind, dt=dt, setting=setting, first=place * THERE
            )
        return times if state == "ok" else []

    with ThreadPoolExecutor(count) as pool:
        times = [t for found in pool.map(serve, range(count)) for t in found if np.isfinite(t)]
    cost = statistics.median(times) if times else np.nan
    return {"cpu": cost, "run": len(times), "dt": dt, "cores": count}
