"""Speed of buildings on many bearings: rows of docs/performance.md.

Ten storeys as in the benchmark's case d, under the strong part of its motion, with steps of 10 ms.
"""

from __future__ import annotations

from typing import Any, cast

from frames import time_history
from validation.measurements.benchmark_models import Structure, strong

STOREYS, STEP = 10, 0.01  # -, s
CASES = (
    (6, "direct", 4.0),
    (6, "reduced", 4.0),
    (10, "direct", 4.0),
    (10, "reduced", 4.0),
    (16, "direct", 4.0),
    (16, "reduced", 4.0),
)
"""Bearings along each side, method, duration [s]."""


def many_rows() -> list[str]:
    """Return a row a case: unknowns, vectors, microseconds a step, milliseconds a second."""
    rows = []
    for side, method, duration in CASES:
        one = Structure(f"{side**2} bearings", "d", (side - 1, side - 1), STOREYS)
        frame = one.frame(one.bearing())
        data = time_history(
            frame, strong(duration), duration=duration, dt=STEP, method=cast("Any", method)
        )
        found = data.attrs
        spent = found["seconds_loop"]
        rows.append(
            f"| {side**2} | {found['degrees_of_freedom']} | {method} | {found['modes']} "
            f"| {1e6 * spent / found['steps']:.0f} | {1e3 * spent / duration:.0f} "
            f"| {found['newton_iterations'] / found['steps']:.1f} | {found['tangents']}, "
            f"{found['shared_tangents']} | {found['seconds_gravity']:.1f} |"
        )
    return rows
