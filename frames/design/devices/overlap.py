"""The overlap of the two sliders: two circles of one radius, a slip apart, and its pressure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from lir_element.argument_checks import require_non_negative, require_positive

if TYPE_CHECKING:
    from frames.design.calculation.trace import Trace


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
    """Enter the mean pressure of a load on what two circles of radius `a` share."""
    area, s = f"A_{symbol}", t.value(offset)
    if math.isinf(s):
        return t.given(symbol, math.inf, "Pa", note=t[offset].note)
    if s >= 2.0 * t.value("a"):
        return t.given(symbol, math.inf, "Pa", note=f"{offset} = {s:.4g} m: nothing overlaps")
    t(
        area,
        f"2 * a**2 * acos({offset} / (2 * a)) - {offset} / 2 * sqrt(4 * a**2 - {offset}**2)",
        "m2",
        note="circles that overlap",
    )
    return t(symbol, f"{load} / {area}", "Pa")


def liner_pressure(t: Trace, k: int, load: str) -> float:
    """Enter the mean pressure on the part of a liner around its resultant, no restrainer contact."""
    if not math.isfinite(t.value("s")):
        return t.given(f"p_{k}", math.inf, "Pa", note=t["s"].note)
    note = "twice the offset of the centre of pressure, no restrainer contact"
    formula, source = f"2 * abs(R_{k} * (s / L + mu_e - mu_{k}_U))", "docs/theory.md, section 2"
    t(f"c_{k}", formula, "m", shown="mm", source=source, note=note)
    return pressure(t, f"p_{k}", load, f"c_{k}")
