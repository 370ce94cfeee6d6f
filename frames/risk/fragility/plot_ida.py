"""Figures of incremental dynamic analyses and of multiple stripes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from frames.risk._errors import FragilityError
from frames.risk.fragility.incremental import IDA
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.plot_fragility import shown_intensity
from frames.risk.fragility.runs import COMPLETE, FAILURE, IntensityRuns
from lir_element.argument_checks import require_choice, require_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

MARKED = 0.06
"""Space to the right of the demands for marks of failed bearings, over their width [-]."""


def ida_curves(
    found: IDA,
    quantity: str,
    *,
    limit: LimitState | None = None,
    percent: Sequence[float] = (16.0, 50.0, 84.0),
) -> Figure:
    """Draw the curves of an incremental dynamic analysis and their fractiles.

    Parameters
    ----------
    found : IDA
        The analysis.
    quantity : str
        A quantity of `frames.peaks`: the demand.
    limit : LimitState, optional
        Drawn as a line if it is a limit of the quantity.
    percent : sequence of float
        Fractiles [%].

    Returns
    -------
    Figure
        Intensities over demands; a curve ends flat if a bearing failed.

    Raises
    ------
    FragilityError
        If the quantity is not known.

    Examples
    --------
    In the gallery: "Incremental dynamic analysis" (docs/gallery/research/a_ida.py).
    """
    require_type("found", found, IDA, "an IDA")
    runs = found.runs
    require_choice("quantity", quantity, tuple(runs.units), error=FragilityError)
    demand = runs.demand(quantity)
    is_drawn = limit is not None and limit.quantity == quantity
    goal = limit.limit or 0.0 if limit is not None and is_drawn else 0.0
    largest = max(goal, float(_finite(demand).max(initial=0.0)))
    factor, unit = ps.engineering(runs.units[quantity], largest)
    size, text = shown_intensity(runs.intensity.unit, runs.intensity.label)
    end = 1.08 * factor * largest or 1.0
    figure = ps.new_figure(4.2)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    ends = found.capacities(LimitState.bearing_failure())
    thin: dict[str, Any] = {"color": "#999999", "linewidth": 0.7}
    for motion, at in ends.iterrows():
        curve = found.curve(str(motion), quantity)
        holds = curve[(curve["demand"] < np.inf) & (curve["im"] <= at["capacity"])]
        shown = [0.0, *(factor * holds["demand"])]
        panel.plot(shown, [0.0, *(size * holds["im"])], marker=".", markersize=2.5, **thin)
        if not at["censored"]:
            panel.plot([shown[-1], end], [size * at["capacity"]] * 2, linestyle=":", **thin)
    handles: list[Artist] = [
        Line2D([], [], label="a motion", marker=".", markersize=4.0, **thin),
        Line2D([], [], label="failure of a bearing", linestyle=":", **thin),
    ]
    table = found.fractiles(quantity, percent=percent)
    for k, name in enumerate(table):
        look = ps.line_of(k % len(ps.PALETTE), 0.4)
        values = factor * table[name].to_numpy()
        known = np.isfinite(values)
        x, y = values[known], size * table.index.to_numpy()[known]
        if np.isinf(values).any() and known.any():
            x, y = np.append(x, end), np.append(y, y[-1])
        panel.plot([0.0, *x], [0.0, *y], **look)
        handles.append(Line2D([], [], label=f"{name} fractile of the demand", **look))
    if limit is not None and is_drawn:
        panel.axvline(factor * goal, color=ps.GREY, linewidth=1.0, linestyle="--")
        handles.append(Line2D([], [], label=limit.name, color=ps.GREY, linestyle="--"))
    panel.set_xlim(0.0, end)
    panel.set_ylim(bottom=0.0)
    ps.caption(panel, x=ps.text_of(quantity, unit), y=text)
    title = f"Incremental dynamic analysis, {len(ends)} motions"
    ps.add_legend(figure, handles, columns=3, title=title, size=ps.SMALL)
    return figure


def stripes(runs: IntensityRuns, quantity: str, *, limit: LimitState | None = None) -> Figure:
    """Draw demands over intensities: multiple stripes, or a cloud.

    Parameters
    ----------
    runs : IntensityRuns
        The runs.
    quantity : str
        A quantity of `frames.peaks`: the demand.
    limit : LimitState, optional
        Drawn as a line if it is a limit of the quantity; runs that exceed it are filled.

    Returns
    -------
    Figure
        A mark a run; failures of bearings at the right edge, numerical failures not at all (the
        title counts them).

    Raises
    ------
    FragilityError
        If the quantity is not known.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Intensity, multiple_stripes
    >>> from frames.risk.plots import stripes
    >>> frame, pulse = example(1.0)
    >>> intensity = Intensity(kind="PGA", measure="x")
    >>> runs = multiple_stripes(frame, pulse, [0.5, 1.0], intensity=intensity, workers=1)
    >>> figure = stripes(runs, "bearing displacement")
    """
    require_type("runs", runs, IntensityRuns, "IntensityRuns")
    require_choice("quantity", quantity, tuple(runs.units), error=FragilityError)
    demand, im = runs.demand(quantity), runs.of("im")
    outcome = runs.of("outcome")
    largest = float(_finite(demand).max(initial=0.0))
    factor, unit = ps.engineering(runs.units[quantity], largest)
    size, text = shown_intensity(runs.intensity.unit, runs.intensity.label)
    end = factor * largest * (1.0 + MARKED) or 1.0
    over = np.zeros(len(im), dtype=bool) if limit is None else runs.exceeded(limit) > 0.5
    figure = ps.new_figure(3.9)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    handles: list[Artist] = []
    done, fell = outcome == COMPLETE, outcome == FAILURE
    handles += _marks(panel, factor * demand, size * im, done & ~over, "none", "complete")
    if limit is not None:
        handles += _marks(
            panel, factor * demand, size * im, done & over, ps.PALETTE[0], f"exceeds: {limit.name}"
        )
        if limit.quantity == quantity and limit.limit is not None:
            panel.axvline(factor * limit.limit, color=ps.GREY, linewidth=1.0, linestyle="--")
    handles += _marks(
        panel,
        np.full(len(im), end),
        size * im,
        fell,
        ps.PALETTE[1],
        "failure of a bearing",
        color=ps.PALETTE[1],
        marker=">",
    )
    panel.set_xlim(0.0, end)
    panel.set_ylim(bottom=0.0)
    ps.caption(panel, x=ps.text_of(quantity, unit), y=text)
    failed = int((~done & ~fell).sum())
    more = f", {failed} failed numerically" if failed else ""
    title = f"{len(im)} runs under {len(runs.motions)} motions{more}"
    ps.add_legend(figure, handles, columns=3, title=title)
    return figure


def _marks(
    panel: Axes,
    x: FloatArray,
    y: FloatArray,
    which: FloatArray,
    fill: str,
    label: str,
    color: str = ps.PALETTE[0],
    marker: str = "o",
) -> list[Artist]:
    if not which.any():
        return []
    look: dict[str, Any] = {
        "linestyle": "none",
        "marker": marker,
        "markersize": 4.0,
        "markeredgewidth": 0.8,
        "color": color,
        "markerfacecolor": fill,
    }
    panel.plot(x[which], y[which], clip_on=False, **look)
    return [Line2D([], [], label=label, **look)]


def _finite(values: FloatArray) -> FloatArray:
    return values[np.isfinite(values)]
