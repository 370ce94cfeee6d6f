"""A design spectrum given point by point: from a list in a project's file, or a table beside it."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from frames._csv import csv_lines
from frames.design._errors import ProjectError
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from pathlib import Path

Points = tuple[tuple[float, float], ...]

_UNITS = {
    "g": STANDARD_GRAVITY,
    "m/s2": 1.0,
    "m/s^2": 1.0,
    "cm/s2": 0.01,
    "cm/s^2": 0.01,
    "gal": 0.01,
}
_HEAD = "period [s],acceleration [g]"


def read_points(path: Path) -> Points:
    """Return the points of a spectrum from a table of two columns."""
    try:
        lines = csv_lines(path)
    except OSError as cause:
        msg = f"[spectrum] points = {path.name}: {cause.strerror}: name a CSV file beside the "
        raise ProjectError(msg + "project's") from cause
    except ValueError as cause:
        msg = f"[spectrum] points = {path.name}: {cause}"
        raise ProjectError(msg) from cause
    factor = _unit_of(path, lines[0][1] if lines else [])
    found = []
    for k, row in lines[1:]:
        try:
            period, level = map(float, row)
        except ValueError:
            period = math.nan
        if not math.isfinite(period):
            comma = "; numbers with decimal commas need semicolons between" * (len(row) > 2)
            msg = (
                f"{path.name}, line {k}: {','.join(row)} must be two numbers: period, level{comma}"
            )
            raise ProjectError(msg)
        found.append((period, factor * level))
    return tuple(found)


def _unit_of(path: Path, head: list[str]) -> float:
    # Of accelerations, from the head of their column.
    words = [re.fullmatch(r"\s*(.*?)\s*\[(.*)\]\s*", cell) for cell in head]
    names = [(word[1].lower(), word[2].strip()) if word else ("", "") for word in words]
    if len(names) != 2 or names[0] != ("period", "s") or names[1][0] != "acceleration":
        msg = f'{path.name} begins with "{",".join(head)}": its first line must be "{_HEAD}"'
        raise ProjectError(msg)
    unit = names[1][1].lower()
    if unit not in _UNITS:
        msg = f"{path.name}: accelerations in {names[1][1]}: give them in {', '.join(_UNITS)}"
        raise ProjectError(msg)
    return _UNITS[unit]
