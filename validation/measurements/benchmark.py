"""Cost of this program and of OpenSees for the same accuracy: writes docs/validation/benchmark.md.

How far it is from its goals goes into docs/benchmark_goals.md.

    python -m validation.measurements.benchmark

Runs what docs/validation/benchmark.json does not hold yet, case by case, each in a process of its
own, keeps what it finds there, and writes the page. Options:

    --case b c       these cases alone: a to f, or "profile"
    --again          measure anew what is there
    --short          shorter windows, one turn, fewer elements: to try it out, in a file of its own
    --page           write the page from what is there
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import platform
import statistics
import sys
from dataclasses import asdict
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
from matplotlib.lines import Line2D

from frames import gravity
from frames.plots.plot_style import PALETTE, SMALL, add_legend, caption, grid_of, new_figure
from lir_element.opensees import opensees
from validation.measurements.benchmark_cases import SOME, measure
from validation.measurements.benchmark_models import STRUCTURES, strong
from validation.measurements.benchmark_page import before, goals_text, second_cost, text, there_are
from validation.measurements.benchmark_runs import batch_here, batch_there, run_here
from validation.measurements.benchmark_search import ALLOWED, setting_of
from validation.measurements.performance import element_microseconds
from validation.opensees.worker import Worker
from validation.page import DPI, FOLDER, index

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KEPT = FOLDER / "benchmark.json"
LIMIT = 3600.0
"""Seconds after which a case counts as hanging."""
SMALLER = {"d256": "d100"}
"""Where a structure takes steps and settings from; else those of OpenSees from case b."""
CASES = ("a", "b", "f", "profile", "e", "c", "d")
"""In the order in which they are run: later ones use the steps of b."""


def measured(key: str, kept: dict[str, Any], *, short: bool) -> dict[str, Any]:
    """Run one structure in a process of its own; return what was found."""
    smaller = kept.get(SMALLER.get(key, "b"), {})
    with Worker(LIMIT) as worker:
        state, found = worker.run(measure, structure=STRUCTURES[key], smaller=smaller, short=short)
    return {"state": state, **(asdict(found) if found is not None else {})}


def profiles() -> dict[str, Any]:
    """Profile the loop in a process of its own."""
    with Worker(LIMIT) as worker:
        return {key: worker.run(profile, key=key)[1] for key in PROFILED}


def batch(kept: dict[str, Any]) -> dict[str, Any]:
    """Run the batch: here at the step of structure b, in OpenSees with its settings of it."""
    found = kept["b"]
    dt = found["here"]["LIR-DCFP"]["direct"]["dt"]
    with Worker(LIMIT) as worker:
        state, ours = worker.run(batch_here, dt=dt)
    kinds = {}
    for kind in SOME:
        best = found["there"][kind]["best"]
        kinds[kind] = batch_there(kind, best["dt"], setting_of(best["setting"]), LIMIT)
    return {"state": state, "here": ours, "there": kinds}


def keys_of(case: str) -> list[str]:
    """Return what is kept of a case."""
    found = [one.key for one in STRUCTURES.values() if one.case == case]
    return found or [case]


def run(case: str, kept: dict[str, Any], file: Path, *, again: bool, short: bool) -> None:
    """Run a case, and keep each of its results at once."""
    for key in keys_of(case):
        if key in kept and not again:
            continue
        print(f"{datetime.datetime.now():%H:%M:%S} {key}", flush=True)  # of this machine
        if key in STRUCTURES:
            found = measured(key, kept, short=short)
        elif key == "profile":
            found = profiles()
        elif "b" in kept:
            found = batch(kept)
        else:
            print("  needs the steps of b: run that case first")
            continue
        earlier = kept.get(key, {})
        kept[key] = {**found, "when": f"{datetime.datetime.now():%Y-%m-%d}"}
        if earlier.get("state") == "ok":
            kept[key]["before"] = before(earlier)
        kept["machine"] = machine()
        file.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def machine() -> str:
    """Return what the figures were taken on."""
    return (
        f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}, numba "
        f"{numba.__version__}, OpenSees {opensees().version()}"
    )


def processor() -> str:
    """Return the name of the processor, as far as the system tells."""
    file = Path("/proc/cpuinfo")
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def write(kept: dict[str, Any], folder: Path = FOLDER) -> None:
    """Write page, figure, index, and the page of goals beside the folder."""
    draw(kept).savefig(
        folder / "figures" / "benchmark-cost.png", dpi=DPI, metadata={"Software": None}
    )
    (folder / "benchmark.md").write_text(text(kept), encoding="utf-8")
    (folder / "README.md").write_text(index(folder), encoding="utf-8")
    (folder.parent / "benchmark_goals.md").write_text(goals_text(kept), encoding="utf-8")


def main(arguments: list[str] | None = None) -> None:
    """Measure what is asked for and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.measurements.benchmark")
    parser.add_argument("--case", nargs="+", choices=CASES, default=CASES)
    parser.add_argument("--again", action="store_true", help="measure anew what is there")
    parser.add_argument("--short", action="store_true", help="try it out; no page is written")
    parser.add_argument("--page", action="store_true", help="write the page from what is there")
    options = parser.parse_args(arguments)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # of the processes that run the cases
    file = Path("benchmark-short.json") if options.short else KEPT
    kept = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    if not options.page:
        for case in CASES:
            if case in options.case:
                run(case, kept, file, again=options.again, short=options.short)
    if options.short:
        json.dump(kept, sys.stdout, indent=1)
    else:
        write(kept)


KINDS = {"singleFPBearing": "o", "LIR-DCFP, in-process coupling": "s"}
"""By marker; beside a kind stands our own device of it."""
WHO = {"direct": PALETTE[0], "reduced": PALETTE[2], "usual": PALETTE[3], "best": PALETTE[1]}
NAMES = {
    "direct": "here, direct",
    "reduced": "here, reduced",
    "usual": "OpenSees, usual settings",
    "best": "OpenSees at its best",
}
FLOOR = 1e-3  # %: errors below are drawn here


def size_panel(ax: Axes, kept: dict[str, Any]) -> None:
    """Draw the cost of a second of the motion over the number of bearings."""
    large = [one for one in there_are(kept) if one.case in "bcd"]
    for kind, marker in KINDS.items():
        for who, colour in WHO.items():
            points = sorted((one.bearings, second_cost(kept[one.key], kind, who)) for one in large)
            points = [(n, cost) for n, cost in points if math.isfinite(cost)]
            if points:
                ax.plot(
                    *zip(*points, strict=True),
                    color=colour,
                    marker=marker,
                    ms=3.5,
                    lw=0.0,
                    mfc=colour if marker == "s" else "white",
                )
    ax.set(xscale="log", yscale="log", xlim=(7.0, 330.0))
    ax.set_xticks([9, 16, 25, 36, 100, 256], labels=["9", "16", "25", "36", "100", "256"])
    ax.minorticks_off()
    caption(ax, x="bearings", y="computation / motion [s/s]", title="cost over size")


def error_panel(ax: Axes, found: dict[str, Any]) -> None:
    """Draw error over cost of the building on nine bearings."""
    ours = found["here"]
    for device, marker in (("plain DCFP", "o"), ("LIR-DCFP", "s")):
        for method, one in ours[device].items():
            pairs = [
                (run["loop"], max(100.0 * error, FLOOR))
                for run, error in zip(one.get("runs", [])[:4], one.get("errors", []), strict=False)
            ]
            if pairs:
                ax.plot(
                    *zip(*pairs, strict=True),
                    color=WHO[method],
                    marker=marker,
                    ms=3.5,
                    lw=1.0,
                    mfc=WHO[method] if marker == "s" else "white",
                )
    for kind, marker in KINDS.items():
        for name in ("usual", "best"):
            one = found["there"][kind][name]
            if math.isfinite(one["dt"]) and "loop" in one:
                ax.plot(
                    [one["loop"]],
                    [max(100.0 * one["error"], FLOOR)],
                    color=WHO[name],
                    marker=marker,
                    ms=4.5,
                    mfc=WHO[name] if marker == "s" else "white",
                    lw=0.0,
                )
    ax.axhline(100.0 * ALLOWED, color="black", ls="--", lw=0.9)
    ax.set(xscale="log", yscale="log")
    caption(
        ax,
        x="CPU time of the steps [s]",
        y="error of the peak displacement [%]",
        title="3 storeys, 9 bearings, 12 s",
    )


def draw(kept: dict[str, Any]) -> Figure:
    """Draw both panels, of what there is."""
    figure = new_figure(3.6)
    ((left, right),) = grid_of(figure, 1, 2)
    size_panel(left, kept)
    if kept.get("b", {}).get("state") == "ok":
        error_panel(right, kept["b"])
    handles = [
        Line2D([], [], color=colour, marker="s", ms=4.0, lw=0.0, label=NAMES[who])
        for who, colour in WHO.items()
        if who != "reduced" or _has_reduced(kept)
    ]
    handles += [
        Line2D([], [], color="black", marker="s", ms=4.0, lw=0.0, label="LIR-DCFP"),
        Line2D([], [], color="black", marker="o", mfc="white", ms=4.0, lw=0.0, label="plain DCFP"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="error allowed"),
    ]
    add_legend(figure, handles, columns=3, size=SMALL)
    return figure


def _has_reduced(kept: dict[str, Any]) -> bool:
    return any("runs" in kept[one.key]["here"]["LIR-DCFP"]["reduced"] for one in there_are(kept))


PROFILED = ("a", "b", "c36x10")
LENGTH, REACH = 4.0, 0.2  # s, m: of the motion, and of the bearing's orbit
STEP = 0.01
"""Of the runs [s]."""
SIZE, PRODUCTS = 160, 2000  # of the matrix that tells the machine's rate, which fits its caches
REPEATS = 7


def nanoseconds_a_product() -> float:
    """Return the time of a multiply-add in a product of matrix and vector [ns]."""
    matrix, x = np.ones((SIZE, SIZE)), np.ones(SIZE)
    out = np.zeros(SIZE)

    def multiply() -> None:
        for _ in range(PRODUCTS):
            np.dot(matrix, x, out=out)

    return 1e9 * _median_of(multiply) / (PRODUCTS * SIZE * SIZE)


def _median_of(run: Callable[[], object]) -> float:
    times = []
    for _ in range(REPEATS):
        began = process_time()
        run()
        times.append(process_time() - began)
    return statistics.median(times)


def multiply_adds(
    coordinates: int, modes: int, bearings: int, iterations: float, states: float, tangents: float
) -> float:
    """Return the multiply-adds that a step needs besides the bearings' state determinations."""
    b, eta = float(coordinates), float(modes)
    linear = 3.0 * b * b + 4.0 * b * eta + 10.0 * eta
    residuals = (states + 1.0) * b * b
    solutions = (iterations + 1.0) * b * b
    made = tangents * (b**3 / 3.0 + 144.0 * bearings)
    return linear + residuals + solutions + made


def profile(key: str) -> dict[str, float]:
    """Return what a step of a structure on LIR-DCFPs is spent on."""
    structure = STRUCTURES[key]
    bearing = structure.bearing()
    frame, motion = structure.frame(bearing), strong(LENGTH)
    state = gravity(frame)
    runs = [run_here(frame, motion, LENGTH, STEP) for _ in range(REPEATS)]
    step = statistics.median(run.step for run in runs)
    full = [run_here(frame, motion, LENGTH, STEP, recording=None).step for _ in range(REPEATS)]
    everything = statistics.median(full)
    iterations, states, tangents = (
        count / runs[0].steps for count in (runs[0].iterations, runs[0].states, runs[0].tangents)
    )
    trial, _ = element_microseconds(bearing, REACH, "pendulum", tangent=False)
    both, _ = element_microseconds(bearing, REACH, "pendulum", tangent=True)
    count = len(frame.bearings)
    coordinates, modes = len(state.run.b), len(state.run.e)
    needed = multiply_adds(coordinates, modes, count, iterations, states, tangents)
    return {
        "step": 1e6 * step,
        "states": count * states * trial,
        "tangents": count * tangents * (both - trial),
        "arithmetic": 1e-3 * nanoseconds_a_product() * needed,
        "recording": 1e6 * (everything - step),
        "multiply-adds": needed,
        "iterations": iterations,
        "states made": states,
        "tangents made": tangents,
        "coordinates": float(coordinates),
        "modes": float(modes),
    }


if __name__ == "__main__":
    main()
