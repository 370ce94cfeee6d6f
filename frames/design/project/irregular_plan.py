"""From ``[structure]`` of kind "irregular frame" and its tables to the frame on its bearings."""

from __future__ import annotations

import difflib
import math
from itertools import combinations
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.csv_rows import CsvRow, csv_rows
from frames.design.project.member_sections import NamedSection, named_section
from frames.design.project.schema_sections import SectionTable
from frames.library.building_plan import BeamPart, BuildingPlan, ColumnPart

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from frames.design.project.schema_structure import IrregularFrame

COLUMNS = ("name", "x", "y", "section")
BEAMS = ("from", "to", "section")
"""Columns that the tables must have."""

_CLOSE = 0.05
"""Distance below which two column lines are one [m]."""


class SectionsByName:
    """Sections of a building by the names that its tables have."""

    def __init__(self, tables: Mapping[str, SectionTable]) -> None:
        self._tables = tables
        self._made: dict[tuple[str, bool], NamedSection] = {}

    def of(self, row: CsvRow, *, column: bool) -> NamedSection:
        """Return the section of a row, or raise a ProjectError."""
        name = row.text("section")
        if (name, column) not in self._made:
            table = self._tables.get(name)
            try:
                if table is None:
                    table = SectionTable(section=name)
                self._made[name, column] = named_section(table, column=column)
            except (ModelError, ProjectError) as cause:
                own = list(self._tables)
                near = difflib.get_close_matches(name, own, n=1) or own[:1]
                hint = f'; [structure.sections] has "{near[0]}"' if near else ""
                msg = f'{row.place}: section "{name}": {cause}{hint}'
                raise ProjectError(msg) from cause
        found = self._made[name, column]
        turned = row.choice("depth_along", ("x", "y"))
        if turned is None:
            return found
        return found._replace(up=(0.0, 1.0, 0.0) if turned == "y" else None)


def irregular_plan(given: IrregularFrame, folder: Path) -> BuildingPlan:
    """Return the plan of an irregular frame."""
    sections = SectionsByName(given.sections)
    lines, columns = _columns(given, folder, sections)
    beams = _beams(given, folder, sections, lines)
    return BuildingPlan(lines=lines, heights=given.storey_height, columns=columns, beams=beams)


def _columns(
    given: IrregularFrame, folder: Path, sections: SectionsByName
) -> tuple[dict[str, tuple[float, float]], tuple[ColumnPart, ...]]:
    lines: dict[str, tuple[float, float]] = {}
    parts: dict[tuple[str, int], ColumnPart] = {}
    for row in csv_rows(folder / given.columns_table, COLUMNS, ("storeys", "depth_along")):
        name, place = row.text("name"), (row.length("x"), row.length("y"))
        if lines.setdefault(name, place) != place:
            msg = (
                f'{row.place}: column "{name}" stands at ({place[0]:g}, {place[1]:g}) m here, at '
                f"({lines[name][0]:g}, {lines[name][1]:g}) m before: a name has one place"
            )
            raise ProjectError(msg)
        own = sections.of(row, column=True)
        for storey in row.span("storeys", 1, len(given.storey_height)):
            if (name, storey) in parts:
                msg = f'{row.place}: column "{name}" has two sections in storey {storey}: keep one'
                raise ProjectError(msg)
            parts[name, storey] = ColumnPart(name, storey, own.section, own.up)
    for (one, here), (other, there) in combinations(lines.items(), 2):
        if math.dist(here, there) < _CLOSE:
            msg = (
                f'{given.columns_table}: columns "{one}" and "{other}" stand at one place, '
                f"({here[0]:g}, {here[1]:g}) m: give parts of one column one name"
            )
            raise ProjectError(msg)
    for name, storey in parts:
        below = [s for n, s in parts if n == name and s < storey]
        if below and storey - 1 not in below:
            msg = (
                f'{given.columns_table}: column "{name}" is missing in storey {storey - 1}, under '
                f"its part in storey {storey}: fill the gap"
            )
            raise ProjectError(msg)
    return lines, tuple(parts.values())


def _beams(
    given: IrregularFrame,
    folder: Path,
    sections: SectionsByName,
    lines: Mapping[str, tuple[float, float]],
) -> tuple[BeamPart, ...]:
    found: dict[tuple[int, frozenset[str]], BeamPart] = {}
    for row in csv_rows(folder / given.beams_table, BEAMS, ("floors",)):
        ends = row.text("from"), row.text("to")
        for end in ends:
            if end not in lines:
                near = difflib.get_close_matches(end, lines, n=1)
                meant = f'is "{near[0]}" meant?' if near else "add it there"
                msg = f'{row.place}: {given.columns_table} has no column "{end}": {meant}'
                raise ProjectError(msg)
        if ends[0] == ends[1]:
            msg = f'{row.place}: the beam begins and ends at "{ends[0]}": give two columns'
            raise ProjectError(msg)
        own = sections.of(row, column=False)
        for floor in row.span("floors", 0, len(given.storey_height)):
            key = (floor, frozenset(ends))
            if key in found:
                msg = (
                    f'{row.place}: there are two beams between "{ends[0]}" and "{ends[1]}" on '
                    f"floor {floor}: keep one"
                )
                raise ProjectError(msg)
            found[key] = BeamPart("beam", floor, *ends, own.section)
    return tuple(found.values())
