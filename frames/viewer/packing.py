"""Arrays as text: whole numbers of 8 or 16 bits with a scale, in base64."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

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
