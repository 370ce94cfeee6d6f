"""Where the resultant between the sliders lay when it was farthest off, and what pressed then."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.bundles.peak_data import PRESSED
from frames.design._errors import CheckError
from frames.results.formulas import in_plan, of_bearings
from frames.results.recorded import require_recorded, require_steps
from lir_element.argument_checks import require_between, require_positive

if TYPE_CHECKING:
    import xarray as xr

_NEEDED = (
    "interface_eccentricity",
    "axial_force",
    "rim_force",
    "slider_displacement",
    "interface_slip_size",
)


def resultant_offsets(
    data: xr.Dataset, *, least_load: float = PRESSED, limit: float = 0.8
) -> pd.DataFrame:
    """Return when the resultant between the sliders was farthest off their axes, and why.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history that recorded eccentricity, axial force, rims, sliding and slip.
    least_load : float
        Axial force over that at rest above which offsets count [-]. All runs keep those above 0.05
        (`peak_eccentricity`) and above 0.5 (`peak_eccentricity_loaded`, which checks take).
    limit : float
        Offset over the slider's radius, the time above which is given [-].

    Returns
    -------
    pandas.DataFrame
        A row for each bearing: the largest offset over the slider's radius [-], its time [s], the
        axial force then over that at rest [-], which rims pressed ("none", "bottom", "top",
        "both"), interface slip [m], how far the other rim was [m] where one pressed alone (else
        NaN), and the time above the limit [s].

    Raises
    ------
    CheckError
        If a share or a limit is out of bounds.
    ValueError
        If the variables or the steps between the ends were not recorded.

    Notes
    -----
    Source: docs/theory.md (10.2). At the level "pendulum" a rim may press alone while the other is
    a millimetre away; real sliders turn against each other until both press, as they do at the
    level "contact".

    Examples
    --------
    >>> from frames import GroundMotion, lumped_mass, time_history
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.1, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.15)
    >>> pulse = GroundMotion(x=[0.0, 2.0, 0.0, -2.0, 0.0], dt=0.2)
    >>> table = resultant_offsets(time_history(lumped_mass(bearing, 15e3), pulse))
    >>> table["rims"].tolist(), float(table["time_above"][0])
    (['none'], 0.0)
    """
    require_between("least_load", least_load, 0.0, 1.0, "-", error=CheckError)
    require_positive("limit", limit, "-", error=CheckError)
    require_recorded(data, "resultant_offsets", *_NEEDED)
    require_steps(data, "resultant_offsets")
    time = data["time"].to_numpy()
    load = of_bearings(data, "axial_force")
    load = load / data["static_axial_force"].to_numpy()
    offset = of_bearings(data, "interface_eccentricity")
    offset = np.where(load > least_load, offset / data["slider_radius"].to_numpy(), 0.0)
    met = of_bearings(data, "rim_force", "surface") > 0.0
    slid = of_bearings(data, "slider_displacement", "surface", "axis")
    clear = data["rim_displacement"].transpose("bearing", "surface").to_numpy() - in_plan(slid)
    slip = of_bearings(data, "interface_slip_size")
    lasts = np.diff(time, append=time[-1])
    words = [*data["surface"].to_numpy(), "both"]
    rows = []
    for b, name in enumerate(data["bearing"].to_numpy()):
        k = int(np.argmax(offset[:, b]))
        pressed = np.flatnonzero(met[k, b])
        rims = "none" if not len(pressed) else words[2 if len(pressed) == 2 else pressed[0]]
        other = float(clear[k, b, 1 - pressed[0]]) if len(pressed) == 1 else np.nan
        rows.append(
            (
                str(name),
                float(offset[k, b]),
                float(time[k]),
                float(load[k, b]),
                str(rims),
                float(slip[k, b]),
                other,
                float(lasts[offset[:, b] > limit].sum()),
            )
        )
    columns = ["bearing", "offset", "time", "load", "rims", "slip", "clearance", "time_above"]
    return pd.DataFrame(rows, columns=columns)
