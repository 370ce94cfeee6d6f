"""Tasks in child processes that may hang or die without taking the rest with them."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import time
from dataclasses import dataclass
from multiprocessing.connection import wait
from pathlib import Path
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


def series_parser(module: str, *, keeps: bool = True, **counts: int) -> argparse.ArgumentParser:
    """Return the parser of a series of test cases, with an option for each count."""
    parser = argparse.ArgumentParser(prog=f"python -m {module}")
    parser.add_argument("--seed", type=int, default=1, help="series of test cases (default 1)")
    for name, count in counts.items():
        parser.add_argument(f"--{name}", type=int, default=count, help=f"how many ({count})")
    parser.add_argument("--workers", type=int, default=1, help="child processes")
    if keeps:
        parser.add_argument("--keep", type=Path, help="a file for the numbers, JSON by line")
        parser.add_argument("--kept", type=Path, help="such a file: the page alone, from it")
    return parser


def kept(path: Path | None) -> list[dict[str, Any]]:
    """Return what a file of numbers holds, JSON by line."""
    lines = path.read_text(encoding="utf-8").splitlines() if path else []
    return [json.loads(line) for line in lines]


def series(
    perform: Callable[[Any], dict[str, Any]],
    tasks: Iterable[Any],
    options: argparse.Namespace,
    limit: float,
) -> tuple[list[dict[str, Any]], list[tuple[Any, str]]]:
    """Run a series, and keep its numbers if asked; return them, and tasks that hung or died."""
    if options.kept:
        return kept(options.kept), []
    found, lost = [], []
    for task, result, how in in_children(perform, tasks, options.workers, limit):
        if how:
            lost.append((task, how))
            continue
        found.append(result)
        if options.keep:
            with options.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps(result) + "\n")
    return found, lost


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
