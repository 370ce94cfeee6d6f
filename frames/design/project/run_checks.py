"""The checks that every project's run makes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames.design.calculation.check import Check, Checks
from frames.design.calculation.unevaluated import not_evaluated
from frames.design.devices.capacity import engagement_checks
from frames.design.devices.device import device_checks
from frames.design.histories.histories import history_checks
from frames.design.histories.motions import motion_checks
from frames.design.project.check_register import RunToCheck, register_check

if TYPE_CHECKING:
    from frames.design.calculation.check import Bound
    from frames.design.project.check_register import BearingDemand
    from lir_element import LIRBearing


@register_check
def of_the_analysis(run: RunToCheck) -> list[Check]:
    """Return those of the equivalent-linear analysis that time histories do not replace."""
    return [check for check in run.equivalent.checks if check.scope == "any"]


@register_check
def of_the_motions(run: RunToCheck) -> Checks:
    """Return those of the motions against the design spectrum."""
    return motion_checks(run.motions, run.spectrum, run.equivalent)


@register_check
def of_the_histories(run: RunToCheck) -> list[Check]:
    """Return those of the time histories at each level; minima where the code has them."""
    has_minima = run.rules.has_minima and run.superstructure is not None
    found: list[Check] = []
    for level, runs in run.runs.items():
        found += history_checks(
            runs,
            run.frame,
            run.rules,
            bounds=run.bounds,
            limits=run.limits,
            equivalent=run.equivalent if has_minima else None,
            action_level=level,
            moved=run.moved.get(level),
        )
    return found


@register_check
def of_the_bearing(run: RunToCheck) -> list[Check]:
    """Return those by each type's own numbers, at loads and slip that the histories gave."""
    found: list[Check] = []
    for name, kind in run.types.items():
        for check in _of_type(run, kind.bearing, kind.asked):
            subject = check.subject
            if len(run.types) > 1:
                subject = ", ".join(part for part in (f"type {name}", subject) if part)
            found.append(replace(check, subject=subject, level=run.rules.bearing_level))
    return found


def _of_type(run: RunToCheck, bearing: LIRBearing, asked: BearingDemand) -> list[Check]:
    bounds, limits = run.bounds, run.limits
    checks = device_checks(bearing, asked.loads, slip=asked.slip, bounds=bounds, limits=limits)
    checks = Checks(replace(check, void=asked.void) for check in checks)
    checks = not_evaluated(checks, run.system.unknown_loads, ("N_min", "N_max"))
    allowed: dict[Bound, float] = {
        each.bound: each.allowed_displacement for each in run.equivalent.bounds.values()
    }
    agreed = limits.rim_engagement
    rims = engagement_checks(bearing, allowed, code=run.code.name, agreed=agreed)
    return [*checks, *rims]
