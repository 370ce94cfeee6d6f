"""Solves with positive definite matrices, and doubts those that round-off spoils."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from frames._errors import ModelWarning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray


def solve_positive(
    matrix: FloatArray, right: FloatArray, what: str, labels: Sequence[str]
) -> FloatArray:
    """Solve for right-hand sides, in scaled unknowns where round-off would show otherwise.

    Shapes: matrix (n, n), right (n, m), labels (n,), result (n, m).
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", linalg.LinAlgWarning)
        try:
            return np.asarray(linalg.solve(matrix, right, assume_a="pos"))
        except linalg.LinAlgWarning:
            scale = 1.0 / np.sqrt(np.diag(matrix))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scaled = matrix * np.outer(scale, scale)
        found = linalg.solve(scaled, scale[:, None] * right, assume_a="pos")
    if told:
        weak = np.abs(linalg.eigh(scaled, subset_by_index=[0, 0])[1][:, 0])
        warnings.warn(
            f'the {what} near "{labels[int(weak.argmax())]}" is lost in the round-off of its '
            "neighbours, which are 1e16 times as large: give what is meant to be rigid 1,000 times "
            "theirs, or join it by a diaphragm or offsets",
            ModelWarning,
            stacklevel=2,
        )
    return np.asarray(scale[:, None] * found)
