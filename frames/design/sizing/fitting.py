"""Slider, rims and interface for one radius and friction, and their unmet requirements."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.check import Check, Checks
from frames.design.calculation.not_evaluated import NOT_EVALUATED
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import code_named
from frames.design.devices.device import device_checks
from frames.design.sizing.candidate import Candidate, Governing, grouped
from lir_element import DesignWarning, LIRBearing
from lir_element.device.bearing_checks import LARGEST_SINE
from lir_element.texts import first_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.sizing.candidate import Size
    from frames.design.sizing.target import DesignTarget
    from lir_element.device.friction import FrictionLaw

    Analyse = Callable[[LIRBearing], EquivalentLinear]

_SHALLOW = 0.2
"""Radius of a slider over that of its concave surface, at most: beyond it is no shallow bowl."""

MET_SHARE = 0.75
"""Rim displacement over the displacement, under a code with a rule for rim contact."""

_WHATEVER_SLIDER = frozenset({"P_1", "P_2", "H_slip"})
"""Demands that a larger slider does not lessen."""


class Asked(NamedTuple):
    """Demands of time histories, besides those of the formula."""

    displacement: float = 0.0  # largest displacement that bearings without rims must allow [m]
    slip: float = 0.0  # needed slip of the interface [m]
    interface: float = 0.0  # least friction of the interface [-]
    # of each bearing the largest axial force [N], and the least radius of its slider [m]
    loads: tuple[float, ...] = ()
    sliders: tuple[float, ...] = ()

    def of_size(self, places: Sequence[int], size: int) -> float:
        """Return the least radius of the sliders of a size [m]."""
        each = zip(places, self.sliders or (0.0,) * len(places), strict=True)
        return max((radius for place, radius in each if place == size), default=0.0)


def fitted(
    radius: float,
    friction: FrictionLaw,
    system: IsolationSystem,
    count: int,
    target: DesignTarget,
    bounds: PropertyBounds | None,
    analyse: Analyse,
    asked: Asked,
) -> Candidate:
    """Return a radius and a friction with fitted slider, rims and interface.

    There are `count` sizes of slider at most, divided by the loads, the required ones among them.

    The sliders begin with the radius for the pressures. They grow until they also allow the slip:
    by its overlap, and by the offset of the resultant, which the interface's friction causes.
    """
    if asked.loads:
        more = {"time histories": asked.loads}
        system = replace(system, combinations={**system.combinations, **more})
    least = tuple(math.pi * a**2 * target.largest_pressure for a in asked.sliders)
    places, sizes = grouped(system, count, least)
    radii = [
        rounded_up(
            max(_by_pressure(size, target), asked.of_size(places, k)),
            target.slider_step,
        )
        for k, size in enumerate(sizes)
    ]
    height = 0.0
    while True:
        height = max(height, rounded_up(target.height_ratio * max(radii), 1e-3))
        plain = LIRBearing(
            radius=radius,
            slider_height=height,
            slider_radius=max(radii),
            friction=friction,
            capacity=math.inf,
            interface_friction=math.inf,
        )
        analysis = analyse(plain)
        t = _measures(plain, analysis, system, target, bounds, asked)
        if t.value("e_plate") >= LARGEST_SINE * radius:
            return _impossible(radius, friction, analysis, t, (places, sizes), target)
        if t.value("h_min") > height:
            height = rounded_up(t.value("h_min"), 1e-3)
            continue
        bearings = [_rimmed(plain, each, t) for each in radii]
        found = [
            device_checks(
                bearing,
                (size.least, size.largest),
                slip=t.value("s"),
                bounds=bounds,
                limits=target.limits,
            )
            for bearing, size in zip(bearings, sizes, strict=True)
        ]
        wanted = [
            rounded_up(max(t.value("s"), _growth(checks) * each), target.slider_step)
            for each, checks in zip(radii, found, strict=True)
        ]
        if wanted == radii or max(wanted) > _SHALLOW * radius:
            break
        radii = wanted
    checks = Checks(check for each in found for check in each)
    return Candidate(
        radius=radius,
        friction=friction,
        bearings=tuple(bearings),
        analysis=analysis,
        checks=checks,
        trace=t,
        lacks=tuple(_lacks(t, analysis, checks, wanted, target, radius)),
        groups=tuple(sizes),
        governing=_governing(t, analysis, checks, wanted, target, radius),
        least_pressure=target.least_pressure,
        places=places,
        prices=target.prices,
    )


def _impossible(
    radius: float,
    friction: FrictionLaw,
    analysis: EquivalentLinear,
    t: Trace,
    parted: tuple[tuple[int, ...], tuple[Size, ...]],
    target: DesignTarget,
) -> Candidate:
    return Candidate(
        radius=radius,
        friction=friction,
        bearings=(),
        analysis=analysis,
        checks=Checks(),
        trace=t,
        lacks=(
            f"the plates have a radius of {t.value('e_plate'):.3g} m, too large for their depth",
        ),
        groups=parted[1],
        governing=Governing("too deep a bowl", t.value("e_plate") / (LARGEST_SINE * radius)),
        least_pressure=target.least_pressure,
        places=parted[0],
        prices=target.prices,
    )


def rounded_up(value: float, step: float) -> float:
    """Return the least multiple of a step that is not below a value, round-off aside."""
    return round(math.ceil(value / step - 1e-6) * step, 9)


def _by_pressure(size: Size, target: DesignTarget) -> float:
    area = max(size.average / target.pressure, size.largest / target.largest_pressure)
    return rounded_up(math.sqrt(area / math.pi), target.slider_step)


def _growth(checks: Checks) -> float:
    # Growth of a slider's radius, from its failing checks: less than needed, so that none grows too
    # far.
    ratios = [c.ratio for c in checks.failed if c.symbol not in _WHATEVER_SLIDER]
    return min(math.sqrt(max(ratios, default=1.0)), 1.2)


def _measures(
    plain: LIRBearing,
    analysis: EquivalentLinear,
    system: IsolationSystem,
    target: DesignTarget,
    bounds: PropertyBounds | None,
    asked: Asked,
) -> Trace:
    # Rims, slip and interface of bearings that go as far as those without rims.
    t = Trace()
    t.given("W", system.seismic_weight, "N")
    t.given("V_b", analysis.base_shear, "N", note="largest, without rims")
    allowed, note = analysis.allowed_displacement, "that bearings must allow, without rims"
    if asked.displacement > allowed:
        t.given("D_EL", allowed, "m", shown="mm", note=note)
        note = "the same by time histories"
        t.given("D_TH", asked.displacement, "m", shown="mm", note=note)
        t("D", "max(D_EL, D_TH)", "m", shown="mm")
    else:
        t.given("D", allowed, "m", shown="mm", note=note)
    t.given("R", plain.radii[0], "m")
    t.given("a", plain.slider_radius, "m", shown="mm", note="largest slider")
    t.given("h", plain.slider_height, "m", shown="mm")
    t("L", "2 * R - h", "m")
    _place_rims(t, analysis, target, asked)
    t("e_plate", "U_cap * R / L + a", "m", shown="mm", note="edge of the concave surfaces")
    t.given("c", target.clearance, "m", shown="mm", note="between the plates' edges at rest")
    t(
        "h_min",
        "2 * (R - sqrt(max(R**2 - e_plate**2, 0))) + c",
        "m",
        shown="mm",
        note="least height of the slider",
    )
    t.given("mu", plain.frictions[0].f_max, note="nominal")
    upper, inner = (1.0, 1.0)
    if bounds is not None:
        upper, inner = bounds.friction.upper, bounds.interface_factors.lower
    t.given("lambda_U", upper, note="upper bound of the surfaces")
    t.given("lambda_h", inner, note="lower bound of the interface")
    t("mu_e", "lambda_U * mu * 2 * R / L", source="docs/theory.md (2.1)")
    t.given("gamma", target.limits.margin)
    source = "docs/theory.md (2.1), (2.7)"
    formula = "max(gamma * mu_e, mu_e + s / L) / lambda_h"
    if asked.interface > 0.0:
        t.given("mu_h_TH", asked.interface, note="by time histories")
        formula = f"max({formula}, mu_h_TH)"
    needed = t("mu_h_min", formula, source=source)
    t.given("mu_h", rounded_up(needed, target.friction_step), note="rounded up")
    t.given("b", target.rim_width, "m", shown="mm", note="width of the rim")
    t("d_plan", "2 * (e_plate + b)", "m", shown="mm")
    t("d_plan_free", "2 * (max(D, U_cap) * R / L + a + b)", "m", shown="mm", note="rims not met")
    return t


def _place_rims(t: Trace, analysis: EquivalentLinear, target: DesignTarget, asked: Asked) -> None:
    # The given share; else by intent if the code has a rule for it, beyond all its checks if not.
    rule, share, source = code_named(analysis.code).rims, target.rim_share, "docs/sizing.md"
    if share is None and rule.least < 1.0:
        share = max(MET_SHARE, rule.least)
    if share is not None:
        t.given("r", share, note="share of D at which the rims are met")
        t("U_cap", "r * D", "m", shown="mm", source=source)
    else:
        held = [c.demand for c in analysis.checks if c.unit == "m" and math.isinf(c.limit)]
        note = "largest displacement in the code's checks of rim contact"
        t.given("D_held", max(held, default=t.value("D")), "m", shown="mm", note=note)
        t.given("m_r", target.free_margin, note="margin without rim contact")
        t("U_cap", "m_r * max(D, D_held)", "m", shown="mm", source=source)
        t("r", "U_cap / D", note="share of D at which the rims are met")
    if t.value("r") < 1.0:
        formula, note = "D - U_cap", "left to the interface"
        if target.slip_margin > 1.0:
            t.given("m_s", target.slip_margin, note="margin of the slip")
            formula = "m_s * (D - U_cap)"
    else:
        t.given("r_s", target.slip_reserve, note="reserve without rim contact")
        formula, note = "r_s * D", "reserve of the interface"
    if asked.slip > 0.0:
        t.given("s_TH", asked.slip, "m", shown="mm", note="slip of time histories")
        formula = f"max({formula}, s_TH)"
    t("s", formula, "m", shown="mm", note=note)


def _rimmed(plain: LIRBearing, slider_radius: float, t: Trace) -> LIRBearing:
    with warnings.catch_warnings():  # the stable limit of interface slip is among the checks
        warnings.simplefilter("ignore", DesignWarning)
        return replace(
            plain,
            slider_radius=slider_radius,
            capacity=t.value("U_cap"),
            interface_friction=t.value("mu_h"),
        )


def _lacks(
    t: Trace,
    analysis: EquivalentLinear,
    checks: Checks,
    wanted: Sequence[float],
    target: DesignTarget,
    radius: float,
) -> list[str]:
    found = [
        f"{what} {value:.3g} {unit} exceeds {limit:.3g} {unit}".replace(" -", "")
        for what, value, limit, unit in _asked(t, wanted, target, radius)
        if limit is not None and value > limit
    ]
    ill = [*checks.failed]
    ill += [*analysis.checks.failed]
    return found + sorted({_lacking(check) for check in ill})


def _lacking(check: Check) -> str:
    # By how much a check fails, or why it was not evaluated.
    if NOT_EVALUATED in check.title:
        return f"{check.title} ({first_of(check.note)})"
    return f"{check.title} (ratio {check.ratio:.2f})"


def _governing(
    t: Trace,
    analysis: EquivalentLinear,
    checks: Checks,
    wanted: Sequence[float],
    target: DesignTarget,
    radius: float,
) -> Governing:
    # Limits of the procedure do not count: time histories take its place.
    found = [
        Governing(what, value / limit)
        for what, value, limit, _ in _asked(t, wanted, target, radius)
        if limit is not None
    ]
    counted = [*checks, *(c for c in analysis.checks if c.scope != "procedure")]
    found += [Governing(check.title, check.ratio) for check in counted]
    return max(found, key=lambda one: one.ratio)


def _asked(
    t: Trace, wanted: Sequence[float], target: DesignTarget, radius: float
) -> tuple[tuple[str, float, float | None, str], ...]:
    # Requirements of the target, with its limits.
    return (
        ("displacement", t.value("D"), target.max_displacement, "m"),
        ("base shear / weight", t.value("V_b") / t.value("W"), target.max_base_shear, "-"),
        ("plan diameter", t.value("d_plan"), target.max_plan_diameter, "m"),
        ("slider radius", max(wanted), _SHALLOW * radius, "m"),
    )
