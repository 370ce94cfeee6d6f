"""What ``[moat]`` and ``[dampers.<name>]`` of a project's file hold."""

from __future__ import annotations

from typing import Annotated, Literal, Self, get_args

from pydantic import Field, model_validator

from frames.design.project.derived import Table
from frames.design.project.quantities import (
    Force,
    Length,
    NotNegative,
    Positive,
    Ratio,
    Stiffness,
    quantity,
)
from frames.design.project.schema_sections import Count

Side = Literal["x+", "x-", "y+", "y-"]
"""A side of the base, by the way in which it looks."""

SIDES: tuple[Side, ...] = get_args(Side)
"""All of them."""


class MoatTable(Table):
    """``[moat]``: walls around the base as springs behind a gap."""

    gap: Annotated[Length, Positive]
    stiffness: Annotated[Stiffness, Positive]
    damping: Annotated[quantity("N s/m"), NotNegative] = 0.0  # type: ignore[valid-type]  # made
    sides: tuple[Side, ...] = Field(default=SIDES, min_length=1)


class DamperTable(Table):
    """``[dampers.<name>]``: fluid dampers of one kind, at the base or in storeys."""

    force: Annotated[Force, Positive]
    speed: Annotated[quantity("m/s"), Positive]  # type: ignore[valid-type]  # made
    exponent: Annotated[Ratio, Field(ge=0.1, le=2.0)] = 1.0
    stiffness: Annotated[Stiffness, Positive] | None = None
    columns: tuple[str | int, ...] = ()
    directions: tuple[Literal["x", "y"], ...] = Field(default=("x", "y"), min_length=1)
    between: tuple[str, str] | None = None
    storeys: tuple[Count, Count] | None = None
    pattern: Literal["up", "down"] = "up"

    @model_validator(mode="after")
    def _stand_somewhere(self) -> Self:
        if bool(self.columns) == (self.between is not None):
            msg = (
                'must say where they stand: either columns = ["0-0", "3-0"], from the ground to '
                'the slab above the bearings, or between = ["0-0", "1-0"], in storeys'
            )
            raise ValueError(msg)
        mine = {"columns": {"directions"}, "between": {"storeys", "pattern"}}
        other = mine["between" if self.columns else "columns"] & self.model_fields_set
        if other:
            msg = f"{min(other)} is for dampers {'in storeys' if self.columns else 'at the base'}"
            raise ValueError(msg)
        return self
