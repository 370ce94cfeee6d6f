"""LIR-DCFPs and DCFPs of equal plan that several parts of the study compare.

The plan is the diameter of the dish under the bearing with the largest slider, ``2 (D R / L + a)``.
All bearings of a building have the same way to their rims; an interface slips as far as the
smallest slider lets it, its overlap, for a diaphragm moves all bearings alike.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from validation.measurements.yielding_runs import (
    LIR,
    RIMS,
    bearings_of,
    model_of,
    structures,
)
from validation.study.records_runs import STRUCTURE
from validation.study.rims_runs import BREAKS, ENDLESS, MORE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames import Frame
    from lir_element import LIRBearing

RIM = 1.0
"""Strength of the rims of LIR-DCFPs, over the design load."""

HIGHER = 0.01
"""What sliders are higher by, as often as the plates would touch at rest [m]."""


class Device(NamedTuple):
    """A device of a plan: its sliders, its interface, its rims."""

    plan: float  # diameter of the dish under the centre bearing [m]
    plain: bool
    least: float = 0.0  # radius that no slider is below [m]
    interface: float = 0.0  # friction; of plain bearings without meaning
    strength: float | None = RIM  # of a rim over the design load; None: never yields nor breaks


def own_bearings() -> list[LIRBearing]:
    """Return the bearings of the study's building, their sliders as their loads ask."""
    return list(bearings_of(STRUCTURE).values())


def slider_of(own: LIRBearing, device: Device) -> float:
    """Return the radius of the slider that a device has in the place of a bearing [m]."""
    return max(own.slider_radius, device.least)


def reach_of(device: Device, bearings: Iterable[LIRBearing]) -> float:
    """Return the way from the centre to the rim in all dishes [m]: what the plan leaves to it."""
    return 0.5 * device.plan - max(slider_of(own, device) for own in bearings)


def shape_of(plan: float, own: LIRBearing) -> tuple[float, float]:
    """Return radius of the dishes and height of the sliders [m]: of a plan, with the length L.

    The dishes rise towards their edges. Where both together would rise by more than the sliders are
    high the plates touch at rest: the sliders are higher, and the radius is larger by half of that.
    """
    (radius, _), height = own.radii, own.slider_height
    while 2.0 * (radius - math.sqrt(radius**2 - 0.25 * plan**2)) >= height:
        height += HIGHER
        radius = 0.5 * (own.effective_radius + height)
    return radius, height


def bearing_of(own: LIRBearing, device: Device, reach: float) -> LIRBearing:
    """Return the bearing of a device in the place of one whose slider is as its load asks."""
    options = own.resolved()
    radius, height = shape_of(device.plan, own)
    changes: dict[str, Any] = {
        "radius": radius,
        "slider_height": height,
        "slider_radius": slider_of(own, device),
        "capacity": reach * own.effective_radius / radius,
        "rims": None,
        "design_load": options["design_load"],
        "rim_stiffness": options["rim_stiffness"],
        "rim_overrun": ENDLESS if device.strength is None else BREAKS,
    }
    if device.strength is not None:
        changes["rim_yield_force"] = device.strength * options["design_load"]
    if not device.plain:
        changes["interface_friction"] = device.interface
    return replace(own.as_dcfp() if device.plain else own, **changes)


def frame_of(device: Device) -> Frame:
    """Return the study's building on a device."""
    frame = model_of(structures()[STRUCTURE], RIMS if device.plain else LIR)
    own = {name: link.bearing for name, link in frame.bearings.items()}
    reach = reach_of(device, own.values())
    return frame.with_bearings(
        {name: bearing_of(each, device, reach) for name, each in own.items()}
    )


def plan_of(more: float) -> float:
    """Return the plan whose dishes exceed those of the study's bearings by a radius [m]."""
    own = own_bearings()
    return 2.0 * (own[0].rim_displacement[0] + max(each.slider_radius for each in own) + more)


REFERENCE = MORE
"""That of the plan which is the example."""


def best_devices() -> dict[str, Device]:
    """Return the LIR-DCFP and the DCFPs by their rims of the plan that is the example.

    The LIR-DCFP has the largest friction of its interface that passes `device_checks`.
    """
    plan = plan_of(REFERENCE)
    found = {LIR: Device(plan, False, least=0.1527, interface=0.142)}
    for strength in (None, 2.0, 1.0, 0.5):
        rims = "rims that never break" if strength is None else f"rims of {strength:g} W"
        found[f"DCFP, {rims}"] = Device(plan, True, strength=strength)
    return found
