"""Numbers of a study as they are kept: rounded in JSON, in SI in tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

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


def written(rows: Sequence[Mapping[str, Any]], file: Path) -> None:
    """Write rows as a CSV file, numbers rounded."""
    file.parent.mkdir(exist_ok=True)
    frame = pd.DataFrame([rounded(dict(row)) for row in rows])
    frame.to_csv(file, index=False, lineterminator="\n")
