"""Claim: a macro-model of OpenSees elements agrees with the element until it has slipped.

    LIR_RECORDS=<folder of records> python -m validation.claims.opensees_macro_model

Sources: paper (COMPDYN 2023), sections 2.2 and 3.1, for the test cases; docs/theory.md, section 2, for
the closed forms of the element; the documentation of OpenSees for those of its elements.
"""

from __future__ import annotations

import math
import statistics
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from lir_element import cyclic_test
from lir_element.opensees import opensees
from lir_element.units import STANDARD_GRAVITY
from validation.claims.opensees_macro_runs import (
    SCENE_STEP,
    SCENES,
    SLIPS,
    Ended,
    Loop,
    Rim,
    draw_loops,
    draw_rims,
    scenes_runs,
    settings_runs,
)
from validation.claims.static_test import LOAD, STEP
from validation.opensees.model import ABOVE
from validation.opensees.trials import Device, Shaken, macro, pull, shake
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import (
    EXAMPLE_MASS,
    EXAMPLE_RECORD,
    REACH,
    example_bearing,
    static_bearing,
    static_path,
)

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from lir_element import LIRBearing
    from lir_element.layout import Floats
    from validation.opensees.trials import Maker

CLAIM = Claim(
    "opensees_macro_model",
    "A macro-model of OpenSees elements, compared with the element",
    "A macro-model of OpenSees elements agrees with the element up to the first slip; what differs "
    "after it follows from its arrangement",
    "derived; paper 2.2, 3.1",
    EXAMPLE_RECORD,
)
STEP_HISTORY = 0.002  # s, of both programs
DURATION = 20.0  # s
REPEATS = 5
CORNERS = (8, 16)
"""Directions of the gaps whose corners are measured; those of a square are out of reach."""
ANGLES = 13
"""Directions of pull between 0 and 90 degrees."""
BEFORE = 0.17  # m, short of the rims


def series_with_mu_h(bearing: LIRBearing, weight: float) -> Device:
    """Make the macro-model with the friction of the interface as it is."""
    made = macro(bearing, weight)
    ops = opensees()
    ops.remove("element", made.above[0])
    first = 2_000_000
    stiffness = bearing.interface_friction * weight / bearing.yield_displacement
    own = bearing.resolved()
    ops.frictionModel("Coulomb", first, bearing.interface_friction)
    ops.uniaxialMaterial("Elastic", first, 2.0 * own["axial_stiffness"])
    ops.uniaxialMaterial("Elastic", first + 1, 1.0)
    materials = ("-P", first, "-T", first + 1, "-My", first + 1, "-Mz", first + 1)
    place = (made.middle, ABOVE, first, stiffness)
    ops.element("flatSliderBearing", first, *place, *materials, "-orient", 0, 0, 1, 1, 0, 0)
    return Device((first,), made.middle)


MODELS: dict[str, Maker] = {
    "macro-model": macro,
    "restoring springs across": partial(macro, restoring="across"),
    "flat slider with μ_h itself": series_with_mu_h,
}


def loops(way: Floats) -> dict[str, Loop]:
    """Run the static cyclic test with the element and the macro-models along a path."""
    bearing = static_bearing()
    data = cyclic_test(bearing, way, LOAD)
    found = {
        "element": Loop(
            "element",
            way,
            data["bearing_force"].sel(axis="x")[:, 0].to_numpy() / LOAD,
            data["interface_slip"].sel(axis="x")[:, 0].to_numpy(),
        )
    }
    for name, make in MODELS.items():
        done = pull(make, bearing, LOAD, way)
        u = done.displacement[:, 0]
        found[name] = Loop(name, u, done.force[:, 0] / LOAD, u - done.middle[:, 0])
    return found


def pendulum_force(bearing: LIRBearing, u: float) -> float:
    """Return a singleFPBearing's force over load: H = N (m + u/L) with N = W + H u/L."""
    ratio = u / bearing.effective_radius
    sliding = bearing.effective_friction + ratio
    return sliding / (1.0 - sliding * ratio)


def element_force(bearing: LIRBearing, u: float) -> float:
    """Return the element's force over load there: ``tan(theta + atan m)``."""
    tilt = math.asin(u / bearing.effective_radius)
    return math.tan(tilt + math.atan(bearing.effective_friction))


def static_checks(found: dict[str, Loop]) -> list[Check]:
    """Check loops up to the first slip, and what the arrangement in series makes of them after."""
    bearing = static_bearing()
    ours, theirs = found["element"], found["macro-model"]
    across, plain = (found[name] for name in list(MODELS)[1:])
    limit, length = bearing.force_limit(1.0), bearing.effective_radius
    left, rest = theirs.slip[round(REACH / STEP)], theirs.slip[theirs.zero()]
    early = length * (bearing.interface_friction - bearing.effective_friction)
    return stated(f"""
        force at 170 mm, macro-model / element | closed forms of both, below | {pendulum_force(bearing, BEFORE) / element_force(bearing, BEFORE)} ± 0.3 % | {theirs.at(BEFORE) / ours.at(BEFORE)}
        displacement at the first slip, macro-model | element | {1e3 * ours.displacement[ours.first()]} mm ± 0.5 % | {1e3 * theirs.displacement[theirs.first()]}
        force at the first slip over load, macro-model | tan(θ + atan μ_h) | {limit} ± 0.5 % | {theirs.force[theirs.first()]}
        slip that the first way out leaves, macro-model | element | {1e3 * ours.slip[round(REACH / STEP)]} mm ± 2 % | {1e3 * left}
        force at zero on the way back, macro-model less element, over load | −s/L | {-rest / length} ± 2 % | {theirs.back() - ours.back()}
        the same with springs across, over −s/L | restoring force of U | < 0.02 | {abs((across.back() - ours.back()) * length / rest)}
        largest force over load, springs across | limit + s/L | {limit + left / length} ± 0.5 % | {across.force[: round(REACH / STEP) + 1].max()}
        displacement at the first slip, flat slider with μ_h itself | L (μ_h − m) | {1e3 * early} mm ± 5 % | {1e3 * plain.displacement[plain.first()]}
        """)


def rims() -> dict[str, Rim]:
    """Pull away from the centre in several directions until the interface slips."""
    bearing = static_bearing()
    angles = np.linspace(0.0, 0.5 * math.pi, ANGLES)
    found = {"element": Rim("element", angles, np.array([_ours(bearing, a) for a in angles]))}
    for n in (4, *CORNERS):
        make = partial(macro, directions=n)
        reach = np.array([_theirs(make, bearing, a) for a in angles])
        found[f"{n} gaps"] = Rim(f"macro-model, {n} gaps", angles, reach)
    return found


def _ray(bearing: LIRBearing, angle: float) -> Floats:
    reach = 1.45 * bearing.lateral_capacity
    along = np.arange(0.0, reach, STEP)
    return np.asarray(along[:, None] * np.array([math.cos(angle), math.sin(angle)]))


def _ours(bearing: LIRBearing, angle: float) -> float:
    way = _ray(bearing, angle)[: round(1.02 * bearing.lateral_capacity / STEP)]
    slip = cyclic_test(bearing, way, LOAD)["interface_slip_size"][:, 0].to_numpy()
    return float(np.linalg.norm(way[int(np.argmax(slip > SLIPS))]))


def _theirs(make: partial[Device], bearing: LIRBearing, angle: float) -> float:
    done = pull(make, bearing, LOAD, _ray(bearing, angle))
    slip = np.linalg.norm((done.displacement - done.middle)[:, :2], axis=1)
    slid = slip > SLIPS
    if not slid.any():  # the analysis stopped before
        return math.nan
    return float(np.linalg.norm(done.displacement[int(np.argmax(slid)), :2]))


def rim_checks(found: dict[str, Rim]) -> list[Check]:
    """Check where the rims are met: on a circle, and on polygons about it."""
    capacity = static_bearing().lateral_capacity
    ours = found["element"].reach
    results = stated(f"""
        displacement at the first slip over the direction, element: spread | circle | < 0.001 | {np.ptp(ours) / ours.mean()}
        """)
    for n in CORNERS:
        corner = math.pi / n
        reach = _theirs(partial(macro, directions=n), static_bearing(), corner)
        results += stated(f"""
        the same in a corner, {n} gaps | U_cap / cos(π/n) | {1e3 * capacity / math.cos(corner)} mm ± 0.5 % | {1e3 * reach}
        """)
    return results


def histories(motion: GroundMotion) -> tuple[xr.Dataset, Shaken]:
    """Run the example under the record with both."""
    bearing = example_bearing()
    ours = time_history(lumped_mass(bearing, EXAMPLE_MASS), motion, DURATION, dt=STEP_HISTORY)
    theirs = shake(macro, bearing, EXAMPLE_MASS, motion, duration=DURATION, dt=STEP_HISTORY)
    return ours, theirs


def moments(theirs: Shaken) -> tuple[float, float]:
    """Return the largest moment on node j over that on both, and the error of their sum."""
    bearing = example_bearing()
    both = theirs.moment[:, :, 1]
    lever = theirs.displacement + np.array([0.0, 0.0, bearing.height])
    couple = np.cross(lever, theirs.force)[:, 1]
    total = np.abs(both.sum(axis=1)).max()
    share = np.abs(both[:, 1]).max() / total
    return float(share), float(np.abs(both.sum(axis=1) + couple).max() / total)


def history_checks(ours: xr.Dataset, theirs: Shaken) -> list[Check]:
    """Check both under the record."""
    u = ours["bearing_displacement"].sel(axis="x")[:, 0].to_numpy()
    slip = ours["interface_slip"].sel(axis="x")[:, 0].to_numpy()
    own = ours["bearing_moment"].sel(axis="y")[:, 0].to_numpy()
    share, _ = moments(theirs)
    weight = EXAMPLE_MASS * STANDARD_GRAVITY
    ours_share = np.abs(own[:, 1]).max() / np.abs(own.sum(axis=1)).max()
    return stated(f"""
        Newhall, peak displacement, macro-model | element | {1e3 * np.abs(u).max()} mm ± 1 % | {1e3 * np.abs(theirs.displacement[:, 0]).max()}
        Newhall, slip at the end, macro-model | element | {1e3 * abs(slip[-1])} mm ± 3 % | {1e3 * abs(theirs.displacement[-1, 0] - theirs.middle[-1, 0])}
        Newhall, largest force over limit, macro-model | W tan(θ + atan μ_h) | < 1.005 | {np.abs(theirs.force[:, 0]).max() / example_bearing().force_limit(weight)}
        Newhall, largest moment on the superstructure over that on both ends, element | about half | 0.5 ± 10 % | {ours_share}
        the same, macro-model | P-Delta on node i alone | < 0.2 | {share}
        """)


def cost(motion: GroundMotion) -> tuple[float, float, float]:
    """Return microseconds a step of element and macro-model, and the ratio, medians."""
    pairs = []
    for _ in range(REPEATS):
        ours, theirs = histories(motion)
        pairs.append(
            (
                1e6 * ours.attrs["seconds_loop"] / ours.attrs["steps"],
                1e6 * theirs.seconds / theirs.steps,
            )
        )
    ratio = statistics.median(theirs / ours for ours, theirs in pairs)
    return statistics.median(p[0] for p in pairs), statistics.median(p[1] for p in pairs), ratio


def page(folder: Path | None) -> Page:
    """Run all and return the page."""
    assert folder is not None
    motion = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    found, shapes = loops(static_path()), rims()
    ours, theirs = histories(motion)
    results = [*static_checks(found), *rim_checks(shapes), *history_checks(ours, theirs)]
    scenes, orbits = scenes_runs()
    numbers = _numbers(found, ours, theirs, scenes)
    numbers["square"] = 1e3 * float(shapes["4 gaps"].reach[ANGLES // 2])
    numbers["capacity"] = 1e3 * static_bearing().lateral_capacity
    numbers |= dict(zip(("ours", "theirs", "ratio"), cost(motion), strict=True))
    body = render(
        globals(), n=numbers, scenes=scenes, settings=settings_runs(motion), step=SCENE_STEP
    )
    oblique = orbits["oblique rim contact"]
    shown = {
        "element": oblique["pendulum"],
        **{name: oblique[name] for name in oblique if name.startswith("macro")},
    }
    figures = {
        "loops": draw_loops(found),
        "rims": draw_rims(shapes, shown, example_bearing().lateral_capacity),
    }
    result = (
        f"Newhall: peak {1e3 * np.abs(theirs.displacement[:, 0]).max():.1f} against "
        f"{numbers['peak']:.1f} mm; after 10 mm of slip the force is off by "
        f"{numbers['offset']:.0f} % of the friction; with uplift "
        f"{1e3 * numbers['lifted']:.0f} against {1e3 * numbers['lifted reference']:.0f} mm; a step "
        f"costs {numbers['ratio']:.0f} times as much"
    )
    return Page(CLAIM, result, results, body, figures)


def _numbers(
    found: dict[str, Loop], ours: xr.Dataset, theirs: Shaken, scenes: list[Ended]
) -> dict[str, float]:
    """Return the numbers that the text names."""
    bearing = static_bearing()
    own = np.abs(ours["bearing_moment"].sel(axis="y")[:, 0].to_numpy()).max(axis=0)
    other = np.abs(theirs.moment[:, :, 1]).max(axis=0)
    left = found["macro-model"].slip[round(REACH / STEP)]
    friction = bearing.effective_friction
    ratio = pendulum_force(bearing, BEFORE) / element_force(bearing, BEFORE)
    peaks = {run.model: run.peak for run in scenes}
    newton, fallback = (f"macro-model, 16 gaps, {how}" for how in ("Newton", "with fallback"))
    exact = "element, level rigid_body"
    return {
        "apart": 100.0 * (ratio - 1.0),
        "early": 1e3 * bearing.effective_radius * (bearing.interface_friction - friction),
        "offset": 100.0 * left / bearing.effective_radius / friction,
        "corner 8": 100.0 * (1.0 / math.cos(math.pi / 8) - 1.0),
        "corner 16": 100.0 * (1.0 / math.cos(math.pi / 16) - 1.0),
        "compressed": 100.0
        * max(abs(peaks[name, newton] / peaks[name, exact] - 1.0) for name in SCENES[:2]),
        "lifted": peaks[SCENES[2], fallback],
        "lifted reference": peaks[SCENES[2], exact],
        "moment": 1e-3 * own[1],
        "moment i": 1e-3 * own[0],
        "their moment": 1e-3 * other[1],
        "their moment i": 1e-3 * other[0],
        "peak": 1e3 * float(np.abs(ours["bearing_displacement"].sel(axis="x")).max()),
        "slip": 1e3 * abs(float(ours["interface_slip"].sel(axis="x")[-1, 0])),
        "repeats": float(REPEATS),
    }


if __name__ == "__main__":
    run(CLAIM, page)
