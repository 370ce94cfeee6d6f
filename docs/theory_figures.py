"""The figures of the pages on theory, and the chart of levels; `make_figures.py` writes them."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyBboxPatch, Polygon

from frames import GroundMotion, lumped_mass, time_history
from frames.demo import bearing_for
from frames.results.bearing_geometry import Posture, contact_points, outlines
from lir_element import CoulombFriction, FrictionHeating, LIRBearing, cyclic_test

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from matplotlib.axes import Axes

BLUE, RED, GREEN, GREY = "#0072B2", "#C0392B", "#00795A", "#555555"
PLATE, BOTTOM, TOP = "#D5D8DC", "#BBDDF2", "#F8DDA4"
LOAD = 1000e3  # N


def panels_of(count: int, width: float = 7.2, height: float = 2.9) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure and its panels side by side."""
    figure = Figure(figsize=(width, height), layout="constrained")
    panels = np.atleast_1d(figure.subplots(1, count))
    for panel in panels:
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color="#E5E5E5", linewidth=0.6)
        panel.set_axisbelow(True)
    return figure, list(panels)


def string(bearing: LIRBearing, now: Posture) -> Figure:
    """Draw the string between the sphere centres of a displaced bearing."""
    figure = Figure(figsize=(6.4, 5.0))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    fills = {"bottom plate": PLATE, "top plate": PLATE, "bottom slider": BOTTOM, "top slider": TOP}
    for name, outline in outlines(bearing, now).items():
        ax.add_patch(Polygon(outline, facecolor=fills[name], edgecolor="black", linewidth=0.8))
    points = contact_points(bearing, now)
    c_1, c_2 = points["centre bottom"], points["centre top"]
    foot = c_1 - np.dot(c_1 - c_2, now.axis) * now.axis
    arrows = ((c_1, c_2, GREEN), (c_1, foot, GREY), (foot, c_2, RED))
    for start, end, colour in arrows:
        style = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.8, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", end, start, arrowprops=style)
    for start, end in ((c_1, points["bottom"]), (c_2, points["top"])):
        ax.plot([start[0], end[0]], [start[1], end[1]], color=GREY, linewidth=0.8, linestyle="--")
    labels = (
        (c_1 + np.array([-0.01, 0.02]), "$C_1$", "black", "right"),
        (c_2 + np.array([0.012, 0.0]), "$C_2$", "black", "left"),
        (c_1 + 0.2 * (c_2 - c_1) + [0.012, 0.0], "$c$", GREEN, "left"),
        (c_1 + 0.25 * (foot - c_1) + [-0.012, 0.0], "$-l\\,n$", GREY, "right"),
        (0.5 * (foot + c_2) + [0.0, -0.025], "$s$", RED, "center"),
    )
    for place, words, colour, side in labels:
        ax.text(*place, words, color=colour, ha=side, va="center", fontsize=15)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set(xlim=(-0.30, 0.50), ylim=(-0.29, 0.42))
    return figure


def rim() -> Figure:
    """Draw a push beyond the rims: sliding, rim contact, slip of the interface."""
    bearing = bearing_for(LOAD)
    figure, (panel,) = panels_of(1, 6.0, 3.2)
    path = np.linspace(0.0, 0.32, 161)
    test = cyclic_test(bearing, path, LOAD).sel(axis="x").squeeze()
    u, force = test["bearing_displacement"], test["bearing_force"] / LOAD
    panel.plot(1e3 * u, force, color=BLUE)
    panel.axhline(bearing.force_limit(LOAD) / LOAD, color=RED, linewidth=0.8, linestyle="--")
    panel.axvline(1e3 * bearing.capacity, color=GREY, linewidth=0.8, linestyle="--")
    notes = (
        (60, 0.125, "slope $W/L$", "black"),
        (245, 0.06, "$U_{cap}$: first rim contact", GREY),
        (20, 0.262, r"$W\tan(\theta_{max} + \arctan\,\mu_h)$", RED),
        (264, 0.222, "interface slips", "black"),
    )
    for x, y, words, colour in notes:
        side = "right" if "cap" in words else "left"
        panel.text(x, y, words, color=colour, ha=side, fontsize=9.5)
    panel.set(xlabel="displacement [mm]", ylabel="H / W [-]", ylim=(0.0, 0.29), xlim=(0.0, 335.0))
    return figure


def friction() -> Figure:
    """Draw friction over speed, and the hysteretic variable of both laws."""
    figure, (left, right) = panels_of(2)
    v = np.linspace(0.0, 0.4, 201)
    left.plot(1e3 * v, 0.065 - 0.0325 * np.exp(-15.0 * v), color=BLUE)
    left.set(
        xlabel="sliding speed [mm/s]", ylabel=r"friction coefficient $\mu$ [-]", ylim=(0, 0.08)
    )
    left.text(210, 0.068, "$f_{max}$", fontsize=11)
    left.text(12, 0.028, "$f_{min}$", fontsize=11)
    u = np.concatenate([np.linspace(0, 4, 400), np.linspace(4, -4, 800), np.linspace(-4, 4, 800)])
    laws = {
        "elastic-plastic": (lambda b: np.clip(b, -1.0, 1.0), BLUE),
        "Bouc-Wen, exponent 2": (None, RED),
    }
    for name, (law, colour) in laws.items():
        z, found = 0.0, []
        for du in np.diff(u, prepend=0.0):
            if law is not None:
                z = float(law(z + du))
            else:
                z += du * (1.0 - abs(z) ** 2 * (0.5 + 0.5 * np.sign(du * z)))
            found.append(z)
        right.plot(u, found, color=colour, label=name)
    right.set(xlabel="sliding / yield displacement", ylabel="hysteretic variable z [-]")
    right.set_ylim(-1.6, 1.1)
    right.legend(fontsize=8, frameon=False, loc="lower center", ncols=2)
    return figure


def step() -> Figure:
    """Draw the error of the displacement history over the step."""
    model = lumped_mass(bearing_for(LOAD), mass=LOAD / 9.80665)
    t = np.arange(0.0, 6.0, 0.02)
    x, y = (a * np.sin(w * t) * (t < 4.0) for a, w in ((1.4, 3.6), (0.9, 4.5)))
    motion = GroundMotion(x=x, y=y, dt=0.02)

    def history(dt: float) -> Any:
        with warnings.catch_warnings(action="ignore"):
            data = time_history(model, motion, dt=dt)
        found = data["bearing_displacement"].sel(axis=["x", "y"]).squeeze()
        return found.sel(time=np.arange(0.0, 5.9, 0.02), method="nearest").to_numpy()

    reference = history(0.02 / 256)
    steps = [0.02 / 2**k for k in range(5)]
    largest = np.abs(reference).max()
    errors = [float(np.abs(history(dt) - reference).max() / largest) for dt in steps]
    figure, (panel,) = panels_of(1, 5.4, 3.2)
    panel.loglog([1e3 * dt for dt in steps], [100 * e for e in errors], "o-", color=BLUE)
    line = [100 * errors[0] * (dt / steps[0]) ** 2 for dt in steps]
    panel.loglog([1e3 * dt for dt in steps], line, "--", color=GREY, label="second order")
    panel.set(xlabel="step [ms]", ylabel="error / largest displacement [%]")
    panel.set_xticks([1e3 * dt for dt in steps], [f"{1e3 * dt:g}" for dt in steps])
    panel.minorticks_off()
    panel.legend(frameon=False)
    return figure


def eccentricity() -> Figure:
    """Draw the pressure under a slider at three eccentricities."""
    figure, panels = panels_of(3, 7.2, 2.4)
    x = np.linspace(-1.0, 1.0, 201)
    cases: tuple[tuple[str, Callable[[Any], Any]], ...] = (
        ("e/a = 0.1: closed", lambda r: 1.0 + 0.4 * r),
        ("e/a = 0.25: edge of the kern", lambda r: 1.0 + r),
        ("e/a = 0.6: open on one side", lambda r: np.maximum(r - 0.25, 0.0) * 3.2),
    )
    for panel, (title, pressure) in zip(panels, cases, strict=True):
        panel.fill_between(x, -pressure(x), 0.0, color=BOTTOM, edgecolor=BLUE)
        panel.plot([-1, 1], [0, 0], color="black", linewidth=2.5)
        panel.set_title(title, fontsize=9.5)
        panel.set(xticks=[-1, 0, 1], yticks=[], xlabel="place / radius a")
        panel.set_ylim(-2.6, 0.4)
    panels[0].set_ylabel("pressure")
    return figure


def points() -> Figure:
    """Draw the contact points of a slider, with few and with many."""
    figure = Figure(figsize=(5.4, 2.8), layout="constrained")
    for panel, (title, rings) in zip(
        figure.subplots(1, 2),
        (("6 points: one ring", ((1.0, 6),)), ("16 points: two rings", ((1.0, 8), (0.5, 8)))),
        strict=True,
    ):
        panel.add_patch(Circle((0, 0), 1.0, facecolor=BOTTOM, edgecolor="black"))
        for radius, count in rings:
            angle = 2.0 * np.pi * np.arange(count) / count
            size = 40.0 if radius > 0.9 or len(rings) == 1 else 80.0
            panel.scatter(radius * np.cos(angle), radius * np.sin(angle), size, RED, zorder=3)
        panel.set(xlim=(-1.15, 1.15), ylim=(-1.15, 1.15), aspect="equal", title=title)
        panel.set_axis_off()
    return figure


def heat() -> Figure:
    """Draw the temperature of a plate that a slider heats in cycles about its middle."""
    bearing = LIRBearing(
        radius=1.0,
        slider_height=0.1,
        slider_radius=0.15,
        capacity=0.3,
        friction=CoulombFriction(0.06),
        interface_friction=0.15,
        friction_heating=FrictionHeating(variant="half"),
    )
    figure, (panel,) = panels_of(1, 6.0, 3.0)
    for reach, colour in ((0.10, BLUE), (0.25, RED)):
        path = reach * np.sin(np.linspace(0.0, 10.0 * np.pi, 601))
        test = cyclic_test(bearing, path, LOAD, velocity=0.4).squeeze()
        name = f"cycles of ±{1e3 * reach:.0f} mm"
        panel.plot(
            test["time"], test["temperature"].sel(contact="bottom"), color=colour, label=name
        )
    panel.set(xlabel="time [s]", ylabel="middle of the plate [°C]")
    panel.legend(frameon=False)
    return figure


def box(ax: Axes, x: float, y: float, words: str, colour: str, width: float = 3.0) -> None:
    """Draw a box of the chart."""
    shape = FancyBboxPatch(
        (x - width / 2, y - 0.42), width, 0.84, "round,pad=0.06", facecolor=colour, edgecolor=GREY
    )
    ax.add_patch(shape)
    ax.text(x, y, words, ha="center", va="center", fontsize=10, linespacing=1.35)


def levels() -> Figure:
    """Draw the decision chart of the levels of fidelity."""
    figure = Figure(figsize=(8.6, 5.4))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    questions = (
        (5.6, "One bearing, and a reference\nfor other results?", "yes"),
        (
            4.1,
            "A design, in which bearings meet their\nrims, lift, or have different friction?",
            "yes",
        ),
        (2.6, "Not sure?", "yes"),
    )
    answers = (
        '"rigid_body"\n10 to 30 times the cost',
        '"contact", the default of projects\nabout 3 times the cost',
        '"auto": runs, then again with the\nbearings concerned at "contact"',
    )
    for (y, question, said), answer in zip(questions, answers, strict=True):
        box(ax, 2.5, y, question, "#FFFFFF", 4.2)
        box(ax, 7.6, y, answer, BOTTOM, 3.8)
        arrow = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.2}
        ax.annotate("", (5.6, y), (4.7, y), arrowprops=arrow)
        ax.text(5.1, y + 0.14, said, ha="center", fontsize=9.5)
        ax.annotate("", (2.5, y - 1.0), (2.5, y - 0.5), arrowprops=arrow)
        ax.text(2.62, y - 0.76, "no", fontsize=9.5, va="center")
    box(ax, 2.5, 1.1, '"pendulum", the default of histories:\ncampaigns, no rim met', BOTTOM, 4.2)
    words = (
        "Every run checks its modelling\nassumptions: a warning names the\nlevel that is needed."
    )
    ax.text(7.6, 1.1, words, ha="center", va="center", fontsize=10, color=GREY)
    ax.set(xlim=(0.0, 9.8), ylim=(0.4, 6.3))
    ax.set_axis_off()
    return figure
