"""Kernels that put discs together with their bodies: forces and moments of a pair, derivative.

docs/theory.md, section 7.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined
from lir_element.kernels.contact.disc_pair import bond_disc, plane_disc, sphere_disc
from lir_element.kernels.contact.held import (
    COUPLE,
    FRICTION,
    PUSH,
    hold_forces,
    hold_nothing,
    place_point,
)
from lir_element.kernels.rotation import add_cross

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Scratch


@inlined
def add_block(w: Scratch, held: Floats, sign: float, arm: Floats, s: int, r: int, col: int) -> None:
    """Add a disc's derivative by one of its bodies, whose arm is `arm`, to ``w.k``.

    Rows `s` are those of the body, `r` those of the carrier; `col` is the first column.
    """
    g, k, f, m = w.six, w.k, w.force[0], held[COUPLE]
    x, y, z = held[0, 0], held[0, 1], held[0, 2]
    u, v, t = held[1, 0], held[1, 1], held[1, 2]
    row = w.pair_row
    for a in range(6):
        g_0, g_1, g_2 = g[a, 0], g[a, 1], g[a, 2]
        row[a, 0], row[a, 1], row[a, 2] = sign * g_0, sign * g_1, sign * g_2
        row[a, 3] = sign * (arm[1] * g_2 - arm[2] * g_1 + g[a, 3])
        row[a, 4] = sign * (arm[2] * g_0 - arm[0] * g_2 + g[a, 4])
        row[a, 5] = sign * (arm[0] * g_1 - arm[1] * g_0 + g[a, 5])
    if sign < 0.0:  # both turn with the carrier
        add_cross(row, 0, 3, f[0], f[1], f[2], -1.0)
        add_cross(row, 3, 3, m[0], m[1], m[2], -1.0)
    for e in range(6):
        g_0, g_1, g_2 = row[0, e], row[1, e], row[2, e]
        k[s, col + e] += g_0
        k[s + 1, col + e] += g_1
        k[s + 2, col + e] += g_2
        k[r, col + e] -= g_0
        k[r + 1, col + e] -= g_1
        k[r + 2, col + e] -= g_2
        k[s + 3, col + e] += y * g_2 - z * g_1 + row[3, e]
        k[s + 4, col + e] += z * g_0 - x * g_2 + row[4, e]
        k[s + 5, col + e] += x * g_1 - y * g_0 + row[5, e]
        k[r + 3, col + e] -= v * g_2 - t * g_1 + row[3, e]
        k[r + 4, col + e] -= t * g_0 - u * g_2 + row[4, e]
        k[r + 5, col + e] -= u * g_1 - v * g_0 + row[5, e]


@inlined
def add_disc_slope(w: Scratch, held: Floats, body: int, carrier: int) -> None:
    """Add the derivative of a disc's forces and moments to ``w.k``."""
    f, k, arm = w.force[0], w.k, held[0]
    for a in range(3):
        f[a] = held[PUSH, a] + held[FRICTION, a]
    s, r = 6 * body, 6 * carrier
    add_block(w, held, 1.0, held[0], s, r, s)
    add_block(w, held, -1.0, held[1], s, r, r)
    dot = arm[0] * f[0] + arm[1] * f[1] + arm[2] * f[2]
    for a in range(3):  # arms move: (turn x arm) x force on the body; the other's with the material
        for b in range(3):
            turn = arm[a] * f[b] - (dot if a == b else 0.0)
            k[s + 3 + a, s + 3 + b] += turn
            k[r + 3 + a, s + 3 + b] -= turn
    add_cross(k, r + 3, s, f[0], f[1], f[2], 1.0)
    add_cross(k, r + 3, r, f[0], f[1], f[2], -1.0)


@inlined
def set_face(w: Scratch, body: int, carrier: int) -> None:
    """Set the axes of the body's face as the carrier sees them, ``w.face`` (2, 3)."""
    q, r = w.q[body], w.q[carrier]
    for k in range(2):
        for a in range(3):
            w.face[k, a] = r[0, a] * q[0, k] + r[1, a] * q[1, k] + r[2, a] * q[2, k]


@inlined
def hold_disc(
    s: BodyStep, pair: int, body: int, carrier: int, dt: float, speed: float, derive: bool
) -> None:
    """Hold the forces of the disc `pair` where the pressure is; their derivative goes to ``w.k``.

    `pair` is 0 for the bottom surface, 1 for the interface, 2 for the top surface.
    """
    p, c, w = s.props, s.sliders, s.scratch
    old, new, held = s.touch_old[pair], s.touch_new[pair], w.held[pair]
    a, z = s.points[pair].disc, s.points[pair].arm[2]
    up = p.lever[0] if pair == 0 else (c.plane[0] if pair == 1 else -p.lever[1])
    place_point(w, held, body, carrier, z, up)
    set_face(w, body, carrier)
    if pair != 1:
        push = sphere_disc(p, c, 0 if pair == 0 else 1, w, old, new, a, dt, speed, derive)
    elif p.fused:
        bond_disc(w, c, old, new, a, dt, derive)
        push = 1.0
    else:
        push = plane_disc(p, c, w, old, new, a, dt, derive)
    if push == 0.0:
        hold_nothing(held)
        return
    if pair != 1 or not p.fused:
        q = w.q[body]
        for b in range(3):
            shift = q[b, 0] * new.centre[0] + q[b, 1] * new.centre[1]
            held[0, b] += shift
            held[1, b] += shift
    hold_forces(w, held, carrier)
    if derive:
        add_disc_slope(w, held, body, carrier)
