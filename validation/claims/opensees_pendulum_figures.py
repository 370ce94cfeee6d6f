"""The figures of the comparison with elements of OpenSees."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.lines import Line2D

from frames.plots.plot_style import PALETTE, add_legend, caption, grid_of, new_figure, style

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from validation.claims.opensees_loops import Loop
    from validation.opensees.runs import Track

SHOWN = 15.0  # s, of the histories
OURS, THEIRS = 3.2, 0.9  # pt; so that equal curves show both
COLOURS = tuple(PALETTE[k] for k in (5, 1, 0, 3, 2))  # a light one below


def loops(found: Mapping[str, Loop], load: float) -> Figure:
    """Draw the loop of the bearing, the first one, under that of each element of OpenSees."""
    drawn = new_figure(4.9)
    panels = [panel for row in grid_of(drawn, 2, 2, share_x=True, share_y=True) for panel in row]
    (name, ours), *others = found.items()
    for panel, (other, loop), colour in zip(panels, others, COLOURS[1:], strict=True):
        panel.plot(1e3 * ours.path, ours.force / load, color=COLOURS[0], linewidth=OURS)
        panel.plot(1e3 * loop.path, loop.force / load, color=colour, linewidth=THEIRS)
        caption(panel, title=other)
    for panel in panels[2:]:
        caption(panel, x="displacement [mm]")
    for panel in panels[::2]:
        caption(panel, y="lateral force / load [-]")
    add_legend(drawn, _handles(name, list(found)[1:]), title="Quasi-static cycle")
    return drawn


def newhall(found: Mapping[str, Track], load: float) -> Figure:
    """Draw displacement over time and loops of the bearing, the first one, and of the others."""
    drawn = new_figure(4.9)
    grid = drawn.add_gridspec(2, 2, height_ratios=(1.0, 1.3))
    history = drawn.add_subplot(grid[0, :])
    sides = [drawn.add_subplot(grid[1, k]) for k in (0, 1)]
    (name, ours), *others = found.items()
    for panel in (history, *sides):
        style(panel)
    _history(history, ours, 0)
    for k, (side, (other, track)) in enumerate(zip(sides, others, strict=True), start=1):
        _history(history, track, k)
        _loop(side, ours, load, 0)
        _loop(side, track, load, k)
        caption(side, x="displacement [mm]", y="lateral force / load [-]", title=other)
    history.set_xlim(0.0, SHOWN)
    caption(history, x="time [s]", y="displacement [mm]")
    add_legend(drawn, _handles(name, list(found)[1:]), title="A mass on one bearing, Newhall 360")
    return drawn


def _history(panel: Axes, track: Track, k: int) -> None:
    panel.plot(track.time, 1e3 * track.displacement[:, 0], color=COLOURS[k], linewidth=_width(k))


def _loop(panel: Axes, track: Track, load: float, k: int) -> None:
    u, force = 1e3 * track.displacement[:, 0], track.force[:, 0] / load
    panel.plot(u, force, color=COLOURS[k], linewidth=_width(k))


def _width(k: int) -> float:
    return THEIRS if k else OURS


def _handles(first: str, others: list[str]) -> list[Artist]:
    names = [first, *others]
    return [
        Line2D([], [], color=COLOURS[k], linewidth=_width(k), label=name)
        for k, name in enumerate(names)
    ]
