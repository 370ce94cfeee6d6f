"""From tables of members in a project's file to sections: of each kind, storey and direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames.design._errors import ProjectError
from frames.design.project.materials import Material, material_of
from frames.design.project.schema_sections import BeamsTable, ColumnsTable
from frames.model.sections import Section

if TYPE_CHECKING:
    from frames.design.project.schema_sections import CrackedTable, PropertiesTable, SectionTable

T = TypeVar("T", bound=ColumnsTable | BeamsTable)


class NamedSection(NamedTuple):
    """A section of a member with its name for people."""

    section: Section  # the section; of columns its depth lies along x or y
    # what fixes local axes of a column: None has its depth along global x
    up: tuple[float, float, float] | None
    said: str  # shape, material and stiffness in words


def named_section(given: SectionTable, *, column: bool) -> NamedSection:
    """Return the section that a table describes."""
    material = material_of(given.material)
    keys = {
        "elastic_modulus": material.elastic_modulus,
        "poisson_ratio": material.poisson_ratio,
        "density": material.density,
    }
    if given.section is not None:
        section, said = Section.catalogue(given.section, **keys), given.section
    elif given.box is not None:
        *sides, wall = given.box
        first, second = sides if len(sides) == 2 else (sides[0], sides[0])
        width, depth = (second, first) if column else (first, second)
        section = Section.box(width, depth, wall, **keys)
        said = f"box {_mm(first)} x {_mm(second)} x {_mm(wall)} mm"
    elif given.rectangle is not None:
        first, second = given.rectangle
        width, depth = (second, first) if column else (first, second)
        section = Section.rectangle(width, depth, **keys)
        said = f"rectangle {_mm(first)} x {_mm(second)} mm"
    elif given.circle is not None:
        diameter, *walls = given.circle
        section = Section.circle(diameter, walls[0] if walls else None, **keys)
        said = f"circle {_mm(diameter)}" + (f" x {_mm(walls[0])}" if walls else "") + " mm"
    elif given.i_shape is not None:
        section = Section.i_shape(*given.i_shape, **keys)
        said = "I " + " x ".join(map(_mm, given.i_shape)) + " mm"
    else:
        section, said = _by_properties(given.properties, material), "given constants"
    said = f"{said}, {material.name} (E {1e-9 * material.elastic_modulus:.4g} GPa)"
    section, cracked = cracked_said(section, given.cracked)
    up = (0.0, 1.0, 0.0) if given.depth_along == "y" else None
    return NamedSection(section, up, said + cracked)


def cracked_said(section: Section, cracked: float | CrackedTable | None) -> tuple[Section, str]:
    """Return a section with the stiffness of cracked concrete, and what is said of it."""
    if cracked is None:
        return section, ""
    bending, torsion, shear = (
        (cracked, None, None) if isinstance(cracked, float) else cracked.factors
    )
    found = section.cracked(bending, torsion=torsion, shear=shear)
    return found, f", cracked: {bending:g} of the bending stiffness"


def storeys_of(given: tuple[int, int] | None, count: int) -> range:
    """Return a range of storeys, all if none is given."""
    first, last = given or (1, count)
    if not 1 <= first <= last <= count:
        msg = (
            f"storeys = [{first}, {last}] must be a range from the lower to the upper storey, "
            f"within the {count} of the building: [1, {count}] is all"
        )
        raise ProjectError(msg)
    return range(first, last + 1)


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g}"


def _by_properties(given: PropertiesTable | None, material: Material) -> Section:
    if given is None:  # the schema has one way
        msg = "no section is given"
        raise ProjectError(msg)
    known = given.model_dump()
    areas = {key: math.inf if known[key] is None else known[key] for key in _SHEAR_AREAS}
    return Section(
        **(known | areas),
        elastic_modulus=material.elastic_modulus,
        shear_modulus=material.shear_modulus,
        density=material.density,
    )


_SHEAR_AREAS = ("shear_area_y", "shear_area_z")


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
                    f"storey {storey}{which} has two sections: give each storey one, by "
                    "storeys = [first, last]" + ("" if direction is None else " and direction")
                )
                raise ProjectError(msg)
            found[storey - 1] = one
    chosen = [one for one in found if one is not None]
    if len(chosen) < storeys:
        msg = (
            f"storey {found.index(None) + 1}{which} has no section: give one for each of "
            f"the {storeys} storeys"
        )
        raise ProjectError(msg)
    return chosen
