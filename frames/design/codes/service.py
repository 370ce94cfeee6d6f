"""Checks of what is not seismic: wind that must not slide the bearings, movements in service."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.calculation.check import Checks
from frames.design.calculation.standing import OWN
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from lir_element.device.bearing import LIRBearing

if TYPE_CHECKING:
    from frames.design.calculation.check import Check
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.pendulum import FrictionPendulum
    from frames.design.codes.superstructure import Superstructure

NO_CLAUSE = "no code: serviceability"
"""Clause where a code's own was not read."""


def service_checks(
    system: IsolationSystem,
    bounds: PropertyBounds,
    above: Superstructure,
    wind: CodeValue | None = None,
) -> Checks:
    """Return whether wind leaves the bearings in place, and service leaves the rims alone.

    Bearings begin to slide with the friction of low speed at its lower bound, under their average
    loads, all surfaces of a bearing at once.
    """
    found: list[Check] = []
    if above.wind_shear > 0.0:
        t = least_strength(system, bounds)
        t.given("V_wind", above.wind_shear, "N")
        judge = CheckBuilder(t, "lower", OWN if wind is None else wind.standing)
        clause = NO_CLAUSE if wind is None else wind.clause
        title, note = "sliding under wind", "where it slides: more friction, or a wind restraint"
        found.append(judge(clause, title, "V_wind", "<=", "Q_min", note=note))
    if above.service_displacement > 0.0:
        t = Trace()
        t.given("d_ser", above.service_displacement, "m", shown="mm", note="as given")
        rims = [p.capacity for p in system.pendulums]
        t.given("d_rim", min(rims), "m", shown="mm", note="displacement at the first rim contact")
        judge = CheckBuilder(t, "", OWN)
        title = "no restrainer contact in service"
        found.append(judge(NO_CLAUSE, title, "d_ser", "<=", "d_rim"))
    return Checks(found)


def least_strength(system: IsolationSystem, bounds: PropertyBounds) -> Trace:
    """Return what wind must stay below: the force that starts sliding, at the lower bound."""
    t = Trace()
    t.given_each("P", system.loads, "N", note=f"loads of the {len(system.loads)} bearings")
    slow = [slow_friction(b) for b in system.bearings]
    t.given_each("mu_s", slow, note="of low speed, both surfaces, over the load")
    t.given("lambda_min", bounds.friction.lower, note="lower bound of the surfaces")
    t("Q_min", "lambda_min * sum(P * mu_s)", "N", note="starts sliding")
    return t


def slow_friction(bearing: LIRBearing | FrictionPendulum) -> float:
    """Return the friction of low speed with which all surfaces slide, over the load [-]."""
    if not isinstance(bearing, LIRBearing):
        return bearing.effective_friction
    pairs = zip(bearing.frictions, bearing.radii, strict=True)
    return sum(law.f_min * radius for law, radius in pairs) / bearing.effective_radius
