"""Limits of bearings and of the structure above, as the engineer sets them."""

from __future__ import annotations

from dataclasses import dataclass, field

from frames.design._errors import CheckError
from lir_element.fields import check_numbers, number

PROJECT_LIMIT = "no code: limit of the project"
"""Clause of checks against a limit that the engineer sets."""

PROPOSED_LIMIT = "no code: a proposal"
"""Clause of checks against a limit that this package proposes."""


LANDING_PRESSURE = 90e6
"""Default limit of the mean pressure on the sliders' overlap at a landing [Pa]."""


_FORCE = number("N", "[1, 1e10)")
_PRESSURE = number("Pa", "[1e5, 1e10)")
_LENGTH = number("m", "[1e-4, 5)")


@dataclass(frozen=True, kw_only=True)
class DesignLimits:
    """Limits of bearings and of the structure above, as the engineer sets them.

    A limit is that of the project: checks against it cite no standard, and a standard's own limit
    of the same quantity is checked beside it, whichever is stricter. If a limit is None, its
    quantity is not checked, unless its description differs. `margin` and `rims_together` are of
    `device_checks` alone.

    Parameters
    ----------
    margin : float
        Least ratio of the interface's resistance to its force before rim contact [-], at least 1. A
        proposal of this package: no code has one.
    rim_strength : float, optional
        Radial force that a rim, its bolts and the slider's edge resist [N].
    rims_together : bool
        True if rims that are reached at the same displacement share their force. Less than 1 mm of
        tolerance lets one of them carry all.
    eccentricity : float
        Largest offset of the resultant between the sliders over their radius [-], at most 1. They
        are pressed all over up to 0.25 and tip at 1; the 0.8 is a proposal as well.
    interface_pressure, liner_pressure : float, optional
        Mean pressure limits of the liners of the interface and of the concave surfaces [Pa]. For a
        landing after an uplift without `axial_force`, the limit is 90 MPa on the sliders' overlap,
        a proposal, unless `interface_pressure` is given.
    lateral_force : float, optional
        Lateral force of one bearing that the structure above and below it resists [N].
    slip_left : float, optional
        Allowed residual interface slip after an event [m]; the stable limit s* if None.
    uplift_gap : float, optional
        Gap that a bearing may open in any run [m].
    rim_height : float, optional
        Height of the rims over the edges of their plates [m]: a bearing whose gap is larger can
        leave its rims. Half of the height that has place between the plates if None, a proposal.
    axial_force : float, optional
        Axial force that a bearing resists, landings included [N].
    floor_acceleration : float, optional
        Largest acceleration of a floor in plan [m/s2].
    drift : float, optional
        Largest storey drift ratio [-].
    base_shear : float, optional
        Largest base shear of all bearings [N].
    displacement_left : float, optional
        Bearing displacement that may stay after an event [m].
    rim_engagement : float, optional
        Agreed or tested share of the needed displacement capacity from which on rim contact is
        allowed [-], at most 1.
    moat_gap : float, optional
        Clear distance from the structure above the bearings to the moat wall or a neighbour [m]. Of
        projects alone.

    Raises
    ------
    CheckError
        If a limit is not positive, or impossible for its quantity.

    Examples
    --------
    >>> limits = DesignLimits(margin=1.6, rim_strength=3e6, interface_pressure=90e6)
    >>> limits.margin, limits.eccentricity
    (1.6, 0.8)
    """

    margin: float = field(default=1.2, metadata=number("-", "[1, 10)"))
    rim_strength: float | None = field(default=None, metadata=_FORCE)
    rims_together: bool = False
    eccentricity: float = field(default=0.8, metadata=number("-", "[0.01, 1]"))
    interface_pressure: float | None = field(default=None, metadata=_PRESSURE)
    liner_pressure: float | None = field(default=None, metadata=_PRESSURE)
    lateral_force: float | None = field(default=None, metadata=_FORCE)
    slip_left: float | None = field(default=None, metadata=_LENGTH)
    uplift_gap: float | None = field(default=None, metadata=number("m", "[1e-4, 0.5)"))
    rim_height: float | None = field(default=None, metadata=number("m", "[1e-3, 0.5)"))
    axial_force: float | None = field(default=None, metadata=_FORCE)
    floor_acceleration: float | None = field(default=None, metadata=number("m/s2", "[1e-3, 200)"))
    drift: float | None = field(default=None, metadata=number("-", "[1e-5, 0.2)"))
    base_shear: float | None = field(default=None, metadata=_FORCE)
    displacement_left: float | None = field(default=None, metadata=_LENGTH)
    rim_engagement: float | None = field(default=None, metadata=number("-", "[0.1, 1]"))
    moat_gap: float | None = field(default=None, metadata=number("m", "[1e-2, 10)"))

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)

    def clause_of(self, name: str) -> str:
        """Return the clause of a limit in checks: the project, or a proposal of this package."""
        is_proposed = getattr(self, name) == self.__dataclass_fields__[name].default
        return PROPOSED_LIMIT if is_proposed else PROJECT_LIMIT
