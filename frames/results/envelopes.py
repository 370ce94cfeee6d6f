"""Envelopes of histories, and tables as files."""

from __future__ import annotations

import io
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from frames.results.recorded import require_between_ends, require_recorded
from frames.results.storage import csv_of, make_folder, without_formulas, write_whole

_LONGEST_SHEET = 31  # characters that Excel allows in the name of a sheet


EXTREMES = ("largest", "time_of_largest", "smallest", "time_of_smallest")
"""Variables of an envelope; a recording adds the name of what they are of: `largest_energy`."""


def envelope(values: xr.DataArray | xr.Dataset, variable: str | None = None) -> xr.Dataset:
    """Return the extremes of a history and when they are reached.

    Parameters
    ----------
    values : xarray.DataArray or xarray.Dataset
        With the dimension `time`, such as `member_forces` gives: of the steps that it holds. Or
        the Dataset of a time history, with the name of a variable: of all steps of the run where
        the recording kept extremes (`Recording`), else of those that it holds.
    variable : str, optional
        Name of the variable of a Dataset.

    Returns
    -------
    xarray.Dataset
        `largest`, `time_of_largest`, `smallest` and `time_of_smallest` [units of the values, s]
        over the other dimensions; NaN where the history is. Its `to_dataframe()` is a table.

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
        Tables by name, such as `force_tables` gives; also what has a `to_dataframe()`, such as a
        fragility curve, a rate or an incremental analysis.
    path : str or Path
        A workbook where it ends in ".xlsx" (needs the package openpyxl: ``pip install
        'lir-dcfp[excel]'``), else a folder, which is made. What stood there under the same names
        is replaced.

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
        msg = f"tables: give them by name, such as {{'name': ...}}, not a {type(given).__name__}"
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
    # A table, or what has one.
    found = given.to_dataframe() if hasattr(given, "to_dataframe") else given
    if not isinstance(found, pd.DataFrame):
        msg = f"tables[{name!r}] must be a pandas.DataFrame, not a {type(given).__name__}"
        raise TypeError(msg)
    return found
