"""Tables and text of the page on the macro-model."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D

from frames import time_history
from frames.plots import plot_style as ps
from lir_element import AnalysisWarning
from validation.claims.static_test import STEP
from validation.opensees.trials import PLAIN, ROBUST, Shaken, Steps, macro, shake
from validation.scenes import EXAMPLE_MASS, MASS, REACH, example_bearing, made_scenes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from frames import GroundMotion
    from lir_element.layout import Floats

NAMES = {PLAIN: "Newton", ROBUST: "with fallback"}
DURATION = 20.0
SLIDER = 33.0  # kg, about the bottom slider's own mass
SETTINGS: tuple[tuple[str, dict[str, Any], float, Steps], ...] = (
    ("default", {}, 0.005, PLAIN),
    ("default", {}, 0.005, ROBUST),
    ("default", {}, 0.002, PLAIN),
    ("default", {}, 0.001, PLAIN),
    (f"node m of {SLIDER:.0f} kg", {"middle_mass": SLIDER}, 0.002, PLAIN),
    (f"node m of {SLIDER:.0f} kg", {"middle_mass": SLIDER}, 0.002, ROBUST),
    ("node m of 5 % of the mass", {"middle_mass": 0.05 * EXAMPLE_MASS}, 0.002, PLAIN),
    ("springs across", {"restoring": "across"}, 0.002, PLAIN),
    ("with rise", {"rise": True}, 0.002, PLAIN),
    ("with rise", {"rise": True}, 0.002, ROBUST),
)
SCENES = ("oblique rim contact", "varying axial force", "uplift and landing")
SCENE_STEP = 0.001


def outcome(done: Shaken) -> str:
    """Return how a run ended."""
    return "completed" if done.status == "ok" else f"stopped at {done.time[-1]:.2f} s"


def peak(done: Shaken) -> float:
    """Return the largest horizontal displacement [m]."""
    return float(np.linalg.norm(done.displacement[:, :2], axis=1).max())


def slip(done: Shaken) -> Floats:
    """Return the displacement of node j relative to node m (n, 2) [m]."""
    return np.asarray((done.displacement - done.middle)[:, :2])


class Ended(NamedTuple):
    """What the tables say of a run: its model, how it ended, peak, slip at the end [m] and more."""

    model: tuple[str, ...]
    outcome: str
    peak: float
    slip: float
    more: float
    """Iterations a step, or the largest axial force over the weight [-]."""


def of(model: tuple[str, ...], done: Shaken, more: float) -> Ended:
    """Return what the tables say of a run of the macro-model."""
    return Ended(model, outcome(done), peak(done), float(np.linalg.norm(slip(done)[-1])), more)


def settings_runs(motion: GroundMotion) -> list[Ended]:
    """Run the record with several settings of the macro-model."""
    found = []
    for name, options, dt, algorithms in SETTINGS:
        make = partial(macro, **options)
        how: dict[str, Any] = {"dt": dt, "algorithms": algorithms}
        done = shake(make, example_bearing(), EXAMPLE_MASS, motion, duration=DURATION, **how)
        model = (name, f"{1e3 * dt:g}", NAMES[algorithms])
        found.append(of(model, done, done.iterations / max(done.steps, 1)))
    return found


def scenes_runs() -> tuple[list[Ended], dict[str, dict[str, Floats]]]:
    """Run test cases of oblique contact, varying axial force and uplift with both."""
    found: list[Ended] = []
    orbits: dict[str, dict[str, Floats]] = {}
    for scene in (s for s in made_scenes() if s.name in SCENES):
        orbits[scene.name] = {}
        for level in ("rigid_body", "pendulum"):
            with warnings.catch_warnings(
                action="ignore", category=AnalysisWarning
            ):  # the table tells it
                data = time_history(scene.model(), scene.motion, scene.duration, level=level)
            u = data["bearing_displacement"][:, 0, :2].to_numpy()
            s = data["interface_slip"][:, 0, :2].to_numpy()
            status = "completed" if data.attrs["status"] == "ok" else data.attrs["status"]
            sizes = (float(np.linalg.norm(u, axis=1).max()), float(np.linalg.norm(s[-1])))
            axial = float(data["axial_force"].max() / data["static_axial_force"].max())
            found.append(Ended((scene.name, f"element, level {level}"), status, *sizes, axial))
            orbits[scene.name][level] = u - s
        for algorithms, gaps in ((PLAIN, 16), (ROBUST, 16), (PLAIN, 8)):
            if gaps == 8 and scene.name != SCENES[0]:
                continue
            make = partial(macro, directions=gaps)
            how: dict[str, Any] = {"dt": SCENE_STEP, "algorithms": algorithms}
            done = shake(make, scene.bearing, MASS, scene.motion, duration=scene.duration, **how)
            axial = float(-done.force[:, 2].min() / -done.force[0, 2])
            name = f"macro-model, {gaps} gaps"
            found.append(of((scene.name, f"{name}, {NAMES[algorithms]}"), done, axial))
            orbits[scene.name][name] = done.displacement[:, :2] - slip(done)
    return found, orbits


SLIPS = 3e-4  # m, above what the interface gives before it slips


@dataclass(frozen=True)
class Loop:
    """One static cyclic test: displacement, force over load and slip, (n,)."""

    name: str
    displacement: Floats
    force: Floats
    slip: Floats

    def first(self) -> int:
        """Return the point of the first slip."""
        return int(np.argmax(np.abs(self.slip) > SLIPS))

    def at(self, displacement: float) -> float:
        """Return the force on the first way out, at a displacement [m]."""
        turn = round(REACH / STEP)
        return float(np.interp(displacement, self.displacement[:turn], self.force[:turn]))

    def zero(self) -> int:
        """Return the point nearest to zero displacement on the first way back."""
        turn = round(REACH / STEP)
        return turn + int(np.argmin(np.abs(self.displacement[turn : 3 * turn])))

    def back(self) -> float:
        """Return the force at zero displacement on the first way back."""
        turn = round(REACH / STEP)
        way = slice(turn, 3 * turn)
        return float(np.interp(0.0, self.displacement[way][::-1], self.force[way][::-1]))


@dataclass(frozen=True)
class Rim:
    """Displacement at the first slip [m] over the direction of pull [rad]; (n,)."""

    name: str
    angles: Floats
    reach: Floats


def look(k: int) -> dict[str, Any]:
    """Return colour and line of the k-th curve."""
    return {"color": ps.PALETTE[k], "linestyle": ps.LINES[k], "linewidth": ps.WIDTHS[k]}


def draw_loops(found: Mapping[str, Loop]) -> Figure:
    """Draw the loops of the static test, and their way back through zero enlarged."""
    drawn = ps.new_figure(3.3)
    left, right = ps.grid_of(drawn, 1, 2)[0]
    handles = []
    for k, (name, loop) in enumerate(found.items()):
        for panel in (left, right):
            panel.plot(1e3 * loop.displacement, loop.force, **look(k))
        handles.append(Line2D([], [], label=name, **look(k)))
    right.set_xlim(-45.0, 45.0)
    right.set_ylim(-0.115, -0.025)
    ps.caption(left, x="displacement [mm]", y="lateral force / axial load [-]", title="loops")
    ps.caption(right, x="displacement [mm]", title="ways back through zero, enlarged")
    ps.add_legend(drawn, handles, columns=4, title="Static cyclic test, two cycles of 185 mm")
    return drawn


def draw_rims(found: Mapping[str, Rim], orbits: Mapping[str, Floats], capacity: float) -> Figure:
    """Draw where the interface slips first, and the place of the slider in an oblique contact.

    Shapes: orbits (n, 2).
    """
    drawn = ps.new_figure(3.7)
    left, right = ps.grid_of(drawn, 1, 2)[0]
    handles = []
    for k, rim in enumerate(found.values()):
        x, y = (1e3 * rim.reach * f(rim.angles) for f in (np.cos, np.sin))
        left.plot(x, y, marker="o", markersize=2.5, **look(k))
        handles.append(Line2D([], [], label=rim.name, **look(k)))
    names = [rim.name for rim in found.values()]
    for name, way in orbits.items():
        right.plot(1e3 * way[:, 0], 1e3 * way[:, 1], **look(names.index(name)))
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    right.plot(
        1e3 * capacity * np.cos(turn),
        1e3 * capacity * np.sin(turn),
        color=ps.GREY,
        linewidth=0.8,
        linestyle=(0, (4, 3)),
    )
    near = np.vstack([w[np.linalg.norm(w, axis=1) > 0.97 * capacity] for w in orbits.values()])
    right.set_xlim(1e3 * near[:, 0].min() - 15.0, 1e3 * near[:, 0].max() + 25.0)
    right.set_ylim(1e3 * near[:, 1].min() - 15.0, 1e3 * near[:, 1].max() + 25.0)
    right.annotate(
        "rim",
        1e3 * near.mean(axis=0) * capacity / np.linalg.norm(near.mean(axis=0)),
        (-24.0, -24.0),
        textcoords="offset points",
        fontsize=ps.SMALL,
        color=ps.GREY,
        arrowprops={"arrowstyle": "->", "linewidth": 0.6, "color": ps.GREY},
    )
    for panel in (left, right):
        panel.set_aspect("equal")
    left.set_xlim(left=0.0)
    left.set_ylim(bottom=0.0)
    ps.caption(left, x="x [mm]", y="y [mm]", title="displacement at the first slip")
    ps.caption(right, x="x [mm]", y="y [mm]", title="displacement less slip, a contact")
    ps.add_legend(drawn, handles, columns=4, title="Oblique contact with the rims")
    return drawn
