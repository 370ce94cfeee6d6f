"""Claim: a building that yields on its bearings answers as it does in OpenSees.

    python -m validation.claims.opensees_yielding

Source: OpenSeesPy, with its own materials, sections and elements for all that yields, damps or
stops, and the bearing in both.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import matplotlib.pyplot as plt
import numpy as np

from frames.laws import Bilinear, BoucWen, Gap, HertzGap, Pinching, Tie, ViscousDamper
from lir_element.units import STANDARD_GRAVITY
from validation.claims import opensees_yielding_section as section
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
from validation.page import Check, Claim, Page, render, run, stated

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from matplotlib.figure import Figure

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
        body=render(
            globals(),
            apart=[
                100.0 * float(np.abs(getattr(own, name) - getattr(fibres, name)).max()) / scale
                for name, scale in (("axial", section.AXIAL), ("moment", section.HINGE.moment_y))
            ],
            beyond=[100.0 * (float(one.utilisation.max()) - 1.0) for one in (own, fibres)],
            found=found,
            least=100.0 * LEAST,
            share=100.0 * YIELD / (3.0 * MASS * STANDARD_GRAVITY),
        ),
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


THEIRS = {"color": "0.65", "linewidth": 3.0}
OURS = {"color": "C0", "linewidth": 0.9}
NAMES = ("here", "OpenSees")
"""In the order of results from both programs."""


def draw_loops(cases: Sequence[tuple[str, Both]]) -> Figure:
    """Draw force over deformation of the part of each building that reaches most."""
    drawn, axes = plt.subplots(2, 2, figsize=(8.0, 6.0), layout="constrained")
    for axis, (title, both) in zip(axes.flat, cases, strict=True):
        part = int(np.argmax(both.reached[1]))
        turns = ":" in both.names[part]
        for which, style in ((1, THEIRS), (0, OURS)):
            axis.plot(
                1e3 * both.deformation[which][:, part],
                1e-3 * both.force[which][:, part],
                label=NAMES[which],
                **style,
            )
        axis.set_title(f"{title}\n{both.names[part]}", fontsize=9)
        axis.set_xlabel("plastic rotation [mrad]" if turns else "deformation [mm]")
        axis.set_ylabel("moment [kN m]" if turns else "force [kN]")
        axis.grid(visible=True, alpha=0.3)
    axes[0, 0].legend(loc="lower right")
    return drawn


def draw_column(own: section.Path, fibres: section.Path) -> Figure:
    """Draw axial force over moment, and moment over plastic rotation, of a column."""
    drawn, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.6), layout="constrained")
    for path, name, style in ((fibres, NAMES[1], THEIRS), (own, NAMES[0], OURS)):
        left.plot(
            path.moment / section.HINGE.moment_y, path.axial / section.AXIAL, label=name, **style
        )
        right.plot(1e3 * path.rotation, 1e-3 * path.moment, label=name, **style)
    left.plot([1, 0, -1, 0, 1], [0, 1, 0, -1, 0], "k--", linewidth=0.8, label="|n| + |m| = 1")
    left.set_xlabel("moment / plastic moment [-]")
    left.set_ylabel("axial force / capacity [-]")
    left.legend(loc="lower left", fontsize=8)
    right.set_xlabel("plastic rotation [mrad]")
    right.set_ylabel("moment [kN m]")
    for axis in (left, right):
        axis.grid(visible=True, alpha=0.3)
    return drawn


if __name__ == "__main__":
    run(CLAIM, page)
