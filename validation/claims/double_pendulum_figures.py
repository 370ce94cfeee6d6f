"""The figure of the double concave bearings, with rigid and with articulated sliders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.plots.plot_style import PALETTE, add_legend, caption, grid_of, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from validation.claims.double_pendulum_loops import Loops

LOOKS: tuple[dict[str, Any], ...] = (
    {"color": PALETTE[0], "linewidth": 2.0, "label": "rigid slider (element)"},
    {
        "color": PALETTE[1],
        "linewidth": 1.2,
        "linestyle": "--",
        "label": "articulated (Fenz and Constantinou)",
    },
    {
        "color": PALETTE[2],
        "linewidth": 1.2,
        "linestyle": ":",
        "label": "articulated, moments in equilibrium",
    },
)


def draw(found: Mapping[str, Loops]) -> Figure:
    """Draw the loops of all cases."""
    drawn = new_figure(5.2)
    panels = [panel for row in grid_of(drawn, 2, 2) for panel in row]
    for panel, (name, one) in zip(panels, found.items(), strict=True):
        for force, look in zip((one.element, one.hinged, one.moments), LOOKS, strict=True):
            panel.plot(1e3 * one.path, force, **look)
        caption(panel, x="displacement [mm]", y="lateral force / load [-]", title=name)
    for panel in panels:
        panel.set_ylim(-0.24, 0.24)
    handles = [Line2D([], [], **look) for look in LOOKS]
    add_legend(drawn, handles, title="Double concave bearings with rigid and articulated sliders")
    return drawn
