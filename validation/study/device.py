"""Devices of equal plan, moat and cost: what they cost, who is ahead, and the figures of the page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from frames.risk import Device, LimitState, compare_fragility, paired_tests
from frames.risk.campaign.comparison import COLLAPSE, dish_diameter
from frames.risk.campaign.devices import highest_ratio, moat_of
from frames.risk.campaign.tables import CONFIDENCE
from validation.study import levels

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.frame import Frame
    from frames.risk.campaign.tables import CampaignTables
    from lir_element import LIRBearing

    Own = Mapping[str, Any]

LEVELS = ("contact", "pendulum")
PLANS = ("569 mm", "689 mm", "1009 mm")
REFERENCE = "689 mm"
RIMS = ("rims of 1 W", "unbreakable rims", "rims of 0.5 W")
LIR = f"LIR-DCFP {REFERENCE}"
TERMS = {"plan": PLANS, "moat": ("of moat 517 mm",), "cost": ("of cost as 689 mm",)}
"""What is equal, and how the file calls the DCFPs."""

LIMITS = ("storey drift 2 %", "ductility 4", "floor acceleration 1 g", COLLAPSE)
"""Limit states of the tables."""

PARTS = ("plates", "rims", "sliders", "liners", "overlays", "each")
"""Of a bearing's cost."""

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


PRICES = Prices()


def pairs_of(terms: str) -> list[tuple[str, str]]:
    """Return the devices that are compared on terms: the LIR-DCFP, and a DCFP."""
    labels = TERMS[terms]
    own = {label: f"LIR-DCFP {label}" if terms == "plan" else LIR for label in labels}
    return [(own[label], f"DCFP {label}, {rims}") for label in labels for rims in RIMS]


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


def bearings_of(frame: Frame) -> list[LIRBearing]:
    """Return the bearings of a building."""
    return [link.bearing for link in frame.bearings.values()]


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return what the page says beside the tables of the campaigns, plain numbers."""
    comparison = every[LEVELS[0]].comparison
    assert comparison is not None
    frames = comparison.frames
    found: dict[str, Any] = {"devices": {name: sizes_of(frame) for name, frame in frames.items()}}
    for level in LEVELS:
        tables = every[level]
        found[level] = {
            "shares": {name: _shares(tables, name) for name in tables.runs},
            "pairs": {terms: _pairs(tables, terms) for terms in TERMS},
        }
    margins = every[LEVELS[0]].margins.reindex(columns=["margin [-]"])["margin [-]"].to_dict()
    found["turns"] = {rims: turning_prices(margins, frames, rims) for rims in RIMS}
    found["levels"] = levels.numbers(every)
    return found


def sizes_of(frame: Frame) -> dict[str, Any]:
    """Return lengths [m], interface friction, ratio of the checks [-] and cost of a device."""
    bearings = bearings_of(frame)
    return {
        "plan": max(map(dish_diameter, bearings)),
        "least plan": min(map(dish_diameter, bearings)),
        "capacity": min(each.lateral_capacity for each in bearings),
        "moat": moat_of(bearings),
        "slider": min(each.slider_radius for each in bearings),
        "interface": None if bearings[0].is_dcfp else bearings[0].interface_friction,
        "ratio": None if bearings[0].is_dcfp else highest_ratio(frame),
        "cost": cost_of(bearings),
    }


def _shares(tables: CampaignTables, name: str) -> list[list[float]]:
    # By intensity: runs that collapse, with a failed bearing, and known ones.
    runs = tables.runs[name]
    collapse = next(each for each in tables.limits if each.name == COLLAPSE)
    over, failed = runs.exceeded(collapse), runs.exceeded(LimitState.bearing_failure())
    im = runs.table["scale"].to_numpy()
    rows = []
    for at in np.unique(im):
        counts = (float(np.nansum(each[im == at])) for each in (over, failed))
        rows.append([float(at), *counts, float(np.isfinite(over[im == at]).sum())])
    return rows


def _pairs(tables: CampaignTables, terms: str) -> list[dict[str, Any]]:
    # Of each limit state: ratio of medians with its interval, and the exact test of the records.
    pairs = [pair for pair in pairs_of(terms) if {*pair} <= {*tables.runs}]
    if not pairs:
        return []
    tests = paired_tests(tables.runs, pairs, tables.limits).set_index(["measure", "own", "over"])
    rows = []
    for limit in tables.limits:
        for own, other in pairs:
            tested = tests.loc[[(limit.name, own, other)]]
            whole = tested[np.isinf(tested["scale"])].iloc[0]
            stripes = tested[np.isfinite(tested["scale"])]
            row: dict[str, Any] = {"limit": limit.name, "own": own, "other": other}
            row["ratio"] = _ratio(tables.curves.get(limit.name, {}), own, other)
            row |= {key: int(whole[key]) for key in ("less", "more", "records")}
            row |= {"p": float(whole["p"]), "verdict": str(whole["verdict"])}
            row["stripes"] = stripes[["scale", "less", "more", "verdict"]].to_numpy().tolist()
            rows.append(row)
    return rows


def _ratio(curves: Mapping[str, Any], own: str, other: str) -> list[float] | None:
    if own not in curves or other not in curves:
        return None
    table = compare_fragility(curves[other], curves[own]).to_dataframe(CONFIDENCE)
    row = table.loc["median, ratio [-]"]
    return [float(row[key]) for key in ("value", "low", "high")]


def turning_prices(
    margins: Mapping[str, float], frames: Mapping[str, Frame], rims: str
) -> dict[str, Any]:
    """Return the plan of a DCFP of the margin of the LIR-DCFP, and the prices of equal cost.

    The plan is interpolated between those that were run. Cost is linear in each price, so that one
    factor on it makes both devices cost the same; None where no factor above zero does.
    """
    dcfps = {
        max(map(dish_diameter, bearings_of(frame))): margins[name]
        for name, frame in frames.items()
        if name.startswith("DCFP")
        and name.endswith(rims)
        and math.isfinite(margins.get(name, math.nan))
    }
    plans, known = np.array(sorted(dcfps)), [dcfps[plan] for plan in sorted(dcfps)]
    wanted = margins.get(LIR, math.nan)
    if not len(plans) or not math.isfinite(wanted) or not min(known) <= wanted <= max(known):
        return {"plan": None, "margin": None if not math.isfinite(wanted) else wanted}
    rising = np.maximum.accumulate(known)  # of margins that scatter the first plan that has it
    plan = float(np.interp(wanted, rising + 1e-9 * np.arange(len(rising)), plans))
    like = frames[f"DCFP {REFERENCE}, {rims}"]
    strength = {"rims of 1 W": 1.0, "rims of 0.5 W": 0.5}.get(rims, math.inf)
    other = cost_of(bearings_of(Device(kind="DCFP", plan=plan, rims=strength).on(like)))
    own = cost_of(bearings_of(frames[LIR]))
    more = sum(own.values()) - sum(other.values())
    factors = {
        part: factor
        for part in own
        if abs(own[part] - other[part]) > 1e-9
        and (factor := 1.0 - more / (own[part] - other[part])) > 0.0
    }
    return {"plan": plan, "margin": wanted, "cost": [sum(own.values()), sum(other.values())]} | {
        "factors": factors
    }


def of_pair(own: Own, level: str, terms: str, other: str, limit: str = COLLAPSE) -> dict[str, Any]:
    """Return what is kept of a DCFP beside its LIR-DCFP."""
    rows = own[level]["pairs"][terms]
    found: dict[str, Any] = next(r for r in rows if (r["other"], r["limit"]) == (other, limit))
    return found


def ratio_of(pair: Mapping[str, Any], none: str = "-") -> str:
    """Return ratio of medians with its interval, as text."""
    return "{:.2f} ({:.2f} to {:.2f})".format(*pair["ratio"]) if pair["ratio"] else none


def said(pair: Mapping[str, Any]) -> str:
    """Return ratio of medians, discordant records and verdict, as text."""
    text = ratio_of(pair, "no ratio")
    return f"{text}; {pair['less']} to {pair['more']} records, {pair['verdict']}"


MARKERS = "osd^v"


def figures(campaigns: Mapping[str, Any], own: Own) -> dict[str, Figure]:
    """Return the figures by name: each of the terms, levels and cost."""
    margins = {level: campaigns[level]["tables"]["margins"].set_index("device") for level in LEVELS}
    considered = campaigns[LEVELS[0]]["considered"]
    found = {terms: terms_figure(own, terms, considered) for terms in TERMS}
    cells = [(margins[level], "plan", PLANS, f"level {level}") for level in LEVELS]
    found["margins"] = margins_figure(own, cells)
    sizes = [(margins[LEVELS[0]], key, (), "") for key in ("cost", "moat")]
    found["price"] = margins_figure(own, sizes)
    found["levels"] = levels.figure(own["levels"])
    return found


def legend(figure: Figure) -> None:
    """Put the legend of the LIR-DCFP, and of the DCFP by its rims, above a figure."""
    names = ("LIR-DCFP", *(f"DCFP, {rims}" for rims in RIMS))
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.5, **ps.line_of(k))
        for k, name in enumerate(names)
    ]
    ps.add_legend(figure, handles, columns=2)


def terms_figure(own: Own, terms: str, considered: float) -> Figure:
    """Return shares of collapse over intensity, a panel a pair of devices on equal terms."""
    labels = TERMS[terms]
    figure = ps.new_figure(2.9)
    (panels,) = ps.grid_of(figure, 1, len(labels), share_y=True)
    for panel, label in zip(panels, labels, strict=True):
        first = f"LIR-DCFP {label}" if terms == "plan" else LIR
        for k, name in enumerate((first, *(f"DCFP {label}, {rims}" for rims in RIMS))):
            at, collapsed, failed, known = np.array(own[LEVELS[0]]["shares"][name]).T
            panel.plot(
                at, 100.0 * collapsed / known, marker=MARKERS[k], markersize=3.5, **ps.line_of(k)
            )
            frame = collapsed > failed
            look = {"color": ps.line_of(k)["color"], "markerfacecolor": "white", "markersize": 3.5}
            panel.plot(at[frame], (100.0 * failed / known)[frame], MARKERS[k], **look)
        panel.axvline(considered, color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(-2.0, 103.0)
        title = f"plan {label}" if terms == "plan" else f"DCFP {label}"
        ps.caption(panel, title=title, x="Sa(3 s) [m/s2]", y="share of collapse [%]")
    legend(figure)
    return figure


def _margin_line(
    panel: Axes, margins: Any, names: Sequence[str], at: Sequence[float], k: int
) -> None:
    known = [(x, margins.loc[n]) for x, n in zip(at, names, strict=True) if n in margins.index]
    known = [(x, row) for x, row in known if math.isfinite(row.get("margin [-]", math.nan))]
    if not known:  # of few records there may be no curve
        return
    x = [place for place, _ in known]
    value, low, high = (
        np.array([row[f"margin{end} [-]"] for _, row in known]) for end in ("", ", low", ", high")
    )
    ends = [value - low, high - value]
    look = ps.line_of(k)
    panel.errorbar(x, value, yerr=ends, marker=MARKERS[k], markersize=3.5, elinewidth=0.6, **look)


AXES = {"plan": "plan [mm]", "moat": "moat [mm]", "cost": "cost of nine bearings [t of steel]"}
"""What margins are drawn over, by the name of a size."""


def margins_over(panel: Axes, own: Own, margins: Any, key: str, labels: Sequence[str] = ()) -> None:
    """Draw collapse margins of devices (DCFPs of `labels`; none: all) over a size of `AXES`."""
    for k, end in enumerate(("", *(f", {rims}" for rims in RIMS))):
        start, kept = ("DCFP ", labels) if end else ("LIR-DCFP ", PLANS)
        names = [n for n in own["devices"] if n.startswith(start) and n.endswith(end)]
        names = [n for n in names if not kept or n[len(start) : len(n) - len(end)] in kept]
        sizes = {n: own["devices"][n][key] for n in names}
        at = {
            n: 1e-3 * sum(v.values()) if key == "cost" else 1e3 * v + 4.0 * (k - 1.5)
            for n, v in sizes.items()
        }
        names.sort(key=lambda name, at=at: at[name])  # type: ignore[misc]
        _margin_line(panel, margins, names, [at[name] for name in names], k)
    ps.caption(panel, x=AXES[key], y="collapse margin [-]")


def margins_figure(own: Own, cells: Sequence[tuple[Any, str, Sequence[str], str]]) -> Figure:
    """Return collapse margins, a panel of each: margins, size of `AXES`, labels, title."""
    figure = ps.new_figure(3.2)
    (panels,) = ps.grid_of(figure, 1, len(cells), share_y=True)
    for panel, (margins, key, labels, title) in zip(panels, cells, strict=True):
        margins_over(panel, own, margins, key, labels)
        if title:
            ps.caption(panel, title=title)
    legend(figure)
    return figure
