"""Checks without a demand from the model: never passed, with the reason."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from frames.design.calculation.check import Checks
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check

OF_AXIAL_FORCES = ("N", "t_up", "g", "N_land")
"""Symbols of axial force, uplift duration, gap and force of landing in checks of time histories."""

NOT_EVALUATED = "not evaluated"
"""Part of the title of a check that was not evaluated."""


def not_evaluated(checks: Iterable[Check], why: str, needs: Iterable[str] = ()) -> Checks:
    """Return checks that do not pass, because an input of them is missing."""
    symbols = tuple(needs)
    return Checks(
        _without_demand(check, why)
        if why and (not symbols or any(symbol in check.trace for symbol in symbols))
        else check
        for check in checks
    )


def _without_demand(check: Check, why: str) -> Check:
    if math.isinf(check.limit):
        return check  # no requirement
    worst = math.inf if check.relation == "<=" else -math.inf
    return replace(
        check,
        demand=worst,
        title=worded("{check}: not evaluated", check=check.title),
        scope="any",
        note=joined(why, check.note),
    )
