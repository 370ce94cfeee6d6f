"""Runs of many structures: in threads of this process, and in processes of their own once they pay.

    python -m frames.batch.processes HANDLE PARENT

is started by `Crew`. Set-up and checks of a run hold the interpreter, so that threads wait for each
other if structures are many and their motions are short.
"""

from __future__ import annotations

import os
import sys
import threading
import warnings
from contextlib import ExitStack, contextmanager, suppress
from pickle import PicklingError  # noqa: S403  # of what this process sends
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any

from frames._fingerprint import fingerprint
from frames.batch.batch_run import Runner
from frames.recording.recording import memory, whole_steps
from frames.statics.blas_threads import blas_threads_for
from lir_element._compile.cache import is_kept
from lir_element.child_process import pipe_of, start

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from multiprocessing.connection import Connection

    from frames.batch.batch_dataset import Layout, RunResult

TRIED = 16  # runs that decide on the others
WORTH = 2.0  # s that processes must save: starting two costs nearly as much
_BYTES = 0.5e9  # of the machine's memory for each process, which needs half of that
_ATTENTIVE = 0.02  # s between two looks whether to leave off
_NO_PICKLE = PicklingError, AttributeError, TypeError, ValueError, RecursionError


class Crew:
    """Workers of the runs: `workers` threads, and a process for each if that saves time.

    `runs` is their number in all calls. A process that cannot do a run ends, and its thread does
    that run and all later ones: if a class is one of a notebook, which no other process can import;
    and if the run raises an error, which is then raised here.
    """

    pays = False
    """True if processes save enough time, by the first runs."""

    def __init__(self, workers: int | None, runs: int) -> None:
        self.workers = _processors() if workers is None else whole_steps("workers", workers)
        self._runs, self._noted, self._beside = runs, 0, 0.0
        self._processes: dict[int, ChildProcess] = {}
        self._layouts: dict[str, Layout] = {}
        self._lock = threading.Lock()

    def row(self, k: int, place: int, runner: Runner, is_stopped: Callable[[], bool]) -> Any:
        """Run a case in the process of thread `k`; None if stopped, or if the thread has to."""
        if not self.pays or runner.recording is not None:  # histories are too large to be sent
            return None
        if k not in self._processes:
            try:
                self._processes[k] = ChildProcess(self._layouts)
            except OSError:  # the system has no more memory, or no more processes
                self.pays = False
                return None
        process = self._processes[k]
        return process.row(place, runner, is_stopped) if process.is_ready() else None

    def note(self, beside: float) -> None:
        """Add the time of a run in a thread beside its loop [s]; decide by the first runs."""
        with self._lock:
            self._noted += 1
            self._beside += beside / TRIED
            if self._noted == TRIED:
                saved = (self._runs - TRIED) * self._beside * (1.0 - 1.0 / self.workers)
                self.pays = saved > WORTH and self.workers * _BYTES < memory() and is_kept()

    def end(self) -> None:
        """End the processes."""
        for process in self._processes.values():
            process.end()


@contextmanager
def crew_of(workers: Crew | int | None, runs: int) -> Generator[Crew, None, None]:
    """Hold a crew for a number of runs; a given crew stays at work."""
    if isinstance(workers, Crew):
        yield workers
        return
    crew = Crew(workers, runs)
    try:
        yield crew
    finally:
        crew.end()


class CrewWorker:
    """The runs of thread `k`, in it or in its process; `is_stopped` returns True to stop."""

    def __init__(self, crew: Crew, k: int, runner: Runner, is_stopped: Callable[[], bool]) -> None:
        self._crew, self._k, self._runner, self._is_stopped = crew, k, runner, is_stopped
        self._own, self._is_used = runner.worker(is_stopped), False

    def row(self, place: int) -> RunResult | None:
        """Run a case; None if it was stopped."""
        row: RunResult | None = self._crew.row(self._k, place, self._runner, self._is_stopped)
        if row is not None or self._is_stopped():
            return row
        began, spent = perf_counter(), thread_time()
        row = self._own.row(place)
        if row is not None and self._is_used:
            loop = row.numbers.get("seconds_loop", 0.0) / (perf_counter() - began)
            self._crew.note((thread_time() - spent) * (1.0 - loop))
        self._is_used = True  # its first run sets up the common data
        return row


class ChildProcess:
    """A process that runs cases, and its current batch."""

    def __init__(self, layouts: dict[str, Layout]) -> None:
        # silent: if it cannot do a run, its thread does, and reports the reason
        self._process, self.pipe = start(__name__, silent=True)
        self._layouts = layouts
        self.serves: bool | None = None  # None: it has not reported yet
        self._runner: Runner | None = None

    def is_ready(self) -> bool:
        """Return whether it serves, by now or still."""
        if self.serves is None and self._is_heard(0.0):
            self.serves = self._received() is not None
        return bool(self.serves)

    def row(self, place: int, runner: Runner, is_stopped: Callable[[], bool]) -> RunResult | None:
        """Run a case; None if it was stopped, or if the process cannot do it."""
        batch = None if self._runner is runner else runner.parts()
        try:
            self.pipe.send((batch, place))
        except (*_NO_PICKLE, OSError):
            self.end()
            return None
        self._runner = runner
        while not self._is_heard(_ATTENTIVE):
            if is_stopped():
                self.end()
                return None
        found = self._received()
        if found is None:
            return None
        row, digest, layout, heard = found
        if layout is not None:
            self._layouts.setdefault(digest, layout)
        for each in heard:
            warnings.warn(each, stacklevel=2)
        runner.take(row)
        done: RunResult = row._replace(layout=self._layouts.get(digest))
        return done

    def _is_heard(self, wait: float) -> bool:
        # True if there is a message, or the process has ended, which shows on receipt.
        try:
            return self.pipe.poll(wait)
        except OSError:
            return True

    def _received(self) -> Any:
        try:
            return self.pipe.recv()
        except (EOFError, OSError):
            self.end()
            return None

    def end(self) -> None:
        """End it in any state."""
        self.serves = False
        self.pipe.close()
        self._process.kill()
        self._process.wait()


def _processors() -> int:
    # Processors that this process may use.
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _serve(pipe: Connection) -> None:
    # Run the received cases. A layout is sent when it changes, its digest with each row.
    pipe.send("ready")
    layout, digest = None, ""
    with ExitStack() as threads:
        while True:
            batch, place = pipe.recv()
            if batch is not None:
                runner = Runner(*batch)
                threads.close()
                threads.enter_context(blas_threads_for(*runner.models.values()))
                own = runner.worker(bool)  # nothing stops it but its end
            runner.hold(runner.cases[place].model)
            with warnings.catch_warnings(record=True) as heard:
                warnings.simplefilter("always")
                row: Any = own.row(place)
            news = row.layout if row.layout is not layout else None
            if news is not None:
                layout, digest = news, fingerprint(news)
            own_digest = "" if row.layout is None else digest
            pipe.send((row._replace(layout=None), own_digest, news, [w.message for w in heard]))


def main(handle: str, _: str) -> None:
    """Serve the process that started this one until the pipe ends."""
    with suppress(EOFError, OSError):
        _serve(pipe_of(int(handle)))


if __name__ == "__main__":
    main(*sys.argv[1:])
