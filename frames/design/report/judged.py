"""Checks as the report shows them: words in place of zeros that nothing may exceed."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.unevaluated import NOT_EVALUATED

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.calculation.trace import Trace
    from frames.design.codes.bounds import PropertyBounds


_ZERO = {0.0}  # exact: as it was given


class Line(NamedTuple):
    """A line of a calculation as the report shows it."""

    formula: str  # as MathML
    source: str  # clause, equation or table; what else a reader should know
    note: str
    # whether it has a value alone, no formula: on paper several such stand beside each other
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
"""How many checks are shown."""

COUNTS = {"n", "n_failed", "n_odd", "n_spoilt", "S_mean"}
"""Symbols of checks that count motions and runs, and of the mean spectrum, which scaling brings to
its limit: they tell nothing of the structure while they pass."""

_LARGEST_OF_RUNS = {"t_up", "g", "N_land"}
_MEAN = re.compile(r"sum\((\w+_i)\) / n\b")
_LARGEST = re.compile(r"max\((\w+_i)\)")
_SCALE = 1.25  # ratio at the end of the axis, at least


class Bar(NamedTuple):
    """A bar of what governs."""

    check: Check
    length: float  # of its bar, over that of the axis [-]
    ratio: str  # its ratio, as words where there is none


class Governing(NamedTuple):
    """What governs."""

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
                found.append(f"{word} of {count} runs" if count > 1 else "1 run")
        if step.note == "largest of the run":
            found.append("1 run")
    if not found and check.symbol in _LARGEST_OF_RUNS:
        return "largest of all runs"
    return ", ".join(dict.fromkeys(found))
