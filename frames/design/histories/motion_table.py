"""Table of what each motion gives: the values that means and largest values are taken of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames.design.histories.demand_table import worst_place
from frames.design.histories.eccentricity import WAY, cases_of, reached_by
from frames.design.histories.suite import names_of, suite_of
from frames.results.quantities import JUDGED

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd
    import xarray as xr

    from frames._types import FloatArray
    from frames.design.calculation.check import Bound
    from frames.design.codes.history_rules import HistoryRules

KEYS = ("level", "bound", "masses moved", "motion", "scale", "status", "failed")
"""Columns that say of which run a row is."""


def demands_by_motion(
    runs: Mapping[str, Mapping[Bound, xr.Dataset]],
    rules: HistoryRules,
    moved: Mapping[str, Mapping[Bound, xr.Dataset]] | None = None,
) -> pd.DataFrame:
    """Return what each motion gave of each quantity that means or largest values are taken of."""
    import pandas as pd

    parts = []
    for case in cases_of(runs, rules, moved):
        there = [case.data, *([] if case.moved is None else [case.moved])]
        cells: dict[str, Sequence[object] | FloatArray] = {
            key: [value for one in there for value in _key(one, key, rules)] for key in KEYS[2:]
        }
        for name, quantity in JUDGED.items():
            if not case.keeps(name):
                continue
            title, unit, sign = quantity.heading, quantity.pure_unit, quantity.sign
            k = worst_place(case.design(name))
            values = case.all_runs(lambda one, name=name: reached_by(one, name))  # type: ignore[misc]
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
    # Of each run; NaN where nothing is known.
    known = np.where(np.isnan(values), -math.inf, values).max(axis=1)
    return np.where(np.isfinite(known), known, math.nan)


def _key(data: xr.Dataset, key: str, rules: HistoryRules) -> Sequence[object]:
    # A column that says of which run a row is.
    if key == "masses moved":
        own = data[WAY].to_numpy() if WAY in data.coords else [""] * data.sizes["run"]
        return [str(way) for way in own]
    if key == "failed":
        return ["yes" if failed else "no" for failed in suite_of(data, rules).failed]
    return list(data[key].to_numpy()) if key == "scale" else list(map(str, data[key].to_numpy()))
