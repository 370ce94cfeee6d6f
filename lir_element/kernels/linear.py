"""Kernels of small linear maps: sparse rows, and dense systems."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._jit import inlined, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Words


@inlined
def gather(start: Words, columns: Words, values: Floats, source: Floats, target: Floats) -> None:
    """Set the 12 displacements `target` of a bearing's nodes from those of a model, `source`.

    Row r of the map has the entries ``start[r]`` to ``start[r + 1]``.
    """
    for row in range(12):
        total = 0.0
        for entry in range(start[row], start[row + 1]):
            total += values[entry] * source[columns[entry]]
        target[row] = total


@inlined
def scatter(
    start: Words, columns: Words, values: Floats, factor: float, force: Floats, target: Floats
) -> None:
    """Add `factor` times the 12 forces on a bearing's nodes to those of a model, `target`."""
    for row in range(12):
        value = factor * force[row]
        for entry in range(start[row], start[row + 1]):
            target[columns[entry]] += values[entry] * value


@kernel
def solve_many(a: Floats, x: Floats, n: int, m: int) -> bool:
    """Solve ``a x = rhs`` for the first `n` rows and `m` right-hand sides held by `x` (n, m).

    Gaussian elimination with pivoted rows; both arrays are overwritten. Returns False if singular.
    """
    for col in range(n):
        pivot = col
        largest = abs(a[col, col])
        for row in range(col + 1, n):
            if abs(a[row, col]) > largest:
                pivot, largest = row, abs(a[row, col])
        if not largest > 0.0:
            return False
        if pivot != col:
            for k in range(col, n):
                a[col, k], a[pivot, k] = a[pivot, k], a[col, k]
            for k in range(m):
                x[col, k], x[pivot, k] = x[pivot, k], x[col, k]
        inv = 1.0 / a[col, col]
        for row in range(col + 1, n):
            factor = a[row, col] * inv
            if factor != 0.0:
                for k in range(col + 1, n):
                    a[row, k] -= factor * a[col, k]
                for k in range(m):
                    x[row, k] -= factor * x[col, k]
    for row in range(n - 1, -1, -1):
        inv = 1.0 / a[row, row]
        for k in range(m):
            total = x[row, k]
            for col in range(row + 1, n):
                total -= a[row, col] * x[col, k]
            x[row, k] = total * inv
    return True
