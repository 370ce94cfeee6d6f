"""Devices between the two nodes of a stand in OpenSees, each from a bearing and the weight on it.

What a plain bearing becomes is said in `lir_element.opensees.builtin_element`, what the macro-model
is in `lir_element.opensees.compare.macro_model`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

from lir_element.opensees import builtin_commands, builtin_element, macro_model, opensees
from validation.opensees.model import ABOVE, BELOW, ELEMENT

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element import LIRBearing
    from lir_element.opensees.compare.builtin_writing import BuiltinKind

_TFP_DISHES = slice(10, 12)
"""Places of the diameters of the two outer dishes in the command of a TFP."""


@dataclass(frozen=True)
class Device:
    """Elements between two nodes: all of them, those on node j, and node m if there is one."""

    above: tuple[int, ...]
    middle: int | None = None


def plain(kind: BuiltinKind, bearing: LIRBearing, weight: float) -> Device:
    """Make an element of OpenSees from a plain bearing that it can represent."""
    builtin_element(kind, ELEMENT, BELOW, ABOVE, bearing, weight)
    return Device((ELEMENT,))


def tfp(bearing: LIRBearing, weight: float) -> Device:
    """Make a TFP with rims."""
    # builtin_element refuses rims for this element because they end in NaN. The hard cases are
    # there to show that: its command is taken without rims, and given dishes that end at them.
    (command,) = builtin_commands("TFP", ELEMENT, BELOW, ABOVE, bearing.as_dcfp(rims=False), weight)
    arguments = list(command[1:])
    # the element measures sliding at the pivot, R - h/2 from the centre of a dish
    half = 0.5 * bearing.slider_height
    surfaces = zip(bearing.radii, bearing.rim_displacement, strict=True)
    arguments[_TFP_DISHES] = [2.0 * reach * (r - half) / r for r, reach in surfaces]
    opensees().element(*arguments)
    return Device((ELEMENT,))


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
    "singleFPBearing": partial(plain, "singleFPBearing"),
    "FPBearingPTV": partial(plain, "FPBearingPTV"),
    "TripleFrictionPendulum": partial(plain, "TripleFrictionPendulum"),
    "TFP": tfp,
    "macro-model": macro,
}
