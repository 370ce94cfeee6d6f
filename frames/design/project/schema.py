"""What a project's file holds: its sections, each of a module of its own (``schema_...``)."""

from __future__ import annotations

import datetime
from functools import cache
from typing import Annotated, Any, Literal, Self, Union

from pydantic import Field, create_model, field_validator, model_validator

from frames.design.codes.history_rules import MOST_ECCENTRIC
from frames.design.codes.registry import DesignCode, code_named, known_codes
from frames.design.devices.limits import DesignLimits
from frames.design.hazard.code_rules import canonical
from frames.design.project.derived import Table, WholeFile, table_of
from frames.design.project.quantities import Length, Positive, Ratio, Time
from frames.design.project.schema_bearing import Bearing as Bearing
from frames.design.project.schema_bearing import BearingType as BearingType
from frames.design.project.schema_bearing import Bounds as Bounds
from frames.design.project.schema_bearing import DamperTable as DamperTable
from frames.design.project.schema_bearing import MoatTable as MoatTable
from frames.design.project.schema_bearing import bearing_table as bearing_table
from frames.design.project.schema_bearing import bearing_type_table, completed
from frames.design.project.schema_hazard import BY_POINTS, points_table, spectrum_table
from frames.design.project.schema_hazard import Motions as Motions
from frames.design.project.schema_hazard import MotionSource as MotionSource
from frames.design.project.schema_hazard import SpectrumTable as SpectrumTable
from frames.design.project.schema_structure import ImportedModel as ImportedModel
from frames.design.project.schema_structure import IrregularFrame as IrregularFrame
from frames.design.project.schema_structure import MomentFrame as MomentFrame
from frames.design.project.schema_structure import OpenSeesModel as OpenSeesModel
from frames.design.project.schema_structure import ShearBuilding as ShearBuilding
from frames.design.project.schema_structure import Structure as Structure
from frames.design.project.schema_structure import SuperstructureTable as SuperstructureTable
from frames.design.project.structure_loads import LoadsTable as LoadsTable
from frames.design.sizing.target import DesignTarget


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "contact"
    dt: Annotated[Time, Positive] | None = None
    workers: int | None = Field(default=None, ge=1)
    bounds: tuple[Literal["lower", "nominal", "upper"], ...] = Field(
        default=("lower", "nominal", "upper"), min_length=1
    )
    uplift_allowed: bool | None = None
    least_gap: Length | None = None
    nonstructural: str | None = None
    histories: Literal["governing", "all"] = "governing"
    accidental_eccentricity: Ratio | Literal["none"] | None = None
    accidental_eccentricity_motions: Literal["governing", "all"] = "governing"

    @field_validator("bounds")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) < len(names):
            msg = 'must name each bound once: ["lower", "nominal", "upper"] are all'
            raise ValueError(msg)
        return names

    @field_validator("accidental_eccentricity")
    @classmethod
    def _eccentricity(cls, share: float | str | None) -> float | str | None:
        if isinstance(share, float) and not 0.0 <= share <= MOST_ECCENTRIC:
            msg = (
                f"must be a share of the sides of the plan between 0 and {MOST_ECCENTRIC:g}, such "
                'as "5 %", or "none"'
            )
            raise ValueError(msg)
        return share


class Limits(table_of(DesignLimits)):  # type: ignore[misc]  # its keys are the fields
    """``[limits]``: what the engineer allows; the fields of `frames.DesignLimits`."""


class Target(table_of(DesignTarget)):  # type: ignore[misc]  # its keys are the fields
    """``[design]``: what ``lir design`` chooses from; fields of `frames.DesignTarget`."""

    frictions: tuple[Ratio, ...] = ()  # as `lir design` writes them


class ProjectTable(Table):
    """``[project]``: its name and standard, Python files that extend it, who and when, language."""

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
                f"[limits] moat_gap = {1e3 * clear:.5g} mm is more than [moat] gap = "
                f"{1e3 * wall.gap:.5g} mm: what meets the wall in the runs would be called clear "
                f"of it; give {1e3 * wall.gap:.5g} mm at most, or leave moat_gap out"
            )
            raise ValueError(msg)
        return self

    @model_validator(mode="after")
    def _reduced_as_the_code_has_it(self) -> Self:
        above, code = self.superstructure, code_named(self.project.code)
        if above is not None and above.R is None and "R" not in code.unread:
            msg = (
                f"superstructure.R is missing: {code.name} divides forces by it, R = 2.0; of the "
                "structure on a fixed base"
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
