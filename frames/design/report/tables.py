"""Tables for people: numbers of four digits, or whole ones, in mm and kN by their unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.rendering import number as written

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd


_NAME = 18  # letters of a name that stays on one line
SHOWN = {
    "m": ("mm", 1e3),
    "N": ("kN", 1e-3),
    "N m": ("kN m", 1e-3),
    "N/m": ("kN/m", 1e-3),
    "J": ("kJ", 1e-3),
    "m/s2": ("m/s²", 1.0),
}
"""Units that tables show others in, with the factor."""


class Table(NamedTuple):
    """A table of a page: cells as text, the first column and those named to the left."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: frozenset[int] = frozenset()

    @property
    def short(self) -> bool:
        """True if the first column has names alone, which are not broken into lines."""
        return all(len(row[0]) <= _NAME for row in self.rows)


def rows_of(frame: pd.DataFrame, text: Callable[[object], str] = str) -> list[tuple[str, ...]]:
    """Return the rows of a table as text, each after its name."""
    rows = []
    for name, cells in zip(frame.index, frame.itertuples(index=False), strict=True):
        row = dict(zip(frame.columns, cells, strict=True))
        factor = 1.0
        if "unit" in row:
            row["unit"], factor = SHOWN.get(row["unit"], (row["unit"], 1.0))
        shown = (
            _number(factor * value) if isinstance(value, float) else text(value)
            for value in row.values()
        )
        rows.append((str(name), *shown))
    return rows


def _number(value: float) -> str:
    return "-" if math.isnan(value) else written(value)


def in_mm_and_kn(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose columns name their unit: N as kN, m as mm, but coordinates in m."""
    columns = {}
    for title, values in frame.items():
        name, _, unit = str(title).partition(" [")
        shown, factor = SHOWN.get(unit.removesuffix("]"), ("", 1.0))
        if not shown or name.split(" ")[0] in {"x", "y", "z"}:
            columns[str(title)] = values
        else:
            columns[f"{name} [{shown}]"] = factor * values
    return type(frame)(columns, index=frame.index)


PAGE = 118  # letters that a line of a printed table holds
_GAP = 3  # letters between two columns
_WRAPPED = 26  # letters: words that are longer are broken into lines


def in_parts(table: Table, *, keep: int = 1) -> list[Table]:
    """Return a table in parts that fit a page, each with the first columns."""
    sizes = [_size(table, k) for k in range(len(table.head))]
    keep = min(keep, len(table.head))
    kept, count = tuple(range(keep)), 1
    while (groups := _grouped(sizes, keep, count)) and any(
        sum(sizes[:keep]) + sum(sizes[k] for k in group) > PAGE and len(group) > 1
        for group in groups
    ):
        count += 1
    return [_part(table, (*kept, *group)) for group in groups]


def _size(table: Table, column: int) -> int:
    # Letters of a column: heads are broken at blanks, long words of cells as well.
    cells = [row[column] for row in table.rows]
    words = [*table.head[column].split(), *(w for cell in cells for w in cell.split()), ""]
    whole = max((min(len(cell), _WRAPPED) for cell in cells), default=0)
    return max(whole, *(len(word) for word in words)) + _GAP


def _grouped(sizes: Sequence[int], keep: int, count: int) -> list[list[int]]:
    # Columns but the first `keep` in `count` groups of about the same width, in order.
    share = sum(sizes[keep:]) / count
    groups: list[list[int]] = [[] for _ in range(count)]
    before = 0.0
    for k, size in enumerate(sizes[keep:], start=keep):
        groups[min(int((before + 0.5 * size) / share), count - 1)].append(k)
        before += size
    return [group for group in groups if group] or [[]]


def _part(table: Table, columns: Sequence[int]) -> Table:
    return Table(
        [table.head[k] for k in columns],
        [[row[k] for k in columns] for row in table.rows],
        frozenset(place for place, k in enumerate(columns) if k in table.left),
    )
