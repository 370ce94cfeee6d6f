"""Equivalent lateral force analysis and checks of ASCE 7-22, chapter 17."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar

from frames._errors import MotionWarning
from frames.design._errors import CheckError
from frames.design.calculation.check import Checks
from frames.design.codes.common import (
    LinearAnalysis,
    capacity_check,
    drift_checks,
    eccentricities,
    enter_activation,
    enter_restoring,
    enter_storeys,
)
from frames.design.codes.history_rules import MCE_R
from frames.design.codes.outcome import Symbols
from frames.design.codes.prototype_programme import (
    DesignToTest,
    PlannedTest,
    increments,
    many_cycles,
    stable_test,
    static_tests,
    wind_test,
)
from frames.design.codes.registry import DesignCode
from frames.design.codes.secant import CheckBuilder, enter_system, procedure_limit, secant
from frames.design.codes.values_of_asce7 import NAME, PROVISIONS, RULES, VALUES
from frames.design.hazard.spectrum import Spectrum
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames.design.calculation.trace import Trace
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.isolation import Extremes, IsolationSystem
    from frames.design.codes.superstructure import Superstructure

MULTI_PERIOD = "asce7_multi_period"
"""Shape of spectra that are given by period."""

_BY_S_M1 = (
    "from S_M1 alone: at one site 3 % high at 2 s, 6 % low at 3 s, 10 % low at 4 s; use a "
    "multi-period spectrum to avoid this error"
)
_NEAR_FAULT = 0.6  # g, S_1 from which on C_s has a further least value
_STEPS = (0.25, 0.50, 0.67, 1.00)  # of D_M, in tests of increments


@dataclass(frozen=True, kw_only=True)
class ASCE7(LinearAnalysis):
    """Factors of ASCE 7-22, chapter 17; `CODE.values` gives the source of each.

    Parameters
    ----------
    accidental_eccentricity : float
        Share of the longest side of the plan (17.5.3.3).
    least_torsion : float
        Least D_TM over D_M (17.5.3.3).
    restoring : float
        Force that the second half of D_M must add, over W (17.2.4.4).
    exponent : float
        Divisor of damping in (17.5-7): 3.5 if sliding sets in abruptly, as on the concave surfaces
        of all bearings here; 2.5 if the transition is gradual.
    response_share, largest_reduction : float
        R_I = 3/8 R, between 1 and 2 (17.5.4.2).
    activation : float
        Factor on the nominal force that starts sliding (17.5.4.3).
    drift : float
        Limit of storey drift over height (17.5.6).
    longest_period, most_damping, period_ratio, stiffness_ratio, storeys, height : float
        Limits of the procedure (17.4.1): T_M [s], beta_M, T_M over T_fb, k(D_M) over k(0.2 D_M);
        storeys and height [m] count unless `no_tension`.
    history_share : float
        Least share of V_s in time histories (17.6.4): 1 until the edition's wording is read, on the
        safe side; ASCE 7-10 had 0.6, and 0.8 for irregular structures.
    irregular : bool
        True if the structure is irregular: the procedure does not apply then (17.4.1).
    no_tension : bool
        True if analysis shows that no bearing is pulled or lifts, so that the height is not
        limited.
    orthogonal : float
        Share of the other direction's overturning that acts with it.
    pressure_limit : float, optional
        Pressure resistance of the sliders [Pa] (17.2.4.6).

    Notes
    -----
    The centre of mass is the system's, else that of its loads, unless it has an eccentricity.
    V_s is at least the force that starts sliding, not reduced by weight or R_I, which is on the
    safe side.

    Examples
    --------
    In the how-to: "Design checks and equivalent-linear analysis" (docs/design_checks.md).
    """

    least_torsion: float = 1.15
    exponent: float = 3.5
    response_share: float = 3.0 / 8.0
    largest_reduction: float = 2.0
    activation: float = 1.5
    drift: float = 0.015
    longest_period: float = 5.0
    most_damping: float = 0.30
    period_ratio: float = 3.0
    stiffness_ratio: float = 1.0 / 3.0
    storeys: float = 4.0
    height: float = 19.8
    history_share: float = 1.0
    irregular: bool = False
    no_tension: bool = False
    name: ClassVar[str] = NAME
    symbols: ClassVar[Symbols] = Symbols("D_M", "D_TM", "k_M", "beta_M", "T_M", "B_M", "V_b", "V_s")
    each: ClassVar[str] = "D_T"
    level: ClassVar[str] = MCE_R
    values: ClassVar[Mapping[str, CodeValue]] = VALUES
    reduced_by: ClassVar[str] = "R_I"
    shear_clause: ClassVar[str] = "ASCE 7-22 (17.5-5)"
    overturning_clause: ClassVar[str] = "ASCE 7-22 17.2.4.7"
    vertical_clause: ClassVar[str] = "ASCE 7-22 17.2.4.6, 17.2.4.7"

    def require(self, spectrum: Spectrum, above: Superstructure | None) -> None:
        """Raise a CheckError if the spectrum has no S_MS or S_M1."""
        missing = [name for name in ("S_MS", "S_M1") if name not in spectrum.parameters]
        if missing:
            msg = f"the spectrum has no {' and '.join(missing)}: use a spectrum of Spectrum.asce7"
            raise CheckError(msg)

    def first_displacement(self, system: IsolationSystem, spectrum: Spectrum) -> float:
        """Return the displacement at which the search begins [m]."""
        return system.gravity * spectrum.parameters["S_M1"] / 10.0

    def step(self, system: IsolationSystem, spectrum: Spectrum, displacement: float) -> Trace:
        """Return D_M of an assumed displacement [m]."""
        t = enter_system(system)
        t.given("S_MS", spectrum.parameters["S_MS"], note="in g")
        t.given("S_M1", spectrum.parameters["S_M1"], note="in g")
        t.given("D_0", displacement, "m", note="assumed, and found again")
        secant(t, "D_0", self.symbols, "ASCE 7-22 17.2.8, (17.5-2)")
        factor = spectrum.damping_factor(t.value("beta_M"))
        t.looked_up("B_M", factor, ["beta_M"], source="ASCE 7-22 Table 17.5-1")
        source = "ASCE 7-22 (17.5-1)"
        if spectrum.shape != MULTI_PERIOD:
            formula = "g * S_M1 * T_M / (4 * pi**2 * B_M)"
            t("D_M", formula, "m", source=source, shown="mm", note=_BY_S_M1)
            return t
        level = float(spectrum.acceleration(t.value("T_M"))) / t.value("g")
        t.looked_up("S_aM", level, ["T_M"], source=source, note="in g, multi-period spectrum")
        t("D_M", "g * S_aM * T_M**2 / (4 * pi**2 * B_M)", "m", source=source, shown="mm")
        return t

    def totals(self, t: Trace, system: IsolationSystem, spectrum: Spectrum) -> None:
        """Enter D_TM, and D_T of each bearing."""
        if doubt := spectrum.beyond_points(t.value("T_M")):
            warnings.warn(doubt, MotionWarning, stacklevel=5)
        source = "ASCE 7-22 (17.5-3)"
        t.given("a_e", self.accidental_eccentricity, source="ASCE 7-22 17.5.3.3")
        t.given("a_T", self.least_torsion, source="ASCE 7-22 17.5.3.3")
        eccentricities(t, system, "a_e", source, by_direction=False)
        t.given("N", float(len(system.loads)), note="bearings")
        t("r_I", "sqrt((b**2 + d**2) / 12)", "m", source="ASCE 7-22 (17.5-4)")
        formula = "max(sqrt(sum((x - x_M)**2 + (y - y_M)**2) / N) / r_I, 1)"
        t("P_T", formula, source="ASCE 7-22 (17.5-4)")
        for along, across in (("x", "y"), ("y", "x")):
            t.each(
                f"D_T{along}",
                f"D_M * max(1 + abs({across} - {across}_R) / P_T**2 * 12 * e_{across} "
                "/ (b**2 + d**2), a_T)",
                "m",
                source=source,
                shown="mm",
                note=worded("of each bearing, motion along {along}", along=along),
            )
        t.each("D_T", "max(D_Tx, D_Ty)", "m", shown="mm")
        t("D_TM", "max(D_T)", "m", source=source, shown="mm")

    def device_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks of rims, restoring force and limits of the procedure."""
        enter_restoring(t, "D_M", self.restoring)
        t("k_02", "sum(P * (0.2 * D_M / L + mu)) / (0.2 * D_M)", "N/m", note="at 0.2 D_M")
        rims, back = judge.resting_on("rims"), judge.resting_on("restoring")
        limit = partial(procedure_limit, judge, also=("effective",))
        stiffness = "effective stiffness ratio, D_M to 0.2 D_M"
        return Checks(
            [
                capacity_check(t, system, rims, "ASCE 7-22 17.2.4.5, 17.4.1", "D_T"),
                back("ASCE 7-22 17.2.4.4", "restoring force", "Delta_F", ">=", "Delta_F_lim"),
                limit("longest period", "effective period", "T_M", "<=", "T_lim", "s"),
                limit("most damping", "effective damping", "beta_M", "<=", "beta_lim", shown="%"),
                limit(
                    "stiffness ratio", stiffness, "k_M", ">=", "k_lim", "N/m", of=("a_k", "k_02")
                ),
            ]
        )

    def shears(
        self, t: Trace, above: Superstructure, spectrum: Spectrum, extremes: Extremes
    ) -> None:
        """Enter V_s and its least values, the forces of the floors, and least ones of histories."""
        enter_storeys(t, above)
        t("W_s", "sum(w_x)", "N")
        t.given("n_beta", self.exponent, source="ASCE 7-22 (17.5-7)")
        source = "ASCE 7-22 (17.5-7)"
        t("V_st", "V_b * (W_s / W)**(1 - n_beta * beta_M)", "N", source=source)
        t.given("R", above.R)
        t.given("a_I", self.response_share)
        t.given("R_max", self.largest_reduction)
        t("R_I", "min(max(a_I * R, 1), R_max)", source="ASCE 7-22 17.5.4.2")
        t("V_red", "V_st / R_I", "N", source="ASCE 7-22 (17.5-6)")
        least = "ASCE 7-22 17.5.4.3"
        t("S_DS", "2 / 3 * S_MS", source="ASCE 7-22 (11.4-3)")
        t("S_D1", "2 / 3 * S_M1", source="ASCE 7-22 (11.4-4)")
        t.given("I_e", above.importance, note=_of_importance(above.importance))
        self._response_coefficient(t, spectrum)
        t("V_fixed", "C_s * W_s", "N", source=least)
        t.given("V_wind", above.wind_shear, "N", source=least)
        enter_activation(t, extremes, self.activation)
        t("V_act", "max(Q_up, a_Q * Q_nom)", "N", source=least)
        t("V_s", "max(V_red, V_fixed, V_wind, V_act)", "N", source="ASCE 7-22 17.5.4")
        t.given("T_fb", above.fixed_base_period, "s")
        vertical = "ASCE 7-22 17.5.5"
        t("F_1", "(V_b - V_st) / R_I", "N", source="ASCE 7-22 (17.5-8)", note="at the base level")
        t("k_v", "14 * beta_M * T_fb", source="ASCE 7-22 (17.5-11)", note="exponent; T_fb in s")
        t.each("C_vx", "w_x * h_x**k_v / sum(w_x * h_x**k_v)", source=vertical)
        t.each("F_x", "C_vx * V_s", "N", source="ASCE 7-22 (17.5-9)")
        t("M_o", "sum(C_vx * V_st * h_x)", "N m", note="overturning, unreduced")
        t.given("o", self.orthogonal, note="share of the other direction")
        self._dynamic_minima(t)

    def _response_coefficient(self, t: Trace, spectrum: Spectrum) -> None:
        # C_s of the structure on a fixed base, with its least values; S_1 if S_M1 is not above it.
        least, note = "0.044 * S_DS * I_e, 0.01", "fixed base, at T_M"
        s_1, said = spectrum.parameters.get("S_1"), "in g"
        if s_1 is None:
            known = "not given: S_M1, on the safe side on soil"
            s_1, said = t.value("S_M1"), joined("in g", known)
        t.given("S_1", s_1, note=said)
        if s_1 >= _NEAR_FAULT:
            least += ", 0.5 * S_1 * I_e / R"
            note = joined(note, "the last one if S_1 >= 0.6")
        formula = f"max(min(S_DS, S_D1 / T_M) * I_e / R, {least})"
        t("C_s", formula, source="ASCE 7-22 12.8.1.1", note=note)

    def _dynamic_minima(self, t: Trace) -> None:
        source = "ASCE 7-22 17.6.4"
        t.given("a_dyn", self.history_share, source=source)
        t(
            "D_prime_M",
            "D_M / sqrt(1 + (T_fb / T_M)**2)",
            "m",
            source="ASCE 7-22 (17.6-1)",
            shown="mm",
        )
        note = "least of a time history"
        formula = "0.8 * D_TM * D_prime_M / D_M"
        t("D_TM_dyn", formula, "m", source=source, note=note, shown="mm")
        t("V_b_dyn", "0.9 * V_b", "N", source=source, note=note)
        t("V_s_dyn", "a_dyn * V_s", "N", source=source, note=note)

    def structure_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return the limits of the procedure for the structure, and its drifts."""
        limit = partial(procedure_limit, judge)
        title, of = "period ratio T_M / T_fb", ("a_fb", "T_fb")
        also = ("effective",)
        found = [limit("period ratio", title, "T_M", ">=", "T_least", "s", of=of, also=also)]
        if self.irregular:
            t.given("n_irr", 1.0, note="irregular, as given")
            t.given("n_irr_lim", 0.0)
            regular, clause = judge.limit("regularity"), self.values["regularity"].clause
            found.append(regular(clause, "irregular structure", "n_irr", "<=", "n_irr_lim"))
        if not self.no_tension:
            t.given("n", float(len(above.storey_weights)))
            t("h_n", "max(h_x)", "m")
            found.append(limit("storeys", "storeys", "n", "<=", "n_lim"))
            found.append(limit("height", "height", "h_n", "<=", "h_lim", "m"))
        clause = "ASCE 7-22 17.5.6"
        known = judge.resting_on("drift", "V_st", "exponent", "R_I", "F_x")
        drift = drift_checks(t, above, known, clause, limit=self.drift, factor="R_I")
        return Checks([*found, *drift])


def _of_importance(factor: float) -> str:
    # 17.2.1 has I_e = 1.0 for isolated structures in any risk category.
    if math.isclose(factor, 1.0):
        return "of isolated structures by 17.2.1"
    return "as given; 17.2.1 has 1.0 for isolated structures"


def _tests(d: DesignToTest) -> Iterable[PlannedTest]:
    clause, t, moved = "ASCE 7-22 17.8.2.2", d.result.trace, d.result.displacement
    yield PlannedTest(
        "production, each bearing",
        0.67 * moved,
        d.average,
        3.0,
        d.demands.slow_speed,
        "each bearing is as the prototypes",
        "ASCE 7-22 17.8.5",
    )
    yield wind_test(d, f"{clause} (1)")
    steps = [(f"{share:g} D_M", share * moved, d.speed_at(share * moved)) for share in _STEPS]
    yield from increments(d, steps, f"{clause} (2)")
    yield stable_test(d, "D_M", moved, f"{clause} (3)")
    yield stable_test(d, "D_TM", d.result.total_displacement, f"{clause} (3)")
    count = max(10.0, 30.0 * t.value("S_M1") / (t.value("S_MS") * t.value("B_M")))
    at = "0.75 D_M", 0.75 * moved, d.speed_at(0.75 * moved)
    yield many_cycles(d, at, float(math.ceil(count - 1e-9)), f"{clause} (4)")
    yield from static_tests(d, "ASCE 7-22 17.8.2.5")


CODE = DesignCode(analysis=ASCE7, tests=_tests, values=VALUES, provisions=PROVISIONS, **RULES)
"""ASCE 7-22, chapter 17."""
