"""Check of the interface between the sliders: it must hold until a rim is met."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.calculation.check import Checks
from frames.design.calculation.standing import OWN
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from lir_element.device.bearing import LIRBearing

if TYPE_CHECKING:
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.isolation import IsolationSystem


def slip_threshold(system: IsolationSystem, bounds: PropertyBounds) -> Checks:
    """Return the check that the interface holds while the surfaces slide, for the worst bearing.

    Away from the rims the interface carries ``mu1 R1 + mu2 R2`` over L times the load, whatever
    the displacement and the load: it holds where its friction at the lower bound is at least that
    of the surfaces at the upper one.
    """
    pairs = zip(system.labels, system.bearings, strict=True)
    found = [(name, b) for name, b in pairs if isinstance(b, LIRBearing) and not b.is_dcfp]
    if not found:
        return Checks()
    t = Trace()
    t.given_each("mu_h", [b.interface_friction for _, b in found], note="of the interface")
    t.given_each("mu_e", [b.effective_friction for _, b in found], note="of the surfaces")
    t.given("lambda_h", bounds.interface_factors.lower, note="lower bound of the interface")
    t.given("lambda_e", bounds.friction.upper, note="upper bound of the surfaces")
    t.each("mu_h_low", "lambda_h * mu_h")
    t.each("mu_e_up", "lambda_e * mu_e", note="what the interface carries, over the load")
    clause = "LIR-DCFP, docs/theory.md (2.1)"
    check = CheckBuilder(t, "", OWN).worst(
        clause,
        "interface holds before the rim",
        "mu_h_low",
        ">=",
        "mu_e_up",
        subjects=tuple(name for name, _ in found),
    )
    return Checks([check])
