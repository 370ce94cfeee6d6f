"""From ``[loads]`` to the loads and masses of a building."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from frames.design.project.derived import Table
from frames.design.project.quantities import AreaLoad, LineLoad, NotNegative, Ratio
from frames.library.building_loads import Pressures, add_base_inertia, load_floors, move_loads
from frames.library.moment_frames import DEFAULT_BASE_DEPTH

if TYPE_CHECKING:
    from frames.design.codes.history_rules import LoadRule
    from frames.frame import Frame
    from frames.library.building_plan import BuildingPlan

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


class BuildingLoads(NamedTuple):
    """Loads of a building, and which of them is mass."""

    table: LoadsTable  # the section of the file
    mass: Mapping[str, float]  # share of each load case, "D", "L", "S", that is mass [-]


def loads_of(table: LoadsTable | None, rule: LoadRule) -> BuildingLoads | None:
    """Return the loads of a project, its masses by the code where the file does not say them."""
    if table is None:
        return None
    given = table.mass
    mass = rule.mass if given is None else {"D": given.dead, "L": given.live, "S": given.snow}
    return BuildingLoads(table, mass)


def apply_loads(
    frame: Frame, plan: BuildingPlan, loads: BuildingLoads, eccentricity: tuple[float, float]
) -> None:
    """Put the loads of a project on its building, and make masses of them."""
    table = loads.table
    pressures = Pressures(
        floors=table.of_field(base=False, roof=False),
        roof=table.of_field(base=False, roof=True),
        base=table.of_field(base=True, roof=False),
        open_base=table.of_field(base=True, roof=True),
        facade=table.facade,
    )
    frame.set_mass_source(loads.mass)
    edges = [plan.edges(level) for level in range(len(plan.heights) + 1)]
    load_floors(frame, edges, pressures, table.span)
    move_loads(frame, eccentricity)
    add_base_inertia(frame, DEFAULT_BASE_DEPTH)
