"""A bearing's numbers as calculations begin with them: geometry, frictions at their bounds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from lir_element.argument_checks import require_non_negative, require_positive
from lir_element.device.sliders import interface_height
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.codes.bounds import PropertyBounds
    from lir_element import LIRBearing


def overlap_area(radius: float, offset: float) -> float:
    """Return the area that two circles of one radius share, their centres `offset` apart [m2].

    Parameters
    ----------
    radius : float
        Radius of both [m], > 0.
    offset : float
        Distance of their centres [m], at least 0.

    Returns
    -------
    float
        ``2 a^2 acos(s / 2 a) - s / 2 sqrt(4 a^2 - s^2)``, 0 from ``s = 2 a`` on.

    Raises
    ------
    CheckError
        If a length is out of bounds.

    Examples
    --------
    >>> round(overlap_area(0.15, 0.15) / overlap_area(0.15, 0.0), 3)
    0.391
    """
    a = require_positive("radius", radius, "m", error=CheckError)
    s = min(require_non_negative("offset", offset, "m", error=CheckError), 2.0 * a)
    return 2.0 * a * a * math.acos(0.5 * s / a) - 0.5 * s * math.sqrt(4.0 * a * a - s * s)


def pressure(t: Trace, symbol: str, load: str, offset: str) -> float:
    """Enter the mean pressure of a load on the overlap of two circles of radius `a` [Pa]."""
    area, s = f"A_{symbol}", t.value(offset)
    if math.isinf(s):
        return t.given(symbol, math.inf, "Pa", note=t[offset].note)
    if s >= 2.0 * t.value("a"):
        return t.given(
            symbol,
            math.inf,
            "Pa",
            note=worded("{offset} = {s:.4g} m: nothing overlaps", offset=offset, s=s),
        )
    t(
        area,
        f"2 * a**2 * acos({offset} / (2 * a)) - {offset} / 2 * sqrt(4 * a**2 - {offset}**2)",
        "m2",
        note="circles that overlap",
    )
    return t(symbol, f"{load} / {area}", "Pa")


def liner_pressure(t: Trace, k: int, load: str) -> float:
    """Enter the mean pressure on a liner around its resultant, without restrainer contact."""
    if not math.isfinite(t.value("s")):
        return t.given(f"p_{k}", math.inf, "Pa", note=t["s"].note)
    note = "twice the offset of the centre of pressure, no restrainer contact"
    formula, source = f"2 * abs(R_{k} * (s / L + mu_e - mu_{k}_U))", "docs/theory.md, section 2"
    t(f"c_{k}", formula, "m", shown="mm", source=source, note=note)
    return pressure(t, f"p_{k}", load, f"c_{k}")


def by_equation(number: str) -> str:
    """Return the clause of a check that no code has, by an equation of docs/theory.md."""
    return worded("no code: docs/theory.md ({equation})", equation=number)


def by_section(number: str) -> str:
    """Return the clause of a check that no code has, by a section of docs/theory.md."""
    return worded("no code: docs/theory.md, section {section}", section=number)


SURFACES = ("bottom", "top")


def require_rims(bearing: LIRBearing) -> None:
    """Raise a CheckError if a bearing has no rims."""
    if not math.isfinite(bearing.lateral_capacity):
        msg = "the bearing has no rims (capacity = inf): set capacity, or leave this check out"
        raise CheckError(msg)


def enter_geometry(bearing: LIRBearing) -> Trace:
    """Return a calculation with radii, rims, effective radius L and displacement U_cap at a rim."""
    t = Trace()
    for k, (radius, rim) in enumerate(
        zip(bearing.radii, bearing.rim_displacement, strict=True), start=1
    ):
        t.given(f"R_{k}", radius, "m")
        t.given(f"d_rim_{k}", rim, "m", shown="mm", note="sliding at rim contact")
    t.given("h", bearing.slider_height, "m", shown="mm")
    t("L", "R_1 + R_2 - h", "m")
    t("U_cap", "L * min(d_rim_1 / R_1, d_rim_2 / R_2)", "m", shown="mm")
    return t


def enter_bearing(
    bearing: LIRBearing,
    bounds: PropertyBounds | None,
    loads: tuple[float, float] | None = None,
) -> Trace:
    """Return a calculation with a bearing's geometry, frictions at their bounds, and its slips."""
    require_rims(bearing)
    if bearing.is_dcfp:
        msg = (
            "a rigid slider (interface_friction = inf) has no interface: set "
            "interface_friction, or leave this check out"
        )
        raise CheckError(msg)
    t = enter_geometry(bearing)
    t.given("a", bearing.slider_radius, "m", shown="mm")
    height = float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))
    t.given("h_1", height, "m", shown="mm", note="interface above the bottom vertex")
    t("h_2", "h - h_1", "m", shown="mm")
    if loads is not None:
        for symbol, load in zip(("N_min", "N_max"), loads, strict=True):
            t.given(symbol, load, "N")
        _enter_pressure(t, bearing)
    _enter_frictions(t, bearing, bounds)
    t("mu_e", "(mu_1_U * R_1 + mu_2_U * R_2) / L", source="docs/theory.md, section 2")
    source = "docs/theory.md (2.7)"
    t(
        "s_star",
        "L * mu_h_L - mu_1_U * R_1 - mu_2_U * R_2",
        "m",
        shown="mm",
        source=source,
        note="stable limit of interface slip",
    )
    note = "slip at which the sliders' overlap ends"
    t.given("s_cap", bearing.resolved()["slip_capacity"], "m", shown="mm", note=note)
    t("s_lim", "max(min(s_cap, s_star), 0)", "m", shown="mm")
    return t


def _enter_pressure(t: Trace, bearing: LIRBearing) -> None:
    # Factors of the surfaces' friction: upper at the least pressure, lower at the largest.
    law = bearing.pressure_dependence
    if law is None:
        return
    reference = law.reference_pressure
    if reference is None:
        t.given("N_0", bearing.resolved()["design_load"], "N", note="design load")
        t("p_0", "N_0 / (pi * a**2)", "Pa", note="at which friction was measured")
    else:
        t.given("p_0", reference, "Pa", note="at which friction was measured")
    t.given("r_p", law.rate, "1/Pa", note="fall of friction with the pressure")
    for bound, load in (("U", "N_min"), ("L", "N_max")):
        t(
            f"k_p_{bound}",
            f"exp(-r_p * ({load} / (pi * a**2) - p_0))",
            source="docs/theory.md (11.1)",
        )


def _enter_frictions(t: Trace, bearing: LIRBearing, bounds: PropertyBounds | None) -> None:
    # Upper friction of the surfaces is that of high speed, lower one that of no speed.
    nominal = {f"mu_{k}": law for k, law in enumerate(bearing.frictions, start=1)}
    values = {f"{name}_U": law.f_max for name, law in nominal.items()}
    values |= {f"{name}_L": law.f_min for name, law in nominal.items()}
    values |= dict.fromkeys(("mu_h_U", "mu_h_L"), bearing.interface_friction)
    for symbol, value in values.items():
        at = "upper" if symbol.endswith("U") else "lower"
        inner = symbol.startswith("mu_h")
        factors = []
        if bounds is not None:
            factor = f"lambda_{'h' if inner else 'd'}_{at}"
            if factor not in t:
                given = bounds.interface_factors if inner else bounds.friction
                t.given(factor, given.at("upper" if at == "upper" else "lower"))
            factors.append(factor)
        if not inner and f"k_p_{symbol[-1]}" in t:
            factors.append(f"k_p_{symbol[-1]}")
        if factors:
            t.given(f"{symbol}0", value, note="nominal")
            t(symbol, " * ".join([*factors, f"{symbol}0"]))
        else:
            t.given(symbol, value)


def enter_length(t: Trace, symbol: str, value: float, note: str = "") -> None:
    """Enter a length that must not be negative [m]."""
    found = require_non_negative(symbol, value, "m", error=CheckError)
    t.given(symbol, found, "m", shown="mm", note=note)
