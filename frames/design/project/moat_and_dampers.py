"""Moat walls and dampers of a project's file, added to its structure as links."""

from __future__ import annotations

import difflib
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.calculation.check import Check
from frames.design.calculation.standing import PROJECT
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.limits import PROJECT_LIMIT, DesignLimits
from frames.design.histories.slab_corners import farthest_corner
from frames.design.histories.suite import motion_of, peaks_of_runs, stopped_runs
from frames.design.project.member_sections import storeys_of, storeys_said
from frames.design.project.schema_bearing import SIDES
from frames.laws import Gap, ViscousDamper
from frames.statics.gravity import gravity
from lir_element.argument_checks import listed
from lir_element.elevations import SAME_PLACE
from lir_element.texts import anded, joined, worded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr

    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.codes.registry import DesignCode
    from frames.design.histories.eccentricity import Case
    from frames.design.project.schema_bearing import BearingType, DamperTable, MoatTable
    from frames.io import Frame
    from lir_element import LIRBearing


STANDARD = "standard"
"""Name of the type that ``[bearing]`` describes."""

_NAMED = 6  # columns that a message lists


def types_by_column(given: Mapping[str, BearingType], frame: Frame) -> dict[str, str]:
    """Return the type of each bearing of a frame."""
    found: dict[str, str] = dict.fromkeys(frame.bearings, STANDARD)
    by_load = {}
    for name, kind in given.items():
        if bool(kind.columns) == (kind.above is not None):
            msg = (
                f'[bearings.{name}] needs its columns: either columns = ["0-0", "0-1"], or '
                'above = "1500 kN", the least average axial load'
            )
            raise ProjectError(msg)
        if kind.above is not None:
            by_load[name] = kind.above
    if by_load:
        loads = gravity(frame).axial_forces
        for bearing, load in zip(frame.bearings, loads, strict=True):
            heavy = [name for name, above in by_load.items() if load >= above]
            if heavy:
                found[bearing] = max(heavy, key=lambda name: by_load[name])
    taken: dict[str, str] = {}
    for name, kind in given.items():
        for column in map(str, kind.columns):
            for bearing in _named(column, name, frame):
                if bearing in taken:
                    msg = (
                        f"[bearings.{name}] columns: {column} already belongs to "
                        f"[bearings.{taken[bearing]}]: list it once"
                    )
                    raise ProjectError(msg)
                taken[bearing] = found[bearing] = name
    idle = [name for name in given if name not in found.values()]
    if idle:
        msg = f"no column uses [bearings.{idle[0]}]: list its columns, or lower the load in `above`"
        raise ProjectError(msg)
    return found


def on_types(frame: Frame, chosen: Mapping[str, str], devices: Mapping[str, LIRBearing]) -> Frame:
    """Return a frame on bearings of several types."""
    others = {name: devices[kind] for name, kind in chosen.items() if kind != STANDARD}
    return frame.with_bearings(others) if others else frame


def columns_by_type(chosen: Mapping[str, str]) -> dict[str, list[str]]:
    """Return the bearings of each type if there are several types; nothing if there is one."""
    found: dict[str, list[str]] = {}
    for name, kind in chosen.items():
        found.setdefault(kind, []).append(name)
    return found if len(found) > 1 else {}


def _named(column: str, kind: str, frame: Frame) -> list[str]:
    # The bearings of a column, or of a group of the model that the frame was read from.
    groups = {} if frame.imported is None else frame.imported.groups
    own = {column, f"bearing-{column}"} & set(frame.bearings)
    if own or column not in groups:
        try:
            return [bearing_under(column, frame)]
        except ProjectError as cause:
            msg = f"[bearings.{kind}] columns: {cause}"
            raise ProjectError(msg) from None
    found = [name for label in groups[column] for name in (f"bearing-{label}", label)]
    standing = [name for name in found if name in frame.bearings]
    if not standing:
        msg = f"[bearings.{kind}] columns: no joint or link of the group {column} has a bearing"
        raise ProjectError(msg)
    return standing


def bearing_under(column: str, frame: Frame) -> str:
    """Return the bearing of a column that is named as its bearing, or without that word."""
    for name in (column, f"bearing-{column}"):
        if name in frame.bearings:
            return name
    names = [name.removeprefix("bearing-") for name in frame.bearings]
    near = difflib.get_close_matches(column.removeprefix("bearing-"), names, n=1)
    meant = f'; is "{near[0]}" meant?' if near else f": there are {listed(names, _NAMED)}"
    msg = f"{column} is not a column with a bearing{meant}"
    raise ProjectError(msg)


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
    sides: tuple[str, ...]  # sides of the base with walls, "x+"
    links: tuple[str, ...]  # names of the links that they are


def walls_of(frame: Frame) -> Walls | None:
    """Return the moat walls that `with_devices` added to a structure; None without."""
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
    series = {} if given.stiffness is None else {"stiffness": given.stiffness}
    return ViscousDamper(coefficient=coefficient, exponent=given.exponent, **series)


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
        f'no node of level "{frame.levels[level].name}" is over column "{column}": dampers '
        "in storeys need nodes above the bearings"
    )
    raise ProjectError(msg)


def device_rows(
    moat: MoatTable | None, dampers: Mapping[str, DamperTable]
) -> Sequence[tuple[str, str]]:
    """Return walls and dampers, a row for each, in words."""
    rows = []
    if moat is not None:
        made = joined(
            worded("gap {size:.5g} mm", size=1e3 * moat.gap),
            f"{1e-6 * moat.stiffness:.5g} kN/mm",
            f"{1e-3 * moat.damping:.5g} kN s/m" if moat.damping else "",
            worded("at {sides}", sides=", ".join(moat.sides)),
            by=", ",
        )
        rows.append(("moat wall along each side", made))
    for name, given in dampers.items():
        made = worded(
            "{force:.5g} kN at {speed:.5g} m/s, exponent {exponent:g}",
            force=1e-3 * given.force,
            speed=given.speed,
            exponent=given.exponent,
        )
        if given.stiffness is not None:
            series = worded("{stiffness:.5g} kN/mm in series", stiffness=1e-6 * given.stiffness)
            made = joined(made, series, by=", ")
        if given.between is None:
            where = worded(
                "{columns}, along {axes}",
                columns=", ".join(map(str, given.columns)),
                axes=anded(given.directions),
            )
        else:
            one, other = given.between if given.pattern == "up" else given.between[::-1]
            rising = worded("rising from {one} to {other}", one=one, other=other)
            where = joined(rising, storeys_said(given.storeys), by=", ")
        rows.append((worded("dampers {name}", name=name), joined(made, where)))
    return rows


def wall_checks(frame: Frame, cases: Sequence[Case], gap: float) -> list[Check]:
    """Make the checks of the clear distance by time histories.

    The needed clearance with the code's factor, and the largest displacement of all single runs.
    Notes give the walls in the runs, and the number of runs with contact.
    """
    return [check for case in cases for check in _of_histories(frame, case, gap)]


def clearance_checks(
    code: DesignCode, equivalent: EquivalentLinear, limits: DesignLimits, frame: Frame
) -> list[Check]:
    """Make the checks of the clear distance by the equivalent-linear analysis alone."""
    found, room, walls = [], code.values.get("separation"), walls_of(frame)
    gap = limits.moat_gap or (walls and walls.gap)
    if not gap:
        return []
    for each in equivalent.bounds.values():
        t = _with_gap(gap)
        t.given("D_a", each.allowed_displacement, "m", shown="mm", note="that bearings must allow")
        corner = farthest_corner(frame, np.array(each.displacements))
        t.given("c_c", corner.factor, note=corner.note)
        t("D_T", "c_c * D_a", "m", shown="mm")
        title = "clearance to the moat wall, equivalent-linear"
        judge = CheckBuilder(t, each.bound, PROJECT if room is None else room.standing)
        clause = PROJECT_LIMIT if room is None else room.clause
        found.append(judge(clause, title, "D_T", "<=", "g_moat", note=corner.note))
    level = code.histories.bearing_level
    return [replace(check, level=level) for check in found]


def _of_histories(frame: Frame, case: Case, gap: float) -> list[Check]:
    t = _with_gap(gap)
    reached = case.design("displacement")
    corner = farthest_corner(frame, reached)
    t.given(
        "D", float(reached.max()), "m", shown="mm", note="of the histories, by the rule of the code"
    )
    t.given("gamma_x", case.rules.displacement_factor)
    t.given("c_c", corner.factor, note=corner.note)
    t("D_d", "gamma_x * c_c * D", "m", shown="mm")
    judge = CheckBuilder(t, case.bound, PROJECT, void=case.suite.void)
    title = "clearance to the moat wall"
    every = case.every
    told = _told_of_walls(frame, every)
    note = joined(corner.note, told.holds)
    first = judge(PROJECT_LIMIT, title, "D_d", "<=", "g_moat", note=note)
    largest = peaks_of_runs(every, "displacement").max(axis=1)
    k = int(largest.argmax())
    t = _with_gap(gap)
    t.given("D_b", float(largest[k]), "m", shown="mm", note=motion_of(every, k))
    corner = farthest_corner(frame, peaks_of_runs(every, "displacement")[k])
    t.given("c_c", corner.factor, note=corner.note)
    t("D_max", "c_c * D_b", "m", shown="mm")
    judge = CheckBuilder(t, case.bound, PROJECT, void=stopped_runs(every))
    title = "moat wall is not met in any run"
    return [first, judge(PROJECT_LIMIT, title, "D_max", "<=", "g_moat", note=told.model)]


class _Told(NamedTuple):
    # Notes on the model of walls, and that they hold back the structure at contact.
    model: str
    holds: str


def _told_of_walls(frame: Frame, every: xr.Dataset) -> _Told:
    walls = walls_of(frame)
    if walls is None:
        return _Told("the wall is not modelled: results have no force of contact with it", "")
    gap, sides = 1e3 * walls.gap, ", ".join(walls.sides)
    which = [str(name) in walls.links for name in every["link"].to_numpy()]
    force = peaks_of_runs(every, "link_force")[:, which].max(axis=1)
    met = force[force > 0.0]
    if not len(met):
        none = worded(
            "walls at {gap:.5g} mm along {sides} are modelled: no contact in the runs",
            gap=gap,
            sides=sides,
        )
        return _Told(none, "")
    model = worded(
        "walls at {gap:.5g} mm along {sides} are modelled: contact in {met} of {runs} runs, with "
        "up to {force:.4g} kN at a node",
        gap=gap,
        sides=sides,
        met=len(met),
        runs=len(force),
        force=1e-3 * met.max(),
    )
    holds = worded(
        "the modelled walls limit the displacement of {met} of {runs} runs",
        met=len(met),
        runs=len(force),
    )
    return _Told(joined(model, "their force is in the results (links.csv)"), holds)


def _with_gap(gap: float) -> Trace:
    t = Trace()
    t.given("g_moat", gap, "m", shown="mm", note="clear distance, as given")
    return t
