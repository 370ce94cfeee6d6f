"""Runs of every test case at every level and step, beside a reference that is shown to be converged."""

from __future__ import annotations

import statistics
import warnings
from dataclasses import dataclass, replace
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, time_history
from lir_element import CoulombFriction, cyclic_test
from lir_element.errors import AnalysisWarning
from validation.measures import Errors, Response, errors, response
from validation.scenes import building, static_bearing, static_path

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames import Frame
    from lir_element import LIRBearing
    from validation.scenes import Scene

STEPS = (2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 1e-4)
OUTPUT = 1e-3
"""Longest time between outputs of the reference [s]."""
REFERENCE_TOLERANCE = 1e-10
TOLERANCES = (1e-8, 1e-9)
REPEATS, SHORT = 3, 0.7
"""A run shorter than SHORT seconds is timed REPEATS times, the median counts."""
LOAD = 150e3
STATIC_SPEED = 0.02
BUILDING_STEPS = (2e-2, 1e-2, 5e-3, 2e-3, 1e-3)
BUILDING_REFERENCE = 2.5e-4
WIDTHS = (1.0, 1.25, 1.5)
"""Factors on the slider's radius for the study of eccentric pressure."""
STUDIED = ("oblique rim contact", "unequal rims", "uplift and landing")
CORNERS = {f"bearing-{i}-{j}": "contact" for i in (0, 2) for j in (0, 2)}


@dataclass(frozen=True)
class Row:
    """One run against its reference; `dt` [s] is NaN where the program chose the step."""

    scene: str
    level: str
    dt: float
    errors: Errors
    seconds: float
    share: float
    """Seconds of computation a second of the test case."""
    implicit: float
    """Cost of the implicit reference over that of this run."""
    explicit: float
    """Cost of the explicit reference over that of this run, NaN where there is none."""
    status: str


@dataclass(frozen=True)
class Result:
    """All runs of a test case, with what its reference says of itself."""

    name: str
    what: str
    uplift: bool
    reference: Response
    rows: list[Row]
    features: list[tuple[str, Errors]]


def timed(run: Callable[[], Response]) -> Response:
    """Run several times if it is short; the seconds are the median."""
    first = run()
    if first.seconds > SHORT:
        return first
    times = [run().seconds for _ in range(REPEATS)]
    return replace(first, seconds=statistics.median(times))


def history(model: Frame, motion: GroundMotion, duration: float, **options: Any) -> Response:
    """Run a time history, warnings off: the table says what failed."""
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        return response(time_history(model, motion, duration, **options))


def warm_up(scene: Scene) -> None:
    """Compile and load the kernels of all levels, so that no run is timed with it."""
    for options in (
        {"level": "pendulum"},
        {"level": "contact"},
        {"level": "rigid_body"},
        {"level": "rigid_body", "integrator": "explicit"},
    ):
        history(scene.model(), scene.motion, 2.0 * OUTPUT, **options)
    for level in ("pendulum", "contact", "rigid_body"):
        cyclic_test(static_bearing(), [0.0, OUTPUT], axial_load=LOAD, level=level)


def options_of(dt: float | None) -> dict[str, Any]:
    """Return step and spacing of the outputs, never closer than those of the reference."""
    if dt is None:
        return {}
    return {"dt": dt, "record_every": max(1, round(OUTPUT / dt))}


def run_scene(scene: Scene) -> Result:
    """Run a test case at all levels."""
    model = scene.model()

    def go(level: str, duration: float = scene.duration, **options: Any) -> Response:
        return history(model, scene.motion, duration, level=level, **options)

    reference = go("rigid_body", dt=OUTPUT, tolerance=REFERENCE_TOLERANCE)
    runs = [
        (
            "rigid_body",
            f"tolerance {tolerance:.0e}",
            tolerance,
            timed(partial(go, "rigid_body", dt=OUTPUT, tolerance=tolerance)),
        )
        for tolerance in TOLERANCES
    ]
    cost = runs[0][3].seconds / scene.duration
    slow, rows = float("nan"), []
    if scene.explicit > 0.0:
        exact = go("rigid_body", scene.explicit, integrator="explicit")
        slow = exact.seconds / scene.explicit
        part = go("rigid_body", scene.explicit, dt=OUTPUT, tolerance=REFERENCE_TOLERANCE)
        rows.append(
            _row(scene.name, "rigid_body, explicit", 0.0, exact, part, scene.explicit, cost, slow)
        )
    rows += [
        _row(scene.name, f"{level}, {label}", 0.0, run, reference, scene.duration, cost, slow)
        for level, label, _, run in runs
    ]
    for level in ("pendulum", "contact"):
        for dt in (*STEPS, None):
            run = timed(partial(go, level, **options_of(dt)))
            rows.append(_row(scene.name, level, dt, run, reference, scene.duration, cost, slow))
    return Result(scene.name, scene.what, scene.uplift, reference, rows, features(scene, reference))


def without(bearing: LIRBearing, **changes: Any) -> LIRBearing:
    """Return a bearing with changes, its limits wide enough to see what an omission does."""
    return replace(bearing, slip_capacity=1.0, rim_overrun=1.0, **changes)


def features(scene: Scene, reference: Response) -> list[tuple[str, Errors]]:
    """Return the errors of the level 'pendulum' when something of the test case is left out."""
    bearing, motion = scene.bearing, scene.motion
    top = tuple(CoulombFriction(law.f_max) for law in bearing.frictions)
    cases: list[tuple[str, LIRBearing, GroundMotion]] = [
        ("nothing left out", bearing, motion),
        ("rims", without(bearing, capacity=float("inf"), rims=None), motion),
        ("interface (rigid slider)", without(bearing.as_dcfp()), motion),
        ("rims and interface", without(bearing.as_dcfp(rims=False)), motion),
        ("speed of friction (f_max)", without(bearing, friction=top), motion),
        ("vertical component", without(bearing), motion.scaled((1.0, 1.0, 0.0))),
        ("horizontal y", without(bearing), motion.scaled((1.0, 0.0, 1.0))),
    ]
    return [
        (name, errors(history(scene.model(b), m, scene.duration, dt=2e-3), reference))
        for name, b, m in cases
    ]


def sensitivity(scene: Scene) -> list[tuple[str, Errors]]:
    """Return how far the reference moves when a property that is assumed is changed."""
    own = scene.bearing.resolved()
    cases: list[tuple[str, dict[str, Any]]] = [
        ("4 contact points", {"contact_points": 4}),
        ("16 contact points", {"contact_points": 16}),
        ("sliders of a tenth of their mass", {"slider_density": 785.0}),
        ("axial stiffness / 4", {**kept_of(own), "axial_stiffness": 0.25 * own["axial_stiffness"]}),
        ("axial damping x 4", {"axial_damping": 4.0 * own["axial_damping"]}),
        ("rim stiffness / 4", {"rim_stiffness": 0.25 * own["rim_stiffness"]}),
        ("no rim damping", {"rim_damping": 0.0}),
    ]
    options = {"level": "rigid_body", "dt": OUTPUT, "tolerance": TOLERANCES[1]}
    base = history(scene.model(), scene.motion, scene.duration, **options)
    return [
        (
            name,
            errors(
                history(
                    scene.model(replace(scene.bearing, **changes)),
                    scene.motion,
                    scene.duration,
                    **options,
                ),
                base,
            ),
        )
        for name, changes in cases
    ]


def kept_of(resolved: dict[str, float]) -> dict[str, Any]:
    """Return the properties that must not follow a changed default."""
    names = ("axial_stiffness", "axial_damping", "rim_stiffness", "rim_damping", "design_load")
    return {name: resolved[name] for name in names}


def widths(scene: Scene) -> list[tuple[float, Errors]]:
    """Return the errors of the level 'pendulum' over the slider's radius, stiffness held."""
    found = []
    for factor in WIDTHS:
        radius = factor * scene.bearing.slider_radius
        bearing = replace(
            scene.bearing,
            slider_radius=radius,
            slip_capacity=0.15,
            rim_overrun=0.015,
            **kept_of(scene.bearing.resolved()),
        )
        model = scene.model(bearing)
        exact = history(
            model,
            scene.motion,
            scene.duration,
            level="rigid_body",
            dt=OUTPUT,
            tolerance=TOLERANCES[1],
        )
        run = history(model, scene.motion, scene.duration, dt=OUTPUT)
        found.append((radius, errors(run, exact)))
    return found


def static_loop() -> Result:
    """Run the paper's static test at all levels; the rig chooses its increments."""
    path, bearing = static_path(), static_bearing()
    duration = float(np.abs(np.diff(path)).sum()) / STATIC_SPEED

    def go(level: Any) -> Response:
        began = perf_counter()
        data = cyclic_test(bearing, path, axial_load=LOAD, velocity=STATIC_SPEED, level=level)
        return response(data, seconds=perf_counter() - began)

    reference = go("rigid_body")
    runs = [(level, timed(partial(go, level))) for level in ("pendulum", "contact")]
    rows = [
        _row(
            "static loop",
            level,
            None,
            run,
            reference,
            duration,
            reference.seconds / duration,
            float("nan"),
        )
        for level, run in runs
    ]
    what = "the paper's static test, two cycles of 185 mm under 150 kN"
    return Result("static loop", what, False, reference, rows, [])


def run_building() -> Result | None:
    """Run the demonstration's building; its reference is the level 'contact' at a small step."""
    parts = building()
    if parts is None:
        return None
    model, motion, duration = parts

    def go(level: Any, dt: float | None) -> Response:
        return history(model, motion, duration, level=level, **options_of(dt))

    reference = go("contact", BUILDING_REFERENCE)
    cost = reference.seconds / duration
    runs: list[tuple[str, Any, float | None]] = [
        *(("pendulum", "pendulum", dt) for dt in (*BUILDING_STEPS, None)),
        *(("contact at the corners", CORNERS, dt) for dt in BUILDING_STEPS[1:]),
        *(("contact", "contact", dt) for dt in BUILDING_STEPS[1:]),
    ]
    rows = [
        _row(
            "building",
            name,
            dt,
            timed(partial(go, level, dt)),
            reference,
            duration,
            cost,
            float("nan"),
        )
        for name, level, dt in runs
    ]
    what = "the demonstration: three storeys on nine bearings, Pacoima Dam 1971 times 0.8"
    lifts = bool(reference.axial.min() <= 0.0)
    return Result("building", what, lifts, reference, rows, [])


def _row(
    scene: str,
    level: str,
    dt: float | None,
    run: Response,
    reference: Response,
    duration: float,
    implicit: float,
    explicit: float,
) -> Row:
    share = run.seconds / duration
    return Row(
        scene=scene,
        level=level,
        dt=float("nan") if dt is None else dt,
        errors=errors(run, reference),
        seconds=run.seconds,
        share=share,
        implicit=implicit / share,
        explicit=explicit / share,
        status=run.status,
    )
