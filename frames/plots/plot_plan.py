"""Figure of the bearings in plan, by how far they are used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.patches import Circle

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.results.measures import lateral_capacity
from frames.results.peak_response import largest

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray

_SAME_PLACE = 3  # decimals of a place in m, in plan


def bearing_plan(data: xr.Dataset) -> Figure:
    """Draw the bearings in plan, coloured by how far they use their displacement capacity.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history.

    Returns
    -------
    Figure
        A circle for each bearing, or for those under one column, with names, largest displacement
        over capacity, largest slip of the interface and minimum axial force; the colour is the
        first of these.

    Raises
    ------
    ValueError
        If the Dataset does not tell the places of nodes.

    Examples
    --------
    In the gallery: "A slender building lifts" (docs/gallery/building/i_uplift.py).
    """
    pick.need(data, ("node_position", "bearing_node"), "draw a result of time_history")
    lower = data["bearing_node"].sel(end="i").to_numpy()
    if (lower < 0).any():
        msg = "nodes under bearings were not recorded: record those of all bearings to draw a plan"
        raise ValueError(msg)
    places = data["node_position"].to_numpy()[lower, :2]
    share = largest(data, "displacement").values / lateral_capacity(data)
    slip = 1e3 * largest(data, "slip").values
    least = -1e-3 * largest(data, "axial_tension").values
    figure = ps.new_figure(5.2)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    colours = ScalarMappable(Normalize(0.0, max(1.0, float(share.max()))), "YlOrRd")
    spots, at = np.unique(places.round(_SAME_PLACE), axis=0, return_inverse=True)
    apart, names = _nearest(spots), data["bearing"].to_numpy()
    for k, (x, y) in enumerate(spots):
        own = np.flatnonzero(at.ravel() == k)  # several stand under some columns
        worst = own[share[own].argmax()]
        face = colours.to_rgba(share[worst])
        panel.add_patch(Circle((x, y), 0.22 * apart, facecolor=face, edgecolor=ps.GREY))
        text = "\n".join(str(name) for name in names[own]) + f"\n{100.0 * share[worst]:.0f} %"
        text += f"\ns {slip[own].max():.1f} mm\nN ≥ {least[own].min():.0f} kN"
        panel.annotate(
            text, (x, y - 0.26 * apart), ha="center", va="top", fontsize=ps.SMALL, color="black"
        )
    panel.set_aspect("equal")
    panel.set_xlim(spots[:, 0].min() - 0.6 * apart, spots[:, 0].max() + 0.6 * apart)
    panel.set_ylim(spots[:, 1].min() - 0.9 * apart, spots[:, 1].max() + 0.5 * apart)
    ps.caption(panel, x="x [m]", y="y [m]")
    bar = figure.colorbar(colours, ax=panel, shrink=0.8)
    bar.set_label("largest displacement over displacement capacity", fontsize=ps.LABEL)
    bar.ax.tick_params(labelsize=ps.SMALL)
    label = pick.label_of(str(data.attrs.get("title", "bearings")), data, " ")
    ps.add_legend(figure, [], title=f"Bearings in plan: {label}")
    return figure


def _nearest(spots: FloatArray) -> float:
    # Distance of the two places that are nearest to one another, 1 m for a single one.
    if len(spots) < 2:
        return 1.0
    apart = np.linalg.norm(spots[:, None] - spots[None], axis=-1)
    apart[np.diag_indices(len(spots))] = np.inf
    return float(apart.min())
