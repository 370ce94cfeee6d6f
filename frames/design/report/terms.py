"""What a model and a bearing are, in the words and units of the field."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING

from frames.design.calculation.rendering import number as written
from frames.design.report.page import Table
from lir_element.device.friction import FrictionLaw

if TYPE_CHECKING:
    from frames.statics.model_check import ModelCheck
    from lir_element import LIRBearing

_SHOWN = {
    "m": ("mm", 1e3),
    "N": ("kN", 1e-3),
    "N/m": ("kN/m", 1e-3),
    "N s/m": ("kN s/m", 1e-3),
    "kg/m3": ("kg/m³", 1.0),
    "kg m2": ("kg m²", 1.0),
}


def _applies(name: str, bearing: LIRBearing) -> bool:
    # Whether a field says something of a bearing.
    if name == "bouc_wen_exponent":
        return bearing.friction_law == "bouc-wen"
    if name == "uplift_capacity":
        return math.isfinite(bearing.uplift_capacity)
    return name != "rim_hardening" or math.isfinite(bearing.rim_yield_force)


def device_table(bearing: LIRBearing) -> Table:
    """Return what a bearing is: what was given, defaults, and what follows."""
    derived = [
        ("effective radius", bearing.effective_radius, "m"),
        ("pendulum period", bearing.period, "s"),
        ("displacement capacity", bearing.lateral_capacity, "m"),
        ("characteristic strength ratio Q/W", bearing.effective_friction, "-"),
        ("stable limit of interface slip", bearing.slip_stability, "m"),
    ]
    rows = [
        (title, _quantity(value, unit, "not limited"), _unit(value, unit), "derived")
        for title, value, unit in derived
    ]
    resolved = bearing.resolved()
    for field in fields(bearing):
        name, value, origin = field.name, getattr(bearing, field.name), "given"
        if (value is None and name not in resolved) or not _applies(name, bearing):
            continue
        if value is None:
            value, origin = resolved[name], "default"
        elif value == field.default:
            origin = "default"
        unit = field.metadata.get("unit", "")
        shown = _quantity(value, unit, field.metadata.get("endless") or "not limited")
        rows.append((field.metadata["title"], shown, _unit(value, unit), origin))
    return Table(("property", "value", "unit", "origin"), rows, frozenset({3}))


def model_table(model: ModelCheck) -> Table:
    """Return the totals of a model under its permanent loads."""
    across = [abs(force) for force in model.loads[:2]]
    taken = sum(force for _, force in model.supports)
    periods = ", ".join(f"{value:.3g}" for value in model.periods)
    rows = [
        ("mass", f"{1e-3 * model.mass:.5g}", "t"),
        ("permanent vertical load", f"{1e-3 * model.weight:.5g}", "kN"),
        ("of it non-mass loads", f"{-1e-3 * model.loads[2] + 0.0:.5g}", "kN"),
    ]
    if any(across):
        rows += [
            (f"permanent load along {axis}", f"{1e-3 * force:.5g}", "kN")
            for axis, force in zip("xy", model.loads[:2], strict=True)
        ]
    rows += [
        ("carried by the bearings", f"{1e-3 * model.carried:.5g}", "kN"),
        ("carried by other supports", f"{1e-3 * taken + 0.0:.5g}", "kN"),
        ("periods, fixed base", periods or "none, rigid", "s" if periods else ""),
        ("period on the bearings, sliding", f"{model.isolated_period:.3g}", "s"),
    ]
    return Table(("quantity", "value", "unit"), rows)


def loads_table(model: ModelCheck) -> Table:
    """Return what permanent loads make of each bearing."""
    rows = [
        (
            load.name,
            written(1e-3 * load.axial_force),
            f"{1e-6 * load.pressure:.3g}",
            f"{1e3 * load.settlement:.2g}",
            f"{load.period:.3g}",
            _held(load.slip_stability, load.slip_capacity),
        )
        for load in model.bearings
    ]
    head = (
        "bearing",
        "axial force [kN]",
        "pressure [MPa]",
        "settlement [mm]",
        "pendulum period [s]",
        "stable limit of interface slip, of the overlap",
    )
    return Table(head, rows, frozenset({5}))


def _held(stable: float, overlap: float) -> str:
    if math.isinf(stable):
        return "rigid slider"
    end = f"{1e3 * overlap:.3g} mm"
    if stable >= overlap:
        return f"all {end}"
    return f"{1e3 * max(stable, 0.0):.3g} of {end}"


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _unit(value: object, unit: str) -> str:
    if _is_number(value) and not math.isfinite(float(value)):  # type: ignore[arg-type]  # a number
        return ""
    return "" if unit in {"", "-"} else _SHOWN.get(unit, (unit, 1.0))[0]


def _quantity(value: object, unit: str, endless: str) -> str:
    # A value in the unit shown; pairs that are alike once.
    if isinstance(value, tuple):
        parts = [_quantity(each, unit, endless) for each in value]
        return parts[0] if len(set(parts)) == 1 else "; ".join(parts)
    if isinstance(value, FrictionLaw):
        return _friction(value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not _is_number(value):
        return str(value)
    number = float(value)  # type: ignore[arg-type]  # a number
    if not math.isfinite(number):
        return endless
    shown = _SHOWN.get(unit, (unit, 1.0))[1] * number
    return written(shown)


def _friction(law: FrictionLaw) -> str:
    if law.f_max == law.f_min:
        return f"{law.f_max:.4g}"
    return f"{law.f_max:.4g} at high speed, {law.f_min:.4g} at rest"
