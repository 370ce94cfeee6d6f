"""What ``[spectrum]`` and ``[motions]`` of a project's file hold."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, create_model, field_validator, model_validator

from frames.design.codes.registry import DesignCode
from frames.design.project.derived import Table
from frames.design.project.quantities import Acceleration, Positive, Time, quantity


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
