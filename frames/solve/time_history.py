"""Time history analysis: gravity first, then the compiled time loop, then the Dataset."""

from __future__ import annotations

import math
import warnings
from time import perf_counter
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from frames._errors import AuditWarning
from frames._fingerprint import motion_digest
from frames._provenance import provenance
from frames.kernel_data import MOST_HALVINGS, Ground, IntegratorSettings
from frames.kernels.integration import integrate_chunk, record
from frames.motion.resampling import seen_by_steps
from frames.recording.recorder import Recorder
from frames.recording.recording import recording_of
from frames.results.assumption_checks import doubts_of
from frames.solve.level_escalation import escalate_level, mark_other_end
from frames.solve.options import Options, check_options, check_reduction, options_of
from frames.solve.outcome import Outcome, concluded, ended
from frames.solve.progress_line import share_told
from frames.solve.rigid import LARGEST_STEP, rigid_time_history
from frames.statics.basis_refinement import refined
from frames.statics.blas_threads import blas_threads_for
from frames.statics.equilibrium import force_tolerance
from frames.statics.kept_equilibria import kept_gravity
from frames.statics.model_traits import exact_features, plane_coupling
from frames.statics.sanity_checks import check_analysis
from lir_element.device.features import Features
from lir_element.errors import RunStatus
from lir_element.interruptible import interruptible, ready
from lir_element.results.dataset import report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.kernel_data import Output, ReducedModel
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.recording.recording import Recording
    from frames.results.peak_response import Extreme
    from frames.statics.gravity import GravityState

_FORCE_TOLERANCE = 1e-7  # of the total weight
_MAX_ITERATIONS = 25
_ERROR_TOLERANCE = 1e-3  # of histories over the displacement reached, where the program chooses
_HALVED_FROM = 5e-4  # tolerance below whose half the largest step is halved, below a fourth twice
_ERROR_SHARE = 0.045  # of what a lasting force does to the pendulum: it does not last (calibrated)
_ERROR_TIME = 8.0  # times sqrt(L / g), over which what rings gets out of phase (calibrated)
_ERROR_EVENT = 1.5e-3  # s, step below which an error of force counts as an impulse (calibrated)
_SMALLEST_REACH = 1e-3  # of the effective radius: what counts as reached from the start
_ERROR_VERTICAL = 0.1  # share of a vertical error, which friction passes on, while pressed
_ERROR_OPEN = 1.0  # share of it off the ground
_PRODUCT = 3e-4  # cost of a multiplication over that of a bearing's state determination (measured)
_SERVES = 5.0  # steps that a new tangent serves (measured)
_SECANTS_SAVE = 2.5  # of what bearings share of a tangent, by secants (measured)
_ENERGY_TOLERANCE = 2e-4  # of the energy moved, that contacts may make or lose in a step
_ENERGY_FLOOR = 1e-6  # of weight times effective radius


def time_history(
    model: FrameData,
    motion: GroundMotion,
    duration: float | None = None,
    dt: float | None = None,
    level: str | Mapping[str, str] = "pendulum",
    method: Literal["direct", "reduced"] = "direct",
    *,
    integrator: Literal["newmark", "generalised-alpha", "explicit"] | None = None,
    spectral_radius: float = 0.8,
    tolerance: float | None = None,
    reduction_tolerance: float | None = None,
    record_every: int = 1,
    recording: Recording | None = None,
    on_failure: Literal["warn", "raise"] = "warn",
    features: Features | None = None,
    progress: Callable[[float], None] | bool | None = None,
) -> xr.Dataset:
    """Analyse a frame on bearings under a ground motion.

    Parameters
    ----------
    model : Frame
        The structure and its bearings. It is brought into equilibrium under its permanent loads
        first; their axial forces enter the bearings.
    motion : GroundMotion
        Acceleration of the ground, up to three components.
    duration : float, optional
        Length of the analysis [s]; that of the motion if None. Beyond it the ground rests.
    dt : float, optional
        Step [s]. None: the step of the motion, or its largest whole part of at most 0.005 s,
        halved wherever the estimated error asks for it. A given step is halved only where Newton's
        method fails, or where a contact that opens or closes would make or lose energy.
    level : {"pendulum", "contact", "rigid_body"} or mapping
        Level of fidelity of the bearings: one for all, or by name of bearing ("pendulum" for
        those that it does not name). "rigid_body" takes one bearing with a mass on it. "auto":
        the cheapest that is sufficient; the analysis is run, checked for its assumptions, and run
        again with what was missing.
    method : {"direct", "reduced"}
        "direct": all degrees of freedom. "reduced": the bearings' ones and few load-dependent
        vectors of the structure, in a run with few and runs with more, until two agree: for
        structures whose modes are many beside their bearings (docs/choices.md).
    integrator : {None, "newmark", "generalised-alpha", "explicit"}
        Time integration. None is Newmark's average acceleration, which conserves energy;
        "generalised-alpha" that of Chung and Hulbert (1993). At the level "rigid_body" None is
        Bossak's implicit method, and "explicit" takes small equal steps of `dt`.
    spectral_radius : float
        Of the generalised-alpha method at infinite frequency [-], in [0, 1]; 1 takes nothing out.
    tolerance : float, optional
        Error that the bearings' displacement histories may have, over the displacement reached,
        where the program controls it: 1e-3 by default. Between 5e-5 and 5e-4 the error is within a
        factor of three of it (docs/choices.md). At the level "rigid_body" that of a step over the
        effective radius: 1e-8.
    reduction_tolerance : float, optional
        Of the method "reduced": largest difference of two runs in the peaks of bearing
        displacement and base shear, 1e-3 by default; ten times that in axial forces, floor
        accelerations in plan, storey drifts and yielding parts, a hundred times in vertical
        accelerations. What is larger in the end is named by a line of the assumption check.
    record_every : int
        Record every so many base steps: ``Recording(every=record_every)``.
    recording : Recording, optional
        What is recorded: steps, variables, bearings, nodes, windows around impacts, extremes;
        everything if None. Not together with `record_every`. The assumption check, `peaks` and the
        energy balance see all base steps, whatever is recorded. At the level "rigid_body"
        memory is taken for all of them while it runs, and with `every` alone only the recorded ones
        are seen.
    on_failure : {"warn", "raise"}
        A run that fails hands back what was computed, with a warning and its reason in the
        attributes; or raises AnalysisError, whose `data` holds the same.
    features : Features, optional
        What is modelled; everything if None. The assumption check tells whether what was left out
        mattered. Not together with ``level="auto"``, which chooses for itself.
    progress : callable or bool, optional
        Called with the share done (0 to 1) some fifty times; True writes a bar to the standard
        error, in a notebook too.

    Returns
    -------
    xarray.Dataset
        See docs/results.md. Attributes hold status, message, versions, options, timings and the
        assumption check: for each feature left out whether it mattered, with a number. A run whose
        energy balance is open by more than 0.1 % of the input has the status "inaccurate"
        and warns; what "generalised-alpha" takes out may reach 1 %, and is named by a warning from
        0.1 % on. An AuditWarning tells of a completed run in whose assumption check a line begins
        with "!".

    Raises
    ------
    ValueError
        If an option is out of bounds.
    frames.ModelError
        If the model cannot work.
    lir_element.AnalysisError
        If there is no equilibrium under gravity, or (with ``on_failure="raise"``) a run fails.
    lir_element.AnalysisInterrupted
        After Ctrl-C, a KeyboardInterrupt whose `data` holds what was computed. A plain
        KeyboardInterrupt before the first step.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, lumped_mass, time_history
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> data.attrs["status"], round(float(abs(data["bearing_displacement"]).max()), 2)
    ('ok', 0.24)
    """
    check_analysis(model, motion)
    check_options(level, method, integrator, on_failure, features)
    check_reduction(method, level, reduction_tolerance)
    wanted, told = recording_of(recording, record_every), share_told(progress)
    options = options_of(
        motion,
        duration,
        dt,
        method=method,
        integrator=integrator,
        spectral_radius=spectral_radius,
        tolerance=tolerance,
        recording=wanted,
        progress=told,
        reduction=reduction_tolerance,
    )
    if level == "rigid_body":
        data, outcome = rigid_time_history(
            model,
            motion,
            options.duration,
            dt,
            integrator=integrator,
            tolerance=tolerance,
            recording=wanted,
            progress=told,
        )
        return _told(report(data, *outcome, on_failure=on_failure))
    outcomes: list[Outcome] = []
    recorders: list[Recorder] = []

    def analyse(kept: Features, at: str | Mapping[str, str]) -> xr.Dataset:
        recorders.clear()  # of an earlier run: its memory
        with blas_threads_for(model):
            data, outcome, recorder = _run(model, motion, kept, at, options)
        outcomes.append(outcome)
        recorders.append(recorder)
        if outcome[0] is RunStatus.INTERRUPTED:  # no further run of level="auto"
            report(recorder.recorded(data), *outcome, on_failure=on_failure)
        return data

    if level == "auto":
        data = escalate_level(analyse, exact_features(model, motion))
        mark_other_end(data, [(outcome[0], outcome[1]) for outcome in outcomes])
    else:
        data = analyse(Features.all() if features is None else features, level)
    data = recorders[-1].recorded(data)
    return _told(report(data, *outcomes[-1], on_failure=on_failure))


def _told(data: xr.Dataset) -> xr.Dataset:
    # Warns of what the assumption check of a completed run marks.
    doubts = doubts_of(data)
    if doubts and "failed_at" not in data.attrs:
        what = "completed with a warning: " + "; ".join(doubts)
        warnings.warn(what, AuditWarning, stacklevel=3)
    return data


class StepWriter(Protocol):
    """Where a run writes its steps, such as a `Recorder`."""

    out: Output
    first: int
    seconds: float

    def begin(self) -> None:
        """Record the state at rest."""

    def room(self, done: int) -> int:
        """Return the last base step that there is room for."""
        ...


def _run(
    model: FrameData,
    motion: GroundMotion,
    features: Features,
    level: str | Mapping[str, str],
    options: Options,
) -> tuple[xr.Dataset, Outcome, Recorder]:
    # One run and its assumption check; what is recorded joins it in the end.
    attrs = {
        "title": f"time history of {model.name}",
        "motion": motion.name,
        "level": level if isinstance(level, str) else str(dict(level)),
        "features_left_out": ", ".join(features.left_out) or "none",
        "plane_coupling": 0.0 if features.second_direction else plane_coupling(model),
        "motion_digest": motion_digest(motion),
        **provenance(dated=False),
    }
    if options.method == "direct":
        return _run_from(kept_gravity(model, features, level), model, motion, options, attrs)
    runs: list[tuple[xr.Dataset, Outcome, Recorder]] = []

    def run(state: GravityState) -> tuple[dict[str, Extreme], bool]:
        runs[:] = [_run_from(state, model, motion, options, attrs)]
        data, outcome, recorder = runs[0]
        return recorder.reached(data), outcome.status is RunStatus.INTERRUPTED

    found = refined(model, features, level, options.reduction, run)
    data, outcome, recorder = runs[0]
    data.attrs |= found.attrs
    if found.doubt:
        data.attrs["audit"] += f"\n! reduced: two runs differ by more than asked for: {found.doubt}"
    return data, outcome, recorder


def _run_from(
    state: GravityState,
    model: FrameData,
    motion: GroundMotion,
    options: Options,
    attrs: dict[str, object],
) -> tuple[xr.Dataset, Outcome, Recorder]:
    # One run from a state at rest.
    features = state.system.features
    settings = settings_of(state, options)
    tolerance = settings.error_tolerance
    ground = ground_of(motion, features, settings)
    recorder = Recorder(model, motion, state, ground, options.steps, options.recording)
    begin(state, ground, settings)
    code, seconds = integrate(state, settings, ground, recorder, options)
    end = ended(state, code)
    counts = state.run.counts[0]
    data = recorder.data(int(state.run.clock["done"][0]))
    data.attrs = (
        attrs
        | recorder.strains.attrs()
        | {
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
            "seconds_loop": seconds,
        }
    )
    seen = recorder.judgeable(data)
    seen.attrs = data.attrs
    outcome = concluded(seen, state, end)
    data.attrs = seen.attrs
    return data, outcome, recorder


def settings_of(state: GravityState, options: Options) -> IntegratorSettings:
    """Return the constants of the time integration."""
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
        tangent_worth=_tangent_worth(state.model),
        shared_worth=_shared_worth(state.model),
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
        first=0,
    )


def estimated_error(state: GravityState, settings: IntegratorSettings) -> float:
    """Return the estimated error of a run's displacement histories over the largest reached [-]."""
    clock = state.run.clock[0]
    return float(clock["worst"] / max(clock["reach"], 1e-6 * settings.smallest_reach))


def _least_halvings(base: float, tolerance: float) -> int:
    # Of the base step: small tolerances get small steps, whatever the estimate says.
    if not tolerance <= 0.5 * _HALVED_FROM:
        return 0
    largest = LARGEST_STEP * 0.5 ** math.floor(math.log2(_HALVED_FROM / tolerance) + 1e-9)
    wanted = math.ceil(math.log2(base / largest) - 1e-9)
    return min(max(wanted, 0), MOST_HALVINGS // 2)


def _tangent_worth(model: ReducedModel) -> float:
    # Cost of a new tangent in iterations with a kept one, over the steps that it serves.
    bearings, unknowns = len(model.props), len(model.load_b)
    new = bearings + _PRODUCT * unknowns**3 / 3.0
    kept = bearings + _PRODUCT * unknowns**2
    return max(new / kept - 1.0, 0.0) / _SERVES


def _shared_worth(model: ReducedModel) -> float:
    # The same of what bearings share of it. Secants of the corrections make up for much of it.
    if not len(model.shared):
        return _tangent_worth(model)
    bearings, unknowns = len(model.props), len(model.load_b)
    kept = bearings + _PRODUCT * unknowns**2
    return _SECANTS_SAVE * (bearings + _PRODUCT * len(model.shared) * unknowns**2) / kept


def ground_of(motion: GroundMotion, features: Features, settings: IntegratorSettings) -> Ground:
    """Return a motion as the loop integrates it: along the directions that are modelled."""
    shaking = motion if features.second_direction else motion.scaled([1.0, 0.0, 1.0])
    return Ground(*seen_by_steps(shaking, settings.dt))


def begin(state: GravityState, ground: Ground, settings: IntegratorSettings) -> None:
    """Set the accelerations at rest: the ground's first value acts on what has mass."""
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
    ready(record, model, run, contacts, parts, ground, out, 0)
    recorder.begin()
    began = perf_counter()

    def go(last: int, trials: int) -> int:
        here = settings._replace(first=recorder.first)
        return integrate_chunk(model, run, contacts, parts, here, ground, out, last, trials)

    def done() -> int:
        return int(run.clock["done"][0])

    status = interruptible(
        go, done, options.steps, options.progress, room=lambda: recorder.room(done())
    )
    return status, perf_counter() - began - recorder.seconds
