"""Whether the values of a project's file can be those of a building: doubts before it is run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.design.codes.analysis import least_strength
from frames.design.project.inputs import bearing_of
from frames.design.project.schema import MomentFrame, ShearBuilding
from frames.design.project.schema_bearing import SIDES
from frames.design.project.schema_structure import BuildingTable, IrregularFrame
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.project.schema import ProjectFile

SOFT = 0.5
"""Period of what is on a storey over the number of storeys above its floor and one more [s], from
which on it is strange: whole buildings have about 0.1 s a storey."""

STIFF = 0.005
"""The same over the number of storeys above its floor [s], up to which it is strange."""

FLOOR_MASS = (50.0, 6000.0)
"""Mass of a storey over its plan [kg/m2]; buildings have 300 to 1500."""

STOREY = (2.0, 20.0)
"""Height of storeys that buildings have [m]."""

HEAVY_FLOOR, HEAVY_FACADE = 25e3, 60e3
"""Live load or snow [N/m2], and facade [N/m], from which on they are strange."""


def file_doubts(file: ProjectFile) -> tuple[str, ...]:
    """Return what is strange about a project's file, a sentence for each thing."""
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
        f"[superstructure] wind_shear = {1e-3 * wind:.4g} kN is above {1e-3 * holds:.4g} kN, with "
        "which all bearings slide at the lower bound of friction: the isolation slides in wind. "
        "Raise the friction, add a wind restraint, or look at the unit of wind_shear",
    )


def _of_sections(file: ProjectFile) -> list[str]:
    given = file.structure
    if not isinstance(given, MomentFrame):
        return []
    keys = ("columns", "beams", "base_beams")
    assumed = [key for key in keys if getattr(given, key) is None]
    if not assumed:
        return []
    return [
        f"[structure] {' and '.join(assumed)}: no section is given, those of an example are "
        "assumed (`lir check` shows them), whatever the building carries: give each its section, "
        'columns = { section = "HEB 300" }, beams = { rectangle = ["300 mm", "600 mm"], '
        'material = "C30/37" }'
    ]


def _of_masses(file: ProjectFile) -> list[str]:
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
        return []
    low, high = FLOOR_MASS
    strange = {k: v for k, v in found.items() if v > high or (v < low and k != "base_mass")}
    if not strange:
        return []
    key, value = next(iter(strange.items()))
    unit = "is a mass in t written as kg?" if value < low else "is a mass in kg written as t?"
    return [
        f"[structure] {key} is {value:.3g} kg on each m2 of the plan, buildings have 300 to 1500: "
        f"{unit} Masses are written with their unit, 300 t or 300000 kg"
    ]


def _of_heights(file: ProjectFile) -> list[str]:
    given = file.structure
    if not isinstance(given, (MomentFrame, IrregularFrame)):
        return []
    low, high = STOREY
    for k, height in enumerate(given.heights, start=1):
        if not low <= height <= high:
            return [
                f"[structure] storey_height of storey {k} is {height:.4g} m, storeys have {low:g} "
                f"to {high:g} m: look at its unit"
            ]
    return []


def _of_loads(file: ProjectFile) -> list[str]:
    given = file.loads
    if given is None:
        return []
    named = {
        "live": (given.live, HEAVY_FLOOR, "kN/m2"),
        "snow": (given.snow, HEAVY_FLOOR, "kN/m2"),
        "facade": (given.facade, HEAVY_FACADE, "kN/m"),
    }
    for key, (load, most, unit) in named.items():
        if load > most:
            return [
                f"[loads] {key} = {1e-3 * load:.4g} {unit} is more than {1e-3 * most:g} {unit}, "
                "which hardly any building has: look at its unit"
            ]
    return []


def _of_bays(file: ProjectFile) -> list[str]:
    given = file.structure
    if file.bearing is None or not isinstance(given, (MomentFrame, ShearBuilding)):
        return []
    each = [bearing_of(one) for one in (file.bearing, *file.bearings.values())]
    sides = [own.lateral_capacity + 2.0 * own.slider_radius for own in each]  # plates go half of it
    side = max((side for side in sides if math.isfinite(side)), default=0.0)
    least = min(width for count, width in zip(given.bays, given.bay_width, strict=True) if count)
    if least >= side:
        return []
    return [
        f"[structure] bay_width = {least:.4g} m is less than the {side:.4g} m that a bearing takes "
        "in plan (capacity and the diameter of the slider): look at its unit"
    ]


def _of_storeys(file: ProjectFile) -> list[str]:
    given = file.structure
    if not isinstance(given, ShearBuilding) or len(given.storey_stiffness) != len(
        given.storey_mass
    ):
        return []
    count = len(given.storey_mass)
    for k, stiffness in enumerate(given.storey_stiffness):
        above = sum(given.storey_mass[k:])
        period, most = 2.0 * math.pi * math.sqrt(above / stiffness), SOFT * (1 + count - k)
        if period < STIFF * (count - k):
            return [
                f"[structure] storey_stiffness[{k}] = {1e-6 * stiffness:.4g} kN/mm lets the "
                f"{1e-3 * above:.4g} t above it swing with {period:.3g} s; storeys of buildings "
                f"stay above {STIFF * (count - k):.3g} s: look at its unit"
            ]
        if period > most:
            return [
                f"[structure] storey_stiffness[{k}] = {1e-6 * stiffness:.4g} kN/mm lets the "
                f"{1e-3 * above:.4g} t above it swing with {period:.3g} s; storeys of buildings "
                f"stay below {most:.3g} s: look at its unit"
            ]
    return []


def _of_importance(file: ProjectFile) -> list[str]:
    above, spectrum = file.superstructure, file.spectrum
    if above is None:
        return []
    own = getattr(spectrum, "importance", None)
    if own is None or above.importance == own:
        return []
    share = above.importance / own
    return [
        f"[superstructure] importance = {above.importance:g}, [spectrum] importance = "
        f"{own:g}: {file.project.code} multiplies a_g by gamma_I, which only the spectrum's "
        f"does; if {above.importance:g} is meant, the spectrum is to be multiplied by {share:.3g}: "
        "give both sections the same"
    ]


def _of_moat(file: ProjectFile) -> list[str]:
    # A neighbour may be nearer than a wall, but not where walls stand all around.
    clear, wall = file.limits.moat_gap, file.moat
    if wall is None or clear is None or clear >= wall.gap or len(set(wall.sides)) < len(SIDES):
        return []
    return [
        f"[limits] moat_gap = {1e3 * clear:.5g} mm, [moat] gap = {1e3 * wall.gap:.5g} mm: walls "
        "all around stand farther off than the clear distance that is checked; give both the same "
        "if they are of one wall"
    ]
