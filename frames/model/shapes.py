"""Constants of ready-made shapes, rolled ones with their fillets, and checked dimensions."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, fields, replace
from typing import Self

from frames._errors import ModelError, likely
from lir_element.argument_checks import (
    require_finite,
    require_non_negative,
    require_positive,
)
from lir_element.fields import check_numbers, number
from lir_element.texts import html_table
from lir_element.units import meant

LARGEST_SIDE = 100.0
"""Outer dimension of a ready-made shape that no member has [m]."""


def dimensions(where: str, **values: float) -> tuple[float, ...]:
    """Return outer dimensions [m] once they are positive and possible."""
    remedy = "give the outer dimensions in m"
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
            f"Section.i_shape: flange_thickness = {tf:g} m must be below half the depth, "
            f"{d / 2.0:g} m, web_thickness = {tw:g} m at most flange_width = {b:g} m: check "
            "the order of the arguments"
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


SOFTEST, LARGEST_AREA = 1e6, 500.0
"""Elastic modulus [Pa] below, and area [m2] above which no member is."""

_NEEDED = "use SI units"
_SHEARED = "give m2, or leave it out to neglect shear deformation"
_INERTIA = number("m4", "(0, inf)", remedy=_NEEDED)
_MODULUS = number("Pa", "(0, inf)", remedy=_NEEDED)
_SHEAR_AREA = number("m2", "(0, inf]", remedy=_SHEARED)
_DENSITY = number("kg/m3", "[0, inf)", remedy="give kg/m3, or 0 for a member without mass")


@dataclass(frozen=True)
class SectionConstants:
    """Fields of `Section`; its docstring has the meaning of each."""

    area: float = field(metadata=number("m2", "(0, inf)", remedy=_NEEDED))
    inertia_y: float = field(metadata=_INERTIA)
    inertia_z: float = field(metadata=_INERTIA)
    torsion_constant: float = field(metadata=_INERTIA)
    elastic_modulus: float = field(metadata=_MODULUS)
    shear_modulus: float = field(metadata=_MODULUS)
    density: float = field(default=0.0, metadata=_DENSITY)
    shear_area_y: float = field(default=math.inf, metadata=_SHEAR_AREA)
    shear_area_z: float = field(default=math.inf, metadata=_SHEAR_AREA)

    def __post_init__(self) -> None:
        """Check every number."""
        check_numbers(self, error=ModelError, owner="Section.")
        for each in fields(self):
            object.__setattr__(self, each.name, float(getattr(self, each.name)))
        self._refuse_units()

    def _refuse_units(self) -> None:
        # Moduli that no material has, areas that no member has; sections of modulus 1, with
        # stiffnesses in the place of areas, and rigid ones pass.
        if self.elastic_modulus < SOFTEST and self.area < LARGEST_AREA:
            message = (
                f"Section.elastic_modulus = {self.elastic_modulus:g} Pa is softer than rubber: "
                f"{meant(self.elastic_modulus, 'Pa', 1e9, 5e11)}; steel has 200e9, "
                "concrete 30e9"
            )
            raise ModelError(message)
        if self.area > LARGEST_AREA and self.density > 0.0 and self.elastic_modulus > SOFTEST:
            message = (
                f"Section.area = {self.area:g} m2, at most {LARGEST_AREA:g} m2 for a member with "
                f"mass: {meant(self.area, 'm2', 1e-5, 20.0)}"
            )
            raise ModelError(message)

    def _repr_html_(self) -> str:
        def text(value: float) -> str:
            return "not counted" if math.isinf(value) else f"{value:.4g}"

        rows = [
            (f.name.replace("_", " "), text(getattr(self, f.name)), f.metadata["unit"])
            for f in fields(self)
        ]
        return html_table("Section", rows)

    def cracked(
        self, bending: float, *, torsion: float | None = None, shear: float | None = None
    ) -> Self:
        """Return the section with the effective stiffness of cracked concrete.

        Codes give factors, such as 0.5 for bending and shear (EN 1998-1:2004, 4.3.1(7)), or 0.7 for
        the bending of columns and 0.35 of beams (ACI 318-19, table 6.6.3.1.1(a)).

        Parameters
        ----------
        bending : float
            Factor on both second moments of area [-], in (0, 1].
        torsion, shear : float, optional
            Factors on the torsion constant and on the shear areas [-], in (0, 1]; that of bending
            if None.

        Returns
        -------
        Section
            The same section; area and density stay.

        Raises
        ------
        ModelError
            If a factor is out of bounds.
        """
        given = {"bending": bending, "torsion": torsion, "shear": shear}
        factors = {name: bending if value is None else value for name, value in given.items()}
        for name, value in factors.items():
            if not 0.0 < value <= 1.0:
                msg = f"{name} = {value:g} must lie in (0, 1]: 0.5 is half the uncracked stiffness"
                raise ModelError(msg)
        return replace(
            self,
            inertia_y=factors["bending"] * self.inertia_y,
            inertia_z=factors["bending"] * self.inertia_z,
            torsion_constant=factors["torsion"] * self.torsion_constant,
            shear_area_y=factors["shear"] * self.shear_area_y,
            shear_area_z=factors["shear"] * self.shear_area_z,
        )


SERIES = ("IPE", "HEA", "HEB", "HEM")
"""Series with parallel flanges in `Section.catalogue`."""

_FILLET_AREA = 1.0 - math.pi / 4.0  # r^2, of the part between two walls and a quarter circle
_FILLET_PLACE = (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi)  # r, of its centroid from a wall
_FILLET_INERTIA = 1.0 - 5.0 * math.pi / 16.0 - _FILLET_AREA * _FILLET_PLACE**2  # r^4, about it


def rolled_i_constants(
    depth: float,
    flange_width: float,
    flange_thickness: float,
    web_thickness: float,
    radius: float,
) -> dict[str, float]:
    r"""Return the constants of a rolled I shape with parallel flanges.

    Area and second moments are exact, fillets included. The torsion constant is that of El Darwish
    & Johnston, Torsion of structural shapes, J. Struct. Div. ASCE 91 (1965), as catalogues have it:

    .. math::
        I_t = \tfrac23 (b - 0.63 t_f) t_f^3 + \tfrac13 (h - 2 t_f) t_w^3
        + 2 \frac{t_w}{t_f} \Bigl(0.145 + 0.1 \frac{r}{t_f}\Bigr) D^4, \quad
        D = \frac{(r + t_w/2)^2 + (r + t_f)^2 - r^2}{2 r + t_f}
    """
    where = "Section.rolled_i"
    d, b, tf, tw = dimensions(
        where,
        depth=depth,
        flange_width=flange_width,
        flange_thickness=flange_thickness,
        web_thickness=web_thickness,
    )
    r = require_non_negative(f"{where}: radius [m]", radius, error=ModelError)
    web = d - 2.0 * tf
    if 2.0 * r >= web or tw + 2.0 * r > b:
        message = (
            f"{where}: flanges 2 x {tf:g} m and fillets 2 x {r:g} m exceed the depth {d:g} "
            f"m, or web {tw:g} m and fillets the flange_width = {b:g} m: check the order of "
            "the arguments"
        )
        raise ModelError(message)
    corner = _FILLET_AREA * r**2
    across, along = 0.5 * tw + _FILLET_PLACE * r, 0.5 * web - _FILLET_PLACE * r
    own = _FILLET_INERTIA * r**4
    circle = ((r + 0.5 * tw) ** 2 + (r + tf) ** 2 - r**2) / (2.0 * r + tf)
    return {
        "area": 2.0 * b * tf + web * tw + 4.0 * corner,
        "inertia_y": (b * d**3 - (b - tw) * web**3) / 12.0 + 4.0 * (own + corner * along**2),
        "inertia_z": (2.0 * tf * b**3 + web * tw**3) / 12.0 + 4.0 * (own + corner * across**2),
        "torsion_constant": 2.0 / 3.0 * (b - 0.63 * tf) * tf**3
        + web * tw**3 / 3.0
        + 2.0 * tw / tf * (0.145 + 0.1 * r / tf) * circle**4,
        "shear_area_y": 5.0 / 6.0 * 2.0 * b * tf,
        "shear_area_z": (d - tf) * tw,
    }


def catalogue_dimensions(name: str) -> tuple[float, float, float, float, float]:
    """Return the dimensions of a rolled shape by its name."""
    try:
        import steel_sections
    except ImportError as cause:
        message = (
            'Section.catalogue needs steel-sections: pip install "lir-dcfp[sections]", or '
            "use Section.rolled_i with dimensions"
        )
        raise ImportError(message) from cause
    wanted = re.sub(r"[^A-Z0-9]", "", str(name).upper())
    wanted = re.sub(r"^HE(\d+)([ABM])$", r"HE\2\1", wanted)
    known = {
        row.section.replace(" ", ""): row
        for series in SERIES
        for row in steel_sections.series(series)
    }
    if wanted not in known:
        message = (
            f'there is no rolled shape "{name}" among {", ".join(SERIES)} '
            f"({likely(wanted, known)}): for another one use Section.rolled_i"
        )
        raise ModelError(message)
    row = known[wanted]
    d, b, tf, tw, r = (1e-3 * x for x in (row.h_mm, row.b_mm, row.tf_mm, row.tw_mm, row.r_mm))
    return d, b, tf, tw, r
