"""The paper's bearings, as its sections give them, and the levels that the claims are run at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lir_element import CoulombFriction, LIRBearing, VelocityFriction

if TYPE_CHECKING:
    from lir_element.element import AnyLevel

LEVELS_STATIC: tuple[AnyLevel, ...] = ("pendulum", "contact", "rigid_body")
"""Levels of the static cyclic test."""

LEVELS_HISTORY: tuple[AnyLevel, ...] = ("rigid_body", "contact", "pendulum")
"""Levels of the numerical example."""

LEVELS_DRIFT: tuple[AnyLevel, ...] = ("pendulum", "rigid_body")
"""Levels at which the drift under Bouc-Wen friction is followed through the numerical example."""

EXAMPLE_MASS = 204e3
"""Mass on the bearing of the numerical example [kg] (section 3.1)."""

EXAMPLE_RECORD = "RSN1044_NORTHR_NWH360.AT2"
"""PEER file of the numerical example: Newhall, Northridge 1994, 360."""


def static_bearing() -> LIRBearing:
    """Return the bearing of the static cyclic test (section 2.2); slider radius assumed."""
    return LIRBearing(
        radius=0.75,
        slider_height=0.085,
        slider_radius=0.08,
        capacity=0.175,
        friction=CoulombFriction(0.066),
        interface_friction=0.126,
    )


def example_bearing(**changes: Any) -> LIRBearing:
    """Return the bearing of the numerical example (section 3.1); slider radius assumed."""
    options: dict[str, Any] = {
        "radius": 1.185,
        "slider_height": 0.12,
        "slider_radius": 0.15,
        "capacity": 0.25,
        "friction": VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
        "interface_friction": 0.13,
    }
    return LIRBearing(**{**options, **changes})
