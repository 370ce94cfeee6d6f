"""Kernels of pairs whose forces are held: on the sliders at once, by origin when asked for.

What is held of a pair are five vectors in global axes, the rows of one ``w.held[j]``: the arms from
body and carrier to where the forces act, the normal force, the friction and its couple.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lir_element._compile.jit import inlined

if TYPE_CHECKING:
    from lir_element.layout import Floats, Scratch

PUSH, FRICTION, COUPLE = 2, 3, 4
"""Rows of what is held; 0 and 1 are the arms."""


@inlined
def place_point(
    w: Scratch, held: Floats, body: int, carrier: int, height: float, up: float
) -> None:
    """Set the arms to a point on the body's axis, and ``w.d``: where the carrier sees it.

    At a `height` over the body's mass centre, from `up` on the carrier's axis.
    """
    q, r = w.q[body], w.q[carrier]
    for a in range(3):
        held[0, a] = q[a, 2] * height
        held[1, a] = held[0, a] + (w.x[body, a] - w.x[carrier, a])
    for a in range(3):
        w.d[a] = r[0, a] * held[1, 0] + r[1, a] * held[1, 1] + r[2, a] * held[1, 2]
    w.d[2] -= up


@inlined
def hold_forces(w: Scratch, held: Floats, carrier: int) -> None:
    """Hold the force and couple that a pair has in axes of its carrier."""
    q = w.q[carrier]
    n, t, m = w.normal, w.tangential, w.couple
    for a in range(3):
        held[PUSH, a] = q[a, 0] * n[0] + q[a, 1] * n[1] + q[a, 2] * n[2]
        held[FRICTION, a] = q[a, 0] * t[0] + q[a, 1] * t[1] + q[a, 2] * t[2]
        held[COUPLE, a] = q[a, 0] * m[0] + q[a, 1] * m[1] + q[a, 2] * m[2]


@inlined
def hold_nothing(held: Floats) -> None:
    """Hold that a pair passes no force."""
    for a in range(3):
        held[PUSH, a], held[FRICTION, a], held[COUPLE, a] = 0.0, 0.0, 0.0


@inlined
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


@inlined
def add_held(out: Floats, first: int, sign: float, side: int, held: Floats) -> None:
    """Add all that is held of a pair to the body of one `side`: 0 the body, 1 the carrier."""
    x = held[PUSH, 0] + held[FRICTION, 0]
    y = held[PUSH, 1] + held[FRICTION, 1]
    z = held[PUSH, 2] + held[FRICTION, 2]
    add_wrench(out, first, sign, held[side], x, y, z)
    for a in range(3):
        out[first + 3 + a] += sign * held[COUPLE, a]


@inlined
def spread_pair(
    parts: Floats, held: Floats, body: int, carrier: int, normal: int, friction: int
) -> None:
    """Add what is held of a pair to the `parts` of two origins, on both of its bodies."""
    f, t = held[PUSH], held[FRICTION]
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        first = 6 * (body if side == 0 else carrier)
        add_wrench(parts[normal], first, sign, held[side], f[0], f[1], f[2])
        add_wrench(parts[friction], first, sign, held[side], t[0], t[1], t[2])
        for a in range(3):
            parts[friction, first + 3 + a] += sign * held[COUPLE, a]
