"""Requirements of single codes on measured loops: equal specimens, cycles like the third."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.calculation.check import Check
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.registry import DesignCode
    from frames.design.testing.loops import Cycle, PrototypeTest

OF_MEAN, OF_ANOTHER, OF_THIRD = 0.15, 0.10, 0.25
"""Shares in the words of the values "specimens" of ASCE 7-22 and NCh2745, and "accepted cycles" of
EN 1998."""

_THIRD = 2


class _Compared(NamedTuple):
    # A number of a cycle or a specimen, and its limit.
    label: str
    value: float
    against: float


def checks_of_code(
    code: DesignCode, name: str, tests: Sequence[PrototypeTest], capacity: float
) -> list[Check]:
    """Return a code's own requirements on the loops of one set, besides the common limits."""
    found, by_specimen = [], _by_specimen(tests)
    below = all(max(c.highest, -c.lowest) <= capacity for c in chain(*by_specimen.values()))
    specimens, cycles = code.values.get("specimens"), code.values.get("accepted cycles")
    if specimens is not None and len(by_specimen) > 1:
        if code.name == "NCh2745":
            means = _means(by_specimen)
            title = "effective stiffness of specimens, off the least of them"
            found.append(_check(specimens, title, name, means, "N/m", OF_ANOTHER))
        elif below:
            each = _cycle_by_cycle(by_specimen)
            title = "post-elastic stiffness of specimens, off their mean"
            found.append(_check(specimens, title, name, each, "N/m", OF_MEAN))
    if cycles is not None and below:
        third = [part for test in tests for part in _against_the_third(test)]
        if third:
            title = "friction of each cycle, off that of the third"
            found.append(_check(cycles, title, name, third, "", OF_THIRD))
    return found


def _by_specimen(tests: Sequence[PrototypeTest]) -> dict[str, list[Cycle]]:
    found: dict[str, list[Cycle]] = {}
    for test in tests:
        found.setdefault(test.specimen, []).extend(test.cycles)
    return found


def _means(by_specimen: dict[str, list[Cycle]]) -> list[_Compared]:
    # As many cycles as all specimens have.
    count = min(map(len, by_specimen.values()))
    means = {
        name: sum(cycle.stiffness for cycle in each[:count]) / count
        for name, each in by_specimen.items()
    }
    least = min(means.values())
    return [_Compared(name, value, least) for name, value in means.items()]


def _cycle_by_cycle(by_specimen: dict[str, list[Cycle]]) -> list[_Compared]:
    # As many cycles as all specimens have.
    found = []
    for k, cycles in enumerate(zip(*by_specimen.values(), strict=False), start=1):
        slopes = [sum(cycle.slopes) / 2.0 for cycle in cycles]
        mean = sum(slopes) / len(slopes)
        found += [
            _Compared(f"{name}, cycle {k}", slope, mean)
            for name, slope in zip(by_specimen, slopes, strict=True)
        ]
    return found


def _against_the_third(test: PrototypeTest) -> list[_Compared]:
    frictions = [cycle.friction for cycle in test.cycles]
    if len(frictions) <= _THIRD:
        return []
    who = f"{test.specimen}, " if test.specimen else ""
    return [
        _Compared(f"{who}cycle {k}", friction, frictions[_THIRD])
        for k, friction in enumerate(frictions, start=1)
    ]


def _check(
    value: CodeValue, title: str, name: str, compared: list[_Compared], unit: str, share: float
) -> Check:
    t = Trace()
    t.given_each("v", [each.value for each in compared], unit)
    t.given_each("v_0", [each.against for each in compared], unit, note="held against")
    t.given("dev_lim", share, shown="%", note=value.what)
    t.each("dev", "abs(v / v_0 - 1)", shown="%")
    judge = CheckBuilder(t, "", value.standing)
    subjects = tuple(f"{name}, {each.label}" for each in compared)
    return judge.worst(value.clause, title, "dev", "<=", "dev_lim", subjects=subjects)
