"""Tubes and pipes of steel that are filled with concrete: one section of the steel's material."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames._remedies import argument
from frames.exchange.building import Modifiers
from frames.exchange.section_shapes import shape_constants, with_constants

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames.exchange.building import FrameSection, Material
    from frames.exchange.tables import Row

PIPE = "filled steel pipe"
SHAPES = ("filled steel tube", PIPE)
"""Shapes that are filled, in lower case."""


def filled_section(
    row: Row,
    name: str,
    sizes: tuple[float, float, float, float],
    steel: Material,
    fill: Material,
) -> FrameSection:
    """Return the section of a filled tube or pipe, transformed to its steel.

    Areas and inertias of the concrete count by its modulus over that of the steel, uncracked and
    bonded; torsion and shear by the shear moduli, each part for itself. Factors on mass and weight
    make them those of both materials.
    """
    shape = row.text("SHAPE")
    solid, hollow = ("circle", "pipe") if shape.strip().lower() == PIPE else ("rectangular", "tube")
    depth, width, _, web = sizes
    inner = (depth - 2.0 * web, width - 2.0 * web, 0.0, 0.0)
    try:
        wall = shape_constants(hollow, sizes, steel.poisson_ratio)
        core = shape_constants(solid, inner, fill.poisson_ratio)
    except ModelError as cause:
        msg = f'section "{name}": {cause}'
        raise row.error(msg) from cause
    if wall is None or core is None:
        message = (
            f'section "{name}": TF = {sizes[2]:g} m and TW = {web:g} m differ; known are filled '
            f"tubes of one thickness: give its constants, {argument('sections', {name: ...})}"
        )
        raise row.error(message)
    stretch = fill.elastic_modulus / steel.elastic_modulus
    shear = fill.shear_modulus / steel.shear_modulus
    area = wall.area + stretch * core.area

    def share(value: Callable[[Material], float], word: str) -> float:
        # What both weigh over what the transformed area of steel alone would.
        own, inside = value(steel), value(fill)
        if own <= 0.0:
            if inside <= 0.0:
                return 1.0
            msg = f'section "{name}": its steel "{steel.name}" has no {word}, its concrete has'
            raise row.error(msg)
        return (own * wall.area + inside * core.area) / (own * area)

    return replace(
        with_constants(name, steel.name, shape, wall, sizes),
        area=area,
        torsion=wall.torsion_constant + shear * core.torsion_constant,
        inertia_33=wall.inertia_y + stretch * core.inertia_y,
        inertia_22=wall.inertia_z + stretch * core.inertia_z,
        shear_2=wall.shear_area_z + shear * core.shear_area_z,
        shear_3=wall.shear_area_y + shear * core.shear_area_y,
        modifiers=Modifiers(
            mass=share(lambda matter: matter.density, "mass"),
            weight=share(lambda matter: matter.weight, "weight"),
        ),
    )
