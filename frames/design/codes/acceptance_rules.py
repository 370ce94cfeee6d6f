"""What a code accepts of the tests of bearings: one rule, and those that name a test."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.codes.code_values import CodeValue


class AcceptanceRule(NamedTuple):
    """What a code accepts of measured loops, of which tests of its programme.

    Attributes
    ----------
    tests : tuple of str
        How the names of these tests begin.
    value : CodeValue
        What is accepted, its clause, and how well it is known.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rule = code_named("ASCE 7-22").accepted[-2]
    >>> rule.tests, rule.value.clause
    (('static',), 'ASCE 7-22 17.8.4')
    """

    tests: tuple[str, ...]
    value: CodeValue

    def holds_for(self, test: str) -> bool:
        """Return whether it is of a test of the programme, by its name."""
        return test.startswith(self.tests)


def accepted_of(rules: Iterable[AcceptanceRule], test: str) -> str:
    """Return what is accepted of a test, with clauses and stars, "; " between."""
    return "; ".join(
        f"{rule.value.what} ({rule.value.standing.cited(rule.value.clause)})"
        for rule in rules
        if rule.holds_for(test)
    )
