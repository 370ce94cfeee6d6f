"""Plausibility of a bearing's numbers: impossible values, and unusual ones.

The bounds are wide: no model at a twentieth of the scale and no bearing of the largest bridges is
refused, or named. Values beyond them are probably in another unit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lir_element.argument_checks import as_pair
from lir_element.device.friction import VelocityFriction
from lir_element.texts import worded
from lir_element.units import meant

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lir_element.device.friction import FrictionLaw
    from lir_element.device.specification import Specification

LONGEST_PENDULUM, FLAT = 100.0, 1e5
"""Effective radius that nobody builds (a period of 20 s), and radius from which a surface is meant
to be flat [m]."""

LONG_PENDULUM = 16.0
"""Effective radius that is strange [m]: a period of 8 s."""

USUAL_PRESSURE = (0.2e6, 200e6)
"""Usual pressure on the slider's area under permanent load [Pa]: sliding materials carry 5 to 100
MPa, a model at a twentieth of the scale without added mass has 0.5 MPa.
"""

LARGEST_PRESSURE = 3e9
"""Pressure that no material carries [Pa]."""

LARGEST_SHORTENING, STRANGE_SHORTENING = 1.0, 0.2
"""Settlement under the design load over the slider's height: impossible, strange [-]."""

USUAL_PROPORTIONS = (0.02, 10.0)
"""Height over diameter of a slider [-]."""

HOLDS = 0.9
"""Stable limit of interface slip over the sliders' overlap, below which a design counts on more
than it has (docs/theory.md, Eq. 2.7). Of the published bearings it is 0.92 and 0.99."""

USUAL_DENSITY = (500.0, 25e3)
LARGEST_FRICTION = 0.4
SLOWEST_RATES = (1e-4, 0.11)
"""Rate parameters with which friction hardly depends on speed, as those in s/mm are [s/m]; lower
ones are meant to be none."""


def pressure_remedy(pressure: float) -> str:
    """Return the remedy for an unusual slider pressure, for the end of a sentence."""
    if pressure < USUAL_PRESSURE[0]:
        return "look at the units of load and mass (kN for N, t for kg) and at the slider's radius"
    return "look at the units of load and mass (N for kg) and at the slider's radius"


def sanity_warnings(bearing: Specification) -> tuple[str, ...]:
    """Return the unusual properties of a bearing, a sentence each; nothing for usual ones."""
    return (
        *_of_geometry(bearing),
        *_of_loads(bearing),
        *_of_friction(bearing),
        *_of_rims(bearing),
        *_of_slip(bearing),
    )


def _of_geometry(bearing: Specification) -> Iterator[str]:
    length = bearing.effective_radius
    if length > LONG_PENDULUM and max(bearing.radii) < FLAT:
        yield worded(
            "radius = {radius} m makes a pendulum of {period:.1f} s: {hint} if that is not meant",
            radius=bearing.radius,
            period=bearing.period,
            hint=meant(max(bearing.radii), "m", 0.02, 6.0),
        )
    proportions = bearing.slider_height / (2.0 * bearing.slider_radius)
    if not USUAL_PROPORTIONS[0] <= proportions <= USUAL_PROPORTIONS[1]:
        yield worded(
            "slider_height = {slider_height:g} m is {proportions:.2g} times the slider's diameter: "
            "check that both are in m",
            slider_height=bearing.slider_height,
            proportions=proportions,
        )
    for name, part in (("yield_displacement", 0.02), ("interface_yield_displacement", 0.005)):
        value = getattr(bearing, name)
        if value > part * length:
            yield worded(
                "{name} = {value:g} m is {share:.2g} % of the effective radius, too soft for "
                "friction: {hint}",
                name=name,
                value=value,
                share=100.0 * value / length,
                hint=meant(value, "m", 0.0, 0.005 * length),
            )
    if not USUAL_DENSITY[0] <= bearing.slider_density <= USUAL_DENSITY[1]:
        density = bearing.slider_density
        yield worded(
            "slider_density = {density:g} kg/m3 is outside the range of metals: {hint}",
            density=density,
            hint=meant(density, "kg/m3", *USUAL_DENSITY),
        )
    mass = 0.5 * 7850.0 * slider_area(bearing) * bearing.slider_height
    for value in as_pair("slider_mass", bearing.slider_mass):
        if value is None or 0.005 <= value / mass <= 200.0:
            continue
        yield worded(
            "slider_mass = {value:g} kg, but half a slider of steel has {mass:.3g} kg: {hint}",
            value=value,
            mass=mass,
            hint=meant(value, "kg", 0.1 * mass, 10.0 * mass),
        )


def _of_loads(bearing: Specification) -> Iterator[str]:
    load = bearing.resolved()["design_load"]
    pressure = load / slider_area(bearing)
    low, high = (limit * slider_area(bearing) for limit in USUAL_PRESSURE)
    if not low <= load <= high:
        yield worded(
            "design_load = {load:g} N makes a pressure of {pressure:.2g} MPa on the slider: {hint} "
            "if that is not meant",
            load=load,
            pressure=1e-6 * pressure,
            hint=meant(load, "N", 10.0 * low, high),
        )
        return
    yield from (
        worded("{doubt} if that is not meant", doubt=msg)
        for msg in shortening(bearing, STRANGE_SHORTENING)
    )


def shortening(bearing: Specification, part: float, why: str = "") -> Iterator[str]:
    """Yield that the design load shortens the slider by more than a part of its height."""
    options = bearing.resolved()
    load, stiffness = options["design_load"], options["axial_stiffness"]
    if load > part * stiffness * bearing.slider_height:
        least = load / (0.02 * bearing.slider_height)
        yield worded(
            "axial_stiffness = {stiffness:g} N/m settles by {settled:.3g} mm under the design load "
            "of {load:.4g} N{why}: {hint}",
            stiffness=stiffness,
            settled=1e3 * load / stiffness,
            load=load,
            why=why,
            hint=meant(stiffness, "N/m", least, 200.0 * least),
        )


def _of_friction(bearing: Specification) -> Iterator[str]:
    for law in dict.fromkeys(bearing.frictions):
        if law.f_max > LARGEST_FRICTION:
            yield worded(
                "friction of {f_max:g} is far above that of sliding materials, 0.01 to 0.2: "
                "give a pure number, 0.06 for 6 %",
                f_max=law.f_max,
            )
        rate = law.kernel_values().rate
        if law.f_max > law.f_min and SLOWEST_RATES[0] < rate < SLOWEST_RATES[1]:
            yield worded(
                "{law} = {rate:g} s/m leaves friction at f_min = {f_min:g} at all speeds of an "
                "earthquake: {hint}",
                law=_rate_of(law),
                rate=rate,
                f_min=law.f_min,
                hint=meant(rate, "s/m", 5.0, 500.0),
            )


def _rate_of(law: FrictionLaw) -> str:
    own = isinstance(law, VelocityFriction)
    return (
        "rate"
        if own
        else worded("steepest growth of {name} over its range", name=type(law).__name__)
    )


def _of_rims(bearing: Specification) -> Iterator[str]:
    options = bearing.resolved()
    edge = bearing.slider_radius
    for name, bound in (("slip_capacity", 300.0 * edge), ("rim_overrun", 50.0 * edge)):
        if options[name] > bound:
            yield worded(
                "{name} = {value:g} m is large for a slider of radius {edge:g} m: {hint} if "
                "that is not meant",
                name=name,
                value=options[name],
                edge=edge,
                hint=meant(options[name], "m", 0.0, 2.0 * edge),
            )
    yield from _of_rim_yield(bearing)
    strength = options["rim_stiffness"] * options["rim_overrun"]
    if strength < 0.02 * options["design_load"] and math.isfinite(bearing.lateral_capacity):
        least = 0.1 * options["design_load"] / options["rim_overrun"]
        yield worded(
            "rim_stiffness = {stiffness:g} N/m and rim_overrun = {overrun:g} m: the rim "
            "fails at {strength:.3g} N, far below the design load of {load:.3g} N: {hint}",
            stiffness=options["rim_stiffness"],
            overrun=options["rim_overrun"],
            strength=strength,
            load=options["design_load"],
            hint=meant(options["rim_stiffness"], "N/m", least, 200.0 * least),
        )


def _of_rim_yield(bearing: Specification) -> Iterator[str]:
    force, options = bearing.rim_yield_force, bearing.resolved()
    if math.isinf(force) or math.isinf(bearing.lateral_capacity):
        return
    load, elastic = options["design_load"], force / options["rim_stiffness"]
    if not 0.02 * load <= force <= 100.0 * load:
        yield worded(
            "rim_yield_force = {force:g} N does not suit a design load of {load:.3g} N: {hint}",
            force=force,
            load=load,
            hint=meant(force, "N", 0.02 * load, 100.0 * load),
        )
    if elastic >= options["rim_overrun"]:
        yield worded(
            "the rim fails before it yields: rim_yield_force = {force:g} N is reached at "
            "{elastic:.3g} m, rim_overrun = {overrun:g} m. Raise rim_overrun, or leave "
            "rim_yield_force out",
            force=force,
            elastic=elastic,
            overrun=options["rim_overrun"],
        )


def _of_slip(bearing: Specification) -> Iterator[str]:
    holds, overlap = bearing.slip_stability, bearing.resolved()["slip_capacity"]
    without = bearing.allow_weak_interface or math.isinf(bearing.lateral_capacity)
    if without or not 0.0 < holds < HOLDS * overlap:
        return
    needed = (overlap / bearing.effective_radius) + bearing.effective_friction
    yield worded(
        "interface_friction = {mu:g} keeps the interface stable without rim contact up "
        "to {holds:.3g} mm of slip (slip_stability), below the overlap of {overlap:.3g} mm: "
        "raise it to {needed:.3g}, or limit the slip to {holds:.3g} mm",
        mu=bearing.interface_friction,
        holds=1e3 * holds,
        overlap=1e3 * overlap,
        needed=needed,
    )


def slider_area(bearing: Specification) -> float:
    """Return the area of the slider in plan [m2]."""
    return math.pi * bearing.slider_radius**2
