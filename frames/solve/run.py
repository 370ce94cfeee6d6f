"""One run of an analysis: constants of the time integration, the compiled loop, its results."""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from frames._fingerprint import motion_digest
from frames._provenance import provenance
from frames.bundles.run_data import CORRECTED, MOST_HALVINGS, Ground, IntegratorSettings
from frames.kernels.integration import integrate_chunk
from frames.motion.ground_motion import seen_by_steps
from frames.solve.outcome import Outcome, final_status, loop_status
from frames.solve.rigid import LARGEST_STEP
from frames.statics.equilibrium import force_tolerance
from lir_element.errors import RunStatus
from lir_element.interruptible import interruptible, ready

if TYPE_CHECKING:
    import xarray as xr

    from frames.bundles.model_data import ReducedModel
    from frames.bundles.run_data import Output
    from frames.motion.ground_motion import GroundMotion
    from frames.recording.force_tracking import StrainGauge
    from frames.results.findings import Findings
    from frames.solve.analysis import PreparedFrame
    from frames.solve.options import Options
    from frames.statics.gravity_state import GravityState
    from lir_element.device.features import Features

_FORCE_TOLERANCE = 1e-7  # of the total weight
_MAX_ITERATIONS = 25
_ERROR_TOLERANCE = 1e-3  # error of histories over the peak displacement, if the program chooses
_HALVED_FROM = 5e-4  # tolerance below whose half the largest step is halved, below a fourth twice
_ERROR_SHARE = 0.045  # of a lasting force's effect on the pendulum: it ends (calibrated)
_ERROR_TIME = 8.0  # times sqrt(L / g), time in which vibrations get out of phase (calibrated)
_ERROR_EVENT = 1.5e-3  # s, step below which an error of force counts as an impulse (calibrated)
_SMALLEST_REACH = 1e-3  # of the effective radius: least peak displacement
_ERROR_VERTICAL = 0.1  # share of a vertical error, which friction passes on, while pressed
_ERROR_OPEN = 1.0  # share of it off the ground
_PRODUCT = 3e-4  # cost of a multiplication over that of a bearing's state determination (measured)
_PART = 0.5  # cost of a part that may yield over that of a bearing (measured)
_SERVES = 2.0  # steps for which a new tangent is better than secants (measured)
_SECANTS_SAVE = 2.5  # factor on the bearings' share of a tangent, by secants (measured)
_ENERGY_TOLERANCE = 2e-4  # of the energy moved, that contacts may make or lose in a step
_ENERGY_FLOOR = 1e-6  # of weight times effective radius


NOT_CORRECTED = (
    f'integrator = "{CORRECTED}" needs links or hinges, and damping by modes or '
    'stiffness, not by a matrix: use integrator="newmark" with a smaller dt'
)


class StepWriter(Protocol):
    """Storage of a run's steps: a `Recorder`, a `PeakRecorder`."""

    out: Output
    first: int
    seconds: float
    strains: StrainGauge

    def renew(self, motion: GroundMotion, ground: Ground) -> None:
        """Make ready for a run under `motion`, which the loop integrates as `ground`."""

    def begin(self) -> None:
        """Begin with the state at rest, which is recorded."""

    def room(self, done: int) -> int:
        """Return the last base step that there is room for."""
        ...

    def data(self, done: int) -> xr.Dataset:
        """Return the result of `done` base steps, or the input of the assumption check."""
        ...

    def without_histories(self, data: xr.Dataset) -> xr.Dataset:
        """Return the assumption check's input from a result of `data`."""
        ...


class Run(NamedTuple):
    """Results of a run."""

    data: xr.Dataset
    """Result, or the checked part if histories are reduced."""
    judged: xr.Dataset
    """Input of the assumption check; the same attributes."""
    outcome: Outcome
    findings: Findings


def run_one(
    analysis: PreparedFrame,
    state: GravityState,
    motion: GroundMotion,
    options: Options,
    recorder: StepWriter,
) -> Run:
    """Run an analysis from a state at rest, which is changed, and check the results."""
    settings = settings_of(state, options)
    ground = ground_of(motion, analysis.features, settings)
    recorder.renew(motion, ground)
    begin(state, ground, settings)
    code, seconds = integrate(state, settings, ground, recorder, options)
    end = loop_status(state, code)
    data = recorder.data(int(state.run.clock["done"][0]))
    data.attrs = {
        **analysis.attrs,
        "motion": motion.name,
        "motion_digest": motion_digest(motion),
        **provenance(dated=False),
        **recorder.strains.attrs(),
        **_attrs(state, settings, options),
        "seconds_loop": seconds,
    }
    judged = recorder.without_histories(data)
    judged.attrs = dict(data.attrs)
    outcome, findings = final_status(judged, state, end)
    data.attrs = dict(judged.attrs)
    return Run(data, judged, outcome, findings)


def _attrs(
    state: GravityState, settings: IntegratorSettings, options: Options
) -> dict[str, object]:
    # Options of a run, and the counts of its loop.
    counts, tolerance = state.run.counts[0], settings.error_tolerance
    return {
        "recording": str(options.recording),
        "method": options.method,
        "integrator": options.integrator,
        "spectral_radius": options.spectral_radius,
        "dt": float(options.base),
        "step_control": "error" if math.isfinite(tolerance) else "fixed",
        "tolerance": tolerance if math.isfinite(tolerance) else math.nan,
        "estimated_error": estimated_error(state, settings),
        "steps": int(counts["steps"]),
        "newton_iterations": int(counts["iterations"]),
        "halvings": int(counts["halvings"]),
        "state_determinations": int(counts["trials"]),
        "tangents": int(counts["tangents"]),
        "shared_tangents": int(counts["shared_tangents"]),
        "degrees_of_freedom": int(state.system.mass.shape[0]),
        "modes": len(state.run.e),
        "seconds_gravity": state.seconds,
    }


def settings_of(state: GravityState, options: Options) -> IntegratorSettings:
    """Return the constants of the time integration."""
    if options.integrator == CORRECTED and not can_correct(state):
        raise ValueError(NOT_CORRECTED)
    alpha_m, alpha_f = 0.0, 0.0
    radius = options.spectral_radius
    if options.integrator == "generalised-alpha":
        alpha_m, alpha_f = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    length = min(placed.bearing.effective_radius for placed in state.system.bearings)
    tolerance = _ERROR_TOLERANCE if options.tolerance is None else options.tolerance
    return IntegratorSettings(
        dt=float(options.base),
        alpha_m=float(alpha_m),
        alpha_f=float(alpha_f),
        beta=float(0.25 * (1.0 - alpha_m + alpha_f) ** 2),
        gamma=float(0.5 - alpha_m + alpha_f),
        force_tolerance=float(force_tolerance(state.system, _FORCE_TOLERANCE)),
        max_iterations=_MAX_ITERATIONS,
        tangent_worth=_tangent_worth(state.model, len(state.system.parts.kind)),
        shared_worth=_shared_worth(state.model, len(state.system.parts.kind)),
        energy_tolerance=_ENERGY_TOLERANCE,
        energy_floor=float(_ENERGY_FLOOR * length * np.abs(state.system.load).sum()),
        error_tolerance=float(tolerance),
        smallest_reach=float(_SMALLEST_REACH * length),
        error_flexibility=float(_ERROR_SHARE * length / state.system.gravity),
        error_time=float(_ERROR_TIME * math.sqrt(length / state.system.gravity)),
        error_event=float(_ERROR_EVENT),
        least_halvings=_least_halvings(options.base, tolerance),
        error_vertical=float(_ERROR_VERTICAL),
        error_open=float(_ERROR_OPEN),
        corrects=int(options.integrator == CORRECTED),
        first=0,
    )


def can_correct(state: GravityState) -> bool:
    """Return whether steps of a structure can have their impulses corrected."""
    return state.parts is not None and not state.model.damping_ee.size


def estimated_error(state: GravityState, settings: IntegratorSettings) -> float:
    """Return the estimated error of a run's displacement histories over the largest reached [-]."""
    clock = state.run.clock[0]
    return float(clock["worst"] / max(clock["reach"], 1e-6 * settings.smallest_reach))


def _least_halvings(base: float, tolerance: float) -> int:
    # Error of the base step: small tolerances get small steps, for any estimate.
    if not tolerance <= 0.5 * _HALVED_FROM:
        return 0
    largest = LARGEST_STEP * 0.5 ** math.floor(math.log2(_HALVED_FROM / tolerance) + 1e-9)
    wanted = math.ceil(math.log2(base / largest) - 1e-9)
    return min(max(wanted, 0), MOST_HALVINGS // 2)


def _tangent_worth(model: ReducedModel, parts: int) -> float:
    # Cost of a new tangent in iterations with a kept one, over the steps that it serves.
    bearings, unknowns = len(model.props), len(model.load_b)
    kept = bearings + _PART * parts + _PRODUCT * unknowns**2
    more = bearings + _PRODUCT * (unknowns**3 / 3.0 - unknowns**2)
    return max(more / kept, 0.0) / _SERVES


def _shared_worth(model: ReducedModel, parts: int) -> float:
    # The bearings' share of it. Secants of the corrections reduce it.
    if not len(model.shared):
        return _tangent_worth(model, parts)
    bearings, unknowns = len(model.props), len(model.load_b)
    kept = bearings + _PRODUCT * unknowns**2
    return _SECANTS_SAVE * (bearings + _PRODUCT * len(model.shared) * unknowns**2) / kept


def ground_of(motion: GroundMotion, features: Features, settings: IntegratorSettings) -> Ground:
    """Return a motion as the loop integrates it: along the directions that are modelled."""
    shaking = motion if features.second_direction else motion.scaled([1.0, 0.0, 1.0])
    return Ground(*seen_by_steps(shaking, settings.dt))


def begin(state: GravityState, ground: Ground, settings: IntegratorSettings) -> None:
    """Set the accelerations at rest: the ground's first value acts on the masses."""
    run, basis = state.run, state.basis
    first = ground.acceleration[0]
    acceleration = basis.shaken @ first if first.any() else np.zeros(len(run.b) + len(run.e))
    n_b = len(run.b)
    run.a_b[:], run.a_e[:] = acceleration[:n_b], acceleration[n_b:]
    for record_of in (run.clock, run.counts, run.energy):
        record_of[:] = np.zeros(1, dtype=record_of.dtype)
    elastic = 0.5 * (run.b @ basis.stiffness_b @ run.b + basis.omega2 @ run.e**2)
    run.clock["elastic_start"] = elastic
    damps = abs(settings.alpha_m) + abs(settings.alpha_f) > 0.0
    run.balanced[0] = int(damps)
    if damps:
        run.balance[:] = basis.mobility
        run.held[:] = basis.stiffness_b @ run.b
    run.push[:] = run.old["force"][:, 6:9]
    run.carried[:] = np.maximum(state.axial_forces, 1e-3 * state.axial_forces.max())
    run.carried[:] /= state.system.gravity


def integrate(
    state: GravityState,
    settings: IntegratorSettings,
    ground: Ground,
    recorder: StepWriter,
    options: Options,
) -> tuple[RunStatus, float]:
    """Run the compiled loop in pieces, to its end, a failure, or Ctrl-C; return its seconds too."""
    model, run, contacts, parts = state.model, state.run, state.contacts, state.parts
    out = recorder.out
    ready(integrate_chunk, model, run, contacts, parts, settings, ground, out, 0, 0)

    def go(last: int, trials: int) -> int:
        here = settings._replace(first=recorder.first)
        return integrate_chunk(model, run, contacts, parts, here, ground, out, last, trials)

    def done() -> int:
        return int(run.clock["done"][0])

    go(0, 0)
    recorder.begin()
    began = perf_counter()
    status = interruptible(
        go, done, options.steps, options.progress, room=lambda: recorder.room(done())
    )
    return status, perf_counter() - began - recorder.seconds
