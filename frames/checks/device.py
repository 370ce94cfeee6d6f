"""Checks of the LIR-DCFP that no code has, from the bearing's own numbers, before any run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from frames._errors import CheckError
from frames.checks.check import TO_BE_CONFIRMED, Bound, Check, Checks
from frames.checks.trace import Trace
from lir_element.device.sliders import interface_height
from lir_element.door import require_between, require_non_negative, require_positive, require_type
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.checks.bounds import PropertyBounds
    from lir_element import LIRBearing

_NO_CODE = "no code: docs/theory.md"
_SAME = 1e-9
SURFACES = ("bottom", "top")


@dataclass(frozen=True, kw_only=True)
class DeviceLimits:
    """What a bearing and what stands on it may be asked for, by the engineer who designs them.

    Where a limit is None, what it bounds is not checked, unless it says otherwise.

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
    landing_force : float, optional
        Axial force that a bearing resists where it lands [N].
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
    landing_force: float | None = None
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


def overlap_area(radius: float, offset: float) -> float:
    """Return the area that two circles of one radius share, their centres `offset` apart [m2].

    Parameters
    ----------
    radius : float
        Radius of both [m], > 0.
    offset : float
        Distance of their centres [m], at least 0.

    Returns
    -------
    float
        ``2 a^2 acos(s / 2 a) - s / 2 sqrt(4 a^2 - s^2)``, 0 from ``s = 2 a`` on.

    Raises
    ------
    CheckError
        If a length is out of bounds.

    Examples
    --------
    >>> round(overlap_area(0.15, 0.15) / overlap_area(0.15, 0.0), 3)
    0.391
    """
    a = require_positive("radius", radius, "m", error=CheckError)
    s = min(require_non_negative("offset", offset, "m", error=CheckError), 2.0 * a)
    return 2.0 * a * a * math.acos(0.5 * s / a) - 0.5 * s * math.sqrt(4.0 * a * a - s * s)


def device_checks(
    bearing: LIRBearing,
    loads: tuple[float, float],
    *,
    slip: float,
    slip_left: float = 0.0,
    bounds: PropertyBounds | None = None,
    limits: DeviceLimits | None = None,
) -> Checks:
    """Check a bearing by what its geometry and friction alone decide.

    Parameters
    ----------
    bearing : LIRBearing
        The bearing, friction nominal. A slider in two pieces, with rims.
    loads : (float, float)
        Least and largest axial load while it works, N_min and N_max [N], > 0.
    slip : float
        Largest interface slip that is reckoned with [m].
    slip_left : float
        Interface slip that an earlier event left, in the worse direction [m].
    bounds : PropertyBounds, optional
        Bounds of friction; nominal friction if None. The low friction is taken at its upper bound
        and that of the interface at its lower one where the interface must hold, the other way
        round where it must slip.
    limits : DeviceLimits, optional
        What it may be asked for.

    Returns
    -------
    Checks
        That the interface holds until a rim is met, at both loads; that its slip holds; that it
        slips before a rim breaks; that the resultant stays on the slider; pressures and lateral
        force where they have a limit.

    Raises
    ------
    CheckError
        If the slider is in one piece or has no rims, or a number is out of bounds.

    Notes
    -----
    Source: docs/theory.md, sections 2 and 10: the moments of the slider about its spheres'
    centres, in a plane, the plates parallel. Friction counts at high speed where it loads the
    interface, and at low speed where it relieves a rim.
    """
    limits = DeviceLimits() if limits is None else limits
    least, most = _ordered(loads)
    t = _numbers(bearing, bounds)
    t.given("s", require_non_negative("slip", slip, "m", error=CheckError), "m", shown="mm")
    left = require_non_negative("slip_left", slip_left, "m", error=CheckError)
    t.given("s_left", left, "m", shown="mm", note="left by an earlier event")
    t.given("N_min", least, "N")
    t.given("N_max", most, "N")
    _friction_at_bounds(t)
    checks = [*_holds(t, limits), _stable(t)]
    checks += _rims(t, bearing, limits)
    checks.append(_eccentricity(t, limits))
    checks += _pressures(t, limits)
    if limits.lateral_force is not None:
        checks.append(_lateral(t, limits.lateral_force))
    return Checks(checks)


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
    """
    t = _numbers(bearing, bounds)
    t.given("D", require_non_negative("displacement", displacement, "m", error=CheckError), "m",
            shown="mm")  # fmt: skip
    left = require_non_negative("slip_left", slip_left, "m", error=CheckError)
    t.given("s_left", left, "m", shown="mm", note="left by an earlier event")
    _friction_at_bounds(t)
    _stability(t)
    t.given("s_cap", bearing.resolved()["slip_capacity"], "m", shown="mm",
            note="slip at which the sliders' overlap ends")  # fmt: skip
    t("s_lim", "max(min(s_cap, s_star), 0)", "m", shown="mm")
    t("U_slide", "min(D, U_cap)", "m", shown="mm", note="both surfaces, as the slider tilts")
    common = {"unit": "m", "shown": "mm", "bound": bound, "clause": f"{_NO_CODE}, section 2"}
    found = []
    for k, name in enumerate(SURFACES, start=1):
        t(f"d_{k}", f"R_{k} * U_slide / L", "m", shown="mm")
        demand, limit = t.value(f"d_{k}"), t.value(f"d_rim_{k}")
        found.append(_check(t, common, f"sliding on the {name} surface", f"d_{k}", demand, limit,
                            f"d_rim_{k}"))  # fmt: skip
    slip = t("s_D", "max(D - U_cap, 0) + s_left", "m", shown="mm")
    found.append(_check(t, common, "slip of the interface", "s_D", slip, t.value("s_lim"), "s_lim"))
    whole = t("U_max", "U_cap + s_lim - s_left", "m", shown="mm")
    found.append(_check(t, common, "displacement", "D", t.value("D"), whole, "U_max"))
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
    _require_rims(bearing)
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
            t = _geometry(bearing)
            t.given("D_TM", value, "m", shown="mm")
            t.given("least", least)
            t("U_rim", f"L * d_rim_{k} / R_{k}", "m", shown="mm", note=f"{name} rim is met")
            share = t("eta", "U_rim / D_TM")
            note = "the rim is not met" if share >= 1.0 else "nonlinear dynamic analysis with rims"
            found.append(
                Check(clause="ASCE 7-22 17.2.4.5", title="displacement at which a rim engages, "
                      "over D_TM", symbol="eta", demand=share, limit=least, relation=">=",
                      trace=t.of("eta", "least"), standing=TO_BE_CONFIRMED, bound=bound,
                      subject=f"{name} rim", note=note)
            )  # fmt: skip
    return Checks(found)


def _ordered(loads: tuple[float, float]) -> tuple[float, float]:
    least, most = (require_positive("axial load", load, "N", error=CheckError) for load in loads)
    if least > most:
        msg = f"loads = {loads}: give the least first, then the largest [N]"
        raise CheckError(msg)
    return least, most


def _require_rims(bearing: LIRBearing) -> None:
    if not math.isfinite(bearing.lateral_capacity):
        msg = "the bearing has no rims: give it a capacity, or leave this check out"
        raise CheckError(msg)


def _geometry(bearing: LIRBearing) -> Trace:
    t = Trace()
    for k, (radius, rim) in enumerate(
        zip(bearing.radii, bearing.rim_displacement, strict=True), start=1
    ):
        t.given(f"R_{k}", radius, "m")
        t.given(f"d_rim_{k}", rim, "m", shown="mm", note="sliding at which the rim is met")
    t.given("h", bearing.slider_height, "m", shown="mm")
    t("L", "R_1 + R_2 - h", "m")
    t("U_cap", "L * min(d_rim_1 / R_1, d_rim_2 / R_2)", "m", shown="mm")
    return t


def _numbers(bearing: LIRBearing, bounds: PropertyBounds | None) -> Trace:
    _require_rims(bearing)
    if bearing.is_dcfp:
        msg = "the slider is in one piece: it has no interface to check"
        raise CheckError(msg)
    t = _geometry(bearing)
    t.given("a", bearing.slider_radius, "m", shown="mm")
    height = float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))
    t.given("h_1", height, "m", shown="mm", note="interface above the bottom vertex")
    t("h_2", "h - h_1", "m", shown="mm")
    for k, law in enumerate(bearing.frictions, start=1):
        t.given(f"mu_{k}", law.f_max, note="high speed")
        t.given(f"mu_{k}_0", law.f_min, note="no speed")
    t.given("mu_h", bearing.interface_friction)
    parts = (None, None) if bounds is None else (bounds.friction, bounds.interface_factors)
    for name, factors in zip(("d", "h"), parts, strict=True):
        t.given(f"lambda_{name}_min", 1.0 if factors is None else factors.lower)
        t.given(f"lambda_{name}_max", 1.0 if factors is None else factors.upper)
    return t


def _friction_at_bounds(t: Trace) -> None:
    # Upper low friction and lower interface friction; friction at no speed at its lower bound.
    for k in (1, 2):
        t(f"mu_{k}_U", f"lambda_d_max * mu_{k}")
        t(f"mu_{k}_L", f"lambda_d_min * mu_{k}_0")
    t("mu_h_L", "lambda_h_min * mu_h")
    t("mu_h_U", "lambda_h_max * mu_h")
    t("mu_e", "(mu_1_U * R_1 + mu_2_U * R_2) / L", source="docs/theory.md, section 2")


def _check(
    t: Trace, common: Mapping[str, str], title: str, symbol: str, demand: float, limit: float,
    *also: str, **more: str,
) -> Check:  # fmt: skip
    words = {**common, **more}
    return Check(title=title, symbol=symbol, demand=demand, limit=limit,
                 trace=t.of(symbol, *also), **words)  # type: ignore[arg-type]  # fmt: skip


def _holds(t: Trace, limits: DeviceLimits) -> list[Check]:
    # Below the rims L F_h = N s + mu_1 N R_1 + mu_2 N R_2.
    t.given("gamma", limits.margin, note="margin; a proposal")
    found = []
    for name in ("min", "max"):
        force = t(f"F_{name}", f"N_{name} * (mu_e + s_left / L)", "N",
                  source="docs/theory.md (2.1)", note="interface, before a rim is met")  # fmt: skip
        held = t(f"H_{name}", f"mu_h_L * N_{name} / gamma", "N")
        common = {"unit": "N", "clause": f"{_NO_CODE} (2.1)", "subject": f"N_{name}"}
        found.append(_check(t, common, "the interface holds until a rim is met", f"F_{name}",
                            force, held, f"H_{name}"))  # fmt: skip
    return found


def _stability(t: Trace) -> float:
    return t("s_star", "L * mu_h_L - mu_1_U * R_1 - mu_2_U * R_2", "m", shown="mm",
             source="docs/theory.md (2.7)")  # fmt: skip


def _stable(t: Trace) -> Check:
    common = {"unit": "m", "shown": "mm", "clause": f"{_NO_CODE} (2.7)"}
    return _check(t, common, "slip that holds", "s", t.value("s"), _stability(t), "s_star",
                  note="low friction at its upper bound, the interface's at its lower")  # fmt: skip


def _rims(t: Trace, bearing: LIRBearing, limits: DeviceLimits) -> list[Check]:
    # At slip L mu_h N = -N s_left + sum of R (F + P cos theta), s_left against the motion.
    if limits.rim_strength is None:
        return []
    t("cos_theta", "sqrt(1 - (U_cap / L)**2)")
    t("M_P", "N_max * (L * mu_h_U + s_left - mu_1_L * R_1 - mu_2_L * R_2) / cos_theta", "N m",
      source="docs/theory.md (2.1)", note="moment of the rims where the interface slips")  # fmt: skip
    reach = [d / r for d, r in zip(bearing.rim_displacement, bearing.radii, strict=True)]
    met = [k for k in (0, 1) if reach[k] <= min(reach) * (1.0 + _SAME)]
    shared = limits.rims_together and len(met) == 2
    t.given("P_R", limits.rim_strength, "N", note="strength of a rim")
    common = {"unit": "N", "clause": f"{_NO_CODE} (2.1)"}
    found = []
    for k in met:
        formula = f"M_P * R_{k + 1} / (R_1**2 + R_2**2)" if shared else f"M_P / R_{k + 1}"
        force = t(f"P_{k + 1}", formula, "N", note="both rims" if shared else "this rim alone")
        found.append(_check(t, common, "the interface slips before the rim breaks", f"P_{k + 1}",
                            force, limits.rim_strength, "P_R",
                            subject=f"{SURFACES[k]} rim"))  # fmt: skip
    return found


def _eccentricity(t: Trace, limits: DeviceLimits) -> Check:
    # Of the resultant in the interface from both sliders' axes, (10.2): rims free, then each alone.
    t("e_1", "(R_1 - h_1) * (s / L + mu_e) - R_1 * mu_1_U", "m", shown="mm", note="rims free")
    t("e_2", "(R_2 - h_2) * mu_h_U - lambda_d_min * mu_2_0 * R_2", "m", shown="mm",
      note="bottom rim alone")  # fmt: skip
    t("e_3", "(R_1 - h_1) * mu_h_U - lambda_d_min * mu_1_0 * R_1", "m", shown="mm",
      note="top rim alone")  # fmt: skip
    worst = "max(abs(e_1), abs(e_1 - s), abs(e_2), abs(s - e_2), abs(e_3), abs(e_3 - s))"
    share = t("eps", f"{worst} / a", source="docs/theory.md (10.2)")
    common = {"clause": f"{_NO_CODE}, section 10", "unit": "-"}
    return _check(t, common, "resultant between the sliders, over their radius", "eps", share,
                  limits.eccentricity, note="0.25: pressed all over; 1: tips")  # fmt: skip


def _pressures(t: Trace, limits: DeviceLimits) -> list[Check]:
    found = []
    common = {"unit": "Pa", "clause": "no code: liner's maker"}
    if limits.interface_pressure is not None:
        value = pressure(t, "p_s", "N_max", "s")
        found.append(_check(t, common, "mean pressure on what overlaps", "p_s", value,
                            limits.interface_pressure, subject="interface"))  # fmt: skip
    if limits.liner_pressure is not None:
        for k, name in enumerate(SURFACES, start=1):
            t(f"c_{k}", f"2 * abs(R_{k} * (s / L + mu_e - mu_{k}_U))", "m", shown="mm",
              source="docs/theory.md, section 2",
              note="twice the offset of the centre of pressure, rims free")  # fmt: skip
            value = pressure(t, f"p_{k}", "N_max", f"c_{k}")
            found.append(_check(t, common, "mean pressure on the liner around its resultant",
                                f"p_{k}", value, limits.liner_pressure,
                                subject=f"{name} surface"))  # fmt: skip
    return found


def pressure(t: Trace, symbol: str, load: str, offset: str) -> float:
    """Enter the mean pressure of a load on what two circles of radius `a` share.

    Parameters
    ----------
    t : Trace
        The calculation, with `a` [m].
    symbol : str
        Symbol of the pressure.
    load, offset : str
        Symbols of the load [N] and of the distance of the circles' centres [m].

    Returns
    -------
    float
        The pressure [Pa], infinite where nothing overlaps.
    """
    area, s, a = f"A_{symbol}", t.value(offset), t.value("a")
    if s >= 2.0 * a:
        return t.given(symbol, math.inf, "Pa", note=f"nothing overlaps: {s:.4g} m")
    t(area, f"2 * a**2 * acos({offset} / (2 * a)) - {offset} / 2 * sqrt(4 * a**2 - {offset}**2)",
      "m2", note="circles that overlap")  # fmt: skip
    return t(symbol, f"{load} / {area}", "Pa")


def _lateral(t: Trace, limit: float) -> Check:
    t("t_theta", "U_cap / sqrt(L**2 - U_cap**2)", note="tangent of the tilt at the rim")
    value = t("H_slip", "N_max * (t_theta + mu_h_U) / (1 - t_theta * mu_h_U)", "N",
              source="docs/theory.md, section 2: W tan(theta + atan(mu_h))")  # fmt: skip
    common = {"unit": "N", "clause": f"{_NO_CODE}, section 2"}
    return _check(t, common, "lateral force that the bearing passes on", "H_slip", value, limit)
