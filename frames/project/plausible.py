"""Whether the values of a project's file can be those of a building: doubts before it is run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.project.schema import En1998Spectrum, MomentFrame, ShearBuilding

if TYPE_CHECKING:
    from frames.checks.bounds import PropertyBounds
    from frames.checks.isolation import IsolationSystem
    from frames.project.schema import ProjectFile

FLOOR_MASS = (50.0, 6000.0)
"""Mass of a storey over its plan [kg/m2]; buildings have 300 to 1500."""


def file_doubts(file: ProjectFile) -> tuple[str, ...]:
    """Return what is strange about a project's file, a sentence for each thing.

    Parameters
    ----------
    file : ProjectFile
        The file.

    Returns
    -------
    tuple of str
        About masses of storeys by area, and an importance that is in one section alone.
    """
    return (*_of_masses(file), *_of_importance(file))


def wind_doubts(
    file: ProjectFile, system: IsolationSystem, bounds: PropertyBounds
) -> tuple[str, ...]:
    """Return whether the wind of a project slides its bearings.

    Parameters
    ----------
    file : ProjectFile
        The file, its wind shear in ``[superstructure]``.
    system : IsolationSystem
        The bearings with their average loads, friction nominal.
    bounds : PropertyBounds
        Factors on friction; the lower one counts.

    Returns
    -------
    tuple of str
        At most one sentence.
    """
    wind = 0.0 if file.superstructure is None else file.superstructure.wind_shear
    holds = bounds.friction.lower * system.strength
    if wind <= holds:
        return ()
    return (
        f"[superstructure] wind_shear = {1e-3 * wind:.4g} kN is above {1e-3 * holds:.4g} kN, with "
        "which all bearings slide at the lower bound of friction: the isolation slides in wind. "
        "Raise the friction, add a wind restraint, or look at the unit of wind_shear",
    )


def _of_masses(file: ProjectFile) -> list[str]:
    given = file.structure
    if isinstance(given, MomentFrame):
        found = {"floor_load": given.floor_load}
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


def _of_importance(file: ProjectFile) -> list[str]:
    above, spectrum = file.superstructure, file.spectrum
    if above is None or not isinstance(spectrum, En1998Spectrum):
        return []
    if above.importance == spectrum.importance:
        return []
    share = above.importance / spectrum.importance
    return [
        f"[superstructure] importance = {above.importance:g}, [spectrum] importance = "
        f"{spectrum.importance:g}: EN 1998 multiplies a_g by gamma_I, which only the spectrum's "
        f"does; if {above.importance:g} is meant, the spectrum is to be multiplied by {share:.3g}: "
        "give both sections the same"
    ]
