"""Units of other programs' files: from their words to SI."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lir_element.units import STANDARD_GRAVITY

_POUND = 0.45359237 * STANDARD_GRAVITY

FORCES = {
    "N": 1.0,
    "KN": 1e3,
    "MN": 1e6,
    "KGF": STANDARD_GRAVITY,
    "TONF": 1e3 * STANDARD_GRAVITY,
    "LB": _POUND,
    "KIP": 1e3 * _POUND,
}
"""Forces [N] by word."""

LENGTHS = {"MM": 1e-3, "CM": 1e-2, "M": 1.0, "IN": 0.0254, "FT": 0.3048}
"""Lengths [m] by word."""


@dataclass(frozen=True)
class Units:
    """Units of a file: force [N] and length [m]; time is in seconds, angles are in degrees."""

    force: float
    length: float

    one: ClassVar[float] = 1.0  # of what has no unit

    @property
    def per_length(self) -> float:
        """Reciprocal of a length [1/m]."""
        return 1.0 / self.length

    @property
    def area(self) -> float:
        """Area [m2]."""
        return self.length**2

    @property
    def inertia(self) -> float:
        """Second moment of an area [m4]."""
        return self.length**4

    @property
    def rotary(self) -> float:
        """Mass times length squared [kg m2]."""
        return self.mass * self.length**2

    @property
    def moment(self) -> float:
        """Moment [N m]."""
        return self.force * self.length

    @property
    def line(self) -> float:
        """Force per length, and stiffness [N/m]."""
        return self.force / self.length

    @property
    def stress(self) -> float:
        """Force per area [Pa]."""
        return self.force / self.length**2

    @property
    def weight(self) -> float:
        """Force per volume [N/m3]."""
        return self.force / self.length**3

    @property
    def mass(self) -> float:
        """Mass: force over acceleration [kg]."""
        return self.force / self.length

    @property
    def density(self) -> float:
        """Mass per volume [kg/m3]."""
        return self.mass / self.length**3


def units_of(force: str, length: str) -> Units | None:
    """Return the units that two words stand for, None if one is unknown."""
    first, second = FORCES.get(force.strip().upper()), LENGTHS.get(length.strip().upper())
    return None if first is None or second is None else Units(first, second)
