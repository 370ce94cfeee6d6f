"""Figure of a campaign: response over the factor on the motions, with the shares that failed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames.plots import plot_style as ps
from frames.results.quantities import QUANTITIES as TABLE
from frames.risk.campaign.ductility import DUCTILITY
from frames.risk.fragility.intensity import Intensity, IntensityMeasure
from frames.risk.fragility.runs import COMPLETE, FAILURE, UNBUILT, UNKNOWN, IntensityRuns

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion

_PANELS = 4  # of responses, at most; the last panel has the shares
_LINE = 0.42  # share of the place of a factor that bars take


def response_by_factor(
    models: Mapping[str, IntensityRuns], *, axis: str = "factor on the motions"
) -> Figure:
    """Draw the results of structures over the factor on the motions, and the failed runs."""
    shown = dict(list(models.items())[: len(ps.PALETTE)])
    units = {q: runs.units[q] for runs in shown.values() for q in QUANTITIES if q in runs.units}
    titles = [q for q in QUANTITIES if q in units][:_PANELS]
    figure, panels = ps.panels_of(len(titles) + 2, 2, 2.0, share=False)
    for panel, quantity in zip(panels, titles, strict=False):
        _response(panel, shown, quantity, units[quantity])
        ps.caption(panel, x=axis)
    for panel, outcome, title in zip(
        panels[len(titles) :],
        (FAILURE, UNKNOWN),
        ("runs in which a bearing failed [%]", "runs whose analysis failed [%]"),
        strict=True,
    ):
        _shares(panel, shown, outcome, title)
        ps.caption(panel, x=axis)
    handles: list[Artist] = [
        Line2D([], [], label=name, **ps.line_of(k)) for k, name in enumerate(shown)
    ]
    handles.append(Patch(color=ps.GREY, alpha=0.2, label="16 to 84 % of the runs"))
    handles.append(
        Line2D([], [], marker="^", linestyle="none", color=ps.GREY, label="beyond: half failed")
    )
    ps.add_legend(figure, handles)
    return figure


def _response(panel: Axes, models: Mapping[str, IntensityRuns], quantity: str, unit: str) -> None:
    largest = max(
        (
            float(values[np.isfinite(values)].max(initial=0.0))
            for runs in models.values()
            if quantity in runs.units
            for values in fractiles(runs, quantity).values()
        ),
        default=0.0,
    )
    factor, text = (1e2, "%") if "drift" in quantity else ps.engineering(unit, largest)
    for k, runs in enumerate(models.values()):
        if quantity not in runs.units:
            continue
        found = fractiles(runs, quantity)
        scales = np.array(list(found))
        low, middle, high = factor * np.array(list(found.values())).T
        look = ps.line_of(k)
        panel.plot(
            scales, np.where(np.isinf(middle), np.nan, middle), marker="o", markersize=3.0, **look
        )
        top = np.where(np.isinf(high), 1.15 * factor * largest, high)
        there = np.isfinite(low)
        panel.fill_between(
            scales[there], low[there], top[there], color=look["color"], alpha=0.15, linewidth=0.0
        )
        lost = scales[np.isinf(middle)]
        panel.plot(
            lost,
            np.full(len(lost), 1.1 * factor * largest),
            marker="^",
            linestyle="none",
            color=look["color"],
            markersize=5.0,
        )
    panel.set_ylim(0.0, 1.15 * factor * largest or 1.0)
    ps.caption(panel, title=f"{quantity} [{text}]")


def _shares(panel: Axes, models: Mapping[str, IntensityRuns], outcome: str, title: str) -> None:
    every = sorted({s for runs in models.values() for s in runs.table["scale"].tolist()})
    place = {scale: k for k, scale in enumerate(every)}
    width = 2.0 * _LINE / len(models)
    for k, runs in enumerate(models.values()):
        each = by_factor(runs)
        shares = [100.0 * float((own.of("outcome") == outcome).mean()) for own in each.values()]
        places = [place[one] - _LINE + (k + 0.5) * width for one in each]
        look: dict[str, Any] = {"color": ps.PALETTE[k], "width": 0.9 * width}
        panel.bar(places, shares, **look)
    panel.set_xticks(range(len(every)), [f"{scale:g}" for scale in every])
    panel.set_ylim(0.0, 100.0)
    ps.caption(panel, title=title)


_NAMES = "displacement drift floor_plan base_shear rim_force slip displacement_left slip_left"
_TITLES = [TABLE[name].title for name in _NAMES.split()]
QUANTITIES = (*_TITLES, f"{TABLE['base_shear'].title} over weight", DUCTILITY)
"""Quantities of runs on the page, if a structure has them."""

FRACTILES = (0.16, 0.5, 0.84)


def runs_by_model(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], intensity: IntensityMeasure | None = None
) -> dict[str, IntensityRuns]:
    """Return the runs of each structure, all sets of parameters together."""
    measure = intensity or Intensity(kind="scale")
    names = dict.fromkeys(str(name) for name in data["model"].to_numpy())
    return {
        name: IntensityRuns.from_dataset(data, motions, measure, model=name, parameters="all")
        for name in names
    }


def by_factor(runs: IntensityRuns) -> dict[float, IntensityRuns]:
    """Return runs by the factor on the motions, rising."""
    found = {factor: own for (factor,), own in runs.by("scale").items()}
    return {factor: found[factor] for factor in sorted(found)}


def fractiles(runs: IntensityRuns, quantity: str) -> dict[float, FloatArray]:
    """Return fractiles of a demand at each factor on the motions.

    Shapes: result (3,).
    """
    found = {}
    for factor, each in by_factor(runs).items():
        demand = each.demand(quantity)
        own = np.sort(demand[~np.isnan(demand)])
        places = [max(math.ceil(part * len(own) - 1e-9) - 1, 0) for part in FRACTILES]
        found[factor] = own[places] if len(own) else np.full(len(FRACTILES), math.nan)
    return found


def response_table(models: Mapping[str, IntensityRuns]) -> pd.DataFrame:
    """Return the results of each structure at each factor on the motions."""
    rows = []
    unbuilt = any((runs.table["outcome"] == UNBUILT).any() for runs in models.values())
    for name, runs in models.items():
        each = {q: fractiles(runs, q) for q in QUANTITIES if q in runs.units}
        for factor, those in by_factor(runs).items():
            own = those.of("outcome")
            row: dict[str, object] = {
                "structure": name,
                "factor": factor,
                "runs": len(own),
                "bearing failed [-]": float((own == FAILURE).mean()),
                "analysis failed [-]": float((own == UNKNOWN).mean()),
            }
            if unbuilt:
                row["not built [-]"] = float((own == UNBUILT).mean())
            for quantity, values in each.items():
                unit = runs.units[quantity].replace("1", "-")
                row[f"{quantity}, median [{unit}]"] = values[factor][1]
                row[f"{quantity}, 84 % [{unit}]"] = values[factor][2]
            rows.append(row)
    return pd.DataFrame(rows)


def failure_table(models: Mapping[str, IntensityRuns]) -> pd.DataFrame:
    """Return the runs that did not go to their end, by structure and cause."""
    rows = []
    for name, runs in models.items():
        table = runs.table
        for status, own in table[table["outcome"] != COMPLETE].groupby("status", sort=False):
            rows.append(
                {
                    "structure": name,
                    "cause": status,
                    "counts as": own["outcome"].iloc[0],
                    "runs": len(own),
                    "share [-]": len(own) / len(table),
                    "from factor": float(own["scale"].min()),
                    "first": f"{own['motion'].iloc[0]} x {own['scale'].iloc[0]:g}: "
                    f"{own['message'].iloc[0]}",
                }
            )
    return pd.DataFrame(rows)
