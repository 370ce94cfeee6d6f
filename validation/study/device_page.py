"""The page of the study of the best devices, from its numbers alone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from validation.measurements.yielding_runs import LIR
from validation.page import render
from validation.study.device_cost_page import cost, cost_verdict, equal_cost
from validation.study.device_figures import COST, MARGINS, REGIONS, SEARCH, labelled, winner
from validation.study.device_runs import BY_LOAD, OTHERS
from validation.study.device_sections import (
    devices,
    interval,
    millimetres,
    pairs,
    reference,
    search,
    soft,
    theory,
    varied,
)
from validation.study.records_runs import COLLAPSE, INTENSITY
from validation.study.rims_runs import BREAKS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Found = Mapping[str, Any]

NAME = "study_device"


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        BREAKS=BREAKS,
        COST=COST,
        LIR=LIR,
        MARGINS=MARGINS,
        OTHERS=OTHERS,
        REGIONS=REGIONS,
        SEARCH=SEARCH,
        cost=cost,
        devices=devices,
        equal_cost=equal_cost,
        found=found,
        math=math,
        pairs=pairs,
        reference=reference,
        search=search,
        soft=soft,
        theory=theory,
        varied=varied,
        INTENSITY=INTENSITY,
    )


def _introduction(found: Found) -> Any:
    plans = ", ".join(millimetres(plan["plan"]) for plan in found["plans"])
    return plans


def _verdict(found: Found) -> str:
    lines = []
    for other in OTHERS:
        rows = [
            (plan["plan"], ratio)
            for plan in found["plans"]
            if (ratio := plan["pairs"][other]["ratios"][COLLAPSE.name]) is not None
        ]
        if not rows:
            lines.append(f"- **{labelled(other)}.** No curve to compare with at any plan.")
            continue
        lines.append(f"- **{labelled(other)}.** {_said(rows)}")
    return (
        "Collapse: median intensity of the best LIR-DCFP over that of the DCFP of the same plan "
        "(interval of 90 %, records resampled), above 1 the LIR-DCFP is better.\n\n"
        + "\n".join(lines)
        + "\n\n"
        + _cells(found)
        + " "
        + cost_verdict(found)
        + "\n\n"
        + _sliders(found)
    )


def _sliders(found: Found) -> str:
    # What equal sliders change, and what bodies do: runs that collapse at the stronger stripe.
    counts = {(each["device"], each["what"]): each["counts"][-1] for each in found["varied"]}
    at, own, known = counts[LIR, "as it is"]
    by_load = counts[LIR, BY_LOAD]
    bodies = [counts[name, "level `contact`"] for name in (LIR, OTHERS[1])]
    plain = counts[OTHERS[1], "as it is"]
    return (
        f"The smallest slider of the building ends the slip of all: at {at:g} m/s2 and "
        f"{millimetres(reference(found)['plan'])} mm {own:.0f} of {known:.0f} records collapse with "
        f"equal sliders, {by_load[1]:.0f} of {by_load[2]:.0f} with sliders by load in the dishes of the "
        f"DCFP. With sliders as bodies {bodies[0][1]:.0f} of {bodies[0][2]:.0f} collapse on the LIR-DCFP "
        f"and {bodies[1][1]:.0f} of {bodies[1][2]:.0f} on the DCFP with rims of 1 W, at the level of "
        f"all other numbers here {own:.0f} and {plain[1]:.0f}."
    )


def _said(rows: Sequence[tuple[float, Sequence[float]]]) -> str:
    # Whether it is ahead, at which plans, and the nearest approach where it is not.
    ahead = [plan for plan, ratio in rows if ratio[1] > 1.0]
    behind = [plan for plan, ratio in rows if ratio[2] < 1.0]
    plan, best = max(rows, key=lambda row: row[1][0])
    words = []
    if ahead:
        words.append(f"is ahead at plans of {', '.join(map(millimetres, ahead))} mm")
    if behind:
        words.append(f"is behind at {', '.join(map(millimetres, behind))} mm")
    even = len(rows) - len(ahead) - len(behind)
    if even:
        words.append(f"is level within the interval at {even} of {len(rows)}")
    text = f"The LIR-DCFP {', '.join(words)}"
    nearest = "largest ratio" if ahead else "nearest approach"
    return f"{text}; {nearest} {interval(best)} at {millimetres(plan)} mm."


def _cells(found: Found) -> str:
    # Over all plans and intensities: in how many cells of the figure one is ahead.
    sentences = []
    for key, text in (
        ("collapse", "Share of records that collapse"),
        ("floors", "Median floor acceleration, failed bearings as infinite"),
    ):
        counts = []
        for other in OTHERS:
            cells = [cell for plan in found["plans"] for cell in plan["pairs"][other][key]]
            who = [winner(cell) for cell in cells]
            counts.append(
                f"{other}: ahead in {who.count('LIR')}, behind in {who.count('DCFP')} of {len(who)}"
            )
        sentences.append(f"{text}, over plans and intensities: {'; '.join(counts)}.")
    return " ".join(sentences)


def _took(found: Found) -> Any:
    rows = [
        [each["what"], str(each["runs"]), f"{each['seconds']:.0f}", f"`{each['digest'][:16]}`"]
        for each in found["costs"]
    ]
    runs, seconds = (sum(each[key] for each in found["costs"]) for key in ("runs", "seconds"))
    rows.append(["all", str(runs), f"{seconds:.0f}", ""])
    return rows
