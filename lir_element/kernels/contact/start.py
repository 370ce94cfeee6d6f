"""Kernels of the level 'contact': places from which the search for the sliders starts.

Those of the level 'pendulum', with its closure shared by the three interfaces; or, in the air, the
end of the sliders' flight. docs/theory.md, section 7.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.contact.places import matrix_of, turn_by
from lir_element.kernels.rotation import rotate

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Bodies, Floats, Props, Scratch, Sliders, State, Work

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

    It rotates the shortest way from its present place; `depth` is the mass centre's height above
    the sphere's centre.
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
    """Put the sliders at their places at level 'pendulum', its closure shared by the contacts."""
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
    """Put the sliders at the end of their free flight."""
    for b in range(2):
        for a in range(3):
            new.displacement[b, a] = old.displacement[b, a] + dt * old.velocity[b, a]
        s = old.spin[b]
        turn_by(old.turn[b], dt * s[0], dt * s[1], dt * s[2], new.turn[b])


@kernel
def turn_of(q: Floats, out: Floats) -> None:
    """Set `out` (4,) to the unit quaternion of the rotation matrix `q` (Shepperd 1978)."""
    trace = q[0, 0] + q[1, 1] + q[2, 2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(1.0 + trace)
        out[0] = 0.25 * s
        out[1], out[2] = (q[2, 1] - q[1, 2]) / s, (q[0, 2] - q[2, 0]) / s
        out[3] = (q[1, 0] - q[0, 1]) / s
        return
    i = 0
    for k in range(1, 3):
        if q[k, k] > q[i, i]:
            i = k
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2.0 * math.sqrt(max(1.0 + q[i, i] - q[j, j] - q[k, k], 1e-30))
    out[0] = (q[k, j] - q[j, k]) / s
    out[1 + i], out[1 + j] = 0.25 * s, (q[j, i] + q[i, j]) / s
    out[1 + k] = (q[k, i] + q[i, k]) / s


@kernel
def shortest_turn(x: Floats, y: Floats, q: Floats) -> bool:
    """Set `q` (3, 3) to the rotation without spin that brings the direction of x onto that of y."""
    size = math.sqrt((x[0] ** 2 + x[1] ** 2 + x[2] ** 2) * (y[0] ** 2 + y[1] ** 2 + y[2] ** 2))
    if size == 0.0:
        return False
    c = (x[0] * y[0] + x[1] * y[1] + x[2] * y[2]) / size
    if c <= -0.5:
        return False
    v_0 = (x[1] * y[2] - x[2] * y[1]) / size
    v_1 = (x[2] * y[0] - x[0] * y[2]) / size
    v_2 = (x[0] * y[1] - x[1] * y[0]) / size
    k = 1.0 / (1.0 + c)
    q[0, 0], q[0, 1], q[0, 2] = c + k * v_0 * v_0, k * v_0 * v_1 - v_2, k * v_0 * v_2 + v_1
    q[1, 0], q[1, 1], q[1, 2] = k * v_0 * v_1 + v_2, c + k * v_1 * v_1, k * v_1 * v_2 - v_0
    q[2, 0], q[2, 1], q[2, 2] = k * v_0 * v_2 - v_1, k * v_1 * v_2 + v_0, c + k * v_2 * v_2
    return True


@inlined_by_llvm
def set_axes_of(face: Floats, out: Floats) -> None:
    """Set the axes of a body (columns of `out`) from the two in its face, by rows."""
    for a in range(3):
        m, o = (a + 1) % 3, (a + 2) % 3
        out[a, 0], out[a, 1] = face[0, a], face[1, a]
        out[a, 2] = face[0, m] * face[1, o] - face[0, o] * face[1, m]


@inlined_by_llvm
def multiply(x: Floats, y: Floats, out: Floats) -> None:
    """Set `out` (3, 3) to the product of two matrices, neither of which it is."""
    for a in range(3):
        for b in range(3):
            out[a, b] = x[a, 0] * y[0, b] + x[a, 1] * y[1, b] + x[a, 2] * y[2, b]


@kernel
def carry_on(s: BodyStep, old: State, dt: float) -> bool:
    """Move the sliders with the plates as one piece, rocked as they are.

    The line of the sphere centres rotates and stretches: the sliders rotate with it about the
    bottom sphere's centre, and each contact gets a third of the stretch. An interface that slipped
    in the last step continues to slip. False if a contact was open.
    """
    p, c, w, new = s.props, s.sliders, s.scratch, s.new
    bottom, plane, top = s.touch_old[0], s.touch_old[1], s.touch_old[2]
    if bottom.push <= 0.0 or top.push <= 0.0 or plane.push <= 0.0:
        return False
    q, h = w.q[0], w.spare_matrix
    set_axes_of(bottom.axes, w.half)
    share = dt / s.old.step if s.old.step > 0.0 and plane.slid > 0.0 else 0.0
    slip_1, slip_2 = share * plane.increment[0], share * plane.increment[1]
    go, aim, place = w.axis, w.spare_vector, w.d
    for a in range(3):
        go[a] = old.centres[a] + w.half[a, 0] * slip_1 + w.half[a, 1] * slip_2
        place[a] = w.x[3, a] - w.x[0, a] - p.lever[1] * w.q[3][a, 2] - p.lever[0] * q[a, 2]
    for a in range(3):
        aim[a] = q[0, a] * place[0] + q[1, a] * place[1] + q[2, a] * place[2]
    if not shortest_turn(go, aim, h):
        return False
    long = math.sqrt(go[0] ** 2 + go[1] ** 2 + go[2] ** 2)
    stretch = math.sqrt(aim[0] ** 2 + aim[1] ** 2 + aim[2] ** 2) - long
    part = _RESTING * stretch
    grow = 1.0 + part / p.radius[0]
    g, low, up = w.global_slope, w.q[1], w.q[2]
    multiply(q, h, g)
    multiply(g, w.half, low)
    d = bottom.spot
    for a in range(3):
        w.x[1, a] = (
            w.x[0, a]
            + p.lever[0] * q[a, 2]
            + grow * (g[a, 0] * d[0] + g[a, 1] * d[1] + g[a, 2] * d[2])
            - c.vertex[0] * low[a, 2]
        )
    set_axes_of(plane.axes, w.half)
    d = plane.spot
    multiply(low, w.half, up)
    for a in range(3):
        w.x[2, a] = (
            w.x[1, a]
            + low[a, 0] * (d[0] + slip_1)
            + low[a, 1] * (d[1] + slip_2)
            + low[a, 2] * (c.plane[0] + d[2] - part)
            - c.plane[1] * up[a, 2]
        )
    for b in range(1, 3):
        turn_of(w.q[b], new.turn[b - 1])
        for a in range(3):
            new.displacement[b - 1, a] = w.x[b, a] - c.place[b, a]
    return True
