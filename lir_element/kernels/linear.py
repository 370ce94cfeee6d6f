"""Kernels of small linear maps: sparse rows, and dense systems."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats, Words

_WHOLE = 200  # columns, up to which a matrix stays at hand as a whole while it is factorised
_PANEL = 32  # columns of a larger one that are taken out of the rest together: a multiple of 4


@inlined_by_llvm
def gather(start: Words, columns: Words, values: Floats, source: Floats, target: Floats) -> None:
    """Set the 12 displacements `target` of a bearing's nodes from those of a model, `source`.

    Row r of the map has the entries ``start[r]`` to ``start[r + 1]``.
    """
    for row in range(12):
        total = 0.0
        for entry in range(start[row], start[row + 1]):
            total += values[entry] * source[columns[entry]]
        target[row] = total


@inlined_by_llvm
def scatter(
    start: Words, columns: Words, values: Floats, factor: float, force: Floats, target: Floats
) -> None:
    """Add `factor` times the 12 forces on a bearing's nodes to those of a model, `target`."""
    for row in range(12):
        value = factor * force[row]
        for entry in range(start[row], start[row + 1]):
            target[columns[entry]] += values[entry] * value


@kernel
def add_product(columns: Floats, x: Floats, factor: float, out: Floats) -> None:
    """Add ``factor * columns.T @ x`` to `out`: row c of `columns` is column c of the matrix.

    Four columns at a time are added to all of `out`, which processors do in wide registers.
    """
    n, m = columns.shape
    whole = n - n % 4
    for c in range(0, whole, 4):
        x_0, x_1, x_2, x_3 = factor * x[c], factor * x[c + 1], factor * x[c + 2], factor * x[c + 3]
        for a in range(m):
            out[a] += (columns[c, a] * x_0 + columns[c + 1, a] * x_1) + (
                columns[c + 2, a] * x_2 + columns[c + 3, a] * x_3
            )
    for c in range(whole, n):
        x_0 = factor * x[c]
        for a in range(m):
            out[a] += columns[c, a] * x_0


@kernel
def set_product(columns: Floats, x: Floats, out: Floats) -> None:
    """Set `out` to ``columns.T @ x``, as `add_product` adds it."""
    for a in range(out.shape[0]):
        out[a] = 0.0
    add_product(columns, x, 1.0, out)


@inlined_by_llvm
def copy(source: Floats, target: Floats) -> None:
    """Set `target` (n,) to `source`."""
    for a in range(target.shape[0]):
        target[a] = source[a]


@kernel
def copy_words(source: Words, target: Words) -> None:
    """Copy one record, seen as a row of 64-bit words."""
    for k in range(source.shape[0]):
        target[k] = source[k]


@kernel
def subtract_squares(rows: Floats, weights: Floats, out: Floats) -> None:
    """Subtract ``rows.T @ diag(weights) @ rows`` from `out` (n, n); rows (m, n), weights (m,).

    A block of rows, which stays at hand, is taken out of all of `out` before the next.
    """
    m, n = rows.shape
    for first in range(0, m, _PANEL):
        last = min(first + _PANEL, m)
        whole = last - (last - first) % 4
        for a in range(n):
            row = out[a]
            for k in range(first, whole, 4):
                x_0, x_1 = weights[k] * rows[k, a], weights[k + 1] * rows[k + 1, a]
                x_2, x_3 = weights[k + 2] * rows[k + 2, a], weights[k + 3] * rows[k + 3, a]
                r_0, r_1, r_2, r_3 = rows[k], rows[k + 1], rows[k + 2], rows[k + 3]
                for c in range(n):
                    less = (row[c] - x_0 * r_0[c]) - x_1 * r_1[c]
                    row[c] = (less - x_2 * r_2[c]) - x_3 * r_3[c]
            for k in range(whole, last):
                x_0 = weights[k] * rows[k, a]
                for c in range(n):
                    row[c] -= x_0 * rows[k, c]


@kernel
def dot(x: Floats, y: Floats) -> float:
    """Return the scalar product of `x` and `y`."""
    total = 0.0
    for a in range(x.shape[0]):
        total += x[a] * y[a]
    return total


@kernel
def pivot_of(a: Floats, col: int, n: int) -> int:
    """Return the row below `n`, from `col` on, with the largest entry of a column; -1 if none."""
    pivot, largest = col, abs(a[col, col])
    for row in range(col + 1, n):
        if abs(a[row, col]) > largest:
            pivot, largest = row, abs(a[row, col])
    return pivot if largest > 0.0 else -1


@kernel
def factorise(columns: Floats, order: Words) -> bool:
    """Factorise a matrix (n, n) in place, row c of `columns` being its column c.

    Gaussian elimination of the transposed with pivoted rows, exchanged as listed in `order`; the
    pivots are kept inverted. Large matrices are processed a panel of columns at a time: its pivots
    stay in the cache while all columns right of them are read and written once. Returns False if
    the matrix is singular.
    """
    n = columns.shape[0]
    width = max(n, 1) if n <= _WHOLE else _PANEL
    for first in range(0, n, width):
        last = min(first + width, n)
        if not factorise_columns(columns, order, first, last):
            return False
        if last < n:
            eliminate_panel(columns, first, last)
    return True


@kernel
def factorise_columns(columns: Floats, order: Words, first: int, last: int) -> bool:
    """Factorise the columns `first` to `last`, four pivots at a time taken out of the rest."""
    n = columns.shape[0]
    for at in range(first, last, 4):
        end = min(at + 4, last)
        if not factorise_pivots(columns, order, at, end):
            return False
        eliminate_pivots(columns, at, end, end, last)
        if end == last:
            return True
        p_0, p_1 = columns[at, end:last], columns[at + 1, end:last]
        p_2, p_3 = columns[at + 2, end:last], columns[at + 3, end:last]
        for row in range(end, n):
            f_0, f_1 = columns[row, at], columns[row, at + 1]
            f_2, f_3 = columns[row, at + 2], columns[row, at + 3]
            rest = columns[row, end:last]
            for k in range(rest.shape[0]):
                rest[k] -= (f_0 * p_0[k] + f_1 * p_1[k]) + (f_2 * p_2[k] + f_3 * p_3[k])
    return True


@kernel
def factorise_pivots(columns: Floats, order: Words, first: int, last: int) -> bool:
    """Eliminate with the pivots `first` to `last` in their own columns alone."""
    n = columns.shape[0]
    for col in range(first, last):
        pivot = pivot_of(columns, col, n)
        if pivot < 0:
            return False
        order[col] = pivot
        if pivot != col:
            for k in range(n):
                columns[col, k], columns[pivot, k] = columns[pivot, k], columns[col, k]
        inv = 1.0 / columns[col, col]
        columns[col, col] = inv
        for row in range(col + 1, n):
            factor = columns[row, col] * inv
            columns[row, col] = factor
            if factor != 0.0:
                for k in range(col + 1, last):
                    columns[row, k] -= factor * columns[col, k]
    return True


@inlined_by_llvm
def eliminate_pivots(columns: Floats, first: int, last: int, begin: int, end: int) -> None:
    """Eliminate the pivots `first` to `last` from one another's columns `begin` to `end`."""
    for row in range(first + 1, last):
        for col in range(first, row):
            factor = columns[row, col]
            for k in range(begin, end):
                columns[row, k] -= factor * columns[col, k]


@kernel
def eliminate_panel(columns: Floats, first: int, last: int) -> None:
    """Eliminate the pivots `first` to `last`, in fours, from all columns beyond, rows in pairs."""
    n = columns.shape[0]
    for at in range(first, last, 4):
        for before in range(first, at, 4):
            eliminate_four(columns, at, before, last)
            eliminate_four(columns, at + 2, before, last)
        eliminate_pivots(columns, at, at + 4, last, n)
    for row in range(last, n - 1, 2):
        for at in range(first, last, 4):
            eliminate_four(columns, row, at, last)
    if (n - last) % 2 == 1:  # the last row has none beside it
        for col in range(first, last):
            factor = columns[n - 1, col]
            for k in range(last, n):
                columns[n - 1, k] -= factor * columns[col, k]


@inlined_by_llvm
def eliminate_four(columns: Floats, row: int, at: int, begin: int) -> None:
    """Eliminate the four pivots from `at` on from a row and the next, from column `begin` on."""
    f_0, f_1 = columns[row, at], columns[row, at + 1]
    f_2, f_3 = columns[row, at + 2], columns[row, at + 3]
    g_0, g_1 = columns[row + 1, at], columns[row + 1, at + 1]
    g_2, g_3 = columns[row + 1, at + 2], columns[row + 1, at + 3]
    p_0, p_1 = columns[at, begin:], columns[at + 1, begin:]
    p_2, p_3 = columns[at + 2, begin:], columns[at + 3, begin:]
    one, other = columns[row, begin:], columns[row + 1, begin:]
    for k in range(one.shape[0]):
        q_0, q_1, q_2, q_3 = p_0[k], p_1[k], p_2[k], p_3[k]
        one[k] -= (f_0 * q_0 + f_1 * q_1) + (f_2 * q_2 + f_3 * q_3)
        other[k] -= (g_0 * q_0 + g_1 * q_1) + (g_2 * q_2 + g_3 * q_3)


@kernel
def substitute(factors: Floats, order: Words, x: Floats) -> None:
    """Solve for the right-hand side `x` (n,) in place, with the factors of `factorise`."""
    substitute_rows(factors, order, x[None])


@kernel
def substitute_rows(factors: Floats, order: Words, x: Floats) -> None:
    """Solve for the right-hand sides in the rows of `x` (m, n) in place, as `substitute`.

    Four rows of `factors` at a time are read for all of them: large ones are read once.
    """
    n = factors.shape[0]
    whole = n - n % 4
    for c in range(0, whole, 4):
        for y in x:
            forward_four(factors, c, y)
    for y in x:
        for c in range(whole, n):
            y[c] *= factors[c, c]
            for a in range(c + 1, n):
                y[a] -= factors[c, a] * y[c]
        for c in range(n - 1, whole - 1, -1):
            for a in range(c):
                y[a] -= factors[c, a] * y[c]
    for c in range(whole - 4, -1, -4):
        for y in x:
            backward_four(factors, c, y)
    for y in x:
        for c in range(n - 1, -1, -1):
            y[c], y[order[c]] = y[order[c]], y[c]


@inlined_by_llvm
def forward_four(factors: Floats, c: int, x: Floats) -> None:
    """Eliminate four unknowns from `c` on, which become known, from those that follow."""
    for k in range(c, c + 4):
        x[k] *= factors[k, k]
        for a in range(k + 1, c + 4):
            x[a] -= factors[k, a] * x[k]
    x_0, x_1, x_2, x_3 = x[c], x[c + 1], x[c + 2], x[c + 3]
    f_0, f_1, f_2, f_3 = factors[c], factors[c + 1], factors[c + 2], factors[c + 3]
    for a in range(c + 4, x.shape[0]):
        less = (x[a] - f_0[a] * x_0) - f_1[a] * x_1
        x[a] = (less - f_2[a] * x_2) - f_3[a] * x_3


@inlined_by_llvm
def backward_four(factors: Floats, c: int, x: Floats) -> None:
    """Eliminate four unknowns from `c` on, which become known, from those before."""
    for k in range(c + 3, c, -1):
        for a in range(c, k):
            x[a] -= factors[k, a] * x[k]
    x_0, x_1, x_2, x_3 = x[c], x[c + 1], x[c + 2], x[c + 3]
    f_0, f_1, f_2, f_3 = factors[c], factors[c + 1], factors[c + 2], factors[c + 3]
    for a in range(c):
        less = (x[a] - f_3[a] * x_3) - f_2[a] * x_2
        x[a] = (less - f_1[a] * x_1) - f_0[a] * x_0


@kernel
def substitute_many(factors: Floats, order: Words, x: Floats) -> None:
    """Solve for the right-hand sides in the columns of `x` (n, m) in place, as `substitute`."""
    n, m = x.shape
    for c in range(n):
        inv = factors[c, c]
        for k in range(m):
            x[c, k] *= inv
        for a in range(c + 1, n):
            factor = factors[c, a]
            for k in range(m):
                x[a, k] -= factor * x[c, k]
    for c in range(n - 1, 0, -1):
        for a in range(c):
            factor = factors[c, a]
            for k in range(m):
                x[a, k] -= factor * x[c, k]
    for c in range(n - 1, -1, -1):
        if order[c] != c:
            for k in range(m):
                x[c, k], x[order[c], k] = x[order[c], k], x[c, k]


@kernel
def solve_many(a: Floats, x: Floats, n: int, m: int) -> bool:
    """Solve ``a x = rhs`` for the first `n` rows and `m` right-hand sides held by `x` (n, m).

    Gaussian elimination with pivoted rows; both arrays are overwritten. Returns False if singular.
    """
    for col in range(n):
        pivot = pivot_of(a, col, n)
        if pivot < 0:
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
