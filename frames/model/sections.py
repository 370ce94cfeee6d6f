"""Cross-sections of members: given by their constants, or ready-made shapes."""

from __future__ import annotations

import math

from frames._errors import ModelError
from frames.model.shapes import (
    SectionConstants,
    catalogue_dimensions,
    circle_constants,
    dimensions,
    i_shape_constants,
    rolled_i_constants,
    shear_modulus_of,
)

STEEL_ELASTIC_MODULUS = 200e9
"""Elastic modulus of structural steel [Pa]."""

STEEL_POISSON_RATIO = 0.3
"""Poisson ratio of structural steel [-]."""

STEEL_DENSITY = 7850.0
"""Density of structural steel [kg/m3]."""


class Section(SectionConstants):
    """Cross-section and material of an elastic member, in the member's local axes.

    Local x runs along the member, local y and z are the principal axes of the section
    (`frames.model.axes.local_axes`). The *depth* of the ready-made shapes is along local z, which
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
        Mass density [kg/m3], >= 0. Set it to 0 if a floor mass already contains the members.
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
        two walls parallel to the shear force, measured between the centre lines of the other two.

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
        constants = i_shape_constants(depth, flange_width, flange_thickness, web_thickness)
        return cls(
            elastic_modulus=elastic_modulus,
            shear_modulus=shear_modulus_of(elastic_modulus, poisson_ratio),
            density=density,
            **constants,
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

        The constants are those of its catalogue: `frames.model.shapes` has the formulas.
        Shear areas are as in `i_shape`; warping is left out.

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
            Name in the series IPE, HEA, HEB and HEM: "HEB 300", "HE 300 B", "IPE 270".
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
            Thickness of the wall [m], less than half the diameter; solid if None.
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
