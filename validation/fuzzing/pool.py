"""Tasks in child processes that may hang or die without taking the rest with them."""

from __future__ import annotations

import multiprocessing
import time
from dataclasses import dataclass
from multiprocessing.connection import wait
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

_SPAWN = multiprocessing.get_context("spawn")


@dataclass
class _Worker:
    process: BaseProcess
    pipe: Connection
    task: Any = None
    deadline: float = 0.0


def in_children(
    function: Callable[[Any], Any], tasks: Iterable[Any], workers: int, limit: float
) -> Iterator[tuple[Any, Any, str]]:
    """Run `function` on every task, as many at a time as there are workers."""
    waiting = iter(tasks)
    crew: list[_Worker] = []
    for _ in range(workers):
        worker = _started(function)
        crew.append(worker)
        _hand(worker, waiting, 10.0 * limit)
    while busy := [worker for worker in crew if worker.task is not None]:
        ready = wait([worker.pipe for worker in busy], timeout=1.0)
        for place, worker in enumerate(crew):
            if worker.task is None:
                continue
            how, result = "", None
            if worker.pipe in ready:
                try:
                    result = worker.pipe.recv()
                except EOFError:
                    how = "crash"
            elif time.monotonic() > worker.deadline:
                how = "hang"
            else:
                continue
            task = worker.task
            if how:
                _stop(worker)
                crew[place] = worker = _started(function)
            _hand(worker, waiting, limit if not how else 10.0 * limit)
            yield task, result, how
    for worker in crew:
        _stop(worker)


def _started(function: Callable[[Any], Any]) -> _Worker:
    ours, theirs = _SPAWN.Pipe()
    process = _SPAWN.Process(target=_serve, args=(function, theirs), daemon=True)
    process.start()
    theirs.close()
    return _Worker(process, ours)


def _serve(function: Callable[[Any], Any], pipe: Connection) -> None:
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        pipe.send(function(task))


def _hand(worker: _Worker, waiting: Iterator[Any], limit: float) -> None:
    worker.task = next(waiting, None)
    worker.deadline = time.monotonic() + limit
    if worker.task is not None:
        worker.pipe.send(worker.task)


def _stop(worker: _Worker) -> None:
    worker.pipe.close()
    worker.process.kill()
    worker.process.join()
