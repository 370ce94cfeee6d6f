"""How templates of the study show tables, and the sentences that their pages share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.devices import highest_ratio, moat_of
from lir_element.units import STANDARD_GRAVITY as G
from validation.page import table as markdown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.frame import Frame
    from lir_element import LIRBearing

    Told = Mapping[str, Any]

SETTING = (
    "The building has three storeys of steel frames that yield, and the bearings have a plan of "
    "689 mm ([study.md](study.md)). One device is an LIR-DCFP within the checks of the package, the "
    "others are DCFPs ([study_device.md](study_device.md)). Rims of 1 W yield at the load of their "
    "bearing and break at 20 mm."
)
"""Building and devices of most parts, in words."""

READING = (
    "Cells begin with the verdict of an exact two-sided sign test of the records. Verdicts of a "
    "campaign and set of records have a false-discovery rate of 10 %. The median intensity of the "
    "LIR-DCFP over that of the DCFP follows, with its interval of 90 %: above 1 the LIR-DCFP is "
    'better. The last two numbers count records. "3 to 0": the LIR-DCFP exceeds the limit less often '
    "in 3 records, and more often in none. If too few differ, no outcome of these records could decide. "
    "Intervals are of medians and tests of records, so that both may disagree. Comparisons share "
    "records and the building: they are not independent."
)
"""How to read tables of `judged`."""

DEMANDS = {
    "storey drift, mean": ("storey drift [%]", 1e2, ".2f"),
    "floor acceleration in plan, mean": ("floor acceleration [g]", 1.0 / G, ".2f"),
    "base shear over weight": ("base shear / W", 1.0, ".2f"),
    "ductility": ("ductility [-]", 1.0, ".1f"),
    "bearing displacement": ("bearing displacement [mm]", 1e3, ".0f"),
}
"""Demands of the table "response": their text, a factor from SI, a format."""

OPEN = 1.7
"""Upper end over value from which an interval counts as open [-]."""

NONE = "-"
"""What stands where there is no number."""


def where(table: pd.DataFrame, **chosen: object) -> pd.DataFrame:
    """Return the rows of a table with these values, of columns by names: `limit_state="..."`."""
    for key, value in chosen.items():
        column = key.replace("_", " ")
        values = value if isinstance(value, (list, tuple)) else [value]
        table = table[table[column].isin(values)]
    return table


def _column(row: Mapping[str, Any], name: str) -> str:
    # The column of this name, whatever its unit.
    return next((str(c) for c in row.keys() if str(c).split(" [")[0] == name), name)  # noqa: SIM118


def bearings_of(frame: Frame) -> list[LIRBearing]:
    """Return the bearings of a building."""
    return [link.bearing for link in frame.bearings.values()]


def sizes_of(frame: Frame) -> dict[str, float | None]:
    """Return sizes of a building's bearings: m, friction of the interface, ratio of the checks."""
    bearings = bearings_of(frame)
    dishes, plain = [dish_diameter(each) for each in bearings], bearings[0].is_dcfp
    return {
        "plan": max(dishes),
        "least plan": min(dishes),
        "capacity": min(each.lateral_capacity for each in bearings),
        "moat": moat_of(bearings),
        "slider": min(each.slider_radius for each in bearings),
        "interface": None if plain else bearings[0].interface_friction,
        "ratio": None if plain else highest_ratio(frame),
    }


def interval(row: Mapping[str, Any], name: str, form: str = ".2f", factor: float = 1.0) -> str:
    """Return a number of a row with its interval, or "above" its low end if it has no upper one.

    A median far beyond the stripes has none; a dash stands for no number.
    """
    column = _column(row, name)
    value = row.get(column)
    if value is None or pd.isna(value):
        return NONE
    unit = column.removeprefix(name)
    ends = [row.get(f"{name}, {end}{unit}", row.get(f"{end}{unit}")) for end in ("low", "high")]
    one, *both = (f"{factor * v:{form}}" for v in (value, *ends) if v is not None)
    if both and ends[1] > OPEN * value > 0.0:
        return f"above {both[0]}"
    return f"{one} ({both[0]} to {both[1]})" if both else one


def number(row: Mapping[str, Any], name: str, form: str = ".2f", factor: float = 1.0) -> str:
    """Return a number of a row by its column without the unit; "failed" if it is infinite."""
    value = row.get(_column(row, name))
    if value is None or pd.isna(value):
        return NONE
    return "failed" if abs(value) == float("inf") else f"{factor * value:{form}}"


def rows_of(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return a table as rows, for loops of a template."""
    return [{str(key): value for key, value in row.items()} for _, row in table.iterrows()]


def verdict_of(row: Mapping[str, Any]) -> str:
    """Return verdict, ratio of medians and records that differ of a row of ratios, as text."""
    return f"{row['verdict']}, {interval(row, 'ratio')}; {row['less']:.0f} to {row['more']:.0f}"


def judged(ratios: pd.DataFrame, corner: str = "limit state") -> str:
    """Return ratios in Markdown with verdicts of exact tests, a row a limit state."""
    others: dict[str, None] = {}
    found: dict[str, dict[str, str]] = {}
    for row in rows_of(ratios):
        other = str(row["over"]).removeprefix(f"{row.get('structure')}, ")
        others[other] = None
        found.setdefault(str(row["limit state"]), {})[other] = verdict_of(row)
    lines = [[name, *(cells.get(other, NONE) for other in others)] for name, cells in found.items()]
    return markdown([corner, *others], lines)


def margins_table(margins: pd.DataFrame) -> str:
    """Return failures, collapses and the collapse margin in Markdown, a row a device."""
    keys = ["device", "runs", "bearing failed", "collapsed", "analysis failed"]
    keys = ["record set", *keys] if "record set" in margins else keys
    lines = [
        [f"{row[key]}" for key in keys] + [interval(row, name) for name in ("median", "margin")]
        for row in rows_of(margins)
    ]
    return markdown([*keys, "median [m/s2] (90 %)", "margin (90 %)"], lines)


def demands_table(response: pd.DataFrame) -> str:
    """Return median and fractile of 84 % of demands in Markdown, a row an intensity and device."""
    lines = [
        [f"{row['factor']:g}", row["structure"]]
        + [
            f"{number(row, name + ', median', form, factor)}, "
            f"{number(row, name + ', 84 %', form, factor)}"
            for name, (_, factor, form) in DEMANDS.items()
        ]
        for row in rows_of(response.sort_values("factor", kind="stable"))
    ]
    return markdown(["Sa [m/s2]", "device", *(text for text, *_ in DEMANDS.values())], lines)


def causes(failures: pd.DataFrame) -> str:
    """Return how many runs of each structure stopped, by cause."""
    if failures.empty:
        return "No run failed."
    words: dict[str, list[str]] = {}
    for row in rows_of(failures):
        words.setdefault(str(row["structure"]), []).append(f"{row['runs']} `{row['cause']}`")
    return "Runs that failed: " + "; ".join(f"{n}: {', '.join(w)}" for n, w in words.items()) + "."


def cost_line(campaigns: Mapping[str, Told]) -> str:
    """Return the cost of campaigns, in sentences, with the digests of their results."""
    runs, loop = (sum(each["cost"][key] for each in campaigns.values()) for key in ("runs", "loop"))
    digests = ", ".join(f"`{each['digest'][:16]}`" for each in campaigns.values())
    return (
        f"{runs} histories; their time loops took {loop:.0f} s of one core. Digests of the results "
        f"begin with {digests}."
    )
