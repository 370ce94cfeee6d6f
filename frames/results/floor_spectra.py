"""Response spectra of the floors of a time history."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames.motion.spectra import response_spectrum
from frames.results.measures import floor_acceleration
from frames.results.recorded import require_steps

if TYPE_CHECKING:
    import numpy.typing as npt


def floor_spectrum(data: xr.Dataset, periods: npt.ArrayLike, damping: float = 0.05) -> xr.DataArray:
    """Return the response spectra of the levels' total accelerations, for floor equipment.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history of a model with levels.
    periods : array_like, shape (m,)
        Natural periods of the equipment [s], >= 0.
    damping : float
        Damping ratio of the equipment [-], in [0, 1).

    Returns
    -------
    xarray.DataArray
        Pseudo-acceleration (level, axis, period) [m/s2] of the mean motion of each level's nodes.

    Raises
    ------
    MotionError
        If a period or the damping is out of its bounds.
    ValueError
        If the records are not equally spaced in time, or are the first and the last step only.

    Examples
    --------
    >>> from frames import floor_spectrum, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example(1.0, storeys=2)
    >>> data = time_history(frame, pulse)
    >>> spectrum = floor_spectrum(data, periods=[0.1, 0.5, 1.0])
    >>> spectrum.dims
    ('level', 'axis', 'period')
    """
    require_steps(data, "floor_spectrum")
    return spectra_of(floor_acceleration(data), periods, damping)


def spectra_of(motions: xr.DataArray, periods: npt.ArrayLike, damping: float) -> xr.DataArray:
    """Return the spectra (level, axis, period) of motions (time, level, axis): `floor_spectrum`."""
    steps = np.diff(motions["time"].to_numpy())
    if len(steps) == 0 or np.ptp(steps) > 1e-6 * steps.mean():
        msg = "spectra need records equally spaced in time, at least two: run with a fixed record"
        raise ValueError(msg)
    moves = motions.transpose("level", "axis", "time")
    values = [
        [
            response_spectrum(one, float(steps[0]), periods, damping)["pseudo_acceleration"]
            for one in each
        ]
        for each in moves.to_numpy()
    ]
    return xr.DataArray(
        np.asarray(values),
        dims=("level", "axis", "period"),
        coords={
            "level": moves["level"],
            "axis": moves["axis"],
            "period": np.atleast_1d(np.asarray(periods, dtype=np.float64)),
        },
        attrs={"units": "m/s2", "long_name": "pseudo-acceleration", "damping": damping},
    )
