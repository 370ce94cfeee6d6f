"""What ``[loads]`` of a project's file holds: pressures on floors, facades, masses."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from frames.design.project.derived import Table
from frames.design.project.quantities import AreaLoad, LineLoad, NotNegative, Ratio

Downwards = Annotated[AreaLoad, NotNegative]
Share = Annotated[Ratio, Field(ge=0.0, le=1.0)]


class LevelLoads(Table):
    """Loads of one level in place of those of the others."""

    dead: Downwards | None = None
    live: Downwards | None = None


class MassShares(Table):
    """Shares of the loads that are seismic mass; members are mass whole."""

    dead: Share = 1.0
    live: Share = 0.0
    snow: Share = 0.0


class LoadsTable(Table):
    """``[loads]``: besides the members, which weigh by their density."""

    dead: Downwards
    live: Downwards = 0.0
    snow: Downwards = 0.0
    roof: LevelLoads = LevelLoads()
    base: LevelLoads = LevelLoads()
    facade: Annotated[LineLoad, NotNegative] = 0.0
    span: Literal["x", "y"] | None = None
    mass: MassShares | None = None

    @model_validator(mode="after")
    def _weighs(self) -> Self:
        if not self.dead and not self.roof.dead:
            msg = 'dead = "0 kN/m2": floors weigh something besides the members: dead = "3.5 kN/m2"'
            raise ValueError(msg)
        if self.mass is not None and self.mass.dead <= 0.0:
            msg = "mass: dead must be greater than 0: 1.0 counts all of the dead load"
            raise ValueError(msg)
        return self

    def of_field(self, *, base: bool, roof: bool) -> dict[str, float]:
        """Return the loads of a field by load case: "D", "L", "S" [N/m2]."""
        own = self.base if base else self.roof if roof else LevelLoads()
        return {
            "D": self.dead if own.dead is None else own.dead,
            "L": self.live if own.live is None else own.live,
            "S": self.snow if roof else 0.0,
        }
