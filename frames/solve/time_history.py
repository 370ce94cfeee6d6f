"""Time history analysis: gravity first, then the compiled time loop, then the Dataset."""

from __future__ import annotations

import warnings
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from frames._errors import AuditWarning
from frames.recording.recording import recording_of
from frames.results.assumption_checks import asking_for_contact
from frames.results.findings import Findings, doubts_of, findings_of, remark
from frames.solve.analysis import Analysis, analysis_of
from frames.solve.options import Options, check_options, check_reduction, options_of
from frames.solve.progress_line import share_told
from frames.solve.recorder import Recorder
from frames.solve.rigid import rigid_time_history
from frames.solve.run import Run, run_one
from frames.statics.basis_refinement import refined
from frames.statics.blas_threads import blas_threads_for
from frames.statics.sanity_checks import check_analysis
from frames.statics.springs import exact_features
from lir_element.device.features import Features
from lir_element.errors import RunStatus
from lir_element.results.dataset import report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr

    from frames.results.findings import Finding
    from lir_element import Features

    Level = str | Mapping[str, str]
    """One for all bearings, or "contact" by name: the others are at the level "pendulum"."""
    from collections.abc import Mapping

    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion
    from frames.recording.recording import Recording
    from frames.results.peak_response import Extreme
    from frames.statics.gravity import GravityState

MOST_RUNS = 5
"""Features and level settle in two or three runs; this bounds what each run may reveal anew."""


def escalate_level(
    analyse: Callable[[Features, Level], xr.Dataset], features: Features
) -> xr.Dataset:
    """Run with `features`, and again with what was missing."""
    level: Level = "pendulum"
    lines: list[str] = []
    for count in range(1, MOST_RUNS + 1):
        began = perf_counter()
        data = analyse(features, level)
        seconds = perf_counter() - began
        findings = findings_of(data)
        names = tuple(str(name) for name in data.variables["bearing"].to_numpy())
        wider, higher, reason = _next(findings, features, level, names)
        is_last = count == MOST_RUNS or (wider, higher) == (features, level)
        out = ", ".join(features.left_out) or "nothing"
        at = (
            level if isinstance(level, str) else f"{len(level)} of {len(names)} bearings at contact"
        )
        lines.append(f"run {count}: {at}, left out {out}, {seconds:.3f} s: {reason}")
        if is_last:
            break
        features, level = wider, higher
    data.attrs["auto_runs"] = "\n".join(lines)
    return data


def mark_other_end(data: xr.Dataset, ends: Sequence[tuple[RunStatus, float]]) -> None:
    """Say in the check of a result of `escalate_level` that an earlier run ended otherwise."""
    last, time = ends[-1]
    others = [
        k for k, (status, _) in enumerate(ends[:-1]) if status.is_complete != last.is_complete
    ]
    if not others:
        return
    first, earlier = ends[others[-1]]
    line = (
        f"ends: run {others[-1] + 1} {_ended(first, earlier)}, run {len(ends)} "
        f"{_ended(last, time)} (auto_runs): a little more or less decides whether a bearing fails"
    )
    noted = remark("ends", float(others[-1] + 1), line, doubtful=True)
    data.attrs |= Findings((noted, *findings_of(data))).attrs()
    data.attrs["auto_runs"] += f"\n{line}"


def _ended(status: RunStatus, time: float) -> str:
    how = "completed" if status.is_complete else f"stopped ({status.name.lower()})"
    return f"{how} at t = {time:.4g} s"


def _next(
    findings: tuple[Finding, ...], features: Features, level: Level, names: tuple[str, ...]
) -> tuple[Features, Level, str]:
    # Features and level of the next run (the same: settled), and why.
    out = features.left_out
    missing = [f for f in findings if f.is_missing and f.feature in out]
    if missing:
        wider = features.including(*(f.feature for f in missing))
        if wider.rims and not features.rims:  # a rigid slider would break the rims that are met
            wider = wider.including("interface")
        return wider, level, "again, for " + "; ".join(f.sentence for f in missing)
    asking = asking_for_contact(findings)
    if not asking:
        return features, level, "sufficient"
    raised = _raised(level, names, {name for found in asking for name in found.bearings})
    who = "all bearings" if raised == "contact" else ", ".join(raised)
    why = "; ".join(f.sentence for f in asking)
    return features, raised, f"again with {who} at the level 'contact': {why}"


def _raised(level: Level, names: tuple[str, ...], asked: set[str]) -> Level:
    # The level with more bearings at "contact".
    at_contact = asked if isinstance(level, str) else asked | set(level)
    chosen = {name: "contact" for name in names if name in at_contact}
    return "contact" if len(chosen) == len(names) else chosen


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
    runs: list[tuple[Run, Recorder]] = []
    ends: list[tuple[RunStatus, float]] = []

    def analyse(kept: Features, at: str | Mapping[str, str]) -> xr.Dataset:
        runs.clear()  # of an earlier run: its memory
        with blas_threads_for(model):
            runs.append(_run(model, motion, kept, at, options))
        run, recorder = runs[0]
        data, outcome = run.data, run.outcome
        data.attrs |= run.findings.attrs()
        ends.append((outcome.status, outcome.time))
        if outcome.status is RunStatus.INTERRUPTED:  # no further run of level="auto"
            report(recorder.recorded(data), *outcome, on_failure=on_failure)
        return data

    if level == "auto":
        data = escalate_level(analyse, exact_features(model, motion))
        mark_other_end(data, ends)
    else:
        data = analyse(Features.all() if features is None else features, level)
    run, recorder = runs[0]
    return _told(report(recorder.recorded(data), *run.outcome, on_failure=on_failure))


def _told(data: xr.Dataset) -> xr.Dataset:
    # Warns of what the assumption check of a completed run marks.
    doubts = doubts_of(data)
    if doubts and "failed_at" not in data.attrs:
        what = "completed with a warning: " + "; ".join(doubts)
        warnings.warn(what, AuditWarning, stacklevel=3)
    return data


def _run(
    model: FrameData,
    motion: GroundMotion,
    features: Features,
    level: str | Mapping[str, str],
    options: Options,
) -> tuple[Run, Recorder]:
    # One run, or those of the method "reduced"; what is recorded joins its result in the end.
    def run(analysis: Analysis, state: GravityState) -> tuple[Run, Recorder]:
        recorder = Recorder(analysis, state, options.steps, options.recording)
        return run_one(analysis, state, motion, options, recorder), recorder

    if options.method == "direct":
        return run(*analysis_of(model, features, level))
    last: list[tuple[Run, Recorder]] = []

    def reached(state: GravityState) -> tuple[dict[str, Extreme], bool]:
        last.clear()  # its memory
        analysis = Analysis(model, features, level, state)
        last.append(run(analysis, analysis.fresh()))
        found, recorder = last[0]
        return recorder.reached(found.data), found.outcome.status is RunStatus.INTERRUPTED

    found = refined(model, features, level, options.reduction, reached)
    last_run, recorder = last[0]
    last_run.data.attrs |= found.attrs
    if found.doubt:
        text = f"reduced: two runs differ by more than asked for: {found.doubt}"
        noted = remark("reduced", found.attrs["reduction_tolerance"], text, doubtful=True)
        last_run = last_run._replace(findings=Findings((*last_run.findings, noted)))
    return last_run, recorder
