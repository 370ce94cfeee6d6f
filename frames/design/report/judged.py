"""Checks as the report shows them: words in place of zeros that nothing may exceed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.unevaluated import NOT_EVALUATED
from frames.design.report.governs import statistic_of

if TYPE_CHECKING:
    from frames.design.calculation.check import Check
    from frames.design.calculation.trace import Trace
    from frames.design.codes.bounds import PropertyBounds

_ZERO = {0.0}  # exact: as it was given


class Line(NamedTuple):
    """A line of a calculation as the report shows it.

    Attributes
    ----------
    formula : str
        As MathML.
    source, note : str
        Clause, equation or table; what else a reader should know.
    is_given : bool
        Whether it has a value alone, no formula: on paper several such stand beside each other.
    """

    formula: str
    source: str
    note: str
    is_given: bool


class Judged(NamedTuple):
    """A check as the report shows it.

    Attributes
    ----------
    check : Check
        The check.
    demand, sign, limit, ratio : str
        As text, with units.
    statistic : str
        Of which runs the demand is.
    steps : list of Line
        Its calculation.
    """

    check: Check
    demand: str
    sign: str
    limit: str
    ratio: str
    statistic: str
    steps: list[Line]


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
