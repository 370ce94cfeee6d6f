"""What a page shows of the model: nodes, lines, floors, bearings; how arrays are packed."""

from __future__ import annotations

import base64
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from frames.plots.model_geometry import STATIONS, member_lines, shell_corners

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray, IntArray
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData


def structure_of(model: FrameData, system: System) -> dict[str, object]:
    """Return the model as it stands, and how its members follow the nodes."""
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
    # Unlike members' lines for a unit of each of the twelve displacements, (k, stations, 3, 12),
    # and which of these each member has.
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
    # The nodes around a level, in order; none where they do not span an area.
    try:
        hull = ConvexHull(system.coordinates[nodes][:, :2])
    except (QhullError, ValueError):
        return []
    return [nodes[k] for k in hull.vertices]


Packed: TypeAlias = dict[str, object]
"""An array as it stands in the page: "type", "shape", "data", and "scale" where it is scaled."""

STEPS = 32767
"""Steps between zero and the largest value of a history."""


def scaled(values: npt.ArrayLike, *, along: int = 0) -> Packed:
    """Return histories in 16 bits."""
    array = np.asarray(values, dtype=np.float64)
    largest = np.abs(array).max(axis=along, keepdims=True)
    # in single precision, as it is read: the numbers are found with the same scale
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
