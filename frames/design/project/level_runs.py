"""Time histories of a project at each level of the seismic action, and what they give."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, MotionError
from frames.batch.time_histories import time_histories
from frames.design._errors import ProjectError
from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.demand_table import at_levels
from frames.design.histories.eccentricity import WAY, WAYS
from frames.design.histories.histories import history_demands
from frames.design.histories.suite import suite_of
from frames.recording.recording import Recording

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
