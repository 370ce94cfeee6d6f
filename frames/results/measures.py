"""What engineers read off a Dataset: drifts, floor accelerations, the ledger of energy."""

from __future__ import annotations

import numpy as np
import xarray as xr

from frames.kernel_data import ENERGY_TERMS

ABSORBED = ENERGY_TERMS[1:]
"""Terms of the energy that take up the input."""


def energy_error(data: xr.Dataset) -> float:
    """Measure how far the ledger of energy is from closing.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history.

    Returns
    -------
    float
        Largest gap ``|input - (sum of all other terms)|`` over the largest input [-]; in joule
        where there was no input.
    """
    energy = data["energy"]
    gap = np.abs(energy.sel(term="input") - energy.sel(term=list(ABSORBED)).sum("term"))
    scale = float(np.abs(energy.sel(term="input")).max())
    return float(gap.max()) / scale if scale > 0.0 else float(gap.max())


def storey_drift(data: xr.Dataset) -> xr.DataArray:
    """Take the drifts of the storeys from a time history.

    Parameters
    ----------
    data : xarray.Dataset
        Of a time history of a model with levels.

    Returns
    -------
    xarray.DataArray
        Drift ratio (time, storey, axis x and y) [-]: the mean displacement of a level's nodes
        against that of the level below, over the storey height.

    Raises
    ------
    ValueError
        If the model has fewer than two levels.
    """
    place = data["level_node"].to_numpy()
    count = data.sizes["level"]
    if count < 2:
        msg = f"the model has {count} levels: drifts need at least two (Frame.add_level)"
        raise ValueError(msg)
    moves = data["node_displacement"].sel(dof=["ux", "uy"]).to_numpy()
    means = np.stack([moves[:, place == k].mean(axis=1) for k in range(count)], axis=1)
    heights = np.diff(data["level_height"].to_numpy())
    drift = np.diff(means, axis=1) / heights[None, :, None]
    names = [str(name) for name in data["level"].to_numpy()[1:]]
    return xr.DataArray(
        drift,
        dims=("time", "storey", "axis"),
        coords={"time": data["time"], "storey": names, "axis": ["x", "y"]},
        attrs={"units": "1", "long_name": "storey drift ratio"},
    )


def floor_acceleration(data: xr.Dataset) -> xr.DataArray:
    """Return the mean total acceleration of each level's nodes (time, level, axis) [m/s2]."""
    place = data["level_node"].to_numpy()
    moves = data["node_acceleration"].sel(dof=["ux", "uy", "uz"]).to_numpy()
    count = data.sizes["level"]
    means = np.stack([moves[:, place == k].mean(axis=1) for k in range(count)], axis=1)
    return xr.DataArray(
        means,
        dims=("time", "level", "axis"),
        coords={"time": data["time"], "level": data["level"], "axis": ["x", "y", "z"]},
        attrs={"units": "m/s2", "long_name": "total acceleration of the level"},
    )
