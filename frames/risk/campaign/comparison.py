"""Devices of a campaign under the same records: ratios of medians, collapse margins, sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.design.hazard.code_rules import damping_factor
from frames.risk._errors import FragilityError
from frames.risk.campaign.compared_devices import LIR, dish_diameter
from frames.risk.fragility.comparison import compare_fragility
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.risk import collapse_margin_ratio
from frames.risk.fragility.runs import UNKNOWN
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.frame import Frame
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.runs import IntensityRuns
    from lir_element import LIRBearing

COLLAPSE = "collapse"


def collapse_limit(drift: float | None) -> LimitState:
    """Return collapse: failure of a bearing or, if one is given, a storey drift beyond it."""
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
    """What a campaign says of devices under the same records."""

    frames: Mapping[str, Frame]  # the structure on each device
    # devices with the same rims, the LIR-DCFP first, by their rims
    groups: Mapping[str, Sequence[str]]
    collapse: LimitState  # what counts as collapse
    # intensity of the maximum considered earthquake, in the unit of the curves; None: it is not
    # known, and there are no margins
    considered: float | None
    filling: bool  # whether that is the one that fills the capacity, and none that was given

    def ratios(
        self, curves: Mapping[str, Mapping[str, Fragility]], confidence: float
    ) -> pd.DataFrame:
        """Return the median of the LIR-DCFP over that of each other device, limit by limit."""
        rows = []
        for limit, own in curves.items():
            for rims, (first, *others) in self.groups.items():
                for other in others:
                    row: dict[str, object] = {"limit state": limit, "rims": rims, "over": other}
                    row |= _ratio(own.get(first), own.get(other), confidence)
                    rows.append(row)
        return pd.DataFrame(rows)

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
            outcome = each.table["outcome"].to_numpy()
            row: dict[str, object] = {
                "runs": len(outcome),
                "collapsed": int(np.nansum(exceeded)),
                "bearing failed": int(np.nansum(each.exceeded(LimitState.bearing_failure()))),
                "analysis failed": int((outcome == UNKNOWN).sum()),
            }
            if name in curves:
                row |= self._numbers(curves[name], confidence)
            rows[name] = row | {"no curve": reasons.get(name, "")}
        return pd.DataFrame.from_dict(rows, orient="index")

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
                key=lambda each: each.slider_radius,
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
        return pd.DataFrame.from_dict(rows, orient="index")


def _breaks_at(bearing: LIRBearing) -> float:
    # Elastic up to the yield force, then hardening, until the deformation at failure.
    options = bearing.resolved()
    if options["rim_overrun"] >= max(bearing.radii):
        return math.inf
    stiffness, limit = options["rim_stiffness"], options["rim_overrun"]
    elastic = min(limit, bearing.rim_yield_force / stiffness)
    return stiffness * (elastic + bearing.rim_hardening * (limit - elastic))


def _ratio(own: Fragility | None, other: Fragility | None, confidence: float) -> dict[str, Any]:
    nothing = dict.fromkeys(("ratio [-]", "low [-]", "high [-]", f"{LIR} better [-]"), math.nan)
    if own is None or other is None:
        lacking = [word for word, c in ((LIR, own), ("the other", other)) if c is None]
        return nothing | {"verdict": f"no curve of {' and '.join(lacking)}"}
    try:
        found = compare_fragility(other, own).to_dataframe(confidence).loc["median, ratio [-]"]
    except FragilityError as cause:
        return nothing | {"verdict": str(cause)}
    value, low, high, better = (float(found[k]) for k in ("value", "low", "high", "second better"))
    verdict = "better" if low > 1.0 else "worse" if high < 1.0 else "alike"
    return dict(zip(nothing, (value, low, high, better), strict=True)) | {"verdict": verdict}
