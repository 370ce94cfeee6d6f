"""Figures of quantities over time, and of the bearings in plan by how far they are used."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.patches import Circle

from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.results.formulas import in_plan, values_of
from frames.results.measures import lateral_capacity
from frames.results.peak_response import largest
from frames.results.quantities import QUANTITIES as TABLE
from frames.results.quantities import Quantity
from lir_element.texts import worded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

USUAL = ("displacement", "base_shear", "interface_slip", "axial_force")
_SPIKY = ("base_shear", "roof_acceleration")  # impacts exceed the rest by far
_BRIEF = 0.01  # share of the time that a few impacts may take
_OUTSTANDING = 2.5  # times the largest value of the rest of the time: beyond, peaks are cut
_ROOM = 1.6  # times that value: end of the axis


def histories(
    systems: pick.Systems,
    quantities: str | Sequence[str] | None = None,
    bearing: str | None = None,
    *,
    start: float | None = None,
    end: float | None = None,
    limits: Mapping[str, float] | None = None,
) -> Figure:
    """Draw quantities over time, one panel each, the systems over one another.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    quantities : str or sequence of str, optional
        Names in `QUANTITIES`: "displacement", "base_shear", "interface_slip", "axial_force",
        "rim_force", "roof_acceleration", "ground_acceleration". Default: the first four, without
        those that stay zero.
    bearing : str, optional
        Their bearing; by default that with the largest slip in the first result (the largest
        displacement if nothing slips).
    start, end : float, optional
        Window of time [s].
    limits : mapping of quantity to float, optional
        Largest value shown, in SI units, > 0; infinite shows all. By default base shear and roof
        acceleration end at a lower value if impacts shorter than 1 % of the time would flatten the
        rest. Peaks beyond are marked with their value.

    Returns
    -------
    Figure
        The histories.

    Raises
    ------
    ValueError
        If a quantity or the bearing is unknown, or nothing is in the window.

    Examples
    --------
    In the gallery: "Histories of a building" (docs/gallery/building/c_histories.py).
    """
    found = pick.as_systems(systems, start, end)
    names = list(USUAL) if quantities is None else pick.several(quantities)
    if not names:
        msg = f"quantities is empty: choose one or more of {', '.join(QUANTITIES)}"
        raise ValueError(msg)
    ends = dict(limits or {})
    for name in (*names, *ends):
        pick.choose(name, QUANTITIES, "quantity")
    for name, value in ends.items():
        if not value > 0.0:
            msg = f"limits[{name!r}] = {value} must be greater than 0: leave it out for a default"
            raise ValueError(msg)
    bearing = pick.choose_bearing(found, bearing)
    for name in names:
        for data in found.values():
            pick.need(data, _NEEDS.get(name, (name,)), f"leave the quantity {name!r} out")
    traces = {name: [_trace(data, name, bearing) for data in found.values()] for name in names}
    if quantities is None:
        moving = {n: t for n, t in traces.items() if ps.peak_of(x.to_numpy() for x in t) > 0.0}
        traces = moving or traces
    figure = ps.new_figure(0.8 + 1.55 * len(traces))
    column = [row[0] for row in ps.grid_of(figure, len(traces), 1, share_x=True)]
    for (name, values), panel in zip(traces.items(), column, strict=True):
        usual = max(_telling(trace) for trace in values) if name in _SPIKY else np.inf
        _history(panel, values, ends.get(name, usual))
    first = min(float(data["time"][0]) for data in found.values())
    last = max(float(data["time"][-1]) for data in found.values())
    column[0].set_xlim(first if start is None else start, last if end is None else end)
    ps.caption(column[-1], x="time [s]")
    figure.align_ylabels()
    ps.add_legend(figure, pick.system_handles(found), title=f"Histories, {bearing}")
    return figure


def _telling(trace: xr.DataArray) -> float:
    # The largest size; a lower value if brief impacts exceed all the rest by far.
    size = np.abs(trace.to_numpy())
    peak = float(size.max())
    order = np.argsort(size)
    share = np.cumsum(np.gradient(trace["time"].to_numpy())[order])
    rest = float(size[order][np.searchsorted(share, (1.0 - _BRIEF) * share[-1])])
    return peak if peak <= _OUTSTANDING * rest else _ROOM * rest


def _history(panel: Axes, traces: Sequence[xr.DataArray], limit: float) -> None:
    units = str(traces[0].attrs["units"])
    peaks = [ps.peak_of([trace.to_numpy()]) for trace in traces]
    peak = max(peaks)
    shown = min(limit, peak)
    factor, unit = ps.engineering(units, shown)
    common = all(np.array_equal(_until(t, traces[0]), _until(traces[0], t)) for t in traces)
    for k, trace in enumerate([max(traces, key=len)] if common else traces):
        look = ps.line_of(k)
        if common and len(traces) > 1:  # one line for all systems
            look = {"color": ps.GREY, "linestyle": "-", "linewidth": ps.WIDTHS[2]}
        panel.plot(trace["time"], factor * trace.to_numpy(), **look)
    low = min(float(trace.min()) for trace in traces)
    bottom = -1.05 * factor * min(-low, shown) if low < -1e-6 * peak else 0.0
    panel.set_ylim(bottom, (1.08 * factor * shown) or 1.0)
    beyond = [(k, factor * value) for k, value in enumerate(peaks) if value > limit]
    for place, (k, value) in enumerate(beyond):
        panel.text(
            0.015,
            0.95 - 0.13 * place,
            f"▲ {value:.3g}",
            transform=panel.transAxes,
            ha="left",
            va="top",
            fontsize=ps.SMALL,
            color=ps.PALETTE[k],
        )
    ps.caption(panel, y=ps.text_of(str(traces[0].attrs["long_name"]), unit))


def _until(trace: xr.DataArray, other: xr.DataArray) -> FloatArray:
    # The values as far as the other trace goes.
    return trace.to_numpy()[: len(other)]


def _trace(data: xr.Dataset, name: str, bearing: str) -> xr.DataArray:
    # Quantity of a bearing, of the highest level or of the whole structure.
    key, label = QUANTITIES[name]
    quantity = TABLE.get(key, _GROUND)
    values = quantity.of(data)
    if quantity.dims == ("bearing",):
        values = values[:, list(map(str, data["bearing"].to_numpy())).index(bearing)]
    elif quantity.dims == ("level",):
        values = values[:, -1]
    attrs = {"long_name": label, "units": quantity.unit}
    if key == "base_shear":
        values, attrs["units"] = values / float(data["weight"]), "1"
    return xr.DataArray(values, {"time": data["time"]}, ("time",), attrs=attrs)


_GROUND = Quantity(
    (),
    "m/s2",
    "ground acceleration in plan",
    lambda d: in_plan(values_of(d, "ground_acceleration", "time", "axis")),
)
QUANTITIES = {
    "displacement": ("displacement", "displacement\nin plan"),
    "base_shear": ("base_shear", "base shear\n/ weight"),
    "interface_slip": ("slip", "interface\nslip"),
    "axial_force": ("axial_force", "axial\nforce"),
    "rim_force": ("rim_force", "larger\nrim force"),
    "roof_acceleration": ("floor_plan", "roof acc.\nin plan"),
    "ground_acceleration": ("ground", "ground acc.\nin plan"),
}
"""Histories by name: the quantity of each, and its axis."""

_NEEDS = {
    "displacement": ("bearing_displacement",),
    "base_shear": ("base_shear", "weight"),
    "interface_slip": ("interface_slip_size",),
    "roof_acceleration": ("node_acceleration", "level_node"),
}


_SAME_PLACE = 3  # decimals of a place in m, in plan


def bearing_plan(data: xr.Dataset) -> Figure:
    """Draw the bearings in plan, coloured by displacement over displacement capacity.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history.

    Returns
    -------
    Figure
        A circle for each bearing, or for those under one column, with names, largest displacement
        over capacity, largest slip of the interface and minimum axial force; the colour is the
        first of these.

    Raises
    ------
    ValueError
        If the Dataset lacks the places of nodes.

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
        own = np.flatnonzero(at.ravel() == k)  # some columns have several
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
    ps.add_legend(figure, [], title=worded("Bearings in plan: {what}", what=label))
    return figure


def _nearest(spots: FloatArray) -> float:
    # Distance of the two places that are nearest to one another, 1 m for a single one.
    if len(spots) < 2:
        return 1.0
    apart = np.linalg.norm(spots[:, None] - spots[None], axis=-1)
    apart[np.diag_indices(len(spots))] = np.inf
    return float(apart.min())
