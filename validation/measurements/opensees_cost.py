"""What a bearing costs inside OpenSees: writes docs/validation/opensees_cost.md.

    python -m validation.measurements.opensees_cost

Buildings under one motion, on bearings of OpenSees and on ours by both couplings: of three sizes by
Newton's method, which often stops, and frames on 4, 9 and 25 bearings by KrylovNewton. All that stand
in one column of the tables are run in turn, several times; the ratios are medians of the ratios
within a turn, and hold on a noisy machine.
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
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from frames import Frame, GroundMotion, gravity, lumped_mass, moment_frame, time_history
from frames.library.models import DEFAULT_BASE_BEAM, DEFAULT_BEAM, DEFAULT_COLUMN
from lir_element import CoulombFriction, LIRBearing
from lir_element.opensees import bearing_element, builtin_element, macro_model, opensees
from validation.claims.opensees_building import slender
from validation.opensees.frames import add_loads, build
from validation.opensees.model import (
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)
from validation.page import FOLDER, render, table
from validation.scenes import EXAMPLE_MASS, example_bearing

if TYPE_CHECKING:
    from collections.abc import Mapping

TARGET = FOLDER / "opensees_cost.md"
TURNS = 3
STEPS, STEP = 1000, 0.005  # of the transient analysis, s
FAST_GOAL, PORTABLE_GOAL = 1.5, 3.0
BASE: Final = "singleFPBearing"
MACRO = "LIR-DCFP, macro-model"
CONTACT_GOAL = 2.0  # times the level pendulum, of a whole step
FRAMES = {
    "4 bearings, 1 storey": ((1, 1), 1),
    "9 bearings, 3 storeys": ((2, 2), 3),
    "25 bearings, 1 storey": ((4, 4), 1),
}
"""Frames by KrylovNewton: numbers of bays and storeys."""
FRAME_STEPS, FRAME_STEP = 600, 0.002
HALVINGS = 6  # of a step that fails

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


def levels(bearing: LIRBearing, load: float) -> dict[str, tuple[LIRBearing, Place]]:
    """Return the bearings under the frames, the LIR-DCFP at both levels."""
    kept = {
        name: each
        for name, each in devices(bearing, load).items()
        if name == BASE or name.startswith("plain")
    }
    for level in ("pendulum", "contact"):
        for route, coupling in (("fast", "in-process"), ("portable", "out-of-process")):
            name = f"LIR-DCFP at level {level}, {coupling} coupling"
            kept[name] = bearing, ours(route, level)
    return kept


def set_up(
    ops: Any, frame: Frame, place: Place, motion: GroundMotion, algorithm: str = "Newton"
) -> None:
    """Write a structure into an empty model, and bring it to the start of its transient analysis."""
    add_loads(ops, frame, build(ops, frame, place))
    gravity_analysis(ops)
    ground_motion(ops, motion)
    solver(ops)
    ops.algorithm(algorithm)
    transient_steps(ops)


def microseconds(
    frame: Frame, place: Place, motion: GroundMotion, algorithm: str = "Newton"
) -> float:
    """Run a structure in OpenSees and return the time of a step of the transient analysis [us]."""
    with empty_model() as ops:
        set_up(ops, frame, place, motion, algorithm)
        began = time.perf_counter()
        if algorithm == "Newton":
            steps, done = STEPS, ops.analyze(STEPS, STEP) == 0
        else:
            steps, done = FRAME_STEPS, all(stepped(ops, FRAME_STEP) for _ in range(FRAME_STEPS))
        return 1e6 * (time.perf_counter() - began) / steps if done else math.nan


def stepped(ops: Any, step: float, halvings: int = HALVINGS) -> bool:
    """Advance by a step, in halves where it fails; return whether that was possible."""
    if ops.analyze(1, step) == 0:
        return True
    return halvings > 0 and all(stepped(ops, 0.5 * step, halvings - 1) for _ in range(2))


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


def measure_frame(name: str, bearing: LIRBearing, motion: GroundMotion) -> dict[str, list[float]]:
    """Run a frame on its bearings in turn by KrylovNewton; return the times by device."""
    bays, storeys = FRAMES[name]
    load = float(gravity(slender_frame(bays, storeys, bearing)).axial_forces.mean())
    bearing = replace(bearing, design_load=load)
    runs = {
        device: partial(
            microseconds, slender_frame(bays, storeys, kind), place, motion, "KrylovNewton"
        )
        for device, (kind, place) in levels(bearing, load).items()
    }
    return in_turns(runs)


def ratios(found: Mapping[str, Mapping[str, list[float]]]) -> str:
    """Return the table of times and of ratios to the bearing of OpenSees."""
    head = ["bearings", *(f"{name} [µs]" for name in found), *(f"ratio, {n}" for n in found)]
    rows = []
    for device in next(iter(found.values())):
        numbers = [statistics.median(each[device]) for each in found.values()]
        times = ["stops" if math.isnan(number) else f"{number:.0f}" for number in numbers]
        shares = [ratio(each, device) for each in found.values()]
        rows.append([device, *times, *("-" if math.isnan(r) else f"{r:.2f}" for r in shares)])
    return table(head, rows)


def page(
    found: Mapping[str, Mapping[str, list[float]]], framed: Mapping[str, Mapping[str, list[float]]]
) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        found=found,
        framed=framed,
        opensees=opensees().version(),
        os=os,
        platform=platform,
    )


def verdict(name: str, times: Mapping[str, list[float]]) -> str:
    """Say whether the goals are met in a building."""
    parts = []
    for coupling, goal in (("in-process", FAST_GOAL), ("out-of-process", PORTABLE_GOAL)):
        worst = max(ratio(times, device) for device in times if f" {coupling} coupling" in device)
        parts.append(f"{coupling} {worst:.2f} ({'met' if worst <= goal else '**missed**'})")
    return f"{name}: {', '.join(parts)}."


def contact_verdict(framed: Mapping[str, Mapping[str, list[float]]]) -> str:
    """Say what the level 'contact' costs, and whether that is as little as is wanted."""
    contact, pendulum = (
        f"LIR-DCFP at level {level}, in-process coupling" for level in ("contact", "pendulum")
    )
    shares = {name: ratio(times, contact, pendulum) for name, times in framed.items()}
    return "; ".join(
        f"{value:.2f} ({'met' if value <= CONTACT_GOAL else '**missed**'}), {name}"
        for name, value in shares.items()
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
    framed = {name: measure_frame(name, bearing, motion) for name in FRAMES}
    TARGET.write_text(page(found, framed), encoding="utf-8")
    print(TARGET.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
