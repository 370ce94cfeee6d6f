"""LIR-DCFPs and DCFPs of equal plan, each at its best: the devices.

The plan is the diameter of the dish under the bearing with the largest slider, ``2 (D R / L + a)``.
All bearings of a building have the same way to their rims; an interface slips as far as the
smallest slider lets it, its overlap, for a diaphragm moves all bearings alike.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from frames.risk import Campaign
from validation.measurements.yielding_runs import (
    LIR,
    RIMS,
    WIDE,
    bearings_of,
    model_of,
    structures,
)
from validation.study.records_runs import STEP, STRUCTURE
from validation.study.rims_runs import BREAKS, ENDLESS, MORE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from frames import Frame, GroundMotion
    from lir_element import LIRBearing

SOFT = 0.1
"""Stiffness of soft rims over the default."""

RIM = 1.0
"""Strength of the rims of the LIR-DCFPs that are searched, over the design load."""

HIGHER = 0.01
"""What sliders are higher by, as often as the plates would touch at rest [m]."""


class Device(NamedTuple):
    """A device of a plan: its sliders, its interface, its rims."""

    plan: float  # diameter of the dish under the centre bearing [m]
    plain: bool
    more: float = 0.0  # radius that all sliders have more than their load asks [m]
    least: float = 0.0  # radius that no slider is below [m]
    interface: float = 0.0  # friction; of plain bearings without meaning
    strength: float | None = RIM  # of a rim over the design load; None: never yields nor breaks
    soft: bool = False  # rims of a tenth of the stiffness, which break where the default ones do

    @property
    def name(self) -> str:
        """How tables call it."""
        rims = "rims that never break" if self.strength is None else f"rims of {self.strength:g} W"
        rims = "soft rims" if self.soft else rims
        plan = f"{1e3 * self.plan:.0f} mm"
        if self.plain:
            return f"DCFP {plan}, {rims}"
        more = f", sliders {1e3 * self.more:+.0f} mm" if self.more else ""
        least = f", sliders of at least {1e3 * self.least:.0f} mm" if self.least else ""
        return f"LIR-DCFP {plan}{more}{least}, mu_h {self.interface:.3f}, {rims}"


def own_bearings() -> list[LIRBearing]:
    """Return the bearings of the study's building, their sliders as their loads ask."""
    return list(bearings_of(STRUCTURE).values())


def slider_of(own: LIRBearing, device: Device) -> float:
    """Return the radius of the slider that a device has in the place of a bearing [m]."""
    return max(own.slider_radius + device.more, device.least)


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
        "rim_stiffness": options["rim_stiffness"] * (SOFT if device.soft else 1.0),
        "rim_overrun": ENDLESS if device.strength is None else BREAKS,
    }
    if device.soft:
        changes["rim_overrun"] = options["rim_overrun"]
    elif device.strength is not None:
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


LEAST, MOST = -0.02, 0.15
"""Of the plans of the search: radii by which dishes exceed those of the study's bearings [m]."""

SEARCHED = (0.0, MORE, MOST)
"""Radii by which the dishes exceed those of the study's bearings where a device is searched [m]."""

COMPARED = (*SEARCHED, 0.22)
"""The same of all plans compared; the largest has the device that the work by hand names."""

REFERENCE = MORE
"""That of the plan which is the example."""

STRENGTHS = (None, 1.0, 0.5)
"""Of the rims of the DCFPs, over the design load."""

STRIPES = (1.6, 2.2, 2.6, 3.2, 4.2)
"""Intensities at which devices are compared [m/s2]."""


OTHERS = "rims that never break", "rims of 1 W", "rims of 0.5 W", "no rims"
"""DCFPs, by their rims."""

HALF_STRIPES = (2.6, 3.2)
"""Those at which devices are varied, and run at the level `contact`."""


def plain_devices(plan: float) -> dict[str, Device]:
    """Return the DCFPs of a plan: sliders as small as the pressure allows, so that all is way."""
    return {
        name: Device(plan, True, strength=strength)
        for name, strength in zip(OTHERS[:3], STRENGTHS, strict=True)
    }


def soft_device() -> Device:
    """Return the DCFP of the study's plan whose rims are ten times softer."""
    return Device(plan_of(0.0), True, soft=True)


BY_LOAD = "sliders by load, 60 mm more"
"""How a variant of the best LIR-DCFP is called."""


def varied_devices(best: Device) -> dict[str, Device]:
    """Return a LIR-DCFP with other rims, another interface, and with sliders as their loads ask."""
    own = own_bearings()[0]
    smallest = min(each.slider_radius for each in own_bearings()) + MORE
    share = (best.interface - own.effective_friction) / best.least
    return {
        "rims of 0.5 W": best._replace(strength=0.5),
        "rims that never break": best._replace(strength=None),
        "mu_h further above mu_e by half": best._replace(
            interface=own.effective_friction + 1.5 * share * best.least
        ),
        BY_LOAD: best._replace(
            least=0.0, more=MORE, interface=own.effective_friction + share * smallest
        ),
    }


def campaign_of(
    devices: Sequence[Device], motions: Mapping[str, GroundMotion], store: Path
) -> Campaign:
    """Return the campaign of devices at all stripes."""
    frames = {device.name: frame_of(device) for device in devices}
    return Campaign(frames, dict(motions), store=store, scales=list(STRIPES), dt=STEP)


def free_campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return that of DCFPs without rims: until one leaves its dish, its plan changes nothing."""
    frame = model_of(structures()[STRUCTURE], WIDE)
    return Campaign({WIDE: frame}, dict(motions), store=store, scales=list(STRIPES), dt=STEP)


def half_campaign(
    devices: Sequence[Device],
    motions: Mapping[str, GroundMotion],
    store: Path,
    level: str = "pendulum",
) -> Campaign:
    """Return that of devices under every second record at few stripes, at a level of fidelity."""
    frames = {device.name: frame_of(device) for device in devices}
    return Campaign(
        frames,
        dict(list(motions.items())[::2]),
        store=store,
        scales=list(HALF_STRIPES),
        dt=STEP,
        level=level,
    )


def best_devices() -> dict[str, Device]:
    """Return the LIR-DCFP and the DCFPs by their rims of the plan that is the example."""
    plan = plan_of(REFERENCE)
    lir = Device(plan, False, least=0.1527, interface=0.20)
    plain = [Device(plan, True, strength=strength) for strength in (None, 2.0, 1.0, 0.5)]
    return {LIR: lir} | {
        each.name.replace(f"DCFP {1e3 * plan:.0f} mm", "DCFP"): each for each in plain
    }
