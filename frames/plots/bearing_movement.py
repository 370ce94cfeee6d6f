"""How the bodies of a bearing move through a time history, in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.plots.drawn_device import Geometry


class Movement(NamedTuple):
    """A bearing's bodies over time, in space.

    Attributes
    ----------
    axis, plate_axis : ndarray, shape (n_steps, 3)
        Unit vectors of the slider n and of the top plate e_j, upwards.
    slip : ndarray, shape (n_steps, 3)
        Interface slip of the top slider on the bottom one [m].
    opening : ndarray, shape (n_steps, 3)
        Where the top plate of a bearing that has lifted is, against its place on the slider [m];
        0 where the contact is closed.
    """

    axis: FloatArray
    plate_axis: FloatArray
    slip: FloatArray
    opening: FloatArray

    @property
    def lift(self) -> FloatArray:
        """Gap between the top slider and the top plate, along `axis`, shape (n_steps,) [m]."""
        along = np.einsum("ta,ta->t", self.opening, self.axis)
        return np.asarray(np.maximum(along, 0.0))


def slider_axis(data: xr.Dataset, bearing: Geometry, name: str) -> FloatArray:
    """Return the slider's axis of a bearing over time, from its sliding on the bottom plate.

    With ``d1 = -R1 (n - e_i)`` and a bottom plate that stays level, ``n = (0, 0, 1) - d1 / R1``.

    Shapes: result (n_steps, 3).
    """
    sliding = data["slider_displacement"].sel(bearing=name, surface="bottom").to_numpy()
    return np.array([0.0, 0.0, 1.0]) - sliding / bearing.radii[0]


def movement(data: xr.Dataset, bearing: Geometry, name: str) -> Movement:
    """Return how the bodies of a bearing move.

    In contact the centres of the spheres are ``c = C2 - C1 = -L n + s`` apart (docs/theory.md,
    section 1). What a bearing that carries nothing has opened is the difference of c, by the
    nodes' displacements and rotations, from that: what is recorded as sliding on its top surface
    is not between surfaces that touch. Where rotations of its nodes were not recorded its plates
    count as parallel.
    """
    own = data.sel(bearing=name)
    axis = slider_axis(data, bearing, name)
    top = own["slider_displacement"].sel(surface="top").transpose("time", "axis").to_numpy()
    plate = axis + top / bearing.radii[1]  # d2 = -R2 (n - e_j)
    slip = own["interface_slip"].transpose("time", "axis").to_numpy()
    opening = np.zeros_like(axis)
    lifted = ~(own["axial_force"].to_numpy() > 0.0)
    if lifted.any():
        length = sum(bearing.radii) - bearing.slider_height
        up, (lower, upper) = np.array([0.0, 0.0, 1.0]), _plate_tilts(data, name)
        u = own["bearing_displacement"].transpose("time", "axis").to_numpy()
        levers = own["lever"].sel(surface=["bottom", "top"]).to_numpy()
        centres = u - length * up - levers[0] * lower - levers[1] * upper
        closed = slip - length * (axis + lower)
        opening[lifted] = (centres - closed)[lifted]
        plate[lifted] = (up + upper - lower)[lifted]
    return Movement(axis, plate, slip, opening)


def _plate_tilts(data: xr.Dataset, name: str) -> tuple[FloatArray, FloatArray]:
    # Changes of the axes of the bottom and the top plate by the rotations of their nodes, (n, 3).
    nodes = data["bearing_node"].sel(bearing=name).to_numpy() if "bearing_node" in data else (-1,)
    tilts = np.zeros((2, data.sizes["time"], 3))
    if "node_displacement" in data and min(nodes) >= 0:
        turns = data["node_displacement"].isel(node=nodes).sel(dof=["ry", "rx"])
        tilts[..., :2] = turns.transpose("node", "time", "dof").to_numpy() * (1.0, -1.0)
    return tilts[0], tilts[1]
