"""How the bodies of a bearing move: recorded where the level records it, else from the kinematics.

Levels that give the sliders a mass record `body_position` and `body_rotation`. At the level
'pendulum' the sliding on the bottom plate and the slip fix the bodies (docs/theory.md, section 1):
with a bottom plate that stays level, ``n = e3 - d1 / R1``, and both sliders turn from e3 to n.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from frames.results.bearing_geometry import plane_height, slider_axis

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element import LIRBearing

BODIES = ("bottom_slider", "top_slider", "top_plate")
AXES = ("x", "y", "z")


def body_motion(data: xr.Dataset, bearing: LIRBearing, name: str) -> xr.Dataset:
    """Return displacements and rotations of the three bodies that move."""
    if "body_position" in data:
        chosen = data.sel(bearing=name)
        position = chosen["body_position"].sel(body=list(BODIES)).to_numpy()
        rotation = chosen["body_rotation"].sel(body=list(BODIES)).to_numpy()
    else:
        position, rotation = _from_kinematics(data, bearing, name)
    dims = ("time", "body", "axis")
    return xr.Dataset(
        {"position": (dims, position), "rotation": (dims, rotation)},
        {"time": data["time"].to_numpy(), "body": list(BODIES), "axis": list(AXES)},
    )


def rise(bearing: LIRBearing, displacement: FloatArray, slip: FloatArray) -> FloatArray:
    """Return the rise of the top plate over its place at the centre, the bearing undeformed [m].

    The sphere centres lie ``sqrt(L^2 + s^2)`` apart, for the line between them has the part L along
    the slider's axis and the slip s across it.
    """
    length = bearing.effective_radius
    return np.asarray(length - np.sqrt(length**2 + slip**2 - displacement**2))


def _from_kinematics(
    data: xr.Dataset, bearing: LIRBearing, name: str
) -> tuple[FloatArray, FloatArray]:
    up = np.array([0.0, 0.0, 1.0])
    axis = slider_axis(data, bearing, name)
    chosen = data.sel(bearing=name)
    slip = chosen["interface_slip"].transpose("time", "axis").to_numpy()
    lower = plane_height(bearing)
    heights = (0.5 * lower, 0.5 * (lower + bearing.slider_height))  # over the bottom contact
    bottom, top = ((h - bearing.radii[0]) * (axis - up) for h in heights)
    plate = chosen["bearing_displacement"].transpose("time", "axis").to_numpy()
    across = np.cross(up, axis)
    size = np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.arctan2(size[:, 0], axis[:, 2])[:, None]
    turn = across * np.divide(angle, size, out=np.ones_like(size), where=size > 0.0)
    return (
        np.stack([bottom, top + slip, plate], axis=1),
        np.stack([turn, turn, np.zeros_like(turn)], axis=1),
    )
