"""Constants of the cross-sections that a file gives by shape and dimensions alone."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames._remedies import argument
from frames.exchange.building import FrameSection
from frames.model.rolled_shapes import catalogue_dimensions
from frames.model.sections import Section

if TYPE_CHECKING:
    from frames.exchange.tables import Row

_SOLID = {"rectangular", "concrete rectangular", "steel plate", "steel rod rectangular"}
_ROUND = {"circle", "concrete circle", "steel rod", "steel solid rod"}
_I = {"i/wide flange", "steel i/wide flange", "i section"}
_TUBE = {"box/tube", "tube", "steel tube"}
_PIPE = {"pipe", "steel pipe"}
_ROLLED = re.compile(r"(IPE|HE)[ABM]?\s*\d+\s*[ABM]?", re.IGNORECASE)
_ANY = 1e9  # Pa: the constants of a shape are those of any material but for its Poisson's ratio


def shape_constants(
    shape: str, sizes: tuple[float, float, float, float], poisson_ratio: float
) -> Section | None:
    """Return the constants of a shape."""
    word = shape.strip().lower()
    depth, width, flange, web = sizes
    if word in _SOLID:
        return Section.rectangle(width, depth, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _ROUND:
        return Section.circle(depth, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _I:
        return Section.i_shape(
            depth, width, flange, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio
        )
    if word in _TUBE and math.isclose(flange, web, rel_tol=1e-6):
        return Section.box(width, depth, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _PIPE:
        return Section.circle(depth, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if _ROLLED.fullmatch(word):
        return Section.catalogue(word, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    return None


def section_by_shape(
    row: Row,
    name: str,
    material: str,
    shape: str,
    sizes: tuple[float, float, float, float],
    poisson_ratio: float,
) -> FrameSection:
    """Return a cross-section that is given by its shape."""
    try:
        if not sizes[0] and _ROLLED.fullmatch(shape.strip()):
            depth, width, flange, web, _ = catalogue_dimensions(shape)
            sizes = (depth, width, flange, web)
        found = shape_constants(shape, sizes, poisson_ratio)
    except ModelError as cause:
        msg = f'section "{name}": {cause}'
        raise row.error(msg) from cause
    if found is None:
        message = (
            f'section "{name}" is a "{shape}" without Area, I33, I22 and torsion constant: known '
            "by dimensions are rectangles, circles, I shapes, tubes of one thickness and pipes, by "
            "name IPE, HEA, HEB and HEM; define it as a general section, or of an ETABS model give "
            f"its constants, {argument('sections', {name: ...})}, or the file of the program that "
            f"has them, {argument('library', ['AISC14.xml'])}"
        )
        raise row.error(message)
    return with_constants(name, material, shape, found, sizes)


def with_constants(
    name: str,
    material: str,
    shape: str,
    found: Section,
    sizes: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
) -> FrameSection:
    """Return a cross-section with the constants of a section, whose local z is axis 2."""
    depth = sizes[0] or math.sqrt(12.0 * found.inertia_y / found.area)
    width = sizes[1] or sizes[0] or found.area / depth
    return FrameSection(
        name=name,
        material=material,
        shape=shape,
        area=found.area,
        torsion=found.torsion_constant,
        inertia_33=found.inertia_y,
        inertia_22=found.inertia_z,
        shear_2=found.shear_area_z,
        shear_3=found.shear_area_y,
        depth=depth,
        width=width,
    )
