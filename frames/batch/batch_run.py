"""One run among many: in arrays that its thread uses again and again, to a row of numbers."""

from __future__ import annotations

import math
import threading
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.batch.batch_dataset import NUMBERS, Layout, RunResult, reached_row
from frames.batch.workspace import PeakRecorder, Structure, Workspace, set_up
from frames.peak_data import ENERGY_TERMS
from frames.recording.recorder import Recorder
from frames.recording.recording import Recording
from frames.recording.reduction import judgeable_of
from frames.recording.size import require_rows
from frames.results.assumption_checks import doubts_of
from frames.results.peaks import peaks_of
from frames.results.recorded import REACHED
from frames.solve.outcome import concluded, ended
from frames.solve.time_history import begin, estimated_error, ground_of, integrate, settings_of
from lir_element.errors import AnalysisError, RunStatus
from lir_element.results.dataset import note_end

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr

    from frames._types import FloatArray
    from frames.batch.cases import Case
    from frames.kernel_data import IntegratorSettings
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.solve.options import Options
    from frames.statics.gravity import GravityState
    from lir_element.device.features import Features


_ROW = 8e3
"""Memory of a row besides what was reached: texts, peaks [bytes]."""

_COPIES = 2.0
"""Rows, and the Dataset made of them."""


class Kept(NamedTuple):
    """What is kept of each run besides what it reached."""

    recording: Recording
    histories: bool


class _Ended(NamedTuple):
    # A run: how it ended, what the assumption check reads, energy at the end, what is recorded
    # besides.
    data: xr.Dataset
    energy: FloatArray
    histories: xr.Dataset | None


class Runner:
    """The runs of `time_histories`, and the structures that they share.

    Parameters
    ----------
    models, motions, options : mapping
        Structures, motions, and the options of the runs under each motion, by name.
    cases : sequence of Case
        The runs.
    features : Features
        What is modelled.
    level : str or mapping
        Levels of the bearings.
    kept : Kept
        What is kept of each run.
    """

    def __init__(
        self,
        models: Mapping[str, FrameData],
        motions: Mapping[str, GroundMotion],
        options: Mapping[str, Options],
        cases: Sequence[Case],
        features: Features,
        level: str | Mapping[str, str],
        kept: Kept,
    ) -> None:
        self.cases = cases
        self.motions, self.options = motions, options
        self.features, self.kept = features, kept
        self._models, self._level = models, level
        self._shared: dict[str, Structure | AnalysisError] = {}
        self._left = {name: 0 for name in models}
        for case in cases:
            self._left[case.model] += 1
        self._lock = threading.Lock()
        self._bytes, self._rows = 0.0, 0

    def worker(self, is_stopped: Callable[[], bool]) -> Worker:
        """Return what one thread runs with; `is_stopped` says whether to leave off."""
        return Worker(self, is_stopped)

    def structure(self, name: str) -> Structure | AnalysisError:
        """Return a structure, set up by the first who asks, or why it has no equilibrium."""
        with self._lock:
            if name not in self._shared:
                self._shared[name] = self._set_up(name)
            return self._shared[name]

    def done(self, name: str) -> None:
        """Let go of a structure when its last run is done."""
        with self._lock:
            self._left[name] -= 1
            if not self._left[name]:
                self._shared.pop(name, None)

    def _set_up(self, name: str) -> Structure | AnalysisError:
        recording = self.kept.recording if self.kept.histories else None
        try:
            found = set_up(self._models[name], self.features, self._level, recording)
        except AnalysisError as failure:
            return failure
        own = [case for case in self.cases if case.model == name]
        self._rows += len(own)
        self._bytes += len(own) * (_ROW + 8.0 * float(found.layout.starts[-1]))
        if recording is not None:
            steps = (self.options[case.motion].steps for case in own)
            every = recording.every
            kept = sum(count // every + 1 if every else 2 for count in steps)
            self._bytes += kept * found.step_bytes
        require_rows(_COPIES * self._bytes, self._rows, len(self.cases))
        return found


class Worker:
    """One thread's runs.

    Parameters
    ----------
    runner : Runner
        What is run.
    is_stopped : callable
        Whether to leave off.
    """

    def __init__(self, runner: Runner, is_stopped: Callable[[], bool]) -> None:
        self._runner, self._is_stopped = runner, is_stopped
        self._workspace: Workspace | None = None
        self._recorder: PeakRecorder | None = None

    def row(self, place: int) -> RunResult | None:
        """Run a case; None where it was stopped."""
        case = self._runner.cases[place]
        structure = self._runner.structure(case.model)
        if isinstance(structure, AnalysisError):
            row: RunResult | None = _without_rest(place, structure)
        else:
            run = self._run(case, self._own(structure))
            row = None if run is None else _row_of(place, run, structure.layout)
        self._runner.done(case.model)
        return row

    def _own(self, structure: Structure) -> Workspace:
        if self._workspace is None or self._workspace.structure is not structure:
            self._workspace, self._recorder = Workspace(structure), None
        return self._workspace

    def _run(self, case: Case, workspace: Workspace) -> _Ended | None:
        runner, state, structure = self._runner, workspace.reset(), workspace.structure
        options = runner.options[case.motion]
        motion = runner.motions[case.motion].scaled(case.scale)
        settings = settings_of(state, options)
        ground = ground_of(motion, runner.features, settings)
        recorder: PeakRecorder | _Recorder
        if structure.gauges is None or runner.kept.histories:
            recorder = _Recorder(
                structure.model,
                motion,
                state,
                ground,
                options.steps,
                options.recording,
                structure.maps,
            )
            recorder.is_stopped = self._is_stopped
        else:
            recorder = self._recorder or PeakRecorder(workspace, self._is_stopped)
            recorder.renew(motion, ground)
            self._recorder = recorder
        begin(state, ground, settings)
        code, seconds = integrate(state, settings, ground, recorder, options)
        if code is RunStatus.INTERRUPTED:
            return None
        end = ended(state, code)
        return self._judged(recorder, state, end, structure, options, settings, seconds)

    def _judged(
        self,
        recorder: PeakRecorder | _Recorder,
        state: GravityState,
        end: tuple[RunStatus, str],
        structure: Structure,
        options: Options,
        settings: IntegratorSettings,
        seconds: float,
    ) -> _Ended:
        # What became of a run, as `time_history` judges it.
        counts, done = state.run.counts[0], int(state.run.clock["done"][0])
        data = recorder.data(done).assign_attrs(
            structure.template.attrs,
            integrator=options.integrator,
            dt=float(options.base),
            seconds_loop=seconds,
            step_control="error" if math.isfinite(settings.error_tolerance) else "fixed",
            estimated_error=estimated_error(state, settings),
            **recorder.strains.attrs(),
        )
        energy = recorder.out.energy[done - recorder.first].copy()
        whole, data = data, judgeable_of(data) if "time" in data.dims else data
        outcome = concluded(data, state, end)
        note_end(data, *outcome)
        data.attrs |= {name: int(counts[name]) for name in ("steps", "halvings")}
        histories = None
        if self._runner.kept.histories and isinstance(recorder, _Recorder):
            recorded = whole if "time" in whole.dims else recorder.recorded(data)
            histories = _histories(recorded, structure.template)
        return _Ended(data, energy, histories)


class _Recorder(Recorder):
    # One that leaves off when it is told to.

    is_stopped: Callable[[], bool]

    def room(self, done: int) -> int:
        if self.is_stopped():
            raise KeyboardInterrupt
        return super().room(done)


def _histories(recorded: xr.Dataset, template: xr.Dataset) -> xr.Dataset:
    # The histories of a run, and the places of the nodes, without which they cannot be drawn.
    known = {*template.data_vars, "nodes_of_level"} - {"node_position"}
    names = [
        name
        for name in recorded.data_vars
        if name not in known and not str(name).startswith(REACHED)
    ]
    return recorded[names].drop_attrs(deep=False)


def _row_of(place: int, run: _Ended, layout: Layout) -> RunResult:
    # A run as numbers.
    attrs = run.data.attrs
    return RunResult(
        place=place,
        status=attrs["status"],
        message=attrs["message"],
        failed_at=float(attrs.get("failed_at", math.nan)),
        failed_where=str(attrs.get("failed_where", "")),
        audit=attrs["audit"],
        doubts="; ".join(doubts_of(run.data)),
        peaks=tuple(peaks_of(run.data)),
        numbers={name: float(attrs.get(name, math.nan)) for name in NUMBERS},
        energy=run.energy,
        reached=reached_row(run.data, layout),
        layout=layout,
        histories=run.histories,
    )


def _without_rest(place: int, failure: AnalysisError) -> RunResult:
    # A run of a structure that has no equilibrium to start from.
    return RunResult(
        place=place,
        status=failure.status.name.lower(),
        message=str(failure),
        failed_at=0.0,
        failed_where=failure.where,
        audit="",
        doubts="",
        peaks=(),
        numbers={},
        energy=np.full(len(ENERGY_TERMS), np.nan),
        reached=np.zeros(0),
        layout=None,
        histories=None,
    )
