"""The lines of a frame in space, bent as its members bend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.model.axes import to_local

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.system import MemberTable

STATIONS = 9
"""Points of a member's line."""


def member_lines(table: MemberTable, coordinates: FloatArray, u: FloatArray) -> FloatArray:
    """Return the lines of members under nodal displacements.

    Between its ends a member bends by the cubic of their displacements and rotations, which is
    exact for end forces without shear deformation.

    Shapes: coordinates (n_nodes, 3), u (n_nodes, 6), result (n_members, STATIONS, 3).
    """
    axes, length = table.arrays.axes, table.arrays.length[:, None]
    local = np.einsum("mab,mb->ma", table.follow, to_local(u.reshape(-1)[table.dofs], axes))
    t = np.linspace(0.0, 1.0, STATIONS)[None, :]
    one, two = 1.0 - 3.0 * t**2 + 2.0 * t**3, 3.0 * t**2 - 2.0 * t**3
    near, far = length * (t - 2.0 * t**2 + t**3), length * (t**3 - t**2)

    def bent(at: int, slope: int, sign: float) -> FloatArray:
        i, j = local[:, at, None], local[:, 6 + at, None]
        turn_i, turn_j = local[:, slope, None], local[:, 6 + slope, None]
        return np.asarray(one * i + two * j + sign * (near * turn_i + far * turn_j))

    moved = np.stack(
        [(1.0 - t) * local[:, 0, None] + t * local[:, 6, None], bent(1, 5, 1.0), bent(2, 4, -1.0)],
        axis=-1,
    )
    ends = coordinates[table.nodes] + table.offsets
    start, end = (ends[:, k, None] for k in range(2))
    straight = start + t[..., None] * (end - start)
    return np.asarray(straight + np.einsum("msl,mlg->msg", moved, axes))
