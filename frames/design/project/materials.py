"""Materials of members by name: structural steels and classes of concrete."""

from __future__ import annotations

import difflib
import re
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import ProjectError

if TYPE_CHECKING:
    from frames.design.project.schema_sections import MaterialTable

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
    """Elastic constants of a material.

    Attributes
    ----------
    name : str
        As the file calls it.
    elastic_modulus, shear_modulus : float
        [Pa].
    poisson_ratio : float
        [-].
    density : float
        [kg/m3].
    """

    name: str
    elastic_modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float


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
                f"material: E = {1e-9 * modulus:g} GPa with G = {1e-9 * shear:g} GPa is a "
                f"Poisson's ratio of {ratio:.3g}, it must be from 0 to below 0.5: look at G"
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
        f'material = "{given}" is not known: {meant} For another one write '
        '{ E = "30 GPa", nu = 0.2, density = "2500 kg/m3" }'
    )
    raise ProjectError(msg)
