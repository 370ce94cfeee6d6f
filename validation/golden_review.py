"""Golden review: fourteen projects run by `lir run`, every number recomputed without the package.

    python -m validation.golden_review [FOLDER] [--only 01 05]

Each project of tests/golden/projects is run in a folder of its own (kept where FOLDER names one),
with artificial motions that tests/golden/ground.py writes. Then tests/golden/recompute.py, which
imports nothing of the packages, reads the files and compares: peaks from histories, statistics,
equivalent-linear analyses, checks, spectra and factors of the motions, what moved masses add, the
weight and mass of loads by area, and each table of the report. A table is printed; the exit code is 1 where something disagrees.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess  # noqa: S404  (this Python, our own files)
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parents[1]
GOLDEN = HERE / "tests" / "golden"
_RUN = "from frames.command.entry import main; main()"
_RAN = (0, 1)  # exit codes of `lir run` that leave results: checks pass, or some fail


class Review(NamedTuple):
    """What the comparison of one project found."""

    counts: dict[str, int]
    """Number of values compared, by category."""
    worst: dict[str, float]
    """Largest relative difference of those that agree."""
    tolerances: dict[str, tuple[float, str]]
    """Tolerance, and its reason."""
    bad: list[list[str]]
    """Category, label, reported, found and difference of what disagrees."""
    missing: list[list[str]]
    """Category and label of what was reported and not recomputed."""


def projects() -> list[Path]:
    """Return the projects' files."""
    return sorted((GOLDEN / "projects").glob("*.toml"))


def prepared(project: Path, folder: Path) -> Path:
    """Write a project with its motions into a folder."""
    own = folder / project.stem
    shutil.rmtree(own, ignore_errors=True)
    own.mkdir(parents=True)
    shutil.copy(project, own / "project.toml")
    for pattern in ("*.py", "*.e2k"):  # models
        for model in project.parent.glob(pattern):
            shutil.copy(model, own)
    _script("ground.py", own)
    return own


def review(own: Path) -> Review:
    """Run a prepared project and recompute what it reports."""
    done = _python(["-c", _RUN, "run", "--no-figures"], own)
    if done.returncode not in _RAN:
        msg = f"{own.name}: lir run ended with {done.returncode}: {done.stderr[-2000:]}"
        raise RuntimeError(msg)
    return recomputed(own)


def recomputed(own: Path) -> Review:
    """Recompute what the run of a project reports, from the files that it left."""
    return Review(**json.loads(_script("recompute.py", own, "--json", fails=(0, 1))))


def _script(name: str, *given: object, fails: tuple[int, ...] = (0,)) -> str:
    # A script of tests/golden, in a process of its own that has not the packages on its path.
    done = _python([str(GOLDEN / name), *map(str, given)], Path(tempfile.gettempdir()), alone=True)
    if done.returncode not in fails or (0 not in fails and not done.stdout):
        msg = f"{name} ended with {done.returncode}: {done.stderr[-2000:]}"
        raise RuntimeError(msg)
    if not done.stdout and 1 in fails:
        msg = f"{name} printed nothing: {done.stderr[-2000:]}"
        raise RuntimeError(msg)
    return done.stdout


def _python(
    command: list[str], folder: Path, *, alone: bool = False
) -> subprocess.CompletedProcess[str]:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    if not alone:
        environment["PYTHONPATH"] = str(HERE)
    return subprocess.run(  # noqa: S603  (this Python, our own files)
        [sys.executable, *command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def table(reviews: dict[str, Review]) -> str:
    """Return the comparisons of all projects by category."""
    counts: dict[str, int] = defaultdict(int)
    worst: dict[str, float] = defaultdict(float)
    bad: dict[str, int] = defaultdict(int)
    why: dict[str, tuple[float, str]] = {}
    for each in reviews.values():
        why |= each.tolerances
        for name, count in each.counts.items():
            counts[name] += count
            worst[name] = max(worst[name], each.worst.get(name, 0.0))
        for name, *_ in each.bad:
            bad[name] += 1
    lines = [f"{'category':44}{'values':>8}{'worst':>9}{'off':>5}  tolerance"]
    for name, count in counts.items():
        tolerance, reason = why[name]
        size = f"{tolerance:.0e}, " if tolerance else ""
        lines.append(f"{name:44}{count:8d}{worst[name]:9.1e}{bad[name]:5d}  {size}{reason}")
    total, off = sum(counts.values()), sum(bad.values())
    lines.append(f"{total} values of {len(reviews)} projects, {off} disagree")
    for project, each in reviews.items():
        lines += (f"{project}: DISAGREES {' | '.join(row)}" for row in each.bad[:20])
        lines += (f"{project}: not recomputed: {' | '.join(row)}" for row in each.missing[:20])
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """Run and review all projects, or some."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if given.folder is None else given.folder.resolve()
        chosen = [p for p in projects() if not given.only or p.stem[:2] in given.only]
        reviews = {}
        for project in chosen:
            own = prepared(project, folder)
            reviews[project.stem] = each = review(own)
            print(f"{project.stem}: {sum(each.counts.values())} values, {len(each.bad)} disagree")
            if given.folder is None:
                shutil.rmtree(own)
    print(table(reviews))
    return int(any(each.bad or each.missing for each in reviews.values()))


if __name__ == "__main__":
    raise SystemExit(main())
