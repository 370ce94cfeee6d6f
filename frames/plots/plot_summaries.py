"""Figures of a whole run: peaks over the height, and where the energy goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames.plots.plot_style import (
    LINES,
    PALETTE,
    PLANE,
    SMALL,
    WIDTHS,
    Systems,
    add_legend,
    as_systems,
    caption,
    engineering,
    grid_of,
    label_of,
    new_figure,
    peak_of,
    system_handles,
    text_of,
)
from frames.results.measures import floor_acceleration, storey_drift

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

ENERGY_GROUPS: dict[str, tuple[tuple[str, ...], str]] = {
    "low friction, bottom": (("low_friction_bottom",), "#0072B2"),
    "low friction, top": (("low_friction_top",), "#56B4E9"),
    "high-friction interface": (("high_friction",), "#D55E00"),
    "rims": (("rims",), "#CC79A7"),
    "damping of the structure": (("damping",), "#009E73"),
    "contact, elastic sliding": (("contact", "friction_elastic", "numerical"), "#F0E442"),
    "kinetic, elastic, gravity": (("kinetic", "elastic", "gravity"), "#BBBBBB"),
}
"""Terms of the energy drawn together, from below, and their colours."""


def storey_profiles(systems: Systems) -> Figure:
    """Draw peak storey drift and peak floor acceleration over the height.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare; of models with two levels or more.

    Returns
    -------
    Figure
        Left the drift of each storey, the larger of x and y [%]; right the total horizontal
        acceleration of each level, its largest size in plan [m/s2].
    """
    found = as_systems(systems)
    figure = new_figure(3.6)
    left, right = grid_of(figure, 1, 2, share_y=True)[0]
    for k, data in enumerate(found.values()):
        z = data["level_height"].to_numpy()
        drift = 100.0 * np.abs(storey_drift(data).to_numpy()).max(axis=(0, 2))
        left.stairs(drift, z, orientation="horizontal", baseline=None, color=PALETTE[k],
                    linestyle=LINES[k], linewidth=WIDTHS[k] + 0.6)  # fmt: skip
        floors = floor_acceleration(data).sel(axis=list(PLANE)).to_numpy()
        peaks = np.linalg.norm(floors, axis=-1).max(axis=0)
        right.plot(peaks, z, color=PALETTE[k], linestyle=LINES[k], marker="os^Dvp"[k],
                   markersize=6.0 - 1.5 * k if k < 3 else 2.0, linewidth=WIDTHS[k])  # fmt: skip
    first = next(iter(found.values()))
    names = [str(name) for name in first["level"].to_numpy()]
    left.set_yticks(first["level_height"].to_numpy(), names)
    caption(left, x="peak storey drift [%]", title="Storey drift")
    caption(right, x="peak total acceleration in plan [m/s²]", title="Floor acceleration")
    left.set_xlim(0.0, 1.06 * left.dataLim.x1)
    right.set_xlim(0.0, 1.06 * right.dataLim.x1)
    add_legend(figure, system_handles(found), title="Peaks over the height")
    return figure


def energy(
    systems: Systems, *, stacked: bool = True, window: tuple[float, float] | None = None
) -> Figure:
    """Draw where the energy of the ground motion goes, over time.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare, a panel each.
    stacked : bool
        Areas on top of one another, which add up to the input; else lines.
    window : (float, float), optional
        From when to when [s].

    Returns
    -------
    Figure
        Energies since gravity; the dashed line is the input.
    """
    found = as_systems(systems)
    factor, unit = engineering("J", peak_of(d["energy"].to_numpy() for d in found.values()))
    figure = new_figure(3.4)
    row = grid_of(figure, 1, len(found), share_x=True, share_y=True)[0]
    for panel, (name, data) in zip(row, found.items(), strict=True):
        time = data["time"].to_numpy()
        groups = [
            factor * data["energy"].sel(term=list(terms)).sum("term").to_numpy()
            for terms, _ in ENERGY_GROUPS.values()
        ]
        colours = [colour for _, colour in ENERGY_GROUPS.values()]
        if stacked:
            panel.stackplot(time, *groups, colors=colours, linewidth=0.0)
        else:
            for values, colour in zip(groups, colours, strict=True):
                panel.plot(time, values, color=colour, linewidth=1.2)
        total = factor * data["energy"].sel(term="input").to_numpy()
        panel.plot(time, total, color="black", linewidth=0.9, linestyle="--")
        panel.set_xlim(*(window or (0.0, max(float(d["time"][-1]) for d in found.values()))))
        caption(panel, x="time [s]", title=label_of(name, data, "\n"))
    caption(row[0], y=text_of("energy since gravity", unit))
    lowest = min(ax.dataLim.y0 for ax in row)
    row[0].set_ylim(min(0.0, 1.05 * lowest), 1.05 * max(ax.dataLim.y1 for ax in row))
    handles: list[Artist] = [Patch(color=c, label=t) for t, (_, c) in ENERGY_GROUPS.items()]
    handles.append(Line2D([], [], color="black", linewidth=0.9, linestyle="--", label="input"))
    add_legend(figure, handles, columns=4, title="Where the energy goes", size=SMALL)
    return figure
