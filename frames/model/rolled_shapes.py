"""Rolled I shapes: constants with their fillets, and dimensions by the name in a catalogue."""

from __future__ import annotations

import math
import re

from frames._errors import ModelError
from frames.model.names import likely
from frames.model.shapes import dimensions
from lir_element.argument_checks import require_non_negative

SERIES = ("IPE", "HEA", "HEB", "HEM")
"""Series with parallel flanges that `Section.catalogue` knows."""

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
            f"{where}: flanges 2 x {tf:g} m and fillets 2 x {r:g} m must leave a part of the depth "
            f"{d:g} m, web {tw:g} m and fillets not exceed flange_width = {b:g} m: check the order "
            "(depth, flange_width, flange_thickness, web_thickness, radius)"
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
            'Section.catalogue reads the tables of steel-sections: pip install "lir-dcfp[sections]"'
            ", or give the dimensions to Section.rolled_i"
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
            f"({likely(wanted, known)}): for another one give Section.rolled_i its dimensions"
        )
        raise ModelError(message)
    row = known[wanted]
    d, b, tf, tw, r = (1e-3 * x for x in (row.h_mm, row.b_mm, row.tf_mm, row.tw_mm, row.r_mm))
    return d, b, tf, tw, r
