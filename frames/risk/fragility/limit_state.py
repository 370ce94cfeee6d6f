"""Limit states, and the runs that exceed them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from frames.results.quantities import QUANTITIES
from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_non_negative, require_positive, require_type
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from lir_element import LIRBearing


@dataclass(frozen=True)
class LimitState:
    """A limit state: exceeded if a demand is above its limit, or a bearing fails.

    Failure of a bearing (a status of `lir_element.RunStatus` with `is_bearing_failure`) exceeds
    every limit state: it is collapse of the isolation. A run that went on with the backup of a
    failed bearing (`LIRBearing.backup`) has demands of its own, and exceeds `bearing_failure`. A
    run that ended otherwise before its end exceeds and keeps nothing: it is not known.

    Parameters
    ----------
    name : str
        Name of the limit state.
    quantity : str, optional
        A quantity of `frames.peaks`; None: failure of a bearing alone.
    limit : float, optional
        Upper limit of the demand, in the quantity's SI unit.

    Raises
    ------
    FragilityError
        If a limit is missing or negative.

    Examples
    --------
    >>> LimitState.drift(0.01)
    LimitState(name='storey drift 1 %', quantity='storey drift, mean', limit=0.01)
    """

    name: str
    quantity: str | None = None
    limit: float | None = None

    def __post_init__(self) -> None:
        """Check."""
        require_type("name", self.name, str, "a string")
        if (self.quantity is None) != (self.limit is None):
            msg = f"{self.name}: give a quantity of frames.peaks and its limit, or neither"
            raise FragilityError(msg)
        if self.limit is not None:
            require_non_negative(f"{self.name}: limit", self.limit, error=FragilityError)

    @staticmethod
    def bearing_failure() -> LimitState:
        """Return failure of a bearing: overlap or rim exceeded, or slip that does not hold."""
        return LimitState("failure of a bearing")

    @staticmethod
    def rim_contact() -> LimitState:
        """Return contact with a rim: a force of any rim."""
        return LimitState("rim contact", QUANTITIES["rim_force"].title, 0.0)

    @staticmethod
    def interface_slip(bearing: LIRBearing) -> LimitState:
        """Return the limit state of interface slip beyond its stable limit s* (`slip_stability`).

        Parameters
        ----------
        bearing : LIRBearing
            The bearing, or the one with the least s* if they differ.

        Returns
        -------
        LimitState
            The limit state, with the limit s* [m].

        Raises
        ------
        FragilityError
            If the interface cannot slip, or holds no slip.
        """
        holds = bearing.slip_stability
        if not 0.0 < holds < math.inf:
            msg = f"s* = {holds:g} m of this bearing is no limit: use bearing_failure()"
            raise FragilityError(msg)
        return LimitState("interface slip beyond s*", QUANTITIES["slip"].title, holds)

    @staticmethod
    def displacement(limit: float) -> LimitState:
        """Return a bearing displacement in plan above `limit` [m]."""
        return _above(f"bearing displacement {1e3 * limit:g} mm", "displacement", limit)

    @staticmethod
    def residual_displacement(limit: float) -> LimitState:
        """Return a residual bearing displacement at the end above `limit` [m]."""
        return _above(f"residual displacement {1e3 * limit:g} mm", "displacement_left", limit)

    @staticmethod
    def drift(limit: float) -> LimitState:
        """Return a storey drift ratio above `limit` [-]: mean of the storey, size in plan."""
        return _above(f"storey drift {100 * limit:g} %", "drift", limit)

    @staticmethod
    def floor_acceleration(limit: float) -> LimitState:
        """Return a floor acceleration above `limit` [m/s2]: mean of the level, size in plan."""
        name = f"floor acceleration {limit / STANDARD_GRAVITY:.3g} g"
        return _above(name, "floor_plan", limit)

    @staticmethod
    def ductility(limit: float) -> LimitState:
        """Return a ductility of links (storeys that yield) above `limit` [-]."""
        return _above(f"ductility {limit:g}", "link_ductility", limit)

    @staticmethod
    def plastic_rotation(limit: float) -> LimitState:
        """Return a plastic rotation of hinges above `limit` [rad]."""
        return _above(f"plastic rotation {limit:g} rad", "hinge_rotation", limit)


def _above(name: str, quantity: str, limit: float) -> LimitState:
    require_positive("limit", limit, error=FragilityError)
    return LimitState(name, QUANTITIES[quantity].title, limit)
