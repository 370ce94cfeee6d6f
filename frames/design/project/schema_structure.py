"""What ``[structure]`` and ``[superstructure]`` of a project's file hold."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from frames.design.codes.registry import MOST_IMPORTANT
from frames.design.project.derived import Table
from frames.design.project.quantities import (
    AreaMass,
    Eccentricity,
    Force,
    Mass,
    NotNegative,
    Positive,
    Stiffness,
)
from frames.design.project.schema_sections import BaseBeams, Beams, Columns, Count, Size


class MomentFrame(Table):
    """``[structure]`` of kind "moment frame": a regular frame, a bearing under each column."""

    kind: Literal["moment frame"]
    bays: tuple[Count, Count]
    bay_width: tuple[Size, Size]
    storeys: int = Field(ge=1)
    storey_height: Size
    floor_load: Annotated[AreaMass, Positive]
    columns: Columns | None = None
    beams: Beams | None = None
    base_beams: BaseBeams | None = None
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
