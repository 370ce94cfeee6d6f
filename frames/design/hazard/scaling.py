"""Scaling of a set of motions to a target: the rules of the codes, and the factors."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames.design.hazard.code_rules import scaling_named
from frames.design.hazard.motion_measures import pair_spectrum
from frames.design.hazard.spectrum import Spectrum
from lir_element.argument_checks import require_choice, require_positive, require_type
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames.motion.ground_motion import GroundMotion

POINTS = 60
"""Periods of the range at which motions and target are compared."""


@dataclass(frozen=True, slots=True)
class Scaling:
    """Scaling of a set of motions.

    Attributes
    ----------
    target : Spectrum
        Target of the scaling.
    rule : str
        Name of the rule.
    measure : str
        Measure of a pair.
    part : float
        Least value of the mean, as a share of the target [-].
    periods : tuple of float
        Range of periods [s].
    damping : float
        Damping of the spectra [-].
    factors : mapping of str to float
        Factor of each motion [-], on all its components.
    least_ratio : float
        Smallest mean over target within the range [-].
    largest_ratio : float
        Largest one [-].

    Examples
    --------
    >>> from frames.design import Spectrum, synthetic_near_fault
    >>> motions = synthetic_near_fault(7, magnitude=6.8, distance=6.0, seed=1)
    >>> scaled = motions.scaled_to(Spectrum.asce7(s_ms=0.9, s_m1=0.5), periods=(1.5, 4.0))
    >>> scaled.scaling.rule, round(scaled.scaling.least_ratio, 9)
    ('ASCE 7-22', 1.0)
    """

    target: Spectrum
    rule: str
    measure: str
    part: float
    periods: tuple[float, float]
    damping: float
    factors: Mapping[str, float]
    least_ratio: float
    largest_ratio: float


def scaled_so(
    motions: Mapping[str, GroundMotion],
    before: Mapping[str, float],
    spectrum: Spectrum,
    rule: str,
    periods: tuple[float, float],
    how: str,
    measure: str | None,
    part: float | None,
    damping: float,
    limits: tuple[float, float],
    least: int | None,
) -> Scaling:
    """Find how motions are to be scaled."""
    require_type("spectrum", spectrum, Spectrum, "a Spectrum")
    code = scaling_named(rule)
    require_choice("how", how, ("amplitude", "common"), error=MotionError)
    low, high = checked_range(periods)
    if doubt := spectrum.beyond_points(high):
        warnings.warn(doubt, MotionWarning, stacklevel=3)
    wanted = code.part if part is None else require_positive("part", part, error=MotionError)
    kind = code.measure if measure is None else measure
    grid = np.concatenate([np.geomspace(low, high, POINTS), [0.0] if code.at_zero else []])
    target = np.asarray(spectrum.acceleration(grid, damping), dtype=np.float64)
    found = np.array([pair_spectrum(m, grid, damping, kind) for m in motions.values()])
    if not (found > 0.0).all():
        name = list(motions)[int(np.argmin(found.min(axis=1)))]
        msg = f"{name} has no acceleration in the measure {kind!r}: leave it out of the set"
        raise MotionError(msg)
    factors = np.ones(len(motions))
    if how == "amplitude":  # least squares of the logarithms
        factors = np.exp(np.log(target / found)[:, :POINTS].mean(axis=1))
    floor = target * np.where(grid > 0.0, wanted, code.at_zero)
    mean = (factors[:, None] * found).mean(axis=0)
    factors *= (floor / mean).max()
    ratio = (factors[:, None] * found).mean(axis=0)[:POINTS] / target[:POINTS]
    total = {
        name: float(factor) * before.get(name, 1.0)
        for name, factor in zip(motions, factors, strict=True)
    }
    _warn_of(total, limits, code.least if least is None else least, code.name)
    return Scaling(
        spectrum,
        code.name,
        kind,
        wanted,
        (low, high),
        damping,
        total,
        float(ratio.min()),
        float(ratio.max()),
    )


def checked_range(periods: tuple[float, float]) -> tuple[float, float]:
    """Return a range of periods [s], or raise a MotionError."""
    if np.shape(periods) != (2,):
        msg = f"periods = {periods!r}: give the shortest and the longest period in s"
        raise MotionError(msg)
    low = require_positive("periods[0]", periods[0], "s", error=MotionError)
    high = require_positive("periods[1]", periods[1], "s", error=MotionError)
    if not low < high:
        msg = f"periods = ({low:g}, {high:g}) s: the first must be below the second"
        raise MotionError(msg)
    return low, high


def _warn_of(
    factors: Mapping[str, float], limits: tuple[float, float], least: int, rule: str
) -> None:
    """Warn of factors that are out of the limits, and of too few motions."""
    low, high = limits
    far = [
        worded("{name} {factor:.3g}", name=name, factor=value)
        for name, value in factors.items()
        if not low <= value <= high
    ]
    if far:
        msg = worded(
            "scale factors outside {low:g} to {high:g}: {factors}. Choose stronger or "
            "weaker records, or set limits=",
            low=low,
            high=high,
            factors=joined(*far, by=", "),
        )
        warnings.warn(msg, MotionWarning, stacklevel=4)
    if len(factors) < least:
        msg = worded(
            "{count} motions: {code} allows the mean response for {least} or more",
            count=len(factors),
            code=rule,
            least=least,
        )
        warnings.warn(msg, MotionWarning, stacklevel=4)
