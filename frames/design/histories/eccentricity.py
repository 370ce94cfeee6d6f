"""Accidental eccentricity: how far runs with the floors' masses moved raise demands."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design._errors import CheckError
from frames.design.histories.suite import (
    Amplification,
    Suite,
    motion_of,
    names_of,
    peaks_of_runs,
    suite_of,
)
from frames.results.quantities import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from frames._types import FloatArray
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules

WAYS: Mapping[str, tuple[float, float]] = {
    "+x": (1.0, 0.0),
    "-x": (-1.0, 0.0),
    "+y": (0.0, 1.0),
    "-y": (0.0, -1.0),
}
"""Ways in which masses are moved, as shares along x and y of the accidental eccentricity."""

WAY = "masses_moved"
"""Coordinate of runs that says which way the masses were moved."""

_RAISED = sorted(
    (name for name, quantity in QUANTITIES.items() if quantity.raised),
    key=lambda name: (QUANTITIES[name].raised == "difference", QUANTITIES[name].kind == "final"),
)
"""Quantities that moved masses raise. Of rims none of which yields nothing is said."""


def raises_of(
    data: xr.Dataset, moved: xr.Dataset, rules: HistoryRules
) -> tuple[dict[str, Amplification], str]:
    """Return by what moved masses raise each quantity, the worst way each."""
    table, failed = _each_way(data, moved, rules)
    found: dict[str, Amplification] = {}
    for (name, way), (centred, reached, motions) in table.items():
        one = _raise(way, centred, reached, motions, QUANTITIES[name].raised)
        worst = found.get(name)
        if worst is None or (one.factor, one.added) > (worst.factor, worst.added):
            found[name] = one
    return found, failed


def eccentricity_table(
    runs: Mapping[str, Mapping[Bound, xr.Dataset]],
    moved: Mapping[str, Mapping[Bound, xr.Dataset]],
    rules: HistoryRules,
) -> pd.DataFrame:
    """Return what moving the masses each way does to each quantity."""
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for level, each in moved.items():
        for bound, data in each.items():
            table, failed = _each_way(runs[level][bound], data, rules)
            for (name, way), (centred, reached, motions) in table.items():
                one = _raise(way, centred, reached, motions, QUANTITIES[name].raised)
                factored = QUANTITIES[name].raised == "factor"
                rows.append(
                    {
                        "level": level,
                        "bound": bound,
                        "masses": way,
                        "quantity": name.replace("_", " "),
                        "unit": QUANTITIES[name].pure_unit,
                        "centred": centred,
                        "moved": reached,
                        "factor": one.factor if factored else math.nan,
                        "added": math.nan if factored else one.added,
                        "motions": motions,
                        "void": failed,
                    }
                )
    return pd.DataFrame(rows)


def with_moved(data: xr.Dataset, moved: xr.Dataset | None) -> xr.Dataset:
    """Return runs and those with moved masses one after the other: what single runs reached."""
    import xarray as xr

    if moved is None:
        return data
    beside = named_by_way(moved)
    own = [name for name, each in data.variables.items() if each.dims[:1] == ("run",)]
    own = [name for name in own if name in beside.variables]
    own = [name for name in own if not {"time", "step"} & {*data[name].dims, *beside[name].dims}]
    parts = [part[own].drop_vars(WAY, errors="ignore") for part in (data, beside)]
    found = xr.concat(parts, "run", data_vars="minimal", coords="minimal", compat="override")
    return found.assign_attrs(data.attrs)


def raised_suite(data: xr.Dataset, moved: xr.Dataset | None, rules: HistoryRules) -> Suite:
    """Return how the runs of one bound are taken together, accidental eccentricity with them."""
    suite = suite_of(data, rules)
    if moved is None:
        return suite
    raised, failed = raises_of(data, moved, rules)
    return replace(suite, raised=raised, moved_failed=failed)


def named_by_way(moved: xr.Dataset) -> xr.Dataset:
    """Return runs with moved masses whose motions name the way as well."""
    named = [
        f"{motion}, masses {way}"
        for motion, way in zip(moved["motion"].to_numpy(), moved[WAY].to_numpy(), strict=True)
    ]
    return moved.assign_coords(motion=("run", named))


def every_motion(data: xr.Dataset, moved: xr.Dataset | None) -> list[str]:
    """Return the motions of all runs, those with moved masses last and with their way."""
    every = [data] if moved is None else [data, named_by_way(moved)]
    return [motion_of(one, k) for one in every for k in range(one.sizes["run"])]


_OF_SUITES = (
    "status",
    "failed_at",
    "failed_where",
    "reached_time_lifted",
    "reached_gap",
    "level",
)
"""What `suite_of` and `names_of` look at, beside the runs' coordinates."""

Pairs = dict[tuple[str, str], tuple[float, float, str]]
"""Largest values with the masses where they are and moved, and of which motions, by quantity and
way."""


def pairs_by_way(
    data: xr.Dataset, moved: xr.Dataset
) -> Iterator[tuple[str, xr.Dataset, xr.Dataset]]:
    """Yield each way with its runs where the masses are and moved, of the same motions."""
    ways = [str(way) for way in moved[WAY].to_numpy()]
    for way in dict.fromkeys(ways):
        there = moved.isel(run=[k for k, each in enumerate(ways) if each == way])
        yield way, data.isel(run=[_place(data, there, k) for k in range(there.sizes["run"])]), there


def added_by_moved(
    data: xr.Dataset,
    moved: xr.Dataset | None,
    rules: HistoryRules,
    values_of: Callable[[xr.Dataset], FloatArray],
) -> tuple[FloatArray, NDArray[np.object_]]:
    """Return what moved masses add to many values, each by the way that adds most to it."""
    shape = values_of(data.isel(run=[0])).shape[1:]
    most, way_of = np.zeros(shape), np.full(shape, "", dtype=object)
    for way, here, there in () if moved is None else pairs_by_way(data, moved):
        more = suite_of(there, rules).values(values_of(there))
        more = more - suite_of(here, rules).values(values_of(here))
        larger = more > most
        most, way_of = np.where(larger, more, most), np.where(larger, way, way_of)
    return most, way_of


def _each_way(data: xr.Dataset, moved: xr.Dataset, rules: HistoryRules) -> tuple[Pairs, str]:
    # Of each way the same motions are compared, as the code counts them together. To select runs
    # takes as long as there are variables, of which few are looked at.
    wanted = (*(f"reached_{name}" for name in _RAISED), *_OF_SUITES)
    data, moved = (part[[n for n in wanted if n in part.variables]] for part in (data, moved))
    found, failed = Pairs(), []
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
                pair = [_largest(each, name, suite) for each, suite in compared]
                if name == "rim_plastic" and not any(pair):
                    continue
                found[name, way] = (pair[0], pair[1], motions)
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
    values = values.reshape(len(values), -1)
    each = [suite.value(column) for column in values.T]
    known = [value for value in each if math.isfinite(value)]
    return max(known, default=0.0) if len(names_of(data, name)) else 0.0


def _raise(way: str, centred: float, moved: float, motions: str, kind: str) -> Amplification:
    factor = added = 0.0
    if kind == "factor" and centred > 0.0:
        factor = moved / centred
    elif kind == "difference":
        added = moved - centred
    return Amplification(way, centred, moved, max(factor, 1.0), max(added, 0.0), motions)


def refuse_unlike(data: xr.Dataset, moved: xr.Dataset, bound: str) -> None:
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
