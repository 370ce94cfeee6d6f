"""Response spectra of a pair of horizontal components: one number a period, by several measures.

A pair of oscillators, along x and along y, moves on a path in plan. RotD100, the response in the
direction where it is largest, is the largest distance of that path from its origin; the response
in any direction is decided by the corners of the path's convex hull, from which the median over
all directions, RotD50, is taken (Boore 2010, Bull. Seism. Soc. Am. 100:1830-1835).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from frames._types import FloatArray
from frames.motion.spectra import checked_oscillators, displacement_history
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames.motion.ground_motion import GroundMotion

ANGLES = 180
"""Directions over half a turn of which RotD50 is the median."""


def _directions(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the largest response in each direction (ANGLES,)."""
    from scipy.spatial import ConvexHull, QhullError  # a good part of the time of `import frames`

    path = np.column_stack([x, y])
    try:
        corners = path[ConvexHull(path).vertices]
    except QhullError:  # all on one line: no hull
        corners = path
    angle = np.pi / ANGLES * np.arange(ANGLES)
    peaks = [np.abs(corners @ (np.cos(a), np.sin(a))).max() for a in angle]
    return np.array(peaks, dtype=np.float64)


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())


MEASURES: dict[str, Callable[[FloatArray, FloatArray], float]] = {
    "RotD100": lambda x, y: _peak(np.hypot(x, y)),
    "RotD50": lambda x, y: float(np.median(_directions(x, y))),
    "SRSS": lambda x, y: float(np.hypot(_peak(x), _peak(y))),
    "geometric mean": lambda x, y: float(np.sqrt(_peak(x) * _peak(y))),
    "arithmetic mean": lambda x, y: 0.5 * (_peak(x) + _peak(y)),
    "x": lambda x, y: _peak(x),
    "y": lambda x, y: _peak(y),
}
"""Measures of the response of a pair: functions of the histories along x and y."""


def pair_spectrum(
    motion: GroundMotion,
    periods: npt.ArrayLike,
    damping: float = 0.05,
    measure: str = "RotD100",
) -> FloatArray:
    """Return the spectrum of a pair of horizontal components.

    Parameters
    ----------
    motion : GroundMotion
        The motion; x and y, unless the measure is one of them.
    periods : array_like, shape (m,)
        Natural periods [s], >= 0.
    damping : float
        Part of the critical damping [-], in [0, 1).
    measure : str
        "RotD100" (maximum direction), "RotD50", "SRSS", "geometric mean", "arithmetic mean", or
        "x" or "y" alone.

    Returns
    -------
    ndarray, shape (m,)
        Pseudo-accelerations [m/s2].

    Raises
    ------
    MotionError
        If a component is missing, or a period, the damping or the measure is out of its bounds.

    Examples
    --------
    >>> from frames import GroundMotion
    >>> wave = [0.0, 3.0, 0.0, -3.0, 0.0]
    >>> both = GroundMotion(x=wave, y=[4.0 / 3.0 * a for a in wave], dt=0.1)
    >>> pair_spectrum(both, [0.0]).tolist()
    [5.0]
    """
    require_choice("measure", measure, tuple(MEASURES), error=MotionError)
    period, ratio = checked_oscillators(periods, damping)
    needed = measure if measure in {"x", "y"} else "xy"
    missing = [axis for axis in needed if getattr(motion, axis) is None]
    if missing:
        msg = (
            f"{motion.name or 'motion'} has no component {missing[0]}, which the measure "
            f"{measure!r} needs: give the pair, or take the measure 'x' or 'y'"
        )
        raise MotionError(msg)
    pair = [
        motion.x if motion.x is not None else np.zeros(motion.n_steps),
        motion.y if motion.y is not None else np.zeros(motion.n_steps),
    ]
    rule = MEASURES[measure]
    found = np.empty(len(period))
    for k, each in enumerate(period):
        if each > 0.0:
            x, y = (displacement_history(a, motion.dt, float(each), ratio) for a in pair)
            found[k] = (2.0 * np.pi / each) ** 2 * rule(x, y)
        else:
            found[k] = rule(*pair)
    return found
