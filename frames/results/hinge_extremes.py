"""What links and hinges did at each instant: histories that the peaks of yielding are of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.results.recorded import require_recorded

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray, FloatArray


def of_links(data: xr.Dataset, name: str) -> FloatArray:
    """Return a variable of links, (time, link)."""
    require_recorded(data, "what links did", name)
    return np.asarray(data.variables[name].transpose("time", "link").to_numpy())


def of_hinges(data: xr.Dataset, name: str) -> FloatArray:
    """Return a variable of hinges, (time, hinge)."""
    require_recorded(data, "what hinges did", name)
    return np.asarray(data.variables[name].transpose("time", "hinge").to_numpy())


def link_ductility(data: xr.Dataset) -> FloatArray:
    """Return the deformations of links over those at yield.

    Shapes: result (n_steps, n_links).
    """
    d, force = of_links(data, "link_deformation"), of_links(data, "link_force")
    ratio = np.abs(d) / np.where(can_yield(data), data.variables["link_yield_deformation"], np.inf)
    return np.where(d * force > 0.0, ratio, 0.0)


def can_yield(data: xr.Dataset) -> BoolArray:
    """Return which links have a deformation at which they yield (link,)."""
    return np.asarray(np.isfinite(data.variables["link_yield_deformation"].to_numpy()))


def hinge_rotation(data: xr.Dataset) -> FloatArray:
    """Return the sizes of the hinges' plastic rotations about both axes (time, hinge) [rad]."""
    require_recorded(data, "the rotation of hinges", "hinge_rotation")
    both = data["hinge_rotation"].sel(hinge_force_component=["My", "Mz"])
    values = both.transpose("time", "hinge", "hinge_force_component").to_numpy()
    return np.asarray(np.linalg.norm(values, axis=-1))
