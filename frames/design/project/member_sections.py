"""From tables of members in a project's file to sections: of each kind, storey and direction."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames.design._errors import ProjectError
from frames.design.project.schema_sections import BeamsTable, ColumnsTable
from frames.model.sections import Section
from frames.model.shapes import catalogue_dimensions
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames.design.project.schema_sections import (
        CrackedTable,
        HingesTable,
        MaterialTable,
        SectionTable,
    )
    from frames.model.laws import PlasticHinge

EUROPEAN_STEELS = ("S235", "S275", "S355", "S420", "S450", "S460")
"""Grades with E = 210 GPa, G = 81 GPa as of nu = 0.3 (EN 1993-1-1:2005, 3.2.6)."""

AMERICAN_STEELS = ("A36", "A500", "A572", "A913", "A992")
"""Grades with E = 29,000 ksi, here 200 GPa (ANSI/AISC 360-16, table of symbols)."""

CONCRETE_CLASSES = (
    *("C12/15", "C16/20", "C20/25", "C25/30", "C30/37", "C35/45", "C40/50", "C45/55", "C50/60"),
    *("C55/67", "C60/75", "C70/85", "C80/95", "C90/105"),
)
"""Classes of EN 1992-1-1:2004, table 3.1: E_cm = 22 GPa (f_cm / 10)^0.3, f_cm = f_ck + 8 [MPa]."""

DEFAULT_STEEL = "A992"
"""Material of rolled, welded and hollow shapes of which none is named."""


class Material(NamedTuple):
    """Elastic constants of a material."""

    name: str  # as the file calls it
    elastic_modulus: float  # [Pa]
    shear_modulus: float  # [Pa]
    poisson_ratio: float  # [-]
    density: float  # [kg/m3]


def material_of(given: str | MaterialTable | None) -> Material:
    """Return a material by its name or its numbers."""
    if given is None:
        given = DEFAULT_STEEL
    if not isinstance(given, str):
        modulus = given.E
        shear = modulus / (2.0 * (1.0 + (given.nu or 0.0))) if given.G is None else given.G
        ratio = modulus / (2.0 * shear) - 1.0
        if not 0.0 <= ratio < 0.5:
            msg = (
                f"material: E = {1e-9 * modulus:g} GPa and G = {1e-9 * shear:g} GPa give Poisson's "
                f"ratio {ratio:.3g}, which must be at least 0 and below 0.5: check G"
            )
            raise ProjectError(msg)
        return Material("own material", modulus, shear, ratio, given.density)
    if given in EUROPEAN_STEELS or given in AMERICAN_STEELS:
        modulus = 210e9 if given in EUROPEAN_STEELS else 200e9
        return Material(given, modulus, modulus / 2.6, 0.3, 7850.0)
    if given in CONCRETE_CLASSES:
        mean = float(re.split(r"[C/]", given)[1]) + 8.0  # f_cm [MPa]
        modulus = 22e9 * (mean / 10.0) ** 0.3
        return Material(given, modulus, modulus / 2.4, 0.2, 2500.0)
    known = (*EUROPEAN_STEELS, *AMERICAN_STEELS, *CONCRETE_CLASSES)
    near = difflib.get_close_matches(given, known, n=1, cutoff=0.5)
    meant = f'is "{near[0]}" meant?' if near else f"choose one of {', '.join(known)}"
    msg = (
        f'material = "{given}" is not known: {meant} For other materials write {{ E = "30 GPa", nu '
        f'= 0.2, density = "2500 kg/m3" }}'
    )
    raise ProjectError(msg)


T = TypeVar("T", bound=ColumnsTable | BeamsTable)


class NamedSection(NamedTuple):
    """A section of a member with its name for people."""

    section: Section  # the section; of columns its depth is along x or y
    # vector that fixes local axes of a column: None has its depth along global x
    up: tuple[float, float, float] | None
    said: str  # shape, material and stiffness in words


def named_section(given: SectionTable, *, column: bool) -> NamedSection:
    """Return the section that a table describes."""
    material = material_of(given.material)
    elastic = {"elastic_modulus": material.elastic_modulus, "density": material.density}
    keys = elastic | {"poisson_ratio": material.poisson_ratio}
    if given.section is not None:
        section, shape = Section.catalogue(given.section, **keys), given.section
    elif given.box is not None:
        *sides, wall = given.box
        first, second = sides if len(sides) == 2 else (sides[0], sides[0])
        width, depth = (second, first) if column else (first, second)
        section = Section.box(width, depth, wall, **keys)
        shape = worded("box {size} mm", size=_mm(first, second, wall))
    elif given.rectangle is not None:
        first, second = given.rectangle
        width, depth = (second, first) if column else (first, second)
        section = Section.rectangle(width, depth, **keys)
        shape = worded("rectangle {size} mm", size=_mm(first, second))
    elif given.circle is not None:
        diameter, *walls = given.circle
        section = Section.circle(diameter, walls[0] if walls else None, **keys)
        shape = worded("circle {size} mm", size=_mm(diameter, *walls))
    elif given.i_shape is not None:
        section = Section.i_shape(*given.i_shape, **keys)
        shape = worded("I {size} mm", size=_mm(*given.i_shape))
    elif given.properties is not None:
        section = given.properties.made(shear_modulus=material.shear_modulus, **elastic)
        shape = "given constants"
    section, cracked = cracked_said(section, given.cracked)
    up = (0.0, 1.0, 0.0) if given.depth_along == "y" else None
    hinged = "with plastic hinges" if getattr(given, "hinges", None) else ""
    said = joined(shape, of_material(material), cracked, hinged, by=", ")
    return NamedSection(section, up, said)


def hinge_of(given: SectionTable, hinges: HingesTable, *, column: bool) -> PlasticHinge:
    """Return the hinge of a table, on its section.

    A yield stress gives the plastic moments of the shape without fillets, and for columns the
    squash load. Floors resist the axial force of beams.
    """
    if hinges.yield_stress is None:
        return hinges.made()  # type: ignore[no-any-return]
    strength, moduli = hinges.yield_stress, _plastic_moduli(given, column=column)
    moments = dict(zip(("moment_y", "moment_z"), (strength * each for each in moduli), strict=True))
    if column:
        moments["axial"] = strength * named_section(given, column=True).section.area
    return hinges.made(**moments)  # type: ignore[no-any-return]


def _plastic_moduli(given: SectionTable, *, column: bool) -> tuple[float, float]:
    # About local y and z [m3].
    def solid(width: float, depth: float) -> tuple[float, float]:
        return 0.25 * width * depth**2, 0.25 * depth * width**2

    if given.circle is not None:
        diameter, *walls = given.circle
        inner = diameter - 2.0 * walls[0] if walls else 0.0
        return ((diameter**3 - inner**3) / 6.0,) * 2
    if given.section is not None or given.i_shape is not None:
        shape = given.i_shape or catalogue_dimensions(str(given.section))[:4]
        depth, width, flange, web = shape
        inner = depth - 2.0 * flange
        strong = width * flange * (depth - flange) + 0.25 * web * inner**2
        return strong, 0.5 * flange * width**2 + 0.25 * inner * web**2
    if given.box is None and given.rectangle is None:
        msg = (
            "hinges.yield_stress needs plastic moduli, and `properties` have none: write "
            "moment_y and moment_z"
        )
        raise ProjectError(msg)
    *sides, wall = given.box or (*(given.rectangle or ()), 0.0)
    width, depth = (sides[-1], sides[0]) if column else (sides[0], sides[-1])
    hole = solid(width - 2.0 * wall, depth - 2.0 * wall) if wall else (0.0, 0.0)
    strong, weak = (one - less for one, less in zip(solid(width, depth), hole, strict=True))
    return strong, weak


def cracked_said(section: Section, cracked: float | CrackedTable | None) -> tuple[Section, str]:
    """Return a section with the stiffness of cracked concrete, and its statement."""
    if cracked is None:
        return section, ""
    bending, torsion, shear = (
        (cracked, None, None) if isinstance(cracked, float) else cracked.factors
    )
    found = section.cracked(bending, torsion=torsion, shear=shear)
    return found, bending_said(bending)


def bending_said(bending: float) -> str:
    """Return the statement on cracked concrete."""
    return worded("cracked: {share:g} of the bending stiffness", share=bending)


def of_material(material: Material) -> str:
    """Return a material with its elastic modulus in words."""
    modulus = 1e-9 * material.elastic_modulus
    return worded("{material} (E {modulus:.4g} GPa)", material=material.name, modulus=modulus)


def storeys_said(storeys: tuple[int, int] | None) -> str:
    """Return a range of storeys in words; nothing of all."""
    if storeys is None:
        return ""
    return worded("storeys {first} to {last}", first=storeys[0], last=storeys[1])


def storeys_of(given: tuple[int, int] | None, count: int) -> range:
    """Return a range of storeys, all if none is given."""
    first, last = given or (1, count)
    if not 1 <= first <= last <= count:
        msg = (
            f"storeys = [{first}, {last}] must be a range from the lower to the upper storey, "
            f"within 1 to {count}: write [1, {count}] for all"
        )
        raise ProjectError(msg)
    return range(first, last + 1)


def _mm(*lengths: float) -> str:
    return " x ".join(f"{1e3 * length:.5g}" for length in lengths)


def by_storey(given: Sequence[T], storeys: int, direction: str | None = None) -> list[T]:
    """Return the table of each storey, 1 first."""
    found: list[T | None] = [None] * storeys
    which = "" if direction is None else f", beams along {direction},"
    for one in given:
        own = getattr(one, "direction", None)
        if direction is not None and own not in {None, direction}:
            continue
        for storey in storeys_of(one.storeys, storeys):
            if found[storey - 1] is not None:
                msg = (
                    f"storey {storey}{which} has two sections: limit them by storeys = [first, "
                    "last]" + ("" if direction is None else " and direction")
                )
                raise ProjectError(msg)
            found[storey - 1] = one
    chosen = [one for one in found if one is not None]
    if len(chosen) < storeys:
        msg = (
            f"storey {found.index(None) + 1}{which} has no section: write sections for each of the "
            f"{storeys} storeys"
        )
        raise ProjectError(msg)
    return chosen
