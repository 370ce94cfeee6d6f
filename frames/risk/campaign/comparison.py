"""Devices of a campaign under the same records: ratios of medians, collapse margins, sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pandas as pd

from frames.design.hazard.code_rules import damping_factor
from frames.results.quantities import QUANTITIES
from frames.risk._errors import CampaignError, FragilityError
from frames.risk.campaign.devices import Device
from frames.risk.campaign.ductility import DUCTILITY
from frames.risk.fragility.comparison import compare_fragility
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.paired_tests import ALL, paired_tests
from frames.risk.fragility.risk import collapse_margin_ratio
from frames.risk.fragility.runs import UNKNOWN
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.frame import Frame
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.runs import IntensityRuns
    from lir_element import LIRBearing

LIR, PLAIN, SAME_PLAN, LARGER = "LIR-DCFP", "DCFP", "DCFP of the same plan", "larger DCFP"
OTHERS = PLAIN, SAME_PLAN, LARGER
"""Devices of the comparison with an LIR-DCFP."""

TESTED = "more", "less", "p", "q", "verdict"
"""Columns of exact tests beside a ratio."""

Strength = float | Literal["unbreakable"]
"""Strength of rims: yield force over the design load [-], or unbreakable."""


class ComparedDevices:
    """Devices of a comparison: the part of ``[compare]`` that makes them."""

    devices: tuple[str, ...]  # of `OTHERS`
    # strengths of the rims over the design load, each of which all devices with rims have; empty:
    # the rims of the bearing
    rims: tuple[Strength, ...]
    slider_radius: float | None  # of the DCFP of the same plan [m]
    larger: float | None  # capacity of the larger DCFP [m]; None: it has no rims

    def frames(self, frame: Frame) -> dict[str, Frame]:
        """Return the structure on each device."""
        for name, link in frame.bearings.items():
            if link.bearing.is_dcfp or math.isinf(link.bearing.lateral_capacity):
                lacking = "a rigid slider" if link.bearing.is_dcfp else "no rims"
                msg = f"bearing {name} has {lacking}: set its interface_friction and capacity"
                raise CampaignError(msg)
        made = {LIR: Device()} | {n: self._device(n, frame) for n in OTHERS if n in self.devices}
        found: dict[str, Frame] = {}
        for name, device in made.items():
            for strength in self.rims or (None,):
                kept = None if name == LARGER and self.larger is None else strength  # has no rims
                rims = math.inf if isinstance(kept, str) else kept  # unbreakable
                found.setdefault(_named(name, kept), replace(device, rims=rims).on(frame))
        return found

    def by_rims(self) -> dict[str, list[str]]:
        """Return the names of devices with the same rims, the LIR-DCFP first, by their rims."""
        found = {}
        for strength in self.rims or (None,):
            names = [LIR, *(name for name in OTHERS if name in self.devices)]
            found[_rims(strength) if strength is not None else "rims of the bearing"] = [
                _named(n, None if n == LARGER and self.larger is None else strength) for n in names
            ]
        return found

    def _device(self, name: str, frame: Frame) -> Device:
        # Differences of a DCFP from the LIR-DCFP; that of the same plate diameter has smaller
        # sliders.
        if name == PLAIN:
            return Device(kind="DCFP")
        bearings = [link.bearing for link in frame.bearings.values()]
        least, own = self.slider_radius or 0.0, min(each.slider_radius for each in bearings)
        if name == SAME_PLAN and not 0.0 < least < own:
            msg = (
                f"slider_radius = {1e3 * least:g} mm of a DCFP of the same plan must be below the "
                f"{1e3 * own:g} mm of the LIR-DCFP: reduce it"
            )
            raise CampaignError(msg)
        if name == SAME_PLAN:
            return Device(kind="DCFP", slider_radius=least)
        capacity = max(each.lateral_capacity for each in bearings)
        if self.larger is not None and self.larger <= capacity:
            msg = (
                f"larger = {1e3 * self.larger:g} mm must be above the capacity of the bearing, "
                f"{1e3 * capacity:g} mm: raise it"
            )
            raise CampaignError(msg)
        return Device(kind="DCFP", capacity=self.larger or math.inf)


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


COLLAPSE = "collapse"


def overlap_limit(share: float) -> LimitState:
    """Return a slip of the interface above a share of the overlap of its sliders [-]."""
    title = f"{QUANTITIES['slip'].title} over overlap"
    return LimitState(f"slip {100.0 * share:g} % of the overlap", title, share)


def collapse_limit(drift: float | None, ductility: float | None = None) -> LimitState:
    """Return collapse: failure of a bearing or, if one is given, drift or ductility beyond it."""
    if ductility is not None:
        return LimitState(COLLAPSE, DUCTILITY, ductility)
    if drift is None:
        return LimitState(COLLAPSE)
    return LimitState(COLLAPSE, LimitState.drift(drift).quantity, drift)


def filling_intensity(bearing: LIRBearing, period: float) -> float:
    """Return the Sa of the maximum considered earthquake that fills a bearing's capacity [m/s2].

    Its displacement by ASCE 7-22, equation 17.5-1, on the nominal bearing is the capacity: the
    one-second spectrum ``S_M1 / T`` that this needs, at a period.
    """
    displacement = bearing.lateral_capacity
    friction, length = bearing.effective_friction, bearing.effective_radius
    stiffness = 1.0 / length + friction / displacement  # over the weight, 1/m
    effective = 2.0 * math.pi / math.sqrt(STANDARD_GRAVITY * stiffness)
    damping = 2.0 / math.pi * friction / (friction + displacement / length)
    factor = damping_factor("ASCE 7-22", damping)
    return displacement * 4.0 * math.pi**2 * factor / (effective * period)


@dataclass(frozen=True, kw_only=True, eq=False)
class DeviceComparison:
    """Results of a campaign on devices under the same records."""

    frames: Mapping[str, Frame]  # the structure on each device
    # devices with the same rims, the LIR-DCFP first, by their rims
    groups: Mapping[str, Sequence[str]]
    collapse: LimitState  # definition of collapse
    # intensity of the maximum considered earthquake, in the unit of the curves; None: it is not
    # known, and there are no margins
    considered: float | None
    filling: bool  # whether that is the one that fills the capacity, and none that was given
    structures: Mapping[str, str] = field(default_factory=dict)  # by group, if there are several

    def ratios(
        self,
        curves: Mapping[str, Mapping[str, Fragility]],
        limits: Sequence[LimitState],
        tests: pd.DataFrame,
        confidence: float,
    ) -> pd.DataFrame:
        """Return the median of the LIR-DCFP over that of each other device, limit by limit."""
        whole = tests[tests["scale"] == ALL].set_index(["measure", "own", "over"])
        rows = []
        for limit in (each.name for each in limits):
            own = curves.get(limit, {})
            for rims, (first, *others) in self.groups.items():
                for other in others:
                    structure = self.structures.get(rims, "")
                    row: dict[str, object] = {"structure": structure} if structure else {}
                    row |= {"limit state": limit, "rims": rims.removeprefix(f"{structure}, ")}
                    row |= {"own": first, "over": other}
                    row |= _ratio(own.get(first), own.get(other), confidence)
                    row |= whole.loc[(limit, first, other), list(TESTED)].to_dict()
                    rows.append(row)
        return pd.DataFrame(rows)

    def tests(
        self, runs: Mapping[str, IntensityRuns], limits: Sequence[LimitState]
    ) -> pd.DataFrame:
        """Return exact tests of the LIR-DCFP against each other device with the same rims."""
        pairs = [(own, other) for own, *others in self.groups.values() for other in others]
        return paired_tests(runs, pairs, limits)

    def margins(
        self,
        runs: Mapping[str, IntensityRuns],
        curves: Mapping[str, Fragility],
        reasons: Mapping[str, str],
        confidence: float,
    ) -> pd.DataFrame:
        """Return median, dispersion and margin against collapse of each device."""
        rows: dict[str, dict[str, object]] = {}
        for name, each in runs.items():
            exceeded = each.exceeded(self.collapse)
            outcome = each.of("outcome")
            row: dict[str, object] = {
                "runs": len(outcome),
                "collapsed": int(np.nansum(exceeded)),
                "bearing failed": int(np.nansum(each.exceeded(LimitState.bearing_failure()))),
                "analysis failed": int((outcome == UNKNOWN).sum()),
            }
            if name in curves:
                row |= self._numbers(curves[name], confidence)
            rows[name] = row | {"no curve": reasons.get(name, "")}
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("device")

    def _numbers(self, curve: Fragility, confidence: float) -> dict[str, object]:
        interval = curve.interval(confidence)
        ends = {part: float(interval.loc["median", part]) for part in ("value", "low", "high")}
        row: dict[str, object] = {
            f"median{word} [{curve.unit}]": ends[part]
            for part, word in (("value", ""), ("low", ", low"), ("high", ", high"))
        }
        row["dispersion [-]"] = curve.dispersion
        if self.considered is not None:
            row |= {
                f"margin{word} [-]": collapse_margin_ratio(ends[part], self.considered)
                for part, word in (("value", ""), ("low", ", low"), ("high", ", high"))
            }
        return row

    def sizes(self, runs: Mapping[str, IntensityRuns]) -> pd.DataFrame:
        """Return the devices: of each the bearing with the largest dish."""
        rows = {}
        for name, frame in self.frames.items():
            bearing = max(
                (link.bearing for link in frame.bearings.values()),
                key=lambda each: (each.slider_radius, each.resolved()["design_load"]),
            )
            reached = runs[name].demand("bearing displacement")
            largest = float(reached[np.isfinite(reached)].max(initial=0.0))
            has_rims = math.isfinite(bearing.lateral_capacity)
            rows[name] = {
                "slider radius [m]": bearing.slider_radius,
                "interface friction [-]": bearing.interface_friction,
                "capacity [m]": bearing.lateral_capacity,
                "rims yield at [N]": bearing.rim_yield_force if has_rims else math.nan,
                "rims break at [N]": _breaks_at(bearing) if has_rims else math.nan,
                "largest displacement [m]": largest,
                "dish diameter [m]": dish_diameter(bearing, None if has_rims else largest),
            }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("device")


def _breaks_at(bearing: LIRBearing) -> float:
    # Elastic up to the yield force, then hardening, until the deformation at failure.
    options = bearing.resolved()
    if options["rim_overrun"] >= max(bearing.radii):
        return math.inf
    stiffness, limit = options["rim_stiffness"], options["rim_overrun"]
    elastic = min(limit, bearing.rim_yield_force / stiffness)
    return stiffness * (elastic + bearing.rim_hardening * (limit - elastic))


def _ratio(own: Fragility | None, other: Fragility | None, confidence: float) -> dict[str, Any]:
    row: dict[str, Any] = dict.fromkeys(("ratio [-]", "low [-]", "high [-]"), math.nan)
    if own is None or other is None:
        lacking = [word for word, c in ((LIR, own), ("the other", other)) if c is None]
        return row | {"no ratio": f"no curve of {' and '.join(lacking)}"}
    try:
        found = compare_fragility(other, own).to_dataframe(confidence).loc["median, ratio [-]"]
    except FragilityError as cause:
        return row | {"no ratio": str(cause)}
    ends = (float(found[key]) for key in ("value", "low", "high"))
    return dict(zip(row, ends, strict=True)) | {"no ratio": ""}
