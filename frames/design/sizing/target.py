"""What a proposal of bearings is chosen from, and what it has to keep."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from frames.design._errors import CheckError
from frames.design.devices.limits import LANDING_PRESSURE, DesignLimits
from lir_element.argument_checks import require_type
from lir_element.device.friction import CoulombFriction, FrictionLaw
from lir_element.fields import check_numbers, number

INTERFACE_PRESSURE = LANDING_PRESSURE
"""Mean pressure on the sliders' overlap that a proposal keeps unless told otherwise [Pa]."""


LEAST_PRESSURE = 10e6
"""Pressure below which a proposal warns of its liners, and takes others first [Pa].

Liners of the PTFE type usually work at 15 to 60 MPa under permanent load; their friction rises as
the pressure falls, and tests cover 5 to 45 MPa (for instance Bondonet and Filiatrault 1997, J.
Bridge Eng. 2(4)). Ten, of all bearings together, leaves the lightest ones about the lower end of
the tests. A starting point of this package, to be confirmed by the liner's maker.
"""


_PRESSURE = number("Pa", "(0, inf)")
_PRICE = number("-", "[0, inf)")


@dataclass(frozen=True, kw_only=True)
class Prices:
    """Prices by which proposals are compared, all in one currency.

    Parameters
    ----------
    bearing : float
        Of each bearing, whatever its size: tests, transport, placing.
    volume : float
        Per cubic metre of the bearings: area of the plates times height of the slider.
    liner : float
        Per square metre of liner: both surfaces of a slider and its interface.
    gap : float
        Per metre of the displacement that the gap around the building must allow.

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
    """What bearings are chosen from, and what is asked of them.

    Pressures and shares are starting points of this package, not of a standard: take those of the
    liner's maker and of the standard that you design by.

    Parameters
    ----------
    radii : sequence of float
        Radii of the concave surfaces to choose from, both alike [m].
    frictions : sequence of float or FrictionLaw
        Nominal frictions of the concave surfaces to choose from.
    rim_share : float, optional
        Displacement at which the rims are met, over the largest that a bearing without rims must
        allow [-], in (0, 2): D_TM, by EN 1998 gamma_x d_bd. What is left, the interface has to
        slip. None: 0.75 where the code has a rule for rims that are met (ASCE 7-22); where it has
        none (EN 1998, NCh2745) rims are `free_margin` beyond all that its checks hold against them.
    free_margin : float
        How far rims that are not to be met are beyond the largest displacement of those checks [-].
    slip_reserve : float
        What the interface must be able to slip where rims are not met, over the displacement that
        bearings must allow [-]: for an earthquake that is stronger.
    slip_margin : float
        What the interface must be able to slip where rims are met, over what they leave to it [-],
        at least 1: sliders and friction of the interface are for that slip, so that bearings are
        farther from failing under motions beyond those of the design.
    pressure : float
        Mean pressure on a slider under the average combination [Pa].
    largest_pressure : float
        The same under the largest load of all combinations [Pa].
    least_pressure : float
        Pressure under the average combination, the mean of the bearings of a size weighted by their
        loads, below which a proposal warns and takes other pairs first [Pa]; see `LEAST_PRESSURE`.
    height_ratio : float
        Height of the whole slider over its radius [-].
    rim_width : float
        Width of the rim around a concave surface [m].
    clearance : float
        Between the edges of the two plates at rest [m].
    slider_step, friction_step : float
        What radii of sliders [m] and the friction of the interface [-] are rounded up to.
    max_displacement : float, optional
        Largest that a bearing without rims must allow, as the gap around the building has it [m].
    max_base_shear : float, optional
        Largest base shear over weight [-].
    max_plan_diameter : float, optional
        Largest diameter of a bearing's plates [m].
    prices : Prices, optional
        What `Candidate.cost` is reckoned by; without them there is no cost.
    limits : DesignLimits
        Of `device_checks`, which the proposal keeps: margin of the interface, eccentricity,
        strength of a rim, pressure on the overlap.

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
