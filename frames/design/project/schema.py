"""What a project's file holds: sections, keys, units and defaults."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self, Union

from pydantic import Field, create_model, field_validator, model_validator

from frames.design.codes.registry import MOST_IMPORTANT, DesignCode, known_codes
from frames.design.hazard.code_rules import canonical
from frames.design.project.derived import DerivedTable, Table, table_of
from frames.design.project.quantities import (
    Acceleration,
    AreaMass,
    Eccentricity,
    Force,
    Length,
    Mass,
    NotNegative,
    Positive,
    Pressure,
    Ratio,
    Stiffness,
    Time,
    quantity,
)
from lir_element import LIRBearing

Pair = tuple[Ratio, Ratio]
Size = Annotated[Length, Positive]
Count = Annotated[int, Field(ge=1)]


class ProjectTable(Table):
    """``[project]``: its name, the standard that it is designed by, Python files that extend it."""

    name: str = Field(min_length=1)
    code: str
    extensions: tuple[str, ...] = ()


class MomentFrame(Table):
    """``[structure]`` of kind "moment frame": a regular frame, a bearing under each column."""

    kind: Literal["moment frame"]
    bays: tuple[Count, Count]
    bay_width: tuple[Size, Size]
    storeys: int = Field(ge=1)
    storey_height: Size
    floor_load: Annotated[AreaMass, Positive]
    eccentricity: tuple[Eccentricity, Eccentricity] = (0.0, 0.0)


class ShearBuilding(Table):
    """``[structure]`` of kind "shear building": rigid floors on storey springs, which tilt."""

    kind: Literal["shear building"]
    bays: tuple[Count, Count]
    bay_width: tuple[Size, Size]
    storey_mass: tuple[Annotated[Mass, Positive], ...] = Field(min_length=1)
    storey_stiffness: tuple[Annotated[Stiffness, Positive], ...] = Field(min_length=1)
    storey_height: Size
    base_mass: Annotated[Mass, NotNegative] | None = None
    eccentricity: tuple[Eccentricity, Eccentricity] = (0.0, 0.0)


class OpenSeesModel(Table):
    """``[structure]`` of kind "opensees": a script that builds a model with OpenSeesPy."""

    kind: Literal["opensees"]
    script: Path
    base_nodes: tuple[int, ...] = Field(min_length=1)
    length_unit: Size = 1.0
    force_unit: Annotated[Force, Positive] = 1.0


Structure = Annotated[MomentFrame | ShearBuilding | OpenSeesModel, Field(discriminator="kind")]


class SuperstructureTable(Table):
    """``[superstructure]``: what design formulas need of it besides the model."""

    R: float = Field(gt=0.0)
    importance: float = Field(default=1.0, gt=0.0, le=MOST_IMPORTANT)
    wind_shear: Annotated[Force, NotNegative] = 0.0


class Bearing(table_of(LIRBearing)):  # type: ignore[misc]  # its keys are the fields
    """``[bearing]``: the LIR-DCFP under each column; arguments of `lir_element.LIRBearing`."""


class SpectrumTable(Table):
    """``[spectrum]``: the keys of the project's code."""

    code: str


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

    @field_validator("scale")
    @classmethod
    def _scale(cls, scale: str | float) -> str | float:
        if not isinstance(scale, str) and not 0.0 < scale < math.inf:
            msg = 'must be "spectrum", or a factor on the accelerations above 0'
            raise ValueError(msg)
        return scale


class Bounds(Table):
    """``[bounds]``: factors on friction, lower and upper; the interface's own if given."""

    friction: Pair
    interface: Pair | None = None


class Limits(Table):
    """``[limits]``: what the engineer allows; the fields of `frames.DesignLimits`."""

    margin: float | None = None
    rim_strength: Force | None = None
    rims_together: bool | None = None
    eccentricity: float | None = None
    interface_pressure: Pressure | None = None
    liner_pressure: Pressure | None = None
    lateral_force: Force | None = None
    slip_left: Length | None = None
    uplift_gap: Length | None = None
    rim_height: Length | None = None
    axial_force: Force | None = None
    floor_acceleration: Acceleration | None = None
    drift: Ratio | None = None
    base_shear: Force | None = None
    displacement_left: Length | None = None
    rim_engagement: Ratio | None = None


class Target(Table):
    """``[design]``: what ``lir design`` chooses from; fields of `frames.DesignTarget`."""

    radii: tuple[Length, ...] | None = None
    frictions: tuple[Ratio, ...] | None = None
    rim_share: Ratio | None = None
    pressure: Pressure | None = None
    largest_pressure: Pressure | None = None
    least_pressure: Pressure | None = None
    max_displacement: Length | None = None
    max_base_shear: Ratio | None = None
    max_plan_diameter: Length | None = None


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "contact"
    dt: Annotated[Time, Positive] | None = None
    workers: int | None = Field(default=None, ge=1)
    bounds: tuple[Literal["lower", "nominal", "upper"], ...] = ("lower", "nominal", "upper")
    uplift_allowed: bool | None = None
    least_gap: Length | None = None
    histories: Literal["governing", "all"] = "governing"


class ProjectFile(Table):
    """A whole file."""

    project: ProjectTable
    structure: Structure
    superstructure: SuperstructureTable | None = None
    bearing: Bearing | None = None
    spectrum: SpectrumTable
    motions: Motions
    bounds: Bounds
    limits: Limits = Limits()
    design: Target = Target()
    analysis: Analysis = Analysis()

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
                    data = data | {"spectrum": {"code": about["code"]} | given}
        return data


def project_file() -> type[ProjectFile]:
    """Return the class of a whole file: the keys of ``[spectrum]`` are those of its code.

    Returns
    -------
    type
        A `ProjectFile` that knows the codes that are registered.
    """
    bearing: Any = bearing_table()
    return _file_of(known_codes(), bearing)


def bearing_table() -> type[Bearing]:
    """Return the class of ``[bearing]``: its friction is of any law that is known now."""
    return _bearing_of(table_of(LIRBearing))


@cache
def _bearing_of(table: type[DerivedTable]) -> type[Bearing]:
    key = table.model_fields["friction"]
    kind: Any = key.annotation
    return create_model("Bearing", __base__=Bearing, __doc__=Bearing.__doc__, friction=(kind, key))


@cache
def _file_of(codes: tuple[DesignCode, ...], bearing: Any) -> type[ProjectFile]:
    names = tuple(code.name for code in codes)
    literal: Any = Literal[names]
    about = create_model("ProjectTable", __base__=ProjectTable, code=(literal, ...))
    tables = tuple(_spectrum_of(code) for code in codes)
    spectra: Any = tables[0]
    if len(tables) > 1:
        spectra = Annotated[Union[tables], Field(discriminator="code")]  # noqa: UP007
    return create_model(
        "ProjectFile",
        __base__=ProjectFile,
        project=(about, ...),
        bearing=(bearing | None, None),
        spectrum=(spectra, ...),
    )


def _spectrum_of(code: DesignCode) -> type[SpectrumTable]:
    keys: dict[str, Any] = {"code": (Literal[code.name], ...)}
    for name, key in code.spectrum_keys.items():
        kind: Any = key.kind
        if kind is float and key.unit:
            kind = Annotated[quantity(key.unit), Positive]
        default: Any = ... if key.default is None else key.default
        plain = key.kind is float and not key.unit
        rule = Field(default, gt=0.0, le=key.most) if plain else Field(default)
        keys[name] = (kind, rule)
    said = f"``[spectrum]`` of {code.name}."
    return create_model(f"Spectrum, {code.name}", __base__=SpectrumTable, __doc__=said, **keys)
