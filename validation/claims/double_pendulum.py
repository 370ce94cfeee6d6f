"""Claim: as a plain DCFP the element is the rigid slider's theory; the articulated one differs.

    python -m validation.claims.double_pendulum

Sources: moment equilibrium of a rigid slider (docs/theory.md, section 2); Fenz and Constantinou
(2006), Earthq. Eng. Struct. Dyn. 35, 1403, whose slider is articulated
(`validation/articulated.py`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lir_element import LIRBearing
from validation.articulated import articulated
from validation.claims.double_pendulum_figures import draw
from validation.claims.double_pendulum_loops import CASES, HEIGHT, LOAD, STEP, Loops, loops
from validation.page import Check, Claim, Page, render, run, stated

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from frames._types import FloatArray

CLAIM = Claim(
    "double_pendulum",
    "The plain DCFP and the theory of Fenz and Constantinou (2006)",
    "As a plain DCFP the element is the theory of a rigid slider, and agrees with that of an "
    "articulated one where both surfaces slide",
    "statics; Fenz and Constantinou 2006",
)
SMALL = 0.1  # m, displacement up to which the tilt counts as small: 0.05 rad


def rigid(bearing: LIRBearing, displacement: FloatArray) -> FloatArray:
    """Return the rigid slider's force over the load while it slides outwards [-].

    ``H = W tan(theta + atan(m))`` with ``sin(theta) = U / L``, ``m = (mu1 R1 + mu2 R2) / L``.
    """
    tilt = np.arcsin(displacement / bearing.effective_radius)
    return np.asarray(np.tan(tilt + np.arctan(bearing.effective_friction)))


def checks(found: dict[str, Loops]) -> list[Check]:
    """Check the element against the rigid slider, and where the articulated one agrees."""
    results = []
    free = [run for run in found.values() if run.case.rims is None]
    for one in free:
        bearing, u = one.case.bearing, one.path[one.first]
        error = np.abs(one.element[one.first] / rigid(bearing, u) - 1.0).max()
        small = u <= SMALL
        linear = u / bearing.effective_radius + bearing.effective_friction
        gap = np.abs(one.element[one.first] / linear - 1.0)[small].max()
        of = f" ({one.case.name})"
        results += stated(f"""
        element / W tan(θ + atan m) − 1{of} | rigid slider, exact | < 0.005 | {error}
        element / W (U + μ1 R1 + μ2 R2)/L − 1, up to 100 mm{of} | rigid slider, small tilt | < 0.005 | {gap}
        """)
    equal, unequal = free[0], free[-1]
    pair = articulated(unequal.case.bearing, moments=True)
    results += stated(f"""
        sliding d1/R1 − d2/R2, over the largest | one axis for both surfaces | < 1e-9 | {max(one.turn for one in free)}
        force at zero, equal surfaces: element / Fenz and Constantinou | (R1 + R2)/L | {1.0 + HEIGHT / equal.case.bearing.effective_radius} ± 0.5 % | {_at_zero(equal, equal.element) / articulated(equal.case.bearing).at_zero}
        stiffness × L / W, equal surfaces, both sliding: element | 1 | 1 ± 1 % | {_stiffness(equal, equal.element)}
        the same: Fenz and Constantinou | 1 | 1 ± 1 % | {_stiffness(equal, equal.hinged)}
        force at zero, unequal surfaces: articulated with moment equilibrium | (μ1 R1 + μ2 R2)/L | {unequal.case.bearing.effective_friction} ± 1e-07 % | {pair.at_zero}
        equal surfaces: loop of the element against the articulated with moment equilibrium, over the peak | derived below | < 0.01 | {_apart(equal)}
        unequal surfaces, both sliding (100 mm): the same difference | derived below | < 0.01 | {abs(unequal.at(unequal.element, SMALL) / unequal.at(unequal.moments, SMALL) - 1.0)}
        """)
    return [*results, *_rim_checks(found[CASES[-1].name])]


def _rim_checks(one: Loops) -> list[Check]:
    # Where each slider first meets a rim: the stiffness of the loop jumps.
    bearing = one.case.bearing
    count = round(one.case.amplitude / STEP)
    begin = round((articulated(bearing).second_starts + 0.01) / STEP)
    element, hinged = (
        float(
            one.path[
                begin
                + int(
                    np.argmax(
                        np.diff(force[begin : count + 1]) / STEP > 1.15 * _slope(force, begin)
                    )
                )
            ]
        )
        for force in (one.element, one.hinged)
    )
    model = articulated(bearing)
    parts = list(zip(model.radii, model.frictions, model.reach, strict=True))
    touches = min(reach / radius + mu for radius, mu, reach in parts)  # force over the load
    place = sum(max(0.0, (touches - mu) * radius) for radius, mu, _ in parts)
    return stated(f"""
        first rim contact: element | L min(d1/R1, d2/R2) | {1e3 * bearing.lateral_capacity} mm ± 1 % | {1e3 * element}
        first rim contact: Fenz and Constantinou | u1 + u2 as it happens | {1e3 * place} mm ± 1 % | {1e3 * hinged}
        """)


def _apart(one: Loops) -> float:
    # Largest difference of two loops over the peak, 2 mm and more after each turn.
    way = np.sign(np.diff(one.path, prepend=0.0))
    turns = np.flatnonzero(np.diff(way, prepend=0.0))
    settled = np.ones(len(way), dtype=bool)
    for turn in turns:
        settled[turn : turn + round(0.002 / STEP)] = False
    gap = np.abs(one.element - one.moments)[settled].max()
    return float(gap / one.element.max())


def _slope(force: FloatArray, place: int) -> float:
    return float((force[place + 10] - force[place]) / (10 * STEP))


def _at_zero(one: Loops, force: FloatArray) -> float:
    # Half the height of the loop at zero, on its way back and out again.
    begin = round(one.case.amplitude / STEP)
    way, values = one.path[begin:], force[begin:]
    half = len(way) // 2
    back = np.interp(0.0, way[: half + 1][::-1], values[: half + 1][::-1])
    return float(0.5 * (np.interp(0.0, way[half:], values[half:]) - back))


def _stiffness(one: Loops, force: FloatArray) -> float:
    # Of the first way out between 20 and 80 mm, times the effective radius.
    rise = one.at(force, 0.08) - one.at(force, 0.02)
    return rise / 0.06 * one.case.bearing.effective_radius


def against(one: Loops, of: Callable[[Loops, FloatArray], float]) -> str:
    """Return a value of the element, and of both articulated theories beside it, in words."""
    first, *others = (of(one, force) for force in (one.element, one.hinged, one.moments))
    return f"{first:.4f}; " + ", ".join(
        f"{v:.4f} ({100.0 * (v / first - 1.0):+z.0f} %)" for v in others
    )


def page(_: Path | None = None) -> Page:
    """Run all cases and return the page."""
    found = {case.name: loops(case) for case in CASES}
    worst = max(
        float(
            np.abs(one.element[one.first] / rigid(one.case.bearing, one.path[one.first]) - 1).max()
        )
        for one in found.values()
        if one.case.rims is None
    )
    lost = [one.energy(one.moments) / one.energy(one.element) - 1.0 for one in found.values()]
    return Page(
        CLAIM,
        f"closed form of the rigid slider within {100.0 * worst:.3f} %; articulated slider: same force where "
        f"both surfaces slide, energy {100.0 * lost[0]:+.1f} % with equal and "
        f"{100.0 * lost[1]:+.0f} % with unequal frictions",
        checks(found),
        render(
            globals(),
            HEIGHT=HEIGHT,
            LOAD=LOAD,
            articulated=articulated,
            energy=Loops.energy,
            early=lambda one, force: one.at(force, 0.02),
            found=found,
            lost=-100.0 * lost[1],
        ),
        {"loops": draw(found)},
    )


if __name__ == "__main__":
    run(CLAIM, page)
