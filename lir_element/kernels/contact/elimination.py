"""Kernels that solve for the sliders: Newton's direction, the inverse of its matrix.

The matrix stands in the first twelve columns of ``w.joint`` (12, 24), the right-hand side in the
next one. Rows are eliminated over a whole width, which processors do in wide registers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined, kernel
from lir_element.kernels.linear import pivot_of

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch


@inlined
def eliminate(a: Floats, width: int) -> bool:
    """Bring the first twelve columns to upper triangular form, over `width` columns."""
    for col in range(12):
        pivot = pivot_of(a, col, 12)
        if pivot < 0:
            return False
        if pivot != col:
            for k in range(24):
                a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
        inv = 1.0 / a[col, col]
        for row in range(col + 1, 12):
            factor = a[row, col] * inv
            for k in range(width):
                a[row, k] -= factor * a[col, k]
    return True


@kernel
def solve_one(w: Scratch, x: Floats) -> bool:
    """Set ``x`` (12,) to the solution for column 12; False where the matrix is singular."""
    a = w.joint
    if not eliminate(a, 16):
        return False
    for row in range(11, -1, -1):
        total = a[row, 12]
        for col in range(row + 1, 12):
            total -= a[row, col] * x[col]
        x[row] = total / a[row, row]
    return True


@kernel
def invert(w: Scratch) -> bool:
    """Set the second twelve columns of ``w.joint`` to its inverse, column by column in rows.

    By Gauss and Jordan in place, with pivoted rows; False where the matrix is singular.
    """
    a, order = w.joint, w.order
    for col in range(12):
        pivot = pivot_of(a, col, 12)
        if pivot < 0:
            return False
        order[col] = pivot
        if pivot != col:
            for k in range(12):
                a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
        inv = 1.0 / a[col, col]
        a[col, col] = 1.0
        for k in range(12):
            a[col, k] *= inv
        for row in range(12):
            if row != col:
                factor = a[row, col]
                a[row, col] = 0.0
                for k in range(12):
                    a[row, k] -= factor * a[col, k]
    for row in range(12):
        for col in range(12):
            a[col, 12 + row] = a[row, col]
    for col in range(11, -1, -1):
        if order[col] != col:
            for k in range(12, 24):
                a[col, k], a[order[col], k] = a[order[col], k], a[col, k]
    return True
