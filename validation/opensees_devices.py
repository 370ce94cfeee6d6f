"""Devices between two nodes of an OpenSeesPy model, each from a bearing and the weight on it.

Sources: the documentation of OpenSees for the elements; the source of its TFP element for the order
of arguments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from lir_element.opensees import macro_model, opensees

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element import LIRBearing

BELOW, ABOVE = 1, 2
"""Tags of the nodes under and over the bearing."""
UP = (0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
"""Orientation of a bearing: local x upwards, local y along global x."""

_INNER = 0.05  # effective radius of the inner sliders over that of the bearing
_INNER_GAP = 1e-4  # m
_CONTACT_RADIUS = 0.15  # m


@dataclass(frozen=True)
class Device:
    """Elements between two nodes: all of them, those on node j, and node m if there is one."""

    above: tuple[int, ...]
    middle: int | None = None


def single(bearing: LIRBearing, weight: float) -> Device:
    """Make a singleFPBearing: no rims, no interface."""
    ops = opensees()
    _materials(bearing)
    ops.frictionModel("Coulomb", 1, bearing.effective_friction)
    ops.element(
        "singleFPBearing", 1, BELOW, ABOVE, 1, bearing.effective_radius,
        _stiffness(bearing, weight), "-P", 1, "-T", 2, "-My", 2, "-Mz", 2, "-orient", *UP,
        "-iter", 50, 1e-10 * weight,
    )  # fmt: skip
    return Device((1,))


def temperature(bearing: LIRBearing, weight: float) -> Device:
    """Make an FPBearingPTV with constant friction: no rims, no interface."""
    ops = opensees()
    _materials(bearing)
    ops.element(
        "FPBearingPTV", 1, BELOW, ABOVE, bearing.effective_friction, 0, 1e7, 0, 0.444e-5, 18.0,
        0, 100.0, bearing.effective_radius, _CONTACT_RADIUS, _stiffness(bearing, weight),
        1, 2, 2, 2, *UP, 0.0, 0, 0.0, 50, 1e-10 * weight, 1,
    )  # fmt: skip
    return Device((1,))


def triple(bearing: LIRBearing, weight: float) -> Device:
    """Make a TripleFrictionPendulum with equal friction everywhere: rims, no interface."""
    ops = opensees()
    _materials(bearing)
    ops.frictionModel("Coulomb", 1, bearing.effective_friction)
    length = bearing.effective_radius
    rim = 0.5 * bearing.lateral_capacity
    stiffness = bearing.resolved()["axial_stiffness"]
    ops.element(
        "TripleFrictionPendulum", 1, BELOW, ABOVE, 1, 1, 1, 1, 2, 2, 2,
        _INNER * length, 0.5 * length, 0.5 * length, _INNER_GAP, rim, rim, weight,
        bearing.yield_displacement, 1e-9 * stiffness, 1e-3 * weight, 1e-6,
    )  # fmt: skip
    return Device((1,))


def tfp(bearing: LIRBearing, weight: float) -> Device:
    """Make a TFP element with its inner surfaces held by friction: rims, no interface."""
    ops = opensees()
    outer = 0.5 * bearing.effective_radius
    inner = 0.3 * outer
    rim = bearing.lateral_capacity  # diameter: half of it each surface
    friction = bearing.effective_friction
    # the last two: yield displacement, then axial stiffness, as the element reads them
    ops.element(
        "TFP", 1, BELOW, ABOVE, inner, inner, outer, outer, 0.01, 0.01, rim, rim,
        0.0, 0.0, 0.0, 0.0, 1.0, 1.0, friction, friction, 0.0, 0.0, 0.0, 0.0,
        bearing.height, weight, 1e-3, bearing.resolved()["axial_stiffness"],
    )  # fmt: skip
    return Device((1,))


def macro(bearing: LIRBearing, weight: float, **options: Any) -> Device:
    """Make the macro-model: rims and interface."""
    tags = macro_model(bearing, BELOW, ABOVE, load=weight, **options)
    last = tags.pendulum if tags.interface is None else tags.interface
    above: tuple[int, ...] = (last,) if tags.restoring is None else (last, tags.restoring)
    if tags.node is None:
        above += tags.rims
    return Device(above, tags.node)


Maker: TypeAlias = "Callable[[LIRBearing, float], Device]"
"""Makes a device between `BELOW` and `ABOVE` from a bearing and the weight on it [N]."""

DEVICES: dict[str, Maker] = {
    "singleFPBearing": single,
    "FPBearingPTV": temperature,
    "TripleFrictionPendulum": triple,
    "TFP": tfp,
    "macro-model": macro,
}


def _materials(bearing: LIRBearing) -> None:
    own = bearing.resolved()
    ops = opensees()
    ops.uniaxialMaterial("Elastic", 1, own["axial_stiffness"], own["axial_damping"])
    ops.uniaxialMaterial("Elastic", 2, 1.0)


def _stiffness(bearing: LIRBearing, weight: float) -> float:
    """Return the lateral stiffness before slip."""
    ratio = weight / bearing.effective_radius
    return bearing.effective_friction * weight / bearing.yield_displacement + ratio
