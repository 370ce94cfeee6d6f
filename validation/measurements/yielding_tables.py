"""Tables of isolated buildings that yield: medians, single runs, who does better."""

from __future__ import annotations

import math
from statistics import median
from typing import TYPE_CHECKING, Any

from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR, MOAT, RIMS, SYSTEMS, structures
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    Row = dict[str, Any]

COLUMNS = (
    ("bearing displacement [mm]", "displacement", 1e3, ".0f"),
    ("storey drift [%]", "drift", 1e2, ".2f"),
    ("hinge rotation [mrad]", "rotation", 1e3, ".1f"),
    ("hinges that yield", "hinges", 1.0, ".0f"),
    ("residual drift [%]", "residual", 1e2, ".2f"),
    ("base shear / W", "shear", 1.0, ".2f"),
    ("floor acceleration [g]", "floor", 1.0 / STANDARD_GRAVITY, ".2f"),
    ("of the roof [g]", "roof", 1.0 / STANDARD_GRAVITY, ".2f"),
    ("work of yielding / input [%]", "yielding", 1e2, ".1f"),
)
MEASURES = (
    ("drift", "storey drift"),
    ("rotation", "hinge rotation"),
    ("floor", "floor acceleration"),
    ("residual", "residual drift"),
    ("shear", "base shear"),
)
SAME = 0.02
"""Share within which two numbers are no win."""
LEAST = {"drift": 0.0, "rotation": 1e-4, "residual": 5e-4, "floor": 0.0, "shear": 0.0}
"""Differences that are none."""


def chosen(found: Iterable[Row], **wanted: Any) -> list[Row]:
    """Return the rows that have these values."""
    return [row for row in found if all(row[key] == value for key, value in wanted.items())]


def completed(rows: Iterable[Row]) -> list[Row]:
    """Return the runs that were completed."""
    return [row for row in rows if row["status"] == "ok"]


def ends(rows: Sequence[Row]) -> str:
    """Return how many runs were completed, and how the others stopped."""
    stopped = sorted({row["status"] for row in rows} - {"ok"})
    counts = [f"{len(chosen(rows, status=status))} `{status}`" for status in stopped]
    return ", ".join([f"{len(completed(rows))} of {len(rows)}", *counts])


def cells(rows: Sequence[Row]) -> list[str]:
    """Return the medians of what is compared, over completed runs."""
    if not rows:
        return ["-"] * len(COLUMNS)
    return [
        f"{factor * median(float(row[key]) for row in rows) + 0.0:{form}}"
        for _, key, factor, form in COLUMNS
    ]


def medians(
    found: Sequence[Row], structure: str, demands: Sequence[float], systems: Sequence[str]
) -> str:
    """Return the table of a structure: medians over the records."""
    head = ["demand", "system", "completed", *(name for name, *_ in COLUMNS)]
    lines = []
    for demand in demands:
        for system in systems:
            rows = chosen(found, structure=structure, demand=demand, system=system, elastic=False)
            lines.append([f"{demand:g}", system, ends(rows), *cells(completed(rows))])
    return table(head, lines)


def of_record(found: Sequence[Row], record: str, demands: Sequence[float]) -> str:
    """Return the table of one record."""
    head = ["frame", "demand", "factor", "system", "status", *(name for name, *_ in COLUMNS)]
    lines = []
    for structure in structures():
        for demand in demands:
            for system in SYSTEMS:
                for row in chosen(
                    found,
                    record=record,
                    structure=structure,
                    demand=demand,
                    system=system,
                    elastic=False,
                ):
                    own = cells(
                        [
                            row
                            | {"residual": math.nan if row["residual"] is None else row["residual"]}
                        ]
                    )
                    lines.append(
                        [
                            structure,
                            f"{demand:g}",
                            f"{row['factor']:.2f}",
                            system,
                            f"`{row['status']}`",
                            *(c.replace("nan", "-") for c in own),
                        ]
                    )
    return table(head, lines)


def elastic_table(found: Sequence[Row], demand: float) -> str:
    """Return the table of yielding frames beside those that stay elastic, medians."""
    head = ["frame", "system", "", *(name for name, *_ in COLUMNS)]
    lines = []
    for structure in structures():
        for system in SYSTEMS:
            for elastic in (True, False):
                rows = completed(
                    chosen(
                        found, structure=structure, demand=demand, system=system, elastic=elastic
                    )
                )
                how = "elastic" if elastic else "yields"
                lines.append([structure, system, how, *cells(rows)])
    return table(head, lines)


def pairs(found: Sequence[Row], other: str, demands: Sequence[float]) -> list[tuple[Row, Row]]:
    """Return the completed runs of the LIR-DCFP with those of another system beside them."""
    mine = {
        (r["record"], r["demand"], r["structure"]): r
        for r in completed(chosen(found, system=LIR, elastic=False))
    }
    return [
        (mine[place], row)
        for row in completed(chosen(found, system=other, elastic=False))
        if (place := (row["record"], row["demand"], row["structure"])) in mine
        and row["demand"] in demands
    ]


def wins(both: Iterable[tuple[Row, Row]], key: str) -> tuple[int, int, int]:
    """Return how often the first is lower, about equal, higher."""
    count = [0, 0, 0]
    for mine, theirs in both:
        a, b = float(mine[key]), float(theirs[key])
        same = abs(a - b) <= max(SAME * max(a, b), LEAST[key])
        count[1 if same else 0 if a < b else 2] += 1
    return count[0], count[1], count[2]


def wins_table(found: Sequence[Row], demands: Sequence[float]) -> str:
    """Return how often the LIR-DCFP is lower than, as, or higher than each other system."""
    head = ["LIR-DCFP against", "runs", *(f"{name}: lower / same / higher" for _, name in MEASURES)]
    lines = []
    for other in SYSTEMS[1:]:
        both = pairs(found, other, demands)
        counts = ["{} / {} / {}".format(*wins(both, key)) for key, _ in MEASURES]
        lines.append([other, str(len(both)), *counts])
    return table(head, lines)


def worse(found: Sequence[Row], other: str, demands: Sequence[float]) -> list[tuple[Row, Row]]:
    """Return the pairs in which the LIR-DCFP does worse by drift, rotation or residual drift."""
    return [
        pair
        for pair in pairs(found, other, demands)
        if any(wins([pair], key)[2] for key in ("drift", "rotation", "residual"))
    ]


def losses(found: Sequence[Row], demands: Sequence[float]) -> str:
    """Return the runs in which rims or a moat do better by drift or by hinge rotation."""
    head = [
        "record",
        "demand",
        "frame",
        "against",
        "drift [%]",
        "hinge rotation [mrad]",
        "residual drift [%]",
    ]
    lines = []
    for other in (RIMS, MOAT):
        for mine, theirs in worse(found, other, demands):
            numbers = [
                f"{factor * mine[key]:.2f}, {factor * theirs[key]:.2f}"
                for key, factor in (("drift", 1e2), ("rotation", 1e3), ("residual", 1e2))
            ]
            place = mine["record"], f"{mine['demand']:g}", mine["structure"]
            lines.append([*place, other, *numbers])
    return table(head, lines) if lines else "None."
