"""Tables of members in a project's file: sections, materials, storeys."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from frames.design.project.derived import Table, key_of, table_of
from frames.design.project.quantities import (
    Density,
    Length,
    Positive,
    Pressure,
    Ratio,
)
from frames.model.laws import PlasticHinge
from frames.model.sections import Section

Size = Annotated[Length, Positive]
Count = Annotated[int, Field(ge=1)]

SHAPES = ("section", "box", "rectangle", "circle", "i_shape", "properties")
"""Alternatives for a cross-section; a table has one."""


def one_or_more(kind: Any, name: str) -> Any:
    """Return the type of one value or a list of them, distinguished by tags of this name."""
    one, more = f"[{name}]", f"[[{name}]]"
    ways = Annotated[kind, Tag(one)] | Annotated[tuple[kind, ...], Tag(more), Field(min_length=1)]
    told = Discriminator(lambda given: more if isinstance(given, (list, tuple)) else one)
    return Annotated[ways, told]


def _listed(given: object) -> object:
    return [given] if isinstance(given, (str, int, float)) else given


class MaterialTable(Table):
    """A material by its numbers: E, G or Poisson's ratio nu, density."""

    E: Annotated[Pressure, Positive]
    nu: Annotated[Ratio, Field(ge=0.0, lt=0.5)] | None = None
    G: Annotated[Pressure, Positive] | None = None
    density: Density

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if (self.nu is None) == (self.G is None):
            msg = "needs one of nu and G: write nu = 0.2 for concrete, nu = 0.3 for steel"
            raise ValueError(msg)
        return self


Material = Annotated[
    Annotated[str, Tag("[name]")] | Annotated[MaterialTable, Tag("[MaterialTable]")],
    Discriminator(lambda v: "[name]" if isinstance(v, str) else "[MaterialTable]"),
]
"""A material by name, "S355", "A992", "C30/37", or by its numbers."""


class CrackedTable(Table):
    """Factors on the stiffness of a section of cracked concrete."""

    bending: Ratio
    torsion: Ratio | None = None
    shear: Ratio | None = None

    @property
    def factors(self) -> tuple[float, float | None, float | None]:
        """Factors on bending, torsion and shear; None is that of bending."""
        return self.bending, self.torsion, self.shear


Cracked = Annotated[
    Annotated[Ratio, Tag("[number]")] | Annotated[CrackedTable, Tag("[CrackedTable]")],
    Discriminator(lambda v: "[CrackedTable]" if isinstance(v, (dict, Table)) else "[number]"),
]
"""One factor on bending, torsion and shear, or one for each."""


_CONSTANTS = ("area", "inertia_y", "inertia_z", "torsion_constant", "shear_area_y", "shear_area_z")


class PropertiesTable(table_of(Section, *_CONSTANTS)):  # type: ignore[misc]  # its keys
    """A cross-section by its constants, as `frames.Section` names them."""

    shear_area_y: key_of(Section, "shear_area_y") | None = None  # type: ignore[valid-type]  # made
    shear_area_z: key_of(Section, "shear_area_z") | None = None  # type: ignore[valid-type]  # made


class SectionTable(Table):
    """A cross-section in one of its alternatives, and its material."""

    section: str | None = None
    box: tuple[Size, ...] | None = Field(default=None, min_length=2, max_length=3)
    rectangle: tuple[Size, Size] | None = None
    circle: Annotated[
        tuple[Size, ...] | None,
        BeforeValidator(_listed),
        Field(min_length=1, max_length=2),
    ] = None
    i_shape: tuple[Size, Size, Size, Size] | None = None
    properties: PropertiesTable | None = None
    material: Material | None = None
    cracked: Cracked | None = None
    depth_along: Literal["x", "y"] | None = None

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        given = [name for name in SHAPES if getattr(self, name) is not None]
        if len(given) != 1:
            what = f"has {' and '.join(given)}: write one of them" if given else "has no section"
            msg = f'{what}: section = "HEB 300", box = ["400 mm", "25 mm"], ' + (
                'rectangle = ["500 mm", "700 mm"], circle, i_shape or properties'
            )
            raise ValueError(msg)
        if self.material is None and given[0] in {"rectangle", "circle", "properties"}:
            msg = (
                f'{given[0]} needs its material: write material = "C30/37", or {{ E, nu, density }}'
            )
            raise ValueError(msg)
        if self.depth_along is not None and given[0] in {"rectangle", "circle"}:
            msg = (
                f"depth_along has no effect on {given[0]}, whose sides are along x and y: leave "
                "it out"
            )
            raise ValueError(msg)
        return self


class HingesTable(table_of(PlasticHinge)):  # type: ignore[misc]  # its keys are the fields
    """``hinges``: plastic hinges at the ends of members; moments as given, or of a yield stress."""

    beside: ClassVar[frozenset[str]] = frozenset({"yield_stress", "ends"})
    yield_stress: Annotated[Pressure, Positive] | None = None
    ends: Literal["both", "foot"] = "both"

    @model_validator(mode="after")
    def _one_strength(self) -> Self:
        moments = {"moment_y", "moment_z"} & self.model_fields_set
        if (self.yield_stress is None) != bool(moments):
            msg = (
                'must have either yield_stress = "345 MPa", or moment_y and moment_z = "400 kN '
                'm": write one of both'
            )
            raise ValueError(msg)
        return self


class ColumnsTable(SectionTable):
    """``[structure.columns]``: the section of the columns, of some storeys if these are named.

    With ``at`` of these lines alone, in place of the section that the others have.
    """

    storeys: tuple[Count, Count] | None = None
    at: tuple[str, ...] = ()
    faces: bool = False
    hinges: HingesTable | None = None

    @model_validator(mode="after")
    def _has_faces(self) -> Self:
        if self.faces and (self.rectangle is None or not self.at):
            msg = (
                'faces = true, beams end at the faces, is for rectangles with "at": leave faces out'
            )
            raise ValueError(msg)
        return self


class BeamsTable(SectionTable):
    """``[structure.beams]``: the section of the beams, of a direction and storeys if named."""

    storeys: tuple[Count, Count] | None = None
    direction: Literal["x", "y"] | None = None
    hinges: HingesTable | None = None

    @model_validator(mode="after")
    def _lies(self) -> Self:
        if self.depth_along is not None:
            msg = "depth_along is for columns, and the depth of beams is vertical: leave it out"
            raise ValueError(msg)
        if self.hinges is not None and self.hinges.ends == "foot":
            msg = (
                'hinges.ends = "foot" is for columns: leave ends out, beams have hinges at both '
                "ends"
            )
            raise ValueError(msg)
        return self


class BaseBeamsTable(BeamsTable):
    """``[structure.base_beams]``: the section of the beams above the bearings."""

    @model_validator(mode="after")
    def _one_level(self) -> Self:
        if self.storeys is not None:
            msg = "storeys is not for base_beams, which are at the base: leave it out"
            raise ValueError(msg)
        return self


class BraceTable(SectionTable):
    """``[[structure.braces]]``: rods hinged at both ends, in one bay of some storeys."""

    between: tuple[str, str]
    storeys: tuple[Count, Count] | None = None
    pattern: Literal["x", "up", "down"] = "x"

    @model_validator(mode="after")
    def _lies(self) -> Self:
        if self.depth_along is not None:
            msg = "depth_along is for columns, and rods have axial force alone: leave it out"
            raise ValueError(msg)
        return self


class WallTable(Table):
    """``[[structure.walls]]``: a wall from column to column, as a column on its axis."""

    between: tuple[str, str]
    thickness: Size
    material: Material
    length: Size | None = None
    cracked: Cracked | None = None
    storeys: tuple[Count, Count] | None = None
