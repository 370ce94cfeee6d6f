"""Register of checks of a project's run: their input, and how to add one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames.design._errors import CheckError
from frames.design.calculation.check import Check, Checks
from frames.design.calculation.not_evaluated import not_evaluated
from frames.design.devices.capacity import engagement_checks
from frames.design.devices.device import device_checks
from frames.design.histories.eccentricity import levels_of
from frames.design.histories.histories import case_checks
from frames.design.histories.motions import motion_checks
from frames.design.project.moat_and_dampers import clearance_checks, wall_checks
from lir_element.argument_checks import require_type
from lir_element.texts import joined

if TYPE_CHECKING:
    import pandas as pd

    from frames.batch.runs import Runs
    from frames.design.calculation.check import Bound
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.codes.registry import DesignCode
    from frames.design.codes.superstructure import Superstructure
    from frames.design.devices.limits import DesignLimits
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.hazard.spectrum import Spectrum
    from frames.design.histories.eccentricity import Case
    from frames.io import Frame
    from lir_element import LIRBearing


class BearingDemand(NamedTuple):
    """Demands for checks and tests of bearings."""

    # least axial load that presses, and the largest, of combinations and histories [N]
    loads: tuple[float, float]
    slip: float  # of the interface [m]
    void: str  # why neither is a value for design, as after runs that failed; "" if they are


class TypeOfBearing(NamedTuple):
    """A type of bearing of a project, with the demands of its time histories."""

    bearing: LIRBearing  # the device, friction nominal
    columns: tuple[str, ...]  # names of the frame's bearings that are of this type
    asked: BearingDemand  # demands of the time histories on these


@dataclass(frozen=True, kw_only=True, eq=False)
class Preliminary:
    """Results for a project before its time histories."""

    frame: Frame  # on its bearings, friction nominal, under the average combination of loads
    system: IsolationSystem  # the bearings with their places, and their loads in all combinations
    spectrum: Spectrum  # the design spectrum
    superstructure: Superstructure | None  # structure above the bearings
    equivalent: EquivalentLinear  # equivalent-linear analysis at both bounds
    motions: MotionSet  # scaled by the file
    # the structure with its floors' masses moved, by the direction; none without accidental
    # eccentricity
    moved: Mapping[str, Frame] = field(default_factory=dict)
    kinds: Mapping[str, str] = field(default_factory=dict)  # type of each bearing of the frame
    # the structure under each combination of loads but the average one, by its factors in words;
    # with the vertical earthquake, unless motions have it
    combined: Mapping[str, Frame] = field(default_factory=dict)
    # warnings about the file, the bearing and the motions
    doubts: tuple[str, ...] = ()
    # those of the equivalent-linear analysis, and of the clear distance to walls by it
    checks: Checks = field(default_factory=Checks)


@dataclass(frozen=True, kw_only=True, eq=False)
class RunToCheck(Preliminary):
    """All results of a project for its checks.

    Attributes
    ----------
    code : DesignCode
        The code that it is designed by.
    frame : Frame
        The structure on its bearings, friction nominal.
    bearing : LIRBearing
        The standard bearing, friction nominal.
    system : IsolationSystem
        The bearings with their places, average loads and combinations.
    superstructure : Superstructure, optional
        The structure above, for design formulas.
    spectrum : Spectrum
        The design spectrum.
    motions : MotionSet
        The scaled motions of the runs.
    equivalent : EquivalentLinear
        Equivalent-linear analysis at both bounds.
    runs : frames.batch.runs.Runs
        Time histories, a row each: ``run.runs.where(hazard_level="MCE_R", bound="lower").data`` is
        a Dataset of some. The tag "mass_shift" is the direction of moved masses.
    cases : list of Case
        The same by level and bound as the code counts them, accidental eccentricity with them.
    demands : pandas.DataFrame
        Design values of the time histories, with the level of each row.
    bounds : PropertyBounds
        Bounds of friction.
    limits : DesignLimits
        Limits of the engineer.
    rules : HistoryRules
        Rules for time histories.
    asked : BearingDemand
        Demands of the time histories on the bearings.
    types : mapping of str to TypeOfBearing
        Types of bearings, with the demands of the time histories on each.
    moved, kinds : mapping of str to Frame, of str to str
        The structure with its masses moved, by the direction; the type of each of its bearings.
    combined : mapping of str to Frame
        The structure under each combination of loads, "1.44 D + L + 0.15 S".
    doubts, checks : tuple of str, Checks
        Warnings about the input; checks without time histories.

    Examples
    --------
    In the how-to: "Adding a check, a design code or a friction law" (docs/extending.md).
    """

    code: DesignCode
    bearing: LIRBearing
    runs: Runs
    cases: list[Case]
    demands: pd.DataFrame
    bounds: PropertyBounds
    limits: DesignLimits
    rules: HistoryRules
    asked: BearingDemand
    types: Mapping[str, TypeOfBearing] = field(default_factory=dict)


MakeChecks = Callable[[RunToCheck], Iterable[Check]]
"""A function that makes checks of a run."""

Made = TypeVar("Made", bound=MakeChecks)
_REGISTERED: dict[str, MakeChecks] = {}


def register_check(make: Made) -> Made:
    """Add checks to every project's run; also as a decorator.

    Parameters
    ----------
    make : callable
        Returns checks of a `RunToCheck`. Its name is its place: one of the same name, as after a
        notebook's cell was run again, is replaced.

    Returns
    -------
    callable
        The same.

    Raises
    ------
    TypeError
        If it cannot be called.

    Examples
    --------
    >>> from frames.design import register_check, unregister_check
    >>> @register_check
    ... def none_yet(run):
    ...     return []
    >>> unregister_check(none_yet)
    """
    require_type("make", make, Callable, "a function of a run that returns checks")  # type: ignore[arg-type]
    _REGISTERED[_name(make)] = make
    return make


def unregister_check(make: MakeChecks) -> None:
    """Remove these checks from every project's run.

    Parameters
    ----------
    make : callable
        The registered function.

    Examples
    --------
    >>> from frames.design import register_check, unregister_check
    >>> @register_check
    ... def nothing(run):
    ...     return []
    ...
    >>> unregister_check(nothing)
    """
    _REGISTERED.pop(_name(make), None)


def checks_of(run: RunToCheck) -> list[Check]:
    """Return the checks of all that are registered, in that order."""
    found: list[Check] = []
    for name, make in tuple(_REGISTERED.items()):
        made: object = make(run)
        for one in made if isinstance(made, Iterable) else [made]:
            if not isinstance(one, Check):
                msg = f"{name} returned {one!r}: return a list of frames.design.Check"
                raise CheckError(msg)
            found.append(one)
    return found


def _name(make: MakeChecks) -> str:
    kind = type(make)
    return f"{make.__module__}.{getattr(make, '__qualname__', kind.__qualname__)}"


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
    """Return the checks of the time histories at each level, with the code's minima."""
    has_minima = run.rules.has_minima and run.superstructure is not None
    found: list[Check] = []
    equivalent = run.equivalent if has_minima else None
    for name, cases in levels_of(run.cases).items():
        level = run.rules.level(name)
        found += case_checks(cases, run.frame, level, run.bounds, run.limits, equivalent)
    return found


@register_check
def of_the_bearing(run: RunToCheck) -> list[Check]:
    """Return those by each type's own numbers, at loads and slip that the histories gave."""
    found: list[Check] = []
    for name, kind in run.types.items():
        for check in _of_type(run, kind.bearing, kind.asked):
            subject = check.subject
            if len(run.types) > 1:
                subject = joined(f"type {name}", subject, by=", ")
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


@register_check
def of_the_moat(run: RunToCheck) -> list[Check]:
    """Return those of the clear distance to the moat wall, by both analyses."""
    gap, level = run.limits.moat_gap, run.rules.bearing_level
    found = clearance_checks(run.code, run.equivalent, run.limits, run.frame)
    if gap is not None:
        found += wall_checks(run.frame, levels_of(run.cases)[level], gap)
    return [replace(check, level=level) for check in found]
