"""Storage of a run's steps: all of them, or a buffer that is emptied as it fills."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from frames.bundles.nonlinear_data import part_sizes
from frames.bundles.run_data import output_arrays
from frames.recording.dataset import build_dataset, ground_at, peak_velocity
from frames.recording.force_tracking import ForceTracker, StrainGauge
from frames.recording.nonlinear_results import NonlinearPeaks
from frames.recording.peak_tracking import PeakTracker
from frames.recording.recording import (
    bytes_of_step,
    bytes_over_time,
    memory,
    require_known,
    require_memory,
    require_room,
)
from frames.recording.reduction import (
    PeakState,
    Reduction,
    present_quantities,
    put_peak_state,
    without_histories_of,
)
from frames.results.peak_response import largest, with_exceeded
from frames.statics.resultants import Plausibility

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames.bundles.run_data import Ground, Output
    from frames.motion.ground_motion import GroundMotion
    from frames.recording.recording import Recording
    from frames.results.peak_response import Extreme
    from frames.solve.analysis import PreparedFrame
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records

BUFFER = 64e6
"""Memory of the steps between two emptyings, their Dataset included [bytes]."""

LEAST_ROWS = 16
"""Steps that a buffer holds at least."""

PEAK_BYTES, MOST_ROWS = 6e6, 1024
"""Memory [bytes] and steps if peaks alone are kept: they must fit into the processor's cache."""


class Gauges:
    """Peaks of a run, found from the records of its loop, without any Dataset.

    Without `whole`, the structure above the bearings is left out.
    """

    def __init__(self, analysis: PreparedFrame, *, whole: bool) -> None:
        state = analysis.state
        self._bearings = PeakTracker(analysis.devices, analysis.shape if whole else None)
        self._parts = NonlinearPeaks(state, analysis.model)
        self._sums = Plausibility(state, analysis.common.resultants)

    def take(self, out: Output, states: Records, ground: Ground, first: int, last: int) -> None:
        """Add rows first <= k < last of the recorded steps, which follow those before."""
        self._bearings.take(states, out, ground, first, last)
        self._parts.take(out, first, last)
        shaking = ground_at(ground, out.time[first:last])
        self._sums.take(out, states, shaking, first, last)

    def reached(self) -> dict[str, Extreme]:
        """Return the largest values, by quantity."""
        return self._bearings.reached() | self._parts.reached() | self._sums.reached()

    def peak_state(self, out: Output, states: Records, last: int) -> PeakState:
        """Return all peaks up to a row of the recorded steps, and the residual values there."""
        row = states[last]
        moved = row["displacement"][:, 6:8] - row["displacement"][:, :2]
        left = {
            "displacement": np.linalg.norm(moved, axis=-1),
            "slip": np.linalg.norm(row["slip_total"], axis=-1),
        }
        left |= self._parts.left(out, last)
        return PeakState(self.reached(), self._bearings.totals(), left, float(out.time[last]))


class _Buffer:
    # The arrays that the loop writes into; the last `overlap` of full ones stay.

    overlap = 1

    def __init__(
        self,
        analysis: PreparedFrame,
        state: GravityState,
        rows: int,
        is_stopped: Callable[[], bool] | None,
    ) -> None:
        self._analysis, self._state, self._rows = analysis, state, rows
        self._is_stopped = is_stopped
        self.out, self._states, self._bodies = output_arrays(
            state.model, state.contacts, rows, part_sizes(state.parts)
        )
        self.strains = StrainGauge(analysis.model, state)
        """Strains of imported members that may yield."""

    def renew(self, motion: GroundMotion, ground: Ground) -> None:
        """Make ready for a run under `motion`, which the loop integrates as `ground`."""
        self._motion, self._ground = motion, ground
        self.first = 0
        """Base step in the first row of `out`."""
        self.seconds = 0.0
        """Time of emptying [s]."""
        self.strains.reset()

    def begin(self) -> None:
        """Begin with the state at rest, which is recorded."""

    def room(self, done: int) -> int:
        """Return the last base step that there is room for; a full buffer is emptied first."""
        if self._is_stopped is not None and self._is_stopped():
            raise KeyboardInterrupt
        last = self.first + self._rows - 1
        if done < last:
            return last
        began, rows, kept = perf_counter(), done - self.first + 1, self.overlap
        self._empty(rows)
        for array in self.out:
            array[:kept] = array[rows - kept : rows]
        self.first = done + 1 - kept  # last: an interruption before leaves all to be recorded
        self.seconds += perf_counter() - began
        return self.first + self._rows - 1

    def _empty(self, rows: int) -> None:
        # Record the first rows, as far as they are new.
        raise NotImplementedError


class Recorder(_Buffer):
    """Storage of a run's records, and their result.

    It refuses names of a recording that the result lacks, and records beyond the memory. With
    `every_peak` a run that records everything is checked by all of its quantities.
    """

    overlap = 2  # for values formed over neighbours

    def __init__(
        self,
        analysis: PreparedFrame,
        state: GravityState,
        steps: int,
        recording: Recording,
        *,
        is_stopped: Callable[[], bool] | None = None,
        every_peak: bool = False,
    ) -> None:
        self._recording, self._steps, self._every_peak = recording, steps, every_peak
        self._is_whole = recording.is_everything
        rows = steps + 1
        if self._is_whole:
            require_memory(state, rows)
        else:
            rows = min(rows, max(LEAST_ROWS, int(BUFFER / bytes_of_step(state))))
        super().__init__(analysis, state, rows, is_stopped)
        self._reduction = Reduction(recording)
        self._forces = ForceTracker(analysis.force_maps) if recording.forces else None

    def begin(self) -> None:
        """Refuse a recording that is not possible."""
        recording = self._recording
        if self._is_whole:
            return
        count = self._steps // recording.every + 1 if recording.every else 2
        if not recording.names and BUFFER + count * bytes_of_step(self._state) < memory():
            return
        start = self._dataset(1)
        require_known(recording, start)
        reduction = Reduction(recording)
        reduction.take(start, 0, final=True)
        row = reduction.recorded(reduction.without_histories())
        require_room(bytes_over_time(row), count, BUFFER)

    def data(self, done: int) -> xr.Dataset:
        """Return the result of `done` base steps, or the input of the assumption check."""
        rows = done - self.first + 1
        self.strains.take(self.out, 0, rows)
        data = self._dataset(rows, kept=self._is_whole)
        if self._is_whole:
            return data
        self._reduction.take(data, self.first, final=True)
        judged = self._reduction.without_histories()
        if self._forces is None:
            return judged
        self._forces.take(self._states, self.out, self.first, rows)
        variables, coordinates = self._forces.variables()
        return judged.assign_coords(coordinates).assign(variables)

    def without_histories(self, data: xr.Dataset) -> xr.Dataset:
        """Return the assumption check's input from a result of `data`."""
        if self._is_whole and self._every_peak:
            return without_histories_of(data)
        if not self._is_whole or not self._analysis.can_track:
            return data
        count = data.sizes["time"]
        found = self._peaks_compiled(count, whole=False).peak_state(
            self.out, self._states, count - 1
        )
        judged = self._analysis.judged(data, found)
        peak = data.variables["peak_ground_velocity"].values
        return put_peak_state(judged.copy(), found, peak, self._analysis.common.variables)

    def reached(self, data: xr.Dataset) -> dict[str, Extreme]:
        """Return the largest values of all quantities of a result that `data` gave, by name."""
        if not self._is_whole or not self._analysis.can_track:
            return {name: largest(data, name) for name in present_quantities(data)}
        return self._peaks_compiled(data.sizes["time"], whole=True).reached()

    def recorded(self, judged: xr.Dataset) -> xr.Dataset:
        """Return the result, once: `data` with the records of the run and the given attributes."""
        return judged if self._is_whole else with_exceeded(self._reduction.recorded(judged))

    def _peaks_compiled(self, count: int, *, whole: bool) -> Gauges:
        gauges = Gauges(self._analysis, whole=whole)
        gauges.take(self.out, self._states, self._ground, 0, count)
        return gauges

    def _empty(self, rows: int) -> None:
        if self._forces is not None:
            self._forces.take(self._states, self.out, self.first, rows)
        self.strains.take(self.out, 0, rows)
        self._reduction.take(self._dataset(rows), self.first, final=False)

    def _dataset(self, count: int, *, kept: bool = False) -> xr.Dataset:
        return build_dataset(
            self._analysis.common,
            self._state,
            self._ground,
            peak_velocity(self._motion, float(self.out.time[count - 1])),
            self.out,
            self._states,
            self._bodies,
            count,
            kept=kept,
        )


class PeakRecorder(_Buffer):
    """Peaks of one run after the other; keeps no steps."""

    def __init__(
        self, analysis: PreparedFrame, state: GravityState, is_stopped: Callable[[], bool]
    ) -> None:
        size = int(PEAK_BYTES / bytes_of_step(state))
        super().__init__(analysis, state, min(max(size, LEAST_ROWS), MOST_ROWS), is_stopped)
        self._judged = analysis.template.copy()

    def serve(self, analysis: PreparedFrame, state: GravityState) -> bool:
        """Switch to runs of another analysis, if their steps need the same storage."""
        own = self._state
        if _sizes(own) != _sizes(state):
            return False
        if analysis.template is not self._analysis.template:
            self._judged = analysis.template.copy()
        self._analysis, self._state = analysis, state
        self.strains = StrainGauge(analysis.model, state)
        return True

    def renew(self, motion: GroundMotion, ground: Ground) -> None:
        """Make ready for a run under `motion`, which the loop integrates as `ground`."""
        super().renew(motion, ground)
        self._taken = 0
        self._gauges = Gauges(self._analysis, whole=True)

    def data(self, done: int) -> xr.Dataset:
        """Return the assumption check's input of the run, until the next one begins."""
        rows = done - self.first + 1
        self._empty(rows)
        found = self._gauges.peak_state(self.out, self._states, rows - 1)
        peak = peak_velocity(self._motion, found.until)
        return put_peak_state(self._judged, found, peak, self._analysis.common.variables)

    def without_histories(self, data: xr.Dataset) -> xr.Dataset:
        """Return the assumption check's input from a result of `data`."""
        return data

    def _empty(self, rows: int) -> None:
        first = self._taken - self.first
        self._gauges.take(self.out, self._states, self._ground, first, rows)
        self.strains.take(self.out, first, rows)
        self._taken = self.first + rows


def _sizes(state: GravityState) -> tuple[object, ...]:
    # Shape of the arrays that steps are written to.
    model = state.model
    own = len(model.load_b), len(model.load_e), len(model.props)
    return *own, state.contacts is None, part_sizes(state.parts)
