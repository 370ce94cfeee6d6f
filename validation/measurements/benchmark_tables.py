"""Figures of the benchmark from what was kept: costs, ratios, growth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from validation.measurements.benchmark_cases import device_of
from validation.measurements.benchmark_models import STRUCTURES
from validation.measurements.benchmark_search import OWN, PLAIN, RESILIENT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from validation.measurements.benchmark_models import Structure

GROUPS = {
    "plain DCFP": tuple(kind for kind in PLAIN if kind not in OWN),
    "LIR-DCFP": RESILIENT,
}
"""What stands for our devices in OpenSees; for the plain one only what is its own."""


@dataclass(frozen=True)
class Rival:
    """The cheapest way to a device's response in OpenSees, and what it costs.

    Attributes
    ----------
    kind : str
        Element in OpenSees.
    method : str
        The cheapest method here.
    ratio : float
        Cost there over cost here [-].
    """

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
