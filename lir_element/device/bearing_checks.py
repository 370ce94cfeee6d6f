"""Impossible and doubtful bearings: checked once, when they are made."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, cast

import numpy as np

from lir_element.argument_checks import as_pair, require_choice, require_type
from lir_element.device.friction import FrictionLaw
from lir_element.device.heating import FrictionHeating, PressureDependence
from lir_element.device.sanity_checks import (
    FLAT,
    LARGEST_PRESSURE,
    LARGEST_SHORTENING,
    LONGEST_PENDULUM,
    USUAL_PRESSURE,
    sanity_warnings,
    shortening,
    slider_area,
)
from lir_element.device.specification import BackupSupport
from lir_element.texts import TextWarning
from lir_element.units import meant

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lir_element.device.specification import Specification

LARGEST_SINE = 0.95
"""Largest sine of the slider's tilt at the rim; the kernels stop at 72 degrees."""


class DesignWarning(TextWarning):
    """A bearing that can be computed, but will not work as it is meant to.

    Examples
    --------
    >>> import warnings
    >>> from lir_element import LIRBearing
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08,
    ...                          capacity=0.175, friction=0.066, interface_friction=0.067)
    >>> str(told[0].message).split(": ")[1]
    'the interface slips before rim contact. Raise it unless this is intended'
    """


def check_bearing(bearing: Specification) -> None:
    """Refuse impossible combinations of a bearing's numbers, and warn of unusual ones."""
    _check_kinds(bearing)
    for part in (_of_geometry, _of_friction, _of_rims, _of_sliders, _of_forces):
        for msg in part(bearing):
            raise ValueError(msg)
    for doubt in (*_early_slip(bearing), *sanity_warnings(bearing)):
        warnings.warn(doubt, DesignWarning, stacklevel=4)


AT_RIGID_BODY = 'level = "rigid_body" does not support', 'level="contact"'
TO_OPENSEES = "the mapping to elements of OpenSees does not support", "bearing_element"
"""Words of `require_constant_friction`."""


def require_constant_friction(bearing: Specification, words: tuple[str, str]) -> None:
    """Refuse a bearing whose friction depends on pressure or temperature."""
    for name in ("pressure_dependence", "friction_heating"):
        if getattr(bearing, name) is not None:
            raise ValueError(_unknown(name, "None", words))


def require_lasting_rims(bearing: Specification, words: tuple[str, str]) -> None:
    """Refuse a bearing whose rims yield, or break and let the slider go on."""
    for name, value, none in (
        ("rim_yield_force", bearing.rim_yield_force, "math.inf"),
        ("flange", bearing.flange or math.inf, "None"),
    ):
        if math.isfinite(value) and math.isfinite(bearing.lateral_capacity):
            raise ValueError(_unknown(name, none, words))


def require_no_backup(bearing: Specification, words: tuple[str, str]) -> None:
    """Refuse a bearing whose failure does not end the analysis."""
    if bearing.backup is not None:
        raise ValueError(_unknown("backup", "None", words))


def _unknown(name: str, none: str, words: tuple[str, str]) -> str:
    # Program or law without the property, its alternative, and the bearing without the property.
    return (
        f"{words[0]} {name}: use {words[1]}, or a bearing without it, "
        f"dataclasses.replace(bearing, {name}={none})"
    )


def _check_kinds(bearing: Specification) -> None:
    pair: tuple[object, object] = as_pair("friction", bearing.friction)
    for law in pair:
        if not isinstance(law, FrictionLaw):
            msg = (
                f"friction = {law!r} is not a friction law: pass a number (0.05), "
                "CoulombFriction(mu), VelocityFriction(f_max, f_min, rate), your own "
                "FrictionLaw, or a pair (bottom, top) of these"
            )
            raise TypeError(msg)
        law.kernel_values()  # refuses values that kernels cannot use
    for name, kind, example in (
        ("pressure_dependence", PressureDependence, "PressureDependence()"),
        ("friction_heating", FrictionHeating, "FrictionHeating()"),
        ("backup", BackupSupport, "BackupSupport(drop=0.05)"),
    ):
        if (value := getattr(bearing, name)) is not None:
            require_type(name, value, kind, f"a {kind.__name__}, such as {example}")
    for name in ("torsional_friction", "allow_weak_interface"):
        require_type(name, getattr(bearing, name), bool, "True or False")
    require_choice("friction_law", bearing.friction_law, ("elastic-plastic", "bouc-wen"))


def _of_friction(bearing: Specification) -> Iterator[str]:
    mu_h, largest = bearing.interface_friction, max(law.f_max for law in bearing.frictions)
    if mu_h <= largest and not bearing.allow_weak_interface:
        yield (
            f"interface_friction = {mu_h:g} must exceed {largest:g}, the highest friction of "
            "the concave surfaces (design rule mu_h > mu_d): raise it, or set "
            "allow_weak_interface=True"
        )


def _early_slip(bearing: Specification) -> Iterator[str]:
    mu_h, least = bearing.interface_friction, bearing.effective_friction
    if mu_h <= least and not bearing.allow_weak_interface:
        yield (
            f"interface_friction = {mu_h:g} does not exceed (mu_1 R_1 + mu_2 R_2) / L = "
            f"{least:.4g}: the interface slips before rim contact. Raise it unless this is "
            "intended"
        )


def _of_geometry(bearing: Specification) -> Iterator[str]:
    flat = max(bearing.radii) >= FLAT
    if bearing.effective_radius > LONGEST_PENDULUM and not flat:
        radius = max(bearing.radii)
        yield (
            f"radius = {radius:g} m makes a pendulum of {bearing.period:.0f} s: "
            f"{meant(radius, 'm', 0.02, 15.0)}; a flat surface has {FLAT:g} m or more"
        )
    height, edge = bearing.slider_height, bearing.slider_radius
    if edge >= min(bearing.radii):
        yield (
            f"slider_radius = {edge:g} m does not fit a concave surface of radius "
            f"{min(bearing.radii):g} m: use a smaller slider or larger radii"
        )
    caps = sum(r - math.sqrt(r * r - edge * edge) for r in bearing.radii)
    if height <= caps:
        yield (
            f"slider_height = {height:g} m does not exceed the height of its two spherical "
            f"caps, {caps:.4g} m at slider_radius = {edge:g} m: use a higher or a slimmer "
            "slider"
        )
    if height >= sum(bearing.radii):
        yield (
            f"slider_height = {height:g} m must be below the sum of the radii, "
            f"{sum(bearing.radii):g} m: the effective radius R1 + R2 - h must be positive"
        )


def _of_rims(bearing: Specification) -> Iterator[str]:
    if bearing.capacity is None and bearing.rims is None:
        yield (
            "capacity is missing: give the lateral displacement at the first rim contact [m] "
            "(math.inf for a bearing without rims), or rims=(bottom, top)"
        )
    given, found = bearing.capacity, bearing.lateral_capacity
    twice = given is not None and bearing.rims is not None
    if twice and not math.isclose(given or 0.0, found, rel_tol=1e-6):
        yield (
            f"capacity = {given:g} m contradicts rims = {bearing.rims}, which give {found:g} m: "
            "give only one of them"
        )
    limit = LARGEST_SINE * bearing.effective_radius
    if math.isfinite(bearing.lateral_capacity) and bearing.lateral_capacity > limit:
        yield (
            f"capacity = {bearing.lateral_capacity:g} m lies beyond the spheres: it must not "
            f"exceed {LARGEST_SINE} L = {limit:.4g} m; use larger radii, or "
            f"{meant(bearing.lateral_capacity, 'm', 0.002, 0.5 * limit)}"
        )
    for name, reach, r in zip(
        ("bottom", "top"), bearing.rim_displacement, bearing.radii, strict=True
    ):
        if math.isfinite(reach) and reach + bearing.slider_radius >= r:
            yield (
                f"the slider does not fit the {name} plate: at its rim it reaches "
                f"{reach:.4g} + slider_radius {bearing.slider_radius:g} m, which must be below "
                f"the radius {r:g} m; reduce capacity or slider_radius"
            )
    # Both surfaces extend to the edge of a slider at the rim. At rest, one above the other, they
    # are closest at the edge of the smaller one. If they are displaced and raised, the gap only
    # grows.
    edge = min(bearing.rim_displacement) + bearing.slider_radius
    if not math.isfinite(edge):
        return
    rise = sum(r - math.sqrt(r * r - edge * edge) for r in bearing.radii)
    if bearing.slider_height <= rise:
        yield (
            f"slider_height = {bearing.slider_height:g} m is not above {rise:.4g} m, the "
            f"rise of both concave surfaces at the slider's edge, {edge:.4g} m from the axis: "
            "increase slider_height or radius, or reduce capacity"
        )


def _of_sliders(bearing: Specification) -> Iterator[str]:
    inertia: object = bearing.slider_inertia
    if inertia is not None:
        pairs = inertia if isinstance(inertia, tuple) else ()
        if [len(pair) if isinstance(pair, tuple) else 0 for pair in pairs] != [2, 2]:
            yield (
                f"slider_inertia = {inertia!r} must be two pairs (across, along) [kg m2]: pass "
                "one for the bottom and one for the top slider"
            )
    given: object = bearing.contact_points
    if given is None:
        return
    whole = isinstance(given, (int, np.integer)) and not isinstance(given, (bool, np.bool_))
    count = int(cast("int", given)) if whole else 0
    fits = 4 <= count <= 7 or (8 <= count <= 64 and count % 2 == 0)
    if not (fits or (count >= 96 and count % 32 == 0)):
        yield (
            f"contact_points = {given!r} is not supported: leave it out (discs in closed "
            "form), or use 4 to 7, an even number from 8 to 64, or a multiple of 32 from 96 "
            "on"
        )


def _of_forces(bearing: Specification) -> Iterator[str]:
    load = bearing.resolved()["design_load"]
    area = slider_area(bearing)  # of the smallest numbers 0
    pressure, usual = load / area if area > 0.0 else math.inf, USUAL_PRESSURE[1] * area
    if pressure > LARGEST_PRESSURE:
        yield (
            f"design_load = {load:g} N gives a slider pressure of {1e-6 * pressure:.3g} MPa, "
            f"above the strength of any material: use at most {usual:.2g} N, or check "
            f"slider_radius = {bearing.slider_radius:g} m"
        )
    yield from shortening(bearing, LARGEST_SHORTENING, ", more than the slider's height")
