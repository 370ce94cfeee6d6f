"""Figures of results: loops, orbits, histories, profiles over the height, energies.

Each function takes one Dataset of `frames.time_history`, or several by name for comparison, and
returns a matplotlib Figure of the width of a page; it draws on no display and keeps no state.
Save one with ``figure.savefig("loops.png", dpi=150)``. Colours follow the order of the systems,
so they agree between figures of the same systems.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch

from frames.plot_style import (
    GREY,
    LINES,
    PAGE_WIDTH,
    PALETTE,
    SMALL,
    TITLE,
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
from frames.results import floor_acceleration, storey_drift

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

    Capacity: TypeAlias = float | Mapping[str, float] | None
    """Displacement at the rims [m]: one for all systems, or by system; infinite or None: none."""

PLANE = ("x", "y")

ENERGY_GROUPS: dict[str, tuple[tuple[str, ...], str]] = {
    "low friction, bottom": (("low_friction_bottom",), "#0072B2"),
    "low friction, top": (("low_friction_top",), "#56B4E9"),
    "high-friction interface": (("high_friction",), "#D55E00"),
    "rims": (("rims",), "#CC79A7"),
    "damping of the structure": (("damping",), "#009E73"),
    "axial contact, numerical": (("contact", "numerical"), "#F0E442"),
    "kinetic, elastic, gravity": (("kinetic", "elastic", "gravity"), "#BBBBBB"),
}
"""Terms of the energy drawn together, from below, and their colours."""


def worst_bearing(data: xr.Dataset, variable: str = "interface_slip_size") -> str:
    """Return the name of the bearing with the largest absolute value of a variable.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`.
    variable : str
        A variable over time and bearing.

    Returns
    -------
    str
        Its name, in the dimension "bearing".
    """
    values = np.abs(data[variable])
    peaks = values.max([dim for dim in values.dims if dim != "bearing"])
    return str(data["bearing"].to_numpy()[int(np.argmax(peaks.to_numpy()))])


def hysteresis(
    systems: Systems, bearing: str | None = None, *, force_limit: float | None = None
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
        End of the axis of forces, over weight [-]. A system that goes beyond is marked with its
        peak value: for loops that a few impacts would otherwise flatten.

    Returns
    -------
    Figure
        Force over weight [-] (of the structure, or the static axial force of the bearing).
    """
    found = as_systems(systems)
    loops = {name: _loop(data, bearing) for name, data in found.items()}
    factor, unit = engineering("m", peak_of(u for u, _ in loops.values()))
    limit = 1.06 * peak_of(f for _, f in loops.values()) if force_limit is None else force_limit
    figure = new_figure(0.6 + 2.1 * len(found))
    panels = grid_of(figure, len(found), 2, share_x=True, share_y=True)
    for k, (name, data) in enumerate(found.items()):
        u, force = loops[name]
        for axis, panel in enumerate(panels[k]):
            panel.plot(factor * u[:, axis], force[:, axis], color=PALETTE[k], linewidth=0.8)
            _mark_peak(panel, factor * u[:, axis], force[:, axis], limit)
            caption(panel, title=f"{label_of(name, data)}, {PLANE[axis]}")
        caption(panels[k][0], y="force / weight [-]")
    panels[0][0].set_ylim(-limit, limit)
    for axis, panel in enumerate(panels[-1]):
        caption(panel, x=text_of(f"displacement {PLANE[axis]}", unit))
    where = "isolation level" if bearing is None else bearing
    figure.suptitle(f"Force over displacement, {where}", fontsize=TITLE + 1.0)
    return figure


def orbits(systems: Systems, bearing: str | None = None, *, capacity: Capacity = None) -> Figure:
    """Draw the path of a bearing in plan, with its capacity as a circle.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    bearing : str, optional
        The bearing; that with the largest displacement in the first result if left out.
    capacity : float or mapping of name to float, optional
        Displacement at the first rim contact [m]; infinite where there is no rim.

    Returns
    -------
    Figure
        A panel for each system, equal scales; the largest displacement and the end are marked.
    """
    found = as_systems(systems)
    first = next(iter(found.values()))
    name_of = worst_bearing(first, "bearing_displacement") if bearing is None else bearing
    paths = {
        name: data["bearing_displacement"].sel(bearing=name_of, axis=list(PLANE)).to_numpy()
        for name, data in found.items()
    }
    given = capacity if isinstance(capacity, Mapping) else dict.fromkeys(found, capacity or np.inf)
    reach = {name: float(given.get(name, np.inf)) for name in found}
    rims = [c for c in reach.values() if np.isfinite(c)]
    largest = max([float(np.linalg.norm(p, axis=1).max()) for p in paths.values()] + rims)
    factor, unit = engineering("m", largest)
    figure = new_figure(0.85 + (PAGE_WIDTH if len(found) > 1 else 5.0) / len(found))
    row = grid_of(figure, 1, len(found), share_x=True, share_y=True)[0]
    for k, (name, data) in enumerate(found.items()):
        _orbit(row[k], factor * paths[name], PALETTE[k])
        if np.isfinite(reach[name]):
            radius = factor * reach[name]
            row[k].add_patch(Circle((0, 0), radius, fill=False, color=GREY, linestyle="--"))
        caption(row[k], x=text_of("x", unit), title=label_of(name, data))
    row[0].set_xlim(-1.08 * factor * largest, 1.08 * factor * largest)
    row[0].set_ylim(-1.08 * factor * largest, 1.08 * factor * largest)
    caption(row[0], y=text_of("y", unit))
    heading = f"Path of {name_of}: top plate relative to bottom plate"
    add_legend(figure, _orbit_legend(rims, factor, unit), title=heading)
    return figure


def histories(
    systems: Systems,
    quantities: Sequence[str] = ("displacement", "base_shear", "interface_slip", "axial_force"),
    bearing: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    limits: Mapping[str, float] | None = None,
) -> Figure:
    """Draw quantities over time, one panel each, the systems over one another.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    quantities : sequence of str
        Of `QUANTITIES`: "displacement", "base_shear", "interface_slip", "axial_force",
        "rim_force", "roof_acceleration", "ground_acceleration".
    bearing : str, optional
        The bearing they belong to; that with the largest slip in the first result if left out.
    window : (float, float), optional
        From when to when [s].
    limits : mapping of quantity to float, optional
        Largest value shown, in SI units; peaks beyond it are marked with their value.

    Returns
    -------
    Figure
        The histories.

    Raises
    ------
    ValueError
        If a quantity is unknown, or there is none.
    """
    unknown = [name for name in quantities if name not in QUANTITIES]
    if unknown or not quantities:
        msg = f"quantities = {list(quantities)}: choose one or more of {', '.join(QUANTITIES)}"
        raise ValueError(msg)
    found = as_systems(systems)
    name_of = worst_bearing(next(iter(found.values()))) if bearing is None else bearing
    figure = new_figure(0.8 + 1.55 * len(quantities))
    column = [row[0] for row in grid_of(figure, len(quantities), 1, share_x=True)]
    for quantity, panel in zip(quantities, column, strict=True):
        traces = [QUANTITIES[quantity](data, name_of) for data in found.values()]
        if window is not None:
            traces = [trace.sel(time=slice(*window)) for trace in traces]
        _history(panel, traces, (limits or {}).get(quantity))
    if window is not None:
        column[0].set_xlim(*window)
    else:
        column[0].set_xlim(0.0, max(float(data["time"][-1]) for data in found.values()))
    caption(column[-1], x="time [s]")
    figure.align_ylabels()
    add_legend(figure, system_handles(found), title=f"Histories, {name_of}")
    return figure


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
        drift = 100.0 * np.abs(storey_drift(data)).max(["time", "axis"]).to_numpy()
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
        caption(panel, x="time [s]", title=label_of(name, data))
    caption(row[0], y=text_of("energy since gravity", unit))
    lowest = min(ax.dataLim.y0 for ax in row)
    row[0].set_ylim(min(0.0, 1.05 * lowest), 1.05 * max(ax.dataLim.y1 for ax in row))
    handles: list[Artist] = [Patch(color=c, label=t) for t, (_, c) in ENERGY_GROUPS.items()]
    handles.append(Line2D([], [], color="black", linewidth=0.9, linestyle="--", label="input"))
    add_legend(figure, handles, columns=4, title="Where the energy goes", size=SMALL)
    return figure


def _loop(data: xr.Dataset, bearing: str | None) -> tuple[FloatArray, FloatArray]:
    # Displacement (n, 2) [m] and force over weight (n, 2) of a bearing or of the whole level.
    plane = list(PLANE)
    if bearing is None:
        u = data["bearing_displacement"].sel(axis=plane).mean("bearing").to_numpy()
        return u, data["base_shear"].sel(axis=plane).to_numpy() / float(data["weight"])
    chosen = data.sel(bearing=bearing, axis=plane)
    weight = float(data["static_axial_force"].sel(bearing=bearing))
    return chosen["bearing_displacement"].to_numpy(), chosen["bearing_force"].to_numpy() / weight


def _mark_peak(panel: Axes, u: FloatArray, force: FloatArray, limit: float) -> None:
    # An arrowhead and the value at the edge of the panel, beside the curve, for what lies beyond.
    for sign, place in ((1.0, "top"), (-1.0, "bottom")):
        step = int(np.argmax(sign * force))
        if sign * force[step] > limit:
            arrow = "▲" if sign > 0 else "▼"
            side = "right" if u[step] > 0.0 else "left"
            panel.annotate(
                f"{arrow} {force[step]:.2f}".replace("-", "−"),
                (u[step], sign * limit),
                xytext=(-6.0 if side == "right" else 6.0, -3.0 * sign),
                textcoords="offset points", ha=side, va=place, fontsize=SMALL, color=GREY,
            )  # fmt: skip


def _orbit(panel: Axes, path: FloatArray, colour: str) -> None:
    panel.plot(path[:, 0], path[:, 1], color=colour, linewidth=0.8)
    far = path[int(np.argmax(np.linalg.norm(path, axis=1)))]
    panel.plot(*far, "o", color="black", markersize=4.0, markerfacecolor="white")
    panel.plot(*path[-1], "s", color="black", markersize=3.5)
    panel.set_aspect("equal")


def _orbit_legend(rims: Sequence[float], factor: float, unit: str) -> list[Artist]:
    entries: list[Artist] = [
        Line2D([], [], color="black", marker="o", markerfacecolor="white", linestyle="",
               markersize=4.0, label="largest displacement"),
        Line2D([], [], color="black", marker="s", linestyle="", markersize=3.5, label="at the end"),
    ]  # fmt: skip
    sizes = sorted({round(factor * c, 3) for c in rims})
    if sizes:
        text = ", ".join(f"{size:g}" for size in sizes)
        entries.append(
            Line2D([], [], color=GREY, linestyle="--", label=f"rim contact at {text} {unit}")
        )
    return entries


def _history(panel: Axes, traces: Sequence[xr.DataArray], limit: float | None) -> None:
    units = str(traces[0].attrs["units"])
    peak = peak_of(trace.to_numpy() for trace in traces)
    shown = peak if limit is None else min(limit, peak)
    factor, unit = engineering(units, shown)
    common = all(np.array_equal(_until(t, traces[0]), _until(traces[0], t)) for t in traces)
    for k, trace in enumerate(traces[:1] if common else traces):
        colour, line = (GREY, "-") if common and len(traces) > 1 else (PALETTE[k], LINES[k])
        width = WIDTHS[2] if common and len(traces) > 1 else WIDTHS[k]
        values = factor * trace.to_numpy()
        panel.plot(trace["time"], values, color=colour, linestyle=line, linewidth=width)
    low = min(float(trace.min()) for trace in traces)
    bottom = -1.05 * factor * min(-low, shown) if low < -1e-6 * peak else 0.0
    panel.set_ylim(bottom, (1.08 * factor * shown) or 1.0)
    beyond = [
        (k, factor * float(np.abs(t).max()))
        for k, t in enumerate(traces)
        if limit is not None and float(np.abs(t).max()) > limit
    ]
    for line, (k, value) in enumerate(beyond):
        panel.text(0.985, 0.95 - 0.13 * line, f"▲ {value:.3g}", transform=panel.transAxes,
                   ha="right", va="top", fontsize=SMALL, color=PALETTE[k])  # fmt: skip
    caption(panel, y=text_of(str(traces[0].attrs["long_name"]), unit))


def _until(trace: xr.DataArray, other: xr.DataArray) -> FloatArray:
    # The values as far as the other trace goes.
    return trace.to_numpy()[: len(other)]


def _size_in_plan(values: xr.DataArray, long_name: str, units: str) -> xr.DataArray:
    size = np.sqrt((values.sel(axis=list(PLANE)) ** 2).sum("axis"))
    return size.assign_attrs(long_name=long_name, units=units)


def _displacement(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["bearing_displacement"]
    return _size_in_plan(values.sel(bearing=bearing), "displacement\nin plan", values.units)


def _base_shear(data: xr.Dataset, bearing: str) -> xr.DataArray:
    return _size_in_plan(data["base_shear"] / data["weight"], "base shear\n/ weight", "1")


def _interface_slip(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["interface_slip_size"]
    return values.sel(bearing=bearing).assign_attrs(long_name="interface\nslip")


def _axial_force(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["axial_force"]
    return values.sel(bearing=bearing).assign_attrs(long_name="axial\nforce")


def _rim_force(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["rim_force"]
    largest = values.sel(bearing=bearing).max("surface")
    return largest.assign_attrs(long_name="larger\nrim force", units=values.units)


def _roof_acceleration(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = floor_acceleration(data)
    return _size_in_plan(values.isel(level=-1), "roof acc.\nin plan", values.units)


def _ground_acceleration(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["ground_acceleration"]
    return _size_in_plan(values, "ground acc.\nin plan", values.units)


QUANTITIES: dict[str, Callable[[xr.Dataset, str], xr.DataArray]] = {
    "displacement": _displacement,
    "base_shear": _base_shear,
    "interface_slip": _interface_slip,
    "axial_force": _axial_force,
    "rim_force": _rim_force,
    "roof_acceleration": _roof_acceleration,
    "ground_acceleration": _ground_acceleration,
}
"""Histories by name, as functions of the Dataset and a bearing."""
