"""What is run of each structure of the benchmark, and what is kept of it.

Both programs are first run at several steps, and each takes the largest one that keeps the peak
displacement of the bearings within `ALLOWED` of its converged value. With these steps they then
run in turns over the same strong part of the motion, so that a busy machine slows both alike.
"""

from __future__ import annotations

import math
import statistics
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from frames import gravity
from validation.measurements.benchmark_models import motion_of, strong
from validation.measurements.benchmark_runs import run_here, run_there
from validation.measurements.benchmark_search import (
    DURATION,
    FINE,
    OWN,
    PLAIN,
    RESILIENT,
    STEPS,
    assumed,
    coarsest,
    error,
    search,
    setting_of,
    steps_there,
)

if TYPE_CHECKING:
    from frames import Frame
    from lir_element import LIRBearing
    from validation.measurements.benchmark_models import Structure

METHODS = ("direct", "reduced")
SOME = (PLAIN[0], RESILIENT[0])
"""Kinds that are run under large structures."""
SEARCHED = 5
"""Steps by which a setting is judged for a large structure."""
SEARCHABLE = 100
"""Bearings, beyond which neither steps nor settings are sought: each run takes minutes."""
COARSE = 2.5e-3
"""Step of the converged runs of large structures [s]."""


@dataclass(frozen=True)
class Effort:
    """How much of a structure is run."""

    kinds: tuple[str, ...] = (*PLAIN, *RESILIENT)
    """Elements in OpenSees."""
    full: bool = True
    """Whether OpenSees is run at all steps; else it takes those of structure b."""
    window: float = 4.0
    """Length of the part of the motion in which the programs take turns [s]."""
    turns: int = 3
    """How often."""


EFFORTS = {
    "a": Effort(window=8.0, turns=7),
    "b": Effort(window=2.0),
    "c": Effort(SOME, full=False, window=0.4),
    "d": Effort(SOME, full=False, window=0.1, turns=1),
    "f": Effort((PLAIN[0], RESILIENT[0]), window=2.0),
}
"""By case."""


@dataclass
class Found:
    """What was found of a structure, as it is kept: numbers, texts, lists and dictionaries."""

    key: str
    """Of the structure."""
    sizes: dict[str, int] = field(default_factory=dict)
    """Numbers of bearings, degrees of freedom, bearing coordinates and modes."""
    here: dict[str, dict[str, Any]] = field(default_factory=dict)
    """By device and method: runs at all steps, the fine one last, and the step chosen."""
    there: dict[str, dict[str, Any]] = field(default_factory=dict)
    """By kind: runs, steps and settings, "usual" and "best", and what the search tried."""
    pairs: dict[str, dict[str, Any]] = field(default_factory=dict)
    """By kind: medians of the ratios of cost and of the costs themselves."""


def device_of(kind: str) -> str:
    """Return which of our devices a kind in OpenSees is compared with."""
    return "LIR-DCFP" if kind in RESILIENT else "plain DCFP"


def devices_here(structure: Structure) -> dict[str, LIRBearing]:
    """Return the devices that are run here."""
    bearing = structure.bearing()
    return {"plain DCFP": bearing.as_dcfp(rims=False), "LIR-DCFP": bearing}


def measure(
    structure: Structure, smaller: dict[str, Any] | None = None, *, short: bool = False
) -> Found:
    """Run a structure in both programs."""
    effort, found = EFFORTS[structure.case], Found(structure.key)
    if short:
        effort = Effort(SOME, full=False, window=min(0.1, effort.window), turns=1)
    frames = {name: structure.frame(one) for name, one in devices_here(structure).items()}
    found.sizes = sizes(structure, next(iter(frames.values())))
    fine = FINE["here"] if effort.full else COARSE
    known, chosen = ((smaller or {}).get(part, {}) for part in ("here", "there"))
    for name, frame in frames.items():
        if structure.bearings > SEARCHABLE and known:
            found.here[name] = {
                m: {"runs": [], "errors": [], **_step(known[name][m])} for m in METHODS
            }
        else:
            found.here[name] = {m: here(frame, m, fine) for m in METHODS}
    bearing = structure.bearing()
    for kind in effort.kinds:
        if effort.full:
            reference = found.here[device_of(kind)]["direct"]["reference"]
            there = steps_there(structure, bearing, kind, reference if kind in OWN else None)
        else:
            there = _searched(structure, bearing, kind, chosen.get(kind) or assumed())
        found.there[kind] = there
        frame = frames[device_of(kind)]
        found.pairs[kind] = turns(
            structure, bearing, kind, frame, found.here[device_of(kind)], there, effort
        )
    return found


def _step(here: dict[str, Any]) -> dict[str, Any]:
    return {name: here[name] for name in ("dt", "refused") if name in here}


def _searched(
    structure: Structure, bearing: LIRBearing, kind: str, there: dict[str, Any]
) -> dict[str, Any]:
    # Steps of the structure they come from; the best setting is this one's own, as far as it can
    # be sought: what is cheapest for few unknowns is not for many.
    found = {
        name: {part: there[name][part] for part in ("dt", "setting")} for name in ("usual", "best")
    }
    dt = found["best"]["dt"]
    if math.isfinite(dt) and structure.bearings <= SEARCHABLE:
        settings, _ = search(structure, bearing, kind, dt, SEARCHED * dt)
        if settings:
            found["best"]["setting"] = asdict(settings[0])
    return found


def sizes(structure: Structure, frame: Frame) -> dict[str, int]:
    """Return the sizes of a structure's problem."""
    state = gravity(frame)
    unknowns, ours = state.system.mass.shape[0], len(state.basis.bearing_dofs)
    return {"bearings": structure.bearings, "unknowns": int(unknowns), "bearing_unknowns": ours}


def here(frame: Frame, method: str, fine: float) -> dict[str, Any]:
    """Run a structure here at all steps; return the runs, the reference and the step chosen."""
    motion = motion_of(DURATION)
    first = run_here(frame, motion, 2.0 * fine, fine, method)  # loads the kernels
    if first.status.startswith("refused"):
        return {"refused": first.status}
    runs = [run_here(frame, motion, DURATION, dt, method) for dt in (*STEPS, None, fine)]
    reference = runs[-1].peak
    return {
        "runs": [asdict(run) for run in runs],
        "reference": reference,
        "dt": coarsest(runs, reference),
        "errors": [error(run, reference) for run in runs],
    }


def turns(
    structure: Structure,
    bearing: LIRBearing,
    kind: str,
    frame: Frame,
    ours: dict[str, Any],
    there: dict[str, Any],
    effort: Effort,
) -> dict[str, Any]:
    """Run both programs in turns, each at its own step; return medians."""
    motion = strong(effort.window)
    methods = {m: v["dt"] for m, v in ours.items() if math.isfinite(v.get("dt", math.nan))}
    times: dict[str, list[float]] = {}
    for _ in range(effort.turns):
        for method, dt in methods.items():
            repeats = [run_here(frame, motion, effort.window, dt, method) for _ in range(5)]
            times.setdefault(method, []).append(statistics.median(r.loop for r in repeats))
        for name in ("usual", "best"):
            dt = there[name]["dt"]
            if not math.isfinite(dt):
                continue
            steps = round(effort.window / dt)
            run = run_there(
                structure, bearing, kind, motion, dt, steps, setting_of(there[name]["setting"])
            )
            times.setdefault(name, []).append(run.loop)
    pairs: dict[str, Any] = {name: statistics.median(values) for name, values in times.items()}
    pairs["ratios"] = {
        f"{name} over {method}": statistics.median(
            a / b for a, b in zip(times[name], times[method], strict=True)
        )
        for name in ("usual", "best")
        if name in times
        for method in methods
    }
    pairs["window"] = effort.window
    return pairs
