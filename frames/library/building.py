"""A building on bearings from its plan, whose parts must join; bearings at points in plan."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import TYPE_CHECKING, TypeAlias

from frames._errors import ModelError, likely
from frames.io import Frame
from frames.library.building_plan import BuildingPlan, level_name, wall_node
from frames.model.axes import fields_of
from frames.model.damping import ModalDamping
from lir_element.argument_checks import require_positive, shown
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.library.building_plan import WallPart
    from frames.model.damping import Damping
    from frames.model.sections import Section
    from lir_element import LIRBearing

DEFAULT_DAMPING = ModalDamping(0.02)
"""Two per cent in every mode of the structure, customary for steel above an isolation level."""


def build(
    plan: BuildingPlan,
    bearing: LIRBearing | Mapping[str, LIRBearing],
    *,
    name: str = "building",
    damping: Damping | None = DEFAULT_DAMPING,
    gravity: float = STANDARD_GRAVITY,
) -> Frame:
    """Return the frame of a building, without loads and masses but those of its members.

    `bearing` is one for all lines at the base, or one by line.
    """
    require_whole(plan)
    frame = Frame(name, gravity)
    if not isinstance(bearing, Mapping):
        require_device("bearing", bearing)
        bearing = dict.fromkeys(plan.at_level(0), bearing)
    base = add_bearings(frame, bearing, plan.lines)
    heights = [base + z for z in accumulate(plan.heights, initial=0.0)]
    _add_level(frame, plan, 0)
    for storey in range(1, len(plan.heights) + 1):
        floor, below = level_name(storey), level_name(storey - 1)
        parts = {part.line: part for part in plan.standing(storey)}
        for line in plan.at_level(storey):
            x, y = plan.lines[line]
            frame.add_node(f"{floor}-{line}", x, y, heights[storey])
            if line in parts:
                part = parts[line]
                foot, head = f"{below}-{line}", f"{floor}-{line}"
                frame.add_member(f"column-{storey}-{line}", foot, head, part.section, part.up)
        _add_level(frame, plan, storey)
        add_walls(frame, plan, storey)
        add_braces(frame, plan, storey)
    frame.set_damping(damping)
    return frame


def _add_level(frame: Frame, plan: BuildingPlan, level: int) -> None:
    # Beams, diaphragm and level; beams in the order of the lines that they begin at.
    floor, lines = level_name(level), plan.at_level(level)
    beams = plan.beams_at(level)
    order = {line: k for k, line in enumerate(lines)}
    begun = Counter((beam.name, beam.start) for beam in beams)
    for part in sorted(beams, key=lambda part: order[part.start]):
        start, end = f"{floor}-{part.start}", f"{floor}-{part.end}"
        name = f"{part.name}-{start}"
        alone = begun[part.name, part.start] == 1
        name = name if alone else f"{name}-{part.end}"
        frame.add_member(name, start, end, part.section, offsets=part.offsets)
    nodes = [f"{floor}-{line}" for line in lines]
    axes = add_wall_nodes(frame, plan, level)
    add_arms(frame, plan, level)
    if level not in plan.flexible:
        for k, slab in enumerate(_slabs([*nodes, *axes], plan.edges(level))):
            if len(slab) > 1:
                first = slab[0].removeprefix(f"{floor}-")
                frame.add_diaphragm(floor if k == 0 else f"{floor}-{first}", slab)
    frame.add_level(floor, nodes)


def _slabs(nodes: list[str], edges: list[tuple[str, str]]) -> list[list[str]]:
    # Nodes that beams join, one list for each separate part of a level.
    group = {node: node for node in nodes}

    def root(node: str) -> str:
        while group[node] != node:
            node = group[node]
        return node

    for start, end in edges:
        group[root(end)] = root(start)
    found: dict[str, list[str]] = {}
    for node in nodes:
        found.setdefault(root(node), []).append(node)
    return list(found.values())


def require_whole(plan: BuildingPlan) -> None:
    """Refuse a plan whose parts do not join."""
    _require_walls(plan)
    count = len(plan.heights)
    for part in plan.columns:
        _require_line(plan, part.line, f"a column of storey {part.storey}")
        if not 1 <= part.storey <= count:
            msg = (
                f'column on line "{part.line}": storey {part.storey} does not exist: use 1 to '
                f"{count}"
            )
            raise ModelError(msg)
    for level in range(count + 1):
        nodes = set(plan.at_level(level))
        if not nodes:
            msg = f"no column reaches level {level}: add one to each storey"
            raise ModelError(msg)
        ends = {end for wall in plan.walls_at(level) for end in (wall.start, wall.end)}
        for beam in (beam for beam in plan.beams if beam.level == level):
            for line in (beam.start, beam.end):
                where = f'beam from "{beam.start}" to "{beam.end}" at {level_name(level)}'
                _require_line(plan, line, where)
                if line not in nodes:
                    msg = (
                        f'{where}: no column on line "{line}" starts or ends there: add a '
                        "column, or leave the beam out"
                    )
                    raise ModelError(msg)
                ends.add(line)
        heads = {part.line for part in plan.standing(level)} if level or len(nodes) == 1 else set()
        hanging = sorted(nodes - heads - ends)
        if hanging and level == 0:
            msg = (
                f'column "{hanging[0]}" has no base beam, and a bearing does not restrain '
                "rotation: add base beams between the feet of columns"
            )
            raise ModelError(msg)
        if hanging:
            msg = (
                f'column "{hanging[0]}" begins at {level_name(level)}without a beam: start it at '
                "the base, or add beams that carry it"
            )
            raise ModelError(msg)
        if plan.walls:  # which must not be over beams
            points = {line: plan.lines[line] for line in nodes}
            walls = [(wall.start, wall.end) for wall in plan.walls_at(level)]
            beams = [(beam.start, beam.end) for beam in plan.beams_at(level)]
            fields_of(points, [*beams, *walls], level_name(level))
    for rod in plan.braces:
        where = f'brace from "{rod.start}" to "{rod.end}" in storey {rod.storey}'
        for line, level in ((rod.start, rod.storey - 1), (rod.end, rod.storey)):
            _require_line(plan, line, where)
            if line not in plan.at_level(level):
                msg = f'{where}: no column on line "{line}" reaches {level_name(level)}'
                raise ModelError(msg + ": leave this brace out")
        if rod.start == rod.end:
            msg = f"{where} starts and ends on one line: name two lines"
            raise ModelError(msg)


def _require_walls(plan: BuildingPlan) -> None:
    pairs: set[frozenset[str]] = set()
    for wall in plan.walls:
        where = f'wall between "{wall.start}" and "{wall.end}"'
        for line in (wall.start, wall.end):
            _require_line(plan, line, where)
        if wall.start == wall.end:
            msg = f"{where} has no length: name two lines"
            raise ModelError(msg)
        pair = frozenset((wall.start, wall.end))
        if pair in pairs:
            msg = f"{where} occurs twice: keep one"
            raise ModelError(msg)
        pairs.add(pair)


def _require_line(plan: BuildingPlan, line: str, where: str) -> None:
    if line not in plan.lines:
        msg = f'{where}: there is no column line "{line}" ({likely(line, plan.lines)})'
        raise ModelError(msg)


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


Bearings: TypeAlias = "LIRBearing | Mapping[tuple[int, int], LIRBearing]"
"""One bearing for every place of a grid, or one for each place (ix, iy)."""


def require_device(name: str, device: object) -> None:
    """Raise a TypeError unless `device` can be made into a bearing element."""
    if not isinstance(getattr(device, "height", None), (int, float)):
        msg = f"{name} = {shown(device)} must be an LIRBearing"
        raise TypeError(msg)


def bearings_at(
    places: Sequence[tuple[int, int]], bearing: Bearings
) -> dict[tuple[int, int], LIRBearing]:
    """Return the device at every place (ix, iy) of a grid."""
    chosen = bearing if isinstance(bearing, Mapping) else dict.fromkeys(places, bearing)
    missing = [place for place in places if place not in chosen]
    unused = [place for place in chosen if place not in places]
    if missing or unused:
        message = (
            f"bearing: the grid has the places {places[0]} to {places[-1]}; missing: "
            f"{missing or 'none'}; not in the grid: {unused or 'none'}. Pass one LIRBearing "
            "for all, or a mapping with every place (ix, iy)"
        )
        raise ModelError(message)
    for place, device in chosen.items():
        require_device(f"bearing at {place}" if isinstance(bearing, Mapping) else "bearing", device)
    return {place: chosen[place] for place in places}


def add_bearings(
    frame: Frame, devices: Mapping[str, LIRBearing], points: Mapping[str, tuple[float, float]]
) -> float:
    """Add a bearing at every point in plan, between a ground and a base node; return their height.

    The base is level: ground nodes under bearings of less height are higher.
    """
    level = max(device.height for device in devices.values())
    for name, device in devices.items():
        x, y = points[name]
        frame.add_node(f"ground-{name}", x, y, level - device.height)
        frame.fix(f"ground-{name}", "all")
        frame.add_node(f"base-{name}", x, y, level)
        frame.add_bearing(f"bearing-{name}", f"ground-{name}", f"base-{name}", device)
    return level


def pair(
    value: float | tuple[float, float], what: str, *, count: bool = False
) -> tuple[float, float]:
    """Accept one number for both horizontal directions, or two."""
    values = tuple(value) if isinstance(value, Sequence) else (value, value)
    if len(values) != 2:
        message = f"{what} = {value!r} must be one number, or two for x and y"
        raise ModelError(message)
    first, second = (
        require_positive(what, number, remedy="give one number, or two for x, y", error=ModelError)
        for number in values
    )
    if count and not (first.is_integer() and second.is_integer()):
        message = f"{what} = {value!r} must be integers: use counts of 1 or more"
        raise ModelError(message)
    return first, second
