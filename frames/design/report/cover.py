"""The cover of a report with the verdict, and checks as the report shows them."""

from __future__ import annotations

import hashlib
import importlib.metadata
import math
import platform
import re
from datetime import UTC, datetime
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from frames.design.calculation.not_evaluated import NOT_EVALUATED
from frames.design.calculation.rendering import quantity
from frames.design.codes.registry import code_named
from frames.design.histories.suite_notes import marked_features
from frames.design.report.tables import Table
from lir_element._version import package_version
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.calculation.trace import Trace
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.histories.demand_table import FailedRuns
    from frames.design.project.design_run import ProjectRun


_ZERO = {0.0}  # exact: as it was given


class Line(NamedTuple):
    """A line of a calculation as the report shows it."""

    formula: str  # as MathML
    source: str  # clause, equation or table; remark for the reader
    note: str
    # true for a value without formula: in print several of them share a line
    is_given: bool


class Judged(NamedTuple):
    """A check as the report shows it."""

    check: Check
    demand: str  # as text, with units
    sign: str
    limit: str
    ratio: str
    statistic: str  # of which runs the demand is
    steps: list[Line]  # its calculation


def judged(check: Check) -> Judged:
    """Return a check as the report shows it."""
    demand, limit, ratio = check.said
    if check.void and math.isfinite(check.demand):
        demand = worded("({value})", value=quantity(check.demand, check.unit, check.shown))
    sign = "" if check.void else "≤" if check.relation == "<=" else "≥"
    if check.limit in _ZERO and check.relation == "<=":  # nothing may be there: no ratio
        limit, sign, ratio = "none allowed", "", ""
        demand = "none" if check.demand in _ZERO and not check.void else demand
    if math.isinf(check.demand):
        known = "no limit" if check.passed else NOT_EVALUATED
        demand, sign, ratio = "not known" if check.void else known, "", ""
    if math.isinf(check.limit):
        limit, sign, ratio = "no limit", "", ""
    return Judged(
        check=check,
        demand=demand,
        sign=sign,
        limit=limit,
        ratio="" if ratio == "-" else ratio,
        statistic=statistic_of(check),
        steps=_lines(check.trace),
    )


def factor_steps(bounds: PropertyBounds) -> list[tuple[str, list[Line]]]:
    """Return the calculations of factors on friction that are given by source."""
    both = {
        "Factors on the friction of the surfaces": bounds.friction,
        "Factors on the friction of the interface": bounds.interface,
    }
    return [
        (what, _lines(one.trace))
        for what, one in both.items()
        if one is not None and len(one.trace)
    ]


def _lines(trace: Trace) -> list[Line]:
    return [Line(step.mathml(), step.source, step.note, not step.formula) for step in trace]


MOST = 10
"""Largest number of checks shown."""

COUNTS = {"n", "n_failed", "n_odd", "n_spoilt", "S_mean"}
"""Symbols of checks that count motions and runs, and of the mean spectrum, which scaling brings to
its limit: while they pass, they do not describe the structure.
"""

_LARGEST_OF_RUNS = {"t_up", "g", "N_land"}
_MEAN = re.compile(r"sum\((\w+_i)\) / n\b")
_LARGEST = re.compile(r"max\((\w+_i)\)")
_SCALE = 1.25  # ratio at the end of the axis, at least


class Bar(NamedTuple):
    """A bar in the chart of governing checks."""

    check: Check
    length: float  # of its bar, over that of the axis [-]
    ratio: str  # its ratio, or words if there is none


class Governing(NamedTuple):
    """The governing checks."""

    bars: list[Bar]  # highest ratio first
    limit: float  # place of the ratio 1 on the axis [-]


def what_governs(checks: Iterable[Check]) -> Governing:
    """Return the checks of the highest ratios, of each title at each level its highest one."""
    highest: dict[tuple[str, str], Check] = {}
    for check in checks:
        if (check.passed and check.symbol in COUNTS) or check.verdict == "raised":
            continue
        key = (check.title, check.level)
        if key not in highest or check.compared > highest[key].compared:
            highest[key] = check
    first = sorted(highest.values(), key=lambda check: -check.compared)[:MOST]
    finite = [check.compared for check in first if math.isfinite(check.compared)]
    end = max([_SCALE, *(min(ratio, 2.0 * _SCALE) for ratio in finite)])
    bars = [Bar(check, min(check.compared / end, 1.0), _ratio_of(check)) for check in first]
    return Governing(bars, 1.0 / end)


def _ratio_of(check: Check) -> str:
    if check.void:
        return "no value"
    return f"{check.ratio:.2f}" if math.isfinite(check.ratio) else "not met"


def statistic_of(check: Check) -> str:
    """Return of which runs the demand of a check is."""
    found: list[str] = []
    for step in check.trace:
        for pattern, word in ((_MEAN, "mean"), (_LARGEST, "largest")):
            for runs in pattern.findall(step.formula):
                values = check.trace[runs].value
                count = len(values) if isinstance(values, tuple) else 1
                several = worded("{statistic} of {n} runs", statistic=word, n=count)
                found.append(several if count > 1 else "1 run")
        if step.note == "largest of the run":
            found.append("1 run")
    if not found and check.symbol in _LARGEST_OF_RUNS:
        return "largest of all runs"
    return joined(*dict.fromkeys(found), by=", ")


_LIBRARIES = ("numpy", "scipy", "numba", "xarray", "matplotlib")
_SHORT = 12  # letters of a digest in the foot of a page


class Cover(NamedTuple):
    """Contents of the cover and the margins."""

    people: list[tuple[str, str]]  # client, engineer, checker; empty for a signature by hand
    issue: list[tuple[str, str]]  # revision and date; empty if they were left out
    codes: list[tuple[str, str, str]]  # code and title
    # program and main libraries with their versions, Python, system
    programs: list[tuple[str, str]]
    digest: str  # SHA-256 of the project's file
    motions: str  # digest of the accelerations as they were run
    written: str  # when

    @property
    def short(self) -> str:
        """The digest in the foot of a page."""
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
    failures: Table  # runs that failed: each cause once
    failed: int  # number of runs that failed, and of all runs
    runs: int
    warnings: list[tuple[str, int]]  # what the assumption checks mark, and in how many runs


def verdict_of(run: ProjectRun) -> Verdict:
    """Return the verdict of a run's checks."""
    void = run.checks.without_value
    by_value = run.checks.by_value
    beyond, within = void.beyond_and_within
    return Verdict(
        by_value=len(by_value),
        worst=_worst(by_value),
        without_value=len(void),
        beyond=beyond,
        within=within,
        failures=_failures(run.failures),
        failed=sum(one.failed for one in run.failures),
        runs=len(run.runs),
        warnings=[
            (feature.replace("_", " "), len(those))
            for feature, those in marked_features(run.runs.parts).items()
        ],
    )


def _failures(failures: Iterable[FailedRuns]) -> Table:
    # A cause that is that of the row before is left out.
    rows, before = [], ""
    for one in failures:
        cause = "" if one.cause == before else one.cause
        rows.append((cause, one.level, one.bound, f"{one.failed} / {one.of}", one.motions))
        before = one.cause
    return Table(("cause", "level", "bound", "failed", "motions"), rows, frozenset({0, 1, 2, 4}))


def _worst(checks: Iterable[Check]) -> list[tuple[Judged, str]]:
    # For each title and level the check of the largest ratio, and the bounds of the others.
    groups: dict[tuple[str, str], list[Check]] = {}
    for check in checks:
        groups.setdefault((check.title, check.level), []).append(check)
    found = []
    for group in groups.values():
        worst = max(group, key=lambda check: check.ratio)
        others = dict.fromkeys(check.bound for check in group if check.bound != worst.bound)
        found.append((judged(worst), joined(*others, by=", ")))
    return found


def css_string(text: str) -> Markup:
    """Return a text as a string of a style sheet inside a page, quotes included."""
    plain = " ".join(text.split())
    safe = "".join(c if c.isalnum() or c in " .,:;/-_()" else f"\\{ord(c):x} " for c in plain)
    return Markup(f'"{safe}"')  # noqa: S704  (nothing is left that ends a string or a tag)
