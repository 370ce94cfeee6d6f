"""The run that displaces a bearing most: its histories, and whether its peaks are chance."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.suite import stopped_in
from frames.recording.recording import Recording
from frames.results.peak_response import largest
from frames.results.quantities import QUANTITIES
from frames.results.storage import as_packed
from frames.solve.step_sensitivity import NOISE, SENSITIVE
from frames.solve.time_history import time_history
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames.design.calculation.check import Bound
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.level_runs import LevelRuns
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
