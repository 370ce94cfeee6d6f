"""The cover of a report: people, date, codes, programs, input, and the verdict."""

from __future__ import annotations

import hashlib
import importlib.metadata
import platform
from datetime import UTC, datetime
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from frames.design.codes.registry import code_named
from frames.design.histories.demand_table import failed_runs
from frames.design.report.judged import Judged, judged
from frames.design.report.page import Table
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.project.design_run import ProjectRun

_LIBRARIES = ("numpy", "scipy", "numba", "xarray", "matplotlib")
_SHORT = 12  # letters of a digest in the foot of a page


class Cover(NamedTuple):
    """What stands on the cover and in the margins."""

    people: list[tuple[str, str]]  # client, engineer, checker; empty where they are to sign
    issue: list[tuple[str, str]]  # revision and date; empty where they were left out
    codes: list[tuple[str, str, str]]  # code and title
    # program and main libraries with their versions, Python, system
    programs: list[tuple[str, str]]
    digest: str  # SHA-256 of the project's file
    motions: str  # digest of the accelerations as they were run
    written: str  # when

    @property
    def short(self) -> str:
        """The digest as it stands in the foot of a page."""
        return self.digest[:_SHORT]


def cover_of(run: ProjectRun, source: str) -> Cover:
    """Return the cover of a run's report."""
    about = run.about
    code = code_named(run.equivalent.code)
    return Cover(
        people=[
            ("client", about.client),
            ("engineer", about.engineer),
            ("checker", about.checker),
        ],
        issue=[("revision", about.revision), ("date", str(about.date))],
        codes=[(code.name, code.title, code.edition)],
        programs=[
            ("lir-dcfp", package_version()),
            ("Python", platform.python_version()),
            *((name, importlib.metadata.version(name)) for name in _LIBRARIES),
            ("system", f"{platform.system()} {platform.machine()}"),
        ],
        digest=hashlib.sha256(source.encode("utf-8")).hexdigest(),
        motions=str(run.inputs.get("motions", "")),
        written=datetime.now(tz=UTC).strftime("%Y-%m-%d %H:%M UTC"),
    )


class Verdict(NamedTuple):
    """The verdict of a run: two short lists, and each cause once."""

    # number of checks that fail on their value; counts of failed runs are not among them
    by_value: int
    # of each title and level the worst of these, and the other bounds at which it fails
    worst: list[tuple[Judged, str]]
    without_value: int  # number of checks that have no valid value, because runs failed
    # titles of these: beyond the limit before the failure already, and not beyond it
    beyond: list[str]
    within: list[str]
    failures: Table  # runs that failed, by level, bound and cause
    failed: int  # number of runs that failed, that the assumption checks mark, and of all runs
    doubtful: int
    runs: int


def verdict_of(run: ProjectRun) -> Verdict:
    """Return the verdict of a run's checks."""
    void = run.checks.without_value
    by_value = [c for c in run.checks.failed if not c.void and c.symbol != "n_failed"]
    beyond = _titles(check for check in void if check.compared > 1.0)
    failures = failed_runs(run.runs, run.rules, run.moved)
    each = (*run.runs.values(), *run.moved.values())
    every = [data for bounds in each for data in bounds.values()]
    return Verdict(
        by_value=len(by_value),
        worst=_worst(by_value),
        without_value=len(void),
        beyond=beyond,
        within=[title for title in _titles(void) if title not in beyond],
        failures=Table(
            ("level", "bound", "failed", "cause", "motions"),
            [(f.level, f.bound, f"{f.failed} / {f.of}", f.cause, f.motions) for f in failures],
            frozenset({0, 1, 3, 4}),
        ),
        failed=sum(one.failed for one in failures),
        doubtful=sum(int((data["doubts"].to_numpy() != "").sum()) for data in every),
        runs=sum(data.sizes["run"] for data in every),
    )


def _titles(checks: Iterable[Check]) -> list[str]:
    return list(dict.fromkeys(check.title for check in checks))


def _worst(checks: Iterable[Check]) -> list[tuple[Judged, str]]:
    # Of each title and level the check of the largest ratio, and the bounds of the others.
    groups: dict[tuple[str, str], list[Check]] = {}
    for check in checks:
        groups.setdefault((check.title, check.level), []).append(check)
    found = []
    for group in groups.values():
        worst = max(group, key=lambda check: check.ratio)
        others = dict.fromkeys(check.bound for check in group if check.bound != worst.bound)
        found.append((judged(worst), ", ".join(others)))
    return found


def css_string(text: str) -> Markup:
    """Return a text as a string of a style sheet inside a page, quotes included."""
    plain = " ".join(text.split())
    safe = "".join(c if c.isalnum() or c in " .,:;/-_()" else f"\\{ord(c):x} " for c in plain)
    return Markup(f'"{safe}"')  # noqa: S704  (nothing is left that ends a string or a tag)
