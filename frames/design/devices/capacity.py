"""Capacity of the LIR-DCFP as the sum of its three parts, and its rim displacements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check, Checks
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from frames.design.codes.registry import code_named
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.bearing_numbers import (
    SURFACES,
    by_section,
    enter_bearing,
    enter_geometry,
    enter_length,
    require_rims,
)
from frames.design.devices.limits import PROJECT_LIMIT
from lir_element.argument_checks import require_positive
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.registry import RimRule
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

    Both surfaces slide together, as the slider tilts, until rim contact; the interface slips the
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
        Lower and upper bound friction properties, for the stable limit of interface slip.
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
        If the slider is rigid or it has no rims, or a number is out of bounds.

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
    judge, clause = CheckBuilder(t, bound, PROJECT), by_section("2")
    found = []
    for k, name in enumerate(SURFACES, start=1):
        t(f"d_{k}", f"R_{k} * U_slide / L", "m", shown="mm")
        found.append(
            judge(
                clause,
                worded("sliding on the {name} surface", name=name),
                f"d_{k}",
                "<=",
                f"d_rim_{k}",
            )
        )
    found.append(judge(clause, "slip of the interface", "s_D", "<=", "s_lim"))
    found.append(judge(clause, "displacement over the sum of the parts", "D", "<=", "U_max"))
    return Checks(found)


def engagement_checks(
    bearing: LIRBearing,
    displacement: float | Mapping[Bound, float],
    *,
    least: float | None = None,
    code: str = "ASCE 7-22",
    agreed: float | None = None,
) -> Checks:
    """Check the rim displacements as shares of the needed displacement capacity.

    Parameters
    ----------
    bearing : LIRBearing
        The bearing.
    displacement : float or mapping
        Displacement that bearings must allow [m], one or one for each bound: D_TM of ASCE 7-22, and
        of NCh2745 at its maximum level; gamma_x d_bd of EN 1998.
    least : float, optional
        Share of it below which a rim must not be reached [-]; that of the code if None: 0.60 of
        ASCE 7-22 (wording to be read), 1 of the others, which have no rule for intended rim
        contact.
    code : str
        The code: "ASCE 7-22", "EN 1998", "NCh2745", or one that was registered.
    agreed : float, optional
        Share agreed with the authority, or proved by tests [-]: checked beside that of the code.

    Returns
    -------
    Checks
        A check for each rim and bound. If the code has no rule for intended rim contact, one check
        for the worst rim and bound; its verdict is "needs agreement" if a rim is reached earlier.
        An agreed share adds the same number of checks.

    Raises
    ------
    CheckError
        If the bearing has no rims, the code is not known, or a number is out of bounds.

    Notes
    -----
    Rim contact is at ``U = L d / R``, plates parallel, no residual slip.

    Examples
    --------
    >>> from frames.design import engagement_checks
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> checks = engagement_checks(bearing, 0.5)
    >>> checks.passed, round(checks[0].demand, 2)
    (True, 0.9)
    """
    require_rims(bearing)
    rule = code_named(code).rims
    share = rule.least if least is None else require_positive("least", least, "-", error=CheckError)
    known = rule.standing if least is None else FROM_MEMORY
    asked = [(rule.clause, known, share, rule.note)]
    if agreed is not None:
        require_positive("agreed", agreed, "-", error=CheckError)
        said = "as agreed; the code's share is checked separately"
        asked.append((PROJECT_LIMIT, PROJECT, agreed, said))
    of: Mapping[Bound, float] = (
        displacement if isinstance(displacement, Mapping) else {"": displacement}
    )
    for bound, value in of.items():
        require_positive(f"displacement {bound}".strip(), value, "m", error=CheckError)
    rims = [k for k in range(len(SURFACES)) if math.isfinite(bearing.rim_displacement[k])]
    found: list[Check] = []
    for each in asked:
        made = [_met(bearing, k, at, rule, *each) for at in of.items() for k in rims]
        found += made if rule.least < 1.0 else [max(made, key=lambda check: check.ratio)]
    return Checks(found)


def _met(
    bearing: LIRBearing,
    k: int,
    at: tuple[Bound, float],
    rule: RimRule,
    clause: str,
    standing: Standing,
    least: float,
    said: str,
) -> Check:
    # Displacement at rim contact, over the needed displacement capacity.
    t, symbol = enter_geometry(bearing), rule.symbol
    t.given("D_allowed", at[1], "m", shown="mm", note=symbol)
    t.given("eta_least", least)
    name = SURFACES[k]
    t(
        "U_rim",
        f"L * d_rim_{k + 1} / R_{k + 1}",
        "m",
        shown="mm",
        note=worded("{name} rim is met", name=name),
    )
    share = t("eta", "U_rim / D_allowed")
    no_rule = standing != PROJECT and rule.least >= 1.0
    judge = CheckBuilder(t, at[0], standing, "agreement" if no_rule else "any")
    return judge.worst(
        clause,
        worded("displacement where a rim engages, over {what}", what=symbol),
        "eta",
        ">=",
        "eta_least",
        subjects=(worded("{name} rim", name=name),),
        note=worded("not met below {symbol}", symbol=symbol) if share >= 1.0 else said,
    )
