"""What a page shows of bearings: geometry, movement of the bodies, forces, contacts, peaks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.plots.bearing_geometry import (
    movement,
    plane_height,
    rim_face,
    rim_height,
    surface_reach,
)
from frames.plots.drawn_device import device_of
from frames.plots.plot_choice import need
from frames.results.measures import uplift_gap

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from frames._types import FloatArray

RIM_BOTTOM, RIM_TOP, SLIPS, LIFTED = 1, 2, 4, 8
"""Bits of what goes on in a bearing at a step."""

SLIP_SPEED = 5e-3
"""Speed from which on an interface is shown as sliding [m/s]: below, friction is elastic."""

_NEEDED = (
    "bearing_displacement",
    "bearing_force",
    "axial_force",
    "slider_displacement",
    "interface_slip",
    "interface_slip_size",
    "rim_force",
    "lever",
)


class Movements(NamedTuple):
    """Histories of all bearings, each (n_steps, n_bearings, ...)."""

    displacement: FloatArray  # (..., 3) of node j against node i [m]
    force: FloatArray  # (..., 2) horizontal force on node j [N]
    axial_force: FloatArray  # compression positive [N]
    # (..., 2) horizontal parts of the unit vectors of the slider and of the top plate
    slider_axis: FloatArray
    plate_axis: FloatArray  # (..., 2)
    slip: FloatArray  # (..., 3) interface slip [m]
    gap: FloatArray  # gap of uplift [m]
    # (..., 3) where the top plate of a bearing that has lifted is, against its place on the
    # slider [m]
    opening: FloatArray
    rim_force: FloatArray  # (..., 2) of the bottom and the top rim [N]
    # sum of `RIM_BOTTOM`, `RIM_TOP`, `SLIPS` and `LIFTED` where that is so
    contacts: npt.NDArray[np.uint8]


def movements(data: xr.Dataset) -> Movements:
    """Return the histories of all bearings of a result."""
    need(data, _NEEDED, "record all variables of bearings (frames.Recording), to view them")
    names = [str(name) for name in data["bearing"].to_numpy()]
    bodies = [movement(data, device_of(data, name), name) for name in names]
    slip = np.stack([one.slip for one in bodies], axis=1)
    axial = _of(data, "axial_force")
    rims = _of(data, "rim_force", "surface")
    axis = np.stack([one.axis for one in bodies], axis=1)
    speed = _slip_speed(data["time"].to_numpy(), slip, axis)
    contacts = (
        RIM_BOTTOM * (rims[..., 0] > 0.0)
        + RIM_TOP * (rims[..., 1] > 0.0)
        + SLIPS * (speed > SLIP_SPEED)
        + LIFTED * ~(axial > 0.0)
    )
    return Movements(
        displacement=_of(data, "bearing_displacement", "axis"),
        force=_of(data, "bearing_force", "axis")[..., :2],
        axial_force=axial,
        slider_axis=axis[..., :2],
        plate_axis=np.stack([one.plate_axis[:, :2] for one in bodies], axis=1),
        slip=slip,
        gap=uplift_gap(data).transpose("time", "bearing").to_numpy(),
        opening=np.stack([one.opening for one in bodies], axis=1),
        rim_force=rims,
        contacts=contacts.astype(np.uint8),
    )


def devices(data: xr.Dataset) -> list[dict[str, object]]:
    """Return the geometry of all bearings as drawn, lengths in m, None for what is infinite."""
    found = []
    for name in data["bearing"].to_numpy():
        device = device_of(data, str(name))
        found.append(
            {
                "name": str(name),
                "radii": device.radii,
                "sliderHeight": device.slider_height,
                "sliderRadius": device.slider_radius,
                "rimFaces": [_finite(rim_face(device, k)) for k in (0, 1)],
                "rimHeight": rim_height(device),
                "planeHeight": plane_height(device),
                "capacity": _finite(device.lateral_capacity),
                "slipCapacity": _finite(float(data["slip_capacity"].sel(bearing=name))),
                "reach": surface_reach(data.sel(bearing=[name]), device),
                "rigid": device.is_dcfp,
            }
        )
    return found


def peaks_of(time: FloatArray, moved: Movements) -> dict[str, list[list[float]]]:
    """Return the extremes of each bearing over all recorded steps, with their times.

    Shapes: time (n_steps,).
    """
    sizes = {
        "displacement": np.linalg.norm(moved.displacement[..., :2], axis=-1),
        "force": np.linalg.norm(moved.force, axis=-1),
        "slip": np.linalg.norm(moved.slip, axis=-1),
        "rimBottom": moved.rim_force[..., 0],
        "rimTop": moved.rim_force[..., 1],
        "gap": moved.gap,
        "axial": moved.axial_force,
    }
    steps = {name: values.argmax(axis=0) for name, values in sizes.items()}
    sizes["axialLeast"] = moved.axial_force
    steps["axialLeast"] = moved.axial_force.argmin(axis=0)
    return {
        name: [[float(values[step, k]), float(time[step])] for k, step in enumerate(steps[name])]
        for name, values in sizes.items()
    }


def _slip_speed(time: FloatArray, slip: FloatArray, axis: FloatArray) -> FloatArray:
    # In the interface, whose plane turns with the sliders: a slip that stays is no speed.
    rate = np.gradient(slip, time, axis=0)
    along = np.einsum("tba,tba->tb", rate, axis) / np.einsum("tba,tba->tb", axis, axis)
    return np.asarray(np.linalg.norm(rate - along[..., None] * axis, axis=-1))


def _of(data: xr.Dataset, name: str, *rest: str) -> FloatArray:
    values = data[name].transpose("time", "bearing", *rest).to_numpy()
    return np.asarray(values, dtype=np.float64)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
