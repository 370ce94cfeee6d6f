"""Time histories of a project at each level of the seismic action, and their results."""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Event
from typing import TYPE_CHECKING, cast

import numpy as np

from frames._errors import ModelError, MotionError
from frames.batch.runs import BOUND, HAZARD, MASS_SHIFT, Runs, tagged
from frames.batch.time_histories import time_histories
from frames.design._errors import ProjectError
from frames.design.codes.isolation import with_property_bounds
from frames.design.histories.eccentricity import WAYS, cases_of
from frames.design.histories.suite import stopped_in
from frames.recording.recording import Recording
from frames.results.peak_response import largest
from frames.results.quantities import QUANTITIES
from frames.results.storage import as_packed
from frames.solve.step_sensitivity import NOISE, SENSITIVE
from frames.solve.time_history import Analysis
from frames.statics.blas_threads import blas_threads_for
from lir_element.errors import AnalysisWarning
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames.batch.cases import BatchProgress
    from frames.design.codes.bounds import BoundName
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.histories.eccentricity import Case
    from frames.design.project.check_register import Preliminary
    from frames.design.project.inputs import ProjectInputs
    from frames.io import Frame
    from frames.motion.ground_motion import GroundMotion

_WATCHED = ("displacement", "base_shear", "rim_force", "slip")
"""Quantities that noise is compared in."""

_ATTRIBUTE = "noise_"  # begins the attributes that keep the differences


def governing_run(parts: ProjectInputs, known: Preliminary, runs: Runs) -> xr.Dataset:
    """Return the histories of the run that displaces a bearing most, run once more to keep them."""
    model, motion = model_and_motion(parts, known, most_displaced(runs))
    given = parts.file.analysis
    stop = Event()

    def go_on(_share: float) -> None:
        if stop.is_set():
            raise KeyboardInterrupt

    with blas_threads_for(model), warnings.catch_warnings(), ThreadPoolExecutor(1) as beside:
        warnings.simplefilter("ignore", AnalysisWarning)  # as in the same run among the others
        run = partial(Analysis(model, given.level).run, dt=given.dt)
        noisy, peaks = motion.scaled(1.0 + NOISE), Recording.peaks()
        other = beside.submit(run, noisy, recording=peaks, progress=go_on)
        try:
            data = run(motion)
            disturbed = other.result()
        finally:
            stop.set()
    return as_packed(data).assign_attrs(
        {f"{_ATTRIBUTE}{key}": _apart(data, disturbed, key) for key in _WATCHED}
    )


def model_and_motion(
    parts: ProjectInputs, known: Preliminary, one: Runs
) -> tuple[Frame, GroundMotion]:
    """Return the structure at the bound of a run, and its motion at the level of that run."""
    level, bound, name = (str(one.of(tag)[0]) for tag in (HAZARD, BOUND, "motion"))
    motion = known.motions[name].scaled(parts.rules().level(level).factor)
    if not bound:
        return known.frame, motion
    return with_property_bounds(known.frame, cast("BoundName", bound), parts.bounds()), motion


def sensitivity_warnings(data: xr.Dataset) -> tuple[str, ...]:
    """Return the warnings on the sensitivity of the governing run's peaks to noise."""
    found = {
        QUANTITIES[key].title: float(data.attrs.get(f"{_ATTRIBUTE}{key}", 0.0)) for key in _WATCHED
    }
    large = {name: share for name, share in found.items() if share > SENSITIVE}
    if not large:
        return ()
    each = (
        worded("{quantity} by {share:.2g} %", quantity=name, share=100.0 * share)
        for name, share in large.items()
    )
    return (
        worded(
            "a change of 1e-9 in the motion changes peaks of the governing run ({peaks}): "
            "use the envelope of several disturbed runs (frames.step_sensitivity), not a "
            "smaller step",
            peaks=joined(*each, by=", "),
        ),
    )


def most_displaced(runs: Runs) -> Runs:
    """Return the run with the largest bearing displacement, of those with the masses in place."""
    own = runs.centred
    reached = np.nan_to_num(own.of("peak_displacement"), nan=-np.inf).max(axis=1)
    return own.those(np.arange(len(own)) == reached.argmax())


def named_case(one: Runs, *, failed: bool = True) -> str:
    """Return a run in words: motion, bound and level; if `failed`, also whether it failed."""
    motion, bound, level = (str(one.of(tag)[0]) for tag in ("motion", BOUND, HAZARD))
    named = worded("{run}, {bound} bound, {level} level", run=motion, bound=bound, level=level)
    return joined(named, "failed" if failed and stopped_in(one.data)[0] else "", by=", ")


def _apart(data: xr.Dataset, other: xr.Dataset, quantity: str) -> float:
    # Difference of the largest values over the larger: 1 if only one run reaches a rim.
    one, two = (float(largest(each, quantity).values.max()) for each in (data, other))
    return 0.0 if one == two else abs(two - one) / max(abs(one), abs(two))


MOVED = "moved"
"""Folder among runs as they complete that keeps those with moved masses."""


def project_runs(
    parts: ProjectInputs,
    known: Preliminary,
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None = None,
) -> Runs:
    """Run a project's time histories at each level and bound, then those with moved masses."""
    given, rules, motions = parts.file.analysis, parts.rules(), known.motions
    own = [
        (level.name, bound, "", name)
        for level in rules.levels
        for bound in given.bounds
        for name in motions
    ]
    runs = _of_all(parts, {"": known.frame}, motions, own, progress, resume)
    if not known.moved:
        return runs
    rows = []
    for case in cases_of(runs, rules):
        is_all = given.accidental_eccentricity_motions == "all"
        names = list(motions) if is_all else [governing_motion(case)]
        rows += [(case.level, case.bound, way, name) for way in known.moved for name in names]
    kept = None if resume is None else resume / MOVED
    return runs + _of_all(parts, known.moved, motions, rows, progress, kept)


def _of_all(
    parts: ProjectInputs,
    frames: Mapping[str, Frame],
    motions: MotionSet,
    rows: Sequence[tuple[str, str, str, str]],
    progress: Callable[[BatchProgress], None] | bool | None,
    resume: Path | None,
) -> Runs:
    # Rows of level, bound, direction of the masses and motion, of a structure by each direction:
    # with their peaks, and their histories if the project keeps them.
    given, rules = parts.file.analysis, parts.rules()
    named = {(b, way): f"{b}, masses {way}" if way else b for b in given.bounds for way in frames}
    models = {
        name: with_property_bounds(frames[way], bound, parts.bounds())
        for (bound, way), name in named.items()
    }
    levels, bounds, ways, names = zip(*rows, strict=True)
    factors = (rules.level(level).factor for level in levels)
    of = (named[at] for at in zip(bounds, ways, strict=True))
    try:
        data = time_histories(
            models,
            motions,
            cases=list(zip(of, names, factors, strict=True)),
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
    return Runs(tagged(data, **{HAZARD: levels, BOUND: bounds, MASS_SHIFT: ways}))


def governing_motion(case: Case) -> str:
    """Return the motion that displaces a bearing most, of the runs that count if any do."""
    reached = case.data["peak_displacement"].max("bearing").to_numpy()
    failed = np.array(case.suite.failed)
    counted = reached if failed.all() else np.where(failed, -np.inf, reached)
    return str(case.data["motion"].to_numpy()[int(np.argmax(counted))])


def said_of_runs(parts: ProjectInputs, motions: MotionSet) -> str:
    """Return the number of time histories of a project, in words."""
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
        f"{said}; {more} more with the masses moved by {100.0 * share:g} % of the plan in each "
        f"direction, {more / count:.2g} times the time of these{without}"
    )
