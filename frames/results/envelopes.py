"""Tables of peaks: envelopes of variables, ductility of yielding parts."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from frames.results.formulas import can_yield
from frames.results.peak_response import final_if_complete, final_value, largest
from frames.results.recorded import require_between_ends, require_recorded
from frames.results.storage import csv_of, make_folder, without_formulas, write_whole

_LONGEST_SHEET = 31  # characters that Excel allows in the name of a sheet


EXTREMES = ("largest", "time_of_largest", "smallest", "time_of_smallest")
"""Variables of an envelope; a recording adds the name of the quantity: `largest_energy`."""


def envelope(values: xr.DataArray | xr.Dataset, variable: str | None = None) -> xr.Dataset:
    """Return the extremes of a history and their times [units of the values, s].

    Parameters
    ----------
    values : xarray.DataArray or xarray.Dataset
        History with the dimension `time`, as from `member_forces`: extremes of its steps. Or the
        Dataset of a time history, with the name of a variable: extremes of all steps of the run if
        the recording kept them (`Recording`), else of its steps.
    variable : str, optional
        Name of the variable of a Dataset.

    Returns
    -------
    xarray.Dataset
        `largest`, `time_of_largest`, `smallest` and `time_of_smallest` [units of the values, s]
        over the other dimensions; NaN if the history is NaN. Its `to_dataframe()` is a table.

    Raises
    ------
    ValueError
        If the values have no dimension `time`, were not recorded, or only at both ends of the run.
    TypeError
        If a variable is named without a Dataset, or the other way round.

    Examples
    --------
    >>> from frames import envelope, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> found = envelope(data, "axial_force").squeeze()
    >>> 1.0 < float(found["largest"] / data["weight"]) < 1.5
    True
    """
    if isinstance(values, xr.Dataset):
        return _envelope_of(values, variable)
    if variable is not None:
        msg = f"variable = {variable!r} belongs to a Dataset: give the Dataset, or leave it out"
        raise TypeError(msg)
    require_between_ends(str(values.attrs.get("recording", "")), "envelope")
    if "time" not in values.dims:
        msg = f"values have the dimensions {values.dims}: an envelope needs 'time'"
        raise ValueError(msg)
    history = values.transpose("time", ...)
    time, array = history["time"].to_numpy(), history.to_numpy()
    dims = tuple(str(name) for name in history.dims[1:])
    known = np.isfinite(array).all(axis=0)
    found: dict[str, xr.Variable] = {}
    for name, fill, pick in (("largest", -np.inf, np.argmax), ("smallest", np.inf, np.argmin)):
        at = pick(np.where(np.isnan(array), fill, array), axis=0)
        extreme = np.take_along_axis(array, at[None], axis=0)[0]
        found[name] = xr.Variable(dims, np.where(known, extreme, np.nan), values.attrs)
        when = np.where(known, time[at], np.nan)
        found[f"time_of_{name}"] = xr.Variable(dims, when, {"units": "s"})
    kept = {name: history[name] for name in history.coords if "time" not in history[name].dims}
    return xr.Dataset(found, kept)


def _envelope_of(data: xr.Dataset, variable: str | None) -> xr.Dataset:
    # From the extremes that a recording kept, or from the history.
    if variable is None:
        msg = "envelope of a Dataset needs the name of a variable: envelope(data, 'axial_force')"
        raise TypeError(msg)
    if f"{EXTREMES[0]}_{variable}" not in data.variables:
        require_recorded(data, "envelope", variable)
        return envelope(data[variable])
    kept = data[[f"{name}_{variable}" for name in EXTREMES]]
    found = kept.rename({f"{name}_{variable}": name for name in EXTREMES})
    found.attrs = {}
    return found


def write_tables(tables: Mapping[str, pd.DataFrame], path: str | Path) -> None:
    """Write tables: as sheets of a workbook, or as CSV files in a folder.

    Parameters
    ----------
    tables : mapping of str to pandas.DataFrame
        Tables by name, as from `force_tables`; also objects with `to_dataframe()`, such as a
        fragility curve, a rate or an incremental analysis.
    path : str or Path
        A workbook if it ends in ".xlsx" (needs the package openpyxl: ``pip install
        'lir-dcfp[excel]'``), else a folder, which is made. Existing files of the same names are
        replaced.

    Raises
    ------
    OSError
        If a file cannot be written; the message names it.
    ImportError
        If openpyxl is missing.
    TypeError
        If tables are not given by name, or one is no table.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from frames import peaks, time_history, write_tables
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_tables({"peaks": peaks(data)}, folder)
    ...     print([path.name for path in Path(folder).iterdir()])
    ['peaks.csv']
    """
    given: object = tables
    if not isinstance(given, Mapping):
        msg = f"tables is a {type(given).__name__}: pass tables by name, {{'name': ...}}"
        raise TypeError(msg)
    tables = {name: _table(name, each) for name, each in tables.items()}
    target = Path(path)
    if target.suffix.lower() == ".xlsx":
        try:
            import_module("openpyxl")
        except ImportError as cause:
            msg = f"{target} needs openpyxl: pip install 'lir-dcfp[excel]', or give a folder (CSV)"
            raise ImportError(msg) from cause
        workbook = io.BytesIO()
        with pd.ExcelWriter(workbook, engine="openpyxl") as writer:
            for name, table in tables.items():
                shown = without_formulas(table)
                shown.to_excel(writer, sheet_name=name[:_LONGEST_SHEET], merge_cells=False)
        write_whole(target, workbook.getvalue())
        return
    make_folder(target)
    for name, table in tables.items():
        write_whole(target / f"{name}.csv", csv_of(table))


def _table(name: str, given: Any) -> pd.DataFrame:
    # A table, or an object with one.
    found = given.to_dataframe() if hasattr(given, "to_dataframe") else given
    if not isinstance(found, pd.DataFrame):
        msg = f"tables[{name!r}] must be a pandas.DataFrame, not a {type(given).__name__}"
        raise TypeError(msg)
    return found


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
    """Return deformation and ductility of each yielding link and plastic hinge [m, rad; -].

    Parameters
    ----------
    data : xarray.Dataset
        Result of a `time_history` of a structure that may yield, with any recording.

    Returns
    -------
    pandas.DataFrame
        A row for each link with a yield force and each hinge, by name, with the columns

        - kind: "link" or "hinge";
        - largest: deformation against a force that resists it [m, rad]; of a hinge its plastic
          rotation, the size of that about both axes [rad]; and its time [s], NaN if there was none;
        - yield: deformation at first yield; NaN of hinges, which are rigid until then;
        - ductility: the one over the other [-]; of ties the deformation includes their slack. NaN
          for hinges: it would need the rotation at which the member yields, ``M_p L / (6 E I)``
          (ASCE/SEI 41, chapter 9), and data does not have the member. Codes limit the plastic
          rotation itself;
        - residual: size of the deformation, or plastic rotation, that is left at the end of the
          run; NaN of a run that stopped before;
        - cumulative: plastic rotation run through [rad]; NaN of links;
        - work: plastic work [J], including the energy stored by hardening; of ties dissipated.

        Without any rows if nothing can yield.

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
    """Return the ductility of the storeys of a `shear_building` with a `storey_law` [-, m].

    Parameters
    ----------
    data : xarray.Dataset
        Result of its `time_history`.

    Returns
    -------
    pandas.DataFrame
        A row a storey from below, with the columns x and y: largest deformation over that at yield
        [-]; residual_x and residual_y: deformation at the end of the run [m].

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
            "storey_ductility: data has no links of storeys that yield (storey-1-x, ...): "
            "pass storey_law to shear_building, or use ductility(data) for other links"
        )
        raise ValueError(msg)
    index = pd.Index([f"storey-{k}" for k in sorted(storeys)], name="storey")
    rows = [storeys[k] for k in sorted(storeys)]
    return pd.DataFrame(rows, index=index, columns=["x", "y", "residual_x", "residual_y"])


def _reached(size: float, at: float) -> tuple[float, float]:
    # Without a peak there is no time.
    return (float(size), float(at)) if size > 0.0 else (float(size), math.nan)
