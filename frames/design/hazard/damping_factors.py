"""Damping factors B of the codes: a spectrum of 5 % damping is divided by them."""

from __future__ import annotations

from frames._errors import MotionError
from frames.design.hazard.code_rules import rules_named
from lir_element.argument_checks import require_between


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
