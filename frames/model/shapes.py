"""What ready-made sections share: checked dimensions, and constants of shapes."""

from __future__ import annotations

import math

from frames._errors import ModelError
from lir_element.argument_checks import require_finite, require_positive
from lir_element.units import meant

LARGEST_SIDE = 100.0
"""Outer dimension of a ready-made shape that no member has [m]."""


def dimensions(where: str, **values: float) -> tuple[float, ...]:
    """Return outer dimensions [m] once they are positive and possible."""
    remedy = "give the outer dimensions in metres"
    for name, value in values.items():
        if (
            require_positive(f"{where}: {name}", value, remedy=remedy, error=ModelError)
            > LARGEST_SIDE
        ):
            message = (
                f"{where}: {name} = {value:g} m, at most {LARGEST_SIDE:g} m: "
                f"{meant(value, 'm', 1e-3, 10.0)}"
            )
            raise ModelError(message)
    return tuple(values.values())


def shear_modulus_of(elastic_modulus: float, poisson_ratio: float) -> float:
    """Return the shear modulus of an isotropic material [Pa]."""
    ratio = require_finite("poisson_ratio", poisson_ratio, error=ModelError)
    if not -1.0 < ratio <= 0.5:
        message = f"poisson_ratio = {ratio:g} must lie in (-1, 0.5]: steel has 0.3, concrete 0.2"
        raise ModelError(message)
    return require_positive(
        "elastic_modulus", elastic_modulus, remedy="give Pa", error=ModelError
    ) / (2.0 * (1.0 + ratio))


def circle_constants(
    diameter: float, thickness: float | None, poisson_ratio: float
) -> tuple[float, float, float]:
    """Return the constants of a circle, or of a tube."""
    (outer,) = dimensions("Section.circle", diameter=diameter)
    inner = 0.0
    if thickness is not None:
        (wall,) = dimensions("Section.circle", thickness=thickness)
        if 2.0 * wall >= outer:
            message = (
                f"Section.circle: thickness = {wall:g} m must be less than half the diameter, "
                f"{outer / 2.0:g} m: leave it out for a solid section"
            )
            raise ModelError(message)
        inner = outer - 2.0 * wall
    area = math.pi / 4.0 * (outer**2 - inner**2)
    inertia = math.pi / 64.0 * (outer**4 - inner**4)
    m, nu = (inner / outer) ** 2, poisson_ratio
    share = 6.0 * (1.0 + nu) * (1.0 + m) ** 2
    share /= (7.0 + 6.0 * nu) * (1.0 + m) ** 2 + (20.0 + 12.0 * nu) * m
    return area, inertia, share * area


def i_shape_constants(
    depth: float, flange_width: float, flange_thickness: float, web_thickness: float
) -> dict[str, float]:
    """Return the constants of a doubly symmetric I shape without fillets, web along local z."""
    d, b, tf, tw = dimensions(
        "Section.i_shape",
        depth=depth,
        flange_width=flange_width,
        flange_thickness=flange_thickness,
        web_thickness=web_thickness,
    )
    if 2.0 * tf >= d or tw > b:
        message = (
            f"Section.i_shape: flange_thickness = {tf:g} m must be less than half the depth, "
            f"{d / 2.0:g} m, and web_thickness = {tw:g} m not more than flange_width = "
            f"{b:g} m: check the order (depth, flange_width, flange_thickness, web_thickness)"
        )
        raise ModelError(message)
    web = d - 2.0 * tf
    return {
        "area": 2.0 * b * tf + web * tw,
        "inertia_y": (b * d**3 - (b - tw) * web**3) / 12.0,
        "inertia_z": (2.0 * tf * b**3 + web * tw**3) / 12.0,
        "torsion_constant": (2.0 * b * tf**3 + (d - tf) * tw**3) / 3.0,
        "shear_area_y": 5.0 / 6.0 * 2.0 * b * tf,
        "shear_area_z": (d - tf) * tw,
    }
