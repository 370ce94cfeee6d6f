"""What ``[bearing]`` and ``[bounds]`` of a project's file hold."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Tag, create_model

from frames.design.project.derived import DerivedTable, Table, table_of
from frames.design.project.quantities import Force, Positive, Ratio
from lir_element import LIRBearing

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
    """Return a file's data with what types of bearings leave out, taken from ``[bearing]``."""
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
