"""Figures of a comparison of two devices: motion by motion, and the loops of one motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.design.project.comparison import BY_MOTION, OURS, PLAIN
from frames.design.report.page import Picture, picture
from frames.plots import bearing_sections, hysteresis, storey_profiles
from frames.plots import plot_style as ps
from frames.results.quantities import DEMANDS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DEVICES = (OURS, PLAIN)
_MARKERS = ("o", "s")
_ASIDE = (-0.12, 0.12)  # of the number of the motion


def by_motion(table: pd.DataFrame) -> Figure:
    """Draw what each motion reached with each device, the largest over the bounds."""
    titles = [title for title in BY_MOTION if table[title].notna().any()]
    figure, panels = ps.panels_of(len(titles), 2, 2.1, share=False)
    for panel, title in zip(panels, titles, strict=True):
        _panel(panel, table, title)
    handles = [
        Line2D([], [], marker=marker, color=colour, linestyle="none", label=device)
        for device, marker, colour in zip(_DEVICES, _MARKERS, ps.PALETTE, strict=False)
    ]
    if (table["failed"] != "").any():
        cross: dict[str, Any] = {"marker": "x", "color": ps.GREY, "linestyle": "none"}
        handles.append(Line2D([], [], label="a run stopped: reached at least", **cross))
    ps.add_legend(figure, handles)
    return figure


def _panel(panel: Axes, table: pd.DataFrame, title: str) -> None:
    quantity = DEMANDS[BY_MOTION[title]]
    shown, factor = quantity.in_figures
    motions = list(dict.fromkeys(table["motion"]))
    for k, device in enumerate(_DEVICES):
        rows = table[table["device"] == device].set_index("motion").loc[motions]
        values = factor * rows[title].to_numpy(dtype=float)
        places = np.arange(1, len(motions) + 1) + _ASIDE[k]
        failed = (rows["failed"] != "").to_numpy()
        look: dict[str, Any] = {"color": ps.PALETTE[k], "linestyle": "none", "markersize": 5.0}
        panel.plot(places[~failed], values[~failed], marker=_MARKERS[k], **look)
        panel.plot(places[failed], values[failed], marker="x", **look)
        for x, y in zip(places[failed], values[failed], strict=True):
            panel.annotate(
                "",
                (x, y),
                xytext=(0.0, 13.0),
                textcoords="offset points",
                arrowprops={"arrowstyle": "<-", "color": ps.PALETTE[k], "linewidth": 0.9},
            )
    panel.set_xticks(range(1, len(motions) + 1))
    panel.set_xlim(0.5, len(motions) + 0.5)
    panel.set_ylim(0.0, 1.2 * factor * float(np.nanmax(table[title])) or 1.0)
    ps.caption(panel, x="number of the motion", y=f"{quantity.demand} [{shown}]")


def comparison_pictures(
    table: pd.DataFrame, histories: Mapping[str, xr.Dataset], case: str, bearing: str
) -> dict[str, list[Picture]]:
    """Return the figures of a comparison by the section that they stand in."""
    several = table["level"].nunique() > 1
    motions = [
        picture(
            "Largest of each motion over the bounds" + (f", {level} level" if several else ""),
            by_motion(rows),
        )
        for level, rows in table.groupby("level", sort=False)
    ]
    systems = dict(histories)
    loops = [
        picture(f"Force over displacement, {bearing}; {case}", hysteresis(systems, bearing)),
        picture(f"Storeys; {case}", storey_profiles(systems)),
    ]
    loops += [
        picture(f"{device}, {bearing}; {case}", bearing_sections(data, bearing=bearing))
        for device, data in histories.items()
    ]
    return {"motions": motions, "loops": loops}
