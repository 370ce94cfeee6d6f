"""Time histories of a project at each level of the seismic action, and what they give."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.batch.time_histories import time_histories
from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.demand_table import at_levels
from frames.design.histories.histories import history_demands
from frames.recording.recording import Recording

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from frames.batch.cases import BatchProgress
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.project.inputs import ProjectInputs
    from frames.frame import Frame

LevelRuns = dict[str, dict["Bound", "xr.Dataset"]]
"""Runs by level of the seismic action, then by bound of the properties."""


def histories_at_levels(
    parts: ProjectInputs,
    frame: Frame,
    motions: MotionSet,
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None = None,
) -> LevelRuns:
    """Run a project's time histories at each level and bound, all on all processors.

    Parameters
    ----------
    parts : ProjectInputs
        The project.
    frame : Frame
        Its structure, friction nominal.
    motions : MotionSet
        Scaled to the design spectrum.
    progress : callable or bool, optional
        As for `frames.time_histories`.
    resume : Path, optional
        Folder that keeps runs as they complete, and from which they are taken.

    Returns
    -------
    dict of str to dict of str to xarray.Dataset
        By level, then by bound: a row a motion.

    Raises
    ------
    AnalysisInterrupted
        After Ctrl-C, with the runs that were complete.
    """
    given, levels = parts.file.analysis, parts.rules().levels
    models: dict[str, Frame] = {
        bound: with_property_bounds(frame, bound, parts.bounds()) for bound in given.bounds
    }
    places = [(level, bound) for level in levels for bound in given.bounds]
    cases = [(bound, name, level.factor) for level, bound in places for name in motions]
    record = Recording(every=1 if given.histories == "all" else None, forces=True)
    data = time_histories(
        models,
        motions,
        cases=cases,
        level=given.level,
        dt=given.dt,
        workers=given.workers,
        progress=progress,
        record=record,
        resume=resume,
    )
    found: LevelRuns = {level.name: {} for level in levels}
    for k, (level, bound) in enumerate(places):
        rows = slice(k * len(motions), (k + 1) * len(motions))
        found[level.name][bound] = data.isel(run=rows)
    return found


def demands_at_levels(
    runs: Mapping[str, Mapping[Bound, xr.Dataset]], rules: HistoryRules
) -> pd.DataFrame:
    """Return what time histories give for design at each level.

    Parameters
    ----------
    runs : mapping of str to mapping of str to xarray.Dataset
        By level, then by bound.
    rules : HistoryRules
        The code's.

    Returns
    -------
    pandas.DataFrame
        The tables of `frames.history_demands` one under the other; the last column is the level.
    """
    return at_levels({name: history_demands(each, rules) for name, each in runs.items()})


def said_of_runs(parts: ProjectInputs, motions: MotionSet) -> str:
    """Return how many time histories a project asks for, in words."""
    levels, bounds = parts.rules().levels, parts.file.analysis.bounds
    count = len(levels) * len(bounds) * len(motions)
    named = ", ".join(
        f"{level.name} (motions times {level.factor:g})" if level.factor > 1.0 else level.name
        for level in levels
    )
    what = f"{len(motions)} motions, bounds {', '.join(bounds)}, level{'s' * (len(levels) > 1)}"
    return f"{count} time histories: {what} {named}"
