"""Capacity of the LIR-DCFP as the sum of its three parts, and where its rims are met."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from frames._errors import CheckError
from frames.checks.bearing_numbers import (
    NO_CODE,
    SURFACES,
    enter_bearing,
    enter_geometry,
    enter_length,
    require_rims,
)
from frames.checks.check import CONFIRMED, Bound, Checks
from frames.checks.equivalent import Judge
from lir_element.door import require_positive

if TYPE_CHECKING:
    from frames.checks.bounds import PropertyBounds
    from lir_element import LIRBearing


def capacity_checks(
    bearing: LIRBearing,
    displacement: float,
    *,
    slip_left: float = 0.0,
    bounds: PropertyBounds | None = None,
    bound: Bound = "",
) -> Checks:
    """Check a displacement against the sum of the three parts that make it, and each part.

    Both surfaces slide together, as the slider tilts, until a rim is met; the interface does the
    rest.

    Parameters
    ----------
    bearing : LIRBearing
        The bearing, friction nominal.
    displacement : float
        Design displacement, in any direction [m].
    slip_left : float
        Interface slip that an earlier event left in that direction [m].
    bounds : PropertyBounds, optional
        Bounds of friction, for the slip that holds.
    bound : {"lower", "nominal", "upper", ""}
        Bound that the displacement belongs to.

    Returns
    -------
    Checks
        Sliding on the bottom and the top surface against their rims; interface slip against the
        smaller of overlap and s*; the whole displacement against the capacity.

    Raises
    ------
    CheckError
        If the slider is in one piece or has no rims, or a number is out of bounds.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> [round(check.ratio, 3) for check in capacity_checks(bearing, 0.2)]
    [1.0, 1.0, 0.315, 0.787]
    """
    t = enter_bearing(bearing, bounds)
    enter_length(t, "D", displacement)
    enter_length(t, "s_left", slip_left, note="left by an earlier event")
    t("U_slide", "min(D, U_cap)", "m", shown="mm", note="both surfaces, as the slider tilts")
    t("s_D", "max(D - U_cap, 0) + s_left", "m", shown="mm")
    t("U_max", "U_cap + s_lim - s_left", "m", shown="mm")
    judge, clause = Judge(t, bound, CONFIRMED), f"{NO_CODE}, section 2"
    found = []
    for k, name in enumerate(SURFACES, start=1):
        t(f"d_{k}", f"R_{k} * U_slide / L", "m", shown="mm")
        found.append(judge(clause, f"sliding on the {name} surface", f"d_{k}", "<=", f"d_rim_{k}"))
    found.append(judge(clause, "slip of the interface", "s_D", "<=", "s_lim"))
    found.append(judge(clause, "displacement over the sum of the parts", "D", "<=", "U_max"))
    return Checks(found)


def engagement_checks(
    bearing: LIRBearing,
    displacement: float | Mapping[Bound, float],
    *,
    least: float = 0.60,
) -> Checks:
    """Check at which share of the maximum displacement each rim is met, for ASCE 7-22 17.2.4.5.

    Parameters
    ----------
    bearing : LIRBearing
        The bearing.
    displacement : float or mapping
        Total maximum displacement D_TM [m], one or one for each bound.
    least : float
        Share of D_TM below which a restraint must not engage [-]; the edition's wording has to be
        read.

    Returns
    -------
    Checks
        A check for each rim and bound, where a rim is met below D_TM at all.

    Raises
    ------
    CheckError
        If the bearing has no rims, or a number is out of bounds.

    Notes
    -----
    A rim is met at ``U = L d / R``, plates parallel, no slip left.
    """
    require_rims(bearing)
    require_positive("least", least, "-", error=CheckError)
    of: Mapping[Bound, float] = (
        displacement if isinstance(displacement, Mapping) else {"": displacement}
    )
    found = []
    for bound, value in of.items():
        require_positive(f"displacement {bound}".strip(), value, "m", error=CheckError)
        for k, name in enumerate(SURFACES, start=1):
            if not math.isfinite(bearing.rim_displacement[k - 1]):
                continue
            t = enter_geometry(bearing)
            t.given("D_TM", value, "m", shown="mm")
            t.given("eta_least", least)
            t("U_rim", f"L * d_rim_{k} / R_{k}", "m", shown="mm", note=f"{name} rim is met")
            share = t("eta", "U_rim / D_TM")
            note = "not met below D_TM" if share >= 1.0 else "needs time histories with the rims"
            found.append(
                Judge(t, bound).worst(
                    "ASCE 7-22 17.2.4.5", "displacement where a rim engages, over D_TM",
                    "eta", ">=", "eta_least", subjects=(f"{name} rim",), note=note,
                )
            )  # fmt: skip
    return Checks(found)
