"""Datasets in files: an old file is replaced only once the new one is complete.

All files that commands write go through `write_whole`, all tables through `csv_of`.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import uuid
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from frames.results.recorded import with_present_names

_FIRST_BYTES = 1 << 16  # of a file in memory: it grows


def save(data: xr.Dataset, path: str | Path, *, compress: bool = False) -> None:
    """Write a Dataset to netCDF.

    Parameters
    ----------
    data : xarray.Dataset
        Results of `time_history`, or any other.
    path : str or path
        The file. An existing one is replaced at the end, in one move: an interruption leaves either
        the old results or the new ones.
    compress : bool
        True to pack histories in single precision (6e-8 of each value; the energy stays double):
        usually a tenth of the size.

    Raises
    ------
    OSError
        If the file cannot be written (disk full, no such folder, no permission). The message names
        it; nothing is left behind, and you can save `data` elsewhere.
    TypeError
        If it is no Dataset.

    Examples
    --------
    >>> import tempfile
    >>> from frames import load, save, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(data, f"{folder}/run.nc", compress=True)
    ...     print(load(f"{folder}/run.nc").attrs["status"])
    ok
    """
    given: object = data
    if not isinstance(given, xr.Dataset):
        msg = (
            f"data must be an xarray.Dataset, not a {type(given).__name__}: runs, curves and rates "
            "of fragility are written by save_fragility, tables by write_tables"
        )
        raise TypeError(msg)
    write_whole(path, _content({"": data}, compress=compress))


def save_groups(results: Mapping[str, xr.Dataset], path: str | Path) -> None:
    """Write Datasets to one netCDF file, a group each, histories in compressed single precision."""
    write_whole(path, _content(results, compress=True))


def _content(groups: Mapping[str, xr.Dataset], *, compress: bool) -> memoryview:
    # A netCDF file of one Dataset ("") or a group each. HDF5 does not survive a write that fails
    # (the process dies at its end): it works in memory.
    import netCDF4  # with HDF5 in its train
    from xarray.backends import NetCDF4DataStore

    whole = netCDF4.Dataset("results", "w", memory=_FIRST_BYTES)
    try:
        for name, data in groups.items():
            place = whole.createGroup(name) if name else whole
            store = NetCDF4DataStore(place)  # type: ignore[no-untyped-call]  # has no types
            data.dump_to_store(store, encoding=_packed(data) if compress else {})
    except BaseException:
        whole.close()
        raise
    content: memoryview = whole.close()
    return content


def _packed(data: xr.Dataset) -> dict[Hashable, dict[str, object]]:
    # Storage of histories: compressed, in single precision but for the energy balance.
    small: dict[str, object] = {"zlib": True, "complevel": 2, "shuffle": True}
    return {
        key: small if key == "energy" else {"dtype": "float32", **small}
        for key, variable in data.data_vars.items()
        if "time" in variable.dims
    }


def as_packed(data: xr.Dataset) -> xr.Dataset:
    """Return a result as `save` with `compress` keeps it."""
    names = [key for key, kept in _packed(data).items() if "dtype" in kept]
    return data.assign({key: data[key].astype(np.float32) for key in names})


def write_whole(path: str | Path, content: bytes | memoryview | str) -> None:
    """Write a file beside its place, then move it there."""
    whole = content.encode() if isinstance(content, str) else content
    target = place_of(path)
    beside = target.with_name(f".{target.name[:60]}.{uuid.uuid4().hex}.part")
    try:
        with beside.open("xb") as file:
            file.write(whole)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, beside)
        beside.replace(target)
    except BaseException as cause:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        if not isinstance(cause, OSError):
            raise
        msg = (
            f"{path} could not be written ({len(whole) / 1e6:.3g} MB): "
            f"{cause.strerror}. The file that was there is unchanged: save to another "
            "place, or free some space"
        )
        raise OSError(cause.errno, msg) from cause


def place_of(path: str | Path) -> Path:
    """Return the real path of a file or a folder, links resolved."""
    given = Path(path)
    folder, target = Path(os.path.realpath(given.parent)), Path(os.path.realpath(given))
    if given.name not in {"", ".."} and not target.is_relative_to(folder):
        raise OSError(errno.ELOOP, _leads_out(given))
    return target


def refuse_links(folder: str | Path) -> None:
    """Refuse a folder that is a link, or holds one, that leads out of it."""
    whole = place_of(folder)
    for where, folders, names in os.walk(whole):
        for name in (*folders, *names):
            found = Path(where) / name
            if found.is_symlink() and not Path(os.path.realpath(found)).is_relative_to(whole):
                raise OSError(errno.ELOOP, _leads_out(found))


def _leads_out(link: Path) -> str:
    return (
        f"{link} is a link out of its folder, to {os.path.realpath(link)}: remove the "
        "link, or name its target"
    )


def make_folder(path: str | Path) -> Path:
    """Make a folder for results if it is not there, and return it."""
    folder = Path(path)
    refuse_links(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as cause:
        msg = (
            f"{folder} is not a folder and cannot be created ({cause.strerror}): name another place"
        )
        taken = cause.errno == errno.EEXIST  # by a file
        raise OSError(errno.ENOTDIR if taken else cause.errno, msg) from cause
    return folder


def csv_of(table: pd.DataFrame, *, index: bool = True) -> str:
    """Return a table as CSV in which no text is a formula."""
    text: str = without_formulas(table).to_csv(index=index, lineterminator="\n")
    return text


def without_formulas(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table for a spreadsheet: texts that it would run as formulas have an apostrophe."""
    found = table.copy()
    for k, kind in enumerate(table.dtypes):
        if not pd.api.types.is_numeric_dtype(kind):
            found.isetitem(k, table.iloc[:, k].map(as_text))
    for name in ("index", "columns"):
        labels: pd.Index[Any] = getattr(table, name)
        if isinstance(labels, pd.MultiIndex):
            setattr(found, name, labels.map(lambda each: tuple(map(as_text, each))))
        elif not pd.api.types.is_numeric_dtype(labels.dtype):
            setattr(found, name, labels.map(as_text))
        getattr(found, name).names = [as_text(each) for each in labels.names]
    return found


_FORMULA = re.compile(r"\s*[=+\-@\t\r]\s*\S")
_PLAIN = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*|[+-]?(inf|nan)|[+-][xyz]")


def as_text(cell: Any) -> Any:
    """Return a cell of a table; a text that a spreadsheet would run has an apostrophe before it."""
    runs = isinstance(cell, str) and _FORMULA.match(cell) and not _PLAIN.fullmatch(cell)
    return f"'{cell}" if runs else cell


def from_text(cell: Any) -> Any:
    """Return a cell as it was before `as_text`."""
    bare = cell[1:] if isinstance(cell, str) else cell
    return bare if bare != cell and as_text(bare) == cell else cell


def load(path: str | Path, *, lazy: bool = False) -> xr.Dataset:
    """Read a Dataset written by `save`.

    Parameters
    ----------
    path : str or path
        The file.
    lazy : bool
        True to read variables from the file only on use, for large files; close the Dataset in the
        end (or use it in a `with`).

    Returns
    -------
    xarray.Dataset
        The saved Dataset, in memory unless it is lazy.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    OSError
        If it holds no results.

    Examples
    --------
    >>> import tempfile
    >>> from frames import load, save, time_history
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> data = time_history(frame, pulse)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(data, f"{folder}/run.nc")
    ...     print(load(f"{folder}/run.nc").equals(data))
    True
    """
    if not Path(path).is_file():
        msg = f"{path} is not a file: use one that save or `lir run` wrote"
        raise FileNotFoundError(msg)
    try:
        data = xr.open_dataset(path, engine="netcdf4")
    except (OSError, ValueError, RuntimeError) as cause:
        msg = f"{path} has no results (netCDF): use a file that save or `lir run` wrote"
        raise OSError(msg) from cause
    if lazy:
        return with_present_names(data)
    with data:
        return with_present_names(data.load())
