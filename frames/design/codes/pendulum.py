"""The lateral force of friction pendulums at a displacement, as design formulas have it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    from lir_element import LIRBearing


@dataclass(frozen=True)
class FrictionPendulum:
    """A friction pendulum by its effective radii and frictions, for design formulas.

    `FrictionPendulum.of` makes one of an `LIRBearing`, whose rigid slider slides on both surfaces
    at once: one radius and one friction describe it. Two radii describe a slider with a joint,
    whose surfaces slide one after the other: if their frictions differ, the loop has a corner.

    Parameters
    ----------
    radii : tuple of float
        Effective radius of each surface, R_i - h_i [m]; one or two, > 0.
    frictions : tuple of float
        Friction coefficient of each surface [-], at least 0 and below 1.
    capacity : float
        Displacement at rim contact [m]; infinite without rims.

    Raises
    ------
    CheckError
        If there are not one or two surfaces, or a number is out of bounds.

    Notes
    -----
    Source: Fenz and Constantinou (2006), Earthquake Engng Struct. Dyn. 35(7); the loss at the
    corners follows from the work of friction on each surface.

    Examples
    --------
    >>> two = FrictionPendulum((0.95, 0.95), (0.05, 0.09))
    >>> round(two.corner, 3), round(two.force(0.30, 1000.0), 2)
    (0.038, 227.89)
    """

    radii: tuple[float, ...] = field(metadata=number("m", "(0, inf)"))
    frictions: tuple[float, ...] = field(metadata=number("-", "[0, 1)"))
    capacity: float = field(default=math.inf, metadata=number("m", "(0, inf]"))

    def __post_init__(self) -> None:
        if len(self.radii) not in {1, 2} or len(self.radii) != len(self.frictions):
            msg = (
                f"radii {self.radii}, frictions {self.frictions}: give one radius and one "
                "friction for each of one or two surfaces"
            )
            raise CheckError(msg)
        check_numbers(self, error=CheckError)

    @classmethod
    def of(cls, bearing: LIRBearing | FrictionPendulum) -> FrictionPendulum:
        """Return the pendulum that a bearing is below its rims, friction that of high speed."""
        if isinstance(bearing, FrictionPendulum):
            return bearing
        radius, friction = bearing.effective_radius, bearing.effective_friction
        return cls((radius,), (friction,), bearing.lateral_capacity)

    @property
    def effective_radius(self) -> float:
        """L, sum of the effective radii [m]."""
        return sum(self.radii)

    @property
    def effective_friction(self) -> float:
        """Force at zero displacement over load, all surfaces sliding [-]."""
        moment = sum(r * mu for r, mu in zip(self.radii, self.frictions, strict=True))
        return moment / self.effective_radius

    @property
    def corner(self) -> float:
        """Displacement u* of a first loading from which on both surfaces slide [m]."""
        radii = [r for _, r in sorted(zip(self.frictions, self.radii, strict=True))]
        return (max(self.frictions) - min(self.frictions)) * radii[0]

    @property
    def corner_loss(self) -> float:
        """Loss of a cycle's energy at corners, over the load [m]: 4 R1 R2 (mu2 - mu1)^2 / L."""
        step = max(self.frictions) - min(self.frictions)
        return 4.0 * math.prod(self.radii) * step**2 / self.effective_radius

    def force(self, displacement: float, load: float) -> float:
        """Return the lateral force at a displacement beyond the corner, all surfaces sliding [N].

        Parameters
        ----------
        displacement : float
            Displacement [m], at least `corner`.
        load : float
            Axial load [N], compression positive.

        Returns
        -------
        float
            Lateral force [N].

        Raises
        ------
        CheckError
            If the displacement is below the corner.
        """
        self.require_sliding(displacement)
        return load * (displacement / self.effective_radius + self.effective_friction)

    def loop_energy(self, displacement: float, load: float) -> float:
        """Return the energy of a full cycle of an amplitude beyond the corner [J], as `force`."""
        self.require_sliding(displacement)
        return load * (4.0 * self.effective_friction * displacement - self.corner_loss)

    def require_sliding(self, displacement: float) -> None:
        """Raise a CheckError if not all surfaces slide at a displacement."""
        if not displacement >= self.corner:
            msg = (
                f"displacement = {displacement:g} m is below the corner of the loop, "
                f"{self.corner:g} m, below which one surface slides alone: analyse that surface"
            )
            raise CheckError(msg)
