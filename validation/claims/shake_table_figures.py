"""The figures of the shake table test, after Figs 10 and 11 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.plots.plot_style import GREY, PALETTE, add_legend, caption, grid_of, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.figure import Figure

    from frames import GroundMotion
    from lir_element import LIRBearing


def inputs(motions: Mapping[str, GroundMotion]) -> Figure:
    """Draw the accelerations of the table, after Fig. 10."""
    drawn = new_figure(2.0)
    row = grid_of(drawn, 1, len(motions), share_x=True, share_y=True)[0]
    for panel, (name, motion) in zip(row, motions.items(), strict=True):
        panel.plot(motion.time, motion.components[:, 0], color=PALETTE[0], linewidth=1.0)
        caption(panel, x="time [s]", title=f"test {name}")
    row[0].set_xlim(0.0, next(iter(motions.values())).duration)
    caption(row[0], y="acceleration [m/s²]")
    return drawn


def responses(
    without: xr.Dataset, plain: xr.Dataset, impact: xr.Dataset, device: LIRBearing
) -> Figure:
    """Draw base displacement and loops without and with impact, after Fig. 11."""
    drawn = new_figure(4.7)
    grid = grid_of(drawn, 2, 2)
    looks: tuple[dict[str, Any], ...] = (
        {"color": PALETTE[0], "linewidth": 1.8},
        {"color": PALETTE[1], "linewidth": 0.9, "linestyle": "--"},
    )
    for row, pairs, title in (
        (grid[0], ((without, looks[0]), (plain, looks[1])), "without impact"),
        (grid[1], ((impact, {**looks[0], "linewidth": 1.1}),), "with impact"),
    ):
        for data, look in pairs:
            u = 1e3 * data["bearing_displacement"].sel(axis="x").mean("bearing")
            row[0].plot(data["time"], u, **look)
            row[1].plot(u, data["base_shear"].sel(axis="x") / data["weight"], **look)
        for sign in (-1.0, 1.0):
            reach = sign * 1e3 * device.lateral_capacity
            row[0].axhline(reach, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
            row[1].axvline(reach, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
            row[1].axhline(0.6 * sign, color="black", linewidth=0.8, linestyle=(0, (1, 2)))
        row[0].set_xlim(0.0, float(without["time"][-1]))
        row[0].set_ylim(-155.0, 155.0)
        row[1].set_xlim(-155.0, 155.0)
        row[1].set_ylim(-0.66, 0.66)
        caption(row[0], y="base displacement [mm]", title=title)
        caption(row[1], y="base shear / weight [-]", title=title)
    caption(grid[1][0], x="time [s]")
    caption(grid[1][1], x="base displacement [mm]")
    handles = [
        Line2D([], [], label="LIR-DCFP", **looks[0]),
        Line2D([], [], label="plain DCFP", **looks[1]),
        Line2D([], [], color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), label="capacity"),
        Line2D([], [], color="black", linewidth=0.8, linestyle=(0, (1, 2)), label="60 % of weight"),
    ]
    add_legend(drawn, handles, columns=4, title="Stiff structure on four bearings")
    return drawn
