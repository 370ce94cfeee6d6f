"""Contents of ``[structure]`` and ``[superstructure]`` of a project's file."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, field_validator, model_validator

from frames.design.codes.superstructure import Superstructure
from frames.design.project.derived import Table, key_of, table_of
from frames.design.project.quantities import (
    Acceleration,
    AreaMass,
    Eccentricity,
    Force,
    Mass,
    NotNegative,
    Positive,
    Ratio,
    Stiffness,
)
from frames.design.project.schema_sections import (
    BaseBeamsTable,
    BeamsTable,
    BraceTable,
    ColumnsTable,
    Count,
    SectionTable,
    Size,
    WallTable,
    one_or_more,
)

_RESULT_TABLES = """
bearings bench centres checks compare compare-motions demands demands-by-motion eccentricity
equivalent-linear friction links member-combinations member-groups members members-without-forces
modes motions programme provisions reaction-combinations reactions replacement rig schedule
storeys uplift
"""
_RESULT_OTHERS = """
checks.txt compare.html governing.nc interrupted.nc project.toml report.html report.pdf run.json
view.html
"""
RESULT_FILES = frozenset(
    [*(f"{name}.csv" for name in _RESULT_TABLES.split()), *_RESULT_OTHERS.split()]
)
"""Files of fixed names, besides the time histories ``runs-<bound>.nc`` and ``moved-<bound>.nc``."""


_PRESSURE = re.compile(r"N\s*/\s*m|Pa|lbf|psf|kip")


class BuildingTable(Table):
    """Common keys of buildings of columns and beams."""

    floor_load: Annotated[AreaMass, Positive] | None = None
    eccentricity: tuple[Eccentricity, Eccentricity] = (0.0, 0.0)
    damping: Annotated[Ratio, Field(ge=0.0, le=0.2)] = 0.02
    braces: tuple[BraceTable, ...] = ()
    walls: tuple[WallTable, ...] = ()
    floor_diaphragm: Literal["rigid", "flexible"] = "rigid"
    base_diaphragm: Literal["rigid", "flexible"] = "rigid"

    @field_validator("floor_load", mode="before")
    @classmethod
    def _no_pressure(cls, given: object) -> object:
        if isinstance(given, str) and _PRESSURE.search(given):
            msg = (
                'is a pressure, and floor_load a mass, "450 kg/m2": write pressures in [loads], '
                'dead = "4.5 kN/m2"'
            )
            raise ValueError(msg)
        return given


class MomentFrame(BuildingTable):
    """``[structure]`` of kind "moment frame": a regular frame, a bearing under each column."""

    kind: Literal["moment frame"]
    bays: tuple[Count, Count]
    bay_width: tuple[Size, Size]
    storeys: int = Field(ge=1)
    storey_height: one_or_more(Size, "number")  # type: ignore[valid-type]  # made, as below
    columns: one_or_more(ColumnsTable, "ColumnsTable") | None = None  # type: ignore[valid-type]
    beams: one_or_more(BeamsTable, "BeamsTable") | None = None  # type: ignore[valid-type]
    base_beams: one_or_more(BaseBeamsTable, "BaseBeamsTable") | None = None  # type: ignore[valid-type]

    @property
    def heights(self) -> tuple[float, ...]:
        """Height of each storey [m]."""
        each = self.storey_height
        return each if isinstance(each, tuple) else (each,) * self.storeys

    @model_validator(mode="after")
    def _one_height_each(self) -> Self:
        if len(self.heights) != self.storeys:
            msg = (
                f"storey_height has {len(self.heights)} heights for {self.storeys} storeys: write "
                "one for all, or one for each"
            )
            raise ValueError(msg)
        return self


class IrregularFrame(BuildingTable):
    """``[structure]`` of kind "irregular frame": columns and beams from tables.

    The results include both tables under their names, beside the files of a run.
    """

    kind: Literal["irregular frame"]
    storey_height: tuple[Size, ...] = Field(min_length=1)
    columns_table: Path
    beams_table: Path
    sections: dict[str, SectionTable] = Field(default_factory=dict)

    @property
    def heights(self) -> tuple[float, ...]:
        """Height of each storey [m]."""
        return self.storey_height

    @field_validator("columns_table", "beams_table")
    @classmethod
    def _is_no_result(cls, given: Path) -> Path:
        if given.name.lower() in RESULT_FILES:  # would be written over, on any system
            msg = (
                "must not have the name of a file of the results, which are in the same folder: "
                "rename it"
            )
            raise ValueError(msg)
        return given

    @model_validator(mode="after")
    def _two_names(self) -> Self:
        one, other = self.columns_table, self.beams_table
        if one != other and one.name.lower() == other.name.lower():
            msg = (
                f"columns_table and beams_table are both named {one.name}, and are copied to one "
                "folder of results: rename one"
            )
            raise ValueError(msg)
        return self


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

    @model_validator(mode="after")
    def _one_stiffness_each(self) -> Self:
        if len(self.storey_mass) != len(self.storey_stiffness):
            msg = (
                f"storey_mass has {len(self.storey_mass)} entries, storey_stiffness "
                f"{len(self.storey_stiffness)}: write one of each for every storey"
            )
            raise ValueError(msg)
        return self


class OpenSeesModel(Table):
    """``[structure]`` of kind "opensees": a script that builds a model with OpenSeesPy."""

    kind: Literal["opensees"]
    script: Path
    base_nodes: tuple[int, ...] = Field(min_length=1)
    length_unit: Size = 1.0
    force_unit: Annotated[Force, Positive] = 1.0
    vertical: Literal["y", "z"] | None = None
    base_rotations: Literal["kept", "free", "fixed"] = "kept"
    base_diaphragm: bool = True
    gravity: Annotated[Acceleration, Positive] | None = None
    damping: bool = True
    other_supports: tuple[int, ...] = ()
    accept_nonlinear: bool = False
    vertical_mass: Literal["horizontal"] | None = None


class ImportedModel(Table):
    """``[structure]`` of kind "sap2000" or "etabs": a model of those programs, as text tables."""

    kind: Literal["sap2000", "etabs"]
    file: Path
    bearings_at: tuple[str, ...] = ()
    loads: dict[str, float] | str = "all"
    mass: dict[str, float] | None = None
    allow: tuple[str, ...] = ()
    mesh: Size = 1.25
    base_rotations: Literal["kept", "free", "fixed"] = "kept"
    base_diaphragm: bool = True
    decimal: Literal[".", ","] = "."
    sections: dict[str, SectionTable] = Field(default_factory=dict)
    library: tuple[Path, ...] = ()

    @model_validator(mode="after")
    def _sections_of_etabs(self) -> Self:
        for word, given in (("sections", self.sections), ("library", self.library)):
            if given and self.kind != "etabs":
                msg = (
                    f"{word} is for ETABS files without section constants, and SAP2000 files have "
                    "them: leave it out"
                )
                raise ValueError(msg)
        return self


Structure = Annotated[
    MomentFrame | IrregularFrame | ShearBuilding | OpenSeesModel | ImportedModel,
    Field(discriminator="kind"),
]


_OF_FILE = ("importance", "wind_shear", "service_displacement")


class SuperstructureTable(table_of(Superstructure, *_OF_FILE)):  # type: ignore[misc]  # its keys
    """``[superstructure]``: values for design formulas that the model does not have."""

    R: key_of(Superstructure, "R") | None = None  # type: ignore[valid-type]  # made
