"""From ``[loads]`` to the loads and masses of a building."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from frames.library.building_loads import Pressures, add_base_inertia, load_floors, move_loads
from frames.library.moment_frames import DEFAULT_BASE_DEPTH

if TYPE_CHECKING:
    from frames.design.codes.load_rules import LoadRule
    from frames.design.project.schema_loads import LoadsTable
    from frames.frame import Frame
    from frames.library.building_plan import BuildingPlan


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
