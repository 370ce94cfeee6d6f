"""Time history analysis: gravity first, then the compiled time loop, then the Dataset."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Literal

from frames._errors import AuditWarning
from frames._progress_line import share_told
from frames.model.frame_data import FrameData
from frames.recording.recording import recording_of
from frames.results.findings import Findings, doubts_of, remark
from frames.solve.analysis import PreparedFrame, analysis_of
from frames.solve.escalation import escalate_level, mark_other_end
from frames.solve.options import METHODS, Options, check_options, check_reduction, options_of
from frames.solve.recorder import Recorder
from frames.solve.rigid import rigid_time_history
from frames.solve.run import Run, run_one
from frames.statics.basis_refinement import refined
from frames.statics.blas_threads import blas_threads_for
from frames.statics.sanity_checks import check_analysis
from frames.statics.springs import exact_features
from lir_element.argument_checks import require_type
from lir_element.device.features import Features
from lir_element.errors import RunStatus
from lir_element.results.dataset import report
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from frames.motion.ground_motion import GroundMotion
    from frames.recording.recording import Recording
    from frames.results.peak_response import Extreme
    from frames.solve.outcome import Outcome
    from frames.statics.gravity_state import GravityState


def time_history(
    model: FrameData,
    motion: GroundMotion,
    duration: float | None = None,
    dt: float | None = None,
    level: str | Mapping[str, str] = "pendulum",
    method: Literal["direct", "reduced"] = "direct",
    *,
    integrator: Literal["newmark", "corrected-newmark", "generalised-alpha", "explicit"]
    | None = None,
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
        Step [s]. None: the step of the motion, or its largest whole part of at most 0.005 s, halved
        if the estimated error is too large. A given step is halved only if Newton's method fails,
        or if a contact that opens or closes would gain or lose energy.
    level : {"pendulum", "contact", "rigid_body"} or mapping
        Level of fidelity of the bearings: one for all, or by name of bearing ("pendulum" for the
        others). "rigid_body" needs one bearing with a mass on it. "auto": the cheapest that is
        sufficient; the analysis is run, checked for its assumptions, and run again with the missing
        features.
    method : {"direct", "reduced"}
        "direct": all degrees of freedom. "reduced": those of the bearings and few load-dependent
        vectors of the structure, in a run with few and runs with more, until two agree: for
        structures whose modes are many beside their bearings (docs/choices_structure.md).
    integrator : {None, "newmark", "corrected-newmark", "generalised-alpha", "explicit"}
        Time integration. None is Newmark's average acceleration, which conserves energy;
        "corrected-newmark" adds its error in a step, for structures with links or hinges, so that
        steps may be twice as long for the same error (docs/choices_time_step.md);
        "generalised-alpha" that of Chung and Hulbert (1993). At the level "rigid_body" None is
        Bossak's implicit method, and "explicit" uses small equal steps of `dt`.
    spectral_radius : float
        Spectral radius of the generalised-alpha method at infinite frequency [-], in [0, 1]; 1 is
        without numerical damping.
    tolerance : float, optional
        Allowed error of the bearings' displacement histories, over the peak displacement, if the
        program controls it: 1e-3 by default. Between 5e-5 and 5e-4 the error is within a factor of
        three of it (docs/choices_time_step.md). At the level "rigid_body" that of a step over the
        effective radius: 1e-8.
    reduction_tolerance : float, optional
        Tolerance of the method "reduced": largest difference of two runs in the peaks of bearing
        displacement and base shear, 1e-3 by default; ten times that in axial forces, floor
        accelerations in plan, storey drifts and yielding parts, a hundred times in vertical
        accelerations. Larger final differences are in a line of the assumption check.
    record_every : int
        Record every so many base steps: ``Recording(every=record_every)``.
    recording : Recording, optional
        Recorded steps, variables, bearings, nodes, windows around impacts, extremes; everything if
        None. Not together with `record_every`. The assumption check, `peaks` and the energy balance
        cover all base steps, for any recording. At the level "rigid_body" memory is needed for all
        of them during the run, and with `every` alone only the recorded ones are covered.
    on_failure : {"warn", "raise"}
        "warn": a run that fails returns its results so far, with a warning and its reason in the
        attributes. "raise": it raises AnalysisError, whose `data` holds the same.
    features : Features, optional
        Modelled features; all if None. The assumption check shows if an omission mattered. Not
        together with ``level="auto"``, which chooses for itself.
    progress : callable or bool, optional
        Called with the share done (0 to 1) some fifty times; True writes a bar to the standard
        error, in a notebook too.

    Returns
    -------
    xarray.Dataset
        See docs/results.md. Attributes hold status, message, versions, options, timings and the
        assumption check: the effect of each feature left out, with a number. A run whose energy
        balance is open by more than 0.1 % of the input has the status "inaccurate" and warns; the
        dissipation of "generalised-alpha" may reach 1 %, with a warning from 0.1 % on. An
        AuditWarning reports a completed run in whose assumption check a line begins with "!".

    Raises
    ------
    ValueError
        If an option is out of bounds.
    frames.ModelError
        If the model cannot work.
    lir_element.AnalysisError
        If there is no equilibrium under gravity, or (with ``on_failure="raise"``) a run fails.
    lir_element.AnalysisInterrupted
        After Ctrl-C, a KeyboardInterrupt whose `data` holds the results so far. A plain
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
        return _ended(data, outcome, doubts_of(data), on_failure)
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
            _ended(recorder.recorded(data), outcome, run.findings.doubts(), on_failure)
        return data

    if level == "auto":
        data = escalate_level(analyse, exact_features(model, motion))
        mark_other_end(data, ends)
        doubts = doubts_of(data)
    else:
        analyse(Features.all() if features is None else features, level)
        doubts = runs[0][0].findings.doubts()
    last, recorder = runs[0]
    return _ended(recorder.recorded(last.data), last.outcome, doubts, on_failure)


class Analysis:
    """A frame in equilibrium under its permanent loads, for many time histories.

    `time_history` is a run of one. An analysis keeps the frame as it is when it is made: later
    changes of the frame are not in it. Its runs do not change each other.

    Parameters
    ----------
    frame : Frame
        The structure and its bearings.
    level : {"pendulum", "contact"} or mapping
        Level of fidelity of the bearings, as in `time_history`.
    features : Features, optional
        Modelled features; all if None.

    Raises
    ------
    ValueError, TypeError
        If the level or the features are none that all runs can share.
    frames.ModelError
        If the model cannot work.
    lir_element.AnalysisError
        If there is no equilibrium under gravity.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import Analysis, GroundMotion, lumped_mass
    >>> from frames.demo import bearing_for
    >>> analysis = Analysis(lumped_mass(bearing_for(2000e3), mass=204e3))
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> runs = [analysis.run(pulse.scaled(factor)) for factor in (0.5, 1.0)]
    >>> [round(float(abs(data["bearing_displacement"]).max()), 2) for data in runs]
    [0.07, 0.24]
    """

    def __init__(
        self,
        frame: FrameData,
        level: str | Mapping[str, str] = "pendulum",
        features: Features | None = None,
    ) -> None:
        require_type("frame", frame, FrameData, "a Frame")
        check_options(level, _DIRECT, None, "warn", features)
        if level in {"auto", "rigid_body"} if isinstance(level, str) else False:
            msg = f'level = "{level}" does not share gravity states between runs: use time_history'
            raise ValueError(msg)
        kept, chosen = features or Features.all(), level if isinstance(level, str) else dict(level)
        with blas_threads_for(frame):
            self._prepared = PreparedFrame(frame, kept, chosen)

    def run(
        self,
        motion: GroundMotion,
        duration: float | None = None,
        dt: float | None = None,
        *,
        integrator: Literal["newmark", "corrected-newmark", "generalised-alpha"] | None = None,
        spectral_radius: float = 0.8,
        tolerance: float | None = None,
        recording: Recording | None = None,
        on_failure: Literal["warn", "raise"] = "warn",
        progress: Callable[[float], None] | bool | None = None,
    ) -> xr.Dataset:
        """Analyse the frame under a ground motion.

        Parameters
        ----------
        motion : GroundMotion
            Acceleration of the ground, up to three components.
        duration, dt : float, optional
            Length of the analysis and its step [s], as in `time_history`.
        integrator, spectral_radius, tolerance, recording, on_failure, progress
            As in `time_history`.

        Returns
        -------
        xarray.Dataset
            The result of `time_history`, to the bit.

        Raises
        ------
        ValueError, TypeError
            If an option is out of bounds.
        lir_element.AnalysisError
            If a run fails with ``on_failure="raise"``.
        """
        prepared = self._prepared
        check_analysis(prepared.model, motion)
        check_options(prepared.level, _DIRECT, integrator, on_failure, prepared.features)
        options = options_of(
            motion,
            duration,
            dt,
            method=_DIRECT,
            integrator=integrator,
            spectral_radius=spectral_radius,
            tolerance=tolerance,
            recording=recording_of(recording, 1),
            progress=share_told(progress),
        )
        with blas_threads_for(prepared.model):
            run, recorder = _run_prepared(prepared, prepared.fresh(), motion, options)
        run.data.attrs |= run.findings.attrs()
        doubts = run.findings.doubts()
        return _ended(recorder.recorded(run.data), run.outcome, doubts, on_failure)


_DIRECT = METHODS[0]


def _run_prepared(
    prepared: PreparedFrame, state: GravityState, motion: GroundMotion, options: Options
) -> tuple[Run, Recorder]:
    # A run from a state at rest; the records join its result in the end.
    recorder = Recorder(prepared, state, options.steps, options.recording)
    return run_one(prepared, state, motion, options, recorder), recorder


def _ended(
    data: xr.Dataset, outcome: Outcome, doubts: tuple[str, ...], on_failure: str
) -> xr.Dataset:
    # Warns of the end of a run, and of the findings of a completed one's assumption check.
    report(data, *outcome, on_failure=on_failure, stacklevel=4)
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
    # One run, or those of the method "reduced".
    if options.method == _DIRECT:
        return _run_prepared(*analysis_of(model, features, level), motion, options)
    last: list[tuple[Run, Recorder]] = []

    def reached(state: GravityState) -> tuple[dict[str, Extreme], bool]:
        last.clear()  # its memory
        prepared = PreparedFrame(model, features, level, state)
        last.append(_run_prepared(prepared, prepared.fresh(), motion, options))
        found, recorder = last[0]
        return recorder.reached(found.data), found.outcome.status is RunStatus.INTERRUPTED

    found = refined(model, features, level, options.reduction, reached)
    last_run, recorder = last[0]
    last_run.data.attrs |= found.attrs
    if found.doubt:
        text = worded(
            "reduced: two runs differ by more than reduction_tolerance: {differences}",
            differences=found.doubt,
        )
        noted = remark("reduced", found.attrs["reduction_tolerance"], text, doubtful=True)
        last_run = last_run._replace(findings=Findings((*last_run.findings, noted)))
    return last_run, recorder
