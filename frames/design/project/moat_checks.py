"""Checks that what stands on bearings does not meet the moat wall."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.check import Check
from frames.design.calculation.standing import PROJECT
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.limits import PROJECT_LIMIT, DesignLimits
from frames.design.histories.suite import motion_of, peaks_of_runs, stopped_runs
from frames.design.project.moat_and_dampers import walls_of
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.codes.registry import DesignCode
    from frames.design.histories.eccentricity import Case
    from frames.frame import Frame

_AT_BEARINGS = "at the bearings: what stands out past them moves more where the base turns"


def wall_checks(frame: Frame, cases: Sequence[Case], gap: float) -> list[Check]:
    """Make the checks of the clear distance by time histories.

    The displacement that they ask for with the code's factor, and the largest of all single runs.
    Notes say whether the runs have the wall, and in how many of them it is met.
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
        t.given("D_T", each.allowed_displacement, "m", shown="mm", note="that bearings must allow")
        title = "clearance to the moat wall, equivalent-linear"
        judge = CheckBuilder(t, each.bound, PROJECT if room is None else room.standing)
        clause = PROJECT_LIMIT if room is None else room.clause
        found.append(judge(clause, title, "D_T", "<=", "g_moat", note=_AT_BEARINGS))
    level = code.histories.bearing_level
    return [replace(check, level=level) for check in found]


def _of_histories(frame: Frame, case: Case, gap: float) -> list[Check]:
    t = _with_gap(gap)
    reached = float(case.design("displacement").max())
    t.given("D", reached, "m", shown="mm", note="of the histories, as the code counts")
    t.given("gamma_x", case.rules.displacement_factor)
    t("D_d", "gamma_x * D", "m", shown="mm")
    judge = CheckBuilder(t, case.bound, PROJECT, void=case.suite.void)
    title = "clearance to the moat wall"
    every = case.every
    told = _told_of_walls(frame, every)
    note = joined(_AT_BEARINGS, told.holds)
    first = judge(PROJECT_LIMIT, title, "D_d", "<=", "g_moat", note=note)
    largest = peaks_of_runs(every, "displacement").max(axis=1)
    k = int(largest.argmax())
    t = _with_gap(gap)
    t.given("D_max", float(largest[k]), "m", shown="mm", note=motion_of(every, k))
    judge = CheckBuilder(t, case.bound, PROJECT, void=stopped_runs(every))
    title = "moat wall is not met in any run"
    return [first, judge(PROJECT_LIMIT, title, "D_max", "<=", "g_moat", note=told.model)]


class _Told(NamedTuple):
    # What notes say of walls: how they are modelled, and that they hold back what meets them.
    model: str
    holds: str


def _told_of_walls(frame: Frame, every: xr.Dataset) -> _Told:
    walls = walls_of(frame)
    if walls is None:
        return _Told("the wall is not modelled: where it is met, its force is in no result", "")
    gap, sides = 1e3 * walls.gap, ", ".join(walls.sides)
    which = [str(name) in walls.links for name in every["link"].to_numpy()]
    force = peaks_of_runs(every, "link_force")[:, which].max(axis=1)
    met = force[force > 0.0]
    if not len(met):
        none = worded(
            "walls at {gap:.5g} mm along {sides} are modelled: none is met in the runs",
            gap=gap,
            sides=sides,
        )
        return _Told(none, "")
    model = worded(
        "walls at {gap:.5g} mm along {sides} are modelled: met in {met} of {runs} runs, by up to "
        "{force:.4g} kN at a node",
        gap=gap,
        sides=sides,
        met=len(met),
        runs=len(force),
        force=1e-3 * met.max(),
    )
    holds = worded(
        "the walls that are modelled hold back {met} of {runs} runs, which would go farther "
        "without them",
        met=len(met),
        runs=len(force),
    )
    return _Told(joined(model, "their force is in the results (links.csv)"), holds)


def _with_gap(gap: float) -> Trace:
    t = Trace()
    t.given("g_moat", gap, "m", shown="mm", note="clear distance, as given")
    return t
