"""Figures of a whole run: peaks over the height, and the energy terms."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.results.floor_spectra import spectra_of
from frames.results.measures import floor_acceleration
from frames.results.peak_response import extreme_of, largest, storeys_of_lines
from frames.results.quantities import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

ENERGY_GROUPS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "low friction, bottom": (("low_friction_bottom",), "#0072B2", ""),
    "low friction, top": (("low_friction_top",), "#56B4E9", ""),
    "high-friction interface": (("high_friction",), "#D55E00", "///"),
    "rims": (("rims",), "#CC79A7", "xxx"),
    "damping of the structure": (("damping",), "#009E73", "\\\\\\"),
    "contact, elastic sliding": (("contact", "friction_elastic", "numerical"), "#E0C800", ""),
    "kinetic, elastic, gravity": (("kinetic", "elastic", "gravity"), "#BBBBBB", "..."),
}
"""Terms of the energy drawn together, from below, their colours and hatches."""

PART_GROUPS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "yielding": (("yielding",), "#8C510A", "+++"),
    "dampers": (("dampers",), "#6A51A3", "|||"),
    "stops, walls": (("stops",), "#444444", ""),
}
"""Energy terms of links and hinges, drawn after the damping if a result has them."""

_AFTER = "damping of the structure"

EDGE = "#333333"
PERIODS = np.geomspace(0.02, 5.0, 120)
"""Periods of the floor spectra [s]."""

MOST_PANELS = 6
_RING: dict[str, Any] = {"marker": "o", "fillstyle": "none", "markersize": 6.0}
_LINES: tuple[Literal["-", "--", "-.", ":"], ...] = (
    "-",
    "--",
    "-",
    ":",
    "-.",
    ":",
    "--",
    "-",
    "-.",
    ":",
)


def storey_profiles(
    systems: pick.Systems, *, start: float | None = None, end: float | None = None
) -> Figure:
    """Draw peak storey drift and peak floor acceleration over the height.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare; of models with two levels or more.
    start, end : float, optional
        Window of time [s] of the peaks.

    Returns
    -------
    Figure
        Left the drift of each storey [%], right the total horizontal acceleration of each level
        [m/s2]: both the largest size of the vector in plan, as in `peaks`. Lines are those of the
        mean of a level's nodes, rings the maximum at any column line or corner. Without a window of
        time: of all steps of the run, also of those that its recording leaves out.

    Raises
    ------
    ValueError
        If a model has fewer than two levels, or nothing is in the window.

    Examples
    --------
    In the gallery: "Storey profiles" (docs/gallery/building/d_profiles.py).
    """
    found = pick.as_systems(systems, start, end)
    figure = ps.new_figure(3.6)
    left, right = ps.grid_of(figure, 1, 2, share_y=True)[0]
    for k, data in enumerate(found.values()):
        pick.need(data, ("node_displacement", "level_height"), "profiles need a frame's levels")
        z = data["level_height"].to_numpy()
        of = partial(_peaks, data, whole=start is None and end is None)
        left.stairs(
            100.0 * of("drift"), z, orientation="horizontal", baseline=None, **ps.line_of(k, 0.6)
        )
        right.plot(
            of("floor_plan"),
            z,
            marker="os^Dvp"[k],
            markersize=6.0 - 1.5 * k if k < 3 else 2.0,
            **ps.line_of(k),
        )
        _corners(left, right, data, k, of)
    first = next(iter(found.values()))
    names = [str(name) for name in first["level"].to_numpy()]
    left.set_yticks(first["level_height"].to_numpy(), names)
    ps.caption(left, x="peak drift, resultant in plan [%]", title="Storey drift")
    ps.caption(right, x="peak total, resultant in plan [m/s²]", title="Floor acceleration")
    left.set_xlim(0.0, 1.06 * left.dataLim.x1)
    right.set_xlim(0.0, 1.06 * right.dataLim.x1)
    ring = Line2D([], [], color=ps.GREY, linestyle="", label="worst corner", **_RING)
    ps.add_legend(figure, [*pick.system_handles(found), ring], title="Peaks over the height")
    return figure


def floor_spectra(
    systems: pick.Systems,
    *,
    level: str | None = None,
    axis: Literal["x", "y", "z"] = "x",
    damping: float = 0.05,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw response spectra of floors, for equipment on them.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare; of models with levels.
    level : str, optional
        Name of a level; all levels in one panel each if None.
    axis : {"x", "y", "z"}
        Direction.
    damping : float
        Damping ratio of the equipment [-].
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        Pseudo-acceleration [m/s2] over the period [s].

    Raises
    ------
    ValueError
        If there is no level of that name, or nothing is in the window.

    Examples
    --------
    In the gallery: "Floor spectra" (docs/gallery/building/e_floor_spectra.py).
    """
    found = pick.as_systems(systems, start, end)
    first = next(iter(found.values()))
    pick.need(first, ("node_acceleration", "level_node"), "spectra need a frame's levels")
    names = [str(name) for name in first["level"].to_numpy()]
    if level is not None and level not in names:
        msg = f"level = {level!r}: the model has the levels {', '.join(names) or 'none'}"
        raise ValueError(msg)
    shown = names[::-1] if level is None else [level]
    shown = shown[:MOST_PANELS]
    columns = ps.COLUMNS[len(shown)]
    figure, panels = ps.panels_of(len(shown), columns, 2.5)
    for k, data in enumerate(found.values()):
        motions = floor_acceleration(data).sel(level=shown, axis=[axis])
        spectra = spectra_of(motions, PERIODS, damping).sel(axis=axis)
        for panel, name in zip(panels, shown, strict=True):
            panel.plot(PERIODS, spectra.sel(level=name), **ps.line_of(k))
    for place, (panel, name) in enumerate(zip(panels, shown, strict=True)):
        panel.set_xscale("log")
        ps.caption(panel, title=name, y="m/s²" if place % columns == 0 else None)
        ps.close_column(panel, "period [s]", is_last=place + columns >= len(shown))
    panels[0].set_ylim(bottom=0.0)
    panels[0].set_xlim(PERIODS[0], PERIODS[-1])
    title = f"Floor spectra along {axis}, pseudo-acceleration at {100.0 * damping:g} % damping"
    ps.add_legend(figure, pick.system_handles(found), title=title)
    return figure


def _peaks(data: xr.Dataset, name: str, *, whole: bool) -> FloatArray:
    # Peak of a quantity in the whole run, or in the window of `data`.
    if whole:
        return largest(data, name).values
    return extreme_of(QUANTITIES[name].of(data), data["time"].to_numpy()).values


def _corners(
    left: Axes, right: Axes, data: xr.Dataset, place: int, of: Callable[[str], FloatArray]
) -> None:
    # The largest drift at any column line of each storey, the worst node of each level.
    if "node_position" not in data:
        return  # a file of an earlier version
    z, levels = data["level_height"].to_numpy(), data["level"].to_numpy()
    storeys = np.array(storeys_of_lines(data)[1])
    each = 100.0 * of("line_drift") if len(storeys) else np.zeros(0)
    own = [each[storeys == name] for name in levels[1:]]
    style: dict[str, Any] = {"color": ps.line_of(place)["color"], "linestyle": "", **_RING}
    drifts = [sizes.max() if len(sizes) else np.nan for sizes in own]
    left.plot(drifts, 0.5 * (z[1:] + z[:-1]), **style)
    on, peaks = data["level_node"].to_numpy(), of("node_plan")
    right.plot([peaks[on == k].max() for k in range(len(levels))], z, **style)


def energy(
    systems: pick.Systems,
    *,
    stacked: bool = True,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw the energy of the ground motion and its terms, over time.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare, a panel each.
    stacked : bool
        Areas on top of one another, which add up to the input; else lines.
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        Energies since gravity; the dashed line is the input.

    Raises
    ------
    ValueError
        If nothing is in the window, or the Dataset has no energies.

    Examples
    --------
    In the gallery: "Energy balance" (docs/gallery/building/f_energy.py).
    """
    found = pick.as_systems(systems, start, end)
    for data in found.values():
        pick.need(data, ("energy",), "draw from the whole result of time_history")
    factor, unit = ps.engineering("J", ps.peak_of(d["energy"].to_numpy() for d in found.values()))
    columns, groups = ps.COLUMNS[len(found)], energy_groups(found)
    figure, panels = ps.panels_of(len(found), columns, 2.8)
    for place, (panel, (name, data)) in enumerate(zip(panels, found.items(), strict=True)):
        _energies(panel, data, factor, groups, stacked=stacked)
        title = ps.wrapped(pick.label_of(name, data, "\n"), 0.82 * ps.PAGE_WIDTH / columns)
        ps.caption(panel, title=title)
        if place % columns == 0:
            ps.caption(panel, y=ps.text_of("energy since gravity", unit))
        ps.close_column(panel, "time [s]", is_last=place + columns >= len(found))
    first = min(float(data["time"][0]) for data in found.values())
    last = max(float(data["time"][-1]) for data in found.values())
    panels[0].set_xlim(first if start is None else start, last if end is None else end)
    lowest = min(panel.dataLim.y0 for panel in panels)
    panels[0].set_ylim(min(0.0, 1.05 * lowest), (1.05 * max(p.dataLim.y1 for p in panels)) or 1.0)
    handles: list[Artist] = [
        Patch(facecolor=colour, hatch=hatch, edgecolor=EDGE, linewidth=0.4, label=text)
        if stacked
        else Line2D([], [], color=colour, linestyle=_LINES[k], linewidth=1.2, label=text)
        for k, (text, (_, colour, hatch)) in enumerate(groups.items())
    ]
    handles.append(Line2D([], [], color="black", linewidth=0.9, linestyle="--", label="input"))
    ps.add_legend(figure, handles, columns=4, title="Where the energy goes", size=ps.SMALL)
    return figure


def energy_groups(
    systems: Mapping[str, xr.Dataset],
) -> dict[str, tuple[tuple[str, ...], str, str]]:
    """Return the groups of terms that a figure of these results shows."""
    found = {}
    for text, group in ENERGY_GROUPS.items():
        found[text] = group
        if text == _AFTER:
            found |= {name: own for name, own in PART_GROUPS.items() if _is_there(systems, own[0])}
    return found


def _is_there(systems: Mapping[str, xr.Dataset], terms: tuple[str, ...]) -> bool:
    # True if a result has energy in one of the terms.
    energies = (data["energy"].sel(term=list(terms)).to_numpy() for data in systems.values())
    return ps.peak_of(energies) > 0.0


def _energies(
    panel: Axes,
    data: xr.Dataset,
    factor: float,
    shown: Mapping[str, tuple[tuple[str, ...], str, str]],
    *,
    stacked: bool,
) -> None:
    time, terms = data["time"].to_numpy(), factor * data["energy"]
    groups = [terms.sel(term=list(names)).sum("term").to_numpy() for names, _, _ in shown.values()]
    colours = [colour for _, colour, _ in shown.values()]
    if stacked:
        hatches = [hatch for _, _, hatch in shown.values()]
        for area, hatch in zip(
            panel.stackplot(time, *groups, colors=colours, linewidth=0.3, edgecolor=EDGE),
            hatches,
            strict=True,
        ):
            area.set_hatch(hatch)
    else:
        for values, colour, line in zip(groups, colours, _LINES, strict=False):
            panel.plot(time, values, color=colour, linestyle=line, linewidth=1.2)
    total = terms.sel(term="input").to_numpy()
    panel.plot(time, total, color="black", linewidth=0.9, linestyle="--")
