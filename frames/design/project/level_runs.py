"""Time histories of a project at each level of the seismic action, and what they give."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, MotionError
from frames.batch.time_histories import time_histories
from frames.design._errors import ProjectError
from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.demand_table import at_levels
from frames.design.histories.eccentricity import WAY, WAYS
from frames.design.histories.histories import history_demands
from frames.design.histories.suite import stopped_in, suite_of
from frames.recording.recording import Recording
from frames.results.peak_response import largest
from frames.results.quantities import QUANTITIES
from frames.results.storage import as_packed
from frames.solve.step_sensitivity import NOISE, SENSITIVE
from frames.solve.time_history import time_history
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from frames.batch.cases import BatchProgress
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.project.inputs import ProjectInputs
    from frames.frame import Frame

_WATCHED = ("displacement", "base_shear", "rim_force", "slip")
"""Quantities that noise is compared in."""

_ATTRIBUTE = "noise_"  # begins the attributes that keep the differences


def governing_run(
    parts: ProjectInputs, frame: Frame, motions: MotionSet, runs: LevelRuns
) -> tuple[xr.Dataset, str]:
    """Return the histories of the run that displaces a bearing most, run once more to keep them."""
    level, bound, run = most_displaced(runs)
    name, given = str(runs[level][bound]["motion"].to_numpy()[run]), parts.file.analysis
    motion = motions[name].scaled(parts.rules().level(level).factor)
    model = frame if bound == "" else with_property_bounds(frame, bound, parts.bounds())
    with warnings.catch_warnings():  # as told of the same run among the others
        warnings.simplefilter("ignore", AnalysisWarning)
        data = time_history(model, motion, level=given.level, dt=given.dt)
        disturbed = time_history(
            model,
            motion.scaled(1.0 + NOISE),
            level=given.level,
            dt=given.dt,
            recording=Recording.peaks(),
        )
    kept = as_packed(data).assign_attrs(
        {f"{_ATTRIBUTE}{key}": _apart(data, disturbed, key) for key in _WATCHED}
    )
    return kept, named_case(runs, level, bound, run)


def sensitivity_warnings(data: xr.Dataset) -> tuple[str, ...]:
    """Return what noise says of the peaks of the governing run."""
    found = {
        QUANTITIES[key].title: float(data.attrs.get(f"{_ATTRIBUTE}{key}", 0.0)) for key in _WATCHED
    }
    large = {name: share for name, share in found.items() if share > SENSITIVE}
    if not large:
        return ()
    listed = ", ".join(f"{name} by {100.0 * share:.2g} %" for name, share in large.items())
    return (
        f"a billionth of the ground motion changes peaks of the governing run ({listed}): they are "
        "chance within that range, which no smaller step narrows; judge several disturbed motions "
        "(frames.step_sensitivity compares)",
    )


def most_displaced(runs: Mapping[str, Mapping[Bound, xr.Dataset]]) -> tuple[str, Bound, int]:
    """Return level, bound and place of the run that displaces a bearing most."""
    reached = {
        (level, bound, run): float(data["reached_displacement"].isel(run=run).max())
        for level, each in runs.items()
        for bound, data in each.items()
        for run in range(data.sizes["run"])
    }
    return max(reached, key=lambda key: reached[key])


def named_case(runs: LevelRuns, level: str, bound: Bound, run: int) -> str:
    """Return a run in words: motion, bound and level, and the status of one that failed."""
    data = runs[level][bound]
    motion, status = (str(data[name].to_numpy()[run]) for name in ("motion", "status"))
    ended = f", failed ({status})" if stopped_in(data)[run] else ""
    return f"{motion}, {bound} bound, {level} level{ended}"


def _apart(data: xr.Dataset, other: xr.Dataset, quantity: str) -> float:
    # Difference of the largest values over the larger: a rim that one run alone meets is all of it.
    one, two = (float(largest(each, quantity).values.max()) for each in (data, other))
    return 0.0 if one == two else abs(two - one) / max(abs(one), abs(two))


MOVED = "moved"
"""Folder among runs as they complete that keeps those with moved masses."""

LevelRuns = dict[str, dict["Bound", "xr.Dataset"]]
"""Runs by level of the seismic action, then by bound of the properties."""


def histories_at_levels(
    parts: ProjectInputs,
    frame: Frame,
    motions: MotionSet,
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None = None,
) -> LevelRuns:
    """Run a project's time histories at each level and bound, all on all processors."""
    given, levels = parts.file.analysis, parts.rules().levels
    models: dict[str, Frame] = {
        bound: with_property_bounds(frame, bound, parts.bounds()) for bound in given.bounds
    }
    places = [(level, bound) for level in levels for bound in given.bounds]
    cases = [(bound, name, level.factor) for level, bound in places for name in motions]
    data = _of_all(parts, models, motions, cases, progress, resume)
    found: LevelRuns = {level.name: {} for level in levels}
    for k, (level, bound) in enumerate(places):
        rows = slice(k * len(motions), (k + 1) * len(motions))
        found[level.name][bound] = data.isel(run=rows)
    return found


def moved_at_levels(
    parts: ProjectInputs,
    moved: Mapping[str, Frame],
    motions: MotionSet,
    runs: Mapping[str, Mapping[Bound, xr.Dataset]],
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None = None,
) -> LevelRuns:
    """Run a project with the floors' masses moved each way, at each level and bound."""
    if not moved:
        return {}
    given, rules = parts.file.analysis, parts.rules()
    models: dict[str, Frame] = {
        f"{bound}, masses {way}": with_property_bounds(frame, bound, parts.bounds())
        for bound in given.bounds
        for way, frame in moved.items()
    }
    cases, places = [], []
    for level in rules.levels:
        for bound in given.bounds:
            names = (
                list(motions)
                if given.accidental_eccentricity_motions == "all"
                else [governing_motion(runs[level.name][bound], rules)]
            )
            own = [(way, name) for way in moved for name in names]
            places.append((level.name, bound, [way for way, _ in own]))
            cases += [(f"{bound}, masses {way}", name, level.factor) for way, name in own]
    kept = None if resume is None else resume / MOVED
    data = _of_all(parts, models, motions, cases, progress, kept)
    found: LevelRuns = {level.name: {} for level in rules.levels}
    begin = 0
    for name, bound, ways in places:
        own_rows = data.isel(run=slice(begin, begin + len(ways)))
        found[name][bound] = own_rows.assign_coords({WAY: ("run", ways)})
        begin += len(ways)
    return found


def _of_all(
    parts: ProjectInputs,
    models: Mapping[str, Frame],
    motions: MotionSet,
    cases: Sequence[tuple[str, str, float]],
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None,
) -> xr.Dataset:
    # All runs alike: with what they reached, and their histories where the project asks for these.
    given = parts.file.analysis
    try:
        return time_histories(
            models,
            motions,
            cases=cases,
            level=given.level,
            dt=given.dt,
            workers=given.workers,
            progress=progress,
            record=Recording(every=1 if given.histories == "all" else None, forces=True),
            resume=resume,
        )
    except (ModelError, MotionError):
        raise
    except ValueError as cause:  # of steps, and of results that would not fit the memory
        msg = f"[analysis] {cause}"
        raise ProjectError(msg) from cause


def governing_motion(data: xr.Dataset, rules: HistoryRules) -> str:
    """Return the motion that displaces a bearing most, of the runs that count if any do."""
    reached = data["reached_displacement"].max("bearing").to_numpy()
    failed = np.array(suite_of(data, rules).failed)
    counted = reached if failed.all() else np.where(failed, -np.inf, reached)
    return str(data["motion"].to_numpy()[int(np.argmax(counted))])


def demands_at_levels(
    runs: Mapping[str, Mapping[Bound, xr.Dataset]],
    rules: HistoryRules,
    moved: Mapping[str, Mapping[Bound, xr.Dataset]] | None = None,
) -> pd.DataFrame:
    """Return what time histories give for design at each level."""
    beside = moved or {}
    return at_levels(
        {name: history_demands(own, rules, moved=beside.get(name)) for name, own in runs.items()}
    )


def said_of_runs(parts: ProjectInputs, motions: MotionSet) -> str:
    """Return how many time histories a project asks for, in words."""
    levels, bounds = parts.rules().levels, parts.file.analysis.bounds
    count = len(levels) * len(bounds) * len(motions)
    named = ", ".join(
        f"{level.name} (motions times {level.factor:g})" if level.factor > 1.0 else level.name
        for level in levels
    )
    lacking = [end for end in ("lower", "upper") if end not in bounds]
    without = f"; without the bound {' and '.join(lacking)}" if lacking else ""
    what = f"{len(motions)} motions, bounds {', '.join(bounds)}, level{'s' * (len(levels) > 1)}"
    said = f"{count} time histories: {what} {named}"
    share = parts.rules().accidental_eccentricity
    if not share:
        return f"{said}; accidental eccentricity is left out{without}"
    every = parts.file.analysis.accidental_eccentricity_motions == "all"
    more = len(WAYS) * (count if every else len(levels) * len(bounds))
    return (
        f"{said}; {more} more with the masses moved by {100.0 * share:g} % of the plan each way, "
        f"{more / count:.2g} times the time of these{without}"
    )
