"""Values of ASCE 7-22, chapter 17, with the source of each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.design.codes.bounds import factors_of_asce7
from frames.design.codes.code_values import (
    BNBC,
    E031,
    E031_FACTORS,
    E031_ORDINATE,
    UFC_BNBC,
    USGS,
    CodeValue,
    Provision,
    common,
    yours,
)
from frames.design.codes.history_rules import LOADS_OF_ASCE, MCE_R, ActionLevel, HistoryRules
from frames.design.codes.prototype_programme import AcceptanceRule
from frames.design.codes.registry import NO_LIMITS, ExampleProject, RimRule, SpectrumKey
from frames.design.hazard.code_rules import LINEAR, DampingRule, ScalingRule
from frames.design.hazard.spectrum import Spectrum
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Sequence

NAME = "ASCE 7-22"

VALUES = {
    "damping factor": CodeValue("ASCE 7-22 table 17.5-1", "B_M by the damping", E031),
    "effective": CodeValue("ASCE 7-22 17.2.8, (17.5-2)", "k_M, beta_M and T_M at D_M", E031),
    "D_M": CodeValue("ASCE 7-22 (17.5-1)", "D_M by S_M1"),
    "D_M, points": CodeValue("ASCE 7-22 (17.5-1)", "D_M by the ordinate at T_M", E031_ORDINATE),
    "eccentricity": CodeValue(
        "ASCE 7-22 17.5.3.3", "5 % of the longest side", E031, "accidental_eccentricity"
    ),
    "torsion": CodeValue("ASCE 7-22 17.5.3.3", "D_TM at least 1.15 D_M", E031, "least_torsion"),
    "D_TM": CodeValue("ASCE 7-22 (17.5-3), (17.5-4)", "D_TM with P_T, at least 1", E031),
    "rims": CodeValue("ASCE 7-22 17.2.4.5", "rims are not met below 0.6 D_TM"),
    "restoring": CodeValue(
        "ASCE 7-22 17.2.4.4", "0.025 W of the second half of D_M", field="restoring"
    ),
    "V_b": CodeValue("ASCE 7-22 (17.5-5)", "V_b = k_M D_M", E031),
    "V_st": CodeValue("ASCE 7-22 (17.5-7)", "form of V_st", E031),
    "exponent": CodeValue("ASCE 7-22 (17.5-7)", "3.5 of V_st, abrupt sliding", field="exponent"),
    "R_I": CodeValue("ASCE 7-22 17.5.4.2", "R_I = 3/8 R, from 1 to 2", E031, "response_share"),
    "most R_I": CodeValue("ASCE 7-22 17.5.4.2", "R_I at most 2", E031, "largest_reduction"),
    "least V_s": CodeValue(
        "ASCE 7-22 17.5.4.3", "fixed base at T_M; 1.5 nominal or the upper activation", E031
    ),
    "activation": CodeValue("ASCE 7-22 17.5.4.3", "1.5 times nominal", E031, "activation"),
    "C_s": CodeValue("ASCE 7-22 12.8.1.1", "C_s at least 0.5 S_1 I_e / R from S_1 = 0.6 on"),
    "importance": CodeValue("ASCE 7-22 17.2.1", "I_e = 1 of isolated structures"),
    "wind": CodeValue("ASCE 7-22 17.5.4.3", "V_s at least the wind's shear"),
    "F_1": CodeValue("ASCE 7-22 (17.5-8)", "force at the base level", E031),
    "F_x": CodeValue("ASCE 7-22 (17.5-11)", "exponent 14 beta_M T_fb over the height", E031),
    "longest period": CodeValue("ASCE 7-22 17.4.1", "T_M at most 5 s", E031, "longest_period"),
    "most damping": CodeValue("ASCE 7-22 17.4.1", "beta_M at most 30 %", E031, "most_damping"),
    "stiffness ratio": CodeValue(
        "ASCE 7-22 17.4.1", "k_M at least a third of that at 0.2 D_M", E031, "stiffness_ratio"
    ),
    "period ratio": CodeValue("ASCE 7-22 17.4.1", "T_M at least 3 T_fb", E031, "period_ratio"),
    "storeys": CodeValue("ASCE 7-22 17.4.1", "at most 4 storeys", E031, "storeys"),
    "height": CodeValue("ASCE 7-22 17.4.1", "at most 19.8 m", E031, "height"),
    "regularity": CodeValue("ASCE 7-22 17.4.1", "the structure is regular"),
    "drift": CodeValue("ASCE 7-22 17.5.6", "storey drift at most 0.015", UFC_BNBC, "drift"),
    "vertical loads": CodeValue("ASCE 7-22 17.2.4.6, 17.2.4.7", "no uplift, pressure of sliders"),
    "overturning": CodeValue("ASCE 7-22 17.2.4.7", "of the whole structure, safety 1.0"),
    "sliding under wind": CodeValue("ASCE 7-22 17.2.4.2", "wind does not slide the bearings"),
    "separation": CodeValue("ASCE 7-22 17.2.5.2", "room for D_TM around the structure"),
    "orthogonal": CodeValue(
        "ASCE 7-22 17.2.4.6, 17.2.4.7", "30 % of the other direction", field="orthogonal"
    ),
    "factors": CodeValue(
        "ASCE 7-22 (17.2-1), (17.2-2)", "75 % of ageing and environment", E031_FACTORS
    ),
    "ends of factors": CodeValue("ASCE 7-22 17.2.8.4", "1.8 and 0.60 without full-scale tests"),
    "loads": CodeValue(LOADS_OF_ASCE.clause, "seismic mass and combinations"),
    "number of motions": CodeValue("ASCE 7-22 17.3.3", "7 motions at least"),
    "mean": CodeValue("ASCE 7-22 17.3.3", "the mean counts from 7 motions on", UFC_BNBC),
    "scaling": CodeValue("ASCE 7-22 17.3.3", "RotD100, 0.75 T to 1.25 T"),
    "S_MS, S_M1": CodeValue("ASCE 7-22 21.4", "S_MS and S_M1 of spectra by points", USGS),
    "history drift": CodeValue("ASCE 7-22 17.6.4.4", "storey drift at most 0.020", UFC_BNBC),
    "second order": CodeValue("ASCE 7-22 17.6.4.4", "P-Delta above a drift of 0.010 / R_I"),
    "drift of lines": CodeValue("ASCE 7-22 12.3.2", "largest over mean drift at most 1.4"),
    "stability": CodeValue(
        "ASCE 7-22 12.8.7", "P-Delta coefficient at most 0.10, in the analysis 0.25"
    ),
    "history minima": CodeValue(
        "ASCE 7-22 17.6.4", "0.8 D_TM, 0.9 V_b, and V_s whole", field="history_share"
    ),
    "uplift": CodeValue("ASCE 7-22 17.2.4.7", "uplift that deformations allow"),
    "moved masses": CodeValue("ASCE 7-22 17.6.2.1", "5 % of the sides in histories"),
    "tests": CodeValue("ASCE 7-22 17.8.2.2", "which tests, in which order", BNBC),
    "cycles": CodeValue("ASCE 7-22 17.8.2.2, 17.8.2.5, 17.8.5", "amplitudes and cycles of tests"),
    "accepted slope": CodeValue("ASCE 7-22 17.8.4", "the force rises with the displacement"),
    "accepted k_d and EDC": CodeValue(
        "ASCE 7-22 17.8.4",
        "post-elastic stiffness and EDC of each cycle within lambda_test of the nominal ones",
    ),
    "specimens": CodeValue(
        "ASCE 7-22 17.8.4",
        "post-elastic stiffness of two specimens within 15 % of their mean, cycle by cycle",
    ),
    "many cycles, stiffness": CodeValue(
        "ASCE 7-22 17.8.4", "effective stiffness changes by 20 % at most over the cycles"
    ),
    "many cycles, damping": CodeValue(
        "ASCE 7-22 17.8.4", "effective damping falls by 20 % at most over the cycles"
    ),
    "stable": CodeValue("ASCE 7-22 17.8.4", "the bearing stays stable"),
    "number of specimens": CodeValue(
        "ASCE 7-22 17.8.2", "two full-size specimens of each type and size"
    ),
    "production": CodeValue(
        "ASCE 7-22 17.8.5", "post-elastic stiffness and EDC within lambda_spec of the nominal ones"
    ),
}
"""Values by name; a value without comparison with a text is from memory."""

PROVISIONS = (
    common(f"{NAME} 17.2.4.5, 17.4.1", "rims are not met at D_TM"),
    common(f"{NAME} 17.2.4.5", "share of D_TM from which rims may be met"),
    common(f"{NAME} 17.2.4.4", "restoring force"),
    Provision(
        f"{NAME} 17.4.1",
        "limits of the procedure: T_M, beta_M, stiffness",
        ("effective period", "effective damping", "effective stiffness ratio"),
    ),
    Provision(
        f"{NAME} 17.4.1",
        "limits of the procedure: T_M over T_fb, storeys, height",
        ("period ratio T_M / T_fb", "storeys", "height"),
        ("superstructure",),
    ),
    Provision(
        f"{NAME} 17.4.1, 12.3.2",
        "extreme torsional irregularity",
        ("largest over mean drift of a storey",),
        ("storeys",),
    ),
    yours(
        f"{NAME} 17.2.2.1, 12.3.2",
        "weak and soft storeys",
        "the strength and stiffness of each storey over that above",
    ),
    common(f"{NAME} 17.5.6", "storey drift, equivalent-linear"),
    common(f"{NAME} 17.6.4.4", "storey drift of time histories"),
    Provision(
        f"{NAME} 12.8.7, 17.6.4.4",
        "P-Delta: coefficient of the storeys, and whether the analysis has it",
        ("P-Delta coefficient of a storey",),
        ("storeys",),
    ),
    common(f"{NAME} 17.2.4.7", "overturning of the whole structure"),
    common(f"{NAME} 17.2.4.6, 17.2.4.7", "uplift by the combinations"),
    common(f"{NAME} 12.4.2.2, 17.2.7.1", "vertical earthquake in the combinations"),
    Provision(
        f"{NAME} 17.2.4.7", "uplift in time histories", ("maximum uplift over the rim height",)
    ),
    common(f"{NAME} 17.2.4.2", "sliding under wind"),
    common(f"{NAME} 17.2.5.2", "separation to walls and neighbours"),
    common(f"{NAME} 17.3.3", "number and scaling of motions"),
    Provision(
        f"{NAME} 17.3.3",
        "near-fault pairs in the axes of the fault",
        ("near-fault pairs that are not turned to the fault",),
        ("near fault",),
    ),
    common(f"{NAME} 17.3.3", "runs that failed"),
    common(f"{NAME} 17.6.2.1", "accidental eccentricity of time histories"),
    common(f"{NAME} 17.6.4", "displacement of time histories"),
    Provision(
        f"{NAME} 17.6.4",
        "least shears of time histories",
        ("base shear of time histories", "storey shear of time histories"),
        ("superstructure", "storeys", "bounds"),
    ),
    common(f"{NAME} 12.4.3, 17.5.4", "overstrength of members and connections"),
    Provision(
        f"{NAME} 17.2.5.1",
        "diaphragm that brings forces to the bearings",
        why="since forces in slabs are not formed",
    ),
    yours(
        f"{NAME} 11.4, 17.3.1, (17.5-1)",
        "spectrum at the long periods of isolation",
        "D_M by S_M1 alone was up to 10 % low at one site: give [spectrum] points",
    ),
    yours(f"{NAME} 17.2.4.1, 17.2.4.3", "environment and fire", "state it in the specification"),
    yours(
        f"{NAME} 17.2.4.8, 17.2.4.9",
        "inspection, replacement and quality control",
        "state it in the specification",
    ),
    yours(
        f"{NAME} 17.2.3, 12.3.4", "redundancy", "forces have the factor 1: state it, and raise them"
    ),
    yours(
        f"{NAME} 17.2.5.4",
        "kind of the structural system and its detailing",
        "ordinary braced frames ask for R_I = 1 and 1.2 D_TM",
    ),
    common(f"{NAME} 17.2.6", "parts that cross the isolation interface"),
    common(f"{NAME} 17.2.6.1", "parts that stand above the isolation interface"),
    common(f"{NAME} 17.2.8", "bounds of properties over the life of the bearings"),
    common(f"{NAME} 17.7", "review of the design"),
    common(f"{NAME} 17.8", "tests of the bearings"),
)
"""Provisions of chapter 17, checked or not; `OF_BEARINGS` has those of bearings."""


def _by_points(periods: Sequence[float], accelerations: Sequence[float], **keys: Any) -> Spectrum:
    # A multi-period or site-specific spectrum, points in m/s2.
    in_g = [level / STANDARD_GRAVITY for level in accelerations]
    return Spectrum.asce7_multi_period(periods, in_g, **keys)


RULES: dict[str, Any] = {
    "name": NAME,
    "aliases": ("ASCE 7", "ASCE/SEI 7-22"),
    "title": "Minimum Design Loads and Associated Criteria for Buildings and Other Structures",
    "edition": "ASCE/SEI 7-22, chapter 17; compared with public texts that follow 7-05 and 7-16",
    "damping": DampingRule(
        "ASCE/SEI 7-22, table 17.5-1 (7-16 alike)",
        LINEAR,
        table=(
            (0.02, 0.8),
            (0.05, 1.0),
            (0.10, 1.2),
            (0.20, 1.5),
            (0.30, 1.7),
            (0.40, 1.9),
            (0.50, 2.0),
        ),
        standing=VALUES["damping factor"].standing,
    ),
    "scaling": (
        ScalingRule(
            "ASCE 7-22",
            "RotD100",
            1.0,
            0.0,
            7,
            "ASCE 7-22 17.3.3",
            (0.75, 1.25),
            fault_axes=True,
            standing=VALUES["scaling"].standing,
        ),
        ScalingRule(
            "ASCE 7-16", "SRSS", 1.0, 0.0, 7, "ASCE 7-16 17.3.3", (0.75, 1.25), fault_axes=True
        ),
    ),
    "histories": HistoryRules(
        code=NAME,
        least=7,
        mean_from=7,
        drift=0.020,
        second_order=0.010,
        torsion=1.4,
        stability=(0.10, 0.25),
        uplift_allowed=True,
        has_minima=True,
        accidental_eccentricity=0.05,
        levels=(ActionLevel(MCE_R),),
        statistic_clause="17.3.3",
        displacement_clause="17.6.4",
        drift_clause="17.6.4.4",
        torsion_clause="17.4.1, 12.3.2",
        stability_clause="12.8.7",
        force_clause="17.6.4",
        uplift_clause="17.2.4.7",
        eccentricity_clause="17.6.2.1",
    ),
    "spectrum": Spectrum.asce7,
    "spectrum_keys": {
        "s_ms": SpectrumKey(),
        "s_m1": SpectrumKey(),
        "t_l": SpectrumKey(unit="s", default=8.0),
        "s_1": SpectrumKey(optional=True),
    },
    "factors": factors_of_asce7,
    "spectrum_by_points": _by_points,
    "points_keys": {
        "s_ms": SpectrumKey(),
        "s_m1": SpectrumKey(),
        "s_1": SpectrumKey(),
        "t_l": SpectrumKey(unit="s"),
        "v_s30": SpectrumKey(unit="m/s"),
    },
    "rims": RimRule(
        "ASCE 7-22 17.2.4.5",
        "D_TM",
        0.60,
        "needs time histories with the rims",
        VALUES["rims"].standing,
    ),
    "accepted": tuple(
        AcceptanceRule(tests, VALUES[name])
        for tests, name in (
            (("increments", "maximum displacement", "many cycles"), "accepted slope"),
            (("increments", "maximum displacement"), "accepted k_d and EDC"),
            (("increments", "maximum displacement"), "specimens"),
            (("many cycles",), "many cycles, stiffness"),
            (("many cycles",), "many cycles, damping"),
            (("static",), "stable"),
            (("production",), "production"),
        )
    ),
    "acceptance": f"{NO_LIMITS}, not of ASCE 7-22 17.8.4",
    "example": ExampleProject({"s_ms": 1.2, "s_m1": 0.7}, {}),
}
"""All else of its `DesignCode`, but formulas and tests."""
