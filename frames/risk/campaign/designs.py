"""A structure with other parameters: fields of its bearings by name, factors on them, damping."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING

from frames.model.damping import ModalDamping
from frames.risk._errors import CampaignError
from lir_element.device.bearing import LIRBearing
from lir_element.device.friction import CoulombFriction, known_laws
from lir_element.fields import unit_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from frames.frame import Frame
    from lir_element import FrictionLaw

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
    "interface_hold",
)
"""Fields of `LIRBearing` that a sample may name: one number for both surfaces, SI."""

OF_BEARINGS = {name: unit_of(LIRBearing, name) for name in FIELDS} | {"friction": ""}
"""Units of parameters that all bearings have, "" of pure numbers."""

FACTOR = "_factor"
"""Ends the name of a parameter that multiplies the value of each bearing."""

DAMPING = "modal_damping"
"""Parameter of the structure: its modal damping [-]."""

UNITS = OF_BEARINGS | dict.fromkeys((DAMPING, *(f"{name}{FACTOR}" for name in OF_BEARINGS)), "")
"""Units of all parameters but those of friction laws."""

_INTERFACE = "interface_friction", "interface_yield_displacement", "interface_hold"
"""Fields that no run on a plain DCFP reads."""


def with_parameters(frame: Frame, parameters: Mapping[str, float]) -> Frame:
    """Return a structure whose bearings all have the given parameters."""
    before = {name: link.bearing for name, link in frame.bearings.items()}
    distinct = {id(each): each for each in before.values()}
    own = {name: value for name, value in parameters.items() if name != DAMPING}
    made = {key: _device(each, own) for key, each in distinct.items()}
    found = frame.with_bearings({name: made[id(each)] for name, each in before.items()})
    if DAMPING in parameters:
        found.set_damping(ModalDamping(parameters[DAMPING]))
    return found


def _device(bearing: LIRBearing, given: Mapping[str, float]) -> LIRBearing:
    parameters, factor = _by_factors(bearing, given)
    changes: dict[str, Any] = {name: parameters[name] for name in FIELDS if name in parameters}
    law = {name: parameters[name] for name in parameters.keys() - changes.keys() - {"friction"}}
    if factor is not None:
        changes["friction"] = tuple(each.scaled(factor) for each in bearing.frictions)
    if bearing.is_dcfp:
        changes = {name: value for name, value in changes.items() if name not in _INTERFACE}
    if "capacity" in changes:
        changes["rims"] = None
    if "friction" in parameters:
        changes["friction"] = CoulombFriction(parameters["friction"])
        if law:
            msg = f"friction and {', '.join(law)} are given: leave one out"
            raise CampaignError(msg)
    elif law:
        changes["friction"] = _laws(bearing, law)
    return replace(bearing, **changes)


def _by_factors(
    bearing: LIRBearing, given: Mapping[str, float]
) -> tuple[dict[str, Any], float | None]:
    # Values by name, those of factors times the bearing's own value; and the factor on its
    # friction.
    factors = {f"{each}{FACTOR}": each for each in OF_BEARINGS}
    found: dict[str, Any] = {name: v for name, v in given.items() if name not in factors}
    of_friction = None
    for name in given.keys() - found.keys():
        field = factors[name]
        double = [each for each in ("friction", "f_max", "f_min") if each in found]
        if field in found or (field == "friction" and double):
            msg = f"{name} and {field if field in found else double[0]} are given: leave one out"
            raise CampaignError(msg)
        if field == "friction":
            of_friction = given[name]
            continue
        found[field] = _times(given[name], _nominal(bearing, field))
    return found, of_friction


def _nominal(bearing: LIRBearing, field: str) -> Any:
    # The value of a bearing, that of its default if none is given.
    if field == "capacity":
        return bearing.lateral_capacity
    value = getattr(bearing, field)
    value = bearing.resolved().get(field) if value is None else value
    if value is None:
        msg = f"{field}{FACTOR}: the bearing has no {field} to multiply: set {field}"
        raise CampaignError(msg)
    return value


def _times(factor: float, value: Any) -> Any:
    return tuple(factor * each for each in value) if isinstance(value, tuple) else factor * value


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
        there = ", ".join(["friction", *FIELDS, *of_law, DAMPING])
        msg = f'"{name}" is no parameter: choose one of {there}, or with a factor, friction{FACTOR}'
        raise CampaignError(msg)
    return tuple(replace(each, **changes) for each in bearing.frictions)  # type: ignore[type-var]


def names_of(law: type[FrictionLaw]) -> list[str]:
    """Return the names of a law's fields that are parameters: those of the bearing are its own."""
    return [f.name for f in fields(law) if f.name not in {*FIELDS, "friction"}]  # type: ignore[arg-type]
