"""Speed and error of a model on this machine, step by step."""

from __future__ import annotations

import math
import statistics
import warnings
from typing import TYPE_CHECKING, Literal, NamedTuple

from frames.recording.recording import Recording
from frames.results.peaks import peaks
from frames.solve.time_history import time_history
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import xarray as xr

    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion

STEPS = (0.02, 0.01, 0.005, 0.0025)
"""Steps that are tried [s]."""
REPEATS = 3
_COMPARED = ("bearing displacement", "base shear", "acceleration in plan, worst node")


class Way(NamedTuple):
    """Options of a run, and its results."""

    dt: float  # step [s]; NaN if the program controls its error
    level: str  # of the bearings
    steps: int  # number, refinements included
    seconds: float  # in the loop, median of the repeats [s]
    share: float  # of that over the duration of the motion [-]
    # differences of the peaks from those of the finest run [-]; NaN if it stopped early
    displacement: float
    base_shear: float
    acceleration: float
    status: str  # as in the results


def ways_to_run(
    model: FrameData,
    motion: GroundMotion,
    *,
    levels: Sequence[Literal["pendulum", "contact"]] = ("pendulum",),
) -> Iterator[Way]:
    """Run a model with several steps, the finest first, with which the others are compared."""
    finest = min(STEPS) / 2.0
    time_history(model, motion, min(motion.duration, 4.0 * finest), dt=finest)  # loads the kernels
    reference = _peaks(_run(model, motion, finest, levels[0]))
    for level in levels:
        for dt in (finest, None, *STEPS) if level == levels[0] else (None, *STEPS):
            count = 1 if dt == finest else REPEATS
            runs = [_run(model, motion, dt, level) for _ in range(count)]
            yield _way(runs, motion, dt, level, reference)


def recommended(ways: Sequence[Way], error: float) -> Way | None:
    """Return the cheapest options whose differences are within an error."""
    good = [
        way
        for way in ways
        if way.status == "ok" and max(way.displacement, way.base_shear, way.acceleration) <= error
    ]
    return min(good, key=lambda way: way.seconds, default=None)


def _run(model: FrameData, motion: GroundMotion, dt: float | None, level: str) -> xr.Dataset:
    with warnings.catch_warnings():  # the status is in the table
        warnings.simplefilter("ignore", AnalysisWarning)
        return time_history(model, motion, dt=dt, level=level, recording=Recording(every=None))


def _peaks(data: xr.Dataset) -> list[float]:
    values = peaks(data)["value"]
    return [float(values[name]) for name in _COMPARED]


def _way(
    runs: Sequence[xr.Dataset],
    motion: GroundMotion,
    dt: float | None,
    level: str,
    reference: Sequence[float],
) -> Way:
    attrs = runs[0].attrs
    seconds = statistics.median(float(run.attrs["seconds_loop"]) for run in runs)
    errors = [math.nan] * len(reference)
    if attrs["status"] == "ok":
        errors = [
            abs(found / expected - 1.0) if expected > 0.0 else abs(found)
            for found, expected in zip(_peaks(runs[0]), reference, strict=True)
        ]
    displacement, base_shear, acceleration = errors
    return Way(
        dt=math.nan if dt is None else dt,
        level=level,
        steps=int(attrs["steps"]),
        seconds=seconds,
        share=seconds / motion.duration,
        displacement=displacement,
        base_shear=base_shear,
        acceleration=acceleration,
        status=str(attrs["status"]),
    )
