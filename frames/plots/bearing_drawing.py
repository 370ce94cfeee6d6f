"""The bearing drawn to scale: vertical sections at chosen instants of an analysis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Polygon

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.plots.drawn_device import device_of, require_own
from frames.results.bearing_geometry import (
    BODIES,
    Plates,
    Posture,
    contact_points,
    outlines,
    posture,
    surface_reach,
)
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.results.bearing_geometry import Geometry
    from lir_element import LIRBearing

FILLS = {
    "bottom plate": "#B8BEC4",
    "bottom slider": "#56B4E9",
    "top slider": "#F7D488",
    "top plate": "#B8BEC4",
}
INTERFACE = "#B2182B"
_LIFTED = 5e-4  # m, gap that is labelled
_SLIPS = 1e-3  # m, interface slip above which its swing matters


def impact_instants(data: xr.Dataset, name: str) -> dict[str, float]:
    """Return the characteristic instants of a bearing's impact [s]."""
    time = data["time"].to_numpy()
    u = data["bearing_displacement"].sel(bearing=name, axis=list(ps.PLANE)).to_numpy()
    size = np.linalg.norm(u, axis=1)
    far = int(np.argmax(size))
    touches = np.flatnonzero(data["rim_force"].sel(bearing=name).max("surface").to_numpy() > 0.0)
    middle = start = far
    if len(touches):
        slip = data["interface_slip_size"].sel(bearing=name).to_numpy()
        end = int(np.argmax(slip)) if slip.max() > _SLIPS else far
        middle = int(touches[touches <= end][-1]) if touches[0] <= end else int(touches[0])
    aside = np.flatnonzero(u @ u[middle] <= 0.0)  # on the other side of the centre
    swing = range(
        int(max(aside[aside < middle], default=-1)) + 1,
        int(min(aside[aside > middle], default=len(u))),
    )
    if len(touches):
        start = int(touches[touches >= swing.start][0])
    begin = start
    while begin > 0 and size[begin] > 0.5 * size[start]:
        begin -= 1
    turn = swing.start + int(np.argmax(size[swing.start : swing.stop]))
    inward = np.flatnonzero(u[turn:] @ u[turn] <= 0.0)
    found = {"before the impact" if len(touches) else "before": begin}
    if len(touches):
        found["rim contact"] = start
    if size[turn] < size[far]:
        found["turn of the swing"] = turn
    found["largest displacement"] = far
    if len(inward):
        found["after the impact" if len(touches) else "after"] = turn + int(inward[0])
    steps = sorted(found.items(), key=lambda item: item[1])
    return {title: float(time[step]) for title, step in steps}


def impact_direction(data: xr.Dataset, name: str, time: float) -> FloatArray:
    """Return the horizontal unit vector of a bearing's displacement at an instant, shape (2,)."""
    now = data["bearing_displacement"].sel(time=time, method="nearest")
    u = now.sel(bearing=name, axis=list(ps.PLANE)).to_numpy()
    size = float(np.linalg.norm(u))
    return u / size if size > 0.0 else np.array([1.0, 0.0])


def bearing_sections(
    data: xr.Dataset,
    bearing: LIRBearing | str | None = None,
    name: str | None = None,
    instants: Mapping[str, float] | Sequence[float] | None = None,
    *,
    direction: FloatArray | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw the vertical section of a bearing at some instants, to one scale.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`; it has the geometry of its bearings.
    bearing : str or LIRBearing, optional
        Name of the bearing; by default that with the largest slip (the largest displacement if
        nothing slips). A device is compared with that of the Dataset under `name`.
    name : str, optional
        The name, beside a device.
    instants : mapping of title to float, or sequence of float, optional
        Times [s]; by default those of `impact_instants`.
    direction : ndarray, shape (2,), optional
        Horizontal direction of the section; left out: of the displacement at the rim contact,
        or at the largest of the instants.
    start, end : float, optional
        Window of time [s] in which the instants are looked for.

    Returns
    -------
    Figure
        A panel for each instant. Movements across the section are not shown; each panel names
        those of more than 1 mm, and the gap of a bearing that has lifted.

    Raises
    ------
    ValueError
        If there is no bearing of that name, the device is not that of the name, there is no
        instant, or one is outside of the result.

    Notes
    -----
    Surfaces, sliders, tilt, slip, lift and the place of the rims are to scale. The thickness of the
    plates and the height of the rims are for the picture: the model does not depend on them.

    Examples
    --------
    In the gallery: "An impact in sections" (docs/gallery/bearing/f_sections.py).
    """
    data = pick.in_window(data, start, end)
    drawn = ("bearing_displacement", "slider_displacement", "rim_force", "interface_slip_size")
    pick.need(data, drawn, "record them, to draw sections")
    if isinstance(bearing, str):
        if name is not None and name != bearing:
            msg = f"two names are given, {bearing!r} and {name!r}: pass one, or a device and a name"
            raise ValueError(msg)
        bearing, name = None, bearing
    name = pick.choose_bearing({"the Dataset": data}, name)
    if bearing is not None:
        require_own(data, name, bearing)
    device = device_of(data, name)
    chosen = impact_instants(data, name) if instants is None else _instants(data, instants)
    plane = _plane(data, name, chosen) if direction is None else _unit(direction)
    postures = [posture(data, device, name, time, plane) for time in chosen.values()]
    figure = _draw_panels(data.sel(bearing=name), device, chosen, postures, plane)
    names = ("plates", "slider") if device.is_dcfp else ("plates", "bottom slider", "top slider")
    handles = [
        Polygon(
            np.zeros((1, 2)), facecolor=FILLS[body], edgecolor="black", linewidth=0.6, label=label
        )
        for body, label in zip(BODIES, names, strict=False)
    ]
    angle = math.degrees(math.atan2(plane[1], plane[0])) % 360.0
    heading = worded(
        "{name}, to scale: vertical section at {angle}° from x",
        name=name,
        angle=round(angle) % 360,
    )
    ps.add_legend(figure, handles, title=heading)
    return figure


def _draw_panels(
    data: xr.Dataset,
    device: Geometry,
    chosen: Mapping[str, float],
    postures: Sequence[Posture],
    plane: FloatArray,
) -> Figure:
    columns = 1 if len(chosen) == 1 else 2
    rows = math.ceil(len(chosen) / columns)
    reach = surface_reach(data, device)
    frame = _window([outlines(device, now, reach) for now in postures])
    share = (frame[3] - frame[2]) / (frame[1] - frame[0])
    figure = ps.new_figure(0.75 + rows * (0.62 + share * (ps.PAGE_WIDTH / columns - 0.15)))
    panels = [ax for row in figure.subplots(rows, columns, squeeze=False) for ax in row]
    for ax, now, (title, time) in zip(panels, postures, chosen.items(), strict=False):
        draw_section(ax, device, now, reach=reach)
        ax.set_xlim(frame[0], frame[1])
        ax.set_ylim(frame[2], frame[3])
        state = data.sel(time=time, method="nearest")
        _annotate(ax, state, plane, now)
        text = joined(title.strip(), f"t = {float(state['time']):.2f} s", by=", ")
        ps.caption(ax, title=ps.wrapped(text, 0.9 * ps.PAGE_WIDTH / columns))
    for ax in panels[len(chosen) :]:
        ax.remove()
    _scale_bar(panels[0], frame)
    return figure


def draw_section(
    ax: Axes,
    bearing: Geometry,
    now: Posture,
    *,
    reach: float | None = None,
    plates: Plates | None = None,
) -> None:
    """Draw the four bodies of a bearing into a panel, to scale, without its frame."""
    bodies = outlines(bearing, now, reach, plates)
    if bearing.is_dcfp:  # rigid slider: both caps without the plane faces between
        caps = [bodies.pop("bottom slider")[:-2], bodies.pop("top slider")[-3::-1]]
        bodies["bottom slider"] = np.vstack(caps)
    for body, outline in bodies.items():
        ax.add_patch(
            Polygon(
                outline, facecolor=FILLS[body], edgecolor="black", linewidth=0.6, joinstyle="miter"
            )
        )
    points = contact_points(bearing, now)
    half = bearing.slider_radius * now.across
    for end in () if bearing.is_dcfp else ("interface bottom", "interface top"):
        line = np.array([points[end] - half, points[end] + half])
        ax.plot(*line.T, color=INTERFACE, linewidth=1.2, solid_capstyle="butt")
    for low, high in (("bottom", "interface bottom"), ("interface top", "top")):
        ax.plot(
            *np.array([points[low], points[high]]).T,
            color="black",
            linewidth=0.7,
            linestyle=(0, (6, 2, 1, 2)),
        )
    ax.set_aspect("equal")
    ax.set_axis_off()


def _annotate(ax: Axes, state: xr.Dataset, plane: FloatArray, now: Posture) -> None:
    # Displacement in the section, across it and in plan; slip, rim force, lift.
    u = state["bearing_displacement"].sel(axis=list(ps.PLANE)).to_numpy()
    aside = abs(float(u @ np.array([-plane[1], plane[0]])))
    along = f"{round(1e3 * float(u @ plane)):d}".replace("-", "−")
    moved = worded("displacement {u} mm", u=along)
    if aside > 1e-3:
        size = 1e3 * np.linalg.norm(u)
        across = worded("across {v:.0f} mm, in plan {w:.0f} mm", v=1e3 * aside, w=size)
        moved = joined(moved, across, by=", ")
    slip = float(state["interface_slip_size"])
    slipped = worded("slip {s:.1f} mm", s=1e3 * abs(now.slip))
    if slip - abs(now.slip) > 1e-3:
        slipped = joined(slipped, worded("({p:.1f} mm in plan)", p=1e3 * slip), by=" ")
    rim = float(state["rim_force"].max())
    pressed = worded("rim force {force:.0f} kN", force=1e-3 * rim) if rim > 0.0 else ""
    lifted = worded("lifted {gap:.1f} mm", gap=1e3 * now.lift) if now.lift > _LIFTED else ""
    text = joined(moved, joined(slipped, pressed, lifted, by=", "), by="\n")
    ax.text(0.0, -0.01, text, transform=ax.transAxes, ha="left", va="top", fontsize=ps.SMALL)


def _instants(
    data: xr.Dataset, instants: Mapping[str, float] | Sequence[float]
) -> dict[str, float]:
    # Titles (empty without) and times, in the order given and within the result.
    if isinstance(instants, Mapping):
        chosen = {str(title): float(time) for title, time in instants.items()}
    else:
        chosen = {" " * k: float(time) for k, time in enumerate(instants)}
    if not chosen:
        msg = "instants is empty: pass at least one time [s] by title, or leave it out"
        raise ValueError(msg)
    first, last = (float(data["time"][k]) for k in (0, -1))
    for title, time in chosen.items():
        if not first <= time <= last:
            msg = (
                f"instant {title!r} = {time:g} s is outside of the result, {first:g} to {last:g} s"
            )
            raise ValueError(msg)
    return chosen


def _unit(direction: FloatArray) -> FloatArray:
    plane = np.asarray(direction, dtype=np.float64)
    size = float(np.linalg.norm(plane))
    if plane.shape != (2,) or not 0.0 < size < math.inf:
        msg = f"direction = {direction}: give two components, x and y, of a horizontal vector"
        raise ValueError(msg)
    return plane / size


def _plane(data: xr.Dataset, name: str, instants: Mapping[str, float]) -> FloatArray:
    # Direction of the displacement at the rim contact, else at the largest of the instants.
    times = list(instants.values())
    if "rim contact" in instants:
        return impact_direction(data, name, instants["rim contact"])
    u = data["bearing_displacement"].sel(bearing=name, axis=list(ps.PLANE))
    sizes = np.linalg.norm(u.sel(time=times, method="nearest").to_numpy(), axis=1)
    return impact_direction(data, name, times[int(np.argmax(sizes))])


def _window(drawn: Sequence[Mapping[str, FloatArray]]) -> tuple[float, float, float, float]:
    # Limits that hold all bodies at all instants, with a margin: left, right, bottom, top [m].
    points = np.vstack([outline for bodies in drawn for outline in bodies.values()])
    left, bottom = points.min(axis=0) - 0.01
    right, top = points.max(axis=0) + 0.01
    return float(left), float(right), float(bottom), float(top) + 0.02


def _scale_bar(ax: Axes, frame: tuple[float, float, float, float]) -> None:
    # A bar of 100 mm in the upper left corner of the panel.
    left, top = frame[0] + 0.01, frame[3] - 0.012
    ax.plot([left, left + 0.1], [top, top], color=ps.GREY, linewidth=2.0, solid_capstyle="butt")
    ax.text(left + 0.11, top, "100 mm", fontsize=ps.SMALL, color=ps.GREY, va="center")
