"""The figures of the macro-model: loops of the static test, and where the rims are met."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.plots.plot_style import (
    GREY,
    LINES,
    PALETTE,
    SMALL,
    WIDTHS,
    add_legend,
    caption,
    grid_of,
    new_figure,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from lir_element.layout import Floats
    from validation.claims.opensees_macro_loops import Loop


@dataclass(frozen=True)
class Rim:
    """Displacement at the first slip [m] over the direction of pull [rad]; (n,)."""

    name: str
    angles: Floats
    reach: Floats


def look(k: int) -> dict[str, Any]:
    """Return colour and line of the k-th curve."""
    return {"color": PALETTE[k], "linestyle": LINES[k], "linewidth": WIDTHS[k]}


def draw_loops(found: Mapping[str, Loop]) -> Figure:
    """Draw the loops of the static test, and their way back through zero enlarged."""
    drawn = new_figure(3.3)
    left, right = grid_of(drawn, 1, 2)[0]
    handles = []
    for k, (name, loop) in enumerate(found.items()):
        for panel in (left, right):
            panel.plot(1e3 * loop.displacement, loop.force, **look(k))
        handles.append(Line2D([], [], label=name, **look(k)))
    right.set_xlim(-45.0, 45.0)
    right.set_ylim(-0.115, -0.025)
    caption(left, x="displacement [mm]", y="lateral force / axial load [-]", title="loops")
    caption(right, x="displacement [mm]", title="ways back through zero, enlarged")
    add_legend(drawn, handles, columns=4, title="Static cyclic test, two cycles of 185 mm")
    return drawn


def draw_rims(found: Mapping[str, Rim], orbits: Mapping[str, Floats], capacity: float) -> Figure:
    """Draw where the interface slips first, and the place of the slider in an oblique contact.

    Shapes: orbits (n, 2).
    """
    drawn = new_figure(3.7)
    left, right = grid_of(drawn, 1, 2)[0]
    handles = []
    for k, rim in enumerate(found.values()):
        x, y = (1e3 * rim.reach * f(rim.angles) for f in (np.cos, np.sin))
        left.plot(x, y, marker="o", markersize=2.5, **look(k))
        handles.append(Line2D([], [], label=rim.name, **look(k)))
    names = [rim.name for rim in found.values()]
    for name, way in orbits.items():
        right.plot(1e3 * way[:, 0], 1e3 * way[:, 1], **look(names.index(name)))
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    right.plot(
        1e3 * capacity * np.cos(turn),
        1e3 * capacity * np.sin(turn),
        color=GREY,
        linewidth=0.8,
        linestyle=(0, (4, 3)),
    )
    near = np.vstack([w[np.linalg.norm(w, axis=1) > 0.97 * capacity] for w in orbits.values()])
    right.set_xlim(1e3 * near[:, 0].min() - 15.0, 1e3 * near[:, 0].max() + 25.0)
    right.set_ylim(1e3 * near[:, 1].min() - 15.0, 1e3 * near[:, 1].max() + 25.0)
    right.annotate(
        "rim",
        1e3 * near.mean(axis=0) * capacity / np.linalg.norm(near.mean(axis=0)),
        (-24.0, -24.0),
        textcoords="offset points",
        fontsize=SMALL,
        color=GREY,
        arrowprops={"arrowstyle": "->", "linewidth": 0.6, "color": GREY},
    )
    for panel in (left, right):
        panel.set_aspect("equal")
    left.set_xlim(left=0.0)
    left.set_ylim(bottom=0.0)
    caption(left, x="x [mm]", y="y [mm]", title="displacement at the first slip")
    caption(right, x="x [mm]", y="y [mm]", title="displacement less slip, a contact")
    add_legend(drawn, handles, columns=4, title="Oblique contact with the rims")
    return drawn
