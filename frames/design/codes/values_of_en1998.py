"""Values of EN 1998 and EN 15129 for isolation, with the source of each."""

from __future__ import annotations

import math
from typing import Any, Literal

from frames.design.codes.bounds import factors_of_en1998
from frames.design.codes.code_values import (
    NO_CODE,
    NTC,
    NTC_SLIDERS,
    CodeValue,
    Provision,
    common,
    yours,
)
from frames.design.codes.history_rules import Combinations, HistoryRules, LoadRule
from frames.design.codes.prototype_programme import AcceptanceRule
from frames.design.codes.registry import (
    MOST_IMPORTANT,
    NO_LIMITS,
    ExampleProject,
    RimRule,
    SpectrumKey,
    example_bearing,
)
from frames.design.hazard.code_rules import DampingRule, ScalingRule
from frames.design.hazard.spectral_shapes import EN1998_TABLES
from frames.design.hazard.spectrum import Spectrum
from lir_element.units import STANDARD_GRAVITY

NAME = "EN 1998"

VALUES = {
    "spectrum": CodeValue(
        "EN 1998-1 3.2.2.2, tables 3.2 and 3.3", "elastic spectra", EN1998_TABLES
    ),
    "damping factor": CodeValue(
        "EN 1998-1 (3.6)", "eta = sqrt(10 / (5 + xi)), at least 0.55", EN1998_TABLES
    ),
    "d_dc": CodeValue("EN 1998-1 (10.4)", "d_dc with the least stiffness", NTC),
    "reliability": CodeValue(
        "EN 1998-1 10.3(2)", "gamma_x = 1.2 of buildings", field="reliability"
    ),
    "eccentricity": CodeValue(
        "EN 1998-1 4.3.2", "5 % of the side", field="accidental_eccentricity"
    ),
    "torsion": CodeValue("EN 1998-1 (10.5)", "displacements of each bearing, torsion included"),
    "capacity": CodeValue("EN 1998-1 10.3, EN 15129 8.3", "gamma_x d_bd below the rims"),
    "energy": CodeValue("EN 15129 4.3", "E_S at least 0.25 E_H", field="energy_ratio"),
    "recentring": CodeValue("EN 1998-2 7.7.1", "d_cd at least 0.5 d_r", field="recentring"),
    "stiffness ratio": CodeValue(
        "EN 1998-1 10.9.2", "K_eff at least 50 % of that at 0.2 d_dc", NTC, "stiffness_ratio"
    ),
    "most damping": CodeValue("EN 1998-1 10.9.2", "xi_eff at most 30 %", NTC, "most_damping"),
    "restoring": CodeValue(
        "EN 1998-1 10.9.2", "0.025 W of the second half of d_dc", NTC, "restoring"
    ),
    "variation": CodeValue(
        "EN 1998-1 10.9.2", "properties vary by 10 % at most", NTC, "most_variation"
    ),
    "largest side": CodeValue("EN 1998-1 10.9.3", "side at most 50 m", NTC, "largest_side"),
    "longest period": CodeValue("EN 1998-1 10.9.3", "T_eff at most 3 s", NTC, "longest_period"),
    "period ratio": CodeValue("EN 1998-1 10.9.3", "T_eff at least 3 T_f", NTC, "period_ratio"),
    "vertical period": CodeValue("EN 1998-1 10.9.3", "T_v below 0.1 s", NTC, "vertical_period"),
    "fault": CodeValue("EN 1998-1 10.9.3", "15 km from the fault", field="least_distance"),
    "vertical stiffness": CodeValue(
        "EN 1998-1 10.9.3", "K_V at least 150 K_eff", field="vertical_stiffness"
    ),
    "total eccentricity": CodeValue(
        "EN 1998-1 10.9.3", "7.5 % of the side, accidental with it", field="total_eccentricity"
    ),
    "accumulated": CodeValue(
        "NTC 2018 7.10.6.2.2", "half of mu L of earlier events", field="accumulated"
    ),
    "behaviour": CodeValue("EN 1998-1 10.10", "q at most 1.5", NTC, "behaviour"),
    "forces": CodeValue("EN 1998-1 (10.9)", "forces of the floors"),
    "drift": CodeValue("EN 1998-1 4.4.3.2", "storey drift at most 0.005", field="drift"),
    "reduction": CodeValue("EN 1998-1 4.4.3.2", "nu = 0.5", field="reduction"),
    "history drift": CodeValue(
        "EN 1998-1 4.4.3.2", "nu d_r of histories at most 0.005, 0.0075 or 0.010 of the height"
    ),
    "stability": CodeValue(
        "EN 1998-1 4.4.2.2", "P-Delta coefficient at most 0.1, in the analysis 0.3"
    ),
    "eccentricity ratio": CodeValue(
        "EN 1998-1 4.2.3.2(6)",
        "e_0 at most 0.30 of the torsional radius",
        field="eccentricity_ratio",
    ),
    "radius ratio": CodeValue(
        "EN 1998-1 4.2.3.2(6)",
        "torsional radius at least the radius of gyration",
        field="radius_ratio",
    ),
    "orthogonal": CodeValue("EN 1998-1 4.3.3.5", "30 % of the other direction", field="orthogonal"),
    "vertical loads": CodeValue("EN 15129 8.3, EN 1998-1 10.10", "no uplift, pressure of sliders"),
    "overturning": CodeValue("EN 1998-1 4.4.2.4", "of the whole structure, safety 1.0"),
    "separation": CodeValue("EN 1998-1 10.5.4", "room for gamma_x d_bd around the structure"),
    "factors": CodeValue("EN 1998-2 annexes J and JJ", "factors on friction and psi_f"),
    "vertical": CodeValue(
        "EN 1998-1 4.3.3.5.2, 10.6", "vertical component of 3 a_vg, 30 % with the horizontal ones"
    ),
    "loads": CodeValue(
        "EN 1990:2002, 6.4.3.4 and table A1.1, EN 1998-1:2004, 3.2.4",
        "seismic mass and combinations",
    ),
    "number of motions": CodeValue("EN 1998-1 3.2.3.1.2", "3 motions at least"),
    "mean": CodeValue("EN 1998-1 4.3.3.4.3(3)", "the mean counts from 7 motions on"),
    "scaling": CodeValue("EN 1998-1 3.2.3.1.2", "0.9 of the target from 0.2 T to 2 T, 1 at zero"),
    "moved masses": CodeValue("EN 1998-1 4.3.2", "5 % of the sides in histories"),
    "rims": CodeValue("EN 1998-1 10.3(2), EN 15129", "rims are not met below gamma_x d_bd"),
    "tests": CodeValue("EN 15129 8.3.4", "which tests, amplitudes and cycles"),
    "accepted k_d": CodeValue(
        "EN 15129 8.3.4", "post-elastic stiffness within 15 % of that of the design"
    ),
    "accepted friction": CodeValue(
        "EN 15129 8.3.4", "friction within the bounds that the design counts on"
    ),
    "accepted cycles": CodeValue(
        "NTC 2018 11.9.8", "friction of each cycle within 25 % of that of the third", NTC_SLIDERS
    ),
    "stable": CodeValue("EN 15129 8.3.4", "the bearing stays stable"),
}
"""Values by name; a value without comparison with a text is from memory."""

PROVISIONS = (
    Provision(
        "EN 1998-1 10.3, EN 15129 8.3",
        "rims are not met at gamma_x d_bd",
        ("no restrainer contact at gamma_x d_bd",),
    ),
    Provision(
        "EN 1998-1 10.3(2), EN 15129",
        "share of gamma_x d_bd from which rims may be met",
        ("displacement where a rim engages",),
    ),
    Provision(
        "EN 15129 4.3, EN 1998-2 7.7.1",
        "recentring",
        ("recentring, energy", "recentring, displacement"),
    ),
    Provision(
        "EN 1998-1 10.9.2",
        "limits of the procedure: stiffness, damping, restoring force",
        ("effective stiffness ratio", "effective damping", "restoring force"),
    ),
    Provision(
        "EN 1998-1 10.9.2",
        "variation of properties with rate and load",
        why="since a project's file has no key for it",
    ),
    Provision(
        "EN 1998-1 10.9.3", "total eccentricity", ("total eccentricity over the side of the plan",)
    ),
    Provision(
        "EN 1998-1 10.9.3",
        "limits of the simplified linear analysis",
        why="since time histories take its place",
    ),
    Provision(
        "NTC 2018 7.10.6.2.2",
        "displacement left by earlier events",
        ("capacity with accumulated displacement",),
    ),
    common("EN 1998-1 4.4.3.2", "storey drift, equivalent-linear"),
    common("EN 1998-1 4.4.3.2", "storey drift of time histories"),
    Provision(
        "EN 1998-1 4.4.2.2",
        "second-order effects: theta of the storeys, and whether the analysis has them",
        ("P-Delta coefficient of a storey",),
        ("storeys",),
    ),
    Provision(
        "EN 1998-1 4.2.3.2(6)",
        "regularity in plan of the isolation",
        (
            "eccentricity of the isolation over its torsional radius",
            "torsional radius of the isolation over the radius of gyration",
        ),
    ),
    yours(
        "EN 1998-1 4.2.3",
        "regularity in plan and height of what stands on the bearings",
        "the model is spatial; 4.2.3.1(7) reduces q if the elevation is irregular",
    ),
    common("EN 1998-1 4.4.2.4", "overturning of the whole structure"),
    common("EN 15129 8.3, EN 1998-1 10.10", "uplift by the combinations"),
    common("EN 1998-1 10.10", "uplift in time histories"),
    Provision(
        "EN 1998-1 4.3.3.5.2, 10.6",
        "vertical earthquake in the combinations",
        ("no uplift", "no uplift where the vertical earthquake leads"),
        ("superstructure", "combinations"),
    ),
    common(NO_CODE, "sliding under wind"),
    common("EN 1998-1 10.5.4", "separation to walls and neighbours"),
    Provision(
        "EN 1998-1 3.2.3.1.2",
        "number and scaling of motions",
        (
            "number of motions",
            "pairs of motions",
            "mean spectrum of the motions",
            "mean spectrum of the motions at the period 0",
        ),
    ),
    common("EN 1998-1 4.3.3.4.3(3)", "runs that failed"),
    common("EN 1998-1 4.3.2", "accidental eccentricity of time histories"),
    common("EN 1998-1 10.3(2)", "displacement of time histories"),
    common("EN 1998-1 4.4.2.3, 4.4.2.6, 10.10", "overstrength of members and connections"),
    yours(
        "EN 1998-1:2004",
        "edition that is in force",
        "the second generation (2024) is not known here",
    ),
    yours(
        "EN 1998-1 10.5.1 to 10.5.3",
        "place, access and inspection of the bearings, settlements, rigid slab above them",
        "state it in the specification",
    ),
    common("EN 1998-1 10.4", "parts that cross the isolation interface"),
    common("EN 1998-1 4.3.5, 10.9.6", "parts that stand above the isolation interface"),
    yours(
        "EN 1998-1 10.6(3)",
        "spectra of the site for importance class IV near a fault",
        "within 15 km of a fault of magnitude 6.5: give [spectrum] points",
    ),
    common("EN 1998-1 10.8", "bounds of properties over the life of the bearings"),
    yours(
        "EN 1998-1 10.10(1)",
        "substructure under the forces of the isolation",
        "reaction-combinations.csv has them, not reduced; its own inertia comes on top",
    ),
    common("EN 15129 8.3.4", "tests of the bearings"),
    yours("EN 15129 4.4, 10", "durability, fire, replacement", "state it in the specification"),
)
"""Provisions of EN 1998 and EN 15129, checked or not; `OF_BEARINGS` has those of bearings."""


_SMALLEST_ETA = 0.55
_DRIFTS = {"brittle": 0.005, "ductile": 0.0075, "separate": 0.010}
"""Limits of nu d_r over the height by the non-structural elements (EN 1998-1 4.4.3.2)."""


def _factor(damping: float) -> float:
    # B = 1 / eta.
    return 1.0 / max(math.sqrt(10.0 / (5.0 + 100.0 * damping)), _SMALLEST_ETA)


_VERTICAL = {1: 0.90, 2: 0.45}
"""a_vg over a_g by the kind of the spectrum (EN 1998-1 table 3.4)."""
COMPANION = 0.3
"""Share of the vertical component that acts with the horizontal ones (EN 1998-1 4.3.3.5.2(4))."""


def vertical_level(spectrum: Spectrum) -> float:
    """Return the plateau of the vertical elastic spectrum, 3 a_vg, of all vertical periods [g].

    For a spectrum by points S_e(0) replaces a_g: on the safe side, because it includes the ground.
    """
    peak = spectrum.parameters.get("a_g") or float(spectrum.acceleration(spectrum.reach[0]))
    kind = int(dict(spectrum.site).get("kind", 1))
    return 3.0 * _VERTICAL[kind] * peak / STANDARD_GRAVITY


def _combinations(vertical: float | None) -> Combinations:
    part = COMPANION * (vertical or 0.0)
    return {
        "average": {"D": 1.0, "L": 0.3, "S": 0.0},
        "maximum": {"D": 1.0 + part, "L": 0.3 * (1.0 + part), "S": 0.2},
        "minimum": {"D": 1.0 - part, "L": 0.0, "S": 0.0},
    }


_LOADS = LoadRule(
    VALUES["loads"].clause,
    {"D": 1.0, "L": 0.3, "S": 0.0},
    _combinations,
    VALUES["loads"].standing,
    "psi_2 = 0.3 of dwellings and offices, phi = 1; 30 % of the vertical earthquake 3 a_vg",
    vertical_level,
)


RULES: dict[str, Any] = {
    "name": NAME,
    "aliases": ("EN 1998-1", "EN 1998-1:2004", "Eurocode 8"),
    "unread": {"R": "has the behaviour factor q = 1.5 in its place (EN 1998-1 10.10)"},
    "title": "Design of structures for earthquake resistance, with EN 15129, Anti-seismic devices",
    "edition": "EN 1998-1:2004, EN 1998-2:2005, EN 15129:2009; not the second generation",
    "damping": DampingRule(
        "EN 1998-1:2004, 3.2.2.2(3)",
        "B = 1 / eta, eta = sqrt(10 / (5 + damping in %)) >= 0.55",
        formula=_factor,
        standing=VALUES["damping factor"].standing,
    ),
    "scaling": (
        ScalingRule(
            "EN 1998",
            "arithmetic mean",
            0.9,
            1.0,
            7,
            "EN 1998-1:2004 3.2.3.1.2 and 4.3.3.4.3",
            (0.2, 2.0),
            standing=VALUES["scaling"].standing,
        ),
        ScalingRule("EN 1998-2", "SRSS", 1.3, 0.0, 7, "EN 1998-2:2005 3.2.3", (0.2, 1.5)),
    ),
    "loads": _LOADS,
    "histories": HistoryRules(
        code=NAME,
        standard="EN 1998-1",
        least=3,
        mean_from=7,
        drift=_DRIFTS["brittle"],
        drift_factor=0.5,
        drift_classes=tuple(_DRIFTS.items()),
        stability=(0.1, 0.3),
        displacement_factor=1.2,
        accidental_eccentricity=0.05,
        statistic_clause="4.3.3.4.3(3)",
        displacement_clause="10.3(2)",
        drift_clause="4.4.3.2",
        stability_clause="4.4.2.2",
        force_clause="10.10",
        eccentricity_clause="4.3.2",
    ),
    "factors": factors_of_en1998,
    "spectrum": Spectrum.en1998,
    "spectrum_keys": {
        "a_g": SpectrumKey(unit="m/s^2"),
        "ground_type": SpectrumKey(Literal["A", "B", "C", "D", "E"]),
        "kind": SpectrumKey(Literal[1, 2], default=1),
        "importance": SpectrumKey(default=1.0, most=MOST_IMPORTANT),
    },
    "rims": RimRule(
        "EN 1998-1 10.3(2), EN 15129",
        "gamma_x d_bd",
        1.0,
        "rims met by intent: these standards have no rule for it; NTC 2018 7.10.6.2.2, which "
        "implements them, wants end stops that leave this displacement free. Needs the agreement "
        "of the authority, time histories with the rims, and tests of impact and return",
        VALUES["rims"].standing,
    ),
    "accepted": tuple(
        AcceptanceRule(tests, VALUES[name])
        for tests, name in (
            (("P1", "D1", "D2", "D3"), "accepted k_d"),
            (("D", "B"), "accepted friction"),
            (("D", "B"), "accepted cycles"),
            (("D4", "D5"), "stable"),
        )
    ),
    "acceptance": f"{NO_LIMITS}, not of EN 15129 8.3.4",
    "example": ExampleProject(
        {"a_g": 3.4, "ground_type": "B"},
        {
            "spectrum": '# the ground of type 1, elastic\na_g = "3.4 m/s2"\nground_type = "B"\n'
            "kind = 1\n",
            "superstructure": "importance = 1.0\n",
            "bearing": example_bearing("2 m", 200, 270, 0.04, 0.098, "beyond gamma_x d_bd"),
        },
    ),
}
"""All else of its `DesignCode`, but formulas and tests."""
