"""Devices under a whole building: its bearings sized by loads, plan or moat, and their checks."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

from frames.design.devices.device import device_checks
from frames.risk._errors import CampaignError
from frames.statics.gravity import gravity
from lir_element import BackupSupport
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames.design.calculation.check import Check
    from frames.design.devices.limits import DesignLimits
    from frames.frame import Frame
    from lir_element import LIRBearing

HIGHER = 0.01
"""Step in which sliders are raised until the plates do not touch at rest [m]."""

_LENGTH = number("m", "(0, 5)")


@dataclass(frozen=True, kw_only=True)
class Device:
    """Differences of a device's bearings from those of a building.

    Without plan, capacity and moat the concave plates stay: a smaller slider has a larger
    displacement in them. With one of them all bearings have the same rim displacement. If plates
    would touch at rest, their sliders are higher in steps of 10 mm, with an unchanged pendulum
    length.

    Parameters
    ----------
    kind : {"LIR-DCFP", "DCFP"}
        Slider in two pieces, or rigid.
    pressure : float, optional
        Pressure on each slider under the load of its bearing at rest [Pa]: it gives radius and
        design load.
    slider_radius : float, optional
        Radius of all sliders [m].
    wider : float
        Radius of each slider beyond that for its load [m].
    least_slider_radius : float, optional
        Radius that no slider is below [m].
    plan : float, optional
        Diameter of the largest dish of the building [m].
    capacity : float, optional
        Displacement at the first rim contact [m]; ``math.inf`` without rims.
    moat : float, optional
        Displacement at the failure of the first bearing [m]: `moat_of`.
    interface_friction : float, optional
        Friction of the interface of an LIR-DCFP [-].
    rims : float, optional
        Force at which rims yield over the design load [-]; ``math.inf``: they never yield nor
        break. Default: as the bearings have them.
    equal_sliders : bool
        True if all sliders are as wide as the widest one for a load.
    more_plan : float, optional
        Plate diameter beyond that of the bearings, with their rim displacement around the widest
        slider for a load [m]: instead of plan, for several structures.
    rim_stiffness : float
        Stiffness of the rims over that of the bearings [-].
    rim_overrun : float, optional
        Deformation at which a rim breaks [m].
    backup : BackupSupport, optional
        Support after the failure of a bearing.

    Raises
    ------
    CampaignError
        If a number is out of its bounds, or two of them exclude each other.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Device
    >>> frame, _ = example()
    >>> device = Device(kind="DCFP", plan=0.6, rims=1.0, rim_overrun=0.02)
    >>> bearing = next(iter(device.on(frame).bearings.values())).bearing
    >>> bearing.is_dcfp, round(bearing.lateral_capacity, 3)
    (True, 0.285)
    """

    kind: Literal["LIR-DCFP", "DCFP"] = "LIR-DCFP"
    pressure: float | None = field(default=None, metadata=number("Pa", "[1e5, 1e10)"))
    slider_radius: float | None = field(default=None, metadata=_LENGTH)
    wider: float = field(default=0.0, metadata=number("m", "[0, 5)"))
    least_slider_radius: float | None = field(default=None, metadata=_LENGTH)
    plan: float | None = field(default=None, metadata=_LENGTH)
    capacity: float | None = field(default=None, metadata=number("m", "(0, inf]"))
    moat: float | None = field(default=None, metadata=_LENGTH)
    interface_friction: float | None = field(default=None, metadata=number("-", "(0, 1)"))
    rims: float | None = field(default=None, metadata=number("-", "(0, inf]"))
    equal_sliders: bool = False
    more_plan: float | None = field(default=None, metadata=number("m", "(-5, 5)"))
    rim_stiffness: float = field(default=1.0, metadata=number("-", "(0, 100)"))
    rim_overrun: float | None = field(default=None, metadata=number("m", "(0, 5)"))
    backup: BackupSupport | None = None

    def __post_init__(self) -> None:
        check_numbers(self, error=CampaignError)
        named = "plan", "more_plan", "capacity", "moat"
        sizes = [name for name in named if getattr(self, name) is not None]
        if len(sizes) > 1:
            msg = f"{' and '.join(sizes)} are given: each sets the capacity, leave one"
            raise CampaignError(msg)
        if self.slider_radius is not None and (self.wider or self.least_slider_radius):
            msg = "slider_radius sets all sliders: leave wider and least_slider_radius out"
            raise CampaignError(msg)
        if self.kind == "DCFP" and self.interface_friction is not None:
            msg = "interface_friction applies to an LIR-DCFP: leave it out of a DCFP"
            raise CampaignError(msg)
        if self.rims == math.inf and self.rim_overrun is not None:
            msg = "rims that are unbreakable have no rim_overrun: leave it out"
            raise CampaignError(msg)

    def on(self, frame: Frame) -> Frame:
        """Return a building on the device."""
        own, device = self._loaded(frame), self
        widest = max(each.slider_radius for each in own.values())
        if self.equal_sliders:
            device = replace(device, least_slider_radius=widest, equal_sliders=False)
        if self.more_plan is not None:
            ways = [max(link.bearing.rim_displacement) for link in frame.bearings.values()]
            plan = 2.0 * (max(ways) + widest) + self.more_plan
            device = replace(device, plan=plan, more_plan=None)
        return device._on(frame, own)

    def _on(self, frame: Frame, own: Mapping[str, LIRBearing]) -> Frame:
        # Bearings with sliders for their loads.
        sliders = {name: self._slider(each) for name, each in own.items()}
        sized = self._sized(own, sliders)
        return frame.with_bearings(
            {name: self._bearing(each, sized[name]) for name, each in own.items()}
        )

    def _loaded(self, frame: Frame) -> dict[str, LIRBearing]:
        # The bearings with sliders for their loads.
        own = {name: link.bearing for name, link in frame.bearings.items()}
        for name, each in own.items():
            if self.kind == "LIR-DCFP" and each.is_dcfp:
                msg = f"bearing {name} has a rigid slider: set its interface_friction"
                raise CampaignError(msg)
        if self.pressure is None:
            return own
        found = {}
        for (name, each), load in zip(own.items(), gravity(frame).axial_forces, strict=True):
            radius = math.sqrt(float(load) / (math.pi * self.pressure))
            # rounded: columns that mirror each other carry the same
            radius, load = float(f"{radius:.9g}"), float(f"{load:.9g}")
            found[name] = replace(
                each, **_dish(each, radius), slider_radius=radius, design_load=load
            )
        return found

    def _slider(self, own: LIRBearing) -> float:
        wanted = self.slider_radius or own.slider_radius + self.wider
        return max(wanted, self.least_slider_radius or 0.0)

    def _sized(
        self, own: Mapping[str, LIRBearing], sliders: Mapping[str, float]
    ) -> dict[str, dict[str, Any]]:
        # Sliders, and the rim displacement: of the existing plates, or the same in all.
        if self.plan is None and self.capacity is None and self.moat is None:
            return {
                name: {"slider_radius": sliders[name], **_dish(each, sliders[name])}
                for name, each in own.items()
            }
        shapes = {(each.radii, each.slider_height): each for each in own.values()}
        if len(shapes) > 1 and self.plan is not None:
            msg = "plan needs bearings of one radius and height, these differ: set capacity instead"
            raise CampaignError(msg)
        widest, beyond = max(sliders.values()), self._beyond(own, sliders)
        dishes = {shape: self._dishes(each, widest, beyond) for shape, each in shapes.items()}
        return {
            name: {"slider_radius": sliders[name], **dishes[each.radii, each.slider_height]}
            for name, each in own.items()
        }

    def _dishes(self, own: LIRBearing, widest: float, last: tuple[float, float]) -> dict[str, Any]:
        # Radii, height and capacity; plates that would touch at rest have higher sliders.
        (bottom, top), height = own.radii, own.slider_height
        length, given = own.effective_radius, 1e3 * (self.plan or self.moat or 0.0)
        while True:
            reach, beyond = self.capacity or 0.0, last[0] + _bent((bottom, top), length, last[1])
            if self.moat is not None:
                reach = self.moat - beyond
            elif self.plan is not None:
                reach = (0.5 * self.plan - widest) * length / max(bottom, top)
            if not reach > 0.0:
                name = "plan" if self.moat is None else "moat"
                msg = f"{name} = {given:g} mm leaves no capacity before the rims: give more than "
                msg += f"{1e3 * (2.0 * widest if self.moat is None else beyond):.0f} mm"
                raise CampaignError(msg)
            edges = [(reach * radius / length + widest, radius) for radius in (bottom, top)]
            if math.isfinite(reach) and any(edge >= radius for edge, radius in edges):
                msg = f"a capacity of {1e3 * reach:.0f} mm is beyond the dishes, whose radius is "
                msg += f"{bottom:g} m: reduce it"
                raise CampaignError(msg)
            rise = 0.0 if math.isinf(reach) else sum(r - math.sqrt(r**2 - e**2) for e, r in edges)
            if rise < height:
                found = {"radius": (bottom, top), "slider_height": height}
                return {**found, "capacity": reach, "rims": None}
            height, bottom, top = height + HIGHER, bottom + 0.5 * HIGHER, top + 0.5 * HIGHER

    def _beyond(
        self, own: Mapping[str, LIRBearing], sliders: Mapping[str, float]
    ) -> tuple[float, float]:
        # Of the first bearing to fail: slip, or deformation at which its rims break.
        if self.kind == "LIR-DCFP":
            return min(each.slip_capacity or sliders[name] for name, each in own.items()), 0.0
        if self.rims == math.inf:
            return 0.0, 0.0
        given = self.rim_overrun
        return 0.0, min(given or each.resolved()["rim_overrun"] for each in own.values())

    def _bearing(self, own: LIRBearing, sized: Mapping[str, Any]) -> LIRBearing:
        # The rims are those of the bearing for all sliders, except for given values.
        options = own.resolved()
        changes: dict[str, Any] = {**sized, "design_load": options["design_load"]}
        if self.kind == "DCFP":
            changes["interface_friction"] = math.inf
        elif self.interface_friction is not None:
            changes["interface_friction"] = self.interface_friction
        if self.backup is not None:
            changes["backup"] = self.backup
        if math.isfinite(changes.get("capacity") or own.lateral_capacity):
            changes["rim_stiffness"] = options["rim_stiffness"] * self.rim_stiffness
            changes["rim_damping"] = options["rim_damping"] * math.sqrt(self.rim_stiffness)
            changes["rim_overrun"] = self.rim_overrun or options["rim_overrun"]
            if self.rims is not None:
                changes["rim_yield_force"] = self.rims * options["design_load"]
            if self.rims == math.inf:  # the slider has left the sphere before
                changes["rim_overrun"] = max(changes.get("radius", own.radii))
        return replace(own, **changes)


def _dish(own: LIRBearing, slider: float) -> dict[str, Any]:
    # Rims of the same dish around another slider.
    if slider == own.slider_radius or math.isinf(own.lateral_capacity):
        return {}
    more = own.slider_radius - slider
    bottom, top = own.rim_displacement
    if min(bottom, top) + more <= 0.0:
        msg = f"slider_radius = {1e3 * slider:.0f} mm fills its dish: set plan or capacity"
        raise CampaignError(msg)
    return {"capacity": None, "rims": (bottom + more, top + more)}


def _bent(radii: tuple[float, float], length: float, overrun: float) -> float:
    # Displacement beyond the first rim contact at which the rims of both plates are bent so far.
    return 2.0 * overrun * length / sum(radii)


def moat_of(bearings: Iterable[LIRBearing]) -> float:
    """Return the displacement at which the first bearing of a building fails [m].

    The rim displacement plus the slip capacity of the sliders, or plus the way on which the rims
    of both plates bend until they break; the rim displacement if there is no such limit, as for
    unbreakable rims. Rims that break one after the other end the way earlier.
    """
    found = []
    for each in bearings:
        options = each.resolved()
        overrun, reach = options["rim_overrun"], each.lateral_capacity
        broken = _bent(each.radii, each.effective_radius, overrun) * (overrun < max(each.radii))
        found.append(reach + (broken if each.is_dcfp else options["slip_capacity"]))
    return min(found)


def device_ratios(frame: Frame, limits: DesignLimits | None = None) -> dict[str, Check]:
    """Return the governing check of `device_checks` of each LIR-DCFP of a building, by its name.

    The slip is that at the failure of the first bearing: one diaphragm moves all equally.
    Properties are nominal.
    """
    own = {name: link.bearing for name, link in frame.bearings.items()}
    own = {name: each for name, each in own.items() if not each.is_dcfp}
    slip = min((each.resolved()["slip_capacity"] for each in own.values()), default=0.0)
    found: dict[LIRBearing, Check] = {}  # columns that mirror each other have equal bearings
    for each in dict.fromkeys(own.values()):
        load = each.resolved()["design_load"]
        found[each] = device_checks(each, (load, load), slip=slip, limits=limits).governing
    return {name: found[each] for name, each in own.items()}


def highest_ratio(frame: Frame) -> float:
    """Return the largest ratio of `device_ratios` [-]: at most 1 if its LIR-DCFPs pass."""
    return max((check.ratio for check in device_ratios(frame).values()), default=0.0)
