"""The bearing drawn to scale: vertical sections at chosen instants of an analysis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Polygon

from frames.plots.bearing_geometry import (
    BODIES,
    Posture,
    contact_points,
    outlines,
    posture,
    rim_face,
)
from frames.plots.plot_style import GREY, PAGE_WIDTH, SMALL, TITLE, add_legend, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from lir_element import LIRBearing

FILLS = {
    "bottom plate": "#B8BEC4",
    "bottom slider": "#56B4E9",
    "top slider": "#E69F00",
    "top plate": "#B8BEC4",
}
INTERFACE = "#B2182B"


def impact_instants(data: xr.Dataset, name: str) -> dict[str, float]:
    """Return instants that tell the story of a bearing's impact.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`.
    name : str
        The bearing.

    Returns
    -------
    dict of str to float
        Times [s]: "before the impact" (half the displacement of the contact), "rim contact" (the
        first that leads to the largest slip), "largest displacement" (the sliders slip) and
        "after the impact" (the bearing passes its centre, if the run lasts until then). Without
        any contact: "before", "largest displacement" and "after".
    """
    time = data["time"].to_numpy()
    u = data["bearing_displacement"].sel(bearing=name, axis=["x", "y"]).to_numpy()
    size = np.linalg.norm(u, axis=1)
    force = data["rim_force"].sel(bearing=name).max("surface").to_numpy()
    slip = data["interface_slip_size"].sel(bearing=name).to_numpy()
    touches = np.flatnonzero(force > 0.0)
    found: dict[str, float] = {}
    if len(touches):
        end = int(np.argmax(slip)) if slip.max() > 1e-3 else int(np.argmax(size))
        start = int(touches[touches <= end][-1]) if touches[0] <= end else int(touches[0])
        rise = start
        while rise > 0 and size[rise - 1] > size[rise]:  # already on the way back: to the turn
            rise -= 1
        while rise > 0 and size[rise - 1] <= size[rise]:  # back to the first touch of this way out
            rise -= 1
            start = rise if force[rise] > 0.0 else start
        found["rim contact"] = float(time[start])
    else:
        start = int(np.argmax(size))
    begin = start
    while begin > 0 and size[begin] > 0.5 * size[start]:
        begin -= 1
    peak = start
    while peak < len(size) - 1 and size[peak + 1] >= size[peak]:
        peak += 1
    inward = np.flatnonzero(u[peak:] @ u[peak] <= 0.0)
    found["before the impact" if len(touches) else "before"] = float(time[begin])
    found["largest displacement"] = float(time[peak])
    if len(inward):
        found["after the impact" if len(touches) else "after"] = float(time[peak + inward[0]])
    return dict(sorted(found.items(), key=lambda item: item[1]))


def impact_direction(data: xr.Dataset, name: str, time: float) -> FloatArray:
    """Return the horizontal unit vector of a bearing's displacement at an instant, shape (2,)."""
    now = data["bearing_displacement"].sel(time=time, method="nearest")
    u = now.sel(bearing=name, axis=["x", "y"]).to_numpy()
    size = float(np.linalg.norm(u))
    return u / size if size > 0.0 else np.array([1.0, 0.0])


def bearing_sections(
    data: xr.Dataset,
    bearing: LIRBearing,
    name: str,
    instants: Mapping[str, float] | None = None,
    *,
    direction: FloatArray | None = None,
) -> Figure:
    """Draw the vertical section of a bearing at some instants, to one scale.

    Parameters
    ----------
    data : Dataset
        Result of `frames.time_history`.
    bearing : LIRBearing
        The device.
    name : str
        Its name in the Dataset.
    instants : mapping of title to float, optional
        Times [s]; by default those of `impact_instants`.
    direction : ndarray, shape (2,), optional
        Horizontal direction of the section; left out: of the displacement at the rim contact,
        or at the largest of the instants.

    Returns
    -------
    Figure
        A panel for each instant. Movements across the section are not shown; each panel names
        those of more than 1 mm.

    Raises
    ------
    ValueError
        If there is no instant.

    Notes
    -----
    Surfaces, sliders, tilt, slip and the place of the rims are to scale. The thickness of the
    plates and the height of the rims are for the picture: the model does not depend on them.
    """
    chosen = impact_instants(data, name) if instants is None else dict(instants)
    if not chosen:
        msg = "instants is empty: give one or more times [s] by title, or leave it out"
        raise ValueError(msg)
    plane = _plane(data, name, chosen) if direction is None else direction
    columns = 1 if len(chosen) == 1 else 2
    rows = math.ceil(len(chosen) / columns)
    postures = [posture(data, bearing, name, time, plane) for time in chosen.values()]
    reach = _reach(data, bearing, name)
    frame = _window([outlines(bearing, now, reach) for now in postures])
    share = (frame[3] - frame[2]) / (frame[1] - frame[0])
    figure = new_figure(0.75 + rows * (0.62 + share * (PAGE_WIDTH / columns - 0.15)))
    panels = [ax for row in figure.subplots(rows, columns, squeeze=False) for ax in row]
    for ax, now, (title, time) in zip(panels, postures, chosen.items(), strict=False):
        draw_section(ax, bearing, now, reach=reach)
        ax.set_xlim(frame[0], frame[1])
        ax.set_ylim(frame[2], frame[3])
        _annotate(ax, data.sel(time=time, method="nearest").sel(bearing=name), plane, now)
        ax.set_title(f"{title}, t = {_shown(data, time):.2f} s", fontsize=TITLE, loc="left")
    for ax in panels[len(chosen) :]:
        ax.set_axis_off()
    _scale_bar(panels[0], frame)
    names = ("plates", "slider") if bearing.is_dcfp else ("plates", "bottom slider", "top slider")
    handles = [
        Polygon(np.zeros((1, 2)), facecolor=FILLS[body], edgecolor="black", linewidth=0.6,
                label=label)
        for body, label in zip(BODIES, names, strict=False)
    ]  # fmt: skip
    angle = math.degrees(math.atan2(plane[1], plane[0])) % 360.0
    heading = f"{name}, to scale: vertical section at {round(angle) % 360}° from x"
    add_legend(figure, handles, title=heading)
    return figure


def draw_section(
    ax: Axes, bearing: LIRBearing, now: Posture, *, reach: float | None = None
) -> None:
    """Draw the four bodies of a bearing into a panel, to scale, without its frame.

    Parameters
    ----------
    ax : Axes
        The panel.
    bearing : LIRBearing
        The device.
    now : Posture
        Its bodies.
    reach : float, optional
        Half the width of the surfaces of a bearing without rims [m].
    """
    bodies = outlines(bearing, now, reach)
    if bearing.is_dcfp:  # one piece: both caps without the plane faces between
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
        ax.plot(*np.array([points[low], points[high]]).T, color="black", linewidth=0.7,
                linestyle=(0, (6, 2, 1, 2)))  # fmt: skip
    ax.set_aspect("equal")
    ax.set_axis_off()


def _annotate(ax: Axes, state: xr.Dataset, plane: FloatArray, now: Posture) -> None:
    # Displacement in the section and across it, slip, rim force.
    u = state["bearing_displacement"].sel(axis=["x", "y"]).to_numpy()
    aside = float(u @ np.array([-plane[1], plane[0]]))
    rim = float(state["rim_force"].max())
    along = round(1e3 * float(u @ plane))
    text = f"displacement {along:d} mm".replace("-", "−")
    if abs(aside) > 1e-3:
        text += f", and {1e3 * abs(aside):.0f} mm across"
    slip = float(state["interface_slip_size"])
    text += f"\nslip {1e3 * abs(now.slip):.1f} mm"
    if slip - abs(now.slip) > 1e-3:
        text += f" ({1e3 * slip:.1f} mm in plan)"
    if rim > 0.0:
        text += f", rim force {1e-3 * rim:.0f} kN"
    ax.text(0.0, -0.01, text, transform=ax.transAxes, ha="left", va="top", fontsize=SMALL)


def _plane(data: xr.Dataset, name: str, instants: Mapping[str, float]) -> FloatArray:
    # Direction of the displacement at the rim contact, else at the largest of the instants.
    times = list(instants.values())
    if "rim contact" in instants:
        return impact_direction(data, name, instants["rim contact"])
    u = data["bearing_displacement"].sel(bearing=name, axis=["x", "y"])
    sizes = np.linalg.norm(u.sel(time=times, method="nearest").to_numpy(), axis=1)
    return impact_direction(data, name, times[int(np.argmax(sizes))])


def _shown(data: xr.Dataset, time: float) -> float:
    return float(data["time"].sel(time=time, method="nearest"))


def _reach(data: xr.Dataset, bearing: LIRBearing, name: str) -> float:
    # Half the width of the surfaces, also where there are no rims [m].
    face = max(rim_face(bearing, 0), rim_face(bearing, 1))
    if math.isfinite(face):
        return face
    sliding = data["slider_displacement"].sel(bearing=name, axis=["x", "y"]).to_numpy()
    far = 1.05 * float(np.linalg.norm(sliding, axis=-1).max()) + bearing.slider_radius
    return min(far, 0.95 * min(bearing.radii))


def _window(drawn: Sequence[Mapping[str, FloatArray]]) -> tuple[float, float, float, float]:
    # Limits that hold all bodies at all instants, with a margin: left, right, bottom, top [m].
    points = np.vstack([outline for bodies in drawn for outline in bodies.values()])
    left, bottom = points.min(axis=0) - 0.01
    right, top = points.max(axis=0) + 0.01
    return float(left), float(right), float(bottom), float(top) + 0.02


def _scale_bar(ax: Axes, frame: tuple[float, float, float, float]) -> None:
    # A bar of 100 mm in the upper left corner of the panel.
    left, top = frame[0] + 0.01, frame[3] - 0.012
    ax.plot([left, left + 0.1], [top, top], color=GREY, linewidth=2.0, solid_capstyle="butt")
    ax.text(left + 0.11, top, "100 mm", fontsize=SMALL, color=GREY, va="center")
