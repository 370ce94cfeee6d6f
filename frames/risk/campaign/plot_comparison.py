"""Figure of devices with the same rims under the same records: their fragility, limit by limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from frames.risk.fragility.plot_fragility import shown_intensity

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns

MARKERS = "os^d"
POINTS = 80


def device_curves(
    runs: Mapping[str, IntensityRuns],
    curves: Mapping[str, Mapping[str, Fragility]],
    limits: Sequence[LimitState],
    *,
    confidence: float,
    considered: float | None = None,
) -> Figure:
    """Draw the fragility of devices, a panel a limit state."""
    measure = next(iter(runs.values())).intensity
    factor, label = shown_intensity(measure.unit, measure.label)
    top = 1.05 * max(float(each.table["im"].max()) for each in runs.values())
    at = np.linspace(top / POINTS, top, POINTS)
    figure, panels = ps.panels_of(len(limits), min(3, len(limits)), 2.3, share=False)
    for panel, limit in zip(panels, limits, strict=True):
        for k, (name, each) in enumerate(runs.items()):
            curve = curves.get(limit.name, {}).get(name)
            if curve is not None:
                _curve(panel, curve, at, factor, k, confidence)
            im, shares = shares_exceeded(each, limit)
            color = ps.PALETTE[k]
            panel.plot(factor * im, shares, MARKERS[k], markersize=3.0, color=color)
        if considered is not None:
            panel.axvline(factor * considered, color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_xlim(0.0, factor * top)
        panel.set_ylim(0.0, 1.02)
        ps.caption(panel, x=label, title=limit.name)
    for panel in panels[:: min(3, len(limits))]:
        ps.caption(panel, y="probability [-]")
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.0, **ps.line_of(k))
        for k, name in enumerate(runs)
    ]
    said = "Dotted: maximum considered earthquake" if considered is not None else ""
    ps.add_legend(figure, handles, columns=2, title=said)
    return figure


def shares_exceeded(runs: IntensityRuns, limit: LimitState) -> tuple[np.ndarray, np.ndarray]:
    """Return the intensities of runs, and the share at each that exceeds a limit state."""
    exceeded, im = runs.exceeded(limit), runs.table["im"].to_numpy()
    found = np.unique(im)
    known = [exceeded[(im == one) & ~np.isnan(exceeded)] for one in found]
    return found, np.array([own.mean() if len(own) else np.nan for own in known])


def _curve(
    panel: Axes, curve: Fragility, at: np.ndarray, factor: float, k: int, confidence: float
) -> None:
    table, look = curve.to_dataframe(at, confidence), ps.line_of(k)
    panel.fill_between(
        factor * at, table["low"], table["high"], alpha=0.15, color=look["color"], linewidth=0.0
    )
    panel.plot(factor * at, table["probability"], **look)
