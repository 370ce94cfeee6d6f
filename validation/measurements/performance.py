"""Speed of the element and of time histories, measured: writes docs/validation/performance.md.

    python -m validation.measurements.performance

Medians of several runs; ratios hold on a noisy machine, single times do not. Compile times are
taken in child processes with an empty and with a filled kernel cache.
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess  # runs this interpreter on the lines below  # noqa: S404
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
from scipy.stats import uniform

from frames import (
    Analysis,
    Frame,
    GroundMotion,
    Section,
    gravity,
    lumped_mass,
    moment_frame,
    shear_building,
    time_history,
)
from frames._jit import kernel
from frames.laws import Bilinear, PlasticHinge
from frames.risk import Campaign, latin_hypercube
from lir_element import CoulombFriction, LIRBearing
from lir_element.bundles.contact_data import (
    Contacts,
    as_rows,
    contact_arrays,
    heat_parts,
    initial_state,
)
from lir_element.device.features import Level
from lir_element.kernels.levels import bearing_commit, bearing_tangent, bearing_trial
from lir_element.layout import WORK, Floats, Records, Words
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.benchmark_models import Structure, strong
from validation.page import FOLDER, render
from validation.scenes import example_bearing

REPEATS, FEW_REPEATS = 7, 3
STATES = ("linear", "elastic", "yielding")
TARGET = FOLDER / "performance.md"

MANY_STOREYS, MANY_STEP, MANY_SECONDS = 10, 0.01, 4.0  # -, s, s

BELOW = example_bearing(slider_radius=0.12)

START = "import numpy as np; from lir_element import *; "
ELEMENT = START + (
    "e = Element(LIRBearing(radius=1.0, slider_height=0.1, slider_radius=0.1, capacity=0.2, "
    "friction=CoulombFriction(0.05), interface_friction=0.1)); e.tangent_stiffness(); e.commit()"
)
HISTORY = START + (
    "from frames import *; b = LIRBearing(radius=1.0, slider_height=0.1, slider_radius=0.1, "
    "capacity=0.2, friction=CoulombFriction(0.05), interface_friction=0.1); "
    "time_history(lumped_mass(b, 1e5), GroundMotion(x=np.ones(20), dt=0.005))"
)


@kernel
def repeat_element(
    props: Records,
    old: Records,
    new: Records,
    old_words: Words,
    new_words: Words,
    work: Records,
    heat: Floats,
    contacts: Contacts | None,
    path: Floats,
    v: Floats,
    dt: float,
    with_tangent: bool,
    k: Floats,
) -> int:
    """Run trial (, tangent) and commit along `path` (n, 12), speeds `v`; returns the iterations."""
    total = 0
    for step in range(path.shape[0]):
        bearing_trial(props, old, new, work, contacts, 0, path[step], v, (step + 1) * dt)
        if with_tangent:
            bearing_tangent(props, new, work, contacts, 0, k)
        bearing_commit(props, old, new, old_words, new_words, heat, contacts, 0)
        total += old[0].iterations
    return total


class Study(NamedTuple):
    """A study that is measured: a model, or a function of parameters, and what changes."""

    name: str
    model: Any
    more: dict[str, Any]
    sets: int
    scales: tuple[float, ...] = (1.0,)


def stiffer(parameters: dict[str, float]) -> Frame:
    """Return the demo building on bearings of other friction, with other columns."""
    below = replace(BELOW, friction=CoulombFriction(parameters["friction"]))
    column = Section.rectangle(0.4, 0.4, elastic_modulus=parameters["modulus"])
    return moment_frame(bays=(2, 2), storeys=3, bearing=below, column=column)


STUDIES = (
    Study(
        "one bearing: friction, radius",
        lumped_mass(example_bearing(), 204e3),
        {"radius": uniform(0.75, 0.1)},
        60,
    ),
    Study(
        "one bearing: friction, 20 scales each",
        lumped_mass(example_bearing(), 204e3),
        {},
        3,
        tuple(np.linspace(0.2, 1.0, 20)),
    ),
    Study(
        "3 storeys, 9 bearings: friction",
        moment_frame(bays=(2, 2), storeys=3, bearing=BELOW),
        {},
        5,
    ),
    Study("the same: friction, columns", stiffer, {"modulus": uniform(2.6e10, 8e9)}, 5),
)


def element_path(bearing: LIRBearing, count: int, reach: float) -> Floats:
    """Return displacements (count, 12): an orbit of radius `reach`, plates tilting slightly."""
    t = np.linspace(0.0, 4.0 * np.pi, count)
    path = np.zeros((count, 12))
    path[:, 6] = reach * np.sin(t) * np.minimum(t, 1.0)
    path[:, 7] = 0.6 * reach * np.sin(0.7 * t)
    path[:, 3], path[:, 10] = 1e-3 * np.sin(t), 1e-3 * np.cos(t)
    squeeze = bearing.resolved()["design_load"] / bearing.resolved()["axial_stiffness"]
    length = bearing.effective_radius
    path[:, 8] = length - squeeze - np.sqrt(length**2 - path[:, 6] ** 2 - path[:, 7] ** 2)
    return path


def element_microseconds(
    bearing: LIRBearing, reach: float, level: Level, *, tangent: bool
) -> tuple[float, float]:
    """Return microseconds and inner iterations a state determination, medians."""
    path = element_path(bearing, 20000 if level == "pendulum" else 4000, reach)
    props = bearing.to_record()
    times, iterations = [], 0
    for _ in range(REPEATS):
        old, new = initial_state(props), initial_state(props)
        contacts = None
        if level == "contact":
            contacts = contact_arrays([bearing], [True], STANDARD_GRAVITY)
        began = time.process_time()
        iterations = repeat_element(
            props,
            old,
            new,
            as_rows(old),
            as_rows(new),
            np.zeros(1, dtype=WORK),
            heat_parts(props),
            contacts,
            path,
            np.zeros(12),
            0.001,
            tangent,
            np.zeros((12, 12)),
        )
        times.append((time.process_time() - began) / len(path) * 1e6)
    return statistics.median(times[1:]), iterations / len(path)


def near_fault(scale: float) -> GroundMotion:
    """Return a made three-component pulse motion of 10 s (a record is not needed for timing)."""
    t = np.arange(0.0, 10.0, 0.01)
    envelope = np.minimum(t / 2.0, 1.0) * np.minimum((10.0 - t) / 4.0, 1.0)
    rng = np.random.default_rng(1)
    x, y, z = [
        scale * a * envelope * (np.sin(2 * np.pi * t / p) + 0.15 * rng.normal(size=len(t)))
        for a, p in ((1.7, 1.6), (1.2, 2.1), (0.8, 0.25))
    ]
    return GroundMotion(x, y, z, dt=0.01, name="made pulse")


def run_microseconds(model: Any, dt: float) -> tuple[float, dict[str, Any]]:
    """Return microseconds a step of the time loop (median), and the last run's attributes."""
    times, attributes = [], {}
    for _ in range(REPEATS):
        attributes = time_history(model, near_fault(1.0), dt=dt).attrs
        times.append(attributes["seconds_loop"] / attributes["steps"] * 1e6)
    return statistics.median(times[1:]), attributes


def start_seconds(code: str, folder: str) -> float:
    """Return the seconds of CPU of a new process for `code`, kernels cached in `folder`."""
    told = subprocess.run(  # noqa: S603
        [sys.executable, "-c", f"{code}; import time; print(time.process_time())"],
        check=True,
        env={**os.environ, "LIR_CACHE_DIR": folder},
        stdout=subprocess.PIPE,
        text=True,
    )
    return float(told.stdout.split()[-1])


def compile_rows() -> list[str]:
    """Measure cold and cached starts."""
    rows = []
    for name, code in (("element", ELEMENT), ("time history", HISTORY)):
        with tempfile.TemporaryDirectory() as folder:
            cold = start_seconds(code, folder)
            cached = statistics.median(start_seconds(code, folder) for _ in range(3))
        imports = statistics.median(
            start_seconds(code.split("; ")[1] + "; import frames", folder) for _ in range(3)
        )
        rows.append(f"| {name} | {cold:.1f} | {cached:.2f} | {imports:.2f} |")
    return rows


def element_rows() -> list[str]:
    """Measure the element's state determination."""
    rows = []
    example = example_bearing(slip_capacity=1.0)
    cases: list[tuple[str, LIRBearing, float, Level]] = [
        ("LIR-DCFP, sliding", example_bearing(), 0.2, "pendulum"),
        ("LIR-DCFP, rim contact and interface slip", example, 0.3, "pendulum"),
        (
            "LIR-DCFP, Bouc-Wen friction, sliding",
            example_bearing(friction_law="bouc-wen"),
            0.2,
            "pendulum",
        ),
        ("DCFP, sliding", example_bearing().as_dcfp(), 0.2, "pendulum"),
        ("LIR-DCFP, sliding", example_bearing(), 0.2, "contact"),
        (
            "the same, 4 contact points an interface",
            example_bearing(contact_points=4),
            0.2,
            "contact",
        ),
        ("LIR-DCFP, rim contact and interface slip", example, 0.3, "contact"),
    ]
    for name, bearing, reach, level in cases:
        with_tangent, iterations = element_microseconds(bearing, reach, level, tangent=True)
        alone, _ = element_microseconds(bearing, reach, level, tangent=False)
        rows.append(f"| {level} | {name} | {alone:.2f} | {with_tangent:.2f} | {iterations:.1f} |")
    return rows


def run_rows() -> list[str]:
    """Measure the time loop."""
    rows = []
    building = moment_frame(bays=(2, 2), storeys=3, bearing=example_bearing(slider_radius=0.12))
    tower = moment_frame(bays=(3, 3), storeys=8, bearing=example_bearing())
    for name, model in (
        ("one bearing, lumped mass", lumped_mass(example_bearing(), 204e3)),
        ("demo building: 3 storeys, 9 bearings", building),
        ("8 storeys, 16 bearings", tower),
    ):
        count = len(gravity(model).basis.bearing_dofs)
        for dt in (0.005, 0.001):
            cost, run = run_microseconds(model, dt)
            rows.append(
                f"| {name} | {run['degrees_of_freedom']} ({count}) | {dt:g} | {cost:.1f} | "
                f"{run['newton_iterations'] / run['steps']:.2f} | {cost * 1e-6 / dt:.4f} |"
            )
    return rows


def yielding_models() -> dict[str, dict[str, Any]]:
    """Return buildings by name, each linear, with parts that stay elastic and that yield."""
    below = example_bearing(slider_radius=0.12)
    thick = example_bearing(slider_radius=0.25, slider_height=0.25)

    def frame(moment: float | None) -> Any:
        if moment is None:
            return moment_frame(bays=(2, 2), storeys=3, bearing=below)
        beam = PlasticHinge(moment_y=moment)
        column = PlasticHinge(moment_y=1.5 * moment, moment_z=1.5 * moment)
        hinges = {"beam": beam, "column": column}
        return moment_frame(bays=(2, 2), storeys=3, bearing=below, hinges=hinges)

    def stick(force: float | None) -> Any:
        def law(k: float) -> Bilinear:
            assert force is not None
            return Bilinear(stiffness=k, yield_force=force, hardening=0.02)

        return shear_building(
            thick, 3e5, 4e8, storeys=3, base_mass=3e5, storey_law=None if force is None else law
        )

    return {
        "demo building, 126 hinges": dict(zip(STATES, map(frame, (None, 1e9, 1.5e5)), strict=True)),
        "shear building of 3 storeys": dict(zip(STATES, map(stick, (None, 1e9, 5e5)), strict=True)),
    }


def yielding_rows() -> list[str]:
    """Measure the time loop of structures that yield; linear and yielding ones take turns."""
    rows = []
    for name, models in yielding_models().items():
        for dt in (0.005, 0.001):
            times: dict[str, list[float]] = {state: [] for state in models}
            for _ in range(REPEATS):
                for state, model in models.items():
                    data = time_history(model, near_fault(1.0), dt=dt)
                    cost = data.attrs["seconds_loop"] / data.attrs["steps"]
                    times[state].append(1e6 * cost)
            found = [statistics.median(times[state][1:]) for state in STATES]
            ratio = found[2] / found[0]
            cells = " | ".join(f"{one:.1f}" for one in found)
            rows.append(f"| {name} | {dt:g} | {cells} | {ratio:.1f} | {_yielded(data)} |")
    return rows


def _yielded(data: Any) -> str:
    if "hinge_turn" in data:
        turned = data["hinge_turn"].to_numpy()[-1]
        return f"{(turned > 0.0).sum()} hinges, up to {1e3 * turned.max():.0f} mrad run through"
    reached = np.abs(data["link_deformation"] / data["link_yield_deformation"]).max("time")
    return f"{int((reached > 1.0).sum())} links, ductility up to {float(reached.max()):.0f}"


def many_rows() -> list[str]:
    """Return a row a case: unknowns, vectors, microseconds a step, milliseconds a second."""
    rows = []
    for side, method in product((6, 10, 16), ("direct", "reduced")):
        one = Structure(f"{side**2} bearings", "d", (side - 1, side - 1), MANY_STOREYS)
        frame = one.frame(one.bearing())
        if method == "direct":  # set up once
            run = Analysis(frame).run
        else:
            run = partial(time_history, frame, method="reduced")
        given = strong(MANY_SECONDS), MANY_SECONDS, MANY_STEP
        runs = [run(*given).attrs for _ in range(FEW_REPEATS)]
        spent, found = statistics.median(run["seconds_loop"] for run in runs), runs[0]
        rows.append(
            f"| {side**2} | {found['degrees_of_freedom']} | {method} | {found['modes']} "
            f"| {1e6 * spent / found['steps']:.0f} | {1e3 * spent / MANY_SECONDS:.0f} "
            f"| {found['newton_iterations'] / found['steps']:.1f} | {found['tangents']}, "
            f"{found['shared_tangents']} | {found['seconds_gravity']:.1f} |"
        )
    return rows


def study_seconds(study: Study, duration: float) -> float:
    """Return seconds of CPU a run of a campaign with one worker, without what it begins with."""
    found = []
    for count in (study.sets, 3 * study.sets):
        sample = latin_hypercube({"friction": uniform(0.04, 0.04), **study.more}, count, seed=1)
        with tempfile.TemporaryDirectory() as folder:
            whole = Campaign(
                study.model,
                near_fault(0.4),
                store=Path(folder) / "runs",
                sample=sample,
                scales=study.scales,
                duration=duration,
            )
            began = time.process_time()
            whole.run(workers=1)
            found.append(time.process_time() - began)
    return (found[1] - found[0]) / (2 * study.sets * len(study.scales))


def study_rows() -> list[str]:
    """Measure what a run of a study costs: all of it, and with two steps in place of the motion."""
    rows = []
    for study in STUDIES:
        whole, rest = (
            statistics.median(1e3 * study_seconds(study, duration) for _ in range(FEW_REPEATS))
            for duration in (10.0, 0.01)
        )
        rows.append(
            f"| {study.name} | {whole:.1f} | {rest:.1f} | {rest / (whole - rest):.2f} | "
            f"{whole * 10_000 / 60_000:.1f} |"
        )
    return rows


def write() -> str:
    """Measure everything and return the page."""
    return render(globals(), numba=numba, platform=platform)


if __name__ == "__main__":
    page = write()
    TARGET.write_text(page, encoding="utf-8")
    print(page)
