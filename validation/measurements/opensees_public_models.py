"""Public models of OpenSees on LIR-DCFP bearings: writes docs/validation/opensees_public_models.md.

    python -m validation.measurements.opensees_public_models

The models are examples that the package opstool brings along (``pip install
"lir-dcfp[public-models]"``); nothing of them is copied here. Each is put on bearings twice: in
OpenSees by `isolate`, and in `frames` by `Frame.from_opensees`; both are shaken alike.
"""

from __future__ import annotations

import importlib.util
import math
import warnings
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from frames import Frame, ModelWarning, energy_error, gravity, modes, time_history
from lir_element import LIRBearing, VelocityFriction
from lir_element.opensees import bearing_response, isolate, opensees
from lir_element.units import STANDARD_GRAVITY
from validation.opensees.isolators import waves
from validation.opensees.model import empty_model, gravity_analysis, permanent_loads, settle
from validation.opensees.runs import respond
from validation.page import DPI, FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from frames._types import FloatArray

NAME = "opensees_public_models"
DURATION = 4.0  # s
PERIODS = 6
SLAB = 0.1  # of the model's mass, added above the bearings
DAMPING = 0.02  # of critical at the first period, proportional to the stiffness
PRESSURE = 15e6  # N/m2, on a slider


@dataclass(frozen=True)
class Public:
    """A public model, its units, and what it stands on here."""

    name: str
    what: str
    length: float
    """Its unit of length [m]."""
    force: float
    """Its unit of force [N]."""
    radius: float
    """Of the bearings' surfaces [m]."""
    shaking: float
    """Times `waves`, whose peaks are 1.8 m/s2."""
    steps: tuple[float, ...]
    """Steps of time [s]."""


FINE, COARSE = (0.005, 0.0025), (0.01, 0.005)
MODELS = (
    Public("Frame3D", "15 storeys, 5 × 3 bays, in kN and m", 1.0, 1e3, 1.5, 0.7, COARSE),
    Public("Frame3D-2", "4 storeys with set-backs, in N and mm", 1e-3, 1.0, 1.0, 0.68, FINE),
    Public(
        "ArchBridge-2",
        "arch bridge with a deck of shells, in N and mm",
        1e-3,
        1.0,
        2.0,
        0.8,
        COARSE,
    ),
)


def missing() -> str:
    """Return why the models cannot be had; empty if they can."""
    for package in ("openseespy", "opstool"):
        if importlib.util.find_spec(package) is None:
            return f'{package} is not installed: pip install "lir-dcfp[public-models]"'
    return ""


@dataclass(frozen=True)
class Standing:
    """A public model in OpenSees, loaded by its weight on its own supports."""

    bases: list[int]
    top: int
    device: LIRBearing
    weight: float
    """With the slab [N]."""
    n_nodes: int
    periods: FloatArray
    """The first ones on fixed supports [s]."""


def stand(ops: Any, public: Public) -> Standing:
    """Load a public model into OpenSees, give it a slab, its weight and damping."""
    import opstool  # optional, and slow to import

    opstool.load_ops_examples(public.name)
    tags = list(ops.getNodeTags())
    points = np.array([ops.nodeCoord(tag) for tag in tags])
    bases = sorted(ops.getFixedNodes())
    # the node farthest from all: the top's last corner
    top = tags[int(np.lexsort((points[:, 1], points[:, 0], points[:, 2]))[-1])]
    mass = {tag: ops.nodeMass(tag)[0] for tag in tags}
    slab = SLAB * sum(mass.values()) / len(bases)
    for tag in bases:
        mass[tag] += slab
        ops.mass(tag, *[mass[tag]] * 3, 0.0, 0.0, 0.0)
    kilogram = public.force / public.length  # in the model's unit of mass
    weight = STANDARD_GRAVITY * kilogram * sum(mass.values())
    permanent_loads(ops)
    for tag, value in mass.items():
        ops.load(tag, 0.0, 0.0, -value * STANDARD_GRAVITY / public.length, 0.0, 0.0, 0.0)
    omega2 = np.array(ops.eigen(PERIODS))
    ops.rayleigh(0.0, 0.0, 2.0 * DAMPING / math.sqrt(omega2[0]), 0.0)
    gravity_analysis(ops)
    return Standing(
        bases=bases,
        top=top,
        device=bearing(public, weight / len(bases)),
        weight=weight,
        n_nodes=len(tags),
        periods=2.0 * np.pi / np.sqrt(omega2),
    )


def bearing(public: Public, load: float) -> LIRBearing:
    """Return the bearing under a model, for its load [N]."""
    slider = math.sqrt(load / (math.pi * PRESSURE))
    return LIRBearing(
        radius=public.radius,
        slider_height=slider,
        slider_radius=slider,
        capacity=0.15,
        friction=VelocityFriction(f_max=0.06, f_min=0.03, rate=20.0),
        interface_friction=0.13,
        design_load=load,
    )


@dataclass(frozen=True)
class Motions:
    """Displacements of a base node and of the top (n, 2, 3) [m], and what the bearings did."""

    time: FloatArray
    moves: FloatArray
    axial: FloatArray
    """Axial forces at rest, by bearing [N]."""
    slip: float
    """Largest slip in an interface [m]."""
    seconds: float
    """Of computation."""

    def against(self, other: Motions) -> tuple[float, float]:
        """Return largest differences over largest values: of the base, of the top against it."""
        pairs = [
            (one.moves[:, 0, :2], one.moves[:, 1, :2] - one.moves[:, 0, :2])
            for one in (self, other)
        ]
        return tuple(
            float(np.abs(a - b).max() / np.abs(b).max()) for a, b in zip(*pairs, strict=True)
        )  # type: ignore[return-value]


@dataclass(frozen=True)
class Outcome:
    """A public model in both programs."""

    public: Public
    standing: Standing
    frame: Frame
    notes: tuple[str, ...]
    fixed: FloatArray
    """Periods in `frames` on a fixed base [s]."""
    sticking: tuple[FloatArray, FloatArray]
    """Periods on sticking bearings in OpenSees and in `frames` [s]."""
    there: list[Motions]
    here: list[Motions]
    """In OpenSees and in `frames`, by step."""
    halvings: list[int]
    """How often `frames` halved a step, by step."""
    ledger: float


def compare(public: Public, duration: float = DURATION) -> Outcome:
    """Analyse a public model in both programs."""
    units: dict[str, Any] = {"length_unit": public.length, "force_unit": public.force}
    motion = waves(public.shaking, duration)
    there = []
    for place, dt in enumerate(public.steps):
        with empty_model() as ops:
            standing = stand(ops, public)
            if not place:
                with warnings.catch_warnings(action="ignore", category=ModelWarning):
                    frame = Frame.from_opensees(standing.bases, standing.device, **units)
            isolation = isolate(standing.bases, standing.device, **units)
            settle(ops)
            elements = list(isolation.elements.values())
            if not place:
                stuck = 2.0 * np.pi / np.sqrt(np.array(ops.eigen(PERIODS)))
            axial = np.array([bearing_response(tag, "axial_force") for tag in elements])
            track = respond(
                ops,
                motion,
                dt,
                [standing.bases[0], standing.top],
                duration=duration,
                tolerance=1e-8 / public.length,
                length_unit=public.length,
            )
            slip = max(float(bearing_response(tag, "largest_slip")) for tag in elements)
            moves = public.length * (track.displacement - track.displacement[0])[..., :3]
            there.append(Motions(track.time, moves, axial, slip, track.seconds))
    state = gravity(frame)
    here, halvings, ledger = [], [], 0.0
    for dt in public.steps:
        data = time_history(frame, motion, duration, dt, on_failure="raise")
        seconds = float(data.attrs["seconds_loop"])
        nodes = [str(standing.bases[0]), str(standing.top)]
        moves = data["node_displacement"].sel(node=nodes).to_numpy()[..., :3]
        slip = float(data["interface_slip_size"].max())
        here.append(
            Motions(data["time"].to_numpy(), moves - moves[0], state.axial_forces, slip, seconds)
        )
        halvings.append(int(data.attrs["halvings"]))
        ledger = max(ledger, energy_error(data))
    return Outcome(
        public=public,
        standing=standing,
        frame=frame,
        notes=frame.superelements["opensees"].notes,
        fixed=2.0 * np.pi / np.sqrt(state.basis.omega2[:PERIODS]),
        sticking=(stuck, modes(frame, PERIODS, "sticking").periods),
        there=there,
        here=here,
        halvings=halvings,
        ledger=ledger,
    )


def page(found: Sequence[Outcome]) -> str:
    """Return the page in Markdown."""
    periods, histories, costs = [], [], []
    for one in found:
        name = one.public.name
        stuck = one.sticking[1] / one.sticking[0] - 1.0
        periods.append((
            name, one.public.what, str(one.standing.n_nodes), str(len(one.standing.bases)),
            _list(one.standing.periods), _apart(one.fixed, one.standing.periods),
            _list(one.sticking[0]), f"{100.0 * np.abs(stuck).max():.2f} %",
        ))  # fmt: skip
        rows = zip(one.public.steps, one.there, one.here, one.halvings, strict=True)
        for dt, there, here, halved in rows:
            base, top = here.against(there)
            histories.append((
                name, f"{1e3 * dt:g}", *_peaks(there, here), f"{base:.1e}",
                f"{top:.1e}", str(halved),
            ))  # fmt: skip
        there, here = one.there[-1], one.here[-1]
        steps = len(there.time) - 1
        costs.append((
            name, _apart(here.axial, there.axial), f"{one.ledger:.1e}",
            f"{1e3 * there.seconds / steps:.1f}", f"{1e3 * here.seconds / steps:.1f}",
        ))  # fmt: skip
    return render(globals(), costs=costs, histories=histories, opstool=version("opstool"), periods=periods)  # fmt: skip


def _list(values: FloatArray) -> str:
    return ", ".join(f"{value:.4g}" for value in values[:3])


def _apart(found: FloatArray, expected: FloatArray) -> str:
    return f"{np.abs(found / expected - 1.0).max():.1e}"


def _peaks(there: Motions, here: Motions) -> tuple[str, str, str]:
    pairs = []
    for one in (there, here):
        base, top = one.moves[:, 0, :2], one.moves[:, 1, :2] - one.moves[:, 0, :2]
        pairs.append(
            [
                1e3 * float(np.hypot(*base.T).max()),
                1e3 * float(np.hypot(*top.T).max()),
                1e3 * one.slip,
            ]
        )
    first, second, third = (f"{a:.1f} / {b:.1f}" for a, b in zip(*pairs, strict=True))
    return first, second, third


def draw(found: Sequence[Outcome]) -> Figure:
    """Draw base and top along x from both programs, at the smallest step."""
    drawn, axes = plt.subplots(
        2, len(found), figsize=(10.0, 4.6), sharex=True, layout="constrained", squeeze=False
    )
    for column, one in enumerate(found):
        for row, label in enumerate(("base [mm]", "top against base [mm]")):
            axis = axes[row, column]
            for run, name, style in (
                (one.there[-1], "OpenSees, isolate", {"color": "0.65", "linewidth": 3.0}),
                (one.here[-1], "frames, from_opensees", {"color": "C0", "linewidth": 1.0}),
            ):
                shown = run.moves[:, row, 0] - (run.moves[:, 0, 0] if row else 0.0)
                axis.plot(run.time, 1e3 * shown, label=name, **style)
            axis.grid(visible=True, alpha=0.3)
            if not column:
                axis.set_ylabel(label)
        axes[0, column].set_title(one.public.name)
        axes[1, column].set_xlabel("time [s]")
    drawn.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    drawn.align_ylabels()
    return drawn


def main() -> int:
    """Measure and write the page; returns 1 where the models are missing."""
    reason = missing()
    if reason:
        print(reason)
        return 1
    opensees()  # before opstool loads it
    found = []
    for public in MODELS:
        print(f"{public.name}: {public.what}")
        found.append(compare(public))
    (FOLDER / f"{NAME}.md").write_text(page(found), encoding="utf-8")
    draw(found).savefig(FOLDER / "figures" / f"{NAME}.png", dpi=DPI)
    print(page(found))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
