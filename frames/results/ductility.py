"""How far links and hinges yielded: tables of ductility, rotation, residual and work."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.results.formulas import can_yield
from frames.results.peak_response import final_if_complete, final_value, largest

if TYPE_CHECKING:
    import xarray as xr

COLUMNS = (
    "kind",
    "largest",
    "time",
    "yield",
    "ductility",
    "residual",
    "cumulative",
    "work",
)

_STOREY = re.compile(r"storey-(\d+)-([xy])")


def ductility(data: xr.Dataset) -> pd.DataFrame:
    """Return how far each link that yields and each plastic hinge was deformed.

    Parameters
    ----------
    data : xarray.Dataset
        Of a `time_history` of a structure that may yield, whatever its recording.

    Returns
    -------
    pandas.DataFrame
        A row for each link with a yield force and each hinge, by name, with the columns

        - kind: "link" or "hinge";
        - largest: deformation against a force that resists it [m, rad]; of a hinge its plastic
          rotation, the size of that about both axes [rad]; and its time [s], NaN where there was
          none;
        - yield: deformation at first yield; NaN of hinges, which are rigid until then;
        - ductility: the one over the other [-]; of ties the deformation includes their slack. NaN
          of hinges: it would need the rotation at which the member yields, ``M_p L / (6 E I)``
          (ASCE/SEI 41, chapter 9), and data does not have the member. What codes limit is the
          plastic rotation itself;
        - residual: size of the deformation, or plastic rotation, that is left at the end of the
          run; NaN of a run that stopped before;
        - cumulative: plastic rotation run through [rad]; NaN of links;
        - work: done on what is plastic [J], what hardening stores of it included; of ties taken up.

        Without any rows where nothing can yield.

    Raises
    ------
    ValueError
        If histories were left out of the recording that kept no extremes of them.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, ductility, shear_building, time_history
    >>> from frames.demo import bearing_for
    >>> from frames.laws import Bilinear
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6,
    ...                        storey_law=lambda k: Bilinear(stiffness=k, yield_force=95e3))
    >>> data = time_history(frame, pulse, dt=0.004)
    >>> bool(ductility(data).loc["storey-1-x", "ductility"] > 1.0)
    True
    """
    rows = []
    if "link_yield_deformation" in data:
        found, names = largest(data, "link_ductility"), data["link"].to_numpy()
        limits = data["link_yield_deformation"].to_numpy()
        rest, work = final_if_complete(data, "link_deformation"), final_value(data, "link_work")
        for k in np.flatnonzero(can_yield(data)).tolist():
            ratio, at = _reached(found.values[k], found.at[k])
            size = ratio * limits[k]
            numbers = (size, at, limits[k], ratio, rest[k], math.nan, work[k])
            rows.append((str(names[k]), "link", *map(float, numbers)))
    if "hinge_moment" in data:
        found, names = largest(data, "hinge_rotation"), data["hinge"].to_numpy()
        turn, work = largest(data, "hinge_turn").values, final_value(data, "hinge_work")
        rest = final_if_complete(data, "hinge_rotation")
        for k, name in enumerate(names):
            size, at = _reached(found.values[k], found.at[k])
            numbers = (size, at, math.nan, math.nan, rest[k], turn[k], work[k])
            rows.append((str(name), "hinge", *map(float, numbers)))
    return pd.DataFrame(rows, columns=["name", *COLUMNS]).set_index("name")


def storey_ductility(data: xr.Dataset) -> pd.DataFrame:
    """Return how far the storeys of a `shear_building` with a `storey_law` yielded.

    Parameters
    ----------
    data : xarray.Dataset
        Of its `time_history`.

    Returns
    -------
    pandas.DataFrame
        A row a storey from below, with the columns x and y: largest deformation over that at
        yield [-]; residual_x and residual_y: what is left of it at the end of the run [m].

    Raises
    ------
    ValueError
        If no links are those of storeys: "storey-1-x", "storey-1-y" and so on.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion, shear_building, storey_ductility, time_history
    >>> from frames.demo import bearing_for
    >>> from frames.laws import Bilinear
    >>> pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016)
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6,
    ...                        storey_law=lambda k: Bilinear(stiffness=k, yield_force=95e3))
    >>> data = time_history(frame, pulse, dt=0.004)
    >>> storey_ductility(data)["x"].round(1).to_dict()
    {'storey-1': 6.0, 'storey-2': 0.6}
    """
    table = ductility(data)
    storeys: dict[int, dict[str, float]] = {}
    for name, row in table[table["kind"] == "link"].iterrows():
        match = _STOREY.fullmatch(str(name))
        if match is not None:
            axis, storey = match[2], storeys.setdefault(int(match[1]), {})
            storey[axis], storey[f"residual_{axis}"] = row["ductility"], row["residual"]
    if not storeys:
        msg = (
            "storey_ductility: data has no links of storeys that yield (storey-1-x, ...): give "
            "shear_building a storey_law, or see ductility(data) for links of other names"
        )
        raise ValueError(msg)
    index = pd.Index([f"storey-{k}" for k in sorted(storeys)], name="storey")
    rows = [storeys[k] for k in sorted(storeys)]
    return pd.DataFrame(rows, index=index, columns=["x", "y", "residual_x", "residual_y"])


def _reached(size: float, at: float) -> tuple[float, float]:
    # What was never reached has no time.
    return (float(size), float(at)) if size > 0.0 else (float(size), math.nan)
