"""A bearing's numbers as calculations begin with them: geometry, frictions at their bounds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames._errors import CheckError
from frames.checks.trace import Trace
from lir_element.device.sliders import interface_height
from lir_element.door import require_non_negative

if TYPE_CHECKING:
    from frames.checks.bounds import PropertyBounds
    from lir_element import LIRBearing

NO_CODE = "no code: docs/theory.md"
"""Clause of checks that no code has."""

SURFACES = ("bottom", "top")


def require_rims(bearing: LIRBearing) -> None:
    """Raise a CheckError where a bearing has no rims."""
    if not math.isfinite(bearing.lateral_capacity):
        msg = "the bearing has no rims: give it a capacity, or leave this check out"
        raise CheckError(msg)


def enter_geometry(bearing: LIRBearing) -> Trace:
    """Return a calculation with radii, rims, effective radius L and displacement U_cap at a rim."""
    t = Trace()
    for k, (radius, rim) in enumerate(
        zip(bearing.radii, bearing.rim_displacement, strict=True), start=1
    ):
        t.given(f"R_{k}", radius, "m")
        t.given(f"d_rim_{k}", rim, "m", shown="mm", note="sliding at which the rim is met")
    t.given("h", bearing.slider_height, "m", shown="mm")
    t("L", "R_1 + R_2 - h", "m")
    t("U_cap", "L * min(d_rim_1 / R_1, d_rim_2 / R_2)", "m", shown="mm")
    return t


def enter_bearing(bearing: LIRBearing, bounds: PropertyBounds | None) -> Trace:
    """Return a calculation with a bearing's geometry, frictions and factors.

    Parameters
    ----------
    bearing : LIRBearing
        A bearing with rims, its slider in two pieces, friction nominal.
    bounds : PropertyBounds or None
        Factors of its friction; 1 if None.

    Returns
    -------
    Trace
        The calculation.

    Raises
    ------
    CheckError
        If it has no rims, or its slider is in one piece.
    """
    require_rims(bearing)
    if bearing.is_dcfp:
        msg = "the slider is in one piece: it has no interface to check"
        raise CheckError(msg)
    t = enter_geometry(bearing)
    t.given("a", bearing.slider_radius, "m", shown="mm")
    height = float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))
    t.given("h_1", height, "m", shown="mm", note="interface above the bottom vertex")
    t("h_2", "h - h_1", "m", shown="mm")
    for k, law in enumerate(bearing.frictions, start=1):
        t.given(f"mu_{k}", law.f_max, note="high speed")
        t.given(f"mu_{k}_0", law.f_min, note="no speed")
    t.given("mu_h", bearing.interface_friction)
    parts = (None, None) if bounds is None else (bounds.friction, bounds.interface_factors)
    for name, factors in zip(("d", "h"), parts, strict=True):
        t.given(f"lambda_{name}_min", 1.0 if factors is None else factors.lower)
        t.given(f"lambda_{name}_max", 1.0 if factors is None else factors.upper)
    return t


def enter_bounds(t: Trace) -> None:
    """Enter the frictions at their bounds: high speed at the upper, no speed at the lower one."""
    for k in (1, 2):
        t(f"mu_{k}_U", f"lambda_d_max * mu_{k}")
        t(f"mu_{k}_L", f"lambda_d_min * mu_{k}_0")
    t("mu_h_L", "lambda_h_min * mu_h")
    t("mu_h_U", "lambda_h_max * mu_h")
    t("mu_e", "(mu_1_U * R_1 + mu_2_U * R_2) / L", source="docs/theory.md, section 2")


def enter_length(t: Trace, symbol: str, value: float, note: str = "") -> None:
    """Enter a length that must not be negative [m]."""
    found = require_non_negative(symbol, value, "m", error=CheckError)
    t.given(symbol, found, "m", shown="mm", note=note)


def enter_stability(t: Trace) -> None:
    """Enter s*, the slip that holds without rims, low friction upper and interface lower bound."""
    t("s_star", "L * mu_h_L - mu_1_U * R_1 - mu_2_U * R_2", "m", shown="mm",
      source="docs/theory.md (2.7)")  # fmt: skip
