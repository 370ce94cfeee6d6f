"""What a bearing, and what stands on it, may be asked for: limits that the engineer sets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from frames.design._errors import CheckError
from lir_element.argument_checks import require_between

PROJECT_LIMIT = "no code: limit of the project"
"""Clause of checks against a limit that the engineer sets."""

PROPOSED_LIMIT = "no code: a proposal"
"""Clause of checks against a limit that this package proposes."""


LANDING_PRESSURE = 90e6
"""Mean pressure on the sliders' overlap that is checked at a landing where none is given [Pa]."""


class _Range(NamedTuple):
    # What a limit can be: from the least, below the largest.
    least: float
    below: float
    unit: str


_FORCE = _Range(1.0, 1e10, "N")
_PRESSURE = _Range(1e5, 1e10, "Pa")
_LENGTH = _Range(1e-4, 5.0, "m")
_RANGES = {
    "margin": _Range(1.0, 10.0, "-"),
    "eccentricity": _Range(0.01, 1.0 + 1e-9, "-"),
    "drift": _Range(1e-5, 0.2, "-"),
    "floor_acceleration": _Range(1e-3, 200.0, "m/s2"),
    "rim_engagement": _Range(0.1, 1.0 + 1e-9, "-"),
    "uplift_gap": _Range(1e-4, 0.5, "m"),
    "rim_height": _Range(1e-3, 0.5, "m"),
    "moat_gap": _Range(1e-2, 10.0, "m"),
    **dict.fromkeys(("slip_left", "displacement_left"), _LENGTH),
    **dict.fromkeys(("rim_strength", "lateral_force", "axial_force", "base_shear"), _FORCE),
    **dict.fromkeys(("interface_pressure", "liner_pressure"), _PRESSURE),
}


@dataclass(frozen=True, kw_only=True)
class DesignLimits:
    """What a bearing and what stands on it may be asked for, by the engineer who designs them.

    A limit is that of the project: checks against it cite no standard, and a standard's own limit
    of the same quantity is checked beside it, whichever of both is stricter. Where a limit is None,
    what it bounds is not checked, unless it says otherwise. `margin` and `rims_together` are of
    `device_checks` alone.

    Parameters
    ----------
    margin : float
        Least ratio of what the interface holds to what it carries before a rim is met [-], at
        least 1. A proposal of this package: no code has one.
    rim_strength : float, optional
        Radial force that a rim, its bolts and the slider's edge resist [N].
    rims_together : bool
        Whether rims that are met at the same displacement share their force. Less than 1 mm of
        tolerance lets one of them carry all.
    eccentricity : float
        Largest offset of the resultant between the sliders over their radius [-], at most 1. They
        are pressed all over up to 0.25 and tip at 1; the 0.8 is a proposal as well.
    interface_pressure, liner_pressure : float, optional
        Mean pressure that the interface's and the concave surfaces' liners bear [Pa]. Where a
        bearing lands after an uplift and no `axial_force` is given, 90 MPa on the sliders' overlap
        are the limit, a proposal, unless `interface_pressure` is given.
    lateral_force : float, optional
        Lateral force of one bearing that what is above and below it resists [N].
    slip_left : float, optional
        Interface slip that may stay after an event [m]; that which holds, s*, if None.
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
        Share of the displacement that bearings must allow from which on rims may be met, as agreed
        with the authority or proven by tests [-], at most 1.
    moat_gap : float, optional
        Clear distance from what stands on the bearings to the moat wall or a neighbour [m]. Of
        projects alone.

    Raises
    ------
    CheckError
        If a limit is not positive, or none that such a quantity can have.

    Examples
    --------
    >>> limits = DesignLimits(margin=1.6, rim_strength=3e6, interface_pressure=90e6)
    >>> limits.margin, limits.eccentricity
    (1.6, 0.8)
    """

    margin: float = 1.2
    rim_strength: float | None = None
    rims_together: bool = False
    eccentricity: float = 0.8
    interface_pressure: float | None = None
    liner_pressure: float | None = None
    lateral_force: float | None = None
    slip_left: float | None = None
    uplift_gap: float | None = None
    rim_height: float | None = None
    axial_force: float | None = None
    floor_acceleration: float | None = None
    drift: float | None = None
    base_shear: float | None = None
    displacement_left: float | None = None
    rim_engagement: float | None = None
    moat_gap: float | None = None

    def __post_init__(self) -> None:
        for name, (least, below, unit) in _RANGES.items():
            value = getattr(self, name)
            if value is not None:
                remedy = f"give a limit in {unit}" if unit != "-" else "give a pure number"
                if self.__dataclass_fields__[name].default is None:
                    remedy += ", or leave it out"
                require_between(name, value, least, below, unit, remedy=remedy, error=CheckError)

    def clause_of(self, name: str) -> str:
        """Return what a check against a limit cites: the project, or a proposal of this package."""
        is_proposed = getattr(self, name) == self.__dataclass_fields__[name].default
        return PROPOSED_LIMIT if is_proposed else PROJECT_LIMIT
