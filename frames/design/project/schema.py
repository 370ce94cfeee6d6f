"""Contents of a project's file: its sections, each of a module of its own (``schema_...``)."""

from __future__ import annotations

import datetime
import math
import re
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self, Union

from pydantic import BeforeValidator, Field, create_model, field_validator, model_validator

from frames._csv import csv_lines
from frames.design._errors import ProjectError
from frames.design.codes.history_rules import MOST_ECCENTRIC, HistoryRules
from frames.design.codes.registry import DesignCode, code_named, known_codes
from frames.design.devices.limits import DesignLimits
from frames.design.hazard.code_rules import canonical
from frames.design.project.derived import Table, WholeFile, key_of, table_of
from frames.design.project.quantities import (
    Acceleration,
    NotNegative,
    Positive,
    Ratio,
    Speed,
    Time,
    quantity,
)
from frames.design.project.schema_bearing import (
    Bearing,
    BearingType,
    Bounds,
    DamperTable,
    MoatTable,
    bearing_table,
    bearing_type_table,
    completed,
)
from frames.design.project.schema_structure import (
    Structure,
    SuperstructureTable,
)
from frames.design.project.structure_loads import LoadsTable
from frames.design.sizing.target import DesignTarget
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
        msg = (
            f"[spectrum] points = {path.name}: {cause.strerror}: name a CSV file in the folder "
            "of the "
        )
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
    # Units of accelerations, from the head of their column.
    words = [re.fullmatch(r"\s*(.*?)\s*\[(.*)\]\s*", cell) for cell in head]
    names = [(word[1].lower(), word[2].strip()) if word else ("", "") for word in words]
    if len(names) != 2 or names[0] != ("period", "s") or names[1][0] != "acceleration":
        msg = f'{path.name} begins with "{",".join(head)}": its first line must be "{_HEAD}"'
        raise ProjectError(msg)
    unit = names[1][1].lower()
    if unit not in _UNITS:
        msg = f"{path.name}: accelerations are in {names[1][1]}: write them in {', '.join(_UNITS)}"
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
"""End of the tag of a spectrum given point by point; messages leave this part out."""


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


class Pulses(Table):
    """``pulses``: near-fault pulses along x, one of each shape, period and peak velocity."""

    periods: tuple[Annotated[Time, Positive], ...] = ()
    period_ratios: tuple[Annotated[Ratio, Positive], ...] = ()
    velocities: tuple[Annotated[Speed, Positive], ...] = Field(min_length=1)
    shapes: tuple[Literal["symmetric", "antisymmetric"], ...] = Field(("symmetric",), min_length=1)
    cycles: float = Field(default=2.0, gt=1.0)

    @model_validator(mode="after")
    def _periods_or_ratios(self) -> Self:
        if bool(self.periods) == bool(self.period_ratios):
            msg = 'needs periods = ["1.5 s", "3 s"], or period_ratios = [0.5, 1], over the period '
            raise ValueError(msg + "of the sliding bearing: write one of both")
        return self


class Repeated(Table):
    """``repeated``: a second shock behind each motion."""

    factors: tuple[Annotated[Ratio, NotNegative], ...] = Field(min_length=1)
    following: Literal["same", "next"] = "same"
    gap: Annotated[Time, NotNegative] = 10.0


_Records = Literal["far-field", "near-fault pulse", "near-fault no pulse"]


def _one_or_more(given: object) -> object:
    return (given,) if isinstance(given, str) else given


class MotionSource(Table):
    """Records from a folder with a table, a set ready by name, or pulses; how they are varied."""

    folder: Path | None = None
    table: str = "motions.csv"
    fema_p695: Annotated[tuple[_Records, ...], BeforeValidator(_one_or_more)] = ()
    pulses: Pulses | None = None
    fault_normal: bool = False
    only: tuple[str, ...] = ()
    turned: tuple[float, ...] = ()
    vertical: tuple[Literal["with", "without"], ...] = ("with",)
    repeated: Repeated | None = None

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        given = [self.folder, self.fema_p695 or None, self.pulses]
        if given.count(None) != len(given) - 1:
            msg = 'needs one source: folder = "motions", fema_p695 = "far-field", or pulses = '
            raise ValueError(msg + '{periods = ["3 s"], velocities = ["1 m/s"]}')
        return self

    @field_validator("turned", "vertical", "fema_p695")
    @classmethod
    def _each_once(cls, given: tuple[Any, ...]) -> tuple[Any, ...]:
        if len({*given}) < len(given):
            msg = f"{list(given)} has a value twice: leave one out"
            raise ValueError(msg)
        return given


class Motions(MotionSource):
    """``[motions]``: the records, and how they are scaled."""

    scale: Literal["spectrum"] | float = "spectrum"

    @model_validator(mode="before")
    @classmethod
    def _pulses_as_they_are(cls, given: object) -> object:
        if isinstance(given, dict) and given.get("pulses"):
            if given.get("scale") == "spectrum":
                msg = (
                    'scale = "spectrum" does not apply to pulses, which have given velocities: '
                    "leave scale out"
                )
                raise ValueError(msg)
            return {"scale": 1.0, **given}
        return given

    @field_validator("scale", mode="before")
    @classmethod
    def _scale(cls, scale: object) -> object:
        is_number = isinstance(scale, (int, float)) and not isinstance(scale, bool)
        if scale != "spectrum" and not (is_number and 0.0 < float(str(scale)) < math.inf):
            msg = 'must be "spectrum" or a positive factor on accelerations: write "spectrum" or 1'
            raise ValueError(msg)
        return scale


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "contact"
    dt: Annotated[Time, Positive] | None = None
    workers: int | None = Field(default=None, ge=1)
    bounds: tuple[Literal["lower", "nominal", "upper"], ...] = Field(
        default=("lower", "nominal", "upper"), min_length=1
    )
    uplift_allowed: bool | None = None
    least_gap: key_of(HistoryRules, "least_gap") | None = None  # type: ignore[valid-type]  # made
    nonstructural: str | None = None
    histories: Literal["governing", "all"] = "governing"
    accidental_eccentricity: Ratio | Literal["none"] | None = None
    accidental_eccentricity_motions: Literal["governing", "all"] = "governing"

    @field_validator("bounds")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) < len(names):
            msg = 'must have each bound once: write ["lower", "nominal", "upper"] for all'
            raise ValueError(msg)
        return names

    @field_validator("accidental_eccentricity")
    @classmethod
    def _eccentricity(cls, share: float | str | None) -> float | str | None:
        if isinstance(share, float) and not 0.0 <= share <= MOST_ECCENTRIC:
            msg = (
                f"must be a share of the plan's sides between 0 and {MOST_ECCENTRIC:g}, or none: "
                'write "5 %" or "none"'
            )
            raise ValueError(msg)
        return share


class Limits(table_of(DesignLimits)):  # type: ignore[misc]  # its keys are the fields
    """``[limits]``: limits of the engineer; the fields of `frames.DesignLimits`."""


class Target(table_of(DesignTarget)):  # type: ignore[misc]  # its keys are the fields
    """``[design]``: choices of ``lir design``; fields of `frames.DesignTarget`."""

    frictions: tuple[Ratio, ...] = ()  # as `lir design` writes them


class ProjectTable(Table):
    """``[project]``: name and standard, Python files that extend it, people and date, language."""

    name: str = Field(min_length=1)
    code: str
    extensions: tuple[str, ...] = ()
    client: str = ""
    engineer: str = ""
    checker: str = ""
    revision: str = ""
    date: datetime.date | str = ""
    language: Literal["en", "es"] = "en"
    decimal: Literal[".", ","] = "."


class ProjectFile(WholeFile):
    """A whole file."""

    project: ProjectTable
    structure: Structure
    loads: LoadsTable | None = None
    moat: MoatTable | None = None
    dampers: dict[str, DamperTable] = Field(default_factory=dict)
    superstructure: SuperstructureTable | None = None
    bearing: Bearing | None = None
    bearings: dict[str, BearingType] = Field(default_factory=dict)
    spectrum: SpectrumTable
    motions: Motions
    bounds: Bounds
    limits: Limits = Limits()
    design: Target = Target()
    analysis: Analysis = Analysis()

    @model_validator(mode="after")
    def _clear_as_far_as_the_wall(self) -> Self:
        clear, wall = self.limits.moat_gap, self.moat
        if wall is not None and clear is not None and clear > wall.gap:
            msg = (
                f"[limits] moat_gap = {1e3 * clear:.5g} mm must not exceed [moat] gap = "
                f"{1e3 * wall.gap:.5g} mm, or wall contacts in the runs would count as "
                "clear: reduce moat_gap, or leave it out"
            )
            raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _reduced_as_the_code_has_it(self) -> Self:
        above, code = self.superstructure, code_named(self.project.code)
        if above is not None and above.R is None and "R" not in code.unread:
            msg = (
                f"superstructure.R is missing, by which {code.name} divides forces: write R of the "
                "fixed-base structure, R = 2.0"
            )
            raise ValueError(msg)
        return self

    @model_validator(mode="before")
    @classmethod
    def _spectrum_of_its_code(cls, data: object) -> object:
        # The project's code decides which keys its spectrum has.
        if isinstance(data, dict):
            about, given = data.get("project"), data.get("spectrum")
            if isinstance(about, dict) and isinstance(about.get("code"), str):
                about = about | {"code": canonical(about["code"])}
                data = data | {"project": about}
                if isinstance(given, dict):
                    tag = about["code"] + (BY_POINTS if "points" in given else "")
                    data = data | {"spectrum": {"code": tag} | given}
            data = completed(data)
        return data


def project_file() -> type[ProjectFile]:
    """Return the class of a whole file: the keys of ``[spectrum]`` are those of its code."""
    bearing: Any = bearing_table()
    return _file_of(known_codes(), bearing)


@cache
def _file_of(codes: tuple[DesignCode, ...], bearing: Any) -> type[ProjectFile]:
    names = tuple(code.name for code in codes)
    literal: Any = Literal[names]
    about = create_model("ProjectTable", __base__=ProjectTable, code=(literal, ...))
    tables: tuple[type[SpectrumTable], ...] = tuple(
        make(code) for code in codes for make in (spectrum_table, points_table)
    )
    spectra: Any = Annotated[Union[tables], Field(discriminator="code")]  # noqa: UP007
    kind: Any = bearing_type_table(bearing)
    types: Any = dict[str, kind]
    return create_model(
        "ProjectFile",
        __base__=ProjectFile,
        project=(about, ...),
        bearing=(bearing | None, None),
        bearings=(types, Field(default_factory=dict)),
        spectrum=(spectra, ...),
    )
