"""The pages of the benchmark and of its goals, from what was kept: costs, ratios, growth, verdicts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from validation.measurements import benchmark_runs as runs
from validation.measurements import benchmark_search as search
from validation.measurements.benchmark_cases import EFFORTS, METHODS, device_of
from validation.measurements.benchmark_models import SCALE, STRUCTURES
from validation.measurements.benchmark_search import OWN, PLAIN, RESILIENT
from validation.page import render

if TYPE_CHECKING:
    from collections.abc import Sequence

    from validation.measurements.benchmark_models import Structure

GROUPS = {"plain DCFP": tuple(kind for kind in PLAIN if kind not in OWN), "LIR-DCFP": RESILIENT}
"""What stands for our devices in OpenSees; for the plain one only what is its own."""
GOALS = {
    "a": {"best": 20.0},
    "b": {"best": 100.0, "usual": 200.0},
    "c": {"best": 200.0},
    "f": {"best": 50.0},
}
"""Cost of OpenSees over that of this program, by case and setting."""


class Rival(NamedTuple):
    """The cheapest way to a device's response in OpenSees, and what it costs there over here [-]."""

    kind: str
    method: str
    ratio: float


def there_are(kept: dict[str, Any]) -> list[Structure]:
    """Return the structures of which there are results."""
    return [one for key, one in STRUCTURES.items() if kept.get(key, {}).get("state") == "ok"]


def rival(found: dict[str, Any], device: str, setting: str) -> Rival | None:
    """Return the cheapest way in OpenSees; None where no element of it keeps the error."""
    ways = []
    for kind in GROUPS[device]:
        ratios = found["pairs"].get(kind, {}).get("ratios", {})
        for name, ratio in ratios.items():
            which, method = name.split(" over ")
            if which == setting:
                ways.append((found["pairs"][kind][setting], -ratio, Rival(kind, method, ratio)))
    return min(ways, key=lambda way: way[:2])[2] if ways else None


def step_cost(found: dict[str, Any], kind: str, who: str) -> float:
    """Return the CPU time of a step [s]: of a setting there, or of a method here."""
    pairs = found["pairs"].get(kind, {})
    if who not in pairs:
        return math.nan
    dt = found["there"][kind][who]["dt"] if who in {"usual", "best"} else None
    if dt is None:
        dt = found["here"][device_of(kind)][who]["dt"]
    return float(pairs[who] * dt / pairs["window"])


def second_cost(found: dict[str, Any], kind: str, who: str) -> float:
    """Return the CPU time of a second of the motion [s]."""
    pairs = found["pairs"].get(kind, {})
    return float(pairs[who] / pairs["window"]) if who in pairs else math.nan


def power(x: Sequence[float], y: Sequence[float]) -> float:
    """Return the exponent p of the power law y = c x^p, fitted by least squares of logarithms."""
    pairs = np.array([(a, b) for a, b in zip(x, y, strict=True) if math.isfinite(a * b)])
    if len(pairs) < 2 or len(set(pairs[:, 0])) < 2:
        return math.nan
    x_log, y_log = np.log(pairs).T
    return float(np.polyfit(x_log, y_log, 1)[0])


def growth(kept: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return rows of exponents: of the cost of a step over bearings, and over unknowns."""
    large = [kept[one.key] for one in there_are(kept) if one.case in "bcd"]
    rows: list[tuple[str, ...]] = []
    for kind in ("singleFPBearing", "LIR-DCFP, in-process coupling"):
        for who in ("direct", "reduced", "usual", "best"):
            costs = [step_cost(found, kind, who) for found in large]
            if sum(map(math.isfinite, costs)) < 2:
                continue
            name = (
                f"OpenSees, {who}, {kind}"
                if who in {"usual", "best"}
                else (f"here, {who}, {device_of(kind)}")
            )
            exponents = [
                power([found["sizes"][size] for found in large], costs)
                for size in ("bearings", "unknowns")
            ]
            rows.append((name, *(f"{p:.2f}" for p in exponents)))
    return rows


def growth_with_steps(found: dict[str, Any]) -> float:
    """Return the exponent of the cost of a run here over its number of steps."""
    runs = [run for run in found["here"]["LIR-DCFP"]["direct"]["runs"] if run["dt"] == run["dt"]]
    return power([run["steps"] for run in runs], [run["loop"] for run in runs])


def short(kept: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return rows: structure, device, its cheapest element in OpenSees, and how often it costs more."""
    rows = []
    for one in there_are(kept):
        for device in GROUPS:
            ways = [rival(kept[one.key], device, setting) for setting in ("usual", "best")]
            kinds = dict.fromkeys(way.kind for way in ways if way)
            ratios = (f"{way.ratio:.3g}" if way else "-" for way in ways)
            rows.append((one.name, device, ", ".join(kinds) or "-", *ratios))
    return rows


def bound(spent: dict[str, float]) -> str:
    """Say what bounds a step, from its profile."""
    parts = {
        "the bearings' state determinations": spent["states"],
        "their tangents": spent["tangents"],
        "products and solutions of the structure": spent["arithmetic"],
    }
    rest = spent["step"] - sum(parts.values())
    parts["what is left: energy, recording, control of the step"] = max(rest, 0.0)
    name = max(parts, key=lambda part: parts[part])
    return f"{name} ({100.0 * parts[name] / max(spent['step'], sum(parts.values())):.0f} %)"


def whole_cost(found: dict[str, Any], kind: str, method: str = "direct") -> tuple[float, float]:
    """Return the CPU time of whole runs, there at its best and here [s]."""
    ours = found["here"][device_of(kind)][method]
    costs = [run["whole"] for run in ours.get("runs", []) if run["dt"] == ours["dt"]]
    theirs = found["there"][kind]["best"].get("whole", math.nan)
    return theirs, costs[0] if costs else math.nan


def number(value: float) -> str:
    """Return a value with three digits, a dash where there is none."""
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def ms(seconds: float) -> str:
    """Return a step in milliseconds."""
    return f"{1e3 * seconds:g}" if math.isfinite(seconds) else "stops"


def text(kept: dict[str, Any]) -> str:
    """Return the page from what was kept; what was not measured is left out."""
    measured = there_are(kept)
    missing = [
        f"{one.name} ({kept.get(key, {}).get('state', 'not run')})"
        for key, one in STRUCTURES.items()
        if one not in measured
    ]
    spent = {k: v for k, v in kept.get("profile", {}).items() if k in STRUCTURES and v}
    return render(
        globals(),
        bounds=[f"{STRUCTURES[key].name}: {bound(values)}" for key, values in spent.items()],
        dates=sorted({one["when"] for one in kept.values() if isinstance(one, dict)}),
        efforts=EFFORTS,
        kept=kept,
        measured=[kept[one.key] for one in measured],
        methods=METHODS,
        missing=missing,
        refusals=[
            f"{method} is left out: {values['refused']}"
            for one in measured
            for methods in kept[one.key]["here"].values()
            for method, values in methods.items()
            if "refused" in values
        ],
        runs=runs,
        scale=SCALE,
        search=search,
        spent=spent,
    )


def goals(kept: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return rows: goal, device, what was found, and whether it is met."""
    rows: list[tuple[str, ...]] = []
    for one in there_are(kept):
        for setting, goal in GOALS.get(one.case, {}).items():
            for device in GROUPS:
                found = rival(kept[one.key], device, setting)
                what = f"{one.name}: {goal:g} times OpenSees at its {setting}"
                if found is None:
                    rows.append((what, device, "no setting of OpenSees keeps the error", "-"))
                    continue
                got = f"{found.ratio:.3g} ({_how(kept[one.key], found, setting)})"
                rows.append((what, device, got, verdict(goal, found.ratio)))
    if kept.get("e", {}).get("state") == "ok":
        rows += batch_goals(kept["e"]["here"])
    return rows


def _how(found: dict[str, Any], way: Rival, setting: str) -> str:
    # A ratio is that of a step's cost times that of the numbers of steps.
    there = found["there"][way.kind][setting]["dt"]
    here = found["here"][device_of(way.kind)][way.method]["dt"]
    step = step_cost(found, way.kind, setting) / step_cost(found, way.kind, way.method)
    return (
        f"{way.kind}; here {way.method}; {step:.3g} a step, of {1e3 * there:g} ms there, "
        f"{1e3 * here:g} ms here"
    )


def verdict(goal: float, ratio: float) -> str:
    """Say whether a ratio meets a goal, and what is missing."""
    return "met" if ratio >= goal else f"**missed**, by a factor of {goal / ratio:.1f}"


def batch_goals(here: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return the rows of the goals for the batch; on a busy machine CPU time tells more."""
    many = runs.GOAL_HISTORIES / here["histories"]
    clock, cpu = here["clock"] * many, here["cpu"] * many / here["cores"]
    what = (
        f"{runs.GOAL_HISTORIES} histories of the building in {runs.GOAL_SECONDS / 60.0:g} minutes"
    )
    return [
        (
            what,
            "LIR-DCFP",
            f"{cpu / 60.0:.1f} minutes by CPU time over {here['cores']} cores, {clock / 60.0:.1f} by "
            "the clock",
            verdict(runs.GOAL_SECONDS, runs.GOAL_SECONDS**2 / cpu),
        ),
        (
            "memory below 2 GiB",
            "LIR-DCFP",
            f"{here['memory'] / 2**30:.2f} GiB",
            verdict(runs.GOAL_BYTES, runs.GOAL_BYTES**2 / here["memory"]),
        ),
    ]


def before(found: dict[str, Any]) -> dict[str, Any]:
    """Return what is kept of results that are measured anew."""
    rows = goals({found.get("key", "e"): found})
    return {"when": found["when"], "found": {_name(row): row[2] for row in rows}}


def _name(row: tuple[str, ...]) -> str:
    return f"{row[0]}, {row[1]}"


def goals_text(kept: dict[str, Any]) -> str:
    """Return the page, from what was kept of the benchmark."""
    earlier = {
        name: f"{got}; {one['before']['when']}"
        for one in kept.values()
        if isinstance(one, dict) and "before" in one
        for name, got in one["before"]["found"].items()
    }
    rows = [(*row[:2], earlier.get(_name(row), "-"), *row[2:]) for row in goals(kept)]
    yields = any(one.yields for one in there_are(kept))
    return render(globals(), "benchmark_goals", lines=rows, yields=yields)
