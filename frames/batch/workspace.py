"""A structure set up once for many runs, and what each thread needs of its own to run it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.batch.batch_dataset import Layout, layout_of
from frames.kernel_data import Ground, output_arrays
from frames.kernels.integration import record
from frames.nonlinear_data import part_sizes
from frames.recording.dataset import build_dataset, ground_at, peak_velocity
from frames.recording.force_rows import force_maps
from frames.recording.peak_tracking import PeakTracker, can_track, devices_of, places_of, shape_of
from frames.recording.recording import require_known
from frames.recording.reduction import Findings, judgeable_of, reduced, with_other_findings
from frames.recording.size import bytes_of_step, bytes_over_time
from frames.recording.trackers import ForceTracker, PartGauge, StrainGauge
from frames.results.peak_response import Extreme
from frames.statics.fresh_runs import restart, with_own_arrays
from frames.statics.gravity import gravity
from frames.statics.model_traits import plane_coupling
from frames.statics.resultants import Plausibility

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.peak_data import Devices, Shape
    from frames.recording.force_rows import ForceMaps
    from frames.recording.recording import Recording
    from frames.statics.gravity import GravityState
    from lir_element.device.features import Features

ROWS_BYTES = 6e6
"""Memory of the steps between two emptyings [bytes]: they shall be found in the processor's own."""

FEWEST_ROWS, MOST_ROWS = 16, 1024


class Structure(NamedTuple):
    """A frame in equilibrium under gravity, which many runs start from; none of them changes it."""

    model: FrameData
    state: GravityState
    template: xr.Dataset
    """What the assumption check reads of a run, of the state at rest alone."""
    layout: Layout
    step_bytes: float
    """Memory of one recorded step of the histories that are kept [bytes]."""
    gauges: tuple[Devices, Shape] | None
    """None where what is reached has to be read off Datasets."""
    maps: ForceMaps | None = None
    """How forces follow from what is recorded, where their extremes are kept."""


def set_up(
    model: FrameData,
    features: Features,
    level: str | Mapping[str, str],
    recording: Recording | None = None,
) -> Structure:
    """Bring a structure into equilibrium, once for all of its runs."""
    coupling = 0.0 if features.second_direction else plane_coupling(model)
    state = gravity(model, features, level)
    out, states, bodies = output_arrays(state.model, state.contacts, 1, part_sizes(state.parts))
    still = Ground(np.zeros((2, 3)), 1.0)
    record(state.model, state.run, state.contacts, state.parts, still, out, 0)
    first = build_dataset(model, state, still, np.zeros(3), out, states, bodies, 1)
    left_out = ", ".join(features.left_out) or "none"
    first = first.assign_attrs(features_left_out=left_out)
    if recording is not None:
        require_known(recording, first)
    template, maps = judgeable_of(first), None
    if recording is not None and recording.forces:
        maps = force_maps(model, state)
        forces = ForceTracker(maps)
        forces.take(states, out, 0, 1)
        variables, coordinates = forces.variables()
        template = template.assign_coords(coordinates).assign(variables)
    template.attrs |= {
        "plane_coupling": coupling,
        "level": level if isinstance(level, str) else str(dict(level)),
    }
    size = 0.0 if recording is None else bytes_over_time(reduced(first, recording))
    structure = Structure(model, state, template, layout_of(template), size, None, maps)
    if not can_track(state):
        return structure
    gauges = devices_of(state), shape_of(state, places_of(template))
    return structure._replace(gauges=gauges)


class Workspace:
    """A run of a structure in arrays of its own, used by one thread again and again.

    Parameters
    ----------
    structure : Structure
        What is run.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.state = with_own_arrays(structure.state, structure.state.seconds)

    def reset(self) -> GravityState:
        """Return the state under gravity, in this workspace's arrays."""
        restart(self.state, self.structure.state)
        return self.state


class PeakRecorder:
    """Takes up what a run reaches, and keeps no step of it: the `Recorder` of many runs.

    Parameters
    ----------
    workspace : Workspace
        Of the run; its structure has gauges.
    is_stopped : callable
        Whether the run is to stop: asked some thirty times a second.
    """

    def __init__(self, workspace: Workspace, is_stopped: Callable[[], bool]) -> None:
        state = self._state = workspace.state
        self._structure, self._is_stopped = workspace.structure, is_stopped
        size = int(ROWS_BYTES / bytes_of_step(state))
        self._rows = min(max(size, FEWEST_ROWS), MOST_ROWS)
        self.out, self._states, _ = output_arrays(
            state.model, None, self._rows, part_sizes(state.parts)
        )
        self.strains = StrainGauge(self._structure.model, state)
        self.seconds = 0.0

    def renew(self, motion: GroundMotion, ground: Ground) -> None:
        """Make ready for a run under `motion`, which the loop integrates as `ground`."""
        if self._structure.gauges is None:
            msg = "what such a run reaches is read off its Dataset"
            raise AssertionError(msg)
        self._motion, self._ground = motion, ground
        self.first, self._taken = 0, 0
        self.strains.reset()
        self._gauge = PeakTracker(*self._structure.gauges)
        self._parts = PartGauge(self._structure.state, self._structure.model)
        rest = self._structure.state
        self._whole = Plausibility(rest, rest.resultants)

    def begin(self) -> None:
        """Record the state at rest."""
        state = self._state
        record(state.model, state.run, None, state.parts, self._ground, self.out, 0)

    def room(self, done: int) -> int:
        """Return the last base step that there is room for; a full buffer is taken up first."""
        if self._is_stopped():
            raise KeyboardInterrupt
        if done >= self.first + self._rows - 1:
            self._take(done)
            for array in self.out:  # its last step: what is left may be asked for
                array[0] = array[done - self.first]
            self.first = done
        return self.first + self._rows - 1

    def findings(self, done: int) -> Findings:
        """Return what the run reached in `done` base steps."""
        self._take(done)
        last = done - self.first
        row = self._states[last]
        moved = row["displacement"][:, 6:8] - row["displacement"][:, :2]
        left = {
            "displacement": np.linalg.norm(moved, axis=-1),
            "slip": np.linalg.norm(row["slip_total"], axis=-1),
        }
        reached: dict[str, Extreme] = self._gauge.reached() | self._parts.reached()
        reached |= self._whole.reached()
        left |= self._parts.left(self.out, last)
        until = float(self.out.time[last])
        return Findings(reached, self._gauge.totals(), left, until)

    def data(self, done: int) -> xr.Dataset:
        """Return what the assumption check reads of the run."""
        found = self.findings(done)
        peak = peak_velocity(self._motion, found.until)
        return with_other_findings(self._structure.template, found, peak)

    def _take(self, done: int) -> None:
        first, last = self._taken - self.first, done + 1 - self.first
        self._gauge.take(self._states, self.out, self._ground, first, last)
        self._parts.take(self.out, first, last)
        self.strains.take(self.out, first, last)
        shaking = ground_at(self._ground, self.out.time[first:last])
        self._whole.take(self.out, self._states, shaking, first, last)
        self._taken = done + 1
