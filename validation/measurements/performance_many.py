"""Speed of buildings on many bearings: rows of docs/performance.md.

Ten storeys as in the benchmark's case d, under the strong part of its motion, with steps of 10 ms.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from frames import RayleighDamping, modes, time_history
from lir_element import CoulombFriction
from validation.cases import example_bearing
from validation.claims.opensees_building import FAR, RATIO
from validation.measurements.benchmark_models import strong
from validation.measurements.opensees_cost import slender_frame

if TYPE_CHECKING:
    from frames import Frame

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


def building(side: int) -> Frame:
    """Return ten storeys on `side` by `side` bearings, each of them made for the mean load."""
    bearing = example_bearing(friction=CoulombFriction(0.065))
    bays = (side - 1, side - 1)
    frame = slender_frame(bays, STOREYS, bearing)
    weight = sum(float(mass[2]) for mass in frame.masses.values()) * frame.gravity
    load = weight / len(frame.bearings)
    frame = slender_frame(bays, STOREYS, replace(bearing, design_load=load))
    frame.set_damping(RayleighDamping(RATIO, (FAR, float(modes(frame, 1, "fixed").periods[0]))))
    return frame


def many_rows() -> list[str]:
    """Return a row a case: unknowns, vectors, microseconds a step, milliseconds a second."""
    rows = []
    for side, method, duration in CASES:
        frame = building(side)
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
