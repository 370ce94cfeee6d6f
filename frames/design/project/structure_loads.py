"""From ``[loads]`` to the loads and masses of a building."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from frames._errors import ModelError
from frames.design.project.derived import Table
from frames.design.project.quantities import AreaLoad, LineLoad, NotNegative, Ratio
from frames.library.building_plan import DEFAULT_BASE_DEPTH, level_name
from frames.model.axes import fields_of
from frames.model.load_combinations import applied_loads, load_masses

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.design.codes.history_rules import LoadRule
    from frames.io import Frame
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
    """``[loads]``: loads besides the weight of members, which follows from their density."""

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
            msg = (
                "dead must be above 0, because floors weigh more than their members: write dead = "
                '"3.5 kN/m2"'
            )
            raise ValueError(msg)
        if self.mass is not None and self.mass.dead <= 0.0:
            msg = "mass: dead must be greater than 0: write dead = 1.0 for the whole dead load"
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
    """Return the loads of a project, with masses by the code unless the file gives them."""
    if table is None:
        return None
    given = table.mass
    mass = rule.mass if given is None else {"D": given.dead, "L": given.live, "S": given.snow}
    return BuildingLoads(table, mass)


def apply_loads(
    frame: Frame, plan: BuildingPlan, loads: BuildingLoads, eccentricity: tuple[float, float]
) -> None:
    """Add the loads of a project to its building, and masses from them."""
    frame.set_mass_source(loads.mass)
    edges = [plan.edges(level) for level in range(len(plan.heights) + 1)]
    load_floors(frame, edges, loads.table)
    move_loads(frame, eccentricity)
    add_base_inertia(frame, DEFAULT_BASE_DEPTH)


FACADE = "D"
"""Load case of facades."""


def load_floors(
    frame: Frame,
    edges: Sequence[list[tuple[str, str]]],
    loads: LoadsTable,
) -> None:
    """Add loads to the floors of a building: to each field that beams enclose."""
    points = {name: (node.x, node.y) for name, node in frame.nodes.items()}
    levels = [fields_of(points, own, level_name(k)) for k, own in enumerate(edges)]
    members = {frozenset((m.i, m.j)): key for key, m in frame.members.items()}
    for level, found in enumerate(levels):
        name = level_name(level)
        if not found.corners:
            msg = (
                f"{name} cannot carry floor loads, because its beams enclose no area: add beams "
                "around it"
            )
            raise ModelError(msg)
        above = [_outline(points, each) for other in levels[level + 1 :] for each in other.corners]
        for k, corners in enumerate(found.corners):
            middle = _outline(points, corners).mean(axis=0)
            covered = any(_inside(middle, outline) for outline in above)
            for case, pressure in loads.of_field(base=level == 0, roof=not covered).items():
                if pressure > 0.0:
                    panel = f"{case}-{name}-{k + 1}"
                    frame.add_floor_load(panel, corners, pressure, span=loads.span, case=case)
        if loads.facade > 0.0 and level > 0:
            load = (0.0, 0.0, -loads.facade)
            for edge in found.outer:
                frame.add_uniform_load(members[frozenset(edge)], load, case=FACADE)


def _outline(points: Mapping[str, tuple[float, float]], corners: Sequence[str]) -> FloatArray:
    return np.array([points[node] for node in corners])


def _inside(place: FloatArray, outline: FloatArray) -> bool:
    # True if a place is inside of a convex outline that runs anticlockwise.
    along, to = np.roll(outline, -1, axis=0) - outline, place - outline
    return bool((along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0] > 0.0).all())


def move_loads(frame: Frame, eccentricity: tuple[float, float]) -> None:
    """Move the centre of the loads of each level, case by case, by forces on its nodes.

    The loads of the nodes increase linearly in the direction of the move; their sum stays.
    """
    if not any(eccentricity):
        return
    added: list[tuple[str, float, str]] = []
    for case in frame.load_cases:
        weights = _node_loads(frame, case)
        for level in frame.levels:
            own = {node: weights[node] for node in level.nodes if weights.get(node, 0.0) > 0.0}
            if own:
                added += [
                    (node, more, case) for node, more in _tilted(frame, own, eccentricity).items()
                ]
    for node, more, case in added:
        frame.add_load(node, (0.0, 0.0, -more, 0.0, 0.0, 0.0), case=case)


def _node_loads(frame: Frame, case: str) -> dict[str, float]:
    # Weight of the loads of a case at each node, by the rule of the lever [N].
    alone = frame.copy()
    alone.set_mass_source({case: 1.0})
    masses = load_masses(alone, applied_loads(alone))
    return {node: mass * frame.gravity for node, mass in masses.items()}


def _tilted(
    frame: Frame, own: Mapping[str, float], eccentricity: tuple[float, float]
) -> dict[str, float]:
    places = np.array([frame.nodes[node].position[:2] for node in own])
    weights = np.array(list(own.values()))
    sides = np.ptp(places, axis=0)
    apart = places - weights @ places / weights.sum()
    spread: FloatArray = (apart * weights[:, None]).T @ apart
    wanted = weights.sum() * np.array(eccentricity) * sides
    slope, *_ = np.linalg.lstsq(spread, wanted, rcond=1e-12)
    tilt = apart @ slope
    if tilt.min() < -1.0:
        msg = (
            f"eccentricity = {list(eccentricity)} would leave columns at one edge without "
            "load: reduce it (codes require 0.05)"
        )
        raise ModelError(msg)
    return dict(zip(own, (weights * tilt).tolist(), strict=True))


def add_base_inertia(frame: Frame, depth: float) -> None:
    """Add the rotary inertia of their mass over a depth to the nodes above the bearings."""
    masses = load_masses(frame, applied_loads(frame))
    for link in frame.bearings.values():
        inertia = masses.get(link.j, 0.0) * depth**2 / 12.0
        frame.add_mass(link.j, 0.0, (inertia, inertia, 0.0))
