"""Design values of a suite of runs: mean or largest, least shears; treatment of failed runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from frames.results.peak_response import places_of, reached
from frames.results.recorded import PEAK
from lir_element.errors import RunStatus
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray, FloatArray
    from frames.design.codes.history_rules import HistoryRules


class TorsionFactor(NamedTuple):
    """Effect of the worst direction of moved masses on the largest of a quantity."""

    way: str  # direction of the moved masses, "+x"
    # the largest over bearings, storeys or levels with the masses in place, and moved
    centred: float
    moved: float
    factor: float  # moved over centred, 1 at least; 1 of a quantity that differences raise
    added: float  # moved less centred, 0 at least; 0 of a quantity that factors raise
    motions: str  # of which motions

    @property
    def said(self) -> str:
        """Definition of the factor, in words."""
        return worded(
            "accidental eccentricity: masses moved {way}, {motions}",
            way=self.way,
            motions=self.motions,
        )


@dataclass(frozen=True, kw_only=True)
class RunSet:
    """Statistics of a suite of runs."""

    # mean of the runs' largest values, the largest of them, or that of one run
    statistic: Literal["mean", "largest", "single"]
    failed: tuple[bool, ...]  # runs whose values must not count
    allowed: int = 0  # number that may fail while the mean of the others is valid
    median_factor: float = 1.2  # on the median of all runs: the least value of the mean then
    reason: str = ""  # which runs failed, in words
    source: str = ""  # clause of the statistic
    # factors of accidental eccentricity on quantities, by their names
    raised: Mapping[str, TorsionFactor] = field(default_factory=dict)
    # which runs with moved masses failed, in words: then nothing is a value for design
    moved_failed: str = ""

    @property
    def is_usable(self) -> bool:
        """True if there is a design value."""
        if self.moved_failed:
            return False
        failures = sum(self.failed)
        if self.statistic != "mean":
            return failures == 0
        return failures <= self.allowed and 2 * failures < len(self.failed)

    @property
    def void(self) -> str:
        """Reason that there is no design value; empty if there is one."""
        said = joined(self.reason, self.moved_failed)
        return "" if self.is_usable else said or "a run failed"

    def value(self, values: FloatArray, of: str = "") -> float:
        """Return the value for design of those of the runs.

        Shapes: values (n_runs,).
        """
        return float(self.values(values, of))

    def values(self, values: FloatArray, of: str = "") -> FloatArray:
        """Return the design values of many places at once, each raised for the quantity `of`.

        Shapes: values (n_runs, ...).
        """
        if not self.is_usable:
            gone = ~np.isfinite(values).any(axis=0)
            known = np.where(np.isfinite(values), values, np.nan)
            known = np.where(gone, 0.0, known)
            of_all = np.nanmean if self.statistic == "mean" else np.nanmax
            return np.asarray(np.where(gone, math.nan, of_all(known, axis=0)))
        failed, more = np.array(self.failed), self.raised.get(of)
        good = values[~failed]
        found = good.mean(axis=0) if self.statistic == "mean" else good.max(axis=0)
        if self.statistic == "mean" and failed.any():
            above = failed.reshape(-1, *(1,) * (values.ndim - 1))
            median = np.median(np.where(above, math.inf, values), axis=0)
            found = np.maximum(found, self.median_factor * median)
        return np.asarray(found if more is None else more.factor * found + more.added)

    def enter(
        self,
        t: Trace,
        symbol: str,
        values: FloatArray,
        unit: str,
        shown: str = "",
        *,
        of: str = "",
    ) -> float:
        """Enter the values of the runs and their design value.

        Shapes: values (n_runs,).
        """
        if not self.is_usable:
            value = self.value(values)
            if math.isnan(value):
                return t.given(symbol, math.inf, unit, shown=shown, note="not known: runs failed")
            why = "runs with moved masses failed"
            if any(self.failed):
                why = worded(
                    "{count} of {n} runs failed", count=sum(self.failed), n=len(self.failed)
                )
            note = joined("no valid value", why)
            return t.given(symbol, value, unit, shown=shown, note=note)
        more = self.raised.get(of)
        if more is None:
            return self._enter(t, symbol, values, unit, shown)
        own = f"{symbol}_c"  # with the masses in place
        self._enter(t, own, values, unit, shown)
        if more.added > 0.0:
            t.given(f"Delta_{symbol}", more.added, unit, shown=shown, note=more.said)
            return t(symbol, f"{own} + Delta_{symbol}", unit, shown=shown)
        t.given(f"e_{symbol}", more.factor, note=more.said)
        return t(symbol, f"e_{symbol} * {own}", unit, shown=shown)

    def _enter(self, t: Trace, symbol: str, values: FloatArray, unit: str, shown: str) -> float:
        # The statistic of the runs, step by step.
        if self.statistic == "single":
            return t.given(symbol, float(values[0]), unit, shown=shown, note="largest of the run")
        good = values[~np.array(self.failed)]
        runs = f"{symbol}_i"
        note = worded("largest of each of {n} runs", n=len(good))
        t.given_each(runs, good.tolist(), unit, shown=shown, note=note)
        if self.statistic == "largest":
            return t(symbol, f"max({runs})", unit, shown=shown, source=self.source)
        if "n" not in t:
            t.given("n", float(len(good)), note="runs")
        formula = f"sum({runs}) / n"
        if any(self.failed):
            t.given(
                f"{symbol}_50",
                self._median(values),
                unit,
                shown=shown,
                note=worded("median, {n} failed above it", n=sum(self.failed)),
            )
            t.given(f"f_{symbol}", self.median_factor)
            formula = f"max({formula}, f_{symbol} * {symbol}_50)"
        return t(symbol, formula, unit, shown=shown, source=self.source)

    def form(
        self, t: Trace, symbol: str, formula: str, unit: str, shown: str = "", *, of: str
    ) -> None:
        """Enter a result of the value `of`, of `enter`: infinite if that is infinite."""
        if math.isfinite(t.value(of)):
            t(symbol, formula, unit, shown=shown)
        else:
            t.given(symbol, math.inf, unit, shown=shown, note="not known: runs failed")

    def _median(self, values: FloatArray) -> float:
        return float(np.median(np.where(self.failed, math.inf, values)))


def peaks_of_runs(data: xr.Dataset, name: str) -> FloatArray:
    """Return the peaks of a quantity in the runs, (n_runs, ...)."""
    if "run" in data.dims:
        if PEAK + name not in data.variables:
            msg = f"the runs have no {name!r} because an earlier version made them: run them again"
            raise CheckError(msg)
        return data.variables[PEAK + name].transpose("run", ...).to_numpy()
    return reached(data, name)[None]


def names_of(data: xr.Dataset, name: str) -> tuple[str, ...]:
    """Return the names of a quantity's places: bearings, levels, storeys, lines."""
    return tuple(map(str, places_of(data, name)))


class Failure(NamedTuple):
    """A run that failed."""

    motion: str  # the motion and its scale
    status: str  # the status of the run; "ok" of a complete run in which a bearing lifted off
    at: float  # time of the failure [s]; NaN if it is not known
    where: str  # the bearing or degree of freedom

    @property
    def cause(self) -> str:
        """Why it failed, in words."""
        if self.status == "ok":
            return "a bearing lifted off"
        return RunStatus[self.status.upper()].meaning.partition(":")[0]

    def __str__(self) -> str:
        """Return motion, time and place."""
        at = worded("{time:.2f} s", time=self.at) if math.isfinite(self.at) else ""
        there = joined(at, self.where, by=", ")
        known = worded("{motion} ({there})", motion=self.motion, there=there)
        return known if there else self.motion


def by_cause(failures: Iterable[Failure | None]) -> dict[str, list[Failure]]:
    """Return runs that failed by their cause, those that failed earliest first."""
    found: dict[str, list[Failure]] = {}
    known = (one for one in failures if one is not None)
    for one in sorted(known, key=lambda one: (math.isnan(one.at), one.at)):
        found.setdefault(one.cause, []).append(one)
    return found


_NAMED = 4
"""Number of failed runs of one cause that are named; the table of all motions has the others."""


def named(failures: Sequence[Failure]) -> str:
    """Return the first of several runs that failed, and the number of the others."""
    more = len(failures) - _NAMED
    others = worded("{n} more", n=more) if more > 0 else ""
    return joined(*map(str, failures[:_NAMED]), others)


def failures_of(data: xr.Dataset, rules: HistoryRules) -> list[Failure | None]:
    """Return the failure of each run; None of those that count.

    Shapes: result (n_runs,).
    """
    status = [str(value) for value in data["status"].to_numpy()]
    torn = [False] * len(status)
    if not rules.uplift_allowed:
        torn = [bool(lifted.any()) for lifted in parted(data, rules.least_gap)]
    return [_failure(data, k) if word != "ok" or torn[k] else None for k, word in enumerate(status)]


def suite_of(data: xr.Dataset, rules: HistoryRules) -> RunSet:
    """Return the statistics of one bound's runs."""
    return suite_of_failures(failures_of(data, rules), rules)


def suite_of_failures(failures: Sequence[Failure | None], rules: HistoryRules) -> RunSet:
    """Return the statistics of runs by the failure of each."""
    return RunSet(
        statistic="mean" if len(failures) >= rules.mean_from else "largest",
        failed=tuple(one is not None for one in failures),
        allowed=rules.unacceptable_allowed,
        median_factor=rules.median_factor,
        reason=_said_of(failures),
        source=f"{rules.cited} {rules.statistic_clause}".strip(),
    )


def stopped_in(data: xr.Dataset) -> BoolArray:
    """Return the runs that failed by their status, uplift rules aside, (n_runs,)."""
    if "run" not in data.dims:
        return np.array([str(data.attrs["status"]) != "ok"])
    return np.array([str(word) != "ok" for word in data["status"].to_numpy()])


def run_named(data: xr.Dataset, k: int) -> str:
    """Return the motion of a run, and whether it failed: "one (failed)"."""
    name = motion_of(data, k)
    return worded("{motion} (failed)", motion=name) if stopped_in(data)[k] else name


def stopped_runs(data: xr.Dataset) -> str:
    """Return the runs that failed by their status and the times, in words; empty if none did."""
    stopped = stopped_in(data)
    return _said_of([_failure(data, k) if failed else None for k, failed in enumerate(stopped)])


def _said_of(failures: Sequence[Failure | None]) -> str:
    # How many of runs failed, and each cause with its runs.
    causes = by_cause(failures)
    failed = sum(map(len, causes.values()))
    count = worded("{count} of {n} runs failed", count=failed, n=len(failures))
    each = (worded("{cause}: {runs}", cause=c, runs=named(ones)) for c, ones in causes.items())
    return joined(count, *each) if causes else ""


def _failure(data: xr.Dataset, k: int) -> Failure:
    at, where = float(data["failed_at"][k]), str(data["failed_where"].to_numpy()[k])
    kind, _, name = where.partition(' "')
    if kind == "bearing":
        where = name[:-1]
    elif name:
        where = worded('{kind} "{name}"', kind=kind, name=name[:-1])
    return Failure(motion_of(data, k), str(data["status"].to_numpy()[k]), at, where)


def parted(data: xr.Dataset, least: float) -> BoolArray:
    """Return which bearings parted by more than a gap in each run.

    Shapes: result (n_runs, n_bearings).
    """
    time, gap = peaks_of_runs(data, "time_lifted"), peaks_of_runs(data, "gap")
    return np.asarray(np.where(np.isnan(gap), time > 0.0, gap > least))


def motion_of(data: xr.Dataset, k: int) -> str:
    """Return the motion of a run, with its scale if that is not 1."""
    name, scale = str(data["motion"].to_numpy()[k]), float(data["scale"][k])
    same = abs(scale - 1.0) < 1e-12
    return name if same else worded("{motion} x {scale:.4g}", motion=name, scale=scale)
