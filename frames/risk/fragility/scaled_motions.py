"""Motions and intensities: of scaled ones, and factors that bring them to an intensity."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

from frames._errors import MotionWarning
from frames.risk._errors import FragilityError
from frames.risk.fragility.intensity import Intensity
from lir_element.argument_checks import require_positive

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.motion.ground_motion import GroundMotion
    from frames.risk.fragility.intensity import IntensityMeasure

_LEAST_POWER = 0.01  # of a measure that motions can be scaled to


def values_of(
    measure: IntensityMeasure, motion: GroundMotion, factors: Sequence[float]
) -> list[float]:
    """Return the intensities of a motion times each factor (> 0), if they are positive numbers."""
    if isinstance(measure, Intensity):
        one = measure.of(motion)
        return [factor**measure.power * one for factor in factors]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)  # the caller has the warning
        found = [measure.of(motion.scaled(factor)) for factor in factors]
    name = f"{measure.label} of {motion.name or 'motion'}"
    return [require_positive(name, each, measure.unit, error=FragilityError) for each in found]


def growth_of(measure: IntensityMeasure, motion: GroundMotion) -> tuple[float, float]:
    """Return the intensity of a motion, and the power of the factor that it grows with."""
    if isinstance(measure, Intensity):
        return measure.of(motion), measure.power
    one, two, three = values_of(measure, motion, (1.0, 2.0, 3.0))
    power = math.log2(two / one)
    if power < _LEAST_POWER or not math.isclose(three, one * 3.0**power, rel_tol=1e-6):
        msg = (
            f"{measure.label} of {motion.name or 'motion'} is {one:g}, of twice the motion "
            f"{two:g}, of 3 times {three:g}: no motion can be scaled to it. Take cloud_analysis"
        )
        raise FragilityError(msg)
    return one, power


def at_one(
    measure: IntensityMeasure, motions: Mapping[str, GroundMotion]
) -> tuple[dict[str, GroundMotion], float]:
    """Return motions at an intensity of 1, and the power of the factor that all grow with."""
    grown = {name: growth_of(measure, motion) for name, motion in motions.items()}
    power = next(iter(grown.values()))[1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)  # none is run at an intensity of 1
        return {
            name: motions[name].scaled((1.0 / one) ** (1.0 / power))
            for name, (one, _) in grown.items()
        }, power


def factors_to(
    motions: Mapping[str, GroundMotion],
    cases: Sequence[tuple[str, float]],
    intensity: IntensityMeasure,
) -> list[tuple[str, float]]:
    """Return motion and factor of runs that are given by motion and intensity."""
    grown = {m: growth_of(intensity, motions[m]) for m in dict.fromkeys(m for m, _ in cases)}
    return [(m, (level / grown[m][0]) ** (1.0 / grown[m][1])) for m, level in cases]
