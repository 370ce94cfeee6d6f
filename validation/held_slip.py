"""The stable limit of interface slip without rims, L mu_h - mu1 R1 - mu2 R2, tried on the rig at all levels.

A bearing is pushed beyond its rims until the interface has slipped, taken back to the other side,
and turned again in the direction of the slip: a stable limit of interface slip stays as it is, a
larger one runs off the sliders' overlap. docs/theory.md, Eq. (2.7).
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from lir_element import (
    AnalysisWarning,
    CoulombFriction,
    DesignWarning,
    LIRBearing,
    VelocityFriction,
    cyclic_test,
)

SHARES = (0.95, 1.05)
"""Slips over the one that holds."""
LEVELS = ("pendulum", "contact", "rigid_body")
SPEED = 0.02  # m/s
_PLAIN: dict[str, Any] = {
    "radius": 1.0,
    "slider_height": 0.07,
    "slider_radius": 0.1,
    "capacity": 0.2,
    "friction": CoulombFriction(0.07),
    "interface_friction": 0.08,
    "design_load": 3e5,
}
_CHANGES: dict[str, dict[str, Any]] = {
    "mu_h = 0.08, mu_e = 0.07": {},
    "unequal radii": {"radius": (0.8, 1.2)},
    "unequal frictions": {"friction": (CoulombFriction(0.06), CoulombFriction(0.075))},
    "friction by speed": {"friction": VelocityFriction(0.07, 0.04, 500.0)},
    "wide slider": {
        "radius": 2.0,
        "slider_height": 0.15,
        "slider_radius": 0.25,
        "capacity": 0.45,
        "friction": CoulombFriction(0.06),
    },
    "high slider": {"slider_height": 0.12, "interface_friction": 0.09},
}


def bearings() -> dict[str, LIRBearing]:
    """Return the bearings by name: all hold less slip than their sliders overlap."""
    with warnings.catch_warnings(action="ignore", category=DesignWarning):
        return {name: LIRBearing(**(_PLAIN | changes)) for name, changes in _CHANGES.items()}


def end(bearing: LIRBearing, share: float, level: str) -> tuple[str, float]:
    """Return how the turn after a slip of `share` of the held one ends."""
    capacity = bearing.lateral_capacity
    peak = capacity + share * bearing.slip_stability
    path = np.array([0.0, peak, 0.0, -0.5 * capacity, 0.0, 0.5 * capacity, 0.0])
    load = bearing.resolved()["design_load"]
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        data = cyclic_test(bearing, path, load, velocity=SPEED, level=level)  # type: ignore[arg-type]
    return str(data.attrs["status"]), float(data["interface_slip_size"][2, 0])


def rows() -> list[tuple[str, ...]]:
    """Return a row for each bearing: the slips, and how they end at all levels."""
    found = []
    for name, bearing in bearings().items():
        overlap = bearing.resolved()["slip_capacity"]
        row = [name, f"{1e3 * bearing.slip_stability:.1f}", f"{1e3 * overlap:.0f}"]
        for share in SHARES:
            ends = [end(bearing, share, level) for level in LEVELS]
            slips = ", ".join(f"{1e3 * slip:.1f}" for _, slip in ends)
            row += [slips, ", ".join(f"`{status}`" for status, _ in ends)]
        found.append(tuple(row))
    return found


HEAD = (
    "bearing",
    "stable limit of interface slip [mm]",
    "overlap [mm]",
    *(part for share in SHARES for part in (f"{share:g} of it [mm]", "ends")),
)
