"""Walls as columns on their axes with rigid arms to their ends, and hinged rods across storeys."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames.library.building_plan import level_name, wall_node

if TYPE_CHECKING:
    from frames.frame import Frame
    from frames.library.building_plan import BuildingPlan, WallPart
    from frames.model.sections import Section

ARM = "arm-"
"""Beginning of the names of the rigid arms of walls."""

RIGID = 1e3
"""Stiffness of the arms over that of the wall's own section [-]."""

HINGED = {"i": ("My", "Mz"), "j": ("T", "My", "Mz")}
"""Moments that rods do not pass on; torsion is held at one end."""


def add_wall_nodes(frame: Frame, plan: BuildingPlan, level: int) -> list[str]:
    """Add the nodes on the axes of the walls of a level, midway between their ends."""
    floor, found = level_name(level), []
    for wall in plan.walls_at(level):
        one, other = (frame.nodes[f"{floor}-{end}"] for end in (wall.start, wall.end))
        name = wall_node(wall, level)
        frame.add_node(name, 0.5 * (one.x + other.x), 0.5 * (one.y + other.y), one.z)
        found.append(name)
    return found


def add_walls(frame: Frame, plan: BuildingPlan, storey: int) -> None:
    """Add the walls of a storey: members "wall-<storey>-<start>-<end>"."""
    for wall in plan.walls_at(storey):
        foot, head = wall_node(wall, storey - 1), wall_node(wall, storey)
        name = f"wall-{storey}-{wall.start}-{wall.end}"
        frame.add_member(name, foot, head, wall.section, _along(plan, wall))


def add_arms(frame: Frame, plan: BuildingPlan, level: int) -> None:
    """Add the arms of the walls of a level, from their ends to their axes, without mass."""
    floor = level_name(level)
    for wall in plan.walls_at(level):
        for end in (wall.start, wall.end):
            name = f"{ARM}{floor}-{end}-{wall.start}-{wall.end}"
            frame.add_member(name, f"{floor}-{end}", wall_node(wall, level), rigid_arm(wall))


def rigid_arm(wall: WallPart) -> Section:
    """Return the section of a wall's arms: `RIGID` times as stiff as the wall, without mass."""
    own = wall.section
    size = max(own.inertia_y, own.inertia_z)
    return replace(
        own,
        area=RIGID * own.area,
        inertia_y=RIGID * size,
        inertia_z=RIGID * size,
        torsion_constant=RIGID * size,
        shear_area_y=RIGID * own.area,
        shear_area_z=RIGID * own.area,
        density=0.0,
    )


def _along(plan: BuildingPlan, wall: WallPart) -> tuple[float, float, float]:
    (x, y), (u, v) = (plan.lines[end] for end in (wall.start, wall.end))
    return (u - x, v - y, 0.0)


def add_braces(frame: Frame, plan: BuildingPlan, storey: int) -> None:
    """Add the rods of a storey: members "brace-<storey>-<start>-<end>", from foot to head."""
    below, floor = level_name(storey - 1), level_name(storey)
    for rod in (rod for rod in plan.braces if rod.storey == storey):
        name = f"brace-{storey}-{rod.start}-{rod.end}"
        ends = f"{below}-{rod.start}", f"{floor}-{rod.end}"
        frame.add_member(name, *ends, rod.section, releases=HINGED)
