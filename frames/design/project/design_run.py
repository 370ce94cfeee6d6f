"""A project computed: equivalent-linear analysis, time histories at each bound, all checks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray as xr

from frames.design.calculation.check import Checks
from frames.design.codes.prototype_programme import ProgrammeDemands
from frames.design.histories.demand_table import demand_table, largest_of_bounds, void_said
from frames.design.histories.eccentricity import Case, cases_of
from frames.design.histories.impacts import rim_engagement
from frames.design.project import moat_checks as moat_checks  # which it registers
from frames.design.project import run_checks as run_checks  # which it registers
from frames.design.project.check_register import BearingDemand, RunToCheck, TypeOfBearing, checks_of
from frames.design.project.governing_run import governing_run, sensitivity_warnings
from frames.design.project.level_runs import (
    demands_at_levels,
    histories_at_levels,
    moved_at_levels,
)
from frames.design.project.preliminary import inputs_of, preliminary
from frames.design.project.structure_statement import structure_rows
from frames.design.project.unchecked import provisions_of
from frames.design.testing.programme import prototype_tests
from lir_element.errors import AnalysisInterrupted

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from frames.batch.cases import BatchProgress
    from frames.design.calculation.check import Bound
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.codes.provisions import ProvisionState
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.hazard.spectrum import Spectrum
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.preliminary import Preliminary
    from frames.design.project.schema import ProjectTable
    from frames.frame import Frame
    from frames.statics.model_check import ModelCheck


@dataclass(frozen=True, kw_only=True, eq=False)
class ProjectRun:
    """What a project's run gives."""

    frame: Frame  # the structure on its bearings, friction nominal
    spectrum: Spectrum  # the design spectrum
    motions: MotionSet  # as they were run, scaled
    equivalent: EquivalentLinear  # equivalent-linear analysis at both bounds
    # time histories by level of the seismic action, then by bound; a row a motion
    runs: Mapping[str, Mapping[Bound, xr.Dataset]]
    demands: pd.DataFrame  # what the time histories give for design, with the level of each row
    # of the time histories, the bearing, and what of the equivalent-linear analysis they do not
    # replace
    checks: Checks
    bounds: PropertyBounds  # lower and upper bound friction properties
    model: ModelCheck  # totals of the structure
    loads: tuple[float, ...]  # axial loads of the average combination [N]
    governing: xr.Dataset  # histories of the run that displaces a bearing most
    governing_case: str  # which that is: motion, bound and level
    # digests of what the time histories depend on, by section of the file
    inputs: Mapping[str, str]
    programme: pd.DataFrame  # tests that prove the bearings
    rules: HistoryRules  # how the time histories counted, and at which levels
    # ``[project]`` of the file: its name, client, engineer, checker, revision, date
    about: ProjectTable
    # type of each bearing: "standard", or of ``[bearings.<type>]``
    types: Mapping[str, str] = field(default_factory=dict)
    # time histories with the floors' masses moved, in the way of `runs`
    moved: Mapping[str, Mapping[Bound, xr.Dataset]] = field(default_factory=dict)
    doubts: tuple[str, ...] = ()  # what of the input was warned of
    structure: tuple[tuple[str, str], ...] = ()  # what the structure is, in words
    # provisions of the code: checked, not checked and why, or the engineer's
    provisions: tuple[ProvisionState, ...] = ()
    # tables that the file names, which are kept with the results, as they were read
    tables: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, eq=False)
class Histories:
    """The time histories of a project."""

    # by level of the seismic action, then by bound; a row a motion
    runs: Mapping[str, Mapping[Bound, xr.Dataset]]
    # histories of the run that displaces a bearing most, in single precision as they are kept
    governing: xr.Dataset
    governing_case: str  # which that is
    # runs with the floors' masses moved, in the same way; empty without accidental eccentricity
    moved: Mapping[str, Mapping[Bound, xr.Dataset]] = field(default_factory=dict)


def run_project(
    parts: ProjectInputs,
    *,
    progress: Callable[[BatchProgress], None] | bool | None = None,
    resume: Path | None = None,
) -> ProjectRun:
    """Run a project: equivalent-linear analysis, time histories at each level and bound, checks."""
    known = preliminary(parts)
    parts.sources.require_unchanged()
    runs = histories_at_levels(parts, known.frame, known.motions, progress, resume)
    try:
        moved = moved_at_levels(parts, known.moved, known.motions, runs, progress, resume)
        governing, case = governing_run(parts, known.frame, known.motions, runs)
    except AnalysisInterrupted as stop:  # all with the masses where they are were complete
        whole = xr.concat(
            _every(runs), "run", data_vars="minimal", coords="minimal", compat="override"
        )
        more = int(stop.data.attrs.get("runs_asked_for", 0))
        asked = {"status": "interrupted", "runs_asked_for": whole.sizes["run"] + more}
        stop.data = whole.assign_attrs(asked)  # its class says how far: runs, or time of one run
        raise
    found = Histories(runs=runs, governing=governing, governing_case=case, moved=moved)
    return evaluate_run(parts, known, found)


def evaluate_run(parts: ProjectInputs, known: Preliminary, histories: Histories) -> ProjectRun:
    """Return a project's run from its time histories: demands and checks."""
    frame, bounds, rules, runs = known.frame, parts.bounds(), parts.rules(), histories.runs
    moved = histories.moved
    demands = demands_at_levels(runs, rules, moved)
    level = rules.bearing_level
    types = _types(parts, known, cases_of({level: runs[level]}, rules, moved))
    asked = _of_all(types)
    run = RunToCheck(
        code=parts.code(),
        frame=frame,
        bearing=parts.bearing(),
        system=known.system,
        superstructure=known.superstructure,
        spectrum=known.spectrum,
        motions=known.motions,
        equivalent=known.equivalent,
        runs=runs,
        moved=moved,
        demands=demands,
        bounds=bounds,
        limits=parts.limits(),
        rules=rules,
        asked=asked,
        types=types,
    )
    checks = Checks(checks_of(run))
    return ProjectRun(
        frame=frame,
        spectrum=known.spectrum,
        motions=known.motions,
        equivalent=known.equivalent,
        runs=runs,
        moved=moved,
        demands=demands,
        checks=checks,
        bounds=bounds,
        model=frame.check(),
        loads=known.system.loads,
        governing=histories.governing,
        governing_case=histories.governing_case,
        inputs=inputs_of(parts, known),
        programme=_programme(parts, known, histories, asked),
        rules=rules,
        about=parts.file.project,
        types=known.types,
        doubts=(
            *known.doubts,
            *sensitivity_warnings(histories.governing),
            *parts.sources.warn_of_changes(),
        ),
        structure=tuple(structure_rows(parts.file, frame, known.spectrum)),
        provisions=provisions_of(parts, known, checks),
        tables=parts.sources.tables,
    )


def _every(runs: Mapping[str, Mapping[Bound, xr.Dataset]]) -> list[xr.Dataset]:
    return [data for each in runs.values() for data in each.values()]


def _types(
    parts: ProjectInputs,
    known: Preliminary,
    cases: Sequence[Case],
) -> dict[str, TypeOfBearing]:
    # Of each type of bearing what combinations and histories ask, those at the level of bearings.
    found, rules, void = {}, parts.rules(), void_said(demand_table(cases))
    values = {
        name: largest_of_bounds(cases, name)
        for name in ("axial_force", "axial_tension", "slip", "displacement")
    }
    loads = np.array(
        [
            known.system.loads,
            *known.system.combinations.values(),
            values["axial_force"],
            -values["axial_tension"],
        ]
    )
    for kind, bearing in parts.devices().items():
        columns = tuple(name for name, each in known.types.items() if each == kind)
        places = [k for k, name in enumerate(known.frame.bearings) if name in columns]
        if not places:
            continue
        own = loads[:, places]
        pressed = own[(own > 0.0) & np.isfinite(own)]
        slip = float(np.nanmax(values["slip"][places]))
        if void:  # runs failed: the most that it holds
            slip = bearing.resolved()["slip_capacity"]
        elif rules.displacement_factor > 1.0:  # what is beyond the rims by the code
            reached = rules.displacement_factor * float(np.nanmax(values["displacement"][places]))
            slip = max(slip, reached - bearing.lateral_capacity)
        range_ = float(pressed.min()), float(pressed.max())
        found[kind] = TypeOfBearing(bearing, columns, BearingDemand(range_, slip, void))
    return found


def _of_all(types: Mapping[str, TypeOfBearing]) -> BearingDemand:
    # Of all types the least and the largest load, and the largest slip.
    each = [kind.asked for kind in types.values()]
    loads = min(one.loads[0] for one in each), max(one.loads[1] for one in each)
    return BearingDemand(loads, max(one.slip for one in each), each[0].void)


def _programme(
    parts: ProjectInputs, known: Preliminary, histories: Histories, asked: BearingDemand
) -> pd.DataFrame:
    # Tests at the loads, the slip and the speed of impact that the histories gave.
    above, speeds = parts.file.superstructure, rim_engagement(histories.governing)["speed"]
    wind = 0.0 if above is None else above.wind_shear / len(known.system.loads)
    demands = ProgrammeDemands(
        loads=None if known.system.unknown_loads else asked.loads,
        slip=asked.slip,
        wind=wind or None,
        service=None if above is None else above.service_displacement or None,
        impact_speed=float(speeds.max()) if len(speeds) else None,
    )
    table = prototype_tests(known.equivalent, known.system, demands, bounds=parts.bounds())
    stopped = str(histories.governing.attrs["status"]) != "ok"  # of which the speed is
    speed = "the run that displaces a bearing most failed" if stopped else ""
    for of_runs, void in (
        ("(?:largest|least) load|interface|impact", "runs failed" if asked.void else ""),
        ("impact", "" if asked.void else speed),
    ):
        those = table["what"].str.contains(of_runs, regex=True) & bool(void)
        why, notes = f"no values for design: {void}", table.loc[those, "note"]
        table.loc[those, "note"] = [f"{note}; {why}" if note else why for note in notes]
    return table
