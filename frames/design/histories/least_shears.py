"""Least shears of time histories: where runs give less, forces for design are raised to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import standing_in
from frames.design.codes.secant import CheckBuilder
from frames.design.histories.suite import peaks_of_runs

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.codes.outcome import BoundResult
    from frames.design.histories.eccentricity import Case

BASE = "base shear of time histories"
STOREY = "storey shear of time histories"
LEAST = "least one, of the equivalent-linear analysis"


class Raise(NamedTuple):
    """Factors on the earthquake's part of forces and drifts, 1 at least."""

    # above the isolation: the larger ratio of least shear to that of the runs, of the lowest
    # storey and at the base
    above: float = 1.0
    isolation: float = 1.0  # of what bearings exert, and below: that at the base


def shear_checks(case: Case, known: BoundResult, storey: str = "", note: str = "") -> list[Check]:
    """Return the shears of runs against their least values, at the base and over it.

    Less is no failure: it is the shear to design for, and the ratio the factor on the forces.
    """
    data, suite, rules = case.data, case.suite, case.rules
    clause = f"{rules.cited} {rules.force_clause}".strip()

    def judged(t: Trace, title: str, symbol: str, subject: str, what: str) -> Check:
        demand, least = t.value(symbol), t.value("V_least")
        more = ""
        if not suite.void and 0.0 < demand < least:
            more = f"{what} are raised by {least / demand:.4g}"
        said = "; ".join(part for part in (more, note) if part)
        standing = standing_in(rules.code, "history minima")
        judge = CheckBuilder(t, known.bound, standing, void=suite.void).of("minimum")
        return judge.worst(clause, title, symbol, ">=", "V_least", subjects=(subject,), note=said)

    t = Trace()
    suite.enter(t, "V", peaks_of_runs(data, "base_shear"), "N")
    t.given("V_least", known.trace.value("V_b_dyn"), "N", note=LEAST)
    found = [judged(t, BASE, "V", "", "forces and drifts")]
    if not storey:
        return found
    if not case.keeps("storey_shear"):
        msg = "runs have no storey shears (reached_storey_shear): compute them anew"
        raise CheckError(msg)
    t = Trace()
    suite.enter(t, "V_st", peaks_of_runs(data, "storey_shear")[:, 0], "N")
    t.given("R_I", known.trace.value("R_I"), source=known.trace["R_I"].source)
    suite.form(t, "V_run", "V_st / R_I", "N", of="V_st")
    t.given("V_s", known.trace.value("V_s"), "N", note="of the equivalent-linear analysis")
    t.given("a_dyn", known.trace.value("a_dyn"), source=known.trace["a_dyn"].source)
    t("V_least", "a_dyn * V_s", "N")
    what = "forces and drifts above the isolation"
    return [*found, judged(t, STOREY, "V_run", storey, what)]


def raise_of(checks: list[Check]) -> Raise:
    """Return by what the least shears raise forces."""
    factors = {BASE: 1.0, STOREY: 1.0}
    for check in checks:
        if not check.void and check.demand > 0.0:
            factors[check.title] = max(check.limit / check.demand, 1.0)
    return Raise(above=max(factors.values()), isolation=factors[BASE])


def raises_by_case(checks: Iterable[Check]) -> dict[tuple[str, str], Raise]:
    """Return by what the least shears raise the forces of runs."""
    cases: dict[tuple[str, str], list[Check]] = {}
    for check in checks:
        if check.scope == "minimum" and check.title in {BASE, STOREY}:
            cases.setdefault((check.level, check.bound), []).append(check)
    return {case: raise_of(each) for case, each in cases.items()}
