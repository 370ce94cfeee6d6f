"""The sections of the page of the best devices on cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from validation.measurements.yielding_runs import LIR
from validation.page import table
from validation.study.device_cost import PRICES, at_equal_cost, repriced
from validation.study.device_figures import KINDS, labelled
from validation.study.device_runs import OTHERS
from validation.study.device_sections import (
    reference,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    Found = Mapping[str, Any]

VARIED = 0.5
"""Share by which each price is varied."""


def cost(found: Found) -> str:
    """Return the model of cost and its table."""
    rows = []
    for plan in found["plans"]:
        for kind in KINDS[:-1]:
            kept = plan["devices"][kind]
            parts = kept["cost"]
            rows.append(
                [
                    kept["name"],
                    *(f"{value:.0f}" for value in parts.values()),
                    f"{sum(parts.values()):.0f}",
                    f"{kept['volume']:.3f}",
                ]
            )
    parts = reference(found)["devices"][LIR]["cost"]
    return (
        "The cost of nine bearings in kilograms of machined structural steel. Plates are blanks, as "
        f"wide as dish and rims, {1e3 * PRICES.thickness:g} mm under the lowest point and as deep as "
        "the dish rises; rims are as wide as their strength asks in shear over a slider's diameter, 25 "
        "mm at least, those that never break being paid as 4 W; a LIR-DCFP has three sliding faces, a "
        f"DCFP two. Prices per kilogram: plates {PRICES.plate:g}, sliders {PRICES.slider:g}, rims "
        f"{PRICES.rim:g}; per square metre: liners {PRICES.liner:g}, polished stainless overlays "
        f"{PRICES.overlay:g}; {PRICES.each:g} a bearing to assemble and test. **These prices are "
        "assumptions**: no maker publishes any. `lir design --objective cost-like` counts the volume of "
        "plates times the slider's height, the last column: without liners, rims and faces.\n\n"
        + table(["device", *parts, "sum", "volume [m3]"], rows)
    )


def margins_over_cost(found: Found, kind: str, costs: Mapping[str, float]) -> dict[float, float]:
    """Return margins of a device by cost, its parts times factors."""
    points = {}
    for plan in found["plans"]:
        kept = plan["devices"][kind]
        if "margin" in kept:
            points[repriced(kept["cost"], costs)] = kept["margin"][0]
    return points


def equal_ratios(found: Found, other: str, factors: Mapping[str, float]) -> list[float]:
    """Return margins of the LIR-DCFP over those of a DCFP of the same cost, at some costs."""
    own, their = (margins_over_cost(found, kind, factors) for kind in (LIR, other))
    return [one / two for _, one, two in at_equal_cost(own, their)]


def equal_cost(found: Found) -> str:
    """Return margins at equal cost, prices varied."""
    parts = list(reference(found)["devices"][LIR]["cost"])
    cases: dict[str, dict[str, float]] = {"as above": {}} | {
        f"{part} {sign}50 %": {part: 1.0 + VARIED * (1 if sign == "+" else -1)}
        for part in parts
        for sign in "+-"
    }
    rows = []
    for name, factors in cases.items():
        cells = []
        for other in OTHERS[:3]:
            ratios = equal_ratios(found, other, factors)
            cells.append(f"{min(ratios):.2f} to {max(ratios):.2f}" if ratios else "-")
        rows.append([name, *cells])
    return (
        "Margin of the LIR-DCFP over that of a DCFP of the same cost, hence of a larger plan "
        "(interpolated between plans; smallest and largest over the costs that both have):\n\n"
        + table(["prices", *(labelled(other) for other in OTHERS[:3])], rows)
    )


def cost_verdict(found: Found) -> str:
    """Return margins at equal cost in a sentence."""
    words = []
    for other in OTHERS[:3]:
        ratios = equal_ratios(found, other, {})
        if ratios:
            words.append(f"{other} {min(ratios):.2f} to {max(ratios):.2f}")
    return (
        "At equal cost by the model below the margin of the LIR-DCFP over that of a DCFP is: "
        f"{'; '.join(words) or 'not known, costs do not overlap'}."
    )
