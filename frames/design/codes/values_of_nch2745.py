"""Values of NCh2745, with the source of each."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from frames.design.codes.code_values import NO_CODE, CodeValue, Provision, common, yours
from frames.design.codes.history_rules import (
    DESIGN,
    MAXIMUM,
    NCH_MAXIMUM,
    ActionLevel,
    Combinations,
    HistoryRules,
    LoadRule,
)
from frames.design.codes.prototype_programme import AcceptanceRule
from frames.design.codes.registry import (
    NO_LIMITS,
    ExampleProject,
    RimRule,
    SpectrumKey,
    example_bearing,
)
from frames.design.hazard.code_rules import LINEAR, DampingRule, ScalingRule
from frames.design.hazard.spectral_shapes import NCH2745_TABLES
from frames.design.hazard.spectrum import Spectrum
from lir_element.units import STANDARD_GRAVITY

NAME = "NCh2745"

VALUES = {
    "spectrum": CodeValue("NCh2745 Of.2003", "elastic spectra by soil and zone", NCH2745_TABLES),
    "damping factor": CodeValue(
        "NCh2745 Of.2003, table of B_D and B_M", "B by the damping", NCH2745_TABLES
    ),
    "displacements": CodeValue("NCh2745 7.3", "D_D and D_M by C_D, C_M and B"),
    "maximum": CodeValue("NCh2745 7.3", "M_M = 1.2", field="maximum"),
    "eccentricity": CodeValue(
        "NCh2745 7.3", "5 % of the longest side", field="accidental_eccentricity"
    ),
    "torsion": CodeValue(
        "NCh2745 7.3", "total at least 1.1 of the centre's", field="least_torsion"
    ),
    "capacity": CodeValue("NCh2745 7.3", "D_TM below the rims"),
    "restoring": CodeValue(
        "NCh2745 10.2", "0.025 W of the second half of D_D, else 3 D_TD", field="restoring"
    ),
    "V_b": CodeValue("NCh2745 7.4", "V_b by the largest stiffness at D_D"),
    "R_1": CodeValue("NCh2745 7.4", "R_1 at most 2", field="largest_reduction"),
    "least V_s": CodeValue("NCh2745 7.4", "wind; 1.5 nominal or the upper activation"),
    "fixed base": CodeValue("NCh433 6.2.3", "V_s at least that of NCh433 at T_D"),
    "activation": CodeValue("NCh2745 7.4", "1.5 times nominal", field="activation"),
    "F_x": CodeValue("NCh2745 7.5", "forces over the height by w h"),
    "drift": CodeValue("NCh2745 7.6", "storey drift at most 0.0025", field="drift"),
    "vertical loads": CodeValue("NCh2745 6.2", "no uplift, pressure of sliders"),
    "overturning": CodeValue("NCh2745 6.2", "of the whole structure, safety 1.0"),
    "orthogonal": CodeValue("NCh2745 6.2", "30 % of the other direction", field="orthogonal"),
    "loads": CodeValue("NCh433 5.5.1 and NCh2745 8.4", "seismic mass and combinations"),
    "vertical": CodeValue("NCh2745 6.2", "E_v = 0.5 C_A D at the maximum level, as UBC-97 1630.1"),
    "number of motions": CodeValue("NCh2745 8.4", "3 motions at least"),
    "mean": CodeValue("NCh2745 8.4", "the mean counts from 7 motions on"),
    "scaling": CodeValue("NCh2745 8.4", "SRSS, 1.17 of the target, 0.5 T_D to 1.25 T_M"),
    "history drift": CodeValue("NCh2745 8.8", "storey drift at most 0.003"),
    "moved masses": CodeValue("NCh2745 8.3", "5 % of the sides in histories"),
    "rims": CodeValue("NCh2745 7.3", "rims are not met below D_TM"),
    "tests": CodeValue("NCh2745 14", "which tests, amplitudes and cycles"),
    "accepted slope": CodeValue("NCh2745 14.4", "the force rises with the displacement"),
    "accepted k_eff": CodeValue(
        "NCh2745 14.4", "effective stiffness of each cycle within 10 % of the test's mean"
    ),
    "specimens": CodeValue(
        "NCh2745 14.4", "mean effective stiffness of two specimens within 10 % of one another"
    ),
    "many cycles, stiffness": CodeValue(
        "NCh2745 14.4", "effective stiffness changes by 20 % at most over the cycles"
    ),
    "many cycles, damping": CodeValue(
        "NCh2745 14.4", "effective damping falls by 20 % at most over the cycles"
    ),
    "stable": CodeValue("NCh2745 14.4", "the bearing stays stable"),
    "number of specimens": CodeValue("NCh2745 14", "two full-size specimens of each type and size"),
}
"""Values by name; a value without comparison with a text is from memory."""

PROVISIONS = (
    common("NCh2745 7.3", "rims are not met at D_TM"),
    common("NCh2745 7.3", "share of D_TM from which rims may be met"),
    common("NCh2745 10.2", "restoring force"),
    Provision(
        "NCh2745 10.2",
        "capacity of 3 D_TD where the restoring force is less",
        why="since the note of the restoring force alone names it",
    ),
    Provision(
        "NCh2745 7.1",
        "limits of the static procedure",
        why="since none were read; time histories take its place",
    ),
    Provision(
        "NCh2745 8.2",
        "least displacements and shears of time histories",
        why="since none were read; those of ASCE 7-22 and UBC-97 are a measure",
    ),
    Provision(
        "NCh433 5.5, 5.9.3",
        "regularity in plan and height, torsion",
        why="since 0.001 h between edge and centre (5.9.3) is of buildings on a fixed base",
    ),
    common("NCh2745 7.6", "storey drift, equivalent-linear"),
    common("NCh2745 8.8", "storey drift of time histories"),
    common("NCh2745 6.2", "overturning of the whole structure"),
    common("NCh2745 6.2", "uplift by the combinations"),
    common("NCh2745 8", "uplift in time histories"),
    common("NCh2745 6.2", "vertical earthquake in the combinations"),
    common(NO_CODE, "sliding under wind"),
    common(NO_CODE, "separation to walls and neighbours"),
    common("NCh2745 8.4", "number and scaling of motions"),
    common("NCh2745 8.4", "runs that failed"),
    common("NCh2745 8.3", "accidental eccentricity of time histories"),
    common("NCh2745 8", "displacement of time histories"),
    common("NCh2745 7.4", "overstrength of members and connections"),
    yours(
        "NCh433 6.2.3",
        "edition that is in force",
        "of NCh433 with DS61, and of NCh2745: confirm both",
    ),
    common("NCh2745 13", "review of the design"),
    common("NCh2745 14", "tests of the bearings"),
    common("NCh2745 9", "parts that cross the isolation interface"),
    common("NCh2745 9", "parts that stand above the isolation interface"),
    common("NCh2745 8.5, 14", "bounds of properties over the life of the bearings"),
    yours(
        "NCh2745 6",
        "environment, fire, inspection and replacement",
        "state it in the specification",
    ),
)
"""Provisions of NCh2745, checked or not; `OF_BEARINGS` has those of bearings."""


def _vertical(spectrum: Spectrum) -> float:
    # 2.5 C_A at the maximum level, as C_AD of the tests [g].
    periods = np.geomspace(max(spectrum.reach[0], 0.01), 1.0, 200)
    return NCH_MAXIMUM * float(np.max(spectrum.acceleration(periods))) / STANDARD_GRAVITY


def _combinations(vertical: float | None) -> Combinations:
    part = 0.2 * (vertical or 0.0)
    return {
        "average": {"D": 1.0, "L": 0.5, "S": 0.0},
        "maximum": {"D": 1.2 + part, "L": 1.0, "S": 0.2},
        "minimum": {"D": 0.8 - part, "L": 0.0, "S": 0.0},
    }


_LOADS = LoadRule(
    VALUES["loads"].clause,
    {"D": 1.0, "L": 0.25, "S": 0.0},
    _combinations,
    VALUES["loads"].standing,
    "as UBC-97 1661, 25 % of the live load of dwellings and offices is mass; E_v = 0.5 C_A D at "
    "the maximum level",
    _vertical,
)


RULES: dict[str, Any] = {
    "name": NAME,
    "aliases": ("NCh 2745", "NCh2745:2003"),
    "title": "Earthquake-resistant design of base-isolated buildings (Chile)",
    "edition": "tables of NCh2745 Of.2003; that those of 2013 are the same is not confirmed",
    "damping": DampingRule(
        VALUES["damping factor"].clause,
        LINEAR,
        table=(
            (0.02, 0.65),
            (0.05, 1.0),
            (0.10, 1.37),
            (0.15, 1.67),
            (0.20, 1.94),
            (0.25, 2.17),
            (0.30, 2.38),
            (0.50, 3.02),
        ),
        standing=VALUES["damping factor"].standing,
    ),
    # 8.4 of 2013: 1.3 less 10 %, as in UBC-97
    "scaling": (
        ScalingRule(
            "NCh2745",
            "SRSS",
            1.17,
            0.0,
            7,
            "NCh2745 8.4",
            (0.5, 1.25),
            standing=VALUES["scaling"].standing,
        ),
    ),
    "loads": _LOADS,
    "histories": HistoryRules(
        code=NAME,
        least=3,
        mean_from=7,
        drift=0.003,
        accidental_eccentricity=0.05,
        statistic_clause="8.4",
        displacement_clause="8",
        drift_clause="8.8",
        force_clause="8",
        eccentricity_clause="8.3",
        levels=(
            ActionLevel(DESIGN, judges="superstructure"),
            ActionLevel(MAXIMUM, NCH_MAXIMUM, judges="isolation"),
        ),
    ),
    "unread": {"importance": "has formulas and a spectrum without an importance factor here"},
    "spectrum": Spectrum.nch2745,
    "spectrum_keys": {
        "soil": SpectrumKey(Literal["I", "II", "III"]),
        "zone": SpectrumKey(Literal[1, 2, 3]),
    },
    "rims": RimRule(
        "NCh2745 7.3",
        "D_TM",
        1.0,
        "rims met by intent: no clause that allows it was read in NCh2745 (UBC-97, from which it "
        "descends, wants none below 0.75 D_TD, and the maximum level analysed with them). Needs "
        "the reviewer's agreement (13), time histories with the rims, tests of impact and return",
        VALUES["rims"].standing,
    ),
    "accepted": tuple(
        AcceptanceRule(tests, VALUES[name])
        for tests, name in (
            (("increments", "maximum displacement", "many cycles"), "accepted slope"),
            (("increments",), "accepted k_eff"),
            (("increments",), "specimens"),
            (("many cycles",), "many cycles, stiffness"),
            (("many cycles",), "many cycles, damping"),
            (("static",), "stable"),
        )
    ),
    "acceptance": f"{NO_LIMITS}, not of NCh2745 14",
    "example": ExampleProject(
        {"soil": "II", "zone": 3},
        {
            "spectrum": 'soil = "II"\nzone = 3\n',
            "bearing": example_bearing("1.7 m", 200, 420, 0.03, 0.1, "beyond D_TM"),
        },
    ),
}
"""All else of its `DesignCode`, but formulas and tests."""
