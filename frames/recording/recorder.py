"""Where a run writes its steps: room for all of them, or a buffer that is emptied as it fills."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

from frames.kernel_data import output_arrays
from frames.kernels.integration import record
from frames.nonlinear_data import part_sizes
from frames.recording.dataset import build_dataset, ground_at, peak_velocity
from frames.recording.force_rows import force_maps
from frames.recording.peak_tracking import PeakTracker, can_track, devices_of, places_of, shape_of
from frames.recording.recording import require_known
from frames.recording.reduction import (
    Findings,
    Reduction,
    present_quantities,
    with_findings,
    with_other_findings,
)
from frames.recording.size import (
    bytes_of_step,
    bytes_over_time,
    memory,
    require_memory,
    require_room,
)
from frames.recording.trackers import ForceTracker, PartGauge, StrainGauge
from frames.results.formulas import in_plan
from frames.results.peak_response import largest, with_exceeded
from frames.statics.fresh_runs import once
from frames.statics.resultants import Plausibility

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.kernel_data import Ground
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.peak_data import Shape
    from frames.recording.force_rows import ForceMaps
    from frames.recording.recording import Recording
    from frames.results.peak_response import Extreme
    from frames.statics.gravity import GravityState

BUFFER = 64e6
"""Memory of the steps between two emptyings, their Dataset included [bytes]."""

LEAST_ROWS = 16
"""Steps that the buffer holds at least."""

_OVERLAP = 2  # steps that stay for what is formed over neighbours


class Recorder:
    """What a run records into, and the result made of it.

    Raises
    ------
    ValueError
        If the recording names what there is not, or would not fit into memory.
    """

    def __init__(
        self,
        model: FrameData,
        motion: GroundMotion,
        state: GravityState,
        ground: Ground,
        steps: int,
        recording: Recording,
        maps: ForceMaps | None = None,
    ) -> None:
        self._model, self._motion, self._state, self._ground = model, motion, state, ground
        self._recording, self._steps = recording, steps
        self._is_whole = recording.is_everything
        rows = steps + 1
        if self._is_whole:
            require_memory(state, rows)
        else:
            rows = min(rows, max(LEAST_ROWS, int(BUFFER / bytes_of_step(state))))
        self.out, self._states, self._bodies = output_arrays(
            state.model, state.contacts, rows, part_sizes(state.parts)
        )
        self._rows = rows
        self._reduction = Reduction(recording)
        self._forces = ForceTracker(maps or force_maps(model, state)) if recording.forces else None
        self.strains = StrainGauge(model, state)
        """Of imported members that may yield."""
        self.first = 0
        """Base step in the first row of `out`."""
        self.seconds = 0.0
        """Time taken by emptying [s]."""

    def begin(self) -> None:
        """Record the state at rest, and refuse what cannot be recorded."""
        state = self._state
        record(state.model, state.run, state.contacts, state.parts, self._ground, self.out, 0)
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
        row = reduction.recorded(reduction.judgeable())
        require_room(bytes_over_time(row), count, BUFFER)

    def room(self, done: int) -> int:
        """Return the last base step that there is room for; a full buffer is emptied first."""
        last = self.first + self._rows - 1
        if done < last:
            return last
        began = perf_counter()
        rows = done - self.first + 1
        self._take_forces(rows)
        self.strains.take(self.out, 0, rows)
        self._reduction.take(self._dataset(rows), self.first, final=False)
        for array in self.out:
            array[:_OVERLAP] = array[rows - _OVERLAP : rows]
        self.first = done + 1 - _OVERLAP  # last: an interruption before leaves all to be taken up
        self.seconds += perf_counter() - began
        return self.first + self._rows - 1

    def data(self, done: int) -> xr.Dataset:
        """Return the result of `done` base steps, or what the assumption check reads of it."""
        self.strains.take(self.out, 0, done - self.first + 1)
        data = self._dataset(done - self.first + 1, kept=self._is_whole)
        if self._is_whole:
            return data
        self._reduction.take(data, self.first, final=True)
        judged = self._reduction.judgeable()
        if self._forces is None:
            return judged
        self._take_forces(done - self.first + 1)
        variables, coordinates = self._forces.variables()
        return judged.assign_coords(coordinates).assign(variables)

    def judgeable(self, data: xr.Dataset) -> xr.Dataset:
        """Return what the assumption check reads of a result that `data` gave."""
        if not self._is_whole or not can_track(self._state):
            return data
        count = data.sizes["time"]
        reached, totals = self._gauged(count)
        u = self._states["displacement"][count - 1]
        left = {"displacement": in_plan(u[:, 6:8] - u[:, :2])}
        found = Findings(reached, totals, left, float(self.out.time[count - 1]))
        judged = once(self._state, "judged", lambda: with_findings(data.drop_dims("time"), found))
        return with_other_findings(judged, found, data.variables["peak_ground_velocity"].values)

    def reached(self, data: xr.Dataset) -> dict[str, Extreme]:
        """Return the largest values of all quantities of a result that `data` gave, by name."""
        if not self._is_whole or not can_track(self._state):
            return {name: largest(data, name) for name in present_quantities(data)}
        return self._gauged(data.sizes["time"], shape_of(self._state, places_of(data)))[0]

    def _gauged(
        self, count: int, shape: Shape | None = None
    ) -> tuple[dict[str, Extreme], dict[str, FloatArray]]:
        # What the first rows reached, and their totals; with a shape, the structure's too.
        devices = once(self._state, "gauged devices", lambda: devices_of(self._state))
        gauge = PeakTracker(devices, shape)
        parts = PartGauge(self._state, self._model)
        gauge.take(self._states, self.out, self._ground, 0, count)
        parts.take(self.out, 0, count)
        whole = Plausibility(self._state, self._state.resultants)
        shaking = ground_at(self._ground, self.out.time[:count])
        whole.take(self.out, self._states, shaking, 0, count)
        return gauge.reached() | parts.reached() | whole.reached(), gauge.totals()

    def recorded(self, judged: xr.Dataset) -> xr.Dataset:
        """Return the result, once: `data` with what the run records and the attributes given."""
        return judged if self._is_whole else with_exceeded(self._reduction.recorded(judged))

    def _take_forces(self, count: int) -> None:
        if self._forces is not None:
            self._forces.take(self._states, self.out, self.first, count)

    def _dataset(self, count: int, *, kept: bool = False) -> xr.Dataset:
        peak = peak_velocity(self._motion, float(self.out.time[count - 1]))
        data = build_dataset(
            self._model,
            self._state,
            self._ground,
            peak,
            self.out,
            self._states,
            self._bodies,
            count,
            kept=kept,
        )
        left_out = self._state.system.features.left_out
        data.attrs["features_left_out"] = ", ".join(left_out) or "none"
        return data
