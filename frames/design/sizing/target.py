"""Choices of a proposal of bearings, and its requirements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from frames.design._errors import CheckError
from frames.design.devices.limits import LANDING_PRESSURE, DesignLimits
from lir_element.argument_checks import require_type
from lir_element.device.friction import CoulombFriction, FrictionLaw
from lir_element.fields import check_numbers, number

INTERFACE_PRESSURE = LANDING_PRESSURE
"""Default mean pressure on the sliders' overlap in a proposal [Pa]."""


LEAST_PRESSURE = 10e6
"""Pressure below which a proposal warns of its liners, and prefers others [Pa].

Liners of the PTFE type usually work at 15 to 60 MPa under permanent load; their friction rises as
the pressure falls, and tests cover 5 to 45 MPa (for instance Bondonet and Filiatrault 1997, J.
Bridge Eng. 2(4)). With 10 MPa over all bearings together, the lightest ones are about at the lower
end of the tests. A starting point of this package, to be confirmed by the liner's maker.
"""


_PRESSURE = number("Pa", "[1e5, 1e9]", usual=(5e6, 1e8))
_PRICE = number("-", "[0, inf)")


@dataclass(frozen=True, kw_only=True)
class Prices:
    """Prices by which proposals are compared, all in one currency.

    Parameters
    ----------
    bearing : float
        Price of each bearing at any size: tests, transport, placing.
    volume : float
        Price per cubic metre of the bearings: area of the plates times height of the slider.
    liner : float
        Price per square metre of liner: both surfaces of a slider and its interface.
    gap : float
        Price per metre of the displacement that the gap around the building must allow.

    Raises
    ------
    CheckError
        If a price is out of bounds.

    Examples
    --------
    >>> Prices(bearing=2000.0, volume=30e3).liner
    0.0
    """

    bearing: float = field(default=0.0, metadata=_PRICE)
    volume: float = field(default=0.0, metadata=_PRICE)
    liner: float = field(default=0.0, metadata=_PRICE)
    gap: float = field(default=0.0, metadata=_PRICE)

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)


@dataclass(frozen=True, kw_only=True)
class DesignTarget:
    """Choices and requirements of a proposal of bearings.

    Pressures and shares are starting points of this package, not of a standard: take those of the
    liner's maker and of the standard that you design by.

    Parameters
    ----------
    radii : sequence of float
        Radii of the concave surfaces to choose from, equal for both [m].
    frictions : sequence of float or FrictionLaw
        Nominal frictions of the concave surfaces to choose from.
    rim_share : float, optional
        Rim displacement over the largest displacement without rims [-], in (0, 2): D_TM, by EN 1998
        gamma_x d_bd. The interface slips the rest. None: 0.75 if the code has a rule for rim
        contact (ASCE 7-22); if it has none (EN 1998, NCh2745), rims are `free_margin` beyond all
        displacements of its checks.
    free_margin : float
        Margin of rims without contact beyond the largest displacement of those checks [-].
    slip_reserve : float
        Slip capacity of the interface without rim contact, over the needed displacement capacity
        [-]: a reserve for a stronger earthquake.
    slip_margin : float
        Slip capacity of the interface after rim contact, over the displacement beyond the rims [-],
        at least 1: sliders and interface friction are sized for that slip, so that bearings are
        farther from failure under motions beyond those of the design.
    pressure : float
        Mean pressure on a slider under the average combination [Pa].
    largest_pressure : float
        The same under the largest load of all combinations [Pa].
    least_pressure : float
        Pressure under the average combination, the mean of the bearings of a size weighted by their
        loads, below which a proposal warns and prefers other pairs [Pa]; see `LEAST_PRESSURE`.
    height_ratio : float
        Height of the whole slider over its radius [-].
    rim_width : float
        Width of the rim around a concave surface [m].
    clearance : float
        Between the edges of the two plates at rest [m].
    slider_step, friction_step : float
        Steps to which radii of sliders [m] and the friction of the interface [-] are rounded up.
    max_displacement : float, optional
        Largest displacement of a bearing without rims, for the gap around the building [m].
    max_base_shear : float, optional
        Largest base shear over weight [-].
    max_plan_diameter : float, optional
        Largest diameter of a bearing's plates [m].
    prices : Prices, optional
        Prices of `Candidate.cost`; without them there is no cost.
    limits : DesignLimits
        Limits of `device_checks` for the proposal: margin of the interface, eccentricity, strength
        of a rim, pressure on the overlap.

    Raises
    ------
    CheckError
        If a number is out of bounds.

    Examples
    --------
    >>> target = DesignTarget(radii=(1.5, 2.0), frictions=(0.05, 0.06), rim_share=0.8)
    >>> target.pressure / 1e6, target.largest_pressure / 1e6  # MPa
    (30.0, 60.0)
    """

    radii: Sequence[float] = field(
        default=(1.0, 1.5, 2.0, 2.5, 3.0), metadata=number("m", "(0, inf)")
    )
    frictions: Sequence[float | FrictionLaw] = (0.04, 0.05, 0.06, 0.08)
    rim_share: float | None = field(default=None, metadata=number("-", "(0, 2)"))
    free_margin: float = field(default=1.05, metadata=number("-", "[1, 2)"))
    slip_reserve: float = field(default=0.10, metadata=number("-", "(0, 1)"))
    slip_margin: float = field(default=1.0, metadata=number("-", "[1, 10)"))
    pressure: float = field(default=30e6, metadata=_PRESSURE)
    largest_pressure: float = field(default=60e6, metadata=_PRESSURE)
    least_pressure: float = field(default=LEAST_PRESSURE, metadata=_PRESSURE)
    height_ratio: float = field(default=1.0, metadata=number("-", "(0, inf)"))
    rim_width: float = field(default=0.025, metadata=number("m", "(0, inf)"))
    clearance: float = field(default=0.010, metadata=number("m", "(0, inf)"))
    slider_step: float = field(default=0.005, metadata=number("m", "(0, inf)"))
    friction_step: float = field(default=0.005, metadata=number("-", "(0, inf)"))
    max_displacement: float | None = field(default=None, metadata=number("m", "[1e-3, 5)"))
    max_base_shear: float | None = field(default=None, metadata=number("-", "[1e-3, 5)"))
    max_plan_diameter: float | None = field(default=None, metadata=number("m", "[1e-3, 10)"))
    prices: Prices | None = None
    limits: DesignLimits = field(
        default_factory=lambda: DesignLimits(interface_pressure=INTERFACE_PRESSURE)
    )

    def __post_init__(self) -> None:
        for name in ("radii", "frictions"):
            values = tuple(getattr(self, name))
            if not values:
                msg = f"{name} is empty: give at least one value"
                raise CheckError(msg)
            object.__setattr__(self, name, values)
        check_numbers(self, error=CheckError)
        try:
            _ = self.laws  # refused here, not when it is tried
        except ValueError as cause:
            msg = f"frictions: {cause}"
            raise CheckError(msg) from cause
        require_type("limits", self.limits, DesignLimits, "DesignLimits(...)")

    @property
    def laws(self) -> tuple[FrictionLaw, ...]:
        """FrictionLaw laws to choose from."""
        return tuple(
            CoulombFriction(float(each)) if isinstance(each, (int, float)) else each
            for each in self.frictions
        )
