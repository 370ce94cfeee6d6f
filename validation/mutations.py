"""Errors put into codes, statistics and tables of the report: the suite must notice them.

    python -m validation.mutations --workers 2
    python -m validation.mutations --only 17

validation/mutations.toml has the errors: a factor, a sign, a wrong column, a mean for a maximum.
Each is put into a copy of the checkout, alone, and the tests that ought to notice it are run there,
the quickest first. Printed is which test noticed; the exit code is 1 where more than one in 25 is not.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess  # noqa: S404  (this Python, our own tests)
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

ROOT = Path(__file__).resolve().parents[1]
LIST = Path(__file__).with_suffix(".toml")
LEAST = 0.96
"""Share of the errors that must be noticed: 24 of 25."""
_COPIED = ("lir_element", "frames", "validation", "tests", "docs", "pyproject.toml", "README.md")
_CAUGHT = 1  # exit code of pytest where a test failed


class Mutation(NamedTuple):
    """An error: text of a file, what takes its place, and the tests that ought to notice."""

    file: str
    what: str
    old: str
    new: str
    tests: tuple[str, ...]


def mutations() -> list[Mutation]:
    """Return the errors of the list, in its order."""
    known = tomllib.loads(LIST.read_text(encoding="utf-8"))
    found = []
    for entry in known["mutation"]:
        count = (ROOT / entry["file"]).read_text(encoding="utf-8").count(entry["old"])
        if count != 1:
            where = f"{entry['file']}: {entry['old']!r}"
            msg = f"{where} occurs {count} times: give text that is there once"
            raise ValueError(msg)
        found.append(Mutation(**{**entry, "tests": tuple(known["tests"][entry["tests"]])}))
    return found


def copied(target: Path) -> Path:
    """Copy what the tests need into a folder and return it."""
    for name in _COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, target / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(source, target / name)
    return target


def noticed(mutation: Mutation, copy: Path) -> str:
    """Run the tests with an error in a copy and return the one that failed, "" if none did."""
    sound = (copy / mutation.file).read_text(encoding="utf-8")
    wrong = sound.replace(mutation.old, mutation.new).encode()
    return first_failure(mutation.file, wrong, mutation.tests, copy)


def first_failure(
    file: str, wrong: bytes, tests: Sequence[str], copy: Path, longest: float | None = None
) -> str:
    """Run tests with another content of a file and return the one that failed, "" if none did."""
    path = copy / file
    sound = path.read_bytes()
    path.write_bytes(wrong)
    try:
        for test in tests:
            call = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
            call += ["-m", ""] if test.startswith("tests/golden") else []  # nightly ones, too
            call.append(test)
            try:
                ran = subprocess.run(  # noqa: S603
                    call,
                    cwd=copy,
                    capture_output=True,
                    text=True,
                    check=False,
                    timeout=longest,
                    env={**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"},
                )
            except subprocess.TimeoutExpired:
                return f"{test} (longer than {longest:g} s)"
            named = re.search(r"^(?:FAILED|ERROR) (\S+)", ran.stdout, re.MULTILINE)
            if ran.returncode == _CAUGHT or (ran.returncode and named):
                return named[1] if named else test
            if ran.returncode:
                said = (ran.stdout + ran.stderr)[-2000:]
                msg = f"{test}: pytest ended with {ran.returncode}: {said}"
                raise RuntimeError(msg)
    finally:
        path.write_bytes(sound)
    return ""


def main(arguments: list[str] | None = None) -> int:
    """Put in the errors, print what became of each and return how many too many got through."""
    parser = argparse.ArgumentParser(prog="python -m validation.mutations")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of errors, from 1")
    parser.add_argument("--workers", type=int, default=1, help="copies that are tested at once")
    chosen = parser.parse_args(arguments)
    given = list(enumerate(mutations(), start=1))
    given = [each for each in given if not chosen.only or each[0] in chosen.only]
    caught = 0
    with tempfile.TemporaryDirectory() as folder:
        copies: SimpleQueue[Path] = SimpleQueue()
        for k in range(chosen.workers):
            copies.put(copied(Path(folder) / f"copy-{k}"))

        def tried(each: tuple[int, Mutation]) -> str:
            copy = copies.get()
            try:
                return noticed(each[1], copy)
            finally:
                copies.put(copy)

        with ThreadPoolExecutor(chosen.workers) as pool:
            for (number, mutation), by in zip(given, pool.map(tried, given), strict=True):
                caught += bool(by)
                said = by or "NOT NOTICED"
                print(f"{number:3d}  {mutation.file}: {mutation.what}: {said}", flush=True)
    print(f"{caught} of {len(given)} noticed")
    return int(caught < LEAST * len(given))


if __name__ == "__main__":
    sys.exit(main())
