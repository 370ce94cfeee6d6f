"""Numbers of a study as they are kept: rounded in JSON, in SI in tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

DIGITS = 5


def rounded(value: Any, digits: int = DIGITS) -> Any:
    """Return nested mappings and lists with all numbers rounded to significant digits."""
    if isinstance(value, dict):
        return {key: rounded(each, digits) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(each, digits) for each in value]
    if isinstance(value, float):
        return float(f"{value:.{digits}g}")
    return value


def csv_of(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows as CSV, numbers rounded."""
    frame = pd.DataFrame([rounded(dict(row)) for row in rows])
    return str(frame.to_csv(index=False, lineterminator="\n"))


def with_interval(values: Sequence[float] | None, digits: int = 2, factor: float = 1.0) -> str:
    """Return a value with its interval as text; a dash where there is none."""
    if values is None:
        return "-"
    one, low, high = (f"{factor * v:.{digits}f}" for v in values[:3])
    return f"{one} ({low} to {high})"
