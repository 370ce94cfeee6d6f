"""Equivalent-linear analysis of an isolation system, by code and with bounds in one call."""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.check import Checks
from frames.design.calculation.standing import PROJECT
from frames.design.calculation.trace import Trace
from frames.design.codes.bounds import ENDS, BoundName, PropertyBounds
from frames.design.codes.isolation import Extremes, IsolationSystem, with_property_bounds
from frames.design.codes.outcome import BoundResult, EquivalentLinear
from frames.design.codes.registry import (
    AnalysisMethod,
    DesignCode,
    code_named,
    known_codes,
    register_code,
)
from frames.design.codes.secant import CheckBuilder
from frames.design.hazard.code_rules import canonical, known_names
from frames.design.hazard.spectrum import Spectrum
from lir_element.argument_checks import require_type
from lir_element.device.bearing import LIRBearing
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.calculation.check import Check
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.pendulum import FrictionPendulum
    from frames.design.codes.superstructure import Superstructure

for _found in sorted(pkgutil.iter_modules([str(Path(__file__).parent)])):
    _code = getattr(importlib.import_module(f"{__package__}.{_found.name}"), "CODE", None)
    if isinstance(_code, DesignCode):
        register_code(_code)

BUILT_IN = known_codes()
"""The codes of this package."""


def slip_threshold(system: IsolationSystem, bounds: PropertyBounds) -> Checks:
    """Return the check that the interface holds while the surfaces slide, for the worst bearing.

    Away from the rims the interface carries ``mu1 R1 + mu2 R2`` over L times the load, at any
    displacement and load. It holds if its friction at the lower bound is at least that of the
    surfaces at the upper one.
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
    check = CheckBuilder(t, "", PROJECT).worst(
        clause,
        "interface holds before the rim",
        "mu_h_low",
        ">=",
        "mu_e_up",
        subjects=tuple(name for name, _ in found),
    )
    return Checks([check])


NO_CLAUSE = "no code: serviceability"
"""Clause if a code's own was not read."""


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
        judge = CheckBuilder(t, "lower", PROJECT if wind is None else wind.standing)
        clause = NO_CLAUSE if wind is None else wind.clause
        note = "if it slides: raise the friction, or add a wind restraint"
        title = "sliding under wind"
        found.append(judge(clause, title, "V_wind", "<=", "Q_min", note=note))
    if above.service_displacement > 0.0:
        t = Trace()
        t.given("d_ser", above.service_displacement, "m", shown="mm", note="as given")
        rims = [p.capacity for p in system.pendulums]
        t.given("d_rim", min(rims), "m", shown="mm", note="displacement at the first rim contact")
        judge = CheckBuilder(t, "", PROJECT)
        title = "no restrainer contact in service"
        found.append(judge(NO_CLAUSE, title, "d_ser", "<=", "d_rim"))
    return Checks(found)


def least_strength(system: IsolationSystem, bounds: PropertyBounds) -> Trace:
    """Return the force that starts sliding at the lower bound: the limit of the wind force [N]."""
    t = Trace()
    t.given_each(
        "P", system.loads, "N", note=worded("loads of the {n} bearings", n=len(system.loads))
    )
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


def equivalent_linear(
    system: IsolationSystem,
    spectrum: Spectrum,
    *,
    bounds: PropertyBounds | None,
    superstructure: Superstructure | None = None,
    code: AnalysisMethod | str | None = None,
) -> EquivalentLinear:
    """Analyse an isolation system with its effective stiffness and damping, and check it.

    The displacement agrees with the stiffness and damping at that displacement, found at each
    bound. The bearings are modelled without rim contact: a check compares the displacement with the
    rims.

    Parameters
    ----------
    system : IsolationSystem
        Bearings with nominal properties, their places and loads.
    spectrum : Spectrum
        Spectrum of MCE_R for ASCE 7, of the design earthquake for the others; it has the damping
        factor.
    bounds : PropertyBounds or None
        Factors of lower and upper bound; None for nominal properties alone, as for comparisons.
    superstructure : Superstructure, optional
        Structure above; without it there are no forces above the isolation system, and no checks of
        drifts and axial loads.
    code : ASCE7, EN1998, NCh2745 or str, optional
        The standard with its factors, or its name: with all defaults. That of the spectrum if None.

    Returns
    -------
    EquivalentLinear
        Results and checks at each bound.

    Raises
    ------
    CheckError
        If code and spectrum do not belong together, no displacement is found, or the storeys
        weigh more than the whole.
    ValueError
        If a bearing cannot be at a bound.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> from frames.design import IsolationSystem, PropertyBounds, Spectrum
    >>> from frames.design import PropertyModificationFactors
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=CoulombFriction(0.06), interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> factors = PropertyModificationFactors.asce7(full_scale_tests=True, test=(0.8, 1.3))
    >>> bounds = PropertyBounds(factors)
    >>> result = equivalent_linear(system, Spectrum.asce7(s_ms=1.2, s_m1=0.6), bounds=bounds)
    >>> print(result["lower"].trace["V_b"].text())
    V_b = k_M D_M = 3502 kN/m · 250.1 mm = 875.7 kN
    >>> print(result.checks.governing)
    effective damping (upper, MCE_R): 36.29 % <= 30 %, ratio 1.21, does not apply [ASCE 7-22 17.4.1]
    """
    require_type("system", system, IsolationSystem, "an IsolationSystem")
    require_type("spectrum", spectrum, Spectrum, "a Spectrum")
    chosen = _of_spectrum(spectrum) if code is None else _method(code)
    if canonical(spectrum.code) != chosen.name:
        msg = (
            f"a spectrum of {spectrum.code!r} cannot be used with {chosen.name}: give a spectrum "
            f"of {chosen.name}"
        )
        raise CheckError(msg)
    if superstructure is not None and superstructure.weight > system.seismic_weight:
        msg = (
            f"the storeys weigh {1e-3 * superstructure.weight:.4g} kN, more than the whole "
            f"structure, {1e-3 * system.seismic_weight:.4g} kN: give the storeys above the base "
            "level alone"
        )
        raise CheckError(msg)
    at: dict[BoundName, IsolationSystem] = {"nominal": system}
    if bounds is not None:
        at = {name: with_property_bounds(system, name, bounds) for name in ENDS}
    extremes = Extremes(system, at.get("upper", system))
    results: dict[str, BoundResult] = {
        name: chosen.analyse(each, spectrum, name, superstructure, extremes)
        for name, each in at.items()
    }
    general = Checks() if bounds is None else slip_threshold(system, bounds)
    if bounds is not None and superstructure is not None:
        wind = code_named(chosen.name).values.get("sliding under wind")
        general += service_checks(system, bounds, superstructure, wind)
    return EquivalentLinear(chosen.name, results, general)


def _of_spectrum(spectrum: Spectrum) -> AnalysisMethod:
    names = known_names()
    if canonical(spectrum.code) not in names:
        msg = (
            f"{spectrum.code!r} has no equivalent-linear analysis: give a spectrum of "
            f"{', '.join(names)}"
        )
        raise CheckError(msg)
    return code_named(spectrum.code).analysis()


def _method(code: AnalysisMethod | str) -> AnalysisMethod:
    if isinstance(code, str):
        return code_named(code).analysis()
    require_type("code", code, AnalysisMethod, "ASCE7(...), EN1998(...) or NCh2745(...)")
    return code
