"""The level 'rigid_body': one bearing with its mass, as a time history."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.bundles.peak_data import ENERGY_TERMS
from frames.bundles.run_data import Ground, Output, output_arrays
from frames.recording.dataset import build_dataset, common_of, ground_at, peak_velocity
from frames.recording.recording import Recording, number_of_steps, require_known, require_memory
from frames.recording.reduction import reduced
from frames.results.assumption_checks import audit
from frames.results.findings import Findings
from frames.solve.outcome import Outcome, energy_status
from frames.statics.gravity import gravity
from lir_element.bundles.rigid_data import (
    DEFAULT_TOLERANCE,
    FIRST_STEP,
    RigidOutput,
    rigid_input,
    rigid_run,
    rigid_setup,
    stable_step,
)
from lir_element.device.bearing_checks import (
    AT_RIGID_BODY,
    require_constant_friction,
    require_no_backup,
)
from lir_element.element import limit_detail
from lir_element.errors import RunStatus
from lir_element.interruptible import interruptible, ready
from lir_element.kernels.rigid_body.integrate import integrate_bodies, start
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames._types import FloatArray, IntArray
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.statics.gravity_state import GravityState
    from lir_element.bundles.rigid_data import RigidInput, RigidRun, RigidSetup

LARGEST_STEP = 0.005
"""Largest time between outputs that the program chooses [s]."""

_TERMS = ("input", "gravity", "kinetic", "numerical")
_WORKS = {
    "high_friction": "work_interface",
    "friction_elastic": "work_elastic",
    "contact": "work_contact",
    "sliders": "work_sliders",
}


def rigid_time_history(
    model: FrameData,
    motion: GroundMotion,
    length: float,
    dt: float | None,
    *,
    integrator: str | None,
    tolerance: float | None,
    recording: Recording,
    progress: Callable[[float], None] | None,
) -> tuple[xr.Dataset, Outcome]:
    """Analyse one bearing with a mass on it as rigid bodies in contact."""
    if integrator not in (None, "explicit"):
        msg = f'integrator = {integrator!r}: level="rigid_body" has None (implicit) or "explicit"'
        raise ValueError(msg)
    if recording.forces:
        msg = (
            'recording.forces = True: at level="rigid_body" there is one bearing and no structure: '
            "leave it out, its forces are bearing_force and bearing_moment"
        )
        raise ValueError(msg)
    for link in model.bearings.values():
        require_constant_friction(link.bearing, AT_RIGID_BODY)
        require_no_backup(link.bearing, AT_RIGID_BODY)
    own_step = min(motion.dt, LARGEST_STEP)
    is_thinned = recording.every is None or recording != Recording(every=recording.every)
    record_every = 1 if is_thinned or recording.every is None else recording.every
    interval = record_every * (own_step if dt is None or integrator == "explicit" else dt)
    steps = number_of_steps(length, None if integrator == "explicit" else dt, interval)
    state = gravity(model, level="contact")
    require_memory(state, steps + 1)
    run = _prepare(state)
    explicit = _explicit_step(state, run, dt) if integrator == "explicit" else 0.0
    given, recorded = _input(state, motion, interval, steps + 1)
    chosen = DEFAULT_TOLERANCE if tolerance is None else tolerance
    length_scale = state.system.bearings[0].bearing.effective_radius
    largest = min(interval / record_every, motion.dt)
    setup = rigid_setup(length_scale, largest, tolerance=chosen, explicit=explicit)
    run.clock["step"] = min(FIRST_STEP, interval)
    if is_thinned:
        recorded.bodies["turn"][0] = (1.0, 0.0, 0.0, 0.0)  # at rest, until the run writes it
        require_known(recording, _dataset(model, motion, state, given, recorded, 1))
    status, seconds = _march(run, given, setup, progress)
    clock, counts = run.clock[0], run.counts[0]
    count = int(counts["outputs"])
    data = _dataset(model, motion, state, given, recorded, count)
    data.attrs |= {
        "title": worded("time history of {name}", name=model.name),
        "motion": motion.name,
        "level": "rigid_body",
        "method": "direct",
        "integrator": "explicit" if explicit else "bossak",
        "dt": float(explicit or interval / record_every),
        "step_control": "fixed" if explicit else "error",
        "tolerance": float(chosen),
        "steps": int(counts["steps"]),
        "refused_steps": int(counts["refused"]),
        "degrees_of_freedom": 12 + int(run.free[12:].sum()),
        "seconds_gravity": state.seconds,
        "seconds_loop": seconds,
        "plane_coupling": 0.0,
        "recording": str(Recording(every=record_every)),
    }
    findings = audit(data)
    where = f'bearing "{state.system.bearings[0].name}"'
    detail = limit_detail(run.props, run.states[2:], 0)
    if status is RunStatus.OK:
        status, detail, noted = energy_status(data)
        findings = Findings((*findings, *noted))
    data.attrs |= findings.attrs()
    if is_thinned:
        data = reduced(data.assign_attrs(recording=str(recording)), recording)
    return data, Outcome(status, float(clock["time"]), where, detail)


def _dataset(
    model: FrameData,
    motion: GroundMotion,
    state: GravityState,
    given: RigidInput,
    recorded: RigidOutput,
    count: int,
) -> xr.Dataset:
    # The first `count` outputs; an interrupted run is shorter.
    recorded = RigidOutput(*(part[:count] for part in recorded))
    ground = Ground(given.motion, given.motion_dt)
    out = _output(state, ground, given.times[:count], recorded)
    peak = peak_velocity(motion, float(out.time[-1]))
    states, bodies = recorded.states[:, None], recorded.bodies[:, None]
    return build_dataset(common_of(model, state), state, ground, peak, out, states, bodies, count)


def _march(
    run: RigidRun, given: RigidInput, setup: RigidSetup, progress: Callable[[float], None] | None
) -> tuple[RunStatus, float]:
    # The compiled loop in pieces, and its seconds.
    ready(start, run, given)
    ready(integrate_bodies, run, given, setup, 0, 0)
    began = perf_counter()
    start(run, given)

    def go(last: int, tries: int) -> int:
        return integrate_bodies(run, given, setup, last, tries)

    status = interruptible(go, lambda: int(run.counts["outputs"][0]), len(given.times), progress)
    return status, perf_counter() - began


def _prepare(state: GravityState) -> RigidRun:
    mass, inertia, free = _top_plate(state)
    if state.contacts is None:
        msg = "the equilibrium is not at the level 'contact'"
        raise AssertionError(msg)
    return rigid_run(
        state.model.props, state.contacts, state.run.old.copy(), mass, inertia, free, driven=False
    )


def _input(
    state: GravityState, motion: GroundMotion, interval: float, count: int
) -> tuple[RigidInput, RigidOutput]:
    # Input of the run, and its output arrays.
    node = state.system.bearings[0].j
    load = np.tile(state.system.node_load[6 * node : 6 * node + 6], (count, 1))
    times = np.arange(count, dtype=np.float64) * interval
    return rigid_input((motion.components, motion.dt), times, np.zeros((count, 2)), load)


def _top_plate(state: GravityState) -> tuple[FloatArray, FloatArray, IntArray]:
    # Mass, inertia and free degrees of freedom of the node above; refuses anything else.
    system = state.system
    message = ""
    if len(system.bearings) != 1:
        message = f"it has {len(system.bearings)} bearings, but one is needed"
    elif system.stiffness.nnz and np.abs(system.stiffness.data).max() > 0.0:
        message = "it has members or springs; only a mass on a bearing is supported"
    elif len(system.parts.kind):
        message = "it has links or hinges; only a mass on a bearing is supported"
    elif system.damping.nnz:
        message = "it has a damping matrix; only a mass on a bearing is supported"
    rows = system.bearing_rows.toarray()
    if not message and rows[:6].any():
        message = "node i of its bearing is not fixed"
    if not message and len(state.basis.bearing_dofs) != rows.shape[1]:
        message = "it has degrees of freedom away from its bearing"
    if message:
        msg = (
            f'level = "rigid_body" does not support this model: {message}. Use '
            'level="contact" or lumped_mass(bearing, mass)'
        )
        raise ModelError(msg)
    free: IntArray = np.array([row.any() for row in rows[6:]], dtype=np.int64)
    node = system.bearings[0].j
    masses = system.node_mass[node]
    lacking = [name for a, name in enumerate("xyzxyz") if free[a] and not masses[a] > 0.0]
    if lacking:
        msg = (
            f'level = "rigid_body": node "{system.node_names[node]}" is free but has no mass or '
            f"rotational inertia along or about {lacking[0]}: give it with add_mass, or fix it"
        )
        raise ModelError(msg)
    return np.where(masses[:3] > 0.0, masses[:3], 1.0), masses[3:].copy(), free


def _explicit_step(state: GravityState, run: RigidRun, explicit: float | None) -> float:
    load = 4.0 * float(np.abs(state.system.load).sum())
    limit = stable_step(run.sliders, run.props, load)
    if explicit is None:
        return limit
    if explicit > 2.0 * limit:
        msg = (
            f"dt = {explicit:g} s is too large for the explicit mode: at most {2.0 * limit:.3g} s "
            "is stable with these sliders and contacts; take less, or leave dt out"
        )
        raise ValueError(msg)
    return float(explicit)


def _accelerations(
    state: GravityState, ground: Ground, times: FloatArray, force: FloatArray
) -> FloatArray:
    # Acceleration of the top plate (n, 3), relative to the ground: of the forces at the same
    # instant. The scheme's own belong to a place within its step.
    node = state.system.bearings[0].j
    load = state.system.node_load[6 * node : 6 * node + 3]
    mass = state.system.node_mass[node, :3]
    total = (load - force) / np.where(mass > 0.0, mass, np.inf)
    return np.asarray(total - ground_at(ground, times))


def _output(
    state: GravityState, ground: Ground, times: FloatArray, recorded: RigidOutput
) -> Output:
    states, bodies, energy = recorded
    out, _, _ = output_arrays(state.model, None, len(times))
    rows = state.system.bearing_rows.toarray()[6:]
    dofs = [int(np.flatnonzero(rows[:, k])[0]) for k in state.basis.bearing_dofs]
    plate = np.concatenate([bodies["velocity"][:, 2], bodies["spin"][:, 2]], axis=1)
    moves = _accelerations(state, ground, times, states["force"][:, 6:9])
    rates = np.concatenate([moves, bodies["spin_rate"][:, 2]], axis=1)
    out.time[:] = times
    out.b[:] = states["displacement"][:, 6:][:, dofs]
    out.v_b[:], out.a_b[:] = plate[:, dofs], rates[:, dofs]
    for k, term in enumerate(ENERGY_TERMS):
        if term in _TERMS:
            out.energy[:, k] = energy[term]
        elif term in _WORKS:
            out.energy[:, k] = states[_WORKS[term]] - states[_WORKS[term]][0]  # against rest
    places = {term: k for k, term in enumerate(ENERGY_TERMS)}
    out.energy[:, places["low_friction_bottom"]] = states["work_friction"][:, 0]
    out.energy[:, places["low_friction_top"]] = states["work_friction"][:, 1]
    out.energy[:, places["rims"]] = states["work_rim"].sum(axis=1)
    return out
