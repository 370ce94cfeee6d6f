"""What a bearing of the study costs: a model of its steel, liners and surfaces, prices as inputs.

The unit of cost is the price of a kilogram of machined structural steel. All prices are
assumptions: makers publish none. The page varies each of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames.risk.campaign.comparison import dish_diameter

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from lir_element import LIRBearing

DENSITY = 7850.0
"""Of steel [kg/m3]."""

YIELD_STRESS = 345e6
"""Of the rims' steel [Pa]; in shear 0.6 of it."""

UNBROKEN = 4.0
"""Strength over the design load that rims which never break are paid for: a lower bound, since the
rims of the study's DCFPs break at 4.7 to 9 times the load."""

FLANGE = 0.025
"""Width and height of the ring of a rim, at least [m]: `rim_width` of `DesignTarget`."""


@dataclass(frozen=True, kw_only=True)
class Prices:
    """Prices over that of a kilogram of machined steel, and what a plate must have.

    Attributes
    ----------
    plate, slider, rim : float
        Of steel, per kilogram.
    liner : float
        Of a sliding liner, bonded, per square metre.
    overlay : float
        Of stainless steel, formed and polished, on the dish or in the interface, per square metre.
    each : float
        Of assembling and testing a bearing.
    thickness : float
        Of a plate under the lowest point of its dish [m].
    """

    plate: float = 1.0
    slider: float = 1.5
    rim: float = 1.5
    liner: float = 500.0
    overlay: float = 250.0
    each: float = 200.0
    thickness: float = 0.03


PRICES = Prices()


def rim_width(bearing: LIRBearing, strength: float | None) -> float:
    """Return the width of the ring that a rim of a strength needs [m].

    Its foot is sheared over the diameter of the slider that presses on it.
    """
    force = (UNBROKEN if strength is None else strength) * bearing.resolved()["design_load"]
    return max(FLANGE, force / (2.0 * bearing.slider_radius * 0.6 * YIELD_STRESS))


def parts_of(bearing: LIRBearing, strength: float | None, prices: Prices) -> dict[str, float]:
    """Return the cost of a bearing by part."""
    dish, a = dish_diameter(bearing), bearing.slider_radius
    radius = max(bearing.radii)
    width = rim_width(bearing, strength)
    depth = radius - math.sqrt(radius**2 - 0.25 * dish**2)
    blank = 0.25 * math.pi * (dish + 2.0 * width) ** 2 * (depth + prices.thickness)
    ring = math.pi * (dish + width) * width * FLANGE
    faces = 2 if bearing.is_dcfp else 3  # with a liner on one side, polished steel on the other
    spheres = 2.0 * math.pi * radius * depth  # area of a dish
    inside = 0.0 if bearing.is_dcfp else math.pi * a**2
    return {
        "plates": 2.0 * DENSITY * blank * prices.plate,
        "rims": 2.0 * DENSITY * ring * prices.rim,
        "sliders": DENSITY * math.pi * a**2 * bearing.slider_height * prices.slider,
        "liners": faces * math.pi * a**2 * prices.liner,
        "overlays": (2.0 * spheres + inside) * prices.overlay,
        "each": prices.each,
    }


def cost_of(
    bearings: Iterable[LIRBearing], strength: float | None, prices: Prices = PRICES
) -> dict[str, float]:
    """Return the cost of all bearings of a building by part, over that of a kilogram of steel."""
    total: dict[str, float] = {}
    for bearing in bearings:
        for name, value in parts_of(bearing, strength, prices).items():
            total[name] = total.get(name, 0.0) + value
    return total


def volume_of(bearings: Iterable[LIRBearing]) -> float:
    """Return the volume that `lir design --objective cost-like` counts [m3]."""
    return sum(
        0.25 * math.pi * (dish_diameter(each) + 2.0 * FLANGE) ** 2 * each.slider_height
        for each in bearings
    )


def repriced(parts: Mapping[str, float], factors: Mapping[str, float]) -> float:
    """Return the cost of parts whose prices are times a factor, 1 where none is given."""
    return sum(value * factors.get(name, 1.0) for name, value in parts.items())


def at_equal_cost(
    first: Mapping[float, float], second: Mapping[float, float]
) -> list[tuple[float, float, float]]:
    """Return cost, value of the first and value of the second where both are known."""
    costs = sorted(second)
    return [
        (cost, value, float(np.interp(cost, costs, [second[each] for each in costs])))
        for cost, value in sorted(first.items())
        if costs and costs[0] <= cost <= costs[-1]
    ]
