"""Two hundred histories of one building: here by a batch, in OpenSees by one process a core."""

from __future__ import annotations

import os
import resource
import statistics
import warnings
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

import numpy as np

import frames
from lir_element.errors import AnalysisWarning
from validation.measurements.benchmark_models import STRUCTURES, motion_of
from validation.measurements.benchmark_runs import BEARINGS_ALONE, run_here, run_there
from validation.opensees.worker import Worker

if TYPE_CHECKING:
    from frames import Frame, GroundMotion
    from validation.measurements.benchmark_runs import Setting

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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
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
