"""From ``[structure]`` of kind "moment frame" to the frame on its bearings."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.member_sections import NamedSection, by_storey, named_section
from frames.design.project.schema_sections import BeamsTable, ColumnsTable
from frames.frame import Frame
from frames.library.building import BeamPart, BuildingPlan, ColumnPart, build, level_name
from frames.library.moment_frames import (
    DEFAULT_BASE_BEAM,
    DEFAULT_BASE_DEPTH,
    DEFAULT_BEAM,
    DEFAULT_COLUMN,
    tributary_masses,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.project.schema_structure import MomentFrame
    from frames.model.sections import Section
    from lir_element import LIRBearing

T = TypeVar("T", bound=ColumnsTable | BeamsTable)

DIRECTIONS = ("x", "y")

_DEFAULTS: dict[str, tuple[Section, str]] = {
    "columns": (DEFAULT_COLUMN, "box 400 x 400 x 25 mm"),
    "beams": (DEFAULT_BEAM, "I 550 x 220 x 20 x 12 mm"),
    "base_beams": (DEFAULT_BASE_BEAM, "I 800 x 300 x 30 x 16 mm"),
}


class MemberSections(NamedTuple):
    """Sections of a regular frame.

    Attributes
    ----------
    columns : list of NamedSection
        By storey.
    beams : dict of str to list of NamedSection
        By direction, "x" and "y", then by floor.
    base_beams : dict of str to NamedSection
        By direction.
    assumed : tuple of str
        Keys that are not in the file, whose sections are assumed.
    """

    columns: list[NamedSection]
    beams: dict[str, list[NamedSection]]
    base_beams: dict[str, NamedSection]
    assumed: tuple[str, ...]


def sections_of(given: MomentFrame) -> MemberSections:
    """Return the sections of a regular frame, those that the file leaves out assumed.

    Parameters
    ----------
    given : MomentFrame
        The section of the file.

    Returns
    -------
    MemberSections
        One for each storey and direction.

    Raises
    ------
    ProjectError, ModelError
        If one cannot be, or a storey has none or several.
    """
    tables = {key: _tables(getattr(given, key)) for key in _DEFAULTS}
    columns = _sections("columns", tables["columns"], given.storeys, None)
    beams = {d: _sections("beams", tables["beams"], given.storeys, d) for d in DIRECTIONS}
    base = {d: _sections("base_beams", tables["base_beams"], 1, d)[0] for d in DIRECTIONS}
    assumed = tuple(key for key, each in tables.items() if not each)
    return MemberSections(columns, beams, base, assumed)


def _tables(given: T | Sequence[T] | None) -> list[T]:
    if given is None:
        return []
    return [given] if isinstance(given, (ColumnsTable, BeamsTable)) else list(given)


def _sections(
    key: str, tables: list[ColumnsTable | BeamsTable], storeys: int, direction: str | None
) -> list[NamedSection]:
    if not tables:
        section, said = _DEFAULTS[key]
        return [NamedSection(section, None, f"{said}, steel (E 200 GPa), assumed")] * storeys
    try:
        chosen = by_storey(tables, storeys, direction)
        made = {id(one): named_section(one, column=key == "columns") for one in chosen}
    except (ModelError, ProjectError) as cause:
        msg = f"[structure] {key}: {cause}"
        raise ProjectError(msg) from cause
    return [made[id(one)] for one in chosen]


def regular_frame(given: MomentFrame, bearing: LIRBearing, name: str) -> Frame:
    """Return a regular frame on its bearings.

    Parameters
    ----------
    given : MomentFrame
        The section of the file.
    bearing : LIRBearing
        Under each column.
    name : str
        Name of the model.

    Returns
    -------
    Frame
        The parts have the names of `frames.moment_frame`.

    Raises
    ------
    ProjectError, ModelError
        If it cannot be.
    """
    frame = build(_plan(given, sections_of(given)), bearing, name=name)
    masses = tributary_masses(given.bays, given.bay_width, given.floor_load, given.eccentricity)
    for level in range(given.storeys + 1):
        for (ix, iy), mass in masses.items():
            frame.add_mass(f"{level_name(level)}-{ix}-{iy}", mass)
    for (ix, iy), mass in masses.items():
        inertia = mass * DEFAULT_BASE_DEPTH**2 / 12.0
        frame.add_mass(f"base-{ix}-{iy}", 0.0, (inertia, inertia, 0.0))
    return frame


def _plan(given: MomentFrame, sections: MemberSections) -> BuildingPlan:
    (n_x, n_y), (b_x, b_y) = given.bays, given.bay_width
    places = list(product(range(n_x + 1), range(n_y + 1)))
    columns, beams = [], []
    for level in range(given.storeys + 1):
        for ix, iy in places:
            if level:
                column = sections.columns[level - 1]
                columns.append(ColumnPart(f"{ix}-{iy}", level, column.section, column.up))
            for direction, there, end in (
                ("x", ix < n_x, f"{ix + 1}-{iy}"),
                ("y", iy < n_y, f"{ix}-{iy + 1}"),
            ):
                if there:
                    each = sections.beams[direction]
                    own = each[level - 1] if level else sections.base_beams[direction]
                    name = f"beam-{direction}"
                    beams.append(BeamPart(name, level, f"{ix}-{iy}", end, own.section))
    return BuildingPlan(
        lines={f"{ix}-{iy}": (ix * b_x, iy * b_y) for ix, iy in places},
        heights=(given.storey_height,) * given.storeys,
        columns=tuple(columns),
        beams=tuple(beams),
    )
