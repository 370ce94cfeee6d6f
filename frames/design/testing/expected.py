"""Expected results of a bearing on a testing rig: forces, and the loop of a cycle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.design.codes.pendulum import FrictionPendulum
from lir_element import LIRBearing

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.codes.bounds import PropertyBounds, PropertyModificationFactors
    from frames.design.codes.prototype_programme import PlannedTest
    from lir_element.device.friction import FrictionLaw

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


class Loop(NamedTuple):
    """A cycle of harmonic motion about the centre; NaN if a test has no displacement."""

    stiffness: float  # effective: force at the end over the displacement [N/m]
    energy: float  # dissipated per cycle, EDC [J]
    friction: float  # E / (4 N d) [-]


LOOPS = tuple(
    f"{name}, {which} [{unit}]"
    for name, unit in (("k_eff", "N/m"), ("EDC", "J"), ("friction", "-"))
    for which in ("lower", "nominal", "upper", "accepted from", "accepted to")
)
"""Columns of the expected loops, and of the acceptance."""

NO_LOOP = Loop(math.nan, math.nan, math.nan)


def pressure_factor(bearing: LIRBearing | FrictionPendulum, load: float) -> float:
    """Return the factor of the pressure under a load [N] on the surfaces' nominal friction [-]."""
    if not isinstance(bearing, LIRBearing) or bearing.pressure_dependence is None:
        return 1.0
    area = math.pi * bearing.slider_radius**2
    reference = bearing.resolved()["design_load"] / area
    return bearing.pressure_dependence.factor(load / area, reference)


def lateral_force(test: PlannedTest, bearing: LIRBearing | FrictionPendulum) -> float:
    """Return the lateral force at the displacement of a test, as design formulas have it [N]."""
    if math.isfinite(test.lateral) or math.isnan(test.displacement):
        return test.lateral
    own = FrictionPendulum.of(bearing)
    if test.alone and isinstance(bearing, LIRBearing):
        return bearing.interface_friction * test.load + bearing.interface_hold
    if own.corner <= test.displacement <= own.capacity:
        more = (pressure_factor(bearing, test.load) - 1.0) * own.effective_friction
        return own.force(test.displacement, test.load) + more * test.load
    limit = bearing.force_limit(test.load) if isinstance(bearing, LIRBearing) else math.inf
    return limit if math.isfinite(limit) else math.nan


def expected_loop(test: PlannedTest, bearing: LIRBearing | FrictionPendulum) -> Loop:
    """Return the loop of a test by the path's mean friction at its peak speed, without heating.

    Elastic displacements before sliding cut corners off. Beyond the rims the surfaces slide as far
    as the rims, and the interface slides the rest, tilted as they left it. Between its faces acts
    ``N mu / (cos t - mu sin t)``, along a path longer by ``1 / cos t``.
    """
    d, load = test.displacement, test.load
    if not (d > 0.0 and load > 0.0):
        return NO_LOOP
    own = FrictionPendulum.of(bearing)
    if not isinstance(bearing, LIRBearing):
        if not own.corner <= d <= own.capacity:
            return NO_LOOP
        energy = own.loop_energy(d, load)
        return Loop(own.force(d, load) / d, energy, energy / (4.0 * load * d))
    if test.alone:
        mu = bearing.interface_friction + bearing.interface_hold / load
        return _loop(d, load, mu * load, mu * (d - bearing.interface_yield_displacement))
    reach = min(d, own.capacity)
    beyond = d - reach
    if beyond > 0.0 and bearing.is_dcfp:
        return NO_LOOP
    factor, length = pressure_factor(bearing, load), bearing.effective_radius
    way = strength = 0.0
    for law, radius in zip(bearing.frictions, bearing.radii, strict=True):
        mu = factor * mean_friction(law, test.speed * radius / length)
        way += mu * max(reach * radius / length - bearing.yield_displacement, 0.0)
        strength += mu * radius / length
    force = load * (reach / length + strength)
    if beyond > 0.0:
        tilt, mu = math.asin(reach / length), bearing.interface_friction
        held = mu + bearing.interface_hold / load * math.cos(tilt)
        way += held * beyond / (math.cos(tilt) - mu * math.sin(tilt)) / math.cos(tilt)
        force = lateral_force(test, bearing)
    return _loop(d, load, force, way)


def _loop(d: float, load: float, force: float, way: float) -> Loop:
    # Energy of a quarter of a cycle: the path is friction times distance [m].
    energy = 4.0 * load * way
    return Loop(force / d, energy, energy / (4.0 * load * d))


def mean_friction(law: FrictionLaw, speed: float) -> float:
    """Return the mean friction over the path of harmonic motion of a peak speed [m/s]."""
    if law.f_max == law.f_min or not speed > 0.0:
        return law.f_max
    phase = 0.25 * math.pi * (_NODES + 1.0)
    at = np.array([law.at_speed(speed * math.cos(p)) for p in phase])
    return float(0.25 * math.pi * np.sum(_WEIGHTS * at * np.cos(phase)))


def factor_range(factors: PropertyModificationFactors, source: str) -> tuple[float, float]:
    """Return the factors that tests must keep: those of a source, all together without it.

    The sources are "test" of prototypes and "spec" of the production.
    """
    names = f"lambda_{source}_min", f"lambda_{source}_max"
    if all(name in factors.trace for name in names):
        low, high = map(factors.trace.value, names)
        if low < high:
            return low, high
    return factors.lower, factors.upper


def loop_numbers(
    test: PlannedTest,
    bearing: LIRBearing | FrictionPendulum,
    ends: Sequence[LIRBearing | FrictionPendulum],
    bounds: PropertyBounds | None,
) -> list[float]:
    """Return the numbers of `LOOPS`: at lower, nominal and upper friction, and their acceptance.

    The accepted range is NaN beyond the rims, because surfaces and interface have separate factors,
    and without bounds.
    """
    low, own, high = (expected_loop(test, each) for each in (ends[0], bearing, ends[1]))
    range_ = (math.nan, math.nan)
    if bounds is not None and (
        test.alone or not test.displacement > FrictionPendulum.of(bearing).capacity
    ):
        factors = bounds.interface_factors if test.alone else bounds.friction
        range_ = factor_range(factors, "spec" if "produc" in test.name else "test")
    energies = [factor * own.energy for factor in range_]
    slopes = [own.stiffness + (e - own.energy) / (2.0 * test.displacement) ** 2 for e in energies]
    frictions = [factor * own.friction for factor in range_]
    found: list[float] = []
    for three, two in zip(
        zip(low, own, high, strict=True), (slopes, energies, frictions), strict=True
    ):
        found += [*three, *two]
    return found
