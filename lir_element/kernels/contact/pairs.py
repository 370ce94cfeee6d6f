"""Kernels that put all contact pairs of a bearing together: forces on four bodies, derivative.

Bodies: 0 node i with the bottom plate, 1 bottom slider, 2 top slider, 3 node j with the top plate.
The origin is the undeformed place of the bottom sphere's centre. A pair's force depends on the
place of its point in axes of the carrier alone; force and counterforce act at that point, so that
forces and moments of each pair balance to round-off (Eq. (5) of the paper).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined_by_llvm, kernel
from lir_element.kernels.contact.disc_pair import bond_disc, plane_disc, sphere_disc
from lir_element.kernels.contact.pair import clear_pair, rim
from lir_element.kernels.contact.places import (
    HIGH,
    LOW_BOTTOM,
    LOW_TOP,
    NORMAL,
    OWN,
    RIM_BOTTOM,
    RIM_TOP,
)
from lir_element.kernels.contact.points import add_slope, press_points
from lir_element.kernels.rotation import add_cross
from lir_element.kernels.slip import step_share

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import BodyStep
    from lir_element.layout import Floats, Scratch


@inlined_by_llvm
def clear_parts(parts: Floats) -> None:
    """Set the forces of all origins but the sliders' own to zero."""
    for part in range(OWN):
        for row in range(24):
            parts[part, row] = 0.0


@inlined_by_llvm
def clear_square(k: Floats) -> None:
    """Set the derivative of all forces to zero."""
    for row in range(24):
        for col in range(24):
            k[row, col] = 0.0


@inlined_by_llvm
def hold_rim(s: BodyStep, side: int, body: int, carrier: int, dt: float, derive: bool) -> None:
    """Store the force of a rim on the slider's outermost point; its derivative goes to ``w.k``."""
    p, w, held = s.props, s.scratch, s.scratch.held[3 + side]
    up = p.lever[0] if side == 0 else -p.lever[1]
    place_point(w, held, body, carrier, s.sliders.vertex[side], up)
    clear_pair(w)
    rim(p, side, w, s.old, s.new, dt)
    if s.new.rim_force[side] == 0.0:
        hold_nothing(held)
        return
    for a in range(3):
        w.arm[0, a], w.arm[1, a], w.couple[a] = held[0, a], held[1, a], 0.0
    hold_forces(w, held, carrier)
    if derive:
        for a in range(3):
            w.force[0, a] = held[PUSH, a]
        add_slope(w, body, carrier)


@inlined_by_llvm
def hold_pairs(s: BodyStep, dt: float, speed_bottom: float, speed_top: float, derive: bool) -> None:
    """Store the forces of discs and rims, and set the new state of contacts; see `press`."""
    w = s.scratch
    s.new.step = dt
    w.share, w.step_before = step_share(dt, s.old.step), s.old.step
    w.derived = 1 if derive else 0
    if s.points[0].disc > 0.0:
        hold_disc(s, 0, 1, 0, dt, speed_bottom, derive)
        hold_disc(s, 1, 2, 1, dt, 0.0, derive)
        hold_disc(s, 2, 2, 3, dt, speed_top, derive)
    else:
        press_points(s, dt, speed_bottom, speed_top, derive)
    hold_rim(s, 0, 1, 0, dt, derive)
    hold_rim(s, 1, 2, 3, dt, derive)


@inlined_by_llvm
def push_sliders(s: BodyStep, out: Floats) -> None:
    """Add the forces of discs and rims on both sliders to `out` (12,)."""
    held = s.scratch.held
    add_held(out, 0, 1.0, 0, held[0])
    add_held(out, 6, 1.0, 0, held[1])
    add_held(out, 0, -1.0, 1, held[1])
    add_held(out, 6, 1.0, 0, held[2])
    add_held(out, 0, 1.0, 0, held[3])
    add_held(out, 6, 1.0, 0, held[4])


@kernel
def add_up(s: BodyStep) -> None:
    """Add the stored forces to those by origin, and set their sum ``w.g``."""
    w, parts = s.scratch, s.new.parts
    if s.points[0].disc > 0.0:
        spread_pair(parts, w.held[0], 1, 0, NORMAL, LOW_BOTTOM)
        spread_pair(parts, w.held[1], 2, 1, NORMAL, HIGH)
        spread_pair(parts, w.held[2], 2, 3, NORMAL, LOW_TOP)
    spread_pair(parts, w.held[3], 1, 0, RIM_BOTTOM, RIM_BOTTOM)
    spread_pair(parts, w.held[4], 2, 3, RIM_TOP, RIM_TOP)
    total = w.g
    for row in range(24):
        total[row] = parts[0, row]
    for part in range(1, OWN):
        for row in range(24):
            total[row] += parts[part, row]


@kernel
def press(s: BodyStep, dt: float, speed_bottom: float, speed_top: float, derive: bool) -> None:
    """Set the forces ``w.g`` on all bodies at ``w.x``, ``w.q``, and the new state of contacts.

    With `derive`, also ``w.k``. `speed_bottom` and `speed_top` are the sliding speeds of a static
    state (dt = 0).
    """
    clear_parts(s.new.parts)
    if derive:
        clear_square(s.scratch.k)
    hold_pairs(s, dt, speed_bottom, speed_top, derive)
    add_up(s)


@inlined_by_llvm
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


@inlined_by_llvm
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


@inlined_by_llvm
def set_face(w: Scratch, body: int, carrier: int) -> None:
    """Set the axes of the body's face as the carrier sees them, ``w.face`` (2, 3)."""
    q, r = w.q[body], w.q[carrier]
    for k in range(2):
        for a in range(3):
            w.face[k, a] = r[0, a] * q[0, k] + r[1, a] * q[1, k] + r[2, a] * q[2, k]


@inlined_by_llvm
def hold_disc(
    s: BodyStep, pair: int, body: int, carrier: int, dt: float, speed: float, derive: bool
) -> None:
    """Store the forces of the disc `pair` at the pressure; their derivative goes to ``w.k``.

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


PUSH, FRICTION, COUPLE = 2, 3, 4
"""Rows of the stored forces; 0 and 1 are the arms."""


@inlined_by_llvm
def place_point(
    w: Scratch, held: Floats, body: int, carrier: int, height: float, up: float
) -> None:
    """Set the arms to a point on the body's axis, and ``w.d``: its place in the carrier's axes.

    At a `height` over the body's mass centre, from `up` on the carrier's axis.
    """
    q, r = w.q[body], w.q[carrier]
    for a in range(3):
        held[0, a] = q[a, 2] * height
        held[1, a] = held[0, a] + (w.x[body, a] - w.x[carrier, a])
    for a in range(3):
        w.d[a] = r[0, a] * held[1, 0] + r[1, a] * held[1, 1] + r[2, a] * held[1, 2]
    w.d[2] -= up


@inlined_by_llvm
def hold_forces(w: Scratch, held: Floats, carrier: int) -> None:
    """Store the force and couple of a pair in axes of its carrier."""
    q = w.q[carrier]
    n, t, m = w.normal, w.tangential, w.couple
    for a in range(3):
        held[PUSH, a] = q[a, 0] * n[0] + q[a, 1] * n[1] + q[a, 2] * n[2]
        held[FRICTION, a] = q[a, 0] * t[0] + q[a, 1] * t[1] + q[a, 2] * t[2]
        held[COUPLE, a] = q[a, 0] * m[0] + q[a, 1] * m[1] + q[a, 2] * m[2]


@inlined_by_llvm
def hold_nothing(held: Floats) -> None:
    """Store that a pair has no force."""
    for a in range(3):
        held[PUSH, a], held[FRICTION, a], held[COUPLE, a] = 0.0, 0.0, 0.0


@inlined_by_llvm
def add_wrench(
    out: Floats, first: int, sign: float, arm: Floats, x: float, y: float, z: float
) -> None:
    """Add `sign` times a force and its moment at an arm to six rows of `out`."""
    out[first] += sign * x
    out[first + 1] += sign * y
    out[first + 2] += sign * z
    out[first + 3] += sign * (arm[1] * z - arm[2] * y)
    out[first + 4] += sign * (arm[2] * x - arm[0] * z)
    out[first + 5] += sign * (arm[0] * y - arm[1] * x)


@inlined_by_llvm
def add_held(out: Floats, first: int, sign: float, side: int, held: Floats) -> None:
    """Add all that is held of a pair to the body of one `side`: 0 the body, 1 the carrier."""
    x = held[PUSH, 0] + held[FRICTION, 0]
    y = held[PUSH, 1] + held[FRICTION, 1]
    z = held[PUSH, 2] + held[FRICTION, 2]
    add_wrench(out, first, sign, held[side], x, y, z)
    for a in range(3):
        out[first + 3 + a] += sign * held[COUPLE, a]


@inlined_by_llvm
def spread_pair(
    parts: Floats, held: Floats, body: int, carrier: int, normal: int, friction: int
) -> None:
    """Add the stored forces of a pair to the `parts` of two origins, on both of its bodies."""
    f, t = held[PUSH], held[FRICTION]
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        first = 6 * (body if side == 0 else carrier)
        add_wrench(parts[normal], first, sign, held[side], f[0], f[1], f[2])
        add_wrench(parts[friction], first, sign, held[side], t[0], t[1], t[2])
        for a in range(3):
            parts[friction, first + 3 + a] += sign * held[COUPLE, a]
