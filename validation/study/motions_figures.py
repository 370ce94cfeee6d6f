"""The figures of the study of motions, from its numbers alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from validation.study.motions_runs import (
    MAIN_SCALES,
    PERIOD_RATIOS,
    PHASES,
    PULSE_SCALES,
    PULSE_STEP,
    TRIED,
    Pulse,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

SHOCKS_FIGURE, PULSES_FIGURE = "study_motions-seconds.png", "study_motions-pulses.png"
MARKERS = "osd"


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {SHOCKS_FIGURE: _seconds(found), PULSES_FIGURE: _pulses(found)}


def _seconds(found: Found) -> Figure:
    figure = ps.new_figure(3.2)
    (panels,) = ps.grid_of(figure, 1, len(found["seconds"]), share_x=True, share_y=True)
    for panel, (second, own) in zip(panels, found["seconds"].items(), strict=True):
        for k, name in enumerate(TRIED):
            look = ps.line_of(k)
            rows = own[name]
            at = [row["scale"] for row in rows]
            share = [_share(row["collapsed"], row["known"]) for row in rows]
            intact = [_share(*row["intact"]) for row in rows]
            panel.plot(at, share, marker=MARKERS[k], markersize=4.0, **look)
            panel.plot(at, intact, color=look["color"], linestyle=":", linewidth=0.8)
        panel.set_xticks(MAIN_SCALES)
        panel.set_ylim(-3.0, 103.0)
        ps.caption(panel, title=ps.wrapped(second, 1.7), x="Sa, first [m/s2]")
    ps.caption(panels[0], y="collapse in the second [%]")
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=4.0, **ps.line_of(k))
        for k, name in enumerate(TRIED)
    ]
    handles.append(
        Line2D([], [], label="intact, second alone", color=ps.GREY, linestyle=":", linewidth=0.8)
    )
    ps.add_legend(figure, handles, columns=3)
    return figure


def _share(part: int, whole: int) -> float:
    # Per cent; a gap where there is none.
    return 100.0 * part / whole if whole else float("nan")


def _pulses(found: Found) -> Figure:
    figure = ps.new_figure(3.2)
    (panels,) = ps.grid_of(figure, 1, len(PHASES), share_x=True, share_y=True)
    top = PULSE_STEP * PULSE_SCALES[-1]
    for panel, kind in zip(panels, PHASES, strict=True):
        for k, name in enumerate(TRIED):
            look = ps.line_of(k)
            rows = [found["pulses"][name][Pulse(ratio, kind).name] for ratio in PERIOD_RATIOS]
            at = [top if row["high"] is None else row["high"] for row in rows]
            panel.plot(PERIOD_RATIOS, at, **look)
            for ratio, value, row in zip(PERIOD_RATIOS, at, rows, strict=True):
                panel.plot(
                    [ratio],
                    [value],
                    MARKERS[k],
                    markersize=4.5,
                    color=look["color"],
                    markerfacecolor="white" if row["high"] is None else look["color"],
                )
        panel.set_ylim(0.0, 1.05 * top)
        ps.caption(panel, title=f"{kind} velocity", x="T_p / T_iso [-]")
    ps.caption(panels[0], y="first collapse, Sa(3 s) [m/s2]")
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=4.5, **ps.line_of(k))
        for k, name in enumerate(TRIED)
    ]
    ps.add_legend(figure, handles, columns=3)
    return figure
