"""What ``[spectrum]`` and ``[motions]`` of a project's file hold."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, create_model, field_validator, model_validator

from frames._csv import csv_lines
from frames.design._errors import ProjectError
from frames.design.codes.registry import DesignCode
from frames.design.project.derived import Table
from frames.design.project.quantities import Acceleration, Positive, Time, quantity
from lir_element.units import STANDARD_GRAVITY

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


class SpectrumTable(Table):
    """``[spectrum]``: the keys of the project's code."""

    code: str


def spectrum_table(code: DesignCode) -> type[SpectrumTable]:
    """Return the class of ``[spectrum]`` of a code: its keys are those that the code names."""
    keys: dict[str, Any] = {"code": (Literal[code.name], ...)}
    for name, key in code.spectrum_keys.items():
        kind: Any = key.kind
        if kind is float and key.unit:
            kind = Annotated[quantity(key.unit), Positive]
        default: Any = ... if key.default is None else key.default
        plain = key.kind is float and not key.unit
        rule = Field(default, gt=0.0, le=key.most) if plain else Field(default)
        if key.optional:
            kind, rule = Annotated[kind, Field(gt=0.0, le=key.most)] | None, Field(None)
        keys[name] = (kind, rule)
    said = f"``[spectrum]`` of {code.name}."
    return create_model(f"Spectrum, {code.name}", __base__=SpectrumTable, __doc__=said, **keys)


BY_POINTS = " [points]"
"""Ends the tag of a spectrum that is given point by point; messages leave such parts out."""


class PointsTable(SpectrumTable):
    """``[spectrum]`` point by point: from a list or a table, for any code."""

    points: Path | Annotated[tuple[tuple[Time, Acceleration], ...], Field(min_length=2)]

    @field_validator("points", mode="before")
    @classmethod
    def _points(cls, points: object) -> object:
        if not isinstance(points, (str, list, tuple, Path)):
            msg = 'must be a file, "spectrum.csv", or a list of points, [["0.5 s", "1.2 g"], ...]'
            raise ValueError(msg)
        return points


def points_table(code: DesignCode) -> type[PointsTable]:
    """Return the class of ``[spectrum]`` with points, of a code."""
    keys: dict[str, Any] = {"code": (Literal[code.name + BY_POINTS], ...)}
    for name, key in code.points_keys.items():
        kind: Any = Annotated[quantity(key.unit), Positive]
        keys[name] = (kind | None, Field(None))
    said = f"``[spectrum]`` of {code.name}, point by point."
    return create_model(f"Points, {code.name}", __base__=PointsTable, __doc__=said, **keys)


class MotionSource(Table):
    """Records from a folder with a table, PEER files, or a set ready by name."""

    folder: Path | None = None
    table: str = "motions.csv"
    fema_p695: Literal["far-field", "near-fault pulse", "near-fault no pulse"] | None = None
    fault_normal: bool = False
    only: tuple[str, ...] = ()

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.folder is None) == (self.fema_p695 is None):
            msg = 'needs one source: folder = "motions", or fema_p695 = "far-field"'
            raise ValueError(msg)
        return self


class Motions(MotionSource):
    """``[motions]``: the records, and how they are scaled."""

    scale: Literal["spectrum"] | float = "spectrum"

    @field_validator("scale", mode="before")
    @classmethod
    def _scale(cls, scale: object) -> object:
        is_number = isinstance(scale, (int, float)) and not isinstance(scale, bool)
        if scale != "spectrum" and not (is_number and 0.0 < float(str(scale)) < math.inf):
            msg = 'must be "spectrum", or a factor on the accelerations above 0'
            raise ValueError(msg)
        return scale
