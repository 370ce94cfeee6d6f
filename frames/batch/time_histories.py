"""Many time histories at once: structures, motions and scales on all processors, one Dataset."""

from __future__ import annotations

import math
import queue
import threading
import warnings
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter, sleep
from typing import TYPE_CHECKING, Literal

from frames._errors import AuditWarning, ModelWarning
from frames._fingerprint import motion_digest
from frames._provenance import provenance
from frames.batch.batch_dataset import RunResult, stack
from frames.batch.batch_run import Runner
from frames.batch.cases import BatchProgress, grid, named_models, named_motions, tell
from frames.batch.completed_runs import KeptRuns
from frames.batch.processes import Crew, CrewWorker, crew_of
from frames.recording.recording import Recording
from frames.solve.options import check_options, options_of
from frames.statics.blas_threads import blas_threads_for
from frames.statics.sanity_checks import motion_doubts
from lir_element._version import package_version
from lir_element.argument_checks import require_choice
from lir_element.device.features import Features
from lir_element.errors import AnalysisInterrupted, AnalysisWarning, RunStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    import xarray as xr

    from frames.batch.cases import Case
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion

_ATTENTIVE = 0.02  # s between two looks whether a run is done
_GRAVE = ("equilibrium", "accelerations")  # doubts that are named before all others


def time_histories(
    models: FrameData | Sequence[FrameData] | Mapping[str, FrameData],
    motions: GroundMotion | Sequence[GroundMotion] | Mapping[str, GroundMotion],
    *,
    scales: float | Sequence[float] | None = None,
    cases: Sequence[tuple[str, str, float]] | None = None,
    duration: float | None = None,
    dt: float | None = None,
    level: str | Mapping[str, str] = "pendulum",
    method: Literal["direct"] = "direct",
    integrator: Literal["newmark", "corrected-newmark", "generalised-alpha"] | None = None,
    spectral_radius: float = 0.8,
    tolerance: float | None = None,
    features: Features | None = None,
    record: Literal["peaks"] | Recording | None = None,
    workers: Crew | int | None = None,
    progress: Callable[[BatchProgress], None] | bool | None = None,
    resume: str | Path | None = None,
) -> xr.Dataset:
    """Analyse structures under many ground motions and scales, on all processors.

    Each run gives the numbers of `time_history`, for any number of workers. A structure is
    assembled and brought into equilibrium once for all of its runs.

    Parameters
    ----------
    models : Frame, or a sequence or mapping of them
        The structures, by the names of a mapping, else by their own.
    motions : GroundMotion, or a sequence or mapping of them
        Accelerations of the ground, by name as the structures.
    scales : float or sequence of float, optional
        Factors on the motions [-]; 1 if None.
    cases : sequence of (str, str, float), optional
        Runs by name of model, name of motion, and scale, instead of all combinations of models,
        motions and scales: for example motions with a factor each.
    duration, dt, level, method, integrator, spectral_radius, tolerance, features
        As for `time_history`, the same for all runs. `duration` None: each motion's own. The levels
        "auto" and "rigid_body" are those of single runs.
    record : {None, "peaks"} or Recording
        Histories to keep besides the peaks of every run, as a `Recording`.
    workers : int, optional
        Runs at a time, each in a thread: the compiled loops do not hold each other up. None: as
        many as the process has processors. If the first runs show that set-up and judging of the
        others would take seconds, each thread has a process of its own do its runs.
    progress : callable or bool, optional
        Called with a `BatchProgress` after each run; True writes it to the standard error.
    resume : str or path, optional
        Folder that keeps each run as it completes, and from which complete runs are read: those of
        the same model, motion, scale, options, version and sources. The result is that of an
        undisturbed batch. The folder stays; its files have no other use.

    Returns
    -------
    xarray.Dataset
        A row a run along `run`, in the order models, motions, scales (the last change first) or
        that of the cases; `model`, `motion` and `scale` are coordinates. See docs/recording.md. A
        run that stopped early is a row like the others, with its `status` and `message`, and its
        peaks until then. Two warnings at most give the number of runs that stopped or are
        inaccurate, and the number with findings of the assumption check.

    Raises
    ------
    ValueError
        If an option is out of bounds, names are not unique, or the results would not fit.
    TypeError
        If an argument is of another kind.
    frames.ModelError
        If a model cannot work.
    lir_element.AnalysisInterrupted
        After Ctrl-C, a KeyboardInterrupt whose `data` holds the runs that were complete.
    KeyboardInterrupt
        After Ctrl-C before the first run was complete.

    Examples
    --------
    >>> from frames import time_histories
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> runs = time_histories(frame, {"pulse": pulse}, scales=[0.5, 1.0], workers=1)
    >>> runs["status"].values.tolist(), runs["scale"].values.tolist()
    (['ok', 'ok'], [0.5, 1.0])
    """
    structures, grounds = named_models(models), named_motions(motions)
    runs = grid(structures, grounds, scales, cases)
    require_choice("method", method, ("direct",))
    check_options(level, method, integrator, "warn", features)
    if level in {"auto", "rigid_body"} if isinstance(level, str) else False:
        msg = f'time_histories does not support level="{level}": call time_history for each motion'
        raise ValueError(msg)
    histories = _recording_of(record)
    options = {
        name: options_of(
            motion,
            duration,
            dt,
            method=method,
            integrator=integrator,
            spectral_radius=spectral_radius,
            tolerance=tolerance,
            recording=histories or Recording(every=None),
            progress=None,
        )
        for name, motion in grounds.items()
    }
    _warn_of_motions(structures, grounds, runs)
    chosen = Features.all() if features is None else features
    began = perf_counter()
    with blas_threads_for(*structures.values()), crew_of(workers, len(runs)) as crew:
        keeper, before = None, list[RunResult]()
        if resume is not None:
            asked = (chosen, level, histories)
            keeper = KeptRuns(Path(resume), structures, grounds, options, asked)
            before = keeper.rows(runs)
        todo = sorted({*range(len(runs))} - {row.place for row in before})
        rest = [runs[k] for k in todo]
        runner = Runner(structures, grounds, options, rest, chosen, level, histories)
        new, is_stopped = _all(runner, crew, tell(progress), keeper, len(before))
        rows = before + [row._replace(place=todo[row.place]) for row in new]
    if not rows:
        raise KeyboardInterrupt
    data = stack(rows, runs, {name: motion_digest(each) for name, each in grounds.items()})
    data.attrs = {
        "title": f"{len(runs)} time histories",
        "status": "ok" if len(rows) == len(runs) else "interrupted",
        "runs_asked_for": len(runs),
        "level": level if isinstance(level, str) else str(dict(level)),
        "features_left_out": ", ".join(chosen.left_out) or "none",
        "recording": "what was reached" if histories is None else str(histories),
        "method": method,
        "integrator": integrator or "newmark",
        "spectral_radius": float(spectral_radius),
        "seconds": perf_counter() - began,
        "lir_dcfp_version": package_version(),
        **provenance(dated=False),
    }
    if is_stopped:
        stop: AnalysisInterrupted = _Interrupted(_computed(data), data)
        raise stop
    _warn_of_runs(rows)
    return data


def _computed(data: xr.Dataset) -> float:
    # Time of motion that was gone through in all [s].
    return float(data["peak_until"].sum()) if "peak_until" in data else 0.0


class _Interrupted(AnalysisInterrupted):
    # Ctrl-C between runs.

    def __str__(self) -> str:
        done, total = self.data.sizes["run"], self.data.attrs["runs_asked_for"]
        return (
            f"interrupted after {done} of {total} runs: their results are in the attribute "
            "`data` of this AnalysisInterrupted"
        )


def _all(
    runner: Runner,
    crew: Crew,
    told: Callable[[BatchProgress], None] | None,
    keeper: KeptRuns | None,
    taken: int,
) -> tuple[list[RunResult], bool]:
    # The rows, and whether Ctrl-C came: it leaves those that are done, which may be all.
    if taken and told is not None:
        told(BatchProgress(0, len(runner.cases), 0.0, 0, taken))
    if not runner.cases:
        return [], False
    results: queue.SimpleQueue[RunResult | None] = queue.SimpleQueue()  # None: a worker has ended
    todo, lock, stop = iter(range(len(runner.cases))), threading.Lock(), threading.Event()

    def next_place() -> int | None:
        with lock:
            return None if stop.is_set() else next(todo, None)

    def work(k: int) -> None:
        own, is_done = CrewWorker(crew, k, runner, stop.is_set), False
        try:
            while (place := next_place()) is not None:
                row = own.row(place)
                if row is not None:
                    results.put(row)
            is_done = True
        finally:
            if not is_done:  # the others need not go on
                stop.set()
            results.put(None)

    rows, is_stopped = list[RunResult](), False

    def take(row: RunResult) -> None:
        rows.append(row)  # those that came before an interruption stay
        if keeper is not None:
            keeper.keep(row, runner.cases[row.place])

    workers = min(crew.workers, len(runner.cases))
    with ThreadPoolExecutor(workers) as pool:
        futures = [pool.submit(work, k) for k in range(workers)]
        try:
            for row in _arriving(results, workers, len(runner.cases), told, taken):
                take(row)
        except KeyboardInterrupt:
            is_stopped = True
        finally:
            stop.set()
    for future in futures:
        future.result()  # raises the error that ended a worker
    while not results.empty():
        late = results.get()
        if late is not None:
            take(late)
    return rows, is_stopped


def _arriving(
    results: queue.SimpleQueue[RunResult | None],
    workers: int,
    total: int,
    told: Callable[[BatchProgress], None] | None,
    taken: int,
) -> Iterator[RunResult]:
    # Rows as they are done, until all workers have ended.
    began, done, failed = perf_counter(), 0, 0
    while workers:
        while results.empty():
            sleep(_ATTENTIVE)  # Ctrl-C breaks it on every system
        row = results.get()
        if row is None:
            workers -= 1
            continue
        yield row
        done += 1
        failed += math.isfinite(row.failed_at)
        if told is not None:
            told(BatchProgress(done, total, perf_counter() - began, failed, taken))


def _recording_of(record: object) -> Recording | None:
    if record is None or record == "peaks":
        return None
    if not isinstance(record, Recording):
        msg = f'record = {record!r} must be None or "peaks", or a Recording such as Recording()'
        raise TypeError(msg)
    return record


def _warn_of_motions(
    models: Mapping[str, FrameData], motions: Mapping[str, GroundMotion], runs: Sequence[Case]
) -> None:
    # Warnings about a motion under a structure, once for all of them.
    found = [
        (case, doubt)
        for case in runs
        for doubt in motion_doubts(models[case.model], motions[case.motion].scaled(case.scale))
    ]
    if found:
        (case, doubt), others = found[0], len(found) - 1
        more = f" (and {others} more of the {len(runs)} runs)" if others else ""
        warnings.warn(f"{case}: {doubt}{more}", ModelWarning, stacklevel=3)


def _warn_of_runs(rows: Sequence[RunResult]) -> None:
    # Number of runs that did not end well, and number that need attention.
    ill = sorted((row for row in rows if row.status != RunStatus.OK.name.lower()), key=_place)
    if ill:
        kinds = Counter(row.status for row in ill)
        text = ", ".join(f"{count} {status}" for status, count in kinds.items())
        warnings.warn(
            f"{len(ill)} of {len(rows)} runs stopped early or have warnings ({text}); the first, "
            f"run {ill[0].place}: {ill[0].message.rstrip('.')}. "
            "See the variables status and message",
            AnalysisWarning,
            stacklevel=3,
        )
    marked = [row for row in rows if row.findings.doubts() and math.isnan(row.failed_at)]
    if marked:
        grave = [row for row in marked if _is_grave(row)]
        first = min(grave or marked, key=_place)
        which = f"{len(grave)} with unreliable forces or accelerations, the" if grave else "the"
        warnings.warn(
            f"{len(marked)} of {len(rows)} runs completed with a warning; {which} "
            f"first, run {first.place}: {'; '.join(first.findings.doubts()).rstrip('.')}. "
            "See the variable doubts",
            AuditWarning,
            stacklevel=3,
        )


def _is_grave(row: RunResult) -> bool:
    return any(found.is_marked and found.feature in _GRAVE for found in row.findings)


def _place(row: RunResult) -> int:
    return row.place
