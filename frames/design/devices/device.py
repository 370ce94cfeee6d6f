"""Checks of the LIR-DCFP that no code has, from the bearing's own numbers, before any run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.calculation.check import Check, Checks
from frames.design.calculation.standing import PROJECT
from frames.design.codes.prototype_programme import ordered_loads
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.bearing_numbers import (
    SURFACES,
    by_equation,
    by_section,
    enter_bearing,
    enter_length,
    liner_pressure,
    pressure,
)
from frames.design.devices.limits import PROJECT_LIMIT, DesignLimits
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames.design.codes.bounds import PropertyBounds
    from lir_element import LIRBearing

_SAME = 1e-9


def device_checks(
    bearing: LIRBearing,
    loads: tuple[float, float],
    *,
    slip: float,
    slip_left: float = 0.0,
    bounds: PropertyBounds | None = None,
    limits: DesignLimits | None = None,
) -> Checks:
    """Check a bearing by its geometry and friction alone.

    Parameters
    ----------
    bearing : LIRBearing
        The bearing, friction nominal. A slider in two pieces, with rims.
    loads : (float, float)
        Least and maximum axial force along the slider while it works, N_min and N_max [N], > 0. At
        a rim it exceeds the vertical load by ``1 / (cos(theta) - mu_h sin(theta))``.
    slip : float
        Largest expected interface slip [m].
    slip_left : float
        Interface slip that an earlier event left, in the worse direction [m].
    bounds : PropertyBounds, optional
        Lower and upper bound friction properties; nominal friction if None. If the interface must
        hold, low friction is at its upper bound and interface friction at its lower one; if it must
        slip, the other way round.
    limits : DesignLimits, optional
        Limits of the project.

    Returns
    -------
    Checks
        The checks: the interface holds until rim contact, at both loads; its slip is stable; it
        slips before a rim breaks; the resultant stays on the slider; pressures and lateral force,
        if they have a limit.

    Raises
    ------
    CheckError
        If the slider is rigid or it has no rims, or a number is out of bounds.

    Notes
    -----
    Source: docs/theory.md, sections 2 and 10: the moments of the slider about its spheres' centres,
    in a plane, the plates parallel. Friction that depends on pressure counts at N_min in its upper
    bound and at N_max in its lower one. Include the effect of heat in the lower factor of `bounds`,
    because the temperature is not known here. Friction counts at high speed if it loads the
    interface, and at low speed if it relieves a rim. With one rim pressed alone the resultant is
    that of the first slip. As the interface slips on, the rim springs back, friction on the
    surfaces fades with it, and the offset grows; `impact_checks` gives it for a run.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> checks = device_checks(bearing, (100e3, 150e3), slip=0.02)
    >>> print(checks[2])
    stable limit of interface slip: 20 mm <= 79.29 mm, ratio 0.252, passed [no code: docs/theory.md
    (2.7)]
    """
    limits = DesignLimits() if limits is None else limits
    t = enter_bearing(bearing, bounds, ordered_loads(loads))
    enter_length(t, "s", slip)
    enter_length(t, "s_left", slip_left, note="left by an earlier event")
    judge = CheckBuilder(t, "", PROJECT)
    return Checks(
        [
            *_holds(judge, limits),
            _stable(judge),
            *_rims(judge, bearing, limits),
            _eccentricity(judge, limits),
            *_pressures(judge, limits),
            *_lateral(judge, limits),
        ]
    )


def _holds(judge: CheckBuilder, limits: DesignLimits) -> list[Check]:
    # Below the rims L F_h = N s + mu_1 N R_1 + mu_2 N R_2.
    t, found = judge.t, []
    own = limits.clause_of("margin") == PROJECT_LIMIT
    t.given(
        "gamma", limits.margin, note=joined("margin", "of the project" if own else "a proposal")
    )
    for name in ("min", "max"):
        t(
            f"F_{name}",
            f"N_{name} * (mu_e + s_left / L)",
            "N",
            source="docs/theory.md (2.1)",
            note="interface, before rim contact",
        )
        t(f"H_{name}", f"mu_h_L * N_{name} / gamma", "N")
        found.append(
            judge.worst(
                by_equation("2.1"),
                "interface holds until a rim is met",
                f"F_{name}",
                "<=",
                f"H_{name}",
                subjects=(f"N_{name}",),
            )
        )
    return found


def _stable(judge: CheckBuilder) -> Check:
    note = "low friction at its upper bound, the interface's at its lower"
    return judge(
        by_equation("2.7"), "stable limit of interface slip", "s", "<=", "s_star", note=note
    )


def _rims(judge: CheckBuilder, bearing: LIRBearing, limits: DesignLimits) -> list[Check]:
    # At slip L mu_h N = -N s_left + sum of R (F + P cos theta), s_left against the motion.
    if limits.rim_strength is None:
        return []
    t, found = judge.t, []
    t("cos_theta", "sqrt(1 - (U_cap / L)**2)")
    moment = "N_max * (L * mu_h_U + s_left - mu_1_L * R_1 - mu_2_L * R_2) / cos_theta"
    note = "moment of the rims where the interface slips"
    t("M_P", moment, "N m", source="docs/theory.md (2.1)", note=note)
    t.given("P_R", limits.rim_strength, "N", note="strength of a rim")
    reach = [d / r for d, r in zip(bearing.rim_displacement, bearing.radii, strict=True)]
    met = [k for k in (0, 1) if reach[k] <= min(reach) * (1.0 + _SAME)]
    shared = limits.rims_together and len(met) == 2
    for k in met:
        formula = f"M_P * R_{k + 1} / (R_1**2 + R_2**2)" if shared else f"M_P / R_{k + 1}"
        t(f"P_{k + 1}", formula, "N", note="both rims press" if shared else "this rim alone")
        found.append(
            judge.worst(
                by_equation("2.1"),
                "interface slips before the rim breaks",
                f"P_{k + 1}",
                "<=",
                "P_R",
                subjects=(worded("{name} rim", name=SURFACES[k]),),
            )
        )
    return found


def _eccentricity(judge: CheckBuilder, limits: DesignLimits) -> Check:
    # Distance of the resultant in the interface from both sliders' axes, (10.2): without restrainer
    # contact, then with each alone.
    t = judge.t
    t(
        "e_1",
        "(R_1 - h_1) * (s / L + mu_e) - R_1 * mu_1_U",
        "m",
        shown="mm",
        note="no restrainer contact",
    )
    t("e_2", "(R_2 - h_2) * mu_h_U - mu_2_L * R_2", "m", shown="mm", note="bottom rim alone")
    t("e_3", "(R_1 - h_1) * mu_h_U - mu_1_L * R_1", "m", shown="mm", note="top rim alone")
    free, alone = "abs(e_1), abs(e_1 - s)", "abs(e_2 - s), abs(e_3 - s)"
    left = "abs(e_2) + s_left, abs(e_3) + s_left"
    t("epsilon", f"max({free}, {alone}, {left}) / a", source="docs/theory.md (10.2)")
    own = limits.clause_of("eccentricity") == PROJECT_LIMIT
    t.given("epsilon_lim", limits.eccentricity, note="of the project" if own else "a proposal")
    title, note = "normalised eccentricity e/a at the rims", "tips at 1"
    return judge(by_section("10"), title, "epsilon", "<=", "epsilon_lim", note=note)


def _pressures(judge: CheckBuilder, limits: DesignLimits) -> list[Check]:
    t, found, clause = judge.t, [], "no code: liner's maker"
    if limits.interface_pressure is not None:
        t.given("p_i_lim", limits.interface_pressure, "Pa")
        pressure(t, "p_i", "N_max", "s")
        found.append(judge(clause, "pressure on the sliders' overlap", "p_i", "<=", "p_i_lim"))
    if limits.liner_pressure is not None:
        t.given("p_lim", limits.liner_pressure, "Pa")
        for k, name in enumerate(SURFACES, start=1):
            liner_pressure(t, k, "N_max")
            title = "pressure on the liner around its resultant"
            where = (worded("{name} surface", name=name),)
            found.append(judge.worst(clause, title, f"p_{k}", "<=", "p_lim", subjects=where))
    return found


def _lateral(judge: CheckBuilder, limits: DesignLimits) -> list[Check]:
    if limits.lateral_force is None:
        return []
    t = judge.t
    t.given("H_R", limits.lateral_force, "N")
    formula = "N_max * (U_cap / L + mu_h_U * sqrt(1 - (U_cap / L)**2))"
    source = "docs/theory.md (2.2), the interface slipping at the rim's tilt"
    t("H_slip", formula, "N", source=source)
    title = "lateral force that the bearing passes on"
    return [judge(by_section("2"), title, "H_slip", "<=", "H_R")]
