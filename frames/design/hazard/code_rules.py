"""Rules of codes for spectra and motions, and the one table of all codes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import MotionError
from frames.design.calculation.standing import FROM_MEMORY, Standing
from lir_element.argument_checks import require_between, require_choice

if TYPE_CHECKING:
    from collections.abc import Callable


def damping_factor(code: str, damping: float) -> float:
    """Return the factor by which a code divides a spectrum of 5 % damping.

    Examples
    --------
    >>> damping_factor("ASCE 7-22", 0.25)
    1.6
    """
    rule = rules_named(code).damping
    ratio = require_between("damping", damping, 0.0, 1.0, remedy="5 % is 0.05", error=MotionError)
    return rule.factor(ratio)


LINEAR = "linear between the values, constant outside of them"
"""Interpolation of factors between those of a table."""


class DampingRule(NamedTuple):
    """Damping factors of one code, by a table or by a formula.

    Attributes
    ----------
    source : str
        Clause of the code.
    rule : str
        The formula, or how values between those of the table are found.
    standing : Standing
        Source of the rule and its values.
    table : tuple of (float, float)
        Damping [-] and factor B [-]; empty if a formula gives them.
    formula : callable, optional
        B [-] of the damping [-], if there is no table.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rule = code_named("EN 1998").damping
    >>> rule.source, rule.standing.kind
    ('EN 1998-1:2004, 3.2.2.2(3)', 'agrees')
    """

    source: str
    rule: str
    standing: Standing = FROM_MEMORY
    table: tuple[tuple[float, float], ...] = ()
    formula: Callable[[float], float] | None = None

    def factor(self, damping: float) -> float:
        """Return B [-] at a part of the critical damping [-]."""
        if self.formula is not None:
            return self.formula(damping)
        known, factors = np.array(self.table).T
        return float(np.interp(damping, known, factors))


class ScalingRule(NamedTuple):
    """Rule of a code for the mean spectrum of a set of motions, and its range of periods.

    Attributes
    ----------
    name : str
        Name in `MotionSet.scaled_to` and `motion_checks`.
    measure : str
        Measure of a pair (`frames.design.hazard.motion_measures.MEASURES`).
    part : float
        Least value of the mean, as a share of the target [-].
    at_zero : float
        The same at the period zero [-]; 0 if there is no such rule.
    least : int
        Number of pairs from which the mean response may be used.
    clause : str
        Clause of the code.
    periods : (float, float)
        Range of periods over the shortest and the longest effective period of the bounds [-].
    fault_axes : bool
        True if near-fault pairs are to be turned to the axes of the fault.
    standing : Standing
        Source of clause, share and range.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rule = code_named("ASCE 7-22").scaling[0]
    >>> rule.measure, rule.part, rule.periods
    ('RotD100', 1.0, (0.75, 1.25))
    """

    name: str
    measure: str
    part: float
    at_zero: float
    least: int
    clause: str
    periods: tuple[float, float]
    fault_axes: bool = False
    standing: Standing = FROM_MEMORY


@dataclass(frozen=True, kw_only=True, eq=False)
class HazardRules:
    """Rules of a code for spectra and motions: the base of `frames.design.DesignCode`.

    Parameters
    ----------
    name : str
        The one spelling of the code.
    aliases : tuple of str
        Other spellings that are understood.
    damping : DampingRule
        Factors by which a spectrum of 5 % damping is divided.
    scaling : tuple of ScalingRule
        Scaling of motions: the code's own rule first, then others by their names.
    """

    name: str
    aliases: tuple[str, ...] = ()
    damping: DampingRule
    scaling: tuple[ScalingRule, ...]


_KNOWN: dict[str, HazardRules] = {}
"""The one table of codes, by their names; `frames.design.register_code` fills it."""


def known_rules() -> tuple[HazardRules, ...]:
    """Return all codes that are registered."""
    return tuple(_KNOWN.values())


def known_names() -> tuple[str, ...]:
    """Return the names of all codes that are registered."""
    return tuple(_KNOWN)


def add_rules(code: HazardRules, *, replace: bool = False) -> None:
    """Enter a code in the table."""
    words = {code.name, *code.aliases, *(rule.name for rule in code.scaling)}
    for other in _KNOWN.values():
        if other is code or (replace and other.name == code.name):
            continue
        twice = words & {other.name, *other.aliases, *(rule.name for rule in other.scaling)}
        if twice:
            msg = (
                f"name {sorted(twice)[0]!r} belongs to {other.name!r}: choose another name, or set "
                "replace=True to replace a code of the same name"
            )
            raise MotionError(msg)
    _KNOWN[code.name] = code


def remove_rules(name: str) -> None:
    """Remove a code from the table, for tests."""
    _KNOWN.pop(name, None)


def canonical(name: str) -> str:
    """Return the one spelling of a code; any other name is returned unchanged."""
    for code in _KNOWN.values():
        if name == code.name or name in code.aliases:
            return code.name
    return name


def rules_named(name: str, error: type[ValueError] = MotionError) -> HazardRules:
    """Return a code by its name or another spelling."""
    spelled = canonical(name)
    require_choice("code", spelled, known_names(), error=error)
    return _KNOWN[spelled]


_FORMER = {"ASCE 7-10": "ASCE 7-16"}
"""Rules by names that they had: range and measure of "ASCE 7-10" were those of ASCE 7-16."""


def scaling_named(name: str, error: type[ValueError] = MotionError) -> ScalingRule:
    """Return a rule by which motions are scaled."""
    rules = {rule.name: rule for code in _KNOWN.values() for rule in code.scaling}
    current = name if name in rules else _FORMER.get(name, name)
    if current in rules:
        return rules[current]
    spelled = canonical(name)
    if spelled in _KNOWN:
        return _KNOWN[spelled].scaling[0]
    msg = f"rule = {name!r}: choose one of {tuple(rules)}"
    raise error(msg)
