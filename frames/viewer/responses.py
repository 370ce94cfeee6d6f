"""What a page plots of the structure over time: floors, storeys, the base."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.results.measures import floor_acceleration, storey_drift

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray


class Response(NamedTuple):
    """Histories of one quantity.

    Attributes
    ----------
    name, unit : str
        What it is, and the unit that it is shown in.
    factor : float
        From SI to that unit.
    places : tuple of str
        Levels, storeys, or what else has one.
    values : ndarray, (n_steps, n_places, 2)
        Along x and y, SI.
    """

    name: str
    unit: str
    factor: float
    places: tuple[str, ...]
    values: FloatArray


def responses(data: xr.Dataset) -> list[Response]:
    """Return the histories of floors and storeys that a result has, and of its base."""
    found = []
    levels = data.sizes.get("level", 0)
    if levels and "node_acceleration" in data:
        moves = floor_acceleration(data).sel(axis=["x", "y"])
        found.append(_response("floor acceleration", "m/s²", 1.0, moves, "level"))
    if levels > 1:
        found.append(_response("storey drift", "%", 100.0, storey_drift(data), "storey"))
    for name, variable, place, unit, factor in (
        ("storey shear", "storey_shear", "storey", "kN", 1e-3),
        ("base shear", "base_shear", "", "kN", 1e-3),
        ("ground acceleration", "ground_acceleration", "", "m/s²", 1.0),
    ):
        if variable in data and data[variable].size:
            part = data[variable].sel(axis=["x", "y"])
            found.append(_response(name, unit, factor, part, place))
    return found


def _response(name: str, unit: str, factor: float, values: xr.DataArray, place: str) -> Response:
    if not place:
        values, place = values.expand_dims("place"), "place"
    numbers = values.transpose("time", place, "axis").to_numpy().astype(np.float64)
    named = place in values.coords
    places = tuple(map(str, values[place].to_numpy())) if named else (name,)
    return Response(name, unit, factor, places, numbers)
