"""How templates of the study show tables: rows chosen, numbers with their intervals, Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from lir_element.units import STANDARD_GRAVITY as G
from validation.page import table as markdown

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Told = Mapping[str, Any]

DEMANDS = {
    "ductility": ("ductility [-]", 1.0, ".2f"),
    "storey drift, mean": ("storey drift [%]", 1e2, ".2f"),
    "floor acceleration in plan, mean": ("floor acceleration [g]", 1.0 / G, ".2f"),
    "bearing displacement": ("bearing displacement [mm]", 1e3, ".0f"),
    "residual bearing displacement": ("residual displacement [mm]", 1e3, ".1f"),
    "interface slip": ("interface slip [mm]", 1e3, ".1f"),
    "residual interface slip": ("residual slip [mm]", 1e3, ".1f"),
    "rim force": ("rim force [kN]", 1e-3, ".0f"),
    "base shear over weight": ("base shear / W", 1.0, ".2f"),
}
"""Demands of the table "response": their text, a factor from SI, a format."""

NONE = "-"
"""What stands where there is no number."""


def where(table: pd.DataFrame, **chosen: object) -> pd.DataFrame:
    """Return the rows of a table with these values, of columns by names: `limit_state="..."`."""
    for key, value in chosen.items():
        column = key.replace("_", " ")
        values = value if isinstance(value, (list, tuple)) else [value]
        table = table[table[column].isin(values)]
    return table


def unit_of(table: pd.DataFrame, name: str) -> str:
    """Return a column of a table by its name without the unit: "median" of "median [m/s2]"."""
    return next((str(c) for c in table.columns if str(c).split(" [")[0] == name), name)


def interval(row: Mapping[str, Any], name: str, form: str = ".2f", factor: float = 1.0) -> str:
    """Return a number of a row with its interval; a dash where there is none."""
    column = next((str(c) for c in row.keys() if str(c).split(" [")[0] == name), name)  # noqa: SIM118
    value = row.get(column)
    if value is None or pd.isna(value):
        return NONE
    unit = column.removeprefix(name)
    ends = [row.get(f"{name}, {end}{unit}", row.get(f"{end}{unit}")) for end in ("low", "high")]
    one, *both = (f"{factor * v:{form}}" for v in (value, *ends) if v is not None)
    return f"{one} ({both[0]} to {both[1]})" if both else one


def number(row: Mapping[str, Any], name: str, form: str = ".2f", factor: float = 1.0) -> str:
    """Return a number of a row by its column without the unit; "failed" if it is infinite."""
    column = next((str(c) for c in row.keys() if str(c).split(" [")[0] == name), name)  # noqa: SIM118
    value = row.get(column)
    if value is None or pd.isna(value):
        return NONE
    return "failed" if abs(value) == float("inf") else f"{factor * value:{form}}"


def rows_of(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return a table as rows, for loops of a template."""
    return [{str(key): value for key, value in row.items()} for _, row in table.iterrows()]


def crossed(
    table: pd.DataFrame, rows: str | Sequence[str], columns: str, name: str, form: str = ".2f"
) -> str:
    """Return a table in Markdown: values of one column along, a number with interval a cell."""
    keys = [rows] if isinstance(rows, str) else list(rows)
    heads = list(dict.fromkeys(map(str, table[columns])))
    found: dict[tuple[str, ...], dict[str, str]] = {}
    for row in rows_of(table):
        place = tuple(str(row[key]) for key in keys)
        found.setdefault(place, {})[str(row[columns])] = interval(row, name, form)
    lines = [[*place, *(cells.get(h, NONE) for h in heads)] for place, cells in found.items()]
    return markdown([*keys, *heads], lines)


def judged(ratios: pd.DataFrame, rows: str, corner: str = "") -> str:
    """Return ratios in Markdown with verdicts of exact tests, a row a limit state or the like."""
    others = list(dict.fromkeys(map(str, ratios["over"])))
    found: dict[str, dict[str, str]] = {}
    for row in rows_of(ratios):
        counts = f"{row['less']:.0f} to {row['more']:.0f}"
        said = f"{row['verdict']}, {interval(row, 'ratio')}; {counts}"
        found.setdefault(str(row[rows]), {})[str(row["over"])] = said
    lines = [[name, *(cells.get(other, NONE) for other in others)] for name, cells in found.items()]
    return markdown([corner or rows, *others], lines)


def ended(table: pd.DataFrame, column: str, end: str) -> pd.DataFrame:
    """Return the rows of a table whose text in a column ends so: devices of several structures."""
    return table[table[column].str.endswith(end)]


def crossed_verdicts(ratios: pd.DataFrame, corner: str) -> str:
    """Return ratios in Markdown with verdicts of exact tests, structures by limit states."""
    return judged(ratios.assign(over=ratios["limit state"]), "structure", corner)


def causes(failures: pd.DataFrame) -> str:
    """Return how many runs of each structure stopped, by cause."""
    if failures.empty:
        return "No run failed."
    words: dict[str, list[str]] = {}
    for row in rows_of(failures):
        words.setdefault(str(row["structure"]), []).append(f"{row['runs']} `{row['cause']}`")
    return "Runs that failed: " + "; ".join(f"{n}: {', '.join(w)}" for n, w in words.items()) + "."


def brief(reason: object) -> str:
    """Return why there is no curve, without its remedy."""
    return "" if pd.isna(reason) else str(reason).split(":")[0].split(";")[0]


def cost_line(campaigns: Mapping[str, Told]) -> str:
    """Return what campaigns cost, in sentences, with the digests of their results."""
    costs = [each["cost"] for each in campaigns.values()]
    runs, computed = (sum(cost[key] for cost in costs) for key in ("runs", "computed"))
    clock, loop = (sum(cost[key] for cost in costs) for key in ("clock", "loop"))
    digests = ", ".join(f"`{each['digest'][:16]}`" for each in campaigns.values())
    return (
        f"{runs} histories, {computed} of them in the last call ({clock:.0f} s by the clock); their "
        f"time loops took {loop:.0f} s. Digests of the results begin with {digests}."
    )
