"""Sections of the page of the best devices: theory, search, devices and what was varied."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import spearmanr

from validation.measurements.yielding_runs import LIR
from validation.page import table
from validation.study.device_figures import KINDS, labelled
from validation.study.device_runs import (
    HALF_STRIPES,
    LEAST,
    MOST,
    OTHERS,
    REFERENCE,
    SEARCHED,
    STRIPES,
    plan_of,
)
from validation.study.device_search import EDGE
from validation.study.device_search import STRIPES as TRIED
from validation.study.records_runs import COLLAPSE
from validation.study.rims_runs import LIMITS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Found = Mapping[str, Any]


def millimetres(value: float) -> str:
    """Return a length as text in millimetres."""
    return f"{1e3 * value:.0f}"


def interval(values: Sequence[float]) -> str:
    """Return a value with its interval as text."""
    return "{:.2f} ({:.2f} to {:.2f})".format(*values[:3])


def margin_of(kept: Mapping[str, Any]) -> str:
    """Return a collapse margin as text, or why there is none."""
    margin = kept.get("margin")
    return kept["limits"][COLLAPSE.name]["why"] if margin is None else interval(margin)


def reference(found: Found) -> Mapping[str, Any]:
    """Return the plan that is the example."""
    wanted = plan_of(REFERENCE)
    plan: Mapping[str, Any] = min(found["plans"], key=lambda each: abs(each["plan"] - wanted))
    return plan


def theory(found: Found) -> str:
    """Return what must govern by hand, and how well the work ranks devices."""
    plan = reference(found)
    kept = plan["devices"]
    own, one = kept[LIR]["energies"], kept[OTHERS[1]]["energies"]
    smallest, largest, most = found["sliders"]
    a, rows = kept[LIR]["device"]["least"], found["search"]
    work, medians = ([row[key] for row in rows] for key in ("work", "median"))
    slope, level = np.polyfit(np.log(work), np.log(medians), 1)
    scatter = float(np.std(np.log(medians) - slope * np.log(work) - level))
    return (
        "In one way from rest a bearing takes the work `D^2 / 2L + mu_e D` until it meets its rims, over "
        "the weight W; from there the interface passes on `(D / L + mu_h) W` at the first contact "
        "([theory](../theory_bearing.md)), over its slip. A diaphragm moves all bearings alike, so "
        "that **the smallest slider of the building ends the slip**, `s = a_min`: the work of the slip is "
        "`(D / L + mu_h) a_min`. A DCFP has the strength of its rims times their deformation instead, "
        "and what its frame takes in yielding.\n\n"
        f"- **Sliders.** By the pressure of the study (28 MPa, 2,000 kN on a radius of 150 mm; "
        f"`lir design` takes 30 MPa) they have {1e3 * smallest:.0f} mm at the "
        f"corners and {1e3 * largest:.0f} mm in the centre. Larger corner sliders take nothing from "
        "the way to the rims of the centre bearing, which ends the way of all; so all of the same "
        f"radius, {1e3 * largest:.0f} mm, have the slip without its price in displacement (larger "
        "corner dishes are a price, see [cost](#cost)). Beyond that each millimetre of slider takes "
        f"L/R = 1.9 mm of displacement. The upper bound is the least pressure, 10 MPa in the mean "
        f"weighted by the loads: {1e3 * most:.0f} mm.\n"
        "- **Interface.** With `mu_h = mu_e + kappa a / L` the slip may use up the overlap from kappa = 1 "
        "on (theory.md 2.7), and the resultant stands on the edge of the slider at the first slip where "
        "kappa = 2 (10.2: `(R - h / 2) mu_h - mu R = a`): between them lies what is possible. More "
        "friction is more work, so the upper bound should govern.\n"
        "- **Height.** Dishes of more than 744 mm meet at rest over sliders of 120 mm: larger plans "
        "have higher sliders and radii larger by half of that, L as it is.\n\n"
        f"At {millimetres(plan['plan'])} mm the best LIR-DCFP (a_min = {1e3 * a:.0f} mm) takes "
        f"{1e3 * own['sliding']:.0f} mm of W by sliding and {1e3 * own['slip']:.0f} by slip, a DCFP "
        f"with rims of 1 W {1e3 * one['sliding']:.0f} and {1e3 * one['rims']:.0f} in its rims. Over all "
        f"{len(rows)} LIR-DCFPs tried the median of collapse grows as the work to the power of "
        f"{slope:.2f}, with a scatter of {100.0 * scatter:.0f} % (rank correlation "
        f"{float(spearmanr(work, medians).statistic):.2f})."
    )


def search(found: Found) -> str:
    """Return how the best device was searched for, and what was tried at each plan."""
    rows = []
    for plan in found["plans"]:
        own = [r for r in found["search"] if abs(r["plan"] - plan["plan"]) < 1e-6]
        for row in own:
            chosen = abs(row["least"] - plan["devices"][LIR]["device"]["least"]) < 1e-6 and (
                abs(row["interface"] - plan["devices"][LIR]["device"]["interface"]) < 1e-6
            )
            rows.append(
                [
                    millimetres(row["plan"]),
                    "by hand" if (row["sliders"], row["kappa"]) == EDGE else "of the surface",
                    f"{1e3 * row['least']:.0f}",
                    f"{row['kappa']:.2f}",
                    f"{row['interface']:.3f}",
                    f"{1e3 * row['work']:.0f}",
                    f"{row['median']:.2f}",
                    "taken" if chosen else "",
                ]
            )
    head = [
        "plan [mm]",
        "point",
        "a_min [mm]",
        "kappa",
        "mu_h",
        "work [mm]",
        "collapse, median [m/s2]",
        "",
    ]
    first = sum(row["stage"] == "first" for row in found["search"])
    stripes = ", ".join(f"{at:g}" for at in TRIED)
    return (
        "A time history of collapse has no derivative and each value costs a stripe analysis, so that the "
        f"search has a response surface: {first} Sobol' points of plan "
        f"({millimetres(plan_of(LEAST))} to {millimetres(plan_of(MOST))} mm), least slider and kappa, every "
        f"second record at {stripes} m/s2, the median by a lognormal curve of dispersion 0.25; through "
        "them a power of the work by hand, and linear radial functions of what it leaves over "
        "(`scipy.interpolate.RBFInterpolator`); the maximum of both at each plan by "
        "`scipy.optimize.direct`, which needs no start. At each plan that point and the one that the work by hand names, "
        "equal sliders with kappa = 2, are run (they are one at "
        f"{_alike(found)} of {len(SEARCHED)} plans); the better is taken to all records and "
        "stripes. A larger plan, beyond those of the search, has the device named by hand.\n\n"
        + table(head, rows)
    )


def _alike(found: Found) -> int:
    # Plans at which the surface is highest where the work by hand says.
    plans = [round(row["plan"], 6) for row in found["search"] if row["stage"] == "second"]
    return sum(plans.count(plan) == 1 for plan in set(plans))


def devices(found: Found) -> str:
    """Return the table of all devices."""
    head = [
        "device",
        "D [mm]",
        "a_min [mm]",
        *(f"{limit.name}, median [m/s2]" for limit in LIMITS),
        "collapse margin (90 %)",
        "failed bearings [%] at " + ", ".join(f"{at:g}" for at in STRIPES),
        "e/a > 1 [% of complete runs]",
    ]
    rows = [_device_row(plan["devices"][kind]) for plan in found["plans"] for kind in KINDS]
    return table(head, rows)


def _device_row(kept: Mapping[str, Any]) -> list[str]:
    curves = [kept["limits"][limit.name] for limit in LIMITS]
    eccentric = kept["eccentricity"]
    return [
        kept["name"],
        millimetres(kept["capacity"]),
        millimetres(kept["sliders"][0]),
        *(f"{c['median'][0]:.2f}" if "median" in c else "-" for c in curves),
        margin_of(kept),
        ", ".join(f"{100.0 * share:.0f}" for share in kept["failed"]),
        "-" if eccentric is None else f"{100.0 * eccentric:.0f}",
    ]


def pairs(found: Found) -> str:
    """Return ratios of medians, plan by plan."""
    head = ["plan [mm]", "DCFP", *(f"{limit.name}" for limit in LIMITS)]
    rows = []
    for plan in found["plans"]:
        for other in OTHERS:
            ratios = plan["pairs"][other]["ratios"]
            cells = [ratios[limit.name] for limit in LIMITS]
            rows.append(
                [
                    millimetres(plan["plan"]),
                    other,
                    *("-" if cell is None else interval(cell) for cell in cells),
                ]
            )
    return (
        "Median of the LIR-DCFP over that of the DCFP (90 %), above 1 the LIR-DCFP is better; a dash: "
        "one of both has no curve, as its runs never, or always, exceed the limit.\n\n"
        + table(head, rows)
    )


def soft(found: Found) -> str:
    """Return what soft rims do."""
    rows = [
        [
            kept["name"],
            margin_of(kept),
            ", ".join(f"{100.0 * share:.0f}" for share in kept["failed"]),
        ]
        for kept in found["soft"].values()
    ]
    own = {round(p["plan"], 4): p["devices"][LIR] for p in found["plans"]}
    words = []
    for kept in found["soft"].values():
        best = own.get(round(kept["device"]["plan"], 4))
        if best and "margin" in best and "margin" in kept:
            ratio = best["margin"][0] / kept["margin"][0]
            words.append(f"{millimetres(kept['device']['plan'])} mm: {ratio:.2f}")
    return (
        "Rims of a tenth of the default stiffness that break at the default deformation (a tenth of the "
        "slider's radius) bear a tenth of the force. Median of the best LIR-DCFP over that of such a "
        f"DCFP of its plan: {'; '.join(words)}.\n\n"
        + table(
            [
                "device",
                "collapse margin (90 %)",
                "failed bearings [%] at " + ", ".join(f"{at:g}" for at in STRIPES),
            ],
            rows,
        )
    )


def varied(found: Found) -> str:
    """Return the devices of the example's plan, varied and at the other level."""
    rows = [
        [
            each["device"] if each["device"] == LIR else labelled(each["device"]),
            each["what"],
            *(f"{count:.0f} of {known:.0f}" for _, count, known in each["counts"]),
        ]
        for each in found["varied"]
    ]
    stripes = [f"Sa(3 s) = {at:g} m/s2" for at in HALF_STRIPES]
    return (
        f"Devices of the plan of {millimetres(reference(found)['plan'])} mm under every second record: "
        "runs that collapse, of those known. Sliders by load have 60 mm more in radius each and the "
        "dishes of the DCFP under every column, not under the centre alone. Where rims are met, the "
        "resultant leaves the sliders of the level `pendulum` in many runs (last column of the "
        "devices' table), where bodies would tip; the level `contact` has sliders as bodies.\n\n"
        + table(["device", "varied", *stripes], rows)
    )
