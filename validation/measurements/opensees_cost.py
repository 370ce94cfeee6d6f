"""What a bearing costs inside OpenSees: writes docs/validation/opensees_cost.md.

    python -m validation.measurements.opensees_cost

Buildings of three sizes under one motion, on bearings of OpenSees and on ours by both couplings. All
that stand in one row of the tables are run in turn, several times; the ratios are medians of the
ratios within a turn, and hold on a noisy machine.
"""

from __future__ import annotations

import math
import os
import platform
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from frames import Frame, GroundMotion, gravity, lumped_mass, moment_frame, time_history
from frames.library.moment_frames import DEFAULT_BASE_BEAM, DEFAULT_BEAM, DEFAULT_COLUMN
from lir_element import CoulombFriction, LIRBearing
from lir_element.opensees import bearing_element, builtin_element, macro_model, opensees
from validation.cases import EXAMPLE_MASS, example_bearing
from validation.claims.opensees_building import slender
from validation.opensees.frames import add_loads, build
from validation.opensees.model import (
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Mapping

TARGET = Path(__file__).parents[2] / "docs" / "validation" / "opensees_cost.md"
TURNS = 3
STEPS, STEP = 1000, 0.005  # of the transient analysis, s
FAST_GOAL, PORTABLE_GOAL = 1.5, 3.0
BASE = "singleFPBearing"
MACRO = "LIR-DCFP, macro-model"
CONTACT_GOAL = 2.0  # times the level pendulum, of a whole step
BELOW = 0.55  # of the motion, under which no rim is met: plain Newton stops at none of the levels

Place: TypeAlias = Callable[[int, int, int, LIRBearing], object]
"""Puts an element with a tag between node i and node j, for a bearing."""


def pulse() -> GroundMotion:
    """Return the motion: a synthetic one of 2.5 s in three directions, then rest."""
    t = np.arange(0.0, STEPS * STEP, STEP)
    shaking = t < 2.5
    return GroundMotion(
        x=2.2 * np.sin(2.0 * np.pi * t / 1.6) * shaking,
        y=1.3 * np.sin(2.0 * np.pi * t / 1.1) * shaking,
        z=1.0 * np.sin(2.0 * np.pi * t / 0.3) * shaking,
        dt=STEP,
    )


def scenes(bearing: LIRBearing) -> dict[str, Frame]:
    """Return the structures, from one bearing to nine."""
    return {
        "a mass on one bearing": lumped_mass(bearing, EXAMPLE_MASS),
        "1 × 1 bay, 1 storey": slender_frame((1, 1), 1, bearing),
        "2 × 2 bays, 3 storeys": slender_frame((2, 2), 3, bearing),
    }


def ours(route: Any, level: Any = "pendulum") -> Place:
    """Return what puts our bearings, by a coupling and at a level."""
    return lambda tag, i, j, device: bearing_element(tag, i, j, device, route=route, level=level)


def devices(bearing: LIRBearing, load: float) -> dict[str, tuple[LIRBearing, Place]]:
    """Return the bearings that are compared, and what puts them into the model."""
    plain = bearing.as_dcfp(rims=False)

    def builtin(kind: Any) -> Place:
        return lambda tag, i, j, device: builtin_element(kind, tag, i, j, device, load)

    return {
        BASE: (plain, builtin(BASE)),
        "TripleFrictionPendulum": (plain, builtin("TripleFrictionPendulum")),
        "plain DCFP, in-process coupling": (plain, ours("fast")),
        "plain DCFP, out-of-process coupling": (plain, ours("portable")),
        "LIR-DCFP, in-process coupling": (bearing, ours("fast")),
        "LIR-DCFP, out-of-process coupling": (bearing, ours("portable")),
        MACRO: (bearing, lambda _, i, j, device: macro_model(device, i, j, load=load)),
    }


def microseconds(frame: Frame, place: Place, motion: GroundMotion) -> float:
    """Run a structure in OpenSees and return the time of a step of the transient analysis [us]."""
    with empty_model() as ops:
        add_loads(ops, frame, build(ops, frame, place))
        gravity_analysis(ops)
        ground_motion(ops, motion)
        solver(ops)
        transient_steps(ops)
        began = time.perf_counter()
        if ops.analyze(STEPS, STEP):
            return math.nan
        return 1e6 * (time.perf_counter() - began) / STEPS


def in_frames(frame: Frame, motion: GroundMotion) -> float:
    """Return the time of a step of the same length in `frames` [us]."""
    data = time_history(frame, motion, duration=STEPS * STEP, dt=STEP)
    return 1e6 * float(data.attrs["seconds_loop"]) / STEPS


def in_turns(runs: Mapping[str, Callable[[], float]]) -> dict[str, list[float]]:
    """Run all in turn and return what each gave; the first turn, which compiles, does not count."""
    found: dict[str, list[float]] = {name: [] for name in runs}
    for turn in range(TURNS + 1):
        for name, run in runs.items():
            value = run()
            if turn:
                found[name].append(value)
    return found


def measure(name: str, bearing: LIRBearing, motion: GroundMotion) -> dict[str, list[float]]:
    """Run all devices under one structure in turn; return the times by device."""
    load = float(gravity(scenes(bearing)[name]).axial_forces.mean())
    bearing = replace(bearing, design_load=load)
    runs = {
        device: partial(microseconds, scenes(kind)[name], place, motion)
        for device, (kind, place) in devices(bearing, load).items()
    }
    whole = partial(in_frames, scenes(bearing)[name], motion)
    return in_turns({**runs, "LIR-DCFP, the whole in frames": whole})


def page(found: Mapping[str, Mapping[str, list[float]]], at_contact: Mapping[str, float]) -> str:
    """Return the page in Markdown."""
    head = ["bearings", *(f"{name} [µs]" for name in found), *(f"ratio, {n}" for n in found)]
    rows = []
    for device in next(iter(found.values())):
        numbers = [statistics.median(each[device]) for each in found.values()]
        times = ["stops" if math.isnan(number) else f"{number:.0f}" for number in numbers]
        ratios = [ratio(each, device) for each in found.values()]
        rows.append([device, *times, *("-" if math.isnan(r) else f"{r:.2f}" for r in ratios)])
    return (
        "\n\n".join(
            [
                "# Cost of a bearing inside OpenSees",
                f"Written by `python -m validation.measurements.opensees_cost`, OpenSees "
                f"{opensees().version()}, Python "
                f"{platform.python_version()}, {os.cpu_count()} cores. Time of a step of the whole "
                f"transient analysis: {STEPS} steps of {1e3 * STEP:g} ms, Newmark, Newton's method to a "
                "norm of the correction of 1e-8, UmfPack; medians of "
                f"{TURNS} turns. Ratios to {BASE}. The LIR-DCFP meets its rims and slips; {BASE} and the "
                "plain DCFP have no rims.",
                table(head, rows),
                f"Goals in buildings: in-process coupling {FAST_GOAL:g}, out-of-process coupling {PORTABLE_GOAL:g}. "
                + " ".join(verdict(name, found[name]) for name in list(found)[1:]),
                f"A step at the level contact over one at the level pendulum, in-process, under "
                f"{BELOW:g} times the motion (goal {CONTACT_GOAL:g}): {contact_verdict(at_contact)}.",
                "An element of the out-of-process coupling waits for some four answers of another process an "
                'iteration; the smaller the rest of the model, the more that counts. "stops": plain '
                "Newton runs in circles in some step, as friction turns round or slips under a rim; "
                "`KrylovNewton` and `NewtonLineSearch` pass with the element (the macro-model asks for "
                "smaller steps, [opensees_macro_model.md](opensees_macro_model.md)). "
                "The last row is `time_history` of this package with the same step.",
            ]
        )
        + "\n"
    )


def verdict(name: str, times: Mapping[str, list[float]]) -> str:
    """Say whether the goals are met in a building."""
    parts = []
    for coupling, goal in (("in-process", FAST_GOAL), ("out-of-process", PORTABLE_GOAL)):
        worst = max(ratio(times, device) for device in times if f" {coupling} coupling" in device)
        parts.append(f"{coupling} {worst:.2f} ({'met' if worst <= goal else '**missed**'})")
    return f"{name}: {', '.join(parts)}."


def contact_ratio(name: str, bearing: LIRBearing, motion: GroundMotion) -> float:
    """Return what a step costs at the level 'contact', over the level 'pendulum', in-process."""
    load = float(gravity(scenes(bearing)[name]).axial_forces.mean())
    frame, weak = scenes(replace(bearing, design_load=load))[name], motion.scaled(BELOW)
    levels = ("pendulum", "contact")
    found = in_turns({k: partial(microseconds, frame, ours("fast", k), weak) for k in levels})
    return ratio(found, "contact", "pendulum")


def contact_verdict(ratios: Mapping[str, float]) -> str:
    """Say what the level 'contact' costs, and whether that is as little as is wanted."""
    return "; ".join(
        f"{value:.2f} ({'met' if value <= CONTACT_GOAL else '**missed**'}), {name}"
        for name, value in ratios.items()
    )


def ratio(times: Mapping[str, list[float]], device: str, base: str = BASE) -> float:
    """Return the median over the turns of the time over that of another device."""
    pairs = zip(times[device], times[base], strict=True)
    return statistics.median(a / b for a, b in pairs)


def slender_frame(bays: tuple[int, int], storeys: int, bearing: LIRBearing) -> Frame:
    """Return a moment frame without damping, its members without shear deformation."""
    return moment_frame(
        bays=bays,
        storeys=storeys,
        bearing=bearing,
        damping=None,
        column=slender(DEFAULT_COLUMN),
        beam=slender(DEFAULT_BEAM),
        base_beam=slender(DEFAULT_BASE_BEAM),
    )


def main() -> None:
    """Measure and write the page."""
    bearing = example_bearing(friction=CoulombFriction(0.065))
    motion = pulse()
    found = {name: measure(name, bearing, motion) for name in scenes(bearing)}
    at_contact = {name: contact_ratio(name, bearing, motion) for name in scenes(bearing)}
    TARGET.write_text(page(found, at_contact), encoding="utf-8")
    print(TARGET.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
