"""Random buildings brought into equilibrium under their weight: gravity must find it, and rest."""

from __future__ import annotations

import time
import warnings
from typing import TYPE_CHECKING

import numpy as np

from frames import GroundMotion, ModelError, Section, moment_frame, shear_building, time_history
from lir_element import AnalysisError, LIRBearing
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import log_uniform, random_bearing
from validation.fuzzing.checks import Report, check_gravity
from validation.fuzzing.scenes import storey_values

if TYPE_CHECKING:
    from frames import Frame

PRESSURES = (2e6, 4e8)
"""Lightest and heaviest loading of the sliders [Pa]."""
WEIGHT = 1e-3
"""Largest difference of the bearings' forces and the weight [-]."""
REST = 1e-6
"""Largest movement in a moment without motion, over the effective radius [-]."""
CONTACT_SHARE = 0.1


def random_building(seed: int, number: int) -> tuple[Frame, str]:
    """Draw a building on a grid of bearings, light to overloaded."""
    rng = np.random.default_rng((seed, number, 20))
    bays = (int(rng.integers(1, 4)), int(rng.integers(1, 4)))
    storeys, width = int(rng.integers(1, 7)), rng.uniform(3.0, 9.0, 2)
    places = [(ix, iy) for ix in range(bays[0] + 1) for iy in range(bays[1] + 1)]
    kinds = [_bearing(rng) for _ in range(int(rng.integers(1, 4)))]
    grid = {place: kinds[int(rng.integers(0, len(kinds)))] for place in places}
    area = bays[0] * width[0] * bays[1] * width[1]
    slider = np.mean([np.pi * device.slider_radius**2 for device in grid.values()])
    mass = float(len(grid) * slider * log_uniform(rng, *PRESSURES) / STANDARD_GRAVITY)
    if rng.random() < 0.7:
        side = float(rng.uniform(0.25, 0.7))
        frame = moment_frame(
            bays,
            storeys,
            bearing=grid,
            bay_width=(float(width[0]), float(width[1])),
            floor_load=mass / area / (storeys + 1),
            column=Section.box(side, side, 0.05 * side),
        )
        kind = "frame"
    else:
        masses, stiffness, base = storey_values(rng, mass)
        plan = (bays, (float(width[0]), float(width[1])))
        frame = shear_building(grid, masses, stiffness, base_mass=base, plan=plan)
        kind = "stick"
    for _ in range(int(rng.integers(0, 4))):  # loads that are not masses, downwards or aside
        node = str(rng.choice(sorted(set(frame.masses))))
        force = STANDARD_GRAVITY * mass * rng.uniform(0.0, 0.02, 3) * np.array([0.1, 0.1, -3.0])
        frame.add_load(node, [*force, 0.0, 0.0, 0.0])
    smallest = min(device.yield_displacement for device in grid.values())
    line = (
        f"{kind}, {bays[0]} x {bays[1]} bays, {storeys} storeys, {mass / 1e3:.3g} t, "
        f"{mass * STANDARD_GRAVITY / len(grid) / slider / 1e6:.3g} MPa, "
        f"smallest yield displacement {1e3 * smallest:.2g} mm"
    )
    return frame, line


def _bearing(rng: np.random.Generator) -> LIRBearing:
    device = random_bearing(rng, log_uniform(rng, 0.4, 4.0))
    values = {name: getattr(device, name) for name in device.__dataclass_fields__}
    values["yield_displacement"] = log_uniform(rng, 1e-7, 1e-3)
    values["interface_yield_displacement"] = log_uniform(rng, 1e-7, 1e-4)
    return LIRBearing(**values)


def try_building(seed: int, number: int) -> Report:
    """Bring a building into equilibrium and leave it alone for a moment."""
    began = time.process_time()
    with warnings.catch_warnings(action="ignore"):  # overloaded sliders are meant
        frame, line = random_building(seed, number)
    draw = np.random.default_rng((seed, number, 21)).random()
    level = "contact" if draw < CONTACT_SHARE else "pendulum"
    report = Report(number, f"{line}, {level}", "building", level)
    calm = GroundMotion(x=np.zeros(4), dt=0.01)
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            data = time_history(frame, calm, dt=0.01, level=level)
    except ModelError as refusal:
        report.outcome, report.message = "refused", str(refusal)
    except AnalysisError as failure:
        check_gravity(report, frame, failure)
    else:
        report.warnings = [str(entry.message) for entry in caught]
        report.outcome, report.message = data.attrs["status"], data.attrs["message"]
        weight = float(data["weight"])
        carried = -float(data["bearing_force"].sel(axis="z").isel(time=0).sum())
        if abs(carried / weight - 1.0) > WEIGHT:
            report.found("weight", carried / weight, "the bearings do not carry the weight")
        moved = data["node_displacement"] - data["node_displacement"].isel(time=0)
        share = float(np.abs(moved).max()) / float(data["length"].min())
        if share > REST:
            report.found("rest", share, f"moves by {share:.3g} L without a motion")
        if report.outcome != "ok":
            report.found("rest", 1.0, report.message)
    report.seconds = time.process_time() - began
    return report
