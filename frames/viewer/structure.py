"""Data of the model on a page: nodes, lines, floors, bearings; packing of arrays."""

from __future__ import annotations

import base64
import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from frames.plots.drawn_device import device_of
from frames.plots.model_geometry import STATIONS, member_lines, shell_corners
from frames.plots.plot_choice import need
from frames.results.bearing_geometry import (
    movement,
    plane_height,
    rim_face,
    rim_height,
    surface_reach,
)
from frames.results.measures import uplift_gap

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from frames._types import FloatArray, IntArray
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData


def structure_of(model: FrameData, system: System) -> dict[str, object]:
    """Return the model at rest, and the displacements of its members by those of the nodes."""
    index = {name: k for k, name in enumerate(system.node_names)}
    table = system.members
    kinds, of_kind = _bending(system)
    ends = system.coordinates[table.nodes] + table.offsets
    joined = [[index[one.i], index[one.j]] for one in model.springs.values()]
    joined += [[index[one.i], index[one.j]] for one in model.links.values()]
    mass = system.node_mass[:, :3].max(axis=1)
    largest = float(mass.max()) if len(mass) else 0.0
    supports = [index[name] for name, held in model.fixed_dofs.items() if {"ux", "uy", "uz"} & held]
    return {
        "nodes": exact(system.coordinates, "float32"),
        "members": {
            "nodes": exact(table.nodes, "int32"),
            "ends": exact(ends, "float32"),
            "kind": exact(of_kind, "int32"),
            "bending": exact(kinds, "float32"),
        },
        "pairs": joined,
        "bearings": [[one.i, one.j] for one in system.bearings],
        "shells": shell_corners(model, system.node_names),
        "floors": [_around(system, [index[n] for n in level.nodes]) for level in model.levels],
        "supports": supports,
        "masses": exact(mass / largest if largest > 0.0 else mass, "float32"),
    }


def _bending(system: System) -> tuple[FloatArray, IntArray]:
    # Different lines of members for a unit of each of the twelve displacements, (k, stations, 3,
    # 12), and each member's line.
    table, count = system.members, len(system.members.names)
    alone = replace(
        table, nodes=np.arange(2 * count).reshape(count, 2), offsets=np.zeros((count, 2, 3))
    )
    places = np.zeros((2 * count, 3))
    found = np.zeros((count, STATIONS, 3, 12))
    for dof in range(12):
        u = np.zeros((count, 12))
        u[:, dof] = 1.0
        found[..., dof] = member_lines(alone, places, u.reshape(-1, 6))
    flat = np.round(found.reshape(count, STATIONS * 36), 9) + 0.0
    _, first, kinds = np.unique(flat, axis=0, return_index=True, return_inverse=True)
    return found[first], kinds.reshape(count)


def _around(system: System, nodes: list[int]) -> list[int]:
    # The nodes around a level, in order; none if they do not span an area.
    try:
        hull = ConvexHull(system.coordinates[nodes][:, :2])
    except (QhullError, ValueError):
        return []
    return [nodes[k] for k in hull.vertices]


Packed: TypeAlias = dict[str, object]
"""An array in the page: "type", "shape", "data", and "scale" if it is scaled."""

STEPS = 32767
"""Steps between zero and the largest value of a history."""


def scaled(values: npt.ArrayLike, *, along: int = 0) -> Packed:
    """Return histories in 16 bits."""
    array = np.asarray(values, dtype=np.float64)
    largest = np.abs(array).max(axis=along, keepdims=True)
    # in single precision, as the page reads it: the numbers use the same scale
    scale = (largest / STEPS).astype(np.float32).astype(np.float64)
    numbers = np.rint(array / np.where(scale > 0.0, scale, 1.0)).clip(-STEPS, STEPS)
    return {
        "type": "int16",
        "shape": list(array.shape),
        "along": along,
        "scale": exact(scale.squeeze(along), "float32"),
        "data": _text(numbers.astype("<i2")),
    }


def exact(values: npt.ArrayLike, kind: str) -> Packed:
    """Return numbers as they are."""
    array = np.asarray(values)
    return {
        "type": kind,
        "shape": list(array.shape),
        "data": _text(array.astype(np.dtype(kind).newbyteorder("<"))),
    }


def _text(array: npt.NDArray[np.generic]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


RIM_BOTTOM, RIM_TOP, SLIPS, LIFTED = 1, 2, 4, 8
"""Bits of the state of a bearing at a step."""

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
    # (..., 3) place of the top plate of a bearing that has lifted, relative to its place on the
    # slider [m]
    opening: FloatArray
    rim_force: FloatArray  # (..., 2) of the bottom and the top rim [N]
    # sum of `RIM_BOTTOM`, `RIM_TOP`, `SLIPS` and `LIFTED`
    contacts: npt.NDArray[np.uint8]


def movements(data: xr.Dataset) -> Movements:
    """Return the histories of all bearings of a result."""
    need(data, _NEEDED, "record all variables of bearings to view them (frames.Recording)")
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
    """Return the drawn geometry of all bearings, lengths in m, None for infinite ones."""
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
