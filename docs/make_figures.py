"""The figures of the documentation: docs/conventions.svg and docs/figures/*.png.

    python docs/make_figures.py

The bearing of the drawing has small radii and a high slider, so that its sphere centres and its
bodies fit one picture; everything in it is to that scale. The figure of the demo needs its record
(``pip install ".[demo]"``).
"""

from __future__ import annotations

import contextlib
import re
import shutil
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import how_figures  # beside this file
import matplotlib as mpl
import numpy as np
import theory_figures  # beside this file
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from frames import demo, moment_frame, time_history
from frames.plots import bearing_sections, worst_bearing
from frames.results.bearing_geometry import Posture, contact_points, outlines
from lir_element import CoulombFriction, LIRBearing, cyclic_test

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

DOCS = Path(__file__).parent
PLATE, BOTTOM, TOP = "#D5D8DC", "#BBDDF2", "#F8DDA4"
BLUE, RED, GREEN, GREY, PURPLE = "#0072B2", "#C0392B", "#00795A", "#555555", "#7B2D8B"
SIZE = 10.0  # pt, of the text
FORCE_LIMIT = r"force limit $\tan(\theta_{max} + \arctan\,\mu_h)$"
LOAD = 150e3  # N, of the static test


def static_test_bearing() -> LIRBearing:
    """Return the bearing of the static test in section 2.2 of the paper."""
    return LIRBearing(
        radius=0.75,
        slider_height=0.085,
        slider_radius=0.08,
        capacity=0.175,
        friction=CoulombFriction(0.066),
        interface_friction=0.126,
    )


def hysteresis() -> Figure:
    """Draw the static cyclic test: DCFP without rims, DCFP on its rims, LIR-DCFP on its rims."""
    device = static_test_bearing()
    corners = [0.0, 0.185, -0.185, 0.185, -0.185, 0.0]
    parts = [np.linspace(a, b, 301)[1:] for a, b in pairwise(corners)]
    path = np.concatenate(parts)
    cases = (
        ("DCFP, no restraining rims", device.as_dcfp(rims=False), GREY),
        ("DCFP, rim contact", device.as_dcfp(), RED),
        ("LIR-DCFP, rim contact", device, BLUE),
    )
    figure = Figure(figsize=(8.4, 2.9), layout="constrained")
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    peaks = []
    for panel, (title, bearing, colour) in zip(panels, cases, strict=True):
        data = cyclic_test(bearing, path, LOAD, level="contact").sel(axis="x", bearing="bearing")
        u, force = data["bearing_displacement"].to_numpy(), data["bearing_force"].to_numpy() / LOAD
        panel.plot(1e3 * u, force, color=colour, linewidth=1.4)
        panel.set_title(title, fontsize=SIZE, loc="left")
        panel.set_xlabel("displacement [mm]")
        panel.grid(color="#E5E5E5", linewidth=0.6)
        panel.spines[["top", "right"]].set_visible(False)
        panel.set_axisbelow(True)
        peaks.append(np.abs(force).max())
    panels[0].set_ylabel("lateral force / axial load [-]")
    panels[0].set_ylim(-0.42, 0.42)
    limit = device.force_limit(LOAD) / LOAD
    for sign in (1.0, -1.0):
        panels[2].axhline(sign * limit, color=RED, linewidth=0.8, linestyle="--")
    panels[2].text(-190.0, limit + 0.012, FORCE_LIMIT, color=RED, fontsize=8.5, va="bottom")
    notes = (
        (panels[1], f"to {peaks[1]:.1f}", (174.0, 0.42), (90.0, 0.36), "right"),
        (panels[1], f"to −{peaks[1]:.1f}", (-174.0, -0.42), (-90.0, -0.36), "left"),
        (panels[2], "1st slip: +175 mm", (175.0, 0.205), (60.0, 0.225), "right"),
        (panels[2], "2nd slip: −165 mm", (-165.0, -0.205), (-60.0, -0.225), "left"),
    )
    for panel, text, point, place, side in notes:
        panel.annotate(
            text,
            point,
            place,
            fontsize=8.5,
            ha=side,
            va="center",
            arrowprops={"arrowstyle": "->", "linewidth": 0.7, "shrinkB": 3.0},
        )
    return figure


class Drawing:
    """A panel in metres, with arrows and labels."""

    def __init__(self, ax: Axes) -> None:
        self.ax = ax

    def arrow(
        self,
        start: NDArray[Any],
        end: NDArray[Any],
        colour: str,
        width: float = 1.6,
        style: str = "-|>",
    ) -> None:
        """Draw an arrow between two points."""
        shape = {
            "arrowstyle": style,
            "color": colour,
            "linewidth": width,
            "shrinkA": 0.0,
            "shrinkB": 0.0,
            "mutation_scale": 11.0,
        }
        self.ax.annotate("", end, start, arrowprops=shape, zorder=6)

    def line(
        self,
        start: NDArray[Any],
        end: NDArray[Any],
        colour: str,
        style: Any = "-",
        width: float = 0.9,
    ) -> None:
        """Draw a line between two points."""
        self.ax.plot(
            [start[0], end[0]],
            [start[1], end[1]],
            color=colour,
            linestyle=style,
            linewidth=width,
            zorder=4,
        )

    def dot(self, point: NDArray[Any], colour: str = "black", size: float = 5.0) -> None:
        """Mark a point."""
        self.ax.plot(*point, "o", color=colour, markersize=size, zorder=7)

    def text(
        self,
        x: float,
        z: float,
        words: str,
        colour: str = "black",
        *,
        side: str = "left",
        size: float = SIZE,
        back: bool = False,
    ) -> None:
        """Write a label; with a white ground where lines pass behind it."""
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0} if back else None
        self.ax.text(
            x, z, words, color=colour, fontsize=size, ha=side, va="center", bbox=box, zorder=8
        )


def drawn_bearing() -> tuple[LIRBearing, Posture]:
    """Return a bearing with visible proportions, its slider on the bottom rim, and its posture."""
    height, radius, rim = 0.14, 0.36, 0.095
    bearing = LIRBearing(
        radius=radius,
        slider_height=height,
        slider_radius=0.07,
        rims=(rim, 0.13),
        friction=CoulombFriction(0.05),
        interface_friction=0.12,
        plate_thickness=0.35 * height,
    )
    sine, tilt = rim / radius, np.deg2rad(4.0)
    return bearing, Posture(
        axis=np.array([-sine, np.sqrt(1.0 - sine**2)]),
        plate_axis=np.array([np.sin(tilt), np.cos(tilt)]),
        slip=0.046,
    )


def conventions() -> Figure:
    """Draw the vertical section of a displaced bearing with axes, nodes, vectors and forces."""
    bearing, now = drawn_bearing()
    left, right, low, high = -0.30, 0.56, -0.265, 0.475
    width = 8.6
    figure = Figure(figsize=(width, width * (high - low) / (right - left)))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw = Drawing(ax)
    fills = {"bottom plate": PLATE, "top plate": PLATE, "bottom slider": BOTTOM, "top slider": TOP}
    for name, outline in outlines(bearing, now).items():
        ax.add_patch(Polygon(outline, facecolor=fills[name], edgecolor="black", linewidth=0.8))
    points = contact_points(bearing, now)
    thick = 0.35 * bearing.slider_height
    points["node i"] = np.array([0.0, -thick])
    points["node j"] = points["vertex"] + thick * now.plate_axis
    _axes_and_centres(draw, now, points)
    _sliding(draw, points)
    _forces(draw, bearing, now, points)
    ax.set_aspect("equal")
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
    ax.set_axis_off()
    return figure


def _axes_and_centres(draw: Drawing, now: Posture, points: dict[str, NDArray[Any]]) -> None:
    up, chain = np.array([0.0, 1.0]), (0, (8, 2, 1, 2))
    c_1, c_2 = points["centre bottom"], points["centre top"]
    draw.line(points["node i"], c_1, GREY, chain)
    draw.line(points["node j"], c_2, GREY, chain)
    draw.line(c_1, points["bottom"], GREY)
    draw.line(c_2, points["top"], GREY)
    draw.arrow(c_1, c_2, GREEN, 1.5)
    draw.arrow(c_1, c_1 + 0.08 * up, "black")
    draw.arrow(c_1, c_1 + 0.08 * now.axis, "black")
    draw.arrow(c_2, c_2 + 0.08 * now.plate_axis, "black")
    for point in (c_1, c_2):
        draw.dot(point, GREY, 4.5)
    draw.text(0.008, c_1[1] + 0.075, "$e_i$", size=13.0)
    draw.text(-0.034, c_1[1] + 0.072, "$n$", size=13.0, side="right")
    draw.text(c_2[0] + 0.016, c_2[1] + 0.056, "$e_j$", size=13.0)
    draw.text(-0.014, c_1[1], "$C_1$, centre of the bottom sphere", GREY, side="right")
    draw.text(c_2[0] + 0.014, c_2[1] - 0.002, "$C_2$, centre of the top sphere", GREY)
    draw.text(c_1[0] + 0.034, c_1[1] - 0.025, "$c = C_2 - C_1 = -l\\,n + s$", GREEN, size=11.0)
    for name, end, share, side in (
        ("$R_1$", points["bottom"] - c_1, 0.24, "right"),
        ("$R_2$", points["top"] - c_2, 0.20, "right"),
    ):
        start = c_1 if name == "$R_1$" else c_2
        at = start + share * end
        label = at + np.array([-0.075, -0.004])
        draw.line(label + np.array([0.002, 0.0]), at, GREY, width=0.5)
        draw.text(*label, name, GREY, side=side, size=13.0)
    axes = np.array([-0.255, -0.215])
    draw.arrow(axes, axes + np.array([0.07, 0.0]), "black", 1.2)
    draw.arrow(axes, axes + np.array([0.0, 0.07]), "black", 1.2)
    draw.text(axes[0] + 0.077, axes[1], "$x$", size=13.0)
    draw.text(axes[0], axes[1] + 0.083, "$z$", side="center", size=13.0)
    draw.text(axes[0] - 0.012, axes[1] - 0.022, "$y$ into the page", size=9.0)


def _sliding(draw: Drawing, points: dict[str, NDArray[Any]]) -> None:
    vertex = np.zeros(2)
    draw.arrow(vertex, points["bottom"], BLUE, 2.0)
    draw.arrow(points["top"], points["vertex"], BLUE, 2.0)
    draw.arrow(points["interface bottom"], points["interface top"], RED, 2.2)
    draw.text(0.052, -0.016, "$d_1$", BLUE, size=13.0)
    middle = 0.5 * (points["top"] + points["vertex"])
    draw.text(middle[0] - 0.004, middle[1] + 0.024, "$d_2$", BLUE, size=13.0)
    start = points["interface bottom"]
    draw.text(start[0] - 0.008, start[1] + 0.014, "$s$", RED, side="right", size=13.0)


def _forces(
    draw: Drawing, bearing: LIRBearing, now: Posture, points: dict[str, NDArray[Any]]
) -> None:
    node = points["node j"]
    draw.arrow(node, node + np.array([0.10, 0.0]), "black", 2.0)
    draw.arrow(node, node + np.array([0.0, 0.085]), "black", 2.0)
    draw.text(node[0] + 0.060, node[1] + 0.017, "$u_x,\\ f_x$", size=13.0)
    draw.text(node[0] + 0.008, node[1] + 0.082, "$u_z,\\ f_z$", size=13.0)
    for name in ("node i", "node j"):
        draw.dot(points[name], "black", 7.0)
    draw.text(points["node i"][0] - 0.010, points["node i"][1] - 0.017, "node $i$", side="right")
    draw.text(node[0] - 0.010, node[1] + 0.016, "node $j$", side="right")
    for name, sign in (("bottom", -1.0), ("top", 1.0)):
        tail = points[name] + sign * 0.068 * now.axis
        draw.arrow(tail, points[name], PURPLE, 2.0)
        side = "left" if sign > 0.0 else "right"
        at = tail + np.array([0.012, -0.022]) * sign
        draw.text(*at, "$N$", PURPLE, side=side, size=13.0)
    # the edge of the bottom slider that lies on the rim
    tilt = np.arcsin(bearing.slider_radius / bearing.radii[0])
    turned = np.arctan2(-now.axis[0], now.axis[1]) + tilt
    edge = bearing.radii[0] * np.array([np.sin(turned), 1.0 - np.cos(turned)])
    draw.arrow(edge + np.array([0.10, 0.0]), edge, PURPLE, 2.0)
    draw.text(edge[0] + 0.108, edge[1], "$P_1$", PURPLE, size=13.0)
    lines = (
        ("$u$, $f$: displacement of node $j$ and resisting force on it,", "black"),
        ("positive along $+x$, $+y$, $+z$", "black"),
        ("$N$, $P_1$: forces on the slider, compression positive", PURPLE),
    )
    for k, (words, colour) in enumerate(lines):
        draw.text(0.175, 0.440 - 0.026 * k, words, colour, size=9.5)


def demo_sections() -> Figure:
    """Draw the sections of the demo's most displaced LIR-DCFP bearing."""
    frame = moment_frame(bearing=demo.design(), name=demo.LIR)
    motion = demo.pacoima(demo.DEFAULT_SCALE)
    data = time_history(frame, motion, level=demo.LEVEL, duration=demo.DURATION)
    return bearing_sections(data, worst_bearing(data))


def drawn_by_pages() -> None:
    """Run the blocks of README.md and of the guide; keep the figures that they save."""
    block = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)
    for names, kept in PAGES.items():
        text = "".join((DOCS / name).read_text(encoding="utf-8") for name in names)
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            space: dict[str, object] = {"__name__": "page"}
            for code in block.findall(text):
                exec(compile(code, names[0], "exec"), space)  # the page's own code  # noqa: S102
            for drawn, name in kept.items():
                shutil.copy(drawn, DOCS / "figures" / name)


PAGES = {
    ("../README.md",): {"loops.png": "example.png"},
    ("guide.md", "guide_building.md", "guide_results.md"): {
        f"{name}.png": f"guide-{name}.png"
        for name in ("hinges", "links", "loops", "histories", "sections", "model", "plan")
    },
}
"""Figures of pages whose blocks run one after the other: the name there, and in docs/figures."""


THEORY = {
    "string": lambda: theory_figures.string(*drawn_bearing()),
    "rim": theory_figures.rim,
    "friction": theory_figures.friction,
    "step": theory_figures.step,
    "eccentricity": theory_figures.eccentricity,
    "points": theory_figures.points,
    "heat": theory_figures.heat,
}


def main() -> None:
    """Write the figures."""
    mpl.rcParams.update({"svg.hashsalt": "lir-dcfp", "font.size": SIZE, "mathtext.fontset": "stix"})
    (DOCS / "figures").mkdir(exist_ok=True)
    conventions().savefig(DOCS / "conventions.svg", metadata={"Date": None, "Creator": None})
    theory_figures.levels().savefig(DOCS / "figures" / "levels.png", dpi=130)
    for name, draw in THEORY.items():
        draw().savefig(DOCS / "figures" / f"theory-{name}.png", dpi=130)
    for name, figure in how_figures.pictures(static_test_bearing()).items():
        figure.savefig(DOCS / "figures" / f"how-{name}.png", dpi=150)
    hysteresis().savefig(DOCS / "figures" / "hysteresis.png", dpi=130)
    drawn_by_pages()
    demo_sections().savefig(DOCS / "figures" / "demo-sections.png", dpi=120)


if __name__ == "__main__":
    main()
