"""Effects of impacts on rims and of landings, from the results of a time history."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.design._errors import CheckError
from frames.motion.ground_motion import GroundMotion
from frames.results.formulas import displacement, in_plan, of_bearings, rims_met
from frames.results.measures import uplift_gap
from frames.results.peak_response import places_of
from frames.results.quantities import QUANTITIES
from frames.results.recorded import require_recorded, require_steps
from lir_element.argument_checks import require_between, require_non_negative

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray, FloatArray


def rim_engagement(data: xr.Dataset) -> pd.DataFrame:
    """Return time and displacement of the first contact with each rim [s, m].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history with `rim_force` and `bearing_displacement`.

    Returns
    -------
    pandas.DataFrame
        A row for each rim with contact: bearing, surface, time [s], displacement in plan then [m],
        speed in plan a recorded step before (NaN if it was not recorded) [m/s], largest rim force
        [N].

    Raises
    ------
    ValueError
        If the variables or the steps between the ends were not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import rim_engagement
    >>> frame, pulse = example(2.1)
    >>> data = time_history(frame, pulse)
    >>> met = rim_engagement(data)
    >>> met["surface"].tolist(), met["displacement"].round(2).tolist()
    (['bottom', 'top'], [0.25, 0.25])
    """
    require_recorded(data, "rim_engagement", "rim_force", "bearing_displacement")
    require_steps(data, "rim_engagement")
    time = data["time"].to_numpy()
    force = of_bearings(data, "rim_force", "surface")
    moved = displacement(data)
    speed = np.full(moved.shape, np.nan)
    if "bearing_velocity" in data.variables:
        speed = in_plan(of_bearings(data, "bearing_velocity", "axis"))
    rows = []
    for b, name in enumerate(data["bearing"].to_numpy()):
        for s, surface in enumerate(data["surface"].to_numpy()):
            met = np.flatnonzero(force[:, b, s] > 0.0)
            if len(met):
                k = met[0]
                largest = float(force[:, b, s].max())
                then = float(moved[k, b]), float(speed[max(k - 1, 0), b])
                rows.append((str(name), str(surface), float(time[k]), *then, largest))
    columns = ["bearing", "surface", "time", "displacement", "speed", "rim_force"]
    return pd.DataFrame(rows, columns=columns)


def impact_demand(data: xr.Dataset, after: float = 0.3) -> pd.DataFrame:
    """Compare the structure's demands at rim impacts with those before the first one.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history with the histories of rims, base shear and nodes.
    after : float
        Time after each step of contact that counts as impact [s], at least 0.

    Returns
    -------
    pandas.DataFrame
        A row for the base shear in plan, each level's mean acceleration in plan and each storey's
        mean drift: unit, largest value before the first contact, largest at impacts, its time [s],
        and the ratio of both (infinite if the first is zero). Empty without impacts.

    Raises
    ------
    ValueError
        If an input was not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import impact_demand
    >>> frame, pulse = example(2.1)
    >>> data = time_history(frame, pulse)
    >>> bool(impact_demand(data).loc["base shear", "ratio"] > 1.0)
    True
    """
    require_recorded(data, "impact_demand", "rim_force", "base_shear")
    require_steps(data, "impact_demand")
    require_non_negative("after", after, "s")
    time, met = data["time"].to_numpy(), np.asarray(rims_met(data).any(axis=1))
    columns = ["unit", "before", "at_impact", "time", "ratio"]
    if not met.any():
        return pd.DataFrame(columns=columns)
    hit, before = near(met, time, after), time < time[np.argmax(met)]
    found = {
        label: (unit, *_compared(history, time, before, hit))
        for label, unit, history in _felt(data)
    }
    return pd.DataFrame.from_dict(found, orient="index", columns=columns)


def uplift_events(data: xr.Dataset, after: float = 0.1) -> pd.DataFrame:
    """Return each lift-off of a bearing: duration [s], gap [m] and landing force [N].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history with the histories of bearings and nodes.
    after : float
        Time after the landing in which the maximum axial force counts as its force [s].

    Returns
    -------
    pandas.DataFrame
        A row for each: bearing, begin [s], duration [s], gap [m], landing_force [N] (NaN if the run
        ends in the air). The last column is True if a rim of the bearing was pressed at most
        `after` before the lift-off.

    Raises
    ------
    ValueError
        If an input was not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import uplift_events
    >>> frame, pulse = example(2.1)
    >>> data = time_history(frame, pulse)
    >>> len(uplift_events(data))
    0
    """
    require_recorded(data, "uplift_events", "axial_force", "rim_force")
    require_steps(data, "uplift_events")
    require_non_negative("after", after, "s")
    time = data["time"].to_numpy()
    force = of_bearings(data, "axial_force")
    gap, met = uplift_gap(data).to_numpy(), rims_met(data) > 0.0
    rows = []
    for b, name in enumerate(data["bearing"].to_numpy()):
        for first, last in _runs(force[:, b] <= 0.0):
            ends = last < len(time)
            end = time[last] if ends else time[-1]
            landing = (time >= end) & (time <= end + after)
            earlier = (time >= time[first] - after) & (time <= time[first])
            rows.append(
                (
                    str(name),
                    float(time[first]),
                    float(end - time[first]),
                    float(gap[first:last, b].max()),
                    float(force[landing, b].max()) if ends else math.nan,
                    bool(met[earlier, b].any()),
                )
            )
    columns = ["bearing", "begin", "duration", "gap", "landing_force", "at_impact"]
    return pd.DataFrame(rows, columns=columns)


def slips_of_events(data: xr.Dataset, ends: tuple[float, ...]) -> pd.DataFrame:
    """Return largest and residual slip and displacement of each of several events [m].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history of the events in a row, for example under `repeated_motion`.
    ends : tuple of float
        Times at which the events end, pauses included [s], rising.

    Returns
    -------
    pandas.DataFrame
        A row for each event and bearing: event from 1 on, bearing, slip [m] and displacement [m]
        in plan, the largest during the event, slip_left and displacement_left at its end. Events
        that the run did not reach to the end are missing.

    Raises
    ------
    CheckError
        If the times do not rise.
    ValueError
        If slip and displacement were not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import repeated_motion, slips_of_events
    >>> frame, pulse = example(1.5)
    >>> motion, ends = repeated_motion(pulse, 2, pause=3.0)
    >>> data = time_history(frame, motion)
    >>> len(slips_of_events(data, ends))
    2
    """
    require_recorded(data, "slips_of_events", "interface_slip_size", "bearing_displacement")
    require_steps(data, "slips_of_events")
    if not ends or np.any(np.diff([0.0, *ends]) <= 0.0):
        msg = f"ends = {ends}: give rising times of the events' ends [s]"
        raise CheckError(msg)
    time = data["time"].to_numpy()
    slip = of_bearings(data, "interface_slip_size")
    moved = displacement(data)
    step = float(np.diff(time).max(initial=0.0))
    rows = []
    for k, (begin, end) in enumerate(zip((0.0, *ends[:-1]), ends, strict=True)):
        if time[-1] < end - 1.5 * step or ("failed_at" in data.attrs and time[-1] < end):
            break
        part = (time >= begin) & (time <= end + 1e-9)
        last = np.flatnonzero(part)[-1]
        for b, name in enumerate(data["bearing"].to_numpy()):
            row = slip[part, b].max(), slip[last, b], moved[part, b].max(), moved[last, b]
            rows.append((k + 1, str(name), *map(float, row)))
    columns = ["event", "bearing", "slip", "slip_left", "displacement", "displacement_left"]
    return pd.DataFrame(rows, columns=columns)


def repeated_motion(
    motion: GroundMotion, times: int, pause: float
) -> tuple[GroundMotion, tuple[float, ...]]:
    """Return a motion several times in a row, with a pause after each.

    Parameters
    ----------
    motion : GroundMotion
        The event.
    times : int
        Number of repetitions, at least 1.
    pause : float
        Time of rest after each [s], rounded up to whole steps; long enough for the structure to
        come to rest.

    Returns
    -------
    GroundMotion
        The events in a row.
    tuple of float
        Times at which they end, pauses included [s], for `slips_of_events` and `event_checks`.

    Raises
    ------
    CheckError
        If there is no event.
    MotionError
        If the pause is negative.

    Examples
    --------
    >>> from frames import GroundMotion
    >>> pulse = GroundMotion(x=[0.0, 1.0, -1.0, 0.0], dt=0.5, name="pulse")
    >>> motion, ends = repeated_motion(pulse, 2, pause=2.0)
    >>> motion.x.tolist(), ends
    ([0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0], (4.0, 7.5))
    """
    count = int(require_between("times", times, 1, 1000, "-", error=CheckError))
    one = motion.with_tail(pause)
    given = {axis: getattr(one, axis) for axis in "xyz"}
    rows = {axis: np.tile(a, count) for axis, a in given.items() if a is not None}
    length = len(next(iter(rows.values()))) // count
    ends = [k * length * one.dt for k in range(1, count + 1)]
    ends[-1] -= one.dt
    name = f"{motion.name or 'motion'}, {count} times"
    return GroundMotion(**rows, dt=one.dt, name=name), tuple(ends)


def near(met: BoolArray, time: FloatArray, after: float) -> BoolArray:
    """Return the steps at a contact or less than some time after one.

    Shapes: met (n,), time (n,), result (n,).
    """
    last = np.maximum.accumulate(np.where(met, time, -math.inf))
    return np.asarray(time - last <= after)


def _felt(data: xr.Dataset) -> list[tuple[str, str, FloatArray]]:
    found = [("base shear", "N", QUANTITIES["base_shear"].of(data))]
    for word, name in (("acceleration", "floor_plan"), ("drift", "drift")):
        places = places_of(data, name)
        if len(places):
            values, unit = QUANTITIES[name].of(data), QUANTITIES[name].pure_unit
            found += [(f"{word} of {at}", unit, values[:, k]) for k, at in enumerate(places)]
    return found


def _compared(
    history: FloatArray, time: FloatArray, before: BoolArray, hit: BoolArray
) -> tuple[float, float, float, float]:
    earlier = float(history[before].max(initial=0.0))
    at = np.where(hit, history, -math.inf)
    k = int(np.argmax(at))
    value = float(at[k])
    return earlier, value, float(time[k]), value / earlier if earlier > 0.0 else math.inf


def _runs(mask: BoolArray) -> list[tuple[int, int]]:
    # First step of each run of True, and the first one after it.
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edges > 0), np.flatnonzero(edges < 0), strict=True))
