"""The checks of a run, read again from the table among its results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from frames.design._errors import ProjectError
from frames.design.calculation.check import Check, Checks
from frames.design.calculation.standing import standing_of
from frames.results.storage import from_text

if TYPE_CHECKING:
    from pathlib import Path

_TEXTS = (
    "clause",
    "title",
    "symbol",
    "unit",
    "relation",
    "standing",
    "bound",
    "subject",
    "note",
    "void",
    "level",
)
_SHOWN = {"m": "mm"}


def read_checks(folder: Path) -> Checks:
    """Return the checks that ``checks.csv`` holds, without their calculations."""
    path = folder / "checks.csv"
    if not path.is_file():
        msg = f"{path} is missing: `lir report` writes it from the histories of the run"
        raise ProjectError(msg)
    try:
        table = pd.read_csv(path, dtype=dict.fromkeys(_TEXTS, str), keep_default_na=False)
    except (OSError, ValueError) as cause:
        msg = f"{path} cannot be read ({cause}): `lir report` writes it anew"
        raise ProjectError(msg) from cause
    missing = sorted({*_TEXTS, "demand", "limit", "verdict"} - {*map(str, table.columns)})
    if missing:
        msg = f"{path} has no column {', '.join(missing)}: `lir report` writes it anew"
        raise ProjectError(msg)
    return Checks(_check(row) for row in table.to_dict("records"))


def _check(row: dict[Any, Any]) -> Check:
    texts = {name: from_text(row[name]) for name in _TEXTS}
    beyond = {
        "does not apply": "procedure",
        "needs agreement": "agreement",
        "raised": "minimum",
    }
    scope = beyond.get(row["verdict"], "any")
    shown = _SHOWN.get(row["unit"], "")
    numbers = {name: float(row[name]) for name in ("demand", "limit")}
    texts["standing"] = standing_of(row["standing"])
    return Check(**texts, **numbers, scope=scope, shown=shown)  # type: ignore[arg-type]  # Check judges them
