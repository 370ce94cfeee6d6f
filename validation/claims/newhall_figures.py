"""The figures of the numerical example, after Figs 6 to 8 of the paper, and its film."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import PillowWriter
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from frames.plots.bearing_drawing import draw_section
from frames.results.bearing_geometry import outlines, posture
from validation.body_motion import BODIES, body_motion

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from lir_element import LIRBearing

NAME = "bearing"
SHOWN = 15.0  # s, of the histories
FILM = (3.5, 6.0)  # s, of the motion
FRAMES = 84
RATE = 12  # pictures a second: 7 s
FILM_DPI = 100
WIDTH = 1.1  # pt
BODY_WIDTHS = (2.2, 1.0, 1.2)  # pt; so that equal curves show both


def motions(found: Mapping[str, xr.Dataset], bearing: LIRBearing, contact: float) -> Figure:
    """Draw displacements and rotations of the bodies over time, after Fig. 6."""
    drawn = ps.new_figure(5.6)
    panels = [row[0] for row in ps.grid_of(drawn, 3, 1, share_x=True)]
    for k, data in enumerate(found.values()):
        motion = body_motion(data, bearing, NAME).sel(time=slice(0.0, SHOWN))
        lateral = 1e3 * motion["position"].sel(axis="x")
        vertical = 1e3 * motion["position"].sel(axis="z")
        turns = 1e3 * motion["rotation"].sel(axis="y")
        for panel, values in zip(panels, (lateral, vertical, turns), strict=True):
            for b, body in enumerate(BODIES):
                panel.plot(
                    motion["time"],
                    values.sel(body=body),
                    color=ps.PALETTE[b],
                    linestyle=ps.LINES[k],
                    linewidth=BODY_WIDTHS[b],
                )
    for panel, text in zip(
        panels,
        ("lateral\ndisplacement [mm]", "vertical\ndisplacement [mm]", "rotation about y\n[mrad]"),
        strict=True,
    ):
        panel.axvline(contact, color=ps.GREY, linewidth=0.8, linestyle=(0, (4, 3)))
        ps.caption(panel, y=text)
    panels[0].text(
        contact - 0.1,
        0.97,
        "impact",
        fontsize=ps.SMALL,
        color=ps.GREY,
        ha="right",
        va="top",
        transform=panels[0].get_xaxis_transform(),
    )
    panels[0].set_xlim(0.0, SHOWN)
    ps.caption(panels[-1], x="time [s]")
    drawn.align_ylabels()
    handles = [
        Line2D([], [], color=ps.PALETTE[b], linewidth=BODY_WIDTHS[b], label=body.replace("_", " "))
        for b, body in enumerate(BODIES)
    ] + _levels(found)
    ps.add_legend(drawn, handles, columns=3, title="Motion of the bodies, Newhall 360")
    return drawn


def forces(found: Mapping[str, xr.Dataset], limit: float, contact: float) -> Figure:
    """Draw lateral force and moment over time and the loop, after Fig. 8."""
    drawn = ps.new_figure(4.6)
    grid = ps.grid_of(drawn, 2, 2)
    force_panel, loop, moment, zoom = grid[0][0], grid[0][1], grid[1][0], grid[1][1]
    for k, data in enumerate(found.values()):
        chosen = data.sel(bearing=NAME)
        until = chosen.sel(time=slice(0.0, SHOWN))
        look: dict[str, Any] = {
            "color": ps.PALETTE[k],
            "linestyle": ps.LINES[k],
            "linewidth": 0.75 * ps.WIDTHS[k],
        }
        force = until["bearing_force"].sel(axis="x") / data["weight"]
        force_panel.plot(until["time"], force, **look)
        zoom.plot(until["time"], force, **look)
        moment.plot(until["time"], 1e-3 * until["bearing_moment"].sel(end="j", axis="y"), **look)
        loop.plot(
            1e3 * chosen["bearing_displacement"].sel(axis="x"),
            chosen["bearing_force"].sel(axis="x") / data["weight"],
            **look,
        )
    for panel in (force_panel, moment, zoom):
        panel.axvline(contact, color=ps.GREY, linewidth=0.8, linestyle=(0, (4, 3)))
        ps.caption(panel, x="time [s]")
    for panel in (force_panel, moment):
        panel.set_xlim(0.0, SHOWN)
    for panel in (force_panel, zoom, loop):
        panel.set_ylim(-1.2 * limit, 1.25 * limit)
        for sign in (-1.0, 1.0):
            panel.axhline(sign * limit, color=ps.GREY, linewidth=0.8, linestyle=(0, (1, 2)))
        ps.caption(panel, y="force / weight [-]")
    zoom.set_xlim(contact - 0.5, contact + 0.5)
    ps.caption(force_panel, title="lateral force")
    ps.caption(zoom, title="lateral force around the impact")
    ps.caption(moment, y="moment about y [kN m]", title="moment on the superstructure")
    ps.caption(loop, x="displacement [mm]", title="loops")
    handles = [
        Line2D([], [], color=ps.GREY, linewidth=0.8, linestyle=(0, (4, 3)), label="impact"),
        Line2D(
            [],
            [],
            color=ps.GREY,
            linewidth=0.8,
            linestyle=(0, (1, 2)),
            label="limit, static: tan(θ + atan μ$_h$)",
        ),
        *_levels(found, colours=True),
    ]
    ps.add_legend(drawn, handles, title="Forces that the bearing passes on, Newhall 360")
    return drawn


def film(data: xr.Dataset, bearing: LIRBearing, path: Path) -> None:
    """Write the film of the impact: the section to scale, and the loop as it grows."""
    along = np.array([1.0, 0.0])
    times = np.linspace(*FILM, FRAMES)
    still = [posture(data, bearing, NAME, float(time), along) for time in times]
    points = np.vstack([o for now in still for o in outlines(bearing, now).values()])
    low, high = points.min(axis=0) - 0.01, points.max(axis=0) + 0.01
    drawn = ps.new_figure(2.35, 8.2)
    drawn.set_layout_engine("none")
    section = drawn.add_axes((0.005, 0.02, 0.60, 0.86))
    loop = drawn.add_axes((0.70, 0.20, 0.285, 0.68))
    chosen = data.sel(bearing=NAME, time=slice(*FILM))
    u = 1e3 * chosen["bearing_displacement"].sel(axis="x").to_numpy()
    force = (chosen["bearing_force"].sel(axis="x") / data["weight"]).to_numpy()
    clock = chosen["time"].to_numpy()
    writer = PillowWriter(fps=RATE)
    with mpl.rc_context({"savefig.bbox": None}), writer.saving(drawn, str(path), FILM_DPI):
        for time, now in zip(times, still, strict=True):
            section.clear()
            draw_section(section, bearing, now)
            section.set_xlim(low[0], high[0])
            section.set_ylim(low[1], high[1])
            rim = float(data["rim_force"].sel(time=time, method="nearest").max()) > 0.0
            words = f"t = {time:.2f} s, slip {1e3 * abs(now.slip):.0f} mm"
            section.set_title(
                words + (", rim contact" if rim else ""), fontsize=ps.SMALL + 1.5, loc="left"
            )
            _loop(loop, u, force, int(np.searchsorted(clock, time, side="right")))
            writer.grab_frame()


def _loop(panel: Axes, u: FloatArray, force: FloatArray, count: int) -> None:
    panel.clear()
    ps.style(panel)
    panel.plot(u[:count], force[:count], color=ps.PALETTE[0], linewidth=1.2)
    panel.plot(
        u[count - 1 : count], force[count - 1 : count], "o", color=ps.PALETTE[1], markersize=4
    )
    panel.set_xlim(1.08 * u.min(), 1.08 * u.max())
    panel.set_ylim(1.15 * force.min(), 1.15 * force.max())
    ps.caption(panel, x="displacement [mm]", y="force / weight [-]")


def _levels(found: Mapping[str, xr.Dataset], *, colours: bool = False) -> list[Line2D]:
    return [
        Line2D(
            [],
            [],
            color=ps.PALETTE[k] if colours else "black",
            linestyle=ps.LINES[k],
            linewidth=WIDTH,
            label=f"level {level}",
        )
        for k, level in enumerate(found)
    ]
