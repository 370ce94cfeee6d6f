"""What governs a design: the checks of the highest ratios, and of which runs their values are."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check

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
    """A bar of what governs.

    Attributes
    ----------
    check : Check
        The check.
    length : float
        Of its bar, over that of the axis [-].
    ratio : str
        Its ratio, as words where there is none.
    """

    check: Check
    length: float
    ratio: str


class Governing(NamedTuple):
    """What governs.

    Attributes
    ----------
    bars : list of Bar
        Highest ratio first.
    limit : float
        Place of the ratio 1 on the axis [-].
    """

    bars: list[Bar]
    limit: float


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
