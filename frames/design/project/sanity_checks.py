"""Plausibility of a project's file: doubts about its building before it is run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.codes.analysis import least_strength
from frames.design.codes.registry import code_named
from frames.design.project.inputs import bearing_of
from frames.design.project.moat_and_dampers import STANDARD
from frames.design.project.schema_bearing import SIDES
from frames.design.project.schema_structure import (
    BuildingTable,
    IrregularFrame,
    MomentFrame,
    ShearBuilding,
)
from lir_element.texts import anded, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from frames.design.codes.bounds import PropertyBounds
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
    given, limit = (f"{factor * v:.4g} {unit}".rstrip() for v in (value, bound))
    return worded(
        "{key} = {value} is {word} than {bound}, {why}: check its unit",
        key=row.key,
        value=given,
        word=word,
        bound=limit,
        why=row.why,
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
        why = worded("a fifth of the {c:.4g} mm displacement without rims", c=1e3 * needed)
        yield _Row(f"{at} capacity", bearing.lateral_capacity, "m", 0.2 * needed, math.inf, why)
        why = "the slider's radius: its edge leaves the plate before the rim fails"
        yield _Row(f"{at} rim_overrun", options["rim_overrun"], "m", 0.0, a, why)
        why = "the slider's diameter: its halves no longer overlap"
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
    heaviest = worded("the heaviest bearing carries {load:.4g} kN", load=1e-3 * load)
    whole = worded("the building weighs {weight:.4g} kN", weight=1e-3 * weight)
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
            worded(
                "the isolation transmits {share:.3g} of the weight, isolated floors have 1 to 10 "
                "m/s2",
                share=pushed,
            ),
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
        why = worded("half of the {c:.4g} mm displacement without walls", c=1e3 * needed)
        yield _Row("[moat] gap", file.moat.gap, "m", 0.5 * needed, math.inf, why)
        stiff = max(one.stiffness for one in each)
        why = "ten times the isolation's stiffness: such a soft wall has no effect"
        yield _Row("[moat] stiffness", file.moat.stiffness, "N/m", 10.0 * stiff, math.inf, why)
    for name, one in file.dampers.items():
        count = len(one.columns) or 1
        why = worded("the building weighs {weight:.4g} kN", weight=1e-3 * weight)
        key = f"[dampers.{name}] force"
        key = worded("{key} times {count}", key=key, count=count) if count > 1 else key
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
    # Keys that the code does not read, unused bearings.
    above, code = file.superstructure, code_named(file.project.code)
    for key, instead in code.unread.items():
        given = above is not None and key in above.model_fields_set and getattr(above, key)
        if given and not math.isclose(given, 1.0):
            yield worded(
                "{key} = {value:g} has no effect: {code} {instead}; leave it out",
                key=f"[superstructure] {key}",
                value=given,
                code=code.name,
                instead=instead,
            )
    by_load = any(kind.above is not None for kind in file.bearings.values())
    if by_load and STANDARD not in types.values():
        yield (
            "no column uses [bearing]: every bearing carries more than the least `above` "
            "of [bearings]. Check its unit, or raise it"
        )


SOFT = 0.5
"""Period of a storey and those above it, over the number of storeys above its floor and one more
[s], above which it is unusual: whole buildings have about 0.1 s a storey.
"""

STIFF = 0.005
"""The same over the number of storeys above its floor [s], up to which it is strange."""

FLOOR_MASS = (50.0, 6000.0)
"""Mass of a storey over its plan [kg/m2]; buildings have 300 to 1500."""

STOREY = (2.0, 20.0)
"""Height of storeys that buildings have [m]."""

HEAVY_FLOOR, HEAVY_FACADE = 25e3, 60e3
"""Live load or snow [N/m2], and facade [N/m], from which on they are strange."""


def file_doubts(file: ProjectFile) -> tuple[str, ...]:
    """Return the unusual values of a project's file, a sentence for each."""
    return (
        *_of_sections(file),
        *_of_masses(file),
        *_of_heights(file),
        *_of_loads(file),
        *_of_bays(file),
        *_of_storeys(file),
        *_of_importance(file),
        *_of_moat(file),
    )


def wind_doubts(
    file: ProjectFile, system: IsolationSystem, bounds: PropertyBounds
) -> tuple[str, ...]:
    """Return whether the wind of a project slides its bearings."""
    wind = 0.0 if file.superstructure is None else file.superstructure.wind_shear
    holds = least_strength(system, bounds).value("Q_min")
    if wind <= holds:
        return ()
    return (
        worded(
            "the isolation slides in wind: [superstructure] wind_shear = {wind:.4g} kN exceeds "
            "the least friction of all bearings, {holds:.4g} kN. Raise the friction, add a wind "
            "restraint, or check the unit",
            wind=1e-3 * wind,
            holds=1e-3 * holds,
        ),
    )


def _of_sections(file: ProjectFile) -> Iterator[str]:
    given = file.structure
    if not isinstance(given, MomentFrame):
        return
    keys = ("columns", "beams", "base_beams")
    assumed = [key for key in keys if getattr(given, key) is None]
    if not assumed:
        return
    yield worded(
        "[structure] {keys}: example sections are assumed (see `lir check`). Write your own, "
        'columns = {{ section = "HEB 300" }}, beams = {{ rectangle = ["300 mm", "600 mm"], '
        'material = "C30/37" }}',
        keys=anded(assumed),
    )


def _of_masses(file: ProjectFile) -> Iterator[str]:
    given = file.structure
    if isinstance(given, BuildingTable):
        dead = None if file.loads is None else file.loads.dead / STANDARD_GRAVITY
        named = {"floor_load": given.floor_load, "[loads] dead over gravity": dead}
        found = {key: value for key, value in named.items() if value is not None}
    elif isinstance(given, ShearBuilding):
        area = math.prod(n * w for n, w in zip(given.bays, given.bay_width, strict=True))
        masses = {f"storey_mass[{k}]": mass for k, mass in enumerate(given.storey_mass)}
        if given.base_mass is not None:
            masses["base_mass"] = given.base_mass
        found = {key: mass / area for key, mass in masses.items()} if area > 0.0 else {}
    else:
        return
    low, high = FLOOR_MASS
    strange = {k: v for k, v in found.items() if v > high or (v < low and k != "base_mass")}
    for key, value in list(strange.items())[:1]:
        unit = "is a mass in t written as kg?" if value < low else "is a mass in kg written as t?"
        yield worded(
            "[structure] {key} is {mass:.3g} kg/m2 of the plan, buildings have 300 to 1500: "
            "{unit} Write masses with their unit, 300 t or 300000 kg",
            key=key,
            mass=value,
            unit=unit,
        )


def _of_heights(file: ProjectFile) -> Iterator[str]:
    given = file.structure
    if not isinstance(given, (MomentFrame, IrregularFrame)):
        return
    low, high = STOREY
    for k, height in enumerate(given.heights, start=1):
        if not low <= height <= high:
            yield worded(
                "[structure] storey_height of storey {storey} is {height:.4g} m, outside the "
                "usual {low:g} to {high:g} m: check its unit",
                storey=k,
                height=height,
                low=low,
                high=high,
            )
            return


def _of_loads(file: ProjectFile) -> Iterator[str]:
    given = file.loads
    if given is None:
        return
    rows = [
        _Row(f"[loads] {key}", 1e-3 * load, unit, 0.0, 1e-3 * most, "which hardly any building has")
        for key, load, most, unit in (
            ("live", given.live, HEAVY_FLOOR, "kN/m2"),
            ("snow", given.snow, HEAVY_FLOOR, "kN/m2"),
            ("facade", given.facade, HEAVY_FACADE, "kN/m"),
        )
    ]
    yield from map(_said, filter(_strange, rows))


def _of_bays(file: ProjectFile) -> Iterator[str]:
    given = file.structure
    if file.bearing is None or not isinstance(given, (MomentFrame, ShearBuilding)):
        return
    each = [bearing_of(one) for one in (file.bearing, *file.bearings.values())]
    sides = [own.lateral_capacity + 2.0 * own.slider_radius for own in each]  # half of it each
    side = max((side for side in sides if math.isfinite(side)), default=0.0)
    least = min(width for count, width in zip(given.bays, given.bay_width, strict=True) if count)
    if least >= side:
        return
    yield worded(
        "[structure] bay_width = {width:.4g} m is less than the {side:.4g} m of a bearing "
        "in plan (capacity and slider diameter): check its unit",
        width=least,
        side=side,
    )


def _of_storeys(file: ProjectFile) -> Iterator[str]:
    given = file.structure
    if not isinstance(given, ShearBuilding) or len(given.storey_stiffness) != len(
        given.storey_mass
    ):
        return
    count = len(given.storey_mass)
    for k, stiffness in enumerate(given.storey_stiffness):
        above = sum(given.storey_mass[k:])
        least, most = STIFF * (count - k), SOFT * (1 + count - k)
        period = 2.0 * math.pi * math.sqrt(above / stiffness)
        if not least <= period <= most:
            bound = worded("above {bound:.3g} s", bound=least)
            if period > most:
                bound = worded("below {bound:.3g} s", bound=most)
            yield worded(
                "{key} = {stiffness:.4g} kN/mm and the {mass:.4g} t above give a period of "
                "{period:.3g} s, for storeys usually {bound}: check its unit",
                key=f"[structure] storey_stiffness[{k}]",
                stiffness=1e-6 * stiffness,
                mass=1e-3 * above,
                period=period,
                bound=bound,
            )
            return


def _of_importance(file: ProjectFile) -> Iterator[str]:
    above, spectrum = file.superstructure, file.spectrum
    if above is None:
        return
    own = getattr(spectrum, "importance", None)
    if own is None or above.importance == own:
        return
    share = above.importance / own
    yield worded(
        "[superstructure] importance = {a:g}, [spectrum] importance = {b:g}: {code} multiplies "
        "a_g by gamma_I, and only [spectrum] does. Write one value in both; {c:g} multiplies the "
        "spectrum by {share:.3g}",
        a=above.importance,
        b=own,
        code=file.project.code,
        c=above.importance,
        share=share,
    )


def _of_moat(file: ProjectFile) -> Iterator[str]:
    # A neighbour may be nearer than a wall, but not if walls are all around.
    clear, wall = file.limits.moat_gap, file.moat
    if wall is None or clear is None or clear >= wall.gap or len(set(wall.sides)) < len(SIDES):
        return
    yield worded(
        "[limits] moat_gap = {clear:.5g} mm, the clear distance checked, is less than [moat] gap "
        "= {gap:.5g} mm on all sides: write the same value if both are one wall",
        clear=1e3 * clear,
        gap=1e3 * wall.gap,
    )
