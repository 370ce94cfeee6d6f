"""A project computed: equivalent-linear analysis, time histories at each bound, all checks."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.design.calculation.check import Checks
from frames.design.codes.code_values import OF_BEARINGS, states_of
from frames.design.codes.prototype_programme import ProgrammeDemands
from frames.design.histories.demand_table import (
    FailedRuns,
    demands_at_levels,
    failed_runs,
    largest_of_bounds,
    void_of,
)
from frames.design.histories.eccentricity import Case, cases_of, levels_of
from frames.design.histories.impacts import rim_engagement
from frames.design.project.check_register import BearingDemand, RunToCheck, TypeOfBearing, checks_of
from frames.design.project.level_runs import (
    governing_run,
    most_displaced,
    named_case,
    project_runs,
    sensitivity_warnings,
)
from frames.design.project.preliminary import inputs_of, preliminary
from frames.design.project.structure_statement import structure_rows
from frames.design.testing.programme import prototype_tests
from lir_element.texts import joined, keeping_texts, worded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames.batch.cases import BatchProgress
    from frames.batch.runs import Runs
    from frames.design.calculation.check import Check
    from frames.design.codes.code_values import ProvisionState
    from frames.design.codes.registry import DesignCode
    from frames.design.project.check_register import Preliminary
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.schema import ProjectTable
    from frames.statics.model_check import ModelCheck


def provisions_of(
    parts: ProjectInputs, known: Preliminary, checks: Iterable[Check], *, is_run: bool = True
) -> tuple[ProvisionState, ...]:
    """Return whether each provision of the code is checked in a project, and why not."""
    asked = (*parts.code().provisions, *OF_BEARINGS)
    return states_of(asked, facts_of(parts, known), (*checks, *known.checks), is_run=is_run)


def facts_of(parts: ProjectInputs, known: Preliminary) -> frozenset[str]:
    """Return the facts of `NEEDS` that a project has, and the parts of its structure."""
    file, frame, above = parts.file, known.frame, known.superstructure
    limits, facts = parts.limits(), [one.get("near_fault") for one in known.motions.facts.values()]
    laws = [getattr(link.law, "yield_force", None) for link in frame.links.values()]
    there = {
        "superstructure": above is not None,
        "wind": above is not None and above.wind_shear > 0.0,
        "service": above is not None and above.service_displacement > 0.0,
        "storey stiffness": above is not None and above.storey_stiffness is not None,
        "combinations": bool(known.system.combinations),
        "storeys": len(frame.levels) > 1,
        "moved": bool(known.moved),
        "bounds": not {*file.analysis.bounds}.isdisjoint(known.equivalent.bounds),
        "gap": limits.moat_gap is not None,
        "room": limits.moat_gap is not None or file.moat is not None,
        "pressure": limits.interface_pressure is not None,
        "liner": limits.liner_pressure is not None,
        "rim strength": limits.rim_strength is not None,
        "near fault": any(facts),
        "walls": bool(getattr(file.structure, "walls", ())),
        "dampers": bool(file.dampers),
        "yields": bool(frame.hinges) or any(force is not None for force in laws),
    }
    return frozenset(name for name, is_there in there.items() if is_there)


def from_memory(code: DesignCode) -> tuple[str, ...]:
    """Return which values of a code are from memory alone."""
    said = [f"{v.clause} ({v.what})" for v in code.values.values() if v.standing.starred]
    return (f"from memory, not read in the standard: {'; '.join(said)}",) if said else ()


@dataclass(frozen=True, kw_only=True, eq=False)
class ProjectRun(RunToCheck):
    """Results of a project's run: the input of its checks, and their outcome."""

    # its checks are all that were made, its doubts those of the governing run as well
    model: ModelCheck  # totals of the structure
    governing: xr.Dataset  # histories of the run that displaces a bearing most
    # digests of the input of the time histories, by section of the file
    inputs: Mapping[str, str]
    programme: pd.DataFrame  # tests that prove the bearings
    # ``[project]`` of the file: name, client, engineer, checker, revision, date
    about: ProjectTable
    rim_width: float  # least of a rim in plan [m]
    structure: tuple[tuple[str, str], ...] = ()  # the structure in words
    # provisions of the code: checked, not checked and why, or the engineer's
    provisions: tuple[ProvisionState, ...] = ()
    # tables of the file, kept with the results as they were read
    tables: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def governing_case(self) -> str:
        """Motion, bound and level of the run that displaces a bearing most."""
        return named_case(most_displaced(self.runs))

    @property
    def loads(self) -> tuple[float, ...]:
        """Axial loads of the average combination [N], (n_bearings,)."""
        return self.system.loads

    @cached_property
    def failures(self) -> list[FailedRuns]:
        """Runs that failed, by level, bound and cause."""
        return failed_runs(self.cases)

    @cached_property
    def by_file(self) -> dict[tuple[str, str], tuple[Case, xr.Dataset]]:
        """Case and its runs of a file, by the two words of the file's name."""
        several = len(levels_of(self.cases)) > 1
        found = {}
        for word in ("runs", "moved"):
            for case in self.cases:
                data = case.data if word == "runs" else case.moved
                label = f"{case.level}-{case.bound}" if several else case.bound
                if data is not None:
                    found[word, label] = case, data
        return found


def run_project(
    parts: ProjectInputs,
    *,
    progress: Callable[[BatchProgress], None] | bool | None = None,
    resume: Path | None = None,
) -> ProjectRun:
    """Run a project: equivalent-linear analysis, time histories at each level and bound, checks."""
    known = preliminary(parts)
    parts.sources.require_unchanged()
    runs = project_runs(parts, known, progress, resume)
    return evaluate_run(parts, known, runs, governing_run(parts, known, runs))


@keeping_texts
def evaluate_run(
    parts: ProjectInputs, known: Preliminary, runs: Runs, governing: xr.Dataset
) -> ProjectRun:
    """Return a project's run from its time histories: demands and checks."""
    run = checked_run(parts, known, runs)
    heard = (*sensitivity_warnings(governing), *parts.sources.warn_of_changes())
    return ProjectRun(
        **(vars(run) | {"doubts": (*known.doubts, *heard)}),
        model=run.frame.check(),
        governing=governing,
        inputs=inputs_of(parts, known),
        programme=_programme(parts, known, governing, run.asked),
        about=parts.file.project,
        rim_width=parts.target().rim_width,
        structure=tuple(structure_rows(parts.file, run.frame, known.spectrum)),
        provisions=provisions_of(parts, known, run.checks),
        tables=parts.sources.tables,
    )


def checked_run(parts: ProjectInputs, known: Preliminary, runs: Runs) -> RunToCheck:
    """Return the input of a project's checks, with all checks made of it."""
    rules = parts.rules()
    cases = cases_of(runs, rules)
    types = _types(parts, known, levels_of(cases)[rules.bearing_level])
    run = RunToCheck(
        **vars(known),
        code=parts.code(),
        bearing=parts.bearing(),
        runs=runs,
        cases=cases,
        demands=demands_at_levels(cases),
        bounds=parts.bounds(),
        limits=parts.limits(),
        rules=rules,
        asked=_of_all(types),
        types=types,
    )
    return replace(run, checks=Checks(checks_of(run)))


def _types(
    parts: ProjectInputs,
    known: Preliminary,
    cases: Sequence[Case],
) -> dict[str, TypeOfBearing]:
    # Demands of combinations and histories on each type of bearing, at the level of bearings.
    found, rules, void = {}, parts.rules(), void_of(cases)
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
        columns = tuple(name for name, each in known.kinds.items() if each == kind)
        places = [k for k, name in enumerate(known.frame.bearings) if name in columns]
        if not places:
            continue
        own = loads[:, places]
        pressed = own[(own > 0.0) & np.isfinite(own)]
        slip = float(np.nanmax(values["slip"][places]))
        if void:  # runs failed: the most that it holds
            slip = bearing.resolved()["slip_capacity"]
        elif rules.displacement_factor > 1.0:  # the part beyond the rims by the code
            reached = rules.displacement_factor * float(np.nanmax(values["displacement"][places]))
            slip = max(slip, reached - bearing.lateral_capacity)
        range_ = float(pressed.min()), float(pressed.max())
        found[kind] = TypeOfBearing(bearing, columns, BearingDemand(range_, slip, void))
    return found


def _of_all(types: Mapping[str, TypeOfBearing]) -> BearingDemand:
    # The least and the largest load of all types, and the largest slip.
    each = [kind.asked for kind in types.values()]
    loads = min(one.loads[0] for one in each), max(one.loads[1] for one in each)
    return BearingDemand(loads, max(one.slip for one in each), each[0].void)


def _programme(
    parts: ProjectInputs, known: Preliminary, governing: xr.Dataset, asked: BearingDemand
) -> pd.DataFrame:
    # Tests at the loads, the slip and the speed of impact that the histories gave.
    above, speeds = parts.file.superstructure, rim_engagement(governing)["speed"]
    wind = 0.0 if above is None else above.wind_shear / len(known.system.loads)
    demands = ProgrammeDemands(
        loads=None if known.system.unknown_loads else asked.loads,
        slip=asked.slip,
        wind=wind or None,
        service=None if above is None else above.service_displacement or None,
        impact_speed=float(speeds.max()) if len(speeds) else None,
    )
    table = prototype_tests(known.equivalent, known.system, demands, bounds=parts.bounds())
    stopped = str(governing.attrs["status"]) != "ok"  # of which the speed is
    speed = "the run that displaces a bearing most failed" if stopped else ""
    for of_runs, void in (
        ("(?:largest|least) load|interface|impact", "runs failed" if asked.void else ""),
        ("impact", "" if asked.void else speed),
    ):
        those = table["what"].str.contains(of_runs, regex=True) & bool(void)
        why = worded("no values for design: {why}", why=void)
        table.loc[those, "note"] = [joined(note, why) for note in table.loc[those, "note"]]
    return table
