"""What a bearing, and what stands on it, may be asked for: limits that the engineer sets."""

from __future__ import annotations

import math
from dataclasses import dataclass

from frames._errors import CheckError
from lir_element.door import require_between, require_positive


@dataclass(frozen=True, kw_only=True)
class DesignLimits:
    """What a bearing and what stands on it may be asked for, by the engineer who designs them.

    Where a limit is None, what it bounds is not checked, unless it says otherwise. `margin` and
    `rims_together` are of `device_checks` alone.

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
        Largest offset of the resultant between the sliders over their radius [-]. They are pressed
        all over up to 0.25 and tip at 1; the 0.8 is a proposal as well.
    interface_pressure, liner_pressure : float, optional
        Mean pressure that the interface's and the concave surfaces' liners bear [Pa].
    lateral_force : float, optional
        Lateral force of one bearing that what is above and below it resists [N].
    slip_left : float, optional
        Interface slip that may stay after an event [m]; that which holds, s*, if None.
    uplift_gap : float, optional
        Gap that a bearing may open [m].
    axial_force : float, optional
        Axial force that a bearing resists, landings included [N].
    floor_acceleration : float, optional
        Largest acceleration of a floor in plan [m/s2].
    drift : float, optional
        Largest storey drift ratio at an impact [-].
    base_shear : float, optional
        Largest base shear of all bearings [N].
    displacement_left : float, optional
        Bearing displacement that may stay after an event [m].

    Raises
    ------
    CheckError
        If a limit is not positive.
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
    axial_force: float | None = None
    floor_acceleration: float | None = None
    drift: float | None = None
    base_shear: float | None = None
    displacement_left: float | None = None

    def __post_init__(self) -> None:
        require_between("margin", self.margin, 1.0, math.inf, "-", error=CheckError)
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if value is not None and name != "rims_together":
                require_positive(name, value, error=CheckError)
