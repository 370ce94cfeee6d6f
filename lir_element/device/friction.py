"""Friction of a concave surface, as an engineer specifies it."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np

from lir_element.argument_checks import require_between, require_non_negative
from lir_element.units import per_cent


@dataclass(frozen=True, slots=True)
class CoulombFriction:
    """A friction coefficient that does not depend on speed.

    Parameters
    ----------
    coefficient : float
        Friction coefficient mu_d [-], at least 0 and below 1.

    Examples
    --------
    >>> CoulombFriction(0.066).at_speed(0.2)
    0.066
    """

    coefficient: float

    def __post_init__(self) -> None:
        require_between(
            "coefficient", self.coefficient, 0.0, 1.0, "-", remedy=per_cent(self.coefficient)
        )

    @property
    def f_max(self) -> float:
        """Friction coefficient at high speed [-]."""
        return float(self.coefficient)

    @property
    def f_min(self) -> float:
        """Friction coefficient at zero speed [-]."""
        return float(self.coefficient)

    @property
    def rate(self) -> float:
        """Rate parameter [s/m]; none."""
        return 0.0

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s]."""
        return float(self.coefficient)

    def scaled(self, factor: float) -> CoulombFriction:
        """Return the law with its coefficient times a factor [-], as at a bound of properties."""
        return CoulombFriction(factor * self.coefficient)


@dataclass(frozen=True, slots=True)
class VelocityFriction:
    r"""A friction coefficient that grows with the sliding speed.

    .. math:: \mu_d = f_{max} - (f_{max} - f_{min}) e^{-\alpha |v|}

    Source: Eq. (1) of the paper, after Mokha, Constantinou and Reinhorn (1990).

    Parameters
    ----------
    f_max : float
        Friction coefficient at high speed [-], at least `f_min` and below 1.
    f_min : float
        Friction coefficient at zero speed [-], at least 0.
    rate : float
        Rate parameter alpha [s/m], at least 0. It belongs to the sliding speed on one surface.

    Examples
    --------
    >>> VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0).at_speed(0.0)
    0.0325
    """

    f_max: float
    f_min: float
    rate: float

    def __post_init__(self) -> None:
        require_between("f_max", self.f_max, 0.0, 1.0, "-", remedy=per_cent(self.f_max))
        require_between("f_min", self.f_min, 0.0, 1.0, "-", remedy=per_cent(self.f_min))
        require_non_negative("rate", self.rate, "s/m")
        if self.f_min > self.f_max:
            msg = (
                f"f_min = {self.f_min:g} exceeds f_max = {self.f_max:g}: the friction at zero "
                "speed must not exceed that at high speed; exchange the two values"
            )
            raise ValueError(msg)

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s]."""
        return self.f_max - (self.f_max - self.f_min) * exp(-self.rate * abs(speed))

    def scaled(self, factor: float) -> VelocityFriction:
        """Return the law with its coefficients times a factor [-], as at a bound of properties."""
        return VelocityFriction(factor * self.f_max, factor * self.f_min, self.rate)


Friction = CoulombFriction | VelocityFriction
"""All laws; what they share is what a bearing asks of them: f_max, f_min, rate, scaled."""


def as_laws(given: object) -> object:
    """Return friction with numbers as `CoulombFriction`; anything else is left to its check."""
    if isinstance(given, tuple):
        return tuple(as_laws(each) for each in given)
    if isinstance(given, (int, float, np.number)) and not isinstance(given, bool):
        return CoulombFriction(float(given))
    return given
