"""Kernels that put discs together with their bodies: forces and moments of a pair, derivative.

docs/theory.md, section 7.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import kernel
from lir_element.kernels.contact.disc_pair import bond_disc, plane_disc, set_columns, sphere_disc
from lir_element.kernels.contact.places import HIGH, LOW_BOTTOM, LOW_TOP, NORMAL, locate
from lir_element.kernels.rotation import add_cross

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Scratch


@kernel
def shift_arms(w: Scratch, body: int, e_1: float, e_2: float) -> None:
    """Move the arms of a pair from the face's centre to the centre of pressure."""
    q = w.q[body]
    for a in range(3):
        shift = q[a, 0] * e_1 + q[a, 1] * e_2
        w.arm[0, a] += shift
        w.arm[1, a] += shift


@kernel
def set_blocks(w: Scratch, carrier: int) -> None:
    """Set the derivatives (3 x 12) of the pair's global force and couple by body and carrier."""
    q, six = w.q[carrier], w.six
    for block in range(4):
        top, left = 3 * (block // 2), 3 * (block % 2)
        for a in range(3):
            for b in range(3):
                w.half[a, b] = (
                    q[a, 0] * six[top, left + b]
                    + q[a, 1] * six[top + 1, left + b]
                    + q[a, 2] * six[top + 2, left + b]
                )
        for a in range(3):
            for b in range(3):
                w.six_global[top + a, left + b] = (
                    w.half[a, 0] * q[b, 0] + w.half[a, 1] * q[b, 1] + w.half[a, 2] * q[b, 2]
                )
    g, row = w.six_global, w.pair_row
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        x, y, z = w.arm[side, 0], w.arm[side, 1], w.arm[side, 2]
        col = 6 * side
        for a in range(6):
            g_0, g_1, g_2 = g[a, 0], g[a, 1], g[a, 2]
            row[a, col], row[a, col + 1], row[a, col + 2] = sign * g_0, sign * g_1, sign * g_2
            row[a, col + 3] = sign * (y * g_2 - z * g_1 + g[a, 3])
            row[a, col + 4] = sign * (z * g_0 - x * g_2 + g[a, 4])
            row[a, col + 5] = sign * (x * g_1 - y * g_0 + g[a, 5])


@kernel
def global_vector(q: Floats, local: Floats, out: Floats) -> None:
    """Set `out` to the vector `local` of a body with axes `q`, in global axes."""
    for a in range(3):
        out[a] = q[a, 0] * local[0] + q[a, 1] * local[1] + q[a, 2] * local[2]


@kernel
def add_disc(w: Scratch, parts: Floats, body: int, carrier: int, origin: int) -> None:
    """Add a disc's forces to `parts` where the pressure is, its friction to those of `origin`."""
    q = w.q[carrier]
    global_vector(q, w.normal, w.force[0])
    global_vector(q, w.tangential, w.force[1])
    global_vector(q, w.couple, w.couple_global)
    m = w.couple_global
    for which in range(2):
        f, part = w.force[which], parts[NORMAL if which == 0 else origin]
        for side in range(2):
            sign = 1.0 if side == 0 else -1.0
            first = 6 * (body if side == 0 else carrier)
            x, y, z = w.arm[side, 0], w.arm[side, 1], w.arm[side, 2]
            for a in range(3):
                part[first + a] += sign * f[a]
            part[first + 3] += sign * (y * f[2] - z * f[1])
            part[first + 4] += sign * (z * f[0] - x * f[2])
            part[first + 5] += sign * (x * f[1] - y * f[0])
            if which == 1:
                for a in range(3):
                    part[first + 3 + a] += sign * m[a]
    for a in range(3):
        w.force[0, a] += w.force[1, a]


@kernel
def add_disc_slope(w: Scratch, body: int, carrier: int) -> None:
    """Add the derivative of a disc's forces and moments to ``w.k``."""
    f, m, k, row = w.force[0], w.couple_global, w.k, w.pair_row
    set_blocks(w, carrier)
    add_cross(row, 0, 9, f[0], f[1], f[2], -1.0)  # both turn with the carrier
    add_cross(row, 3, 9, m[0], m[1], m[2], -1.0)
    s, r = 6 * body, 6 * carrier
    x, y, z = w.arm[0, 0], w.arm[0, 1], w.arm[0, 2]
    u, v, t = w.arm[1, 0], w.arm[1, 1], w.arm[1, 2]
    for e in range(12):
        col = s + e if e < 6 else r + e - 6
        g_0, g_1, g_2 = row[0, e], row[1, e], row[2, e]
        k[s, col] += g_0
        k[s + 1, col] += g_1
        k[s + 2, col] += g_2
        k[r, col] -= g_0
        k[r + 1, col] -= g_1
        k[r + 2, col] -= g_2
        k[s + 3, col] += y * g_2 - z * g_1 + row[3, e]
        k[s + 4, col] += z * g_0 - x * g_2 + row[4, e]
        k[s + 5, col] += x * g_1 - y * g_0 + row[5, e]
        k[r + 3, col] -= v * g_2 - t * g_1 + row[3, e]
        k[r + 4, col] -= t * g_0 - u * g_2 + row[4, e]
        k[r + 5, col] -= u * g_1 - v * g_0 + row[5, e]
    dot = x * f[0] + y * f[1] + z * f[2]
    for a in range(3):  # arms move: (turn x arm) x force on the body; the other's with the material
        for b in range(3):
            turn = w.arm[0, a] * f[b] - (dot if a == b else 0.0)
            k[s + 3 + a, s + 3 + b] += turn
            k[r + 3 + a, s + 3 + b] -= turn
    add_cross(k, r + 3, s, f[0], f[1], f[2], 1.0)
    add_cross(k, r + 3, r, f[0], f[1], f[2], -1.0)


@kernel
def press_disc(
    s: BodyStep, j: int, dt: float, speed_bottom: float, speed_top: float, derive: bool
) -> None:
    """Add forces, and derivative, of the disc `j` to those of all bodies."""
    p, c, w = s.props, s.sliders, s.scratch
    point, old, new = s.points[j], s.touch_old[j], s.touch_new[j]
    pair, a = point.pair, point.disc
    body, carrier, friction, up = 2, 1, HIGH, c.plane[0]
    if pair == 0:
        body, carrier, friction, up = 1, 0, LOW_BOTTOM, p.lever[0]
    elif pair == 2:
        carrier, friction, up = 3, LOW_TOP, -p.lever[1]
    locate(w, body, carrier, 0.0, 0.0, point.arm[2], up)
    set_columns(w, body, carrier)
    if pair == 0:
        push = sphere_disc(p, c, 0, w, old, new, a, dt, speed_bottom, derive)
    elif pair == 2:
        push = sphere_disc(p, c, 1, w, old, new, a, dt, speed_top, derive)
    elif p.fused:
        bond_disc(w, c, old, new, a, dt, derive)
        push = 1.0
    else:
        push = plane_disc(p, c, w, old, new, a, dt, derive)
    if push == 0.0:
        return
    if not (pair == 1 and p.fused):
        shift_arms(w, body, new.centre[0], new.centre[1])
    add_disc(w, s.new.parts, body, carrier, friction)
    if derive:
        add_disc_slope(w, body, carrier)
