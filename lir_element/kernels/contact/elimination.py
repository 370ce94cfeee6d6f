"""Kernels that eliminate the sliders: Newton's direction, and what the nodes see of them.

The matrix stands in the first twelve columns of ``w.joint`` (12, 24), right-hand sides in the
others. Rows are eliminated over their whole width, which processors do in wide registers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch


@inlined
def exchange(a: Floats, col: int) -> float:
    """Bring the row with the largest entry of a column to its place; return that entry."""
    pivot, largest = col, abs(a[col, col])
    for row in range(col + 1, 12):
        if abs(a[row, col]) > largest:
            pivot, largest = row, abs(a[row, col])
    if pivot != col:
        for k in range(24):
            a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
    return a[col, col]


@kernel
def solve_one(w: Scratch, x: Floats) -> bool:
    """Set ``x`` (12,) to the solution for column 12; False where the matrix is singular."""
    a = w.joint
    for col in range(12):
        pivot = exchange(a, col)
        if pivot == 0.0:
            return False
        inv = 1.0 / pivot
        for row in range(col + 1, 12):
            factor = a[row, col] * inv
            for k in range(16):
                a[row, k] -= factor * a[col, k]
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
    for col in range(12):
        pivot = exchange(a, col)
        if pivot == 0.0:
            return False
        inv = 1.0 / pivot
        for row in range(col + 1, 12):
            factor = a[row, col] * inv
            for k in range(24):
                a[row, k] -= factor * a[col, k]
    for row in range(11, -1, -1):
        for col in range(row + 1, 12):
            factor = a[row, col]
            for k in range(12, 24):
                a[row, k] -= factor * a[col, k]
        inv = 1.0 / a[row, row]
        for k in range(12, 24):
            a[row, k] *= inv
    return True
