"""The pictures of docs/how_it_works.md: the bearing at four instants of a slow test, and its loop.

`make_figures.py` writes them; the page runs the same test.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from frames.plots.bearing_drawing import draw_section
from frames.results.bearing_geometry import posture
from lir_element import cyclic_test

if TYPE_CHECKING:
    import xarray as xr

    from lir_element import LIRBearing

LOAD = 150e3  # N
FARTHEST = 0.225  # m
POINTS = 226  # of each way from the middle to the farthest displacement, 1 mm apart
STAGES = {
    "sliding": (100, "both surfaces slide, the interface sticks"),
    "rim": (176, "a slider meets a rim on each plate"),
    "slip": (225, "the interface slides"),
    "return": (450, "back in the middle: the slip stays"),
}
"""Places along the path, by the names of the pictures, and what happens there."""

BLUE, GREY, RED = "#0072B2", "#BBBBBB", "#B2182B"


def slow_test(bearing: LIRBearing) -> xr.Dataset:
    """Return the test: out to the farthest displacement, to the other side, and back."""
    out = np.linspace(0.0, FARTHEST, POINTS)
    path = np.concatenate([out, out[-2::-1], -out[1:], -out[-2::-1]])
    return cyclic_test(bearing, path, axial_load=LOAD)


def pictures(bearing: LIRBearing) -> dict[str, Figure]:
    """Return a picture for each stage: left the section, right force over displacement so far."""
    data = slow_test(bearing)
    return {name: _picture(data, bearing, *stage) for name, stage in STAGES.items()}


def _picture(data: xr.Dataset, bearing: LIRBearing, place: int, words: str) -> Figure:
    figure = Figure(figsize=(6.6, 2.3), layout="constrained")
    section, loop = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    by_time = data.assign_coords(time=data["time"]).swap_dims(step="time")
    time = float(data["time"][place])
    now = posture(by_time, bearing, "bearing", time, np.array([1.0, 0.0]))
    draw_section(section, bearing, now)
    section.set_xlim(-0.20, 0.43)
    section.set_ylim(-0.04, 0.15)
    section.set_title(words, fontsize=10.0, loc="left")
    along = data.sel(axis="x", bearing="bearing")
    u, force = 1e3 * along["bearing_displacement"], along["bearing_force"] / LOAD
    loop.plot(u, force, color=GREY, linewidth=1.0)
    loop.plot(u[: place + 1], force[: place + 1], color=BLUE, linewidth=1.8)
    loop.plot(u[place], force[place], "o", color=RED, markersize=6.0)
    loop.set_xlabel("displacement [mm]")
    loop.set_ylabel("force / axial load [-]")
    loop.grid(color="#E5E5E5", linewidth=0.6)
    loop.spines[["top", "right"]].set_visible(False)
    return figure
