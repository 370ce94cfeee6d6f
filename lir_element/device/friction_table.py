"""Friction over speed as a table that kernels read: made of any law, and its error measured."""

from __future__ import annotations

from math import inf, isfinite, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.layout import FRICTION_TABLE

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    from lir_element.layout import Floats

    Law = Callable[[float], float]

LARGEST_ERROR = 1e-3
"""Largest error of a table, over the friction coefficient at high speed; above it a law is refused.
"""

KNOTS = (FRICTION_TABLE - 1) // 2

FASTEST = 1e12
"""Speed that counts as high without end [m/s]."""

_NEARLY_FASTEST = 1e9  # m/s, speed at which a law must have reached its limit
_AT_LIMIT = 1e-6  # of the coefficient
_LEVEL = 1e-12  # of the coefficient: a fall in speed within round-off
_NO_DROP = 1e-9  # of the coefficient: a law that does not depend on speed
_SPEEDS = np.concatenate([[0.0], np.geomspace(1e-6, 1e6, 1201), np.linspace(1e-3, 2.0, 1000)])
_BESIDE = 2e-3  # of a knot's distance to the next one: step of the differences that give slopes
_BETWEEN = np.arange(1, 8) / 8.0  # where between two knots a table is compared
_SCALES = tuple(2.0**k for k in range(-3, 5))  # reference speeds tried, over that of half the drop
_HALVINGS = 60


class FrictionValues(NamedTuple):
    """Values of a friction law for kernels.

    Attributes
    ----------
    most, drop : float
        Friction coefficient at high speed [-], and its reduction at rest [-].
    rate : float
        Steepest growth over the drop [s/m]; for Eq. (1) the rate parameter.
    table : tuple of float
        Entries of `PROPS` "friction_table"; empty for Eq. (1).
    error : float
        Largest difference between table and law [-].
    """

    most: float
    drop: float
    rate: float
    table: tuple[float, ...] = ()
    error: float = 0.0

    def times(self, factor: float) -> FrictionValues:
        """Return the values of the law times a factor [-]."""
        return self._replace(
            most=factor * self.most, drop=factor * self.drop, error=factor * self.error
        )

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] that kernels read at a speed [m/s]."""
        return self.most - self.drop * float(self.left(speed)) if self.table else self.most

    def left(self, speeds: npt.ArrayLike) -> Floats:
        """Return the share of the drop that speeds leave by the table, (n,) of (n,) [m/s]."""
        reference = self.table[0]
        v = np.asarray(speeds, dtype=np.float64)
        knots = np.asarray(self.table[1:])
        return np.asarray(_curve(knots[0::2], knots[1::2])(v / (v + reference)))


def sampled(name: str, law: Law, largest: float = LARGEST_ERROR) -> FrictionValues:
    """Return the table of a law, cubic between knots that are even over v / (v + v_ref)."""
    values = _checked(name, law)
    least, most = float(values[0]), _coefficient(name, law, FASTEST)
    drop = most - least
    if drop <= _NO_DROP * most:
        return FrictionValues(most, 0.0, 0.0)
    middle = _half(law, most, drop)
    best: tuple[float, ...] = ()
    error, worst = inf, 0.0
    for scale in _SCALES:
        table, found, at = _tabulated(law, most, drop, scale * middle)
        if found < error:
            best, error, worst = table, found, at
    if error > largest * most:
        msg = (
            f"{name} changes too abruptly at {worst:.3g} m/s: its table is off by "
            f"{error:.2g} there, more than {largest:g} of f_max = {most:.4g}: use a law "
            "without jumps and kinks, for example scipy.interpolate.PchipInterpolator"
        )
        raise ValueError(msg)
    return FrictionValues(most, drop, _steepest(best), best, error)


def never_falling(speeds: npt.ArrayLike, coefficients: npt.ArrayLike) -> PchipInterpolator:
    """Return the isotonic fit of measured points, smooth between the centres of its blocks.

    Shapes: speeds, coefficients (n,).
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.optimize import isotonic_regression

    v, of, count = np.unique(speeds, return_inverse=True, return_counts=True)
    fit = isotonic_regression(np.bincount(of, coefficients) / count, weights=count)
    first = fit.blocks[:-1]
    centres = np.add.reduceat(count * v, first) / np.add.reduceat(count, first)
    values = fit.x[first]
    if centres[0] > 0.0:
        centres, values = np.append(0.0, centres), np.append(values[0], values)
    last = 2.0 * centres[-1] or 1.0
    return PchipInterpolator(np.append(centres, last), np.append(values, values[-1]))


def _coefficient(name: str, law: Law, speed: float) -> float:
    try:
        value = float(law(float(speed)))
    except ArithmeticError as cause:
        msg = (
            f"{name} fails at {speed:.3g} m/s ({type(cause).__name__}: {cause}): friction "
            f"must be finite at every speed up to {FASTEST:g} m/s; avoid terms that overflow "
            "(use exp(-v), not exp(v))"
        )
        raise ValueError(msg) from cause
    if not isfinite(value):
        msg = f"{name} is {value} at {speed:.3g} m/s: it must be finite at every speed from 0 on"
        raise ValueError(msg)
    if not 0.0 <= value < 1.0:
        msg = (
            f"{name} is {value:.6g} at {speed:.3g} m/s: a friction coefficient must be at "
            "least 0 and below 1; give pure numbers, 0.06 for 6 %"
        )
        raise ValueError(msg)
    return value


def _checked(name: str, law: Law) -> Floats:
    # Coefficients at many speeds: in bounds, never falling, with a limit.
    speeds = np.unique(_SPEEDS)
    values = np.array([_coefficient(name, law, v) for v in speeds])
    ends = [_coefficient(name, law, v) for v in (_NEARLY_FASTEST, FASTEST)]
    whole = np.concatenate([values, ends])
    at = np.concatenate([speeds, [_NEARLY_FASTEST, FASTEST]])
    falls = np.diff(whole) < -_LEVEL * whole[:-1]
    if falls.any():
        k = int(np.argmax(falls))
        end = k + 1  # as far as it goes on falling
        while end < len(falls) and falls[end]:
            end += 1
        msg = (
            f"{name} falls with speed, from {whole[k]:.6g} at {at[k]:.3g} m/s to "
            f"{whole[end]:.6g} at {at[end]:.3g} m/s: friction must not decrease with speed; "
            "model the decrease by heating with FrictionHeating"
        )
        raise ValueError(msg)
    if ends[1] - ends[0] > _AT_LIMIT * ends[1]:
        msg = (
            f"{name} has no limit at high speed: it is {ends[0]:.6g} at {_NEARLY_FASTEST:g} "
            f"m/s and {ends[1]:.6g} at {FASTEST:g} m/s; make it constant beyond the tested "
            "speeds"
        )
        raise ValueError(msg)
    return values


def _half(law: Law, most: float, drop: float) -> float:
    # Speed at which half of the drop is left.
    low, high = 1e-9, 1e9
    for _ in range(_HALVINGS):
        middle = sqrt(low * high)
        if most - law(middle) > 0.5 * drop:
            low = middle
        else:
            high = middle
    return sqrt(low * high)


def _tabulated(
    law: Law, most: float, drop: float, reference: float
) -> tuple[tuple[float, ...], float, float]:
    # The table with a reference speed, its largest error and the speed of that.
    def left(x: Floats) -> Floats:
        gone = [most if s >= 1.0 else float(law(reference * s / (1.0 - s))) for s in x.tolist()]
        shares: Floats = (most - np.asarray(gone)) / drop
        return shares

    x = np.linspace(0.0, 1.0, KNOTS)
    h = x[1]
    shares = np.minimum.accumulate(np.clip(left(x), 0.0, 1.0))
    slopes = _limited(_slopes(left, x, _BESIDE * h), np.diff(shares) / h)
    inside = (x[:-1, None] + h * _BETWEEN).ravel()
    off = np.abs(_curve(shares, slopes)(inside) - left(inside)) * drop
    worst = int(np.argmax(off))
    table = (float(reference), *np.column_stack([shares, slopes]).ravel().tolist())
    at = inside[worst]
    return table, float(off[worst]), float(reference * at / (1.0 - at))


def _slopes(left: Callable[[Floats], Floats], x: Floats, d: float) -> Floats:
    # By differences of fourth order, one-sided at both ends.
    inner = x[1:-1]
    slopes = np.zeros_like(x)
    slopes[1:-1] = (
        8.0 * (left(inner + d) - left(inner - d)) - left(inner + 2 * d) + left(inner - 2 * d)
    ) / (12.0 * d)
    weights = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / (12.0 * d)
    away = d * np.arange(5.0)
    slopes[0], slopes[-1] = weights @ left(away), -(weights @ left(1.0 - away))
    return slopes


def _limited(slopes: Floats, secants: Floats) -> Floats:
    # Slopes with which the curve never rises (Fritsch and Carlson 1980): at most three times the
    # flatter secant beside each knot.
    flatter = np.concatenate([secants[:1], np.maximum(secants[:-1], secants[1:]), secants[-1:]])
    return np.clip(slopes, 3.0 * flatter, 0.0)


def _curve(shares: Floats, slopes: Floats) -> CubicHermiteSpline:
    from scipy.interpolate import CubicHermiteSpline  # half a second, which few runs need

    return CubicHermiteSpline(np.linspace(0.0, 1.0, len(shares)), shares, slopes)


def _steepest(table: tuple[float, ...]) -> float:
    # Steepest fall of the share over speed [s/m].
    knots = np.asarray(table[1:])
    x = np.linspace(0.0, 1.0, 16 * (KNOTS - 1) + 1)
    by_x = _curve(knots[0::2], knots[1::2])(x, 1)
    return float((-by_x * (1.0 - x) ** 2).max() / table[0])
