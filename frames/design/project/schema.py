"""What a project's file holds: sections, keys, units and defaults."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

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
    SpeedRate,
    Stiffness,
    Time,
)

Pair = tuple[Ratio, Ratio]
Size = Annotated[Length, Positive]
Count = Annotated[int, Field(ge=1)]
CodeName = Literal["ASCE 7-22", "EN 1998", "NCh2745"]


MOST_IMPORTANT = 3.0
"""Largest importance factor [-]; codes have 0.6 to 1.5."""


class Table(BaseModel):
    """A table of the file: no keys but those that it knows."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _no_truth_for_a_number(cls, given: object) -> object:
        for key, value in given.items() if isinstance(given, dict) else ():
            field = cls.model_fields.get(str(key))
            if isinstance(value, bool) and field and "bool" not in str(field.annotation):
                msg = f"{key} = {str(value).lower()} must be a number or a text, not a truth value"
                raise ValueError(msg)
        return given


class ProjectTable(Table):
    """``[project]``: its name, and the standard that it is designed by."""

    name: str = Field(min_length=1)
    code: CodeName


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


class Friction(Table):
    """``friction = {f_max = 0.06, f_min = 0.03, rate = "100 s/m"}``."""

    f_max: Ratio
    f_min: Ratio
    rate: SpeedRate


class Bearing(Table):
    """``[bearing]``: the LIR-DCFP under each column; arguments of `lir_element.LIRBearing`."""

    radius: Length | tuple[Length, Length]
    slider_height: Length
    slider_radius: Length
    capacity: Length
    friction: Ratio | Friction
    interface_friction: Ratio


class Asce7Spectrum(Table):
    """``[spectrum]`` of ASCE 7: MCE_R, accelerations in g as the standard has them."""

    code: Literal["ASCE 7-22"]
    s_ms: float = Field(gt=0.0)
    s_m1: float = Field(gt=0.0)
    t_l: Annotated[Time, Positive] = 8.0


class En1998Spectrum(Table):
    """``[spectrum]`` of EN 1998-1."""

    code: Literal["EN 1998"]
    a_g: Annotated[Acceleration, Positive]
    ground_type: Literal["A", "B", "C", "D", "E"]
    kind: Literal[1, 2] = 1
    importance: float = Field(default=1.0, gt=0.0, le=MOST_IMPORTANT)


class NChSpectrum(Table):
    """``[spectrum]`` of NCh2745."""

    code: Literal["NCh2745"]
    soil: Literal["I", "II", "III"]
    zone: Literal[1, 2, 3]


DesignSpectrum = Annotated[
    Asce7Spectrum | En1998Spectrum | NChSpectrum, Field(discriminator="code")
]


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
    max_displacement: Length | None = None
    max_base_shear: Ratio | None = None
    max_plan_diameter: Length | None = None


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "pendulum"
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
    spectrum: DesignSpectrum
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
            if isinstance(about, dict) and isinstance(given, dict):
                return data | {"spectrum": {"code": about.get("code")} | given}
        return data
