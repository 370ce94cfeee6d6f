"""Random test cases by the thousand: writes their section of docs/validation/robustness.md.

    python -m validation.random_scenes --seed 1 --count 5000 --workers 2
    python -m validation.random_scenes --seed 1 --only 1234

Test case `number` of the series `seed` is always the same one, whatever the count. Test cases are run in
child processes: one that hangs or dies (of any exception that is not the project's own; its
traceback goes to the terminal) is a finding, and the rest goes on. With `--minutes` no
test case is begun after that time; with `--only` one test case is run here, and nothing is written.
"""

from __future__ import annotations

import argparse
import json
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from validation.fuzzing.buildings import random_building, try_building
from validation.fuzzing.checks import Report
from validation.fuzzing.page import write
from validation.fuzzing.pool import in_children, kept, series_parser
from validation.fuzzing.scenes import random_scene
from validation.fuzzing.trial import try_scene
from validation.page import ROBUSTNESS, put
from validation.scenes import LEVELS_STATIC, static_bearing

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

Task = tuple[str, int]
"""Test case or building, and its number."""

LIMIT = 300.0
"""Longest time for a test case with all its runs [s]."""


def attempt(task: Task, seed: int, level: str | None) -> Report:
    """Run a test case or a building with all its checks; the level is that of test cases."""
    kind, number = task
    if kind == "building":
        return try_building(seed, number)
    return try_scene(seed, number, level=level)


def perform(task: Task, *, seed: int, level: str | None) -> dict[str, Any]:
    """Run a test case or a building and return its report as it is kept."""
    return attempt(task, seed, level).as_dict()


def warm_up() -> None:
    """Have the kernels of all levels compiled and kept, so that no test case waits for that."""
    calm = GroundMotion(x=np.zeros(3), dt=0.01)
    for level in LEVELS_STATIC:
        time_history(lumped_mass(static_bearing(), 15e3), calm, level=level)


def lost(task: Task, how: str, seed: int, level: str | None = None) -> dict[str, Any]:
    """Return the report of a test case whose process hung or died."""
    kind, number = task
    if kind == "building":
        report = Report(number, random_building(seed, number)[1], "building", "?")
    else:
        scene = random_scene(seed, number, level)
        report = Report(number, scene.describe(), scene.model, scene.level)
    report.outcome, report.seconds = how, LIMIT
    report.found(how, 1.0, f"no report: {how}")
    return report.as_dict()


def tasks(count: int, buildings: int, minutes: float) -> Iterator[Task]:
    """Yield test cases with buildings in between, until the time is over."""
    end = time.monotonic() + 60.0 * minutes
    given = 0
    for number in range(count):
        if time.monotonic() > end:
            return
        yield "scene", number
        if given < round((number + 1) * buildings / count):
            yield "building", given
            given += 1


def only(task: Task, seed: int, level: str | None) -> None:
    """Run one test case here and print all that is known of it."""
    report = attempt(task, seed, level)
    for name, value in report.as_dict().items():
        if name != "findings":
            print(f"{name:>12}: {value}")
    for kind, size, words in report.findings:
        print(f"  ! {kind} ({size:.3g}): {words}")


def arguments(given: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = series_parser("validation.random_scenes", count=5000)
    parser.add_argument("--buildings", type=int, help="under their weight (0.16 a test case)")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="begin none after")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="run this test case alone")
    parser.add_argument(
        "--level",
        choices=("pendulum", "contact", "auto"),
        help="of all test cases; drawn unless given",
    )
    parser.add_argument("--building", action="store_true", help="NUMBER is that of a building")
    parser.add_argument("--page", type=Path, default=ROBUSTNESS, help="that has the section")
    found = parser.parse_args(given)
    for name in ("count", "workers"):
        if getattr(found, name) < 1:
            parser.error(f"--{name} must be at least 1")
    if found.buildings is None:
        found.buildings = round(0.16 * found.count)
    return found


def main(given: Sequence[str] | None = None) -> int:
    """Run the test cases, write the page; return how many have a finding."""
    chosen = arguments(given)
    if chosen.only is not None:
        kind = "building" if chosen.building else "scene"
        only((kind, chosen.only), chosen.seed, chosen.level)
        return 0
    began = time.monotonic()
    found: dict[str, list[dict[str, Any]]] = {"scene": [], "building": []}
    for entry in kept(chosen.kept):
        found["building" if entry["model"] == "building" else "scene"].append(entry)
    todo: Iterable[Task] = ()
    if not chosen.kept:
        warm_up()
        todo = tasks(chosen.count, chosen.buildings, chosen.minutes)
    run = partial(perform, seed=chosen.seed, level=chosen.level)
    for task, result, how in in_children(run, todo, chosen.workers, LIMIT):
        entry = lost(task, how, chosen.seed, chosen.level) if how else result
        found[task[0]].append(entry)
        if chosen.keep:
            with chosen.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps(entry) + "\n")
        for kind, _, words in entry["findings"]:
            print(f"{task[0]} {task[1]}: {kind}: {words[:120]}", flush=True)
    for entries in found.values():
        entries.sort(key=lambda entry: int(entry["number"]))
    workers = f"{chosen.workers} process{'es' if chosen.workers > 1 else ''}"
    spent = f"{(time.monotonic() - began) / 60.0:.0f} minutes with {workers}"
    count = len(found["scene"])
    call = f"python -m validation.random_scenes --seed {chosen.seed} --count {count}"
    if chosen.level:
        call += f" --level {chosen.level}"
    put(chosen.page, "random_scenes", write(found["scene"], found["building"], call, spent))
    return sum(bool(entry["findings"]) for entries in found.values() for entry in entries)


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
