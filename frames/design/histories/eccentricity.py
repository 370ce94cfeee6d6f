"""Accidental eccentricity: how far runs with the floors' masses moved raise demands."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from frames.batch.runs import BOUND, HAZARD, WAY
from frames.design._errors import CheckError
from frames.design.histories.suite import (
    Amplification,
    Suite,
    motion_of,
    names_of,
    peaks_of_runs,
    stopped_in,
    suite_of,
)
from frames.results.quantities import QUANTITIES
from frames.results.recorded import REACHED

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from frames._types import FloatArray
    from frames.batch.runs import Runs
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules

WAYS: Mapping[str, tuple[float, float]] = {
    "+x": (1.0, 0.0),
    "-x": (-1.0, 0.0),
    "+y": (0.0, 1.0),
    "-y": (0.0, -1.0),
}
"""Ways in which masses are moved, as shares along x and y of the accidental eccentricity."""

_RAISED = sorted(
    (name for name, quantity in QUANTITIES.items() if quantity.raised),
    key=lambda name: (QUANTITIES[name].raised == "difference", QUANTITIES[name].kind == "final"),
)
"""Quantities that moved masses raise. Of rims none of which yields nothing is said."""


@dataclass(frozen=True, eq=False)
class Case:
    """Runs of a level and bound, those with moved masses beside them, and how they count."""

    data: xr.Dataset  # the runs
    # runs of motions among these with the floors' masses moved: accidental eccentricity
    moved: xr.Dataset | None
    rules: HistoryRules  # the code's
    level: str = ""  # of the seismic action, and of the properties
    bound: Bound = ""

    @cached_property
    def each_way(self) -> tuple[dict[tuple[str, str], Amplification], str]:
        """By what each way raises each quantity, and which runs with moved masses failed."""
        if self.moved is None:
            return {}, ""
        return _each_way(self.data, self.moved, self.rules)

    @cached_property
    def suite(self) -> Suite:
        """How the runs are taken together, accidental eccentricity with them."""
        table, failed = self.each_way
        found: dict[str, Amplification] = {}
        for (name, _), one in table.items():
            worst = found.get(name)
            if worst is None or (one.factor, one.added) > (worst.factor, worst.added):
                found[name] = one
        return replace(suite_of(self.data, self.rules), raised=found, moved_failed=failed)

    @cached_property
    def every(self) -> xr.Dataset:
        """The runs and those with moved masses one after the other: what single runs reached."""
        import xarray as xr

        if self.moved is None:
            return self.data
        beside = named_by_way(self.moved)
        own = [name for name, each in self.data.variables.items() if each.dims[:1] == ("run",)]
        own = [name for name in own if name in beside.variables]
        timed = {"time", "step"}
        own = [n for n in own if not timed & {*self.data[n].dims, *beside[n].dims}]
        parts = [part[own].drop_vars(WAY, errors="ignore") for part in (self.data, beside)]
        found = xr.concat(parts, "run", data_vars="minimal", coords="minimal", compat="override")
        return found.assign_attrs(self.data.attrs)

    @property
    def motions(self) -> list[str]:
        """The motions of all runs, those with moved masses last and with their way."""
        every = [self.data] if self.moved is None else [self.data, named_by_way(self.moved)]
        return [motion_of(one, k) for one in every for k in range(one.sizes["run"])]

    def keeps(self, name: str) -> bool:
        """Return whether the runs have a quantity."""
        return REACHED + name in self.data.variables

    def design(self, name: str) -> FloatArray:
        """Return the values for design of a quantity at each of its places.

        Shapes: result (m,).
        """
        columns = reached_by(self.data, name)
        if self.suite.void and QUANTITIES[name].kind == "final" and np.isnan(columns).any():
            return np.full(columns.shape[1], math.nan)
        return self.suite.values(columns, name)

    def all_runs(self, values_of: Callable[[xr.Dataset], FloatArray]) -> FloatArray:
        """Return values of the runs, then of those with moved masses."""
        both = [self.data] if self.moved is None else [self.data, self.moved]
        return np.concatenate([values_of(one) for one in both])

    def added(
        self, values_of: Callable[[xr.Dataset], FloatArray]
    ) -> tuple[FloatArray, NDArray[np.object_]]:
        """Return what moved masses add to many values, each by the way that adds most to it.

        Nothing where runs failed: then values are what runs reached.
        """
        shape = values_of(self.data.isel(run=[0])).shape[1:]
        most, way_of = np.zeros(shape), np.full(shape, "", dtype=object)
        if self.moved is None or self.suite.void:
            return most, way_of
        for way, here, there in pairs_by_way(self.data, self.moved):
            pair = (suite_of(one, self.rules).values(values_of(one)) for one in (here, there))
            more = -np.subtract(*pair)
            larger = more > most
            most, way_of = np.where(larger, more, most), np.where(larger, way, way_of)
        return most, way_of


def cases_of(runs: Runs, rules: HistoryRules) -> list[Case]:
    """Return the runs of each level and bound, moved ones beside them."""
    found = []
    for (level, bound), own in runs.by(HAZARD, BOUND).items():
        moved = own.moved.data if len(own.moved) else None
        found.append(case_of(own.centred.data, moved, rules, level, cast("Bound", bound)))
    return found


def case_of(
    data: xr.Dataset, moved: xr.Dataset | None, rules: HistoryRules, level: str, bound: Bound
) -> Case:
    """Return the case of a level and bound; runs that do not belong together are refused."""
    _refuse_runs(data, bound)
    if moved is not None:
        _refuse_unlike(data, moved, bound)
    return Case(data, moved, rules, level, bound)


def levels_of(cases: Sequence[Case]) -> dict[str, list[Case]]:
    """Return cases by their level of the seismic action."""
    return {
        level: [case for case in cases if case.level == level]
        for level in dict.fromkeys(case.level for case in cases)
    }


def reached_by(data: xr.Dataset, name: str) -> FloatArray:
    """Return what runs reached at each place of a quantity.

    Shapes: result (n_runs, m).
    """
    values = peaks_of_runs(data, name)
    values = values.reshape(len(values), -1).copy()
    if QUANTITIES[name].kind == "final":
        values[stopped_in(data)] = math.nan
    return values


def eccentricity_table(cases: Sequence[Case]) -> pd.DataFrame:
    """Return what moving the masses each way does to each quantity."""
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


def named_by_way(moved: xr.Dataset) -> xr.Dataset:
    """Return runs with moved masses whose motions name the way as well."""
    named = [
        f"{motion}, masses {way}"
        for motion, way in zip(moved["motion"].to_numpy(), moved[WAY].to_numpy(), strict=True)
    ]
    return moved.assign_coords(motion=("run", named))


_OF_SUITES = (
    "status",
    "failed_at",
    "failed_where",
    "reached_time_lifted",
    "reached_gap",
    "level",
)
"""What `suite_of` and `names_of` look at, beside the runs' coordinates."""


def pairs_by_way(
    data: xr.Dataset, moved: xr.Dataset
) -> Iterator[tuple[str, xr.Dataset, xr.Dataset]]:
    """Yield each way with its runs where the masses are and moved, of the same motions."""
    ways = [str(way) for way in moved[WAY].to_numpy()]
    for way in dict.fromkeys(ways):
        there = moved.isel(run=[k for k, each in enumerate(ways) if each == way])
        yield way, data.isel(run=[_place(data, there, k) for k in range(there.sizes["run"])]), there


def _each_way(
    data: xr.Dataset, moved: xr.Dataset, rules: HistoryRules
) -> tuple[dict[tuple[str, str], Amplification], str]:
    # By what each way raises each quantity, and which runs failed. Of each way the same motions
    # are compared, as the code counts them together. To select runs takes as long as there are
    # variables, of which few are looked at.
    wanted = (*(f"reached_{name}" for name in _RAISED), *_OF_SUITES)
    data, moved = (part[[n for n in wanted if n in part.variables]] for part in (data, moved))
    found, failed = dict[tuple[str, str], Amplification](), []
    for way, here, there in pairs_by_way(data, moved):
        suites = suite_of(here, rules), suite_of(there, rules)
        if any(suites[1].failed):
            failed.append(f"masses moved {way}: {suites[1].reason}")
        elif suites[0].void:  # what moved masses are compared with
            failed.append(f"masses where they are: {suites[0].void}")
        whole = there.sizes["run"] == data.sizes["run"]
        motions = f"{suites[1].statistic} of all {there.sizes['run']} motions"
        if not whole:
            motions = ", ".join(motion_of(there, k) for k in range(there.sizes["run"]))
        compared = tuple(zip((here, there), suites, strict=True))
        for name in _RAISED:
            if f"reached_{name}" in data and f"reached_{name}" in there:
                centred, reached = (_largest(each, name, suite) for each, suite in compared)
                if name != "rim_plastic" or centred or reached:
                    found[name, way] = _raise(way, centred, reached, motions, name)
    return found, "; ".join(dict.fromkeys(failed))


def _place(data: xr.Dataset, moved: xr.Dataset, k: int) -> int:
    # The run of the same motion and scale.
    motion, scale = str(moved["motion"].to_numpy()[k]), float(moved["scale"][k])
    for place, (name, factor) in enumerate(
        zip(data["motion"].to_numpy(), data["scale"].to_numpy(), strict=True)
    ):
        if str(name) == motion and math.isclose(float(factor), scale, rel_tol=1e-12):
            return place
    msg = (
        f"moved: the motion {motion!r} at the scale {scale:g} is not among the runs: give runs of "
        "the same motions"
    )
    raise CheckError(msg)


def _largest(data: xr.Dataset, name: str, suite: Suite) -> float:
    values = peaks_of_runs(data, name)
    each = suite.values(values.reshape(len(values), -1))
    known = each[np.isfinite(each)]
    return float(known.max()) if len(known) else 0.0


def _raise(way: str, centred: float, moved: float, motions: str, name: str) -> Amplification:
    factor, added, kind = 0.0, 0.0, QUANTITIES[name].raised
    if kind == "factor" and centred > 0.0:
        factor = moved / centred
    elif kind == "difference":
        added = moved - centred
    return Amplification(way, centred, moved, max(factor, 1.0), max(added, 0.0), motions)


def _refuse_runs(data: xr.Dataset, bound: str) -> None:
    """Refuse runs that are not of one structure each, whole, each motion once."""
    what = f"runs at the bound {bound!r}" if bound else "runs"
    if "run" not in data.dims or "status" not in data.variables:
        msg = f"{what}: no dimension 'run': give the Dataset of time_histories"
        raise CheckError(msg)
    if data.attrs.get("status", "ok") != "ok":
        msg = f"{what}: the batch was interrupted, runs are missing: run it again"
        raise CheckError(msg)
    if "reached_uplifts" not in data.variables:
        msg = f"{what}: none could begin: {data['message'].to_numpy()[0]}"
        raise CheckError(msg)
    models = sorted({str(name) for name in data["model"].to_numpy()})
    if len(models) != 1:
        msg = f"{what}: there are {len(models)} structures, {', '.join(models)}: give one a bound"
        raise CheckError(msg)
    motions = [str(name) for name in data["motion"].to_numpy()]
    twice = [name for name in motions if motions.count(name) > 1]
    if twice:
        msg = f"{what}: the motion {twice[0]!r} is there twice: give each at one scale"
        raise CheckError(msg)


def _refuse_unlike(data: xr.Dataset, moved: xr.Dataset, bound: str) -> None:
    """Refuse runs with moved masses that do not belong to others."""
    what = f"moved at the bound {bound!r}" if bound else "moved"
    if "run" not in moved.dims or WAY not in moved.coords:
        msg = f"{what}: no coordinate {WAY!r} along 'run': name the way of each run, '+x'"
        raise CheckError(msg)
    odd = {*map(str, np.unique(moved[WAY].to_numpy()))} - {*WAYS}
    if odd:
        msg = f"{what}: masses_moved = {min(odd)!r} must be one of {', '.join(WAYS)}"
        raise CheckError(msg)
    if "reached_uplifts" not in moved.variables:
        msg = f"{what}: none could begin: {moved['message'].to_numpy()[0]}"
        raise CheckError(msg)
    if names_of(data, "displacement") != names_of(moved, "displacement"):
        msg = f"{what}: its bearings are others than those of the runs: give runs of one structure"
        raise CheckError(msg)
