"""A structure on bearings with other parameters: fields of the bearing by name."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING

from frames.risk._errors import CampaignError
from lir_element.device.friction import CoulombFriction, known_laws

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from frames.frame import Frame
    from lir_element import FrictionLaw, LIRBearing

FIELDS = (
    "radius",
    "slider_height",
    "slider_radius",
    "capacity",
    "interface_friction",
    "axial_stiffness",
    "axial_damping",
    "rim_stiffness",
    "rim_damping",
    "rim_yield_force",
    "rim_overrun",
    "flange",
    "slip_capacity",
    "uplift_capacity",
    "yield_displacement",
    "interface_yield_displacement",
)
"""Fields of `LIRBearing` that a sample may name: one number for both surfaces, SI."""

_INTERFACE = "interface_friction", "interface_yield_displacement"
"""Fields that no run on a plain DCFP reads."""


def with_parameters(frame: Frame, parameters: Mapping[str, float]) -> Frame:
    """Return a structure whose bearings all have the given parameters."""
    before = {name: link.bearing for name, link in frame.bearings.items()}
    distinct = {id(each): each for each in before.values()}
    made = {key: _device(each, parameters) for key, each in distinct.items()}
    return frame.with_bearings({name: made[id(each)] for name, each in before.items()})


def _device(bearing: LIRBearing, parameters: Mapping[str, float]) -> LIRBearing:
    changes: dict[str, Any] = {name: parameters[name] for name in FIELDS if name in parameters}
    law = {name: parameters[name] for name in parameters.keys() - changes.keys() - {"friction"}}
    if bearing.is_dcfp:
        changes = {name: value for name, value in changes.items() if name not in _INTERFACE}
    if "capacity" in changes:
        changes["rims"] = None
    if "friction" in parameters:
        changes["friction"] = CoulombFriction(parameters["friction"])
        if law:
            msg = f"friction and {', '.join(law)} are given: one is Coulomb's, the others are not"
            raise CampaignError(msg)
    elif law:
        changes["friction"] = _laws(bearing, law)
    return replace(bearing, **changes)


def _laws(bearing: LIRBearing, changes: Mapping[str, float]) -> tuple[FrictionLaw, ...]:
    # The friction of both surfaces with other values of its fields.
    kinds = list(dict.fromkeys(type(each) for each in bearing.frictions))
    for name in sorted(changes):
        lacking = [kind for kind in kinds if name not in names_of(kind)]
        if not lacking:
            continue
        others = [kind.__name__ for kind in known_laws() if name in names_of(kind)]
        if others:
            has = "Coulomb's friction" if CoulombFriction in lacking else lacking[0].__name__
            msg = f"{name}: the bearing has {has}; give it {' or '.join(others)}"
            raise CampaignError(msg)
        of_law = [each for each in names_of(kinds[0]) if len(kinds) == 1]
        there = ", ".join(["friction", *FIELDS, *of_law])
        msg = f'"{name}" is no parameter: there are {there}'
        raise CampaignError(msg)
    return tuple(replace(each, **changes) for each in bearing.frictions)  # type: ignore[type-var]


def names_of(law: type[FrictionLaw]) -> list[str]:
    """Return the names of a law's fields that are parameters: those of the bearing are its own."""
    return [f.name for f in fields(law) if f.name not in {*FIELDS, "friction"}]  # type: ignore[arg-type]
