"""Datasets in files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import xarray as xr

if TYPE_CHECKING:
    from pathlib import Path


def save(data: xr.Dataset, path: str | Path) -> None:
    """Write a Dataset to netCDF (h5netcdf engine)."""
    data.to_netcdf(path, engine="h5netcdf")


def load(path: str | Path) -> xr.Dataset:
    """Read a Dataset that `save` wrote, into memory."""
    with xr.open_dataset(path, engine="h5netcdf") as data:
        return data.load()
