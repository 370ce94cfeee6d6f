"""Claim: a building imported from OpenSees moves on its bearings as it does in OpenSees.

    python -m validation.claims.opensees_superstructure

Source: OpenSeesPy, which analyses the same building as a whole.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from frames import (
    Frame,
    ModelWarning,
    Section,
    energy_error,
    gravity,
    modes,
    moment_frame,
    time_history,
)
from lir_element import CoulombFriction, Features, LIRBearing
from validation.opensees.frames import Built, add_loads, build
from validation.opensees.isolators import (
    Isolator,
    add_ground,
    damp,
    own_bearing,
    put_on_isolators,
    single_pendulum,
    spring,
    waves,
)
from validation.opensees.model import empty_model, gravity_analysis
from validation.opensees.runs import respond
from validation.page import Check, Claim, Page, render, run, stated

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion

CLAIM = Claim(
    "opensees_superstructure",
    "A building of OpenSees on bearings of this program",
    "A building imported by `Frame.from_opensees` moves as in OpenSees itself, with every kind "
    "of Rayleigh damping",
    "OpenSeesPy",
)
DT, DURATION = 0.005, 8.0  # s
FINE = 0.001  # s, a step that follows rim impacts
HARD = 0.65  # times the motion, into the rims
EQUILIBRIUM = 1e-10  # m and rad, of the last correction in OpenSees
STOREYS = 3
AXIAL, AXIAL_DAMPING = 2e9, 1e6  # N/m, N s/m, of a bearing
FRICTION = 0.05
COLUMN = Section(0.0375, 8.8e-4, 8.8e-4, 1.3e-3, 2.1e11, 8.08e10, density=7850.0)
BEAM = Section(0.0150, 7.5e-4, 3.5e-5, 1.5e-6, 2.1e11, 8.08e10, density=7850.0)
PENDULUM = Features(
    rims=False, interface=False, plate_rotation=False, vertical_coupling=False, uplift=False
)
"""What leaves of a bearing without friction a pendulum at constant load over a vertical spring."""
DAMPINGS = {
    "none": "none",
    "mass and initial stiffness": "`rayleigh(0.2, 0, 0.002, 0)`",
    "present stiffness": "`rayleigh(0, 0.005, 0, 0)`",
    "by regions": "initial stiffness, 0.02 s in the columns, 0.001 s in the beams",
}


@dataclass(frozen=True)
class Comparison:
    """Displacements of a base node and of the roof (n, 2, 6) [m, rad] from both programs."""

    time: FloatArray
    found: FloatArray
    expected: FloatArray
    ledger: float
    slip: float
    """Largest slip in the bearings' interface [m]."""

    @property
    def base(self) -> float:
        """Largest difference of the base's displacement in plan over its largest value."""
        return _apart(self.found[:, 0, :2], self.expected[:, 0, :2])

    @property
    def storeys(self) -> float:
        """The same of the roof's displacement relative to the base."""
        return _apart(*(u[:, 1, :2] - u[:, 0, :2] for u in (self.found, self.expected)))


def _apart(found: FloatArray, expected: FloatArray) -> float:
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def device(friction: float) -> LIRBearing:
    """Return a plain DCFP without rims."""
    return LIRBearing(
        radius=1.0,
        slider_height=0.1,
        slider_radius=0.12,
        capacity=math.inf,
        friction=CoulombFriction(friction),
        interface_friction=0.3,
        axial_stiffness=AXIAL,
        axial_damping=AXIAL_DAMPING,
    ).as_dcfp(rims=False)


def resilient() -> LIRBearing:
    """Return an LIR-DCFP that strong shaking drives into its rims."""
    return LIRBearing(
        radius=1.0,
        slider_height=0.1,
        slider_radius=0.12,
        capacity=0.15,
        friction=CoulombFriction(FRICTION),
        interface_friction=0.14,
    )


def building(bearing: LIRBearing) -> Frame:
    """Return the building: 2 by 2 bays, three storeys, rotational inertia at every node."""
    frame = moment_frame(
        storeys=STOREYS, bearing=bearing, column=COLUMN, beam=BEAM, base_beam=BEAM, damping=None
    )
    for name in frame.nodes:
        if not name.startswith("ground"):
            frame.add_mass(name, 0.0, (500.0, 500.0, 800.0))
    return frame


def fixed_base(ops: Any, frame: Frame, damping: str) -> Built:
    """Build it in OpenSees on fixed supports, P-Delta in its members, loads applied."""
    built = build(ops, frame, diaphragms=_floors(frame))
    for tag in built.bases:
        ops.fix(tag, 1, 1, 1, 1, 1, 0)
    add_ground(ops, built.bases)
    add_loads(ops, frame, built)
    damp(ops, built, damping)
    gravity_analysis(ops)
    return built


def _floors(frame: Frame) -> list[str]:
    return [name for name in frame.diaphragms if name != "base"]


def compare(
    motion: GroundMotion,
    bearing: LIRBearing,
    isolator: Isolator,
    *,
    damping: str,
    features: Features | None = None,
    dt: float = DT,
) -> Comparison:
    """Analyse the building imported, and wholly in OpenSees."""
    with empty_model() as ops:
        built = fixed_base(ops, building(bearing), damping)
        with warnings.catch_warnings(
            action="ignore", category=ModelWarning
        ):  # damping of the isolation is meant here
            taken = Frame.from_opensees(built.bases, bearing)
        loads = gravity(taken, features).axial_forces
        data = time_history(taken, motion, DURATION, dt, features=features, on_failure="raise")
        nodes = [built.bases[0], built.nodes[f"floor-{STOREYS}-0-0"]]
        put_on_isolators(ops, built.bases, bearing, loads, isolator)
        track = respond(ops, motion, dt, nodes, duration=DURATION, tolerance=EQUILIBRIUM)
    moves = data["node_displacement"].sel(node=[str(tag) for tag in nodes]).to_numpy()
    return Comparison(
        time=track.time,
        found=moves - moves[0],
        expected=track.displacement - track.displacement[0],
        ledger=energy_error(data),
        slip=float(data["interface_slip_size"].max()),
    )


def independent() -> tuple[float, float]:
    """Compare with the building built by members here: periods, and a history on LIR-DCFPs."""
    bearing = resilient()
    here = building(bearing)
    with empty_model() as ops:
        built = build(ops, here, diaphragms=_floors(here))
        for tag in built.bases:
            ops.fix(tag, 1, 1, 1, 1, 1, 1)
        add_loads(ops, here, built)
        gravity_analysis(ops)
        taken = Frame.from_opensees(built.bases, bearing, base_rotations="free")
    first, second = (modes(frame, 10**6, "sticking").periods for frame in (here, taken))
    motion = waves(0.5, 6.0)
    runs = [
        time_history(frame, motion, dt=DT, on_failure="raise")["bearing_displacement"].to_numpy()
        for frame in (here, taken)
    ]
    return float(np.abs(second / first - 1.0).max()), _apart(runs[1], runs[0])


def page(_: Path | None) -> Page:
    """Run the claim."""
    weak, strong = waves(0.03, 6.0), waves(0.5, 6.0)
    linear = {
        name: compare(weak, device(1e-7), spring, damping=name, features=PENDULUM)
        for name in DAMPINGS
    }
    sliding = compare(
        strong,
        device(FRICTION),
        single_pendulum,
        damping="mass and initial stiffness",
        features=Features(plate_rotation=False),
    )
    own = compare(
        waves(HARD, 6.0), resilient(), own_bearing, damping="mass and initial stiffness", dt=FINE
    )
    periods, moves = independent()
    worst = max(max(one.base, one.storeys) for one in linear.values())
    return Page(
        claim=CLAIM,
        result=f"within {100.0 * worst:.2f} % on linear isolators, "
        f"{100.0 * max(own.base, own.storeys):.2f} % on LIR-DCFPs that meet their rims, "
        f"{100.0 * max(sliding.base, sliding.storeys):.1f} % on friction pendulums of OpenSees",
        checks=_checks(linear, sliding, own, periods, moves),
        body=render(globals(), linear=linear),
        figures={"histories": draw(linear["mass and initial stiffness"], sliding)},
    )


def _checks(
    linear: dict[str, Comparison],
    sliding: Comparison,
    own: Comparison,
    periods: float,
    moves: float,
) -> list[Check]:
    lines = [
        f"linear isolators, damping {name}: {what} | OpenSeesPy | < 0.005 | {value}"
        for name, one in linear.items()
        for what, value in (
            ("displacement of the base", one.base),
            ("roof against base", one.storeys),
        )
    ]
    ledger = max(one.ledger for one in (*linear.values(), sliding, own))
    return stated("\n".join(lines)) + stated(f"""
        LIR-DCFPs: displacement of the base | `bearing_element` | < 0.005 | {own.base}
        LIR-DCFPs: roof against base | `bearing_element` | < 0.005 | {own.storeys}
        LIR-DCFPs: largest interface slip | rims met | > 10 mm | {1e3 * own.slip}
        friction pendulums: displacement of the base | singleFPBearing | < 0.02 | {sliding.base}
        friction pendulums: roof against base | singleFPBearing | < 0.04 | {sliding.storeys}
        all periods, sticking: imported against built here | members of this program | < 0.005 | {periods}
        displacement of LIR-DCFPs: imported against built here | members of this program | < 0.005 | {moves}
        energy balance: error / input | conservation of energy | < 0.001 | {ledger}
        """)


def draw(linear: Comparison, sliding: Comparison) -> Figure:
    """Draw displacements of base and roof along x from both programs."""
    drawn, axes = plt.subplots(2, 2, figsize=(8.0, 4.6), sharex=True, layout="constrained")
    titles = ("linear isolators", "friction pendulums")
    for column, (one, title) in enumerate(zip((linear, sliding), titles, strict=True)):
        for row, label in enumerate(("base [mm]", "roof against base [mm]")):
            axis = axes[row, column]
            for moves, name, style in (
                (one.expected, "OpenSees", {"color": "0.65", "linewidth": 3.0}),
                (one.found, "imported", {"color": "C0", "linewidth": 1.0}),
            ):
                shown = moves[:, row, 0] - (moves[:, 0, 0] if row else 0.0)
                axis.plot(one.time, 1e3 * shown, label=name, **style)
            axis.set_ylabel(label)
            axis.grid(visible=True, alpha=0.3)
        axes[0, column].set_title(title)
        axes[1, column].set_xlabel("time [s]")
    axes[0, 1].legend(loc="lower right")
    drawn.align_ylabels()
    return drawn


if __name__ == "__main__":
    run(CLAIM, page)
