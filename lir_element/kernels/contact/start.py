"""Kernels of the level 'contact': places from which the search for the sliders starts.

Those of the level 'pendulum', its closure shared by the three interfaces; or, in the air, where the
sliders fly on to. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.pairs import matrix_of, turn_by
from lir_element.kernels.rotation import rotate

if TYPE_CHECKING:
    from lir_element.layout import Bodies, Floats, Props, Scratch, Sliders, Work

_RESTING = 1.0 / 3.0  # of the closure in each of the three interfaces, which are equally stiff


@kernel
def place_nodes(p: Props, c: Sliders, w: Scratch, u: Floats) -> None:
    """Set places and rotations of the plates from the nodes' displacements `u` (12,)."""
    rotate(u[3], u[4], u[5], w.q[0], w.spin_i)
    rotate(u[9], u[10], u[11], w.q[3], w.spin_j)
    for a in range(3):
        w.x[0, a] = c.place[0, a] + u[a]
        w.x[3, a] = c.place[3, a] + u[6 + a]


@kernel
def turn_back(old: Bodies, new: Bodies) -> None:
    """Turn the sliders as they were."""
    for b in range(2):
        for a in range(4):
            new.turn[b, a] = old.turn[b, a]


@kernel
def put_slider(c: Sliders, w: Scratch, new: Bodies, b: int, centre: Floats, depth: float) -> None:
    """Put slider `b` (1, 2) with its sphere's centre at `centre`, axis ``w.axis``.

    It turns from where it is on the shortest way; `depth` is the mass centre's height above the
    sphere's centre.
    """
    matrix_of(new.turn[b - 1], w.spare_matrix)
    x, y, z = w.spare_matrix[0, 2], w.spare_matrix[1, 2], w.spare_matrix[2, 2]
    n = w.axis
    c_x, c_y, c_z = y * n[2] - z * n[1], z * n[0] - x * n[2], x * n[1] - y * n[0]
    size = math.sqrt(c_x * c_x + c_y * c_y + c_z * c_z)
    angle = math.atan2(size, x * n[0] + y * n[1] + z * n[2])
    factor = angle / size if size > 1e-12 else 1.0
    turn_by(new.turn[b - 1], factor * c_x, factor * c_y, factor * c_z, new.turn[b - 1])
    for a in range(3):
        new.displacement[b - 1, a] = centre[a] + depth * n[a] - c.place[b, a]


@kernel
def follow_string(p: Props, c: Sliders, new: Bodies, w: Scratch, pen: Work) -> None:
    """Put the sliders where the level 'pendulum' has them, its closure shared by the contacts."""
    closure = pen.l - p.length
    q = pen.q_i
    for a in range(3):
        w.axis[a] = q[a, 0] * pen.n[0] + q[a, 1] * pen.n[1] + q[a, 2] * pen.n[2]
    share_bottom, share_top = _RESTING * closure, _RESTING * closure
    if not closure > 0.0:  # lifted off: one rests on the other, and both on the bottom plate
        share_bottom = (c.mass[0] + c.mass[1]) * c.gravity / c.stiffness
        share_top = closure - share_bottom - c.mass[1] * c.gravity / c.stiffness
    centre = w.spare_vector
    for a in range(3):
        centre[a] = w.x[0, a] + p.lever[0] * w.q[0][a, 2] - share_bottom * w.axis[a]
    put_slider(c, w, new, 1, centre, c.place[1, 2])
    for a in range(3):
        centre[a] = w.x[3, a] - p.lever[1] * w.q[3][a, 2] + share_top * w.axis[a]
    put_slider(c, w, new, 2, centre, c.place[2, 2] + p.length)


@kernel
def fly_on(old: Bodies, new: Bodies, dt: float) -> None:
    """Put the sliders where their velocity takes them."""
    for b in range(2):
        for a in range(3):
            new.displacement[b, a] = old.displacement[b, a] + dt * old.velocity[b, a]
        s = old.spin[b]
        turn_by(old.turn[b], dt * s[0], dt * s[1], dt * s[2], new.turn[b])
