"""Sensitivity of a run to its step, and to a billionth of its ground motion."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames._errors import AuditWarning
from frames.results.peaks import peaks
from frames.solve.time_history import time_history
from lir_element.texts import worded

if TYPE_CHECKING:
    import xarray as xr

    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion

NOISE = 1e-9
"""Share of the ground motion that a run is disturbed by [-]."""

SENSITIVE = 0.01
"""Difference by that noise, over the value, from which on a peak is chance."""

_FINER = 0.25  # of the tolerance: half the steps, because the error grows with their square
_TOLERANCE = 1e-3  # default, as of `time_history`
_OF_RUN = ("energy balance: error over input", "duration computed", "seconds of the time loop")
_HISTORY = "bearing displacement, whole history"


def step_sensitivity(
    model: FrameData,
    motion: GroundMotion,
    duration: float | None = None,
    dt: float | None = None,
    **options: Any,
) -> pd.DataFrame:
    """Run a time history three times: as given, with half the step, and disturbed by a billionth.

    Parameters
    ----------
    model : Frame
        The structure and its bearings.
    motion : GroundMotion
        Acceleration of the ground.
    duration, dt : float, optional
        As for `time_history`. With ``dt=None`` a quarter of the tolerance replaces half the step.
    **options
        Further arguments of `time_history`, except those of recording.

    Returns
    -------
    pandas.DataFrame
        By quantity of `peaks`, and for the whole history of bearing displacements: `value` and
        `unit` of the given run (of the history its largest displacement), the relative differences
        `halved` and `noise` of the other runs [-]; NaN if the value is zero. A run that stopped is
        compared up to there.

    Raises
    ------
    TypeError
        If an option is one of recording.

    Warns
    -----
    AuditWarning
        If noise changes the displacements by more than 1 %: no step makes their peak exact, so use
        the envelope of several disturbed motions; or if the halved step does.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, lumped_mass, step_sensitivity
    >>> from frames.demo import bearing_for
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> found = step_sensitivity(lumped_mass(bearing_for(2000e3), mass=204e3), pulse)
    >>> bool(found["halved"].max() < 0.02)
    True
    """
    for name in ("record_every", "recording"):
        if name in options:
            msg = f"step_sensitivity does not support {name}: leave it out"
            raise TypeError(msg)
    asked = time_history(model, motion, duration, dt, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AuditWarning)  # same as in the first run
        if dt is None:
            finer = _FINER * (options.get("tolerance") or _tolerance(asked))
            halved = time_history(model, motion, duration, **(options | {"tolerance": finer}))
        else:
            halved = time_history(model, motion, duration, 0.5 * dt, record_every=2, **options)
        disturbed = time_history(model, motion.scaled(1.0 + NOISE), duration, dt, **options)
    table = peaks(asked)[["value", "unit"]].drop(index=list(_OF_RUN), errors="ignore")
    largest = float(np.abs(asked["bearing_displacement"]).max())
    for name, other in (("halved", halved), ("noise", disturbed)):
        values = peaks(other)["value"].reindex(table.index)
        scale = table["value"].abs()
        table[name] = ((values - table["value"]).abs() / scale.where(scale > 0.0)).astype(float)
    table.loc[_HISTORY] = [largest, "m", _apart(asked, halved), _apart(asked, disturbed)]
    _tell(table)
    return table


def _tolerance(data: xr.Dataset) -> float:
    tolerance = float(data.attrs["tolerance"])
    return tolerance if tolerance > 0.0 else _TOLERANCE


def _apart(data: xr.Dataset, other: xr.Dataset) -> float:
    # Largest difference of displacement histories over the largest displacement.
    u, v = (each["bearing_displacement"].to_numpy() for each in (data, other))
    count, largest = min(len(u), len(v)), float(np.abs(u).max())
    return float(np.abs(u[:count] - v[:count]).max() / largest) if largest > 0.0 else 0.0


def _tell(table: pd.DataFrame) -> None:
    by_noise, by_step = (float(table.loc[_HISTORY, name]) for name in ("noise", "halved"))
    text = ""
    if by_noise > SENSITIVE:
        text = worded(
            "a change of 1e-9 in the motion changes displacements by {change:.2g} % of the "
            "largest: use the envelope of several disturbed runs, not a smaller step",
            change=100.0 * by_noise,
        )
    elif by_step > SENSITIVE:
        text = worded(
            "half the step changes displacements by {change:.2g} % of the largest: use a "
            "smaller dt, or leave dt out",
            change=100.0 * by_step,
        )
    if text:
        warnings.warn(text, AuditWarning, stacklevel=3)
