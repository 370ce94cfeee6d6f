"""Whether values of a project's file fit its building: loads, displacement, stiffness."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.codes.registry import code_named
from frames.design.project.devices_beside import STANDARD
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.project.schema import ProjectFile
    from lir_element import LIRBearing

_SHOWN = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "Pa": ("MPa", 1e-6), "N/m": ("kN/mm", 1e-6)}


class _Row(NamedTuple):
    """A value with the bounds beyond which it is strange, and their reason."""

    key: str
    value: float | None
    unit: str
    low: float
    high: float
    why: str


def value_doubts(
    file: ProjectFile,
    system: IsolationSystem,
    equivalent: EquivalentLinear,
    devices: Mapping[str, LIRBearing],
    types: Mapping[str, str],
) -> tuple[str, ...]:
    """Return which values of a file do not fit its building, and which have no effect."""
    rows = [
        *_of_bearings(devices, equivalent),
        *_of_limits(file, system, equivalent, devices),
        *_of_devices(file, system, equivalent),
    ]
    return (*map(_said, filter(_strange, rows)), *_without_effect(file, types))


def _strange(row: _Row) -> bool:
    return row.value is not None and not row.low <= row.value <= row.high


def _said(row: _Row) -> str:
    value = row.value or 0.0
    unit, factor = _SHOWN.get(row.unit, (row.unit, 1.0))
    bound, word = (row.low, "less") if value < row.low else (row.high, "more")
    return (
        f"{row.key} = {factor * value:.4g} {unit}".rstrip()
        + f" is {word} than {factor * bound:.4g} {unit}".rstrip()
        + f", {row.why}: look at its unit"
    )


def _of_bearings(devices: Mapping[str, LIRBearing], equivalent: EquivalentLinear) -> Iterator[_Row]:
    needed = max(each.allowed_displacement for each in equivalent.bounds.values())
    for kind, bearing in devices.items():
        at = "[bearing]" if kind == STANDARD else f"[bearings.{kind}]"
        a, options = bearing.slider_radius, bearing.resolved()
        why = "sliding materials of isolators have 0.01 to 0.15"
        yield _Row(
            f"{at} friction", max(law.f_max for law in bearing.frictions), "", 0.01, 0.3, why
        )
        why = f"a fifth of the {1e3 * needed:.4g} mm that bearings without rims go"
        yield _Row(f"{at} capacity", bearing.lateral_capacity, "m", 0.2 * needed, math.inf, why)
        why = "the slider's radius: its edge has left the plate before the rim counts as failed"
        yield _Row(f"{at} rim_overrun", options["rim_overrun"], "m", 0.0, a, why)
        why = "the slider's diameter: its halves overlap no more"
        yield _Row(f"{at} slip_capacity", options["slip_capacity"], "m", 0.0, 2.0 * a, why)
        for name in ("yield_displacement", "interface_yield_displacement"):
            why = "sliders begin to slide within some tenths of a millimetre"
            yield _Row(f"{at} {name}", getattr(bearing, name), "m", 0.0, 5e-3, why)
        if bearing.friction_heating is not None:
            key = f"{at} friction_heating: initial_temperature"
            given, why = bearing.friction_heating.initial_temperature, "no climate's temperature"
            yield _Row(key, given, "C", -40.0, 60.0, why)


def _of_limits(
    file: ProjectFile,
    system: IsolationSystem,
    equivalent: EquivalentLinear,
    devices: Mapping[str, LIRBearing],
) -> Iterator[_Row]:
    limits, load, weight = file.limits, max(system.loads), system.seismic_weight
    capacity = max(each.lateral_capacity for each in devices.values())
    heaviest = f"the heaviest bearing carries {1e-3 * load:.4g} kN"
    whole = f"the building weighs {1e-3 * weight:.4g} kN"
    pushed = min(each.base_shear for each in equivalent.bounds.values()) / weight
    rows: dict[str, tuple[str, float, float, str]] = {
        "rim_strength": ("N", 0.02 * load, 100.0 * load, heaviest),
        "axial_force": ("N", 0.5 * load, 100.0 * load, heaviest),
        "lateral_force": ("N", 0.005 * load, 100.0 * load, heaviest),
        "base_shear": ("N", 0.005 * weight, 3.0 * weight, whole),
        "interface_pressure": ("Pa", 2e6, 1e9, "sliding materials carry 5 to 100 MPa"),
        "liner_pressure": ("Pa", 2e6, 1e9, "sliding materials carry 5 to 100 MPa"),
        "floor_acceleration": (
            "m/s2",
            pushed * STANDARD_GRAVITY,
            25.0,
            f"the isolation pushes with {pushed:.3g} of the weight, isolated floors have 1 to 10 "
            "m/s2",
        ),
        "drift": ("", 1e-4, 0.05, "codes allow 0.002 to 0.02 of isolated buildings"),
        "slip_left": ("m", 0.0, capacity, "the capacity: no run reaches it"),
        "displacement_left": ("m", 0.0, capacity, "the capacity: hardly a run reaches it"),
    }
    for name, (unit, low, high, why) in rows.items():
        yield _Row(f"[limits] {name}", getattr(limits, name), unit, low, high, why)


def _of_devices(
    file: ProjectFile, system: IsolationSystem, equivalent: EquivalentLinear
) -> Iterator[_Row]:
    weight, each = system.seismic_weight, equivalent.bounds.values()
    needed = max(one.allowed_displacement for one in each)
    if file.moat is not None:
        why = f"half of the {1e3 * needed:.4g} mm that bearings go without walls"
        yield _Row("[moat] gap", file.moat.gap, "m", 0.5 * needed, math.inf, why)
        stiff = max(one.stiffness for one in each)
        why = "ten times the isolation's stiffness: a wall that soft is none"
        yield _Row("[moat] stiffness", file.moat.stiffness, "N/m", 10.0 * stiff, math.inf, why)
    for name, one in file.dampers.items():
        count = len(one.columns) or 1
        why = f"the building weighs {1e-3 * weight:.4g} kN"
        key = f"[dampers.{name}] force times {count}" if count > 1 else f"[dampers.{name}] force"
        yield _Row(key, count * one.force, "N", 1e-3 * weight, weight, why)
        why = "isolated buildings move at 0.1 to 2 m/s"
        yield _Row(f"[dampers.{name}] speed", one.speed, "m/s", 0.01, 5.0, why)
    above = getattr(file.structure, "damping", None)
    if isinstance(above, float):
        why = "structures on isolators stay elastic and have 0.01 to 0.05"
        yield _Row("[structure] damping", above, "", 0.0, 0.1, why)
    why = "the program chooses 0.005 s or less"
    yield _Row("[analysis] dt", file.analysis.dt, "s", 0.0, 0.02, why)


def _without_effect(file: ProjectFile, types: Mapping[str, str]) -> Iterator[str]:
    # Keys that the code does not read, bearings that stand nowhere.
    above, code = file.superstructure, code_named(file.project.code)
    for key, instead in code.unread.items():
        given = above is not None and key in above.model_fields_set and getattr(above, key)
        if given and not math.isclose(given, 1.0):
            yield (
                f"[superstructure] {key} = {given:g} changes nothing: {code.name} {instead}; "
                "leave it out"
            )
    by_load = any(kind.above is not None for kind in file.bearings.values())
    if by_load and STANDARD not in types.values():
        yield (
            "[bearing] stands under no column: every bearing carries more than the least `above` "
            "of [bearings]; look at its unit, or raise it"
        )
