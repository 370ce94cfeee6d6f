"""The ground motion as steps of an analysis see it: nothing between two steps is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion


def seen_by_steps(motion: GroundMotion, dt: float) -> tuple[FloatArray, float]:
    """Return ground accelerations and their step for an analysis in steps of `dt`."""
    given = np.ascontiguousarray(motion.components, dtype=np.float64)
    step = float(motion.dt)
    if dt <= step * (1.0 + 1e-9) or len(given) < 2:
        return given, step
    rise = np.diff(given, axis=0) / step
    velocity = np.vstack([np.zeros(3), np.cumsum(0.5 * step * (given[1:] + given[:-1]), axis=0)])
    parts = step * velocity[:-1] + step**2 * (0.5 * given[:-1] + step * rise / 6.0)
    place = np.vstack([np.zeros(3), np.cumsum(parts, axis=0)])
    count = int(np.ceil((len(given) - 1) * step / dt - 1e-9)) + 2
    times = dt * np.arange(-1, count + 1)
    index = np.clip((times / step + 1e-9).astype(np.int64), 0, len(given) - 1)
    since = np.maximum(times - step * index, 0.0)[:, None]
    inside = index < len(given) - 1
    slope = np.vstack([rise, np.zeros(3)])[index]
    start = np.where(inside[:, None], given[index], 0.0)
    moved = place[index] + since * velocity[index] + since**2 * (0.5 * start + since * slope / 6.0)
    moved[times < 0.0] = 0.0
    means = (moved[2:] - 2.0 * moved[1:-1] + moved[:-2]) / dt**2
    means[0] *= 2.0  # half of the first triangle lies before the motion
    return np.ascontiguousarray(means), dt
