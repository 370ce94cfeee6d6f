"""The step and the settings with which OpenSees is cheapest and accurate enough."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

from validation.measurements.benchmark_models import motion_of, strong
from validation.measurements.benchmark_runs import USUAL, Run, Setting, run_there

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from lir_element import LIRBearing
    from validation.measurements.benchmark_models import Structure

ALLOWED = 0.005
"""Error of the peak displacement that a step may make [-]."""
STEPS = (0.02, 0.01, 0.005, 0.0025)
FINE = {"here": 5e-4, "there": 2.5e-3, "yielding": 5e-4}
"""Steps of the converged runs here and in OpenSees, and there of structures that yield [s]."""
DURATION = 12.0
"""Of the runs that find the step [s]."""
PLAIN = ("singleFPBearing", "TripleFrictionPendulum", "plain DCFP, in-process coupling")
RESILIENT = ("LIR-DCFP, in-process coupling", "LIR-DCFP, macro-model")
OWN = (PLAIN[2], RESILIENT[0])
"""Kinds that are this program's element inside OpenSees: they converge to its results."""
CANDIDATES = 3
"""Settings that are run at all steps: a loose test may be cheap and keep the error at none."""
SYSTEMS = ("BandGeneral", "SparseGeneral", "ProfileSPD", "FullGeneral")
FULL = 9
"""Bearings, beyond which a full matrix, the last of them, is not tried: its cost is their cube."""
ALGORITHMS = (
    ("KrylovNewton",),
    ("ModifiedNewton",),
    ("ModifiedNewton", "-initial"),
    ("Newton", "-initial"),
)
NUMBERERS = ("AMD", "Plain")
TESTS = (
    ("NormDispIncr", 1e-6),
    ("NormDispIncr", 1e-5),
    ("NormUnbalance", 10.0),
    ("EnergyIncr", 1e-4),
)


def coarsest(runs: Sequence[Run], reference: float) -> float:
    """Return the largest step that keeps the peak, as do all smaller ones [s]; NaN if none does."""
    best = math.nan
    for run in sorted((r for r in runs if math.isfinite(r.dt)), key=lambda r: r.dt):
        if run.status != "ok" or error(run, reference) > ALLOWED:
            return best
        best = run.dt
    return best


def error(run: Run, reference: float) -> float:
    """Return the error of the peak displacement of a run [-]."""
    return abs(run.peak / reference - 1.0)


def steps_there(
    structure: Structure, bearing: LIRBearing, kind: str, reference: float | None
) -> dict[str, Any]:
    """Find steps and settings of OpenSees for a kind of element."""
    motion = motion_of(DURATION)

    def run(dt: float, setting: Setting = USUAL) -> Run:
        return run_there(structure, bearing, kind, motion, dt, round(DURATION / dt), setting)

    runs = []
    if reference is None:
        runs.append(run(FINE["yielding" if structure.yields else "there"]))
        reference = runs[0].peak
    usual = _largest(run, USUAL, reference, runs)
    start = usual["dt"] if math.isfinite(usual["dt"]) else STEPS[1]
    settings, tried = search(structure, bearing, kind, start)
    best = cheapest(
        [usual, *(_largest(run, one, reference, runs) for one in settings if one != USUAL)]
    )
    return {
        "usual": usual,
        "best": best,
        "reference": reference,
        "tried": tried,
        "runs": [asdict(one) for one in runs],
    }


def cheapest(ways: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return that of several steps and settings whose run cost least; the first if none is good."""
    return min(ways, key=lambda way: way["loop"] if math.isfinite(way["dt"]) else math.inf)


def _largest(
    run: Callable[[float, Setting], Run], setting: Setting, reference: float, runs: list[Run]
) -> dict[str, Any]:
    # From the largest step down: the first one that keeps the peak is taken.
    for dt in STEPS:
        runs.append(run(dt, setting))
        if runs[-1].status == "ok" and error(runs[-1], reference) <= ALLOWED:
            return {
                "dt": dt,
                "error": error(runs[-1], reference),
                "setting": asdict(setting),
                "loop": runs[-1].loop,
                "whole": runs[-1].whole,
                "rescued": runs[-1].rescued,
            }
    return {"dt": math.nan, "error": math.nan, "setting": asdict(setting)}


def assumed() -> dict[str, Any]:
    """Return a step and the usual settings, where none were searched."""
    one = {"dt": STEPS[1], "setting": asdict(USUAL)}
    return {"usual": one, "best": one}


def setting_of(values: dict[str, Any]) -> Setting:
    """Return a setting from what was kept of it."""
    parts: dict[str, Any] = {
        name: tuple(v) if isinstance(v, list) else v for name, v in values.items()
    }
    return Setting(**parts)


def search(
    structure: Structure, bearing: LIRBearing, kind: str, dt: float, length: float = 1.0
) -> tuple[list[Setting], dict[str, float]]:
    """Search cheap settings of OpenSees: one part after the other, from the usual one."""
    motion = strong(length)
    tried: dict[str, float] = {}
    costs: dict[Setting, float] = {}

    def cost(setting: Setting) -> float:
        run = run_there(structure, bearing, kind, motion, dt, round(length / dt), setting)
        tried[setting.name] = run.step if run.status == "ok" else math.nan
        costs[setting] = run.step if run.status == "ok" else math.inf
        return costs[setting]

    best, least = USUAL, cost(USUAL)
    for part, values in (
        ("system", SYSTEMS if structure.bearings <= FULL else SYSTEMS[:-1]),
        ("algorithm", ALGORITHMS),
        ("numberer", NUMBERERS),
        ("criterion", TESTS),
    ):
        for value in values:
            other = replace(best, **{part: value})  # type: ignore[arg-type]
            spent = cost(other)
            if spent < least:
                best, least = other, spent
    good = sorted((one for one in costs if math.isfinite(costs[one])), key=lambda one: costs[one])
    return good[:CANDIDATES], tried
