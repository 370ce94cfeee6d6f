"""Equivalent-linear analysis of an isolation system, by code and with bounds in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.check import Checks
from frames.design.codes import builtin as builtin
from frames.design.codes.bounds import ENDS, BoundName, PropertyBounds, with_property_bounds
from frames.design.codes.interface import slip_threshold
from frames.design.codes.isolation import Extremes, IsolationSystem
from frames.design.codes.outcome import BoundResult, EquivalentLinear
from frames.design.codes.registry import AnalysisMethod, code_named
from frames.design.codes.service import service_checks
from frames.design.hazard.code_rules import canonical, known_names
from frames.design.hazard.spectrum import Spectrum
from lir_element.argument_checks import require_type

if TYPE_CHECKING:
    from frames.design.codes.superstructure import Superstructure


def equivalent_linear(
    system: IsolationSystem,
    spectrum: Spectrum,
    *,
    bounds: PropertyBounds | None,
    superstructure: Superstructure | None = None,
    code: AnalysisMethod | str | None = None,
) -> EquivalentLinear:
    """Analyse an isolation system with its effective stiffness and damping, and check it.

    The displacement is where stiffness and damping give that same displacement, found at each
    bound. Bearings are those below their rims: a check says whether the rims stay free.

    Parameters
    ----------
    system : IsolationSystem
        Bearings with nominal properties, their places and loads.
    spectrum : Spectrum
        Of MCE_R for ASCE 7, of the design earthquake for the others; it has the damping factor.
    bounds : PropertyBounds or None
        Factors of lower and upper bound; None for nominal properties alone, as for comparisons.
    superstructure : Superstructure, optional
        What stands on it; without it there are no forces above the isolation system, and no
        checks of drifts and axial loads.
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
        msg = f"a spectrum of {spectrum.code!r} does not go with {chosen.name}: give one of its own"
        raise CheckError(msg)
    if superstructure is not None and superstructure.weight > system.seismic_weight:
        msg = (
            f"the storeys weigh {1e-3 * superstructure.weight:.4g} kN, all of it "
            f"{1e-3 * system.seismic_weight:.4g} kN: give the storeys above the base level alone"
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
            f"a spectrum of {spectrum.code!r} has no equivalent-linear analysis: give one of "
            f"{', '.join(names)}"
        )
        raise CheckError(msg)
    return code_named(spectrum.code).analysis()


def _method(code: AnalysisMethod | str) -> AnalysisMethod:
    if isinstance(code, str):
        return code_named(code).analysis()
    require_type("code", code, AnalysisMethod, "ASCE7(...), EN1998(...) or NCh2745(...)")
    return code
