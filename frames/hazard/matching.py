"""Pairs matched to a spectrum by wavelets, with the package `reqpy-m`, the extra "matching".

The package adjusts continuous wavelet coefficients until RotD100 or RotD50 follows the target
(Montejo 2021, Earthquake Spectra 37:1851-1872). The baseline is corrected here afterwards, so the
ground is at rest at the end, and what was reached is measured by this program's own spectra.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames.hazard.pair_spectra import pair_spectrum
from frames.motion.ground_motion import GroundMotion
from lir_element.door import require_choice
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.hazard.spectrum import Spectrum

SCALES, ROUNDS, POINTS = 200, 30, 60
"""Wavelet scales, rounds of adjustment, and periods at which the outcome is measured."""

PERCENTILES = {"RotD100": 100, "RotD50": 50}


def matched_pair(
    name: str,
    motion: GroundMotion,
    target: Spectrum,
    periods: tuple[float, float],
    damping: float,
    measure: str,
    tolerance: float,
) -> GroundMotion:
    """Return a motion whose pair follows a spectrum; arguments as in `MotionSet.matched_to`."""
    require_choice("measure", measure, tuple(PERCENTILES), error=MotionError)
    if motion.x is None or motion.y is None:
        msg = f"{name} is no pair: matching needs x and y"
        raise MotionError(msg)
    low, high = periods
    shortest, longest = max(0.5 * low, target.reach[0]), min(2.0 * high, target.reach[1])
    grid = np.geomspace(shortest, longest, 4 * POINTS)
    made = _generator()(
        motion.x / STANDARD_GRAVITY,
        motion.y / STANDARD_GRAVITY,
        1.0 / motion.dt,
        grid,
        target.acceleration(grid, damping) / STANDARD_GRAVITY,
        nn=PERCENTILES[measure],
        T1PSA=low,
        T2PSA=high,
        zi=damping,
        baseline_method="none",
        NS=SCALES,
        nit=ROUNDS,
    )
    x, y = (STANDARD_GRAVITY * np.asarray(made[key]) for key in ("sc1", "sc2"))
    with warnings.catch_warnings():  # of the drift that is taken out here
        warnings.simplefilter("ignore", MotionWarning)
        pair = GroundMotion(x=x, y=y, z=motion.z, dt=motion.dt)
    still = pair.corrected()
    found = GroundMotion(x=still.x, y=still.y, z=pair.z, dt=motion.dt, name=f"{name}, matched")
    check = np.geomspace(low, high, POINTS)
    ratio = pair_spectrum(found, check, damping, measure) / target.acceleration(check, damping)
    if math.isnan(ratio.sum()) or abs(ratio - 1.0).max() > tolerance:
        msg = (
            f"{name}: {measure} over target is {ratio.min():.2f} to {ratio.max():.2f} after the "
            "matching: take a shorter range, or a record of a shape like the target's"
        )
        warnings.warn(msg, MotionWarning, stacklevel=3)
    return found


def _generator() -> Any:
    """Return the function that matches pairs, or raise an ImportError that names the extra."""
    try:
        from reqpy_M import generate_rotdnn_compatible_record
    except ImportError as cause:
        msg = "matching comes with a package of its own: pip install 'lir-dcfp[matching]'"
        raise ImportError(msg) from cause
    return generate_rotdnn_compatible_record
