"""A project's bearings beside the same ones with rigid sliders: time histories of both."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from frames.design.codes.bounds import with_property_bounds
from frames.design.histories.demand_table import envelope_said, void_said
from frames.design.histories.suite import peaks_of_runs
from frames.design.project.level_runs import (
    demands_at_levels,
    histories_at_levels,
    most_displaced,
    moved_at_levels,
    named_case,
)
from frames.design.project.preliminary import preliminary
from frames.results.quantities import DEMANDS
from frames.solve.time_history import time_history
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.batch.cases import BatchProgress
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.level_runs import LevelRuns
    from frames.design.project.preliminary import Preliminary
    from frames.frame import Frame

OURS, PLAIN = "LIR-DCFP", "DCFP"

BY_MOTION = {
    f"{DEMANDS[name].demand} [{DEMANDS[name].pure_unit}]": name
    for name in ("displacement", "drift", "floor_plan", "rim_force")
}
"""What is compared motion by motion, with the name of its column."""


class RunCounts(NamedTuple):
    """What came of the runs of a device.

    Attributes
    ----------
    runs, met, stopped, doubtful : int
        All of them; those that met a rim, stopped before their end, and have a warning of the check
        of modelling assumptions.
    """

    runs: int
    met: int
    stopped: int
    doubtful: int


@dataclass(frozen=True, kw_only=True, eq=False)
class Comparison:
    """Time histories of a project with its bearings, and with rigid sliders in them.

    Attributes
    ----------
    known : Preliminary
        Structure, spectrum and motions.
    runs : mapping of str to mapping
        By device, "LIR-DCFP" and "DCFP": runs by level of the seismic action, then by bound.
    demands : mapping of str to pandas.DataFrame
        By device: what the runs give for design (see `frames.design.history_demands`), raised by
        what moved masses do to that device.
    moved : mapping of str to mapping
        Runs with the floors' masses moved, in the way of `runs`; empty without accidental
        eccentricity.
    """

    known: Preliminary
    runs: Mapping[str, LevelRuns]
    demands: Mapping[str, pd.DataFrame]
    moved: Mapping[str, LevelRuns] = field(default_factory=dict)

    def table(self) -> pd.DataFrame:
        """Return the envelopes over the bounds side by side, in SI units."""
        columns = {
            f"{device}, {envelope_said(table)}": table["envelope"]
            for device, table in self.demands.items()
        }
        ours = self.demands[OURS]
        return ours[["unit"]].assign(**columns, level=ours["level"])

    def by_motion(self) -> pd.DataFrame:
        """Return what each motion reached with each device, the largest over the bounds."""
        rows = []
        for device, levels in self.runs.items():
            for level, bounds in levels.items():
                for k, motion in enumerate(self.known.motions):
                    every = {bound: data.isel(run=[k]) for bound, data in bounds.items()}
                    row: dict[str, object] = {"level": level, "motion": motion, "device": device}
                    row |= {
                        title: max(_largest(data, name) for data in every.values())
                        for title, name in BY_MOTION.items()
                    }
                    status = {b: str(data["status"].to_numpy()[0]) for b, data in every.items()}
                    failed = [f"{b} ({word})" for b, word in status.items() if word != "ok"]
                    rows.append(row | {"failed": ", ".join(failed)})
        return pd.DataFrame(rows)

    def counts(self, device: str, level: str) -> RunCounts:
        """Return how many runs a device has at a level, and what came of them."""
        every = list(self.runs[device][level].values())
        return RunCounts(
            runs=sum(data.sizes["run"] for data in every),
            met=sum(int((_peaks(data, "rim_force") > 0.0).any(axis=1).sum()) for data in every),
            stopped=sum(int((data["status"].to_numpy() != "ok").sum()) for data in every),
            doubtful=sum(int((data["doubts"].to_numpy() != "").sum()) for data in every),
        )

    @property
    def eccentricity(self) -> str:
        """What of accidental eccentricity is in the demands, in words."""
        count = sum(
            data.sizes["run"]
            for levels in self.moved.values()
            for bounds in levels.values()
            for data in bounds.values()
        )
        if not count:
            return "Accidental eccentricity is not in the demands."
        return (
            f"Accidental eccentricity is in the demands, of each device by its own runs: {count} "
            "with the masses of all floors moved, in both. Counts of runs and what each motion "
            "reached are of masses where they are."
        )

    def void(self, device: str, level: str) -> str:
        """Return why a device has no values for design at a level; empty where it has."""
        table = self.demands[device]
        return void_said(table[table["level"] == level])


def compare_project(
    parts: ProjectInputs, *, progress: Callable[[BatchProgress], None] | bool | None = None
) -> Comparison:
    """Run a project with its bearings, and with the same ones whose sliders are rigid."""
    known = preliminary(parts)
    parts.sources.require_unchanged()
    runs = {
        device: histories_at_levels(parts, frame, known.motions, progress)
        for device, frame in _frames_of(known.frame).items()
    }
    moved = {}
    for device, own in runs.items():
        ways = {way: _frames_of(frame)[device] for way, frame in known.moved.items()}
        moved[device] = moved_at_levels(parts, ways, known.motions, own, progress)
    demands = {
        device: demands_at_levels(own, parts.rules(), moved[device]) for device, own in runs.items()
    }
    known = replace(known, doubts=(*known.doubts, *parts.sources.warn_of_changes()))
    return Comparison(known=known, runs=runs, demands=demands, moved=moved)


def compared_histories(
    parts: ProjectInputs, found: Comparison
) -> tuple[dict[str, xr.Dataset], str, str]:
    """Return the histories of both devices in the run that displaces an LIR-DCFP most."""
    level, bound, run = most_displaced(found.runs[OURS])
    reached = _peaks(found.runs[OURS][level][bound], "displacement")[run]
    name, given = list(found.known.motions)[run], parts.file.analysis
    motion = found.known.motions[name].scaled(parts.rules().level(level).factor)
    data = {}
    with warnings.catch_warnings():  # as told of the same run among the others
        warnings.simplefilter("ignore", AnalysisWarning)
        for device, frame in _frames_of(found.known.frame).items():
            model = frame if bound == "" else with_property_bounds(frame, bound, parts.bounds())
            data[device] = time_history(model, motion, level=given.level, dt=given.dt)
    where = list(found.known.frame.bearings)[int(np.argmax(reached))]
    return data, named_case(found.runs[OURS], level, bound, run), where


def _frames_of(frame: Frame) -> dict[str, Frame]:
    plain = {name: link.bearing.as_dcfp() for name, link in frame.bearings.items()}
    return {OURS: frame, PLAIN: frame.with_bearings(plain)}


def _peaks(data: xr.Dataset, name: str) -> np.ndarray:
    return peaks_of_runs(data, name).reshape(data.sizes["run"], -1)


def _largest(data: xr.Dataset, name: str) -> float:
    if f"reached_{name}" not in data:
        return math.nan
    return float(np.nanmax(_peaks(data, name), initial=0.0))
