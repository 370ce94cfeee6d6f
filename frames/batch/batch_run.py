"""One run among many: in arrays that its thread uses again and again, to a row of numbers."""

from __future__ import annotations

import math
import threading
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.batch.batch_dataset import NUMBERS, Layout, RunResult, layout_of, reached_row
from frames.bundles.peak_data import ENERGY_TERMS
from frames.recording.force_tracking import ForceTracker
from frames.recording.recording import Recording, bytes_over_time, require_known, require_rows
from frames.recording.reduction import reduced
from frames.results.findings import Findings
from frames.results.peaks import peaks_of
from frames.results.recorded import is_of_all_steps
from frames.solve.analysis import PreparedFrame
from frames.solve.recorder import PeakRecorder, Recorder
from frames.solve.run import run_one
from lir_element.errors import AnalysisError, RunStatus
from lir_element.results.dataset import note_end

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr

    from frames.batch.cases import Case
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.solve.options import Options
    from frames.statics.gravity_state import GravityState
    from lir_element.device.features import Features


_ROW = 8e3
"""Memory of a row besides the peaks: texts, numbers [bytes]."""

_COPIES = 2.0
"""Rows, and the Dataset made of them."""


class Structure(NamedTuple):
    """An analysis that many runs share, and the places of its numbers in their rows."""

    analysis: PreparedFrame
    layout: Layout
    bytes: float  # of a recorded step


class Runner:
    """The runs of `time_histories`, and the structures that they share.

    `recording` names the kept histories, besides the peaks of each run; None: none.
    """

    def __init__(
        self,
        models: Mapping[str, FrameData],
        motions: Mapping[str, GroundMotion],
        options: Mapping[str, Options],
        cases: Sequence[Case],
        features: Features,
        level: str | Mapping[str, str],
        recording: Recording | None,
    ) -> None:
        self.cases = cases
        self.motions, self.options = motions, options
        self.features, self.recording = features, recording
        self.models, self._level = models, level
        self._shared: dict[str, Structure | AnalysisError] = {}
        self._last: Structure | None = None
        self._left = Counter(case.model for case in cases)
        self._lock = threading.Lock()
        self._bytes, self._rows = 0.0, 0

    def worker(self, is_stopped: Callable[[], bool]) -> Worker:
        """Return the state of one thread; `is_stopped` returns True to stop."""
        return Worker(self, is_stopped)

    def structure(self, name: str) -> Structure | AnalysisError:
        """Return a structure, set up on first use, or the reason that it has no equilibrium."""
        with self._lock:
            if name not in self._shared:
                self._shared[name] = self._set_up(name)
            return self._shared[name]

    def done(self, name: str) -> None:
        """Release a structure when its last run is complete."""
        with self._lock:
            self._left[name] -= 1
            if not self._left[name]:
                self._shared.pop(name, None)

    def parts(self) -> tuple[Any, ...]:
        """Return the arguments of another runner of this kind."""
        given = self.models, self.motions, self.options, self.cases
        return *given, self.features, self._level, self.recording

    def hold(self, name: str) -> None:
        """Release all structures but this one."""
        self._shared = {key: found for key, found in self._shared.items() if key == name}

    def take(self, row: RunResult) -> None:
        """Count a run of another process."""
        with self._lock:
            self._count(1, len(row.reached))
            require_rows(_COPIES * self._bytes, self._rows, len(self.cases))
        self.done(self.cases[row.place].model)

    def _set_up(self, name: str) -> Structure | AnalysisError:
        recording = self.recording
        try:
            like = self._last and self._last.analysis
            found = PreparedFrame(self.models[name], self.features, self._level, like=like)
        except AnalysisError as failure:
            return failure
        if self._last is not None and self._last.analysis.template is found.template:
            self._last = self._last._replace(analysis=found)
        else:
            step = 0.0 if recording is None else bytes_over_time(reduced(found.at_rest, recording))
            self._last = Structure(found, _layout_of(found, recording), step)
        own = [case for case in self.cases if case.model == name]
        self._count(len(own), int(self._last.layout.starts[-1]))
        if recording is not None:
            steps = (self.options[case.motion].steps for case in own)
            every = recording.every
            kept = sum(count // every + 1 if every else 2 for count in steps)
            self._bytes += kept * self._last.bytes
        require_rows(_COPIES * self._bytes, self._rows, len(self.cases))
        return self._last

    def _count(self, rows: int, numbers: int) -> None:
        self._rows += rows
        self._bytes += rows * (_ROW + 8.0 * numbers)


def _layout_of(analysis: PreparedFrame, recording: Recording | None) -> Layout:
    # Template of each run's peaks; refuses names of a recording that its results lack.
    template = analysis.template
    if recording is not None:
        require_known(recording, analysis.at_rest)
    elif analysis.can_track:
        _ = analysis.shape  # formed once, not by each thread
    if recording is not None and recording.forces:
        variables, coordinates = ForceTracker(analysis.force_maps).variables()
        template = template.assign_coords(coordinates).assign(variables)
    return layout_of(template)


class Worker:
    """Runs of one thread; `is_stopped` returns True to stop."""

    def __init__(self, runner: Runner, is_stopped: Callable[[], bool]) -> None:
        self._runner, self._is_stopped = runner, is_stopped
        self._own: tuple[Structure, GravityState, PeakRecorder | None] | None = None

    def row(self, place: int) -> RunResult | None:
        """Run a case; None if it was stopped."""
        case = self._runner.cases[place]
        structure = self._runner.structure(case.model)
        if isinstance(structure, AnalysisError):
            row: RunResult | None = _without_rest(place, structure)
        else:
            row = self._run(place, case, structure)
        self._runner.done(case.model)
        return row

    def _run(self, place: int, case: Case, structure: Structure) -> RunResult | None:
        runner, analysis = self._runner, structure.analysis
        options = runner.options[case.motion]
        state, recorder = self._arrays(structure, options)
        motion = runner.motions[case.motion].scaled(case.scale)
        run = run_one(analysis, state, motion, options, recorder)
        if run.outcome.status is RunStatus.INTERRUPTED:
            return None
        data = run.judged
        note_end(data, *run.outcome)
        histories = None
        if runner.recording is not None and isinstance(recorder, Recorder):
            recorded = run.data if "time" in run.data.dims else recorder.recorded(data)
            histories = _histories(recorded, analysis.template)
        attrs = data.attrs
        done = int(state.run.clock["done"][0])
        return RunResult(
            place=place,
            status=attrs["status"],
            message=attrs["message"],
            failed_at=float(attrs.get("failed_at", math.nan)),
            failed_where=str(attrs.get("failed_where", "")),
            findings=run.findings,
            peaks=tuple(peaks_of(data)),
            numbers={name: float(attrs.get(name, math.nan)) for name in NUMBERS},
            energy=recorder.out.energy[done - recorder.first].copy(),
            reached=reached_row(data, structure.layout),
            layout=structure.layout,
            histories=histories,
        )

    def _arrays(
        self, structure: Structure, options: Options
    ) -> tuple[GravityState, PeakRecorder | Recorder]:
        # The state of this thread, at rest, and the arrays of its run.
        analysis = structure.analysis
        if self._own is None or self._own[0] is not structure:
            state, peaks = analysis.fresh(), None
            if analysis.can_track and self._runner.recording is None:
                peaks = self._own and self._own[2]
                if peaks is None or not peaks.serve(analysis, state):
                    peaks = PeakRecorder(analysis, state, self._is_stopped)
            self._own = structure, state, peaks
        else:
            analysis.restart(self._own[1])
        _, state, peaks = self._own
        return state, peaks or Recorder(
            analysis,
            state,
            options.steps,
            options.recording,
            is_stopped=self._is_stopped,
            every_peak=True,
        )


def _histories(recorded: xr.Dataset, template: xr.Dataset) -> xr.Dataset:
    # The histories of a run, and the places of the nodes, without which they cannot be drawn.
    known = {*template.data_vars, "nodes_of_level"} - {"node_position"}
    names = [name for name in recorded.data_vars if name not in known and not is_of_all_steps(name)]
    return recorded[names].drop_attrs(deep=False)


def _without_rest(place: int, failure: AnalysisError) -> RunResult:
    # A run of a structure that has no equilibrium to start from.
    return RunResult(
        place=place,
        status=failure.status.name.lower(),
        message=str(failure),
        failed_at=0.0,
        failed_where=failure.where,
        findings=Findings(),
        peaks=(),
        numbers={},
        energy=np.full(len(ENERGY_TERMS), np.nan),
        reached=np.zeros(0),
        layout=None,
        histories=None,
    )
