"""Datasets in files: what stood there before is replaced only once the new file is complete."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import uuid
from collections.abc import Mapping
from pathlib import Path

import h5netcdf
import xarray as xr
from xarray.backends import H5NetCDFStore


def save(data: xr.Dataset, path: str | Path) -> None:
    """Write a Dataset to netCDF (h5netcdf engine).

    Parameters
    ----------
    data : xarray.Dataset
        Results of `time_history`, or any other.
    path : str or path
        The file. An existing one is replaced at the end, in one move: whatever happens in between
        leaves either the old results or the new ones.

    Raises
    ------
    OSError
        If the file cannot be written (disk full, no such folder, no permission). The message names
        it; nothing is left behind, and `data` can be saved elsewhere.
    """
    # HDF5 does not survive a write that fails (the process dies at its end): it works in memory
    write_whole(path, data.to_netcdf(None, engine="h5netcdf"))


def save_groups(results: Mapping[str, xr.Dataset], path: str | Path) -> None:
    """Write Datasets to one netCDF file, a group each; histories compressed, in single precision.

    Parameters
    ----------
    results : mapping of str to xarray.Dataset
        Results by name of group.
    path : str or path
        The file. An existing one is replaced once all groups are complete.

    Raises
    ------
    OSError
        If the file cannot be written; the message names it.
    """
    whole = io.BytesIO()
    with h5netcdf.File(whole, "w") as file:
        for name, data in results.items():
            packed = {
                key: {"dtype": "float32", "zlib": True, "complevel": 2, "shuffle": True}
                for key, variable in data.data_vars.items()
                if "time" in variable.dims
            }
            store = H5NetCDFStore(file.create_group(name), mode="a")
            data.dump_to_store(store, encoding=packed)
    write_whole(path, whole.getbuffer())


def write_whole(path: str | Path, content: bytes | memoryview) -> None:
    """Write a file beside its place, then move it there.

    Parameters
    ----------
    path : str or path
        The file; where it is a link, the file that it points to.
    content : bytes
        All of it.

    Raises
    ------
    OSError
        If it cannot be written; the message names the file and what to do.
    """
    target = Path(os.path.realpath(path))
    beside = target.with_name(f".{target.name}.{uuid.uuid4().hex}.part")
    try:
        with beside.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, beside)
        beside.replace(target)
    except OSError as cause:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        msg = (
            f"{path} could not be written ({len(content) / 1e6:.3g} MB): {cause.strerror}. What "
            "stood there before is untouched: save to another place, or make room"
        )
        raise OSError(cause.errno, msg) from cause


def load(path: str | Path) -> xr.Dataset:
    """Read a Dataset that `save` wrote, into memory."""
    with xr.open_dataset(path, engine="h5netcdf") as data:
        return data.load()
