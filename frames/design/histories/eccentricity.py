"""Runs of a level and bound as a code counts them, accidental eccentricity with them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from frames.batch.runs import BOUND, HAZARD, MASS_SHIFT
from frames.design._errors import CheckError
from frames.design.histories.suite import (
    Failure,
    RunSet,
    TorsionFactor,
    failures_of,
    motion_of,
    names_of,
    peaks_of_runs,
    stopped_in,
    suite_of_failures,
)
from frames.results.quantities import QUANTITIES
from frames.results.recorded import PEAK
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence

    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from frames._types import BoolArray, FloatArray, IntArray
    from frames.batch.runs import Runs
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules

WAYS: Mapping[str, tuple[float, float]] = {
    "+x": (1.0, 0.0),
    "-x": (-1.0, 0.0),
    "+y": (0.0, 1.0),
    "-y": (0.0, -1.0),
}
"""Directions of moved masses, as shares along x and y of the accidental eccentricity."""

_RAISED = sorted(
    (name for name, quantity in QUANTITIES.items() if quantity.raised),
    key=lambda name: (QUANTITIES[name].raised == "difference", QUANTITIES[name].kind == "final"),
)
"""Quantities that moved masses raise. Rims that do not yield have no entry."""


class _Way(NamedTuple):
    # A case of moved masses: rows of the runs of the same motions with the masses in place, and
    # with moved masses, among all runs of a case, and the statistics of both.
    name: str
    own: list[int]
    rows: list[int]
    here: RunSet
    there: RunSet

    def both(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        # Design values with masses in place and moved, from the values of all runs.
        return self.here.values(values[self.own]), self.there.values(values[self.rows])


@dataclass(frozen=True, eq=False)
class Case:
    """Runs of a level and bound, some with the floors' masses moved, by the rules of a code."""

    runs: Runs  # those with moved masses are of motions among the others
    rules: HistoryRules  # the code's
    level: str = ""  # of the seismic action, and of the properties
    bound: Bound = ""

    @cached_property
    def data(self) -> xr.Dataset:
        """The runs with the masses in place."""
        return self.runs.centred.data

    @cached_property
    def moved(self) -> xr.Dataset | None:
        """The runs with moved masses: accidental eccentricity."""
        moved = self.runs.moved
        return moved.data if len(moved) else None

    @cached_property
    def failures(self) -> list[Failure | None]:
        """The failure of each run, then of those with moved masses; None of those that count."""
        return [one for part in self.parts for one in failures_of(part, self.rules)]

    @cached_property
    def ways(self) -> list[_Way]:
        """The directions of the moved masses, with the compared runs of each."""
        if self.moved is None:
            return []
        found, count, names = [], self.data.sizes["run"], self.moved[MASS_SHIFT].to_numpy().tolist()
        for name in dict.fromkeys(names):
            places = [k for k, each in enumerate(names) if each == name]
            own, rows = (
                [_place(self.data, self.moved, k) for k in places],
                [count + k for k in places],
            )
            failures = [[self.failures[k] for k in each] for each in (own, rows)]
            suites = (suite_of_failures(each, self.rules) for each in failures)
            found.append(_Way(str(name), own, rows, *suites))
        return found

    @cached_property
    def each_way(self) -> tuple[dict[tuple[str, str], TorsionFactor], str]:
        """Factors of each case on each quantity, and failed runs with moved masses."""
        found, failed = dict[tuple[str, str], TorsionFactor](), []
        raised = [name for name in _RAISED if all(PEAK + name in each for each in self.parts)]
        for way in self.ways:
            if any(way.there.failed):
                why = way.there.reason
                failed.append(worded("masses moved {way}: {why}", way=way.name, why=why))
            elif way.here.void:  # reference of the moved masses
                failed.append(worded("masses not moved: {why}", why=way.here.void))
            motions = worded(
                "{statistic} of all {n} motions", statistic=way.there.statistic, n=len(way.rows)
            )
            if len(way.rows) != self.data.sizes["run"]:
                motions = joined(*(motion_of(self.data, k) for k in way.own), by=", ")
            for name in raised:
                centred, moved = map(_largest, way.both(_flat(self.peaks(name))))
                if name != "rim_plastic" or centred or moved:
                    found[name, way.name] = _raise(way.name, centred, moved, motions, name)
        return found, joined(*dict.fromkeys(failed))

    @cached_property
    def suite(self) -> RunSet:
        """Statistics of the runs, with accidental eccentricity."""
        table, failed = self.each_way
        found: dict[str, TorsionFactor] = {}
        for (name, _), one in table.items():
            worst = found.get(name)
            if worst is None or (one.factor, one.added) > (worst.factor, worst.added):
                found[name] = one
        own = suite_of_failures(self.failures[: self.data.sizes["run"]], self.rules)
        return replace(own, raised=found, moved_failed=failed)

    @property
    def parts(self) -> list[xr.Dataset]:
        """The runs, and those with moved masses if there are any."""
        return [self.data] if self.moved is None else [self.data, self.moved]

    @cached_property
    def every(self) -> xr.Dataset:
        """The runs followed by those with moved masses: values of single runs."""
        import xarray as xr

        if self.moved is None:
            return self.data
        parts = [self.data, named_by_way(self.moved)]
        kept = [name for name in self.data.variables if all(_is_of_runs(p, name) for p in parts)]
        parts = [part[kept].drop_vars(MASS_SHIFT, errors="ignore") for part in parts]
        found = xr.concat(parts, "run", data_vars="minimal", coords="minimal", compat="override")
        return found.assign_attrs(self.data.attrs)

    @property
    def motions(self) -> list[str]:
        """The motions of all runs, those with moved masses last and with their direction."""
        return [motion_of(self.every, k) for k in range(self.every.sizes["run"])]

    def keeps(self, name: str) -> bool:
        """Return whether the runs have a quantity."""
        return PEAK + name in self.data.variables

    def design(self, name: str) -> FloatArray:
        """Return the values for design of a quantity at each of its places.

        Shapes: result (m,).
        """
        columns = reached_by(self.data, name)
        if self.suite.void and QUANTITIES[name].kind == "final" and np.isnan(columns).any():
            return np.full(columns.shape[1], math.nan)
        return self.suite.values(columns, name)

    def peaks(self, name: str) -> FloatArray:
        """Return the peaks of a quantity in the runs, then with moved masses, (n_runs, ...)."""
        return np.concatenate([peaks_of_runs(one, name) for one in self.parts])

    def counted(self, values: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return the value for design of those of all runs, and which that counts is farthest."""
        suite, own = self.suite, self.data.sizes["run"]
        counts: BoolArray = np.full(len(values), True)  # no moved run may fail
        if suite.is_usable:  # else those that failed count, too
            counts[:own] = ~np.array(suite.failed)
        known = np.where(counts.reshape(-1, *(1,) * (values.ndim - 1)), values, -np.inf)
        which = np.asarray(np.nan_to_num(known, nan=-np.inf).argmax(axis=0))
        return suite.values(values[:own]), which

    def added(self, values: FloatArray) -> tuple[FloatArray, NDArray[np.object_]]:
        """Return the increments by moved masses, and the direction of the largest one.

        No increment if runs failed: the values are then those of the runs.
        """
        most, way_of = np.zeros(values.shape[1:]), np.full(values.shape[1:], "", dtype=object)
        for way in () if self.suite.void else self.ways:
            here, there = way.both(values)
            larger = there - here > most
            most, way_of = np.where(larger, there - here, most), np.where(larger, way.name, way_of)
        return most, way_of


def cases_of(runs: Runs, rules: HistoryRules) -> list[Case]:
    """Return the cases of each level and bound; runs that do not belong together are refused."""
    found = []
    for (level, bound), own in runs.by(HAZARD, BOUND).items():
        if not len(own.centred):
            msg = f"moved has runs at the bound {bound!r}, runs has none: add them to runs"
            raise CheckError(msg)
        case = Case(own, rules, level, cast("Bound", bound))
        _refuse_runs(case.data, bound)
        if case.moved is not None:
            _refuse_unlike(case.data, case.moved, bound)
        found.append(case)
    return found


def levels_of(cases: Sequence[Case]) -> dict[str, list[Case]]:
    """Return cases by their level of the seismic action."""
    return {
        level: [case for case in cases if case.level == level]
        for level in dict.fromkeys(case.level for case in cases)
    }


def reached_by(data: xr.Dataset, name: str) -> FloatArray:
    """Return the peaks of the runs at each place of a quantity.

    Shapes: result (n_runs, m).
    """
    values = _flat(peaks_of_runs(data, name)).copy()
    if QUANTITIES[name].kind == "final":
        values[stopped_in(data)] = math.nan
    return values


def _flat(values: FloatArray) -> FloatArray:
    return values.reshape(len(values), -1)


def eccentricity_table(cases: Sequence[Case]) -> pd.DataFrame:
    """Return the effect of moved masses in each direction on each quantity."""
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for case in cases:
        table, failed = case.each_way
        for (name, way), one in table.items():
            factored = QUANTITIES[name].raised == "factor"
            rows.append(
                {
                    "level": case.level,
                    "bound": case.bound,
                    "masses": way,
                    "quantity": name.replace("_", " "),
                    "unit": QUANTITIES[name].pure_unit,
                    "centred": one.centred,
                    "moved": one.moved,
                    "factor": one.factor if factored else math.nan,
                    "added": math.nan if factored else one.added,
                    "motions": one.motions,
                    "void": failed,
                }
            )
    return pd.DataFrame(rows)


def _is_of_runs(data: xr.Dataset, name: Hashable) -> bool:
    # True if a variable has one value a run, no history.
    dims = data.variables[name].dims if name in data.variables else ()
    return dims[:1] == ("run",) and not {"time", "step"} & {*dims}


def named_by_way(moved: xr.Dataset) -> xr.Dataset:
    """Return runs with moved masses, with the direction in the names of their motions."""
    named = [
        worded("{motion}, masses {way}", motion=motion, way=way)
        for motion, way in zip(
            moved["motion"].to_numpy(), moved[MASS_SHIFT].to_numpy(), strict=True
        )
    ]
    return moved.assign_coords(motion=("run", np.array(named, dtype=object)))


def _place(data: xr.Dataset, moved: xr.Dataset, k: int) -> int:
    # The run of the same motion and scale.
    motion, scale = str(moved["motion"].to_numpy()[k]), float(moved["scale"][k])
    for place, (name, factor) in enumerate(
        zip(data["motion"].to_numpy(), data["scale"].to_numpy(), strict=True)
    ):
        if str(name) == motion and math.isclose(float(factor), scale, rel_tol=1e-12):
            return place
    msg = (
        f"moved: the motion {motion!r} at the scale {scale:g} is not among the runs: use the "
        "motions and scales of the runs"
    )
    raise CheckError(msg)


def _largest(each: FloatArray) -> float:
    known = each[np.isfinite(each)]
    return float(known.max()) if len(known) else 0.0


def _raise(way: str, centred: float, moved: float, motions: str, name: str) -> TorsionFactor:
    factor, added, kind = 0.0, 0.0, QUANTITIES[name].raised
    if kind == "factor" and centred > 0.0:
        factor = moved / centred
    elif kind == "difference":
        added = moved - centred
    return TorsionFactor(way, centred, moved, max(factor, 1.0), max(added, 0.0), motions)


def _refuse_runs(data: xr.Dataset, bound: str) -> None:
    """Refuse runs that are not of one structure each, whole, each motion once."""
    what = f"runs at the bound {bound!r}" if bound else "runs"
    if data.attrs.get("status", "ok") != "ok":
        msg = f"{what}: the batch was interrupted, runs are missing: run it again"
        raise CheckError(msg)
    if "peak_uplifts" not in data.variables:
        msg = f"{what}: none could begin: {data['message'].to_numpy()[0]}"
        raise CheckError(msg)
    models = sorted({str(name) for name in data["model"].to_numpy()})
    if len(models) != 1:
        msg = (
            f"{what}: there are {len(models)} structures, {', '.join(models)}: give the runs of "
            "one structure for each friction bound"
        )
        raise CheckError(msg)
    motions = [str(name) for name in data["motion"].to_numpy()]
    twice = [name for name in motions if motions.count(name) > 1]
    if twice:
        msg = f"{what}: the motion {twice[0]!r} occurs twice: give each motion at one scale"
        raise CheckError(msg)


def _refuse_unlike(data: xr.Dataset, moved: xr.Dataset, bound: str) -> None:
    """Refuse runs with moved masses that do not belong to others."""
    what = f"moved at the bound {bound!r}" if bound else "moved"
    odd = {*map(str, np.unique(moved[MASS_SHIFT].to_numpy()))} - {*WAYS}
    if odd:
        msg = f"{what}: {MASS_SHIFT} = {min(odd)!r} must be one of {', '.join(WAYS)}"
        raise CheckError(msg)
    if "peak_uplifts" not in moved.variables:
        msg = f"{what}: none could begin: {moved['message'].to_numpy()[0]}"
        raise CheckError(msg)
    if names_of(data, "displacement") != names_of(moved, "displacement"):
        msg = f"{what}: its bearings differ from those of the runs: give runs of one structure"
        raise CheckError(msg)
