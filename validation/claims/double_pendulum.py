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
from validation.articulated import Articulated, articulated
from validation.claims.double_pendulum_figures import draw
from validation.claims.double_pendulum_loops import CASES, HEIGHT, LOAD, STEP, Loops, loops
from validation.page import Check, Claim, Page, figure, run, stated, table

if TYPE_CHECKING:
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


def comparison(found: dict[str, Loops]) -> str:
    """Return the table of the differences."""
    rows = []
    for name, one in found.items():
        model: Articulated = articulated(one.case.bearing)
        zero = [_at_zero(one, force) for force in (one.element, one.hinged, one.moments)]
        early = [one.at(force, 0.02) for force in (one.element, one.hinged, one.moments)]
        energy = [one.energy(force) for force in (one.element, one.hinged, one.moments)]
        rows.append(
            (
                name,
                f"{1e3 * model.second_starts:.0f}",
                _against(early),
                _against(zero),
                _against(energy),
            )
        )
    head = (
        "case",
        "u* [mm]",
        "force at 20 mm, first way out [-]",
        "half the loop's height at zero [-]",
        "energy dissipated per cycle (EDC) / load [m]",
    )
    return table(head, rows)


def _against(values: list[float]) -> str:
    first, *others = values
    return f"{first:.4f}; " + ", ".join(
        f"{v:.4f} ({100.0 * (v / first - 1.0):+z.0f} %)" for v in others
    )


def text(rows: str, lost: float) -> list[str]:
    """Return the text of the page."""
    return [
        figure(CLAIM, "loops", "Loops of the element and of the articulated slider"),
        "In the last panel the rigid slider meets a rim at ±190 mm, and its force leaves the picture.",
        "Each entry: element; Fenz and Constantinou; articulated with moment equilibrium. "
        f"Load {1e-3 * LOAD:.0f} kN, slider height {1e3 * HEIGHT:.0f} mm, hinge in the middle.",
        rows,
        "## The rigid slider",
        "A rigid slider that lies in full contact on both spheres has one axis n. With parallel "
        "plates it leans by one angle θ against both, `sin θ = U/L`, so **both surfaces slide "
        "together**: `d1/R1 = d2/R2`. It cannot slide on the surface of lower friction alone. The "
        "pressures pass through the sphere centres C1 and C2, a distance L apart; friction turns "
        "about them with the levers R1 and R2. Moments about C1, with the force (H, W) at C2:",
        "    (H cos θ − W sin θ) L = N (μ1 R1 + μ2 R2),    N = W cos θ + H sin θ,\n"
        "    H = W tan(θ + atan m) ≈ W U/L + m W,          m = (μ1 R1 + μ2 R2)/L.",
        "The first rim ends it for both surfaces: `U_cap = L min(d1/R1, d2/R2)`.",
        "## The articulated slider",
        "Fenz and Constantinou's slider is articulated: each part leans by its own angle. With "
        "`R_eff,i = R_i − h_i`, u_i the displacement of the hinge against plate i:",
        "    F = W u_i/R_eff,i + μ_i W,    u1 + u2 = U,    R_eff,1 + R_eff,2 = L.",
        "For μ1 < μ2 surface 1 slides alone with the stiffness `W/R_eff,1` until "
        "`u* = (μ2 − μ1) R_eff,1`; then both slide, `F = W (U + μ1 R_eff,1 + μ2 R_eff,2)/L`. When "
        "a part meets its rim, at `u_i = d_i R_eff,i/R_i`, the other goes on alone with "
        "`W/R_eff,2`; the bearing ends where both do. On the way back the regimes repeat with "
        "twice the friction.",
        "This balances the horizontal forces of each part. Its moments balance only if the "
        "pressure shifts, for friction acts at the surface and the hinge force a distance h_i "
        "above it. About the sphere's centre of part i: `μ_i N R_i = (F cos θ_i − W sin θ_i) "
        "R_eff,i`, that is",
        "    F = W u_i/R_eff,i + μ̄_i W,    μ̄_i = μ_i R_i/R_eff,i.",
        "So μ_i of Fenz and Constantinou is what a test shows as force over load, not the ratio of "
        "the stresses on the surface. Sarlis and Constantinou (2016) say so of the earlier models "
        "of the triple bearing: they rest on horizontal equilibrium, with the resultant in the "
        "middle of each surface.",
        "## Where they agree, where not",
        "- **Both surfaces sliding**: the stiffness is W/L in all three. With μ̄_i the articulated "
        "force at zero is `(μ̄1 R_eff,1 + μ̄2 R_eff,2)/L = (μ1 R1 + μ2 R2)/L`, that of the "
        "rigid slider, whatever the radii, the frictions and the place of the hinge. Without it, it is lower: "
        f"for equal surfaces by h/(R1 + R2), {100.0 * HEIGHT / 2.0:.0f} % here.",
        "- **Equal surfaces**: the same loop, to the second order of the tilt.",
        "- **Unequal frictions**: the rigid slider starts to slide at m W, the articulated slider at μ̄1 W, "
        "with a steeper branch until u*. That cuts the corners of its loop: "
        f"{lost:.0f} % less energy in the second case. The hinge is the cause: no choice of μ1 and "
        "μ2 makes a rigid slider show it.",
        "- **Unequal rims**: the rigid slider stops at the first rim, the articulated slider goes on with the "
        "other part, to d1 R_eff,1/R1 + d2 R_eff,2/R2.",
        "The paper takes `R_eff = R1 + R2 − h` from Fenz and Constantinou, and says that without "
        "rim contact the LIR-DCFP is identical to the classical frictional isolators. Stiffness "
        "and period are. The force at zero is μ_d W in their formula and μ_d (R1 + R2)/L W here: "
        "6 % more for the bearing of the static test, if its μ_d is that of the surfaces.",
        "## Advice",
        "- The two sliders of the LIR-DCFP meet in a plane that sticks until the rims are met: they "
        "act as a rigid slider, whose element applies. Unequal frictions do not give it the staged "
        "response of an articulated DCFP.",
        "- Friction evaluated from a loop as force at zero over load, Q/W, is m. For equal "
        "surfaces enter `μ = (Q/W) L/(R1 + R2)`.",
        "- An articulated DCFP with equal surfaces may be modelled by `as_dcfp()` with that μ. "
        "With unequal frictions use an element for it (two single pendulums in series) where "
        "displacements stay near u*; `as_dcfp()` overestimates its energy.",
        "Sources: Fenz and Constantinou (2006), Earthq. Eng. Struct. Dyn. 35, 1403; Sarlis and "
        "Constantinou (2016), the same, doi 10.1002/eqe.2738. Their relations are derived again "
        "here (`validation/articulated.py`); no data of their tests are used.",
    ]


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
        text(comparison(found), -100.0 * lost[1]),
        {"loops": draw(found)},
    )


if __name__ == "__main__":
    run(CLAIM, page)
