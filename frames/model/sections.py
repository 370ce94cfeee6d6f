"""Cross-sections of members: the constants of an elastic prismatic bar."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

from frames._errors import ModelError
from frames.model.rolled import catalogue_dimensions, rolled_i_constants
from frames.model.shapes import circle_constants, dimensions, shear_modulus_of
from lir_element.door import require_non_negative, require_positive
from lir_element.tables import html_table
from lir_element.units import AREAS, MODULI, meant

STEEL_ELASTIC_MODULUS = 200e9
"""Elastic modulus of structural steel [Pa]."""

STEEL_POISSON_RATIO = 0.3
"""Poisson ratio of structural steel [-]."""

STEEL_DENSITY = 7850.0
"""Density of structural steel [kg/m3]."""


SOFTEST, LARGEST_AREA = 1e6, 500.0
"""Elastic modulus [Pa] below, and area [m2] above which no member is."""

UNITS = {
    "area": "m2", "inertia_y": "m4", "inertia_z": "m4", "torsion_constant": "m4",
    "elastic_modulus": "Pa", "shear_modulus": "Pa", "density": "kg/m3", "shear_area_y": "m2",
    "shear_area_z": "m2",
}  # fmt: skip


@dataclass(frozen=True)
class Section:
    """Cross-section and material of an elastic member, in the member's local axes.

    Local x runs along the member, local y and z are the principal axes of the section
    (`frames.model.axes.local_axes`). The *depth* of the ready-made shapes lies along local z, which
    is vertical for a horizontal member: `inertia_y` then carries the gravity loads.

    Parameters
    ----------
    area : float
        Cross-sectional area [m2], > 0.
    inertia_y, inertia_z : float
        Second moments of area about local y and local z [m4], > 0.
    torsion_constant : float
        Saint-Venant torsion constant [m4], > 0.
    elastic_modulus, shear_modulus : float
        Moduli of the material [Pa], > 0.
    density : float
        Mass density [kg/m3], >= 0. Set it to 0 where a floor mass already contains the members.
    shear_area_y, shear_area_z : float
        Areas that carry the shear force along local y and z [m2], > 0. Infinity, the default,
        leaves the shear deformation out (Euler-Bernoulli).

    Raises
    ------
    ModelError
        If a number is out of its bounds; the message names it.

    Examples
    --------
    >>> column = Section.box(0.4, 0.4, 0.02)
    >>> round(column.area, 6), round(column.inertia_y * 1e4, 4)
    (0.0304, 7.3365)
    """

    area: float
    inertia_y: float
    inertia_z: float
    torsion_constant: float
    elastic_modulus: float
    shear_modulus: float
    density: float = 0.0
    shear_area_y: float = math.inf
    shear_area_z: float = math.inf

    def __post_init__(self) -> None:
        """Check every number.

        Raises
        ------
        ModelError
            If a number is out of its bounds.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            what = f"Section.{field.name}"
            if field.name == "density":
                number = require_non_negative(
                    what,
                    value,
                    remedy="give kg/m3, or 0 for a member without mass",
                    error=ModelError,
                )
            elif field.name.startswith("shear_area"):
                remedy = "give m2, or leave it out (infinity) to neglect the shear deformation"
                number = require_positive(
                    what, value, infinite=True, remedy=remedy, error=ModelError
                )
            else:
                number = require_positive(
                    what,
                    value,
                    remedy="a member needs every stiffness; give SI units",
                    error=ModelError,
                )
            object.__setattr__(self, field.name, number)
        self._refuse_units()

    def _refuse_units(self) -> None:
        # Moduli that no material has, areas that no member has; sections of modulus 1, with
        # stiffnesses in the place of areas, and rigid ones pass.
        if self.elastic_modulus < SOFTEST and self.area < LARGEST_AREA:
            message = (
                f"Section.elastic_modulus = {self.elastic_modulus:g} Pa is softer than rubber: "
                f"{meant(self.elastic_modulus, 'Pa', MODULI, 1e9, 5e11)}; steel has 200e9, "
                "concrete 30e9"
            )
            raise ModelError(message)
        if self.area > LARGEST_AREA and self.density > 0.0 and self.elastic_modulus > SOFTEST:
            message = (
                f"Section.area = {self.area:g} m2, at most {LARGEST_AREA:g} m2 for a member with "
                f"mass: {meant(self.area, 'm2', AREAS, 1e-5, 20.0)}"
            )
            raise ModelError(message)

    def _repr_html_(self) -> str:
        def text(value: float) -> str:
            return "not counted" if math.isinf(value) else f"{value:.4g}"

        rows = [(f.name.replace("_", " "), text(getattr(self, f.name)), UNITS[f.name]) for f in
                fields(self)]  # fmt: skip
        return html_table("Section", rows)

    @classmethod
    def box(
        cls,
        width: float,
        depth: float,
        thickness: float,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Build a rectangular hollow section of constant wall thickness.

        The torsion constant is Bredt's for the closed wall line; the shear areas are those of the
        two walls parallel to the shear force, taken between the centre lines of the other two.

        Parameters
        ----------
        width, depth : float
            Outer dimensions along local y and along local z [m].
        thickness : float
            Wall thickness [m], less than half the smaller outer dimension.
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            The section.

        Raises
        ------
        ModelError
            If a dimension is not positive or the walls overlap.
        """
        b, d, t = dimensions("Section.box", width=width, depth=depth, thickness=thickness)
        if 2.0 * t >= min(b, d):
            message = (
                f"Section.box: thickness = {t:g} m must be less than half the smaller side, "
                f"{min(b, d) / 2.0:g} m: the walls overlap, use Section.rectangle for a solid bar"
            )
            raise ModelError(message)
        inner_b, inner_d = b - 2.0 * t, d - 2.0 * t
        return cls(
            area=b * d - inner_b * inner_d,
            inertia_y=(b * d**3 - inner_b * inner_d**3) / 12.0,
            inertia_z=(d * b**3 - inner_d * inner_b**3) / 12.0,
            # Bredt: 4 A_m^2 / integral of ds / t
            torsion_constant=2.0 * t * ((b - t) * (d - t)) ** 2 / ((b - t) + (d - t)),
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus_of(elastic_modulus, poisson_ratio),
            density=density,
            shear_area_y=2.0 * t * (b - t),
            shear_area_z=2.0 * t * (d - t),
        )

    @classmethod
    def i_shape(
        cls,
        depth: float,
        flange_width: float,
        flange_thickness: float,
        web_thickness: float,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Build a doubly symmetric I section (no fillets), web along local z.

        The torsion constant is that of thin open walls, the sum of b t^3 / 3; warping is left
        out. Shear areas: the web between the flange centre lines along z, 5/6 of the two flanges
        along y.

        Parameters
        ----------
        depth : float
            Outer depth along local z [m].
        flange_width, flange_thickness : float
            Width along local y and thickness of each flange [m].
        web_thickness : float
            Thickness of the web [m], not more than the flange width.
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            The section.

        Raises
        ------
        ModelError
            If a dimension is not positive, or flanges or web do not fit.
        """
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
        return cls(
            area=2.0 * b * tf + web * tw,
            inertia_y=(b * d**3 - (b - tw) * web**3) / 12.0,
            inertia_z=(2.0 * tf * b**3 + web * tw**3) / 12.0,
            torsion_constant=(2.0 * b * tf**3 + (d - tf) * tw**3) / 3.0,
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus_of(elastic_modulus, poisson_ratio),
            density=density,
            shear_area_y=5.0 / 6.0 * 2.0 * b * tf,
            shear_area_z=(d - tf) * tw,
        )

    @classmethod
    def rolled_i(
        cls,
        depth: float,
        flange_width: float,
        flange_thickness: float,
        web_thickness: float,
        radius: float,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Build a rolled I shape with parallel flanges and fillets, web along local z.

        The constants are those of its catalogue: `frames.model.rolled` has the formulas. Shear
        areas are as in `i_shape`; warping is left out.

        Parameters
        ----------
        depth : float
            Outer depth along local z [m].
        flange_width, flange_thickness : float
            Width along local y and thickness of each flange [m].
        web_thickness : float
            Thickness of the web [m].
        radius : float
            Radius of the fillets between web and flanges [m]; of a W shape k - t_f.
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            The section.

        Raises
        ------
        ModelError
            If a dimension is not positive, or the parts do not fit.

        Examples
        --------
        >>> heb_300 = Section.rolled_i(0.300, 0.300, 0.019, 0.011, 0.027)
        >>> round(1e4 * heb_300.area, 1)  # cm2
        149.1
        """
        constants = rolled_i_constants(depth, flange_width, flange_thickness, web_thickness, radius)
        return cls(
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus_of(elastic_modulus, poisson_ratio),
            density=density,
            **constants,
        )

    @classmethod
    def catalogue(
        cls,
        name: str,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Return a European rolled I shape by its name, strong axis local y.

        Parameters
        ----------
        name : str
            Of the series IPE, HEA, HEB and HEM: "HEB 300", "HE 300 B", "IPE 270".
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            `rolled_i` of its dimensions.

        Raises
        ------
        ModelError
            If the catalogue does not have it.
        ImportError
            If steel-sections is not installed: ``pip install "lir-dcfp[sections]"``.
        """
        return cls.rolled_i(
            *catalogue_dimensions(name),
            elastic_modulus=elastic_modulus,
            poisson_ratio=poisson_ratio,
            density=density,
        )

    @classmethod
    def rectangle(
        cls,
        width: float,
        depth: float,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Build a solid rectangular section.

        The torsion constant is Saint-Venant's series [Timoshenko & Goodier, Theory of Elasticity,
        art. 109]; the shear areas are 5/6 of the area.

        Parameters
        ----------
        width, depth : float
            Dimensions along local y and along local z [m].
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            The section.
        """
        b, d = dimensions("Section.rectangle", width=width, depth=depth)
        short, long = min(b, d), max(b, d)
        series = sum(math.tanh(n * math.pi * long / (2.0 * short)) / n**5 for n in range(1, 40, 2))
        return cls(
            area=b * d,
            inertia_y=b * d**3 / 12.0,
            inertia_z=d * b**3 / 12.0,
            torsion_constant=long
            * short**3
            / 3.0
            * (1.0 - 192.0 / math.pi**5 * short / long * series),
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus_of(elastic_modulus, poisson_ratio),
            density=density,
            shear_area_y=5.0 / 6.0 * b * d,
            shear_area_z=5.0 / 6.0 * b * d,
        )

    @classmethod
    def circle(
        cls,
        diameter: float,
        thickness: float | None = None,
        *,
        elastic_modulus: float = STEEL_ELASTIC_MODULUS,
        poisson_ratio: float = STEEL_POISSON_RATIO,
        density: float = STEEL_DENSITY,
    ) -> Section:
        """Build a round section, solid or a tube.

        The shear areas are those of Cowper [The Shear Coefficient in Timoshenko's Beam Theory,
        J. Appl. Mech. 33 (1966), table 1].

        Parameters
        ----------
        diameter : float
            Outer diameter [m].
        thickness : float, optional
            Of the wall [m], less than half the diameter; solid if None.
        elastic_modulus, poisson_ratio, density : float
            Material [Pa], [-], [kg/m3]; steel by default.

        Returns
        -------
        Section
            The section.

        Raises
        ------
        ModelError
            If a dimension is not positive, or the wall does not fit.
        """
        shear_modulus = shear_modulus_of(elastic_modulus, poisson_ratio)
        area, inertia, shear_area = circle_constants(diameter, thickness, poisson_ratio)
        return cls(
            area=area,
            inertia_y=inertia,
            inertia_z=inertia,
            torsion_constant=2.0 * inertia,
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus,
            density=density,
            shear_area_y=shear_area,
            shear_area_z=shear_area,
        )

    def cracked(
        self, bending: float, *, torsion: float | None = None, shear: float | None = None
    ) -> Section:
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
