"""Tables and text of the page on the macro-model."""

from __future__ import annotations

import warnings
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import time_history
from lir_element import AnalysisWarning
from validation.cases import EXAMPLE_MASS, example_bearing
from validation.opensees.devices import macro
from validation.opensees.trials import PLAIN, ROBUST, Shaken, Steps, shake
from validation.page import Claim, figure, table
from validation.scenes import MASS, Scene, made_scenes

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


def settings_table(motion: GroundMotion) -> tuple[str, dict[str, Shaken]]:
    """Run the record with several settings of the macro-model."""
    rows, kept = [], {}
    for name, options, dt, algorithms in SETTINGS:
        done = shake(
            partial(macro, **options),
            example_bearing(),
            EXAMPLE_MASS,
            motion,
            duration=DURATION,
            dt=dt,
            algorithms=algorithms,
        )
        kept[f"{name}, {1e3 * dt:g} ms, {NAMES[algorithms]}"] = done
        rows.append(
            (
                name,
                f"{1e3 * dt:g}",
                NAMES[algorithms],
                outcome(done),
                f"{1e3 * peak(done):.1f}",
                f"{1e3 * np.linalg.norm(slip(done)[-1]):.1f}",
                f"{done.iterations / max(done.steps, 1):.1f}",
            )
        )
    head = (
        "macro-model",
        "step [ms]",
        "algorithm",
        "outcome",
        "peak [mm]",
        "slip at the end [mm]",
        "iterations a step",
    )
    return table(head, rows), kept


def scenes_table() -> tuple[str, dict[str, dict[str, Floats]], dict[str, float]]:
    """Run test cases of oblique contact, varying axial force and uplift with both."""
    rows: list[tuple[str, ...]] = []
    orbits: dict[str, dict[str, Floats]] = {}
    peaks: dict[str, float] = {}
    for scene in (s for s in made_scenes() if s.name in SCENES):
        orbits[scene.name] = {}
        for level in ("rigid_body", "pendulum"):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AnalysisWarning)  # the table tells it
                data = time_history(scene.model(), scene.motion, scene.duration, level=level)
            u = data["bearing_displacement"][:, 0, :2].to_numpy()
            s = data["interface_slip"][:, 0, :2].to_numpy()
            axial = float(data["axial_force"].max() / data["static_axial_force"].max())
            peaks[f"{scene.name}, {level}"] = float(np.linalg.norm(u, axis=1).max())
            rows.append(_row(scene, f"element, level {level}", data.attrs["status"], u, s, axial))
            orbits[scene.name][level] = u - s
        for algorithms, gaps in ((PLAIN, 16), (ROBUST, 16), (PLAIN, 8)):
            if gaps == 8 and scene.name != SCENES[0]:
                continue
            done = shake(
                partial(macro, directions=gaps),
                scene.bearing,
                MASS,
                scene.motion,
                duration=scene.duration,
                dt=SCENE_STEP,
                algorithms=algorithms,
            )
            name = f"macro-model, {gaps} gaps, {NAMES[algorithms]}"
            axial = float(-done.force[:, 2].min() / -done.force[0, 2])
            u = done.displacement[:, :2]
            peaks[f"{scene.name}, {name}"] = peak(done)
            rows.append(_row(scene, name, outcome(done), u, slip(done), axial))
            orbits[scene.name][f"macro-model, {gaps} gaps"] = u - slip(done)
    head = (
        "scene",
        "model",
        "outcome",
        "peak [mm]",
        "slip at the end [mm]",
        "maximum axial force / weight",
    )
    return table(head, rows), orbits, peaks


def _row(
    scene: Scene, name: str, status: str, u: Floats, s: Floats, axial: float
) -> tuple[str, ...]:
    state = "completed" if status == "ok" else status
    return (
        scene.name,
        name,
        state,
        f"{1e3 * np.linalg.norm(u, axis=1).max():.1f}",
        f"{1e3 * np.linalg.norm(s[-1]):.1f}",
        f"{axial:.2f}",
    )


def text(claim: Claim, numbers: dict[str, float], settings: str, scenes: str) -> list[str]:
    """Return the paragraphs of the page."""
    n = numbers
    return [
        figure(claim, "loops", "Loops of the element and of the macro-models, static test"),
        "    node i --+-- friction pendulum (L, m) --+-- node m -- flat slider -- node j\n"
        "             +-- gaps (rims) ---------------+",
        "`lir_element.opensees.macro_model` builds it: what an engineer can put together "
        "today from singleFPBearing, ElasticPPGap in zeroLength elements, and flatSliderBearing. W "
        "is the axial load, `m = (μ1 R1 + μ2 R2)/L`, s the slip, `sin θ = U_cap/L`.",
        "## Up to the first slip",
        "**The same.** Both are a pendulum of length L with the friction m W. The element's force "
        "is "
        "`W tan(asin(U/L) + atan m)`, that of a singleFPBearing follows from "
        "`H = N (m + U/L), N = W + H U/L`: they part with the square of the tilt, by "
        f"{n['apart']:.1f} % at 170 mm.",
        "**The interface's friction must be chosen anew.** In the bearing the interface leans with "
        "the slider: the restoring force passes as pressure, and friction carries the rest. A flat "
        "slider carries all of it, so that with μ_h itself it slips at `U = L (μ_h − m)`, "
        f"{n['early']:.0f} mm here, long before the rims (fourth curve). The macro-model takes "
        "`tan(θ + atan μ_h)`, the force over load at which the bearing's interface slips at the "
        "rim.",
        "## After a slip",
        "**Restoring force.** In series the pendulum sees U − s: `H = ± m W + W (U − s)/L`, "
        "centred "
        "on the slip. In the bearing the load W acts at the slip s off the slider's axis, which "
        "adds "
        "`W s/L`: `H = ± m W + W U/L`, centred on zero "
        "([theory.md](../theory_bearing.md#2-forces-and-equilibrium-of-the-slider)). The loops are apart "
        "by "
        f"W s/L: {n['offset']:.1f} % of the friction force after 10 mm, and as much more as the "
        "slip "
        'grows. Switched off by springs W/L from node i to node j (`restoring="across"`), the '
        "offset is gone; but then the force grows while the interface slips on the rim, by s/L of "
        "the weight, where the bearing's stays. Sliders in series have one or the other.",
        "## Rims",
        figure(
            claim, "rims", "Displacements at the first slip by direction, and an oblique contact"
        ),
        "n gaps are a polygon about the circle: a rim is met at `U_cap / cos(π/n)` in its corners, "
        f"{n['corner 8']:.1f} % late with 8 gaps, {n['corner 16']:.1f} % with 16. The corner of a "
        "square is 41 % away; the pendulum's own force makes the interface slip before that, at "
        f"{n['square']:.0f} mm (U_cap is {n['capacity']:.0f} mm). A "
        "side "
        "of the polygon does not turn the slider, as the circle does.",
        "## Uplift, vertical motion, moments",
        f"Steps of {1e3 * SCENE_STEP:g} ms, test cases of [speed_error.md](speed_error.md).",
        scenes,
        "**Compressed**, the macro-model follows, also under a varying axial force: peaks within "
        f"{n['compressed']:.1f} % of the level rigid_body. **Lifting off**, "
        "Newton's method stops at the first uplift. With a fallback (KrylovNewton, modified "
        "Newton, "
        "halving) it goes on, to a peak of "
        f"{1e3 * n['lifted']:.0f} mm where the bearing has {1e3 * n['lifted reference']:.0f} mm: a "
        "step that is tried again does not begin where the last one ended "
        '([opensees_hard_cases.md](opensees_hard_cases.md), "Steps taken back").',
        "**Vertical motion**: the element rises by `L − sqrt(L² + s² − U²)`; the macro-model does "
        "not, "
        "unless `rise=True`, whose tangent lacks the coupling (next table).",
        "**Moments**: OpenSees puts `N (u_m − u_i)` on node i, whole. The element shares it, "
        "as the slider stands halfway: under Newhall "
        f"{n['moment']:.0f} kN m on the superstructure, against {n['their moment']:.0f} kN m from "
        f"the macro-model, and {n['moment i']:.0f} against {n['their moment i']:.0f} kN m below. "
        "The sums balance in both.",
        "## Newhall",
        settings,
        f"Element: peak {n['peak']:.1f} mm, slip {n['slip']:.1f} mm. Where Newton's method "
        "converges "
        "the macro-model gives the same within a per cent. It needs a mass on node m that the "
        "bearing "
        "does not have; its share in the result is seen with five times the default.",
        "## Cost",
        f"A step of {1e3 * 0.002:g} ms of the whole analysis: element (frames) {n['ours']:.1f} µs, "
        f"macro-model (OpenSeesPy) {n['theirs']:.0f} µs, **ratio {n['ratio']:.0f}** (medians of "
        f"{n['repeats']:.0f} runs in turn; calls of `analyze` alone are timed there, the time loop "
        "here). Ratios carry over to another machine, times do not.",
    ]
