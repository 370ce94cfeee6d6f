"""Contents of ``[bearing]`` and ``[bounds]`` of a project's file."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, ClassVar, Literal, Self, get_args

from pydantic import Discriminator, Field, Tag, create_model, model_validator

from frames.design.project.derived import DerivedTable, Table, key_of, table_of
from frames.design.project.quantities import (
    Force,
    Length,
    Positive,
    Ratio,
    quantity,
)
from frames.design.project.schema_sections import Count
from frames.laws import Gap, ViscousDamper
from lir_element import LIRBearing

Side = Literal["x+", "x-", "y+", "y-"]
"""A side of the base, by its outward direction."""

SIDES: tuple[Side, ...] = get_args(Side)
"""All of them."""


class MoatTable(table_of(Gap, "gap", "stiffness", "damping")):  # type: ignore[misc]  # its keys
    """``[moat]``: walls around the base as springs behind a gap."""

    gap: Annotated[Length, Positive]
    sides: tuple[Side, ...] = Field(default=SIDES, min_length=1)


class DamperTable(Table):
    """``[dampers.<name>]``: fluid dampers of one kind, at the base or in storeys."""

    force: Annotated[Force, Positive]
    speed: Annotated[quantity("m/s"), Positive]  # type: ignore[valid-type]  # made
    exponent: key_of(ViscousDamper, "exponent") = 1.0  # type: ignore[valid-type]  # made
    stiffness: key_of(ViscousDamper, "stiffness") | None = None  # type: ignore[valid-type]  # made
    columns: tuple[str | int, ...] = ()
    directions: tuple[Literal["x", "y"], ...] = Field(default=("x", "y"), min_length=1)
    between: tuple[str, str] | None = None
    storeys: tuple[Count, Count] | None = None
    pattern: Literal["up", "down"] = "up"

    @model_validator(mode="after")
    def _stand_somewhere(self) -> Self:
        if bool(self.columns) == (self.between is not None):
            msg = (
                'needs its place: write either columns = ["0-0", "3-0"], from the ground to the '
                'slab above the bearings, or between = ["0-0", "1-0"], in storeys'
            )
            raise ValueError(msg)
        mine = {"columns": {"directions"}, "between": {"storeys", "pattern"}}
        other = mine["between" if self.columns else "columns"] & self.model_fields_set
        if other:
            msg = f"{min(other)} is for dampers {'in storeys' if self.columns else 'at the base'}"
            raise ValueError(msg)
        return self


Pair = tuple[Ratio, Ratio]


class Bearing(table_of(LIRBearing)):  # type: ignore[misc]  # its keys are the fields
    """``[bearing]``: the LIR-DCFP under each column; arguments of `lir_element.LIRBearing`."""


class BearingType(Bearing):
    """``[bearings.<type>]``: a further type; keys left out are those of ``[bearing]``."""

    beside: ClassVar[frozenset[str]] = frozenset({"columns", "above"})
    columns: tuple[str | int, ...] = ()
    above: Annotated[Force, Positive] | None = None


TO_RIMS = ("capacity", "rims")
"""Keys of which a type that gives one does not take the other from ``[bearing]``."""


def completed(data: dict[str, Any]) -> dict[str, Any]:
    """Return a file's data; missing keys of types of bearings come from ``[bearing]``."""
    own, types = data.get("bearing"), data.get("bearings")
    if not isinstance(types, dict) or not isinstance(own, dict):
        return data
    found = {}
    for name, given in types.items():
        if not isinstance(given, dict):
            return data  # refused as no table
        has_rims = any(key in given for key in TO_RIMS)
        base = {key: v for key, v in own.items() if not (has_rims and key in TO_RIMS)}
        found[name] = base | given
    return data | {"bearings": found}


@cache
def bearing_type_table(bearing: type[Bearing]) -> type[BearingType]:
    """Return the class of ``[bearings.<type>]`` whose friction is of any law that is known now."""
    key = bearing.model_fields["friction"]
    kind: Any = key.annotation
    return create_model(
        "BearingType", __base__=BearingType, __doc__=BearingType.__doc__, friction=(kind, key)
    )


def bearing_table() -> type[Bearing]:
    """Return the class of ``[bearing]``: its friction is of any law that is known now."""
    return _bearing_of(table_of(LIRBearing))


@cache
def _bearing_of(table: type[DerivedTable]) -> type[Bearing]:
    key = table.model_fields["friction"]
    kind: Any = key.annotation
    return create_model("Bearing", __base__=Bearing, __doc__=Bearing.__doc__, friction=(kind, key))


class FactorSources(Table):
    """``[bounds.friction]``: factors lower and upper by source, put together as the code does."""

    ageing: Pair = (1.0, 1.0)
    contamination: Pair = (1.0, 1.0)
    temperature: Pair = (1.0, 1.0)
    wear: Pair = (1.0, 1.0)
    test: Pair = (1.0, 1.0)
    specification: Pair = (1.0, 1.0)
    full_scale_tests: bool | None = None
    importance_class: Literal["I", "II", "III"] | None = None


def _way(given: object) -> str:
    return "[FactorSources]" if isinstance(given, (dict, FactorSources)) else "[pair]"


_Factors = Annotated[
    Annotated[Pair, Tag("[pair]")] | Annotated[FactorSources, Tag("[FactorSources]")],
    Discriminator(_way),
]


class Bounds(Table):
    """``[bounds]``: factors on friction, lower and upper; the interface's own if given."""

    friction: _Factors
    interface: _Factors | None = None
