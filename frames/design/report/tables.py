"""Tables for people: numbers of four digits, or whole ones, in mm and kN by their unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.rendering import number as written

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd

_NAME = 18  # letters of a name that stays on one line
_SHOWN = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "N m": ("kN m", 1e-3)}


class Table(NamedTuple):
    """A table of a page: cells as text, the first column and those named to the left."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: frozenset[int] = frozenset()

    @property
    def short(self) -> bool:
        """Whether the first column has names alone, which are not broken into lines."""
        return all(len(row[0]) <= _NAME for row in self.rows)


def rows_of(frame: pd.DataFrame, text: Callable[[object], str] = str) -> list[tuple[str, ...]]:
    """Return the rows of a table as text, each after its name."""
    rows = []
    for name, cells in zip(frame.index, frame.itertuples(index=False), strict=True):
        row = dict(zip(frame.columns, cells, strict=True))
        factor = 1.0
        if "unit" in row:
            row["unit"], factor = _SHOWN.get(row["unit"], (row["unit"], 1.0))
        shown = (
            _number(factor * value) if isinstance(value, float) else text(value)
            for value in row.values()
        )
        rows.append((str(name), *shown))
    return rows


def _number(value: float) -> str:
    return "-" if math.isnan(value) else written(value)


def in_mm_and_kn(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose columns name their unit with those in N as kN, in m as mm."""
    columns = {}
    for title, values in frame.items():
        name, _, unit = str(title).partition(" [")
        shown, factor = _SHOWN.get(unit.removesuffix("]"), ("", 1.0))
        if not shown or name in {"x", "y"}:
            columns[str(title)] = values
        else:
            columns[f"{name} [{shown}]"] = factor * values
    return type(frame)(columns, index=frame.index)
