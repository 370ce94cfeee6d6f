"""Numbers and figures of the map of near-fault pulses: which device stands, and which is better."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from frames import time_histories
from frames.design.project.inputs import bearing_of
from frames.plots import plot_style as ps
from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.devices import highest_ratio, moat_of
from frames.risk.campaign.ductility import DUCTILITY, ductility
from frames.risk.fragility.runs import COMPLETE, FAILURE
from lir_element.units import STANDARD_GRAVITY
from validation.page import number, table
from validation.study.part import quietly

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy.typing as npt
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lir_element import LIRBearing

    Own = Mapping[str, Any]

MOATS = 384, 517, 650
"""Displacements at which the first bearing fails [mm]."""

PLANS = 689, 838
"""Diameters of the largest dish of pairs of equal plan [mm]."""

BEYOND = "LIR-DCFP beyond the checks, moat 517 mm"
SOFT = "DCFP, soft rims, moat 384 mm"
DRIFT = 0.05
"""Storey drift from which a building counts as lost [-]: FEMA 356, collapse prevention of steel
frames (table C1-3; to be confirmed)."""

APART = 0.1
"""Share by which demands of two devices must differ [-]: less is alike."""

QUANTITIES = {
    "acceleration": "floor acceleration in plan, mean",
    "drift": "storey drift, mean",
    "displacement": "bearing displacement",
    "shear": "base shear over weight",
    "rim": "rim force",
}
LIR_ONLY, LIR_BETTER, ALIKE, MIXED, PLAIN_BETTER, PLAIN_ONLY, NEITHER = range(7)
LOOKS = {
    LIR_ONLY: ("#1a1a1a", "", "L", "LIR-DCFP alone stands"),
    LIR_BETTER: ("#777777", "", "L", "both stand, LIR-DCFP better"),
    ALIKE: ("#ffffff", "", "=", "both stand, alike"),
    MIXED: ("#ffffff", "..", "", "both stand, one better in each"),
    PLAIN_BETTER: ("#d9d9d9", "", "D", "both stand, DCFP better"),
    PLAIN_ONLY: ("#d9d9d9", "////", "", "DCFP alone stands"),
    NEITHER: ("#ffffff", "xxxx", "", "neither stands"),
}
"""Of what a cell says: face, hatch, letter, legend; apart in grey, too."""


def lir(moat: int) -> str:
    """Return the name of the LIR-DCFP of a moat [mm]."""
    return f"LIR-DCFP, moat {moat} mm"


def plain(moat: int) -> str:
    """Return the name of the DCFP of a moat [mm]."""
    return f"DCFP, moat {moat} mm"


PAIRS = {
    "plan 689 mm": (lir(517), plain(384)),
    "plan 838 mm": (lir(650), plain(517)),
    **{f"moat {moat} mm": (lir(moat), plain(moat)) for moat in MOATS},
    "beyond": (BEYOND, plain(384)),
    "soft": (lir(517), SOFT),
}
"""Devices that are set side by side: of equal plan, of equal moat, beyond the checks, soft rims."""

HALVED = tuple((name, number, 0.8) for number in (3, 6) for name in PAIRS["plan 689 mm"])
"""Runs at half the step, too: device, number of the pulse, peak velocity [m/s]."""

COMPARED = {
    DUCTILITY: "ductility",
    QUANTITIES["drift"]: "storey drift",
    QUANTITIES["acceleration"]: "floor acceleration",
    QUANTITIES["displacement"]: "bearing displacement",
    "interface slip": "interface slip",
}
"""Demands of these runs, and their text."""

PLAN, MOAT = "plan 689 mm", "moat 517 mm"
"""The pairs of the map."""


def numbers(every: Mapping[str, Any]) -> dict[str, Any]:
    """Return of each device the worse of both shapes, by velocity and period; lost is infinite."""
    tables = every["near_fault"]
    frames = tables.frames
    runs = tables.campaign.to_dataframe()
    words = runs["motion"].str.extract(r"^(\w+) pulse of ([\d.]+) s")
    runs = runs.assign(shape=words[0], period=words[1].astype(float))
    runs["failed"] = runs["outcome"] == FAILURE
    runs["lost"] = (runs["outcome"] != COMPLETE) | (runs[QUANTITIES["drift"]] > DRIFT)
    found: dict[str, Any] = {}
    for device, own in runs.groupby("model"):
        grid = own.groupby(["scale", "period"])
        kept: dict[str, Any] = {key: _square(grid[key].max()) for key in ("failed", "lost")}
        for key, quantity in QUANTITIES.items():
            kept[key] = _square(grid[quantity].max())
        found[str(device)] = kept
    return {
        "velocities": sorted(set(runs["scale"])),
        "periods": sorted(set(runs["period"])),
        "ratios": sorted(tables.file.motions.pulses.period_ratios),
        "unknown": int((~runs["outcome"].isin([COMPLETE, FAILURE])).sum()),
        "devices": found,
        "period": bearing_of(tables.file.bearing).period,
        "sizes": {
            name: sizes_of([link.bearing for link in frame.bearings.values()])
            for name, frame in frames.items()
        },
        "halved": at_two_steps(tables),
        "ratio": highest_ratio(frames[lir(517)]),
    }


def at_two_steps(tables: Any) -> list[dict[str, Any]]:
    """Return demands of runs at the step of the campaign and at half."""
    analysis, rows = tables.file.analysis, []
    motions = list(tables.campaign.motions.items())
    for model, which, scale in HALVED:
        name, motion = motions[which % len(motions)]
        frame, runs = tables.frames[model], []
        for dt in (analysis.dt, 0.5 * analysis.dt):
            options = {"scales": [scale], "dt": dt, "level": analysis.level}
            with quietly():
                data = time_histories({model: frame}, {name: motion}, **options)
            peaks = data["peak"].isel(run=0).to_series().to_dict()
            peaks[DUCTILITY] = float(ductility(data, frame)[0])
            values = {q: float(peaks[q]) if np.isfinite(peaks[q]) else None for q in COMPARED}
            runs.append({"status": str(data["status"].item())} | values)
        rows.append({"device": model, "motion": name, "im": scale, "runs": runs})
    return rows


def steps_said(rows: Sequence[dict[str, Any]]) -> str:
    """Return how far runs at two steps are apart."""
    pairs, words = [row["runs"] for row in rows], []
    apart = [row["device"] for row in rows if len({run["status"] for run in row["runs"]}) > 1]
    for quantity, text in COMPARED.items():
        far = [
            abs(whole[quantity] / half[quantity] - 1.0)
            for whole, half in pairs
            if whole["status"] == half["status"] == "ok" and (half[quantity] or 0.0) > 1e-3
        ]
        words += [f"{100.0 * max(far):.1f} % of {text}"] if far else []
    alike = f"ends differ in {'; '.join(apart)}" if apart else "all end alike"
    return f"{alike}; demands of complete runs differ by at most {', '.join(words) or 'nothing'}."


def sizes_of(bearings: Sequence[LIRBearing]) -> list[float]:
    """Return plan, way to the rims, least slider, moat [m], friction of the interface [-]."""
    least = min(each.slider_radius for each in bearings)
    first = bearings[0]
    friction = 0.0 if first.is_dcfp else first.interface_friction
    way = min(each.lateral_capacity for each in bearings)
    return [max(map(dish_diameter, bearings)), way, least, moat_of(bearings), friction]


def _square(values: Any) -> list[list[float]]:
    found: list[list[float]] = values.unstack().to_numpy().astype(float).round(5).tolist()
    return found


def verdicts(own: Own, pair: str, keys: Sequence[str] = ("acceleration", "drift")) -> Any:
    """Return by velocity and period which device of a pair stands, or is better by all keys.

    Shapes: result (velocities, periods), of the numbers of `LOOKS`.
    """
    one, other = (own["devices"][name] for name in PAIRS[pair])
    stands, holds = (~np.array(each["lost"], dtype=bool) for each in (one, other))
    ratios = np.array([np.array(one[key]) / np.array(other[key]) for key in keys])
    less, more = ratios < 1.0 - APART, ratios > 1.0 / (1.0 - APART)
    found = np.full(stands.shape, ALIKE)
    found[less.any(axis=0) & ~more.any(axis=0)] = LIR_BETTER
    found[more.any(axis=0) & ~less.any(axis=0)] = PLAIN_BETTER
    found[less.any(axis=0) & more.any(axis=0)] = MIXED
    found[stands & ~holds], found[holds & ~stands] = LIR_ONLY, PLAIN_ONLY
    found[~stands & ~holds] = NEITHER
    return found


def counts(own: Own, pair: str, *keys: str) -> dict[int, int]:
    """Return how many cells of a pair say what, by all keys that are given."""
    found = verdicts(own, pair, keys or ("acceleration", "drift"))
    return {kind: int((found == kind).sum()) for kind in LOOKS}


def frontier(own: Own, device: str, key: str = "failed") -> list[float]:
    """Return by period the least velocity at which a device fails [m/s]; inf if at none."""
    over, at = np.array(own["devices"][device][key], dtype=bool), np.array(own["velocities"])
    return [float(at[column].min()) if column.any() else np.inf for column in over.T]


def frontiers(own: Own) -> str:
    """Return the table of least velocities at which bearings fail, by period."""
    lines = [
        [name, *("-" if np.isinf(v) else f"{v:g}" for v in frontier(own, name))]
        for name in own["devices"]
    ]
    return table(["device", *(f"{ratio:g}" for ratio in own["ratios"])], lines)


def failed(own: Own, device: str) -> int:
    """Return in how many cells a bearing of a device fails."""
    return int(np.sum(own["devices"][device]["failed"]))


def ahead(counted: Mapping[int, int]) -> str:
    """Return the device that more cells are for."""
    one, other = (
        sum(counted[kind] for kind in kinds)
        for kinds in ((LIR_ONLY, LIR_BETTER), (PLAIN_ONLY, PLAIN_BETTER))
    )
    return "LIR-DCFP" if one > other else "DCFP" if other > one else "cheaper one"


def both(counted: Mapping[int, int]) -> int:
    """Return in how many cells both devices stand."""
    return sum(counted[kind] for kind in (LIR_BETTER, ALIKE, MIXED, PLAIN_BETTER))


UNITS = {
    "acceleration": ("floor acceleration [g]", 1.0 / STANDARD_GRAVITY, ".2f"),
    "drift": ("storey drift [%]", 100.0, ".2f"),
    "displacement": ("displacement [mm]", 1e3, ".0f"),
    "shear": ("base shear over weight [-]", 1.0, ".2f"),
    "rim": ("rim force [kN]", 1e-3, ".0f"),
}


def medians(own: Own, pair: str) -> dict[str, list[float]]:
    """Return medians of both devices, over the cells in which both stand and a rim is met."""
    devices = [own["devices"][name] for name in PAIRS[pair]]
    stand = ~np.any([each["lost"] for each in devices], axis=0)
    met = stand & np.any([np.array(each["rim"]) > 0.0 for each in devices], axis=0)
    return {
        key: [
            factor * float(np.median(np.array(each[key])[met])) if met.any() else np.nan
            for each in devices
        ]
        for key, (_, factor, _) in UNITS.items()
    } | {"cells": [float(met.sum())]}


def pairs_table(own: Own) -> str:
    """Return what pairs of devices say: counts of cells, and medians where a rim is met."""
    lines = []
    for pair in PAIRS:
        counted, found = counts(own, pair), medians(own, pair)
        values = [
            " / ".join(number(v, form) for v in found[key]) for key, (_, _, form) in UNITS.items()
        ]
        lines.append([" / ".join(PAIRS[pair]), *(f"{counted[k]}" for k in LOOKS), *values])
    heads = [text for *_, text in LOOKS.values()]
    return table(["LIR-DCFP / DCFP", *heads, *(text for text, _, _ in UNITS.values())], lines)


def devices_table(own: Own) -> str:
    """Return the devices: dish, way to the rims, friction of the interface, moat."""
    lines = [
        [name, *(f"{1e3 * v:.0f}" for v in (plan, way, slider, moat)), f"{mu:.3f}" if mu else "-"]
        for name, (plan, way, slider, moat, mu) in own["sizes"].items()
    ]
    heads = "plan [mm]", "way to the rims [mm]", "least slider radius [mm]", "moat [mm]", "mu_h [-]"
    return table(["device", *heads], lines)


def figures(campaigns: object, own: Own) -> dict[str, Figure]:
    """Return the figures by name."""
    del campaigns
    return {"map": map_figure(own), "decision": decision_figure(own)}


def map_figure(own: Own) -> Figure:
    """Return who stands and who is better in acceleration and drift, at equal plan and moat."""
    figure = ps.new_figure(5.6)
    grid = ps.grid_of(figure, 2, 3, share_x=True, share_y=True)
    keys = {"failure of a bearing": (), "floor acceleration": ("acceleration",)}
    for row, pair in zip(grid, (PLAN, MOAT), strict=True):
        for panel, (title, of) in zip(row, {**keys, "drift": ("drift",)}.items(), strict=True):
            found = verdicts(own, pair, of) if of else _by_failure(own, pair)
            draw_cells(panel, own, pair, found, f"{title},\nequal {pair}")
    _labels(grid)
    ps.add_legend(figure, legend_handles(), columns=3)
    return figure


def _by_failure(own: Own, pair: str) -> npt.NDArray[Any]:
    # Who stands, by failure of bearings alone.
    one, other = (np.array(own["devices"][name]["failed"], dtype=bool) for name in PAIRS[pair])
    found = np.where(one, PLAIN_ONLY, LIR_ONLY)
    found[~one & ~other], found[one & other] = ALIKE, NEITHER
    return found


def decision_figure(own: Own) -> Figure:
    """Return which device to choose, a panel each limited plan or moat."""
    figure = ps.new_figure(5.2)
    grid = ps.grid_of(figure, 2, 3, share_x=True, share_y=True)
    pairs = [[f"plan {plan} mm" for plan in PLANS], [f"moat {moat} mm" for moat in MOATS]]
    for row, own_pairs in zip(grid, pairs, strict=True):
        for panel, pair in zip(row, own_pairs, strict=False):
            draw_cells(panel, own, pair, verdicts(own, pair), f"limited: {pair}")
    grid[0][2].set_axis_off()
    grid[0][2].legend(handles=legend_handles(), loc="center", fontsize=ps.SMALL, frameon=False)
    _labels(grid)
    return figure


def _labels(grid: Sequence[Sequence[Axes]]) -> None:
    for row in grid:
        ps.caption(row[0], y="peak velocity [m/s]")
    for panel in grid[-1]:
        ps.caption(panel, x="T_p / T_b [-]")


def draw_cells(panel: Axes, own: Own, pair: str, found: npt.NDArray[Any], title: str) -> None:
    """Draw cells, and lines below the first cell of each period in which a bearing fails."""
    panel.grid(visible=False)
    for (y, x), kind in np.ndenumerate(found):
        face, hatch, letter, _ = LOOKS[int(kind)]
        corner, edge = (float(x) - 0.5, float(y) - 0.5), ps.GREY
        panel.add_patch(
            Rectangle(corner, 1.0, 1.0, facecolor=face, hatch=hatch, edgecolor=edge, linewidth=0.3)
        )
        if not hatch:
            ink = "white" if kind in (LIR_ONLY, LIR_BETTER) else "black"
            panel.text(x, y, letter, ha="center", va="center", fontsize=5.5, color=ink)
    velocities, edges = own["velocities"], np.arange(found.shape[1] + 1) - 0.5
    for name, line in zip(PAIRS[pair], ("-", "--"), strict=True):
        rows = [
            len(velocities) if np.isinf(v) else velocities.index(v) for v in frontier(own, name)
        ]
        for color, width, style in (("white", 3.2, "-"), ("black", 1.5, line)):
            panel.stairs(
                np.array(rows) - 0.5,
                edges,
                baseline=None,
                color=color,
                linewidth=width,
                linestyle=style,
            )
    panel.set_xlim(-0.5, found.shape[1] - 0.5)
    panel.set_ylim(-0.5, found.shape[0] - 0.5)
    panel.set_xticks(range(found.shape[1]), [f"{ratio:g}" for ratio in own["ratios"]], rotation=90)
    panel.set_yticks(range(found.shape[0]), [f"{v:g}" for v in velocities])
    ps.caption(panel, title=title)
    panel.title.set_fontsize(ps.SMALL)


def legend_handles() -> list[Any]:
    """Return the entries of a legend of cells and lines."""
    patches = [
        Patch(facecolor=face, hatch=hatch, edgecolor=ps.GREY, label=text)
        for face, hatch, _, text in LOOKS.values()
    ]
    lines = [
        Line2D([], [], color="black", linestyle=line, label=f"{name}: bearing fails above")
        for name, line in zip(("LIR-DCFP", "DCFP"), ps.LINES, strict=False)
    ]
    return [*patches, *lines]
