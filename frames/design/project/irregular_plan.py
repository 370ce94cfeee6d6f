"""From ``[structure]`` of kind "irregular frame" and its tables to the frame on its bearings."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

from frames._csv import csv_lines
from frames._errors import ModelError
from frames.design._errors import ProjectError
from frames.design.project.member_sections import NamedSection, named_section
from frames.design.project.quantities import si
from frames.design.project.schema_sections import SectionTable
from frames.exchange.tables import Row
from frames.library.building_plan import BeamPart, BuildingPlan, ColumnPart

if TYPE_CHECKING:
    from pathlib import Path

    from frames.design.project.schema_structure import IrregularFrame
    from frames.exchange.tables import Value

_HEAD = re.compile(r"\s*([a-z_]+)\s*(?:\[\s*([^]]+?)\s*\])?\s*")  # x [m]
_RANGE = re.compile(r"(\d+)(?:\s*(?:-|to)\s*(\d+))?")


class CsvRow(Row):
    """A row of a table: texts by column, with the unit of the head if it has one."""

    __slots__ = ()

    refusal = ProjectError
    remedy = "give it"

    def length(self, key: str) -> float:
        """Return a cell that is a length [m], or raise a ProjectError."""
        given = self.text(key)
        try:
            return si(given, "m", "6.5 m")
        except ValueError as cause:
            msg = f'{key} = "{given}" {cause}, or write the unit in the head, "{key} [m]"'
            raise self.error(msg) from cause

    def choice(self, key: str, choices: Sequence[str]) -> str | None:
        """Return a cell that is one of some words, None if it is empty, or raise."""
        given = self.text(key, "") or None
        if given is not None and given not in choices:
            known = ", ".join(f'"{each}"' for each in choices)
            msg = f'{key} = "{given}" is not known: choose one of {known}'
            raise self.error(msg)
        return given

    def span(self, key: str, least: int, most: int) -> range:
        """Return a cell such as "2" or "1-3" as a range; empty is all from least to most."""
        given = self.text(key, "")
        if not given:
            return range(least, most + 1)
        found = _RANGE.fullmatch(given)
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (1, 0)
        if not least <= first <= last <= most:
            msg = (
                f'{key} = "{given}" must be a storey or a range, lower to upper, within {least} to '
                f'{most}: write "{least}-{most}" for all'
            )
            raise self.error(msg)
        return range(first, last + 1)


def csv_rows(path: Path, needed: Sequence[str], other: Sequence[str] = ()) -> list[CsvRow]:
    """Return the rows of a table."""
    try:
        lines = csv_lines(path)
    except OSError as cause:
        msg = f"{path}: {cause.strerror or cause}: give a CSV file with {', '.join(needed)}"
        raise ProjectError(msg) from cause
    except ValueError as cause:
        msg = f"{path}: {cause}"
        raise ProjectError(msg) from cause
    heads = [_HEAD.fullmatch(head.lower()) for head in (lines[0][1] if lines else [])]
    names = [found[1] if found else "" for found in heads]
    units = [found[2] if found else None for found in heads]
    _require_heads(path, names, lines[0][1] if lines else [], needed, other)
    rows = []
    for number, line in lines[1:]:
        cells: dict[str, Value] = {
            name: f"{cell.strip()} {unit}" if unit else cell.strip()
            for name, unit, cell in zip(names, units, line, strict=False)
            if cell.strip()
        }
        if len(line) > len(names):
            msg = f"{path}, line {number}: has {len(line)} cells, its head {len(names)}"
            msg += ": separate the cells by semicolons if numbers have commas"
            raise ProjectError(msg)
        if cells:
            rows.append(CsvRow(path.name, "", number, cells))
    if not rows:
        msg = f"{path} has no rows: write one for each member, with {', '.join(needed)}"
        raise ProjectError(msg)
    return rows


def _require_heads(
    path: Path, names: list[str], heads: list[str], needed: Sequence[str], other: Sequence[str]
) -> None:
    known = (*needed, *other)
    for name, head in zip(names, heads, strict=True):
        if name not in known:
            near = difflib.get_close_matches(head.lower(), known, n=1)
            meant = f'is "{near[0]}" meant?' if near else f"it has {', '.join(known)}"
            msg = f'{path}: column "{head}" is not known: {meant}'
            raise ProjectError(msg)
        if names.count(name) > 1:
            msg = f'{path}: column "{name}" occurs twice: keep one of them'
            raise ProjectError(msg)
    for name in needed:
        if name not in names:
            msg = f'{path}: column "{name}" is missing: write the head {",".join(known)}'
            raise ProjectError(msg)


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
                f'{row.place}: column "{name}" is at ({place[0]:g}, {place[1]:g}) m here, at '
                f"({lines[name][0]:g}, {lines[name][1]:g}) m before: write one place for each name"
            )
            raise ProjectError(msg)
        own = sections.of(row, column=True)
        for storey in row.span("storeys", 1, len(given.storey_height)):
            if (name, storey) in parts:
                msg = (
                    f'{row.place}: column "{name}" has two sections in storey {storey}: keep one '
                    "of them"
                )
                raise ProjectError(msg)
            parts[name, storey] = ColumnPart(name, storey, own.section, own.up)
    for (one, here), (other, there) in combinations(lines.items(), 2):
        if math.dist(here, there) < _CLOSE:
            msg = (
                f'{given.columns_table}: columns "{one}" and "{other}" are both at ({here[0]:g}, '
                f"{here[1]:g}) m: write one name for all storeys of a column"
            )
            raise ProjectError(msg)
    for name, storey in parts:
        below = [s for n, s in parts if n == name and s < storey]
        if below and storey - 1 not in below:
            msg = (
                f'{given.columns_table}: column "{name}" is missing in storey {storey - 1}, but '
                f"has a row for storey {storey}: add a row for storey {storey - 1}"
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
            msg = f'{row.place}: the beam begins and ends at "{ends[0]}": write two columns'
            raise ProjectError(msg)
        own = sections.of(row, column=False)
        for floor in row.span("floors", 0, len(given.storey_height)):
            key = (floor, frozenset(ends))
            if key in found:
                msg = (
                    f'{row.place}: two beams join "{ends[0]}" and "{ends[1]}" on floor {floor}: '
                    "keep one of them"
                )
                raise ProjectError(msg)
            found[key] = BeamPart("beam", floor, *ends, own.section)
    return tuple(found.values())
