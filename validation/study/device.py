"""Devices of equal plan, moat and cost: what they cost, who is ahead, and the figures of the page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from frames.risk import Device
from frames.risk.campaign.comparison import dish_diameter
from validation.study import levels
from validation.study.shown import bearings_of, sizes_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.frame import Frame
    from frames.risk.campaign.tables import CampaignTables
    from lir_element import LIRBearing

    Own = Mapping[str, Any]

LEVELS = ("contact", "pendulum")
REFERENCE, SMALL, LARGE = "689 mm", "569 mm", "1009 mm"
RIMS = ("rims of 1 W", "unbreakable rims", "rims of 0.5 W")
LIR = f"LIR-DCFP {REFERENCE}"
TERMS = {
    "plan": "The DCFP has sliders as small as the pressure allows, so that all of the plan is "
    "displacement. Plates of the LIR-DCFP are as large under all columns. In the plates of the DCFP "
    "under every column its sliders are by load, 60 mm wider: its margin is in the last table.",
    "moat": "The DCFP fails at the displacement at which the LIR-DCFP of 689 mm fails, and has a larger "
    "plan.",
    "cost": "The DCFP costs as much as the LIR-DCFP of 689 mm.",
}
"""What is equal in groups of the file, with a remark."""

DENSITY = 7850.0
"""Of steel [kg/m3]."""

YIELD_STRESS = 345e6
"""Of the rims' steel [Pa]; in shear 0.6 of it."""

UNBROKEN = 4.0
"""Strength over the design load that rims which never break are paid for: a lower bound."""

FLANGE = 0.025
"""Width and height of the ring of a rim, at least [m]."""


class Prices(NamedTuple):
    """Prices over that of a kilogram of machined steel, assumptions: makers publish none."""

    plates: float = 1.0  # a kilogram
    rims: float = 1.5
    sliders: float = 1.5
    liners: float = 500.0  # bonded, a square metre
    overlays: float = 250.0  # stainless steel, formed and polished, a square metre
    each: float = 200.0  # assembling and testing a bearing
    thickness: float = 0.03  # of a plate under the lowest point of its dish [m]


PRICES, PARTS = Prices(), Prices._fields[:-1]


def rim_width(bearing: LIRBearing) -> float:
    """Return the width of the ring that a rim of its strength needs [m].

    Its foot is sheared over the diameter of the slider that presses on it.
    """
    force = min(bearing.rim_yield_force, UNBROKEN * bearing.resolved()["design_load"])
    return max(FLANGE, force / (2.0 * bearing.slider_radius * 0.6 * YIELD_STRESS))


def parts_of(bearing: LIRBearing, prices: Prices = PRICES) -> dict[str, float]:
    """Return the cost of a bearing by part, over that of a kilogram of machined steel."""
    dish, a = dish_diameter(bearing), bearing.slider_radius
    radius, width = max(bearing.radii), rim_width(bearing)
    depth = radius - math.sqrt(radius**2 - 0.25 * dish**2)
    blank = 0.25 * math.pi * (dish + 2.0 * width) ** 2 * (depth + prices.thickness)
    ring = math.pi * (dish + width) * width * FLANGE
    faces = 2 if bearing.is_dcfp else 3  # with a liner on one side, polished steel on the other
    spheres = 2.0 * math.pi * radius * depth  # area of a dish
    inside = 0.0 if bearing.is_dcfp else math.pi * a**2
    return {
        "plates": 2.0 * DENSITY * blank * prices.plates,
        "rims": 2.0 * DENSITY * ring * prices.rims,
        "sliders": DENSITY * math.pi * a**2 * bearing.slider_height * prices.sliders,
        "liners": faces * math.pi * a**2 * prices.liners,
        "overlays": (2.0 * spheres + inside) * prices.overlays,
        "each": prices.each,
    }


def cost_of(bearings: Iterable[LIRBearing], prices: Prices = PRICES) -> dict[str, float]:
    """Return the cost of all bearings of a building by part."""
    total: dict[str, float] = {}
    for bearing in bearings:
        for name, value in parts_of(bearing, prices).items():
            total[name] = total.get(name, 0.0) + value
    return total


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return sizes, costs, prices that turn the answer, and why levels differ, plain numbers."""
    tables = every[LEVELS[0]]
    margins = tables.margins.reindex(columns=["margin [-]"])["margin [-]"].to_dict()
    return {
        "devices": {
            name: sizes_of(frame) | {"cost": cost_of(bearings_of(frame))}
            for name, frame in tables.frames.items()
        },
        "turns": {rims: turning_prices(margins, tables.frames, rims) for rims in RIMS},
        "levels": levels.numbers(every),
    }


def turning_prices(
    margins: Mapping[str, float], frames: Mapping[str, Frame], rims: str
) -> dict[str, Any]:
    """Return the plan of a DCFP of the margin of the LIR-DCFP, and the prices of equal cost.

    The plan is interpolated between those that were run; None beyond them. Cost is linear in each
    price, so that one factor on it makes both devices cost the same.
    """
    found = [
        (max(map(dish_diameter, bearings_of(frame))), margins.get(name, math.nan))
        for name, frame in frames.items()
        if name.startswith("DCFP") and name.endswith(rims)
    ]
    plans, known = (
        np.array(sorted(each for each in found if math.isfinite(each[1]))).reshape(-1, 2).T
    )
    wanted = margins.get(LIR, math.nan)
    if not len(plans) or not known.min() <= wanted <= known.max():
        return {"plan": None, "smaller": bool(len(plans) and wanted < known.min())}
    rising = np.maximum.accumulate(known)  # of margins that scatter the first plan that has it
    plan = float(np.interp(wanted, rising + 1e-9 * np.arange(len(rising)), plans))
    strength = {RIMS[0]: 1.0, RIMS[2]: 0.5}.get(rims, math.inf)
    device = Device(kind="DCFP", plan=plan, rims=strength)
    own = cost_of(bearings_of(frames[LIR]))
    other = cost_of(bearings_of(device.on(frames[f"DCFP {REFERENCE}, {rims}"])))
    more = sum(own.values()) - sum(other.values())
    factors = {
        part: 1.0 - more / (own[part] - other[part])
        for part in own
        if abs(own[part] - other[part]) > 1e-9
    }
    costs = [sum(own.values()), sum(other.values())]
    return {"plan": plan, "cost": costs, "factors": {p: f for p, f in factors.items() if f > 0.0}}


MARKERS = "osd^v"
MARGIN = ["margin [-]", "margin, low [-]", "margin, high [-]"]


def figures(campaigns: Mapping[str, Any], own: Own) -> dict[str, Figure]:
    """Return the figures by name: margins over sizes, and levels."""
    margins = {level: campaigns[level]["tables"]["margins"].set_index("device") for level in LEVELS}
    cells = [(margins[level], "plan", f"level {level}") for level in LEVELS]
    sizes = [(margins[LEVELS[0]], key, "") for key in ("cost", "moat")]
    return {
        "margins": margins_figure(own, cells),
        "price": margins_figure(own, sizes),
        "levels": levels.figure(own["levels"]),
    }


def legend(figure: Figure) -> None:
    """Put the legend of the LIR-DCFP, and of the DCFP by its rims, above a figure."""
    names = ("LIR-DCFP", *(f"DCFP, {rims}" for rims in RIMS))
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
        for k, name in enumerate(names)
    ]
    ps.add_legend(figure, handles, columns=2)


AXES = {"plan": "plan [mm]", "moat": "moat [mm]", "cost": "cost of nine bearings [t of steel]"}
"""What margins are drawn over, by the name of a size."""


def margins_over(panel: Axes, own: Own, margins: pd.DataFrame, key: str) -> None:
    """Draw collapse margins of devices over a size of `AXES`."""
    for k, end in enumerate(("", *(f", {rims}" for rims in RIMS))):
        start, at = "DCFP " if end else "LIR-DCFP ", {}
        for name, one in own["devices"].items():
            if key == "moat" and "unbreakable" in name:
                continue  # which have none
            if name.startswith(start) and name.endswith(end) and ("," in name) is bool(end):
                size = 1e-3 * sum(one["cost"].values()) if key == "cost" else 1e3 * one[key]
                at[name] = size + 4.0 * (k - 1.5) * (key != "cost")
        rows = margins.reindex(list(at), columns=MARGIN).assign(at=at.values())
        value, low, high, x = rows.dropna().sort_values("at").to_numpy().T
        look = ps.line_of(k) | {"marker": MARKERS[k], "markersize": 3.5, "elinewidth": 0.6}
        panel.errorbar(x, value, yerr=[value - low, high - value], **look)
    ps.caption(panel, x=AXES[key], y="collapse margin [-]")


def margins_figure(own: Own, cells: Sequence[tuple[Any, str, str]]) -> Figure:
    """Return collapse margins, a panel of each: margins, size of `AXES`, title."""
    figure = ps.new_figure(3.2)
    (panels,) = ps.grid_of(figure, 1, len(cells), share_y=True)
    for panel, (margins, key, title) in zip(panels, cells, strict=True):
        margins_over(panel, own, margins, key)
        ps.caption(panel, title=title)
    legend(figure)
    return figure
