"""Materials as rows of SAP2000's tables, for members and shells."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from frames.exchange.units import Units
    from frames.exchange.write_s2k_text import Value

MATERIALS = "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"


def material_row(
    name: str, modulus: float, poisson_ratio: float, density: float, units: Units
) -> dict[str, Value]:
    """Return the row of a material without weight: weights are loads of joints, as in a frame."""
    return {
        "Material": name,
        "UnitWeight": 0.0,
        "UnitMass": density / units.density,
        "E1": modulus / units.stress,
        "G12": 0.5 * modulus / (1.0 + poisson_ratio) / units.stress,
        "U12": poisson_ratio,
    }
