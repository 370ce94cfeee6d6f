"""The check of the worst of several: bearings, storeys, levels."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.check import Bound, Check
from frames.design.calculation.standing import Standing
from frames.design.codes.secant import CheckBuilder

if TYPE_CHECKING:
    from frames.design.calculation.trace import Trace


class Calculation(NamedTuple):
    """A calculation with its symbols of demand and limit."""

    trace: Trace
    demand: str
    limit: str


@dataclass(frozen=True)
class Governing:
    """Makes the check of what is worst."""

    bound: Bound  # properties of the bearings that it is for
    standing: Standing  # of its checks
    note: str = ""  # goes with its checks
    void: str = ""  # why its demands are no values for design

    def __call__(self, clause: str, title: str, each: Mapping[str, Calculation]) -> list[Check]:
        """Return the check of the largest ratio."""
        # where no value is finite none is the worst
        known = any(math.isfinite(c.trace.value(c.demand)) for c in each.values())
        found = [
            CheckBuilder(c.trace, self.bound, self.standing, void=self.void).worst(
                clause,
                title,
                c.demand,
                "<=",
                c.limit,
                subjects=(name if known else "",),
                note=self.note,
            )
            for name, c in each.items()
        ]
        return [max(found, key=lambda check: check.compared)] if found else []
