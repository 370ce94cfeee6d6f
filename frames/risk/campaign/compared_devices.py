"""Devices that a campaign compares: LIR-DCFPs and plain DCFPs, their rims by strength."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from frames.risk._errors import CampaignError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames.frame import Frame
    from lir_element import LIRBearing

LIR, PLAIN, SAME_PLAN, LARGER = "LIR-DCFP", "DCFP", "DCFP of the same plan", "larger DCFP"
OTHERS = PLAIN, SAME_PLAN, LARGER
"""What an LIR-DCFP is compared with."""

Strength = float | Literal["unbreakable"]
"""Of rims: force at which they yield over the design load [-], or what never yields nor breaks."""


@dataclass(frozen=True, kw_only=True)
class ComparedDevices:
    """Which devices are compared."""

    others: Sequence[str]  # of `OTHERS`
    # strengths of the rims over the design load, each of which all devices with rims have; empty:
    # the rims of the bearing
    rims: Sequence[Strength] = ()
    slider_radius: float | None = None  # of the DCFP of the same plan [m]
    larger: float | None = None  # capacity of the larger DCFP [m]; None: it has no rims

    def frames(self, frame: Frame) -> dict[str, Frame]:
        """Return the structure on each device."""
        for name, link in frame.bearings.items():
            if link.bearing.is_dcfp or math.isinf(link.bearing.lateral_capacity):
                msg = (
                    f"bearing {name} has "
                    + ("a rigid slider" if link.bearing.is_dcfp else "no rims")
                    + ": what is compared with DCFPs is an LIR-DCFP; give interface_friction and "
                    "capacity"
                )
                raise CampaignError(msg)
        made: dict[str, Callable[[LIRBearing], LIRBearing]] = {LIR: lambda own: own}
        ways: dict[str, Callable[[LIRBearing], LIRBearing]] = {
            PLAIN: lambda own: own.as_dcfp(),
            SAME_PLAN: self._same_plan,
            LARGER: self._larger,
        }
        made |= {name: ways[name] for name in OTHERS if name in self.others}
        found: dict[str, Frame] = {}
        for name, make in made.items():
            for strength in self.rims or (None,):
                if name == LARGER and self.larger is None and strength is not None:
                    strength = None  # it has no rims
                devices = {
                    at: _with_rims(make(link.bearing), link.bearing, strength)
                    for at, link in frame.bearings.items()
                }
                found.setdefault(_named(name, strength), frame.with_bearings(devices))
        return found

    def groups(self) -> dict[str, list[str]]:
        """Return the names of devices with the same rims, the LIR-DCFP first, by their rims."""
        found = {}
        for strength in self.rims or (None,):
            names = [LIR, *(name for name in OTHERS if name in self.others)]
            found[_rims(strength) if strength is not None else "rims of the bearing"] = [
                _named(n, None if n == LARGER and self.larger is None else strength) for n in names
            ]
        return found

    def _same_plan(self, own: LIRBearing) -> LIRBearing:
        # Smaller sliders in the same dish: their edges meet the rims later.
        least = self.slider_radius or 0.0
        if not 0.0 < least < own.slider_radius:
            msg = (
                f"slider_radius = {1e3 * least:g} mm of a DCFP of the same plan must be below the "
                f"{1e3 * own.slider_radius:g} mm of the LIR-DCFP, whose sliders are larger for "
                "the slip"
            )
            raise CampaignError(msg)
        more = own.slider_radius - least
        bottom, top = own.rim_displacement
        return replace(
            own.as_dcfp(), slider_radius=least, capacity=None, rims=(bottom + more, top + more)
        )

    def _larger(self, own: LIRBearing) -> LIRBearing:
        if self.larger is None:
            return own.as_dcfp(rims=False)
        if self.larger <= own.lateral_capacity:
            msg = (
                f"larger = {1e3 * self.larger:g} mm must be above the capacity of the bearing, "
                f"{1e3 * own.lateral_capacity:g} mm"
            )
            raise CampaignError(msg)
        return replace(own.as_dcfp(), capacity=self.larger, rims=None)


def _with_rims(device: LIRBearing, own: LIRBearing, strength: Strength | None) -> LIRBearing:
    # The rims are those of the LIR-DCFP, whatever slides in them, with another strength.
    options = own.resolved()
    if math.isinf(device.lateral_capacity):
        return device
    same = replace(
        device,
        rim_stiffness=options["rim_stiffness"],
        rim_damping=options["rim_damping"],
        rim_overrun=options["rim_overrun"],
    )
    if strength is None:
        return same
    if isinstance(strength, str):  # unbreakable
        # before a rim deforms so far the slider has left the sphere
        return replace(same, rim_yield_force=math.inf, rim_overrun=max(own.radii))
    return replace(same, rim_yield_force=strength * options["design_load"])


def _rims(strength: Strength) -> str:
    return "unbreakable rims" if isinstance(strength, str) else f"rims of {strength:g} W"


def _named(name: str, strength: Strength | None) -> str:
    return name if strength is None else f"{name}, {_rims(strength)}"


def dish_diameter(bearing: LIRBearing, displacement: float | None = None) -> float:
    """Return the diameter of the larger dish of a bearing, its plan [m]."""
    reached = bearing.lateral_capacity if displacement is None else displacement
    slides = [reached * radius / bearing.effective_radius for radius in bearing.radii]
    if displacement is None:
        slides = list(bearing.rim_displacement)
    return 2.0 * (max(slides) + bearing.slider_radius)
