"""The figures of the drift under Bouc-Wen friction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.plots.plot_style import GREY, PALETTE, add_legend, caption, grid_of, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.figure import Figure

MARKS = ("o", "s", "^")


def drift_figure(
    found: Mapping[tuple[float, float], xr.Dataset],
    ratios: Mapping[tuple[float, float], float],
    estimates: Mapping[float, float],
) -> Figure:
    """Draw the slip under the synthetic motion, and the drift a cycle over the exponent."""
    drawn = new_figure(3.3)
    left, right = grid_of(drawn, 1, 2)[0]
    shown = 0.1e-3
    finite = sorted({eta for eta, _ in ratios if math.isfinite(eta)})
    exponents = [*finite, math.inf]
    handles = []
    for k, eta in enumerate(exponents):
        data = found[eta, shown]
        colour = PALETTE[k] if math.isfinite(eta) else "black"
        name = f"η = {eta:g}" if math.isfinite(eta) else "elastic-plastic"
        slip = abs(data["interface_slip"].sel(axis="x")[:, 0])
        left.plot(data["time"], 1e3 * slip, color=colour, linewidth=1.0)
        handles.append(Line2D([], [], color=colour, linewidth=1.2, label=name))
    left.set_xlim(8.0, float(found[math.inf, shown]["time"][-1]))
    left.set_ylim(4.6, 6.1)
    caption(left, x="time [s]", y="interface slip [mm]", title="slip, u$_y$ = 0.1 mm")
    right.plot(list(estimates), list(estimates.values()), color=GREY, linewidth=1.0)
    marks = [Line2D([], [], color=GREY, linewidth=1.0, label="estimate")]
    yields = sorted({u_y for _, u_y in ratios})
    for k, u_y in enumerate(yields):
        points = [(eta, ratios[eta, u_y]) for eta in finite if ratios[eta, u_y] > 0.0]
        look: dict[str, Any] = {
            "marker": MARKS[k],
            "color": PALETTE[k],
            "linestyle": "",
            "markersize": 4.5,
            "markerfacecolor": "none",
        }
        right.plot(*zip(*points, strict=True), **look)
        marks.append(Line2D([], [], label=f"u$_y$ = {1e3 * u_y:g} mm", **look))
    right.set_xscale("log")
    right.set_yscale("log")
    right.set_xticks(finite, [f"{eta:g}" for eta in finite])
    right.minorticks_off()
    caption(right, x="exponent η [-]", y="drift a cycle / u$_y$ [-]", title="drift")
    right.legend(handles=marks, frameon=False, fontsize=7.5, loc="lower left")
    add_legend(drawn, handles, columns=6, title="Bouc-Wen friction on the rim, synthetic motion")
    return drawn


def newhall_figure(found: Mapping[tuple[float, float], xr.Dataset]) -> Figure:
    """Draw the slip of the numerical example over time, a panel for each yield displacement."""
    drawn = new_figure(2.7)
    yields = sorted({u_y for _, u_y in found})
    row = grid_of(drawn, 1, len(yields), share_x=True, share_y=True)[0]
    handles = []
    for panel, u_y in zip(row, yields, strict=True):
        for k, eta in enumerate(sorted({eta for eta, _ in found})):
            data = found[eta, u_y]
            colour = PALETTE[k] if math.isfinite(eta) else "black"
            slip = abs(data["interface_slip"].sel(axis="x")[:, 0])
            panel.plot(data["time"], 1e3 * slip, color=colour, linewidth=1.0)
            if panel is row[0]:
                name = f"η = {eta:g}" if math.isfinite(eta) else "elastic-plastic"
                handles.append(Line2D([], [], color=colour, linewidth=1.2, label=name))
        caption(panel, x="time [s]", title=f"u$_y$ = {1e3 * u_y:g} mm")
    row[0].set_xlim(4.0, 20.0)
    row[0].set_ylim(36.0, 43.0)
    caption(row[0], y="interface slip [mm]")
    add_legend(drawn, handles, columns=6, title="Slip of the interface, Newhall 360")
    return drawn
