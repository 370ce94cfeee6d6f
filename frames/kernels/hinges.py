"""Kernels of plastic hinges at a member's ends: N, My and Mz interact on a smooth convex surface.

A member has five deformations: elongation, rotations of its ends from the chord about z (i, j)
and about y (i, j); its forces are N, Mz and My there. A hinge adds plastic elongation and rotation
along the normal of its surface (closest point of the elastic trial, both hinges together).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._jit import kernel
from frames.assembly.system import HINGE, N_PLASTIC, STRIDE
from lir_element.kernels.linear import solve_many

if TYPE_CHECKING:
    from lir_element.layout import Floats

_CORNER = 0.02  # rounds the surface at zero moment, and at zero axial force
_TOLERANCE = 1e-11  # of the surface
_MOST = 40
_TRIES = 8


@kernel
def place(hinge: int, part: int) -> int:
    """Return which of the five forces is N, My, Mz (0, 1, 2) of a hinge (0, 1)."""
    if part == 0:
        return 0
    return 3 + hinge if part == 1 else 1 + hinge


@kernel
def surface(par: Floats, at: int, sigma: Floats, first: Floats, second: Floats) -> float:
    """Return the yield function of `sigma` (N, My, Mz less the back stress), negative inside.

    Sets its gradient `first` (3,) and its second derivatives `second` (3, 3).
    """
    c = _CORNER
    x, y = sigma[1] * par[at + 1], sigma[2] * par[at + 2]
    size = math.sqrt(x * x + y * y + c * c)
    scale = 1.0 / (math.sqrt(1.0 + c * c) - c)
    value = scale * (size - c) - 1.0
    for p in range(3):
        for q in range(3):
            second[p, q] = 0.0
    first[0] = 0.0
    first[1] = scale * x / size * par[at + 1]
    first[2] = scale * y / size * par[at + 2]
    cube = scale / (size * size * size)
    second[1, 1] = cube * (y * y + c * c) * par[at + 1] * par[at + 1]
    second[2, 2] = cube * (x * x + c * c) * par[at + 2] * par[at + 2]
    second[1, 2] = -cube * x * y * par[at + 1] * par[at + 2]
    second[2, 1] = second[1, 2]
    if par[at] > 0.0:  # the axial force is limited, too
        a = (sigma[0] - par[at + 3]) * par[at]
        half = 0.5 * par[at + 4]
        square = a * a + c * c
        power = square ** (half - 1.0)
        least = c ** (2.0 * half)
        axial = 1.0 / ((1.0 + c * c) ** half - least)
        value += axial * (power * square - least)
        first[0] = axial * 2.0 * half * a * power * par[at]
        bend = 2.0 * half * axial * power * (1.0 + 2.0 * (half - 1.0) * a * a / square)
        second[0, 0] = bend * par[at] * par[at]
    return value


@kernel
def is_inside(par: Floats, at: int, sigma: Floats) -> bool:
    """Return True if forces are surely elastic: within the inscribed surface."""
    x, y = sigma[1] * par[at + 1], sigma[2] * par[at + 2]
    return math.sqrt(x * x + y * y) + abs((sigma[0] - par[at + 3]) * par[at]) <= 1.0


@kernel
def is_outside(par: Floats, at: int, sigma: Floats, w: Floats) -> bool:
    """Return True if forces are outside the surface; the costly test only if needed."""
    if is_inside(par, at, sigma):
        return False
    return surface(par, at, sigma, w[11, :3], w[13:16, :3]) > 0.0


@kernel
def set_forces(par: Floats, p: Floats, d: Floats, s: Floats) -> None:
    """Set the member's five forces from its deformations and the plastic parts of its hinges."""
    e_0, e_1, e_2 = d[0] - p[0] - p[3], d[1] - p[2], d[2] - p[5]  # places of `place`
    e_3, e_4 = d[3] - p[1], d[4] - p[4]
    for a in range(5):
        at = 5 * a
        s[a] = par[25 + a] + (
            par[at] * e_0
            + par[at + 1] * e_1
            + par[at + 2] * e_2
            + par[at + 3] * e_3
            + par[at + 4] * e_4
        )


@kernel
def rests(par: Floats, old: Floats, d: Floats, s: Floats) -> bool:
    """Return whether the hinges of a member surely do not turn, by `is_inside`; `s` is scratch."""
    set_forces(par, old, d, s)
    for h in range(2):
        at = HINGE + STRIDE * h
        if par[at + 8] > 0.0:
            y = s[3 + h] - par[at + 6] * old[3 * h + 1]
            z = s[1 + h] - par[at + 7] * old[3 * h + 2]
            x, y, z = (
                s[0] - par[at + 5] * old[3 * h] - par[at + 3],
                y * par[at + 1],
                z * par[at + 2],
            )
            left = 1.0 - abs(x * par[at])
            if left < 0.0 or y * y + z * z > left * left:
                return False
    return True


@kernel
def set_stress(par: Floats, hinge: int, p: Floats, s: Floats, sigma: Floats) -> None:
    """Set N, My, Mz of a hinge less its back stress."""
    at = HINGE + STRIDE * hinge
    for part in range(3):
        sigma[part] = s[place(hinge, part)] - par[at + 5 + part] * p[3 * hinge + part]


@kernel
def stress_slope(par: Floats, h: int, i: int, g: int, j: int) -> float:
    """Return how part `i` of hinge h's stress falls with part `j` of hinge g's plastic part."""
    value = par[5 * place(h, i) + place(g, j)]
    if h == g and i == j:
        value += par[HINGE + STRIDE * h + 5 + i]
    return value


@kernel
def count_unknowns(par: Floats, on: Floats) -> int:
    """Return how many unknowns the hinges that are on have: parts of limited force, multipliers."""
    count = 0
    for h in range(2):
        if on[h] > 0.0:
            count += 1
            for i in range(3):
                if par[HINGE + STRIDE * h + i] > 0.0:
                    count += 1
    return count


@kernel
def set_row(
    par: Floats, on: Floats, h: int, push: Floats, i: int, own: float, mixed: float, row: Floats
) -> None:
    """Set a row of the Jacobian: 1 on part `i` of hinge h (none below 0), ``push`` on all stresses.

    `own` is the factor of the multiplier of hinge h, `mixed` times `push` that of each stress of
    it.
    """
    at, c = HINGE + STRIDE * h, 0
    for g in range(2):
        if on[g] == 0.0:
            continue
        for j in range(3):
            if par[HINGE + STRIDE * g + j] == 0.0:
                continue
            total = 1.0 if g == h and j == i else 0.0
            for q in range(3):
                if par[at + q] > 0.0:
                    total += mixed * push[q] * stress_slope(par, h, q, g, j)
            row[c] = total
            c += 1
        row[c] = own if g == h else 0.0
        c += 1


@kernel
def set_system(
    par: Floats, old: Floats, p: Floats, lam: Floats, on: Floats, d: Floats, w: Floats
) -> float:
    """Set Jacobian ``w[:n, :n]`` and residual ``w[:n, 8]`` of the hinges; returns the error.

    Unknowns of a hinge that is on are the plastic parts whose forces are limited, then its
    multiplier; n is `count_unknowns`.
    """
    s, sigma, first = w[9, :5], w[10, :3], w[11:13, :3]
    set_forces(par, p, d, s)
    error, row = 0.0, 0
    for h in range(2):
        if on[h] == 0.0:
            continue
        at, second = HINGE + STRIDE * h, w[13:16, 3 * h : 3 * h + 3]
        set_stress(par, h, p, s, sigma)
        value = surface(par, at, sigma, first[h], second)
        error = max(error, abs(value))
        for i in range(3):
            if par[at + i] == 0.0:
                continue
            lack = p[3 * h + i] - old[3 * h + i] - lam[h] * first[h, i]
            error = max(error, abs(lack) * stress_slope(par, h, i, h, i) * par[at + i])
            set_row(par, on, h, second[i], i, -first[h, i], lam[h], w[row])
            w[row, 8] = lack
            row += 1
        set_row(par, on, h, first[h], -1, 0.0, -1.0, w[row])
        w[row, 8] = value
        row += 1
    return error


@kernel
def go_on(
    par: Floats,
    on: Floats,
    back: Floats,
    step: Floats,
    factor: float,
    new: Floats,
    lam: Floats,
) -> None:
    """Set plastic parts and multipliers of the hinges that are on to ``back + factor * step``.

    `back` (8,) are those of all parts and multipliers, `step` (n,) is that of the unknowns.
    """
    row = 0
    for h in range(2):
        if on[h] == 0.0:
            continue
        for i in range(3):
            if par[HINGE + STRIDE * h + i] > 0.0:
                new[3 * h + i] = back[3 * h + i] + factor * step[row]
                row += 1
        lam[h] = back[N_PLASTIC + h] + factor * step[row]
        row += 1


@kernel
def return_map(
    par: Floats, old: Floats, new: Floats, lam: Floats, on: Floats, d: Floats, w: Floats
) -> bool:
    """Find the plastic parts of the hinges that are on from a guess; returns success."""
    step, back = w[16, :8], w[17, :8]
    count = count_unknowns(par, on)
    error = set_system(par, old, new, lam, on, d, w)
    for _ in range(_MOST):
        if error <= _TOLERANCE:
            return True
        for a in range(count):
            step[a] = -w[a, 8]
        for a in range(N_PLASTIC):
            back[a] = new[a]
        back[N_PLASTIC], back[N_PLASTIC + 1] = lam[0], lam[1]
        if not solve_many(w, step[:, None], count, 1):
            return False
        factor, found = 1.0, math.inf
        for _ in range(_TRIES):
            go_on(par, on, back, step, factor, new, lam)
            found = set_system(par, old, new, lam, on, d, w)
            if found < error:
                break
            factor *= 0.5
        if not found < error:
            return error <= 1e3 * _TOLERANCE
        error = found
    return error <= 1e3 * _TOLERANCE


@kernel
def forget_turns(old: Floats, new: Floats, lam: Floats) -> None:
    """Guess that no hinge has turned."""
    for a in range(N_PLASTIC):
        new[a] = old[a]
    lam[0], lam[1] = 0.0, 0.0


@kernel
def guess_multipliers(
    par: Floats, old: Floats, new: Floats, lam: Floats, on: Floats, d: Floats, w: Floats
) -> None:
    """Set multipliers that fit plastic parts `new` best; hinges that are off have not turned."""
    s, sigma = w[9, :5], w[10, :3]
    for h in range(2):
        if on[h] == 0.0:
            for part in range(3):
                new[3 * h + part] = old[3 * h + part]
    set_forces(par, new, d, s)
    for h in range(2):
        at, first, above, below = HINGE + STRIDE * h, w[11 + h, :3], 0.0, 0.0
        if on[h] > 0.0:
            set_stress(par, h, new, s, sigma)
            surface(par, at, sigma, first, w[13:16, 3 * h : 3 * h + 3])
            for i in range(3):
                if par[at + i] > 0.0:
                    steep = first[i] / par[at + i]
                    above += (new[3 * h + i] - old[3 * h + i]) / par[at + i] * steep
                    below += steep * steep
        lam[h] = max(above / below, 0.0) if below > 0.0 else 0.0


@kernel
def turn_hinges(
    par: Floats,
    old: Floats,
    new: Floats,
    d: Floats,
    flow: Floats,
    give: Floats,
    w: Floats,
    warm: bool,
) -> int:
    """Set the changes `flow` of the plastic parts of the five deformations, and derivatives `give`.

    Returns 0 if nothing yields, and neither is set; 1 if a hinge does, -1 if no state was found.
    `w` (18, 16) is scratch. If it is `warm`, `new` contains a near state to start from.
    """
    s, sigma, on, lam = w[9, :5], w[10, :3], w[17, 8:10], w[17, 10:12]
    for k in range(N_PLASTIC, old.shape[0]):
        new[k] = old[k]
    if rests(par, old, d, s):
        forget_turns(old, new, lam)
        return 0
    yields = 0
    for h in range(2):
        on[h] = 0.0
        at = HINGE + STRIDE * h
        if par[at + 8] > 0.0:
            set_stress(par, h, old, s, sigma)
            if is_outside(par, at, sigma, w):
                on[h], yields = 1.0, 1
    if yields == 0 or not warm:
        forget_turns(old, new, lam)
    else:
        guess_multipliers(par, old, new, lam, on, d, w)
    if yields == 0:
        return 0
    if not settle_hinges(par, old, new, lam, on, d, w):
        return -1
    set_give(par, lam, on, give, w)
    for c in range(5):
        flow[c] = 0.0
    for h in range(2):
        for part in range(3):
            flow[place(h, part)] += new[3 * h + part] - old[3 * h + part]
        turn = math.hypot(new[3 * h + 1] - old[3 * h + 1], new[3 * h + 2] - old[3 * h + 2])
        new[N_PLASTIC + h] = old[N_PLASTIC + h] + turn
    return 1


@kernel
def hinged_member(
    par: Floats, old: Floats, new: Floats, d: Floats, g: Floats, slope: Floats, w: Floats
) -> int:
    """Set the forces `g` beyond the elastic ones and their derivatives `slope` (5, 5).

    Returns the code of `turn_hinges`.
    """
    flow, column = w[8, :5], w[8, 5:10]
    for a in range(5):
        for c in range(5):
            slope[a, c] = 0.0
    yields = turn_hinges(par, old, new, d, flow, slope, w, False)
    for a in range(5):
        g[a] = 0.0
        for h in range(2):
            for part in range(3):
                g[a] -= par[5 * a + place(h, part)] * new[3 * h + part]
    for c in range(5):
        for a in range(5):
            column[a] = slope[a, c]
        for a in range(5):
            slope[a, c] = 0.0
            for q in range(5):
                slope[a, c] -= par[5 * a + q] * column[q]
    return yields


@kernel
def settle_hinges(
    par: Floats, old: Floats, new: Floats, lam: Floats, on: Floats, d: Floats, w: Floats
) -> bool:
    """Return-map with the hinges that turn out to yield: none pulled back, none left outside.

    `new` and `lam` hold a guess to start from.
    """
    s, sigma = w[9, :5], w[10, :3]
    guessed = True
    for _ in range(6):
        if not return_map(par, old, new, lam, on, d, w):
            if not guessed:
                return False
            guessed = False
            forget_turns(old, new, lam)
            if not return_map(par, old, new, lam, on, d, w):
                return False
        same = True
        for h in range(2):
            at = HINGE + STRIDE * h
            if on[h] > 0.0:
                if lam[h] <= 0.0:
                    on[h], same = 0.0, False
            elif par[at + 8] > 0.0:
                set_forces(par, new, d, s)
                set_stress(par, h, new, s, sigma)
                if surface(par, at, sigma, w[11 + h, :3], w[13:16, 3 * h : 3 * h + 3]) > 1e-9:
                    on[h], same = 1.0, False
        if same:
            return True
        guessed = False
        forget_turns(old, new, lam)
    return False


@kernel
def set_give(par: Floats, lam: Floats, on: Floats, give: Floats, w: Floats) -> None:
    """Set the derivatives of the plastic parts of the five deformations by these.

    `w` is as `settle_hinges` leaves it: the system at the state that was found.
    """
    right, count = w[:8, 9:14], count_unknowns(par, on)
    row = 0
    for h in range(2):
        if on[h] == 0.0:
            continue
        at, second = HINGE + STRIDE * h, w[13:16, 3 * h : 3 * h + 3]
        for i in range(4):
            if i < 3 and par[at + i] == 0.0:
                continue
            for c in range(5):
                total = 0.0
                for q in range(3):
                    push = lam[h] * second[i, q] if i < 3 else -w[11 + h, q]
                    total += push * par[5 * place(h, q) + c]
                right[row, c] = total
            row += 1
    solve_many(w, right, count, 5)
    row = 0
    for a in range(5):
        for c in range(5):
            give[a, c] = 0.0
    for h in range(2):
        if on[h] == 0.0:
            continue
        for i in range(3):
            if par[HINGE + STRIDE * h + i] > 0.0:
                for c in range(5):
                    give[place(h, i), c] += right[row, c]
                row += 1
        row += 1
