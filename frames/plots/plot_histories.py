"""Figures of quantities over time, the systems over one another."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames.plots.plot_style import (
    GREY,
    LINES,
    PALETTE,
    PLANE,
    SMALL,
    WIDTHS,
    Systems,
    add_legend,
    as_systems,
    caption,
    engineering,
    grid_of,
    new_figure,
    peak_of,
    system_handles,
    text_of,
    worst_bearing,
)
from frames.results.measures import floor_acceleration

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray


def histories(
    systems: Systems,
    quantities: Sequence[str] = ("displacement", "base_shear", "interface_slip", "axial_force"),
    bearing: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    limits: Mapping[str, float] | None = None,
) -> Figure:
    """Draw quantities over time, one panel each, the systems over one another.

    Parameters
    ----------
    systems : Dataset or mapping of name to Dataset
        Results to compare.
    quantities : sequence of str
        Of `QUANTITIES`: "displacement", "base_shear", "interface_slip", "axial_force",
        "rim_force", "roof_acceleration", "ground_acceleration".
    bearing : str, optional
        The bearing they belong to; that with the largest slip in the first result if left out.
    window : (float, float), optional
        From when to when [s].
    limits : mapping of quantity to float, optional
        Largest value shown, in SI units; peaks beyond it are marked with their value.

    Returns
    -------
    Figure
        The histories.

    Raises
    ------
    ValueError
        If a quantity is unknown, or there is none.
    """
    unknown = [name for name in quantities if name not in QUANTITIES]
    if unknown or not quantities:
        msg = f"quantities = {list(quantities)}: choose one or more of {', '.join(QUANTITIES)}"
        raise ValueError(msg)
    found = as_systems(systems)
    name_of = worst_bearing(next(iter(found.values()))) if bearing is None else bearing
    figure = new_figure(0.8 + 1.55 * len(quantities))
    column = [row[0] for row in grid_of(figure, len(quantities), 1, share_x=True)]
    for quantity, panel in zip(quantities, column, strict=True):
        traces = [QUANTITIES[quantity](data, name_of) for data in found.values()]
        if window is not None:
            traces = [trace.sel(time=slice(*window)) for trace in traces]
        _history(panel, traces, (limits or {}).get(quantity))
    if window is not None:
        column[0].set_xlim(*window)
    else:
        column[0].set_xlim(0.0, max(float(data["time"][-1]) for data in found.values()))
    caption(column[-1], x="time [s]")
    figure.align_ylabels()
    add_legend(figure, system_handles(found), title=f"Histories, {name_of}")
    return figure


def _history(panel: Axes, traces: Sequence[xr.DataArray], limit: float | None) -> None:
    units = str(traces[0].attrs["units"])
    peak = peak_of(trace.to_numpy() for trace in traces)
    shown = peak if limit is None else min(limit, peak)
    factor, unit = engineering(units, shown)
    common = all(np.array_equal(_until(t, traces[0]), _until(traces[0], t)) for t in traces)
    for k, trace in enumerate([max(traces, key=len)] if common else traces):
        colour, line = (GREY, "-") if common and len(traces) > 1 else (PALETTE[k], LINES[k])
        width = WIDTHS[2] if common and len(traces) > 1 else WIDTHS[k]
        values = factor * trace.to_numpy()
        panel.plot(trace["time"], values, color=colour, linestyle=line, linewidth=width)
    low = min(float(trace.min()) for trace in traces)
    bottom = -1.05 * factor * min(-low, shown) if low < -1e-6 * peak else 0.0
    panel.set_ylim(bottom, (1.08 * factor * shown) or 1.0)
    beyond = [
        (k, factor * float(np.abs(t).max()))
        for k, t in enumerate(traces)
        if limit is not None and float(np.abs(t).max()) > limit
    ]
    for place, (k, value) in enumerate(beyond):
        panel.text(0.015, 0.95 - 0.13 * place, f"▲ {value:.3g}", transform=panel.transAxes,
                   ha="left", va="top", fontsize=SMALL, color=PALETTE[k])  # fmt: skip
    caption(panel, y=text_of(str(traces[0].attrs["long_name"]), unit))


def _until(trace: xr.DataArray, other: xr.DataArray) -> FloatArray:
    # The values as far as the other trace goes.
    return trace.to_numpy()[: len(other)]


def _size_in_plan(values: xr.DataArray, long_name: str, units: str) -> xr.DataArray:
    plane = values.sel(axis=list(PLANE))
    size = xr.DataArray(
        np.linalg.norm(plane.to_numpy(), axis=-1), {"time": values["time"]}, ("time",)
    )
    return size.assign_attrs(long_name=long_name, units=units)


def _displacement(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["bearing_displacement"]
    return _size_in_plan(values.sel(bearing=bearing), "displacement\nin plan", values.units)


def _base_shear(data: xr.Dataset, bearing: str) -> xr.DataArray:
    return _size_in_plan(data["base_shear"] / data["weight"], "base shear\n/ weight", "1")


def _interface_slip(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["interface_slip_size"]
    return values.sel(bearing=bearing).assign_attrs(long_name="interface\nslip")


def _axial_force(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["axial_force"]
    return values.sel(bearing=bearing).assign_attrs(long_name="axial\nforce")


def _rim_force(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["rim_force"]
    largest = values.sel(bearing=bearing).max("surface")
    return largest.assign_attrs(long_name="larger\nrim force", units=values.units)


def _roof_acceleration(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = floor_acceleration(data)
    return _size_in_plan(values.isel(level=-1), "roof acc.\nin plan", values.units)


def _ground_acceleration(data: xr.Dataset, bearing: str) -> xr.DataArray:
    values = data["ground_acceleration"]
    return _size_in_plan(values, "ground acc.\nin plan", values.units)


QUANTITIES: dict[str, Callable[[xr.Dataset, str], xr.DataArray]] = {
    "displacement": _displacement,
    "base_shear": _base_shear,
    "interface_slip": _interface_slip,
    "axial_force": _axial_force,
    "rim_force": _rim_force,
    "roof_acceleration": _roof_acceleration,
    "ground_acceleration": _ground_acceleration,
}
"""Histories by name, as functions of the Dataset and a bearing."""
