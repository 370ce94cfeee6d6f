"""Local axes of members and the turning of vectors and matrices between local and global axes.

Local x runs from node i to node j; local z lies in the plane of x and the `up` vector, on the side
of `up`; y = z x x completes the right-handed set. By default `up` is global Z, for vertical
members global X. A horizontal member along global X thus has the global directions as local axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError

if TYPE_CHECKING:
    from frames._types import FloatArray

VERTICAL_SINE = 1e-3
"""A member is vertical when the sine of its angle to the global Z axis is below this [-]."""


def default_up(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the default `up` vector: global Z, and global X for vertical members.

    Shapes: start, end (n, 3), result (n, 3).
    """
    along = end - start
    sine = np.hypot(along[:, 0], along[:, 1]) / np.linalg.norm(along, axis=1)
    vertical = sine < VERTICAL_SINE
    return np.where(vertical[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def local_axes(start: FloatArray, end: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return local axes and lengths of members.

    Shapes: start, end (n, 3), up (n, 3), axes (n, 3, 3), length (n,).
    """
    along = end - start
    length = np.linalg.norm(along, axis=1)
    if (length <= 0.0).any():
        index = int(np.argmin(length))
        message = (
            f"member {index} has length 0 m, it must be greater than 0: "
            "its ends coincide, join them by a spring instead"
        )
        raise ModelError(message)
    x_axis = along / length[:, None]
    side = np.cross(up, x_axis)
    sine = np.linalg.norm(side, axis=1) / np.maximum(np.linalg.norm(up, axis=1), 1e-300)
    if (sine < 1e-6).any():
        index = int(np.argmin(sine))
        message = (
            f"up = {up[index].tolist()} of member {index} is zero or parallel to its axis "
            f"{x_axis[index].tolist()}: give a vector at an angle to the member"
        )
        raise ModelError(message)
    y_axis = side / np.linalg.norm(side, axis=1)[:, None]
    z_axis = np.cross(x_axis, y_axis)
    return np.stack([x_axis, y_axis, z_axis], axis=1), length


def to_local(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn end displacements or forces from global into local axes.

    Shapes: vectors (..., n, 12), axes (n, 3, 3), result (..., n, 12).
    """
    triads = vectors.reshape(*vectors.shape[:-1], 4, 3)
    turned: FloatArray = np.einsum("nab,...nkb->...nka", axes, triads)
    return turned.reshape(vectors.shape)


def to_global(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn end displacements or forces from local into global axes.

    Shapes: vectors (..., n, 12), axes (n, 3, 3), result (..., n, 12).
    """
    return to_local(vectors, axes.transpose(0, 2, 1))


def matrix_to_global(matrices: FloatArray, axes: FloatArray) -> FloatArray:
    """Turn member matrices from local into global axes.

    Shapes: matrices (n, 12, 12), axes (n, 3, 3), result (n, 12, 12).
    """
    count = axes.shape[0]
    blocks = matrices.reshape(count, 4, 3, 4, 3)
    turned: FloatArray = np.einsum("npa,nipjq,nqb->niajb", axes, blocks, axes, optimize=True)
    return turned.reshape(count, 12, 12)
