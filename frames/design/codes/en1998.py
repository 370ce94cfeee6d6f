"""Equivalent linear analysis and checks of EN 1998-1 chapter 10, EN 1998-2 chapter 7, EN 15129."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar

from frames.design._errors import CheckError
from frames.design.calculation.check import Check, Checks
from frames.design.codes.common import (
    LinearAnalysis,
    capacity_check,
    drift_checks,
    eccentricities,
    enter_restoring,
    enter_storeys,
)
from frames.design.codes.history_rules import DESIGN
from frames.design.codes.outcome import Symbols
from frames.design.codes.prototype_programme import DesignToTest, PlannedTest
from frames.design.codes.registry import DesignCode
from frames.design.codes.secant import CheckBuilder, enter_system, procedure_limit, secant
from frames.design.codes.values_of_en1998 import (
    COMPANION,
    NAME,
    PROVISIONS,
    RULES,
    VALUES,
    vertical_level,
)
from frames.design.hazard.spectrum import Spectrum
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames.design.calculation.trace import Trace
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.isolation import Extremes, IsolationSystem
    from frames.design.codes.superstructure import Superstructure


_ECCENTRIC = "eccentricity of the isolation over its torsional radius"
_TORSION = "torsional radius of the isolation over the radius of gyration"


@dataclass(frozen=True, kw_only=True)
class EN1998(LinearAnalysis):
    """Factors of EN 1998-1 and -2 and EN 15129; `CODE.values` gives the source of each.

    Parameters
    ----------
    reliability : float
        Factor on the displacement that bearings must allow: gamma_x = 1.2 for buildings
        (EN 1998-1 10.3), gamma_IS = 1.5 for bridges (EN 1998-2 7.6.2).
    accidental_eccentricity : float
        Accidental eccentricity over the side of the plan (EN 1998-1 4.3.2).
    behaviour : float
        Behaviour factor q of the superstructure, 1.5 at most (EN 1998-1 10.10).
    energy_ratio : float
        Least stored over dissipated energy, E_S / E_H (EN 15129 4.3).
    recentring : float
        Least displacement over the largest residual one, d_cd / d_r (EN 1998-2 7.7.1).
    restoring : float
        Force that the second half of the displacement must add, over W (EN 1998-1 10.9.2).
    stiffness_ratio, most_damping : float
        Least K_eff over that at 0.2 d_dc, and largest damping (EN 1998-1 10.9.2).
    property_variation : float, optional
        Variation of properties with rate and load in the range of interest [-], from tests.
    most_variation : float
        Its limit (EN 1998-1 10.9.2).
    simplified : bool
        True if the limits of the simplified linear analysis are checked (EN 1998-1 10.9.3).
    fault_distance : float, optional
        Distance of the nearest fault of magnitude 6.5 and more [m], for these limits.
    least_distance, largest_side, longest_period, period_ratio, vertical_period : float
        These limits: distance [m], side of the plan [m], T_eff [s], T_eff over T_f, T_v [s].
    vertical_stiffness : float
        Another of these limits: K_V over K_eff, K_V by T_v; NTC 2018 has 800.
    total_eccentricity : float
        Limit of the eccentricity between the centres of mass and stiffness, the accidental one
        with it, over the side of the plan (EN 1998-1 10.9.3); NTC 2018 has 0.03.
    eccentricity_ratio, radius_ratio : float
        Regularity in plan of the isolation: largest distance of the centres of mass and stiffness
        over the torsional radius, least torsional radius over the radius of gyration (EN 1998-1
        4.2.3.2(6)).
    accumulated : float
        Share of the displacement without force, mu L, that earlier events leave (NTC 2018
        7.10.6.2.2).
    drift, reduction : float
        Limit of storey drift over height, 0.005 with brittle elements up to 0.010, and factor nu
        on the drift for the more frequent earthquake (EN 1998-1 4.4.3.2).
    orthogonal : float
        Share of the other direction's overturning that acts with it (EN 1998-1 4.3.3.5).
    pressure_limit : float, optional
        Pressure resistance of the sliders [Pa].

    Examples
    --------
    In the how-to: "Design checks and equivalent-linear analysis" (docs/design_checks.md).
    """

    reliability: float = 1.2
    behaviour: float = 1.5
    energy_ratio: float = 0.25
    recentring: float = 0.5
    stiffness_ratio: float = 0.5
    most_damping: float = 0.30
    property_variation: float | None = None
    most_variation: float = 0.10
    simplified: bool = False
    fault_distance: float | None = None
    least_distance: float = 15e3
    largest_side: float = 50.0
    longest_period: float = 3.0
    period_ratio: float = 3.0
    vertical_period: float = 0.1
    vertical_stiffness: float = 150.0
    total_eccentricity: float = 0.075
    eccentricity_ratio: float = 0.30
    radius_ratio: float = 1.0
    accumulated: float = 0.5
    drift: float = 0.005
    reduction: float = 0.5
    name: ClassVar[str] = NAME
    symbols: ClassVar[Symbols] = Symbols(
        "d_dc", "d_bd", "K_eff", "xi_eff", "T_eff", "eta", "V_b", "V_s", allowed="d_max"
    )
    each: ClassVar[str] = "d_bi"
    level: ClassVar[str] = DESIGN
    values: ClassVar[Mapping[str, CodeValue]] = VALUES
    reduced_by: ClassVar[str] = "q"
    shear_clause: ClassVar[str] = "EN 1998-1 10.9.3"
    overturning_clause: ClassVar[str] = "EN 1998-1 4.4.2.4"
    vertical_clause: ClassVar[str] = "EN 15129 8.3, EN 1998-1 10.10"

    def require(self, spectrum: Spectrum, above: Superstructure | None) -> None:
        """Raise a CheckError if the simplified analysis lacks a distance or a period."""
        vertical = None if above is None else above.vertical_period
        if self.simplified and (self.fault_distance is None or vertical is None):
            msg = (
                "the limits of the simplified analysis need fault_distance of EN1998, and a "
                "superstructure with its vertical_period: give both, or set simplified=False"
            )
            raise CheckError(msg)

    def first_displacement(self, system: IsolationSystem, spectrum: Spectrum) -> float:
        """Return the displacement at which the search begins [m]."""
        return 0.1 * max(p.effective_radius for p in system.pendulums)

    def step(self, system: IsolationSystem, spectrum: Spectrum, displacement: float) -> Trace:
        """Return d_dc of an assumed displacement [m]."""
        t = enter_system(system)
        t.given("d_0", displacement, "m", note="assumed, and found again")
        secant(t, "d_0", self.symbols, "EN 1998-1 10.9.2; EN 15129 8.3")
        damping = t.value("xi_eff")
        factor = spectrum.damping_factor(damping)
        t.looked_up("eta", 1.0 / factor, ["xi_eff"], source="EN 1998-1 (3.6)")
        acceleration = spectrum.acceleration(t.value("T_eff"), damping)
        at, source = ["T_eff", "xi_eff"], "EN 1998-1 3.2.2.2"
        t.looked_up("S_e", float(acceleration), at, "m/s2", source=source)
        t("M", "W / g", "kg", shown="t")
        t("d_dc", "M * S_e / K_eff", "m", source="EN 1998-1 (10.4)", shown="mm")
        return t

    def totals(self, t: Trace, system: IsolationSystem, spectrum: Spectrum) -> None:
        """Enter d_bd, d_max, and d_bi of each bearing."""
        t.given("a_e", self.accidental_eccentricity, source="EN 1998-1 4.3.2")
        source = "EN 1998-1 (10.5)"
        eccentricities(t, system, "a_e", "EN 1998-1 4.3.2", by_direction=True)
        t.each("x_i", "x - x_R", "m")
        t.each("y_i", "y - y_R", "m")
        t("r2", "sum(F * (x_i**2 + y_i**2)) / sum(F)", "m2", note="torsional radius squared")
        for along, across in (("x", "y"), ("y", "x")):
            lever = f"e_{across} / r2" if t.value("r2") > 0.0 else "0"
            formula = f"1 + {lever} * abs({across}_i)"
            t.each(
                f"delta_{along}",
                formula,
                source=source,
                note=worded("motion along {along}", along=along),
            )
        t.each("d_bi", "d_dc * max(delta_x, delta_y)", "m", shown="mm")
        t.given("gamma_x", self.reliability)
        t.each("d_Ed", "gamma_x * d_bi", "m", source="EN 1998-1 10.3", shown="mm")
        t("d_bd", "max(d_bi)", "m", shown="mm")
        t("d_max", "max(d_Ed)", "m", shown="mm", note="that bearings must allow")

    def device_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks of capacity, recentring and limits of the procedure."""
        t("K_02", "sum(P * (0.2 * d_dc / L + mu)) / (0.2 * d_dc)", "N/m", note="at 0.2 d_dc")
        enter_restoring(t, "d_dc", self.restoring)
        t("a_tot", "max(e_x / b, e_y / d)", note="with the accidental one, over the side")
        t("r_T", "sqrt(r2)", "m", note="torsional radius of the isolation")
        t("e_r", "max(abs(x_M - x_R), abs(y_M - y_R)) / r_T" if t.value("r2") > 0.0 else "0 * r_T")
        t("l_s", "sqrt((b**2 + d**2) / 12)", "m", note="radius of gyration, mass even in plan")
        t("r_l", "r_T / l_s")
        t.given("a_S", self.energy_ratio)
        t.each("E_S", "P * d_dc**2 / (2 * L)", "J", source="EN 15129 4.3", note="stored, 0 to d_dc")
        t.each("E_H", "P * mu * d_dc", "J", source="EN 15129 4.3", note="dissipated, 0 to d_dc")
        t.each("E_lim", "a_S * E_H", "J")
        t.given("a_r", self.recentring)
        t.each("d_r", "mu * L", "m", source="EN 1998-2 7.7.1", shown="mm", note="largest residual")
        t.each("d_least", "a_r * d_r", "m", shown="mm")
        limit, names = partial(procedure_limit, judge), system.labels
        title, stiffness = "recentring, energy", "effective stiffness ratio, d_dc to 0.2 d_dc"
        eccentricity = "total eccentricity over the side of the plan"
        capacity = judge.resting_on("capacity", "reliability")

        found = [
            capacity_check(
                t, system, capacity, "EN 1998-1 10.3, EN 15129 8.3", "d_Ed", "gamma_x d_bd"
            ),
            judge.resting_on("energy").worst(
                "EN 15129 4.3", title, "E_S", ">=", "E_lim", subjects=names
            ),
            judge.resting_on("recentring").worst(
                "EN 1998-2 7.7.1",
                "recentring, displacement",
                "d_dc",
                ">=",
                "d_least",
                subjects=names,
                note="else capacity must be d_o + gamma_du rho_d d_bi,d",
            ),
            limit("stiffness ratio", stiffness, "K_eff", ">=", "K_lim", "N/m", of=("a_k", "K_02")),
            limit("most damping", "effective damping", "xi_eff", "<=", "xi_lim", shown="%"),
            judge.limit("restoring")(
                "EN 1998-1 10.9.2", "restoring force", "Delta_F", ">=", "Delta_F_lim"
            ),
            limit("total eccentricity", eccentricity, "a_tot", "<=", "a_e_lim"),
            limit("eccentricity ratio", _ECCENTRIC, "e_r", "<=", "e_r_lim"),
            limit("radius ratio", _TORSION, "r_l", ">=", "r_l_lim"),
            self._accumulated(t, system, judge.limit("accumulated")),
        ]
        if self.property_variation is not None:
            t.given("v", self.property_variation, shown="%")
            title = "variation of properties"
            found.append(limit("variation", title, "v", "<=", "v_lim", shown="%"))
        return Checks(found)

    def _accumulated(self, t: Trace, system: IsolationSystem, limit: CheckBuilder) -> Check:
        # The residual displacement of earlier events adds to the displacement: Italy's rule, which
        # is public.
        t.given("a_0", self.accumulated, source="NTC 2018 7.10.6.2.2")
        t.each("d_acc", "a_0 * d_r", "m", shown="mm", note="left by earlier events")
        t.each("d_all", "d_Ed + d_acc", "m", source="NTC 2018 7.10.6.2.2", shown="mm")
        return limit.worst(
            "NTC 2018 7.10.6.2.2",
            "capacity with accumulated displacement",
            "d_all",
            "<=",
            "d_rim",
            subjects=system.labels,
            note="in Italy; the residual displacement at damage limitation counts if it is larger",
        )

    def shears(
        self, t: Trace, above: Superstructure, spectrum: Spectrum, extremes: Extremes
    ) -> None:
        """Enter V_s and the forces of the floors."""
        enter_storeys(t, above)
        t.given("q", self.behaviour, source="EN 1998-1 10.10")
        source = "EN 1998-1 (10.9)"
        t.each("f_x", "w_x / g * S_e", "N", source=source, note="forces of the floors, q = 1")
        t.each("F_x", "f_x / q", "N", note="design forces of the floors")
        t("V_s", "sum(F_x)", "N", note="design shear above the base level")
        t("F_1", "(W - sum(w_x)) / g * S_e / q", "N", source=source, note="at the base level")
        t.given("T_f", above.fixed_base_period, "s")
        t("M_o", "sum(f_x * h_x)", "N m", note="overturning, q = 1")
        t.given("o", self.orthogonal, source="EN 1998-1 4.3.3.5")
        t.given("v_z", vertical_level(spectrum), source="EN 1998-1 3.2.2.3", note="3 a_vg, in g")

    def structure_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return the check of storey drifts."""
        t.given("nu", self.reduction, source="EN 1998-1 4.4.3.2")
        known, clause = judge.resting_on("drift", "reduction", "behaviour"), "EN 1998-1 4.4.3.2"
        return drift_checks(t, above, known, clause, limit=self.drift, factor="nu * q")

    def vertical_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks by the combinations, and that of a vertical earthquake that leads."""
        found = super().vertical_checks(t, system, judge)
        if "N_minimum" not in t:
            return found
        t.given("a_z", COMPANION, note="of the vertical earthquake, in the combination")
        levers = [name for name in ("N_Ex", "N_Ey") if name in t]
        beside = " + ".join(f"o * {name}" for name in levers) or "0 * P"
        t.each("N_Ez", f"{beside} + (1 - a_z) * v_z * P", "N", source="EN 1998-1 4.3.3.5.2(4)")
        limit = judge.limit("vertical", "orthogonal")
        title, clause = "no uplift where the vertical earthquake leads", VALUES["vertical"].clause
        lead = limit.worst(clause, title, "N_Ez", "<=", "N_minimum", subjects=system.labels)
        return found + Checks([lead])

    def further_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return the limits of the simplified analysis."""
        if not self.simplified:
            return Checks()
        t("B_plan", "max(b, d)", "m")
        t.given("r_f", self.fault_distance or 0.0, "m")
        t.given("T_v", above.vertical_period or 0.0, "s")
        t("K_V", "W / g * (2 * pi / T_v)**2", "N/m", note="by T_v of the mass above")
        t("r_V", "K_V / K_eff")
        limit, ratio, of = (
            partial(procedure_limit, judge),
            "period ratio T_eff / T_fb",
            ("a_f", "T_f"),
        )
        upright = "vertical over effective stiffness"
        return Checks(
            [
                limit("largest side", "side of the plan", "B_plan", "<=", "B_lim", "m"),
                limit("longest period", "effective period", "T_eff", "<=", "T_lim", "s"),
                limit("fault", "distance to the fault", "r_f", ">=", "r_lim", "m"),
                limit("period ratio", ratio, "T_eff", ">=", "T_least", "s", of=of),
                limit("vertical period", "vertical period", "T_v", "<=", "T_v_lim", "s"),
                limit("vertical stiffness", upright, "r_V", ">=", "r_V_lim"),
            ]
        )


def _tests(d: DesignToTest) -> Iterable[PlannedTest]:
    clause, total, slow = "EN 15129 8.3.4", d.result.total_displacement, d.demands.slow_speed
    fast = d.speed_at(total)
    service = math.nan if d.demands.service is None else d.demands.service
    for name, share, load, cycles, speed, shows in (
        ("S, service", service / total, d.average, 20.0, 0.1 * slow, "moves with temperature"),
        ("P1, benchmark", 1.0, d.average, 3.0, slow, "reference for later tests"),
        ("D1, dynamic", 0.25, d.average, 3.0, fast, "friction and stiffness"),
        ("D2, dynamic", 0.50, d.average, 3.0, fast, "friction and stiffness"),
        ("D3, dynamic", 1.00, d.average, 3.0, fast, "friction and stiffness"),
        ("P2, integrity of the liner", 1.0, d.average, 3.0, slow, "as P1 after the dynamic tests"),
        ("D4, seismic, largest load", 1.0, d.largest, 3.0, fast, "friction and stability"),
        ("D5, seismic, least load", 1.0, d.least, 3.0, fast, "friction and stability"),
        ("B, both directions", 1.0, d.average, 3.0, fast, "clover-leaf path: friction in plan"),
    ):
        yield PlannedTest(name, share * total, load, cycles, speed, shows, clause)


CODE = DesignCode(analysis=EN1998, tests=_tests, values=VALUES, provisions=PROVISIONS, **RULES)
"""EN 1998-1 chapter 10, EN 1998-2 chapter 7, EN 15129."""
