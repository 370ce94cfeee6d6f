"""Random projects: files with errors put into them, and sound ones, for `lir check` and `lir run`.

    python -m validation.random_projects --seed 1 --count 200 --workers 2
    python -m validation.random_projects --seed 1 --only 17

Project `number` of the series `seed` is always the same one. Most have one thing wrong, or two: a
unit, a thousandfold value, a key that is missing, misspelled, doubled or swapped with another,
sections in another order, a motion's file that cannot be read. Each must end in a message that says
what is wrong, with the documented exit code, or in numbers: of those that `lir check` takes, one
motion is run and tests/golden/recompute.py, which imports nothing of the packages, must find every
number again.
"""

from __future__ import annotations

import re
import tempfile
from collections import Counter
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from typer.testing import CliRunner

from frames.command.app import app
from validation.fuzzing.pool import in_children, series_parser
from validation.fuzzing.projects import ERRORS, SPOILT, Document, sound
from validation.golden_review import recomputed

if TYPE_CHECKING:
    from collections.abc import Sequence

LIMIT = 300.0
"""Longest time for a project [s]."""

_DT, _SECONDS = 0.01, 4.0
_FINE = 0.2  # share of the projects in which nothing is put wrong
_TWICE = 0.15  # share of the others in which two things are


class Outcome(NamedTuple):
    """What became of a project."""

    number: int
    """Of the project."""
    wrong: str
    """What was put wrong, in words."""
    outcome: str
    """"refused", "checked", "run", or what was found: "traceback", "exit code", "no remedy", "not a number", "disagrees", "hang", "crash"."""
    words: str
    """The message, or what was found."""


FINDINGS = (
    "traceback",
    "exit code",
    "no remedy",
    "not a number",
    "disagrees",
    "hang",
    "crash",
    "strange",
)
"""Outcomes that are defects."""


def random_project(seed: int, number: int) -> tuple[Document, str]:
    """Return a project and what was put wrong in it."""
    rng = np.random.default_rng([seed, number])
    document = sound(rng)
    if rng.random() < _FINE:
        return document, ""
    times = 2 if rng.random() < _TWICE else 1
    words = []
    for _ in range(times):
        put = ERRORS[int(rng.integers(len(ERRORS)))]
        with suppress(KeyError, IndexError, ValueError, TypeError):  # what it changes is gone
            words.append(put(document, rng))
    return document, "; ".join(words)


def written(document: Document) -> str:
    """Return a project as TOML."""
    lines = []
    for section, keys in document.items():
        lines.append(f"[{section}]")
        lines += (f"{key.strip()} = {_toml(v)}" for key, v in keys.items() if key != SPOILT)
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return f"{value:.1f}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def motion_files(folder: Path, spoilt: str) -> None:
    """Write one short motion and its table."""
    folder.mkdir(parents=True)
    time = np.arange(0.0, _SECONDS, _DT)
    bell = np.sin(np.pi * time / _SECONDS) ** 2
    unit = {"unit": "m/s"}.get(spoilt, "m/s2")
    for axis, size, period in (("x", 1.6, 1.9), ("y", 1.0, 1.3)):
        values = size * bell * np.sin(2.0 * np.pi * time / period)
        values = 0.0 * values if spoilt == "still" else values
        lines = [f"{9.80665 * v if spoilt == 'in g' else v:.6e}" for v in values]
        if spoilt in {"a word", "nan"}:
            lines[40] = {"a word": "gap", "nan": "nan"}[spoilt]
        if spoilt != "no file":
            text = "" if spoilt == "empty" else "\n".join(lines) + "\n"
            (folder / f"one-{axis}.txt").write_text(text, encoding="utf-8")
    step = "" if spoilt == "no dt" else f"{_DT:g}"
    table = f"name,x,y,dt,unit\none,one-x.txt,one-y.txt,{step},{unit}\n"
    if spoilt != "no table":
        (folder / "motions.csv").write_text(table, encoding="utf-8")


def perform(number: int, *, seed: int, most: float = 1.0) -> Outcome:
    """Check a project, run it where it can be, and judge what comes out."""
    document, wrong = random_project(seed, number)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "project.toml").write_text(written(document), encoding="utf-8")
        motion_files(folder / "motions", str(document.get("motions", {}).get(SPOILT, "")))
        outcome, words = _judged(folder, wrong, runs=(number % 100) < 100.0 * most)
    return Outcome(number, wrong, outcome, words)


def _judged(folder: Path, wrong: str, *, runs: bool) -> tuple[str, str]:
    file = folder / "project.toml"
    done = CliRunner().invoke(app, ["check", str(file)])
    found = _of_command(done, wrong)
    if found is not None or not runs:
        return found or ("checked", "")
    results = folder / "results"
    done = CliRunner().invoke(app, ["run", "--no-figures", str(file), "--results", str(results)])
    found = _of_command(done, wrong)
    if found is not None:
        return found
    if 'histories = "all"' not in file.read_text(encoding="utf-8"):
        return "run", "histories were not kept"
    review = recomputed(folder)
    if review.bad:
        return "disagrees", " | ".join(review.bad[0])
    return "run", f"{sum(review.counts.values())} numbers; {done.stderr.strip()[-200:]}"


def _of_command(done: Any, wrong: str) -> tuple[str, str] | None:
    # What a command's end says, None where it gave numbers.
    said = " ".join(done.stderr.split())
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        return "traceback", f"{type(done.exception).__name__}: {done.exception}"
    if "Traceback" in said:
        return "traceback", said
    if done.exit_code in {0, 1}:
        shown = re.search(r"\b(nan|NaN)\b", done.stdout)
        return ("not a number", done.stdout[max(0, shown.start() - 100) :]) if shown else None
    if done.exit_code not in {2, 3}:
        return "exit code", f"{done.exit_code}: {said}"
    return ("refused", said) if _tells(said, wrong) else ("no remedy", said)


def _tells(said: str, wrong: str) -> bool:
    # Whether a message begins as one, and names what was put wrong or its section.
    if not said.startswith(("error:", "warning:")) or ":" not in said[6:]:
        return False
    named = re.findall(r"[A-Za-z_0-9]{2,}", wrong.replace("spoilt", ""))
    if re.search(r"TOML syntax error: .*line \d+.*\): ", said):
        return True
    return not wrong or any(word.lower() in said.lower() for word in named)


def table(found: Sequence[Outcome]) -> str:
    """Return how often each kind of error ended how."""
    counts = Counter(one.outcome for one in found)
    lines = [f"{len(found)} projects"]
    for outcome, count in counts.most_common():
        lines.append(f"  {outcome:14}{count:5d}")
    quiet = [o for o in found if o.outcome in {"run", "checked"} and o.wrong]
    lines += [f"taken with something wrong: {len(quiet)}"]
    lines += [f"  {o.number}: {o.wrong}: {o.words}" for o in quiet]
    lines += [
        f"FINDING {o.outcome}, project {o.number} ({o.wrong}): {o.words[:600]}"
        for o in found
        if o.outcome in FINDINGS
    ]
    return "\n".join(lines)


def main(given: Sequence[str] | None = None) -> int:
    """Run the series, print the table; return 1 where there is a finding."""
    parser = series_parser("validation.random_projects", keeps=False, count=200)
    parser.add_argument("--most", type=float, default=1.0, help="share of sound ones to be run")
    parser.add_argument("--only", type=int, metavar="NUMBER")
    chosen = parser.parse_args(given)
    if chosen.only is not None:
        print(written(random_project(chosen.seed, chosen.only)[0]))
        print(perform(chosen.only, seed=chosen.seed))
        return 0
    found = []
    task = partial(perform, seed=chosen.seed, most=chosen.most)
    for number, result, how in in_children(task, range(chosen.count), chosen.workers, LIMIT):
        wrong = random_project(chosen.seed, number)[1]
        found.append(Outcome(number, wrong, how, "") if how else result)
        if found[-1].outcome in FINDINGS:
            print(found[-1], flush=True)
    found.sort(key=lambda one: one.number)
    print(table(found))
    return int(any(one.outcome in FINDINGS for one in found))


if __name__ == "__main__":
    raise SystemExit(main())
