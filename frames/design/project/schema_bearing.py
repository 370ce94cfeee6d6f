"""What ``[bearing]`` and ``[bounds]`` of a project's file hold."""

from __future__ import annotations

from functools import cache
from typing import Any

from pydantic import create_model

from frames.design.project.derived import DerivedTable, Table, table_of
from frames.design.project.quantities import Ratio
from lir_element import LIRBearing

Pair = tuple[Ratio, Ratio]


class Bearing(table_of(LIRBearing)):  # type: ignore[misc]  # its keys are the fields
    """``[bearing]``: the LIR-DCFP under each column; arguments of `lir_element.LIRBearing`."""


def bearing_table() -> type[Bearing]:
    """Return the class of ``[bearing]``: its friction is of any law that is known now."""
    return _bearing_of(table_of(LIRBearing))


@cache
def _bearing_of(table: type[DerivedTable]) -> type[Bearing]:
    key = table.model_fields["friction"]
    kind: Any = key.annotation
    return create_model("Bearing", __base__=Bearing, __doc__=Bearing.__doc__, friction=(kind, key))


class Bounds(Table):
    """``[bounds]``: factors on friction, lower and upper; the interface's own if given."""

    friction: Pair
    interface: Pair | None = None
