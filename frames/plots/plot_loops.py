"""Figures of the bearings' motion: force over displacement, and paths in plan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from frames.plots.plot_style import (
    GREY,
    PAGE_WIDTH,
    PALETTE,
    PLANE,
    SMALL,
    TITLE,
    Systems,
    add_legend,
    as_systems,
    caption,
    engineering,
    grid_of,
    label_of,
    new_figure,
    peak_of,
    text_of,
    worst_bearing,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

    Capacity: TypeAlias = float | Mapping[str, float] | None
    """Displacement at the rims [m]: one for all systems, or by system; infinite or None: none."""


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
    stopped = any(label_of(name, data) != name for name, data in found.items())  # two-line titles
    figure = new_figure(0.85 + 0.3 * stopped + (PAGE_WIDTH if len(found) > 1 else 5.0) / len(found))
    row = grid_of(figure, 1, len(found), share_x=True, share_y=True)[0]
    for k, (name, data) in enumerate(found.items()):
        _orbit(row[k], factor * paths[name], PALETTE[k])
        if np.isfinite(reach[name]):
            radius = factor * reach[name]
            row[k].add_patch(Circle((0, 0), radius, fill=False, color=GREY, linestyle="--"))
        caption(row[k], x=text_of("x", unit), title=label_of(name, data, "\n"))
    row[0].set_xlim(-1.08 * factor * largest, 1.08 * factor * largest)
    row[0].set_ylim(-1.08 * factor * largest, 1.08 * factor * largest)
    caption(row[0], y=text_of("y", unit))
    heading = f"Path of {name_of}: top plate relative to bottom plate"
    add_legend(figure, _orbit_legend(rims, factor, unit), title=heading)
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
