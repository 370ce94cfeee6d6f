"""Kernels of finite rotations: a rotation vector's matrix, its spin operator, cross products.

Sources: Rodrigues' formula; Crisfield (1997), Non-linear Finite Element Analysis, vol. 2,
section 16.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel

if TYPE_CHECKING:
    from lir_element.layout import Floats


@inlined_by_llvm
def coefficients(square: float) -> tuple[float, float, float]:
    """Return sin(x)/x, (1 - cos(x))/x^2 and (x - sin(x))/x^3 of x^2 = `square`."""
    if square < 2.5e-3:  # series: the next terms lie below round-off
        s = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
        c = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0))
        d = 1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))
        return s, c, d
    x = math.sqrt(square)
    s = math.sin(x) / x
    return s, (1.0 - math.cos(x)) / square, (1.0 - s) / square


@kernel
def add_cross(k: Floats, row: int, col: int, x: float, y: float, z: float, factor: float) -> None:
    """Add `factor` times the matrix of ``(x, y, z) x`` to the 3 x 3 block of `k` at (row, col)."""
    k[row, col + 1] -= factor * z
    k[row, col + 2] += factor * y
    k[row + 1, col] += factor * z
    k[row + 1, col + 2] -= factor * x
    k[row + 2, col] -= factor * y
    k[row + 2, col + 1] += factor * x


@kernel
def turn_matrix(x: float, y: float, z: float, q: Floats) -> None:
    """Fill `q` (3, 3) with the matrix of the rotation vector."""
    xx, yy, zz = x * x, y * y, z * z
    s, c, xy, yz, zx = 0.0, 0.0, 0.0, 0.0, 0.0
    if xx + yy + zz > 0.0:  # a plate on the ground does not turn
        s, c, _ = coefficients(xx + yy + zz)
        xy, yz, zx = c * x * y, c * y * z, c * z * x
    q[0, 0] = 1.0 - c * (yy + zz)
    q[1, 1] = 1.0 - c * (zz + xx)
    q[2, 2] = 1.0 - c * (xx + yy)
    q[0, 1], q[1, 0] = xy - s * z, xy + s * z
    q[1, 2], q[2, 1] = yz - s * x, yz + s * x
    q[2, 0], q[0, 2] = zx - s * y, zx + s * y


@kernel
def spin_matrix(x: float, y: float, z: float, spin: Floats) -> None:
    """Fill `spin` (3, 3) with the spin by the rates of the rotation vector."""
    _, c, d = coefficients(x * x + y * y + z * z)
    xx, yy, zz = x * x, y * y, z * z
    xy, yz, zx = d * x * y, d * y * z, d * z * x
    spin[0, 0] = 1.0 - d * (yy + zz)
    spin[1, 1] = 1.0 - d * (zz + xx)
    spin[2, 2] = 1.0 - d * (xx + yy)
    spin[0, 1], spin[1, 0] = xy - c * z, xy + c * z
    spin[1, 2], spin[2, 1] = yz - c * x, yz + c * x
    spin[2, 0], spin[0, 2] = zx - c * y, zx + c * y


@kernel
def rotate(x: float, y: float, z: float, q: Floats, spin: Floats) -> None:
    """Fill `q` (3, 3) with the matrix of the rotation vector and `spin` (3, 3) with d(spin)."""
    turn_matrix(x, y, z, q)
    spin_matrix(x, y, z, spin)
