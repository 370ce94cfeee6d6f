"""Tables of the design values of time histories: demands, single motions, links."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.batch.runs import MASS_SHIFT
from frames.design.histories.eccentricity import levels_of, reached_by
from frames.design.histories.suite import by_cause, named, names_of, run_named
from frames.results.quantities import DEMANDS, JUDGED, Quantity
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from frames._types import FloatArray
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.histories.eccentricity import Case
    from frames.design.histories.suite import RunSet

COUNTED = {DEMANDS[name].demand for name in ("uplifts", "time_lifted", "gap")}
"""Rows of uplift, of which codes without uplift leave small gaps aside."""


def demand_table(cases: Sequence[Case]) -> pd.DataFrame:
    """Return the design values of time histories at each bound: see `history_demands`."""
    import pandas as pd

    rows, void = [], void_of(cases)
    for name, quantity in DEMANDS.items():
        there = [case for case in cases if case.keeps(name)]
        if there:
            row: dict[str, Any] = {"quantity": quantity.demand, "unit": quantity.pure_unit}
            row |= _numbers(there, name, quantity.sign)
            row |= {"note": _note(quantity, cases[0].rules), "void": void}
            rows.append(row)
    table = pd.DataFrame(rows).set_index("quantity")
    table.attrs = {
        "statistics": {case.bound or "value": said(case.suite) for case in cases},
        "runs": sum(len(case.failures) for case in cases),
    }
    return table


def void_of(cases: Sequence[Case]) -> str:
    """Return why a level has no values for design, by bound; empty if it has."""
    said = ((case.bound, case.suite.void) for case in cases)
    each = (
        worded("{where}: {why}", where=bound, why=void) if bound and void else void
        for bound, void in said
    )
    return joined(*each)


def _numbers(cases: Sequence[Case], name: str, sign: float) -> dict[str, Any]:
    # The cells of a row: the worst at each bound, over the bounds, and of single runs.
    cells: dict[str, Any] = {}
    envelope, where, worst, run = -math.inf, "", -math.inf, ""
    for case in cases:
        each = case.design(name)
        k = worst_place(each)
        cells[case.bound or "value"] = sign * each[k] + 0.0  # no -0
        if each[k] > envelope:
            envelope, where = each[k], names_of(case.data, name)[k]
        largest = np.nanmax(reached_by(case.every, name), axis=1, initial=-math.inf)
        if largest.max() > worst:
            worst, one = float(largest.max()), int(largest.argmax())
            run = joined(run_named(case.every, one), case.bound, by=", ")
    if not worst > 0.0 and sign > 0.0:  # it is nowhere, and in no run
        where = run = ""
    design, most = (sign * v + 0.0 if math.isfinite(v) else math.nan for v in (envelope, worst))
    return cells | {"envelope": design, "where": where, "worst": most, "run": run}


def largest_of_bounds(cases: Sequence[Case], name: str) -> FloatArray:
    """Return the largest values for design of all bounds, of each bearing.

    Shapes: result (n_bearings,).
    """
    return np.asarray(np.fmax.reduce([case.design(name) for case in cases], axis=0))


def worst_place(each: FloatArray) -> int:
    """Return the place of the largest design value; unknown values are left out."""
    return int(np.argmax(np.nan_to_num(each, nan=-math.inf)))


def _note(quantity: Quantity, rules: HistoryRules) -> str:
    if quantity.demand in COUNTED and not rules.uplift_allowed:
        return worded(
            "of any gap; a run fails above {gap:g} mm ({clause})",
            gap=1e3 * rules.least_gap,
            clause=rules.cited,
        )
    return quantity.note


def said(suite: RunSet) -> str:
    """Return the statistics of a bound's runs in words."""
    n, failed = len(suite.failed), sum(suite.failed)
    of_all = worded("{statistic} of {n} runs", statistic=suite.statistic, n=n)
    if suite.void:
        return joined("no valid value", joined(of_all, worded("{n} failed", n=failed), by=", "))
    if failed:
        counted = worded(
            "{statistic} of {n} of {all} runs", statistic=suite.statistic, n=n - failed, all=n
        )
        least = worded("at least {factor:g} medians of all", factor=suite.median_factor)
        of_all = joined(counted, least, by=", ")
    elif n == 1:
        of_all = "1 run"
    return joined(of_all, "raised by moved masses" if suite.raised else "", by=", ")


def demands_at_levels(cases: Sequence[Case]) -> pd.DataFrame:
    """Return the tables of demands of each level of the seismic action, one under the other."""
    import pandas as pd

    tables = {level: demand_table(own) for level, own in levels_of(cases).items()}
    several = len(tables) > 1
    parts = []
    for name, table in tables.items():
        void = [
            worded("level {level}, {why}", level=name, why=w) if w else "" for w in table["void"]
        ]
        parts.append(table.assign(void=void if several else table["void"], level=name))
    found = pd.concat(parts)
    each_level = {name: table.attrs["statistics"] for name, table in tables.items()}
    statistics = {
        bound: _once({name: words[bound] for name, words in each_level.items()})
        for bound in next(iter(each_level.values()))
    }
    runs = sum(table.attrs["runs"] for table in tables.values()) // len(tables)
    found.attrs = {"statistics": statistics, "at_levels": each_level, "runs": runs}
    return found


def _once(words: Mapping[str, str]) -> str:
    # Text for several, once if all are the same.
    each = (worded("{where}: {words}", where=name, words=text) for name, text in words.items())
    return next(iter(words.values())) if len({*words.values()}) == 1 else joined(*each)


def tables_of_levels(
    demands: pd.DataFrame,
) -> list[tuple[str, list[tuple[str, str]], pd.DataFrame]]:
    """Return a table of demands level by level, for people."""
    heads = {"envelope": "envelope of these", "worst": "largest of all runs", "run": "in run"}
    found = []
    for level, table in demands.groupby("level", sort=False):
        bounds: dict[str, str] = demands.attrs["at_levels"][level]
        left_out = ["void", "level", *(["envelope"] if "value" in bounds else [])]
        shown = table.drop(columns=left_out + ["note"] * int((table["note"] == "").all()))
        same = len({*bounds.values()}) == 1
        words = [("", next(iter(bounds.values())))] if same else [*bounds.items()]
        found.append((str(level), words, shown.rename(columns=heads)))
    return found


def void_said(table: pd.DataFrame) -> str:
    """Return why a table of demands has no values for design, of each level; empty if it has."""
    return joined(*dict.fromkeys(map(str, table["void"])))


def headed(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table of demands with the statistic in the head of each column."""
    statistics: dict[str, str] = table.attrs["statistics"]
    heads = {bound: joined(bound, words, by=", ") for bound, words in statistics.items()}
    heads |= {
        "envelope": "envelope of these",
        "where": "where",
        "worst": f"worst of all {table.attrs['runs']} runs",
        "run": "in run",
    }
    return table.drop(columns="void").rename(columns=heads)


def envelope_said(table: pd.DataFrame) -> str:
    """Return the definition of the envelope of a table of demands, in words."""
    return _once(table.attrs["statistics"])


_COLUMNS = {"deformation [m]": "link_deformation", "force [N]": "link_force"}


def link_demands(cases: Sequence[Case]) -> pd.DataFrame:
    """Return how far links are deformed and which forces they exert, for design."""
    import pandas as pd

    tables = []
    for case in cases:
        if not case.keeps("link_force"):
            continue
        table = pd.DataFrame({"link": names_of(case.data, "link_force")})
        table = table.assign(bound=case.bound, statistic=said(case.suite))
        for title, name in _COLUMNS.items():  # the force is last
            each = case.peaks(name)
            value, which = case.counted(each)
            table[title] = value + case.added(each)[0]
        table["motion"] = np.array(case.motions, dtype=object)[which]
        table["its force [N]"] = each[which, np.arange(len(which))]
        tables.append(table.assign(void=case.suite.void, level=case.level))
    return pd.concat(tables).set_index("level") if tables else pd.DataFrame()


def largest_of_links(table: pd.DataFrame) -> pd.DataFrame:
    """Return the row of each link and level whose force is largest of all bounds."""
    if table.empty:
        return table
    rows = table.reset_index()
    force = rows["force [N]"].fillna(-np.inf)
    return rows.loc[force.groupby([rows["level"], rows["link"]]).idxmax()].sort_index()


def demands_by_motion(cases: Sequence[Case]) -> pd.DataFrame:
    """Return each motion's value of each quantity with a mean or largest value."""
    import pandas as pd

    parts = []
    for case in cases:
        ordered = case.runs.centred + case.runs.moved
        cells: dict[str, Sequence[object] | FloatArray] = {
            "masses moved": list(map(str, ordered.of(MASS_SHIFT))),
            "motion": list(map(str, ordered.of("motion"))),
            "scale": ordered.of("scale"),
            "status": list(map(str, ordered.of("status"))),
            "failed": ["no" if one is None else "yes" for one in case.failures],
        }
        for name, quantity in JUDGED.items():
            if not case.keeps(name):
                continue
            title, unit, sign = quantity.heading, quantity.pure_unit, quantity.sign
            k = worst_place(case.design(name))
            values = np.concatenate([reached_by(one, name) for one in case.parts])
            cells[f"{title} [{unit}]"] = sign * values[:, k] + 0.0  # no -0
            where = names_of(case.data, name)
            if where != ("",):
                cells[f"{title}, at"] = [where[k]] * len(values)
                cells[f"{title}, farthest [{unit}]"] = sign * _farthest(values) + 0.0
        part = pd.DataFrame(cells)
        part.insert(0, "level", case.level)
        part.insert(1, "bound", case.bound)
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def _farthest(values: FloatArray) -> FloatArray:
    # Value of each run; NaN if nothing is known.
    known = np.where(np.isnan(values), -math.inf, values).max(axis=1)
    return np.where(np.isfinite(known), known, math.nan)


class FailedRuns(NamedTuple):
    """The runs of a level and bound that failed for one cause."""

    level: str  # level of the seismic action, and bound of the properties
    bound: str
    failed: int  # number of runs that failed, and of all runs of this level and bound
    of: int
    cause: str  # the cause in words
    first: str  # the run that failed earliest: motion, with time and place of the failure
    motions: str  # several of them

    def __str__(self) -> str:
        """Return the runs on one line, without their cause."""
        where = joined(self.level, self.bound, by=", ")
        return worded(
            "{where}: {failed} of {of} runs failed: {motions}", where=where, **self._asdict()
        )


def failed_runs(cases: Sequence[Case]) -> list[FailedRuns]:
    """Return the runs that failed, by cause, level and bound."""
    found: dict[str, list[FailedRuns]] = {}
    for case in cases:
        of = len(case.failures)
        known = zip(case.motions, case.failures, strict=True)
        own = by_cause(one and one._replace(motion=motion) for motion, one in known)
        for cause, ones in own.items():
            those = len(ones), of, cause, str(ones[0]), named(ones)
            found.setdefault(cause, []).append(FailedRuns(case.level, case.bound, *those))
    return [one for those in found.values() for one in those]
