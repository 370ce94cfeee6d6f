"""Figure of links: force over deformation of storeys that yield, dampers, ties and walls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.results.peak_response import left

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    import xarray as xr
    from matplotlib.figure import Figure

MOST = 6
"""Panels of a figure."""


def link_loops(
    systems: pick.Systems,
    links: str | Collection[str] | None = None,
    *,
    start: float | None = None,
    end: float | None = None,
) -> Figure:
    """Draw force over deformation of links, a panel for each link.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    links : str or sequence of str, optional
        Names of one to six links; those that have taken up the most work in the first result if
        left out.
    start, end : float, optional
        Window of time [s].

    Returns
    -------
    Figure
        Loops in mm and kN, of links that turn in mrad and kN m; dotted lines at the deformation
        at yield, on the sides where it was reached.

    Raises
    ------
    ValueError
        If there are no links, none of a name, or nothing in the window.

    Examples
    --------
    In the gallery: "Storeys that yield" (docs/gallery/building/h_storeys.py).
    """
    found = pick.as_systems(systems, start, end)
    shown = _chosen(found, links)
    columns = ps.COLUMNS[len(shown)]
    height = 3.2 if len(shown) == 1 else 2.3
    figure, panels = ps.panels_of(len(shown), columns, height, share=False)
    for place, (panel, name) in enumerate(zip(panels, shown, strict=True)):
        for k, data in enumerate(found.values()):
            one = data.sel(link=name)
            style = ps.line_of(k) | {"linewidth": 0.8, "linestyle": "-"}
            panel.plot(1e3 * one["link_deformation"], 1e-3 * one["link_force"], **style)
            limit = float(one["link_yield_deformation"])
            for sign in (-1.0, 1.0):
                resisted = sign * one["link_deformation"].where(sign * one["link_force"] > 0.0)
                if float(resisted.max()) >= limit:
                    panel.axvline(1e3 * sign * limit, color=ps.GREY, linewidth=0.6, linestyle=":")
        ps.caption(panel, title=ps.wrapped(name, 0.82 * ps.PAGE_WIDTH / columns))
        if place % columns == 0:
            ps.caption(panel, y="force [kN, kN m]")
        if place + columns >= len(shown):
            ps.caption(panel, x="deformation [mm, mrad]")
    handles = pick.system_handles(found) if len(found) > 1 else []
    label = "" if len(found) > 1 else ", " + pick.label_of(*next(iter(found.items())))
    ps.add_legend(figure, handles, title=f"Force over deformation of links{label}")
    return figure


def _chosen(systems: Mapping[str, xr.Dataset], links: str | Collection[str] | None) -> list[str]:
    # The names of the links shown, which all systems must have.
    variables = ("link_deformation", "link_force", "link_yield_deformation")
    for data in systems.values():
        pick.need(data, variables, "draw a model with links (Frame.add_link) that were recorded")
    first = next(iter(systems.values()))
    known = [str(name) for name in first["link"].to_numpy()]
    if links is None:
        work = np.abs(left(first, "link_work"))
        most = np.argsort(-work, kind="stable")[: min(MOST, max(1, int((work > 0.0).sum())))]
        names = [known[k] for k in sorted(most)]
    else:
        names = pick.several(links)
    if not 1 <= len(names) <= MOST:
        msg = f"{len(names)} links: give 1 to {MOST}, a panel each"
        raise ValueError(msg)
    for system, data in systems.items():
        there = [str(name) for name in data["link"].to_numpy()]
        where = "" if len(systems) == 1 else f" in {system!r}"
        for name in names:
            pick.choose(name, there, "link", where)
    return names
