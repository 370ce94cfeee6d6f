"""Static analysis and checks of NCh2745 (Chile)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

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
from frames.design.codes.history_rules import DESIGN, MAXIMUM, NCH_MAXIMUM
from frames.design.codes.outcome import Iteration, Symbols
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
from frames.design.codes.secant import (
    CheckBuilder,
    enter_system,
    held_by,
    iterate_displacement,
    secant,
)
from frames.design.codes.values_of_nch2745 import NAME, PROVISIONS, RULES, VALUES
from frames.design.hazard.spectral_shapes import NCH433_SHEAR, NCH433_ZONE
from frames.design.hazard.spectrum import Spectrum
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames.design.calculation.trace import Trace
    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.isolation import Extremes, IsolationSystem
    from frames.design.codes.superstructure import Superstructure

_DESIGN = Symbols("D_D", "D_TD", "k_D", "beta_D", "T_D", "B_D", "V_b", "V_s")
GIVEN = "given"
"""Shape of spectra that are given point by point."""

_LONG = 4.0  # s, beyond all T_d


@dataclass(frozen=True, kw_only=True)
class NCh2745(LinearAnalysis):
    """Factors of NCh2745; `CODE.values` gives the source of each.

    Parameters
    ----------
    maximum : float
        M_M, maximum over design displacement at equal damping.
    accidental_eccentricity : float
        Share of the longest side of the plan.
    least_torsion : float
        Least total over central displacement.
    largest_reduction : float
        R_1 of the superstructure.
    restoring : float
        Force that the second half of the displacement must add, over W.
    activation : float
        Factor on the nominal force that starts sliding, as least V_s.
    drift : float
        Limit of storey drift over height, static analysis.
    orthogonal : float
        Share of the other direction's overturning that acts with it.
    pressure_limit : float, optional
        Pressure resistance of the sliders [Pa].

    Notes
    -----
    Combinations of vertical loads for `IsolationSystem` are of the kind 1.2 D + L and 0.8 D (6.2).
    The base shear uses the largest stiffness at the displacement, that of the upper bound.

    Examples
    --------
    In the how-to: "Design checks and equivalent-linear analysis" (docs/design_checks.md).
    """

    maximum: float = NCH_MAXIMUM
    least_torsion: float = 1.1
    largest_reduction: float = 2.0
    activation: float = 1.5
    drift: float = 0.0025
    name: ClassVar[str] = NAME
    symbols: ClassVar[Symbols] = Symbols("D_M", "D_TM", "k_M", "beta_M", "T_M", "B_M", "V_b", "V_s")
    each: ClassVar[str] = "D_TM_i"
    sliding: ClassVar[str] = "D_D"
    level: ClassVar[str] = DESIGN
    loads_level: ClassVar[str] = MAXIMUM
    values: ClassVar[Mapping[str, CodeValue]] = VALUES
    reduced_by: ClassVar[str] = "R_1"
    overturning_clause: ClassVar[str] = "NCh2745 6.2"
    vertical_clause: ClassVar[str] = "NCh2745 6.2"

    def settled(
        self, system: IsolationSystem, spectrum: Spectrum
    ) -> tuple[Trace, tuple[Iteration, ...]]:
        """Return the calculation at the maximum level, after that at the design level."""

        def maximum(displacement: float) -> Trace:
            t = design.copy()
            t.given("D_0M", displacement, "m", note="assumed, and found again")
            secant(t, "D_0M", self.symbols, "NCh2745 7", "_M")
            factor = spectrum.damping_factor(t.value("beta_M"))
            t.looked_up("B_M", factor, ["beta_M"], source="NCh2745 7.3")
            t.given("M_M", self.maximum)
            if spectrum.shape == GIVEN:
                _enter_given(t, spectrum, "T_M", "S_aM", "C_D_M")
                t("C_M", "M_M * C_D_M", "m", shown="mm")
            else:
                t("C_M", "M_M * C_D", "m", shown="mm")
            t("D_M", "C_M / B_M", "m", source="NCh2745 7.3", shown="mm")
            return t

        held = held_by(system, spectrum)
        design, _ = iterate_displacement(
            lambda d: self.step(system, spectrum, d), 0.1, _DESIGN, held
        )
        return iterate_displacement(maximum, design.value("D_D"), self.symbols)

    def step(self, system: IsolationSystem, spectrum: Spectrum, displacement: float) -> Trace:
        """Return D_D of an assumed displacement [m]."""
        t = enter_system(system)
        t.given("D_0", displacement, "m", note="assumed, and found again")
        secant(t, "D_0", _DESIGN, "NCh2745 7")
        factor = spectrum.damping_factor(t.value("beta_D"))
        t.looked_up("B_D", factor, ["beta_D"], source="NCh2745 7.3")
        if spectrum.shape == GIVEN:
            _enter_given(t, spectrum, "T_D", "S_aD", "C_D")
            t("D_D", "C_D / B_D", "m", source="NCh2745 7.3", shown="mm")
            return t
        plateau = spectrum.acceleration(_LONG) * (0.5 * _LONG / math.pi) ** 2
        note = "200 Z, 300 Z, 330 Z mm for soils I, II, III: the spectrum's displacement, B = 1"
        t.given("C_D", plateau, "m", shown="mm", source="NCh2745 7.3", note=note)
        t("D_D", "C_D / B_D", "m", source="NCh2745 7.3", shown="mm")
        return t

    def totals(self, t: Trace, system: IsolationSystem, spectrum: Spectrum) -> None:
        """Enter D_TD, D_TM, those of each bearing, and the cycles of tests."""
        t.given("a_e", self.accidental_eccentricity, source="NCh2745 7.3")
        t.given("a_T", self.least_torsion, source="NCh2745 7.3")
        eccentricities(t, system, "a_e", "NCh2745 7.3", by_direction=False)
        t.each("tau_x", "1 + abs(y - y_R) * 12 * e_y / (b**2 + d**2)", note="motion along x")
        t.each("tau_y", "1 + abs(x - x_R) * 12 * e_x / (b**2 + d**2)", note="motion along y")
        for level in ("D", "M"):
            formula = f"D_{level} * max(tau_x, tau_y, a_T)"
            t.each(f"D_T{level}_i", formula, "m", source="NCh2745 7.3", shown="mm")
            t(f"D_T{level}", f"max(D_T{level}_i)", "m", shown="mm")
        _enter_cycles(t, spectrum)

    def base_shear(self, t: Trace, spectrum: Spectrum, extremes: Extremes) -> None:
        """Enter V_b, by the largest stiffness at D_D."""
        friction = [p.effective_friction for p in extremes.upper.pendulums]
        t.given_each("mu_up", friction, note="effective friction, upper properties")
        t("k_Dmax", "sum(P * (D_D / L + mu_up)) / D_D", "N/m", source="NCh2745 7.4")
        t("V_b", "k_Dmax * D_D", "N", source="NCh2745 7.4")
        t("k_Mmax", "sum(P * (D_M / L + mu_up)) / D_M", "N/m", note="largest at D_M")

    def device_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks of rims and restoring force."""
        enter_restoring(t, "D_D", self.restoring)
        note = "else bearings must allow 3 times the total design displacement, 3 D_TD"
        rims, back = judge.resting_on("capacity"), judge.resting_on("restoring")
        return Checks(
            [
                capacity_check(t, system, rims.at(MAXIMUM), "NCh2745 7.3", "D_TM_i"),
                back("NCh2745 10.2", "restoring force", "Delta_F", ">=", "Delta_F_lim", note=note),
            ]
        )

    def structure_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return the check of storey drifts."""
        known = judge.resting_on("drift", "R_1", "F_x")
        return drift_checks(t, above, known, "NCh2745 7.6", limit=self.drift, factor="R_1")

    def shears(
        self, t: Trace, above: Superstructure, spectrum: Spectrum, extremes: Extremes
    ) -> None:
        """Enter V_s and its least values, and the forces of the floors."""
        enter_storeys(t, above)
        t.given("R", above.R)
        t.given("R_max", self.largest_reduction)
        t("R_1", "max(min(R, R_max), 1)", source="NCh2745 7.4")
        t.given("V_wind", above.wind_shear, "N", source="NCh2745 7.4")
        enter_activation(t, extremes, self.activation)
        _enter_fixed_base(t, spectrum)
        t("V_s", "max(V_b / R_1, V_fixed, V_wind, Q_up, a_Q * Q_nom)", "N", source="NCh2745 7.4")
        t.each("F_x", "V_s * w_x * h_x / sum(w_x * h_x)", "N", source="NCh2745 7.5")
        t("F_1", "V_b / R_1 * (1 - sum(w_x) / W)", "N", note="at the base level")
        t("V_M", "k_Mmax * D_M", "N", note="at the maximum level, for axial loads at D_TM")
        t(
            "M_o",
            "sum(w_x * h_x**2) / sum(w_x * h_x) * V_M",
            "N m",
            source="NCh2745 6.2",
            note="overturning, unreduced, at the maximum level",
        )
        t.given("o", self.orthogonal, note="share of the other direction")


def _enter_given(t: Trace, spectrum: Spectrum, period: str, level: str, symbol: str) -> None:
    # The displacement of a spectrum that is given point by point, at an effective period, B = 1.
    at = float(spectrum.acceleration(t.value(period)))
    t.looked_up(level, at, [period], "m/s2", note="of the spectrum as given")
    t(
        symbol,
        f"{level} * {period}**2 / (4 * pi**2)",
        "m",
        shown="mm",
        note="its displacement, B = 1",
    )


def _enter_fixed_base(t: Trace, spectrum: Spectrum) -> None:
    # Base shear of the same structure on a fixed base, of the period T_D: NCh433, importance 1.
    site = dict(spectrum.site)
    if not site:
        why = "unknown: the spectrum is not defined by a soil and a zone"
        t.given("V_fixed", 0.0, "N", source="NCh433 6.2.3", note=why)
        return
    soil, zone = str(site["soil"]), int(site["zone"])
    t.given("A_0", NCH433_ZONE[zone], note=worded("zone {zone}, in g", zone=zone))
    for symbol, value in zip(("S_433", "T_433", "n_433"), NCH433_SHEAR[soil], strict=True):
        of_soil = worded("soil {soil}", soil=soil)
        t.given(symbol, value, note=joined(of_soil, "T in s" if symbol == "T_433" else ""))
    formula = "max(2.75 * S_433 * A_0 / R * (T_433 / T_D)**n_433, S_433 * A_0 / 6)"
    t("C_433", formula, source="NCh433 6.2.3", note="fixed base, at T_D, importance 1")
    t("V_fixed", "C_433 * sum(w_x)", "N", source="NCh433 6.2.3")


def _enter_cycles(t: Trace, spectrum: Spectrum) -> None:
    # Cycles of the test of many: C_VD and C_AD of UBC-97 are S_a at 1 s, and at most over 2.5.
    source = "NCh2745 14"
    periods = np.geomspace(max(spectrum.reach[0], 0.01), 1.0, 200)
    t.given("C_AD", float(np.max(spectrum.acceleration(periods))) / (2.5 * t.value("g")))
    t.given("C_VD", float(spectrum.acceleration(1.0)) / t.value("g"), note="S_a at 1 s, in g")
    t("n_cyc", "max(10, 15 * C_VD / (C_AD * B_D))", source=source, note="as UBC-97 1665")


def _tests(d: DesignToTest) -> Iterable[PlannedTest]:
    # Each displacement with the period of its level: D_D with T_D, D_M with T_M.
    clause, t = "NCh2745 14", d.result.trace

    def at_design(name: str, displacement: float) -> tuple[str, float, float]:
        return name, displacement, d.speed_at(displacement, t.value("T_D"))

    design, most = t.value("D_D"), t.value("D_M")
    yield wind_test(d, clause)
    steps = (
        at_design("0.25 D_D", 0.25 * design),
        at_design("0.5 D_D", 0.5 * design),
        at_design("D_D", design),
        ("D_M", most, d.speed_at(most)),
    )
    yield from increments(d, steps, clause)
    yield stable_test(d, "D_TM", d.result.total_displacement, clause)
    count = math.ceil(t.value("n_cyc") - 1e-9)
    yield many_cycles(d, at_design("D_TD", t.value("D_TD")), float(count), clause)
    yield from static_tests(d, clause)


CODE = DesignCode(analysis=NCh2745, tests=_tests, values=VALUES, provisions=PROVISIONS, **RULES)
"""NCh2745, isolated buildings in Chile."""
