"""Figure of a campaign: response over the factor on the motions, with the shares that failed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames.plots import plot_style as ps
from frames.risk.campaign.response import QUANTITIES, fractiles
from frames.risk.fragility.runs import FAILURE, UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.risk.fragility.runs import IntensityRuns

_PANELS = 4  # of responses, at most; the last panel has the shares
_LINE = 0.42  # share of the place of a factor that bars take


def response_by_factor(
    models: Mapping[str, IntensityRuns], *, axis: str = "factor on the motions"
) -> Figure:
    """Draw what structures reached over the factor on the motions, and how many runs failed."""
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
        scale, found = runs.table["scale"].to_numpy(), runs.table["outcome"].to_numpy()
        own = sorted(set(scale.tolist()))
        shares = [100.0 * float((found[scale == one] == outcome).mean()) for one in own]
        places = [place[one] - _LINE + (k + 0.5) * width for one in own]
        look: dict[str, Any] = {"color": ps.PALETTE[k], "width": 0.9 * width}
        panel.bar(places, shares, **look)
    panel.set_xticks(range(len(every)), [f"{scale:g}" for scale in every])
    panel.set_ylim(0.0, 100.0)
    ps.caption(panel, title=title)
