"""Kernels of damping that couples modes with each other and with the bearings' displacements.

`damping_be` and `damping_ee` of the model are empty if the damping of the modes is diagonal; none
of this is called then. These kernels have single arrays as arguments and stay out of line, so that
they do not slow the time loop of ordinary frames down.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import kernel
from lir_element.kernels.linear import add_product, dot, set_product

if TYPE_CHECKING:
    from lir_element.layout import Floats


@kernel
def invert(matrix: Floats) -> None:
    """Invert a symmetric positive definite matrix in place (Gauss-Jordan, no pivoting)."""
    n = matrix.shape[0]
    for p in range(n):
        inv = 1.0 / matrix[p, p]
        matrix[p, p] = 1.0
        for c in range(n):
            matrix[p, c] *= inv
        for a in range(n):
            if a != p:
                factor = matrix[a, p]
                matrix[a, p] = 0.0
                for c in range(n):
                    matrix[a, c] -= factor * matrix[p, c]


@kernel
def eliminate_modes(
    mass_e: Floats,
    mass_eb: Floats,
    omega2: Floats,
    damping_e: Floats,
    damping_eb: Floats,
    damping_ee: Floats,
    c_m: float,
    c_c: float,
    c_k: float,
    inverse: Floats,
    follow: Floats,
    lead: Floats,
    out: Floats,
) -> None:
    """Subtract the modes' share from the effective stiffness of b, `out`.

    Sets `inverse`, the modes' effective flexibility, and `follow`, how they follow b, with `lead`
    its transpose.
    """
    n_e, n_b = mass_eb.shape
    for k in range(n_e):
        for j in range(n_e):
            inverse[k, j] = c_c * damping_ee[k, j]
        inverse[k, k] += c_m * mass_e[k] + c_c * damping_e[k] + c_k * omega2[k]
    invert(inverse)
    for k in range(n_e):
        for a in range(n_b):
            follow[k, a] = 0.0
        for j in range(n_e):
            for a in range(n_b):
                follow[k, a] += inverse[k, j] * (c_m * mass_eb[j, a] + c_c * damping_eb[j, a])
    for k in range(n_e):
        for a in range(n_b):
            value = c_m * mass_eb[k, a] + c_c * damping_eb[k, a]
            lead[a, k] = follow[k, a]
            for c in range(n_b):
                out[a, c] -= value * follow[k, c]


@kernel
def coupled_load(
    damping_be: Floats,
    damping_eb: Floats,
    damping_ee: Floats,
    inverse: Floats,
    follow: Floats,
    g_b: Floats,
    g_e: Floats,
    rhs_b: Floats,
    rhs_e: Floats,
    h_e: Floats,
) -> None:
    """Subtract known damping forces from the right-hand sides, then eliminate the modes from b's.

    `g_b` and `g_e` are the known part of the velocities. Sets `h_e` to the modes' motion while b
    rests.
    """
    add_product(damping_eb, g_e, -1.0, rhs_b)
    add_product(damping_be, g_b, -1.0, rhs_e)
    add_product(damping_ee, g_e, -1.0, rhs_e)
    add_product(follow, rhs_e, -1.0, rhs_b)
    set_product(inverse, rhs_e, h_e)


@kernel
def coupled_work(
    damping_be: Floats,
    damping_eb: Floats,
    damping_ee: Floats,
    step_b: Floats,
    step_e: Floats,
    v_b: Floats,
    v_e: Floats,
    flow_b: Floats,
    flow_e: Floats,
) -> float:
    """Return the work of the coupled damping over the step at the mean speeds `v_b` and `v_e`.

    `flow_b` (n_b,) and `flow_e` (n_e,) are overwritten.
    """
    set_product(damping_eb, v_e, flow_b)
    set_product(damping_be, v_b, flow_e)
    add_product(damping_ee, v_e, 1.0, flow_e)
    return dot(step_b, flow_b) + dot(step_e, flow_e)
