"""Claim: as a plain DCFP the element is the rigid slider's theory; the articulated one differs.

    python -m validation.claims.double_pendulum

Sources: moment equilibrium of a rigid slider (docs/theory.md, section 2); Fenz and Constantinou
(2006), Earthq. Eng. Struct. Dyn. 35, 1403, whose slider is articulated
(`validation/articulated.py`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.plots.plot_style import PALETTE, add_legend, caption, grid_of, new_figure
from lir_element import CoulombFriction, LIRBearing, cyclic_test
from validation.articulated import articulated
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import path_along

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from matplotlib.figure import Figure

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


LOOKS: tuple[dict[str, Any], ...] = (
    {"color": PALETTE[0], "linewidth": 2.0, "label": "rigid slider (element)"},
    {
        "color": PALETTE[1],
        "linewidth": 1.2,
        "linestyle": "--",
        "label": "articulated (Fenz and Constantinou)",
    },
    {
        "color": PALETTE[2],
        "linewidth": 1.2,
        "linestyle": ":",
        "label": "articulated, moments in equilibrium",
    },
)


def draw(found: Mapping[str, Loops]) -> Figure:
    """Draw the loops of all cases."""
    drawn = new_figure(5.2)
    panels = [panel for row in grid_of(drawn, 2, 2) for panel in row]
    for panel, (name, one) in zip(panels, found.items(), strict=True):
        for force, look in zip((one.element, one.hinged, one.moments), LOOKS, strict=True):
            panel.plot(1e3 * one.path, force, **look)
        caption(panel, x="displacement [mm]", y="lateral force / load [-]", title=name)
    for panel in panels:
        panel.set_ylim(-0.24, 0.24)
    handles = [Line2D([], [], **look) for look in LOOKS]
    add_legend(drawn, handles, title="Double concave bearings with rigid and articulated sliders")
    return drawn


LOAD = 500e3  # N
HEIGHT = 0.1  # m
STEP = 5e-4  # m, between the points of the path


@dataclass(frozen=True)
class Case:
    """A bearing and the amplitude of its cycle [m]."""

    name: str
    radii: tuple[float, float]
    frictions: tuple[float, float]
    amplitude: float
    rims: tuple[float, float] | None = None

    @property
    def bearing(self) -> LIRBearing:
        """The bearing, its rigid slider."""
        return LIRBearing(
            radius=self.radii,
            slider_height=HEIGHT,
            slider_radius=0.1,
            capacity=math.inf if self.rims is None else None,
            rims=self.rims,
            friction=(CoulombFriction(self.frictions[0]), CoulombFriction(self.frictions[1])),
            interface_friction=0.3,
            yield_displacement=0.02e-3,
            design_load=LOAD,
        ).as_dcfp()


CASES = (
    Case("equal surfaces", (1.0, 1.0), (0.06, 0.06), 0.15),
    Case("unequal frictions", (1.0, 1.0), (0.03, 0.09), 0.15),
    Case("unequal radii and frictions", (1.2, 0.8), (0.03, 0.09), 0.15),
    Case("the same, with rims at 120 mm", (1.2, 0.8), (0.03, 0.09), 0.20, (0.12, 0.12)),
)


@dataclass(frozen=True)
class Loops:
    """Forces over the load along one path: of the element, and of both articulated theories."""

    case: Case
    path: FloatArray
    element: FloatArray
    hinged: FloatArray
    moments: FloatArray
    turn: float

    @property
    def first(self) -> slice:
        """The first way out, without the elastic begin and the turn."""
        return slice(round(0.005 / STEP), round(self.case.amplitude / STEP))

    def at(self, force: FloatArray, displacement: float) -> float:
        """Return a force on the first way out, at a displacement [m]."""
        count = round(self.case.amplitude / STEP) + 1
        return float(np.interp(displacement, self.path[:count], force[:count]))

    def energy(self, force: FloatArray) -> float:
        """Return the energy of the full cycle over the load [m]."""
        begin = round(self.case.amplitude / STEP)
        return float(np.trapezoid(force[begin:], self.path[begin:]))


def loops(case: Case) -> Loops:
    """Run a case: out to the amplitude and one full cycle."""
    path = path_along([0.0, case.amplitude, -case.amplitude, case.amplitude], STEP)
    data = cyclic_test(case.bearing, path, LOAD, on_failure="raise")
    force = data["bearing_force"].sel(axis="x")[:, 0].to_numpy() / LOAD
    sliding = data["slider_displacement"].sel(axis="x")[:, 0].to_numpy()
    shares = sliding[1:] / np.array(case.radii)
    turn = float(np.abs(shares[:, 0] - shares[:, 1]).max() / np.abs(shares).max())
    hinged, moments = (articulated(case.bearing, moments=m).force(path) for m in (False, True))
    return Loops(case, path, force, hinged, moments, turn)


if __name__ == "__main__":
    run(CLAIM, page)
