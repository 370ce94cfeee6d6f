"""Moat walls and dampers of a project's file, put into its structure as links."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.bearing_types import bearing_under
from frames.design.project.member_sections import storeys_of
from frames.design.project.schema_devices import SIDES
from frames.laws import Gap, ViscousDamper
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.design.project.schema_devices import DamperTable, MoatTable
    from frames.frame import Frame

MOAT = "moat"
"""Name of the walls: links "moat-<node>-<side>"."""


def with_devices(frame: Frame, moat: MoatTable | None, dampers: Mapping[str, DamperTable]) -> Frame:
    """Return a structure with the moat walls and dampers of a file."""
    if moat is None and not dampers:
        return frame
    found = frame.copy()
    if moat is not None:
        _add_moat(found, moat)
    for name, given in dampers.items():
        try:
            if given.between is None:
                _add_at_base(found, name, given)
            else:
                _add_in_storeys(found, name, given, given.between)
        except (ModelError, ProjectError) as cause:
            msg = f"[dampers.{name}] {cause}"
            raise ProjectError(msg) from cause
    return found


def _add_moat(frame: Frame, given: MoatTable) -> None:
    # A wall along each side, shared by the nodes of the slab's edge that it faces.
    nodes = [link.j for link in frame.bearings.values()]
    sides: dict[str, dict[str, Gap]] = {}
    for side in given.sides:
        axis, sign = "xy".index(side[0]), 1.0 if side[1] == "+" else -1.0
        out = [sign * frame.nodes[node].position[axis] for node in nodes]
        edge = [
            node for node, place in zip(nodes, out, strict=True) if max(out) - place < SAME_PLACE
        ]
        law = Gap(
            gap=given.gap,
            stiffness=given.stiffness / len(edge),
            damping=given.damping / len(edge),
        )
        for node in edge:
            sides.setdefault(node, {})[side] = law
    for node, laws in sides.items():
        frame.add_moat(MOAT, [node], laws)


class Walls(NamedTuple):
    """Moat walls that a structure has."""

    gap: float  # clear distance to them [m]
    sides: tuple[str, ...]  # along which sides of the base they stand, "x+"
    links: tuple[str, ...]  # names of the links that they are


def walls_of(frame: Frame) -> Walls | None:
    """Return the moat walls that `with_devices` put into a structure; None without."""
    found = {
        name: link.law
        for name, link in frame.links.items()
        if name.startswith(f"{MOAT}-") and isinstance(link.law, Gap)
    }
    if not found:
        return None
    sides = {name[-2:] for name in found}
    gap = min(law.gap for law in found.values())
    return Walls(gap, tuple(side for side in SIDES if side in sides), tuple(found))


def law_of(given: DamperTable) -> ViscousDamper:
    """Return the law of dampers: the coefficient that gives their force at their speed."""
    coefficient = given.force / given.speed**given.exponent
    if given.stiffness is None:
        return ViscousDamper(coefficient=coefficient, exponent=given.exponent)
    return ViscousDamper(
        coefficient=coefficient, exponent=given.exponent, stiffness=given.stiffness
    )


def _add_at_base(frame: Frame, name: str, given: DamperTable) -> None:
    for bearing in (bearing_under(str(column), frame) for column in given.columns):
        link, column = frame.bearings[bearing], bearing.removeprefix("bearing-")
        for direction in given.directions:
            frame.add_link(
                f"{name}-{column}-{direction}", link.i, link.j, law_of(given), f"u{direction}"
            )


def _add_in_storeys(frame: Frame, name: str, given: DamperTable, between: tuple[str, str]) -> None:
    one, other = between if given.pattern == "up" else between[::-1]
    for storey in storeys_of(given.storeys, len(frame.levels) - 1):
        foot, top = (
            _on_line(frame, storey - 1 + k, column) for k, column in enumerate((one, other))
        )
        frame.add_link(f"{name}-{storey}-{one}-{other}", foot, top, law_of(given))


def _on_line(frame: Frame, level: int, column: str) -> str:
    # The node of a level over a bearing.
    below = frame.nodes[frame.bearings[bearing_under(column, frame)].j]
    for node in frame.levels[level].nodes:
        place = frame.nodes[node]
        if abs(place.x - below.x) < SAME_PLACE and abs(place.y - below.y) < SAME_PLACE:
            return node
    msg = (
        f'there is no node of level "{frame.levels[level].name}" over column "{column}": dampers '
        "in storeys join nodes of levels that stand over bearings"
    )
    raise ProjectError(msg)


def device_rows(
    moat: MoatTable | None, dampers: Mapping[str, DamperTable]
) -> Sequence[tuple[str, str]]:
    """Return what walls and dampers are, a row for each, in words."""
    rows = []
    if moat is not None:
        said = f"gap {1e3 * moat.gap:.5g} mm, {1e-6 * moat.stiffness:.5g} kN/mm"
        said += f", {1e-3 * moat.damping:.5g} kN s/m" if moat.damping else ""
        rows.append(("moat wall along each side", f"{said}, at {', '.join(moat.sides)}"))
    for name, given in dampers.items():
        said = f"{1e-3 * given.force:.5g} kN at {given.speed:.5g} m/s, exponent {given.exponent:g}"
        if given.stiffness is not None:
            said += f", {1e-6 * given.stiffness:.5g} kN/mm in series"
        if given.between is None:
            where = f"{', '.join(map(str, given.columns))}, along {' and '.join(given.directions)}"
        else:
            one, other = given.between if given.pattern == "up" else given.between[::-1]
            levels = (
                ""
                if given.storeys is None
                else f", storeys {given.storeys[0]} to {given.storeys[1]}"
            )
            where = f"rising from {one} to {other}{levels}"
        rows.append((f"dampers {name}", f"{said}; {where}"))
    return rows
