"""Type names shared by the structural model: arrays of numbers and sparse matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
"""Array of float64; the shape is given in each docstring."""

ComplexArray: TypeAlias = npt.NDArray[np.complex128]
"""Array of complex128; the shape is given in each docstring."""

IntArray: TypeAlias = npt.NDArray[np.int64]
"""Array of int64; the shape is given in each docstring."""

BoolArray: TypeAlias = npt.NDArray[np.bool_]
"""Array of bool; the shape is given in each docstring."""

if TYPE_CHECKING:
    from collections.abc import Sequence

    from scipy.sparse import csr_array

    SparseMatrix: TypeAlias = csr_array[np.float64]
    """Compressed sparse row matrix of float64."""

    MatrixLike: TypeAlias = SparseMatrix | FloatArray | Sequence[Sequence[float]]
    """A matrix as the caller has it."""
