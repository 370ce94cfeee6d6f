"""What a step of the time loop is spent on, beside the arithmetic that it needs.

State determinations are timed alone and counted; the products and solutions of the structure are
counted in multiply-adds, and take what the machine needs for these in a product of a matrix and a
vector; recording is the difference of two runs. The rest of the step is what is left.
"""

from __future__ import annotations

import statistics
from time import process_time
from typing import TYPE_CHECKING

import numpy as np

from frames import gravity
from validation.measurements.benchmark_models import STRUCTURES, strong
from validation.measurements.benchmark_runs import run_here
from validation.measurements.performance import element_microseconds

if TYPE_CHECKING:
    from collections.abc import Callable

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
