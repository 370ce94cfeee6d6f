"""What the page of buildings says, from the runs of each building on each device: plain numbers."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import time_histories
from frames.risk import LimitState
from frames.risk.fragility.runs import COMPLETE, FAILURE
from lir_element.errors import AnalysisWarning
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_runs import (
    BUILDINGS,
    HEIGHT,
    SPAN,
    Building,
    building,
    period,
    strength,
    yield_rotations,
)
from validation.study.paired import (
    LIMITS,
    OTHERS,
    WEAK,
    curve_of,
    median_of,
    on_devices,
    ratio_of,
    shares_of,
    statuses_of,
    table_of,
)
from validation.study.records_runs import COLLAPSE, STEP, ULTIMATE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames import GroundMotion
    from frames.risk import IntensityRuns
    from validation.study.paired import Curve

    Runs = Mapping[str, IntensityRuns]

RESAMPLES, FEW_RESAMPLES = 200, 100
"""Of the intervals by limit state, and of those by definition of collapse."""

FLOOR, UPLIFT = 2.0 * STANDARD_GRAVITY, 0.05
"""Floor acceleration [m/s2] and uplift [m] that may count as collapse."""

HALVED_EVERY = 3
"""Of the records one in so many is run at two steps, each with another building."""

UNHARMED = (1.0, 4.0, ULTIMATE)
"""Ductilities below which frames are counted whose bearings failed [-]."""


class Definition(NamedTuple):
    """What may be called collapse: demands over their limits, bearings that fail or not."""

    name: str
    limits: tuple[tuple[str, float], ...]
    bearings: bool = True

    def of(self, runs: IntensityRuns) -> tuple[IntensityRuns, LimitState]:
        """Return runs with the largest demand over its limit, and the limit state of 1."""
        table = runs.table
        shares = [table[quantity].to_numpy() / limit for quantity, limit in self.limits]
        changes = {"share": np.max(shares, axis=0) if shares else np.zeros(len(table))}
        if not self.bearings:
            outcome = table["outcome"].to_numpy()
            changes["outcome"] = np.where(outcome == FAILURE, COMPLETE, outcome)
        own = replace(runs, table=table.assign(**changes), units={**runs.units, "share": "1"})
        return own, LimitState(self.name, "share", 1.0)


DRIFT, PLAN_FLOOR = "storey drift, mean", "floor acceleration in plan, mean"
DEFINITIONS = (
    Definition("ductility 9 or a bearing", (("ductility", ULTIMATE),)),
    Definition("ductility 6 or a bearing", (("ductility", 6.0),)),
    Definition("ductility 12 or a bearing", (("ductility", 12.0),)),
    Definition("drift 4 % or a bearing", ((DRIFT, 0.04),)),
    Definition(
        "ductility 9, floor acceleration 2 g or a bearing",
        (("ductility", ULTIMATE), (PLAN_FLOOR, FLOOR)),
    ),
    Definition(
        "ductility 9, uplift 50 mm or a bearing",
        (("ductility", ULTIMATE), ("maximum uplift", UPLIFT)),
    ),
    Definition("a bearing alone", ()),
    Definition(
        "ductility 9 alone, as far as runs went", (("ductility", ULTIMATE),), bearings=False
    ),
    Definition("drift 4 % alone, as far as runs went", ((DRIFT, 0.04),), bearings=False),
)


def facts_of(one: Building) -> dict[str, float]:
    """Return what a building is: period, strength, slenderness, loads, sliders."""
    frame = building(one)
    bearings = [link.bearing for link in frame.bearings.values()]
    loads = [each.resolved()["design_load"] for each in bearings]
    return {
        "period": period(one),
        "strength": strength(one),
        "slenderness": one.storeys * HEIGHT / (2.0 * SPAN),
        "weight": float(sum(loads)),
        "least load": float(min(loads)),
        "largest load": float(max(loads)),
        "least slider": min(each.slider_radius for each in bearings),
        "slider height": bearings[0].slider_height,
        "largest slider": max(each.slider_radius for each in bearings),
    }


def numbers_of(runs: Runs) -> dict[str, Any]:
    """Return what is kept of a building's runs."""
    limits = {}
    for limit in LIMITS:
        curves = {name: curve_of(each, limit, RESAMPLES) for name, each in runs.items()}
        limits[limit.name] = _compared(curves) | {
            "shares": {name: shares_of(each, limit) for name, each in runs.items()}
        }
        if limit is COLLAPSE:
            limits[limit.name]["drawn"] = {name: _drawn(curve) for name, curve in curves.items()}
    definitions = {}
    for definition in DEFINITIONS:
        curves = {}
        counts = {}
        for name, each in runs.items():
            own, limit = definition.of(each)
            curves[name] = curve_of(own, limit, FEW_RESAMPLES)
            over = own.exceeded(limit)
            counts[name] = [int(np.nansum(over)), int(np.isfinite(over).sum())]
        definitions[definition.name] = _compared(curves) | {"counts": counts}
    return {
        "limits": limits,
        "definitions": definitions,
        "statuses": {name: statuses_of(each.table) for name, each in runs.items()},
        "uplift": {name: _uplift(each) for name, each in runs.items()},
        "unharmed": {name: _unharmed(each) for name, each in runs.items()},
    }


def _compared(curves: Mapping[str, Curve | str]) -> dict[str, Any]:
    return {
        "medians": {name: median_of(curve) for name, curve in curves.items()},
        "why": {name: curve for name, curve in curves.items() if isinstance(curve, str)},
        "ratios": {
            other: ratio_of(curves[LIR], curves[other]) if other in curves else None
            for other in OTHERS
        },
    }


def _drawn(curve: Curve | str) -> list[float] | None:
    # Median and dispersion of a lognormal curve.
    if isinstance(curve, str):
        return None
    return [float(curve.median), float(curve.dispersion)]  # type: ignore[union-attr]


def _uplift(runs: IntensityRuns) -> list[list[float]]:
    # By intensity: complete runs, of them lifted by more than UPLIFT, their median uplift [m].
    table = runs.table
    rows = []
    for level, own in table[table["outcome"] == COMPLETE].groupby("im"):
        uplift = own["maximum uplift"]
        rows.append([float(level), len(own), int((uplift > UPLIFT).sum()), float(uplift.median())])
    return rows


def _unharmed(runs: IntensityRuns) -> list[int]:
    # Runs whose bearing failed, and of them those below each ductility until then.
    own = runs.table[runs.table["outcome"] == FAILURE]["ductility"]
    return [len(own), *(int((own <= bound).sum()) for bound in UNHARMED)]


STEPPED = ("ductility", DRIFT, PLAN_FLOOR, "bearing displacement", "interface slip")
"""Demands that are compared at two steps."""

HALVED_AT = 2.6
"""Intensity of the runs at two steps [m/s2]."""


def halved(motions: Mapping[str, GroundMotion]) -> list[dict[str, Any]]:
    """Return demands of each building on two devices at the step of the campaigns and at half of it."""
    rows = []
    for k, one in enumerate(BUILDINGS):
        name, motion = list(motions.items())[HALVED_EVERY * k]
        frames, yields = on_devices(building(one)), yield_rotations(one)
        for device in (LIR, WEAK):
            runs = []
            for dt in (STEP, 0.5 * STEP):
                with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
                    data = time_histories(
                        {device: frames[device]}, {name: motion}, scales=[HALVED_AT], dt=dt
                    )
                run = table_of(data, {name: motion}, yields).table.iloc[0]
                runs.append({"status": str(run["status"])} | {q: float(run[q]) for q in STEPPED})
            rows.append({"building": one.name, "device": device, "motion": name, "runs": runs})
    return rows
