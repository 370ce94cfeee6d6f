"""Figures of parts that yield: hinges in space, and force over deformation of links."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from frames.assembly.assemble import assemble
from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.plots.model_geometry import hinge_places, member_lines
from frames.plots.plot_model import AT_REST, frame_of
from frames.recording.recovery import require_own
from frames.results.formulas import hinge_rotation
from frames.results.peak_response import final_value, largest

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

    from frames._types import FloatArray, IntArray
    from frames.model.frame_data import FrameData


YIELDED = 1e-9
"""Plastic rotation from which on a hinge counts as yielded [rad]."""

CLASSES = ("elastic", "yielded, up to IO", "IO to LS", "LS to CP", "beyond CP")
"""States of a hinge with acceptance limits."""

COLOURS = ("white", "#56B4E9", "#F0E442", "#E69F00", "#B2182B")
_SIZE = 26.0  # pt2


def hinge_map(
    model: FrameData,
    data: xr.Dataset,
    time: float | None = None,
    *,
    limits: Sequence[float] | None = None,
) -> Figure:
    """Draw the plastic hinges of a model in space, coloured by their plastic rotation.

    Parameters
    ----------
    model : Frame
        The model.
    data : xarray.Dataset
        Time history of the model.
    time : float, optional
        Instant [s]; the largest rotations of the run, for any recording, if None.
    limits : sequence of 3 floats, optional
        Plastic rotations [rad] up to which a hinge is acceptable for Immediate Occupancy, Life
        Safety and Collapse Prevention (IO, LS, CP; ASCE/SEI 41, chapters 9 and 10).

    Returns
    -------
    Figure
        The undeformed model with a circle at each hinge: white if it stayed elastic, else coloured
        by the size of its rotation about both axes [rad], or by class; the legend counts.

    Raises
    ------
    ModelError
        If the time history is not one of this model.
    ValueError
        If it has no hinges, the instant is outside of it, or the limits do not grow from 0.

    Examples
    --------
    In the gallery: "Plastic hinges" (docs/gallery/building/g_hinges.py).
    """
    bounds = None if limits is None else _bounds(limits)
    system = assemble(model)
    require_own(model, system, data)
    if "hinge" not in data.dims:
        msg = "the model has no plastic hinges: Frame.add_hinges puts them at members' ends"
        raise ValueError(msg)
    rotation, when = _rotations(data, time)
    still = np.zeros((len(system.node_names), 6))
    lines = member_lines(system.members, system.coordinates, still)
    names, points = hinge_places(lines, system, model.hinges)
    order = {str(name): k for k, name in enumerate(data["hinge"].to_numpy())}
    sizes = rotation[[order[name] for name in names]]
    figure = ps.new_figure(5.2)
    panel: Any = figure.add_subplot(projection="3d")
    bars = Line3DCollection(list(lines), colors=AT_REST, linewidths=0.9)
    panel.add_collection3d(bars).set_clip_on(False)
    classes = _classes(sizes, bounds)
    scale = ScalarMappable(Normalize(0.0, float(sizes.max()) or 1.0), "YlOrRd")
    faces = (
        np.where((classes > 0)[:, None], scale.to_rgba(sizes), 1.0)
        if bounds is None
        else np.array(COLOURS)[classes]
    )
    grown = _SIZE * np.where(classes > 0, 1.0, 0.45)
    circles = panel.scatter(
        *points.T, s=grown, c=faces, edgecolors="black", linewidths=0.5, depthshade=False
    )
    circles.set_clip_on(False)
    frame_of(panel, [system.coordinates])
    if bounds is None and sizes.max() > YIELDED:
        bar = figure.colorbar(scale, ax=panel, shrink=0.6, pad=0.1)
        bar.set_label("plastic rotation [rad]", fontsize=ps.LABEL)
        bar.ax.tick_params(labelsize=ps.SMALL)
    title = f"Hinges of {pick.label_of(model.name, data)}, {when}"
    ps.add_legend(figure, _legend(classes, bounds), columns=5, title=title, size=ps.SMALL)
    return figure


def _bounds(limits: Sequence[float]) -> FloatArray:
    found = np.asarray(limits, dtype=np.float64)
    if found.shape != (3,) or not (np.diff([0.0, *found]) > 0.0).all():
        msg = f"limits = {limits!r}: give three growing rotations (IO, LS, CP) [rad], above 0"
        raise ValueError(msg)
    return found


def _rotations(data: xr.Dataset, time: float | None) -> tuple[FloatArray, str]:
    # Sizes of the plastic rotations (hinge,), and of when they are.
    if time is None:
        return largest(data, "hinge_rotation").values, "largest of the run"
    step = pick.step_at(data, time)
    return hinge_rotation(data.isel(time=[step]))[0], f"at {float(data['time'][step]):.3f} s"


def _classes(sizes: FloatArray, bounds: FloatArray | None) -> IntArray:
    # 0 elastic, 1 yielded, then by the limits that are exceeded.
    classes = (sizes > YIELDED).astype(np.int64)
    return classes if bounds is None else classes + (sizes[:, None] > bounds).sum(axis=1)


def _legend(classes: IntArray, bounds: FloatArray | None) -> list[Artist]:
    labels = ("elastic", "yielded") if bounds is None else CLASSES
    colours = ("white", "#FD8D3C") if bounds is None else COLOURS
    style: dict[str, Any] = {"linestyle": "", "marker": "o", "markeredgecolor": "black"}
    return [
        Line2D(
            [],
            [],
            markerfacecolor=colour,
            label=f"{label}: {int((classes == k).sum())}",
            markersize=5.0 if k else 3.6,
            markeredgewidth=0.5,
            **style,
        )
        for k, (label, colour) in enumerate(zip(labels, colours, strict=True))
    ]


MOST = 6
"""Panels of a figure."""


def link_loops(
    systems: pick.Systems,
    links: str | Collection[str] | None = None,
    *,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw force over deformation of links, a panel for each link.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    links : str or sequence of str, optional
        Names of one to six links; by default those with the largest work in the first result.
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        Loops in mm and kN, of rotational links in mrad and kN m; dotted lines at the yield
        deformation, on the sides that reached it.

    Raises
    ------
    ValueError
        If there are no links, none of a name, or nothing in the window.

    Examples
    --------
    In the gallery: "Storeys that yield" (docs/gallery/building/h_storeys.py).
    """
    found = pick.as_systems(systems, start, end)
    shown = _chosen(found, links)
    columns = ps.COLUMNS[len(shown)]
    height = 3.2 if len(shown) == 1 else 2.3
    figure, panels = ps.panels_of(len(shown), columns, height, share=False)
    for place, (panel, name) in enumerate(zip(panels, shown, strict=True)):
        for k, data in enumerate(found.values()):
            one = data.sel(link=name)
            style = ps.line_of(k) | {"linewidth": 0.8, "linestyle": "-"}
            panel.plot(1e3 * one["link_deformation"], 1e-3 * one["link_force"], **style)
            limit = float(one["link_yield_deformation"])
            for sign in (-1.0, 1.0):
                resisted = sign * one["link_deformation"].where(sign * one["link_force"] > 0.0)
                if float(resisted.max()) >= limit:
                    panel.axvline(1e3 * sign * limit, color=ps.GREY, linewidth=0.6, linestyle=":")
        ps.caption(panel, title=ps.wrapped(name, 0.82 * ps.PAGE_WIDTH / columns))
        if place % columns == 0:
            ps.caption(panel, y="force [kN, kN m]")
        if place + columns >= len(shown):
            ps.caption(panel, x="deformation [mm, mrad]")
    handles = pick.system_handles(found) if len(found) > 1 else []
    label = "" if len(found) > 1 else ", " + pick.label_of(*next(iter(found.items())))
    ps.add_legend(figure, handles, title=f"Force over deformation of links{label}")
    return figure


def _chosen(systems: Mapping[str, xr.Dataset], links: str | Collection[str] | None) -> list[str]:
    # The names of the links shown, which all systems must have.
    variables = ("link_deformation", "link_force", "link_yield_deformation")
    for data in systems.values():
        pick.need(data, variables, "draw a model with links (Frame.add_link) that were recorded")
    first = next(iter(systems.values()))
    known = [str(name) for name in first["link"].to_numpy()]
    if links is None:
        work = np.abs(final_value(first, "link_work"))
        most = np.argsort(-work, kind="stable")[: min(MOST, max(1, int((work > 0.0).sum())))]
        names = [known[k] for k in sorted(most)]
    else:
        names = pick.several(links)
    if not 1 <= len(names) <= MOST:
        msg = f"{len(names)} links: give 1 to {MOST}, a panel each"
        raise ValueError(msg)
    for system, data in systems.items():
        there = [str(name) for name in data["link"].to_numpy()]
        where = "" if len(systems) == 1 else f" in {system!r}"
        for name in names:
            pick.choose(name, there, "link", where)
    return names
