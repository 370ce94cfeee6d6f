"""Claim: a building that yields on its bearings answers as it does in OpenSees.

    python -m validation.claims.opensees_yielding

Source: OpenSeesPy, with its own materials, sections and elements for all that yields, damps or
stops, and the bearing in both.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.laws import Bilinear, BoucWen, Gap, HertzGap, Pinching, Tie, ViscousDamper
from lir_element.units import STANDARD_GRAVITY
from validation.claims import opensees_yielding_section as section
from validation.claims.opensees_yielding_figures import draw_column, draw_loops
from validation.claims.opensees_yielding_runs import (
    LEAST,
    MASS,
    Both,
    bearing,
    equipped,
    hinged,
    pulse,
    run_both,
    stick,
)
from validation.page import Check, Claim, Page, figure, run, stated, table

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from frames import Frame

CLAIM = Claim(
    "opensees_yielding",
    "Structures that yield on their bearings, in both programs",
    "Structures that yield, are damped, braced or run into walls answer on their bearings as in "
    "OpenSees: displacements within 1 %, ductilities and energies within 3 %",
    "OpenSeesPy",
)
DISPLACEMENT, DUCTILITY, ENERGY = 0.01, 0.03, 0.03
"""Largest differences that pass [-]."""
LEDGER = 1e-3
YIELD, WEAK = 4e5, 0.5
"""Yield force of storeys [N], and the motion with which they are shaken over the stronger one."""


class Case(NamedTuple):
    """A building, and how it is shaken."""

    name: str
    theirs: str
    """What OpenSees has for it."""
    make: Callable[[], Frame]
    scale: float
    dt: float
    duration: float
    works: bool = True
    """Whether its parts take energy up."""


def _bilinear(k: float) -> Bilinear:
    return Bilinear(stiffness=k, yield_force=YIELD, hardening=0.03)


def _smooth(k: float) -> BoucWen:
    return BoucWen(stiffness=k, yield_force=YIELD, hardening=0.05)


def _degrading(k: float) -> BoucWen:
    return BoucWen(
        stiffness=k,
        yield_force=YIELD,
        hardening=0.05,
        exponent=1.5,
        shape=0.7,
        strength_loss=0.02,
        stiffness_loss=0.05,
    )


def _pinched(k: float) -> BoucWen:
    return BoucWen(
        stiffness=k, yield_force=YIELD, hardening=0.05, pinching=Pinching(slip=0.9, rate=0.2)
    )


LINEAR = ViscousDamper(coefficient=3e5)
CURVED = ViscousDamper(coefficient=2e5, exponent=0.4)
BRACED = ViscousDamper(coefficient=2e5, exponent=0.4, stiffness=5e7)
TIE = Tie(stiffness=1e7, yield_force=2e5, hardening=0.02, slack=0.02)
WALL = Gap(gap=0.15, stiffness=2e7)
POUNDING = HertzGap(gap=0.15, stiffness=8e7, restitution=0.6)
CASES = (
    Case("storeys, Bilinear", "Steel01", lambda: stick(3, _bilinear, 0.17), WEAK, 1e-3, 6.0),
    Case("storeys, BoucWen", "BoucWen", lambda: stick(2, _smooth), WEAK, 1e-3, 6.0),
    Case("storeys, BoucWen degrading", "BoucWen", lambda: stick(2, _degrading), WEAK, 1e-3, 6.0),
    Case("storeys, BoucWen pinching", "BWBN", lambda: stick(2, _pinched), WEAK, 1e-3, 6.0),
    Case("dampers, linear", "Viscous", lambda: equipped(LINEAR), WEAK, 2e-3, 4.0),
    Case("dampers, exponent 0.4", "Viscous", lambda: equipped(CURVED), WEAK, 2e-3, 4.0),
    Case(
        "dampers with a brace in series", "ViscousDamper", lambda: equipped(BRACED), WEAK, 2e-3, 4.0
    ),
    Case("ties with slack", "ElasticPPGap", lambda: equipped(TIE), WEAK, 2e-3, 4.0),
    Case("walls, elastic", "ViscoelasticGap", lambda: equipped(WALL), 1.0, 5e-4, 2.4, works=False),
    Case("walls, Hertz", "Hertzdamp", lambda: equipped(POUNDING), 1.0, 5e-4, 2.4),
    Case(
        "hinges, no rims",
        "ConcentratedPlasticity",
        lambda: hinged(bearing(math.inf, 0.1)),
        1.0,
        2e-3,
        4.0,
    ),
    Case(
        "hinges, rims met",
        "ConcentratedPlasticity",
        lambda: hinged(bearing(0.2, 0.1)),
        1.0,
        5e-4,
        4.0,
    ),
)
SHOWN = (0, 2, 3, 11)
"""Cases whose loops are drawn."""


def page(_: Path | None) -> Page:
    """Run the claim."""
    found = {one: run_both(one.make(), pulse(one.scale), one.dt, one.duration) for one in CASES}
    own, fibres = section.here(bearing(0.2)), section.in_opensees(bearing(0.2))
    apart = {one: differences(one, both) for one, both in found.items()}
    storeys, frames = (
        max(apart[one]["displacement"] for one in some) for some in (CASES[:-2], CASES[-2:])
    )
    worst = [max(one.get(what, 0.0) for one in apart.values()) for what in ("ductility", "energy")]
    return Page(
        claim=CLAIM,
        result=f"displacements within {100.0 * storeys:.2f} % with storeys that yield, dampers, "
        f"ties and walls, {100.0 * frames:.1f} % with hinges; ductilities within "
        f"{100.0 * worst[0]:.1f} %, energies within {100.0 * worst[1]:.1f} %",
        checks=[*_checks(found, apart), *_column_checks(own, fibres)],
        parts=text(found, own, fibres),
        figures={
            "loops": draw_loops([(one.name, found[one]) for one in (CASES[k] for k in SHOWN)]),
            "column": draw_column(own, fibres),
        },
    )


def differences(case: Case, both: Both) -> dict[str, float]:
    """Return the differences of a case [-]: displacement, ductility, energy where there is one."""
    found = {"displacement": both.displacement, "ductility": both.apart(both.reached)}
    if case.works:
        found["energy"] = both.apart(both.work)
    return found


def _checks(found: dict[Case, Both], apart: dict[Case, dict[str, float]]) -> list[Check]:
    limits = {"displacement": DISPLACEMENT, "ductility": DUCTILITY, "energy": ENERGY}
    lines = [
        f"{case.name}: {what} | {case.theirs} | < {limits[what]} | {value}"
        for case, values in apart.items()
        for what, value in values.items()
    ]
    lines += [
        f"{case.name}: largest interface slip | rims met | > 10 mm | {1e3 * found[case].slip}"
        for case in (CASES[0], CASES[-1])
    ]
    ledger = max(both.ledger for both in found.values())
    lines.append(f"energy balance: error / input | conservation of energy | < {LEDGER} | {ledger}")
    return stated("\n".join(lines))


def _column_checks(own: section.Path, fibres: section.Path) -> list[Check]:
    what, source = "column with N and My", "section of fibres"
    turned = [float(np.abs(one.rotation).max()) for one in (own, fibres)]
    return stated(f"""
        {what}: largest plastic rotation | {source} | {turned[1]} rad ± {100.0 * DUCTILITY} % | {turned[0]}
        {what}: energy dissipated | {source} | {1e-3 * fibres.dissipated} kJ ± {100.0 * ENERGY} % | {1e-3 * own.dissipated}
        {what}: largest value of n + m | rounded corners | < 1.03 | {own.utilisation.max()}
        """)


def text(found: dict[Case, Both], own: section.Path, fibres: section.Path) -> list[str]:
    """Return the text of the page."""
    rows = []
    for case, both in found.items():
        here, there = (float(one.max()) for one in both.reached)
        work = [f"{1e-3 * one.sum():.1f}" if case.works else "" for one in both.work]
        rows.append(
            (case.name, case.theirs, f"{1e3 * both.slip:.0f}", f"{here:.4g}", f"{there:.4g}", *work)
        )
    head = (
        "case",
        "in OpenSees",
        "slip (mm)",
        "reached here",
        "in OpenSees",
        "energy here (kJ)",
        "in OpenSees",
    )
    apart = [
        100.0 * float(np.abs(getattr(own, name) - getattr(fibres, name)).max()) / scale
        for name, scale in (("axial", section.AXIAL), ("moment", section.HINGE.moment_y))
    ]
    return [
        figure(CLAIM, "loops", "Loops of a part of four buildings from both programs"),
        "Both programs analyse the same building by Newmark's method with the same step, the "
        "bearing being that of `bearing_element` in OpenSees. Differences are over the largest "
        "value: of the displacements of all nodes; of the largest deformation of every part over "
        "that at yield (of dampers, ties and walls in metres, of hinges the plastic rotation); of "
        f"the energy that every part took up. Parts that reach {100.0 * LEAST:g} % of the largest "
        "value are compared.",
        table(head, rows),
        "## Storeys, dampers, ties and walls",
        f"A shear building of two storeys (the first case has three) whose storeys yield at "
        f"{1e-3 * YIELD:g} kN, {100.0 * YIELD / (3.0 * MASS * STANDARD_GRAVITY):.0f} % of the "
        "weight, or a linear one with links at its base and in its first storey. The laws are the "
        "same in both programs. `ViscoelasticGap` pulls at the end of a damped contact and a "
        "`Gap` never does: the elastic one is compared here. The energy of links that yield is "
        "without what is elastic at the end.",
        "## Hinges",
        "A steel moment frame of one bay and two storeys, hinges in the beams of its floors "
        "(moments about one axis) and columns (both moments, on a circle). In OpenSees a member "
        "is a "
        "`forceBeamColumn` with the integration `ConcentratedPlasticity`: sections at its ends "
        "that are rigid until they yield, of `Steel01` and of the kind `Bidirectional`. The "
        "geometric stiffness differs: here the consistent one of a bent column, there that of a "
        "straight one, which little hardening makes felt.",
        "## Axial force and moment",
        figure(CLAIM, "column", "A column under drift and changing length"),
        "A column clamped at both ends is taken along a drift and a change of its length, both "
        "prescribed and out of phase. Its hinge yields at |n| + |m| = 1; in OpenSees the same "
        "surface is that of a section of fibres. The surface here is smooth: it is rounded "
        "where no moment and where no axial force is left, and bulges by up to "
        f"{100.0 * (float(own.utilisation.max()) - 1.0):.1f} % between (the fibres, which harden, "
        f"reach {100.0 * (float(fibres.utilisation.max()) - 1.0):.1f} % more than 1). Along this "
        f"path axial forces differ by up to {apart[0]:.1f} % of the axial capacity and moments by "
        f"{apart[1]:.1f} % of the plastic moment.",
    ]


if __name__ == "__main__":
    run(CLAIM, page)
