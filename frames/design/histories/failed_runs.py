"""Runs that failed, by level, bound and cause: each once, for the console and the cover."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.histories.eccentricity import cases_of
from frames.design.histories.suite import failures_of
from lir_element.errors import RunStatus

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.histories.suite import Failure

_NAMED = 4
"""Number of failed runs of one cause that are named; the table of all motions has the others."""


class FailedRuns(NamedTuple):
    """The runs of a level and bound that failed for one cause."""

    level: str  # level of the seismic action, and bound of the properties
    bound: str
    failed: int  # number of runs that failed, and of all runs of this level and bound
    of: int
    cause: str  # the cause in words
    motions: str  # motions with time and place of the failure

    def __str__(self) -> str:
        """Return the runs and their cause on one line."""
        where = ", ".join(part for part in (self.level, self.bound) if part)
        return f"{where}: {self.failed} of {self.of} runs failed: {self.cause}: {self.motions}"


def failed_runs(
    runs: Mapping[str, Mapping[Bound, xr.Dataset]],
    rules: HistoryRules,
    moved: Mapping[str, Mapping[Bound, xr.Dataset]] | None = None,
) -> list[FailedRuns]:
    """Return the runs that failed, by level, bound and cause."""
    found = []
    for case in cases_of(runs, rules, moved):
        every = failures_of(case.every, rules)
        causes: dict[str, list[Failure]] = {}
        for one in every:
            if one is not None:
                causes.setdefault(_cause(one), []).append(one)
        found += [
            FailedRuns(case.level, case.bound, len(ones), len(every), cause, _named(ones))
            for cause, ones in causes.items()
        ]
    return found


def _cause(one: Failure) -> str:
    if one.status == "ok":
        return "a bearing lifted off"
    return RunStatus[one.status.upper()].meaning.partition(":")[0]


def _named(ones: list[Failure]) -> str:
    said = []
    for one in ones[:_NAMED]:
        at = f"{one.at:.2f} s" if math.isfinite(one.at) else ""
        where = one.where.removeprefix("bearing ").strip('"')
        there = ", ".join(part for part in (at, where) if part)
        said.append(f"{one.motion} ({there})" if there else one.motion)
    more = len(ones) - len(said)
    return "; ".join(said) + (f"; {more} more" if more else "")
