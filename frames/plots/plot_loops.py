"""Figures of the bearings' motion: force over displacement, and paths in plan."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.plots.drawn_device import device_of, has_device
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import TypeAlias

    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

    Loop: TypeAlias = tuple[FloatArray, FloatArray]
    """Displacement (n, 2) [m] and force over weight (n, 2) [-], along x and y."""

    Capacity: TypeAlias = float | Mapping[str, float] | None
    """Displacement at the rims [m]: one for all systems, or by system."""

_QUIET = 1e-3  # of the other component: a component below moves nothing that a figure shows
_BRIEF = 0.02  # share of the path travelled under forces that a few impacts may take
_OUTSTANDING = 2.0  # times the force of the rest of the path: beyond, peaks are cut
_ROOM = 1.5  # times that force: end of the axis


def hysteresis(
    systems: pick.Systems,
    bearing: str | None = None,
    *,
    force_limit: float | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw force over displacement along x and y, a row of panels for each system.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    bearing : str, optional
        A bearing. Left out: the whole isolation level, its base shear over the mean displacement
        of the bearings.
    force_limit : float, optional
        End of the axis of forces, over weight [-], > 0; infinite shows all. Left out: all, unless
        impacts reach more than twice the force of the other 98 % of the path; they would flatten
        the loops.
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        Force over weight [-] (of the structure, or the static axial force of the bearing). Peaks
        beyond the axis are named by arrows at its ends. A component (x or y) in which no system
        moves is left out.

    Raises
    ------
    ValueError
        If there is no bearing of that name, nothing in the window, or no weight to divide by.

    Examples
    --------
    In the gallery: "Loops of a time history" (docs/gallery/bearing/i_hysteresis.py).
    """
    if force_limit is not None and not force_limit > 0.0:
        msg = f"force_limit = {force_limit} must be greater than 0 [-]: leave it out for a default"
        raise ValueError(msg)
    found = pick.as_systems(systems, start, end)
    if bearing is not None:
        pick.choose_bearing(found, bearing)
    loops = {name: _loop(data, bearing) for name, data in found.items()}
    axes = _moving(loops.values())
    factor, unit = ps.engineering("m", ps.peak_of(u[:, axes] for u, _ in loops.values()))
    peak = ps.peak_of(force[:, axes] for _, force in loops.values())
    limit = max(_telling_force(*loop) for loop in loops.values()) if force_limit is None else peak
    limit = 1.06 * limit if force_limit is None or math.isinf(force_limit) else force_limit
    entries = [(k, axis) for k in range(len(found)) for axis in axes]
    columns = 2 if len(axes) == 2 else ps.COLUMNS[len(found)]
    figure, panels = ps.panels_of(len(entries), columns, 3.2 if len(entries) == 1 else 2.1)
    cut = False
    for place, ((k, axis), panel) in enumerate(zip(entries, panels, strict=True)):
        name, data = list(found.items())[k]
        u, force = factor * loops[name][0][:, axis], loops[name][1][:, axis]
        panel.plot(u, force, color=ps.PALETTE[k], linewidth=0.8)
        cut |= _mark_peaks(panel, u, force, limit)
        title = joined(pick.label_of(name, data), ps.PLANE[axis], by=", ")
        ps.caption(panel, title=ps.wrapped(title, 0.82 * ps.PAGE_WIDTH / columns))
        if place % columns == 0:
            ps.caption(panel, y="force / weight [-]")
        text = ps.text_of(f"displacement {ps.PLANE[axis]}", unit)
        ps.close_column(panel, text, is_last=place + columns >= len(entries))
    panels[0].set_ylim(-(limit or 1.0), limit or 1.0)
    where = "isolation level" if bearing is None else bearing
    ps.add_legend(
        figure,
        _cut_legend() if cut else [],
        title=worded("Force over displacement, {bearing}", bearing=where),
    )
    return figure


def orbits(
    systems: pick.Systems,
    bearing: str | None = None,
    *,
    capacity: Capacity = None,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw the path of a bearing in plan, with its first rim contact as a circle.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    bearing : str, optional
        The bearing; that with the largest displacement in the first result if left out.
    capacity : float or mapping of name to float, optional
        Radius of the circle [m]; infinite for none. Left out, also of a mapping: the lateral
        capacity that the Dataset has of the bearing.
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        A panel for each system, equal scales; the largest displacement and the end are marked. The
        circle is for parallel plates and sliders without slip.

    Raises
    ------
    ValueError
        If there is no bearing or system of that name, or nothing in the window.

    Examples
    --------
    In the gallery: "Orbits of two devices" (docs/gallery/bearing/g_orbits.py).
    """
    found = pick.as_systems(systems, start, end)
    bearing = pick.choose_bearing(found, bearing, "bearing_displacement")
    paths = {
        name: data["bearing_displacement"].sel(bearing=bearing, axis=list(ps.PLANE)).to_numpy()
        for name, data in found.items()
    }
    circles = {name: _capacity(data, bearing) for name, data in found.items()}
    if capacity is not None:
        circles |= pick.of_each(capacity, found, "capacity")
    rims = {name: float(r) for name, r in circles.items() if math.isfinite(r)}
    sizes = [float(np.linalg.norm(path, axis=1).max()) for path in paths.values()]
    largest = max([*sizes, *rims.values()]) or 1.0
    factor, unit = ps.engineering("m", largest)
    columns = ps.COLUMNS[len(found)]
    side = 5.0 if columns == 1 else ps.PAGE_WIDTH / columns + 0.2
    figure, panels = ps.panels_of(len(found), columns, side)
    for place, (panel, (name, data)) in enumerate(zip(panels, found.items(), strict=True)):
        _orbit(panel, factor * paths[name], ps.PALETTE[place])
        if name in rims:
            panel.add_patch(
                Circle((0, 0), factor * rims[name], fill=False, color=ps.GREY, linestyle="--")
            )
        title = ps.wrapped(pick.label_of(name, data, "\n"), 0.82 * ps.PAGE_WIDTH / columns)
        ps.caption(panel, title=title)
        if place % columns == 0:
            ps.caption(panel, y=ps.text_of("y", unit))
        ps.close_column(panel, ps.text_of("x", unit), is_last=place + columns >= len(found))
    panels[0].set_xlim(-1.08 * factor * largest, 1.08 * factor * largest)
    panels[0].set_ylim(-1.08 * factor * largest, 1.08 * factor * largest)
    heading = worded("Path of {bearing}: top plate relative to bottom plate", bearing=bearing)
    ps.add_legend(figure, _orbit_legend(rims.values(), factor, unit), title=heading)
    return figure


def _loop(data: xr.Dataset, bearing: str | None) -> Loop:
    # Motion of a bearing or of the whole level.
    plane = list(ps.PLANE)
    if bearing is None:
        pick.need(data, ("base_shear", "weight"), "name a bearing, to see its own loop")
        u = data["bearing_displacement"].sel(axis=plane).mean("bearing").to_numpy()
        force, weight = data["base_shear"].sel(axis=plane), float(data["weight"])
    else:
        chosen = data.sel(bearing=bearing, axis=plane)
        u, force = chosen["bearing_displacement"].to_numpy(), chosen["bearing_force"]
        weight = float(chosen["static_axial_force"])
    if not weight > 0.0:
        msg = (
            f"the weight on {bearing or 'the bearings'} is {weight:g} N, but forces are "
            "divided by it: add permanent loads to the model"
        )
        raise ValueError(msg)
    return u, force.to_numpy() / weight


def _moving(loops: Iterable[Loop]) -> list[int]:
    # The components in which something happens: of displacement or of force.
    peaks = np.zeros((2, 2))
    for loop in loops:
        peaks = np.maximum(peaks, [np.abs(values).max(axis=0) for values in loop])
    moving = (peaks > _QUIET * peaks.max(axis=1, keepdims=True)).any(axis=0)
    return [axis for axis in (0, 1) if moving[axis]] or [0]


def _telling_force(u: FloatArray, force: FloatArray) -> float:
    # The largest force; a lower value if few impacts exceed all the rest by far.
    peak = float(np.abs(force).max())
    way = np.linalg.norm(np.diff(u, axis=0), axis=1)
    size = np.abs(force[1:]).max(axis=1)
    order = np.argsort(size)
    share = np.cumsum(way[order])
    if not share[-1] > 0.0:
        return peak
    rest = float(size[order][np.searchsorted(share, (1.0 - _BRIEF) * share[-1])])
    return peak if peak <= _OUTSTANDING * rest else _ROOM * rest


def _mark_peaks(panel: Axes, u: FloatArray, force: FloatArray, limit: float) -> bool:
    # An arrowhead and the value at the edge of the panel, beside the curve, for larger values.
    is_cut = False
    for sign, place in ((1.0, "top"), (-1.0, "bottom")):
        step = int(np.argmax(sign * force))
        if sign * force[step] > limit:
            is_cut = True
            arrow = "▲" if sign > 0 else "▼"
            side = "right" if u[step] > 0.0 else "left"
            panel.annotate(
                f"{arrow} {force[step]:.2f}".replace("-", "−"),
                (u[step], sign * limit),
                xytext=(-6.0 if side == "right" else 6.0, -3.0 * sign),
                textcoords="offset points",
                ha=side,
                va=place,
                fontsize=ps.SMALL,
                color=ps.GREY,
                bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.5},
            )
    return is_cut


def _cut_legend() -> list[Artist]:
    label = "value of a peak beyond the axis"
    return [Line2D([], [], label=label, color=ps.GREY, linestyle="", marker="^", markersize=4.5)]


def _capacity(data: xr.Dataset, bearing: str) -> float:
    # First rim contact in the Dataset; without it: no circle.
    return device_of(data, bearing).lateral_capacity if has_device(data) else math.inf


def _orbit(panel: Axes, path: FloatArray, colour: str) -> None:
    panel.plot(path[:, 0], path[:, 1], color=colour, linewidth=0.8)
    far = path[int(np.argmax(np.linalg.norm(path, axis=1)))]
    panel.plot(*far, "o", color="black", markersize=4.0, markerfacecolor="white")
    panel.plot(*path[-1], "s", color="black", markersize=3.5)
    panel.set_aspect("equal")


def _orbit_legend(rims: Iterable[float], factor: float, unit: str) -> list[Artist]:
    entries: list[Artist] = [
        Line2D(
            [],
            [],
            color="black",
            marker="o",
            markerfacecolor="white",
            linestyle="",
            markersize=4.0,
            label="largest displacement",
        ),
        Line2D([], [], color="black", marker="s", linestyle="", markersize=3.5, label="at the end"),
    ]
    sizes = sorted({round(factor * c, 3) for c in rims})
    if sizes:
        text = ", ".join(f"{size:.4g}" for size in sizes)
        entries.append(
            Line2D(
                [],
                [],
                color=ps.GREY,
                linestyle="--",
                label=worded("rim contact at {where}", where=f"{text} {unit}"),
            )
        )
    return entries
