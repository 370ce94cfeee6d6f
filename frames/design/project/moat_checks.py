"""Checks that what stands on bearings does not meet the moat wall."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames.design.calculation.check import Check
from frames.design.calculation.standing import OWN
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.limits import PROJECT_LIMIT
from frames.design.histories.demand_table import largest_of_bounds
from frames.design.histories.eccentricity import raised_suite, with_moved
from frames.design.histories.suite import motion_of, peaks_of_runs
from frames.design.project.check_register import RunToCheck, register_check

if TYPE_CHECKING:
    import xarray as xr

    from frames.design.calculation.check import Bound

_AT_BEARINGS = "at the bearings: what stands out past them moves more where the base turns"


@register_check
def of_the_moat(run: RunToCheck) -> list[Check]:
    """Make the checks of the clear distance to the moat wall.

    The displacement that bearings must allow by the equivalent-linear analysis, that which the
    histories ask for with the code's factor, and the largest of all single runs, in which the wall,
    which is not modelled, would be hit.

    Parameters
    ----------
    run : RunToCheck
        The run.

    Returns
    -------
    list of Check
        None where no distance is given.
    """
    gap = run.limits.moat_gap
    if gap is None:
        return []
    found = []
    for each in run.equivalent.bounds.values():
        t = _with_gap(gap)
        t.given("D_T", each.allowed_displacement, "m", shown="mm", note="that bearings must allow")
        title = "clearance to the moat wall, equivalent-linear"
        room = run.code.values.get("separation")
        judge = CheckBuilder(t, each.bound, OWN if room is None else room.standing)
        clause = PROJECT_LIMIT if room is None else room.clause
        found.append(judge(clause, title, "D_T", "<=", "g_moat", note=_AT_BEARINGS))
    level = run.rules.bearing_level
    for bound, data in run.runs[level].items():
        moved = run.moved.get(level, {}).get(bound)
        found += _of_histories(run, bound, data, moved, gap)
    return [replace(check, level=level) for check in found]


def _of_histories(
    run: RunToCheck, bound: Bound, data: xr.Dataset, moved: xr.Dataset | None, gap: float
) -> list[Check]:
    beside = None if moved is None else {bound: moved}
    reached = largest_of_bounds({bound: data}, run.rules, "displacement", beside)
    void = raised_suite(data, moved, run.rules).void
    t = _with_gap(gap)
    t.given("D", float(reached.max()), "m", shown="mm", note="of the histories, as the code counts")
    t.given("gamma_x", run.rules.displacement_factor)
    t("D_d", "gamma_x * D", "m", shown="mm")
    judge = CheckBuilder(t, bound, OWN, void=void)
    title = "clearance to the moat wall"
    first = judge(PROJECT_LIMIT, title, "D_d", "<=", "g_moat", note=_AT_BEARINGS)
    every = with_moved(data, moved)
    largest = peaks_of_runs(every, "displacement").max(axis=1)
    k = int(largest.argmax())
    t = _with_gap(gap)
    t.given("D_max", float(largest[k]), "m", shown="mm", note=motion_of(every, k))
    judge = CheckBuilder(t, bound, OWN)
    title = "moat wall is not met in any run"
    note = "the wall is not modelled: where it is met, its force is in no result"
    return [first, judge(PROJECT_LIMIT, title, "D_max", "<=", "g_moat", note=note)]


def _with_gap(gap: float) -> Trace:
    t = Trace()
    t.given("g_moat", gap, "m", shown="mm", note="clear distance, as given")
    return t
