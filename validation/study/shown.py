"""How templates of the study show tables: rows chosen, numbers with their intervals, Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from validation.page import table as markdown

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Told = Mapping[str, Any]

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
