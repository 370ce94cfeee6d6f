"""Comparison of a project's bearings with the same ones with rigid sliders: time histories."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from frames.batch.runs import BOUND, DEVICE, HAZARD, Runs, tagged
from frames.design.histories.demand_table import demands_at_levels, envelope_said, void_said
from frames.design.histories.eccentricity import cases_of
from frames.design.histories.suite import peaks_of_runs
from frames.design.project.level_runs import (
    model_and_motion,
    most_displaced,
    named_case,
    project_runs,
)
from frames.design.project.preliminary import preliminary
from frames.results.quantities import DEMANDS
from frames.results.recorded import PEAK
from frames.solve.time_history import time_history
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames._types import FloatArray
    from frames.batch.cases import BatchProgress
    from frames.design.project.check_register import Preliminary
    from frames.design.project.inputs import ProjectInputs
    from frames.io import Frame

OURS, PLAIN = "LIR-DCFP", "DCFP"

BY_MOTION = {
    f"{DEMANDS[name].demand} [{DEMANDS[name].pure_unit}]": name
    for name in ("displacement", "drift", "floor_plan", "rim_force")
}
"""Quantities of the comparison by motion, with the names of their columns."""


class RunCounts(NamedTuple):
    """Numbers of runs of a device, by outcome."""

    runs: int  # all of them
    met: int  # runs with rim contact, and runs that stopped before their end
    stopped: int
    doubtful: int  # those with a warning of the check of modelling assumptions


@dataclass(frozen=True, kw_only=True, eq=False)
class Comparison:
    """Time histories of a project with its bearings, and with rigid sliders in them."""

    known: Preliminary  # structure, spectrum and motions
    runs: Runs  # those of both devices, by the tag "device": "LIR-DCFP" and "DCFP"
    # by device: design values of the runs, raised by the effect of moved masses on it
    demands: Mapping[str, pd.DataFrame]

    def table(self) -> pd.DataFrame:
        """Return the envelopes over the bounds side by side, in SI units."""
        columns = {
            f"{device}, {envelope_said(table)}": table["envelope"]
            for device, table in self.demands.items()
        }
        ours = self.demands[OURS]
        return ours[["unit"]].assign(**columns, level=ours["level"])

    @property
    def levels(self) -> list[str]:
        """The levels of the seismic action."""
        return list(dict.fromkeys(map(str, self.runs.of(HAZARD))))

    def by_motion(self) -> pd.DataFrame:
        """Return the peaks of each motion with each device, the largest over the bounds."""
        own = self.runs.centred
        keys = {"level": HAZARD, "motion": "motion", "device": DEVICE}
        rows = pd.DataFrame({title: own.of(tag) for title, tag in keys.items()})
        largest = {title: _largest(own, name) for title, name in BY_MOTION.items()}
        failed = [
            "" if status == "ok" else f"{bound} ({status})"
            for bound, status in zip(own.of(BOUND), own.of("status"), strict=True)
        ]
        every = rows.assign(**largest, failed=failed).groupby([*keys], sort=False)
        worst = dict.fromkeys(largest, "max")
        found = every.agg({**worst, "failed": lambda each: ", ".join(filter(None, each))})
        return found.reset_index()

    def counts(self, device: str, level: str) -> RunCounts:
        """Return the numbers of runs of a device at a level, by outcome."""
        own = self.runs.centred.where(**{DEVICE: device, HAZARD: level})
        return RunCounts(
            runs=len(own),
            met=int((_largest(own, "rim_force") > 0.0).sum()),
            stopped=int((own.of("status") != "ok").sum()),
            doubtful=int((own.of("doubts") != "").sum()),
        )

    @property
    def eccentricity(self) -> str:
        """Accidental eccentricity in the demands, in words."""
        count = len(self.runs.moved)
        if not count:
            return "Accidental eccentricity is not in the demands."
        return (
            f"Accidental eccentricity is in the demands, of each device by its own runs: {count} "
            "with the masses of all floors moved, in both. Counts of runs and what each motion "
            "reached are of masses where they are."
        )

    def void(self, device: str, level: str) -> str:
        """Return the reason that a device has no design values at a level; empty if it has."""
        table = self.demands[device]
        return void_said(table[table["level"] == level])


def compare_project(
    parts: ProjectInputs, *, progress: Callable[[BatchProgress], None] | bool | None = None
) -> Comparison:
    """Run a project with its bearings, and with the same ones whose sliders are rigid."""
    known = preliminary(parts)
    parts.sources.require_unchanged()
    runs, demands = Runs(), {}
    for device in (OURS, PLAIN):
        own = project_runs(parts, _with(device, known), progress)
        demands[device] = demands_at_levels(cases_of(own, parts.rules()))
        runs += Runs(*(tagged(part, **{DEVICE: device}) for part in own.parts))
    known = replace(known, doubts=(*known.doubts, *parts.sources.warn_of_changes()))
    return Comparison(known=known, runs=runs, demands=demands)


def compared_histories(
    parts: ProjectInputs, found: Comparison
) -> tuple[dict[str, xr.Dataset], str, str]:
    """Return the histories of both devices in the run that displaces an LIR-DCFP most."""
    worst = most_displaced(found.runs.where(**{DEVICE: OURS}))
    given, data = parts.file.analysis, {}
    with warnings.catch_warnings():  # the same warnings come from the run among the others
        warnings.simplefilter("ignore", AnalysisWarning)
        for device in (OURS, PLAIN):
            model, motion = model_and_motion(parts, _with(device, found.known), worst)
            data[device] = time_history(model, motion, level=given.level, dt=given.dt)
    where = list(found.known.frame.bearings)[int(np.argmax(worst.of("peak_displacement")[0]))]
    return data, named_case(worst), where


def _with(device: str, known: Preliminary) -> Preliminary:
    # A project on its bearings, or on the same ones with rigid sliders.
    if device == OURS:
        return known

    def plain(frame: Frame) -> Frame:
        return frame.with_bearings({n: k.bearing.as_dcfp() for n, k in frame.bearings.items()})

    moved = {way: plain(frame) for way, frame in known.moved.items()}
    return replace(known, frame=plain(known.frame), moved=moved)


def _largest(runs: Runs, name: str) -> FloatArray:
    # Peaks of each run over all places, (n_runs,); NaN if the runs do not keep it.
    found = []
    for part in runs.parts:
        count = part.sizes["run"]
        if f"{PEAK}{name}" in part:
            every = peaks_of_runs(part, name).reshape(count, -1)
            found.append(np.nanmax(every, axis=1, initial=0.0))
        else:
            found.append(np.full(count, math.nan))
    return np.concatenate(found)
