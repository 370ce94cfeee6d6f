"""Bearings on a regular grid, shared by the ready-made models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from frames._errors import ModelError
from frames.frame import Frame
from lir_element.argument_checks import require_positive, shown

if TYPE_CHECKING:
    from lir_element import LIRBearing

    Bearings: TypeAlias = LIRBearing | Mapping[tuple[int, int], LIRBearing]
    """One bearing for every place of a grid, or one for each place (ix, iy)."""


def require_device(name: str, device: object) -> None:
    """Raise a TypeError unless `device` is what a bearing element is made of."""
    if not isinstance(getattr(device, "height", None), (int, float)):
        msg = f"{name} = {shown(device)} must be an LIRBearing, the device itself"
        raise TypeError(msg)


def bearings_at(
    places: Sequence[tuple[int, int]], bearing: Bearings
) -> dict[tuple[int, int], LIRBearing]:
    """Return the device at every place (ix, iy) of a grid."""
    chosen = bearing if isinstance(bearing, Mapping) else dict.fromkeys(places, bearing)
    missing = [place for place in places if place not in chosen]
    unused = [place for place in chosen if place not in places]
    if missing or unused:
        message = (
            f"bearing: the grid has the places {places[0]} to {places[-1]}; without a bearing: "
            f"{missing or 'none'}, not of the grid: {unused or 'none'}: give one LIRBearing for "
            "all, or a mapping with every place (ix, iy)"
        )
        raise ModelError(message)
    for place, device in chosen.items():
        require_device(f"bearing at {place}" if isinstance(bearing, Mapping) else "bearing", device)
    return {place: chosen[place] for place in places}


def add_bearings(
    frame: Frame, devices: Mapping[str, LIRBearing], points: Mapping[str, tuple[float, float]]
) -> float:
    """Add a bearing at every point in plan, between a ground and a base node; return their height.

    The base is level: ground nodes under bearings of less height stand higher.
    """
    level = max(device.height for device in devices.values())
    for name, device in devices.items():
        x, y = points[name]
        frame.add_node(f"ground-{name}", x, y, level - device.height)
        frame.fix(f"ground-{name}", "all")
        frame.add_node(f"base-{name}", x, y, level)
        frame.add_bearing(f"bearing-{name}", f"ground-{name}", f"base-{name}", device)
    return level


def pair(
    value: float | tuple[float, float], what: str, *, count: bool = False
) -> tuple[float, float]:
    """Accept one number for both horizontal directions, or two."""
    values = tuple(value) if isinstance(value, Sequence) else (value, value)
    if len(values) != 2:
        message = f"{what} = {value!r} must be one number, or two for x and y"
        raise ModelError(message)
    first, second = (
        require_positive(what, number, remedy="give one number, or two for x, y", error=ModelError)
        for number in values
    )
    if count and not (first.is_integer() and second.is_integer()):
        message = f"{what} = {value!r} must be whole: give counts of 1 or more"
        raise ModelError(message)
    return first, second
