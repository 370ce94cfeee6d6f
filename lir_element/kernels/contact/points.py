"""Kernels that put contact points together with their bodies: forces of a point, derivative.

docs/theory.md, section 7.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.pair import bond, clear_pair, plane, sphere
from lir_element.kernels.contact.places import HIGH, LOW_BOTTOM, LOW_TOP, NORMAL, locate
from lir_element.kernels.rotation import add_cross

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Scratch


@kernel
def cross_rows(
    row: Floats,
    x: float,
    y: float,
    z: float,
    sign: float,
    k: Floats,
    first: int,
    body: int,
    carrier: int,
) -> None:
    """Add ``sign * (x, y, z) x row`` to the rows `first`.. of `k`, columns of both bodies."""
    for half in range(2):
        col = 6 * (body if half == 0 else carrier)
        for e in range(6):
            r_0, r_1, r_2 = row[0, 6 * half + e], row[1, 6 * half + e], row[2, 6 * half + e]
            k[first, col + e] += sign * (y * r_2 - z * r_1)
            k[first + 1, col + e] += sign * (z * r_0 - x * r_2)
            k[first + 2, col + e] += sign * (x * r_1 - y * r_0)


@kernel
def set_row(w: Scratch, carrier: int, f: Floats) -> None:
    """Set the derivative (3 x 12) of the pair's global force by body and carrier: (7.4)."""
    q, s = w.q[carrier], w.slope
    for a in range(3):
        for b in range(3):
            w.half[a, b] = q[a, 0] * s[0, b] + q[a, 1] * s[1, b] + q[a, 2] * s[2, b]
    for a in range(3):
        for b in range(3):
            w.global_slope[a, b] = (
                w.half[a, 0] * q[b, 0] + w.half[a, 1] * q[b, 1] + w.half[a, 2] * q[b, 2]
            )
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        x, y, z = w.arm[side, 0], w.arm[side, 1], w.arm[side, 2]
        col = 6 * side
        for a in range(3):  # - slope (arm x), the arm's cross product by columns
            g_0, g_1, g_2 = w.global_slope[a, 0], w.global_slope[a, 1], w.global_slope[a, 2]
            w.row[a, col], w.row[a, col + 1], w.row[a, col + 2] = sign * g_0, sign * g_1, sign * g_2
            w.row[a, col + 3] = sign * (y * g_2 - z * g_1)
            w.row[a, col + 4] = sign * (z * g_0 - x * g_2)
            w.row[a, col + 5] = sign * (x * g_1 - y * g_0)
    add_cross(w.row, 0, 9, f[0], f[1], f[2], -1.0)  # the force turns with its carrier


@kernel
def add_pair(
    w: Scratch, parts: Floats, body: int, carrier: int, friction: int, normal: int
) -> None:
    """Add a pair's normal and friction force to the `parts` of the given origins."""
    q = w.q[carrier]
    for which in range(2):
        local = w.normal if which == 0 else w.tangential
        part = parts[normal if which == 0 else friction]
        f = w.force[which]
        for a in range(3):
            f[a] = q[a, 0] * local[0] + q[a, 1] * local[1] + q[a, 2] * local[2]
        for side in range(2):
            sign = 1.0 if side == 0 else -1.0
            first = 6 * (body if side == 0 else carrier)
            x, y, z = w.arm[side, 0], w.arm[side, 1], w.arm[side, 2]
            for a in range(3):
                part[first + a] += sign * f[a]
            part[first + 3] += sign * (y * f[2] - z * f[1])
            part[first + 4] += sign * (z * f[0] - x * f[2])
            part[first + 5] += sign * (x * f[1] - y * f[0])
    for a in range(3):
        w.force[0, a] += w.force[1, a]


@kernel
def add_slope(w: Scratch, body: int, carrier: int) -> None:
    """Add the derivative of a pair's forces and moments to ``w.k``."""
    f, k = w.force[0], w.k
    set_row(w, carrier, f)
    s, r = 6 * body, 6 * carrier
    for a in range(3):
        for e in range(6):
            k[s + a, s + e] += w.row[a, e]
            k[s + a, r + e] += w.row[a, 6 + e]
            k[r + a, s + e] -= w.row[a, e]
            k[r + a, r + e] -= w.row[a, 6 + e]
    cross_rows(w.row, w.arm[0, 0], w.arm[0, 1], w.arm[0, 2], 1.0, k, s + 3, body, carrier)
    cross_rows(w.row, w.arm[1, 0], w.arm[1, 1], w.arm[1, 2], -1.0, k, r + 3, body, carrier)
    # arms move: (phi x arm) x f on the body; the shift of the point from the carrier on the other
    dot = w.arm[0, 0] * f[0] + w.arm[0, 1] * f[1] + w.arm[0, 2] * f[2]
    for a in range(3):
        for b in range(3):
            turn = w.arm[0, a] * f[b] - (dot if a == b else 0.0)
            k[s + 3 + a, s + 3 + b] += turn
            k[r + 3 + a, s + 3 + b] -= turn
    add_cross(k, r + 3, s, f[0], f[1], f[2], 1.0)
    add_cross(k, r + 3, r, f[0], f[1], f[2], -1.0)


@kernel
def press_points(
    s: BodyStep, dt: float, speed_bottom: float, speed_top: float, derive: bool
) -> None:
    """Add forces, and derivative, of all contact points to those of all bodies."""
    p, c, w = s.props, s.sliders, s.scratch
    points, new = s.points, s.new
    for j in range(points.shape[0]):
        pair, arm = points[j].pair, points[j].arm
        stiffness, damping = points[j].share * c.stiffness, points[j].share * c.damping
        clear_pair(w)
        if pair == 0:
            body, carrier, friction = 1, 0, LOW_BOTTOM
            locate(w, 1, 0, arm[0], arm[1], arm[2], p.lever[0])
            sphere(
                p,
                0,
                w,
                s.touch_old[j],
                s.touch_new[j],
                stiffness,
                damping,
                dt,
                speed_bottom,
                c.grip[0],
            )
        elif pair == 2:
            body, carrier, friction = 2, 3, LOW_TOP
            locate(w, 2, 3, arm[0], arm[1], arm[2], -p.lever[1])
            sphere(
                p,
                1,
                w,
                s.touch_old[j],
                s.touch_new[j],
                stiffness,
                damping,
                dt,
                speed_top,
                c.grip[1],
            )
        else:
            body, carrier, friction = 2, 1, HIGH
            locate(w, 2, 1, arm[0], arm[1], arm[2], c.plane[0])
            if p.fused:
                bond(w, s.touch_old[j], s.touch_new[j], arm[0], arm[1], stiffness, damping, dt)
            else:
                held = points[j].share * p.interface_preload
                plane(p, w, s.touch_old[j], s.touch_new[j], stiffness, damping, dt, held)
        if s.touch_new[j].push == 0.0 and not (pair == 1 and (p.fused or p.interface_preload)):
            continue
        add_pair(w, new.parts, body, carrier, friction, NORMAL)
        if derive:
            add_slope(w, body, carrier)
