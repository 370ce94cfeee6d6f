"""Kernels that eliminate the sliders: Newton's direction, and what the nodes see of them.

The matrix stands in the first twelve columns of ``w.joint`` (12, 24), right-hand sides in the
others. Rows are eliminated over their whole width, which processors do in wide registers.
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
def solve_all(w: Scratch) -> bool:
    """Bring the solutions for the columns 12 to 23 to their place; False where it is singular."""
    a = w.joint
    if not eliminate(a, 24):
        return False
    for row in range(11, -1, -1):
        for col in range(row + 1, 12):
            factor = a[row, col]
            for k in range(12, 24):
                a[row, k] -= factor * a[col, k]
        inv = 1.0 / a[row, row]
        for k in range(12, 24):
            a[row, k] *= inv
    return True
