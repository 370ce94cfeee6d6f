"""Equivalent-linear analysis of an isolation system, by code and with bounds in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._errors import CheckError
from frames.checks.asce7 import ASCE7
from frames.checks.bounds import ENDS, BoundName, PropertyBounds, bounded
from frames.checks.check import Checks
from frames.checks.en1998 import EN1998
from frames.checks.interface import slip_threshold
from frames.checks.isolation import Extremes, IsolationSystem
from frames.checks.nch2745 import NCh2745
from frames.checks.outcome import BoundResult, EquivalentLinear
from lir_element.door import require_type

if TYPE_CHECKING:
    from frames.checks.design_spectrum import DesignSpectrum
    from frames.checks.superstructure import Superstructure

Code = ASCE7 | EN1998 | NCh2745
_CODES = (ASCE7, EN1998, NCh2745)


def equivalent_linear(
    system: IsolationSystem,
    spectrum: DesignSpectrum,
    *,
    bounds: PropertyBounds | None,
    superstructure: Superstructure | None = None,
    code: Code | None = None,
) -> EquivalentLinear:
    """Analyse an isolation system with its effective stiffness and damping, and check it.

    The displacement is where stiffness and damping give that same displacement, found at each
    bound. Bearings are those below their rims: a check says whether the rims stay free.

    Parameters
    ----------
    system : IsolationSystem
        Bearings with nominal properties, their places and loads.
    spectrum : DesignSpectrum
        Of MCE_R for ASCE 7, of the design earthquake for the others; it has the damping factor.
    bounds : PropertyBounds or None
        Factors of lower and upper bound; None for nominal properties alone, as for comparisons.
    superstructure : Superstructure, optional
        What stands on it; without it there are no forces above the isolation system, and no
        checks of drifts and axial loads.
    code : ASCE7, EN1998 or NCh2745, optional
        The standard with its factors; the one of the spectrum with all defaults if None.

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
    """
    require_type("system", system, IsolationSystem, "an IsolationSystem")
    chosen = _code(spectrum) if code is None else code
    require_type("code", chosen, _CODES, "ASCE7(...), EN1998(...) or NCh2745(...)")
    if not spectrum.code.startswith(chosen.spectra):
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
        at = {name: bounded(system, name, bounds) for name in ENDS}
    extremes = Extremes(system, at.get("upper", system))
    results: dict[str, BoundResult] = {
        name: chosen.analyse(each, spectrum, name, superstructure, extremes)
        for name, each in at.items()
    }
    general = Checks() if bounds is None else slip_threshold(system, bounds)
    return EquivalentLinear(chosen.name, results, general)


def _code(spectrum: DesignSpectrum) -> Code:
    for code in _CODES:
        if spectrum.code.startswith(code.spectra):
            return code()
    names = ", ".join(code.spectra for code in _CODES)
    msg = f"a spectrum of {spectrum.code!r} has no equivalent-linear analysis: give one of {names}"
    raise CheckError(msg)
