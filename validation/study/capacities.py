"""Capacities of records known between two intensities: lognormal fits, and lines through them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import optimize, special

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.risk import IntensityRuns, LimitState

LEAST = 1e-300
"""Of a likelihood."""


@dataclass(frozen=True)
class Line:
    """ln capacity = `at_mean` + `slope` (x - mean of x), normal about it with `dispersion`."""

    at_mean: float
    slope: float
    dispersion: float
    mean: float

    def median(self, x: float | None = None) -> float:
        """Return the median capacity, at x or at the mean of x."""
        return float(np.exp(self.at_mean + self.slope * (0.0 if x is None else x - self.mean)))


def bounds_of(runs: IntensityRuns, limit: LimitState, records: Sequence[str]) -> FloatArray:
    """Return the intensities between which each record first exceeds a limit state.

    Shapes: result (n, 2).
    """
    table = runs.table.assign(exceeded=runs.exceeded(limit))
    found = []
    for name in records:
        own = table[table["motion"] == name].sort_values("im").dropna(subset="exceeded")
        im, over = own["im"].to_numpy(), own["exceeded"].to_numpy() > 0.0
        first = int(np.argmax(over)) if over.any() else len(im)
        found.append(
            (im[first - 1] if first > 0 else 0.0, im[first] if first < len(im) else np.inf)
        )
    return np.array(found, dtype=np.float64)


def fitted(bounds: FloatArray, x: FloatArray | None = None) -> Line:
    """Fit by maximum likelihood a lognormal capacity, or a line of its logarithm over x.

    Shapes: bounds (n, 2), x (n,).
    """
    with np.errstate(divide="ignore"):
        low, high = np.log(bounds).T
    mean = 0.0 if x is None else float(np.mean(x))
    away = np.zeros(len(low)) if x is None else np.asarray(x) - mean
    middle = np.where(np.isfinite(low), low, high - 0.3)
    middle = np.where(np.isfinite(high) & np.isfinite(low), 0.5 * (low + high), middle)

    def unlikely(p: FloatArray) -> float:
        at, scale = p[0] + (p[1] * away if x is not None else 0.0), np.exp(p[-1])
        above, below = (high - at) / scale, (low - at) / scale
        # on the side where the difference does not cancel
        swap = below > 0.0
        upper = np.where(swap, special.ndtr(-below), special.ndtr(above))
        lower = np.where(swap, special.ndtr(-above), special.ndtr(below))
        return -float(np.log(np.maximum(upper - lower, LEAST)).sum())

    start = [float(middle.mean()), *([0.0] if x is not None else []), float(np.log(0.3))]
    rules = {"xatol": 1e-6, "fatol": 1e-8, "maxiter": 4000}
    best = optimize.minimize(unlikely, start, method="Nelder-Mead", options=rules).x
    slope = float(best[1]) if x is not None else 0.0
    return Line(float(best[0]), slope, float(np.exp(best[-1])), mean)


def draws(count: int, resamples: int, seed: int = 1) -> FloatArray:
    """Return numbers of records drawn anew, (resamples, count): the same for all devices."""
    return np.random.default_rng(seed).integers(0, count, (resamples, count))


def interval(values: Sequence[float], confidence: float = 0.9) -> list[float]:
    """Return the ends of the middle part of resampled values."""
    tail = 0.5 * (1.0 - confidence)
    return [float(v) for v in np.nanquantile(np.asarray(values), [tail, 1.0 - tail])]
