"""Whether motions can be a set to design by: records that are there twice, and their strength."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import ComplexArray
    from frames.motion.ground_motion import GroundMotion

SAME = 0.999
"""Correlation of two components from which they are one record [-]."""

STRONGEST = 2.5
"""Horizontal PGA above almost all that was recorded [g]."""

CONVERSIONS = {
    "g to m/s2": STANDARD_GRAVITY,
    "g to cm/s2": 100.0 * STANDARD_GRAVITY,
    "g to in/s2": STANDARD_GRAVITY / 0.0254,
    "m/s2 to g": 1.0 / STANDARD_GRAVITY,
    "cm/s2 to g": 0.01 / STANDARD_GRAVITY,
    "in/s2 to g": 0.0254 / STANDARD_GRAVITY,
    "cm/s2 to m/s2": 0.01,
    "m/s2 to cm/s2": 100.0,
}
"""Factors that change a unit."""


def twins(motions: Mapping[str, GroundMotion]) -> tuple[str, ...]:
    """Return which motions are one record under several names."""
    flat = {
        name: [a / np.linalg.norm(a) for a in (motion.x, motion.y) if a is not None and a.any()]
        for name, motion in motions.items()
    }
    longest = max((len(a) for each in flat.values() for a in each), default=1)
    size = next_fast_len(2 * longest, real=True)
    spectra = {name: [rfft(a, size) for a in each] for name, each in flat.items()}
    found = [
        f"{one} and {other}"
        for one, other in combinations(spectra, 2)
        if motions[one].dt == motions[other].dt
        and any(_same(a, b, size) for a in spectra[one] for b in spectra[other])
    ]
    if not found:
        return ()
    return (
        f"{'; '.join(found)}: identical or proportional histories, probably one record under two "
        f"names: {len(motions)} motions count as fewer, and their mean is not that of "
        f"{len(motions)}; put another record in its place",
    )


def _same(a: ComplexArray, b: ComplexArray, size: int) -> bool:
    # Of spectra of components of norm 1: their correlation at any delay, first a bound on it.
    if 2.0 / size * float(np.abs(a) @ np.abs(b)) < SAME:
        return False
    return float(np.abs(irfft(a * np.conj(b), size)).max()) > SAME


def factor_doubts(factor: float, motions: Mapping[str, GroundMotion]) -> tuple[str, ...]:
    """Return whether a factor on motions changes a unit, or makes them stronger than any ground."""
    peaks = {
        name: float(np.hypot(*m.components[:, :2].T).max()) / STANDARD_GRAVITY
        for name, m in motions.items()
    }
    name = max(peaks, key=lambda each: peaks[each])
    remedy = "motions are in m/s2 once they are read: the unit of the files belongs in the column "
    remedy += '"unit" of their table, scale = 1 leaves them as recorded'
    for words, value in CONVERSIONS.items():
        if abs(abs(factor) / value - 1.0) < 0.005:
            return (
                f"scale = {factor:g} is the factor from {words} (PGA of {name} then "
                f"{peaks[name]:.3g} g): {remedy}",
            )
    if peaks[name] > STRONGEST:
        return (
            f"scale = {factor:g} gives {name} a PGA of {peaks[name]:.3g} g, almost no record has "
            f"more than {STRONGEST:g} g: {remedy}",
        )
    return ()
