"""Tables and text of the page on the macro-model."""

from __future__ import annotations

import warnings
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import time_history
from lir_element import AnalysisWarning
from validation.cases import EXAMPLE_MASS, example_bearing
from validation.opensees.devices import macro
from validation.opensees.trials import PLAIN, ROBUST, Shaken, Steps, shake
from validation.scenes import MASS, made_scenes

if TYPE_CHECKING:
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
        make, how = partial(macro, **options), {"dt": dt, "algorithms": algorithms}
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
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AnalysisWarning)  # the table tells it
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
            make, how = (
                partial(macro, directions=gaps),
                {"dt": SCENE_STEP, "algorithms": algorithms},
            )
            done = shake(make, scene.bearing, MASS, scene.motion, duration=scene.duration, **how)
            axial = float(-done.force[:, 2].min() / -done.force[0, 2])
            name = f"macro-model, {gaps} gaps"
            found.append(of((scene.name, f"{name}, {NAMES[algorithms]}"), done, axial))
            orbits[scene.name][name] = done.displacement[:, :2] - slip(done)
    return found, orbits
