"""Plausibility of a frame under its permanent loads, and of a motion: doubts by name.

These checks need the equilibrium under gravity: pressures, settlements, periods. The bounds are
wide; a sentence appears if a number is probably in another unit.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError, ModelWarning
from frames.model.frame_data import FrameData
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import shown
from lir_element.device.sanity_checks import (
    LARGEST_PRESSURE,
    STRANGE_SHORTENING,
    USUAL_PRESSURE,
    pressure_remedy,
)
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY, meant

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.assembly.system import System
    from lir_element import LIRBearing

USUAL_LOAD_RATIO = (0.15, 6.0)
"""Load of all bearings over their design loads, if those are given [-]."""

DENSEST, LIGHTEST = 3000.0, 5.0
"""Mass above the bearings over its volume [kg/m3]: that of solid concrete, and a tenth of the
lightest steel hall's. For structures of more than `LEAST_SPAN` in each direction.
"""

LEAST_SPAN = 2.0

STRONG_GROUND, FEEBLE = 50.0, 1e-3
"""Peak ground acceleration above all recorded ones; one below which there is no doubt [m/s2]."""


class BearingLoad(NamedTuple):
    """A bearing under permanent loads."""

    name: str  # of the bearing
    axial_force: float  # compression positive [N]
    pressure: float  # on the slider's area [Pa]
    settlement: float  # closure of its axial contact [m]
    period: float  # of its pendulum [s]
    slip_stability: float
    """Slip of the interface that holds without rims [m]; infinite with the rigid slider."""
    slip_capacity: float  # slip at which the sliders' overlap ends [m]


def bearing_loads(system: System, axial_forces: FloatArray) -> tuple[BearingLoad, ...]:
    """Return the load of each bearing under permanent loads (n_bearings,)."""
    return tuple(
        BearingLoad(
            name=name,
            axial_force=float(force),
            pressure=float(force) / (math.pi * bearing.slider_radius**2),
            settlement=float(force) / bearing.resolved()["axial_stiffness"],
            period=bearing.period,
            slip_stability=bearing.slip_stability,
            slip_capacity=bearing.resolved()["slip_capacity"],
        )
        for (name, _, _, bearing), force in zip(system.bearings, axial_forces, strict=True)
    )


def isolated_period(system: System, axial_forces: FloatArray) -> float:
    """Return the period of the mass that the bearings carry as one pendulum [s]."""
    lengths = np.array([placed.bearing.effective_radius for placed in system.bearings])
    if system.gravity <= 0.0 or not axial_forces.sum() > 0.0:
        return math.inf
    stiffness = float((axial_forces / lengths).sum())
    return 2.0 * math.pi * math.sqrt(axial_forces.sum() / system.gravity / stiffness)


def held_periods(omega2: FloatArray, mass: FloatArray) -> tuple[float, ...]:
    """Return the periods of the structure with its bearings and plates held, longest first [s].

    Shapes: omega2, mass (n_e,).
    """
    modes = np.sort(omega2[(mass > 0.0) & (omega2 > 0.0)])
    return tuple((2.0 * math.pi / np.sqrt(modes)).tolist())


def sanity_warnings(
    system: System, axial_forces: FloatArray, periods: tuple[float, ...]
) -> tuple[str, ...]:
    """Return the unusual values of a frame in equilibrium, a sentence each.

    Shapes: axial_forces (n_bearings,).
    """
    loads = bearing_loads(system, axial_forces)
    devices = {placed.name: placed.bearing for placed in system.bearings}
    return (
        *_of_pressure(loads),
        *_of_settlement(loads, devices),
        *_of_design_loads(loads, devices),
        *_of_density(system, axial_forces),
        *_of_periods(periods, isolated_period(system, axial_forces)),
    )


def _of_pressure(loads: tuple[BearingLoad, ...]) -> list[str]:
    most = max(loads, key=lambda load: load.pressure)
    if most.pressure > LARGEST_PRESSURE:
        message = (
            f'bearing "{most.name}" carries {most.axial_force:.4g} N, {1e-6 * most.pressure:.3g} '
            f"MPa on its slider, more than any material: {pressure_remedy(most.pressure)}"
        )
        raise ModelError(message)
    middle = float(np.median([load.pressure for load in loads]))
    if USUAL_PRESSURE[0] <= middle <= USUAL_PRESSURE[1]:
        return []
    return [
        worded(
            "the sliders carry {middle:.3g} MPa under permanent loads (5 to 60 MPa is usual; "
            '"{name}": {axial_force:.4g} N): {remedy}',
            middle=1e-6 * middle,
            name=most.name,
            axial_force=most.axial_force,
            remedy=pressure_remedy(middle),
        )
    ]


def _of_settlement(loads: tuple[BearingLoad, ...], devices: dict[str, LIRBearing]) -> list[str]:
    def part(load: BearingLoad) -> float:
        return load.settlement / devices[load.name].slider_height

    most = max(loads, key=part)
    if part(most) <= STRANGE_SHORTENING:
        return []
    stiffness = devices[most.name].resolved()["axial_stiffness"]
    return [
        worded(
            'bearing "{name}" settles by {settlement:.3g} mm under {axial_force:.4g} N, '
            "{part:.3g} % of its slider's height: check the units of axial_stiffness = "
            "{stiffness:.4g} N/m (kN/mm?) and of the loads",
            name=most.name,
            settlement=1e3 * most.settlement,
            axial_force=most.axial_force,
            part=100.0 * part(most),
            stiffness=stiffness,
        )
    ]


def _of_design_loads(loads: tuple[BearingLoad, ...], devices: dict[str, LIRBearing]) -> list[str]:
    given = [load for load in loads if devices[load.name].design_load is not None]
    design = sum(devices[load.name].resolved()["design_load"] for load in given)
    if not given:
        return []
    ratio = sum(load.axial_force for load in given) / design
    if USUAL_LOAD_RATIO[0] <= ratio <= USUAL_LOAD_RATIO[1]:
        return []
    return [
        worded(
            "the bearings carry {ratio:.3g} times their design_load ({design:.4g} N in "
            "all): check the units of loads and masses (t or N for kg, kN for N) and of "
            "design_load [N]",
            ratio=ratio,
            design=design,
        )
    ]


def _of_density(system: System, axial_forces: FloatArray) -> list[str]:
    spans = np.ptp(system.coordinates, axis=0)
    if spans.min() < LEAST_SPAN or system.gravity <= 0.0:
        return []
    mass = float(axial_forces.sum()) / system.gravity
    density = mass / float(spans.prod())
    if LIGHTEST <= density <= DENSEST:
        return []
    what = "a weight in N for a mass in kg?" if density > DENSEST else "t for kg, kN for N?"
    return [
        worded(
            "the bearings carry {mass:.4g} kg on {x:.3g} x {y:.3g} x {z:.3g} m, "
            "{density:.3g} kg/m3 (buildings have 100 to 600): check the units of the "
            "masses ({what})",
            mass=mass,
            x=spans[0],
            y=spans[1],
            z=spans[2],
            density=density,
            what=what,
        )
    ]


def _of_periods(periods: tuple[float, ...], isolated: float) -> list[str]:
    if not periods or periods[0] <= max(isolated, 1.0):
        return []
    return [
        worded(
            "the fixed-base period is {fixed:.3g} s, the isolation period {isolated:.3g} "
            "s: check the units of stiffness (kN/m or kN/mm for N/m, MPa for Pa) and mass "
            "(N for kg)",
            fixed=periods[0],
            isolated=isolated,
        )
    ]


def motion_doubts(frame: FrameData, motion: GroundMotion) -> tuple[str, ...]:
    """Return the unusual values of a motion under a frame, a sentence each."""
    peak = float(np.hypot(*motion.components[:, :2].T).max())
    if peak > STRONG_GROUND:
        return (
            worded(
                "the motion's horizontal peak is {peak:.4g} m/s2 = {in_g:.3g} g, above any "
                "recorded ground motion: {hint}",
                peak=peak,
                in_g=peak / STANDARD_GRAVITY,
                hint=meant(peak, "m/s2", 0.2, 20.0),
            ),
        )
    least = min(
        (
            sum(law.f_min * r for law, r in zip(b.frictions, b.radii, strict=True))
            / b.effective_radius
            for b in (link.bearing for link in frame.bearings.values())
        ),
        default=0.0,
    )
    if FEEBLE < peak < 0.5 * least * frame.gravity:
        return (
            worded(
                "the bearings hardly slide: the horizontal peak, {peak:.3g} m/s2 = "
                "{in_g:.2g} g, is below half of the friction, {least:.3g} g. Check its unit "
                "({peak:.3g} g is {in_si:.3g} m/s2)",
                peak=peak,
                in_g=peak / STANDARD_GRAVITY,
                least=least,
                in_si=peak * STANDARD_GRAVITY,
            ),
        )
    return ()


def check_analysis(model: object, motion: object) -> None:
    """Refuse a model or motion that cannot be analysed, and warn of probable mistakes."""
    if isinstance(model, GroundMotion) and isinstance(motion, FrameData):
        msg = "the arguments are swapped: time_history(model, motion), the frame comes first"
        raise TypeError(msg)
    if not isinstance(model, FrameData):
        msg = f"model = {shown(model)} must be a Frame: time_history(model, motion)"
        raise TypeError(msg)
    if not isinstance(motion, GroundMotion):
        msg = (
            f"motion = {shown(motion)} must be a GroundMotion, such as GroundMotion(x=..., dt=0.01)"
        )
        raise TypeError(msg)
    for doubt in motion_doubts(model, motion):
        warnings.warn(doubt, ModelWarning, stacklevel=3)
